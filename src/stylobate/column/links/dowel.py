"""Dowels across joints: what they are, their formulas, and what bars and clamps share with them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from ...errors import InputError, check_choice
from .link import LONGEST, STIFFEST, Link, Numbers, Site
from .materials import MATERIALS

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
        self._range("diameter", 1e-3, 1.0, "m")
        self._range("embedment", 1e-3, LONGEST, "m")
        self._range("shear_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("shear_capacity")
        self._range("clearance", 0.0, 1.0, "m")
        self._range("hole", 1e-3, 2.0, "m")
        self._range("ultimate_slip", 0.0, LONGEST, "m", open_low=True)
        self._range("stone_modulus", 1e6, 1e12, "Pa")
        self._range("stone_strength", 1e4, 1e10, "Pa")
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
        self._check_hole()

    def _check_hole(self) -> None:
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
            "ultimate_slip": given(self.ultimate_slip, lost),
            "failure": failure,
            "reach": ROUNDED * d if d is not None else capacity / stiffness if limited else 0.0,
            "governs": governs,
        }

    def stone(self) -> dict[str, Any]:
        """Stone that it stands in, and capacities that are given, as fields of :class:`Numbers`."""
        stated = tuple(one for one in ("shear_capacity", "axial_capacity") if getattr(self, one, None) is not None)
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
        return stiffness, given(capacity, math.inf), failure or "ductile", governs


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

    def held(self, site: Site) -> Numbers:
        """By Hetényi's beam in either drum, and the weakest of Johansen's modes."""
        return Numbers(**self.across(self.embedment), **self.stone(), lift=given(self.embedment, math.inf))


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


def given(value: float | None, other: float) -> float:
    """A value, or what stands in for one that is left out."""
    return other if value is None else value
