"""Limits of what two states of a column differ by under the same records, never narrower than what the records can show."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np

from .evidence import DIGITS

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
    for one in np.unique(records):
        y = np.unique(np.round(np.log(im[records == one]), DIGITS))
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
