"""Scalar results of a run: the same facts, under the same names, for every model, single run or batch."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..outcome import Outcome


@dataclass(frozen=True)
class Measures:
    """What a run comes down to.

    Parameters
    ----------
    outcome : Outcome
    decided : bool
        False when the run ended while the column was still far from rest, so that the verdict could change.
    collapse_time : float
        Time at which the collapse became certain [s]; NaN without collapse.
    peak_top_displacement, residual_top_displacement : float
        Of the middle of the top face, relative to the base, largest absolute value and value at the end [m].
    peak_rotation : float
        Largest absolute rotation of any drum [rad].
    peak_joint_opening : float
        Largest opening of any joint, at the edge that opens most [m].
    residual_joint_slip : float
        Largest absolute offset that a drum has, at the end, along its joint [m].
    energy_imbalance : float
        Energy that the ledger cannot account for, relative to the largest input work so far, or to an energy of the column
        itself where that is larger (see the model's page) [-].
    time_step : float
        Step of the integration, the smallest if it varies [s].
    steps : int
        Steps taken.
    reason : str
        Mechanism of a collapse, or why a run failed; empty otherwise.
    """

    outcome: Outcome
    decided: bool
    collapse_time: float
    peak_top_displacement: float
    residual_top_displacement: float
    peak_rotation: float
    peak_joint_opening: float
    residual_joint_slip: float
    energy_imbalance: float
    time_step: float
    steps: int
    reason: str = ""

    @property
    def collapsed(self) -> bool:
        """Whether the column collapsed."""
        return self.outcome is Outcome.COLLAPSED

    def row(self) -> dict:
        """The facts under the names that scripts rely on: keys of ``stylobate run --json`` and table columns."""
        return {
            "outcome": self.outcome.label,
            "collapsed": self.collapsed,
            "decided": bool(self.decided),
            "collapse_time_s": None if math.isnan(self.collapse_time) else float(self.collapse_time),
            "peak_top_displacement_m": float(self.peak_top_displacement),
            "residual_top_displacement_m": float(self.residual_top_displacement),
            "peak_rotation_rad": float(self.peak_rotation),
            "peak_joint_opening_m": float(self.peak_joint_opening),
            "residual_joint_slip_m": float(self.residual_joint_slip),
            "energy_imbalance": float(self.energy_imbalance),
            "time_step_s": float(self.time_step),
            "steps": int(self.steps),
            "reason": self.reason,
        }
