"""Fragility: a lognormal curve, its intervals, and runs that make none."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from ..errors import InputError, check_choice, check_kind, check_range, check_whole
from ..messages import digits as number
from ..messages import joined, say
from ..notebook import NotebookSummary
from ..verdicts.limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN
from ..verdicts.verdict import few_laws, under_another_law, wilson_interval
from . import lognormal
from .evidence import DIGITS, Evidence, Ida, independent, intervals, medians_by_law
from .evidence import evidence as evidence_of
from .lognormal import AT_END, curve, dispersions, region

#: Fewest records of which a fragility is made: fewer say nothing about the next earthquake.
FEWEST = 10

#: What is to be done about runs that are undecided.
DECIDE = "decide the runs that are undecided, as the command that made them says"

#: Fewest samples of a bootstrap, so that the quantiles of an interval of 95 % are among them.
FEWEST_SAMPLES = 40


def check_bootstrap(samples: int, seed: int, confidence: float) -> None:
    """Refuse numbers with which no interval can be made."""
    check_whole("`samples`", samples, FEWEST_SAMPLES)
    check_whole("`seed`", seed, 0, 2**63 - 1)
    check_range("confidence", confidence, 0.0, 1.0, open_low=True, open_high=True, remedy="such as 0.95")


def check_number(evidence: Evidence, records_are_one: bool) -> None:
    """Refuse what is no sample of earthquakes, whatever its runs say."""
    decided = evidence.codes >= 0
    if not decided.any():
        raise InputError(
            f"none of the {len(decided)} runs of {evidence.name} is decided ({evidence.count(OPEN)} undecided, "
            f"{evidence.count(FAILED)} failed), so that nothing is known of {evidence.state}; {DECIDE}."
        )
    count, every = len(np.unique(evidence.records[decided])), len(np.unique(evidence.records))
    if count >= FEWEST:
        return
    what = ("run" if records_are_one else "record") + ("" if count == 1 else "s")
    what += f" (of {every}; the others have no decided run)" if count < every else ""
    remedy = DECIDE if count < FEWEST <= every else f"give at least {FEWEST}"
    if not records_are_one:
        remedy += ", or say `records_are_one` to take every run for a record of its own"
    raise InputError(f"a fragility of {count} {what} says nothing about the next earthquake; {remedy}.")


def check_shape(evidence: Evidence, low: np.ndarray, high: np.ndarray, best: lognormal.Fit) -> None:
    """Refuse runs through which no fragility goes."""
    state, unit = evidence.state, "" if evidence.unit == "-" else f" {evidence.unit}"
    if math.isinf(best.log_median[0]):
        every = best.log_median[0] < 0.0
        raise InputError(
            f"{'every decided run exceeds' if every else 'no decided run exceeds'} {state}, so that no curve can be drawn; "
            f"give {'smaller' if every else 'larger'} intensities."
        )
    ends = np.concatenate((low, high))
    ends = np.unique(np.round(ends[np.isfinite(ends)], DIGITS))
    if len(ends) == 1:
        raise InputError(
            f"all runs of {evidence.name} are at one intensity, {evidence.measure} = {math.exp(ends[0]):.4g}{unit}, where "
            f"{evidence.count(EXCEEDED)} of {int((evidence.codes >= 0).sum())} exceed {state}: what happens at others is "
            "not known; give runs at several intensities."
        )
    if lognormal.falls(best):
        with_it, without = (
            math.exp(np.log(evidence.im[evidence.codes == code]).mean()) for code in (EXCEEDED, NOT_EXCEEDED)
        )
        raise InputError(
            f"runs of {evidence.name} do not exceed {state} more often where {evidence.measure} is larger (its geometric "
            f"mean is {with_it:.3g}{unit} where they do, {without:.3g}{unit} where they do not), and that is no fragility; "
            "check which value of 'collapsed' is which, or give intensities farther apart."
        )


#: Sets of runs drawn from the curve to tell how good its fit is.
SETS = 200

#: Intensities told apart by the points behind the curve; more of them are put together.
MOST_POINTS = 12


@dataclass(frozen=True, eq=False)
class Points:
    """Shares of the records that exceed the state, without a curve.

    Parameters
    ----------
    im, share, low, high : array, shape (k,)
        Intensity, share of what is decided, and its Wilson interval, which holds what open runs could make of it; how
        often a record counts does not hang on how many runs it has.
    records : array of int, shape (k,)
    """

    im: np.ndarray
    share: np.ndarray
    low: np.ndarray
    high: np.ndarray
    records: np.ndarray

    def table(self) -> list[dict[str, Any]]:
        """A row for each point, of plain numbers."""
        names = {"im": self.im, "share": self.share, "low": self.low, "high": self.high, "records": self.records}
        return [dict(zip(names, row)) for row in zip(*(values.tolist() for values in names.values()), strict=True)]


def points_of(evidence: Evidence, codes: np.ndarray, method: str, both_ways: bool = False) -> Points:
    """Shares of the records at the intensities that were run, or by groups of them.

    With ``both_ways`` the intervals hold what runs without a verdict could make of the shares.
    """
    at, counts = (_capacities if method == "records" else _groups)(evidence, codes)
    share, low, high, trials = _shares(*counts(codes))
    if both_ways and (codes < 0).any():
        low = np.minimum(low, _shares(*counts(np.where(codes < 0, NOT_EXCEEDED, codes)))[1])
        high = np.maximum(high, _shares(*counts(np.where(codes < 0, EXCEEDED, codes)))[2])
    return Points(at, share, low, high, trials)


#: By what runs say, how many statements of each record there are at each point, and how many that it is exceeded.
Counts = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def _capacities(evidence: Evidence, codes: np.ndarray) -> tuple[np.ndarray, Counts]:
    """Intensities at which capacities end, and what is known there of each."""
    high = intervals(evidence, codes, "records")[1]
    at = np.unique(high[np.isfinite(high)])
    at = at[np.unique(np.linspace(0, len(at) - 1, min(MOST_POINTS, len(at))).round().astype(int))]
    number = len(np.unique(evidence.records))

    def counts(codes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        low, high, owner = intervals(evidence, codes, "records")
        runs, hits = np.zeros((2, len(at), number))
        np.add.at(runs.T, owner, (high[:, None] <= at) | (low[:, None] >= at))
        np.add.at(hits.T, owner, high[:, None] <= at)
        return runs, hits

    return np.exp(at), counts


def _groups(evidence: Evidence, codes: np.ndarray) -> tuple[np.ndarray, Counts]:
    """Intensities of decided runs, or of groups of them, and how many runs are there."""
    decided = codes >= 0
    y = np.exp(np.round(np.log(evidence.im), DIGITS))  # stripes that differ in their last digits are one
    names, owner = np.unique(evidence.records, return_inverse=True)
    levels = np.unique(y[decided])
    if len(levels) > MOST_POINTS:
        edges = np.quantile(y[decided], np.linspace(0.0, 1.0, 1 + min(8, max(3, len(np.unique(owner[decided])) // 5))))
        group, there = (
            np.clip(np.searchsorted(edges, y, side="right") - 1, 0, len(edges) - 2),
            np.ones(len(y), dtype=bool),
        )
    else:
        group = np.minimum(np.searchsorted(levels, y), len(levels) - 1)
        there = levels[group] == y  # no run is decided at another intensity: there is no point
    filled = np.unique(group[decided])
    cell = np.searchsorted(filled, group) * len(names) + owner
    there &= np.isin(group, filled)

    def counts(codes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        known, shape = there & (codes >= 0), (len(filled), len(names))
        runs = np.bincount(cell[known], minlength=math.prod(shape)).reshape(shape)
        return runs, np.bincount(cell[known], codes[known] == EXCEEDED, math.prod(shape)).reshape(shape)

    at = np.bincount(group[decided], np.log(y[decided]))[filled] / np.bincount(group[decided])[filled]
    return np.exp(at), counts


def _shares(runs: np.ndarray, hits: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Share, its limits and number of records, of so many runs of each at a point, shape (k, records)."""
    passed = np.divide(hits, runs, out=np.zeros(runs.shape), where=runs > 0).sum(axis=1)
    trials = (runs > 0).sum(axis=1)
    low, high = wilson_interval(passed, trials)
    return passed / np.maximum(trials, 1), low, high, trials


def goodness(
    evidence: Evidence, method: str, points: Points, log_median: float, beta: float, rng: np.random.Generator
) -> tuple[float, float]:
    """Largest distance of the points from the curve, and how often runs drawn from the curve have a larger one.

    Each set gives every record one capacity, drawn from the curve, and fits a curve of its own.
    """
    distance = float(np.abs(points.share - lognormal.curve(points.im, log_median, beta)).max())
    names, owner = np.unique(evidence.records, return_inverse=True)
    y, decided = np.log(evidence.im), evidence.codes >= 0
    drawn = []
    for _ in range(SETS):
        capacity = log_median + beta * ndtri(rng.uniform(size=len(names)))
        drawn.append(np.where(decided, (y >= capacity[owner]).astype(np.int8), evidence.codes))
    ends = [intervals(evidence, codes, method)[:2] for codes in drawn]
    own = lognormal.fit(np.array([low for low, _ in ends]), np.array([high for _, high in ends]))
    larger = []
    for codes, middle, width in zip(drawn, own.log_median, own.beta):
        if not math.isinf(middle):
            drawn_points = points_of(evidence, codes, method)
            larger.append(
                np.abs(drawn_points.share - lognormal.curve(drawn_points.im, middle, width)).max() >= distance - 1e-9
            )
    return distance, float(np.mean(larger)) if larger else math.nan


#: A limit of the median that is farther from all intensities that were run than by this factor is none.
FAR = 1000.0

#: Dispersions on either side of the median within which a curve is drawn, and its points.
WIDE, DRAWN = 3.5, 80

#: Fewest runs on either side of a limit state with which the median of a curve is compared with others.
FEWEST_EACH = 5

#: Share of its records that runs come to as equal ones below which it is said that a few hold most of the runs [-].
UNEQUAL = 0.7


@dataclass(frozen=True, eq=False)
class Fragility(NotebookSummary):
    """A lognormal fragility with what is known about it.

    Parameters
    ----------
    evidence : Evidence
    method : str
        ``runs``: every run counts; ``records``: the capacity under each record, bracketed by its runs.
    log_median, beta : float
        ln θ and β.
    samples : array, shape (S, 2)
        ln θ and ln β of the bootstrap over records.
    region : array, shape (k, 2)
        ln θ and ln β at the edge of what the likelihood leaves plausible, see :mod:`~stylobate.probability.lognormal`.
    dispersions : (float, float)
        What it leaves plausible of β.
    bracket : (float, float) or None
        The largest intensity up to which nothing exceeds the state and the smallest from which everything does, where no
        run contradicts them: then the median lies between them, and of the dispersion only an upper limit is known.
    extremes : (Fit, Fit)
        Of all runs, open and failed ones counted as exceeded, and as not exceeded.
    ends : tuple of Fragility or None
        The same two with all that is known about them, None where one makes no curve; empty where all runs are decided.
        Intervals hold theirs, too.
    points : Points
    distance, p_value : float
        Largest distance between the points and the curve [-], and the share of sets of runs drawn from the curve that have
        a larger one.
    confidence : float
    records_are_one : bool
        Every run counts as a record of its own: ``records`` are runs.
    samples_of_columns : array, shape (S, 2), optional
        The samples as if the law of the joints were known, where it varies.
    """

    evidence: Evidence
    method: str
    log_median: float
    beta: float
    samples: np.ndarray
    region: np.ndarray
    dispersions: tuple[float, float]
    bracket: tuple[float, float] | None
    extremes: tuple[tuple[float, float], tuple[float, float]]
    points: Points
    distance: float
    p_value: float
    confidence: float
    records_are_one: bool = False
    ends: tuple[Fragility | None, ...] = ()
    samples_of_columns: np.ndarray | None = None

    @property
    def laws(self) -> int:
        """Number of laws of the joints, where they vary; else 0."""
        laws = self.evidence.laws
        return 0 if laws is None else len(np.unique(laws))

    @property
    def of_columns(self) -> Fragility:
        """The same as if the law of the joints were known, of which the samples draw one more."""
        if self.samples_of_columns is None:
            return self
        ends = tuple(None if end is None else end.of_columns for end in self.ends)
        return replace(self, samples=self.samples_of_columns, samples_of_columns=None, ends=ends)

    @property
    def counted(self) -> str:
        """Samples that count as independent of one another, over which the interval is, in words."""
        return say("runs") if self.records_are_one else say("records")

    @property
    def warnings(self) -> list[str]:
        """Caveats beside anything that rests on this curve."""
        alone = say(
            "every run counts as a record of its own: the interval is over runs, holds for these records only, and says "
            "nothing about the next earthquake"
        )
        known = (self.outside, self.no_dispersion, alone * self.records_are_one, self.unequal, self.few_laws)
        caveats = [joined("", [text, "."]) for text in known if text]
        return [self.evidence.doubt, *caveats] if self.evidence.doubt else caveats

    @property
    def median(self) -> float:
        """θ, in the unit of the measure."""
        return math.exp(self.log_median)

    @property
    def records(self) -> int:
        """Number of records of which a run is decided."""
        return len(np.unique(self.evidence.records[self.evidence.codes >= 0]))

    @cached_property
    def equal_records(self) -> float:
        """Number of records with as many runs each that tell as much, as of :func:`.evidence.independent`."""
        e = self.evidence
        return independent(*intervals(e, e.codes, self.method), self.method)[1]

    @property
    def unequal(self) -> str:
        """Caveat on records that hold most of the runs; empty where there are none."""
        count, equal = self.records, self.equal_records
        message = say(
            "a few of its {count} records hold most of the runs: they tell as much as {equal:.2g} with as many each"
        )
        return message.of(count=count, equal=equal) if equal < UNEQUAL * count else ""

    @property
    def levels(self) -> tuple[float, float]:
        """Smallest and largest intensity of a run that is decided."""
        im = self.evidence.im[self.evidence.codes >= 0]
        return float(im.min()), float(im.max())

    @property
    def outside(self) -> str:
        """Caveat on a median beyond all intensities that were computed; empty where it is among them."""
        e, (low, high) = self.evidence, self.levels
        unit = "" if e.unit == "-" else f" {e.unit}"
        if low * (1.0 - AT_END) <= self.median <= high * (1.0 + AT_END):
            return ""
        above = say(
            "the fitted median, {median:.3g}{unit}, lies above all runs ({im} = {low:.3g} to {high:.3g}{unit}): it is told "
            "by the shape of the curve, not by runs; give larger intensities"
        )
        below = say(
            "the fitted median, {median:.3g}{unit}, lies below all runs ({im} = {low:.3g} to {high:.3g}{unit}): it is told "
            "by the shape of the curve, not by runs; give smaller intensities"
        )
        message = above if self.median > high else below
        return message.of(median=self.median, unit=unit, im=e.measure, low=low, high=high)

    @property
    def unsupported(self) -> str:
        """What the runs lack for their median to be compared with that of others; empty where they lack nothing."""
        e = self.evidence
        how = say("collapse") if e.state == "collapse" else say("exceed {state}", state=e.state)
        larger, smaller = say("larger"), say("smaller")
        for code, verb, more in ((EXCEEDED, how, larger), (NOT_EXCEEDED, say("do not {exceed}", exceed=how), smaller)):
            if (count := e.count(code)) < FEWEST_EACH:
                return say(
                    "{count} of {all} runs of “{name}” {verb}, and a median needs at least {fewest} of them; give {more} "
                    "intensities",
                    count=count, all=len(e.im), name=e.name, verb=verb, fewest=FEWEST_EACH, more=more,
                )  # fmt: skip
        if not self.outside:
            return ""
        (low, high), unit = self.levels, "" if e.unit == "-" else f" {e.unit}"
        above = say(
            "the median of “{name}” lies above {high:.3g}{unit}, where nothing was run; give larger intensities"
        )
        below = say(
            "the median of “{name}” lies below {low:.3g}{unit}, where nothing was run; give smaller intensities"
        )
        return (above if self.median > high else below).of(name=e.name, low=low, high=high, unit=unit)

    @property
    def few_laws(self) -> str:
        """Caveat on twins of too few laws of the joints; empty where there are enough, or one is taken as known."""
        return few_laws(self.laws)

    @property
    def no_dispersion(self) -> str:
        """What must be said of a dispersion that these runs do not show, which β then is the least of; else empty."""
        if lognormal.resolved_beta(self.beta) is not None:
            return ""
        most = self.beta_interval[1]
        limit = say("it may be up to {most:.2g}", most=most) if math.isfinite(most) else say("no limit of it is known")
        return say(
            "the dispersion is not seen in these runs ({limit}, with {level:g} % confidence): β = {beta:g} is where the fit "
            "ends, no value; give levels that lie closer",
            limit=limit, level=100.0 * self.confidence, beta=lognormal.BETAS[0],
        )  # fmt: skip

    def probability(self, im: np.ndarray) -> np.ndarray:
        """Probability of exceedance given the intensity, shape of ``im``."""
        return curve(im, self.log_median, self.beta)

    def interval(self, im: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Confidence limits of :meth:`probability`, point by point: what the quantiles of the samples' curves hold, the
        curves of the region, and the curve moved to either limit of its median; with open runs, from the lower ones of the
        curve if none exceeds to the upper ones if all do. It holds one half over all of :attr:`median_interval` only.
        """
        samples, plausible = (
            np.array([curve(im, m, math.exp(s)) for m, s in pairs]) for pairs in (self.samples, self.region)
        )
        low, high = np.quantile(samples, [self._share, 1.0 - self._share], axis=0, method="nearest")
        low, high = np.minimum(low, plausible.min(axis=0)), np.maximum(high, plausible.max(axis=0))
        least, most = self._median_limits
        if math.isfinite(most):
            low = np.minimum(low, curve(im, most, self.beta))
        if math.isfinite(least):
            high = np.maximum(high, curve(im, least, self.beta))
        if self.ends:
            most, least = self.ends
            low = np.zeros_like(low) if least is None else np.minimum(low, least.interval(im)[0])
            high = np.ones_like(high) if most is None else np.maximum(high, most.interval(im)[1])
        return low, high

    @property
    def span(self) -> tuple[float, float]:
        """Intensities between which it is drawn: where it rises, and never beyond the runs."""
        (least, most), wide = (
            self.levels,
            WIDE * (self.beta if self.bracket is None else min(self.beta_interval[1], 1.0)),
        )
        if self.outside:
            return least, most
        return max(least, self.median * math.exp(-wide)), min(most, self.median * math.exp(wide))

    def drawn(self) -> dict[str, list[float]]:
        """The curve and its band over :attr:`span`, as a table."""
        im = np.geomspace(*self.span, DRAWN)
        names = ("im", "probability", "low", "high")
        return {
            name: values.tolist()
            for name, values in zip(names, (im, self.probability(im), *self.interval(im)), strict=True)
        }

    @property
    def median_interval(self) -> tuple[float, float]:
        """Confidence limits of θ, whatever open runs come to; 0 and +inf where none is known.

        The wider ones of :meth:`limits` and of the plain quantiles of the samples, by which the band is drawn.
        """
        low, high = map(math.exp, self._median_limits)
        if self.ends:
            most, least = self.ends
            low = min(low, 0.0 if most is None else most.median_interval[0])
            high = max(high, math.inf if least is None else least.median_interval[1])
        return low, high

    @property
    def _median_limits(self) -> tuple[float, float]:
        """Limits of ln θ by the decided runs; infinite where none is known."""
        middle, spread = self.samples.T
        endless = spread >= math.log(lognormal.BETAS[1]) - AT_END
        im = np.log(self.evidence.im)
        samples = np.where(endless, np.copysign(np.inf, middle - im.mean()), middle)
        known = [*self.limits(self.log_median, samples, self.region[:, 0])]
        known += np.quantile(samples, [self._share, 1.0 - self._share], method="nearest").tolist()
        known += [] if self.bracket is None else [math.log(limit) for limit in self.bracket]
        low, high, far = min(known), max(known), math.log(FAR)
        return low if low > im.min() - far else -math.inf, high if high < im.max() + far else math.inf

    @property
    def beta_interval(self) -> tuple[float, float]:
        """Confidence limits of β, whatever open runs come to; 0 and +inf where none is known."""
        least, most = np.log(lognormal.BETAS)
        samples = np.where(self.samples[:, 1] >= most - AT_END, np.inf, self.samples[:, 1])
        with np.errstate(divide="ignore"):
            plausible = np.log(self.dispersions)
        low, high = np.quantile(samples, [self._share, 1.0 - self._share], method="nearest")
        if low <= least + AT_END:  # samples that show no dispersion do not say that there is none
            low, high = plausible.min(), max(high, plausible.max())
        else:
            low, high = self.limits(math.log(self.beta), samples, plausible)
        ends = [(0.0, math.inf) if end is None else end.beta_interval for end in self.ends]
        return min([math.exp(low), *(lower for lower, _ in ends)]), max([math.exp(high), *(upper for _, upper in ends)])

    def limits(self, best: float, samples: np.ndarray, plausible: np.ndarray) -> tuple[float, float]:
        """Confidence limits of a quantity: the wider ones of the bootstrap and of the likelihood.

        The bootstrap knows that runs of one record hang together; the region knows what the design leaves open, of which
        samples of the same runs see nothing. Where so many samples have no curve that a limit would be one of theirs, the
        quantiles of the samples are taken as they are, and the limit on that side is none.

        Parameters
        ----------
        best : float
        samples, plausible : array
            Of the samples of the bootstrap, infinite where one has no curve; and over the region of the likelihood.
        """
        low, high = np.quantile(samples, [self._share, 1.0 - self._share], method="nearest")
        if np.isfinite([low, high]).all():
            low, high = self.basic(best, samples)
        return min(float(low), float(plausible.min())), max(float(high), float(plausible.max()))

    def basic(self, best: float, samples: np.ndarray) -> tuple[float, float]:
        """Confidence limits of a quantity from its value and those of the samples.  # Eq. (G3)

        The basic bootstrap, its quantiles widened as Student's t is against the normal distribution.
        """
        low, high = np.quantile(samples, [self._share, 1.0 - self._share], method="nearest")
        return float(2.0 * best - high), float(2.0 * best - low)

    @property
    def _share(self) -> float:
        from scipy.stats import t

        n = max(self.equal_records, 2.0)
        return float(ndtr(math.sqrt(n / (n - 1.0)) * t.ppf(0.5 - 0.5 * self.confidence, n - 1)))

    @property
    def sentence(self) -> str:
        """Words of the runs on the median, in a sentence."""
        e = self.evidence
        known = {
            "name": e.name,
            "im": say(e.measure),
            "unit": "" if e.unit == "-" else f" {e.unit}",
            "counted": self.counted,
        }
        known["state"] = say("collapse") if e.state == "collapse" else e.state
        if self.outside:
            return say("{name}: {outside}.", outside=self.outside, **known)
        if self.bracket is None:
            half = say("{name}: by the fitted curve half of the {counted} bring {state} at {im} = {median:.3g}{unit}.")
            return half.of(median=self.median, **known)
        low, high = self.bracket
        stands = (e.codes == NOT_EXCEEDED) & (e.im > high * (1.0 + AT_END))
        # what stands above a collapse is no capacity, and no run that a sentence on all of them may pass over
        if again := int(stands.sum()) if self.method == "records" else 0:
            between = say("at {low:.4g}{unit}") if low == high else say("between {low:.4g} and {high:.4g}{unit}")
            words = say("{name}: under every record {state} at {im} begins {place}; {again} runs above that stand again and "
                        "are left out.")  # fmt: skip
            alone = say("{name}: under every record {state} at {im} begins {place}; 1 run above that stands again and is "
                        "left out.")  # fmt: skip
            place = between.of(low=low, high=high, **known)
            return (alone if again == 1 else words).of(place=place, again=again, **known)
        run = say("decided run") if self.ends else say("run")
        if low == high:
            words = say("{name}: no {run} below {im} = {low:.4g}{unit} brings {state}, and every {run} above it does.")
            return words.of(run=run, low=low, **known)
        words = say(
            "{name}: half of the {counted} bring {state} at {im} between {low:.4g} and {high:.4g}{unit}: no {run} up to the "
            "one brings it, and every {run} from the other on does."
        )
        return words.of(run=run, low=low, high=high, **known)

    def _law_facts(self) -> dict[str, Any]:
        """Number of laws of the joints, and limits of the median as if they were known; empty where they do not vary."""
        if not self.laws:
            return {}
        low, high = self.of_columns.median_interval
        return {"laws": self.laws, "median_of_columns_low": low, "median_of_columns_high": high}

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate fragility``."""
        e = self.evidence
        (high_median, high_beta), (low_median, low_beta) = self.extremes
        return {
            "median": self.median,
            "median_low": self.median_interval[0],
            "median_high": self.median_interval[1],
            **self._law_facts(),
            "beta": lognormal.resolved_beta(self.beta),
            "beta_low": self.beta_interval[0],
            "beta_high": self.beta_interval[1],
            "correlation": lognormal.correlation(self.samples),
            "im": say(e.measure),
            "unit": e.unit,
            "state": e.state,
            "name": e.name,
            "method": self.method,
            "records": self.records,
            "records_are_one": self.records_are_one,
            "warnings": self.warnings,
            "runs": len(e.im),
            "exceeded": e.count(EXCEEDED),
            "undecided": e.count(OPEN),
            "failed": e.count(FAILED),
            "confidence": self.confidence,
            "levels": list(self.levels),
            "outside": self.outside,
            "bracket": None if self.bracket is None else list(self.bracket),
            "if_open_exceed": {"median": math.exp(high_median), "beta": lognormal.resolved_beta(high_beta)},
            "if_open_do_not": {"median": math.exp(low_median), "beta": lognormal.resolved_beta(low_beta)},
            "largest_distance": self.distance,
            "p_value": self.p_value,
            "sentence": self.sentence,
            "curve": self.drawn(),
            "points": self.points.table(),
        }


def between(low: float | None, high: float | None, unit: str = "-", digits: int = 4) -> str:
    """Limits in words, with their unit; 0 and +inf, or None, where there are none."""
    low, high = low or 0.0, math.inf if high is None else high
    behind, form = "" if unit == "-" else f" {unit}", f".{digits}g"
    if low > 0.0:
        words = say("{low} to {high}{unit}") if high < math.inf else say("{low}{unit} or more")
    else:
        words = say("up to {high}{unit}") if high < math.inf else say("no limits known")
    return words.of(low=number(low, form), high=number(high, form), unit=behind)


#: Samples of the bootstrap.
SAMPLES = 1000

#: What counts: every run, or the capacity under each record.
METHODS = ("runs", "records")


def fragility(
    evidence: Evidence | Ida,
    *,
    method: str | None = None,
    samples: int = SAMPLES,
    seed: int = 0,
    confidence: float = 0.95,
    records_are_one: bool = False,
) -> Fragility:
    """Fit a lognormal fragility.

    Parameters
    ----------
    evidence : Evidence or Ida
        An incremental dynamic analysis is taken for collapse over its own measure; for another limit state or measure
        give ``st.evidence(ida, measure, state)``.
    method : str, optional
        ``runs`` or ``records``, see :class:`Fragility`; by default ``records`` for an IDA whose levels were hunted, and
        ``runs`` for all else, an IDA of given levels among it. ``Fragility.method`` and its summary tell which it is.
    samples : int
        Of the bootstrap, 40 or more.
    seed : int
        Of the bootstrap, from 0.
    confidence : float
        Of the intervals, between 0 and 1 [-].
    records_are_one : bool
        Runs of few records count as if each had a record of its own: the curve is then that of these records.

    Raises
    ------
    InputError
        Fewer than ten records of which a run is decided; no run that exceeds the state, or none that does not; all runs at
        one intensity; or runs that exceed it no oftener where the intensity is larger: that is no fragility.
    """
    check_bootstrap(samples, seed, confidence)
    check_choice("`method`", method, (None, *METHODS))
    if isinstance(evidence, Ida):
        evidence = evidence_of(evidence)
    check_kind("evidence", evidence, Evidence, allowed="an Evidence, or an Ida")
    clusters = np.arange(len(evidence.im)).astype(str).astype(object)
    used = replace(evidence, records=clusters, curves=None) if records_are_one else evidence
    check_number(used, records_are_one)
    how = method or ("records" if evidence.brackets and not records_are_one else "runs")
    codes = evidence.codes
    low, high, owner = intervals(used, codes, how)
    best = lognormal.fit(low, high)
    check_shape(used, low, high, best)
    log_median, beta = (float(values[0]) for values in best)
    rng = np.random.default_rng(seed)
    extremes = []
    for counted in (EXCEEDED, NOT_EXCEEDED):
        extreme_fit = lognormal.fit(*intervals(used, np.where(codes < 0, counted, codes), how)[:2])
        extremes.append(
            (math.nan, math.nan)
            if lognormal.falls(extreme_fit)
            else (float(extreme_fit.log_median[0]), float(extreme_fit.beta[0]))
        )
    points = points_of(used, codes, how, both_ways=True)
    distance, p_value = goodness(used, how, points, log_median, beta, rng)
    estimate = _with_laws(Fragility(
        used, how, log_median, beta, *_known(low, high, owner, how, samples, rng, confidence), (extremes[0], extremes[1]),
        points, distance, p_value, confidence, records_are_one,
    ), rng)  # fmt: skip
    if (codes >= 0).all():
        return estimate
    return replace(
        estimate, ends=tuple(_ended(estimate, counted, samples, seed) for counted in (EXCEEDED, NOT_EXCEEDED))
    )


def _known(
    low: np.ndarray,
    high: np.ndarray,
    owner: np.ndarray,
    method: str,
    samples: int,
    rng: np.random.Generator,
    confidence: float,
) -> tuple[np.ndarray, np.ndarray, tuple[float, float], tuple[float, float] | None]:
    """Curve through intervals of ln capacity: samples, region, dispersions and bracket."""
    below, above = float(low.max()), float(high.min())
    weight, number = independent(low, high, owner, method)
    return (
        lognormal.bootstrap(low, high, owner, samples, rng),
        region(low, high, weight, number, confidence),
        dispersions(low, high, weight, number, confidence),
        (math.exp(below), math.exp(above)) if below <= above else None,
    )


def _ended(estimate: Fragility, counted: int, samples: int, seed: int) -> Fragility | None:
    """The curve as if every run without a verdict had come to the same one; None where that is none."""
    runs = estimate.evidence
    runs = replace(runs, codes=np.where(runs.codes < 0, counted, runs.codes))
    low, high, owner = intervals(runs, runs.codes, estimate.method)
    best, rng = lognormal.fit(low, high), np.random.default_rng(seed)
    try:
        check_shape(runs, low, high, best)
    except InputError:
        return None
    known = _known(low, high, owner, estimate.method, samples, rng, estimate.confidence)
    names = ("samples", "region", "dispersions", "bracket")
    middle, spread = (float(each[0]) for each in best)
    return _with_laws(replace(estimate, evidence=runs, log_median=middle, beta=spread, **dict(zip(names, known))), rng)


def _with_laws(estimate: Fragility, rng: np.random.Generator) -> Fragility:
    """The curve with samples that draw one more law of the joints, where the runs are of several."""
    e = estimate.evidence
    if e.laws is None:
        return estimate
    away = under_another_law(medians_by_law(e, e.codes, estimate.method), len(estimate.samples), rng)
    return replace(
        estimate,
        samples=estimate.samples + np.stack((away, np.zeros(len(away))), axis=1),
        samples_of_columns=estimate.samples,
    )
