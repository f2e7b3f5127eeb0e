"""A block of an assembly, a convex polygon of constant thickness, and where two of them touch."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from ..errors import InputError, check_name, check_range, warn
from ..messages import say
from .drum import DENSITIES, LENGTHS
from .joint import Joint
from .shapes import Outlined, Placed, Prism

MAX_VERTICES = 24

#: Faces touch when they are this close, as a share of the smaller block's size, and parallel to this angle [rad].
TOUCHING, PARALLEL = 1e-5, 1e-4

#: Half width and depth of the ground, far enough to be a half-plane [m].
FAR_AWAY = 1.0e4


@dataclass(frozen=True)
class Block(Outlined):
    """A rigid block: a convex polygon of constant thickness.

    Parameters
    ----------
    vertices : sequence of (float, float)
        Corners (x, z), counter-clockwise [m]; clockwise ones are turned round, and that is said. Corners within a straight
        side are left out.
    density : float
        [kg/m³]
    name : str
    depth : float
        Thickness across the plane [m].
    fixed : bool
        Moves with the ground: a support.
    surface : Joint, optional
        Law of the contacts with blocks that come before it; the assembly's if left out.
    solid : (float, float, float, float), optional
        Mass [kg], inertia about the centroid [kg m²] and centroid (x, z) [m] where the solid is no prism of the polygon
        (a round drum).

    Raises
    ------
    InputError
        No convex polygon, or a value outside its range.
    """

    vertices: tuple[tuple[float, float], ...]
    density: float
    name: str = "block"
    depth: float = 1.0
    fixed: bool = False
    surface: Joint | None = None
    solid: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        who = f"block {check_name('the name of a block', self.name)!r}"
        try:
            corners = np.array(self.vertices, dtype=float)
        except (TypeError, ValueError):
            corners = np.empty(0)
        if corners.ndim != 2 or corners.shape[-1] != 2 or not 3 <= len(corners) <= MAX_VERTICES:
            raise InputError(f"{who} needs 3 to {MAX_VERTICES} vertices, each a pair of numbers x, z [m].")
        if not np.isfinite(corners).all() or np.abs(corners).max() > 2.0 * FAR_AWAY:
            raise InputError(f"{who} has a vertex that is not finite or beyond {FAR_AWAY:g} m; use SI units.")
        lightest = 0.0 if self.fixed else DENSITIES[0]
        density = check_range(f"density of {who}", self.density, lightest, DENSITIES[1], unit="kg/m³")
        depth = check_range(f"depth of {who}", self.depth, *LENGTHS, unit="m")
        size = float(np.ptp(corners, axis=0).max())
        if not self.fixed:
            check_range(f"size of {who}", size, *LENGTHS, unit="m", remedy="use SI units")
        sides = np.roll(corners, -1, axis=0) - corners
        short = np.hypot(sides[:, 0], sides[:, 1]) <= 1e-9 * size
        if short.any():
            k = int(short.argmax())
            raise InputError(f"{who} has vertex {k + 1} twice in succession; leave one of them out.")
        area = _area(corners)
        if abs(area) <= 1e-9 * size * size:
            raise InputError(f"{who} has no area; give vertices that do not lie on one line.")
        if area < 0.0:
            corners, area = corners[::-1], -area
            warn(say("the vertices of {who} run clockwise; they are turned round.", who=who))
        corners = _without_flat(corners)
        sides = np.roll(corners, -1, axis=0) - corners
        after = np.roll(sides, -1, axis=0)
        turns = sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]
        angle = np.arctan2(turns, (sides * after).sum(axis=1))
        if turns.min() < -1e-12 * size * size or float(angle.sum()) > 2.0 * math.pi + 1e-6:
            k = (int(turns.argmin()) + 1) % len(corners)
            raise InputError(
                f"{who} is not convex at vertex ({corners[k, 0]:g}, {corners[k, 1]:g}); split it into convex blocks."
            )
        object.__setattr__(self, "vertices", tuple(zip(corners[:, 0].tolist(), corners[:, 1].tolist(), strict=True)))
        object.__setattr__(self, "density", density)
        object.__setattr__(self, "depth", depth)

    @cached_property
    def corners(self) -> np.ndarray:
        """Vertices [m], shape (k, 2)."""
        return np.array(self.vertices)

    @cached_property
    def properties(self) -> tuple[float, float, float, float]:
        """Mass [kg], inertia about the centroid [kg m²], centroid x and z [m]."""
        if self.solid is not None:
            return self.solid
        origin = self.corners.mean(axis=0)
        p = self.corners - origin
        q = np.roll(p, -1, axis=0)
        cross = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
        area = 0.5 * cross.sum()
        centre = ((p + q) * cross[:, None]).sum(axis=0) / (6.0 * area)
        second = float((cross * (p * p + p * q + q * q).sum(axis=1)).sum()) / 12.0
        mass = self.density * self.depth * area
        inertia = self.density * self.depth * second - mass * float(centre @ centre)
        return float(mass), float(inertia), float(origin[0] + centre[0]), float(origin[1] + centre[1])

    @property
    def origin(self) -> tuple[float, float]:
        """Point of the block that its poses refer to [m]: its centroid; (0, 0) of a fixed block."""
        return (0.0, 0.0) if self.fixed else self.properties[2:]

    def side(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        """Ends of the side that starts at a vertex, in the order of the vertices [m], shape (2,) each."""
        return self.corners[number], self.corners[(number + 1) % len(self.corners)]

    @property
    def shape(self) -> Prism:
        """The polygon from its origin, in its thickness."""
        return Prism(self.polygon, self.depth)

    @property
    def place(self) -> tuple[float, float]:
        """Place of its origin [m]."""
        return self.origin

    @property
    def angle(self) -> float:
        """Of its axes as drawn [rad]."""
        return 0.0

    @property
    def placed(self) -> tuple[Placed, ...]:
        """Its one part where it stands in space."""
        x, z = self.origin
        return (Placed(self.shape, (x, 0.0, z)),)

    @property
    def lean(self) -> float:
        """Of the axes that its faces are told in [rad]."""
        return 0.0

    @property
    def outline(self) -> np.ndarray:
        """Corners as it stands [m], shape (k, 2)."""
        return self.corners

    @cached_property
    def polygon(self) -> np.ndarray:
        """Corners from its origin [m], shape (k, 2)."""
        return self.corners - self.origin

    @property
    def mass(self) -> float:
        """[kg]"""
        return self.properties[0]

    @property
    def inertia(self) -> float:
        """About the centroid [kg m²]."""
        return self.properties[1]


@lru_cache(maxsize=64)
def ground_block(level: float) -> Block:
    """The ground of a level [m], a half-plane, as a fixed block without ends."""
    far = FAR_AWAY
    return Block(((-far, level - far), (far, level - far), (far, level), (-far, level)), 0.0, "ground", fixed=True)


class FaceJoint(NamedTuple):
    """Two faces that touch: blocks by number, faces by the number of the vertex they start at."""

    lower: int
    upper: int
    lower_face: int
    upper_face: int
    law: Joint


def separation(a: np.ndarray, b: np.ndarray) -> float:
    """Largest distance between two convex polygons along a face normal [m]; negative: they overlap by that depth."""
    best = -math.inf
    for p, q in ((a, b), (b, a)):
        side = np.roll(p, -1, axis=0) - p
        normal = np.stack((side[:, 1], -side[:, 0]), axis=1) / np.hypot(side[:, 0], side[:, 1])[:, None]
        best = max(best, float(((q[None] - p[:, None]) @ normal[:, :, None]).min(axis=1).max()))
    return best


def touching_faces(a: np.ndarray, b: np.ndarray, near: float) -> tuple[int, int] | None:
    """Faces of two convex polygons that touch along most of their length, to a distance [m]; None if none do."""
    best, faces = 0.0, None
    for i in range(len(a)):
        p, along = a[i], a[(i + 1) % len(a)] - a[i]
        length = math.hypot(along[0], along[1])
        t = along / length
        for k in range(len(b)):
            q, r = b[k] - p, b[(k + 1) % len(b)] - p
            side = r - q
            if not side @ t < 0.0 or abs(t[0] * side[1] - t[1] * side[0]) > PARALLEL * math.hypot(*side):
                continue
            if max(abs(t[0] * q[1] - t[1] * q[0]), abs(t[0] * r[1] - t[1] * r[0])) > 2.0 * near:
                continue
            over = min(length, float(q @ t)) - max(0.0, float(r @ t))
            if over > max(best, near):
                best, faces = over, (i, k)
    return faces


def smallest_turn(a: np.ndarray, face: int, b: np.ndarray, other: int) -> float:
    """Smallest angle by which the outlines turn at the ends of two faces [rad]."""
    angles = []
    for corners, k in ((a, face), (b, other)):
        side = np.roll(corners, -1, axis=0) - corners
        for edge, next_edge in ((side[k - 1], side[k]), (side[k], side[(k + 1) % len(side)])):
            angles.append(math.atan2(edge[0] * next_edge[1] - edge[1] * next_edge[0], float(edge @ next_edge)))
    return min(angles)


def length_of(size: float) -> str:
    """A length for people [m]."""
    return f"{size:.3g} m" if size >= 1.0 else f"{1000.0 * size:.3g} mm"


def _without_flat(corners: np.ndarray) -> np.ndarray:
    """Corners without those at which the outline goes straight on."""
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    flat = (np.abs(turn) <= 1e-9 * np.hypot(*before.T) * np.hypot(*after.T)) & ((before * after).sum(axis=1) > 0.0)
    return corners[~flat]


def _area(corners: np.ndarray) -> float:
    p = corners - corners[0]
    q = np.roll(p, -1, axis=0)
    return 0.5 * float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum())
