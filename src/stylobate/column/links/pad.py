"""Pads that cover a joint, sheets of lead or rubber: what they are, and their formulas."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from ...constants import DEGREE
from ...errors import InputError, check_choice
from ..joint import Joint
from .link import Link, Mark, Numbers, Site


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

    def held(self, site: Site) -> Numbers:
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
