"""Fragility: the probability that a limit state is exceeded, over an intensity of the shaking, and how sure it is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from ..errors import InputError
from . import lognormal
from .evidence import Evidence
from .limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN
from .verdicts import wilson_interval

#: Fewest records of which a fragility is made: fewer say nothing about the next earthquake.
FEWEST = 10

#: Samples of the bootstrap, and sets of runs drawn from the curve to tell how good its fit is.
SAMPLES, SETS = 1000, 200

#: Intensities told apart by the points behind the curve; more of them are put together.
MOST_POINTS = 12


@dataclass(frozen=True, eq=False)
class Points:
    """Shares of the records that exceed the state, without a curve.

    Parameters
    ----------
    im, share, low, high : array, shape (k,)
        Intensity, share, and its Wilson interval; how often a record counts does not hang on how many runs it has.
    records : array of int, shape (k,)
    """

    im: np.ndarray
    share: np.ndarray
    low: np.ndarray
    high: np.ndarray
    records: np.ndarray


@dataclass(frozen=True, eq=False)
class Fragility:
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
    extremes : (Fit, Fit)
        Of all runs, open and failed ones counted as exceeded, and as not exceeded.
    points : Points
    distance, p_value : float
        Largest distance between the points and the curve [-], and the share of sets of runs drawn from the curve that have
        a larger one.
    confidence : float
    """

    evidence: Evidence
    method: str
    log_median: float
    beta: float
    samples: np.ndarray
    extremes: tuple[tuple[float, float], tuple[float, float]]
    points: Points
    distance: float
    p_value: float
    confidence: float

    @property
    def median(self) -> float:
        """θ, in the unit of the measure."""
        return math.exp(self.log_median)

    @property
    def records(self) -> int:
        """Number of records."""
        return len(np.unique(self.evidence.records))

    def probability(self, im: np.ndarray) -> np.ndarray:
        """Probability of exceedance given the intensity, shape of ``im``."""
        return curve(im, self.log_median, self.beta)

    def interval(self, im: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Confidence limits of :meth:`probability`, point by point: the quantiles of the samples' curves."""
        found = np.array([curve(im, m, math.exp(s)) for m, s in self.samples])
        share = self._share
        low, high = np.quantile(found, [share, 1.0 - share], axis=0)
        return low, high

    @property
    def median_interval(self) -> tuple[float, float]:
        """Confidence limits of θ."""
        low, high = self.limits(np.array(self.log_median), self.samples[:, 0])
        return float(np.exp(low)), float(np.exp(high))

    @property
    def beta_interval(self) -> tuple[float, float]:
        """Confidence limits of β."""
        low, high = self.limits(np.array(math.log(self.beta)), self.samples[:, 1])
        return float(np.exp(low)), float(np.exp(high))

    def limits(self, best: Any, samples: np.ndarray) -> tuple[Any, Any]:
        """Confidence limits of a quantity from its value and those of the samples, along the first axis.  # Eq. (G3)

        The basic bootstrap, its quantiles widened as Student's t is against the normal distribution.
        """
        share = self._share
        low, high = np.quantile(samples, [share, 1.0 - share], axis=0, method="nearest")
        return 2.0 * best - high, 2.0 * best - low

    @property
    def _share(self) -> float:
        from scipy.stats import t

        n = self.records
        return float(ndtr(math.sqrt(n / (n - 1.0)) * t.ppf(0.5 - 0.5 * self.confidence, n - 1)))

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate fragility``."""
        e = self.evidence
        (high_median, high_beta), (low_median, low_beta) = self.extremes
        return {
            "median": self.median,
            "median_low": self.median_interval[0],
            "median_high": self.median_interval[1],
            "beta": self.beta,
            "beta_low": self.beta_interval[0],
            "beta_high": self.beta_interval[1],
            "im": e.measure,
            "unit": e.unit,
            "state": e.state,
            "name": e.name,
            "method": self.method,
            "records": self.records,
            "runs": len(e.im),
            "exceeded": e.count(EXCEEDED),
            "undecided": e.count(OPEN),
            "failed": e.count(FAILED),
            "confidence": self.confidence,
            "if_open_exceed": {"median": math.exp(high_median), "beta": high_beta},
            "if_open_do_not": {"median": math.exp(low_median), "beta": low_beta},
            "largest_distance": self.distance,
            "p_value": self.p_value,
            "points": [
                {"im": x, "share": s, "low": a, "high": b, "records": n}
                for x, s, a, b, n in zip(*(one.tolist() for one in vars(self.points).values()), strict=True)
            ],
        }


def curve(im: np.ndarray, log_median: float, beta: float) -> np.ndarray:
    """Φ(ln(im/θ)/β); 0 and 1 everywhere for medians of +inf and −inf."""
    if math.isinf(log_median):
        return np.full(np.shape(im), 0.0 if log_median > 0.0 else 1.0)
    with np.errstate(divide="ignore"):
        return ndtr((np.log(np.asarray(im, dtype=float)) - log_median) / beta)


def fragility(
    evidence: Evidence,
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
    evidence : Evidence
    method : str, optional
        ``runs`` or ``records``, see :class:`Fragility`; ``records`` for an IDA by default, else ``runs``.
    samples : int
        Of the bootstrap.
    seed : int
    confidence : float
    records_are_one : bool
        Runs of few records count as if each had a record of its own: the curve is then that of these records.

    Returns
    -------
    Fragility

    Raises
    ------
    InputError
        Fewer than ten records, or no run that exceeds the state, or none that does not.
    """
    clusters = np.arange(len(evidence.im)).astype(str).astype(object) if records_are_one else evidence.records
    count = len(np.unique(clusters))
    if count < FEWEST:
        what = ("run" if records_are_one else "record") + ("" if count == 1 else "s")
        remedy = f"give at least {FEWEST}" if records_are_one else (
            f"give at least {FEWEST}, or say --records-are-one to take every run for a record of its own"
        )  # fmt: skip
        raise InputError(f"a fragility of {count} {what} says nothing about the next earthquake; {remedy}.")
    how = method or ("records" if evidence.brackets and not records_are_one else "runs")
    used = Evidence(clusters, *(getattr(evidence, one) for one in _REST))
    codes = evidence.codes
    low, high, owner = intervals(used, codes, how)
    best = lognormal.fit(low, high)
    if math.isinf(best.log_median[0]):
        every = "every run exceeds" if best.log_median[0] < 0.0 else "no run exceeds"
        raise InputError(
            f"{every} {evidence.state}, so that no curve can be drawn; give {'smaller' if 'every' in every else 'larger'} "
            "intensities."
        )
    rng = np.random.default_rng(seed)
    extremes = []
    for counted in (EXCEEDED, NOT_EXCEEDED):
        ends = intervals(used, np.where(codes < 0, counted, codes), how)
        one = lognormal.fit(*ends[:2])
        extremes.append((float(one.log_median[0]), float(one.beta[0])))
    points = _points(used, codes, how)
    log_median, beta = float(best.log_median[0]), float(best.beta[0])
    distance, p_value = _goodness(used, how, points, log_median, beta, rng)
    return Fragility(
        used, how, log_median, beta, bootstrap(low, high, owner, samples, rng), (extremes[0], extremes[1]), points,
        distance, p_value, confidence,
    )  # fmt: skip


_REST = ("im", "codes", "measure", "unit", "state", "name", "brackets")


def intervals(evidence: Evidence, codes: np.ndarray, method: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals of ln capacity that the runs say, as of :func:`lognormal.fit`, and the number of each one's record.

    Open and failed runs say nothing.
    """
    y = np.log(evidence.im)
    names, owner = np.unique(evidence.records, return_inverse=True)
    if method == "runs":
        told = codes >= 0
        low = np.where(codes[told] == EXCEEDED, -np.inf, y[told])
        return low, np.where(codes[told] == EXCEEDED, y[told], np.inf), owner[told]
    low, high = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    np.minimum.at(high, owner[codes == EXCEEDED], y[codes == EXCEEDED])
    below = (codes == NOT_EXCEEDED) & (y < high[owner])  # above the first that exceeds it stands again: a resurrection
    np.maximum.at(low, owner[below], y[below])
    told = np.isfinite(low) | np.isfinite(high)
    return low[told], high[told], np.arange(len(names))[told]


def bootstrap(
    low: np.ndarray, high: np.ndarray, owner: np.ndarray, samples: int, rng: np.random.Generator
) -> np.ndarray:
    """ln θ and ln β of samples of the records, with all that a record says together, shape (samples, 2)."""
    _, owner = np.unique(owner, return_inverse=True)
    count = int(owner.max()) + 1
    found = []
    piece = max(1, 2_000_000 // len(low))
    for begin in range(0, samples, piece):
        weight = rng.multinomial(count, np.full(count, 1.0 / count), min(piece, samples - begin))[:, owner]
        one = lognormal.fit(low, high, weight)
        with np.errstate(invalid="ignore"):
            found.append(np.stack((one.log_median, np.log(one.beta)), axis=1))
    values = np.concatenate(found)
    return np.where(np.isnan(values), math.log(lognormal.BETAS[0]), values)


def _points(evidence: Evidence, codes: np.ndarray, method: str) -> Points:
    if method == "records":
        low, high, _ = intervals(evidence, codes, method)
        at = np.unique(high[np.isfinite(high)])
        at = at[np.unique(np.linspace(0, len(at) - 1, min(MOST_POINTS, len(at))).round().astype(int))]
        known = (high[:, None] <= at) | (low[:, None] >= at)
        passed, trials = (high[:, None] <= at).sum(axis=0).astype(float), known.sum(axis=0)
        return _with_wilson(np.exp(at), passed, trials)
    told = codes >= 0
    y, hit, owner = evidence.im[told], codes[told] == EXCEEDED, evidence.records[told]
    y = np.exp(np.round(np.log(y), 6))  # stripes that differ in their last digits are one
    levels = np.unique(y)
    if len(levels) > MOST_POINTS:
        edges = np.quantile(y, np.linspace(0.0, 1.0, 1 + min(8, max(3, len(np.unique(owner)) // 5))))
        group = np.clip(np.searchsorted(edges, y, side="right") - 1, 0, len(edges) - 2)
    else:
        group = np.searchsorted(levels, y)
    names, owner = np.unique(owner, return_inverse=True)
    cell = group * len(names) + owner
    runs = np.bincount(cell, minlength=(group.max() + 1) * len(names)).reshape(-1, len(names))
    hits = np.bincount(cell, hit, minlength=runs.size).reshape(runs.shape)
    filled = runs.sum(axis=1) > 0
    shares = np.divide(hits, runs, out=np.zeros(runs.shape), where=runs > 0).sum(axis=1)
    at = np.bincount(group, np.log(y)) / np.maximum(runs.sum(axis=1), 1)
    return _with_wilson(np.exp(at[filled]), shares[filled], (runs > 0).sum(axis=1)[filled])


def _with_wilson(at: np.ndarray, passed: np.ndarray, trials: np.ndarray) -> Points:
    low, high = wilson_interval(passed, trials)
    return Points(at, passed / np.maximum(trials, 1), low, high, trials)


def _goodness(
    evidence: Evidence, method: str, points: Points, log_median: float, beta: float, rng: np.random.Generator
) -> tuple[float, float]:
    """Largest distance of the points from the curve, and how often runs drawn from the curve have a larger one.

    Each set gives every record one capacity, drawn from the curve, and fits a curve of its own.
    """
    distance = float(np.abs(points.share - curve(points.im, log_median, beta)).max())
    names, owner = np.unique(evidence.records, return_inverse=True)
    y, told = np.log(evidence.im), evidence.codes >= 0
    drawn = []
    for _ in range(SETS):
        capacity = log_median + beta * ndtri(rng.uniform(size=len(names)))
        drawn.append(np.where(told, (y >= capacity[owner]).astype(np.int8), evidence.codes))
    ends = [intervals(evidence, codes, method)[:2] for codes in drawn]
    own = lognormal.fit(np.array([low for low, _ in ends]), np.array([high for _, high in ends]))
    larger = []
    for codes, middle, width in zip(drawn, own.log_median, own.beta):
        if not math.isinf(middle):
            one = _points(evidence, codes, method)
            larger.append(np.abs(one.share - curve(one.im, middle, width)).max() >= distance)
    return distance, float(np.mean(larger)) if larger else math.nan
