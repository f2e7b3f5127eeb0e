"""Does a column in space that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_in_space import SpaceGeometry, inside_overlap, space_geometry, space_load, upward
from ...constants import DEGREE
from ..shared.toes import given_by_toes
from .packing import CORNERS, chip_directions

#: Share of its margin that a drum on another one may walk off while it wobbles [-].
WALK = 0.4


def stands_for_good(
    column: Column,
    drum: np.ndarray,
    lane: int,
    slip: np.ndarray,
    energy: float,
    toes: np.ndarray,
    walks: bool = True,
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
        What each joint gives with its load on its edge (:mod:`stylobate.models.shared.toes`) [J], shape (n,).
    walks : bool
        A drum that wobbles on another one may walk: joints between drums have their support narrowed by :data:`WALK`.
        Walking without slip costs nothing, so that no bound by energy is a proof; the margin is measured, see the theory
        page.
    """
    if column.as_found:
        inside = _centroids_inside if column.section == "circular" else _centroids_above_corners
        if not inside(column, drum, lane):
            return False
        turns = np.unwrap(np.arctan2(drum["iy"][:, lane], drum["ix"][:, lane]))
        twist = np.diff(turns) - [column.as_found.of(i + 1).turn * DEGREE for i in range(column.n)]
        flat = space_geometry(column, slip=slip, twist=twist)
        # what sliding down a slope has set free is not there any more to fall back on
        lower = float(column.masses @ ((space_geometry(column).centroid - flat.centroid) @ upward(column)))
        return energy + max(lower * column.gravity, 0.0) < found_barrier(column, flat, toes, walks)
    if column.section == "circular":
        return _centroids_inside(column, drum, lane) and energy < flat_barrier(column, slip, toes=toes, walks=walks)
    turns = np.arctan2(drum["iy"][:, lane], drum["ix"][:, lane])
    return _centroids_above_corners(column, drum, lane) and energy < flat_barrier(column, slip, turns, toes, walks)


def flat_barrier(
    column: Column,
    slip: np.ndarray,
    turns: np.ndarray | None = None,
    toes: np.ndarray | None = None,
    walks: bool = False,
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
    walks : bool
        See :func:`stands_for_good`.
    """
    cornered = column.section != "circular"
    if cornered and turns is None:
        turns = np.zeros(column.n + 1)
    turned = slip if turns is None else np.stack([_turn(turns[j]) @ slip[j] for j in range(column.n)])
    place = np.cumsum(turned, axis=0)
    friction = column.friction
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
                ends = np.array([0.5 * under.top_width, 0.5 * under.upper_depth])
                corners = np.clip(corners, -ends, ends)
            half = inside_by(back @ middle - beside, corners)
        else:
            below = place[j - 1] if j else middle
            lower = 0.5 * column.drums[j - 1].top_width if j else math.inf
            own = 0.5 * column.drums[j].bottom_width
            half = min(own - math.dist(middle, place[j]), lower - math.dist(middle, below))
        if half <= 0.0:
            return 0.0
        half *= 1.0 - WALK if walks and j else 1.0
        radius = math.hypot(half, height)
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        barrier = column.gravity * float(mass.sum()) * rise
        if toes is not None:
            barrier -= given_by_toes(column, toes, j, half, height)
        lowest = min(lowest, barrier)
    return lowest


def found_barrier(column: Column, flat: SpaceGeometry, toes: np.ndarray, walks: bool = False) -> float:
    """As :func:`flat_barrier` for a column as found, with its drums put down flat where they are; a lower bound [J].

    On a joint that slopes by γ the nearest edge is b cos γ away across gravity, and may lie b sin γ lower; friction is what
    the slope leaves of it.
    """
    up = upward(column)
    level = np.minimum(flat.frame[:, :, 2] @ up, 1.0)
    slope = np.arccos(level)
    friction = np.array([math.tan(max(math.atan(one) - s, 0.0)) for one, s in zip(column.friction, slope, strict=True)])
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        load = space_load(column, flat, j)
        inside = inside_overlap(column, flat, j, load.place) if load.normal > 0.0 else 0.0
        if inside <= 0.0:
            return 0.0
        inside *= 1.0 - WALK if walks and j else 1.0
        place = flat.origin[j] + flat.frame[j, :, :2] @ load.place
        half = inside * level[j]
        height = float((mass @ flat.centroid[j:] / mass.sum() - place) @ up) + inside * math.sin(slope[j])
        radius = math.hypot(half, height)
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        barrier = column.gravity * float(mass.sum()) * level[j] * rise - given_by_toes(column, toes, j, half, height)
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
    """Whether the centroid of every part is above the corners of the overlap of the joint under it, along gravity."""

    def field(*names: str) -> np.ndarray:
        return np.stack([drum[name][..., lane] for name in names], axis=-1)

    up = upward(column)
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
        corners = middle + corners @ lower
        if inside_by(*(one[..., :2] - one[..., 2:] * up[:2] / up[2] for one in (part, corners))) <= 0.0:
            return False
    return True


def _centroids_inside(column: Column, drum: np.ndarray, lane: int) -> bool:
    """Whether the centroid of every part is above both faces of the joint under it, along gravity."""

    def vector(i: int, names: str) -> np.ndarray:
        return np.array([drum[name][i, lane] for name in names.split()])

    up = upward(column)
    axes = [np.array([vector(i, f"{a}x {a}y {a}z") for a in "ijk"]) for i in range(column.n + 1)]
    centroids = np.array([vector(i + 1, "x y z") for i in range(column.n)])
    directions = chip_directions(column)
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
        one = column.as_found.of(j + 1)
        if one.chipped:
            drop = (part - foot) @ faces[0][1] / (faces[0][1] @ up)
            toward, radius = (part - drop * up - foot) @ (directions[j] @ upper), faces[0][2]
            if toward >= radius - max(one.chips):
                return False
        for middle, normal, radius in faces:
            drop = (part - middle) @ normal / (normal @ up)
            if math.dist(part - drop * up, middle) >= radius:
                return False
    return True
