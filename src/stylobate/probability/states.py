"""States of a column side by side under the same records: fragility, paired differences, advice, what links bore."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.campaign import Campaign
from ..campaign.cases import Study
from ..column.links.placed import stone_that_breaks
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..messages import joined, say, whole_percent
from ..models.base import Model
from ..motion import Motion
from ..motion.intensity import IntensityMeasure
from ..notebook import NotebookSummary
from ..response.links import AT_CAPACITY
from ..response.measures import blank_row
from ..response.response import Response
from ..response.words import ROUND_IN_THE_PLANE, to_decide
from ..verdicts.limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN, Share, parse_state, shares
from ..verdicts.verdict import caveat, few_laws, under_another_law
from .evidence import DIGITS, Evidence, evidence, intervals, medians_by_law
from .fragility import FEWEST, SAMPLES, Fragility, check_bootstrap, fragility
from .lognormal import bootstrap, falls, fit
from .studies import StudyResult, histories_of, run_study

if TYPE_CHECKING:
    import pandas


#: Kinds of difference.
STRONGER, WEAKER, INCONCLUSIVE = "stronger", "weaker", "not told"

#: Sentence where there is nothing to compare.
NO_PAIR = say("no pair of runs could be computed")

#: States that are no measure: nobody can adopt them.
NO_MEASURE = ("as built", "as found")


#: What stands before any advice on measures for round columns that were computed in a plane, however many the records.
NO_MEASURE_YET = say(
    "What helps in the plane need not help in space: no measure is to be adopted before a model in space (dem3d) has "
    "told the same."
)


def doubt(labels: Sequence[str], columns: Sequence[Structure], model: Model) -> str:
    """Caveat before any advice on these states, because of the model; empty where nothing does."""
    if not model.is_plane(model.parameters()):
        return caveat(columns, model)
    if all(column.section != "circular" for column in columns):
        return ""
    measures = any(label not in NO_MEASURE for label in labels)
    return joined(" ", [ROUND_IN_THE_PLANE, NO_MEASURE_YET * measures])


def reference(labels: Sequence[str], label: str) -> str:
    """The state that another one is compared with: a measure with the column as it stands today, all else with the first.

    The column as it stands today is as found, or else as built; where there is none of the two, the first of all.
    """
    today = [name for name in NO_MEASURE if name in labels]
    return today[-1] if today and label not in NO_MEASURE else labels[0]


@dataclass(frozen=True)
class Difference:
    """Difference of a state from another one, the same records, levels and twins against one another.

    Intervals hold what is undecided: their one end is that of the case in which every undecided run ends in favour of this
    state and against the other, their other end that of the opposite.

    Parameters
    ----------
    state, against : str
        Labels.
    pairs : int
        Pairs of runs that both have a verdict.
    saved, harmed : int
        Pairs in which only the other state exceeds the limit state, and only this one.
    share, share_low, share_high : float
        Share of the pairs that exceed it, less that of the other state, and its interval over records [-].
    ratio, ratio_low, ratio_high : float
        Median capacity over that of the other state, from the runs that both know, and its interval over records [-]; NaN
        where a curve is missing, 0 and infinite where no limit is known.
    undecided, failed : int
        Pairs of which a run has no verdict, and of which a run could not be computed.
    records : int
        That the pairs are of.
    share_best, share_worst, ratio_best, ratio_worst : float
        Share and ratio of all pairs that could be computed, if every undecided run ends in favour of this state, and
        against it [-]; share and ratio themselves where all is decided.
    limit_state, im : str
        As typed; the measure is empty where the levels are of none.
    confidence : float
        Of the intervals.
    stone : str
        What limits the links of this state instead of them, in words.
    lacking : str
        What the runs lack for a comparison of medians; empty where they lack nothing, or a state has no curve.
    to_decide : str
        What decides the undecided runs of this state, in a clause.
    """

    state: str
    against: str
    pairs: int
    saved: int
    harmed: int
    share: float
    share_low: float
    share_high: float
    ratio: float
    ratio_low: float
    ratio_high: float
    undecided: int = 0
    failed: int = 0
    records: int = 0
    share_best: float = math.nan
    share_worst: float = math.nan
    ratio_best: float = math.nan
    ratio_worst: float = math.nan
    limit_state: str = "collapse"
    im: str = ""
    confidence: float = 0.95
    stone: str = ""
    lacking: str = ""
    to_decide: str = ""

    @property
    def conclusion(self) -> str:
        """Stronger or weaker than the other state beyond the chance of these records, or not told.

        Of fewer records than a fragility takes nothing is concluded. Any sure sign of harm makes a state weaker; where share
        and median contradict one another, nothing is told.
        """
        if self.records < FEWEST:
            return INCONCLUSIVE
        fewer, more = self.share_high < 0.0, self.share_low > 0.0
        higher, lower = self.ratio_low > 1.0, self.ratio_high < 1.0
        if more or lower:
            return INCONCLUSIVE if fewer or higher else WEAKER
        return STRONGER if fewer and not self.ratio < 1.0 else INCONCLUSIVE

    @property
    def sentence(self) -> str:
        """The advice, and what it rests on."""
        return joined(" ", [self.advice, self.basis])

    @property
    def basis(self) -> str:
        """Basis of the advice: median, pairs and share, with their intervals."""
        return joined(" ", [self._median(), self._pairs(), self._share()])

    @property
    def advice(self) -> str:
        """Advice, in one sentence that can be read in one way only, and what to mind beside it."""
        return joined(" ", [self._advice, self.stone])

    @property
    def _advice(self) -> str:
        known = {
            "state": self.state,
            "against": say("than “{name}” against {state}", name=self.against, state=say(self.limit_state)),
        }
        measure = self.state not in NO_MEASURE
        if self.conclusion == STRONGER:
            return say("“{state}”: stronger {against}, under these motions.", **known)
        if self.conclusion == WEAKER:
            never = say("“{state}”: weaker {against}: do not adopt it for safety.", **known)
            return never if measure else say("“{state}”: weaker {against}.", **known)
        words: list[str] = [say("it fares better in {saved} of {number} and worse in {harmed}").of(
            saved=self.saved, number=self._number, harmed=self.harmed)]  # fmt: skip
        if self.records < FEWEST:
            words.append(say("nothing is concluded from fewer than {fewest} records", fewest=FEWEST))
        if self.undecided:
            alone = self.undecided == 1
            template = (
                say("{open} of {all} pairs of runs is undecided")
                if alone
                else say("{open} of {all} pairs of runs are undecided")
            )
            message = template.of(open=self.undecided, all=self.pairs + self.undecided)
            words.append(joined(": ", [message, *[self.to_decide] * (self.to_decide != "" and self.records >= FEWEST)]))
        here = joined("; ", words) if self.pairs + self.undecided else NO_PAIR
        if measure:
            no = say(
                "“{state}”: not shown to be stronger {against}, nor weaker: no ground to adopt it for safety ({here})."
            )
            return no.of(here=here, **known)
        return say("“{state}”: not shown to be weaker or stronger {against} ({here}).", here=here, **known)

    @property
    def _number(self) -> str:
        """Number of pairs of runs, and of their records: the runs of one record are no independent evidence."""
        pairs = self.pairs + self.undecided
        runs = say("{count} pair of runs", count=1) if pairs == 1 else say("{count} pairs of runs", count=pairs)
        if self.records == 1:
            return say("{pairs} under 1 record", pairs=runs)
        return say("{pairs} under {count} records", pairs=runs, count=self.records)

    def _median(self) -> str:
        if math.isnan(self.ratio):
            return say("Medians are not compared: {lacking}.", lacking=self.lacking) if self.lacking else ""
        low, high = sorted((self.ratio_best - 1.0, self.ratio_worst - 1.0))
        measure = f" ({self.im})" if self.im else ""
        change = self._change((low, high), (self.ratio_low - 1.0, self.ratio_high - 1.0), _percent)
        words = say("The median intensity of {state}{measure} is {change}.")
        return words.of(state=say(self.limit_state), measure=measure, change=change)

    def _pairs(self) -> str:
        if not self.pairs + self.undecided:
            return say("{none:capital}.", none=NO_PAIR)
        how = say("collapse") if self.limit_state == "collapse" else say("exceed {state}", state=self.limit_state)
        message = say("Of {number}, {saved} {how} with “{against}” only and {harmed} with “{state}” only").of(
            number=self._number, saved=self.saved, how=how, against=self.against, harmed=self.harmed, state=self.state
        )
        if self.undecided:
            open_ = say("; {count} is undecided") if self.undecided == 1 else say("; {count} are undecided")
            message += open_.of(count=self.undecided)
        return message + (say("; {count} more could not be computed.", count=self.failed) if self.failed else ".")

    def _share(self) -> str:
        if not self.pairs + self.undecided:
            return ""
        change = self._change((self.share_best, self.share_worst), (self.share_low, self.share_high), _points)
        if self.limit_state == "collapse":
            return say("The share that collapses is {change}.", change=change)
        return say("The share that exceeds {state} is {change}.", state=self.limit_state, change=change)

    def _change(
        self, of_these: tuple[float, float], of_others: tuple[float, float], words: Callable[[float, bool], str]
    ) -> str:
        """The interval over records, which decides, and what these records alone show."""
        here = say("{here} in these records", here=_span(*of_these, words))
        if self.records < FEWEST or math.isnan(of_others[0]) or math.isnan(of_others[1]):
            return here + (say(", whichever way the undecided end") if self.undecided else "")
        both = say(", undecided runs counted both ways") if self.undecided else ""
        template = say("{span} ({level:g} % interval over records{both}; {here})")
        return template.of(span=_span(*of_others, words), level=100.0 * self.confidence, both=both, here=here)


def _percent(value: float, direction: bool = True) -> str:
    """A change of a ratio by its size, and its direction where that is asked for."""
    size = whole_percent(abs(value))
    if size == "0":
        return say("the same")
    if not direction:
        return size
    return say("{size} % higher", size=size) if value > 0.0 else say("{size} % lower", size=size)


def _points(value: float, direction: bool = True) -> str:
    """A change of a share by its size, and its direction where that is asked for."""
    size = whole_percent(abs(value))
    if size == "0":
        return say("the same")
    if not direction:
        return size
    if size in ("1", "<1"):
        alone = say("{size} percentage point higher") if value > 0.0 else say("{size} percentage point lower")
        return alone.of(size=size)
    return (say("{size} percentage points higher") if value > 0.0 else say("{size} percentage points lower")).of(
        size=size
    )


def _span(low: float, high: float, words: Callable[[float, bool], str]) -> str:
    """From which to which change; a lower end of −1 of a ratio and an infinite upper one are no limits."""
    if math.isinf(high) and low <= -1.0:
        return say("not known")
    if math.isinf(high):
        return (say("at least {low}") if low > 0.0 else say("{low} or any more")).of(low=words(low, True))
    below, above = words(low, True), words(high, True)
    if below == above:
        return below
    changes = whole_percent(abs(low)) != "0" and whole_percent(abs(high)) != "0"
    if low > 0.0 and high > 0.0 and changes:
        below = words(low, False)
    if low < 0.0 and high < 0.0 and changes:
        below, above = words(high, False), below
    return say("{low} to {high}", low=below, high=above)


#: A resolution of levels is told from so many of them on.
FEWEST_LEVELS = 2


def unseen(records: int, confidence: float = 0.95) -> float:
    """Largest share of records that may be otherwise than all that were seen: z²/(n + z²), Wilson's limit of 0 in n."""
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    return z * z / (records + z * z)


def share_limits(
    sums: np.ndarray, pairs: np.ndarray, levels: float, drawn: np.ndarray, confidence: float = 0.95
) -> tuple[float, float]:
    """Limits of a mean change of pairs: the wider ones of a bootstrap over records and of Eq. (G7).

    The bootstrap sees no changes but those that happened. The other is Agresti and Coull's of yes and no: as if z² more
    records had been seen, of which one half changes at one level for the better and the other half for the worse.

    Parameters
    ----------
    sums, pairs : array, shape (n,)
        Sum of the changes of a record, each −1, 0 or 1, and its number of pairs.
    levels : float
        Number of different intensities of a record.
    drawn : array, shape (S,)
        Mean changes of the samples of the bootstrap.
    confidence : float
    """
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    change, more = sums / pairs.mean(), z * z
    count = len(change) + more
    middle = change.sum() / count
    spread = ((change**2).sum() + more / levels**2) / count - middle**2
    half = z * math.sqrt(spread / count)
    tail = 0.5 - 0.5 * confidence
    low, high = np.quantile(drawn, [tail, 1.0 - tail])
    return min(float(low), middle - half), max(float(high), middle + half)


def levels_of(records: np.ndarray, im: np.ndarray) -> tuple[float, float]:
    """Number of different intensities of a record, and the mean step of their logarithms (NaN where there is none)."""
    numbers, steps = [], []
    for record in np.unique(records):
        y = np.unique(np.round(np.log(im[records == record]), DIGITS))
        numbers.append(len(y))
        if len(y) >= FEWEST_LEVELS:
            steps.append((y[-1] - y[0]) / (len(y) - 1))
    return float(np.mean(numbers)), float(np.mean(steps)) if steps else math.nan


def median_ends(low: np.ndarray, high: np.ndarray, limits: tuple[float, float]) -> tuple[float, float]:
    """Between which levels the median capacity lies: ln of both ends.

    Parameters
    ----------
    low, high : array, shape (n,)
        Ends of the brackets of ln capacity, one per curve.
    limits : (float, float)
        Of the median by all that is known, in the unit of the measure: no end lies beyond them.
    """
    ends = (
        float(np.quantile(low, 0.5, method="inverted_cdf")),
        -float(np.quantile(-high, 0.5, method="inverted_cdf")),
    )
    with np.errstate(divide="ignore"):
        least, most = np.log(limits).tolist()
    return min(max(ends[0], least), most), min(max(ends[1], least), most)


#: Smallest number of states that can be compared.
FEWEST_STATES = 2


@dataclass(frozen=True, eq=False)
class StateComparison(NotebookSummary):
    """Several states of a column, or of an assembly, under the same motions.

    Parameters
    ----------
    labels : tuple of str
        Measures are compared with the column as it stands today, see :func:`~stylobate.probability.states.reference`.
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
            runs = [(b, u) for b, u in zip(mine["link_broken_s"], mine["link_utilisation"]) if isinstance(b, list)]
            for k, link in enumerate(links):
                broke = [b[k] for b, _ in runs if b[k] is not None]
                used = [u[k] for _, u in runs]
                rows.append(
                    {
                        "state": label,
                        "link": link.name,
                        "runs": len(runs),
                        "broken": len(broke),
                        "largest_over_capacity": max(used, default=math.nan),
                        "median_over_capacity": float(np.median(used)) if used else math.nan,
                        "at_capacity": sum(use >= AT_CAPACITY for use in used),
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
    evidences = [
        evidence(part, study.im, state, label, doubt=before) for part, label in zip(parts, labels, strict=True)
    ]
    curves = tuple(_curve(state_evidence, samples, seed, confidence) for state_evidence in evidences)
    compared = {label: labels.index(reference(labels, label)) for label in labels[1:]}
    weak = [stone_that_breaks(column.placed_links) for column in named[1:]]
    differences = tuple(
        dataclasses.replace(
            with_undecided(evidences[at], state_evidence, curves[at], curve, samples, seed, confidence),
            stone=words,
            to_decide=to_decide(column, model.parameters(), campaign.tail),
        )
        for at, state_evidence, curve, words, column in zip(
            compared.values(), evidences[1:], curves[1:], weak, named[1:], strict=True
        )
    )
    side_by_side = tuple(
        shares(
            {state_evidence.name: state_evidence.codes for state_evidence in evidences},
            evidences[0].records,
            evidences[0].laws,
        )
    )
    before = doubt(labels, named, model) if study.of_one_law else ""
    if evidences[0].laws is not None and (few := few_laws(len(np.unique(evidences[0].laws)))):
        before = f"{before} {few[:1].upper()}{few[1:]}.".lstrip()
    return StateComparison(labels, named, result, table, curves, differences, side_by_side, state, study, before)


def _blank(states: Sequence[Structure], model: Model) -> dict:
    """Names of what runs of these states measure."""
    linked, blocks = any(structure.links for structure in states), states[0].base_width is None
    return blank_row(space="y" in model.axes, links=linked, blocks=blocks)


def _curve(state_evidence: Evidence, samples: int, seed: int, confidence: float) -> Fragility | None:
    try:
        return fragility(state_evidence, samples=samples, seed=seed, confidence=confidence)
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
    lacking = (curve.unsupported for curve in (first_curve, other_curve) if curve is not None)
    return dataclasses.replace(
        known,
        share_low=best.share_low,
        share_high=worst.share_high,
        ratio_low=math.nan if no_ratio else _limit_or(worst.ratio_low, 0.0),
        ratio_high=math.nan if no_ratio else _limit_or(best.ratio_high, math.inf),
        undecided=int(open_.sum()),
        failed=int((~computed).sum()),
        records=len(np.unique(first.records[computed])),
        share_best=best.share,
        share_worst=worst.share,
        ratio_best=math.nan if no_ratio else _limit_or(best.ratio, math.inf),
        ratio_worst=math.nan if no_ratio else _limit_or(worst.ratio, 0.0),
        limit_state=first.state,
        im="" if first.measure in ("im", "factor") else first.measure,
        confidence=confidence,
        lacking=next(filter(None, lacking), ""),
    )


def _ended(state_evidence: Evidence, code: int) -> Evidence:
    """The same runs, as if every undecided one had come to an end."""
    return dataclasses.replace(state_evidence, codes=np.where(state_evidence.codes == OPEN, code, state_evidence.codes))


def _limit_or(value: float, otherwise: float) -> float:
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
            mean = [change[first.laws[known] == law].mean() for law in np.unique(first.laws[known])]
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
    for state_evidence, alone in zip(both, curves, strict=True):
        codes = np.where(known, state_evidence.codes, OPEN)
        low, high, owner = intervals(state_evidence, codes, "runs")
        if not len(low):
            return math.nan, math.nan, math.nan
        curve_of_both = fit(low, high)
        best.append(float(curve_of_both.log_median[0]) if not falls(curve_of_both) else math.nan)
        drawn.append(bootstrap(low, high, owner, samples, np.random.default_rng(seed))[:, 0])
        if state_evidence.laws is not None:
            by_law.append(medians_by_law(state_evidence, codes, "runs"))
        ends.append(median_ends(*intervals(state_evidence, codes, "records")[:2], alone.median_interval))
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
