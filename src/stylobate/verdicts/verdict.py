"""The verdict of a run: the one place where runs are counted as collapse, or not.

One rule for every count, share, interval and table:

* A run is ``failed`` if it could not be computed; ``undecided`` if it ended while the column could still change its mind;
  else it ``collapsed`` or ``stands``. Counts name all of them; a run that failed or is undecided is no collapse.
* Shares and probabilities are over all runs but those that failed or were not made. An undecided run counts as not
  collapsed: left out, it would make the share too large, because a collapse decides a run at once and standing needs time.
* In an interval the undecided are counted for both sides: as standing in the lower limit, as collapsed in the upper one.
* Two models are compared where both have a verdict.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from itertools import groupby
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np

from ..campaign.twins import PER_LAW
from ..column.structure import Structure
from ..messages import joined, say
from ..models.base import Model
from ..response.rows import Rows
from ..response.words import cautions_in_space, round_in_the_plane

STANDS, COLLAPSED, UNDECIDED, FAILED, NOT_RUN = "stands", "collapsed", "undecided", "failed", "not run"

VERDICTS = (STANDS, COLLAPSED, UNDECIDED, FAILED, NOT_RUN)

#: Verdicts of runs that were made.
COMPUTED = (COLLAPSED, STANDS, UNDECIDED, FAILED)

#: Attribute of a labelled array that holds verdicts as their places in VERDICTS.
FLAGS = {
    "long_name": "verdict of the run",
    "flag_values": np.arange(len(VERDICTS), dtype=np.int8),
    "flag_meanings": " ".join(verdict.replace(" ", "_") for verdict in VERDICTS),
}


def verdict(row: Mapping[str, Any] | None) -> str:
    """Verdict of a run from its row (``Measures.row()``); None stands for a run that was not made."""
    if row is None:
        return NOT_RUN
    if row["outcome"] == "failed":
        return FAILED
    if not row["decided"]:
        return UNDECIDED
    return COLLAPSED if row["collapsed"] else STANDS


def verdicts_of(rows: Rows) -> np.ndarray:
    """Verdicts of many runs, as :func:`verdict` gives them; texts, shape (runs,)."""
    collapsed, decided = rows.floats("collapsed") == 1.0, rows.floats("decided") == 1.0
    states = (
        (~rows.made, NOT_RUN),
        (rows.are("outcome", "failed"), FAILED),
        (~decided, UNDECIDED),
        (collapsed, COLLAPSED),
    )
    return np.select([where for where, _ in states], [name for _, name in states], STANDS)


def count(verdicts: Sequence[str] | np.ndarray) -> dict[str, int]:
    """Number of runs of each verdict."""
    values = np.asarray(verdicts).ravel()
    return {verdict: int(np.count_nonzero(values == verdict)) for verdict in VERDICTS}


def open_runs(counts: Mapping[str, Any], so: str = say("not counted as collapse")) -> str:
    """Number of runs without a verdict, as a sentence behind another one; empty where all have one."""
    undecided, failed = counts.get(UNDECIDED), counts.get(FAILED)
    alone = say("1 run is undecided") if undecided == 1 else say("{count} runs are undecided", count=undecided)
    failing = say("1 run failed") if failed == 1 else say("{count} runs failed", count=failed)
    clauses = [text for text, number in ((alone, undecided), (failing, failed)) if number]
    return say(" {runs}: {so}.", runs=joined(say(" and "), clauses), so=so) if clauses else ""


def tally(verdicts: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Numbers of runs that collapsed, stand and are undecided along an axis of an array of verdicts."""
    collapsed, stands, undecided = ((verdicts == verdict).sum(axis=axis) for verdict in (COLLAPSED, STANDS, UNDECIDED))
    return collapsed, stands, undecided


def share_collapsed(collapsed: Any, stands: Any, undecided: Any) -> np.ndarray:
    """Share of the runs that collapse, undecided ones counted as not collapsed; NaN where no run is decided.

    Parameters
    ----------
    collapsed, stands, undecided : array of int
        Numbers of runs; those that failed are in none of them.
    """
    fell, stood, open_ = (np.asarray(counts) for counts in (collapsed, stands, undecided))
    trials = fell + stood + open_
    return np.divide(fell, trials, out=np.full(trials.shape, np.nan), where=fell + stood > 0)


def collapse_interval(
    collapsed: Any, stands: Any, undecided: Any, confidence: float = 0.95
) -> tuple[np.ndarray, np.ndarray]:
    """Confidence limits of the probability of collapse; arguments as of :func:`share_collapsed`.

    The lower one as if every undecided run had come to stand, the upper one as if it had collapsed.
    """
    fell, stood, open_ = (np.asarray(counts) for counts in (collapsed, stands, undecided))
    trials = fell + stood + open_
    low, _ = wilson_interval(fell, trials, confidence)
    return low, wilson_interval(fell + open_, trials, confidence)[1]


def wilson_interval(successes: Any, trials: Any, confidence: float = 0.95) -> tuple[np.ndarray, np.ndarray]:
    """Confidence limits of a probability from counts; 0 and 1 where there is no trial.

    References
    ----------
    Wilson 1927: the probabilities p with (successes/trials − p)² ≤ z² p (1 − p)/trials.
    """
    k, n = np.asarray(successes, dtype=float), np.asarray(trials, dtype=float)
    z2 = NormalDist().inv_cdf(0.5 + 0.5 * confidence) ** 2
    centre = (k + 0.5 * z2) / (n + z2)
    half = np.sqrt(z2) / (n + z2) * np.sqrt(np.divide(k * (n - k), n, out=np.zeros_like(n), where=n > 0) + 0.25 * z2)
    low = np.where(k == 0, 0.0, np.maximum(0.0, centre - half))
    return low, np.where(k == n, 1.0, np.minimum(1.0, centre + half))


def first_collapse(amplitudes: np.ndarray, verdicts: Sequence[str]) -> float | None:
    """Smallest amplitude that collapses, or None."""
    return next((float(a) for a, verdict in zip(amplitudes, verdicts) if verdict == COLLAPSED), None)


def all_collapse_above(amplitudes: np.ndarray, verdicts: Sequence[str]) -> float | None:
    """Smallest amplitude from which on every run collapses, or None."""
    lowest = None
    for amplitude, verdict in zip(amplitudes[::-1], reversed(list(verdicts))):
        if verdict != COLLAPSED:
            break
        lowest = float(amplitude)
    return lowest


def alternations(amplitudes: np.ndarray, verdicts: Sequence[str]) -> list[tuple[float, float, str, int]]:
    """Stretches of equal verdict along the amplitudes: (first amplitude, last amplitude, verdict, runs)."""
    out = []
    for verdict, group in groupby(zip(amplitudes, verdicts), key=lambda pair: pair[1]):
        stretch = [float(amplitude) for amplitude, _ in group]
        out.append((stretch[0], stretch[-1], verdict, len(stretch)))
    return out


#: Shares of many capacities that are told.
SHARES = (0.16, 0.5, 0.84)


class Capacity(NamedTuple):
    """A level above ``low`` and up to ``high``: the largest that was stood, and the smallest that brought collapse.

    ``low`` is 0 where no lower level was stood, ``high`` infinite where none brought collapse: only a bound is known then.
    """

    low: float
    high: float

    @property
    def value(self) -> float | None:
        """The smallest level that brought collapse; None where none did."""
        return self.high if math.isfinite(self.high) else None

    def bound(self, unit: float = 1.0) -> str | None:
        """The bound, such as "≤ 0.3", in units of such a size; None where levels on both sides are known."""
        if 0.0 < self.low and math.isfinite(self.high):
            return None
        if math.isfinite(self.high):
            return say("≤ {value:.4g}", value=self.high / unit)
        return say("> {value:.4g}", value=self.low / unit) if self.low > 0.0 else say("not known")


def of_levels(levels: Sequence[float] | np.ndarray, verdicts: Sequence[str]) -> Capacity:
    """Capacity on rising levels; what is undecided or failed below the first collapse may be one, and widens it."""
    high = first_collapse(np.asarray(levels), verdicts)
    low = 0.0
    for level, verdict in zip(levels, verdicts):
        if verdict != STANDS:
            break
        low = float(level)
    return Capacity(low, math.inf if high is None else high)


def quantiles(capacities: Iterable[Capacity], shares: Sequence[float] = SHARES) -> list[Capacity]:
    """Capacities that shares of many do not exceed: between those of their lower ends and those of their upper ones."""
    low, high = np.array(list(capacities), dtype=float).T
    ends = (np.quantile(np.sort(values), shares, method="inverted_cdf") for values in (low, high))
    return [Capacity(float(lower), float(other)) for lower, other in zip(*ends, strict=True)]


def bounds(named: Mapping[str, tuple[Capacity, float]]) -> dict[str, str]:
    """Those of named capacities, each with the size of its unit, of which only a bound is known: the bound by name."""
    named_bounds = {name: capacity.bound(unit) for name, (capacity, unit) in named.items()}
    return {name: bound for name, bound in named_bounds.items() if bound is not None}


#: Exponents of the density of r before anything is counted, (1 − r)³: its mean 0.2 is about that of the counts of other
#: pages, 2, 18 and 0 of 24 (r = 0.5), 4, 10 and 1 of 16 (0.2), and 11 to 19 of 25 (0.05).
ALIKE = 3.0

#: Values of m and r that are looked at.
MEANS, CORRELATIONS = 61, 30

#: Laws of the joints from fewer than which how much they decide is not told.
FEW_LAWS = 4

#: Shares are told by hundredths: limits nearer to none or to all of the columns than that are none, and all.
FINEST = 100


def share_limits(
    verdicts: np.ndarray, groups: Sequence[int], confidence: float = 0.95
) -> tuple[np.ndarray, np.ndarray]:
    """Confidence limits of the probability of collapse over twins of a column, whatever undecided ones come to.

    Parameters
    ----------
    verdicts : array of str, shape (…, twins)
    groups : sequence of int, shape (twins,)
        Law of the joints of each; empty where all have that of the column. Limits are then those of
        :func:`stylobate.verdicts.verdict.collapse_interval`, else they hold those under one more law as well.
    confidence : float
    """
    low, high = collapse_interval(*tally(verdicts, axis=-1), confidence)
    if not len(groups):
        return low, high
    low, high, law = np.array(low), np.array(high), np.eye(max(groups) + 1, dtype=int)[list(groups)]
    kinds = ((COLLAPSED,), (COLLAPSED, UNDECIDED), (COLLAPSED, STANDS, UNDECIDED))
    fell, may, number = (np.isin(verdicts, kind) @ law for kind in kinds)
    for cell in np.ndindex(low.shape):
        low[cell] = min(low[cell], share_under_another_law(fell[cell], number[cell], confidence)[0])
        high[cell] = max(high[cell], share_under_another_law(may[cell], number[cell], confidence)[1])
    return low, high


def under_another_law(values: np.ndarray, samples: int, rng: np.random.Generator) -> np.ndarray:
    """How far what one more law comes to may lie from the mean of a few, drawn so many times.

    Values of laws follow a normal distribution of which nothing else is known, so that one more of G differs from their mean
    by s √(1 + 1/G) times Student's t of G − 1.

    Parameters
    ----------
    values : array, shape (G,)
        Of each law, over the same records; infinite where its runs only tell a bound, NaN where they tell nothing: the draws
        on that side are infinite then, as they are on both of fewer than two.
    samples : int
    rng : numpy.random.Generator

    Returns
    -------
    array, shape (samples,)
    """
    freedom, below, above = _foretold(values)
    draws = rng.standard_t(freedom, samples)
    return draws * np.where(draws > 0.0, above, below)


def limits_under_another_law(values: np.ndarray, confidence: float = 0.95) -> tuple[float, float]:
    """Limits of what one more law comes to: the mean of what is finite, less and more what :func:`under_another_law` draws.

    Parameters
    ----------
    values : array, shape (G,)
        As there.
    confidence : float
    """
    from scipy.special import stdtrit

    freedom, below, above = _foretold(values)
    far, known = float(stdtrit(freedom, 0.5 + 0.5 * confidence)), values[np.isfinite(values)]
    middle = float(known.mean()) if len(known) else 0.0
    return middle - far * below, middle + far * above


def _foretold(values: np.ndarray) -> tuple[int, float, float]:
    """Degrees of freedom of what one more law comes to, and its spread s √(1 + 1/G) to below and to above the mean."""
    known = values[np.isfinite(values)]
    if len(known) < 2:
        return 1, np.inf, np.inf
    spread = float(known.std(ddof=1) * np.sqrt(1.0 + 1.0 / len(known)))
    told_by_none = np.isnan(values).any()
    below, above = (
        np.inf if told_by_none or end.any() else spread for end in (np.isneginf(values), np.isposinf(values))
    )
    return len(known) - 1, below, above


def few_laws(number: int) -> str:
    """Caveat on twins of so few laws; empty where there are enough, or none as one is taken as known."""
    if not 0 < number < FEW_LAWS:
        return ""
    sentence = (
        say("the twins share 1 law of the joints") if number == 1 else say("the twins share {count} laws of the joints")
    )
    more = say(
        ", too few to tell how much it decides: give more replicates, of which every {each} share one, such as {such}"
    )
    return sentence.of(count=number) + more.of(each=PER_LAW, such=FEW_LAWS * PER_LAW)


def share_under_another_law(
    fell: Sequence[int] | np.ndarray, number: Sequence[int] | np.ndarray, confidence: float = 0.95
) -> tuple[float, float]:
    """Limits of the share of columns that collapse under one more law.

    Parameters
    ----------
    fell, number : sequence of int
        Columns that collapsed, and all of them, law by law.
    confidence : float
    """
    return _limits(tuple(sorted(zip(map(int, fell), map(int, number), strict=True))), confidence)


@lru_cache(maxsize=4096)
def _limits(counted: tuple[tuple[int, int], ...], confidence: float) -> tuple[float, float]:
    """The same of laws in any order; cells of a grid and amplitudes of a curve often count alike."""
    from scipy.special import betaln

    k, n = np.array(counted, dtype=float).T
    a, b, before, shares, below_each = _before()
    seen = sum(betaln(a + hits, b + all_ - hits) - betaln(a, b) for hits, all_ in zip(k, n, strict=True))
    weight = np.exp(seen - np.max(seen)) * before
    below = np.tensordot(below_each, weight / weight.sum(), axes=2)
    outside = 0.5 * (1.0 - confidence)
    low = 0.0 if below[0] > outside or not k.sum() else float(np.interp(outside, below, shares))
    high = 1.0 if below[-1] < 1.0 - outside or k.sum() == n.sum() else float(np.interp(1.0 - outside, below, shares))
    return low, high


@lru_cache(maxsize=1)
def _before() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Exponents of the beta distributions over m and r, their weight before anything is counted, and how much of each lies
    below every share that is told."""
    from scipy.special import betainc

    m = (np.arange(MEANS) + 0.5) / MEANS
    r = (np.arange(CORRELATIONS) + 0.5) / CORRELATIONS
    a, b = m[:, None] * (1.0 - r) / r, (1.0 - m[:, None]) * (1.0 - r) / r
    shares = np.arange(1, FINEST) / FINEST
    return a, b, (1.0 - r) ** ALIKE, shares, np.array([betainc(a, b, x) for x in shares])


def caveat(columns: Sequence[Structure], *models: Model) -> str:
    """Caveats before many runs of these columns, or of assemblies, each once; empty where no model gives reason for any.

    In a plane, columns of several round drums leave it by themselves; in space, bodies that strike one another hang on how
    stiff they are, and the wobble of what is round may be damped by nothing.
    """
    return joined(" ", dict.fromkeys(caution for model in models for caution in _cautions(columns, model)))


def _cautions(columns: Sequence[Structure], model: Model) -> list[str]:
    known = model.parameters()
    if not model.is_plane(known):
        return cautions_in_space(columns, known)
    stacks = (column for column in columns if column.stack is not None and column.stack.n > 1)
    return list(filter(None, map(round_in_the_plane, stacks)))[:1]
