"""Numbers of a column in the plane for the law of whether it stands for good."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...constants import DEGREE


@lru_cache(maxsize=4096)
def numbers_for(column: Column) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the drums for the law, put down flat as found, but for what joints give; their offsets as found [m]."""
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
    stand["edge"] = 0.5 * column.joint_widths
    offsets = np.array([one.offset for one in found])
    put_down(stand, offsets)
    return stand, offsets
