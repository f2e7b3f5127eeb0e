"""Which intensity measure tells most: how much the capacities of records scatter given it, and what else matters then."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..motion.intensity_specs import KINDS, IntensityMeasure, parse_measure
from . import lognormal
from . import verdicts as v
from .directions import peak_of
from .evidence import evidence, independent, intervals
from .likelihood_region import dispersions
from .limit_states import LimitState, parse_state

if TYPE_CHECKING:
    import pandas

#: Further properties of a record: column of the table, and whether it counts by its logarithm.
OTHERS = {"magnitude": False, "distance_km": True, "pgv_over_pga_s": True, "d5_95_s": True}

#: Fewest records from which a straight line says something.
FEWEST = 5

#: Logarithms that lie this close together are of one value, through which no line goes [-].
SAME = 1e-9

#: Responses below this share of the largest that stands are no rocking [-].
ROCKS = 0.01


def which_tells_most(
    runs: pandas.DataFrame, state: LimitState | str = "collapse", edp: str | None = None, seed: int = 0
) -> pandas.DataFrame:
    """Prediction of a state by each intensity measure of a table of runs.

    Parameters
    ----------
    runs : pandas.DataFrame
        Of an IDA.
    state : LimitState or str
    edp : str, optional
        Measure of the response; the peak displacement by default.
    seed : int
        Of the bootstrap.

    Returns
    -------
    pandas.DataFrame
        The most efficient measure first: median and dispersion of the capacities in it with 95 % limits, the dispersion of
        ln EDP given it, and p-values of what else may matter; small ones say that the measure alone does not suffice.

    References
    ----------
    Luco and Cornell (2007).
    """
    import pandas

    asked = parse_state(state) if isinstance(state, str) else state
    edp = peak_of(runs) if edp is None else edp
    rows = []
    for measure in _measures(runs):
        told = evidence(runs, measure, asked)
        low, high, owner = intervals(told, told.codes, "records")
        if not len(low):
            continue
        best = lognormal.fit(low, high)
        if math.isinf(best.log_median[0]):
            continue
        samples = np.sort(lognormal.bootstrap(low, high, owner, 500, np.random.default_rng(seed))[:, 1])
        middle = math.log(best.beta[0])
        limits = [math.exp(2.0 * middle - float(np.quantile(samples, q))) for q in (0.975, 0.025)]
        number = len(np.unique(owner))
        plausible = dispersions(low, high, *independent(low, high, owner, "records"))
        limits = [min(limits[0], plausible[0]), max(limits[1], plausible[1])]
        row: dict[str, Any] = {
            "measure": measure.name,
            "unit": measure.unit,
            "median": math.exp(best.log_median[0]),
            # steps of its own levels show no dispersion of the measure that was run, which is not the best for that
            "beta": math.nan if (seen := lognormal.seen(float(best.beta[0]))) is None else seen,
            "beta_low": limits[0],
            "beta_high": limits[1],
            "sigma_ln_edp": _given(runs, measure, edp),
            "records": number,
        }
        both = np.isfinite(low) & np.isfinite(high)
        known, mine = np.unique(owner[both], return_inverse=True)
        capacity = np.bincount(mine, 0.5 * (low + high)[both]) / np.bincount(mine)  # a record counts once
        for other, logarithm in OTHERS.items():
            row[f"p_{other}"] = _p_value(runs, other, logarithm, np.unique(told.records)[known], capacity)
        rows.append(row)
    return pandas.DataFrame(sorted(rows, key=lambda one: (math.isnan(one["beta"]), one["beta"])))


def _measures(runs: pandas.DataFrame) -> list[IntensityMeasure]:
    found = []
    names = [*KINDS, "sa:0.5s", "sa:1s", "sa:2s", "pga@geomean", "pgv@geomean"]
    if "im_name" in runs:
        names.append(str(runs["im_name"].iloc[0]))
    for name in dict.fromkeys(names):
        one = None if name == "sa" else parse_measure(name)
        if (
            one is not None
            and one.power
            and one.key in runs
            and bool(np.isfinite(runs[one.key].to_numpy(dtype=float)).all())
        ):
            found.append(one)
    return list({one.key: one for one in found}.values())


def _given(runs: pandas.DataFrame, measure: IntensityMeasure, edp: str) -> float:
    """Dispersion of ln EDP about a straight line over ln IM, of the runs that stand and rock."""
    stands = (runs["verdict"] == v.STANDS).to_numpy(copy=True)
    y = np.abs(runs[edp].to_numpy(dtype=float))
    stands &= np.isfinite(y) & (y > ROCKS * np.max(y[stands], initial=0.0))
    x = runs[measure.key].to_numpy(dtype=float)
    stands &= x > 0.0
    ln_x, ln_y = np.log(x[stands]), np.log(y[stands])
    if len(ln_x) < FEWEST or np.ptp(ln_x) < SAME:
        return math.nan
    rest = ln_y - np.polyval(np.polyfit(ln_x, ln_y, 1), ln_x)
    return float(np.sqrt((rest**2).sum() / max(1, len(rest) - 2)))


def _p_value(runs: pandas.DataFrame, other: str, logarithm: bool, names: np.ndarray, capacity: np.ndarray) -> float:
    """Of a straight line through ln capacity over another property of the records."""
    from scipy.stats import linregress

    if other not in runs:
        return math.nan
    of_record = dict(zip(runs["record"].astype(str), runs[other].to_numpy(dtype=float)))
    x = np.array([of_record.get(str(name), math.nan) for name in names])
    x = np.log(np.where(x > 0.0, x, math.nan)) if logarithm else x
    known = np.isfinite(x)
    if np.count_nonzero(known) < FEWEST or np.ptp(x[known]) < SAME:
        return math.nan
    line: Any = linregress(x[known], capacity[known])
    return float(line.pvalue)
