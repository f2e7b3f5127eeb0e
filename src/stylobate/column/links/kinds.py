"""Kinds of links: dowels, bars and clamps, ties and cores, layers and pads, each with its formulas and their sources."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from ...constants import DEGREE
from ...errors import InputError, check_choice
from ..joint import Joint
from .anchorage import RANGES
from .link import LONGEST, MATERIALS, STIFFEST, STRONGEST, THICKEST, Lies, Link, Mark, Numbers, Site

#: Behaviour of a dowel at its capacity: it yields, snaps, or crushes the stone so that its hole grows.
FAILURES = ("ductile", "brittle", "crushing")

#: Poisson's ratio of stone [-].
POISSON = 0.25

#: Bearing strength of confined stone over its compressive strength (EN 1992-1-1, 6.7: at most 3) [-].
CONFINED = 3.0

#: A dowel finds its hole again up to this share of its diameter beside its slack: its end is rounded (a choice) [-].
ROUNDED = 0.25


@dataclass(frozen=True, kw_only=True)
class Pin(Link):
    """Common parts of dowels, bars and clamps; parameters as for :class:`Dowel`."""

    diameter: float | None = None
    embedment: float | None = None
    material: str | None = None
    shear_stiffness: float | None = None
    shear_capacity: float | None = None
    clearance: float | None = None
    hole: float | None = None
    ultimate_slip: float | None = None
    failure: str | None = None
    stone_modulus: float = 50e9
    stone_strength: float = 60e6

    def _check(self) -> None:
        super()._check()
        self._material(self.material, self.diameter)
        for name in ("diameter", "embedment", "stone_strength"):
            low, high, unit = RANGES[name]
            self._range(name, low, high, unit)
        self._range("shear_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("shear_capacity")
        self._range("clearance", 0.0, 1.0, "m")
        self._range("hole", 1e-3, 2.0, "m")
        self._range("ultimate_slip", 0.0, LONGEST, "m", open_low=True)
        self._range("stone_modulus", 1e6, 1e12, "Pa")
        if self.failure is not None:
            check_choice("failure", self.failure, FAILURES, of=f"a {self.kind}")
        if self.material is None and self.shear_stiffness is None:
            raise InputError(
                f"a {self.kind} has neither material nor shear_stiffness; give one of the two.", "shear_stiffness"
            )
        if self.material is not None and self.embedment is None:
            raise InputError(
                f"a {self.kind} of {self.material} has no embedment; give its length in each of the two stones [m].",
                "embedment",
            )
        if self.diameter is None:
            return
        hole = 2.0 * self.diameter if self.hole is None else self.hole
        if hole < self.diameter:
            raise InputError(
                f"hole of a {self.kind} is {hole:g} m, and its diameter {self.diameter:g} m; make the hole wider.",
                "hole",
            )
        slack, room = self.clearance or 0.0, 0.5 * (hole - self.diameter)
        if slack > room * (1.0 + 1e-9):
            which = "its hole" if self.hole is not None else "a hole twice as wide as it"
            raise InputError(
                f"clearance of a {self.kind} is {slack:g} m, and {which} leaves {room:g} m all round; make it smaller.",
                "clearance",
            )

    def across(self, embedment: float | None) -> dict[str, Any]:
        """Resistance in shear, embedded by so much on either side [m], as fields of :class:`Numbers`."""
        stiffness, capacity, failure, governs = self._shear(embedment)
        d, lost = self.diameter, math.inf
        if self.material is not None and d is not None:
            lost = MATERIALS[self.material].ultimate_slip * d
        limited = 0.0 < stiffness and capacity < math.inf
        return {
            "diameter": d or 0.0,
            "shear_stiffness": stiffness,
            "shear_capacity": capacity,
            "clearance": self.clearance or 0.0,
            "ultimate_slip": value_or(self.ultimate_slip, lost),
            "failure": failure,
            "reach": ROUNDED * d if d is not None else capacity / stiffness if limited else 0.0,
            "governs": governs,
        }

    def stone(self) -> dict[str, Any]:
        """Stone that it stands in, and capacities that are given, as fields of :class:`Numbers`."""
        stated = tuple(name for name in ("shear_capacity", "axial_capacity") if getattr(self, name, None) is not None)
        return {"stone_strength": self.stone_strength, "stated": stated}

    def _shear(self, embedment: float | None) -> tuple[float, float, str, str]:
        """Stiffness [N/m], capacity [N], failure and what governs."""
        stiffness, capacity = self.shear_stiffness, self.shear_capacity
        failure, governs = self.failure, "as given"
        if self.material is not None:
            assert self.diameter is not None
            assert embedment is not None
            limits = shear_limits(self.material, self.diameter, embedment, self.stone_strength)
            least = min(limits, key=lambda name: limits[name])
            if stiffness is None:
                stiffness = shear_stiffness(self.material, self.diameter, embedment, self.stone_modulus)
            if capacity is None:
                capacity, governs = limits[least], least
                failure = failure or ("crushing" if least.startswith("crushing") else "ductile")
        assert stiffness is not None
        return stiffness, value_or(capacity, math.inf), failure or "ductile", governs


@dataclass(frozen=True, kw_only=True)
class Dowel(Pin):
    """A dowel or pole across a joint: holds in shear, and lifts out freely.

    Parameters
    ----------
    joint : int
        From 1 at the base; of an assembly ``between`` says which.
    diameter : float, optional
        [m]
    embedment : float, optional
        Its length in each of the two drums [m]: above so much lift it has left its hole.
    material : str, optional
        ``wood``, ``iron in lead``, ``titanium`` or ``stainless steel``: gives what is left out below.
    shear_stiffness, shear_capacity : float, optional
        Across the joint [N/m], [N]. A capacity that is left out is the smaller one of its own and of the stone's; one that
        is given is that of the dowel in its stone.
    clearance : float, optional
        Slack all round [m].
    hole : float, optional
        Diameter of the hole [m]; its diameter and twice the clearance if left out.
    ultimate_slip : float, optional
        Slip of the joint at its place at which it is lost for good [m]; never if left out and there is no material.
    failure : {"ductile", "brittle", "crushing"}, optional
        What becomes of it at its own capacity: it yields (elastic-plastic), it snaps, or it crushes the stone, so that its
        hole grows. Left out: what the formula says that governs; ``ductile`` without material. The edge of the stone snaps.
    stone_modulus, stone_strength : float
        Young's modulus and compressive strength of the stone [Pa], for the formulas.
    """

    kind: ClassVar[str] = "dowel"

    joint: int | None = None

    def _check(self) -> None:
        super()._check()
        self._joint(self.joint)

    def resistance(self, site: Site) -> Numbers:
        """By Hetényi's beam in either drum, and the weakest of Johansen's modes."""
        return Numbers(**self.across(self.embedment), **self.stone(), lift=value_or(self.embedment, math.inf))


def shear_stiffness(material: str, diameter: float, embedment: float, stone_modulus: float) -> float:
    """Stiffness of a dowel against slip of a joint [N/m].

    Notes
    -----
    Each half is a beam on an elastic foundation, loaded at the joint, where by symmetry it has no moment: Hetényi (1946),
    free ends, with Vesić's (1961) coefficient of the foundation, K = 0.65 (E_s d⁴/EI)^(1/12) E_s/(1 − ν²), in series with
    what the dowel is set in. Both halves give way.
    """
    made = MATERIALS[material]
    bending = made.modulus * math.pi * diameter**4 / 64.0
    stone = 0.65 * (stone_modulus * diameter**4 / bending) ** (1.0 / 12.0) * stone_modulus / (1.0 - POISSON**2)  # Vesić
    bed = 1.0 / (1.0 / stone + 1.0 / made.bedding)
    beta = (bed / (4.0 * bending)) ** 0.25
    x = min(beta * embedment, 30.0)
    sh, ch, s, c = math.sinh(x), math.cosh(x), math.sin(x), math.cos(x)
    return bed / (4.0 * beta) * (sh * sh - s * s) / (sh * ch - s * c)  # Hetényi


def shear_limits(material: str, diameter: float, embedment: float, stone_strength: float) -> dict[str, float]:
    """Limits of a dowel across a joint [N], by name.

    Notes
    -----
    Shear of the bar, f_v A (EN 1993-1-1, 6.2.6, for metals). Johansen's modes of a fastener between two equal members
    (EN 1995-1-1, Eq. 8.6 with β = 1): it turns as a whole and crushes its bed, (√2 − 1) f_h d l; or two hinges form in it,
    √(2 M_y f_h d) with M_y = f_y d³/6. The bed gives way at 3 f_c of the stone (EN 1992-1-1, 6.7), or at what the dowel's
    own flank bears.
    """
    made = MATERIALS[material]
    bed = min(CONFINED * stone_strength, made.bearing)
    hinge = made.yield_strength * diameter**3 / 6.0
    bed_name = "crushing of the stone" if made.bearing > CONFINED * stone_strength else "crushing of the dowel"
    return {
        "shear of the bar (EN 1993-1-1, 6.2.6)": made.shear_strength * math.pi * diameter**2 / 4.0,
        f"{bed_name} (EN 1995-1-1, 8.6 c)": (math.sqrt(2.0) - 1.0) * bed * diameter * embedment,
        "hinges in the bar (EN 1995-1-1, 8.6 f)": math.sqrt(2.0 * hinge * bed * diameter),
    }


def value_or(value: float | None, other: float) -> float:
    """A value, or what stands in for one that is left out."""
    return other if value is None else value


# -- Bars anchored on both sides of a joint ---------------------------------------------------------------------------


#: Strength of the bond of a grouted bar to the stone [Pa] (a choice within 2 to 6 MPa of cement grouts).
BOND = 3e6


@dataclass(frozen=True, kw_only=True)
class Bar(Dowel):
    """An anchored dowel or bar across a joint: holds in shear and against lifting.

    Parameters
    ----------
    axial_stiffness, axial_capacity : float, optional
        Against opening of the joint at its place [N/m], [N]; elastic-plastic. The capacity from a material is the smallest
        one of yield, bond and the cone of the stone, which snaps.
    bond : float, optional
        Strength of the bond to the stone [Pa], for the formula; 3 MPa if left out.
    ultimate_elongation : float, optional
        Elongation at which it is lost for good [m].
    pretension : float
        Force at the start [N].

    Others as for :class:`Dowel`.
    """

    kind: ClassVar[str] = "bar"
    law: ClassVar[str] = "dowel"
    mark: ClassVar[Mark] = "anchor"

    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    bond: float | None = None
    ultimate_elongation: float | None = None
    pretension: float = 0.0

    def _check(self) -> None:
        super()._check()
        self._range("axial_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("axial_capacity")
        self._range("bond", 0.0, 1e9, "Pa", open_low=True)
        self._range("ultimate_elongation", 0.0, LONGEST, "m", open_low=True)
        self._range("pretension", 0.0, STRONGEST, "N")
        if self.material is None and self.axial_stiffness is None:
            raise InputError(
                "a bar has neither material nor axial_stiffness; give one, or make it a dowel.", "axial_stiffness"
            )

    def resistance(self, site: Site) -> Numbers:
        """As a dowel, and against opening by even bond over its embedment in both drums."""
        across, axial = self.across(self.embedment), self._anchored()
        governs = f"{across.pop('governs')}; {axial.pop('governs')}"
        return Numbers(**across, **axial, **self.stone(), lift=value_or(self.embedment, math.inf), governs=governs)

    def _anchored(self) -> dict[str, Any]:
        stiffness, capacity, ultimate = self.axial_stiffness, self.axial_capacity, self.ultimate_elongation
        governs = "as given"
        if self.material is not None:
            made, d, length = MATERIALS[self.material], self.diameter, self.embedment
            assert d is not None
            assert length is not None
            area = math.pi * d * d / 4.0
            if stiffness is None:  # even bond: the force falls off linearly, each half stretches by T l / 2 E A
                stiffness = made.modulus * area / length
            if capacity is None:
                limits = {
                    "yield of the bar": made.tensile_strength * area,
                    "bond to the stone": math.pi * d * length * value_or(self.bond, BOND),
                }
                governs = min(limits, key=lambda name: limits[name])
                capacity = limits[governs]
            ultimate = value_or(ultimate, made.ultimate_strain * length)
        assert stiffness is not None
        return {
            "axial_stiffness": stiffness,
            "axial_capacity": value_or(capacity, math.inf),
            "ultimate_elongation": value_or(ultimate, math.inf),
            "pretension": self.pretension,
            "governs": governs,
        }


# -- Clamps between blocks side by side -------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Clamp(Pin):
    """A clamp between blocks side by side, of an assembly: holds along itself in both senses, and across.

    Parameters
    ----------
    to : tuple of float, optional
        Its end in the second body, as ``at`` is that in the first: x and z as drawn, or x, y and z [m].
    section : (float, float), optional
        Width and height of its bar [m]; counts as the round bar of that area, where no diameter is given.
    embedment : float, optional
        Length of its two legs in the stone [m].
    axial_stiffness, axial_capacity, ultimate_elongation : float, optional
        Along the clamp [N/m], [N], in tension and compression alike, and elongation at which it is lost [m].

    Others as for :class:`Dowel`; the clearance is slack along and across.
    """

    kind: ClassVar[str] = "clamp"
    lies: ClassVar[Lies] = "side"
    mark: ClassVar[Mark] = "line"

    to: tuple[float, ...] | None = None
    section: tuple[float, float] | None = None
    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    ultimate_elongation: float | None = None

    def _check(self) -> None:
        if self.section is not None:
            self._pair("section")
            if min(self.section) <= 0.0:
                raise InputError(
                    f"section of a clamp is {list(self.section)} m; give its width and height [m].", "section"
                )
            if self.diameter is None:
                object.__setattr__(self, "diameter", math.sqrt(4.0 / math.pi * math.prod(self.section)))
        super()._check()
        self._range("axial_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("axial_capacity")
        self._range("ultimate_elongation", 0.0, LONGEST, "m", open_low=True)
        if self.material is None and self.axial_stiffness is None:
            raise InputError(
                "a clamp has neither material nor axial_stiffness; give one of the two.", "axial_stiffness"
            )

    def resistance(self, site: Site) -> Numbers:
        """Numbers of a clamp of a length between its legs.

        Notes
        -----
        Along itself it is a bar, E A/ℓ and f_y A, in series with its two legs, which are the two halves of a dowel of their
        length (Eq. K3), and as strong as that (Eq. K4). Across, it lies in its groove, and is a dowel with half of its
        length in either block.
        """
        length, across = site.length, self.across(0.5 * site.length)
        in_groove = across.pop("governs")
        stiffness, capacity, ultimate = self.axial_stiffness, self.axial_capacity, self.ultimate_elongation
        failure, governs = self.failure, "as given"
        if self.material is not None:
            made, d, legs = MATERIALS[self.material], self.diameter, self.embedment
            assert d is not None
            assert legs is not None
            area = math.pi * d * d / 4.0
            if stiffness is None:
                give = shear_stiffness(self.material, d, legs, self.stone_modulus)
                stiffness = 1.0 / (length / (made.modulus * area) + 1.0 / give)
            in_legs = shear_limits(self.material, d, legs, self.stone_strength)
            limits = {"yield of the bar": made.tensile_strength * area} | {f"legs: {k}": v for k, v in in_legs.items()}
            least = min(limits, key=lambda name: limits[name])
            if capacity is None:
                capacity, governs = limits[least], least
                failure = failure or ("crushing" if least.startswith("legs: crushing") else "ductile")
            lost = made.ultimate_strain * length if least == "yield of the bar" else made.ultimate_slip * d
            ultimate = value_or(ultimate, lost)
        assert stiffness is not None
        return Numbers(
            **across,
            lift=value_or(self.embedment, math.inf),
            axial_stiffness=stiffness,
            axial_capacity=value_or(capacity, math.inf),
            ultimate_elongation=value_or(ultimate, math.inf),
            axial_failure=failure or "ductile",
            governs=f"across: {in_groove}; along: {governs}",
        )


# -- Straight links between two points, and their ends ----------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Line(Link):
    """Base of links that are straight between a point of one drum (or the base) and one of a drum above it.

    Parameters
    ----------
    at : tuple of float
        Place of both ends in plan, from the column's axis [m]; between two bodies its end in the first.
    to : tuple of float, optional
        Place of the upper end, where it differs; between two bodies its end in the second.
    from_drum, to_drum : int
        Drums that it links; 0 is the base, the upper one is the topmost if left out.
    from_height, to_height : float, optional
        Height of its ends above the base [m], of the column as built; where its kind holds a drum if left out, and 0 at the
        base.
    """

    lies: ClassVar[Lies] = "line"
    mark: ClassVar[Mark] = "line"
    #: Ends of a tie on a drum of which no height is given, as a share of the height: at the far end of all, and here.
    holds_at: ClassVar[tuple[float, float]] = (0.5, 0.5)
    #: Whether it runs in a hole through the stone, rather than beside it.
    through_stone: ClassVar[bool] = False

    to: tuple[float, ...] | None = None
    from_drum: int = 0
    to_drum: int | None = None
    from_height: float | None = None
    to_height: float | None = None

    @property
    def in_plan(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Places of its lower and its upper end in a column, from the axis [m]."""
        low, high = self.ends
        assert low is not None
        high = low if high is None else high
        return (low[0], low[1]), (high[0], high[1])

    def _check(self) -> None:
        super()._check()
        if self.to is not None and self.between is None:
            self._pair("to")
        self._number("from_drum", 0)
        if self.to_drum is not None:
            self._number("to_drum")
            if self.to_drum <= self.from_drum:
                raise InputError(
                    f"a {self.kind} goes from drum {self.from_drum} to drum {self.to_drum}; the second must be the higher "
                    "one.",
                    "to_drum",
                )
        for name in ("from_height", "to_height"):
            self._range(name, -LONGEST, 1e3, "m")


# -- Ties and straps outside the stone --------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Tie(Line):
    """A tie or strap: straight between a point of one drum (or the base) and one of a drum above it, outside the stone.

    Parameters
    ----------
    at, to, from_drum, to_drum, from_height, to_height : optional
        Its ends, as of :class:`~stylobate.column.links.kinds.Line`; at half of a drum's height where none is given.
    diameter, material : optional
        Give what is left out below; diameter in m.
    axial_stiffness, axial_capacity : float, optional
        [N/m], [N]; elastic-plastic, in tension only.
    ultimate_elongation : float, optional
        Elongation at which it is lost for good [m].
    pretension : float
        Force at the start [N].
    """

    kind: ClassVar[str] = "tie"

    diameter: float | None = None
    material: str | None = None
    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    ultimate_elongation: float | None = None
    pretension: float = 0.0

    def _check(self) -> None:
        super()._check()
        self._material(self.material, self.diameter)
        self._range("diameter", 1e-4, 1.0, "m")
        self._range("axial_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("axial_capacity")
        self._range("ultimate_elongation", 0.0, LONGEST, "m", open_low=True)
        self._range("pretension", 0.0, STRONGEST, "N")
        if self.material is None and self.axial_stiffness is None:
            raise InputError(
                f"a {self.kind} has neither material nor axial_stiffness; give one of the two.", "axial_stiffness"
            )

    def resistance(self, site: Site) -> Numbers:
        """A straight bar of its length: E A/ℓ and f_y A."""
        governs = "as given"
        stiffness, capacity, ultimate = self.axial_stiffness, self.axial_capacity, self.ultimate_elongation
        if self.material is not None:
            made, d = MATERIALS[self.material], self.diameter
            assert d is not None
            area = math.pi * d * d / 4.0
            stiffness = value_or(stiffness, made.modulus * area / site.length)
            if capacity is None:
                capacity, governs = made.tensile_strength * area, "yield of the bar"
            ultimate = value_or(ultimate, made.ultimate_strain * site.length)
        assert stiffness is not None
        return Numbers(
            diameter=self.diameter or 0.0,
            axial_stiffness=stiffness,
            axial_capacity=value_or(capacity, math.inf),
            ultimate_elongation=value_or(ultimate, math.inf),
            pretension=self.pretension,
            governs=governs,
        )


# -- Cores, bars in holes through the drums ---------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Core(Tie):
    """A bar in a hole through the drums, anchored at its two ends only; parameters as for :class:`Tie`.

    From the base to the top of the topmost drum, unless said otherwise; a drum's own end is its far face.
    """

    kind: ClassVar[str] = "core"
    law: ClassVar[str] = "tie"
    holds_at: ClassVar[tuple[float, float]] = (0.0, 1.0)
    through_stone: ClassVar[bool] = True


# -- Layers in joints, the one with the base first --------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Layer(Link):
    """A layer in a joint, the one with the base first: low friction, a restoring spring, a dashpot; all act on its slip.

    Parameters
    ----------
    joint : int
        From 1 at the base; of an assembly ``between`` says which.
    friction_coefficient : float, optional
        Of the joint, in place of the stone's [-].
    shear_stiffness : float
        Restoring stiffness at its place [N/m].
    shear_capacity : float, optional
        Largest restoring force [N].
    damping : float
        Force over speed of slip at its place [N s/m].
    ultimate_slip : float, optional
        Slip at which spring and dashpot are lost for good [m].
    """

    kind: ClassVar[str] = "layer"
    law: ClassVar[str] = "dowel"
    mark: ClassVar[Mark] = "sheet"

    joint: int | None = None
    friction_coefficient: float | None = None
    shear_stiffness: float = 0.0
    shear_capacity: float | None = None
    damping: float = 0.0
    ultimate_slip: float | None = None

    def _check(self) -> None:
        super()._check()
        self._joint(self.joint)
        self._range("friction_coefficient", 0.0, 10.0, "")
        self._range("shear_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("shear_capacity")
        self._range("damping", 0.0, THICKEST, "N s/m")
        self._range("ultimate_slip", 0.0, LONGEST, "m", open_low=True)
        if self.friction_coefficient is None and not self.shear_stiffness and not self.damping:
            raise InputError(
                "a layer has neither friction_coefficient, shear_stiffness nor damping; give one.",
                "friction_coefficient",
            )

    def resistance(self, site: Site) -> Numbers:
        """All as given."""
        return Numbers(
            friction_coefficient=self.friction_coefficient,
            shear_stiffness=self.shear_stiffness,
            damping=self.damping,
            shear_capacity=value_or(self.shear_capacity, math.inf),
            ultimate_slip=value_or(self.ultimate_slip, math.inf),
            governs="as given",
        )


# -- Pads that cover a joint, sheets of lead or rubber ----------------------------------------------------------------


class PadMaterial(NamedTuple):
    """Material of a pad: moduli [Pa], how much its shape stiffens it [-], bulk modulus that bounds it [Pa], source."""

    modulus: float
    shear_modulus: float
    shape: float
    bulk: float
    source: str


PAD_MATERIALS = {
    "lead": PadMaterial(
        16.1e9, 5.59e9, 0.0, math.inf, "Kaye and Laby, Tables of Physical and Chemical Constants, 2.2.2"
    ),
    # natural rubber of 50 IRHD: E = 2.20 MPa, G = 0.64 MPa, k = 0.73, bulk modulus 1030 MPa
    "rubber": PadMaterial(2.20e6, 0.64e6, 0.73, 1030e6, "Lindley, Engineering Design with Natural Rubber, 50 IRHD"),
}


@dataclass(frozen=True, kw_only=True)
class Pad(Link):
    """A pad that covers a joint, in compression only: in series with the joint's stiffness, with a friction of its own.

    Parameters
    ----------
    joint : int
        From 1 at the base; of an assembly ``between`` says which.
    thickness : float, optional
        [m]; drums and blocks do not move apart by it.
    material : {"lead", "rubber"}, optional
        Gives the stiffnesses that are left out: elastic lead, or natural rubber of hardness 50 IRHD that does not slip on
        the stone.
    normal_stiffness, shear_stiffness : float, optional
        Of the pad alone, per area [N/m³].
    friction_coefficient, friction_angle : float, optional
        Of the joint with the pad [-], [degrees]; one of the two; the joint's own if both are left out.
    shape_factor : float, optional
        Of rubber, its loaded area over that of its free edges [-]; in a column by the joint if left out.
    """

    kind: ClassVar[str] = "pad"
    mark: ClassVar[Mark] = "sheet"

    joint: int | None = None
    thickness: float | None = None
    material: str | None = None
    normal_stiffness: float | None = None
    shear_stiffness: float | None = None
    friction_coefficient: float | None = None
    friction_angle: float | None = None
    shape_factor: float | None = None

    def _check(self) -> None:
        super()._check()
        self._joint(self.joint)
        if self.at not in (None, (0.0, 0.0)):
            raise InputError(f"a pad covers its joint, and at is {list(self.at or ())}; leave it out.", "at")
        self._range("thickness", 1e-5, 1.0, "m")
        self._range("normal_stiffness", 1.0, 1e15, "N/m³")
        self._range("shear_stiffness", 1.0, 1e15, "N/m³")
        self._range("friction_coefficient", 0.0, 10.0, "")
        self._range("friction_angle", 0.0, 90.0, "degrees", open_high=True)
        self._range("shape_factor", 0.0, 1e4, "", open_low=True)
        if self.friction_coefficient is not None and self.friction_angle is not None:
            raise InputError(
                f"friction_coefficient of a pad is {self.friction_coefficient:g} and its friction_angle "
                f"{self.friction_angle:g} degrees; give one of the two.",
                "friction_coefficient",
            )
        if self.material is None:
            if self.normal_stiffness is None or self.shear_stiffness is None:
                raise InputError(
                    "a pad has neither material nor both normal_stiffness and shear_stiffness; give them.",
                    "normal_stiffness",
                )
            return
        remedy = "give normal_stiffness and shear_stiffness of another"
        check_choice("material", self.material, PAD_MATERIALS, of="a pad", remedy=remedy)
        if self.thickness is None:
            raise InputError(f"a pad of {self.material} has no thickness; give it one [m].", "thickness")

    def check_joint(self, joint: Joint) -> None:
        """Refuse a joint whose stones hold together: a pad parts them."""
        if joint.cohesion:
            raise InputError(
                f"a pad parts the stones of a joint with a cohesion of {joint.cohesion:g} Pa; give that joint cohesion = 0."
            )

    def resistance(self, site: Site) -> Numbers:
        """E/t and G/t; of rubber bonded by friction E_c = E (1 + 2 k S²), in series with its bulk modulus (Lindley)."""
        normal, shear, governs = self.normal_stiffness, self.shear_stiffness, "as given"
        if self.material is not None:
            made, t = PAD_MATERIALS[self.material], self.thickness
            assert t is not None
            if normal is None:
                normal, governs = self._modulus(made, site, t) / t, made.source
            if shear is None:
                shear, governs = made.shear_modulus / t, made.source
        assert normal is not None
        assert shear is not None
        friction = self.friction_coefficient
        if self.friction_angle is not None:
            friction = math.tan(self.friction_angle * DEGREE)
        beds: dict[str, Any] = {"bed_stiffness": normal, "bed_shear_stiffness": shear}
        return Numbers(**beds, friction_coefficient=friction, governs=governs)

    def _modulus(self, made: PadMaterial, site: Site, thickness: float) -> float:
        if not made.shape:
            return made.modulus
        shape = site.area / (site.edge * thickness) if self.shape_factor is None else self.shape_factor
        if math.isnan(shape):
            raise InputError(
                f"a pad of {self.material} between two bodies has no shape_factor; give its loaded area over that of its "
                "free edges, or its normal_stiffness.",
                "shape_factor",
            )
        return 1.0 / (1.0 / (made.modulus * (1.0 + 2.0 * made.shape * shape**2)) + 1.0 / made.bulk)
