"""What a free motion shows of losses without knowing its phase: swings of a rocking body, and how fast a wobble dies.

A body that rocks in a plane turns about one edge, then about the other. At the extreme of a swing, of tilt θ, it stands
still and its energy over that at rest is m g R [cos(α − θ) − cos α]. The impact between two extremes leaves the share e²
of it (Housner 1963), so that extremes alone tell e, whatever the time between them:

    e_k = √(V(θ_k+1)/V(θ_k)),   V(θ) = cos(α − θ) − cos α

A body that wobbles has no such instants. How far it leans at most within windows as long as a swing falls as its energy
does.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stylobate.errors import InputError

#: An extreme is that of a parabola through the samples beyond this share of it; with fewer samples than that it is unknown.
NEAR, FEWEST = 0.8, 5

#: Swings count from this multiple of the noise on, and from this share of the largest.
OVER_NOISE, LEAST = 5.0, 0.02

#: Averages of a wobble's lean in each of its windows.
BINS = 20


class Swings(NamedTuple):
    """Extremes of a body that rocks, one for each time it leans to one side.

    Parameters
    ----------
    times : array
        [s]
    tilts : array
        Positive [rad].
    errors : array
        Standard deviations of the tilts by noise [rad].
    """

    times: np.ndarray
    tilts: np.ndarray
    errors: np.ndarray


def swings(time: np.ndarray, tilt: np.ndarray, noise: float = 0.0) -> Swings:
    """Extremes of a tilt that goes to and fro, as long as it does so for enough samples.

    Parameters
    ----------
    time : array
        [s]
    tilt : array
        To either side [rad].
    noise : float
        Its standard deviation [rad].
    """
    peaks = []
    for number, side in enumerate(sides_of(tilt, noise)):
        inside = slice(side[0], side[-1] + 1)
        size = np.abs(tilt[inside])
        top = int(np.argmax(size))
        near = side[0] + np.flatnonzero(size > NEAR * size[top])
        if len(near) < FEWEST or side[0] + top >= len(tilt) - 2:  # too fast for its samples, or cut off
            break
        peak, error, at = _vertex(time[near], np.abs(tilt[near]), noise)
        if number or time[0] - 2.0 * (time[1] - time[0]) <= at:  # else it came down before the first sample
            peaks.append((at, peak, error))
    return Swings(*np.array(peaks).reshape(-1, 3).T)


def sides_of(tilt: np.ndarray, noise: float) -> list[np.ndarray]:
    """Samples of each time that a tilt goes to one side, beyond its noise and a small share of its largest."""
    size = np.abs(tilt)
    beyond = np.flatnonzero(size > max(OVER_NOISE * noise, LEAST * float(size.max())))
    if not len(beyond):
        return []
    return np.split(beyond, np.flatnonzero(np.diff(np.sign(tilt[beyond]))) + 1)


def _vertex(time: np.ndarray, values: np.ndarray, noise: float) -> tuple[float, float, float]:
    """Largest value of the parabola through some samples, its standard deviation, and its time [s]."""
    middle, half = 0.5 * (time[0] + time[-1]), 0.5 * (time[-1] - time[0])
    matrix = np.vander((time - middle) / half, 3, increasing=True)
    coefficients = np.linalg.lstsq(matrix, values, rcond=None)[0]
    at = -0.5 * coefficients[1] / coefficients[2] if coefficients[2] < 0.0 else 0.0
    row = np.array([1.0, at, at * at])
    error = noise * float(np.sqrt(row @ np.linalg.solve(matrix.T @ matrix, row)))
    return float(row @ coefficients), error, middle + half * at


def height(tilt: np.ndarray, slenderness: float) -> np.ndarray:
    """Rise of the centroid over its distance from the edge [-]: V."""
    return np.cos(slenderness - tilt) - np.cos(slenderness)


def kept(peaks: Swings, slenderness: float) -> tuple[np.ndarray, np.ndarray]:
    """Logarithm of the restitution of every impact between two extremes, and the covariance of that by noise."""
    rise = height(peaks.tilts, slenderness)
    logs = 0.5 * np.log(rise)
    variance = (0.5 * np.sin(slenderness - peaks.tilts) / rise * peaks.errors) ** 2
    return np.diff(logs), of_increments(variance)


def of_increments(variance: np.ndarray) -> np.ndarray:
    """Covariance of the differences of neighbours, whose errors are independent."""
    between = -np.diag(variance[1:-1], 1)
    return np.diag(variance[:-1] + variance[1:]) + between + between.T


def kept_at(tilts: np.ndarray, time: np.ndarray, tilt: np.ndarray, slenderness: float) -> np.ndarray:
    """Logarithm of the restitution of impacts after extremes of some tilts, from a motion that swings down through them.

    Not a number where the motion does not swing.
    """
    peaks = swings(time, tilt)
    if len(peaks.tilts) < 2:
        return np.full(len(tilts), np.nan)
    logs, _ = kept(peaks, slenderness)
    order = np.argsort(peaks.tilts[:-1])
    return np.interp(tilts, peaks.tilts[:-1][order], logs[order])


class Wobble(NamedTuple):
    """How a wobble begins, as one that is let go, or is at the extreme of a swing, does.

    Parameters
    ----------
    time : float
        [s]
    tilt, azimuth : float
        [rad]
    rate : float
        At which its direction turns, from x towards y [rad/s].
    error : float
        Standard deviation of the rate by noise [rad/s].
    """

    time: float
    tilt: float
    azimuth: float
    rate: float
    error: float


def beginning(time: np.ndarray, lean: np.ndarray, noise: float) -> Wobble:
    """How the motion begins that leans towards x and y, shape (samples, 2) [rad].

    From rest at an extreme a lean goes as A (1 − a t²/2): the time until 0.95 A is that from there to 0.8 A. What comes
    before, as while it is held, does not matter.

    Raises
    ------
    InputError
        It has no such extreme, or too few samples there.
    """
    size = np.hypot(*lean.T)
    highest = np.maximum.accumulate(size)
    falls = np.flatnonzero(size < 0.8 * highest)
    if not len(falls) or not falls[0]:
        raise InputError("the lean does not fall to 0.8 of its first extreme; give the history from the release on.")
    below = int(falls[0])
    tilt = highest[below]
    last = int(np.flatnonzero(size[:below] >= 0.95 * tilt)[-1])
    near = np.arange(max(0, 2 * last - below), last + 1)
    if len(near) < FEWEST:
        raise InputError(
            f"{len(near)} samples lie near the first extreme at {time[last]:.4g} s; {FEWEST} are needed: give a history "
            "with a shorter step."
        )
    turned = np.unwrap(np.arctan2(lean[near, 1], lean[near, 0]))
    since = time[near] - time[near[0]]
    rate, azimuth = np.polyfit(since, turned, 1)
    tilt = float(np.sort(size[near])[-max(1, len(near) // 4) :].mean())
    error = noise / tilt / float(np.sqrt(((since - since.mean()) ** 2).sum()))
    return Wobble(float(time[near[0]]), tilt, float(azimuth), float(rate), error)


def envelope(begin: float, time: np.ndarray, lean: np.ndarray, edges: np.ndarray, least: float) -> np.ndarray:
    """Logarithm of the largest lean in windows after a motion's beginning, each as long as a swing at least.

    Parameters
    ----------
    begin : float
        [s]
    time, lean : array
        [s], and how far it leans [rad].
    edges : array
        Of the windows, from the beginning on [s].
    least : float
        Lean below which it counts as this one [rad].
    """
    within = np.arange(BINS * (len(edges) - 1) + 1) / BINS
    bins = np.searchsorted(time - begin, np.interp(within, np.arange(len(edges)), edges))
    sums = np.concatenate(([0.0], np.cumsum(lean)))[np.minimum(bins, len(lean))]
    counts = np.diff(bins)
    means = np.divide(np.diff(sums), counts, out=np.zeros(len(counts)), where=counts > 0)
    return np.log(np.maximum(means.reshape(-1, BINS).max(axis=1), least))
