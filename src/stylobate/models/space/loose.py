"""One lane of bodies in space of which any two may touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...kernels.run_codes import FAILED
from ...kernels.space.records import types, workspace, workspace_of_joints
from .solids import FacesJoined, Solid, pack, pack_joints

#: Below this speed the restitution of a contact acts like a dashpot [m/s].
CALM = 0.02

#: Skin of the spheres of the contact search, as a share of the smallest body's radius.
SKIN = 0.1


class Loose:
    """One lane of bodies in space of which any two may touch, and the search for what does.

    Parameters
    ----------
    solids : sequence of Solid
    law : array
        k_n, k_s [N/m³] and tan φ between any two bodies, shape (N, N, 3); the pair's lower number first.
    gravity : sequence of float
        As an acceleration of the base: up is positive [m/s²].
    restitution : float
        Share of the closing speed that contacts give back: 1 is elastic.
    stiffness_damping : float
        [s]
    joints : sequence of FacesJoined
    """

    def __init__(
        self,
        solids: Sequence[Solid],
        law: np.ndarray,
        gravity: Sequence[float],
        restitution: float = 1.0,
        stiffness_damping: float = 0.0,
        joints: Sequence[FacesJoined] = (),
    ) -> None:
        from ...kernels.space import step as kernel

        self.kernel, kinds = kernel, types()
        self.packed = packed = pack(solids)
        n, e = len(packed.shape), restitution
        self.now, self.feed, ground = (
            np.zeros(rows, kinds[name]) for name, rows in (("now", 1), ("feed", 1), ("ground", 33))
        )
        self.feed["r"][0, :, 0] = np.eye(3).ravel()
        now = self.now
        now["g"], now["beta"], now["touched"] = gravity, stiffness_damping, -1
        now["eta"], now["calm"] = (1.0 - e * e) / (1.0 + e * e), CALM
        now["skin"] = SKIN * min(row["r"] for row in packed.body if not row["fixed"])
        most = n * (n - 1) // 2
        self.pair, spare = np.zeros(most, kinds["pair"]), np.zeros(most, kinds["pair"])
        self.joint, edge = pack_joints(joints, packed)
        self.state: tuple[Any, ...] = (
            packed.body, packed.shape, packed.vertex, packed.plane, packed.loop, packed.corner, self.pair, spare,
            self.joint, edge, np.ascontiguousarray(law), now, self.feed, ground, workspace(), workspace_of_joints(), np.zeros((4, 3)),
        )  # fmt: skip
        self.body = packed.body

    def start(self, step: float) -> None:
        """Set the step; velocities half a step back, as the forces at the start ask for."""
        self.now["dt"] = step
        self.now["last"] = 0.0
        self.kernel.list_all(self.state)

    def advance(self, chunks: int) -> None:
        """Advance by some chunks of steps."""
        self.kernel.advance(self.state, chunks)

    @property
    def failed(self) -> bool:
        """Whether the state is no longer finite."""
        return bool(self.now["status"][0] == FAILED)
