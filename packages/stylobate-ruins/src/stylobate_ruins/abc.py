"""Approximate Bayesian computation with numbers alone: draws of a prior, what each would leave, what is seen.

What a draw leaves comes down to what a regression expects of its parameters (Fearnhead and Prangle 2012). The draws of
which as much is expected as of what is seen are accepted, weighted by the kernel of Epanechnikov, and each is moved by the
difference (Beaumont, Zhang and Balding 2002). Each is expected by a regression on draws of other folds, and what is seen by
the same one: so intervals hold what they should whatever the regression is worth (Barber et al. 2021), and where features
tell nothing of a parameter, its prior stays. A regression on all other draws would not do: their mean falls as the parameter
of the one that is left out rises, and gives it away.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: Shares of a posterior that are told: its median, and the ends of 90 %.
SHARES = (0.05, 0.5, 0.95)

#: Penalties of a regression over the largest squared singular value, of which cross-validation takes one; the last expects
#: the same of all.
PENALTIES = np.array([*np.geomspace(1e-8, 1.0, 25), np.inf])

#: Folds of the draws.
FOLDS = 5

#: Draws are alike whose expectations differ by less, in standard deviations of the prior.
ALIKE = 0.2


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
        Of each from what is seen, shape (accepted,).
    """

    which: np.ndarray
    weights: np.ndarray
    targets: np.ndarray
    distance: np.ndarray

    @property
    def effective(self) -> float:
        """Number of draws of equal weight that say as much."""
        return float(effective(self.weights))


def accepted(
    features: np.ndarray, targets: np.ndarray, seen: np.ndarray, count: int, before: np.ndarray | None = None
) -> Accepted:
    """The draws of which as much is expected as of what is seen, moved to it.

    Parameters
    ----------
    features : array
        Of each draw, shape (draws, features); without features all draws are alike.
    targets : array
        Of each draw, of standard deviation one, shape (draws, targets).
    seen : array
        Features of what is seen, shape (features,).
    count : int
        How many to accept at least.
    before : array, optional
        Weights of the draws before anything is seen, shape (draws,); all alike by default.
    """
    away, fold = np.zeros(targets.shape), np.arange(len(targets)) % FOLDS
    for k in range(FOLDS):
        others, own = fold != k, fold == k
        predictions = expected(features[others], targets[others], np.vstack((features[own], seen)))
        away[own] = predictions[:-1] - predictions[-1]
    return nearest(away, targets - away, count, before)


def nearest(away: np.ndarray, targets: np.ndarray, count: int, before: np.ndarray | None = None) -> Accepted:
    """Draws by their distance from what is seen, of which the nearest count as ``count`` of equal weight, or all are alike.

    Parameters
    ----------
    away, targets : array
        Of each draw, shapes (draws, any number) and (draws, targets).
    count : int
    before : array, optional
        Weights of the draws before anything is seen, shape (draws,); all alike by default.
    """
    before = np.ones(len(targets)) if before is None else before
    distance = np.linalg.norm(away, axis=1)
    order = np.argsort(distance, kind="stable")
    enough = np.cumsum(before[order]) ** 2 > count * np.cumsum(before[order] ** 2)
    last = order[np.argmax(enough) if enough.any() else -1]
    weights = before * np.maximum(0.0, 1.0 - (distance / max(ALIKE, distance[last])) ** 2)  # Epanechnikov
    which = np.flatnonzero(weights)
    return Accepted(which, weights[which] / weights.sum(), targets[which], distance[which])


def expected(features: np.ndarray, targets: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Expectations of targets by a ridge regression whose penalty generalised cross-validation chooses, target by target.

    Parameters
    ----------
    features, targets : array
        Of draws, shapes (draws, features) and (draws, targets).
    at : array
        Features at which they are wanted, shape (points, features).

    Returns
    -------
    array
        Shape (points, targets).
    """
    middle, size, mean = features.mean(axis=0), features.std(axis=0), targets.mean(axis=0)
    size = np.where(size > 1e-12, size, np.inf)
    own, points, off = (features - middle) / size, (at - middle) / size, targets - mean
    squares, along = np.linalg.eigh(own.T @ own)  # singular values of many draws with few features, ten times as quick
    mask = squares > 1e-12 * squares.max(initial=1e-300)
    squares, along = squares[mask], along[:, mask] / np.sqrt(squares[mask])
    onto = along.T @ (own.T @ off)
    kept = squares / (squares + PENALTIES[:, None] * squares.max(initial=1e-300))
    residual = (off**2).sum(axis=0) - (1.0 - (1.0 - kept) ** 2) @ onto**2
    free = np.maximum(1e-12, 1.0 - (1.0 + kept.sum(axis=1)) / len(features))[:, None]
    best = kept[np.argmin(np.where(free > 1e-6, residual / free**2, np.inf), axis=0)].T
    return mean + points @ (along @ (best * onto))


def effective(weights: np.ndarray) -> float:
    """Number of draws of equal weight that say as much as weighted ones (Kish)."""
    return weights.sum() ** 2 / (weights**2).sum()


def quantiles(values: np.ndarray, weights: np.ndarray, shares: tuple[float, ...] = SHARES) -> np.ndarray:
    """Values that one more draw would not exceed with probabilities ``shares``, shape (shares,).

    It is as likely between any two neighbours of a sample as beyond either end (Weibull): few draws give wide intervals.
    """
    order = np.argsort(values, kind="stable")
    each = weights.sum() / effective(weights)
    below = np.cumsum(weights[order]) - 0.5 * weights[order] + 0.5 * each
    return np.interp(shares, below / (weights.sum() + each), values[order])


def spread(values: np.ndarray, weights: np.ndarray) -> float:
    """Standard deviation of a weighted sample."""
    mean = np.average(values, weights=weights)
    return float(np.sqrt(np.average((values - mean) ** 2, weights=weights)))


# -- directions ----------------------------------------------------------------------------------------------------


def vectors(angles: np.ndarray, turn: float) -> np.ndarray:
    """Unit vectors of directions that are the same after ``turn`` [degrees], shape (…, 2)."""
    around = 2.0 * np.pi * np.asarray(angles) / turn
    return np.stack((np.cos(around), np.sin(around)), axis=-1)


def apart(angles: np.ndarray | float, middle: float, turn: float) -> np.ndarray:
    """How far directions are from one of them, the shorter way round [degrees]."""
    return (np.asarray(angles) - middle + 0.5 * turn) % turn - 0.5 * turn


def middle_direction(angles: np.ndarray, weights: np.ndarray, turn: float) -> float:
    """Direction of the mean vector (Mardia and Jupp 2000) [degrees]."""
    x, y = np.average(vectors(angles, turn), axis=0, weights=weights)
    return float(np.arctan2(y, x) * turn / (2.0 * np.pi) % turn)


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
