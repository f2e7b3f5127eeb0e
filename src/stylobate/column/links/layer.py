"""Layers in joints, the one with the base first: low friction, a spring, a dashpot."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from ...errors import InputError
from .dowel import given
from .link import LONGEST, STIFFEST, THICKEST, Link, Mark, Numbers, Site


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

    def held(self, site: Site) -> Numbers:
        """All as given."""
        return Numbers(
            friction_coefficient=self.friction_coefficient,
            shear_stiffness=self.shear_stiffness,
            damping=self.damping,
            shear_capacity=given(self.shear_capacity, math.inf),
            ultimate_slip=given(self.ultimate_slip, math.inf),
            governs="as given",
        )
