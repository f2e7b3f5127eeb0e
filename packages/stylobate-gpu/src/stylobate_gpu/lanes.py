"""Columns whose steps a graphics card takes; how runs begin, end and what they come to is in the blocks of their engine."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np

from stylobate.kernels.run_codes import RUNNING
from stylobate.models.base import Case
from stylobate.models.drums.runs import LaneRuns
from stylobate.models.shared.lanes import NOT_COMPUTED
from stylobate.response import Measures

if TYPE_CHECKING:
    from .card import Device

#: Chunks of steps of a launch: some tens of milliseconds, for which Ctrl-C and runs that have ended wait.
CHUNKS_PER_LAUNCH = 500

#: Lanes of a block here: what runs come to is made for all of a block that end together, one launch in twenty of each.
WIDE = 512

#: Threads that work for a card, each with as many lanes as the card advances at a time: while one begins and ends runs, the
#: lanes of the other go on.
THREADS = 2


class CardLanes:
    """Many lanes that a card advances together; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    Blocks here hold what is known of each run; the numbers of a lane are taken from the card when its run has ended, and put
    there when one begins. Runs of one length end together: threads take turns in beginning and ending them, so that lanes of
    others go on meanwhile.

    Parameters
    ----------
    device : Device
    name : str
        Of the kernel.
    make : callable
        A block here, of columns that the kernel is for; of so many lanes as it is given.
    runs : int
        How many runs there are for these lanes, at most.
    turn : Lock
        Of all threads that work for the card.
    """

    def __init__(self, device: Device, name: str, make: Callable[..., LaneRuns], runs: int, turn: Lock) -> None:
        from .card import CardRecords, lanes_at_once
        from .kinds import lanes_of

        first, starter, of_card = make(WIDE), make(), lanes_of(name)
        self.each, drums = first.lanes, first.arrays.topology.stack
        self.lanes = min(max(1, -(-runs // of_card)) * of_card, lanes_at_once(device, name, drums))
        self.blocks = [first, *(make(WIDE) for _ in range(-(-self.lanes // self.each) - 1))]
        for block in self.blocks:
            block.computed_by, block.starter = f"gpu ({device.name})", starter
        self.card = CardRecords(device, name, drums, self.lanes // of_card)
        self.views = self.card.views()
        self.turn = turn
        self.running = np.zeros(self.lanes, dtype=bool)
        self.cases: dict[int, Case] = {}  # to be begun with the next launch, by their lanes
        self.waiting: dict[int, list[int]] = {}  # lanes to be handed to the card with it, by their blocks
        self.ended: dict[int, Measures | Exception] = {}  # what has come of a lane, or why nothing has

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        self.cases[lane] = case

    def advance(self) -> None:
        """Advance all lanes by a launch; those whose runs end stand still from there."""
        if self.cases or self.waiting:
            with self.turn:
                self._begin()
        if not self.running.any():
            return
        self.card.advance(CHUNKS_PER_LAUNCH)
        ended = self.running & (self.card.here["watch"]["status"].ravel() != RUNNING)
        if ended.any():
            with self.turn:
                self._end(ended)

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended."""
        return lane in self.ended

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended; the lane is free afterwards."""
        measures = self.ended.pop(lane)
        if isinstance(measures, Exception):
            raise measures
        return measures

    def _begin(self) -> None:
        """Begin the runs of cases, and bring all lanes that go on anew to the card."""
        if len(self.card.samples) > 4 * self.lanes:
            self.card.forget_samples(self._in_use())
        for lane, case in self.cases.items():
            number, own = divmod(lane, self.each)
            try:
                self.blocks[number].load(own, case)
            except NOT_COMPUTED as error:
                self.ended[lane] = error
            else:
                self.waiting.setdefault(number, []).append(own)
        self.cases.clear()
        for number, lanes in self.waiting.items():
            self._put(number, np.array(lanes))
        self.waiting.clear()

    def _end(self, ended: np.ndarray) -> None:
        """Take lanes from the card whose runs have ended; those that are shaken again go on with the next launch."""
        self.running &= ~ended
        for number in np.unique(np.flatnonzero(ended) // self.each).tolist():
            block, first = self.blocks[number], number * self.each
            lanes = np.flatnonzero(ended[first : first + self.each])
            self._take(number, lanes)
            over = [own for own in lanes.tolist() if block.is_over(own)]
            if again := [own for own in lanes.tolist() if own not in over]:
                self.waiting.setdefault(number, []).extend(again)
            for own in over:
                try:
                    self.ended[first + own] = block.collect(own)
                except NOT_COMPUTED as error:
                    self.ended[first + own] = error

    def _there(self, number: int, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Blocks of the card, and lanes in them, of lanes of a block here."""
        return np.divmod(number * self.each + own, self.card.lanes)

    def _put(self, number: int, own: np.ndarray) -> None:
        """Write lanes of a block here for the card."""
        block, there = self.blocks[number], self._there(number, own)
        for name, view in self.views.items():
            view[(slice(None), slice(None), *there)] = _fields(block, name, view)[..., own]
        feed = self.card.here["feed"]
        for lane, *place in zip(own.tolist(), *there, strict=True):
            case = block.cases[lane]
            assert case is not None
            for name, samples in _components(case).items():
                if name in (feed.dtype.names or ()):
                    feed[name][tuple(place)] = self.card.address(samples)
        self.running[number * self.each + own] = True
        self.card.changed = True

    def _take(self, number: int, own: np.ndarray) -> None:
        """Take lanes of a block as the card has left them; addresses of samples are those here."""
        block, there = self.blocks[number], self._there(number, own)
        block.ledgers.clear()
        block.ended.clear()
        for name, view in self.views.items():
            if name != "feed":
                _fields(block, name, view)[..., own] = view[(slice(None), slice(None), *there)]
        block.feed["step"][0, own] = self.card.here["feed"]["step"][there]

    def _in_use(self) -> set[int]:
        cases = [case for block in self.blocks for case in block.cases if case is not None]
        every = [samples for case in cases for samples in _components(case).values()]
        return {samples.ctypes.data for samples in every if samples is not None}


def _fields(block: LaneRuns, name: str, view: np.ndarray) -> np.ndarray:
    """Numbers of a record here that the card has as well, its first fields: shape (rows, fields, lanes)."""
    rows, fields = view.shape[:2]
    return block.arrays.rows[name].reshape(rows, -1, block.lanes)[:, :fields]


def _components(case: Case) -> dict[str, np.ndarray | None]:
    """Samples of the motion of a case by their axes."""
    motion = case.motion
    return {"x": motion.samples, "y": motion.y_samples, "z": motion.z_samples}
