"""Does a column in space that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from .packing import CORNERS
from .toes import given_by_toes


def stands_for_good(
    column: Column, drum: np.ndarray, lane: int, slip: np.ndarray, energy: float, toes: np.ndarray
) -> bool:
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
    toes : array
        What each joint gives with its load on its edge, see :func:`~.toes.toe_energies` [J], shape (n,).
    """
    if column.section == "circular":
        return _centroids_inside(column, drum, lane) and energy < flat_barrier(column, slip, toes=toes)
    turns = np.arctan2(drum["iy"][:, lane], drum["ix"][:, lane])
    return _centroids_above_corners(column, drum, lane) and energy < flat_barrier(column, slip, turns, toes)


def flat_barrier(
    column: Column, slip: np.ndarray, turns: np.ndarray | None = None, toes: np.ndarray | None = None
) -> float:
    """Lowest energy that overturns, or slides and lifts, some part of the column with its drums put down flat [J].

    A part overturns about the nearest edge of the overlap of its two faces, at a distance b from under its centroid:
    m g (√(H² + b²) − H); where some joint above is so slippery that it slides first, see Eq. (V1). 0 if a centroid is
    not above its overlap.

    Parameters
    ----------
    column : Column
    slip : array
        Offset of each drum along the joint under it [m], shape (n, 2).
    turns : array, optional
        Azimuth of each body's first axis, the base's first [rad], shape (n + 1,); for rectangular sections.
    toes : array, optional
        See :func:`stands_for_good`; rigid joints without.
    """
    cornered = column.section != "circular"
    if cornered and turns is None:
        turns = np.zeros(column.n + 1)
    turned = slip if turns is None else np.stack([_turn(turns[j]) @ slip[j] for j in range(column.n)])
    place = np.cumsum(turned, axis=0)
    friction = np.array([joint.tan_phi for joint in column.joints])
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        middle = mass @ place[j:] / mass.sum()
        height = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]) / mass.sum())
        if cornered and turns is not None:
            own, under = column.drums[j], column.drums[j - 1] if j else None
            back = _turn(turns[j]).T
            corners = CORNERS * (0.5 * own.bottom_width, 0.5 * own.depth) @ (back @ _turn(turns[j + 1])).T
            beside = back @ (place[j - 1] if j else np.zeros(2))
            corners = corners + back @ place[j] - beside
            if under is not None:
                ends = np.array([0.5 * under.top_width, 0.5 * under.depth])
                corners = np.clip(corners, -ends, ends)
            half = inside_by(back @ middle - beside, corners)
        else:
            below = place[j - 1] if j else middle
            lower = 0.5 * column.drums[j - 1].top_width if j else math.inf
            own = 0.5 * column.drums[j].bottom_width
            half = min(own - math.dist(middle, place[j]), lower - math.dist(middle, below))
        if half <= 0.0:
            return 0.0
        radius = math.hypot(half, height)
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        barrier = column.gravity * float(mass.sum()) * rise
        if toes is not None:
            barrier -= given_by_toes(column, toes, j, half, height)
        lowest = min(lowest, barrier)
    return lowest


def inside_by(point: np.ndarray, polygon: np.ndarray) -> float:
    """How far a point is inside a convex polygon given counter-clockwise, shape (k, 2); negative outside [m].

    Sides without length do not count.
    """
    sides = np.roll(polygon, -1, axis=0) - polygon
    lengths = np.hypot(*sides.T)
    real = lengths > 1e-9 * lengths.max()
    if not real.any():
        return -math.dist(point, polygon[0])
    to = point - polygon[real]
    return float(((sides[real, 0] * to[:, 1] - sides[real, 1] * to[:, 0]) / lengths[real]).min())


def _turn(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def _centroids_above_corners(column: Column, drum: np.ndarray, lane: int) -> bool:
    """Whether the centroid of every part is above the corners of the overlap of the joint under it, seen along z."""

    def field(*names: str) -> np.ndarray:
        return np.stack([drum[name][..., lane] for name in names], axis=-1)

    axes = np.stack([field(f"{a}x", f"{a}y", f"{a}z") for a in "ijk"], axis=1)  # rows i, j, k
    centroids, foot, own = field("x", "y", "z"), field("fx", "fy", "fz"), field("px", "py", "pz")
    ends, ht = field("tx", "ty"), field("ht")
    for j in range(column.n):
        mass = column.masses[j:]
        part = mass @ centroids[j + 1 :] / mass.sum()
        lower, upper = axes[j], axes[j + 1]
        middle = centroids[j] + ht[j] * lower[2]
        corners = (centroids[j + 1] + (foot[j + 1] + own[j + 1]) @ upper - middle) @ lower.T
        corners[:, 2] *= (np.abs(corners[:, :2]) < ends[j]).all(axis=1)
        corners[:, :2] = np.clip(corners[:, :2], -ends[j], ends[j])
        if inside_by(part[:2], (middle + corners @ lower)[:, :2]) <= 0.0:
            return False
    return True


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
