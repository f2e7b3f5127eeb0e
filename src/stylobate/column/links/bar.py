"""Bars anchored on both sides of a joint: what they are, and their formulas."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from ...errors import InputError
from .dowel import Dowel, given
from .link import LONGEST, STIFFEST, STRONGEST, Mark, Numbers, Site
from .materials import MATERIALS

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

    def held(self, site: Site) -> Numbers:
        """As a dowel, and against opening by even bond over its embedment in both drums."""
        across, axial = self.across(self.embedment), self._anchored()
        governs = f"{across.pop('governs')}; {axial.pop('governs')}"
        return Numbers(**across, **axial, **self.stone(), lift=given(self.embedment, math.inf), governs=governs)

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
                    "bond to the stone": math.pi * d * length * given(self.bond, BOND),
                }
                governs = min(limits, key=lambda name: limits[name])
                capacity = limits[governs]
            ultimate = given(ultimate, made.ultimate_strain * length)
        assert stiffness is not None
        return {
            "axial_stiffness": stiffness,
            "axial_capacity": given(capacity, math.inf),
            "ultimate_elongation": given(ultimate, math.inf),
            "pretension": self.pretension,
            "governs": governs,
        }
