"""Materials of links, by name: stiffness and strength, each with its source."""

from __future__ import annotations

import math
from dataclasses import dataclass


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
