"""The smallest amplitude of a motion that collapses a column, on a stated grid of amplitudes.

Verdicts near the boundary alternate, so every amplitude of the grid is run and the whole alternation is reported; a
bisection would return one of many boundaries. A record is run as it is, too: what is said of a factor of the record must not
be more than the record itself does.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.digests import Hasher
from ..campaign.runs import Request, run_all
from ..campaign.twins import the_twins
from ..column import Column
from ..column.structure import Structure
from ..constants import g
from ..errors import InputError, check_kind, check_range
from ..models.base import Case, Cases, Model
from ..models.engine import engine_for
from ..motion import Motion
from ..notebook import Shown
from ..response.rows import Rows
from ..response.words import to_decide
from . import verdicts as v
from .capacity import Capacity, bounds, of_levels
from .critical_population import CriticalPopulation
from .critical_words import sentence
from .difference import caveat

if TYPE_CHECKING:
    import pandas

#: Largest number of amplitudes of a grid.
MAX_AMPLITUDES = 100_000

#: Amplitudes that differ by less are one [-].
CLOSE = 1e-9


@dataclass(frozen=True, eq=False)
class CriticalAmplitude(Shown):
    """Outcomes over a grid of amplitudes.

    Parameters
    ----------
    column : Column
    motion : Motion
        The shape that was scaled.
    model : str
    amplitudes : array
        Peak accelerations along x [m/s²], shape (runs,), rising: the grid, and that of a record as it is.
    rows : Rows, or a list of dict
        One per amplitude, with the keys of ``Measures.row()``.
    wall_time : float
        [s]
    nominal : float, optional
        Amplitude of the motion as it is [m/s²], of which the amplitudes are factors; None for a formula.
    population : CriticalPopulation, optional
        Twins of the column at the same amplitudes.
    doubt : str
        Caveat before all that rests on the runs, because of their model; empty where nothing does.
    cure : str
        What decides runs that are undecided, see :func:`stylobate.response.words.to_decide`.
    """

    column: Column
    motion: Motion
    model: str
    amplitudes: np.ndarray
    rows: Rows
    wall_time: float
    nominal: float | None = None
    population: CriticalPopulation | None = None
    doubt: str = ""
    cure: str = ""

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
    def capacity(self) -> Capacity:
        """Between which amplitudes the first collapse lies [m/s²]."""
        return of_levels(self.amplitudes, self.verdicts)

    @property
    def lowest_capacity(self) -> Capacity:
        """Between which amplitudes the first collapse of the column or one of its twins lies [m/s²]."""
        each = [self.capacity, *([] if self.population is None else self.population.capacities)]
        return Capacity(min(one.low for one in each), min(one.high for one in each))

    @property
    def lowest(self) -> float | None:
        """Smallest amplitude that collapses the column or one of its twins [m/s²]; None when none does."""
        return self.lowest_capacity.value

    @property
    def open_below(self) -> int:
        """Number of runs of the column and its twins without a verdict below that amplitude; any may be a collapse."""
        return self.without_verdict(self.lowest_capacity.high)

    def without_verdict(self, below: float) -> int:
        """Number of runs of the column and its twins without a verdict below an amplitude [m/s²]."""
        each = [(self.amplitudes, np.array(self.verdicts))]
        each += [] if self.population is None else [(self.population.amplitudes, self.population.verdicts)]
        open_ = [~np.isin(one[..., a < below * (1.0 - CLOSE)], (v.STANDS, v.COLLAPSED)) for a, one in each]
        return sum(int(one.sum()) for one in open_)

    @property
    def lowest_factor(self) -> float | None:
        """The same as a factor of the record [-]; None for a formula, too."""
        return None if self.lowest is None or not self.nominal else self.lowest / self.nominal

    @property
    def bounds(self) -> dict[str, str]:
        """Of which numbers of :meth:`summary` only a bound is known, such as "≤ 0.3" or "> 1.5", by name."""
        above, stood = self.all_collapse_above, self.amplitudes[np.array(self.verdicts) == v.STANDS]
        always = Capacity(float(max(stood, default=0.0)), math.inf if above is None else above)
        named = {"critical_g": (self.capacity, g), "all_collapse_above_g": (always, g)}
        named["lowest_collapse_g"] = self.lowest_capacity, g
        if self.nominal:
            named["critical_factor"] = self.capacity, self.nominal
            named["lowest_collapse_factor"] = self.lowest_capacity, self.nominal
        return bounds(named)

    @property
    def as_recorded(self) -> dict[str, Any] | None:
        """Effect of the record as it is: amplitude, verdict, share of the twins with its interval and their verdicts.

        None for a formula, or beyond the grid.
        """
        if self.nominal is None or self.nominal not in self.amplitudes:
            return None
        verdict = self.verdicts[int(np.flatnonzero(self.amplitudes == self.nominal)[0])]
        found: dict[str, Any] = {"amplitude_g": self.nominal / g, "verdict": verdict}
        if self.population is not None:
            likes = self.population
            at = likes.amplitudes == self.nominal
            names = "collapse_probability", "collapse_interval_low", "collapse_interval_high"
            shares = zip(names, (likes.probability, *likes.interval), strict=True)
            found |= {name: float(one[at][0]) for name, one in shares if at.any()}
            found |= {name: int(count[at].sum()) for name, count in likes.counts.items()}
        return found

    @property
    def counts(self) -> dict[str, int]:
        """Number of runs by verdict."""
        return v.count(self.verdicts)

    @property
    def undecided(self) -> bool:
        """Whether a run, or one of a twin, is undecided."""
        likes = () if self.population is None else self.population.verdicts.ravel().tolist()
        return v.UNDECIDED in (*self.verdicts, *likes)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per run: ``amplitude_g``, ``verdict`` and the measures."""
        table = self.rows.table()
        table.insert(0, "amplitude_g", self.amplitudes / g)
        table.insert(1, "verdict", self.verdicts)
        return table

    @property
    def alternation(self) -> pandas.DataFrame:
        """Alternation of verdicts with growing amplitude: one row per stretch of equal verdict."""
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
        found = {
            "critical_g": _in_g(self.critical),
            "first_collapse_g": _in_g(self.critical),
            "critical_factor": self.critical_factor,
            "all_collapse_above_g": _in_g(self.all_collapse_above),
            "lowest_collapse_g": _in_g(self.lowest),
            "lowest_collapse_factor": self.lowest_factor,
            "open_below": self.open_below,
            "bounds": self.bounds,
            "as_recorded": self.as_recorded,
            "runs": len(self.rows),
            "collapsed": counts[v.COLLAPSED],
            "stands": counts[v.STANDS],
            "undecided": counts[v.UNDECIDED],
            "failed": counts[v.FAILED],
            "alternation": self.alternation.to_dict("records"),
            "wall_s": self.wall_time,
            "model": self.model,
            "doubt": self.doubt,
            "to_decide": self.cure if self.undecided else "",
            **({} if self.population is None else self.population.summary()),
        }
        return found | {"sentence": sentence(found, self.column.kind, self.column.like)}


def critical_amplitude(
    column: Column,
    motion: Motion,
    model: Model,
    start: float,
    stop: float,
    step: float = 0.005 * g,
    *,
    nominal: float | None = None,
    twin_amplitudes: int | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> CriticalAmplitude:
    """Run a column under one motion at every amplitude of a grid, and under a record as it is.

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
    twin_amplitudes : int, optional
        Most amplitudes of the grid that twins go through, evenly spread; all by default.
    campaign, **settings : Campaign, optional
        With replicates, twins of the column go through the amplitudes as well.

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
    campaign = Campaign.of("critical_amplitude", campaign, settings)
    check_kind("column", column, Structure)
    check_kind("motion", motion, Motion)
    check_kind("model", model, Model)
    as_is = motion.pga if nominal is None else nominal
    shaken = [Shaken(motion, as_is, nominal is None)]
    results, wall = sweep(column, shaken, model, amplitude_grid(start, stop, step), campaign, twin_amplitudes)
    return dataclasses.replace(results[0], wall_time=wall)


class Shaken(NamedTuple):
    """A motion, its amplitude as it is [m/s²], and whether that is one of a record, not of a formula."""

    motion: Motion
    as_is: float
    recorded: bool


def sweep(
    column: Column,
    shaken: Sequence[Shaken],
    model: Model,
    grid: np.ndarray,
    campaign: Campaign,
    twin_amplitudes: int | None = None,
) -> tuple[list[CriticalAmplitude], float]:
    """Run a column and its twins under motions at every amplitude of a grid; what came of each, and the time it took [s].

    Parameters
    ----------
    column, model
    shaken : sequence of Shaken
    grid : array
        Amplitudes [m/s²], rising.
    campaign : Campaign
    twin_amplitudes : int, optional
        As for :func:`critical_amplitude`.
    """
    drawn = the_twins(column, model, campaign) if campaign.replicates else None
    for motion, as_is, _ in shaken:
        if as_is == 0.0:
            raise InputError(f"motion {motion.name!r} is zero along x and cannot be scaled to an amplitude.")
    twins = () if drawn is None else drawn.columns
    spread = grid[np.unique(np.linspace(0, len(grid) - 1, twin_amplitudes or len(grid)).round().astype(int))]
    own = [_with_own(grid, one) for one in shaken]
    theirs = [_with_own(spread, one) for one in shaken]
    counts = np.array([len(a) + len(twins) * len(b) for a, b in zip(own, theirs, strict=True)])
    ends = np.cumsum(counts)

    def case(number: int) -> Case:
        which = int(np.searchsorted(ends, number, side="right"))
        place = number - int(ends[which] - counts[which])
        stands, amplitudes = column, own[which]
        if place >= len(amplitudes):
            twin, place = divmod(place - len(amplitudes), len(theirs[which]))
            stands, amplitudes = twins[twin], theirs[which]
        motion, as_is, recorded = shaken[which]
        size = float(amplitudes[place])
        return Case(stands, motion.scaled_to_pga(size) if recorded else motion.scaled(size / as_is))

    cases = Cases(int(ends[-1]), case)
    if drawn is not None:
        model = engine_for(model, column).paced
    started = time.perf_counter()
    request = Request.of(cases, Hasher(model, campaign.options), campaign.quiet)
    finished = run_all(request, campaign)
    results, doubt, cure = [], caveat([column], model), to_decide(column, model.parameters(), campaign.tail)
    for one, amplitudes, spread, count, end in zip(shaken, own, theirs, counts, ends, strict=True):
        rows, record = finished[int(end - count) : int(end)], one.as_is if one.recorded else None
        known = rows[: len(amplitudes)], rows[len(amplitudes) :]
        population = None if drawn is None else CriticalPopulation.of(spread, known[1], drawn, record)
        told = known[0], 0.0, record, population, doubt, cure
        results.append(CriticalAmplitude(column, one.motion, model.name, amplitudes, *told))
    return results, time.perf_counter() - started


def _with_own(grid: np.ndarray, shaken: Shaken) -> np.ndarray:
    """The grid with the amplitude that a record has as it is, unless that is beyond the grid's end."""
    return np.union1d(grid, [shaken.as_is]) if shaken.recorded and shaken.as_is <= grid[-1] else grid


def amplitude_grid(start: float, stop: float, step: float) -> np.ndarray:
    """Amplitudes from ``start`` to ``stop`` in steps [m/s²]; the last one is the last step not beyond ``stop``."""
    low, high, width = (float(value) for value in (start, stop, step))
    least = "it must not be below the smallest"
    check_range("the smallest amplitude", low / g, 0.0, 1e3, unit="g", open_low=True, field="start")
    check_range("the largest amplitude", high / g, low / g, 1e3, unit="g", remedy=least, field="stop")
    check_range("the amplitude step", width / g, 0.0, 1e3, unit="g", open_low=True, field="step")
    steps = int((high - low) / width * (1.0 + 1e-12) + 1e-9)
    if steps >= MAX_AMPLITUDES:
        raise InputError(
            f"the grid of amplitudes has {steps + 1} steps; allowed is up to {MAX_AMPLITUDES}: give a larger step.",
            "step",
        )
    return low + width * np.arange(steps + 1)


def _in_g(value: float | None) -> float | None:
    return None if value is None else value / g
