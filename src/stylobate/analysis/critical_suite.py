"""The critical amplitude under each record of a suite: one grid of amplitudes for all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..column import Column
from ..constants import g
from ..errors import InputError
from ..models.base import Model
from ..motion import Motion
from ..motion.orientation import record_of
from ..notebook import Shown
from . import verdicts as v
from .critical import CriticalAmplitude, Shaken, amplitude_grid, sweep
from .critical_words import sentence_of_suite
from .directions import Compass, bearing, direction_of

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class CriticalSuite(Shown):
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
        """Peak accelerations along x of every record [m/s²], shape (A,): the grid."""
        common = self.results[0].amplitudes
        for result in self.results[1:]:
            common = np.intersect1d(common, result.amplitudes)
        return common

    @property
    def verdicts(self) -> np.ndarray:
        """Verdicts by record on that grid, shape (records, A)."""
        return np.array(
            [np.array(result.verdicts)[np.isin(result.amplitudes, self.amplitudes)] for result in self.results],
            dtype=object,
        )

    @property
    def critical(self) -> float | None:
        """Smallest amplitude at which some record collapses the column [m/s²]; None when none does."""
        return min((result.critical for result in self.results if result.critical is not None), default=None)

    @property
    def critical_factor(self) -> float | None:
        """Smallest factor by which some motion collapses the column [-]; None when none does."""
        return min(
            (result.critical_factor for result in self.results if result.critical_factor is not None), default=None
        )

    @property
    def worst(self) -> CriticalAmplitude | None:
        """The motion that collapses the column, or one of its twins, at the smallest factor; None when none does."""
        fell = [result for result in self.results if result.lowest_factor is not None]
        return min(fell, key=lambda one: one.lowest_factor or math.inf, default=None)

    @property
    def open_below(self) -> int:
        """Number of runs under all motions without a verdict at smaller factors than that; any may be a collapse."""
        factor = math.inf if self.worst is None else self.worst.lowest_factor or math.inf
        return sum(result.without_verdict(factor * (result.nominal or math.inf)) for result in self.results)

    @property
    def compass(self) -> Compass:
        """Factor at which the column, or one of its twins, first collapses, by direction; the smallest of all records."""
        found: dict[float, float] = {}
        for result in self.results:
            at = bearing(direction_of(result.motion))
            if at is not None:
                factor = math.inf if result.lowest_factor is None else result.lowest_factor
                found[at] = min(factor, found.get(at, math.inf))
        bearings = sorted(found)
        like = "" if self.results[0].population is None else " or one like it"
        name = f"lowest factor that collapses it{like} [-]"
        most = None if self.worst is None else bearing(direction_of(self.worst.motion))
        return Compass(np.array(bearings), np.array([found[at] for at in bearings]), name, worst=most)

    @property
    def all_collapse_above(self) -> float | None:
        """Smallest amplitude from which on every record collapses the column [m/s²], or None."""
        found = [result.all_collapse_above for result in self.results]
        return None if None in found else max(one for one in found if one is not None)

    @property
    def share_collapsed(self) -> np.ndarray:
        """Share of the records that collapse the column, NaN where none is decided, shape (A,).

        See :func:`stylobate.analysis.verdicts.share_collapsed`.
        """
        return v.share_collapsed(*v.tally(self.verdicts, axis=0))

    @property
    def table(self) -> pandas.DataFrame:
        """One row per motion: its own peak, the critical amplitude, and how many runs came to which verdict."""
        import pandas

        rows = [_row(result) for result in self.results]
        for row in rows:
            row["bounds"] = "; ".join(f"{name} {one}" for name, one in row["bounds"].items())
        return pandas.DataFrame(rows)

    @property
    def runs(self) -> pandas.DataFrame:
        """One row per motion and amplitude, as the table of :class:`CriticalAmplitude`, with ``record`` and ``motion``."""
        import pandas

        return pandas.DataFrame(
            [
                {**_named(result), "amplitude_g": a / g, "verdict": verdict, **row}
                for result in self.results
                for a, verdict, row in zip(result.amplitudes, result.verdicts, result.rows)
            ]
        )

    def summary(self) -> dict:
        """The JSON object of ``stylobate critical`` for a folder of records."""
        counts = v.count([verdict for result in self.results for verdict in result.verdicts])
        twins = [result.population.verdicts.ravel() for result in self.results if result.population is not None]
        critical, above, worst = (
            self.critical,
            self.all_collapse_above,
            None if self.worst is None else _row(self.worst),
        )
        lowest = min((result.lowest for result in self.results if result.lowest is not None), default=None)
        found = {
            "critical_g": None if critical is None else critical / g,
            "first_collapse_g": None if critical is None else critical / g,
            "all_collapse_above_g": None if above is None else above / g,
            "runs": sum(len(result.rows) for result in self.results),
            **{one: counts[one] for one in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
            "critical_factor": self.critical_factor,
            "lowest_collapse_g": None if lowest is None else lowest / g,
            "lowest_collapse_factor": None if worst is None else worst["lowest_collapse_factor"],
            "open_below": self.open_below,
            "certainty": v.count(np.concatenate(twins)) if twins else None,
            "amplitudes_g": (self.amplitudes / g).tolist(),
            "share_collapsed": self.share_collapsed.tolist(),
            "records": [_row(result) for result in self.results],
            "worst": worst,
            "wall_s": self.wall_time,
            "model": self.results[0].model,
            "doubt": self.results[0].doubt,
            "to_decide": self.results[0].cure if any(result.undecided for result in self.results) else "",
        }
        stands = self.results[0].column
        return found | {"sentence": sentence_of_suite(found, stands.kind, stands.like)}


def critical_suite(
    column: Column,
    motions: Sequence[Motion],
    model: Model,
    start: float,
    stop: float,
    step: float = 0.005 * g,
    *,
    campaign: Campaign | None = None,
    **settings: Any,
) -> CriticalSuite:
    """Run a column under every record at every amplitude of a grid.

    Parameters
    ----------
    column : Column
    motions : sequence of Motion
        Each is scaled, all its components alike, so that its peak along x takes the amplitudes of the grid.
    model : Model
    start, stop, step
        As for :func:`stylobate.analysis.critical.critical_amplitude`.
    campaign, **settings : Campaign, optional
        As there.

    Returns
    -------
    CriticalSuite

    Raises
    ------
    InputError
        No motion, one that is zero along x, an impossible grid, or input that the model refuses.
    """
    campaign = Campaign.of("critical_suite", campaign, settings)
    if not motions:
        raise InputError("the suite holds no motion; give at least one.")
    grid = amplitude_grid(start, stop, step)
    shaken = [Shaken(motion, motion.pga, recorded=True) for motion in motions]
    results, wall = sweep(column, shaken, model, grid, campaign)
    return CriticalSuite(tuple(results), wall)


def _named(amplitude: CriticalAmplitude) -> dict[str, str]:
    """The record, the same for all its directions and signs, and the motion that is made of it."""
    return {"record": record_of(amplitude.motion), "motion": amplitude.motion.name}


def _row(amplitude: CriticalAmplitude) -> dict[str, Any]:
    critical, above, counts = amplitude.critical, amplitude.all_collapse_above, amplitude.counts
    return {
        **_named(amplitude),
        "pga_g": amplitude.motion.pga / g,
        "pgv_m_s": amplitude.motion.pgv,
        "critical_g": None if critical is None else critical / g,
        "critical_factor": amplitude.critical_factor,
        "all_collapse_above_g": None if above is None else above / g,
        "as_recorded": (amplitude.as_recorded or {}).get("verdict"),
        **direction_of(amplitude.motion),
        **{name: counts[name] for name in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
        **({} if amplitude.population is None else amplitude.population.percentiles),
        "lowest_collapse_g": None if amplitude.lowest is None else amplitude.lowest / g,
        "lowest_collapse_factor": amplitude.lowest_factor,
        "open_below": amplitude.open_below,
        "bounds": amplitude.bounds | ({} if amplitude.population is None else amplitude.population.bounds),
    }
