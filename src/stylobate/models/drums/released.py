"""Free motions of a column that is let go tilted: many at once, each with its own losses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...column import Column
from ...column.joint import Losses
from ...kernels.run_codes import LANES
from ...motion import Motion
from ..base import Case, RunOptions
from ..engine import engine_for
from ..start import Start


class Free(NamedTuple):
    """A free motion.

    Parameters
    ----------
    time : array
        [s], shape (states,).
    lean : array
        Lean of the lowest body towards x and y [rad], shape (states, 2).
    """

    time: np.ndarray
    lean: np.ndarray


def released(
    column: Column, model: Any, losses: Sequence[Losses], starts: Sequence[Start], duration: float, interval: float
) -> list[Free]:
    """Free motions from starts, with losses in place of the model's.

    Parameters
    ----------
    column : Column
    model : LossyDrums
    losses : sequence of Losses
    starts : sequence of Start
        As many.
    duration, interval : float
        Of each motion, and between its states at most [s].
    """
    engines = [engine_for(replace(model, losses=one), column) for one in losses]
    kinds: dict[Any, list[int]] = {}
    for number, engine in enumerate(engines):
        kinds.setdefault(engine.kind, []).append(number)
    found: dict[int, Free] = {}
    for numbers in kinds.values():
        # lanes of about one step end together
        ordered = sorted(numbers, key=lambda number: engines[number].step)
        for first in range(0, len(ordered), LANES):
            some = ordered[first : first + LANES]
            block = engines[some[0]].block(RunOptions(start=starts[some[0]], until_end=True))
            for lane, number in enumerate(some):
                block.pack, block.options = engines[number].pack, replace(block.options, start=starts[number])
                block.load(lane, Case(column, Motion(duration, np.zeros(2))))
            stride = max(1, int(interval / (block.chunk * block.dt.max())))
            states = [(block.dt * block.feed["step"][0], block.leans()) for _ in followed(block, stride, len(some))]
            times, leans = (np.stack(one) for one in zip(*states, strict=True))
            for lane, number in enumerate(some):
                moves = np.concatenate(([True], np.diff(times[:, lane]) > 0.0))
                found[number] = Free(times[moves, lane], leans[moves, :, lane].copy())
    return [found[number] for number in range(len(losses))]


def followed(block: Any, stride: int, lanes: int) -> Iterator[None]:
    """Let a block go on by so many chunks of steps at a time, as long as any of its first lanes runs; the start first."""
    yield
    while not all(block.is_over(lane) for lane in range(lanes)):
        block.advance(stride)
        yield
