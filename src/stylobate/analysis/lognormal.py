"""A lognormal capacity by maximum likelihood from what runs tell about it, each run an interval that holds it.

A run at intensity x that exceeds a state says that the capacity is at most x; one that does not, that it is above; a record
whose runs bracket its capacity gives both ends. With y = ln x the likelihood of all of them is

    L(a, b) = Π [Φ(a + b y_high) − Φ(a + b y_low)]^w ,    θ = exp(−a/b) ,  β = 1/b ,                               (G1)

for runs alone the probit model of Shinozuka et al. (2000) and Baker (2015). ln L is concave in (a, b), so Newton's steps end
in its one maximum; all samples of a bootstrap take them together.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.special import log_ndtr, ndtr, ndtri

#: Dispersions are kept inside these [-]: where the runs below and above do not overlap the best one is 0.
BETAS = (0.01, 10.0)

#: A dispersion so near, as a share, to where the fit ends is at the end [-].
AT_END = 1e-6

#: Newton's steps at most, and the change of ln θ and ln β after which there are none [-].
STEPS, CLOSE = 60, 1e-9

_LOG_ROOT = 0.5 * np.log(2.0 * np.pi)


class Fit(NamedTuple):
    """Lognormal capacities, one per sample.

    Parameters
    ----------
    log_median, beta : array, shape (S,)
        ln θ and β; +inf or −inf where no run, or every one, exceeds the state. β is the least of all where capacities need
        not scatter at all: then θ is the middle of what is known.
    """

    log_median: np.ndarray
    beta: np.ndarray


def fit(low: np.ndarray, high: np.ndarray, weight: np.ndarray | None = None) -> Fit:
    """Fit Eq. (G1).

    Parameters
    ----------
    low, high : array
        Ends of the intervals of ln capacity, −inf and +inf where open, shape (n,), or (S, n) for S samples.
    weight : array, optional
        How often each interval counts, shape (n,) or (S, n); once by default.

    Returns
    -------
    Fit
    """
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    weight = np.ones(low.shape) if weight is None else np.asarray(weight, dtype=float)
    if low.ndim == 1:  # equal intervals are one with the sum of their weights
        pairs, kind = np.unique(np.stack((low, high), axis=1), axis=0, return_inverse=True)
        low, high = pairs.T
        member = np.zeros((kind.size, len(pairs)))
        member[np.arange(kind.size), kind.ravel()] = 1.0
        weight = np.atleast_2d(weight) @ member
    low, high, weight = np.broadcast_arrays(np.atleast_2d(low), np.atleast_2d(high), np.atleast_2d(weight))
    some_above = ((weight > 0.0) & np.isfinite(low)).any(axis=1)
    some_below = ((weight > 0.0) & np.isfinite(high)).any(axis=1)
    log_median = np.where(some_above, np.inf, -np.inf)
    beta = np.full(len(low), np.nan)
    last, first = np.where(weight > 0.0, low, -np.inf).max(axis=1), np.where(weight > 0.0, high, np.inf).min(axis=1)
    apart = some_above & some_below & (last <= first)
    if apart.any():
        beta[apart] = BETAS[0]
        log_median[apart] = _between(low[apart], high[apart], weight[apart], last[apart], first[apart])
    solvable = some_above & some_below & ~apart
    if solvable.any():
        found = _newton(low[solvable], high[solvable], weight[solvable])
        log_median[solvable], beta[solvable] = found
    return Fit(log_median, beta)


def seen(beta: float) -> float | None:
    """β, if runs show one; None where the fit ends at the least of all."""
    return beta if beta > BETAS[0] * (1.0 + AT_END) else None


def falls(found: Fit) -> bool:
    """Whether the likelihood of the first sample wants a curve that does not rise."""
    return bool(found.beta[0] >= BETAS[1] * (1.0 - 1e-6))


def _between(low: np.ndarray, high: np.ndarray, weight: np.ndarray, last: np.ndarray, first: np.ndarray) -> np.ndarray:
    """ln θ where no run contradicts a capacity that is the same for all: the middle between the last run below it and the
    first above; where both are at one intensity, as the share there says.
    """
    hit = np.where(high == first[:, None], weight, 0.0).sum(axis=1)
    missed = np.where(low == last[:, None], weight, 0.0).sum(axis=1)
    return 0.5 * (last + first) - np.where(last < first, 0.0, BETAS[0] * ndtri(hit / (hit + missed)))


def curve(im: np.ndarray, log_median: float, beta: float) -> np.ndarray:
    """Φ(ln(im/θ)/β); 0 and 1 everywhere for medians of +inf and −inf."""
    if math.isinf(log_median):
        return np.full(np.shape(im), 0.0 if log_median > 0.0 else 1.0)
    with np.errstate(divide="ignore"):
        return ndtr((np.log(np.asarray(im, dtype=float)) - log_median) / beta)


def _newton(low: np.ndarray, high: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    inside = np.where(np.isfinite(low) & np.isfinite(high), 0.5 * (low + high), np.where(np.isfinite(low), low, high))
    total = weight.sum(axis=1)
    centre = (weight * inside).sum(axis=1) / total
    spread = np.sqrt((weight * (inside - centre[:, None]) ** 2).sum(axis=1) / total)
    scale = np.clip(spread, 0.05, 2.0)  # the logarithms are counted from their mean, in units of their spread
    u, v = (low - centre[:, None]) / scale[:, None], (high - centre[:, None]) / scale[:, None]
    a, b = np.zeros(len(low)), np.ones(len(low))
    b_low, b_high = scale / BETAS[1], scale / BETAS[0]
    open_ = np.arange(len(a))  # samples that still move
    for _ in range(STEPS):
        a[open_], b[open_], moved = _step(
            a[open_], b[open_], u[open_], v[open_], weight[open_], b_low[open_], b_high[open_]
        )
        open_ = open_[moved > CLOSE]
        if not open_.size:
            break
    return centre - scale * a / b, scale / b


def _step(
    a: np.ndarray, b: np.ndarray, u: np.ndarray, v: np.ndarray, w: np.ndarray, least: np.ndarray, most: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One of Newton's steps, halved until ln L does not fall: new a and b, and how far they moved."""
    likelihood, ga, gb, haa, hab, hbb = _terms(a, b, u, v, w)
    ridge = 1e-12 * (np.abs(haa) + np.abs(hbb)) + 1e-300
    determinant = (haa - ridge) * (hbb - ridge) - hab * hab
    da = -((hbb - ridge) * ga - hab * gb) / determinant
    db = -((haa - ridge) * gb - hab * ga) / determinant
    held = ((b <= least) & (db < 0.0)) | ((b >= most) & (db > 0.0))  # along the edge, a alone moves
    da, db = np.where(held, -ga / (haa - ridge), da), np.where(held, 0.0, db)
    new_a, new_b, todo = a.copy(), b.copy(), np.arange(len(a))
    step = 1.0
    for _ in range(30):
        new_a[todo] = a[todo] + step * da[todo]
        new_b[todo] = np.clip(b[todo] + step * db[todo], least[todo], most[todo])
        then = _terms(new_a[todo], new_b[todo], u[todo], v[todo], w[todo])[0]
        todo = todo[~(then >= likelihood[todo] - 1e-12 * np.abs(likelihood[todo]))]
        step *= 0.5
        if not todo.size:
            break
    new_a[todo], new_b[todo] = a[todo], b[todo]  # the last digit: no better place is found
    return new_a, new_b, np.maximum(np.abs(new_a - a), np.abs(new_b - b) / b)


def _terms(a: np.ndarray, b: np.ndarray, u: np.ndarray, v: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, ...]:
    """ln L of every sample, and its first and second derivatives by a and b."""
    a, b = a[:, None], b[:, None]
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        s, t = a + b * u, a + b * v
        p = log_interval(s, t)
        rs, rt = (np.where(np.isfinite(z), np.exp(-0.5 * z * z - _LOG_ROOT - p), 0.0) for z in (s, t))
    u, v, s, t = (np.where(np.isfinite(one), one, 0.0) for one in (u, v, s, t))
    p = np.where(w > 0.0, np.maximum(p, -1e300), 0.0)
    ea, eb = rt - rs, v * rt - u * rs
    haa = -(t * rt - s * rs) - ea * ea
    hab = -(v * t * rt - u * s * rs) - ea * eb
    hbb = -(v * v * t * rt - u * u * s * rs) - eb * eb
    return tuple((w * one).sum(axis=1) for one in (p, ea, eb, haa, hab, hbb))


def log_interval(s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """ln(Φ(t) − Φ(s)) from the tail in which both are small."""
    flip = s > 0.0
    upper, lower = np.where(flip, -s, t), np.where(flip, -t, s)
    big = log_ndtr(upper)
    return big + np.log(-np.expm1(np.minimum(log_ndtr(lower) - big, -1e-300)))


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
        one = fit(low, high, weight)
        with np.errstate(invalid="ignore"):
            found.append(np.stack((one.log_median, np.log(one.beta)), axis=1))
    values = np.concatenate(found)
    return np.where(np.isnan(values), math.log(BETAS[0]), values)


def correlation(samples: np.ndarray) -> float:
    """Of ln θ and ln β over samples of both, shape (S, 2), that have a curve; none where one of them does not vary [-]."""
    some = samples[np.isfinite(samples).all(axis=1)]
    spread = some.std(axis=0) if len(some) > 2 else np.zeros(2)
    return float(np.corrcoef(some.T)[0, 1]) if (spread > 1e-6).all() else 0.0
