"""Does a column that stands now stand for good? Its numbers for the law, and the verdict."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...constants import DEGREE
from ..shared.toes import centroids_above
from .block import Records


@lru_cache(maxsize=4096)
def numbers_for(column: Column) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the drums for the law, put down flat as found, but for their toes; their offsets as found [m]."""
    from ...kernels.plane.standing import STAND_TYPE, put_down

    found = [column.as_found.of(i + 1) for i in range(column.n)]
    bottom = np.array([0.5 * drum.bottom_width for drum in column.drums])
    stand: Any = np.zeros(column.n, STAND_TYPE)
    stand["m"], stand["h"], stand["rough"] = column.masses, column.heights, column.friction
    stand["hc"] = [drum.centroid_height for drum in column.drums]
    stand["tilt"] = [one.tilt * DEGREE for one in found]
    stand["left"] = bottom - [one.chip_left for one in found]
    stand["right"] = bottom - [one.chip_right for one in found]
    stand["under"] = [math.inf, *(0.5 * drum.top_width for drum in column.drums[:-1])]
    stand["weight"], stand["moment"] = column.joint_weights, column.joint_weights * 0.5 * column.joint_widths
    stand["over"] = centroids_above(column)
    offsets = np.array([one.offset for one in found])
    put_down(stand, offsets)
    return stand, offsets


def stands_for_good(
    column: Column, records: Records, lane: int, slip: np.ndarray, energy: float, toes: np.ndarray
) -> bool:
    """Whether a column that no input shakes any more can neither overturn nor slide apart.

    Parameters
    ----------
    column : Column
    records : Records
        In which the column is.
    lane : int
    slip : array
        Along each joint since the start [m], shape (n,).
    energy : float
        Kinetic, gravitational and elastic energy above that of the column at rest [J].
    toes : array
        What each joint gives with its load on its edge (:mod:`stylobate.models.shared.toes`) [J], shape (n,).

    Notes
    -----
    Two conditions, Eq. (V1). As the column is, the centroid of every part stands within its contact: it is on the
    near side of every barrier. And the energy is below the lowest barrier of the column put down flat with its
    present offsets: overturning as one body about the nearer end of the contact, m g (R − H); where some joint above
    is so slippery that it slides first, tan φ below the sine of the critical angle, sliding and lifting together: m g
    [tan φ b − H (1 − √(1 − tan² φ))]. On a slope H and b are measured along and across gravity, and friction is what
    the slope of the joint leaves of it. Soft joints give, and the barrier is lower by that.
    """
    from ...kernels.plane.standing import stands

    numbers, offsets = numbers_for(column)
    stand = numbers.copy()
    stand["toe"] = toes
    slope = column.as_found.base_tilt * DEGREE
    return bool(stands(stand, offsets + slip, column.gravity, slope, energy, records.body, records.joint, lane))
