"""Rocking blocks: lanes for the kernel of the rocking equation, of a batch and of a single run alike."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np

from ...column import Column
from ...kernels.rocking import step as kernel
from ...motion import Motion
from ...response import Histories, Measures
from ..base import Case, RunOptions
from ..shared.lanes import MOST_SAMPLES, run_alike
from .block import REST, RockingBlock, half_steps, histories_of, lightest_weight, off_the_ground, remaining_peak

#: Chunks of steps between two looks of the interpreter: some milliseconds.
CHUNKS = 8

#: Motions at half steps that a block keeps.
MOST_TABLES = 256

Tables = tuple[np.ndarray, np.ndarray | None, np.ndarray]

#: Default step over 1/p.
STEP_SHARE = 0.01

#: About what a step of a single run costs on one core [s].
COST = 2e-5


class Rocking(Protocol):
    """A model that sees one block in a column, or takes its one drum for a block."""

    @property
    def initial_rotation(self) -> float: ...
    @property
    def time_step(self) -> float | None: ...
    def block(self, column: Column) -> RockingBlock: ...


def steps_of(model: Rocking, block: RockingBlock, motion: Motion) -> tuple[int, float]:
    """Number of equal steps for a motion and their length [s]: near the one wanted, a whole number of them per motion.

    Steps shorter than the sampling interval divide it, so that the kinks of the motion fall between steps.
    """
    intervals, wanted = motion.steps - 1, model.time_step or STEP_SHARE / block.p
    if wanted <= motion.dt:
        steps = intervals * math.ceil(motion.dt / wanted * (1.0 - 1e-12))
    else:
        steps = math.ceil(intervals / min(MOST_SAMPLES, int(wanted / motion.dt)))
    return steps, motion.duration / steps


def run_blocks(
    model: Rocking, cases: Sequence[Case], options: RunOptions, threads: int
) -> Iterator[tuple[int, Measures]]:
    """Many runs by the lane kernel, impacts located; those with a vertical component apart."""
    return run_alike(
        lambda case: case.motion.z_samples is not None,
        lambda vertical: RockingLanes(model, options, vertical),
        cases,
        threads,
    )


def run_one(model: Rocking, column: Column, motion: Motion, options: RunOptions) -> tuple[Histories, Measures]:
    """One run with histories, by the steps of a batch."""
    lanes = RockingLanes(model, options, motion.z_samples is not None)
    lanes.load(0, Case(column, motion))
    step = float(lanes.row("STEP")[0])
    stride = max(1, round(options.output_interval / step))
    times, rows = [0.0], [lanes.state(0)]
    for count in itertools.count(1):
        lanes.advance(1, 1)
        if count % stride == 0 or lanes.is_over(0):
            times.append(count * step)
            rows.append(lanes.state(0))
        if lanes.is_over(0):
            break
    block = model.block(column)
    return histories_of(block, motion, np.array(times), np.array(rows), model.initial_rotation), lanes.collect(0)


class RockingLanes:
    """A block of lanes of rocking blocks; see :class:`stylobate.models.shared.lanes.LaneBlock`."""

    lanes = kernel.LANES

    def __init__(self, model: Rocking, options: RunOptions, vertical: bool) -> None:
        self.model, self.options, self.vertical = model, options, vertical
        n = self.lanes
        self.values = np.zeros(kernel.ROWS * n)
        self.rows = self.values.reshape(kernel.ROWS, n)
        self.whole = np.zeros((kernel.WHOLE, n), dtype=np.int64)
        self.real = np.zeros((kernel.REAL, n))
        self.a = np.zeros((2 * kernel.CHUNK + 1) * n)
        self.g = np.ones((2 * kernel.CHUNK + 1) * n)
        self.row("SIDE")[:] = 1.0
        self.linear = False
        self.coefficients = kernel.trigonometry(False)
        self.cases: list[tuple[Case, RockingBlock, Tables, int] | None] = [None] * n
        self.blocks: dict[int, tuple[Column, RockingBlock]] = {}
        self.tables: dict[tuple[int, int, float, float], tuple[Motion, Tables]] = {}

    def row(self, name: str) -> np.ndarray:
        """A row of the state by its name in the kernel."""
        return self.rows[getattr(kernel, name) // self.lanes]

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane that is free."""
        column, motion = case
        block = self._block(column)
        steps, step = steps_of(self.model, block, motion)
        shaken = steps
        steps += math.ceil(self.options.tail / step - 1e-9)
        tables = self._tables(motion, step, shaken)
        self.cases[lane] = (case, block, tables, steps)
        start, side = abs(self.model.initial_rotation), -1.0 if self.model.initial_rotation > 0.0 else 1.0
        values = {
            "X": start, "V": 0.0, "SIDE": side,
            "MOVING": 1.0 if start else 0.0, "WORK": 0.0, "WORK_MAX": 0.0, "LOSS": 0.0,
            "TO_RIGHT": max(0.0, side * start), "TO_LEFT": max(0.0, -side * start),
            "ALPHA": block.alpha, "P2": block.p**2, "E": block.restitution, "STEP": step, "LEFT": steps,
            "SIN_A": block.uplift_sine, "COS_A": block.uplift_cosine, "X_EVENT": math.inf,
            "COLLAPSE": -1.0, "IMPACTS": 0.0,
        }  # fmt: skip
        for name, value in values.items():
            self.row(name)[lane] = value
        x, z, remain = (0 if table is None else table.ctypes.data for table in tables)
        self.whole[:, lane] = (x, z, remain, 2 * shaken + 1, 0)
        factor = motion.factor / block.gravity
        self.real[:, lane] = (factor * block.push, -1.0, lightest_weight(motion, block.gravity), factor)

    def advance(self, chunks: int = CHUNKS, chunk: int = kernel.CHUNK) -> None:
        """Advance all lanes, by some hundred steps unless told otherwise."""
        kernel.advance(
            self.values, self.whole, self.real, self.a, self.g, self.coefficients, chunks, chunk, REST, self.linear,
            self.vertical, self.options.until_end,
        )  # fmt: skip

    def state(self, lane: int) -> tuple[float, float, float, float]:
        """Rotation towards +x [rad], velocity [rad/s], input work and loss at impacts over I₀ [1/s²]."""
        x, v, side, work, loss = (float(self.row(name)[lane]) for name in ("X", "V", "SIDE", "WORK", "LOSS"))
        return side * x, v, work, loss

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended."""
        return self.row("LEFT")[lane] <= 0.0

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended."""
        loaded = self.cases[lane]
        assert loaded is not None
        case, block, _, steps = (
            loaded  # kept until the lane is loaded anew: the kernel still reads the motion's samples
        )
        x, v, side, work, work_max, right, left, loss, step, collapse = (
            float(self.row(name)[lane])
            for name in ("X", "V", "SIDE", "WORK", "WORK_MAX", "TO_RIGHT", "TO_LEFT", "LOSS", "STEP", "COLLAPSE")
        )
        start = abs(self.model.initial_rotation)
        stored = 0.5 * v * v + float(block.potential(x) - block.potential(start))
        return block.measures(
            x=x, v=v, side=side, peaks=(right, left), start=-self.model.initial_rotation, collapse_time=collapse,
            end=steps * step, failure=off_the_ground(case.motion, block.gravity, collapse), work=work_max,
            unaccounted=work - stored - loss, step=step, steps=round(collapse / step) if collapse >= 0.0 else steps,
        )  # fmt: skip

    def _block(self, column: Column) -> RockingBlock:
        if id(column) not in self.blocks:
            self.blocks[id(column)] = (column, self.model.block(column))
            block = self.blocks[id(column)][1]
            if block.linear != self.linear:
                self.linear, self.coefficients = block.linear, kernel.trigonometry(block.linear)
        return self.blocks[id(column)][1]

    def _tables(self, motion: Motion, step: float, steps: int) -> Tables:
        """Motion along x and z and what is left of it at half steps, shared by all runs of the same samples and step."""
        key = (id(motion.samples), id(motion.z_samples), motion.dt, step)
        if key not in self.tables:
            if len(self.tables) >= MOST_TABLES:  # lanes keep theirs alive
                self.tables.clear()
            z = motion.z_samples
            vertical = None if z is None else half_steps(z, motion.dt, step, steps)
            peaks_ahead = remaining_peak(motion)
            at = np.minimum(
                (np.arange(2 * steps + 2) * (0.5 * step / motion.dt) + 1e-9).astype(np.int64), len(peaks_ahead) - 1
            )
            remain = peaks_ahead[at]
            remain[2 * steps :] = 0.0
            tables = (half_steps(motion.samples, motion.dt, step, steps), vertical, remain)
            self.tables[key] = (motion, tables)  # the motion keeps its arrays alive, and so their ids
        return self.tables[key][1]
