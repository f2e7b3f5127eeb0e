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

#: Most lanes on a card: as many as the largest of today's have room for at a time, of columns of a dozen drums.
MOST_LANES = 8192


class CardLanes:
    """Many blocks of lanes that a card advances together; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    A block that has a run to begin or to end is fetched and brought back; the others stay on the card.

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
        self.each = first.lanes
        count = -(-min(max(runs, 1), MOST_LANES) // self.each)
        self.blocks = [first, *(make() for _ in range(count - 1))]
        self.lanes = count * self.each
        drums, self.parts = first.arrays.topology.stack, self.each // lanes_of(name)
        self.card = CardRecords(device, name, drums, count * self.parts)
        self.known = set(range(count))  # blocks whose records here are as on the card, or newer
        self.changed: set[int] = set()  # blocks that are newer here
        self.running = np.zeros((count, self.each), dtype=bool)
        self.computed_by = f"gpu ({device.name})"

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        block, own = self._at_hand(lane)
        self.changed.add(lane // self.each)
        block.load(own, case)

    def advance(self) -> None:
        """Advance all lanes by a launch; those whose runs end stand still from there."""
        for number in sorted(self.changed):
            self._bring(number)
        self.changed.clear()
        self.known.clear()
        self.card.advance(CHUNKS_PER_LAUNCH)
        self.card.fetch(slice(None), "watch")
        self.running[...] = self.card.here["watch"]["status"].reshape(self.running.shape) == RUNNING

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended; one that is shaken again goes on."""
        if self.running[divmod(lane, self.each)]:
            return False
        block, own = self._at_hand(lane)
        over = block.is_over(own)
        if not over:
            self.changed.add(lane // self.each)
        return over

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended; the lane is free afterwards."""
        block, own = self._at_hand(lane)
        return replace(block.collect(own), computed_by=self.computed_by)

    def _at_hand(self, lane: int) -> tuple[LaneRuns, int]:
        """The block of a lane, as it is on the card, and the place of the lane in it."""
        number, own = divmod(lane, self.each)
        if number not in self.known:
            self._fetch(number)
            self.known.add(number)
        return self.blocks[number], own

    def _on_card(self, number: int) -> slice:
        return slice(number * self.parts, (number + 1) * self.parts)

    def _bring(self, number: int) -> None:
        rows, card, there = self.blocks[number].arrays.rows, self.card, self._on_card(number)
        for name in ("body", "joint"):
            fields = card.fields("site", there, name)
            fields[...] = self._in_parts(rows[name], fields.shape)
        for name in ("lane", "feed", "watch"):
            fields = card.fields(name, there)
            fields[...] = self._in_parts(rows[name], fields.shape)
        feed = card.here["feed"][there]
        for lane, case in enumerate(self.blocks[number].cases):
            if case is not None:
                part, own = divmod(lane, self.each // self.parts)
                for name, samples in _components(case).items():
                    if name in (feed.dtype.names or ()):
                        feed[name][part, own] = card.address(samples)
        card.bring(there)
        if len(card.samples) > 4 * self.lanes:
            card.forget_samples(self._in_use())

    def _in_use(self) -> set[int]:
        cases = [case for block in self.blocks for case in block.cases if case is not None]
        every = [samples for case in cases for samples in _components(case).values()]
        return {samples.ctypes.data for samples in every if samples is not None}

    def _fetch(self, number: int) -> None:
        arrays, card, there = self.blocks[number].arrays, self.card, self._on_card(number)
        card.fetch(there, "site", "lane", "feed")
        for name in ("body", "joint"):
            arrays.rows[name][...] = self._in_rows(card.fields("site", there, name))
        for name in ("lane", "watch"):
            arrays.rows[name][...] = self._in_rows(card.fields(name, there))
        arrays.feed["step"][0] = card.here["feed"]["step"][there].ravel()

    def _in_parts(self, rows: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """Rows of fields over the lanes of a block, as blocks on the card hold them."""
        return rows.reshape(shape[1], -1, self.parts, self.each // self.parts).transpose(2, 0, 1, 3).reshape(shape)

    def _in_rows(self, fields: np.ndarray) -> np.ndarray:
        """The other way round."""
        own = self.each // self.parts
        return fields.reshape(self.parts, fields.shape[1], -1, own).transpose(1, 2, 0, 3).reshape(-1, self.each)


def _components(case: Case) -> dict[str, np.ndarray | None]:
    """Samples of the motion of a case by their axes."""
    motion = case.motion
    return {"x": motion.samples, "y": motion.y_samples, "z": motion.z_samples}
