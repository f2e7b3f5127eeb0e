"""The critical amplitude under each record of a suite: one grid of amplitudes for all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.runner import Progress, Stopped, run_campaign
from ..column import Column
from ..constants import g
from ..errors import InputError
from ..models.base import Case, Cases, Model
from ..models.shared.quiet import share_of
from ..motion import Motion
from . import verdicts as v
from .critical import CriticalAmplitude, amplitude_grid

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
            "amplitudes_g": (self.amplitudes / g).tolist(),
            "share_collapsed": self.share_collapsed.tolist(),
            "records": [_row(one) for one in self.results],
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
    start, stop, step, tail, whole, threads, progress, ledger
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
    count = len(amplitudes)
    cases = Cases(
        len(motions) * count, lambda i: Case(column, motions[i // count].scaled_to_pga(float(amplitudes[i % count])))
    )
    key = {
        "column": column.digest,
        "motions": [motion.digest for motion in motions],
        "amplitudes": amplitudes.tolist(),
    }
    quiet = share_of(motions, whole)
    campaign = run_campaign(
        cases, model, tail=tail, quiet=quiet, threads=threads, progress=progress, ledger=ledger, key=key
    )
    if campaign.interrupted:
        raise Stopped(campaign.rows.finished, len(cases), ledger)
    return CriticalSuite(
        tuple(
            CriticalAmplitude(column, motion, model.name, amplitudes, campaign.rows[i * count : (i + 1) * count], 0.0)
            for i, motion in enumerate(motions)
        ),
        campaign.wall_time,
    )


def _row(one: CriticalAmplitude) -> dict[str, Any]:
    critical, above, counts = one.critical, one.all_collapse_above, one.counts
    return {
        "record": one.motion.name,
        "pga_g": one.motion.pga / g,
        "pgv_m_s": one.motion.pgv,
        "critical_g": None if critical is None else critical / g,
        "all_collapse_above_g": None if above is None else above / g,
        **{name: counts[name] for name in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED)},
    }
