"""Was it worth it? Several states of one column under the same records: fragility, paired differences, what links bore."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.cases import Study
from ..column.links.placed import stone_that_breaks
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..models.base import Model
from ..motion import Motion
from ..motion.intensity_specs import IntensityMeasure
from ..notebook import Shown
from ..response.links import AT_CAPACITY
from ..response.measures import blank_row
from ..response.response import Response
from .difference import NO_MEASURE, Difference, caveat, doubt, reference
from .evidence import Evidence, evidence, intervals, medians_by_law
from .fragility import SAMPLES, fragility
from .fragility_checks import check_bootstrap
from .fragility_curve import Fragility
from .limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN, parse_state
from .lognormal import bootstrap, falls, fit
from .paired import levels_of, median_ends, share_limits, unseen
from .side_by_side import Share, shares
from .studies import StudyResult, histories_of, run_study
from .unknown_law import few_laws, under_another_law

if TYPE_CHECKING:
    import pandas

#: Smallest number of states that can be compared.
FEWEST_STATES = 2


@dataclass(frozen=True, eq=False)
class StateComparison(Shown):
    """Several states of a column, or of an assembly, under the same motions.

    Parameters
    ----------
    labels : tuple of str
        Measures are compared with the column as it stands today, see :func:`~stylobate.analysis.difference.reference`.
    columns : tuple of Column, or of assemblies
    result : StudyResult
        All runs.
    table : pandas.DataFrame
        One row per run, ``state`` its label.
    curves : tuple of Fragility or None
        None where every run exceeds the limit state, or none does.
    differences : tuple of Difference
        Of every state after the first, from the one that it is compared with.
    shares : tuple of Share
        Of every state, of the runs that could be computed for all of them.
    state : str
        The limit state.
    study : Study
        Of the runs.
    doubt : str
        What stands before any advice, because of the model; empty where nothing does.
    """

    labels: tuple[str, ...]
    columns: tuple[Structure, ...]
    result: StudyResult
    table: pandas.DataFrame
    curves: tuple[Fragility | None, ...]
    differences: tuple[Difference, ...]
    shares: tuple[Share, ...]
    state: str
    study: Study
    doubt: str = ""

    def response(self, row: int, output_interval: float = 0.01) -> Response:
        """The run of a row of the table once more, with histories that are so far apart [s]."""
        number = int(np.flatnonzero(self.result.rows.made)[row])
        return histories_of(self.study, number, output_interval=output_interval)

    @property
    def links(self) -> pandas.DataFrame:
        """One row per link that acts: state, link, runs, in how many it broke or bore its capacity, force over capacity, and
        whether the link or the stone around it limits that."""
        import pandas

        rows: list[dict[str, Any]] = []
        for label, column in zip(self.labels, self.columns, strict=True):
            mine: Any = self.table[self.table["state"] == label]
            if "link_broken_s" not in mine:
                continue
            links = [link for link in column.placed_links if link.acts]
            told = [(b, u) for b, u in zip(mine["link_broken_s"], mine["link_utilisation"]) if isinstance(b, list)]
            for k, link in enumerate(links):
                broke = [b[k] for b, _ in told if b[k] is not None]
                used = [u[k] for _, u in told]
                rows.append(
                    {
                        "state": label,
                        "link": link.name,
                        "runs": len(told),
                        "broken": len(broke),
                        "largest_over_capacity": max(used, default=math.nan),
                        "median_over_capacity": float(np.median(used)) if used else math.nan,
                        "at_capacity": sum(one >= AT_CAPACITY for one in used),
                        "limited_by": "stone" if link.breaks_stone else "link",
                    }
                )
        return pandas.DataFrame(rows)

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate states``.

        ``share_low`` and ``share_high`` of ``states`` are what undecided runs could make of the share of a state, of which
        ``interval_low`` and ``interval_high`` are the interval over records. In ``differences``, ``share`` is that of a
        state less that of the other, negative where fewer exceed it, and ``share_low`` and ``share_high`` are its interval
        over records; what undecided runs could make of it are ``share_best`` and ``share_worst``.
        """
        links: Any = self.links
        table: Any = self.table
        return {
            "state": self.state,
            "doubt": self.doubt,
            "records": int(table["record"].nunique()),
            "states": [
                {
                    "label": label,
                    "column": column.name,
                    "runs": int((table["state"] == label).sum()),
                    "collapsed": int(table.loc[table["state"] == label, "collapsed"].fillna(0).sum()),
                    **share.counts,
                    "fragility": None if curve is None else curve.summary(),
                    "links_broken": int(links.loc[links["state"] == label, "broken"].sum()) if len(links) else 0,
                }
                for label, column, curve, share in zip(self.labels, self.columns, self.curves, self.shares, strict=True)
            ],
            "differences": [
                dataclasses.asdict(difference)
                | {key: getattr(difference, key) for key in ("conclusion", "advice", "basis", "sentence")}
                for difference in self.differences
            ],
            "links": links.astype(object).where(links.notna(), None).to_dict("records"),
        }


def compare_states(
    states: Mapping[str, Structure],
    motions: Sequence[Motion],
    model: Model,
    levels: Sequence[float] = (1.0,),
    im: IntensityMeasure | str | None = None,
    *,
    state: str = "collapse",
    samples: int = SAMPLES,
    confidence: float = 0.95,
    out: str | Path | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> StateComparison:
    """Shake several states of a column with the same motions at the same levels, and compare what becomes of them.

    Parameters
    ----------
    states : mapping of str to Column, or to an assembly
        By label. A measure is compared with the last of "as built" and "as found" that is given, the column as it stands
        today; where neither is, and for these two, it is the first state that the others are compared with.
    motions : sequence of Motion
        At least ten records for curves; fewer give shares only.
    model : Model
    levels : sequence of float
        Of the intensity measure, in its unit (pga and sa in g, pgv in m/s), or factors without one.
    im : IntensityMeasure or str, optional
        That motions are scaled to, such as ``pga`` or ``sa:1.0s``.
    state : str
        Limit state, as of ``stylobate fragility``.
    samples, confidence
        Of the bootstrap over records. All states take the same samples of the records, so that differences are paired.
    out : path, optional
        Folder that keeps the runs.
    campaign, **settings : Campaign, optional
        With replicates, twins of every state are run instead of it; the same seed draws the same deviations for each: of a
        column drum by drum, of an assembly in space stone by stone, by their names.

    Raises
    ------
    InputError
        Fewer than two states, or input that the model refuses.
    """
    campaign = Campaign.of("compare_states", campaign, settings, ("ledger",))
    check_bootstrap(samples, campaign.seed, confidence)
    check_kind("states", states, Mapping, allowed="a mapping of columns by their labels, such as {'as built': column}")
    states = {label: states[label] for label in NO_MEASURE if label in states} | dict(states)
    labels = tuple(states)
    for label, column in states.items():
        check_kind(f"the state {label!r}", column, Structure)
    if len(labels) < FEWEST_STATES:
        raise InputError(f"{len(labels)} state of a column is given; give at least {FEWEST_STATES} to compare.")
    named = tuple(column.renamed(label) for label, column in states.items())
    study = Study(named, motions, [model], levels, im, campaign=campaign.of_runs)
    parse_state(state).check_known(_blank(named, model), named)
    result, seed = run_study(study, out, campaign=campaign.of_computing), campaign.seed
    table = result.table.rename(columns={"column": "state"})
    table["state"] = np.repeat(labels, len(table) // len(labels))
    parts: list[Any] = [table[table["state"] == label] for label in labels]
    before = caveat(named, *study.of_one_law)
    told = [evidence(part, study.im, state, label, doubt=before) for part, label in zip(parts, labels, strict=True)]
    curves = tuple(_curve(one, samples, seed, confidence) for one in told)
    compared = {label: labels.index(reference(labels, label)) for label in labels[1:]}
    weak = [stone_that_breaks(column.placed_links) for column in named[1:]]
    differences = tuple(
        dataclasses.replace(with_undecided(told[at], one, curves[at], curve, samples, seed, confidence), stone=words)
        for at, one, curve, words in zip(compared.values(), told[1:], curves[1:], weak, strict=True)
    )
    side_by_side = tuple(shares({one.name: one.codes for one in told}, told[0].records, told[0].laws))
    before = doubt(labels, named, model) if study.of_one_law else ""
    if told[0].laws is not None and (few := few_laws(len(np.unique(told[0].laws)))):
        before = f"{before} {few[:1].upper()}{few[1:]}.".lstrip()
    return StateComparison(labels, named, result, table, curves, differences, side_by_side, state, study, before)


def _blank(states: Sequence[Structure], model: Model) -> dict:
    """Names of what runs of these states measure."""
    linked, blocks = any(one.links for one in states), states[0].base_width is None
    return blank_row(space="y" in model.axes, links=linked, blocks=blocks)


def _curve(one: Evidence, samples: int, seed: int, confidence: float) -> Fragility | None:
    try:
        return fragility(one, samples=samples, seed=seed, confidence=confidence)
    except InputError:  # too few records, or all runs say the same: shares are told without a curve
        return None


def with_undecided(
    first: Evidence,
    other: Evidence,
    first_curve: Fragility | None,
    other_curve: Fragility | None,
    samples: int,
    seed: int,
    confidence: float,
) -> Difference:
    """The difference; its intervals hold what the undecided could make of it, for the other state and against it."""
    rest = first_curve, other_curve, samples, seed, confidence
    known = _difference(first, other, *rest)
    computed = (first.codes != FAILED) & (other.codes != FAILED)
    open_ = computed & ((first.codes == OPEN) | (other.codes == OPEN))
    best = worst = known
    if open_.any():
        best, worst = (
            _difference(_ended(first, against), _ended(other, for_it), *rest)
            for against, for_it in ((EXCEEDED, NOT_EXCEEDED), (NOT_EXCEEDED, EXCEEDED))
        )
    no_ratio = math.isnan(known.ratio)
    lacking = (one.unsupported for one in (first_curve, other_curve) if one is not None)
    return dataclasses.replace(
        known,
        share_low=best.share_low,
        share_high=worst.share_high,
        ratio_low=math.nan if no_ratio else _known(worst.ratio_low, 0.0),
        ratio_high=math.nan if no_ratio else _known(best.ratio_high, math.inf),
        undecided=int(open_.sum()),
        failed=int((~computed).sum()),
        records=len(np.unique(first.records[computed])),
        share_best=best.share,
        share_worst=worst.share,
        ratio_best=math.nan if no_ratio else _known(best.ratio, math.inf),
        ratio_worst=math.nan if no_ratio else _known(worst.ratio, 0.0),
        limit_state=first.state,
        im="" if first.measure in ("im", "factor") else first.measure,
        confidence=confidence,
        lacking=next(filter(None, lacking), ""),
    )


def _ended(one: Evidence, code: int) -> Evidence:
    """The same runs, as if every undecided one had come to an end."""
    return dataclasses.replace(one, codes=np.where(one.codes == OPEN, code, one.codes))


def _known(value: float, otherwise: float) -> float:
    """A limit, or the end of all that can be where there is none."""
    return otherwise if math.isnan(value) else value


def _difference(
    first: Evidence,
    other: Evidence,
    first_curve: Fragility | None,
    other_curve: Fragility | None,
    samples: int,
    seed: int,
    confidence: float,
) -> Difference:
    """Pair by pair: the runs of both states come in the same order of record, level and twin."""
    known = (first.codes >= 0) & (other.codes >= 0)
    was, now = first.codes[known] == EXCEEDED, other.codes[known] == EXCEEDED
    names, owner = np.unique(first.records, return_inverse=True)
    change, mine = now.astype(float) - was, owner[known]
    share, low, high = math.nan, math.nan, math.nan
    if len(change):
        share = float(change.mean())
        weight = np.random.default_rng(seed).multinomial(len(names), np.full(len(names), 1.0 / len(names)), samples)
        sums, runs = np.bincount(mine, change, len(names)), np.bincount(mine, minlength=len(names))
        drawn = (weight @ sums) / np.maximum(weight @ runs, 1)
        if first.laws is not None:
            mean = [change[first.laws[known] == one].mean() for one in np.unique(first.laws[known])]
            drawn = drawn + under_another_law(np.array(mean), samples, np.random.default_rng(seed))
        paired, (levels, _) = runs > 0, levels_of(first.records[known], first.im[known])
        low, high = share_limits(sums[paired], runs[paired], levels, np.clip(drawn, -1.0, 1.0), confidence)
    ratio = (math.nan, math.nan, math.nan)
    if first_curve is not None and other_curve is not None and not (first_curve.unsupported or other_curve.unsupported):
        ratio = _ratio((first, other), (first_curve, other_curve), samples, seed)
    return Difference(
        other.name, first.name, int(known.sum()), int((was & ~now).sum()), int((now & ~was).sum()), share, low,
        high, *ratio,
    )  # fmt: skip


def _ratio(
    both: tuple[Evidence, Evidence], curves: tuple[Fragility, Fragility], samples: int, seed: int
) -> tuple[float, float, float]:
    """Ratio of the medians and its interval: both curves fitted to the runs that both states know, and to the same samples
    of their records. NaN where these runs alone make no curve.

    Its limits are at least as far off as the levels leave both medians open, and as records that nobody saw may move them.
    """
    known = (both[0].codes >= 0) & (both[1].codes >= 0)
    best, drawn, ends, by_law = [], [], [], []
    for one, alone in zip(both, curves, strict=True):
        codes = np.where(known, one.codes, OPEN)
        low, high, owner = intervals(one, codes, "runs")
        if not len(low):
            return math.nan, math.nan, math.nan
        curve_of_both = fit(low, high)
        best.append(float(curve_of_both.log_median[0]) if not falls(curve_of_both) else math.nan)
        drawn.append(bootstrap(low, high, owner, samples, np.random.default_rng(seed))[:, 0])
        if one.laws is not None:
            by_law.append(medians_by_law(one, codes, "runs"))
        ends.append(median_ends(*intervals(one, codes, "records")[:2], alone.median_interval))
    if not np.isfinite(best).all():
        return math.nan, math.nan, math.nan
    middle, curve = best[1] - best[0], curves[0]
    with np.errstate(invalid="ignore"):
        change = drawn[1] - drawn[0]
        if by_law:
            away = under_another_law(by_law[1] - by_law[0], samples, np.random.default_rng(seed))
            if not np.isfinite(away).all():  # under some law there is no curve of both
                return math.exp(middle), math.nan, math.nan
            change = change + away
    change = change[np.isfinite(change)]
    records, im = both[0].records[known], both[0].im[known]
    number, step = len(np.unique(records)), levels_of(records, im)[1]
    if len(change) < samples // 2 or math.isnan(step):
        return math.exp(middle), math.nan, math.nan
    slack = unseen(number, curve.confidence) * step
    low, high = curve.basic(middle, change)
    (first_low, first_high), (other_low, other_high) = ends
    low, high = min(low, middle - slack, other_low - first_high), max(high, middle + slack, other_high - first_low)
    with np.errstate(over="ignore"):
        return math.exp(middle), float(np.exp(low)), float(np.exp(high))
