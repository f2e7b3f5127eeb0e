"""Numbers of a column in space for the law of whether it stands for good."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_geometry import space_geometry, upward
from ...constants import DEGREE


@lru_cache(maxsize=4096)
def found_numbers(column: Column) -> tuple[np.ndarray, np.ndarray, float]:
    """Numbers of a column as found for the law, see ``kernels/dem3d/standing_found.py``: of its drums; the direction against
    gravity [-], and mass times height of all drums as they were found [kg m]."""
    from ...kernels.dem3d.standing_found import FOUND_TYPE

    at, up, drums = space_geometry(column), upward(column), column.drums
    one: Any = np.zeros(column.n, FOUND_TYPE)
    one["lean"] = at.bed.transpose(0, 2, 1)
    below = np.concatenate(([0.0], at.turned[:-1]))  # offsets as found are in axes that do not turn with the drums
    c, s = np.cos(below), np.sin(below)
    one["x"], one["y"] = c * at.offset[:, 0] + s * at.offset[:, 1], c * at.offset[:, 1] - s * at.offset[:, 0]
    one["low"], one["high"] = np.transpose([(drum.centroid_height, drum.height) for drum in drums])
    half, deep = (np.array([0.5 * getattr(drum, name) for drum in drums]) for name in ("bottom_width", "depth"))
    left, right, front, back = np.transpose([column.as_found.of(i + 1).chips for i in range(column.n)])
    if column.section == "circular":
        cut = left + right > 0.0
        one["left"], one["right"] = (np.where(cut, half - chip, math.inf) for chip in (left, right))
        one["front"] = one["back"] = math.inf
    else:
        one["left"], one["right"], one["front"], one["back"] = half - left, half - right, deep - front, deep - back
    one["towards"] = [column.as_found.of(i + 1).chip_azimuth * DEGREE for i in range(column.n)]
    return one, up, float(column.masses @ at.centroid @ up)


def numbers_for(column: Column, toes: np.ndarray) -> np.ndarray:
    """Numbers of a column for the law, see ``kernels/dem3d/standing.py``.

    ``toes`` is what each joint, and what all others give with the part above it on its edge
    (:mod:`stylobate.models.shared.toes`) [J], shape (2, n).
    """
    from ...kernels.dem3d.standing import STAND_TYPE

    stand: Any = np.zeros(column.n, STAND_TYPE)
    drums, below = column.drums, column.drums[:-1]
    stand["m"], stand["rough"], stand["over"] = column.masses, column.friction, column.parts_above[1]
    stand["edge"], (stand["toe"], stand["others"]) = 0.5 * column.joint_widths, toes
    stand["along"], stand["across"] = np.transpose([(0.5 * drum.bottom_width, 0.5 * drum.depth) for drum in drums])
    stand["under"] = [math.inf, *(0.5 * drum.top_width for drum in below)]
    stand["beside"] = [math.inf, *(0.5 * drum.upper_depth for drum in below)]
    return stand
