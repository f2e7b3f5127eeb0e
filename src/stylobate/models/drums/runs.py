"""Runs in the lanes of a block, in the plane and in space alike: how they go on and end, and what they started with."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...column import Column
from ...errors import InputError
from ...kernels.run_codes import CHUNK, COLLAPSED, FAILED, FREE, LANES, RUNNING
from ...motion import Motion
from ...outcome import Outcome, classify
from ...response import Collapse, LinkMeasures, Measures
from ...response.collapse import what_is_lost
from ...response.measures import CPU, SpaceMeasures
from ...response.residuals import Residuals
from ..base import Case, RunOptions
from ..shared import ledger, quiet
from ..shared.lanes import longest_piece
from ..shared.stable_step import whole_steps
from ..start import check_takes_pose
from .histories import ledger_imbalance
from .links import acting, link_measures, link_snapshot
from .pretension import held_at_start, set_free, without_tension
from .records import LaneRecords, Packed
from .started import Started

#: Calls of the kernel per run.
CALLS_PER_RUN = 100


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
        self.lanes, self.chunk, self.tied = LANES, CHUNK, len(self.link) > 0
        self.watch["status"] = FREE
        self.dt = np.zeros(self.lanes)
        self.steps = np.zeros(self.lanes, dtype=np.int64)
        self.start = np.zeros((self.lanes, 6))
        self.rest = np.zeros(self.lanes)
        self.pressed = np.zeros(self.lanes)
        self.cases: list[Case | None] = [None] * self.lanes
        self.computed_by = CPU
        self.ledgers: dict[int, np.ndarray] = {}  # of lanes that stand still
        self.started: Started | None = None
        self.spans = quiet.Spans(self.lanes, options, self.chunk)
        self.chunks_per_call = 1
        self.piece = longest_piece(cost, self.chunk)

    # -- given by each engine ------------------------------------------------------------------------------------

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        raise NotImplementedError

    def ground_acceleration(self, lane: int) -> Any:
        """Acceleration of the base in its own axes now [m/s²]."""
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

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run is over."""
        raise NotImplementedError

    def lost(self, collapse: Collapse, column: Any) -> str:
        """Fallen bodies, and their places, in words."""
        return f"{what_is_lost(collapse, column.n)}, to the {collapse.side}"

    def stays(self, lane: int, energy: float, slip: np.ndarray) -> bool:
        """Whether what stands in a lane with so much energy above that at rest [J] stands for good.

        ``slip`` is that of every joint since the start [m].
        """
        raise NotImplementedError

    # -- how a run begins ----------------------------------------------------------------------------------------

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        self.cases[lane] = case
        self.ledgers.pop(lane, None)
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
        ground = tuple(self.ground_acceleration(lane))
        if self.started is None or not self.started.serves(packed, dt, ground):
            self.stand(lane)
            self.begin(lane)
            self.started = Started.of(self, lane, ground)
        self.started.put(self, lane)

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

    def pressed_joints(self, lane: int, column: Column) -> float:
        """Energy at the start of joints that pretension presses, above that of joints under their weight alone [J].

        Their elastic energy is larger by more than this, because what stands on them has sunk. Where only the pretension
        holds the column up there is no weight alone, and all that the joints hold counts.
        """
        if not column.pretensioned:
            return 0.0
        held = held_at_start(column)
        try:
            alone = self.energies_without_tension(lane, without_tension(column))
        except InputError:  # it cannot stand
            return float(self.start[lane, 3]) - held
        return float((self.start[lane] - alone)[2:4].sum()) - held

    # -- how it goes on ------------------------------------------------------------------------------------------

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by some chunks of steps."""
        left = min(self.chunks_per_call, self.piece) if chunks is None else chunks
        running = np.count_nonzero(self.running())
        self.ledgers.clear()
        while left > 0 and np.count_nonzero(self.running()) == running:
            count = min(left, self.piece)
            self.step(count)
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
                self.ledgers.pop(lane, None)
                feed["step"][lane], feed["end"][lane] = first, end
                watch["status"][lane] = RUNNING
                self.lane["dt"][0, lane] = self.dt[lane]
        return watch["status"][lane] != RUNNING

    def at_rest(self, lane: int) -> bool:
        """Whether a lane's column has next to no energy above that at its start."""
        change = self.energies(lane) - self.start[lane]
        free = 0.0  # what pretension has given away is not missing from the motion
        if self.tied:
            free = set_free(self.column(lane), self.link["ft"][:, lane], float(self.pressed[lane]))
        return float(change[1] + change[2] + change[3]) + free < quiet.AT_REST * self.packed[lane].barrier

    # -- what it tells -------------------------------------------------------------------------------------------

    def energies(self, lane: int) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J].

        Those of all lanes whose runs have ended are made together: most of the work is the same for one and for all.
        """
        going = self.running()
        if going[lane]:
            return self._ledgers([lane])[0]
        if lane not in self.ledgers:
            ended = [one for one in np.flatnonzero(~going).tolist() if self.cases[one] and one not in self.ledgers]
            self.ledgers.update(zip(ended, self._ledgers(ended), strict=True))
        return self.ledgers[lane]

    def _ledgers(self, lanes: list[int]) -> np.ndarray:
        return self.arrays.energies(lanes, self.dt, [self.ground_acceleration(lane) for lane in lanes])

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        return self.arrays.acceleration(lane)

    def column(self, lane: int) -> Any:
        """The column, or the body, in a lane."""
        case = self.cases[lane]
        assert case is not None
        return case.column

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

    def held_by_links(self, lane: int) -> float:
        """Energy of pretension at the start, in links and in the joints that they press, which may be set free [J]."""
        return held_at_start(self.column(lane)) + float(self.pressed[lane]) if self.tied else 0.0

    def mechanical(self, lane: int, change: np.ndarray) -> float:
        """Energy above that at rest after a change of the ledger, with what links may set free [J]."""
        return float(change[1] + change[2] + change[3] + self.rest[lane]) + self.held_by_links(lane)

    def begun(self, lane: int, change: np.ndarray) -> float:
        """Energy at the start of a run, for its imbalance: the elastic one, or that of the pose and the velocity [J]."""
        begun = float(self.start[lane, 3])
        if self.options.start is not None:
            begun = max(begun, float(self.start[lane, 1]), abs(float(change[1])))
        return begun

    def peak(self, lane: int, name: str) -> float:
        """A peak of the watch; of a column that has collapsed, as it was when the fall began."""
        watch = self.watch[0]
        return float(watch["k" + name if watch["when"][lane] >= 0 else name][lane])

    def measures(
        self,
        lane: int,
        left: Residuals,
        slip: np.ndarray,
        top: float,
        rotation: float,
        space: SpaceMeasures | None = None,
        since: np.ndarray | None = None,
    ) -> Measures:
        """Measures of a lane whose run is over.

        Parameters
        ----------
        lane : int
        left : Residuals
        slip : array
            Of every joint since the start, as :meth:`stays` takes it [m].
        top : float
            Residual displacement of the top [m].
        rotation : float
            Largest rotation of a body [rad].
        space : SpaceMeasures, optional
        since : array, optional
            Change of the ledger since the start [J], shape (6,); that of the lane if left out.
        """
        watch, packed, slips = self.watch[0], self.packed[lane], np.array(left.slips)
        status, when = watch["status"][lane], int(watch["when"][lane])
        step, dt = int(self.feed["step"][0, lane]), float(self.dt[lane])
        change = self.energies(lane) - self.start[lane] if since is None else since
        imbalance = ledger_imbalance(change, float(watch["wmax"][lane]), self.begun(lane, change), packed.barrier)
        failed = status == FAILED or bool(ledger.out_of_balance(imbalance))
        widths = packed.widths
        outcome = classify(
            status == COLLAPSED, failed, float(watch["open"][lane] / widths.min()), float((slips / widths).max())
        )
        collapsed = outcome is Outcome.COLLAPSED
        return Measures(
            outcome=outcome,
            decided=collapsed or (not failed and self.stays(lane, self.mechanical(lane, change), slip)),
            collapse_time=when * dt if when >= 0 else math.nan,
            peak_top_displacement=self.peak(lane, "top"),
            residual_top_displacement=top,
            peak_rotation=rotation,
            peak_joint_opening=self.peak(lane, "open"),
            residual_joint_slip=float(slips.max()),
            energy_imbalance=imbalance,
            time_step=dt,
            steps=step - int(self.spans.left_out[lane]),
            reason=self.reason(lane, outcome, imbalance),
            collapse=self.collapse(lane) if collapsed else None,
            space=space,
            stepped=self.spans.stepped(lane, step, dt),
            links=self.links_done(lane),
            residuals=left,
            computed_by=self.computed_by,
        )

    def reason(self, lane: int, outcome: Outcome, imbalance: float) -> str:
        """Why a run failed, or what happened in a collapse; empty for a column that stands."""
        if outcome is Outcome.FAILED:
            if self.watch["status"][0, lane] == FAILED:
                return f"the state is not finite at {self.time(lane):.4g} s; try a smaller step_factor"
            return ledger.out_of_balance(imbalance)
        if outcome is not Outcome.COLLAPSED:
            return ""
        return self.lost(self.collapse(lane), self.column(lane))
