"""Ties and straps outside the stone: what they are, and their formulas."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from ...errors import InputError
from .dowel import given
from .line import Line
from .link import LONGEST, STIFFEST, STRONGEST, Numbers, Site
from .materials import MATERIALS


@dataclass(frozen=True, kw_only=True)
class Tie(Line):
    """A tie or strap: straight between a point of one drum (or the base) and one of a drum above it, outside the stone.

    Parameters
    ----------
    at, to, from_drum, to_drum, from_height, to_height : optional
        Its ends, as of :class:`~stylobate.column.links.line.Line`; at half of a drum's height where none is given.
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

    def held(self, site: Site) -> Numbers:
        """A straight bar of its length: E A/ℓ and f_y A."""
        governs = "as given"
        stiffness, capacity, ultimate = self.axial_stiffness, self.axial_capacity, self.ultimate_elongation
        if self.material is not None:
            made, d = MATERIALS[self.material], self.diameter
            assert d is not None
            area = math.pi * d * d / 4.0
            stiffness = given(stiffness, made.modulus * area / site.length)
            if capacity is None:
                capacity, governs = made.tensile_strength * area, "yield of the bar"
            ultimate = given(ultimate, made.ultimate_strain * site.length)
        assert stiffness is not None
        return Numbers(
            diameter=self.diameter or 0.0,
            axial_stiffness=stiffness,
            axial_capacity=given(capacity, math.inf),
            ultimate_elongation=given(ultimate, math.inf),
            pretension=self.pretension,
            governs=governs,
        )
