"""Columns in the plane in blocks of lanes: how a run begins, goes on and ends, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...column import Column
from ...column.link_loads import is_pretensioned
from ...constants import DEGREE
from ...errors import InputError
from ...kernels.run_codes import CHUNK, COLLAPSED, FAILED, FREE, RUNNING
from ...outcome import Outcome, classify
from ...response import Collapse, LinkMeasures, Measures
from ...response.collapse import in_plane, what_is_lost
from ..base import Case, RunOptions
from ..drums.barriers import lowest_barrier
from ..drums.histories import ledger_imbalance
from ..drums.links import acting
from ..drums.packing import whole_steps
from ..drums.pretension import held_at_start, set_free, without_tension
from ..shared import ledger, quiet
from ..shared.lanes import longest_piece
from ..start import check_in_plane, check_takes_pose
from .block import Law, Records, base_acceleration, clear_watch, feed_motion
from .links import link_measures, link_snapshot
from .packing import Packed, Topology
from .pose import leans_right, placed, sink
from .standing import stands_for_good

#: Calls of the kernel per run.
CALLS_PER_RUN = 100


class ColumnLanes:
    """See :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    law : Law
        Of the joints.
    pack : callable
        Gives the numbers of a column.
    topology : Topology
        Of every column in this block.
    options : RunOptions
    cost : float
        About what a step of a run costs [s].
    """

    def __init__(
        self, law: Law, pack: Callable[[Column], Packed], topology: Topology, options: RunOptions, cost: float
    ) -> None:
        self.records, self.pack, self.options = Records(law, topology), pack, options
        self.lanes, self.chunk = self.records.lanes, CHUNK
        self.feed, self.watch = self.records.feed, self.records.watch
        self.tied = bool(topology.links)
        self.watch["status"] = FREE
        self.dt = np.zeros(self.lanes)
        self.steps = np.zeros(self.lanes, dtype=np.int64)
        self.start = np.zeros((self.lanes, 6))
        self.slip = np.zeros((self.lanes, topology.stack))
        self.rest = np.zeros(self.lanes)
        self.pressed = np.zeros(self.lanes)
        self.stood = np.zeros((self.lanes, 2, topology.stack))
        self.cases: list[Case | None] = [None] * self.lanes
        self.spans = quiet.Spans(self.lanes, options, self.chunk)
        self.chunks_per_call = 1
        self.piece = longest_piece(cost, self.chunk)

    # -- how a run begins ----------------------------------------------------------------------------------------

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        self.cases[lane] = case
        column, motion = case
        packed, records = self.pack(column), self.records
        records.put(lane, packed)
        dt, chunks = whole_steps(motion, self.options.tail, packed.step)
        steps = chunks * self.chunk
        records.lane["dt"][0, lane] = dt
        if self.tied:
            records.link["dt"][:, lane] = dt
        clear_watch(records, lane, self.options.until_end)
        feed_motion(records, lane, motion, dt, column.as_found.base_tilt * DEGREE)
        feed, watch, body = self.feed[0], self.watch[0], records.body
        feed["step"][lane], feed["end"][lane] = self.spans.begin(lane, case, dt, steps)
        for name, value in packed.top.items():
            watch[name][lane] = value
        self.slip[lane] = records.joint_state(lane)[1]
        self.stood[lane] = body["x"][1:, lane], body["z"][1:, lane]
        watch["stood"][lane] = self.top(lane)
        self.dt[lane] = dt
        self.steps[lane] = steps
        self.chunks_per_call = max(1, chunks // CALLS_PER_RUN)
        self.begin(lane, column)

    def begin(self, lane: int, column: Column) -> None:
        """Take the start's pose, if there is one; velocities half a step before the start, and the energy there.

        Raises
        ------
        InputError
            A pose that this column does not take.
        """
        start = self.options.start
        self.rest[lane] = 0.0
        if start is not None:
            check_takes_pose(start, column)
            self.rest[lane] = -self.energies(lane)[2:4].sum()
            self.take_pose(lane, column, start)
        self.half_a_step_back(lane)
        self.start[lane] = self.energies(lane)
        self.pressed[lane] = self.pressed_joints(lane, column)
        if start is not None:  # what the pose and the velocity hold above the column upright
            self.rest[lane] += self.start[lane, 1:4].sum()

    def take_pose(self, lane: int, column: Column, start: Any) -> None:
        """Tilt a column that stands in a lane."""
        check_in_plane(start, "a model in the plane")
        records = self.records
        fields, (push, lift) = placed(start, records, lane, column.gravity)
        for name, values in fields.items():
            records.body[name][:, lane] = values
        records.joint["fs"][0, :, lane] = 0.0
        records.joint["fs"][0, -1 if leans_right(start) else 0, lane] = push
        sink(records, lane, lift)

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start; without a pose, of drums that do not move yet in a base that may."""
        half, records = 0.5 * self.dt[lane], self.records
        body = records.body
        ground = self.ground_acceleration(lane)
        turn: float | np.ndarray = 0.0
        if self.options.start is not None:
            fx, fz, mo = (one[1:] for one in records.forces(lane))
            ground = (
                ground[0] - fx * body["im"][1:, lane],
                ground[1] + records.lane["g"][0, lane] - fz * body["im"][1:, lane],
            )
            turn = mo * body["ii"][1:, lane]
        body["vx"][1:, lane] += half * ground[0]
        body["vz"][1:, lane] += half * ground[1]
        body["w"][1:, lane] -= half * turn

    def pressed_joints(self, lane: int, column: Column) -> float:
        """Energy at the start of joints that pretension presses, above that of joints under their weight alone [J].

        Their elastic energy is larger by more than this, because what stands on them has sunk. Where only the pretension
        holds the column up there is no weight alone, and all that the joints hold counts.
        """
        if not is_pretensioned(column):
            return 0.0
        held = held_at_start(column)
        try:
            packed = self.pack(without_tension(column))
        except InputError:  # it cannot stand
            return float(self.start[lane, 3]) - held
        bare = Records(self.records.law, Topology.of_column(without_tension(column)))
        bare.put(0, packed)
        bare.feed[...] = self.feed
        alone = bare.energies(0, float(self.dt[lane]), self.ground_acceleration(lane))
        return float((self.start[lane] - alone)[2:4].sum()) - held

    # -- how it goes on ------------------------------------------------------------------------------------------

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by some chunks of steps."""
        left = min(self.chunks_per_call, self.piece) if chunks is None else chunks
        running = np.count_nonzero(self.running())
        while left > 0 and np.count_nonzero(self.running()) == running:
            count = min(left, self.piece)
            self.records.law.advance(self.records.state, count)
            left -= count

    def running(self) -> np.ndarray:
        """Which lanes' runs go on, shape (lanes,)."""
        return self.watch["status"][0] == RUNNING

    def follow(self, chunks: int, between: Callable[[], None]) -> None:
        """Advance the run in the first lane by some chunks, or to its end, however often others end on the way.

        The kernel stops where any run ends, and goes on moving what is left in its lane: ``between`` collects it at once.
        """
        goal = int(self.feed["step"][0, 0]) + chunks * self.chunk
        while not self.is_over(0) and (left := goal - int(self.feed["step"][0, 0])) > 0:
            self.advance(left // self.chunk)
            between()

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended; one that still moves after the shaking, or is shaken again, goes on."""
        feed, watch = self.feed[0], self.watch[0]
        others = (RUNNING, COLLAPSED, FAILED)
        if watch["status"][lane] not in others and feed["end"][lane] < self.steps[lane]:
            now = int(feed["step"][lane])
            first, end = self.spans.onward(lane, now, int(self.steps[lane]), self.at_rest(lane))
            if end > now:
                feed["step"][lane], feed["end"][lane] = first, end
                watch["status"][lane] = RUNNING
                self.records.lane["dt"][0, lane] = self.dt[lane]
        return watch["status"][lane] != RUNNING

    def at_rest(self, lane: int) -> bool:
        """Whether a lane's column has next to no energy above that at its start."""
        column = self.column(lane)
        change = self.energies(lane) - self.start[lane]
        free = 0.0  # what pretension has given away is not missing from the motion
        if self.tied:
            free = set_free(column, self.records.link["ft"][:, lane], float(self.pressed[lane]))
        return float(change[1] + change[2] + change[3]) + free < quiet.AT_REST * lowest_barrier(column)

    # -- what it tells -------------------------------------------------------------------------------------------

    def column(self, lane: int) -> Column:
        """The column in a lane."""
        case = self.cases[lane]
        assert case is not None
        return case.column

    def time(self, lane: int) -> float:
        """Time of the lane's present state [s]."""
        return float(self.feed["step"][0, lane]) * self.dt[lane]

    def ground_acceleration(self, lane: int) -> tuple[float, float]:
        """Acceleration of the base along and normal to it now [m/s²]."""
        case = self.cases[lane]
        assert case is not None
        return base_acceleration(self.records, lane, case.motion, self.time(lane))

    def top(self, lane: int) -> float:
        """Place of the middle of the topmost face along the base [m]."""
        b, w = self.records.body[-1], self.watch[0]
        return float(b["x"][lane] - (b["s"][lane] * w["tc"][lane] + b["c"][lane] * w["ts"][lane]) * w["th"][lane])

    def energies(self, lane: int) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J]."""
        return self.records.energies(lane, float(self.dt[lane]), self.ground_acceleration(lane))

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration of a drum in its present position without input; of its edge, where it turns [m/s²]."""
        return self.records.acceleration(lane)

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        body = self.records.body
        opening, slip = self.records.joint_state(lane)
        bottom = body[1]
        state = {
            "time": self.time(lane),
            "x": body["x"][1:, lane] - self.stood[lane, 0],
            "z": body["z"][1:, lane] - self.stood[lane, 1],
            "rotation": body["th"][1:, lane].copy(),
            "opening": opening,
            "slip": slip - self.slip[lane],
            "base": bottom["x"][lane] + bottom["s"][lane] * self.records.joint["hb"][0, lane],
            "top": self.top(lane) - self.watch["stood"][0, lane],
            "energy": self.energies(lane),
        }
        return state | ({"links": link_snapshot(self.records.link, lane)} if self.tied else {})

    def links_done(self, lane: int) -> tuple[LinkMeasures, ...]:
        """What a lane's run has come to for each link."""
        links = acting(self.column(lane)) if self.tied else ()
        return link_measures(links, self.records.link, lane, float(self.dt[lane]))

    def held_by_links(self, lane: int) -> float:
        """Energy of pretension at the start, in links and in the joints that they press, which may be set free [J]."""
        return held_at_start(self.column(lane)) + float(self.pressed[lane]) if self.tied else 0.0

    def begun(self, lane: int, change: np.ndarray) -> float:
        """What a run started with, for its imbalance: its elastic energy, or what the pose and the velocity hold [J]."""
        begun = float(self.start[lane, 3])
        if self.options.start is not None:
            begun = max(begun, float(self.start[lane, 1]), abs(float(change[1])))
        return begun

    def peak(self, lane: int, name: str) -> float:
        """A peak of the watch; of a column that has collapsed, as it was when the fall began."""
        watch = self.watch[0]
        return float(watch["k" + name if watch["when"][lane] >= 0 else name][lane])

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run is over."""
        column, watch = self.column(lane), self.watch[0]
        status = watch["status"][lane]
        change = self.energies(lane) - self.start[lane]
        imbalance = ledger_imbalance(change, float(watch["wmax"][lane]), self.begun(lane, change), column)
        slip = self.records.joint_state(lane)[1] - self.slip[lane]
        failed = status == FAILED or bool(ledger.out_of_balance(imbalance))
        widths = column.joint_widths
        outcome = classify(
            status == COLLAPSED, failed, float(watch["open"][lane] / widths.min()), float((np.abs(slip) / widths).max())
        )
        return Measures(
            outcome=outcome,
            decided=outcome is Outcome.COLLAPSED or (not failed and self.stays(lane, slip, change)),
            collapse_time=float(watch["when"][lane] * self.dt[lane]) if watch["when"][lane] >= 0 else math.nan,
            peak_top_displacement=self.peak(lane, "top"),
            residual_top_displacement=self.top(lane) - float(watch["stood"][lane]),
            peak_rotation=self.peak(lane, "turn"),
            peak_joint_opening=self.peak(lane, "open"),
            residual_joint_slip=float(np.abs(slip).max()),
            energy_imbalance=imbalance,
            time_step=float(self.dt[lane]),
            steps=int(self.feed["step"][0, lane] - self.spans.left_out[lane]),
            reason=self.reason(lane, outcome, imbalance),
            collapse=self.collapse(lane) if outcome is Outcome.COLLAPSED else None,
            stepped=self.spans.stepped(lane, int(self.feed["step"][0, lane]), float(self.dt[lane])),
            links=self.links_done(lane),
        )

    def stays(self, lane: int, slip: np.ndarray, change: np.ndarray) -> bool:
        """Whether the column in a lane, with these slips [m] and this change of its ledger [J], stands for good."""
        column = self.column(lane)
        mechanical = float(change[1] + change[2] + change[3] + self.rest[lane]) + self.held_by_links(lane)
        return bool(stands_for_good(column, self.records, lane, slip, mechanical, self.pack(column).toes))

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane: what is lost turns about the joint that is widest open, there or higher up."""
        watch = self.watch[0]
        parted = bool(watch["parted"][lane])
        joint = 1 + int(watch["which" if parted else "about"][lane])
        time = float(watch["when"][lane] * self.dt[lane])
        return in_plane(time, joint, float(watch["side"][lane]), slid_off=parted)

    def reason(self, lane: int, outcome: Outcome, imbalance: float) -> str:
        """Why a run failed, or what happened in a collapse; empty for a column that stands."""
        if outcome is Outcome.FAILED:
            if self.watch["status"][0, lane] == FAILED:
                return f"the state is not finite at {self.time(lane):.4g} s; try a smaller step_factor"
            return ledger.out_of_balance(imbalance)
        if outcome is not Outcome.COLLAPSED:
            return ""
        lost = self.collapse(lane)
        return f"{what_is_lost(lost, self.column(lane).n)}, to the {lost.side}"
