"""From where bodies in space are seen: parallel projection, so that lengths across the line of sight keep one scale."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..constants import DEGREE
from ..errors import InputError, check_range


@dataclass(frozen=True)
class View:
    """Direction of the viewer.

    Parameters
    ----------
    azimuth : float
        From x towards y [rad].
    elevation : float
        Above the horizontal [rad].
    """

    azimuth: float
    elevation: float

    @property
    def right(self) -> np.ndarray:
        """Direction to the right of the picture [-], shape (3,)."""
        return np.array([-math.sin(self.azimuth), math.cos(self.azimuth), 0.0])

    @property
    def up(self) -> np.ndarray:
        """Direction that is upward in the picture [-], shape (3,)."""
        s, c = math.sin(self.elevation), math.cos(self.elevation)
        return np.array([-math.cos(self.azimuth) * s, -math.sin(self.azimuth) * s, c])

    @property
    def toward(self) -> np.ndarray:
        """To the viewer [-], shape (3,)."""
        s, c = math.sin(self.elevation), math.cos(self.elevation)
        return np.array([math.cos(self.azimuth) * c, math.sin(self.azimuth) * c, s])

    def across(self, points: np.ndarray) -> np.ndarray:
        """Points in the picture, to the right and upward [m], shape (…, 3) to (…, 2)."""
        return points @ np.stack((self.right, self.up), axis=1)


#: Elevations: x to the right, seen along y; y to the right, seen against x.
ALONG_X, ALONG_Y = View(-0.5 * math.pi, 0.0), View(0.0, 0.0)

#: From where films show bodies in space unless they are told otherwise.
OBLIQUE = View(-40.0 * DEGREE, 18.0 * DEGREE)


def parse_view(text: str) -> View:
    """A view from two angles in degrees, such as ``-40,18``.

    Raises
    ------
    InputError
        Not two numbers, or a viewer below the ground.
    """
    try:
        azimuth, elevation = (float(part.strip().removesuffix("deg")) for part in text.split(","))
    except ValueError:
        raise InputError(
            f"the view is {text!r}; allowed are azimuth and elevation of the viewer in degrees, such as -40,18."
        ) from None
    check_range("azimuth of the view", azimuth, -360.0, 360.0, unit="°")
    check_range("elevation of the view", elevation, 0.0, 90.0, unit="°")
    return View(azimuth * DEGREE, elevation * DEGREE)
