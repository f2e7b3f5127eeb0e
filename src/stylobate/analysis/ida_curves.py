"""Curves of an incremental dynamic analysis: each record's, with its collapse as a plateau, and those of all records."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.twins import Twins
from ..column.structure import Structure
from ..errors import InputError
from ..messages import say
from ..models.base import Model
from ..motion.intensity_specs import IntensityMeasure
from ..notebook import Shown
from ..response.measures import blank_row
from . import verdicts as v
from .capacity import SHARES, Capacity, bounds, of_levels, quantiles
from .directions import peak_of

if TYPE_CHECKING:
    import pandas


def check_response(edp: str, column: Structure, model: Model) -> None:
    """Refuse a measure of the response that runs of this column will not have, before they are made."""
    if column.links:  # what is measured of links has many names
        return
    row = blank_row(space="y" in model.axes, blocks=column.base_width is None)
    numbers = [name for name, value in row.items() if isinstance(value, float)]
    if edp not in numbers:
        raise unknown_response(edp, numbers)


def unknown_response(edp: str, names: Iterable[str]) -> InputError:
    """The sentence that runs have no such measure."""
    known = [name for name in names if name.startswith(("peak_", "residual_"))]
    return InputError(f"the runs have no measure {edp!r}; measures are {', '.join(known)}.")


@dataclass(frozen=True, eq=False)
class Curve:
    """One motion with one column.

    Parameters
    ----------
    record : str
        That the motion is of.
    motion : str
        The record, or one of its components.
    realisation : int
    im, edp : array
        Intensity, rising, and the measure of the response of the runs that stand, shape (k,).
    stands, collapses : float
        The largest intensity up to which every run stands, and that of the first collapse; 0 and +inf where there is
        none. What is undecided or failed between them may be a collapse.
    resurrections : array
        Intensities above the first collapse at which it stands.
    open_runs : int
        Runs that are undecided or failed.
    """

    record: str
    motion: str
    realisation: int
    im: np.ndarray
    edp: np.ndarray
    stands: float
    collapses: float
    resurrections: np.ndarray
    open_runs: int

    def at(self, im: np.ndarray) -> np.ndarray:
        """Response at given intensities: straight between runs, +inf from half way to the first collapse on.

        NaN where it did not collapse and no run stands at an intensity as large: what is undecided or failed tells of no
        response; and below a collapse under which no run stands.
        """
        below = self.im < self.collapses
        x, y = np.concatenate(([0.0], self.im[below])), np.concatenate(([0.0], self.edp[below]))
        found = np.interp(im, x, y) if below.any() else np.full(np.shape(im), np.nan)
        if math.isinf(self.collapses):
            return np.where(im > x[-1], np.nan, found)
        edge = math.sqrt(self.stands * self.collapses) if self.stands else 0.5 * self.collapses
        return np.where(im > edge, np.inf, found)


@dataclass(frozen=True, eq=False)
class Ida(Shown):
    """An incremental dynamic analysis.

    Parameters
    ----------
    runs : pandas.DataFrame
        One row per run: record, motion, realisation, level, factor, verdict, measures of the response and of the scaled
        motion.
    measure : IntensityMeasure
        That the records were scaled to.
    column : Column or Assembly
    model : str
    wall_time : float
        [s]
    twins : Twins, optional
        The columns like this one that were run in its place.
    doubt : str
        What stands before all that rests on these runs, because of the model; empty where nothing does.
    """

    runs: pandas.DataFrame
    measure: IntensityMeasure
    column: Structure
    model: str
    wall_time: float
    twins: Twins | None = None
    doubt: str = ""

    def curves(self, edp: str | None = None) -> list[Curve]:
        """One curve per motion and realisation.

        Parameters
        ----------
        edp : str, optional
            A measure of the response, as a column of the table of runs; the peak displacement by default, of the top or of
            the body of an assembly that goes farthest.
        """
        edp = peak_of(self.runs) if edp is None else edp
        if edp not in self.runs:
            raise unknown_response(edp, self.runs.columns)
        curves = []
        groups: Any = self.runs.groupby(["record", "motion", "realisation"], sort=False)
        for (record, motion, realisation), rows in groups:
            x = rows["level"].to_numpy(dtype=float)
            verdict = rows["verdict"].to_numpy(dtype=object)
            stands, (low, first) = verdict == v.STANDS, of_levels(x, verdict)
            curves.append(
                Curve(
                    str(record),
                    str(motion),
                    int(realisation),
                    x[stands],
                    np.abs(rows[edp].to_numpy(dtype=float)[stands]),
                    low,
                    first,
                    x[stands & (x > first)],
                    int(np.count_nonzero((verdict == v.UNDECIDED) | (verdict == v.FAILED))),
                )
            )
        return curves

    def fractiles(self, edp: str | None = None, points: int = 100) -> pandas.DataFrame:
        """Response that 16, 50 and 84 % of the curves do not exceed, over the intensity.

        A collapse exceeds every response: +inf. A curve counts no further than its runs stand or collapse; where fewer
        than half of all curves are left there is none.
        """
        import pandas

        curves = self.curves(edp)
        im = np.geomspace(self.runs["level"].min(), self.runs["level"].max(), points)
        values = np.array([curve.at(im) for curve in curves])
        table = {"im": im, "curves": np.count_nonzero(~np.isnan(values), axis=0)}
        for share in SHARES:
            column = []
            for row in values.T:
                known = row[~np.isnan(row)]
                enough = 2 * len(known) >= len(curves)
                column.append(float(np.quantile(known, share, method="inverted_cdf")) if enough else math.nan)
            table[f"edp_{100 * share:.0f}"] = np.array(column)
        return pandas.DataFrame(table)

    @property
    def capacities(self) -> pandas.DataFrame:
        """One row per curve: between which levels its first collapse lies, and how often it stands again above."""
        import pandas

        runs = self.runs.groupby(["record", "motion", "realisation"], sort=False).size().tolist()
        return pandas.DataFrame(
            [
                {
                    "record": curve.record,
                    "motion": curve.motion,
                    "realisation": curve.realisation,
                    "stands_until": curve.stands,
                    "collapses_from": None if math.isinf(curve.collapses) else curve.collapses,
                    "resurrections": len(curve.resurrections),
                    "runs": count,
                    "open": curve.open_runs,
                }
                for curve, count in zip(self.curves(), runs)
            ]
        )

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate ida``."""
        table: Any = self.capacities
        runs: Any = self.runs
        counts = v.count(self.runs["verdict"].to_numpy(dtype=object))
        capacities = table.astype(object).where(table.notna(), None).to_dict("records")
        found = zip(SHARES, quantiles(map(_capacity, capacities)), strict=True)
        shares = {f"capacity_{100 * share:.0f}": one for share, one in found}
        return {
            "im": self.measure.name,
            "unit": self.measure.unit,
            "records": int(runs["record"].nunique()),
            "curves": len(table),
            "runs": len(self.runs),
            **{one: counts[one] for one in v.MADE},
            "resurrections": int(table["resurrections"].sum()),
            "curves_with_resurrections": int((table["resurrections"] > 0).sum()),
            **{name: one.high for name, one in shares.items()},
            "bounds": bounds({name: (one, 1.0) for name, one in shares.items()}),
            "largest_factor": float(runs["factor"].max()),
            "capacities": capacities,
            "wall_s": self.wall_time,
            "model": self.model,
            "doubt": self.doubt,
            **({} if self.twins is None else {"replicates": len(self.twins.columns), "certainty": self.twins.facts}),
        }


def _capacity(row: Mapping[str, Any]) -> Capacity:
    high = row["collapses_from"]
    return Capacity(float(row["stands_until"]), math.inf if high is None else float(high))


def median_of(summary: Mapping[str, Any]) -> str:
    """Between which levels half of the curves have collapsed, in words; from the JSON object of ``stylobate ida``.

    It is counted, without a curve. The median of a fragility is that of the lognormal curve that fits all capacities best.
    """
    (half,) = quantiles(map(_capacity, summary["capacities"]), (0.5,))
    unit = "" if summary.get("unit") in (None, "-") else f" {summary['unit']}"
    known = {"im": say(str(summary.get("im"))), "low": half.low, "high": half.high, "unit": unit}
    bound = half.bound()
    if bound is None:
        return say("half of the curves have collapsed between {im} = {low:.3g} and {high:.3g}{unit}", **known)
    if half.low > 0.0:
        fewer = say("fewer than half of the curves collapse up to {im} = {low:.3g}{unit}, and the median lies above")
        return fewer.of(**known)
    if bound.startswith("≤"):
        below = say("half of the curves have collapsed at {im} = {high:.3g}{unit}, or below: no lower level was stood")
        return below.of(**known)
    return say("no level tells where half of the curves have collapsed")
