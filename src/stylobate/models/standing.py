"""Does a column that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math

import numpy as np

from ..column import Column


def lowest_barrier(column: Column) -> float:
    """Smallest energy that overturns the part above some joint of the upright column as one body [J]."""
    return min(
        column.gravity * mass * (math.hypot(half, height) - height)
        for (mass, height), half in zip(
            (_part(column, j) for j in range(column.n)), 0.5 * column.joint_widths, strict=True
        )
    )


def stands_for_good(column: Column, drum: np.ndarray, lane: int, slip: np.ndarray, energy: float) -> bool:
    """Whether a column that no input shakes any more can neither overturn nor slide apart.

    Parameters
    ----------
    column : Column
    drum : array
        Records of the drums, the base first (legend of the kernel).
    lane : int
    slip : array
        Offset along each joint [m], shape (n,).
    energy : float
        Kinetic, gravitational and elastic energy above that of the column at rest [J].

    Notes
    -----
    Two conditions. As the column is, the centroid of every part stands within its contact: it is on the near side of every
    barrier. And the energy is below the lowest barrier of the column put down flat with its present offsets: overturning
    as one body about the nearer end of the contact, m g (R − H); where some joint above is so slippery that it slides
    first, tan φ below the sine of the critical angle, sliding and lifting together: m g [tan φ b − H (1 − √(1 − tan² φ))].
    """
    return _centroids_inside(column, drum, lane) and energy < _flat_barrier(column, slip)


def _part(column: Column, j: int) -> tuple[float, float]:
    """Mass of the part above joint j and height of its centroid above that joint [kg], [m]."""
    mass = column.masses[j:]
    arm = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]))
    return float(mass.sum()), arm / float(mass.sum())


def _centroids_inside(column: Column, drum: np.ndarray, lane: int) -> bool:
    x, z, c, s, ht, hb, b, t = (drum[name][:, lane] for name in ("x", "z", "c", "s", "ht", "hb", "b", "t"))
    for j in range(column.n):
        mass = column.masses[j:]
        centroid = float(mass @ x[j + 1 :] / mass.sum())
        dx, dz = x[j + 1] - x[j], z[j + 1] - z[j]
        cosine, sine = c[j + 1] * c[j] + s[j + 1] * s[j], s[j + 1] * c[j] - c[j + 1] * s[j]
        middle = c[j] * dx + s[j] * dz + sine * hb[j + 1]
        low = max(middle - b[j + 1] * cosine, -t[j])
        high = min(middle + b[j + 1] * cosine, t[j])
        left, right = (x[j] + c[j] * end - s[j] * ht[j] for end in (low, high))
        if not left < centroid < right:
            return False
    return True


def _flat_barrier(column: Column, slip: np.ndarray) -> float:
    """Lowest barrier of the column with its drums flat on one another, each with its offset [J]; 0 if none is left."""
    place = np.cumsum(slip)
    friction = np.array([joint.tan_phi for joint in column.joints])
    lowest = math.inf
    for j, drum in enumerate(column.drums):
        mass, height = _part(column, j)
        centroid = float(column.masses[j:] @ place[j:]) / mass
        left, right = place[j] - drum.bottom_width / 2, place[j] + drum.bottom_width / 2
        if j:
            half = column.drums[j - 1].top_width / 2
            left, right = max(left, place[j - 1] - half), min(right, place[j - 1] + half)
        half = min(right - centroid, centroid - left)
        if half <= 0.0:
            return 0.0
        radius = math.hypot(half, height)
        # sliding on the base takes no support away: joints between drums count
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        lowest = min(lowest, column.gravity * mass * rise)
    return lowest
