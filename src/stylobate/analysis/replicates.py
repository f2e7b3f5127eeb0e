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

from ..campaign.campaign import Campaign
from ..campaign.digests import Hasher
from ..campaign.grid import MAX_CELLS, grid_axis
from ..campaign.runs import Request, Runs
from ..campaign.twins import the_twins
from ..column import Column
from ..errors import InputError, check_range
from ..models.base import Case, Model
from ..motion.scatter import MotionScatter, ScatteredSines
from ..version import __version__
from . import verdicts as v
from .probability import CollapseProbability

#: Largest number of runs in all.
MAX_RUNS = 20_000_000


def collapse_probability(
    column: Column,
    model: Model,
    frequencies: Sequence[float] | np.ndarray,
    amplitudes: Sequence[float] | np.ndarray,
    duration: float = 10.0,
    *,
    motion_scatter: MotionScatter | None = None,
    confidence: float = 0.95,
    out: str | Path | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> CollapseProbability:
    """Run many slightly different columns under harmonic base motions of all frequencies and amplitudes.

    Parameters
    ----------
    column, model, frequencies, amplitudes, duration
        As in :func:`stylobate.collapse_domain`.
    motion_scatter : MotionScatter, optional
        How the motions of a cell differ; by default they do not. Models in the plane leave ``across`` out.
    confidence : float
        Level of the intervals.
    out : path, optional
        Folder that keeps finished runs (``runs.sqlite``), unless the campaign has another ledger, and when all are there
        holds ``probability.nc`` and ``probability.csv``.
    campaign, **settings : Campaign, optional
        Each of the replicates goes through every cell; the same seed gives the same columns and motions.

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
    campaign = Campaign.of("collapse_probability", campaign, settings, ("whole",), replicates=20)
    started = time.perf_counter()
    f = grid_axis("frequencies", frequencies, 1e-3, 1e3, "Hz")
    a = grid_axis("amplitudes", amplitudes, 0.0, 1e4, "m/s²")
    check_range("confidence", confidence, 0.0, 1.0, open_low=True, open_high=True, remedy="0.95 is the default")
    shaking, beyond = MotionScatter() if motion_scatter is None else motion_scatter, ()
    if shaking.across and model.is_plane(model.parameters()):
        shaking, beyond = dataclasses.replace(shaking, across=0.0), ("across",)
    twins = the_twins(column, model, campaign, alone=not shaking.given)
    number, seed = campaign.replicates, campaign.seed
    if len(f) * len(a) > MAX_CELLS or len(f) * len(a) * number > MAX_RUNS:
        raise InputError(
            f"{len(f)} × {len(a)} cells with {number} replicates are {len(f) * len(a) * number} runs; allowed is up to "
            f"{MAX_CELLS} cells and {MAX_RUNS} runs: give fewer."
        )
    cases = _Cases(twins.columns, f, a, ScatteredSines(f, float(duration), shaking, number, seed))
    key = {
        "column": column.digest,
        "frequencies": f.tolist(),
        "amplitudes": a.tolist(),
        "duration": float(duration),
        "replicates": number,
        "scatter": dataclasses.asdict(twins.scatter),
        "motion_scatter": dataclasses.asdict(shaking),
        "left_out": [*twins.left_out, *beyond],
        "seed": seed,
    }
    campaign = campaign.kept_in(out)
    codes = np.full(len(cases), v.VERDICTS.index(v.NOT_RUN), dtype=np.int8)
    peaks = np.full(len(cases), np.nan, dtype=np.float32)
    done = 0
    try:
        request = Request.of(cases, Hasher(model, campaign.options))
        with closing(Runs(campaign)) as runs, closing(runs.run(request)) as finished:
            for index, row in finished:
                codes[index] = v.VERDICTS.index(v.verdict(row))
                peak = row["peak_top_displacement_m"]
                peaks[index] = peak if np.isfinite(peak) else np.nan
                done += 1
                if campaign.progress:
                    campaign.progress(done, len(cases))
    except KeyboardInterrupt:
        pass
    provenance = {
        **key,
        "column": column.to_dict(),
        "column_digest": column.digest,
        "model": model.name,
        "parameters": model.parameters(),
        "references": [*model.references, "wilson1927"],
        "tail": campaign.tail,
        "version": __version__,
    }
    shape = (len(f), len(a), number)
    found = CollapseProbability(
        column, model.name, f, a, codes.reshape(shape), peaks.reshape(shape), twins.scatter, shaking, seed, confidence,
        time.perf_counter() - started, provenance,
    )  # fmt: skip
    if out is not None and found.complete:
        found.save(Path(out) / "probability.nc")
        found.save(Path(out) / "probability.csv")
    return found


class _Cases(Sequence):
    """Cases in the order (frequency, amplitude, replicate), made when asked for: columns and samples are shared."""

    def __init__(self, columns: Sequence[Column], f: np.ndarray, a: np.ndarray, motions: ScatteredSines) -> None:
        self.shape = (len(f), len(a), len(columns))
        self.amplitudes, self.columns, self.motions = a, columns, motions

    def __len__(self) -> int:
        return int(np.prod(self.shape))

    def __getitem__(self, index: Any) -> Case:
        if not 0 <= index < len(self):
            raise IndexError(index)
        i, j, k = (int(one) for one in np.unravel_index(index, self.shape))
        return Case(self.columns[k], self.motions.motion(i, self.amplitudes[j], k))
