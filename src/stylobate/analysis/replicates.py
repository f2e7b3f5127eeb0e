"""Many slightly different columns through every cell: the population behind a probability of collapse.

Near the boundary a verdict hangs on what no survey knows: a per cent of a drum's width, of friction, of stiffness. The
same population of columns goes through every cell; what is counted is how many of them collapse.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from ..campaign.digests import Hasher
from ..campaign.grid import MAX_CELLS, grid_axis
from ..campaign.ledger import RUNS_FILE
from ..campaign.runs import Progress, Request, Runs
from ..column import Column
from ..column.imperfections import Imperfection, imperfect_columns
from ..errors import InputError, as_typed, check_range
from ..models.base import Case, Model
from ..motion import Motion, harmonic
from ..version import __version__
from . import verdicts as v
from .probability import CollapseProbability

#: Largest number of variations, and of runs in all.
MAX_REPLICATES, MAX_RUNS = 10_000, 20_000_000

#: Starts of a motion, and sizes of its component across, that are told apart, so that all variations share these samples.
PHASES, ASIDES = 9, 8


def collapse_probability(
    column: Column,
    model: Model,
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    replicates: int = 20,
    imperfection: Imperfection | None = None,
    seed: int = 0,
    confidence: float = 0.95,
    tail: float = 0.0,
    threads: int | None = None,
    progress: Progress | None = None,
    out: str | Path | None = None,
    ledger: str | Path | None = None,
) -> CollapseProbability:
    """Run many slightly different columns under harmonic base motions of all frequencies and amplitudes.

    Parameters
    ----------
    column, model, frequencies, amplitudes, duration, tail, threads, progress
        As in :func:`stylobate.collapse_domain`.
    replicates : int
        Number of variations of the column; each goes through every cell.
    imperfection : Imperfection, optional
        ±1 % of geometry, friction and stiffness by default.
    seed : int
        The same seed gives the same columns.
    confidence : float
        Level of the intervals.
    out : path, optional
        Folder that keeps finished runs (``runs.sqlite``), for good, and when all are there holds ``probability.nc`` and
        ``probability.csv``.
    ledger : path, optional
        The file that keeps finished runs, if it is not that in ``out``.

    Returns
    -------
    CollapseProbability
        After an interrupt (Ctrl-C) it holds the runs that are finished, and ``complete`` is False.

    Raises
    ------
    InputError
        An impossible grid, number, folder, or input that the model refuses.

    Notes
    -----
    Runs that failed or are undecided are counted apart. Failed ones are left out; undecided ones are never a collapse,
    and the upper confidence limit allows for all of them having become one. The interval is for the probability over the
    stated population, and has nothing to say about the model being right.
    """
    started = time.perf_counter()
    f = grid_axis("frequencies", frequencies, 1e-3, 1e3, "Hz")
    a = grid_axis("amplitudes", amplitudes, 0.0, 1e4, "m/s²")
    number = _whole("replicates", replicates, 1, MAX_REPLICATES)
    _whole("seed", seed, 0, 2**63 - 1)
    check_range("confidence", confidence, 0.0, 1.0, open_low=True, open_high=True, remedy="0.95 is the default")
    size = Imperfection() if imperfection is None else imperfection
    if len(f) * len(a) > MAX_CELLS or len(f) * len(a) * number > MAX_RUNS:
        raise InputError(
            f"{len(f)} × {len(a)} cells with {number} replicates are {len(f) * len(a) * number} runs; allowed is up to "
            f"{MAX_CELLS} cells and {MAX_RUNS} runs: give fewer."
        )
    seen = size if "y" in model.axes else dataclasses.replace(size, across=0.0)  # what the model would leave out
    cases = _Cases(column, f, a, float(duration), number, seen, seed)
    key = {
        "column": column.digest,
        "frequencies": f.tolist(),
        "amplitudes": a.tolist(),
        "duration": float(duration),
        "replicates": number,
        "imperfection": dataclasses.asdict(size),
        "seed": seed,
    }
    if out is not None and ledger is None:
        ledger = Path(out) / RUNS_FILE
    if ledger is not None and not Path(ledger).parent.is_dir():
        raise InputError(f"folder {Path(ledger).parent} does not exist; create it first.")
    codes = np.full(len(cases), v.VERDICTS.index(v.NOT_RUN), dtype=np.int8)
    peaks = np.full(len(cases), np.nan, dtype=np.float32)
    done = 0
    try:
        request = Request.of(cases, Hasher(model, tail))
        with closing(Runs(ledger)) as runs, closing(runs.run(request, threads)) as finished:
            for index, row in finished:
                codes[index] = v.VERDICTS.index(v.verdict(row))
                peak = row["peak_top_displacement_m"]
                peaks[index] = peak if np.isfinite(peak) else np.nan
                done += 1
                if progress:
                    progress(done, len(cases))
    except KeyboardInterrupt:
        pass
    provenance = {
        **key,
        "column": column.to_dict(),
        "column_digest": column.digest,
        "model": model.name,
        "parameters": model.parameters(),
        "references": [*model.references, "wilson1927"],
        "tail": tail,
        "version": __version__,
    }
    shape = (len(f), len(a), number)
    found = CollapseProbability(
        column, model.name, f, a, codes.reshape(shape), peaks.reshape(shape), size, seed, confidence,
        time.perf_counter() - started, provenance,
    )  # fmt: skip
    if out is not None and found.complete:
        found.save(Path(out) / "probability.nc")
        found.save(Path(out) / "probability.csv")
    return found


class _Cases(Sequence):
    """Cases in the order (frequency, amplitude, variation), made when asked for: columns and samples are shared."""

    def __init__(
        self, column: Column, f: np.ndarray, a: np.ndarray, duration: float, number: int, size: Imperfection, seed: int
    ) -> None:
        self.shape = (len(f), len(a), number)
        self.amplitudes = a
        self.columns = imperfect_columns(column, size, number, seed)
        stream = np.random.default_rng([seed, 1])
        self.factors = 1.0 + size.amplitude * stream.uniform(-1.0, 1.0, number)
        starts = size.phase * np.linspace(-1.0, 1.0, PHASES) if size.phase else np.zeros(1)
        self.start = stream.integers(0, len(starts), number)
        aside = size.across * np.linspace(-1.0, 1.0, ASIDES) if size.across else np.zeros(1)
        self.aside = np.random.default_rng([seed, 2]).integers(0, len(aside), number)
        self.units = [
            [[_sine(float(one), duration, float(start), float(share)) for share in aside] for start in starts]
            for one in f
        ]

    def __len__(self) -> int:
        return int(np.prod(self.shape))

    def __getitem__(self, index: Any) -> Case:
        if not 0 <= index < len(self):
            raise IndexError(index)
        i, j, k = np.unravel_index(index, self.shape)
        unit = self.units[i][self.start[k]][self.aside[k]]
        motion = unit.scaled(float(self.amplitudes[j] * self.factors[k]))
        return Case(self.columns[k], motion)


def _sine(frequency: float, duration: float, start: float, aside: float) -> Motion:
    """A unit sine that starts so many cycles late, with a component across of that share, a quarter of a cycle later."""
    unit = harmonic(frequency, 1.0, duration)
    if not start and not aside:
        return unit
    angle = 2.0 * np.pi * (np.arange(unit.steps) * unit.dt * frequency + start)
    lateral = -aside * np.cos(angle) if aside else None
    return unit.replace(acceleration=np.sin(angle), lateral=lateral)


def _whole(name: str, value: Any, low: int, high: int) -> int:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not low <= value <= high:
        raise InputError(f"{name} is {as_typed(value)}; allowed is a whole number from {low} to {high}.")
    return int(value)
