"""Evidence of runs without a curve: shares of the records over the intensity; and how good a curve through them is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ndtri

from . import lognormal
from .evidence import DIGITS, Evidence, intervals
from .limit_states import EXCEEDED, NOT_EXCEEDED
from .verdicts import wilson_interval

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
        return [dict(zip(names, row)) for row in zip(*(one.tolist() for one in names.values()), strict=True)]


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
    told = codes >= 0
    y = np.exp(np.round(np.log(evidence.im), DIGITS))  # stripes that differ in their last digits are one
    names, owner = np.unique(evidence.records, return_inverse=True)
    levels = np.unique(y[told])
    if len(levels) > MOST_POINTS:
        edges = np.quantile(y[told], np.linspace(0.0, 1.0, 1 + min(8, max(3, len(np.unique(owner[told])) // 5))))
        group, there = (
            np.clip(np.searchsorted(edges, y, side="right") - 1, 0, len(edges) - 2),
            np.ones(len(y), dtype=bool),
        )
    else:
        group = np.minimum(np.searchsorted(levels, y), len(levels) - 1)
        there = levels[group] == y  # no run is decided at another intensity: there is no point
    filled = np.unique(group[told])
    cell = np.searchsorted(filled, group) * len(names) + owner
    there &= np.isin(group, filled)

    def counts(codes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        known, shape = there & (codes >= 0), (len(filled), len(names))
        runs = np.bincount(cell[known], minlength=math.prod(shape)).reshape(shape)
        return runs, np.bincount(cell[known], codes[known] == EXCEEDED, math.prod(shape)).reshape(shape)

    at = np.bincount(group[told], np.log(y[told]))[filled] / np.bincount(group[told])[filled]
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
            one = points_of(evidence, codes, method)
            larger.append(np.abs(one.share - lognormal.curve(one.im, middle, width)).max() >= distance - 1e-9)
    return distance, float(np.mean(larger)) if larger else math.nan
