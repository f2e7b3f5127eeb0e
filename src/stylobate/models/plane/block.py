"""A block of lanes of bodies in the plane: the engine's records, the way of a run into them, and what they tell."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...kernels.shared.records import STATE
from ...motion import Motion
from ..drums.bodies import Topology
from ..drums.records import LaneRecords
from .laws import Types


class Records(LaneRecords):
    """Records of bodies in the plane; others as for :class:`LaneRecords`.

    Parameters
    ----------
    types : mapping of str to dtype
        Of :mod:`stylobate.models.plane.laws`.
    """

    axes_of_base = 2

    def __init__(self, types: Types, topology: Topology, spare: int = 0) -> None:
        from ...kernels.plane import step

        super().__init__(types, topology, len(topology.joints), spare)
        self.types, self.kernel = types, step

    def forces(self, lane: int) -> tuple[np.ndarray, ...]:
        """Force along x and z [N] and moment [N m] on every body in its present position, on a copy; shapes (N,)."""
        state = self.now()
        state[STATE.index("lane")]["dt"][0, lane] = 0.0
        self.kernel.gather(state)
        body = state[STATE.index("body")]
        return tuple(body[name][:, lane] for name in ("fx", "fz", "mo"))

    def ledgers(
        self, state: tuple[Any, ...], lanes: np.ndarray, dt: np.ndarray, bases: np.ndarray, out: np.ndarray
    ) -> None:
        """Write the ledgers of lanes of a state whose forces are those of its positions."""
        self.kernel.ledgers(state, np.ascontiguousarray(bases), dt, lanes, out)

    def joint_states(self, lanes: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
        """Opening of every joint, and where the body above it is along it [m], each of shape (lanes, joints)."""
        opening, slip = np.empty((2, len(lanes), len(self.joint)))
        self.kernel.joint_states(self.state, np.array(lanes, dtype=np.int64), opening, slip)
        return opening, slip

    def acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        fx, fz, mo = self.forces(lane)
        free = self.span["fixed"] == 0
        ax = (fx * self.body["im"][:, lane] - self.lane["gx"][0, lane])[free]
        az = (fz * self.body["im"][:, lane] - self.lane["g"][0, lane])[free]
        edge = np.zeros(len(self.body))
        np.maximum.at(edge, self.pair["upper"][: len(self.joint)].astype(int), self.edges(lane))
        turn = (mo * self.body["ii"][:, lane] * edge)[free]
        return float(np.abs(np.concatenate((ax, az, turn))).max())

    def edges(self, lane: int) -> np.ndarray:
        """Distance of the ends of every joint's upper face from the centroid's foot on it, at most [m], shape (joints,)."""
        return np.maximum(self.joint["bl"][:, lane], self.joint["br"][:, lane])


def slope_base(records: Records, lane: int, motion: Motion, slope: float) -> None:
    """Let a lane's base move along a slope [rad], and note the largest accelerations across gravity and along it."""
    feed, watch = records.feed[0], records.watch[0]
    feed["bc"][lane], feed["bs"][lane] = math.cos(slope), math.sin(slope)
    peak_x, peak_z = motion.pga, motion.peaks.get("z", 0.0)
    watch["amax"][lane] = peak_x * math.cos(slope) + peak_z * abs(math.sin(slope))
    watch["vmax"][lane] = peak_x * abs(math.sin(slope)) + peak_z * math.cos(slope)
