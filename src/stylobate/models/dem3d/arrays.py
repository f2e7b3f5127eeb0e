"""Records of bodies in space over lanes, and what a lane reads as."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...kernels.shared.records import GROUND, STATE
from ..drums.bodies import Topology
from ..drums.records import LaneRecords


class Records(LaneRecords):
    """Records of bodies of which each stands on the one below; others as for :class:`LaneRecords`.

    Parameters
    ----------
    kernel : module
        Of the engine.
    """

    axes_of_base = 3

    def __init__(self, kernel: Any, types: Mapping[str, np.dtype], topology: Topology, joints: int) -> None:
        super().__init__(types, topology, joints, spare=1)  # for what all loads of a body add up to
        self.kernel = kernel

    def put(self, lane: int, numbers: np.ndarray) -> None:
        """Write all numbers of a lane."""
        super().put(lane, numbers)
        if "near" in (self.lane.dtype.names or ()):
            self.look_at_all_vertices()

    def look_at_all_vertices(self) -> None:
        """Let every vertex count as near the ground: the engine finds those that are before it steps."""
        every = np.arange(len(self.joint))
        self.lane["near"].reshape(-1)[every] = every
        self.lane["count"] = len(every)

    # -- looks at a lane, which change nothing that matters ------------------------------------------------------

    def ledgers(
        self, state: tuple[Any, ...], lanes: np.ndarray, dt: np.ndarray, bases: np.ndarray, out: np.ndarray
    ) -> None:
        """Write the ledgers of lanes of a state whose forces are those of its positions."""
        state[GROUND]["a"][0][:, lanes] = bases.T  # filled anew before the next step
        self.kernel.ledgers(state, dt, lanes, out)

    def net(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Forces [N] and moments [N m] of their contacts on every body in its present position, each of shape (n, 3)."""
        state = self.now()
        state[STATE.index("lane")]["dt"][0, lane] = 0.0
        self.kernel.gather(state)
        return self.body["f"][1:, :, lane], self.body["mo"][1:, :, lane]

    # of a lane, or of an array of them, whose axis comes first

    def joints(self, lane: int | np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Opening of every joint [m], and since the start its slip where it is closest [m], and twist with full turns [rad].

        Shapes (…, n), (…, n, 2), (…, n).
        """
        size = np.size(lane), len(self.body) - 1
        opening, slip, twist = np.empty(size), np.empty((*size, 2)), np.empty(size)
        self.kernel.joint_states(self.state, np.atleast_1d(lane), opening, slip, twist)
        one: Any = ... if np.ndim(lane) else 0
        return opening[one], slip[one], twist[one]

    def places(self, lane: int | np.ndarray) -> np.ndarray:
        """Centroids of all bodies [m], shape (…, n, 3)."""
        return self.vectors(lane, "x y z")

    def axes(self, lane: int | np.ndarray) -> np.ndarray:
        """Axes of every body as the columns of a matrix [-], shape (…, n, 3, 3)."""
        found = np.empty((*np.shape(lane), len(self.body) - 1, 3, 3))
        for axis, a in enumerate("ijk"):
            self._put(found[..., axis], lane, (f"{a}x", f"{a}y", f"{a}z"))
        return found

    def vectors(self, lane: int | np.ndarray, names: str) -> np.ndarray:
        """Vectors of all bodies but the base, by the names of their fields, shape (…, n, 3)."""
        found = np.empty((*np.shape(lane), len(self.body) - 1, 3))
        self._put(found, lane, names.split())
        return found

    def _put(self, found: np.ndarray, lane: int | np.ndarray, names: Sequence[str]) -> None:
        for c, name in enumerate(names):
            found[..., c] = self.body[name][1:, lane].T

    def acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        force, moment = self.net(lane)
        im, ia, ib, ic, reach = (self.body[name][1:, lane] for name in ("im", "ia", "ib", "ic", "rb"))
        linear = np.abs(force * im[:, None] - self.lane["g"][0, :, lane]).max()
        easiest = ia + np.maximum(np.maximum(ib, ic), 0.0)  # about the axis of the least moment of inertia
        return float(max(linear, (np.abs(moment).max(axis=1) * easiest * reach).max()))
