"""Incremental dynamic analysis: every record scaled over levels that are hunted and filled, all records at a time."""

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
from ..column.structure import Structure
from ..constants import g
from ..errors import InputError, OutOfRangeWarning, check_all, check_choice, check_kind, check_range, suggest, warn
from ..messages import say
from ..models.base import Case, Model
from ..models.shared.quiet import level
from ..motion import Motion
from ..motion.intensity_specs import IntensityMeasure, measures_by_column, parse_measure, powers_by_column
from ..motion.orientation import record_of
from . import verdicts as v
from .difference import caveat
from .hunt import next_levels
from .ida_curves import Ida
from .record_facts import ABOUT

if TYPE_CHECKING:
    import pandas

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

    Returns
    -------
    Ida

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
    for one in levels or ():
        check_range("one of the levels", one, 0.0, 1e6, open_low=True, field="levels")
    if not motions:
        raise InputError("no record is given; give files or a folder of records.")
    if measure.power == 0:
        raise InputError(f"multiplying a record does not change {measure.name}; scale to another measure, such as pgv.")
    if len({one.name for one in motions}) < len(motions):
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
    facts = [_facts(one, measure, relation, known.get(one.name, known.get(record_of(one), {}))) for one in motions]
    if angle is None:
        facts = [{name: value for name, value in one.items() if name not in RELATIVE} for one in facts]
    measure.warn_of_drift(motions)
    drawn = the_twins(column, model, campaign) if campaign.replicates else None
    columns = [column] if drawn is None else list(drawn.columns)
    traces = []
    for motion, fact in zip(motions, facts):
        value, peak = fact[measure.key], _loudest(model.taken(motion), column)
        start = value * (1.0 / peak) ** measure.power
        traces += [Trace(motion, one, k, value, start, [], []) for k, one in enumerate(columns)]
    stripes = None if levels is None else sorted({float(one) for one in levels})
    if stripes is not None:
        for one in traces:
            _check_factor(one, stripes[-1], measure, largest_factor)
    done, total = 0, (runs if stripes is None else len(stripes)) * len(traces)

    def wanted(one: Trace) -> list[float]:
        if stripes is not None:
            return [] if one.levels else stripes
        return _asked(one, runs, largest_factor, measure.power)

    def made(of: Sequence[Trace]) -> Ida:
        table = _table(of, dict(zip((one.name for one in motions), facts)), column, measure, model, drawn)
        table["hunted"] = stripes is None
        table.attrs["doubt"] = doubt = "" if drawn is not None and drawn.groups else caveat([column], model)
        return Ida(table, measure, column, model.name, time.perf_counter() - started, drawn, doubt)

    def so_far(asked: Sequence[tuple[Trace, float]], rows: Sequence[dict]) -> Ida:
        grown = {id(one): replace(one, levels=[*one.levels], rows=[*one.rows]) for one in traces}
        for (one, new), row in zip(asked, rows):
            if row:
                grown[id(one)].levels.append(new)
                grown[id(one)].rows.append(row)
        return made([*grown.values()])

    hasher = Hasher(model, campaign.options)
    try:
        with closing(Runs(campaign)) as kept:
            while asked := [(trace, new) for trace in traces for new in wanted(trace)]:
                cases = [Case(one.column, _scaled(one, new, measure.power)) for one, new in asked]
                rows: list[dict] = [{}] * len(cases)
                with closing(kept.run(Request.of(cases, hasher, campaign.quiet))) as finished:
                    for number, row in finished:
                        rows[number] = row
                        done += 1
                        if campaign.progress:
                            campaign.progress(done, total)
                        if watch:
                            watch(partial(so_far, asked, rows))
                for (one, new), row in zip(asked, rows):
                    one.levels.append(new)
                    one.rows.append(row)
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


def _asked(trace: Trace, runs: int, largest: float, power: int) -> list[float]:
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
            found: dict[str, Any] = {"verdict": v.verdict(trace.rows[k]), **trace.rows[k]}
            rows.append(
                {
                    **who,
                    "im_name": measure.name,
                    "level": trace.levels[k],
                    "factor": factor,
                    **widths,
                    **scaled,
                    **found,
                }
            )
    return pandas.DataFrame(rows)
