"""Base of links: metals, data checked where made, where links may be, and what they hold in numbers."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, NamedTuple, Self

from ...errors import InputError, as_typed, check_choice, check_name, check_range, check_whole
from ..joint import Joint


@dataclass(frozen=True)
class LinkMaterial:
    """Materials of a dowel, bar or tie, and of its setting.

    Parameters
    ----------
    modulus : float
        Young's modulus along the bar [Pa].
    yield_strength : float
        In bending, and in tension unless that is given [Pa].
    shear_strength : float
        Across the bar [Pa].
    bearing : float
        Pressure under which its own flank, or what it is set in, is crushed [Pa].
    bedding : float
        Stiffness of its flank, or of what it is set in, per length [Pa].
    ultimate_strain : float
        Elongation at failure over the length [-].
    ultimate_slip : float
        Slip at which a dowel is lost, over its diameter [-].
    source : str
    tension : float, optional
        Strength in tension, where it is another than in bending [Pa].
    """

    modulus: float
    yield_strength: float
    shear_strength: float
    bearing: float
    bedding: float
    ultimate_strain: float
    ultimate_slip: float
    source: str
    tension: float | None = None

    @property
    def tensile_strength(self) -> float:
        """In tension [Pa]."""
        return self.yield_strength if self.tension is None else self.tension


#: von Mises: shear strength over yield strength, as in EN 1993-1-1, 6.2.6.
VON_MISES = 1.0 / math.sqrt(3.0)

#: Young's modulus of lead [Pa], and the thickness of a poured sheath over the diameter of the iron [-] (a choice: 8 mm
#: round a dowel of 40 mm).
LEAD, SHEATH = 16e9, 0.2

MATERIALS: dict[str, LinkMaterial] = {
    # EN 338:2016, class D30 (mean modulus 11 GPa, f_m 30 MPa, f_t,0 18 MPa, f_v 3.9 MPa, f_c,90 5.3 MPa, E_90 0.73 GPa). A
    # pin is sheared across its grain, of which f_v is the weaker, longitudinal plane: a lower bound.
    "wood": LinkMaterial(11e9, 30e6, 3.9e6, 5.3e6, 0.73e9, 0.01, 0.25, "EN 338:2016, D30", tension=18e6),
    # Wrought iron: yield 180 to 240 MPa, 190 GPa, in tests of historic bars; 200 MPa is a choice within them. The lead gives
    # way at once but cannot leave its hole: stiffness in series, no limit of its own.
    "iron in lead": LinkMaterial(
        190e9, 200e6, 200e6 * VON_MISES, math.inf, LEAD / SHEATH, 0.10, 0.5, "choice: wrought iron, 200 MPa"
    ),
    # ASTM B348, grade 2: proof stress 275 MPa at least, elongation 20 %; a quarter of it over the whole length (a choice).
    "titanium": LinkMaterial(105e9, 275e6, 275e6 * VON_MISES, math.inf, math.inf, 0.05, 0.5, "ASTM B348, grade 2"),
    # EN 10088-3, 1.4404: proof stress 200 MPa at least, elongation 40 %, 200 GPa; a quarter of it (a choice).
    "stainless steel": LinkMaterial(
        200e9, 200e6, 200e6 * VON_MISES, math.inf, math.inf, 0.10, 0.5, "EN 10088-3, 1.4404"
    ),
}


# -- Base of links ----------------------------------------------------------------------------------------------------


#: Largest length [m], stiffness [N/m], force [N] and dashpot [N s/m] of a link.
LONGEST, STIFFEST, STRONGEST, THICKEST = 100.0, 1e13, 1e10, 1e10

#: Least length of a straight link or clamp [m].
LEAST_LENGTH = 1e-3

#: Places of a link: in a joint, straight between two points, or in two blocks side by side, which no column has.
Lies = Literal["joint", "line", "side"]

#: Of each law of links where those lie that act by it, as engines compute it.
_LIES: dict[str, Lies] = {}

#: Picture of a link: a short stroke through its joint, one that is anchored at its ends, a line, or a sheet along its joint.
Mark = Literal["stroke", "anchor", "line", "sheet"]

#: Keys of the place of a link; the first five in a column alone.
PLACES = (
    "joint", "from_drum", "to_drum", "from_height", "to_height", "at", "to", "name", "between", "numbers", "made",
)  # fmt: skip


class Site(NamedTuple):
    """Geometry of a link at its place: the length between its ends [m], or area [m²] and edge [m] of its joint's faces."""

    length: float = math.nan
    area: float = math.nan
    edge: float = math.nan


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """Resistance of a link, for every kernel and every analysis alike.

    Parameters
    ----------
    diameter : float
        [m]; 0 if not known.
    shear_stiffness, shear_capacity : float
        [N/m], [N] (infinite without limit)
    clearance : float
        Slack all round [m].
    ultimate_slip : float
        [m], infinite if it is never lost.
    failure : str
        ``ductile``, ``brittle`` or ``crushing``.
    lift : float
        Lift of the joint at its place up to which it holds in shear [m]; of a clamp the length of its legs.
    reach : float
        How far beside its slack it finds its hole again [m].
    damping : float
        [N s/m]
    axial_stiffness, axial_capacity, ultimate_elongation, pretension : float
        [N/m], [N], [m], [N]; in tension only, but for clamps.
    axial_failure : str
        Of a clamp along itself.
    friction_coefficient : float, optional
        Of its joint, in place of the stone's [-].
    bed_stiffness, bed_shear_stiffness : float
        Normal and shear stiffness per area of what covers its joint, in series with the joint's [N/m³]; infinite if
        nothing does.
    governs : str
        What limits shear and tension, and by which formula.
    stone_strength : float
        Compressive strength of the stone about it [Pa]; 0 where its anchorage is not looked at.
    edge : float
        From its axis to the nearest edge of the stones that it joins [m], infinite where that is not known.
    stated : tuple of str
        Capacities that are given rather than computed: they are those of the link in its stone.
    """

    diameter: float = 0.0
    shear_stiffness: float = 0.0
    shear_capacity: float = math.inf
    clearance: float = 0.0
    ultimate_slip: float = math.inf
    failure: str = "ductile"
    lift: float = math.inf
    reach: float = 0.0
    damping: float = 0.0
    axial_stiffness: float = 0.0
    axial_capacity: float = math.inf
    ultimate_elongation: float = math.inf
    pretension: float = 0.0
    axial_failure: str = "ductile"
    friction_coefficient: float | None = None
    bed_stiffness: float = math.inf
    bed_shear_stiffness: float = math.inf
    governs: str = ""
    stone_strength: float = 0.0
    edge: float = math.inf
    stated: tuple[str, ...] = ()

    def joint_law(self, joint: Joint) -> Joint:
        """Law of its joint with what lies in it: with its friction, and its bed in series with the stone's stiffness."""
        if self.friction_coefficient is not None:
            joint = joint.changed(friction_coefficient=self.friction_coefficient)
        if self.bed_stiffness < math.inf or self.bed_shear_stiffness < math.inf:
            normal = 1.0 / (1.0 / joint.normal_stiffness + 1.0 / self.bed_stiffness)
            shear = 1.0 / (1.0 / joint.shear_stiffness + 1.0 / self.bed_shear_stiffness)
            joint = joint.changed(normal_stiffness=normal, shear_stiffness=shear)
        return joint


@dataclass(frozen=True, kw_only=True)
class Link:
    """Base of the links, of columns and of assemblies alike. A value left out follows from material and size.

    Parameters
    ----------
    at : tuple of float, optional
        In a column its place in the section, along x and y from the axis [m]; on the axis if left out. Between two bodies
        its place as drawn, x and z or x, y and z [m]; the middle of their joint if left out.
    name : str
        What results call it; its kind and place if left out.
    between : (str, str), optional
        Names of the two bodies of an assembly that it links; ``ground`` is the ground.
    numbers : Numbers, optional
        What it holds, where that is known: of a link of an assembly that is made, :meth:`in_numbers`.
    made : Link, optional
        The same link of material and size, of which these numbers are.

    Class attributes: ``kind``, its name in files; ``law``, the name of the law by which it acts, which models and statics
    take or refuse; ``lies`` and ``mark``.
    """

    wanted: ClassVar[str] = "a Dowel, Bar, Tie, Core, Layer or Pad"
    kind: ClassVar[str] = ""
    law: ClassVar[str] = ""
    lies: ClassVar[Lies] = "joint"
    mark: ClassVar[Mark] = "stroke"

    at: tuple[float, ...] | None = None
    name: str = ""
    between: tuple[str, str] | None = None
    numbers: Numbers | None = None
    made: Link | None = dataclasses.field(default=None, compare=False, repr=False)

    def __init_subclass__(cls) -> None:
        """A kind that names no law has one of its own, which nobody takes until its name is added there."""
        super().__init_subclass__()
        if "law" not in vars(cls):
            cls.law = cls.kind
        if cls.law and (usual := _LIES.setdefault(cls.law, cls.lies)) != cls.lies:
            raise TypeError(f"{cls.__name__} acts as a {cls.law}, which lies in a {usual}, and lies in a {cls.lies}.")

    def __post_init__(self) -> None:
        if self.name != "":
            check_name("the name of a link", self.name)
        if self.between is None:
            if self.at is None:
                object.__setattr__(self, "at", (0.0, 0.0))
            self._pair("at")
        else:
            self._between()
        if self.numbers is None:
            self._check()

    def _check(self) -> None:
        """Refuse data that cannot be; a kind adds its own."""

    def resistance(self, site: Site) -> Numbers:
        """Resistance at a site; each kind by its own formulas."""
        raise NotImplementedError

    def check_joint(self, joint: Joint) -> None:
        """Refuse a joint in which it cannot lie."""

    def to_dict(self) -> dict[str, Any]:
        """Its kind and all that differs from what is left out, as plain values; :func:`~.links.link_from_dict` reads it."""
        if self.numbers is None:
            return {"kind": self.kind} | _given_fields(self)
        at, to = self.ends
        place = {"between": self.between, "at": at, "to": to, "name": self.name or None}
        given = {name: list(value) if isinstance(value, tuple) else value for name, value in place.items() if value}
        return {"kind": self.kind} | given | _given_fields(self.numbers)

    @classmethod
    def known(cls) -> set[str]:
        """Entries of a link of this kind, besides where it is."""
        return {field.name for field in dataclasses.fields(cls)} - {*PLACES}

    @property
    def ends(self) -> tuple[tuple[float, ...] | None, tuple[float, ...] | None]:
        """Places that are given of its first and of its second end [m]."""
        return self.at, getattr(self, "to", None)

    def in_numbers(self) -> Self:
        """The same link between its bodies, with what it holds in place of material and size.

        Raises
        ------
        InputError
            It is not between two bodies, or has no length.
        """
        if self.numbers is not None:
            return self
        if self.between is None:
            raise InputError(f"a {self.kind} is between no bodies; give between = ['a', 'b'], two names.", "between")
        at, to = self.ends
        site = Site() if self.lies == "joint" else Site(length_of(self.kind, at, to))
        return self.restated(self.resistance(site), at=at, to=to, name=self.name, between=self.between, made=self)

    def restated(self, numbers: Numbers, **place: Any) -> Self:
        """A link of this kind between two bodies that holds so much; ``to`` is kept where the kind has two ends."""
        if self.lies == "joint":
            place.pop("to", None)
        return type(self)(numbers=numbers, **place)

    def _between(self) -> None:
        between: Any = self.between
        if isinstance(between, str) or len(between) != 2:
            count = 1 if isinstance(between, str) else len(between)
            raise InputError(f"a {self.kind} is between {count} bodies; name two, e.g. ['a', 'b'].", "between")
        object.__setattr__(self, "between", tuple(between))
        for field in dataclasses.fields(self):
            if field.name in PLACES[:5] and getattr(self, field.name) != field.default:
                raise InputError(
                    f"a {self.kind} between two bodies has no {field.name}; give its place, at.", field.name
                )
        for name in ("at", "to"):
            place = getattr(self, name, None)
            if place is not None:
                object.__setattr__(self, name, _place(self.kind, name, place))

    def _pair(self, name: str) -> None:
        value = getattr(self, name)
        if not isinstance(value, (tuple, list)) or len(value) != 2:
            raise InputError(
                f"{name} of a {self.kind} is {as_typed(value)}; it must be a place in plan, [x, y] in m.", name
            )
        place = tuple(
            check_range(name, coordinate, -LONGEST, LONGEST, unit="m", of=f"a {self.kind}") for coordinate in value
        )
        object.__setattr__(self, name, place)

    def _number(self, name: str, least: int = 1) -> None:
        check_whole(name, getattr(self, name), least, of=f"a {self.kind}")

    def _joint(self, joint: int | None) -> None:
        if self.between is not None:
            return
        if joint is None:
            raise InputError(f"a {self.kind} has no joint; give its number, 1 at the base.", "joint")
        self._number("joint")

    def _range(self, name: str, low: float, high: float, unit: str, **more: Any) -> None:
        value = getattr(self, name)
        if value is not None:
            more = {"remedy": "use SI units", **more}
            number = check_range(name, value, low, high, unit=unit, of=f"a {self.kind}", **more)
            object.__setattr__(self, name, number)

    def _capacity(self, name: str) -> None:
        value = getattr(self, name)
        if value is not None and value == 0.0:
            raise InputError(
                f"{name} of a {self.kind} is 0 N, which holds nothing; give what it holds, or leave it out.", name
            )
        self._range(name, 0.0, STRONGEST, "N", open_low=True)

    def _material(self, material: str | None, diameter: float | None) -> None:
        if material is None:
            return
        remedy = "give stiffness and capacity of another"
        check_choice("material", material, MATERIALS, of=f"a {self.kind}", remedy=remedy)
        if diameter is None:
            raise InputError(f"a {self.kind} of {material} has no diameter; give it one [m].", "diameter")


def _given_fields(link: Link | Numbers) -> dict[str, Any]:
    """Fields that differ from what is left out, as plain values."""
    default = {field.name: field.default for field in dataclasses.fields(link)}
    if isinstance(link, Link) and link.between is None:
        default["at"] = (0.0, 0.0)
    values = {name: getattr(link, name) for name in default}
    return {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in values.items()
        if value != default[name]
    }


def length_of(kind: str, at: tuple[float, ...] | None, to: tuple[float, ...] | None) -> float:
    """Length of a link between two places as drawn [m]."""
    if at is None or to is None:
        raise InputError(
            f"a {kind} has two ends; give at, a place in the first body, and to, one in the second [m].", "to"
        )
    low, high = in_space(at), in_space(to)
    length = math.dist(low, high)
    if length < LEAST_LENGTH:
        raise InputError(f"a {kind} has no length: both its ends are at {point(low)}; move one of them.", "to")
    return length


def in_space(place: tuple[float, ...] | None) -> tuple[float, float, float]:
    """A place x, z or x, y, z as x, y, z [m]."""
    assert place is not None
    return (place[0], 0.0 if len(place) == 2 else place[1], place[-1])


def point(place: tuple[float, ...]) -> str:
    """A place in space as messages tell it."""
    return f"[{place[0]:g}, {place[2]:g}] m"


def _place(kind: str, name: str, place: Any) -> tuple[float, ...]:
    if len(place) not in (2, 3) or not all(
        math.isfinite(coordinate) and abs(coordinate) <= 10.0 * LONGEST for coordinate in place
    ):
        raise InputError(
            f"{name} of a {kind} is {list(place)}; it must be a place, [x, z] or [x, y, z] within {10 * LONGEST:g} m.",
            name,
        )
    return tuple(float(coordinate) for coordinate in place)
