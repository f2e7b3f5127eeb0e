"""Columns whose steps a graphics card takes; how runs begin, end and what they come to is in the blocks of their engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...kernels.run_codes import RUNNING
from ...response import Measures
from ..base import Case
from .runs import LaneRuns

if TYPE_CHECKING:
    from ...kernels.gpu.card import Device

#: Chunks of steps of a launch: some tens of milliseconds, for which Ctrl-C and runs that have ended wait.
CHUNKS_PER_LAUNCH = 500

#: Most lanes on a card at a time: as many as the largest of today's have room for, of columns of a dozen drums.
MOST_LANES = 8192

#: Threads that work for a card, each for a part of the lanes: while one prepares runs, the lanes of the other go on.
THREADS = 2


class CardLanes:
    """Many lanes that a card advances together; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    Blocks here hold what is known of each run; the numbers of a lane are taken from the card when its run has ended, and put
    there when one begins.

    Parameters
    ----------
    device : Device
    name : str
        Of the kernel.
    make : callable
        A block here, of columns that the kernel is for.
    runs : int
        How many runs there are, at most.
    """

    def __init__(self, device: Device, name: str, make: Callable[[], LaneRuns], runs: int) -> None:
        from ...kernels.gpu.card import CardRecords
        from ...kernels.gpu.kinds import lanes_of

        first = make()
        self.each, each = first.lanes, lanes_of(name)
        count = -(-min(max(runs, 1), MOST_LANES // THREADS) // self.each)
        self.blocks = [first, *(make() for _ in range(count - 1))]
        self.lanes = count * self.each
        self.card = CardRecords(device, name, first.arrays.topology.stack, self.lanes // each)
        self.views = self.card.views()
        self.running = np.zeros(self.lanes, dtype=bool)
        self.taken = np.zeros(self.lanes, dtype=bool)  # lanes whose blocks here know how their runs have ended
        self.computed_by = f"gpu ({device.name})"

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        block, own = self._own(lane)
        block.load(own, case)
        self._put(lane)

    def advance(self) -> None:
        """Advance all lanes by a launch; those whose runs end stand still from there."""
        if len(self.card.samples) > 4 * self.lanes:
            self.card.forget_samples(self._in_use())
        self.card.advance(CHUNKS_PER_LAUNCH)
        self.running[...] = self.card.here["watch"]["status"].ravel() == RUNNING
        self.taken[...] = False

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended; one that is shaken again goes on."""
        if self.running[lane]:
            return False
        block, own = self._own(lane)
        if not self.taken[lane]:
            self._take(lane)
        over = block.is_over(own)
        if not over:
            self._put(lane)
        return over

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended; the lane is free afterwards."""
        block, own = self._own(lane)
        return replace(block.collect(own), computed_by=self.computed_by)

    def _own(self, lane: int) -> tuple[LaneRuns, int]:
        """The block of a lane, and the place of the lane in it."""
        number, own = divmod(lane, self.each)
        return self.blocks[number], own

    def _numbers(self, lane: int, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Numbers of a record of a lane in its block here, and on their way to and from the card; (rows, fields) each."""
        block, own = self._own(lane)
        there = self.views[name][:, :, lane // self.card.lanes, lane % self.card.lanes]
        return block.arrays.rows[name].reshape(*there.shape, -1)[..., own], there

    def _put(self, lane: int) -> None:
        """Hand a lane to the card with the next launch."""
        block, own = self._own(lane)
        for name in self.views:
            here, there = self._numbers(lane, name)
            there[...] = here
        case = block.cases[own]
        assert case is not None
        feed = self.card.here["feed"]
        for name, samples in _components(case).items():
            if name in (feed.dtype.names or ()):
                feed[name][divmod(lane, self.card.lanes)] = self.card.address(samples)
        self.card.changed = True
        self.running[lane] = True

    def _take(self, lane: int) -> None:
        """Take a lane as the card has left it; addresses of samples are those here."""
        block, own = self._own(lane)
        for name in self.views:
            if name != "feed":
                here, there = self._numbers(lane, name)
                here[...] = there
        block.feed["step"][0, own] = self.card.here["feed"]["step"][divmod(lane, self.card.lanes)]
        self.taken[lane] = True

    def _in_use(self) -> set[int]:
        cases = [case for block in self.blocks for case in block.cases if case is not None]
        every = [samples for case in cases for samples in _components(case).values()]
        return {samples.ctypes.data for samples in every if samples is not None}


def _components(case: Case) -> dict[str, np.ndarray | None]:
    """Samples of the motion of a case by their axes."""
    motion = case.motion
    return {"x": motion.samples, "y": motion.y_samples, "z": motion.z_samples}
