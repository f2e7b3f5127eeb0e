"""Results of a run of drums: its histories, and the closure of its ledger."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...motion import Motion
from ...response import Histories
from ...response.poses import quaternions
from ..shared import ledger
from ..shared.ground import ground_histories
from .links import with_link_histories


def ledger_imbalance(change: ledger.Row, work: float, start: float, barrier: float) -> float:
    """Energy imbalance of a run of drums [-].

    Parameters
    ----------
    change : array or sequence of float
        The ledger, shape (6,) [J].
    work, start : float
        Largest input work so far, and the elastic energy at rest [J].
    barrier : float
        Lowest energy that overturns what stands there [J].
    """
    missing, free = ledger.unaccounted(change), ledger.released(change)
    return ledger.imbalance(missing, work=work, start=start, barrier=barrier, released=free)


def histories(motion: Motion, states: Sequence[dict[str, Any]]) -> Histories:
    """Histories from the snapshots of a run, in the plane or in space."""
    stack = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    energy, in_space = stack["energy"], "axes" in stack
    acceleration, displacement = ground_histories(motion, stack["time"])
    absolute = ("input",) if in_space else ("input", "kinetic")
    shared: dict[str, Any] = {
        "time": stack["time"],
        "joint_opening": stack["opening"],
        "joint_slip": stack["slip"],
        "base_displacement": stack["base"] - stack["base"][0],
        "top_displacement": stack["top"],
        "ground_acceleration": acceleration,
        "ground_displacement": displacement,
        "energy": {
            term: energy[:, i] - (0.0 if term in absolute else energy[0, i]) for i, term in enumerate(ledger.TERMS)
        },
    }
    if in_space:
        orientation = quaternions(stack["axes"])
        found = Histories.in_space(
            **shared, position=stack["position"], orientation=orientation, joint_twist=stack["twist"]
        )
    else:
        found = Histories.of_drums(**shared, drum_x=stack["x"], drum_z=stack["z"], drum_rotation=stack["rotation"])
    return with_link_histories(found, states)
