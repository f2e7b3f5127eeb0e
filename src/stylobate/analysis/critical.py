"""The smallest amplitude of a motion that collapses a column, on a stated grid of amplitudes.

Verdicts near the boundary alternate, so every amplitude of the grid is run and the whole alternation is reported; a
bisection would return one of many boundaries.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..campaign.runs import Progress, Request, run_all
from ..campaign.twins import the_twins
from ..column import Column
from ..column.scatter import Scatter
from ..constants import g
from ..errors import InputError, check_range
from ..models.base import Case, Cases, Model
from ..models.shared.quiet import share_of
from ..motion import Motion
from ..response.rows import Rows
from . import verdicts as v
from .critical_population import CriticalPopulation

if TYPE_CHECKING:
    import pandas

#: Largest number of amplitudes of a grid.
MAX_AMPLITUDES = 100_000


@dataclass(frozen=True, eq=False)
class CriticalAmplitude:
    """Outcomes over a grid of amplitudes.

    Parameters
    ----------
    column : Column
    motion : Motion
        The shape that was scaled.
    model : str
    amplitudes : array
        Peak accelerations along x [m/s²], shape (runs,), rising.
    rows : Rows, or a list of dict
        One per amplitude, with the keys of ``Measures.row()``.
    wall_time : float
        [s]
    nominal : float, optional
        Amplitude of the motion as it is [m/s²], of which the amplitudes are factors; None for a formula.
    population : CriticalPopulation, optional
        Twins of the column at the same amplitudes.
    """

    column: Column
    motion: Motion
    model: str
    amplitudes: np.ndarray
    rows: Rows
    wall_time: float
    nominal: float | None = None
    population: CriticalPopulation | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", Rows.of(self.rows))

    @property
    def verdicts(self) -> list[str]:
        """Verdict of each run: stands, collapsed, undecided or failed."""
        return v.verdicts_of(self.rows).tolist()

    @property
    def critical(self) -> float | None:
        """Smallest amplitude of the grid that collapses the column [m/s²]; None when none does.

        It is an upper bound where a smaller amplitude is undecided or failed; :attr:`counts` says whether any is.
        """
        return v.first_collapse(self.amplitudes, self.verdicts)

    @property
    def critical_factor(self) -> float | None:
        """The same as a factor of the record [-]; None for a formula, too."""
        return None if self.critical is None or not self.nominal else self.critical / self.nominal

    @property
    def all_collapse_above(self) -> float | None:
        """Smallest amplitude from which on every run of the grid collapses [m/s²]; None when the last one does not."""
        return v.all_collapse_above(self.amplitudes, self.verdicts)

    @property
    def counts(self) -> dict[str, int]:
        """Number of runs by verdict."""
        return v.count(self.verdicts)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per run: ``amplitude_g``, ``verdict`` and the measures."""
        table = self.rows.table()
        table.insert(0, "amplitude_g", self.amplitudes / g)
        table.insert(1, "verdict", self.verdicts)
        return table

    @property
    def alternation(self) -> pandas.DataFrame:
        """How the verdicts alternate with growing amplitude: one row per stretch of equal verdict."""
        import pandas

        return pandas.DataFrame(
            [
                {"from_g": low / g, "to_g": high / g, "verdict": one, "runs": runs}
                for low, high, one, runs in v.alternations(self.amplitudes, self.verdicts)
            ]
        )

    def summary(self) -> dict:
        """The JSON object of ``stylobate critical``."""
        counts = self.counts
        return {
            "critical_g": _in_g(self.critical),
            "first_collapse_g": _in_g(self.critical),
            "critical_factor": self.critical_factor,
            "all_collapse_above_g": _in_g(self.all_collapse_above),
            "runs": len(self.rows),
            "collapsed": counts[v.COLLAPSED],
            "stands": counts[v.STANDS],
            "undecided": counts[v.UNDECIDED],
            "failed": counts[v.FAILED],
            "alternation": self.alternation.to_dict("records"),
            "wall_s": self.wall_time,
            "model": self.model,
            **({} if self.population is None else self.population.summary()),
        }


def critical_amplitude(
    column: Column,
    motion: Motion,
    model: Model,
    start: float,
    stop: float,
    step: float = 0.005 * g,
    *,
    nominal: float | None = None,
    replicates: int = 0,
    scatter: Scatter | None = None,
    seed: int = 0,
    tail: float = 0.0,
    whole: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
    ledger: str | Path | None = None,
) -> CriticalAmplitude:
    """Run a column under one motion at every amplitude of a grid.

    Parameters
    ----------
    column : Column
    motion : Motion
        Scaled, all components alike, so that its peak along x takes the amplitudes of the grid.
    model : Model
    start, stop, step : float
        The grid: ``start``, ``start + step`` … up to ``stop`` [m/s²].
    nominal : float, optional
        Amplitude that ``motion`` stands for as it is [m/s²], of a formula; its peak along x by default.
    replicates, scatter, seed
        Twins of the column that go through every amplitude as well, as in :func:`stylobate.certainty`; none by default.
    tail : float
        Time to go on after the motion has ended [s].
    whole : bool
        Step all of a record; by default its quiet, below a tenth of what opens a joint, is left out before and between
        shocks and at the end, where the column lies at rest (``stepped_from_s``, ``stepped_to_s``, ``stepped_s`` say so).
    threads : int, optional
        All cores by default.
    progress : callable, optional
        Called with (finished, all).
    ledger : path, optional
        File that keeps finished runs: a call that was stopped goes on from there. It stays for the caller to remove.

    Returns
    -------
    CriticalAmplitude

    Raises
    ------
    InputError
        An impossible grid, or input that the model refuses.
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    amplitudes = amplitude_grid(start, stop, step)
    as_is = motion.pga if nominal is None else nominal
    if as_is == 0.0:
        raise InputError(f"motion {motion.name!r} is zero along x and cannot be scaled to an amplitude.")
    cases = own = Cases(len(amplitudes), lambda number: Case(column, motion.scaled(amplitudes[number] / as_is)))
    count = len(amplitudes)
    drawn = the_twins(column, model, replicates, scatter, seed) if replicates else None
    if drawn is not None:
        columns = [column, *drawn.columns]
        cases = Cases(len(columns) * count, lambda i: Case(columns[i // count], own[i % count].motion))
        model = model.paced(column)
    started = time.perf_counter()
    request = Request.of(cases, model, tail=tail, quiet=share_of([motion], whole))
    rows = run_all(request, threads=threads, progress=progress, ledger=ledger)
    wall, record = time.perf_counter() - started, as_is if nominal is None else None
    population = None if drawn is None else CriticalPopulation.of(amplitudes, rows[count:], drawn, record)
    return CriticalAmplitude(column, motion, model.name, amplitudes, rows[:count], wall, record, population)


def amplitude_grid(start: float, stop: float, step: float) -> np.ndarray:
    """Amplitudes from ``start`` to ``stop`` in steps [m/s²]; the last one is the last step not beyond ``stop``."""
    low, high, width = (float(value) for value in (start, stop, step))
    least = "it must not be below the smallest"
    check_range("the smallest amplitude", low / g, 0.0, 1e3, unit="g", open_low=True)
    check_range("the largest amplitude", high / g, low / g, 1e3, unit="g", remedy=least)
    check_range("the amplitude step", width / g, 0.0, 1e3, unit="g", open_low=True)
    steps = int((high - low) / width * (1.0 + 1e-12) + 1e-9)
    if steps >= MAX_AMPLITUDES:
        raise InputError(
            f"the grid of amplitudes has {steps + 1} steps; allowed is up to {MAX_AMPLITUDES}: give a larger step."
        )
    return low + width * np.arange(steps + 1)


def _in_g(value: float | None) -> float | None:
    return None if value is None else value / g
