"""Columns in the plane whose steps a graphics card takes; how runs begin, end and what they come to is in ``columns.py``."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...kernels.run_codes import RUNNING
from ...response import Measures
from ..base import Case
from .columns import ColumnLanes
from .laws import Types

#: Chunks of steps of a launch: some tens of milliseconds, for which Ctrl-C and runs that have ended wait.
CHUNKS_PER_LAUNCH = 500

#: Most lanes on a card: as many as the largest of today's have room for at a time, of columns of a dozen drums.
MOST_LANES = 8192


class CardLanes:
    """Many blocks of lanes that a card advances together; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    A block that has a run to begin or to end is fetched and brought back; the others stay on the card.

    Parameters
    ----------
    types : mapping of str to dtype
        Of the records on the card, with fewer lanes to a block than here: a power of two.
    make : callable
        A block here.
    runs : int
        How many runs there are, at most.
    """

    def __init__(self, types: Types, make: Callable[[], ColumnLanes], runs: int) -> None:
        from ...kernels.gpu.card import CardRecords

        first = make()
        self.each = first.lanes
        count = -(-min(max(runs, 1), MOST_LANES) // self.each)
        self.blocks = [first, *(make() for _ in range(count - 1))]
        self.lanes = count * self.each
        self.parts = self.each // types["watch"]["status"].shape[0]
        self.card = CardRecords(types, first.records.topology.stack, count * self.parts)
        self.known = set(range(count))  # blocks whose records here are as on the card, or newer
        self.changed: set[int] = set()  # blocks that are newer here
        self.running = np.zeros((count, self.each), dtype=bool)

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
        return block.collect(own)

    def _at_hand(self, lane: int) -> tuple[ColumnLanes, int]:
        """The block of a lane, as it is on the card, and the place of the lane in it."""
        number, own = divmod(lane, self.each)
        if number not in self.known:
            self._fetch(number)
            self.known.add(number)
        return self.blocks[number], own

    def _on_card(self, number: int) -> slice:
        return slice(number * self.parts, (number + 1) * self.parts)

    def _bring(self, number: int) -> None:
        block, card, there = self.blocks[number], self.card, self._on_card(number)
        for name in ("body", "joint"):
            fields = card.fields("site", there, name)
            fields[...] = self._in_parts(block.records.rows[name], fields.shape)
        for name in ("lane", "feed", "watch"):
            fields = card.fields(name, there)
            fields[...] = self._in_parts(block.records.rows[name], fields.shape)
        feed = card.here["feed"][there]
        for lane, case in enumerate(block.cases):
            if case is not None:
                part, own = divmod(lane, self.each // self.parts)
                feed["x"][part, own] = card.address(case.motion.samples)
                feed["z"][part, own] = card.address(case.motion.z_samples)
        card.bring(there)
        if len(card.samples) > 4 * self.lanes:
            card.forget_samples(self._in_use())

    def _in_use(self) -> set[int]:
        motions = [case.motion for block in self.blocks for case in block.cases if case is not None]
        both = [samples for one in motions for samples in (one.samples, one.z_samples)]
        return {samples.ctypes.data for samples in both if samples is not None}

    def _fetch(self, number: int) -> None:
        block, card, there = self.blocks[number], self.card, self._on_card(number)
        card.fetch(there, "site", "lane", "feed")
        for name in ("body", "joint"):
            block.records.rows[name][...] = self._in_rows(card.fields("site", there, name))
        for name in ("lane", "watch"):
            block.records.rows[name][...] = self._in_rows(card.fields(name, there))
        block.records.feed["step"][0] = card.here["feed"]["step"][there].ravel()

    def _in_parts(self, rows: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """Rows of fields over the lanes of a block, as blocks on the card hold them."""
        return rows.reshape(shape[1], -1, self.parts, self.each // self.parts).transpose(2, 0, 1, 3).reshape(shape)

    def _in_rows(self, fields: np.ndarray) -> np.ndarray:
        """The other way round."""
        own = self.each // self.parts
        return fields.reshape(self.parts, fields.shape[1], -1, own).transpose(1, 2, 0, 3).reshape(-1, self.each)
