"""A start from a pose instead of rest: the whole column tilted about its rim, and turning."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..errors import InputError, check_range


@dataclass(frozen=True)
class Start:
    """The column as one rigid body, tilted about its rim.

    Parameters
    ----------
    tilt : float
        Lean of the column [rad].
    azimuth : float
        Direction in which it leans, from x towards y [rad]; the lowest point of the rim is at its place on the ground.
    angular_velocity : (float, float, float)
        In space axes [rad/s]; the lowest point of the rim is at rest.

    Raises
    ------
    InputError
        A value outside its range.
    """

    tilt: float
    azimuth: float = 0.0
    angular_velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "tilt", check_range("tilt of a start", self.tilt, 0.0, 0.5 * math.pi, unit="rad"))
        turn = 2.0 * math.pi
        object.__setattr__(self, "azimuth", check_range("azimuth of a start", self.azimuth, -turn, turn, unit="rad"))
        spin = tuple(self.angular_velocity)
        if len(spin) != 3:
            raise InputError(
                f"angular_velocity of a start is {spin!r}; give three components, about x, y and z [rad/s]."
            )
        spin = tuple(check_range("angular_velocity of a start", one, -1e4, 1e4, unit="rad/s") for one in spin)
        object.__setattr__(self, "angular_velocity", spin)
