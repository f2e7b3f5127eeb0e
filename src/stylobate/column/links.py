"""Links that strengthen what stands, as data: dowels, bars, clamps, ties, cores and layers; what each is in itself."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, ClassVar

from ..errors import InputError, as_typed, check_range, suggest
from .link_materials import MATERIALS

#: What becomes of a dowel at its capacity: it yields, snaps, or crushes the stone so that its hole grows.
FAILURES = ("ductile", "brittle", "crushing")

#: Largest length [m], stiffness [N/m], force [N] and dashpot [N s/m] of a link.
LONGEST, STIFFEST, STRONGEST, THICKEST = 100.0, 1e13, 1e10, 1e10


@dataclass(frozen=True, kw_only=True)
class Link:
    """Base of the links. A value left out follows from the material, the diameter and the embedment (:mod:`.link_laws`).

    Parameters
    ----------
    at : (float, float)
        Place in the section, along x and y from the column's axis [m].
    name : str
        What results call it; its kind and place if left out.
    """

    kind: ClassVar[str] = ""

    at: tuple[float, float] = (0.0, 0.0)
    name: str = ""

    def __post_init__(self) -> None:
        _pair(self, "at")

    @property
    def what(self) -> str:
        """What messages call the link."""
        return self.name or self.kind

    def to_dict(self) -> dict[str, Any]:
        """Its kind and all that differs from what is left out, as plain values."""
        fields = {one.name: one.default for one in dataclasses.fields(self)}
        values = {name: getattr(self, name) for name, default in fields.items() if getattr(self, name) != default}
        return {"kind": self.kind} | {
            name: list(value) if isinstance(value, tuple) else value for name, value in values.items()
        }

    def _range(self, name: str, low: float, high: float, unit: str, **more: Any) -> None:
        value = getattr(self, name)
        if value is not None:
            number = check_range(f"{name} of a {self.kind}", value, low, high, unit=unit, **more)
            object.__setattr__(self, name, number)

    def _capacity(self, name: str) -> None:
        value = getattr(self, name)
        if value is not None and value == 0.0:
            raise InputError(
                f"{name} of a {self.kind} is 0 N, which holds nothing; give what it holds, or leave it out."
            )
        self._range(name, 0.0, STRONGEST, "N", open_low=True)

    def _material(self, material: str | None, diameter: float | None) -> None:
        if material is None:
            return
        if material not in MATERIALS:
            raise InputError(
                f"material of a {self.kind} is {material!r}; {suggest(material, MATERIALS)}known are "
                f"{', '.join(MATERIALS)}, or give stiffness and capacity instead."
            )
        if diameter is None:
            raise InputError(f"a {self.kind} of {material} has no diameter; give it one [m].")


@dataclass(frozen=True, kw_only=True)
class Pin(Link):
    """What dowels, bars and clamps have in common; parameters as for :class:`Dowel`."""

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

    def __post_init__(self) -> None:
        super().__post_init__()
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
        if self.failure is not None and self.failure not in FAILURES:
            raise InputError(
                f"failure of a {self.kind} is {self.failure!r}; {suggest(self.failure, FAILURES)}allowed are "
                f"{', '.join(FAILURES)}."
            )
        if self.material is None and self.shear_stiffness is None:
            raise InputError(f"a {self.kind} has neither material nor shear_stiffness; give one of the two.")
        if self.material is not None and self.embedment is None:
            raise InputError(f"a {self.kind} of {self.material} has no embedment; give its length in each drum [m].")
        self._check_hole()

    def _check_hole(self) -> None:
        if self.diameter is None:
            return
        hole = 2.0 * self.diameter if self.hole is None else self.hole
        if hole < self.diameter:
            raise InputError(
                f"hole of a {self.kind} is {hole:g} m, and its diameter {self.diameter:g} m; make the hole wider."
            )
        slack, room = self.clearance or 0.0, 0.5 * (hole - self.diameter)
        if slack > room * (1.0 + 1e-9):
            which = "its hole" if self.hole is not None else "a hole twice as wide as it"
            raise InputError(
                f"clearance of a {self.kind} is {slack:g} m, and {which} leaves {room:g} m all round; make it smaller."
            )


@dataclass(frozen=True, kw_only=True)
class Dowel(Pin):
    """A dowel or pole across a joint: holds in shear, and lifts out freely.

    Parameters
    ----------
    joint : int
        From 1 at the base.
    diameter : float, optional
        [m]
    embedment : float, optional
        Its length in each of the two drums [m]: above so much lift it has left its hole.
    material : str, optional
        ``wood``, ``iron in lead``, ``titanium`` or ``stainless steel``: gives what is left out below.
    shear_stiffness, shear_capacity : float, optional
        Across the joint [N/m], [N].
    clearance : float, optional
        Slack all round [m].
    hole : float, optional
        Diameter of the hole [m]; its diameter and twice the clearance if left out.
    ultimate_slip : float, optional
        Slip of the joint at its place at which it is lost for good [m]; never if left out and there is no material.
    failure : {"ductile", "brittle", "crushing"}, optional
        What becomes of it at its capacity: it yields (elastic-plastic), it snaps, or it crushes the stone, so that its hole
        grows. Left out: what the formula says that governs; ``ductile`` without material.
    stone_modulus, stone_strength : float
        Young's modulus and compressive strength of the stone [Pa], for the formulas.
    """

    kind: ClassVar[str] = "dowel"

    joint: int

    def __post_init__(self) -> None:
        super().__post_init__()
        _number(self, "joint")


@dataclass(frozen=True, kw_only=True)
class Bar(Dowel):
    """An anchored dowel or bar across a joint: holds in shear and against lifting.

    Parameters
    ----------
    axial_stiffness, axial_capacity : float, optional
        Against opening of the joint at its place [N/m], [N]; elastic-plastic. The capacity from a material is the smaller
        one of yield and bond.
    bond : float, optional
        Strength of the bond to the stone [Pa], for the formula; 3 MPa if left out.
    ultimate_elongation : float, optional
        Elongation at which it is lost for good [m].
    pretension : float
        Force at the start [N].

    Others as for :class:`Dowel`.
    """

    kind: ClassVar[str] = "bar"

    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    bond: float | None = None
    ultimate_elongation: float | None = None
    pretension: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        self._range("axial_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("axial_capacity")
        self._range("bond", 0.0, 1e9, "Pa", open_low=True)
        self._range("ultimate_elongation", 0.0, LONGEST, "m", open_low=True)
        self._range("pretension", 0.0, STRONGEST, "N")
        if self.material is None and self.axial_stiffness is None:
            raise InputError("a bar has neither material nor axial_stiffness; give one, or make it a dowel.")


@dataclass(frozen=True, kw_only=True)
class Clamp(Pin):
    """A clamp between blocks side by side, of an assembly: holds along itself in both senses, and across.

    Parameters
    ----------
    section : (float, float), optional
        Width and height of its bar [m]; counts as the round bar of that area, where no diameter is given.
    embedment : float, optional
        Length of its two legs in the stone [m].
    axial_stiffness, axial_capacity, ultimate_elongation : float, optional
        Along the clamp [N/m], [N], in tension and compression alike, and elongation at which it is lost [m].

    Others as for :class:`Dowel`; the clearance is slack along and across.
    """

    kind: ClassVar[str] = "clamp"

    section: tuple[float, float] | None = None
    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    ultimate_elongation: float | None = None

    def __post_init__(self) -> None:
        if self.section is not None:
            _pair(self, "section")
            if min(self.section) <= 0.0:
                raise InputError(f"section of a clamp is {list(self.section)} m; give its width and height [m].")
            if self.diameter is None:
                object.__setattr__(self, "diameter", math.sqrt(4.0 / math.pi * math.prod(self.section)))
        super().__post_init__()
        self._range("axial_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("axial_capacity")
        self._range("ultimate_elongation", 0.0, LONGEST, "m", open_low=True)
        if self.material is None and self.axial_stiffness is None:
            raise InputError("a clamp has neither material nor axial_stiffness; give one of the two.")


@dataclass(frozen=True, kw_only=True)
class Tie(Link):
    """A tie or strap: straight between a point of one drum (or the base) and one of a drum above it, outside the stone.

    Parameters
    ----------
    at : (float, float)
        Place of both ends in plan, from the column's axis [m].
    to : (float, float), optional
        Place of the upper end, where it differs.
    from_drum, to_drum : int
        Drums that it ties; 0 is the base, the upper one is the topmost if left out.
    from_height, to_height : float, optional
        Height of its ends above the base [m], of the column as built; half of the drum's height if left out, and 0 at the
        base.
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

    to: tuple[float, float] | None = None
    from_drum: int = 0
    to_drum: int | None = None
    from_height: float | None = None
    to_height: float | None = None
    diameter: float | None = None
    material: str | None = None
    axial_stiffness: float | None = None
    axial_capacity: float | None = None
    ultimate_elongation: float | None = None
    pretension: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.to is not None:
            _pair(self, "to")
        _number(self, "from_drum", 0)
        if self.to_drum is not None:
            _number(self, "to_drum")
            if self.to_drum <= self.from_drum:
                raise InputError(
                    f"a {self.kind} goes from drum {self.from_drum} to drum {self.to_drum}; the second must be the higher "
                    "one."
                )
        for name in ("from_height", "to_height"):
            self._range(name, -LONGEST, 1e3, "m")
        self._material(self.material, self.diameter)
        self._range("diameter", 1e-4, 1.0, "m")
        self._range("axial_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("axial_capacity")
        self._range("ultimate_elongation", 0.0, LONGEST, "m", open_low=True)
        self._range("pretension", 0.0, STRONGEST, "N")
        if self.material is None and self.axial_stiffness is None:
            raise InputError(f"a {self.kind} has neither material nor axial_stiffness; give one of the two.")


@dataclass(frozen=True, kw_only=True)
class Core(Tie):
    """A bar in a hole through the drums, anchored at its two ends only; parameters as for :class:`Tie`.

    From the base to the top of the topmost drum, unless said otherwise; a drum's own end is its far face.
    """

    kind: ClassVar[str] = "core"


@dataclass(frozen=True, kw_only=True)
class Layer(Link):
    """A layer in a joint, the one with the base first: low friction, a restoring spring, a dashpot; all act on its slip.

    Parameters
    ----------
    joint : int
        From 1 at the base.
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

    joint: int
    friction_coefficient: float | None = None
    shear_stiffness: float = 0.0
    shear_capacity: float | None = None
    damping: float = 0.0
    ultimate_slip: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        _number(self, "joint")
        self._range("friction_coefficient", 0.0, 10.0, "")
        self._range("shear_stiffness", 0.0, STIFFEST, "N/m")
        self._capacity("shear_capacity")
        self._range("damping", 0.0, THICKEST, "N s/m")
        self._range("ultimate_slip", 0.0, LONGEST, "m", open_low=True)
        if self.friction_coefficient is None and not self.shear_stiffness and not self.damping:
            raise InputError("a layer has neither friction_coefficient, shear_stiffness nor damping; give one.")


def _pair(link: Any, name: str) -> None:
    value = getattr(link, name)
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise InputError(f"{name} of a {link.kind} is {as_typed(value)}; it must be a place in plan, [x, y] in m.")
    place = tuple(check_range(f"{name} of a {link.kind}", one, -LONGEST, LONGEST, unit="m") for one in value)
    object.__setattr__(link, name, place)


def _number(link: Any, name: str, least: int = 1) -> None:
    value = getattr(link, name)
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        said = repr(value) if not isinstance(value, float) or math.isfinite(value) else str(value)
        raise InputError(f"{name} of a {link.kind} is {said}; allowed is a whole number from {least}.")
