"""What a link holds: stiffness, capacity, slack and failure, as given or by formula from material and size."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from .link_materials import MATERIALS
from .links import Bar, Clamp, Core, Dowel, Layer, Link, Pin, Tie

if TYPE_CHECKING:
    from .column import Column

#: Poisson's ratio of stone [-].
POISSON = 0.25

#: Bearing strength of confined stone over its compressive strength (EN 1992-1-1, 6.7: at most 3) [-].
CONFINED = 3.0

#: Strength of the bond of a grouted bar to the stone [Pa] (a choice within 2 to 6 MPa of cement grouts).
BOND = 3e6

#: A dowel finds its hole again up to this share of its diameter beside its slack: its end is rounded (a choice) [-].
ROUNDED = 0.25


@dataclass(frozen=True)
class LinkProperties:
    """A link in numbers, for every kernel and every analysis alike.

    Parameters
    ----------
    name, kind : str
    lower, upper : int
        Bodies that it links: 0 is the base, i drum i from the bottom.
    joint : int
        Joint that it crosses, from 1; 0 for a straight line between two points.
    low, high : (float, float, float)
        Its ends, in the column as built: x and y from the axis, z above the base [m]. The same point of a joint for what
        crosses it.
    shear_stiffness, shear_capacity : float
        [N/m], [N] (infinite without limit)
    clearance : float
        Slack all round [m].
    ultimate_slip : float
        [m], infinite if it is never lost.
    failure : str
        ``ductile``, ``brittle`` or ``crushing``.
    lift : float
        Lift of the joint at its place up to which it holds in shear [m].
    reach : float
        How far beside its slack it finds its hole again [m].
    damping : float
        [N s/m]
    axial_stiffness, axial_capacity, ultimate_elongation, pretension : float
        [N/m], [N], [m], [N]; in tension only.
    governs : str
        What limits shear and tension, and by which formula.
    """

    name: str
    kind: str
    lower: int
    upper: int
    joint: int
    low: tuple[float, float, float]
    high: tuple[float, float, float]
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
    governs: str = ""

    @property
    def acts(self) -> bool:
        """Whether it does anything: one without stiffness and dashpot is as good as none."""
        return self.shear_stiffness > 0.0 or self.axial_stiffness > 0.0 or self.damping > 0.0

    @property
    def straight(self) -> bool:
        """Whether it is a line between two points, rather than what crosses a joint."""
        return self.joint == 0

    @property
    def length(self) -> float:
        """Of a straight line [m]; 0 for what crosses a joint."""
        return math.dist(self.low, self.high)


def properties(column: Column) -> tuple[LinkProperties, ...]:
    """All links of a column in numbers, in its order; one that only lowers the friction of a joint too."""
    found = [_properties(link, column) for link in column.links]
    names = [one.name for one in found]
    return tuple(
        one if names.count(one.name) == 1 else replace(one, name=f"{one.name}, {names[: i + 1].count(one.name)}")
        for i, one in enumerate(found)
    )


def _properties(link: Link, column: Column) -> LinkProperties:
    if isinstance(link, Tie):
        return _line(link, column)
    assert isinstance(link, (Dowel, Layer))
    place = (*link.at, float(column.joint_heights[link.joint - 1]))
    name = link.name or f"{link.kind} in joint {link.joint}"
    between = {"lower": link.joint - 1, "upper": link.joint, "joint": link.joint, "low": place, "high": place}
    return LinkProperties(name, link.kind, **between, **across_numbers(link))


def across_numbers(link: Dowel | Layer) -> dict[str, Any]:
    """What a dowel, bar or layer holds across its joint, as fields of :class:`LinkProperties`."""
    if isinstance(link, Layer):
        return {
            "shear_stiffness": link.shear_stiffness,
            "damping": link.damping,
            "shear_capacity": _or(link.shear_capacity, math.inf),
            "ultimate_slip": _or(link.ultimate_slip, math.inf),
            "governs": "as given",
        }
    axial = _anchored(link) if isinstance(link, Bar) else {}
    found = _pinned(link, link.embedment)
    if axial:
        found["governs"] += f"; {axial.pop('governs')}"
    return found | axial | {"lift": _or(link.embedment, math.inf)}


def _pinned(link: Pin, embedment: float | None) -> dict[str, Any]:
    """What a bar holds in shear that is embedded by so much on either side [m]."""
    stiffness, capacity, failure, governs = _shear(link, embedment)
    d, lost = link.diameter, math.inf
    if link.material is not None and d is not None:
        lost = MATERIALS[link.material].ultimate_slip * d
    reach = ROUNDED * d if d is not None else capacity / stiffness if 0.0 < stiffness and capacity < math.inf else 0.0
    return {
        "shear_stiffness": stiffness,
        "shear_capacity": capacity,
        "clearance": link.clearance or 0.0,
        "ultimate_slip": _or(link.ultimate_slip, lost),
        "failure": failure,
        "reach": reach,
        "governs": governs,
    }


def _shear(link: Pin, embedment: float | None) -> tuple[float, float, str, str]:
    """Stiffness [N/m], capacity [N], failure and what governs, of a bar across a joint, embedded by so much [m]."""
    stiffness, capacity = link.shear_stiffness, link.shear_capacity
    failure, governs = link.failure, "as given"
    if link.material is not None:
        assert link.diameter is not None
        assert embedment is not None
        limits = shear_limits(link.material, link.diameter, embedment, link.stone_strength)
        least = min(limits, key=lambda name: limits[name])
        if stiffness is None:
            stiffness = shear_stiffness(link.material, link.diameter, embedment, link.stone_modulus)
        if capacity is None:
            capacity, governs = limits[least], least
            failure = failure or ("crushing" if least.startswith("crushing") else "ductile")
    assert stiffness is not None
    return stiffness, _or(capacity, math.inf), failure or "ductile", governs


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
    """What can limit a dowel across a joint [N], by name.

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


def clamp_numbers(link: Clamp, length: float) -> dict[str, Any]:
    """What a clamp of a length between its legs [m] holds, as fields of :class:`LinkProperties`, and its axial failure.

    Notes
    -----
    Along itself it is a bar, E A/ℓ and f_y A, in series with its two legs, which are the two halves of a dowel of their
    length (Eq. K3), and as strong as that (Eq. K4). Across, it lies in its groove, and is a dowel with half of its length in
    either block.
    """
    found = _pinned(link, 0.5 * length)
    stiffness, capacity, ultimate = link.axial_stiffness, link.axial_capacity, link.ultimate_elongation
    failure, governs = link.failure, "as given"
    if link.material is not None:
        made, d, legs = MATERIALS[link.material], link.diameter, link.embedment
        assert d is not None
        assert legs is not None
        area = math.pi * d * d / 4.0
        if stiffness is None:
            give = shear_stiffness(link.material, d, legs, link.stone_modulus)
            stiffness = 1.0 / (length / (made.modulus * area) + 1.0 / give)
        in_legs = shear_limits(link.material, d, legs, link.stone_strength)
        limits = {"yield of the bar": made.tensile_strength * area} | {f"legs: {k}": v for k, v in in_legs.items()}
        least = min(limits, key=lambda name: limits[name])
        if capacity is None:
            capacity, governs = limits[least], least
            failure = failure or ("crushing" if least.startswith("legs: crushing") else "ductile")
        lost = made.ultimate_strain * length if least == "yield of the bar" else made.ultimate_slip * d
        ultimate = _or(ultimate, lost)
    assert stiffness is not None
    return found | {
        "axial_stiffness": stiffness,
        "axial_capacity": _or(capacity, math.inf),
        "ultimate_elongation": _or(ultimate, math.inf),
        "axial_failure": failure or "ductile",
        "governs": f"across: {found['governs']}; along: {governs}",
    }


def _anchored(link: Bar) -> dict:
    """Axial numbers of a bar that is bonded over its embedment in both drums."""
    stiffness, capacity, ultimate = link.axial_stiffness, link.axial_capacity, link.ultimate_elongation
    governs = "as given"
    if link.material is not None:
        made, d, length = MATERIALS[link.material], link.diameter, link.embedment
        assert d is not None
        assert length is not None
        area = math.pi * d * d / 4.0
        if stiffness is None:  # even bond: the force falls off linearly, each half stretches by T l / 2 E A
            stiffness = made.modulus * area / length
        if capacity is None:
            limits = {
                "yield of the bar": made.tensile_strength * area,
                "bond to the stone": math.pi * d * length * _or(link.bond, BOND),
            }
            governs = min(limits, key=lambda name: limits[name])
            capacity = limits[governs]
        ultimate = _or(ultimate, made.ultimate_strain * length)
    assert stiffness is not None
    return {
        "axial_stiffness": stiffness,
        "axial_capacity": _or(capacity, math.inf),
        "ultimate_elongation": _or(ultimate, math.inf),
        "pretension": link.pretension,
        "governs": governs,
    }


def line_ends(link: Tie, column: Column) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Ends of a tie or core in the column as built [m]."""
    ends = []
    upper = column.n if link.to_drum is None else link.to_drum
    for drum, given, far in ((link.from_drum, link.from_height, 0.0), (upper, link.to_height, 1.0)):
        share = far if isinstance(link, Core) else 0.5
        own = 0.0 if drum == 0 else float(column.joint_heights[drum - 1] + share * column.heights[drum - 1])
        ends.append(_or(given, own))
    return (*link.at, ends[0]), (*(link.at if link.to is None else link.to), ends[1])


def _line(link: Tie, column: Column) -> LinkProperties:
    low, high = line_ends(link, column)
    upper = column.n if link.to_drum is None else link.to_drum
    ends = f"{'the base' if link.from_drum == 0 else f'drum {link.from_drum}'} to drum {upper}"
    return LinkProperties(
        link.name or f"{link.kind} from {ends}", link.kind, link.from_drum, upper, 0, low, high,
        **line_numbers(link, math.dist(low, high)),
    )  # fmt: skip


def line_numbers(link: Tie, length: float) -> dict[str, Any]:
    """What a tie or core of a length [m] holds, as fields of :class:`LinkProperties`."""
    governs = "as given"
    stiffness, capacity, ultimate = link.axial_stiffness, link.axial_capacity, link.ultimate_elongation
    if link.material is not None:
        made, d = MATERIALS[link.material], link.diameter
        assert d is not None
        area = math.pi * d * d / 4.0
        stiffness = _or(stiffness, made.modulus * area / length)
        if capacity is None:
            capacity, governs = made.tensile_strength * area, "yield of the bar"
        ultimate = _or(ultimate, made.ultimate_strain * length)
    assert stiffness is not None
    return {
        "axial_stiffness": stiffness,
        "axial_capacity": _or(capacity, math.inf),
        "ultimate_elongation": _or(ultimate, math.inf),
        "pretension": link.pretension,
        "governs": governs,
    }


def _or(value: float | None, other: float) -> float:
    return other if value is None else value
