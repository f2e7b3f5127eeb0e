"""A block of lanes of stacked drums: kernel arrays, the way of a case into them, and of its results out of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...column import Column
from ...constants import DEGREE
from ...kernels.run_codes import CHUNK, COLLAPSED, FAILED, FREE, LANES, RUNNING
from ...outcome import Outcome, classify
from ...response import Collapse, LinkMeasures, Measures
from ...response.collapse import in_plane, what_is_lost
from ..base import Case, RunOptions
from ..shared import ledger, quiet
from ..shared.ground import along_base
from ..shared.lanes import aligned_zeros, longest_piece
from ..start import check_in_plane
from .histories import ledger_imbalance
from .links import acting, link_measures, link_snapshot, put_links
from .packing import PackedColumn, whole_steps
from .pose import check_takes_pose, leans_right, placed, sink
from .pretension import held_at_start, pressed_joints, set_free
from .standing import lowest_barrier, stands_for_good

#: Calls of the kernel per run.
CALLS_PER_RUN = 100


class DrumBlock:
    """See :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    kernel : module
        Of the joints' law: ``forces``, ``ledger``, ``advance``.
    types : tuple of dtype
        Record types of the kernel's arrays.
    pack : callable
        Gives the numbers of a column.
    drums : int
        Number of drums of every column in this block.
    options : RunOptions
    cost : float
        About what a step of a run costs [s].
    links : int
        Number of links of every column in this block.
    """

    def __init__(
        self,
        kernel: Any,
        types: tuple,
        pack: Callable[[Column], PackedColumn],
        drums: int,
        options: RunOptions,
        cost: float,
        links: int = 0,
    ) -> None:
        self.kernel, self.pack, self.options = kernel, pack, options
        self.lanes = LANES
        self.chunk = CHUNK
        self.tied = links > 0
        self.drum = aligned_zeros(drums + 1, types[0])
        self.joint = aligned_zeros(drums + 1, types[1])
        self.lane = aligned_zeros(1 + links, types[2])
        self.ground = aligned_zeros(CHUNK + 1, types[3])
        self.feed = aligned_zeros(1, types[4])
        self.watch = aligned_zeros(1, types[5])
        self.watch["status"] = FREE
        self.dt = np.zeros(self.lanes)
        self.steps = np.zeros(self.lanes, dtype=np.int64)
        self.start = np.zeros((self.lanes, 6))
        self.slip = np.zeros((self.lanes, drums))
        self.rest = np.zeros(self.lanes)
        self.pressed = np.zeros(self.lanes)
        self.stood = np.zeros((self.lanes, 2, drums))
        self.cases: list[Case | None] = [None] * self.lanes
        self.spans = quiet.Spans(self.lanes, options, self.chunk)
        self.chunks_per_call = 1
        self.piece = longest_piece(cost, self.chunk)

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        self.cases[lane] = case
        column, motion = case
        packed = self.pack(column)
        for array, fields in zip((self.drum, self.joint, self.lane), packed.fields, strict=True):
            for name, values in fields.items():
                array[name][..., lane] = values
        self.joint["dn"][..., lane] = self.joint["ds"][..., lane] = 0.0
        dt, chunks = whole_steps(motion, self.options.tail, packed.step)
        steps = chunks * self.chunk
        self.lane["dt"][0, lane] = dt
        if packed.links is not None:
            put_links(self.lane, packed.links, lane, dt)
        x, z = motion.samples, motion.z_samples
        feed, watch = self.feed[0], self.watch[0]
        feed["x"][lane] = x.ctypes.data
        feed["z"][lane] = 0 if z is None else z.ctypes.data
        feed["last"][lane] = len(x) - 1
        feed["step"][lane], feed["end"][lane] = self.spans.begin(lane, case, dt, steps)
        feed["ratio"][lane] = dt / motion.dt
        feed["factor"][lane] = motion.factor
        slope = column.as_found.base_tilt * DEGREE
        feed["bc"][lane], feed["bs"][lane] = math.cos(slope), math.sin(slope)
        for name in watch.dtype.names:
            watch[name][lane] = 0
        watch["status"][lane] = RUNNING
        watch["follow"][lane] = self.options.until_end
        watch["when"][lane] = watch["which"][lane] = watch["wide"][lane] = -1
        peak_z = 0.0 if z is None else _peak(z) * abs(motion.factor)
        watch["amax"][lane] = motion.pga * math.cos(slope) + peak_z * abs(math.sin(slope))
        watch["vmax"][lane] = motion.pga * abs(math.sin(slope)) + peak_z * math.cos(slope)
        self.slip[lane, : column.n] = self.joint_state(lane)[1]
        self.stood[lane] = self.drum["x"][1:, lane], self.drum["z"][1:, lane]
        watch["stood"][lane] = self.top(lane)
        self.dt[lane] = dt
        self.steps[lane] = steps
        self.chunks_per_call = max(1, chunks // CALLS_PER_RUN)
        self.begin(lane)

    def begin(self, lane: int) -> None:
        """Take the start's pose, if there is one; velocities half a step before the start, and the energy there.

        Raises
        ------
        InputError
            A pose that this column or this model does not take.
        """
        case, start = self.cases[lane], self.options.start
        assert case is not None
        self.rest[lane] = 0.0
        if start is not None:
            self.check_start(case.column)
            self.rest[lane] = -self.energies(lane)[2:4].sum()
            self.take_pose(lane, case.column, start)
        self.half_a_step_back(lane)
        self.start[lane] = self.energies(lane)
        self.pressed[lane] = self.pressed_joints(lane, case.column) if self.tied else 0.0
        if start is not None:  # what the pose and the velocity hold above the column upright
            self.rest[lane] += self.start[lane, 1:4].sum()

    def check_start(self, column: Any) -> None:
        """Refuse a start that is not one for this column."""
        check_takes_pose(self.options.start, column)

    def take_pose(self, lane: int, column: Any, start: Any) -> None:
        """Tilt a column that stands in a lane."""
        check_in_plane(start, "a model in the plane")
        fields, (push, lift) = placed(start, self.drum, lane, column.gravity)
        for name, values in fields.items():
            self.drum[name][:, lane] = values
        self.joint["fs"][0, :, lane] = 0.0
        self.joint["fs"][0, -1 if leans_right(start) else 0, lane] = push
        joint, state = self.joint.copy(), self.lane.copy()
        state["dt"][0, lane] = 0.0

        def carried() -> float:
            self.kernel.forces(self.drum, joint, state)
            return float(joint["fz"][0, lane])

        sink(self.drum, lane, lift, carried)

    def pressed_joints(self, lane: int, column: Column) -> float:
        """Energy at the start of joints that pretension presses [J], see :mod:`.pretension`."""
        return pressed_joints(self, lane, column)

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start; without a pose, of drums that do not move yet in a base that may."""
        half, drum = 0.5 * self.dt[lane], self.drum
        ground = self.ground_acceleration(lane, self.time(lane))
        turn: float | np.ndarray = 0.0
        if self.options.start is not None:
            joint, state = self.joint.copy(), self.lane.copy()
            state["dt"][0, lane] = 0.0
            self.kernel.forces(self.drum, joint, state)
            net = {name: joint[name][:, lane] for name in ("fx", "fz", "mu_", "ml")}
            ground = (
                ground[0] - (net["fx"][:-1] - net["fx"][1:]) * drum["im"][1:, lane],
                ground[1] + state["g"][0, lane] - (net["fz"][:-1] - net["fz"][1:]) * drum["im"][1:, lane],
            )
            turn = (net["mu_"][:-1] - net["ml"][1:]) * drum["ii"][1:, lane]
        drum["vx"][1:, lane] += half * ground[0]
        drum["vz"][1:, lane] += half * ground[1]
        drum["w"][1:, lane] -= half * turn

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by some chunks of steps."""
        left = min(self.chunks_per_call, self.piece) if chunks is None else chunks
        running = np.count_nonzero(self.running())
        while left > 0 and np.count_nonzero(self.running()) == running:
            count = min(left, self.piece)
            self.step(count)
            left -= count

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        self.kernel.advance(self.drum, self.joint, self.lane, self.ground, self.feed, self.watch, chunks)

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
                self.lane["dt"][0, lane] = self.dt[lane]
        return watch["status"][lane] != RUNNING

    def at_rest(self, lane: int) -> bool:
        """Whether a lane's column has next to no energy above that at its start."""
        case = self.cases[lane]
        assert case is not None
        change = self.energies(lane) - self.start[lane]
        free = 0.0  # what pretension has given away is not missing from the motion
        if self.tied:
            free = set_free(case.column, self.lane["mft"][1:, lane], float(self.pressed[lane]))
        return float(change[1] + change[2] + change[3]) + free < quiet.AT_REST * lowest_barrier(case.column)

    def time(self, lane: int) -> float:
        """Time of the lane's present state [s]."""
        return float(self.feed["step"][0, lane]) * self.dt[lane]

    def ground_acceleration(self, lane: int, time: float) -> np.ndarray:
        """Acceleration of the base along and normal to it at a time [m/s²], shape (2,)."""
        case = self.cases[lane]
        assert case is not None
        slope = case.column.as_found.base_tilt * DEGREE
        return np.array(along_base(case.motion, time, math.cos(slope), math.sin(slope)))

    def put_ground(self, ground: np.ndarray, lane: int, acceleration: np.ndarray) -> None:
        """Write the base's acceleration as the kernel wants it."""
        ground["ax"][0, lane], ground["az"][0, lane] = acceleration

    def joint_state(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Opening of every joint, and where the drum above it is along it [m], each of shape (n,)."""
        opening, slip = np.empty(len(self.drum) - 1), np.empty(len(self.drum) - 1)
        self.kernel.joint_state(self.drum, lane, opening, slip)
        return opening, slip

    def top(self, lane: int) -> float:
        """Place of the middle of the topmost face along the base [m]."""
        d = self.drum[-1]
        return float(d["x"][lane] - (d["s"][lane] * d["fc"][lane] + d["c"][lane] * d["fs"][lane]) * d["ht"][lane])

    def energies(self, lane: int) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J]."""
        # the forces at the present positions, found as the next step will find them, on a copy
        return self.energies_of(lane, self.drum, self.joint.copy(), self.lane.copy())

    def energies_of(self, lane: int, drum: np.ndarray, joint: np.ndarray, state: np.ndarray) -> np.ndarray:
        """The same of these records, of which those of joints and lanes are changed."""
        ground = np.zeros(1, self.ground.dtype)
        self.put_ground(ground, lane, self.ground_acceleration(lane, self.time(lane)))
        state["dt"][0, lane] = self.dt[lane]
        self.kernel.forces(drum, joint, state)
        out = np.empty(6)
        self.kernel.ledger(drum, joint, state, ground, 0, self.dt[lane], lane, out)
        return out

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration of a drum in its present position without input; of its edge, where it turns [m/s²]."""
        joint, state = self.joint.copy(), self.lane.copy()
        self.kernel.forces(self.drum, joint, state)
        d = {name: self.drum[name][1:, lane] for name in ("im", "ii", "bl", "br")}
        net = {name: joint[name][:, lane] for name in ("fx", "fz", "mu_", "ml")}
        ax = (net["fx"][:-1] - net["fx"][1:]) * d["im"] - state["gx"][0, lane]
        az = (net["fz"][:-1] - net["fz"][1:]) * d["im"] - state["g"][0, lane]
        turn = (net["mu_"][:-1] - net["ml"][1:]) * d["ii"] * np.maximum(d["bl"], d["br"])
        return float(np.abs(np.concatenate((ax, az, turn))).max())

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        drum = self.drum
        opening, slip = self.joint_state(lane)
        bottom = drum[1]
        return {
            "time": self.time(lane),
            "x": drum["x"][1:, lane] - self.stood[lane, 0],
            "z": drum["z"][1:, lane] - self.stood[lane, 1],
            "rotation": drum["th"][1:, lane].copy(),
            "opening": opening,
            "slip": slip - self.slip[lane],
            "base": bottom["x"][lane] + bottom["s"][lane] * bottom["hb"][lane],
            "top": self.top(lane) - self.watch["stood"][0, lane],
            "energy": self.energies(lane),
        } | self.links_now(lane)

    def links_now(self, lane: int) -> dict[str, Any]:
        """What a snapshot keeps of the links, where there are some."""
        return {"links": link_snapshot(self.lane[1:], lane)} if self.tied else {}

    def links_done(self, lane: int) -> tuple[LinkMeasures, ...]:
        """What a lane's run has come to for each link."""
        case = self.cases[lane]
        assert case is not None
        return link_measures(acting(case.column), self.lane[1:], lane, float(self.dt[lane])) if self.tied else ()

    def held_by_links(self, lane: int) -> float:
        """Energy of pretension at the start, in links and in the joints that they press, which may be set free [J]."""
        case = self.cases[lane]
        assert case is not None
        return held_at_start(case.column) + float(self.pressed[lane]) if self.tied else 0.0

    def toes(self, column: Column) -> np.ndarray:
        """What a column's joints give with their load on their edge [J], shape (n,)."""
        return self.pack(column).toes

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
        case = self.cases[lane]
        assert case is not None
        watch = self.watch[0]
        status = watch["status"][lane]
        now = self.energies(lane)
        change = now - self.start[lane]
        imbalance = ledger_imbalance(change, float(watch["wmax"][lane]), self.begun(lane, change), case.column)
        slip = self.joint_state(lane)[1] - self.slip[lane, : case.column.n]
        collapsed = status == COLLAPSED
        failed = status == FAILED or bool(ledger.out_of_balance(imbalance))
        widths = case.column.joint_widths
        outcome = classify(
            collapsed, failed, float(watch["open"][lane] / widths.min()), float((np.abs(slip) / widths).max())
        )
        mechanical = float(change[1] + change[2] + change[3] + self.rest[lane]) + self.held_by_links(lane)
        return Measures(
            outcome=outcome,
            decided=outcome is Outcome.COLLAPSED
            or (not failed and stands_for_good(case.column, self.drum, lane, slip, mechanical, self.toes(case.column))),
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

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane: what is lost turns about the joint that is widest open, there or higher up."""
        watch = self.watch[0]
        parted = bool(watch["parted"][lane])
        joint = 1 + int(watch["which" if parted else "about"][lane])
        time = float(watch["when"][lane] * self.dt[lane])
        return in_plane(time, joint, float(watch["side"][lane]), slid_off=parted)

    def reason(self, lane: int, outcome: Outcome, imbalance: float) -> str:
        """Why a run failed, or what happened in a collapse; empty for a column that stands."""
        watch = self.watch[0]
        if outcome is Outcome.FAILED:
            if watch["status"][lane] == FAILED:
                return f"the state is not finite at {self.time(lane):.4g} s; try a smaller step_factor"
            return ledger.out_of_balance(imbalance)
        if outcome is not Outcome.COLLAPSED:
            return ""
        return f"{what_is_lost(self.collapse(lane), len(self.drum) - 1)}, {self.direction(lane)}"

    def direction(self, lane: int) -> str:
        """Where a collapse goes, in words."""
        return f"to the {self.collapse(lane).side}"


def _peak(values: np.ndarray) -> float:
    return float(np.abs(values).max())
