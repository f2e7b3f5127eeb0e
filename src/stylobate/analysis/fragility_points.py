"""What runs say without a curve: shares of the records over the intensity; and how good a curve through them is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from . import lognormal
from .evidence import DIGITS, Evidence, intervals
from .limit_states import EXCEEDED
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
        Intensity, share, and its Wilson interval; how often a record counts does not hang on how many runs it has.
    records : array of int, shape (k,)
    """

    im: np.ndarray
    share: np.ndarray
    low: np.ndarray
    high: np.ndarray
    records: np.ndarray


def points_of(evidence: Evidence, codes: np.ndarray, method: str) -> Points:
    """Shares of the records at the intensities that were run, or by groups of them."""
    if method == "records":
        low, high, owner = intervals(evidence, codes, method)
        at = np.unique(high[np.isfinite(high)])
        at = at[np.unique(np.linspace(0, len(at) - 1, min(MOST_POINTS, len(at))).round().astype(int))]
        known = (high[:, None] <= at) | (low[:, None] >= at)
        names, owner = np.unique(owner, return_inverse=True)
        runs, hits = np.zeros((2, len(at), len(names)))
        np.add.at(runs.T, owner, known)
        np.add.at(hits.T, owner, high[:, None] <= at)
        return _of_records(np.exp(at), runs, hits)
    told = codes >= 0
    y, hit, owner = evidence.im[told], codes[told] == EXCEEDED, evidence.records[told]
    y = np.exp(np.round(np.log(y), DIGITS))  # stripes that differ in their last digits are one
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
    at = np.bincount(group, np.log(y)) / np.maximum(runs.sum(axis=1), 1)
    return _of_records(np.exp(at[filled]), runs[filled], hits[filled])


def _of_records(at: np.ndarray, runs: np.ndarray, hits: np.ndarray) -> Points:
    """Points of which is known how many runs of each record there are and exceed the state, shape (k, records)."""
    passed = np.divide(hits, runs, out=np.zeros(runs.shape), where=runs > 0).sum(axis=1)
    trials = (runs > 0).sum(axis=1)
    low, high = wilson_interval(passed, trials)
    return Points(at, passed / np.maximum(trials, 1), low, high, trials)


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
