"""Lognormal fragilities by maximum likelihood, and all that runs leave plausible."""

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
        solution = _newton(low[solvable], high[solvable], weight[solvable])
        log_median[solvable], beta[solvable] = solution
    return Fit(log_median, beta)


def resolved_beta(beta: float) -> float | None:
    """β, if runs show one; None where the fit ends at the least of all."""
    return beta if beta > BETAS[0] * (1.0 + AT_END) else None


def falls(result: Fit) -> bool:
    """Whether the likelihood of the first sample wants a curve that does not rise."""
    return bool(result.beta[0] >= BETAS[1] * (1.0 - 1e-6))


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
    at_edge = ((b <= least) & (db < 0.0)) | ((b >= most) & (db > 0.0))  # along the edge, a alone moves
    da, db = np.where(at_edge, -ga / (haa - ridge), da), np.where(at_edge, 0.0, db)
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
    u, v, s, t = (np.where(np.isfinite(values), values, 0.0) for values in (u, v, s, t))
    p = np.where(w > 0.0, np.maximum(p, -1e300), 0.0)
    ea, eb = rt - rs, v * rt - u * rs
    haa = -(t * rt - s * rs) - ea * ea
    hab = -(v * t * rt - u * s * rs) - ea * eb
    hbb = -(v * v * t * rt - u * u * s * rs) - eb * eb
    return tuple((w * term).sum(axis=1) for term in (p, ea, eb, haa, hab, hbb))


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
    pieces = []
    piece = max(1, 2_000_000 // len(low))
    for begin in range(0, samples, piece):
        weight = rng.multinomial(count, np.full(count, 1.0 / count), min(piece, samples - begin))[:, owner]
        result = fit(low, high, weight)
        with np.errstate(invalid="ignore"):
            pieces.append(np.stack((result.log_median, np.log(result.beta)), axis=1))
    values = np.concatenate(pieces)
    return np.where(np.isnan(values), math.log(BETAS[0]), values)


def correlation(samples: np.ndarray) -> float:
    """Of ln θ and ln β over samples of both, shape (S, 2), that have a curve; none where one of them does not vary [-]."""
    curves = samples[np.isfinite(samples).all(axis=1)]
    spread = curves.std(axis=0) if len(curves) > 2 else np.zeros(2)
    return float(np.corrcoef(curves.T)[0, 1]) if (spread > 1e-6).all() else 0.0


#: Dispersions between which the region is looked for [-]: beyond them β counts as 0 and as without end.
NARROWEST, WIDEST = BETAS[0], 1000.0

#: Distance below that of known capacities at which ln L may lie: what is known by yes and no only leaves more open. With it
#: the intervals hold what they promise in the simulations of the page on fragility.
LARGER = 1.3

#: Slopes of the first look, of the look at each end, and of the region itself.
_SLOPES, _FINE = 40, 12

#: Steps to a largest value or to a limit, at most.
_STEPS = 50


def region(
    low: np.ndarray, high: np.ndarray, weight: np.ndarray, records: float, confidence: float = 0.95
) -> np.ndarray:
    """Edge of the region of ln θ and ln β whose ln L, Eq. (G1), is not far below the largest one.

    The range of a quantity over the region is its interval by the profile of the likelihood.

    Parameters
    ----------
    low, high : array, shape (n,)
        Ends of the intervals of ln capacity, as of :func:`stylobate.probability.lognormal.fit`.
    weight : array, shape (n,)
        How much each of them counts, and the number of records behind them, as of
        :func:`stylobate.probability.evidence.independent`.
    records : float
    confidence : float

    Returns
    -------
    array, shape (k, 2)
        Where the region is open towards no dispersion ln β ends at ln 0.01; towards all of it, at ln 1000.
    """
    from scipy.stats import t

    # of capacities that are known: Student's interval of their mean  # Eq. (G2)
    n = max(records, 2.0)
    drop = 0.5 * n * math.log1p(float(t.ppf(0.5 + 0.5 * confidence, n - 1)) ** 2 / (n - 1))
    runs = _Runs(low, high, weight)
    slopes, target = _slopes(runs, LARGER * drop)
    _, at = runs.profile(slopes)
    sides = [runs.side(slopes, at, target, sign) for sign in (-1.0, 1.0)]
    return np.concatenate([np.stack((-a / slopes, -np.log(slopes)), axis=1) for a in sides])


def dispersions(
    low: np.ndarray, high: np.ndarray, weight: np.ndarray, records: float, confidence: float = 0.95
) -> tuple[float, float]:
    """Limits of β by the profile of the likelihood; 0 and +inf where there are none. Parameters as of :func:`region`."""
    from scipy.stats import chi2

    # of capacities that are known: the upper limit of their standard deviation
    n = max(records, 2.0)
    ratio = float(chi2.ppf(0.5 - 0.5 * confidence, n - 1)) / n
    drop = 0.5 * n * (ratio - 1.0 - math.log(ratio))
    slopes, _ = _slopes(_Runs(low, high, weight), LARGER * drop)
    least, most = 1.0 / slopes.max(), 1.0 / slopes.min()
    return (least if least > NARROWEST * (1.0 + 1e-9) else 0.0), (most if most < WIDEST * (1.0 - 1e-9) else math.inf)


def _slopes(runs: _Runs, drop: float) -> tuple[np.ndarray, float]:
    """Slopes 1/β of the region from end to end, and ln L at its edge."""
    slopes = np.geomspace(1.0 / WIDEST, 1.0 / NARROWEST, _SLOPES)
    best, _ = runs.profile(slopes)
    k = int(np.argmax(best))
    near = np.geomspace(slopes[max(k - 1, 0)], slopes[min(k + 1, _SLOPES - 1)], _SLOPES)
    finer, _ = runs.profile(near)
    slopes, order = np.unique(np.concatenate((slopes, near)), return_index=True)
    best = np.concatenate((best, finer))[order]
    target = float(best.max()) - drop
    inside = np.flatnonzero(best >= target)
    ends = [
        _edge(runs, float(slopes[at]), float(slopes[beyond]), target)
        for at, beyond in ((inside[0], inside[0] - 1), (inside[-1], inside[-1] + 1))
        if 0 <= beyond < len(slopes)
    ]
    return np.unique(np.append(slopes[inside], ends)), target


def _edge(runs: _Runs, inside: float, outside: float, target: float) -> float:
    """The last slope that is inside."""
    for _ in range(3):
        slopes = np.geomspace(inside, outside, _FINE)
        best, _ = runs.profile(slopes)
        k = int(np.flatnonzero(best >= target).max(initial=0))
        inside, outside = float(slopes[k]), float(slopes[min(k + 1, _FINE - 1)])
    return inside


class _Runs:
    """ln L of intervals over a and b."""

    def __init__(self, low: np.ndarray, high: np.ndarray, weight: np.ndarray):
        pairs, kind = np.unique(np.stack((low, high), axis=1), axis=0, return_inverse=True)
        self.low, self.high, self.weight = pairs[:, 0], pairs[:, 1], np.bincount(kind.ravel(), weight)
        ends = pairs[np.isfinite(pairs)]
        self.first, self.last = ends.min(), ends.max()

    def by_a(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """ln L, and its first and second derivative by a, for each a and b, shape (s,)."""
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            s, t = (a[:, None] + b[:, None] * y for y in (self.low, self.high))
            p = log_interval(s, t)
            rs, rt = (np.where(np.isfinite(z), np.exp(-0.5 * z * z - _LOG_ROOT - p), 0.0) for z in (s, t))
            bend = np.where(rt > 0.0, t * rt, 0.0) - np.where(rs > 0.0, s * rs, 0.0) + (rt - rs) ** 2
        return np.maximum(p, -1e300) @ self.weight, (rt - rs) @ self.weight, -bend @ self.weight

    def profile(self, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Largest ln L over a for each b, and that a."""
        left, right = -b * self.last - 9.0, -b * self.first + 9.0
        a = 0.5 * (left + right)
        for _ in range(_STEPS):
            _, slope, bend = self.by_a(a, b)
            left, right = np.where(slope > 0.0, a, left), np.where(slope > 0.0, right, a)
            new = a - slope / np.minimum(bend, -1e-300)
            new = np.where((new > left) & (new < right), new, 0.5 * (left + right))
            done = np.abs(new - a) <= 1e-10 * (1.0 + np.abs(a))
            a = new
            if done.all():
                break
        return self.by_a(a, b)[0], a

    def side(self, b: np.ndarray, a: np.ndarray, target: float, sign: float) -> np.ndarray:
        """The a on one side of the largest ln L at which it has fallen to the target."""
        step = np.ones(len(b))
        for _ in range(60):
            inside = self.by_a(a + sign * step, b)[0] >= target
            if not inside.any():
                break
            step = np.where(inside, 2.0 * step, step)
        near, far = np.zeros(len(b)), step  # inside, and outside
        at = step
        for _ in range(_STEPS):
            value, slope, _ = self.by_a(a + sign * at, b)
            inside = value >= target
            near, far = np.where(inside, at, near), np.where(inside, far, at)
            with np.errstate(divide="ignore", invalid="ignore"):
                new = at - (value - target) / (sign * slope)
            new = np.where((new > near) & (new < far), new, 0.5 * (near + far))
            done = np.abs(new - at) <= 1e-9 * (1.0 + at)
            at = new
            if done.all():
                break
        return a + sign * at
