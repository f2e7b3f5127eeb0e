"""Assemblies of blocks in the plane, such as portals, lintels and arches: made, checked, as models and statics want them."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError, as_typed, check_all, check_kind, check_name, check_range, warn
from ..messages import say
from .block import (
    FAR_AWAY,
    TOUCHING,
    Block,
    FaceJoint,
    ground_block,
    length_of,
    separation,
    smallest_turn,
    touching_faces,
)
from .column import GRAVITIES
from .joint import Joint, stated_fields
from .links.link import Link
from .links.placed import PlacedLink, Scene, in_numbers, place_between
from .structure import Bed, FacePair, Structure, face_between


def check_fields(assembly: Any, bodies: str, kind: type) -> None:
    """Refuse what is no body, link, override or law; bodies, links and overrides are tuples afterwards.

    Parameters
    ----------
    assembly : Assembly or SpatialAssembly
    bodies : str
        Name of the field of its bodies.
    kind : type
        Of these.

    Raises
    ------
    InputError
    """
    for name, each in ((bodies, kind), ("links", Link)):
        object.__setattr__(assembly, name, tuple(check_all(name, getattr(assembly, name), each)))
    object.__setattr__(assembly, "overrides", tuple(check_kind("overrides", assembly.overrides, (tuple, list))))
    for override in assembly.overrides:
        kinds = (str, str, Joint)
        if not isinstance(override, (tuple, list)) or len(override) != 3 or not all(map(isinstance, override, kinds)):
            raise InputError(f"an override is {as_typed(override)}; allowed is (name, name, Joint), of two blocks.")
    check_kind("joint", assembly.joint, Joint)
    check_name("the name of an assembly", assembly.name)


# -- An assembly ------------------------------------------------------------------------------------------------------


MAX_BLOCKS = 400

#: Faces beside which the outline turns by less than this make no joint: the next faces touch too soon [rad].
FLATTEST = math.radians(5.0)

#: Blocks may overlap by this share of the smaller block's size: rounding, not geometry.
OVERLAPPING = 1e-7


@dataclass(frozen=True, repr=False)
class Assembly(Structure):
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
    links : sequence of Link
        Clamps, dowels, bars, ties, cores, layers and pads ``between`` two bodies each; kept in numbers.
    north : float, optional
        Bearing of the x axis, clockwise from north [degrees]; nothing is known of north where it is left out.

    Raises
    ------
    InputError
        Blocks overlap, lie in the ground, share a name, none of them can move, or a link cannot be.

    Warns
    -----
    OutOfRangeWarning
        A block touches nothing: it will fall.
    """

    kind: ClassVar[str] = "assembly"
    joints_are: ClassVar[str] = "joint, in the assembly's order"
    computed_by: ClassVar[str] = "dem2d (DistinctElement2D) can"
    first: ClassVar[int] = 0
    relative: ClassVar[bool] = False

    blocks: tuple[Block, ...]
    joint: Joint
    name: str = "assembly"
    gravity: float = STANDARD_GRAVITY
    ground: float | None = 0.0
    overrides: tuple[tuple[str, str, Joint], ...] = ()
    links: tuple[Link, ...] = ()
    north: float | None = None

    def __post_init__(self) -> None:
        check_fields(self, "blocks", Block)
        self._check_north()
        object.__setattr__(self, "links", in_numbers(self.links, self.name))
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
        pairs = [frozenset((block, other)) for block, other, _ in self.overrides]
        known = {block.name for block in self.bodies}
        for (first, other, _), pair in zip(self.overrides, pairs, strict=True):
            missing = next((name for name in (first, other) if name not in known), None)
            if missing is not None:
                raise InputError(f"a joint_override names block {missing!r}, which does not exist; correct its name.")
            if len(pair) == 1 or pairs.count(pair) > 1:
                raise InputError(
                    f"a joint_override names {first!r} and {other!r} twice; name two blocks, each pair once."
                )
        touched = self._contacts[1]
        for i, block in enumerate(self.bodies):
            if not block.fixed and i not in touched:
                warn(say("block {block.name!r} touches nothing: it will fall.", block=block))
        self.placed_links  # noqa: B018  refuses links that cannot be

    @cached_property
    def placed_links(self) -> tuple[PlacedLink, ...]:
        """All links in numbers, in their order."""
        return place_between(Scene(self.bodies, self.joints), self.links, self.name)

    def law_between(self, block: Block, other: Block) -> Joint:
        """Law of the contacts of two bodies, the second of which comes later; with what lies between them."""
        law = self._laws.get(frozenset((block.name, other.name))) or other.surface or self.joint
        return self.with_links_between(block.name, other.name, law)

    @cached_property
    def _laws(self) -> dict[frozenset[str], Joint]:
        return {frozenset((first, other)): law for first, other, law in self.overrides}

    @cached_property
    def bodies(self) -> tuple[Block, ...]:
        """The ground, if there is one, and the blocks."""
        if self.ground is None:
            return self.blocks
        return (ground_block(self.ground), *self.blocks)

    @property
    def n(self) -> int:
        """Number of blocks."""
        return len(self.blocks)

    @property
    def joints(self) -> tuple[FaceJoint, ...]:
        """Pairs of faces that touch."""
        return self._contacts[0]

    @cached_property
    def face_pairs(self) -> tuple[FacePair, ...]:
        """The joints, each as wide as the thinner of its bodies is deep; a fixed one is as deep as the other."""
        return tuple(self._faces(joint) for joint in self.joints)

    def _faces(self, joint: FaceJoint) -> FacePair:
        lower, upper = self.bodies[joint.lower], self.bodies[joint.upper]
        # the lower body's face runs against its own direction, the upper one's along: both left to right, normal upward
        right, left = lower.side(joint.lower_face)
        below = face_between(left, right, lower.origin, upper=True)
        left, right = upper.side(joint.upper_face)
        above = face_between(left, right, upper.origin, upper=False)
        area = min(block.depth for block in (lower, upper) if not block.fixed)
        sides = joint.lower_face, joint.upper_face
        return FacePair(joint.lower, joint.upper, below, above, joint.law, area, 1.0, sides)

    @property
    def beds(self) -> tuple[Bed, ...]:
        """The joints as where and how they carry."""
        return tuple(self._bed(*pair) for pair in zip(self.joints, self.face_pairs, strict=True))

    def _bed(self, joint: FaceJoint, pair: FacePair) -> Bed:
        right, left = self.bodies[joint.lower].side(joint.lower_face)
        way = (right - left) / np.hypot(*(right - left))
        above = [float((end - left) @ way) for end in self.bodies[joint.upper].side(joint.upper_face)]
        ends = np.array([max(0.0, min(above)), min(float((right - left) @ way), max(above))])
        over = left + ends[:, None] * way
        area = float(np.ptp(ends)) * pair.area / pair.width
        return Bed(pair.lower, pair.upper, float(way[0]), over[:, :1], float(over[:, 1].mean()), area, pair.law)

    @property
    def surfaces(self) -> tuple[Joint, ...]:
        """Of every body, the law of its contacts, other than joints, with those before it."""
        return tuple(block.surface or self.joint for block in self.bodies)

    @property
    def laws_of_pairs(self) -> tuple[tuple[int, int, Joint], ...]:
        """Other laws of such contacts: overrides, and of what is linked what the links make of it."""
        numbers = {block.name: i for i, block in enumerate(self.bodies)}
        overrides = [(numbers[first], numbers[other], law) for first, other, law in self.overrides]
        laws = [(min(i, h), max(i, h), law) for i, h, law in overrides]
        for link in self.placed_links:
            i, h = sorted((link.lower, link.upper))
            laws.append((i, h, self.law_between(self.bodies[i], self.bodies[h])))
        return tuple(laws)

    @cached_property
    def _contacts(self) -> tuple[tuple[FaceJoint, ...], set[int]]:
        """Pairs of faces that touch, and all bodies that touch another one."""
        bodies = self.bodies
        low = np.array([block.corners.min(axis=0) for block in bodies])
        high = np.array([block.corners.max(axis=0) for block in bodies])
        face_joints: list[FaceJoint] = []
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
                        f"block {b.name!r} {where} by {length_of(-gap)}; move one of them or correct its vertices."
                    )
                if gap > near:
                    continue
                leaning |= {i, j}
                faces = touching_faces(a.corners, b.corners, near)
                if faces is not None and smallest_turn(a.corners, faces[0], b.corners, faces[1]) > FLATTEST:
                    face_joints.append(FaceJoint(i, j, *faces, self.law_between(a, b)))
        return tuple(face_joints), leaning

    def to_dict(self) -> dict:
        """Everything that defines the assembly, as plain values in SI units."""
        plain = {name: value for name, value in stated_fields(self).items() if name != "links"}
        plain["blocks"] = [{"surface": None, "solid": None} | stated_fields(block) for block in self.blocks]
        return json.loads(json.dumps(plain, default=stated_fields)) | (  # lists for tuples, as a file gives them back
            {"links": [link.to_dict() for link in self.links]} if self.links else {}
        )
