"""The critical amplitude under each record of a suite: one grid of amplitudes for all of them."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.runs import Progress, Request, run_all
from ..campaign.twins import the_twins
from ..column import Column
from ..column.scatter import Scatter
from ..constants import g
from ..errors import InputError
from ..models.base import Case, Cases, Model
from ..models.shared.quiet import share_of
from ..motion import Motion
from . import verdicts as v
from .critical import CriticalAmplitude, amplitude_grid
from .critical_population import CriticalPopulation
from .directions import Compass, bearing, direction_of

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class CriticalSuite:
    """Outcomes of many records over one grid of amplitudes.

    Parameters
    ----------
    results : tuple of CriticalAmplitude
        One per record.
    wall_time : float
        [s], of all of them.
    """

    results: tuple[CriticalAmplitude, ...]
    wall_time: float

    @property
    def amplitudes(self) -> np.ndarray:
        """Peak accelerations along x [m/s²], shape (A,)."""
        return self.results[0].amplitudes

    @property
    def critical(self) -> float | None:
        """Smallest amplitude at which some record collapses the column [m/s²]; None when none does."""
        return min((one.critical for one in self.results if one.critical is not None), default=None)

    @property
    def critical_factor(self) -> float | None:
        """Smallest factor by which some motion collapses the column [-]; None when none does."""
        return min((one.critical_factor for one in self.results if one.critical_factor is not None), default=None)

    @property
    def worst(self) -> CriticalAmplitude | None:
        """The motion that collapses the column at the smallest factor; None when none does."""
        fell = [one for one in self.results if one.critical_factor is not None]
        return min(fell, key=lambda one: one.critical_factor or math.inf, default=None)

    @property
    def compass(self) -> Compass:
        """Critical factor by direction, the smallest of all records."""
        found: dict[float, float] = {}
        for one in self.results:
            at = bearing(direction_of(one.motion))
            if at is not None:
                factor = math.inf if one.critical_factor is None else one.critical_factor
                found[at] = min(factor, found.get(at, math.inf))
        bearings = sorted(found)
        return Compass(
            np.array(bearings), np.array([found[at] for at in bearings]), "critical factor of the record [-]"
        )

    @property
    def all_collapse_above(self) -> float | None:
        """Smallest amplitude from which on every record collapses the column [m/s²], or None."""
        found = [one.all_collapse_above for one in self.results]
        return None if None in found else max(one for one in found if one is not None)

    @property
    def share_collapsed(self) -> np.ndarray:
        """Share of the records that collapse the column, NaN where none is decided, shape (A,).

        See :func:`stylobate.analysis.verdicts.share_collapsed`.
        """
        return v.share_collapsed(*v.tally(np.array([one.verdicts for one in self.results]), axis=0))

    @property
    def table(self) -> pandas.DataFrame:
        """One row per record: its own peak, the critical amplitude, and how many runs came to which verdict."""
        import pandas

        return pandas.DataFrame([_row(one) for one in self.results])

    @property
    def runs(self) -> pandas.DataFrame:
        """One row per record and amplitude, as the table of :class:`CriticalAmplitude` with ``record`` before it."""
        import pandas

        return pandas.DataFrame(
            [
                {"record": one.motion.name, "amplitude_g": a / g, "verdict": verdict, **row}
                for one in self.results
                for a, verdict, row in zip(one.amplitudes, one.verdicts, one.rows)
            ]
        )

    def summary(self) -> dict:
        """The JSON object of ``stylobate critical`` for a folder of records."""
        counts = v.count([verdict for one in self.results for verdict in one.verdicts])
        critical, above = self.critical, self.all_collapse_above
        return {
            "critical_g": None if critical is None else critical / g,
            "first_collapse_g": None if critical is None else critical / g,
            "all_collapse_above_g": None if above is None else above / g,
            "runs": sum(len(one.rows) for one in self.results),
            **{one: counts[one] for one in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
            "critical_factor": self.critical_factor,
            "amplitudes_g": (self.amplitudes / g).tolist(),
            "share_collapsed": self.share_collapsed.tolist(),
            "records": [_row(one) for one in self.results],
            "worst": None if self.worst is None else _row(self.worst),
            "wall_s": self.wall_time,
            "model": self.results[0].model,
        }


def critical_suite(
    column: Column,
    motions: Sequence[Motion],
    model: Model,
    start: float,
    stop: float,
    step: float = 0.005 * g,
    *,
    replicates: int = 0,
    scatter: Scatter | None = None,
    seed: int = 0,
    tail: float = 0.0,
    whole: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
    ledger: str | Path | None = None,
) -> CriticalSuite:
    """Run a column under every record at every amplitude of a grid.

    Parameters
    ----------
    column : Column
    motions : sequence of Motion
        Each is scaled, all its components alike, so that its peak along x takes the amplitudes of the grid.
    model : Model
    start, stop, step, replicates, scatter, seed, tail, whole, threads, progress, ledger
        As for :func:`stylobate.analysis.critical.critical_amplitude`.

    Returns
    -------
    CriticalSuite

    Raises
    ------
    InputError
        No motion, one that is zero along x, an impossible grid, or input that the model refuses.
    """
    amplitudes = amplitude_grid(start, stop, step)
    if not motions:
        raise InputError("the suite holds no motion; give at least one.")
    for motion in motions:
        if motion.pga == 0.0:
            raise InputError(f"motion {motion.name!r} is zero along x and cannot be scaled to an amplitude.")
    drawn = the_twins(column, model, replicates, scatter, seed) if replicates else None
    columns = [column] if drawn is None else [column, *drawn.columns]
    count, each = len(amplitudes), len(amplitudes) * len(columns)

    def case(number: int) -> Case:
        record, rest = divmod(number, each)
        return Case(columns[rest // count], motions[record].scaled_to_pga(float(amplitudes[rest % count])))

    cases = Cases(len(motions) * each, case)
    if drawn is not None:
        model = model.paced(column)
    started = time.perf_counter()
    request = Request.of(cases, model, tail=tail, quiet=share_of(motions, whole))
    rows = run_all(request, threads=threads, progress=progress, ledger=ledger)
    results = []
    for i, motion in enumerate(motions):
        some = rows[i * each : (i + 1) * each]
        population = None if drawn is None else CriticalPopulation.of(amplitudes, some[count:], drawn, motion.pga)
        results.append(
            CriticalAmplitude(column, motion, model.name, amplitudes, some[:count], 0.0, motion.pga, population)
        )
    return CriticalSuite(tuple(results), time.perf_counter() - started)


def _row(one: CriticalAmplitude) -> dict[str, Any]:
    critical, above, counts = one.critical, one.all_collapse_above, one.counts
    return {
        "record": one.motion.name,
        "pga_g": one.motion.pga / g,
        "pgv_m_s": one.motion.pgv,
        "critical_g": None if critical is None else critical / g,
        "critical_factor": one.critical_factor,
        "all_collapse_above_g": None if above is None else above / g,
        **direction_of(one.motion),
        **{name: counts[name] for name in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
        **({} if one.population is None else one.population.percentiles),
    }
