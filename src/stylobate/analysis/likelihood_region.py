"""Every lognormal fragility that runs leave plausible: the region around their largest likelihood."""

from __future__ import annotations

import math

import numpy as np

from .lognormal import BETAS, log_interval

#: Dispersions between which the region is looked for [-]: beyond them β counts as 0 and as without end.
NARROWEST, WIDEST = BETAS[0], 1000.0

#: Distance below that of known capacities at which ln L may lie: what is known by yes and no only leaves more open. With it
#: the intervals hold what they promise in the simulations of the page on fragility.
LARGER = 1.3

#: Slopes of the first look, of the look at each end, and of the region itself.
_SLOPES, _FINE = 40, 12

#: Steps to a largest value or to a limit, at most.
_STEPS = 50

_LOG_ROOT = 0.5 * np.log(2.0 * np.pi)


def region(
    low: np.ndarray, high: np.ndarray, weight: np.ndarray, records: float, confidence: float = 0.95
) -> np.ndarray:
    """Edge of the region of ln θ and ln β whose ln L, Eq. (G1), is not far below the largest one.

    The range of a quantity over the region is its interval by the profile of the likelihood.

    Parameters
    ----------
    low, high : array, shape (n,)
        Ends of the intervals of ln capacity, as of :func:`stylobate.analysis.lognormal.fit`.
    weight : array, shape (n,)
        How much each of them counts, and the number of records behind them, as of
        :func:`stylobate.analysis.evidence.independent`.
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
        some = np.geomspace(inside, outside, _FINE)
        best, _ = runs.profile(some)
        k = int(np.flatnonzero(best >= target).max(initial=0))
        inside, outside = float(some[k]), float(some[min(k + 1, _FINE - 1)])
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
