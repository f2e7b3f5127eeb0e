"""What a free motion says of losses: likelihood of its logarithmic decrements, with a discrepancy that is fitted along.

Decrements d_k = ln(A_k+1/A_k) of what is measured differ from a model's by noise, and by what the model does not know, of an
unknown standard deviation τ. Half of that variance is each decrement's own, and half is common to all of them: what a model
gets wrong it gets wrong at every impact alike, so that more swings do not make it go away.

    d ~ N(d(β, c), Σ + τ² (I + 1 1ᵀ)/2),   p(τ) ∝ 1/τ

Motions are computed for losses drawn evenly, then again about those that do well, each weighed by its likelihood over the
density by which all of its law were drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

#: Discrepancies that are tried, from the least on [-].
DISCREPANCIES = np.geomspace(1.0, 200.0, 24)

#: Losses give decrements like those that were measured, if those differ on average by no more than this.
ALIKE = 0.02

#: Of further draws, those that are made evenly; and the least width of a kernel about an earlier one.
EVENLY, WIDTH = 0.1, 0.02

#: As many draws as are to count, if need be by weighing all of them more alike; with so many no more are made.
COUNTING, ENOUGH = 40.0, 80.0

#: Draws of one law: their unknowns from 0 to 1, shape (draws, unknowns), to their decrements, shape (draws, decrements).
Computed = Callable[[str | None, np.ndarray], np.ndarray]


class Posterior(NamedTuple):
    """What is known of losses afterwards.

    Parameters
    ----------
    laws : array of object
        Law of each draw.
    at : array
        Its unknowns, from 0 to 1, shape (draws, unknowns).
    weights : array
        Their sum is 1.
    discrepancy : float
        τ, its mean [-].
    best : int
        Draw whose decrements are likest the measured ones.
    off : float
        By how much its decrements differ from these on average [-].
    """

    laws: np.ndarray
    at: np.ndarray
    weights: np.ndarray
    discrepancy: float
    best: int
    off: float

    @property
    def reached(self) -> bool:
        """Whether some of the losses give decrements like those that were measured."""
        return self.off < ALIKE

    def share(self, law: str | None) -> float:
        """Of a law."""
        return float(self.weights[self.laws == law].sum())

    def interval(self, unknown: int, confidence: float) -> tuple[float, float]:
        """Limits of an unknown."""
        order = np.argsort(self.at[:, unknown])
        weights = self.weights[order]
        outside = 0.5 * (1.0 - confidence)
        limits = np.interp([outside, 1.0 - outside], np.cumsum(weights) - 0.5 * weights, self.at[order, unknown])
        return float(limits[0]), float(limits[1])

    def likeliest(self) -> tuple[str | None, np.ndarray]:
        """Law and unknowns of the best draw: means of each by itself need not go together."""
        return self.laws[self.best], self.at[self.best]

    def correlation(self) -> float:
        """Of the first two unknowns."""
        covariance = np.cov(self.at[:, :2].T, aweights=self.weights)
        return float(covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]))

    def drawn(self, number: int, seed: int = 0) -> list[tuple[str | None, np.ndarray]]:
        """Law and unknowns of so many draws."""
        places = np.random.default_rng(seed).choice(len(self.weights), number, p=self.weights)
        laws: list[str | None] = self.laws[places].tolist()
        return list(zip(laws, self.at[places], strict=True))


def searched(
    computed: Computed,
    measured: np.ndarray,
    noise: np.ndarray,
    laws: Sequence[str | None],
    unknowns: int,
    draws: tuple[int, int, int],
    least: float,
) -> Posterior:
    """Losses after decrements that were measured; all laws and all values of unknowns alike before.

    Parameters
    ----------
    computed : callable
        Decrements of motions; not a number where there are none.
    measured : array
        Shape (decrements,).
    noise : array
        Covariance of the noise of these.
    laws : sequence
    unknowns : int
    draws : (int, int, int)
        Of each law: even ones at first, those of each further round, and rounds at most.
    least : float
        Discrepancy at least [-].
    """
    from scipy.stats import qmc

    stream = np.random.default_rng(0)
    every, logs, likely, over = [], [], [], []
    for law in laws:
        at = qmc.Halton(unknowns, scramble=False).random(draws[0] + 1)[1:]
        kernels: list[tuple[int, np.ndarray, np.ndarray]] = []
        results = likelihoods(computed(law, at), measured, noise, least)
        number = draws[1]
        for _ in range(draws[2]):
            raw = results[0] - np.log(_density(at, draws[0], kernels))
            weights = alike(raw)
            if _counting(raw) >= ENOUGH:
                break
            spread = np.sqrt(np.maximum(weights @ (at - weights @ at) ** 2, 0.0))
            width = np.maximum(WIDTH, spread * COUNTING ** (-1.0 / (unknowns + 4)))
            centres = at[stream.choice(len(at), number, p=weights)]
            further = centres + width * stream.standard_normal(centres.shape)
            further = 1.0 - np.abs(1.0 - np.abs(further) % 2.0)  # mirrored at both ends
            evenly = stream.random(number) < EVENLY
            further[evenly] = stream.random((int(evenly.sum()), unknowns))
            kernels.append((number, centres, width))
            at = np.vstack((at, further))
            more = likelihoods(computed(law, further), measured, noise, least)
            results = tuple(np.concatenate(both) for both in zip(results, more, strict=True))
        every.append(at)
        logs.append(results[0] - np.log(_density(at, draws[0], kernels)))
        likely.append(results[0])
        over.append(results[1:])
    weights = alike(np.concatenate(logs))
    discrepancies, offs = (np.concatenate(parts) for parts in zip(*over, strict=True))
    names = np.repeat(np.array(laws, dtype=object), [len(at) for at in every])
    best = int(np.concatenate(likely).argmax())
    return Posterior(names, np.vstack(every), weights, float(weights @ discrepancies), best, float(offs[best]))


def likelihoods(
    decrements: np.ndarray, measured: np.ndarray, noise: np.ndarray, least: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Logarithm of the likelihood of each of some computed decrements, their mean discrepancy, and how far they are off.

    The last is the absolute mean of what is left of the measured ones, each by how well it is known.
    """
    number, known = len(measured), np.asarray(np.isfinite(decrements).all(axis=1))
    whole = 0.5 * (np.eye(number) + np.ones((number, number)))
    residuals = measured - np.where(known[:, None], decrements, 0.0)
    sizes = least * DISCREPANCIES
    logs = np.empty((len(sizes), len(residuals)))
    for i, size in enumerate(sizes):
        factor = np.linalg.cholesky(noise + size**2 * whole)
        logs[i] = -0.5 * (np.linalg.solve(factor, residuals.T) ** 2).sum(axis=0) - np.log(np.diag(factor)).sum()
    top = logs.max(axis=0)
    each = np.exp(logs - top)  # discrepancies lie at equal steps of their logarithm
    mean = sizes @ each / each.sum(axis=0)
    best = mean[int(np.where(known, top, -np.inf).argmax())]
    by = np.linalg.solve(noise + best**2 * np.eye(number), np.ones(number))
    off = np.abs(residuals @ by / by.sum())
    return np.where(known, top + np.log(each.sum(axis=0)), -np.inf), mean, off


def alike(logs: np.ndarray) -> np.ndarray:
    """Weights of draws, their sum 1: as their logarithms say, or more alike, so that enough of them count."""
    logs = logs - logs.max()
    target = min(COUNTING, 0.5 * np.isfinite(logs).sum())

    low, high = 0.0, 1.0
    while _counting(logs, high) < target and high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _counting(logs, middle) >= target else (low, middle)
    weights = np.exp(high * logs)
    return weights / weights.sum()


def _counting(logs: np.ndarray, power: float = 1.0) -> float:
    """As how many draws of one weight those with such logarithms of their weights count."""
    weights = np.exp(power * (logs - logs.max()))
    return float(weights.sum() ** 2 / (weights**2).sum())


def _density(at: np.ndarray, first: int, kernels: Sequence[tuple[int, np.ndarray, np.ndarray]]) -> np.ndarray:
    """Density by which all draws of a law were made, at some unknowns."""
    total, all_ = np.full(len(at), float(first)), first
    for number, centres, width in kernels:
        product = np.ones((len(at), len(centres)))
        for i, sigma in enumerate(width):
            x, c = at[:, i, None], centres[:, i]
            product *= sum(np.exp(-0.5 * ((x - mirrored) / sigma) ** 2) for mirrored in (c, -c, 2.0 - c)) / (
                sigma * np.sqrt(2.0 * np.pi)
            )
        total += number * (EVENLY + (1.0 - EVENLY) * product.mean(axis=1))
        all_ += number
    return total / all_
