"""A block of lanes of stacked drums: kernel arrays, the way of a case into them, and of its results out of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...column import Column
from ...kernels.run_codes import CHUNK, COLLAPSED, FAILED, FREE, LANES, RUNNING
from ...outcome import Outcome
from ...response import LinkMeasures
from ...response.collapse import what_is_lost
from ..base import Case, RunOptions
from ..shared import ledger, quiet
from ..shared.lanes import aligned_zeros, longest_piece
from ..start import check_takes_pose
from .barriers import lowest_barrier
from .links import acting, link_measures, link_snapshot
from .packing import PackedColumn
from .pretension import held_at_start, pressed_joints, set_free

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
        self.pressed[lane] = pressed_joints(self, lane, case.column) if self.tied else 0.0
        if start is not None:  # what the pose and the velocity hold above the column upright
            self.rest[lane] += self.start[lane, 1:4].sum()

    def check_start(self, column: Any) -> None:
        """Refuse a start that is not one for this column."""
        check_takes_pose(self.options.start, column)

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by some chunks of steps."""
        left = min(self.chunks_per_call, self.piece) if chunks is None else chunks
        running = np.count_nonzero(self.running())
        while left > 0 and np.count_nonzero(self.running()) == running:
            count = min(left, self.piece)
            self.kernel.advance(self.drum, self.joint, self.lane, self.ground, self.feed, self.watch, count)
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
