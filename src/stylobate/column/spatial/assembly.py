"""Assemblies of stones in space: made, checked, and as models and statics want them."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import ClassVar

import numpy as np

from ...constants import g as STANDARD_GRAVITY
from ...errors import InputError, check_kind, check_range
from ..assembly import Assembly, check_fields
from ..block import FAR_AWAY, Block, ground_block, length_of
from ..column import GRAVITIES, Column
from ..joint import Joint, stated_fields
from ..links import link_from_dict
from ..links.link import Link
from ..links.placed import PlacedLink, in_numbers, place_between
from ..structure import Bed, Body, Structure
from .links import SpaceScene
from .placing import drums_in_space
from .stone import Stone
from .touching import TOUCHING, Overlap, Solid, SpaceJoint, overlap_of, overlaps, separation

#: Most bodies; what a body costs in a second of shaking, intact and once it is loose [s].
MOST, INTACT, LOOSE = 600, 0.02, 0.2

#: Bodies may overlap by this share of the smaller body's size: rounding, not geometry.
OVERLAPPING = 1e-6


@dataclass(frozen=True, eq=False, repr=False)
class SpatialAssembly(Structure):
    """Bodies in space, the law of their contacts, and the ground.

    Parameters
    ----------
    stones : sequence of Stone
    joint : Joint
        Law of all contacts, unless a body has its own.
    name : str
    gravity : float
        [m/s²]
    ground : float, optional
        Level of the ground, a half-space [m]; None for none (fixed bodies are the only support).
    overrides : sequence of (str, str, Joint)
        Laws between two bodies by their names.
    links : sequence of Link
        Clamps, dowels, bars, ties, cores, layers and pads ``between`` two bodies each; kept in numbers.
    settle : bool
        Whether it begins in equilibrium; False to begin as drawn, in the air and moving if need be.
    north : float, optional
        Bearing of the x axis, clockwise from north [degrees]; nothing is known of north where it is left out.

    Raises
    ------
    InputError
        Bodies overlap, lie in the ground, hang in the air or share a name, there are too many, or a link cannot be.
    """

    kind: ClassVar[str] = "assembly in space"
    joints_are: ClassVar[str] = "joint, in the assembly's order"
    computed_by: ClassVar[str] = "dem3d can, and its statics are 'stylobate limit'"
    like: ClassVar[str] = "assemblies"
    first: ClassVar[int] = 0
    relative: ClassVar[bool] = False
    scattered: ClassVar[tuple[str, ...]] = ("friction", "joint_stiffness", "density", "offset")

    stones: tuple[Stone, ...]
    joint: Joint
    name: str = "assembly"
    gravity: float = STANDARD_GRAVITY
    ground: float | None = 0.0
    overrides: tuple[tuple[str, str, Joint], ...] = ()
    settle: bool = True
    links: tuple[Link, ...] = ()
    north: float | None = None

    def __post_init__(self) -> None:
        check_fields(self, "stones", Stone)
        self._check_north()
        check_kind("settle", self.settle, bool, allowed="True or False")
        object.__setattr__(self, "links", in_numbers(self.links, self.name))
        if self.gravity != 0.0:
            check_range("gravity", self.gravity, *GRAVITIES, unit="m/s²", remedy="or 0")
        if self.ground is not None:
            check_range("level of the ground", self.ground, -FAR_AWAY, FAR_AWAY, unit="m")
        refuse_many(len(self.stones))
        names = [stone.name for stone in self.stones]
        double = next((name for name in names if names.count(name) > 1), None)
        if double is not None:
            raise InputError(f"two blocks are called {double!r}; give each a name of its own.")
        if "ground" in names and self.ground is not None:
            raise InputError("a block is called 'ground', which is the name of the ground; call it otherwise.")
        if not self.stones:
            raise InputError(f"{self.name!r} has no blocks; give one at least.")
        if all(stone.fixed for stone in self.stones):
            raise InputError(f"nothing of {self.name!r} can move; give a block that is not fixed.")
        laws = (self.joint, *(law for *_, law in self.overrides), *(stone.surface for stone in self.stones))
        if any(law is not None and law.ring_width is not None for law in laws):
            raise InputError(f"a joint of {self.name!r} has a ring_width, which assemblies do not know; leave it out.")
        self._check_overrides()
        for stone in self.stones:
            _check_parts(stone)
        if self.settle:
            self._refuse_moving()
            self._refuse_hanging()
        else:
            self._contacts  # noqa: B018  refuses bodies that overlap
        self.placed_links  # noqa: B018  refuses links that cannot be

    @classmethod
    def of_column(cls, column: Column) -> SpatialAssembly:
        """The drums of a column as stones, each with the law of the joint below it.

        Raises
        ------
        InputError
            Rings, tilts or a base out of level, which stones in space do not have.
        """
        if column.as_found.base_tilt:
            raise InputError(
                f"{column.name!r} stands on a base out of level, and the ground of an assembly is level; leave it out."
            )
        stones, links = drums_in_space(column)
        own = {"gravity": column.gravity, "links": tuple(links), "north": column.north}
        return cls(tuple(stones), column.joints[0], column.name, **own)

    def _refuse_moving(self) -> None:
        moving = next((stone for stone in self.stones if any(stone.velocity) or any(stone.angular_velocity)), None)
        if moving is not None:
            raise InputError(
                f"block {moving.name!r} of {self.name!r} moves at the start, and what settles is at rest; give "
                "settle = false.",
                "settle",
            )

    def _check_overrides(self) -> None:
        known, pairs = {body.name for body in self.bodies}, []
        for first, other, _ in self.overrides:
            missing = next((name for name in (first, other) if name not in known), None)
            if missing is not None:
                raise InputError(f"a joint_override names block {missing!r}, which does not exist; correct its name.")
            if first == other or {first, other} in pairs:
                raise InputError(
                    f"a joint_override names {first!r} and {other!r} twice; name two blocks, each pair once."
                )
            pairs.append({first, other})

    # -- what it consists of -------------------------------------------------------------------------------------------

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """The ground, if there is one, and the bodies."""
        return self.stones if self.ground is None else (ground_block(self.ground), *self.stones)

    @property
    def n(self) -> int:
        """Number of bodies, without the ground."""
        return len(self.stones)

    @property
    def space_joints(self) -> tuple[SpaceJoint, ...]:
        """Faces that lie on one another, bodies by their numbers in :attr:`bodies`."""
        return self._contacts[0]

    @property
    def beds(self) -> tuple[Bed, ...]:
        """The joints as where and how they carry."""
        beds = []
        for joint in self.space_joints:
            corners = joint.origin + joint.corners @ joint.frame[:, :2].T
            level, rise = float(joint.origin[2]), float(joint.frame[2, 2])
            whole = joint.round and not len(joint.edges.sides) and len(joint.edges.discs) == 1
            beds.append(Bed(joint.lower, joint.upper, rise, corners[:, :2], level, joint.area, joint.law, whole))
        return tuple(beds)

    @property
    def touching(self) -> tuple[tuple[int, int], ...]:
        """All pairs of bodies that touch, on faces or otherwise, by their numbers in :attr:`bodies`."""
        return self._contacts[1]

    @property
    def surfaces(self) -> tuple[Joint, ...]:
        """Of every body, the law of its contacts, other than joints, with those before it."""
        return tuple(getattr(body, "surface", None) or self.joint for body in self.bodies)

    @property
    def laws_of_pairs(self) -> tuple[tuple[int, int, Joint], ...]:
        """Overrides, and of what is linked what the links make of it, by the numbers of their bodies."""
        numbers = {body.name: i for i, body in enumerate(self.bodies)}
        pairs = {tuple(sorted((numbers[first], numbers[other]))) for first, other, _ in self.overrides}
        linked = {(min(link.lower, link.upper), max(link.lower, link.upper)) for link in self.placed_links}
        return tuple((i, k, self.law_between(i, k)) for i, k in sorted(pairs | linked))

    def law_between(self, lower: int, upper: int) -> Joint:
        """Law of the contacts of two bodies by number, the second of which comes later; with what lies between them."""
        first, other = (self.bodies[i].name for i in (lower, upper))
        law = self._overridden.get(frozenset((first, other))) or self.surfaces[upper]
        return self.with_links_between(first, other, law)

    @cached_property
    def _overridden(self) -> dict[frozenset[str], Joint]:
        return {frozenset((first, other)): law for first, other, law in self.overrides}

    @cached_property
    def placed_links(self) -> tuple[PlacedLink, ...]:
        """All links in numbers, in their order."""
        solids = self.solids if self.ground is None else ((), *self.solids)
        scene = SpaceScene(self.bodies, self.space_joints, solids, self.ground)
        return place_between(scene, self.links, self.name)

    @cached_property
    def solids(self) -> tuple[tuple[Solid, ...], ...]:
        """Of every stone its parts as they stand."""
        return tuple(tuple(Solid(part) for part in stone.placed) for stone in self.stones)

    @property
    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest corner of the box around everything that can move [m], shape (3,) each."""
        moving_parts = [
            part for stone, parts in zip(self.stones, self.solids, strict=True) if not stone.fixed for part in parts
        ]
        return np.min([part.low for part in moving_parts], axis=0), np.max([part.high for part in moving_parts], axis=0)

    @cached_property
    def _contacts(self) -> tuple[tuple[SpaceJoint, ...], tuple[tuple[int, int], ...]]:
        """Faces that lie on one another, and all pairs of bodies that touch."""
        joints: list[SpaceJoint] = []
        pairs: list[tuple[int, int]] = []
        first = len(self.bodies) - len(self.stones)
        if first:
            for i, parts in enumerate(self.solids):
                self._on_ground(i, parts, joints, pairs)
        low = np.array([np.min([part.low for part in parts], axis=0) for parts in self.solids])
        high = np.array([np.max([part.high for part in parts], axis=0) for parts in self.solids])
        size = (high - low).max(axis=1)
        for i, stone in enumerate(self.stones):
            near = TOUCHING * np.minimum(size[i], size[i + 1 :])[:, None]
            close = ((low[i] <= high[i + 1 :] + near) & (low[i + 1 :] <= high[i] + near)).all(axis=1)
            for k in (i + 1 + np.flatnonzero(close)).tolist():
                if stone.fixed and self.stones[k].fixed:
                    continue
                met = self._between(i, k, float(near[k - i - 1, 0]), joints, first)
                if met:
                    pairs.append((first + i, first + k))
        return tuple(joints), tuple(pairs)

    def _between(self, i: int, k: int, near: float, joints: list[SpaceJoint], first: int) -> bool:
        """Whether two stones touch; with their joints."""
        met = False
        for a, solid in enumerate(self.solids[i]):
            for b, other in enumerate(self.solids[k]):
                gap, _ = separation(solid, other, near)
                if gap < -OVERLAPPING * min(solid.size, other.size):
                    names = f"block {self.stones[k].name!r} and block {self.stones[i].name!r}"
                    raise InputError(f"{names} overlap by {length_of(-gap)}; move one of them or correct its sizes.")
                if gap > near:
                    continue
                met = True
                law = self.law_between(first + i, first + k)
                for below, above, over in overlaps(solid, other, near):
                    joints.append(SpaceJoint(first + i, first + k, a, b, law, below, above, *over))
        return met

    def _on_ground(
        self, i: int, parts: tuple[Solid, ...], joints: list[SpaceJoint], pairs: list[tuple[int, int]]
    ) -> None:
        """Refuse a body in the ground; its joints with it."""
        assert self.ground is not None
        if self.stones[i].fixed:
            return
        for number, part in enumerate(parts):
            gap, near = float(part.low[2]) - self.ground, TOUCHING * part.size
            if gap < -OVERLAPPING * part.size:
                name = self.stones[i].name
                raise InputError(
                    f"block {name!r} lies in the ground by {length_of(-gap)}; move it or correct its sizes."
                )
            if gap > near:
                continue
            pairs.append((0, i + 1))
            law = self.law_between(0, i + 1)
            for face in part.faces:
                flat = face.frame[2, 2] < -np.cos(1e-4) and abs(float(face.middle[2]) - self.ground) <= 2.0 * near
                over: Overlap | None = overlap_of(None, face, near) if flat else None
                if over is not None:
                    joints.append(SpaceJoint(0, i + 1, 0, number, law, face, face, *over))

    # -- what cannot begin -----------------------------------------------------------------------------------------------

    def _refuse_hanging(self) -> None:
        """Refuse bodies that nothing carries down to the ground or to a fixed body."""
        supported = {i for i, body in enumerate(self.bodies) if body.fixed}
        pairs, more = self._contacts[1], True
        while more:
            reached = {b for pair in pairs for b in pair if supported & set(pair)} - supported
            supported, more = supported | reached, bool(reached)
        first = len(self.bodies) - len(self.stones)
        hanging = [i for i in range(len(self.stones)) if first + i not in supported]
        if not hanging:
            return
        lowest = min(hanging, key=lambda i: min(float(part.low[2]) for part in self.solids[i]))
        over = self._height_over(lowest, [i for i in range(len(self.stones)) if first + i in supported])
        others = f", and {len(hanging) - 1} more with it" if len(hanging) > 1 else ""
        raise InputError(
            f"block {self.stones[lowest].name!r} hangs in the air{over}{others}; put it down, or let it fall with "
            "settle = false."
        )

    def _height_over(self, i: int, supported: list[int]) -> str:
        """How far a body hangs over what is nearest under it, in words."""
        best = (
            [] if self.ground is None else [(float(min(p.low[2] for p in self.solids[i])) - self.ground, "the ground")]
        )
        for k in supported:
            gaps = [separation(a, b, np.inf)[0] for a in self.solids[i] for b in self.solids[k]]
            best.append((max(min(gaps), 0.0), f"block {self.stones[k].name!r}"))
        if not best:
            return ""
        gap, name = min(best)
        return f", {length_of(gap)} from {name}"

    # -- provenance ----------------------------------------------------------------------------------------------------

    def to_dict(self) -> dict:
        """Everything that defines it, as plain values in SI units."""
        more = {"links": [link.to_dict() for link in self.links] or None, "north": self.north}
        return {
            "stones": [stone.to_dict() for stone in self.stones],
            "joint": stated_fields(self.joint),
            "name": self.name,
            "gravity": self.gravity,
            "ground": self.ground,
            "overrides": [[first, other, stated_fields(law)] for first, other, law in self.overrides],
            "settle": self.settle,
        } | {key: value for key, value in more.items() if value is not None}

    @classmethod
    def from_dict(cls, data: dict) -> SpatialAssembly:
        """The assembly that :meth:`to_dict` has written."""
        special = {
            "links": tuple(link_from_dict(fields) for fields in data.get("links", ())),
            "stones": tuple(Stone.from_dict(stone) for stone in data["stones"]),
            "joint": Joint(**data["joint"]),
            "overrides": tuple((first, other, Joint(**law)) for first, other, law in data["overrides"]),
        }
        return cls(**(dict(data) | special))


def refuse_many(bodies: int) -> None:
    """Refuse more bodies than can be computed, with what they would take.

    Raises
    ------
    InputError
    """
    if bodies > MOST:
        minutes = 10.0 * bodies / 60.0
        raise InputError(
            f"{bodies} bodies would take about {minutes * INTACT:.0f} minutes for ten seconds of shaking while they stand "
            f"and {minutes * LOOSE:.0f} once they are loose, each of many runs; allowed are up to {MOST}: take a part of it."
        )


def _check_parts(stone: Stone) -> None:
    """Refuse parts of a body that overlap, which would count twice, or that do not hang together."""
    solids = [Solid(part) for part in stone.pieces]
    joined = {0} if solids else set()
    gaps = {}
    for i, k in combinations(range(len(solids)), 2):
        small = min(solids[i].size, solids[k].size)
        gap = gaps[i, k] = separation(solids[i], solids[k], TOUCHING * small)[0] / small
        if gap < -OVERLAPPING:
            raise InputError(
                f"parts {i + 1} and {k + 1} of block {stone.name!r} overlap by {length_of(-gap * small)}, which would "
                "count twice; let them touch."
            )
    while True:
        more = {b for pair, gap in gaps.items() if gap <= TOUCHING and joined & set(pair) for b in pair} - joined
        if not more:
            break
        joined |= more
    apart = next((i for i in range(len(solids)) if i not in joined), None)
    if apart is not None:
        raise InputError(
            f"part {apart + 1} of block {stone.name!r} touches no other part of it; make it a block of its own."
        )


# -- An assembly of the plane in space --------------------------------------------------------------------------------


def in_space(structure: Structure) -> Structure:
    """What stands in space: an assembly of the plane as prisms, anything else itself."""
    return as_prisms(structure) if isinstance(structure, Assembly) else structure


def as_prisms(assembly: Assembly, depth: float | None = None) -> SpatialAssembly:
    """The same blocks in space, x along the plane and z up.

    Parameters
    ----------
    assembly : Assembly
    depth : float, optional
        Of all blocks, along y [m]; each its own by default.

    Raises
    ------
    InputError
        It has links, or blocks that are no prisms; or the stones cannot stand in space.
    """
    if assembly.links:
        raise InputError(
            f"{assembly.name!r} has links, which are placed in the plane; write it in space, its blocks as box = [x, y, z]."
        )
    stones = tuple(_prism(block, depth) for block in assembly.blocks)
    return SpatialAssembly(
        stones, assembly.joint, assembly.name, assembly.gravity, assembly.ground, overrides=assembly.overrides
    )


def _prism(block: Block, depth: float | None) -> Stone:
    prism = dataclasses.replace(block, solid=None)
    if not np.allclose((prism.mass, *prism.place), (block.mass, *block.place), rtol=1e-9, atol=1e-9):
        raise InputError(
            f"{block.name!r} is no prism of its outline, as a round drum is none; write the assembly in space, where "
            "columns are round."
        )
    half = 0.5 * (block.depth if depth is None else depth)
    corners = [(x, y, z) for x, z in block.vertices for y in (-half, half)]
    return Stone.hull(corners, block.density, name=block.name, fixed=block.fixed, surface=block.surface)
