"""Histories of a run in space from what was kept of its states."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...motion import Motion
from ...response import Histories
from ...response.poses import quaternions
from ..drums.links import with_link_histories
from ..shared import ledger
from ..shared.ground import ground_histories


def histories(motion: Motion, states: Sequence[dict[str, Any]]) -> Histories:
    """Histories from the snapshots of a run."""
    stack = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    energy = stack["energy"]
    acceleration, displacement = ground_histories(motion, stack["time"])
    found = Histories.in_space(
        time=stack["time"],
        position=stack["position"],
        orientation=quaternions(stack["axes"]),
        joint_opening=stack["opening"],
        joint_slip=stack["slip"],
        joint_twist=stack["twist"],
        base_displacement=stack["base"] - stack["base"][0],
        top_displacement=stack["top"],
        ground_acceleration=acceleration,
        ground_displacement=displacement,
        energy={term: energy[:, i] - (0.0 if term == "input" else energy[0, i]) for i, term in enumerate(ledger.TERMS)},
    )
    return with_link_histories(found, states)
