"""The cases of a campaign that its ledger does not hold yet, told by one bit a case."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ..models.base import Case

#: Bytes of bits that are looked through at once, to find the case that is the n-th of the others.
_BLOCK = 512


class Others(Sequence[Case]):
    """All cases but those that are left out; made when they are asked for.

    Parameters
    ----------
    cases : sequence of Case
    """

    def __init__(self, cases: Sequence[Case]) -> None:
        self.cases = cases
        self._known = np.zeros(-(-len(cases) // 8), dtype=np.uint8)
        self._before: list[int] | None = None  # the others before each block, and all of them
        self._in_block = lru_cache(8)(self._look)  # cases are asked for one after the other

    def leave_out(self, number: int) -> bool:
        """Leave a case out, before the others are asked for; False if it is out already, or there is none."""
        if not 0 <= number < len(self.cases):
            return False
        byte, bit = number >> 3, 0x80 >> (number & 7)
        if self._known[byte] & bit:
            return False
        self._known[byte] |= bit
        return True

    def number(self, index: int) -> int:
        """The number among all cases of one of the others."""
        before = self._counted()
        if not 0 <= index < before[-1]:
            raise IndexError(index)
        block = bisect_right(before, index) - 1
        return int(self._in_block(block)[index - before[block]])

    def __len__(self) -> int:
        return self._counted()[-1]

    def __getitem__(self, index: Any) -> Any:
        return self.cases[self.number(index)]

    def _counted(self) -> list[int]:
        if self._before is None:
            others = [len(self._look(block)) for block in range(-(-len(self._known) // _BLOCK))]
            self._before = [0, *np.cumsum(others, dtype=np.int64).tolist()]
        return self._before

    def _look(self, block: int) -> np.ndarray:
        first = block * _BLOCK
        known = np.unpackbits(self._known[first : first + _BLOCK])
        return 8 * first + np.flatnonzero(known[: len(self.cases) - 8 * first] == 0)
