"""An assembly: any set of convex blocks in the plane, with dry joints where faces touch, on a ground or fixed blocks."""

from __future__ import annotations

import hashlib
import json
import math
import warnings
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError, OutOfRangeWarning, check_range
from .block_links import BlockLink
from .column import GRAVITIES
from .drum import DENSITIES, LENGTHS
from .joint import Joint, without_unsaid
from .placed_links import PlacedLink, placed_links

MAX_BLOCKS = 400

MAX_VERTICES = 24

#: Faces touch when they are this close, as a share of the smaller block's size, and parallel to this angle [rad].
TOUCHING, PARALLEL = 1e-5, 1e-4

#: Faces beside which the outline turns by less than this make no joint: the next faces touch too soon [rad].
FLATTEST = math.radians(5.0)

#: Blocks may overlap by this share of the smaller block's size: rounding, not geometry.
OVERLAPPING = 1e-7

#: Half width and depth of the ground, far enough to be a half-plane [m].
FAR_AWAY = 1.0e4


@dataclass(frozen=True)
class Block:
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
        who = f"block {self.name!r}"
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
            warnings.warn(
                f"the vertices of {who} run clockwise; they are turned round.", OutOfRangeWarning, stacklevel=3
            )
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

    @property
    def size(self) -> float:
        """Larger side of the box around the block [m]."""
        return float(np.ptp(self.corners, axis=0).max())

    @property
    def thickness(self) -> float:
        """Smallest distance between two parallels that hold the block [m]."""
        side = np.roll(self.corners, -1, axis=0) - self.corners
        inward = np.stack((-side[:, 1], side[:, 0]), axis=1) / np.hypot(side[:, 0], side[:, 1])[:, None]
        return float(((self.corners[None] - self.corners[:, None]) @ inward[:, :, None]).max(axis=1).min())


class FaceJoint(NamedTuple):
    """Two faces that touch: blocks by number, faces by the number of the vertex they start at."""

    lower: int
    upper: int
    lower_face: int
    upper_face: int
    law: Joint


@dataclass(frozen=True)
class Assembly:
    """Blocks, the law of their contacts, and the ground.

    Parameters
    ----------
    blocks : sequence of Block
    joint : Joint
        Law of all contacts, unless a block has its own.
    name : str
    gravity : float
        [m/s²]
    ground : float, optional
        Level of the ground, a half-plane [m]; None for none (fixed blocks are the only support).
    overrides : sequence of (str, str, Joint)
        Laws between two blocks by their names, of their joint and wherever else they strike each other.
    links : sequence of BlockLink
        Clamps, dowels, bars, ties, cores and layers between two bodies each; :func:`.block_links.block_link` makes them.

    Raises
    ------
    InputError
        Blocks overlap, lie in the ground, share a name, none of them can move, or a link cannot be.

    Warns
    -----
    OutOfRangeWarning
        A block touches nothing: it will fall.
    """

    blocks: tuple[Block, ...]
    joint: Joint
    name: str = "assembly"
    gravity: float = STANDARD_GRAVITY
    ground: float | None = 0.0
    overrides: tuple[tuple[str, str, Joint], ...] = ()
    links: tuple[BlockLink, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "blocks", tuple(self.blocks))
        object.__setattr__(self, "overrides", tuple(self.overrides))
        object.__setattr__(self, "links", tuple(self.links))
        if self.gravity != 0.0:
            check_range("gravity", self.gravity, *GRAVITIES, unit="m/s²", remedy="or 0")
        if self.ground is not None:
            check_range("level of the ground", self.ground, -FAR_AWAY, FAR_AWAY, unit="m")
        if not 1 <= len(self.blocks) <= MAX_BLOCKS:
            raise InputError(f"the assembly has {len(self.blocks)} blocks; allowed is 1 to {MAX_BLOCKS}.")
        names = [block.name for block in self.blocks]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise InputError(f"two blocks are called {twice!r}; give every block a name of its own.")
        if all(block.fixed for block in self.blocks):
            raise InputError(f"no block of {self.name!r} can move; leave fixed = true out for at least one.")
        laws = (self.joint, *(law for *_, law in self.overrides), *(block.surface for block in self.blocks))
        if any(law is not None and law.ring_width is not None for law in laws):
            raise InputError(
                f"a joint of {self.name!r} has a ring_width, and rings are those of round drums; leave it out."
            )
        pairs = [frozenset((one, other)) for one, other, _ in self.overrides]
        known = {block.name for block in self.bodies}
        for (one, other, _), pair in zip(self.overrides, pairs, strict=True):
            missing = next((name for name in (one, other) if name not in known), None)
            if missing is not None:
                raise InputError(f"a joint_override names block {missing!r}, which does not exist; correct its name.")
            if len(pair) == 1 or pairs.count(pair) > 1:
                raise InputError(
                    f"a joint_override names {one!r} and {other!r} twice; name two blocks, each pair once."
                )
        touched = self._contacts[1]
        for i, block in enumerate(self.bodies):
            if not block.fixed and i not in touched:
                warnings.warn(f"block {block.name!r} touches nothing: it will fall.", OutOfRangeWarning, stacklevel=3)
        self.link_properties  # noqa: B018  refuses links that cannot be

    @cached_property
    def link_properties(self) -> tuple[PlacedLink, ...]:
        """All links in numbers, in their order."""
        return placed_links(self)

    def law_between(self, one: Block, other: Block) -> Joint:
        """Law of the contacts of two bodies, the second of which comes later; a layer between them has its own friction."""
        law = self._laws.get(frozenset((one.name, other.name))) or other.surface or self.joint
        slippery = self._layers.get(frozenset((one.name, other.name)))
        if slippery is None:
            return law
        return replace(law, friction_angle=None, friction_coefficient=slippery)

    @cached_property
    def _laws(self) -> dict[frozenset[str], Joint]:
        return {frozenset((one, other)): law for one, other, law in self.overrides}

    @cached_property
    def _layers(self) -> dict[frozenset[str], float]:
        return {
            frozenset(one.between): one.friction_coefficient
            for one in self.links
            if one.friction_coefficient is not None
        }

    @cached_property
    def bodies(self) -> tuple[Block, ...]:
        """The ground, if there is one, and the blocks."""
        if self.ground is None:
            return self.blocks
        far, top = FAR_AWAY, self.ground
        box = ((-far, top - far), (far, top - far), (far, top), (-far, top))
        return (Block(box, 0.0, "ground", fixed=True), *self.blocks)

    @property
    def n(self) -> int:
        """Number of blocks."""
        return len(self.blocks)

    @property
    def joints(self) -> tuple[FaceJoint, ...]:
        """Pairs of faces that touch."""
        return self._contacts[0]

    @cached_property
    def _contacts(self) -> tuple[tuple[FaceJoint, ...], set[int]]:
        """Pairs of faces that touch, and all bodies that touch another one."""
        bodies = self.bodies
        low = np.array([block.corners.min(axis=0) for block in bodies])
        high = np.array([block.corners.max(axis=0) for block in bodies])
        found: list[FaceJoint] = []
        leaning: set[int] = set()
        for i, a in enumerate(bodies):
            for j in range(i + 1, len(bodies)):
                b = bodies[j]
                near = TOUCHING * min(a.size, b.size)
                if (a.fixed and b.fixed) or (low[i] > high[j] + near).any() or (low[j] > high[i] + near).any():
                    continue
                gap = separation(a.corners, b.corners)
                if gap < -OVERLAPPING * min(a.size, b.size) - 1e-15 * max(np.abs(b.corners).max(), 1.0):
                    where = "lies in the ground" if a.name == "ground" else f"and block {a.name!r} overlap"
                    raise InputError(
                        f"block {b.name!r} {where} by {1000.0 * -gap:.3g} mm; move one of them or correct its vertices."
                    )
                if gap > near:
                    continue
                leaning |= {i, j}
                faces = _touching_faces(a.corners, b.corners, near)
                if faces is not None and smallest_turn(a.corners, faces[0], b.corners, faces[1]) > FLATTEST:
                    found.append(FaceJoint(i, j, *faces, self.law_between(a, b)))
        return tuple(found), leaning

    def to_dict(self) -> dict:
        """Everything that defines the assembly, as plain values in SI units."""
        plain = asdict(self, dict_factory=without_unsaid)
        plain.pop("links")
        return plain | ({"links": [link.to_dict() for link in self.links]} if self.links else {})

    @property
    def frequency_parameter(self) -> float:
        """p = √(3g/4R) [1/s], R half the diagonal of the box around all blocks that move: the slowest that could rock."""
        corners = np.concatenate([block.corners for block in self.blocks if not block.fixed])
        return math.sqrt(0.75 * self.gravity / (0.5 * math.hypot(*np.ptp(corners, axis=0))))

    @property
    def digest(self) -> str:
        """SHA-256 of :meth:`to_dict`."""
        return hashlib.sha256(json.dumps(self.to_dict(), sort_keys=True).encode()).hexdigest()


def separation(a: np.ndarray, b: np.ndarray) -> float:
    """Largest distance between two convex polygons along a face normal [m]; negative: they overlap by that depth."""
    best = -math.inf
    for p, q in ((a, b), (b, a)):
        side = np.roll(p, -1, axis=0) - p
        normal = np.stack((side[:, 1], -side[:, 0]), axis=1) / np.hypot(side[:, 0], side[:, 1])[:, None]
        best = max(best, float(((q[None] - p[:, None]) @ normal[:, :, None]).min(axis=1).max()))
    return best


def _touching_faces(a: np.ndarray, b: np.ndarray, near: float) -> tuple[int, int] | None:
    best, found = 0.0, None
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
                best, found = over, (i, k)
    return found


def smallest_turn(a: np.ndarray, face: int, b: np.ndarray, other: int) -> float:
    """Smallest angle by which the outlines turn at the ends of two faces [rad]."""
    angles = []
    for corners, k in ((a, face), (b, other)):
        side = np.roll(corners, -1, axis=0) - corners
        for one, next_one in ((side[k - 1], side[k]), (side[k], side[(k + 1) % len(side)])):
            angles.append(math.atan2(one[0] * next_one[1] - one[1] * next_one[0], float(one @ next_one)))
    return min(angles)


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
