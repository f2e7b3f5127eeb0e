"""A freestanding column: drums on drums on a base, with the closed-form properties every model and check rests on."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from ..constants import DEGREE
from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError, check_all, check_kind, check_name, check_range, check_whole, no_field, warn
from ..messages import say
from .as_found import AS_BUILT, AsFound
from .block import FAR_AWAY, ground_block
from .drum import Drum
from .found_geometry import (
    DrumStack,
    StandingDrum,
    base_axes,
    check_as_found,
    geometry,
    smallest_uplift,
    space_geometry,
    uplift_accelerations,
)
from .joint import Joint, Losses, stated_fields
from .links.link import Link
from .links.placed import PlacedLink, ends_on_bodies, place_in_column, pulls_in_plane
from .materials import material
from .plausible import shape_doubts, size_doubts
from .shapes import Shape, shape_of
from .structure import Body, Face, FacePair

MAX_DRUMS = 200

#: Gravity from that of a small moon to that of a giant planet [m/s²].
GRAVITIES = (1e-2, 100.0)


@dataclass(frozen=True, repr=False)
class Column(DrumStack):
    """Drums from the bottom up, and the joint under each of them.

    Drum i = 0 … n−1 stands on joint i; joint 0 is the one with the base (the design numbers them from 1).

    Parameters
    ----------
    drums : sequence of Drum
    joints : sequence of Joint
        As many as drums.
    name : str
    gravity : float
        g [m/s²].
    as_found : AsFound
        What is not as built: offset and leaning drums, chipped edges, a base out of level. The closed-form properties
        below are those of the column as built, but for the accelerations that open joints.
    material : str, optional
        Name of the stone and its joints, such as ``marble, worn`` (:mod:`stylobate.column.materials`): how columns like
        this one scatter. Densities and joints are those given above.
    links : sequence of Link
        Dowels, bars, ties, cores, layers and pads that strengthen it; the closed-form properties know nothing of them.
    losses : Losses, optional
        Losses and law of its joints in place of the model's, of columns that are drawn (:class:`Scatter`).
    north : float, optional
        Bearing of the x axis, clockwise from north [degrees]; nothing is known of north where it is left out.

    Raises
    ------
    InputError
        No drum, too many drums, a number of joints that differs from the number of drums, a column that is not in
        equilibrium as found, or a link that cannot be.

    Warns
    -----
    OutOfRangeWarning
        A drum that widens upward and is no capital, or a column that does; sizes and densities that no column of stone
        has, as a slip of units makes them: allowed, but said.
    """

    kind: ClassVar[str] = "column"
    counted: ClassVar[tuple[str, str]] = ("drum", "drums")
    joints_are: ClassVar[str] = "joint under the drum of that number"
    like: ClassVar[str] = "columns"
    scattered: ClassVar[tuple[str, ...]] = (
        "friction", "joint_stiffness", "density", "width", "height", "offset",
        "stiffness_damping", "rolling_resistance", "law", "unknown_stiffness",
    )  # fmt: skip

    drums: tuple[Drum, ...]
    joints: tuple[Joint, ...]
    name: str = "column"
    gravity: float = STANDARD_GRAVITY
    as_found: AsFound = AS_BUILT
    material: str | None = None
    links: tuple[Link, ...] = ()
    losses: Losses | None = None
    north: float | None = None

    def __post_init__(self) -> None:
        self._check()
        self._warn_of_doubts()

    @property
    def doubts(self) -> list[str]:
        """Doubts about shapes, and about sizes and densities that look like a slip of units, in sentences."""
        sizes = (say("{self.name!r}: {doubt}", self=self, doubt=doubt) for doubt in size_doubts(self))
        return [*shape_doubts(self, self.name), *sizes]

    def _warn_of_doubts(self) -> None:
        for doubt in self.doubts:
            warn(doubt)

    def _check(self) -> None:
        for name, kind in (("drums", Drum), ("joints", Joint), ("links", Link)):
            object.__setattr__(self, name, tuple(check_all(name, getattr(self, name), kind)))
        check_kind("as_found", self.as_found, AsFound)
        check_kind("losses", self.losses, Losses, optional=True)
        check_name("the name of a column", self.name)
        if not 1 <= len(self.drums) <= MAX_DRUMS:
            raise InputError(f"the column has {len(self.drums)} drums; allowed is 1 to {MAX_DRUMS}.")
        if len(self.joints) != len(self.drums):
            raise InputError(
                f"the column has {len(self.joints)} joints for {len(self.drums)} drums; give one joint under each drum."
            )
        if len({drum.section for drum in self.drums}) > 1:
            raise InputError("the drums mix circular and rectangular sections; give all drums the same section.")
        object.__setattr__(self, "gravity", check_range("gravity", self.gravity, *GRAVITIES, unit="m/s²"))
        self._check_north()
        if self.material is not None:
            object.__setattr__(self, "material", material(self.material).name)
        self.check_rings()
        self.placed_links  # noqa: B018  refuses links that cannot be
        if self.as_found or self.pretensioned:
            check_as_found(self)

    # -- as a structure ------------------------------------------------------------------------------------------------

    @property
    def stack(self) -> Self:
        """The column itself."""
        return self

    @cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """Shapes of the drums, with what their chips leave."""
        return tuple(shape_of(drum, self.as_found.of(i)) for i, drum in enumerate(self.drums, 1))

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """The base and the drums as they stand."""
        at, slope = geometry(self), self.as_found.base_tilt * DEGREE
        space, turn = None if self.as_found.in_plane else space_geometry(self), base_axes(self)
        bodies: list[Body] = [ground_block(0.0)]
        for i, (drum, shape) in enumerate(zip(self.drums, self.shapes, strict=True)):
            place, angle = (float(at.centroid[i, 0]), float(at.centroid[i, 1])), float(at.lean[i] + at.tilt[i])
            pose = None if space is None else (turn @ space.centroid[i], turn @ space.axes[i])
            what = f"drum {i + 1}", shape, float(self.masses[i]), float(self.inertias[i])
            fields = *what, place, angle, slope, float(at.lean[i]), pose
            bodies.append(StandingDrum(*fields, drum=drum, as_found=self.as_found.of(i + 1)))
        return tuple(bodies)

    @cached_property
    def _turns(self) -> tuple[list[float], list[float]]:
        """Cosine and sine of the inclination of each drum's upper face to its lower one."""
        tilt = np.array([self.as_found.of(i).tilt * DEGREE for i in range(1, self.n + 1)])
        return np.cos(tilt).tolist(), np.sin(tilt).tolist()

    @cached_property
    def upper_faces(self) -> tuple[Face, ...]:
        """Upper face of the base and of each drum, which may be inclined to its lower one."""
        faces = [Face((1.0, 0.0), 0.0, FAR_AWAY, FAR_AWAY)]
        for drum, *turn in zip(self.drums, *self._turns, strict=True):
            half = 0.5 * drum.top_width
            faces.append(Face((turn[0], turn[1]), drum.height - drum.centroid_height, half, half))
        return tuple(faces)

    @cached_property
    def face_pairs(self) -> tuple[FacePair, ...]:
        """Each joint, between the upper face of what is below and what chips leave of the lower face of the drum."""
        pairs, face = [], 2  # the upper one of the base among its sides, counter-clockwise from the lower left
        pressed = zip(self.joint_laws, self.joint_areas.tolist(), self.joint_widths.tolist(), strict=True)
        for i, (drum, cosine, sine, how) in enumerate(zip(self.drums, *self._turns, pressed)):
            found_drum, half, high = self.as_found.of(i + 1), 0.5 * drum.bottom_width, drum.centroid_height
            ends = half - found_drum.chip_left - high * sine, half - found_drum.chip_right + high * sine
            left, right = found_drum.chip_left > 0.0, found_drum.chip_right > 0.0
            above = Face((1.0, 0.0), high * cosine, *ends)
            pairs.append(FacePair(i, i + 1, self.upper_faces[i], above, *how, (face, int(left))))
            face = 2 + left + right
        return tuple(pairs)

    @cached_property
    def placed_links(self) -> tuple[PlacedLink, ...]:
        """All links in numbers, at their places in the column as built, in their order."""
        return place_in_column(self, self.links, self.name) if self.links else ()

    def link_ends(self, link: PlacedLink) -> tuple[np.ndarray, np.ndarray, tuple[float, float]]:
        """Places of a link on its two bodies in the axes of their faces [m], shape (3,), and in which direction it slips.

        What crosses a joint lies on the lower face of its upper drum; a line is as drawn in the axes of its drums.
        """
        i = link.upper - 1
        lower, upper = (self.upper_faces[body].direction for body in (link.lower, link.upper))
        foot = self.drums[i].centroid_height * self._turns[1][i]  # of the centroid, to the left of the face's middle
        return ends_on_bodies(link, lower, upper, (foot, -self.face_pairs[i].above.height))

    @property
    def surfaces(self) -> tuple[Joint, ...]:
        """Of every body, the law of its contacts, other than joints, with those before it."""
        return self.joints[0], *self.joints

    @property
    def laws_of_pairs(self) -> tuple[tuple[int, int, Joint], ...]:
        """Of drums in a joint, its law with the layer or pad that lies in it: no other drum meets that."""
        return tuple((j, j + 1, law) for j, law in enumerate(self.joint_laws))

    # -- made from -----------------------------------------------------------------------------------------------

    @classmethod
    def of_drums(
        cls,
        drums: Sequence[Drum],
        joint: Joint,
        *,
        overrides: Mapping[int, Joint] | None = None,
        name: str = "column",
        gravity: float = STANDARD_GRAVITY,
    ) -> Column:
        """A column of given drums (bottom to top) with one joint law, some joints overridden.

        Parameters
        ----------
        drums : sequence of Drum
        joint : Joint
            For every joint without an override.
        overrides : mapping of int to Joint, optional
            By joint number, counted from 1 at the base.
        name : str
        gravity : float
            [m/s²]
        """
        drums = check_all("drums", drums, Drum)
        joints = [check_kind("joint", joint, Joint)] * len(drums)
        check_kind(
            "overrides", overrides, Mapping, allowed="joints by their number, such as {1: Joint(…)}", optional=True
        )
        for index, other in (overrides or {}).items():
            check_whole("override index", index, 1, len(joints), remedy="1 is at the base", field=f"override.{index}")
            joints[index - 1] = check_kind(f"joint {index} of overrides", other, Joint)
        return cls(tuple(drums), tuple(joints), name, gravity)

    @classmethod
    def tapered(
        cls,
        *,
        height: float,
        bottom_width: float,
        top_width: float,
        drums: int,
        density: float,
        joint: Joint,
        section: str = "rectangular",
        depth: float = 1.0,
        top_depth: float | None = None,
        overrides: Mapping[int, Joint] | None = None,
        name: str = "column",
        gravity: float = STANDARD_GRAVITY,
    ) -> Column:
        """A column of equally high drums cut from one taper.

        Parameters
        ----------
        height, bottom_width, top_width : float
            Of the whole column [m].
        drums : int
            Number of drums, 1 for a monolith.
        density : float
            [kg/m³]
        joint : Joint
        section : {"rectangular", "circular"}
        depth : float
            Rectangular only [m].
        top_depth : float, optional
            Depth at the top of a column that tapers in depth too [m].
        overrides, name, gravity
            As in :meth:`of_drums`.
        """
        drums = check_whole("drums", drums, 1, MAX_DRUMS)
        whole = Drum(height, bottom_width, top_width, density, section, depth, top_depth)
        taper = (whole.top_width - whole.bottom_width) / drums
        widths = [whole.bottom_width + taper * i for i in range(drums)] + [whole.top_width]
        deep = [whole.depth_at(whole.height * i / drums) for i in range(drums)] + [whole.upper_depth]
        ends = [(near, None if whole.top_depth is None else far) for near, far in pairwise(deep)]
        stack = [
            Drum(whole.height / drums, low, high, density, section, near, far)
            for (low, high), (near, far) in zip(pairwise(widths), ends, strict=True)
        ]
        return cls.of_drums(stack, joint, overrides=overrides, name=name, gravity=gravity)

    @classmethod
    def from_toml(cls, path: str | Path) -> Column:
        """Read a column file (see the documentation of file formats)."""
        from .tables import read_as  # pydantic is loaded where a file is read

        return read_as(cls, path)

    def renamed(self, name: str) -> Column:
        """A copy of this name; what was warned of is not warned of again."""
        return self.replace(name=name)

    def replace(self, **changes) -> Column:
        """A copy with some fields changed, checked as any column; what was warned of is not warned of again."""
        copy = self.unwarned(**changes)
        if "drums" in changes and not self.doubts:
            copy._warn_of_doubts()
        return copy

    def unwarned(self, **changes) -> Column:
        """As :meth:`replace`, without a warning: of what was drawn or computed, not typed."""
        fields = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        if unknown := changes.keys() - fields:
            raise TypeError(no_field("a column", min(unknown), fields))
        return self.of_fields(**fields | changes)

    @classmethod
    def of_fields(cls, **fields: Any) -> Self:
        """The column of its fields, checked as any, without a warning: of what is read back or computed, not typed."""
        column = object.__new__(cls)
        for name, value in fields.items():
            object.__setattr__(column, name, value)
        column._check()
        return column

    def with_joint(self, **changes) -> Column:
        """A copy with the same change made to every joint, e.g. ``with_joint(friction_angle=10.0)``."""
        return self.replace(joints=tuple(joint.changed(**changes) for joint in self.joints))

    def as_prism(self) -> Column:
        """The paper's idealisation: every drum a prism of its mean width."""
        return self.replace(drums=tuple(drum.as_prism() for drum in self.drums))

    # -- what opens it -------------------------------------------------------------------------------------------

    @cached_property
    def joint_uplift_accelerations(self) -> np.ndarray:
        """Static horizontal acceleration that opens each joint of the rigid stack above it [m/s²], shape (n,).

        A uniform acceleration a overturns the part above joint i about the edge of its contact section when
        a (z_C − z_i) > g d_i / 2. As found, and pulled by pretensioned links, the smaller one of both directions; out of the
        plane, the smallest of all.
        """
        if self.as_found or self.pretensioned:
            if not (self.as_found.in_plane and pulls_in_plane(self.placed_links)):
                return smallest_uplift(self)
            return np.abs(uplift_accelerations(self)).min(axis=1)
        return self.gravity * 0.5 * self.joint_widths / self.parts_above[1]

    @property
    def uplift_acceleration(self) -> float:
        """Static horizontal acceleration at which the first joint opens [m/s²]."""
        return float(self.joint_uplift_accelerations.min())

    @cached_property
    def moving_acceleration(self) -> float:
        """Smallest static horizontal acceleration, in any direction, that opens a joint or makes it slide [m/s²]."""
        least = self.uplift_acceleration
        if self.section == "rectangular":  # across its depth
            least *= min(
                1.0,
                *(
                    min(drum.depth, drum.top_depth or drum.depth) / max(drum.bottom_width, drum.top_width)
                    for drum in self.drums
                ),
            )
        return min(least, self.gravity * float(self.friction.min()))

    # -- provenance ----------------------------------------------------------------------------------------------

    def to_dict(self) -> dict:
        """Everything that defines the column, as plain values in SI units."""
        plain = {name: value for name, value in stated_fields(self).items() if name not in ("as_found", "links")}
        plain |= {name: [stated_fields(part) for part in plain[name]] for name in ("drums", "joints")}
        plain |= {"as_found": self.as_found.to_dict()} if self.as_found else {}
        plain |= {"losses": stated_fields(self.losses)} if self.losses else {}
        return plain | ({"links": [link.to_dict() for link in self.links]} if self.links else {})

    @cached_property
    def _hash(self) -> int:
        return hash(tuple(getattr(self, field.name) for field in dataclasses.fields(self)))

    def __hash__(self) -> int:
        """As of its values; many runs ask for the numbers of one column again and again."""
        return self._hash
