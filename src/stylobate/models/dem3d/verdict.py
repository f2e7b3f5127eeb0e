"""Does a column in space that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column


def stands_for_good(column: Column, drum: np.ndarray, lane: int, slip: np.ndarray, energy: float) -> bool:
    """Whether a column that no input shakes any more can neither overturn nor slide apart. Eq. (V1), in space.

    Parameters
    ----------
    column : Column
    drum : array
        Records of the drums, the base first (legend of the kernels).
    lane : int
    slip : array
        Offset of each drum along the joint under it [m], shape (n, 2).
    energy : float
        Kinetic, gravitational and elastic energy above that of the column at rest [J].
    """
    return _centroids_inside(column, drum, lane) and energy < flat_barrier(column, slip)


def flat_barrier(column: Column, slip: np.ndarray) -> float:
    """Lowest energy that overturns, or slides and lifts, some part of the column with its drums put down flat [J].

    A part overturns about the nearest edge of the overlap of its two faces, at a distance b from under its centroid:
    m g (√(H² + b²) − H); where some joint above is so slippery that it slides first, see Eq. (V1). 0 if a centroid is
    not above its overlap.
    """
    place = np.cumsum(slip, axis=0)
    friction = np.array([joint.tan_phi for joint in column.joints])
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        middle = mass @ place[j:] / mass.sum()
        height = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]) / mass.sum())
        below = place[j - 1] if j else middle
        under = 0.5 * column.drums[j - 1].top_width if j else math.inf
        own = 0.5 * column.drums[j].bottom_width
        half = min(own - math.dist(middle, place[j]), under - math.dist(middle, below))
        if half <= 0.0:
            return 0.0
        radius = math.hypot(half, height)
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        lowest = min(lowest, column.gravity * float(mass.sum()) * rise)
    return lowest


def _centroids_inside(column: Column, drum: np.ndarray, lane: int) -> bool:
    """Whether the centroid of every part is above both faces of the joint under it, along gravity."""

    def vector(i: int, names: str) -> np.ndarray:
        return np.array([drum[name][i, lane] for name in names.split()])

    axes = [np.array([vector(i, f"{a}x {a}y {a}z") for a in "ijk"]) for i in range(column.n + 1)]
    centroids = np.array([vector(i + 1, "x y z") for i in range(column.n)])
    for j in range(column.n):
        mass = column.masses[j:]
        part = mass @ centroids[j:] / mass.sum()
        upper = axes[j + 1]
        foot = centroids[j] + vector(j + 1, "fx fy fz") @ upper
        below = vector(j, "x y z") + drum["ht"][j, lane] * axes[j][2]
        faces = (
            (foot, vector(j + 1, "nx ny nz") @ upper, drum["rb"][j + 1, lane]),
            (below, axes[j][2], drum["rt"][j, lane]),
        )
        for middle, normal, radius in faces:
            drop = (part - middle) @ normal / normal[2]
            if math.dist(part - np.array([0.0, 0.0, drop]), middle) >= radius:
                return False
    return True
