"""Incremental dynamic analysis: which levels are run, and which intensity measure tells most."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.cases import RELATIVE
from ..campaign.digests import Hasher
from ..campaign.runs import Request, Runs, Stopped
from ..campaign.twins import Twins, the_twins
from ..codes.records import ABOUT
from ..column.structure import Structure
from ..constants import g
from ..errors import InputError, OutOfRangeWarning, check_all, check_choice, check_kind, check_range, suggest, warn
from ..messages import say
from ..models.base import Case, Model
from ..models.shared.ground import level
from ..motion import Motion
from ..motion.intensity import KINDS, IntensityMeasure, measures_by_column, parse_measure, powers_by_column
from ..motion.orientation import record_of
from ..verdicts import verdict as v
from ..verdicts.directions import peak_of
from ..verdicts.limit_states import LimitState, parse_state
from ..verdicts.verdict import caveat
from . import lognormal
from .evidence import Ida, evidence, independent, intervals
from .lognormal import dispersions

if TYPE_CHECKING:
    import pandas


#: Each level of the hunt is so many times the one before [-].
GROWTH = 2.0

#: Levels that one record asks for at a time.
TOGETHER = 3

#: Levels that are closer than this tell nothing more [-].
CLOSE = 1.04


def next_levels(
    levels: Sequence[float], verdicts: Sequence[str], first: float, largest: float, remaining: int
) -> list[float]:
    """Levels that a record asks for, from what has been found so far.

    First ever larger ones until the column collapses; then those that split the stretch between the largest level that
    it stands, below the first collapse, and that collapse; then the widest stretches, above the first collapse too.

    Parameters
    ----------
    levels : sequence of float
        That have been run, in any order.
    verdicts : sequence of str
        Of each of them.
    first : float
        Where the hunt begins: below it no joint opens.
    largest : float
        No level is larger.
    remaining : int
        Runs that are left for the record.

    Returns
    -------
    list of float
        Empty where nothing is left, or nothing tells anything more.

    References
    ----------
    Vamvatsikos and Cornell (2004).
    """
    count = min(remaining, TOGETHER)
    if count <= 0:
        return []
    first = min(first, largest)
    if not levels:
        return _up(first, largest, count + 1)[: min(remaining, TOGETHER + 1)]
    order = np.argsort(levels)
    at, sorted_verdicts = np.asarray(levels, dtype=float)[order], [verdicts[i] for i in order]
    fell = [x for x, verdict in zip(at, sorted_verdicts) if verdict == v.COLLAPSED]
    if not fell and at[-1] < largest / CLOSE:
        return _up(min(at[-1] * GROWTH, largest), largest, count)
    if fell:
        high = fell[0]
        stood = [x for x, verdict in zip(at, sorted_verdicts) if verdict == v.STANDS and x < high]
        low = stood[-1] if stood else high / GROWTH**2
        if high > CLOSE * low:
            inside = np.geomspace(low, high, count + (2 if stood else 1))
            new = inside[1:-1] if stood else inside[:-1]
            new = [float(x) for x in new if np.abs(np.log(at / x)).min() > 0.5 * math.log(CLOSE)]
            if new:
                return new
    top = min(largest, GROWTH * fell[0]) if fell else largest
    edges = np.unique(np.concatenate(([first], at[at <= top], [top])))
    widest = np.argsort(-np.diff(np.log(edges)), kind="stable")[:count]
    wide = [k for k in widest if edges[k + 1] > CLOSE**2 * edges[k]]
    return sorted(float(math.sqrt(edges[k] * edges[k + 1])) for k in wide)


def _up(first: float, largest: float, count: int) -> list[float]:
    levels = [first]
    while len(levels) < count and levels[-1] < largest / CLOSE:
        levels.append(min(levels[-1] * GROWTH, largest))
    return levels


#: A record that has to be multiplied by more is no longer that of an earthquake: a warning, and the end of the hunt.
WARNED, LARGEST = 10.0, 20.0

#: Peak at which a hunt begins of what nobody knows the opening of [m/s²].
GENTLE = 0.1 * g

#: Runs of a record.
RUNS = 14


@dataclass
class Trace:
    """Runs of one record with one column."""

    motion: Motion
    column: Structure
    number: int
    value: float
    first: float
    levels: list[float]
    rows: list[dict]


def ida(
    column: Structure,
    motions: Sequence[Motion],
    model: Model,
    im: IntensityMeasure | str = "pgv",
    *,
    levels: Sequence[float] | np.ndarray | None = None,
    runs: int = RUNS,
    largest_factor: float = LARGEST,
    about: Mapping[str, Mapping[str, float]] | None = None,
    watch: Callable[[Callable[[], Ida]], object] | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> Ida:
    """Scale every record over levels of an intensity, and run the column.

    Parameters
    ----------
    column : Column or Assembly
    motions : sequence of Motion
    model : Model
    im : IntensityMeasure or str
        That the records are scaled to, such as ``pgv`` or ``sa:1.0s``.
    levels : sequence of float, optional
        Stripes: every record is run at each of these, in the unit of the measure (pga and sa in g, pgv in m/s), and
        nothing is hunted.
    runs : int
        Of each record, with each column.
    largest_factor : float
        By which a record is multiplied at most [-]; larger levels are not hunted, and refused where they are given.
    about : mapping, optional
        By name of a record, or of a motion that is made of one, ``magnitude`` and ``distance_km``.
    watch : callable, optional
        Called after each run with a function that makes the analysis of the runs that are finished.
    campaign, **settings : Campaign, optional
        With replicates, these are run instead of the column itself; ``progress`` is called with (finished, most that there
        will be).

    Raises
    ------
    InputError
        No record, an intensity that scaling does not change, or one that a record does not have.
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    campaign = Campaign.of("ida", campaign, settings)
    started = time.perf_counter()
    check_kind("column", column, Structure)
    motions = check_all("motions", motions, Motion)
    check_kind("model", model, Model)
    check_kind("im", im, (str, IntensityMeasure))
    check_kind("about", about, Mapping, allowed="a mapping by name of a record", optional=True)
    levels = None if levels is None else check_all("levels", levels, Real)
    measure = parse_measure(im) if isinstance(im, str) else im
    check_range("runs", runs, 4, 1000)
    check_range("`largest_factor`", largest_factor, 0.0, 1e4, open_low=True)
    if levels is not None and not len(levels):
        raise InputError("levels is an empty list; give at least one positive level.", "levels")
    for stripe in levels or ():
        check_range("one of the levels", stripe, 0.0, 1e6, open_low=True, field="levels")
    if not motions:
        raise InputError("no record is given; give files or a folder of records.")
    if measure.power == 0:
        raise InputError(f"multiplying a record does not change {measure.name}; scale to another measure, such as pgv.")
    if len({motion.name for motion in motions}) < len(motions):
        raise InputError("two records have the same name; rename one of the files.")
    for motion in motions:
        if motion.pga == 0.0:
            raise InputError(
                f"{motion.name!r} is zero along x and cannot be scaled; leave a record without shaking out."
            )
    angle = column.slenderness  # an assembly has none, and no measure that is related to it
    relation = (1.0 if angle is None else math.tan(angle), column.frequency_parameter)
    known = _about(about or {}, motions)
    if angle is None and measure.key in RELATIVE:
        raise InputError(
            f"{measure.name} relates a record to the slenderness of a column, and {column.name!r} is {column.described}; "
            "scale to another measure, such as pgv."
        )
    facts = [
        _facts(motion, measure, relation, known.get(motion.name, known.get(record_of(motion), {})))
        for motion in motions
    ]
    if angle is None:
        facts = [{name: value for name, value in fact.items() if name not in RELATIVE} for fact in facts]
    measure.warn_of_drift(motions)
    drawn = the_twins(column, model, campaign) if campaign.replicates else None
    columns = [column] if drawn is None else list(drawn.columns)
    traces = []
    for motion, fact in zip(motions, facts):
        value, peak = fact[measure.key], _loudest(model.taken(motion), column)
        start = value * (1.0 / peak) ** measure.power
        traces += [Trace(motion, structure, k, value, start, [], []) for k, structure in enumerate(columns)]
    stripes = None if levels is None else sorted({float(stripe) for stripe in levels})
    if stripes is not None:
        for trace in traces:
            _check_factor(trace, stripes[-1], measure, largest_factor)
    done, total = 0, (runs if stripes is None else len(stripes)) * len(traces)

    def wanted(trace: Trace) -> list[float]:
        if stripes is not None:
            return [] if trace.levels else stripes
        return _next_levels(trace, runs, largest_factor, measure.power)

    def made(of: Sequence[Trace]) -> Ida:
        table = _table(of, dict(zip((motion.name for motion in motions), facts)), column, measure, model, drawn)
        table["hunted"] = stripes is None
        table.attrs["doubt"] = doubt = "" if drawn is not None and drawn.groups else caveat([column], model)
        return Ida(table, measure, column, model.name, time.perf_counter() - started, drawn, doubt)

    def so_far(requests: Sequence[tuple[Trace, float]], rows: Sequence[dict]) -> Ida:
        grown = {id(trace): replace(trace, levels=[*trace.levels], rows=[*trace.rows]) for trace in traces}
        for (trace, new), row in zip(requests, rows):
            if row:
                grown[id(trace)].levels.append(new)
                grown[id(trace)].rows.append(row)
        return made([*grown.values()])

    hasher = Hasher(model, campaign.options)
    try:
        with closing(Runs(campaign)) as kept:
            while requests := [(trace, new) for trace in traces for new in wanted(trace)]:
                cases = [Case(trace.column, _scaled(trace, new, measure.power)) for trace, new in requests]
                rows: list[dict] = [{}] * len(cases)
                with closing(kept.run(Request.of(cases, hasher, campaign.quiet))) as finished:
                    for number, row in finished:
                        rows[number] = row
                        done += 1
                        if campaign.progress:
                            campaign.progress(done, total)
                        if watch:
                            watch(partial(so_far, requests, rows))
                for (trace, new), row in zip(requests, rows):
                    trace.levels.append(new)
                    trace.rows.append(row)
    except KeyboardInterrupt:
        raise Stopped(done, total, campaign.ledger) from None
    _warn_of_factors(traces, measure.power)
    return made(traces)


def _loudest(motion: Motion, column: Structure) -> float:
    """Largest share of what opens a joint that a motion reaches; of an assembly, of :data:`GENTLE` [-]."""
    if column.moving_acceleration is not None:
        return float(level(motion, column).max())
    return float(np.hypot(motion.samples, 0.0 if motion.y_samples is None else motion.y_samples).max()) * abs(
        motion.factor / GENTLE
    )


def _next_levels(trace: Trace, runs: int, largest: float, power: int) -> list[float]:
    verdicts = [v.verdict(row) for row in trace.rows]
    return next_levels(trace.levels, verdicts, trace.first, trace.value * largest**power, runs - len(trace.levels))


def _check_factor(trace: Trace, level: float, measure: IntensityMeasure, largest: float) -> None:
    """Refuse a level to which a record would have to be multiplied by more than is allowed."""
    times = (level / trace.value) ** (1.0 / measure.power)
    if times > largest * (1.0 + 1e-9):
        unit = "" if measure.unit == "-" else f" {measure.unit}"
        raise InputError(
            f"the level {measure.name} = {level:g}{unit} multiplies {trace.motion.name!r}, of {trace.value:.3g}{unit}, by "
            f"{times:.4g}; allowed is up to {largest:g} (`largest_factor`): give smaller levels, or leave the record out.",
            "levels",
        )


def _scaled(trace: Trace, level: float, power: int) -> Motion:
    return trace.motion.scaled((level / trace.value) ** (1.0 / power))


def _about(about: Mapping[str, Mapping[str, float]], motions: Sequence[Motion]) -> Mapping[str, Mapping[str, float]]:
    """Facts about records, refused where they are of none of these, or are called otherwise."""
    names = list(dict.fromkeys(name for motion in motions for name in (motion.name, record_of(motion))))
    for name, facts in about.items():
        if name not in names:
            raise InputError(
                f"`about` names {name!r}, which is no record here; {suggest(str(name), names)}records are "
                f"{', '.join(names[:4])}{' …' if names[4:] else ''}: leave out what is about others.",
                "about",
            )
        for fact, value in check_kind(f"{name!r} of about", facts, Mapping).items():
            check_choice(f"a fact about {name!r}", fact, ABOUT, field="about")
            check_kind(f"{fact} of {name!r}", value, Real)
    return about


def _facts(
    motion: Motion, measure: IntensityMeasure, relation: tuple[float, float], about: Mapping[str, float]
) -> dict[str, float]:
    return measures_by_column(motion, [relation])[0] | {measure.key: measure.of(motion, relation)} | dict(about)


def _warn_of_factors(traces: Sequence[Trace], power: int) -> None:
    factors = {trace.motion.name: (max(trace.levels) / trace.value) ** (1.0 / power) for trace in traces}
    beyond = {name: factor for name, factor in factors.items() if factor > WARNED}
    if beyond:
        name = max(beyond, key=beyond.__getitem__)
        words = say(
            "{count} of {all} records are multiplied by more than {most:g}, {name!r} by {factor:.3g}: scaled "
            "so far, they are no longer those of earthquakes; leave out the weak ones."
        )
        known = {"count": len(beyond), "all": len(factors), "most": WARNED, "name": name, "factor": beyond[name]}
        warn(words.of(**known), OutOfRangeWarning)


def _table(
    traces: Sequence[Trace],
    facts: Mapping[str, Mapping[str, float]],
    column: Structure,
    measure: IntensityMeasure,
    model: Model,
    drawn: Twins | None,
) -> pandas.DataFrame:
    import pandas

    powers = powers_by_column() | {measure.key: measure.power}
    rows = []
    for trace in traces:
        fact = facts[trace.motion.name]
        for k in np.argsort(trace.levels, kind="stable"):
            factor = (trace.levels[k] / trace.value) ** (1.0 / measure.power)
            scaled = {key: value * factor ** powers.get(key, 0) for key, value in fact.items()}
            who = {"record": record_of(trace.motion), "motion": trace.motion.name, "realisation": trace.number}
            who |= {"column": column.name, "model": model.name} | (drawn.law_of(trace.number) if drawn else {})
            widths = column.widths
            outcome: dict[str, Any] = {"verdict": v.verdict(trace.rows[k]), **trace.rows[k]}
            rows.append(
                {
                    **who,
                    "im_name": measure.name,
                    "level": trace.levels[k],
                    "factor": factor,
                    **widths,
                    **scaled,
                    **outcome,
                }
            )
    return pandas.DataFrame(rows)


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

    limit_state = parse_state(state) if isinstance(state, str) else state
    edp = peak_of(runs) if edp is None else edp
    rows = []
    for measure in _measures(runs):
        state_evidence = evidence(runs, measure, limit_state)
        low, high, owner = intervals(state_evidence, state_evidence.codes, "records")
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
            "beta": math.nan if (seen := lognormal.resolved_beta(float(best.beta[0]))) is None else seen,
            "beta_low": limits[0],
            "beta_high": limits[1],
            "sigma_ln_edp": _dispersion(runs, measure, edp),
            "records": number,
        }
        both = np.isfinite(low) & np.isfinite(high)
        known, mine = np.unique(owner[both], return_inverse=True)
        capacity = np.bincount(mine, 0.5 * (low + high)[both]) / np.bincount(mine)  # a record counts once
        for other, logarithm in OTHERS.items():
            row[f"p_{other}"] = _p_value(runs, other, logarithm, np.unique(state_evidence.records)[known], capacity)
        rows.append(row)
    return pandas.DataFrame(sorted(rows, key=lambda row: (math.isnan(row["beta"]), row["beta"])))


def _measures(runs: pandas.DataFrame) -> list[IntensityMeasure]:
    measures = []
    names = [*KINDS, "sa:0.5s", "sa:1s", "sa:2s", "pga@geomean", "pgv@geomean"]
    if "im_name" in runs:
        names.append(str(runs["im_name"].iloc[0]))
    for name in dict.fromkeys(names):
        measure = None if name == "sa" else parse_measure(name)
        if (
            measure is not None
            and measure.power
            and measure.key in runs
            and bool(np.isfinite(runs[measure.key].to_numpy(dtype=float)).all())
        ):
            measures.append(measure)
    return list({measure.key: measure for measure in measures}.values())


def _dispersion(runs: pandas.DataFrame, measure: IntensityMeasure, edp: str) -> float:
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
