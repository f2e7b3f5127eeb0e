"""Energy that overturns a column of drums: the barriers between how it stands and how it falls."""

from __future__ import annotations

import math
from functools import lru_cache

from ...column import Column


@lru_cache(maxsize=4096)
def lowest_barrier(column: Column) -> float:
    """Smallest energy that overturns the part above some joint of the upright column as one body [J]."""
    return min(
        column.gravity * mass * (math.hypot(half, height) - height)
        for (mass, height), half in zip(
            (_part(column, j) for j in range(column.n)), 0.5 * column.joint_widths, strict=True
        )
    )


def _part(column: Column, j: int) -> tuple[float, float]:
    """Mass of the part above joint j and height of its centroid above that joint [kg], [m]."""
    mass = column.masses[j:]
    arm = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]))
    return float(mass.sum()), arm / float(mass.sum())
