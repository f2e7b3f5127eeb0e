"""Clamps between blocks side by side: what they are, and their formulas."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from ...errors import InputError
from .dowel import Pin, given, shear_limits, shear_stiffness
from .link import LONGEST, STIFFEST, Lies, Mark, Numbers, Site
from .materials import MATERIALS


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

    def held(self, site: Site) -> Numbers:
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
            ultimate = given(ultimate, lost)
        assert stiffness is not None
        return Numbers(
            **across,
            lift=given(self.embedment, math.inf),
            axial_stiffness=stiffness,
            axial_capacity=given(capacity, math.inf),
            ultimate_elongation=given(ultimate, math.inf),
            axial_failure=failure or "ductile",
            governs=f"across: {in_groove}; along: {governs}",
        )
