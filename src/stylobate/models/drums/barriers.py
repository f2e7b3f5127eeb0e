"""Energy that overturns a column of drums: the barriers between how it stands and how it falls."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_geometry import Geometry, gravity_vector
from ...constants import DEGREE
from ..shared.toes import given_by_toes


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


def flat_barrier(column: Column, flat: Geometry, toes: np.ndarray) -> float:
    """Lowest barrier of the column with its drums flat on one another, each with its offset [J]; 0 if none is left."""
    down = gravity_vector(column)
    up = -down / column.gravity
    slope = flat.lean + column.as_found.base_tilt * DEGREE
    friction = np.array(
        [math.tan(max(math.atan(rough) - abs(one), 0.0)) for rough, one in zip(column.friction, slope, strict=True)]
    )
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        centroid = mass @ flat.centroid[j:] / mass.sum()
        arms = [centroid - flat.end(j, side) for side in (-1, 1)]
        # across gravity, from the left and to the right end, and along it
        inside = [arms[0][0] * up[1] - arms[0][1] * up[0], arms[1][1] * up[0] - arms[1][0] * up[1]]
        near = int(np.argmin(inside))
        half, height = float(inside[near]), float(arms[near] @ up)
        if half <= 0.0:
            return 0.0
        radius = math.hypot(half, height)
        # sliding on the base takes no support away: joints between drums count
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        barrier = column.gravity * float(mass.sum()) * rise - given_by_toes(column, toes, j, half, height)
        lowest = min(lowest, barrier)
    return lowest
