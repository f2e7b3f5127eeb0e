"""Approximate Bayesian computation with numbers alone: draws of a prior, what each would leave, what is seen.

Three steps, after Fearnhead and Prangle (2012) and Beaumont, Zhang and Balding (2002): what is seen comes down to as many
numbers as there are parameters, their expectations by a regression; the draws nearest to it are accepted, weighted by the
kernel of Epanechnikov; and each is moved along a local line to where it would be had it left just what is seen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: Shares of a posterior that are told: its median, and the ends of 90 %.
SHARES = (0.05, 0.5, 0.95)

#: Penalties of a regression over the largest squared singular value, of which cross-validation takes one.
PENALTIES = np.geomspace(1e-8, 1.0, 25)


class Scores:
    """Normal scores of a parameter over its prior: whatever its prior is, the scores are standard normal.

    Parameters
    ----------
    values : array
        Draws of the prior, shape (draws,).
    """

    def __init__(self, values: np.ndarray) -> None:
        from scipy.special import ndtri

        self.values, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
        below = np.cumsum(counts) - 0.5 * counts
        self.levels = ndtri(below / len(values))
        self.scores = self.levels[inverse]

    def value(self, scores: np.ndarray) -> np.ndarray:
        """Values of scores, never beyond those of the prior."""
        return np.interp(scores, self.levels, self.values)


@dataclass(frozen=True, eq=False)
class Accepted:
    """Draws that left nearly what is seen.

    Parameters
    ----------
    which : array of int
        Their numbers, shape (accepted,).
    weights : array
        Shape (accepted,), of sum 1.
    targets : array
        Of each, moved to what is seen, shape (accepted, targets).
    distance : array
        Of each from what is seen, in standard deviations of the summaries, shape (accepted,).
    """

    which: np.ndarray
    weights: np.ndarray
    targets: np.ndarray
    distance: np.ndarray

    @property
    def effective(self) -> float:
        """Number of draws of equal weight that say as much (Kish)."""
        return float(1.0 / np.sum(self.weights**2))


def accepted(
    features: np.ndarray, targets: np.ndarray, seen: np.ndarray, count: int, before: np.ndarray | None = None
) -> Accepted:
    """The draws nearest to what is seen, moved to it.

    Parameters
    ----------
    features : array
        Of each draw, shape (draws, features); without features all draws are alike.
    targets : array
        Of each draw, shape (draws, targets).
    seen : array
        Features of what is seen, shape (features,).
    count : int
        How many to accept.
    before : array, optional
        Weights of the draws before anything is seen, shape (draws,); all alike by default.
    """
    told, (at,) = summaries(features, targets, seen[None, :])
    return nearest(told, targets, at, count, before)


def nearest(
    told: np.ndarray, targets: np.ndarray, at: np.ndarray, count: int, before: np.ndarray | None = None
) -> Accepted:
    """The draws whose summaries are nearest to those of what is seen, moved to it; without summaries all of them.

    Parameters
    ----------
    told, targets : array
        Of each draw, shapes (draws, summaries) and (draws, targets).
    at : array
        Summaries of what is seen, shape (summaries,).
    count : int
        How many to accept.
    before : array, optional
        Weights of the draws before anything is seen, shape (draws,); all alike by default.
    """
    draws = len(targets)
    before = np.ones(draws) if before is None else before
    if not told.shape[1]:
        return Accepted(np.arange(draws), before / max(1.0, before.sum()), targets, np.zeros(draws))
    away = told - at
    distance = np.sqrt((away**2).sum(axis=1))
    which = np.argsort(distance, kind="stable")[: min(count + 1, draws)]
    reach = float(distance[which[-1]])
    if len(which) == draws:
        reach *= 1.0 + 1e-9
    which = which[distance[which] < reach] if reach > 0.0 else which
    weights = 1.0 - (distance[which] / reach) ** 2 if reach > 0.0 else np.ones(len(which))  # Epanechnikov
    weights *= before[which]
    weights /= weights.sum()
    return Accepted(which, weights, moved(targets[which], away[which], weights), distance[which])


def summaries(features: np.ndarray, targets: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Expectations of targets at the draws and at further points, over their standard deviations among the draws.

    Parameters
    ----------
    features, targets : array
        Of the draws, shapes (draws, features) and (draws, targets).
    points : array
        Features elsewhere, shape (points, features).

    Returns
    -------
    array, array
        Shapes (draws, summaries) and (points, summaries); without summaries where the features tell nothing.
    """
    draws = len(targets)
    varies = features.std(axis=0) > 1e-12 if features.size and draws > 2 else np.zeros(features.shape[1], dtype=bool)
    if not varies.any():
        return np.zeros((draws, 0)), np.zeros((len(points), 0))
    own, found = expected(features[:, varies], targets, points[:, varies])
    size = own.std(axis=0)
    telling = size > 1e-9 * targets.std(axis=0)
    return own[:, telling] / size[telling], found[:, telling] / size[telling]


def expected(features: np.ndarray, targets: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Expectations of targets by a ridge regression whose penalty generalised cross-validation chooses, target by target.

    Parameters
    ----------
    features, targets : array
        Of the draws, shapes (draws, features) and (draws, targets).
    at : array
        Features at which they are wanted besides, shape (points, features).

    Returns
    -------
    array, array
        Of draws, each by all the others, so that none is foretold better than what is seen, shape (draws, targets); and at
        the points, shape (points, targets).
    """
    middle, size = features.mean(axis=0), features.std(axis=0)
    size = np.where(size > 1e-12, size, np.inf)
    own, mean = (features - middle) / size, targets.mean(axis=0)
    squares, along = np.linalg.eigh(own.T @ own)  # singular values of many draws with few features, ten times as quick
    s = np.sqrt(np.maximum(squares[::-1], 1e-12 * squares[-1]))
    along = along[:, ::-1] / s
    u, points = own @ along, ((at - middle) / size) @ along
    onto, n = u.T @ (targets - mean), len(features)
    others, found = np.empty(targets.shape), np.empty((len(at), targets.shape[1]))
    for k in range(targets.shape[1]):
        total = float(np.sum((targets[:, k] - mean[k]) ** 2))
        best, error = np.zeros(len(s)), np.inf
        for penalty in PENALTIES:
            kept = s**2 / (s**2 + penalty * s[0] ** 2)
            left = total - float(np.sum(onto[:, k] ** 2 * (1.0 - (1.0 - kept) ** 2)))
            score = left / max(1e-12, 1.0 - (1.0 + kept.sum()) / n) ** 2 if kept.sum() + 1.0 < n else np.inf
            if score < error:
                best, error = kept, score
        left = targets[:, k] - mean[k] - u @ (best * onto[:, k])
        others[:, k] = targets[:, k] - left / np.maximum(1e-12, 1.0 - 1.0 / n - u**2 @ best)  # without it (Allen 1974)
        found[:, k] = mean[k] + points @ (best * onto[:, k])
    return others, found


def moved(targets: np.ndarray, away: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Targets of draws, each moved along a local line by as far as it is away from what is seen.

    Parameters
    ----------
    targets, away : array
        Shapes (draws, targets) and (draws, summaries).
    weights : array
        Shape (draws,).
    """
    if len(targets) < 3 * (away.shape[1] + 1):
        return targets
    root = np.sqrt(weights)[:, None]
    line, *_ = np.linalg.lstsq(root * np.column_stack((np.ones(len(away)), away)), root * targets, rcond=1e-6)
    return targets - away @ line[1:]


def quantiles(values: np.ndarray, weights: np.ndarray, shares: tuple[float, ...] = SHARES) -> np.ndarray:
    """Values that shares of a weighted sample do not exceed, linear between the middles of its steps, shape (shares,)."""
    order = np.argsort(values, kind="stable")
    inside = np.cumsum(weights[order]) - 0.5 * weights[order]
    return np.interp(shares, inside / weights.sum(), values[order])


def spread(values: np.ndarray, weights: np.ndarray) -> float:
    """Standard deviation of a weighted sample."""
    mean = np.average(values, weights=weights)
    return float(np.sqrt(np.average((values - mean) ** 2, weights=weights)))


# -- directions ----------------------------------------------------------------------------------------------------


def vectors(angles: np.ndarray, turn: float) -> np.ndarray:
    """Unit vectors of directions that are the same after ``turn`` [degrees], shape (…, 2)."""
    around = 2.0 * np.pi * np.asarray(angles) / turn
    return np.stack((np.cos(around), np.sin(around)), axis=-1)


def angles_of(directions: np.ndarray, turn: float) -> np.ndarray:
    """Directions of vectors, from 0 to ``turn`` [degrees]."""
    return np.arctan2(directions[..., 1], directions[..., 0]) * turn / (2.0 * np.pi) % turn


def apart(angles: np.ndarray | float, middle: float, turn: float) -> np.ndarray:
    """How far directions are from one of them, the shorter way round [degrees]."""
    return (np.asarray(angles) - middle + 0.5 * turn) % turn - 0.5 * turn


def middle_direction(angles: np.ndarray, weights: np.ndarray, turn: float) -> float:
    """Direction of the mean vector (Mardia and Jupp 2000) [degrees]."""
    return float(angles_of(np.average(vectors(angles, turn), axis=0, weights=weights), turn))


def quantiles_around(
    angles: np.ndarray, weights: np.ndarray, turn: float, shares: tuple[float, ...] = SHARES
) -> np.ndarray:
    """Quantiles of directions, counted from their mean direction either way [degrees]; the ends may lie beyond a turn."""
    middle = middle_direction(angles, weights, turn)
    return middle + quantiles(apart(angles, middle, turn), weights, shares)


def spread_around(angles: np.ndarray, weights: np.ndarray, turn: float) -> float:
    """Root of the mean square of the distances of directions from their mean direction [degrees]."""
    away = apart(angles, middle_direction(angles, weights, turn), turn)
    return float(np.sqrt(np.average(away**2, weights=weights)))


# -- a likelihood instead ------------------------------------------------------------------------------------------


def likelihood_weights(told: np.ndarray, at: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Weights of draws by a synthetic likelihood (Wood 2010): what they leave is Gaussian about a quadratic in the targets.

    Parameters
    ----------
    told : array
        Summaries of the draws, shape (draws, summaries).
    at : array
        Of what is seen, shape (summaries,).
    targets : array
        Shape (draws, targets).

    Returns
    -------
    array
        Shape (draws,), of sum 1.
    """
    n = targets.shape[1]
    squares = [targets[:, i] * targets[:, j] for i in range(n) for j in range(i, n)]
    design = np.column_stack((np.ones(len(targets)), targets, *squares))
    line, *_ = np.linalg.lstsq(design, told, rcond=1e-8)
    left = told - design @ line
    covariance = left.T @ left / max(1, len(left) - design.shape[1]) + 1e-9 * np.eye(told.shape[1])
    off = at - design @ line
    logs = -0.5 * np.einsum("ki,ij,kj->k", off, np.linalg.inv(covariance), off)
    weights = np.exp(logs - logs.max())
    return weights / weights.sum()
