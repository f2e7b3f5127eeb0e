"""Statistics of many tests, measured and computed: shares, medians and distributions, with what their number leaves open.

Single tests of what rocks cannot be foretold; what many of them come to can. A score is within its tolerance where all of
its 95 % interval is, outside where none of it is, and open else.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from stylobate.verdicts.verdict import wilson_interval

#: Samples of a bootstrap over tests, and the fewest tests of one.
SAMPLES, FEWEST = 1000, 10

#: Percentiles between which 95 % lie.
ENDS = (2.5, 97.5)


class Interval(NamedTuple):
    """A number and its 95 % limits."""

    value: float
    low: float
    high: float


def share(values: np.ndarray) -> Interval:
    """Share of ones, with Wilson's interval of as many tests; those of several realisations count as one test.

    Parameters
    ----------
    values : array of 0 and 1
        Shape (tests,) or (tests, realisations).
    """
    each = values.reshape(len(values), -1).mean(axis=1)
    low, high = wilson_interval(each.sum(), len(each))
    return Interval(float(values.mean()), float(low), float(high))


def share_difference(measured: np.ndarray, computed: np.ndarray) -> Interval:
    """Computed share less the measured one; limits of Newcombe 1998, method 10, which two Wilson intervals make.

    The tests are the same for both: where both tend to fall in the same ones, the interval is wider than need be.
    """
    m, c = share(measured), share(computed)
    d = c.value - m.value
    low = d - math.hypot(c.value - c.low, m.high - m.value)
    return Interval(d, low, d + math.hypot(c.high - c.value, m.value - m.low))


def median(values: np.ndarray) -> float:
    """The median of finite or infinite values of any shape."""
    return float(np.quantile(values, 0.5, method="higher"))


def median_ratio(measured: np.ndarray, computed: np.ndarray, seed: int = 1) -> Interval:
    """Median of all computed values over that of the measured ones; limits from a bootstrap over tests.

    With fewer tests than :data:`FEWEST` nothing is known of it. Where more than half are infinite on both sides, NaN.

    Parameters
    ----------
    measured : array
        Shape (tests,).
    computed : array
        Shape (tests, realisations).
    """
    value = _over(median(computed), median(measured))
    if len(measured) < FEWEST:
        return Interval(value, 0.0, math.inf)
    drawn = np.random.default_rng(seed).integers(0, len(measured), (SAMPLES, len(measured)))
    ratios = np.array([_over(median(computed[sample]), median(measured[sample])) for sample in drawn])
    if np.isnan(ratios).any():
        return Interval(value, 0.0, math.inf)
    return Interval(value, float(np.percentile(ratios, ENDS[0], method="lower")), _upper(ratios))


def _over(value: float, other: float) -> float:
    if (math.isinf(value) and math.isinf(other)) or value == other == 0.0:
        return math.nan
    return value / other if other else math.inf


def _upper(values: np.ndarray) -> float:
    return float(np.percentile(values, ENDS[1], method="higher"))


def distance(measured: np.ndarray, computed: np.ndarray) -> Interval:
    """Largest distance of the two empirical distributions (Kolmogorov and Smirnov).

    Of n tests a distribution is known to √(ln(2/α)/2n) with a probability of 1 − α (Massart 1990); here α is 2.5 % for each
    of the two, and the realisations of a test count as one.
    """
    at = np.concatenate((measured, computed.ravel()))
    parts = [
        np.searchsorted(np.sort(values.ravel()), at, side="right") / values.size for values in (measured, computed)
    ]
    d = float(np.abs(parts[1] - parts[0]).max())
    known = 2.0 * math.sqrt(math.log(2.0 / 0.025) / (2.0 * len(measured)))
    return Interval(d, max(0.0, d - known), min(1.0, d + known))


def compared(score: str, measured: np.ndarray, low: np.ndarray, high: np.ndarray) -> dict[str, Any]:
    """A score, its interval, and the same of each realisation alone.

    The interval holds what the number of tests leaves open, the middle 95 % of the realisations, each of which is a column
    that could as well have been tested, and both ways in which undecided runs may end.

    Parameters
    ----------
    score : {"share", "median", "distribution"}
    measured : array
        Shape (tests,).
    low, high : array
        Computed; what undecided runs come to at least and at most, shape (tests, realisations).
    """
    of = {"share": share_difference, "median": median_ratio, "distribution": distance}[score]
    ways = [of(measured, low)] + ([] if np.array_equal(low, high) else [of(measured, high)])
    twins = [_alone(score, measured, bound[:, r]) for bound in (low, high) for r in range(bound.shape[1])]
    known = [twin for twin in twins if not math.isnan(twin)]
    ends = [] if low.shape[1] == 1 or not known else [float(np.percentile(known, ENDS[0], method="lower"))]
    ends += [_upper(np.array(known))] if ends else []
    result: dict[str, Any] = {
        "value": ways[0].value,
        "low": min([interval.low for interval in ways] + ends),
        "high": max([interval.high for interval in ways] + ends),
    }
    for name, values in (("measured", measured), ("computed", low)):
        mine = share(values) if score == "share" else Interval(median(values), math.nan, math.nan)
        result |= {name: mine.value} | (
            {f"{name}_low": mine.low, f"{name}_high": mine.high} if score == "share" else {}
        )
    return result


def _alone(score: str, measured: np.ndarray, twin: np.ndarray) -> float:
    """The score of one realisation."""
    if score == "share":
        return float(twin.mean() - measured.mean())
    return _over(median(twin), median(measured)) if score == "median" else distance(measured, twin[:, None]).value


def verdict(score: str, result: dict[str, Any], tolerance: float) -> str:
    """Whether a score is ``within`` its tolerance, ``outside``, or ``open``."""
    least = {"share": -tolerance, "median": 1.0 / tolerance, "distribution": 0.0}[score]
    if math.isnan(result["value"]):
        return "open"
    if least <= result["low"] and result["high"] <= tolerance:
        return "within"
    return "outside" if result["low"] > tolerance or result["high"] < least else "open"
