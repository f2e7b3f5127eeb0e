"""Columns in the plane in blocks of lanes: how a run begins, goes on and ends, and what it comes to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...column import Column
from ...constants import DEGREE
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...response import Collapse
from ...response.collapse import in_plane
from ...response.residuals import Residuals
from ..base import RunOptions
from ..drums.bodies import Topology
from ..drums.lane_engine import Left
from ..drums.records import Packed
from ..drums.runs import LaneRuns
from ..drums.stepped import StackEngine
from ..start import check_in_plane
from .block import Records, slope_base
from .laws import Types
from .pose import leans_right, placed, sink_in
from .standing import numbers_for


def residuals_in(state: dict[str, Any]) -> Residuals:
    """Residuals of a column by the state in which it is left."""
    return Residuals.in_plane(*(state[name] for name in ("slip", "x", "z", "rotation")))


class ColumnLanes(LaneRuns):
    """See :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    types : mapping of str to dtype
        Of the records, by the law of the joints.
    pack : callable
        Gives the numbers of a column.
    topology : Topology
        Of every column in this block.
    options : RunOptions
    cost : float
        About what a step of a run costs [s].
    """

    def __init__(
        self, types: Types, pack: Callable[[Column], Packed], topology: Topology, options: RunOptions, cost: float
    ) -> None:
        self.records = records = Records(types, topology)
        super().__init__(pack, records, options, cost)
        self.slip = np.zeros((self.lanes, topology.stack))
        self.placed = np.zeros((self.lanes, 2, topology.stack))

    def lean(self) -> np.ndarray:
        """Rotation of the lowest body of each lane, towards +x [rad]."""
        return -self.records.body["th"][1]

    def leans(self) -> np.ndarray:
        """The same, and none across the plane, shape (2, lanes)."""
        lean = self.lean()
        return np.stack([lean, np.zeros_like(lean)])

    # -- how a run begins ----------------------------------------------------------------------------------------

    def shake(self, lane: int, motion: Motion) -> None:
        """Note how the base of a lane moves."""
        slope_base(self.records, lane, motion, self.column(lane).as_found.base_tilt * DEGREE)

    @property
    def stood(self) -> tuple[np.ndarray, ...]:
        """Slips of joints, places of drums and of the top as the columns stood."""
        return self.slip, self.placed, self.watch["stood"][0]

    def stand(self, lane: int) -> None:
        """Note how a column stands in a lane."""
        body = self.records.body
        self.slip[lane] = self.records.joint_states([lane])[1][0]
        self.placed[lane] = body["x"][1:, lane], body["z"][1:, lane]
        self.watch["stood"][0, lane] = self.top(lane)

    def take_pose(self, lane: int, column: Column, start: Any) -> None:
        """Tilt a column that stands in a lane."""
        check_in_plane(start, "a model in the plane")
        records = self.records
        fields, (push, lift) = placed(start, records, lane, column.gravity)
        records.fill(lane, body=fields)
        records.joint["fs"][0, :, lane] = 0.0
        records.joint["fs"][0, -1 if leans_right(start) else 0, lane] = push
        sink_in(records, lane, lift)

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        self.records.kernel.advance(self.records.state, chunks)

    def energies_without_tension(self, lane: int, bare: Column) -> np.ndarray:
        """Ledger as if the column stood in a lane without its pretension; ``bare`` is that column [J]."""
        records = Records(self.records.types, Topology.of(bare))
        packed = self.pack(bare)
        records.put(0, packed.lane)
        records.bond[...], records.feed[...] = packed.bond, self.feed
        return records.energies([0], self.dt[lane:], self.ground_accelerations([lane]))[0]

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start; without a pose, of drums that do not move yet in a base that may."""
        half, records = 0.5 * self.dt[lane], self.records
        body = records.body
        ground = self.ground_acceleration(lane)
        turn: float | np.ndarray = 0.0
        if self.options.start is not None:
            fx, fz, mo = (force[1:] for force in records.forces(lane))
            ground = (
                ground[0] - fx * body["im"][1:, lane],
                ground[1] + records.lane["g"][0, lane] - fz * body["im"][1:, lane],
            )
            turn = mo * body["ii"][1:, lane]
        body["vx"][1:, lane] += half * ground[0]
        body["vz"][1:, lane] += half * ground[1]
        body["w"][1:, lane] -= half * turn

    # -- what it tells -------------------------------------------------------------------------------------------

    def top(self, lanes: Any) -> Any:
        """Place of the middle of the topmost face along the base [m], of a lane or of several."""
        b, w = self.records.body[-1], self.watch[0]
        return b["x"][lanes] - (b["s"][lanes] * w["tc"][lanes] + b["c"][lanes] * w["ts"][lanes]) * w["th"][lanes]

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        bottom = self.records.body[1]
        state = {name: values[0] for name, values in self.poses([lane]).items()} | {
            "time": self.time(lane),
            "base": bottom["x"][lane] + bottom["s"][lane] * self.records.joint["hb"][0, lane],
            "top": float(self.top(lane) - self.watch["stood"][0, lane]),
            "energy": self.energies(lane),
        }
        return state | self.links_now(lane)

    def poses(self, lanes: list[int]) -> dict[str, np.ndarray]:
        """Displacements and rotations of drums, openings and slips of joints, from how the columns stood.

        Of shape (lanes, n).
        """
        body, (opening, slip) = self.records.body, self.records.joint_states(lanes)
        x, z, rotation = (body[name][1:, lanes].T for name in ("x", "z", "th"))
        return {
            "x": x - self.placed[lanes, 0],
            "z": z - self.placed[lanes, 1],
            "rotation": rotation,
            "opening": opening,
            "slip": slip - self.slip[lanes],
        }

    def left(self, lanes: list[int]) -> Left:
        """What the runs of some lanes leave behind."""
        state = self.poses(lanes)
        slip, residuals = state["slip"], Residuals.all_in_plane(*(state[one] for one in ("slip", "x", "z", "rotation")))
        top = self.top(lanes) - self.watch["stood"][0, lanes]
        return Left(residuals, np.abs(slip), slip, top, self.peaks(lanes, "turn"))

    def stay(self, lanes: list[int], energy: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Whether columns that no input shakes any more can neither overturn nor slide apart, shape (lanes,).

        Two conditions, Eq. (V1). As the column is, the centroid of every part stands within its contact: it is on the near
        side of every barrier. And the energy is below the lowest barrier of the column put down flat with its present
        offsets: overturning as one body about the nearer end of the contact, m g (R − H); where some joint above is so
        slippery that it slides first, tan φ below the sine of the critical angle, sliding and lifting together:
        m g [tan φ b − H (1 − √(1 − tan² φ))]. On a slope H and b are measured along and across gravity, and friction is what
        the slope of the joint leaves of it. Soft joints give, and the barrier is lower by that,
        Eq. (V5).
        """
        from ...kernels.plane.standing import all_stand

        columns, records = [self.column(lane) for lane in lanes], self.records
        stand, offsets = zip(*map(numbers_for, columns), strict=True)
        stand = np.array([one.view(float) for one in stand]).view(stand[0].dtype)  # numpy stacks records field by field
        stand["toe"], stand["others"] = np.array([self.packed[lane].stand for lane in lanes]).swapaxes(0, 1)
        gravity, slope = np.array([(one.gravity, one.as_found.base_tilt * DEGREE) for one in columns]).T
        where, stays = np.array(lanes, dtype=np.int64), np.zeros(len(lanes), dtype=bool)
        numbers = offsets + slip, gravity.copy(), slope.copy(), energy
        all_stand(stand, *numbers, records.body, records.joint, where, stays)
        return stays

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane: what is lost turns about the joint that is widest open, there or higher up."""
        watch = self.watch[0]
        parted = bool(watch["parted"][lane])
        joint = 1 + int(watch["which" if parted else "about"][lane])
        time = float(watch["when"][lane] * self.dt[lane])
        return in_plane(time, joint, float(watch["side"][lane]), slid_off=parted)


class PlaneStack(StackEngine):
    """Base of the engines of columns in the plane; each gives the law of their joints."""

    def record_types(self, linked: bool, lanes: int = LANES) -> Types:
        """Types of the records by the law of the joints, for columns with links or without."""
        raise NotImplementedError

    def block_for(self, kind: Topology, options: RunOptions, lanes: int = LANES) -> ColumnLanes:
        """A block of lanes for columns of a kind."""
        types = self.record_types(bool(kind.links), lanes)
        return ColumnLanes(types, self.pack, kind, options, self.model.cost(kind.stack))
