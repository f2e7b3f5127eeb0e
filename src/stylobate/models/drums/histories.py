"""What a run of drums comes to: its histories, and how well its ledger closes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...motion import Motion
from ...response import Histories
from ..shared import ledger
from ..shared.ground import ground_histories
from .links import with_link_histories


def ledger_imbalance(change: np.ndarray, work: float, start: float, barrier: float) -> float:
    """Energy imbalance of a run of drums [-].

    Parameters
    ----------
    change : array
        The ledger, shape (6,) [J].
    work, start : float
        Largest input work so far, and the elastic energy at rest [J].
    barrier : float
        Lowest energy that overturns what stands there [J].
    """
    missing, free = ledger.unaccounted(change), ledger.released(change)
    return ledger.imbalance(missing, work=work, start=start, barrier=barrier, released=free)


def histories(motion: Motion, states: Sequence[dict[str, Any]]) -> Histories:
    """Histories from the snapshots of a run."""
    stack = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    energy = stack["energy"]
    acceleration, displacement = ground_histories(motion, stack["time"])
    found = Histories.of_drums(
        time=stack["time"],
        drum_x=stack["x"],
        drum_z=stack["z"],
        drum_rotation=stack["rotation"],
        joint_opening=stack["opening"],
        joint_slip=stack["slip"],
        base_displacement=stack["base"] - stack["base"][0],
        top_displacement=stack["top"],
        ground_acceleration=acceleration,
        ground_displacement=displacement,
        energy={
            name: energy[:, k] - (energy[0, k] if name not in ("input", "kinetic") else 0.0)
            for k, name in enumerate(ledger.TERMS)
        },
    )
    return with_link_histories(found, states)
