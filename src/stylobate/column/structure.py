"""What stands, whatever it was written down as: bodies, the faces at which they are joined, and what is around them."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from .. import notebook
from ..constants import g
from ..errors import InputError, check_range
from ..messages import say
from .as_found import AS_BUILT, AsFound
from .joint import Joint
from .links.link import Link, Numbers
from .links.placed import PlacedLink
from .shapes import Glued, Outlined, Placed, Shape, about, hull, quaternion_of


class Face(NamedTuple):
    """A face, in axes along the lower face of its body if that is a drum, in those in which it is drawn if it is a block.

    ``direction`` (cosine and sine) runs to the right with the joint's normal upward, ``height`` is from the body's centroid
    along that normal, without its sign; ``left`` and ``right`` are how far the ends are from the centroid's foot [m].
    """

    direction: tuple[float, float]
    height: float
    left: float
    right: float

    @property
    def width(self) -> float:
        """[m]"""
        return self.left + self.right


class FacePair(NamedTuple):
    """A joint: the upper face of the body ``lower`` and the lower face of the body ``upper``, by their numbers.

    ``area`` [m²] is that of the contact over a ``width`` [m] of it, so that stiffnesses per area become those per width.
    ``sides`` are the faces among the sides of the polygons of the two bodies, by the number of the corner they start at.
    """

    lower: int
    upper: int
    below: Face
    above: Face
    law: Joint
    area: float
    width: float
    sides: tuple[int, int]


def face_between(left: np.ndarray, right: np.ndarray, origin: tuple[float, float], *, upper: bool) -> Face:
    """The face between two points of a body as it stands [m], shape (2,), from the left to the right one.

    Parameters
    ----------
    left, right : array
    origin : (float, float)
        Of the body [m].
    upper : bool
        Whether it is the upper face of its body.
    """
    length = math.hypot(*(right - left))
    t, foot = (right - left) / length, left - origin
    height, before = float(foot[1] * t[0] - foot[0] * t[1]), -float(foot @ t)
    return Face((float(t[0]), float(t[1])), height if upper else -height, before, length - before)


class Bed(NamedTuple):
    """Faces that lie on one another.

    Parameters
    ----------
    lower, upper : int
        Bodies by number.
    rise : float
        Upward component of the unit normal from the one into the other [-].
    corners : array
        In plan; of a plane along it [m], shape (k, 1 or 2).
    level : float
        Height of the faces [m].
    area : float
        [m²]
    law : Joint
    round : bool
        Whether a circle bounds it.
    """

    lower: int
    upper: int
    rise: float
    corners: np.ndarray
    level: float
    area: float
    law: Joint
    round: bool = False


# -- What a structure says of itself ----------------------------------------------------------------------------------


def described(structure: Any) -> str:
    """What a structure is, in a sentence or two: bodies, size and mass."""
    moving = [body for body in structure.bodies if not body.fixed]
    mass = sum(body.mass for body in moving)
    links = f" with {_number(len(structure.placed_links), ('link', 'links'))}" if structure.placed_links else ""
    state_words = ", as found" if structure.as_found else ""
    text = f"{structure.name}: {structure.described} of {_number(len(moving), structure.counted)}{links}{state_words}, "
    text += f"{structure.height:g} m high, {mass / 1e3:.4g} t."
    if structure.slenderness is not None and structure.frequency_parameter is not None:
        text += f" Slenderness {structure.slenderness:.3f} rad, p = {structure.frequency_parameter:.3f} rad/s."
    if structure.uplift_acceleration is not None:
        text += f" A steady {structure.uplift_acceleration / g:.3f} g opens the first joint."
    return text


def as_html(structure: Any) -> str:
    """The same with its silhouette, as HTML."""
    shapes = [(body.corners, False) for body in structure.bodies if not body.fixed]
    return notebook.page(structure.name, described(structure), {}, notebook.silhouettes([shapes], [""]))


def _number(count: int, of: tuple[str, str]) -> str:
    return f"{count} {of[count != 1]}"


# -- Structures that can be shaken ------------------------------------------------------------------------------------


#: Corners by which round faces are measured.
AROUND = 720


class Body(Protocol):
    """A rigid body as it stands, in axes along and normal to the base, from the middle of what it stands on.

    ``shape`` is in its own axes, from its centroid, which stands at ``place`` (x, z) [m]; ``angle`` is the inclination of
    these axes to the base, counter-clockwise [rad]. ``mass`` [kg], ``inertia`` about the centroid in the plane [kg m²].
    What is ``fixed`` moves with the ground: it has neither, and its origin is that of space. ``corners`` is its outline seen
    along y, horizontally and upward [m], shape (k, 2).

    What is in contact in the plane is ``polygon``, its corners counter-clockwise from its place, in the axes in which its
    faces are told; they are inclined to the base by ``lean`` [rad]. ``outline`` is the same as it stands, along and normal
    to the base; ``sides`` are those of the box around it as it stands, ``size`` is the largest of them, and ``thickness``
    the smallest distance of two parallels that hold it [m]. ``placed`` are its convex parts where they stand in space.
    """

    @property
    def name(self) -> str: ...
    @property
    def shape(self) -> Shape: ...
    @property
    def mass(self) -> float: ...
    @property
    def inertia(self) -> float: ...
    @property
    def place(self) -> tuple[float, float]: ...
    @property
    def angle(self) -> float: ...
    @property
    def fixed(self) -> bool: ...
    @cached_property
    def corners(self) -> np.ndarray: ...
    @property
    def lean(self) -> float: ...
    @cached_property
    def polygon(self) -> np.ndarray: ...
    @property
    def outline(self) -> np.ndarray: ...
    @property
    def sides(self) -> tuple[float, ...]: ...
    @property
    def size(self) -> float: ...
    @property
    def thickness(self) -> float: ...
    @property
    def placed(self) -> tuple[Placed, ...]: ...


@dataclass(frozen=True, eq=False)
class Standing(Outlined):
    """A body that can move; see :class:`Body`.

    Parameters
    ----------
    name : str
    shape : Shape
    mass, inertia : float
        [kg], [kg m²]
    place : (float, float)
        [m]
    angle : float
        [rad]
    slope : float
        Of the base in the plane, counter-clockwise [rad].
    lean : float
        Of the axes that its faces are told in [rad].
    in_space : (array, array), optional
        Centroid [m] and axes as columns, in axes of which z is upward, of a body that leans out of the plane.
    """

    name: str
    shape: Shape
    mass: float
    inertia: float
    place: tuple[float, float]
    angle: float = 0.0
    slope: float = 0.0
    lean: float = 0.0
    in_space: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def fixed(self) -> bool:
        """Whether it moves with the ground: no."""
        return False

    @cached_property
    def corners(self) -> np.ndarray:
        """Outline as it stands, seen along y [m], shape (k, 2)."""
        if self.in_space is not None:
            centroid, axes = self.in_space
            return hull((self.shape.mesh().vertices @ axes.T + centroid)[:, [0, 2]])
        return self.shape.outline @ _turn(self.slope + self.angle) + np.array(self.place) @ _turn(self.slope)

    @cached_property
    def polygon(self) -> np.ndarray:
        """Corners from its place, in these axes [m], shape (k, 2)."""
        return self.shape.outline

    @property
    def placed(self) -> tuple[Placed, ...]:
        """Its one part where it stands in space, z upward."""
        assert not isinstance(self.shape, Glued)
        if self.in_space is not None:
            (x, y, z), axes = self.in_space
            return (Placed(self.shape, (float(x), float(y), float(z)), quaternion_of(axes)),)
        x, z = np.array(self.place) @ _turn(self.slope)
        return (Placed(self.shape, (float(x), 0.0, float(z)), about((0.0, -1.0, 0.0), self.slope + self.angle)),)

    @property
    def outline(self) -> np.ndarray:
        """Corners as it stands, along and normal to the base [m], shape (k, 2)."""
        return self.polygon @ _turn(self.lean) + np.array(self.place)


def _turn(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s], [-s, c]])


class Structure:
    """Base of what stands. A kind gives its bodies and links, and what of the following it has.

    Class attributes: ``kind``, its word in sentences and the name of its entry in files; ``counted`` what one and several of
    its bodies are called; ``like``, what several like it are; ``joints_are``, what the joints of its responses are;
    ``computed_by``, who can where not all models do; ``scattered``, by which parts of a scatter its twins vary, none
    of what has no twins; ``first``, the first of ``bodies`` whose poses a run records; ``relative``, whether a model in the
    plane records them from where the bodies stand.
    """

    wanted: ClassVar[str] = "a Column, Specimen or Assembly"
    kind: ClassVar[str] = "structure"
    counted: ClassVar[tuple[str, str]] = ("body", "bodies")
    joints_are: ClassVar[str] = ""
    computed_by: ClassVar[str] = ""
    like: ClassVar[str] = ""
    scattered: ClassVar[tuple[str, ...]] = ()
    first: ClassVar[int] = 1
    relative: ClassVar[bool] = True

    name: str
    gravity: float
    north: float | None = None
    ground: float | None = 0.0
    as_found: AsFound = AS_BUILT
    links: tuple[Link, ...] = ()
    losses: Any = None

    # -- what it consists of -------------------------------------------------------------------------------------------

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """All bodies in the numbers of joints and links, what moves with the ground too."""
        raise NotImplementedError

    @cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """Shapes of the bodies that a run records."""
        return tuple(body.shape for body in self.bodies[self.first :])

    @cached_property
    def face_pairs(self) -> tuple[FacePair, ...]:
        """The joints between its bodies, in their order."""
        return ()

    @property
    def beds(self) -> tuple[Bed, ...]:
        """The same as where and how they carry, of what is no stack; of those of bodies in space and on vertices too."""
        return ()

    @property
    def space_joints(self) -> tuple[Any, ...] | None:
        """The joints of bodies in space; None of what a plane or a stack tells."""
        return None

    @property
    def joined_faces(self) -> tuple[Any, ...]:
        """The joints between its bodies, in their order, in the plane or in space."""
        return self.face_pairs if self.space_joints is None else self.space_joints

    @cached_property
    def placed_links(self) -> tuple[PlacedLink, ...]:
        """All links in numbers, at their places, in their order."""
        return ()

    def link_ends(self, link: PlacedLink) -> tuple[np.ndarray, np.ndarray, tuple[float, float]]:
        """Places of a link on its two bodies in the axes of their faces [m], shape (3,), and in which direction it slips."""
        return *link.arms, link.along

    def with_links_between(self, first: str, other: str, law: Joint) -> Joint:
        """Law of the contacts of two bodies by name with what lies between them: pads, and the friction of layers."""
        for numbers in self._beds.get(frozenset((first, other)), ()):
            law = numbers.joint_law(law)
        return law

    @cached_property
    def _beds(self) -> dict[frozenset[str], list[Numbers]]:
        """Links between two bodies by name, as contacts."""
        beds: dict[frozenset[str], list[Numbers]] = {}
        for link in self.links:
            if link.between is not None and link.numbers is not None:
                beds.setdefault(frozenset(link.between), []).append(link.numbers)
        return beds

    @property
    def surfaces(self) -> tuple[Joint, ...]:
        """Of every body, the law of its contacts, other than joints, with those before it."""
        raise NotImplementedError

    @property
    def laws_of_pairs(self) -> tuple[tuple[int, int, Joint], ...]:
        """Other laws of such contacts: two bodies, the lower number first."""
        return ()

    @property
    def stack(self) -> Any:
        """The column that it is, drums and joints from the base up; None where it is no single stack of drums."""
        return None

    def _check_north(self) -> None:
        """Refuse what is no bearing; kept within a full circle."""
        if self.north is not None:
            bearing = check_range("north", self.north, -360.0, 360.0, unit="degrees", field="north")
            object.__setattr__(self, "north", bearing % 360.0)

    @property
    def north_words(self) -> str:
        """What is known of north."""
        if self.north is None:
            return say("not stated; azimuths are from x towards y, and none is a bearing")
        return say("x points to {self.north:g}° clockwise from north; azimuths are from x towards y", self=self)

    @property
    def height(self) -> float:
        """From the ground, or its lowest point where there is none, to its highest point [m]; of a column that of its drums
        together, along its axis."""
        ends = np.concatenate([p.mesh(AROUND).vertices[:, 2] for b in self.bodies if not b.fixed for p in b.placed])
        return float(ends.max()) - (float(ends.min()) if self.ground is None else self.ground)

    @property
    def described(self) -> str:
        """Name in a sentence, such as ``an assembly``."""
        return f"{'an' if self.kind[0] in 'aeiou' else 'a'} {self.kind}"

    def describe(self) -> str:
        """What it is, in a sentence or two: bodies, size and mass."""
        return described(self)

    def __repr__(self) -> str:
        return f"<{self.describe()}>"

    def _repr_html_(self) -> str:
        return as_html(self)

    # -- what it measures; None where it has no such thing -------------------------------------------------------------

    @property
    def section(self) -> str | None:
        """``circular`` or ``rectangular``, of drums."""
        return None

    @property
    def base_width(self) -> float | None:
        """Width of the one joint with the base [m]."""
        return None

    @property
    def joint_width(self) -> float | None:
        """Smallest width of its joints [m]."""
        return None

    @property
    def widths(self) -> dict[str, float | None]:
        """Widths that limit states are stated in, by their names in tables [m]."""
        return {"base_width_m": self.base_width, "joint_width_m": self.joint_width}

    @property
    def slenderness(self) -> float | None:
        """α: angle at the base corner between the vertical and the line to the centroid [rad]."""
        return None

    @property
    def uplift_acceleration(self) -> float | None:
        """Static horizontal acceleration at which the first joint opens [m/s²]."""
        return None

    @cached_property
    def moving_acceleration(self) -> float | None:
        """Smallest static horizontal acceleration, in any direction, that opens a joint or makes it slide [m/s²]."""
        return None

    @property
    def frequency_parameter(self) -> float:
        """p = √(3g/4R) [1/s], R half the diagonal of the box around all bodies that move: the slowest that could rock."""
        corners = np.concatenate([body.corners for body in self.bodies if not body.fixed])
        return math.sqrt(0.75 * self.gravity / (0.5 * math.hypot(*np.ptp(corners, axis=0))))

    @property
    def pretensioned(self) -> bool:
        """Whether some link pulls before anything moves."""
        return any(link.pretension > 0.0 for link in self.placed_links)

    @property
    def on_rings(self) -> bool:
        """Whether some joint carries on a ring."""
        return False

    def renamed(self, name: str) -> Any:
        """A copy of this name."""
        fields: Any = self
        return dataclasses.replace(fields, name=name)

    # -- what asks for less ------------------------------------------------------------------------------------------

    def must_be_as_built(self, what: str) -> None:
        """Refuse offsets, tilts or chips where ``what`` knows none.

        Raises
        ------
        InputError
            It is not as built.
        """
        if self.as_found:
            raise InputError(
                f"{what} takes columns as built, and {self.name!r} has offsets, tilts or chips as found; "
                "use the model dem2d or dem3d, or leave [as_found] out."
            )

    def must_link_by(self, laws: Collection[str], what: str) -> None:
        """Refuse links whose laws are not among those that ``what`` takes.

        Raises
        ------
        InputError
        """
        other = next((link for link in self.links if link.law not in laws), None)
        if other is not None and not laws:
            raise InputError(
                f"{what} knows no links, and {self.name!r} has a {other.kind}; use dem2d or dem3d, or leave [[link]] out."
            )
        if other is not None:
            raise InputError(
                f"{what} knows links that act as a {' or '.join(sorted(laws))}, and {self.name!r} has a {other.kind}, which "
                "does not; use a model that knows it, or leave it out."
            )

    def must_carry_on_whole_faces(self, what: str) -> None:
        """Refuse joints on rings where ``what`` knows none.

        Raises
        ------
        InputError
        """
        if self.on_rings:
            raise InputError(
                f"{what} knows no rings, and a joint of {self.name!r} has a ring_width; use dem3d with law=bed, or leave it "
                "out."
            )

    def must_be(self, kind: str) -> Any:
        """The structure itself; for those who read what only this kind has.

        Raises
        ------
        AttributeError
            It is of another kind.
        """
        if self.kind != kind:
            raise AttributeError(f"{self.name!r} is no {kind}; what stood is the attribute structure.")
        return self

    # -- provenance ----------------------------------------------------------------------------------------------------

    def to_dict(self) -> dict:
        """Everything that defines it, as plain values in SI units."""
        raise NotImplementedError

    @cached_property
    def digest(self) -> str:
        """SHA-256 of :meth:`to_dict`."""
        return _digest(self.to_dict())

    @cached_property
    def nameless_digest(self) -> str:
        """The same without the structure's own name: what stands, whatever it is called."""
        return _digest({key: value for key, value in self.to_dict().items() if key != "name"})


def _digest(plain: dict) -> str:
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()
