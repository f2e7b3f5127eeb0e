"""Events that come as a Poisson process: what stands, and which of several states are reached, over years.

The one place of the law of survival, Eq. (G6): of one state, of several of one structure, and of structures that one event
may reach together, Eq. (G8).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: Most states that are seen to be reached: each doubles the sum.
MOST_REACHED = 8


def stands(rate: np.ndarray | float, years: np.ndarray | float) -> np.ndarray:
    """Probability that no event came, exp(−λ t), shapes broadcast.  # Eq. (G6)

    Parameters
    ----------
    rate : array
        How often a year one comes [1/y].
    years : array
        [y]
    """
    return np.exp(-np.asarray(rate) * years)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Which states are reached and which are not, over windows of time that may differ.

    By inclusion and exclusion over the reached states R, with N those not reached: P = Σ (−1)^|S| exp(−Λ(N ∪ S)) over all
    S ⊆ R, where Λ(U) = ∫ rate at time t of events that reach any of U whose window holds t.  # Eq. (G8)

    Parameters
    ----------
    sets : array of bool, shape (m, n)
        Different sets of states whose rates are asked for.
    years : array, shape (s, m)
        For each S, how many years each of these sets is at risk.
    signs : array, shape (s,)
        (−1)^|S|; the first S is empty.
    """

    sets: np.ndarray
    years: np.ndarray
    signs: np.ndarray

    @classmethod
    def of(cls, reached: np.ndarray, begin: np.ndarray, end: np.ndarray) -> Pattern:
        """Pattern of what is seen.

        Parameters
        ----------
        reached : array of bool, shape (n,)
        begin, end : array, shape (n,)
            Of the windows, counted back from today [y]; ``begin`` is the larger one.
        """
        turns = np.unique(np.concatenate((begin, end)))
        middle, lasts = 0.5 * (turns[1:] + turns[:-1]), np.diff(turns)
        exposed = (begin[None] > middle[:, None]) & (end[None] < middle[:, None])
        which = np.flatnonzero(reached)
        bits = (np.arange(2 ** len(which))[:, None] >> np.arange(len(which))) & 1
        asked = np.broadcast_to(~reached, (len(bits), len(reached))).copy()
        asked[:, which] = bits.astype(bool)
        rows = (exposed[None] & asked[:, None]).reshape(-1, len(reached))
        sets, place = np.unique(rows, axis=0, return_inverse=True)
        years = np.zeros((len(bits), len(sets)))
        np.add.at(years, (np.repeat(np.arange(len(bits)), len(lasts)), place.ravel()), np.tile(lasts, len(bits)))
        return cls(sets, years, 1.0 - 2.0 * (bits.sum(axis=1) % 2))

    def probability(self, rate: np.ndarray) -> np.ndarray:
        """Probability of what is seen, of the annual rates of events that reach any state of each set, shape (m, …)."""
        exponent = np.tensordot(self.years, rate, axes=1)
        # every sum of signs is 0 but for one term: differences keep the digits of what is rarely reached
        rest = np.tensordot(self.signs, np.expm1(exponent[:1] - exponent), axes=1)
        return stands(exponent[0], 1.0) * (np.maximum(rest, 0.0) if len(self.signs) > 1 else 1.0)


def together(rates: np.ndarray, sets: np.ndarray, structures: np.ndarray, shared: bool) -> np.ndarray:
    """Rate of events that reach any state of a set, where events are known by their rates alone, shape (m, …).

    Any events that shake several structures make it no less than the largest rate of the set (``shared``: whatever reaches
    the strongest reaches all) and no more than their sum (each has its own).  # Eq. (G9)

    Parameters
    ----------
    rates : array, shape (n, …)
        Of each state [1/y].
    sets : array of bool, shape (m, n)
    structures : array of int, shape (n,)
        Of the states of one structure the one that is reached more often holds the others.
    shared : bool
    """
    if shared:
        structures = np.zeros_like(structures)
    found = np.zeros((len(sets), *rates.shape[1:]))
    for one in np.unique(structures):
        mine = np.flatnonzero(structures == one)
        chosen = sets[:, mine].reshape(len(sets), len(mine), *(1,) * (rates.ndim - 1))
        found += np.where(chosen, rates[mine], 0.0).max(axis=1)
    return found
