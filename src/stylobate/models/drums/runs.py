"""Runs in the lanes of a block, in the plane and in space alike: how they begin, go on and end, and what they come to."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...column import Column
from ...constants import LONGEST_WAIT
from ...errors import InputError
from ...kernels.run_codes import CHUNK, COLLAPSED, FAILED, FREE, RUNNING
from ...messages import say
from ...motion import Motion
from ...outcome import Outcome, classify
from ...response import Collapse, Histories, LinkMeasures, Measures
from ...response.collapse import what_is_lost
from ...response.measures import CPU, SpaceMeasures
from ...response.poses import quaternions
from ...response.residuals import Residuals
from ..base import Case, RunOptions
from ..shared import ledger
from ..shared.ground import AT_REST, Spans, ground_histories
from ..shared.lanes import NOT_COMPUTED, longest_piece
from ..shared.stable_step import whole_steps
from ..start import check_takes_pose
from .links import (
    acting,
    link_measures,
    link_snapshot,
    pretension_energy,
    set_free,
    with_link_histories,
    without_tension,
)
from .records import LaneRecords, Packed


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
        result = Histories.in_space(
            **shared, position=stack["position"], orientation=orientation, joint_twist=stack["twist"]
        )
    else:
        result = Histories.of_drums(**shared, drum_x=stack["x"], drum_z=stack["z"], drum_rotation=stack["rotation"])
    return with_link_histories(result, states)


class FinalStates(NamedTuple):
    """What runs have left behind, of each of them.

    Parameters
    ----------
    residuals : sequence of Residuals
    offset : array
        Length of the offset along every joint [m], shape (runs, joints).
    slip : array
        Of every joint since the start, as :meth:`LaneRuns.stay` takes it [m], shape (runs, joints) or (runs, joints, 2).
    top : array
        Residual displacement of the top [m], shape (runs,).
    rotation : array
        Largest rotation of a body [rad], shape (runs,).
    space : sequence of SpaceMeasures, optional
    """

    residuals: Sequence[Residuals]
    offset: np.ndarray
    slip: np.ndarray
    top: np.ndarray
    rotation: np.ndarray
    space: Sequence[SpaceMeasures] | None = None


@dataclass(frozen=True)
class Started:
    """How a run has begun, for those of the same column that begin alike: what does not hang on its motion otherwise.

    Parameters
    ----------
    packed : Packed
        The column.
    dt : float
        Time step [s].
    ground : tuple of float
        Acceleration of the base at the start [m/s²].
    numbers : array
        Numbers of the lane of what moves.
    kept : tuple of array
        What the block itself keeps of a lane.
    """

    packed: Packed
    dt: float
    ground: tuple[float, ...]
    numbers: np.ndarray
    kept: tuple[np.ndarray, ...]

    @classmethod
    def of(cls, block: LaneRuns, lane: int, ground: tuple[float, ...]) -> Started:
        """That of a run that has begun in a lane."""
        numbers = block.arrays.numbers[: block.arrays.moving, lane].copy()
        kept = tuple(array[lane].copy() for array in block.beginning)
        return cls(block.packed[lane], float(block.dt[lane]), ground, numbers, kept)

    def serves(self, packed: Packed, dt: float, ground: tuple[float, ...]) -> bool:
        """Whether another run begins so."""
        return packed is self.packed and dt == self.dt and ground == self.ground

    def put(self, block: LaneRuns, lane: int) -> None:
        """Let a run begin so in a lane."""
        block.arrays.numbers[: len(self.numbers), lane] = self.numbers
        for array, own in zip(block.beginning, self.kept, strict=True):
            array[lane] = own


#: Calls of the kernel per run.
CALLS_PER_RUN = 100

#: Time after which a run that waits for its verdict is looked at again [s].
WAIT = 0.5


class LaneRuns:
    """Runs in the lanes of a block; the base of the blocks of the engines in the plane and in space.

    Parameters
    ----------
    pack : callable
        Gives the numbers of a column.
    records : LaneRecords
    options : RunOptions
    cost : float
        About what a step of a run costs [s].
    """

    def __init__(self, pack: Callable[[Any], Any], records: LaneRecords, options: RunOptions, cost: float) -> None:
        self.pack, self.arrays, self.options = pack, records, options
        self.lane, self.feed, self.watch, self.link = records.lane, records.feed, records.watch, records.link
        self.packed: dict[int, Packed] = {}
        self.lanes, self.chunk, self.tied = records.lanes, CHUNK, len(self.link) > 0
        self.watch["status"] = FREE
        self.dt = np.zeros(self.lanes)
        self.steps = np.zeros(self.lanes, dtype=np.int64)
        self.start = np.zeros((self.lanes, 6))
        self.rest = np.zeros(self.lanes)
        self.pressed = np.zeros(self.lanes)
        self.cases: list[Case | None] = [None] * self.lanes
        self.computed_by = CPU
        self.ledgers: dict[int, np.ndarray] = {}  # of lanes that stand still
        self.ended: dict[int, Measures] = {}  # of lanes whose runs have ended
        self.started: Started | None = None
        self.starter: LaneRuns | None = None  # a block of few lanes, in which runs begin at less cost than in this one
        self.spans = Spans(self.lanes, options, self.chunk)
        self.chunks_per_call = 1
        self.piece = longest_piece(cost, self.chunk)

    # -- what each engine gives ---------------------------------------------------------------------------------

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        raise NotImplementedError

    def energies_without_tension(self, lane: int, bare: Column) -> np.ndarray:
        """The same as if the column stood there without its pretension; ``bare`` is that column."""
        raise NotImplementedError

    def shake(self, lane: int, motion: Motion) -> None:
        """Note how the base of a lane moves."""
        raise NotImplementedError

    @property
    def stood(self) -> tuple[np.ndarray, ...]:
        """What is kept of how the columns stood, the lanes first."""
        raise NotImplementedError

    def stand(self, lane: int) -> None:
        """Note how a column stands in a lane."""
        raise NotImplementedError

    def take_pose(self, lane: int, column: Any, start: Any) -> None:
        """Put a column that stands in a lane where a run starts from."""
        raise NotImplementedError

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start."""
        raise NotImplementedError

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane."""
        raise NotImplementedError

    def final_states(self, lanes: list[int]) -> FinalStates:
        """What the runs of some lanes leave behind."""
        raise NotImplementedError

    def lost(self, collapse: Collapse, column: Any) -> str:
        """Fallen bodies, and their places, in words."""
        towards = say("{lost}, to the left") if collapse.side == "left" else say("{lost}, to the right")
        return towards.of(lost=what_is_lost(collapse, column.n))

    def stay(self, lanes: list[int], energy: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Whether what stands in lanes with so much energy above that at rest [J] stands for good, shape (lanes,).

        ``slip`` is that of every joint since the start [m], of each lane.
        """
        raise NotImplementedError

    # -- how a run begins ----------------------------------------------------------------------------------------

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        case = self.cases[lane] = case.multiplied if self.computed_by == CPU else case  # a card shares samples
        self._forget(lane)
        packed = self.packed[lane] = self.pack(case.column)
        self.arrays.put(lane, packed.lane)
        dt, chunks = whole_steps(case.motion, self.options.tail, packed.step)
        steps, feed = chunks * self.chunk, self.feed[0]
        self.lane["dt"][0, lane] = self.dt[lane] = dt
        if self.tied:
            self.arrays.bond[...] = packed.bond
            self.link["dt"][:, lane] = dt
        self.watch["follow"][0, lane] = self.options.until_end
        feed["step"][lane], feed["end"][lane] = self.spans.begin(lane, case, dt, steps)
        self.arrays.feed_motion(lane, case.motion, dt)
        self.steps[lane] = steps
        self.chunks_per_call = max(1, chunks // CALLS_PER_RUN)
        self.shake(lane, case.motion)
        ground = self.ground_at_start(lane)
        if self.started is None or not self.started.serves(packed, dt, ground):
            self.started = self._started(lane, case, ground)
        self.started.put(self, lane)

    def _started(self, lane: int, case: Case, ground: tuple[float, ...]) -> Started:
        """How a run begins that is in a lane."""
        if self.starter is not None:
            self.starter.load(0, case)
            assert self.starter.started is not None
            return self.starter.started
        self.stand(lane)
        self.begin(lane)
        return Started.of(self, lane, ground)

    def ground_at_start(self, lane: int) -> tuple[float, ...]:
        """What the acceleration of the base at the start of a run hangs on, but for the column [m/s²].

        That of the first samples, which a run begins with; where quiet is left out before it, of its first step.
        """
        if self.feed["step"][0, lane]:
            return tuple(self.ground_acceleration(lane))
        motion = self.case(lane).motion
        every = motion.samples, motion.y_samples, motion.z_samples
        return tuple(0.0 if samples is None else motion.factor * float(samples[0]) for samples in every)

    @property
    def beginning(self) -> tuple[np.ndarray, ...]:
        """What is kept of how runs have begun, the lanes first."""
        return self.start, self.rest, self.pressed, *self.stood

    def begin(self, lane: int) -> None:
        """Take the start's pose, if there is one; velocities half a step before the start, and the energy there.

        Raises
        ------
        InputError
            A pose that this column or this model does not take.
        """
        column, start = self.column(lane), self.options.start
        self.rest[lane] = 0.0
        if start is not None:
            self.check_start(column)
            self.rest[lane] = -self.energies(lane)[2:4].sum()
            self.take_pose(lane, column, start)
        self.half_a_step_back(lane)
        self.start[lane] = self.energies(lane)
        self.pressed[lane] = self.pressed_joints(lane, column) if self.tied else 0.0
        if start is not None:  # what the pose and the velocity hold above the column upright
            self.rest[lane] += self.start[lane, 1:4].sum()

    def check_start(self, column: Any) -> None:
        """Refuse a start that is not one for this column."""
        check_takes_pose(self.options.start, column)

    def pressed_joints(self, lane: int, column: Any) -> float:
        """Energy at the start of joints that pretension presses, above that of joints under their weight alone [J].

        Their elastic energy is larger by more than this, because what stands on them has sunk. Where only the pretension
        holds the column up there is no weight alone, and all that the joints hold counts.
        """
        if not column.pretensioned:
            return 0.0
        link_energy = pretension_energy(column)
        try:
            alone = self.energies_without_tension(lane, without_tension(column))
        except InputError:  # it cannot stand
            return float(self.start[lane, 3]) - link_energy
        return float((self.start[lane] - alone)[2:4].sum()) - link_energy

    # -- how it goes on ------------------------------------------------------------------------------------------

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by some chunks of steps."""
        remaining = min(self.chunks_per_call, self.piece) if chunks is None else chunks
        running = np.count_nonzero(self.running())
        self.ledgers.clear()
        self.ended.clear()
        while remaining > 0 and np.count_nonzero(self.running()) == running:
            count = min(remaining, self.piece)
            self.step(count)
            remaining -= count

    def running(self) -> np.ndarray:
        """Which lanes' runs go on, shape (lanes,)."""
        return self.watch["status"][0] == RUNNING

    def follow(self, chunks: int, between: Callable[[], None]) -> None:
        """Advance the run in the first lane by some chunks, or to its end, however often others end on the way.

        The kernel stops where any run ends, and goes on moving what is left in its lane: ``between`` collects it at once.
        """
        goal = int(self.feed["step"][0, 0]) + chunks * self.chunk
        while not self.is_over(0) and (remaining := goal - int(self.feed["step"][0, 0])) > 0:
            self.advance(remaining // self.chunk)
            between()

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended; one that still moves after the shaking, or is shaken again, goes on."""
        feed, watch = self.feed[0], self.watch[0]
        others = (RUNNING, COLLAPSED, FAILED, FREE)
        if watch["status"][lane] not in others and feed["end"][lane] < self.steps[lane]:
            now = int(feed["step"][lane])
            first, end = self.spans.onward(lane, now, int(self.steps[lane]), self.at_rest(lane))
            if end > now:
                self._forget(lane)
                feed["step"][lane], feed["end"][lane] = first, end
                watch["status"][lane] = RUNNING
                self.lane["dt"][0, lane] = self.dt[lane]
        if watch["status"][lane] not in others and self._waits(lane):
            self._forget(lane)
            feed["end"][lane] = feed["step"][lane] + self.chunk * math.ceil(WAIT / (self.chunk * self.dt[lane]))
            watch["status"][lane] = RUNNING
            self.lane["dt"][0, lane] = self.dt[lane]
        return watch["status"][lane] != RUNNING

    def _waits(self, lane: int) -> bool:
        """Whether a run goes on after motion and tail, because it moves and its verdict could still change."""
        longest = self.steps[lane] + LONGEST_WAIT / self.dt[lane]
        if not self.options.until_decided or self.feed["step"][0, lane] >= longest or self.at_rest(lane):
            return False
        try:
            self._measure(lane)
        except NOT_COMPUTED:  # of which its collection says so
            return False
        return not self.ended[lane].decided and self.ended[lane].outcome is not Outcome.FAILED

    def _forget(self, lane: int) -> None:
        """Of a lane that goes on, or begins anew."""
        self.ledgers.pop(lane, None)
        self.ended.pop(lane, None)

    def at_rest(self, lane: int) -> bool:
        """Whether a lane's column has next to no energy above that at its start."""
        change = self.energies(lane) - self.start[lane]
        free = 0.0  # what pretension has given away is not missing from the motion
        if self.tied:
            free = set_free(self.column(lane), self.link["ft"][:, lane], float(self.pressed[lane]))
        return float(change[1] + change[2] + change[3]) + free < AT_REST * self.packed[lane].barrier

    # -- what it tells -------------------------------------------------------------------------------------------

    def energies(self, lane: int) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J].

        Those of all lanes whose runs have ended are made together: most of the work is the same for one and for all.
        """
        if self.watch["status"][0, lane] == RUNNING:
            return self._ledgers([lane])[0]
        if lane not in self.ledgers:
            ended = [stopped_lane for stopped_lane in self._stopped() if stopped_lane not in self.ledgers]
            ended += [lane] * (lane not in ended)
            self.ledgers.update(zip(ended, self._ledgers(ended), strict=True))
        return self.ledgers[lane]

    def _stopped(self) -> list[int]:
        """Lanes that stand still, with runs that have not been collected."""
        status = self.watch["status"][0]
        return np.flatnonzero((status != RUNNING) & (status != FREE)).tolist()

    def _ledgers(self, lanes: list[int]) -> np.ndarray:
        return self.arrays.energies(lanes, self.dt, self.ground_accelerations(lanes))

    def ground_accelerations(self, lanes: Sequence[int]) -> np.ndarray:
        """Acceleration of the bases of lanes in their own axes now [m/s²], shape (lanes, axes)."""
        steps = np.array([self.case(lane).motion.dt for lane in lanes])
        return self.arrays.bases(lanes, self.feed["step"][0, lanes] * self.dt[lanes] / steps)

    def ground_acceleration(self, lane: int) -> np.ndarray:
        """Acceleration of the base of a lane in its own axes now [m/s²], shape (axes,)."""
        return self.ground_accelerations([lane])[0]

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        return self.arrays.acceleration(lane)

    def case(self, lane: int) -> Case:
        """The case in a lane."""
        case = self.cases[lane]
        assert case is not None
        return case

    def column(self, lane: int) -> Any:
        """The column, or the body, in a lane."""
        return self.case(lane).column

    def time(self, lane: int) -> float:
        """Time of the lane's present state [s]."""
        return float(self.feed["step"][0, lane]) * self.dt[lane]

    def links_now(self, lane: int) -> dict[str, Any]:
        """Links in a snapshot, where there are some."""
        return {"links": link_snapshot(self.link, lane)} if self.tied else {}

    def links_done(self, lane: int) -> tuple[LinkMeasures, ...]:
        """Results of a lane's run for each link."""
        links = acting(self.column(lane)) if self.tied else ()
        return link_measures(links, self.link, lane, float(self.dt[lane]))

    def link_energy(self, lane: int) -> float:
        """Energy of pretension at the start, in links and in the joints that they press, which may be set free [J]."""
        return pretension_energy(self.column(lane)) + float(self.pressed[lane]) if self.tied else 0.0

    def mechanical(self, lane: int, change: ledger.Row) -> float:
        """Energy above that at rest after a change of the ledger, with what links may set free [J]."""
        return float(change[1] + change[2] + change[3] + self.rest[lane]) + self.link_energy(lane)

    def start_energy(self, lane: int, change: ledger.Row) -> float:
        """Energy at the start of a run, for its imbalance: the elastic one, or that of the pose and the velocity [J]."""
        begun = float(self.start[lane, 3])
        if self.options.start is not None:
            begun = max(begun, float(self.start[lane, 1]), abs(float(change[1])))
        return begun

    def peaks(self, lanes: Sequence[int], name: str) -> np.ndarray:
        """A peak of the watch of lanes; of columns that have collapsed, as it was when the fall began."""
        watch = self.watch[0]
        return np.where(watch["when"][lanes] >= 0, watch["k" + name][lanes], watch[name][lanes])

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run is over."""
        self._measure(lane)
        self.watch["status"][0, lane] = FREE
        return self.ended.pop(lane)

    def _measure(self, lane: int) -> None:
        """Make the measures of a lane that has stopped; those of all are made together, which takes less for each."""
        if lane in self.ended:
            return
        lanes = [stopped_lane for stopped_lane in self._stopped() if stopped_lane not in self.ended]
        lanes += [lane] * (lane not in lanes)
        try:
            self.ended.update(zip(lanes, self.measures(lanes, self.final_states(lanes)), strict=True))
        except NOT_COMPUTED:  # of one of them, whose own turn it is to say so
            (self.ended[lane],) = self.measures([lane], self.final_states([lane]))

    def measures(self, lanes: list[int], final: FinalStates, since: np.ndarray | None = None) -> list[Measures]:
        """Measures of lanes whose runs are over.

        Parameters
        ----------
        lanes : list of int
        final : FinalStates
        since : array, optional
            Change of the ledgers since the start [J], shape (lanes, 6); that of the lanes if left out.
        """
        watch, packed = self.watch[0], [self.packed[lane] for lane in lanes]
        widths = np.stack([numbers.widths for numbers in packed])
        status, when, work = (watch[name][lanes].tolist() for name in ("status", "when", "wmax"))
        opened, shifted = watch["open"][lanes] / widths.min(axis=1), (final.offset / widths).max(axis=1)
        steps, dt = self.feed["step"][0, lanes].tolist(), self.dt[lanes].tolist()
        since = np.array([self.energies(lane) for lane in lanes]) - self.start[lanes] if since is None else since
        change = since.tolist()
        imbalance = [
            ledger.imbalance(
                ledger.unaccounted(row),
                work=most,
                start=self.start_energy(lane, row),
                barrier=numbers.barrier,
                released=ledger.released(row),
            )
            for row, most, lane, numbers in zip(change, work, lanes, packed, strict=True)
        ]
        set_off = [
            most == 0.0
            and self.options.start is None
            and self.column(lane).stack is not None  # which is in equilibrium at the start
            and ledger.released(row) > self.start[lane, 3]
            for row, most, lane in zip(change, work, lanes, strict=True)
        ]
        failed = [
            code == FAILED or moved or bool(ledger.out_of_balance(share))
            for code, moved, share in zip(status, set_off, imbalance, strict=True)
        ]
        outcomes = [
            classify(code == COLLAPSED, *facts)
            for code, *facts in zip(status, failed, opened.tolist(), shifted.tolist(), strict=True)
        ]
        undecided = [k for k, outcome in enumerate(outcomes) if outcome not in (Outcome.COLLAPSED, Outcome.FAILED)]
        decided = np.array([outcome is Outcome.COLLAPSED for outcome in outcomes])
        if undecided:
            energies = np.array([self.mechanical(lanes[k], change[k]) for k in undecided])
            decided[undecided] = self.stay([lanes[k] for k in undecided], energies, final.slip[undecided])
        moved, wide = self.peaks(lanes, "top").tolist(), self.peaks(lanes, "open").tolist()
        top, turned, largest = final.top.tolist(), final.rotation.tolist(), final.offset.max(axis=1).tolist()
        return [
            Measures(
                outcome=outcome,
                decided=sure,
                collapse_time=when[k] * dt[k] if when[k] >= 0 else math.nan,
                peak_top_displacement=moved[k],
                residual_top_displacement=top[k],
                peak_rotation=turned[k],
                peak_joint_opening=wide[k],
                residual_joint_slip=largest[k],
                energy_imbalance=imbalance[k],
                time_step=dt[k],
                steps=steps[k] - int(self.spans.left_out[lane]),
                reason=self.reason(lane, outcome, imbalance[k]),
                collapse=self.collapse(lane) if outcome is Outcome.COLLAPSED else None,
                space=None if final.space is None else final.space[k],
                stepped=self.spans.stepped(lane, steps[k], dt[k]),
                links=self.links_done(lane),
                residuals=final.residuals[k],
                computed_by=self.computed_by,
            )
            for k, (lane, outcome, sure) in enumerate(zip(lanes, outcomes, decided.tolist(), strict=True))
        ]

    def reason(self, lane: int, outcome: Outcome, imbalance: float) -> str:
        """Why a run failed, or what happened in a collapse; empty for a column that stands."""
        if outcome is Outcome.FAILED:
            if self.watch["status"][0, lane] == FAILED:
                return say("the state is not finite at {time:.4g} s; try a smaller step_factor", time=self.time(lane))
            return ledger.out_of_balance(imbalance) or ledger.SET_OFF
        if outcome is not Outcome.COLLAPSED:
            return ""
        return self.lost(self.collapse(lane), self.column(lane))
