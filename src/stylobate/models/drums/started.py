"""How a run begins in a lane, kept for the next one of the same column that begins alike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .records import LaneRecords, Packed


class Lanes(Protocol):
    """What a run that has begun is taken from, and put into: a block of lanes."""

    arrays: LaneRecords
    packed: dict[int, Packed]
    dt: np.ndarray

    @property
    def beginning(self) -> tuple[np.ndarray, ...]:
        """What is kept of how runs have begun, the lanes first."""
        ...


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
    def of(cls, block: Lanes, lane: int, ground: tuple[float, ...]) -> Started:
        """That of a run that has begun in a lane."""
        numbers = block.arrays.numbers[: block.arrays.moving, lane].copy()
        kept = tuple(one[lane].copy() for one in block.beginning)
        return cls(block.packed[lane], float(block.dt[lane]), ground, numbers, kept)

    def serves(self, packed: Packed, dt: float, ground: tuple[float, ...]) -> bool:
        """Whether another run begins so."""
        return packed is self.packed and dt == self.dt and ground == self.ground

    def put(self, block: Lanes, lane: int) -> None:
        """Let a run begin so in a lane."""
        block.arrays.numbers[: len(self.numbers), lane] = self.numbers
        for one, own in zip(block.beginning, self.kept, strict=True):
            one[lane] = own
