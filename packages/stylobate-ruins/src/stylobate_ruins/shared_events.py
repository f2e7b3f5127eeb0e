"""Earthquakes that shake several places at once: rates of what they reach there, one by one and together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtr

from stylobate.errors import within

from .ground_motion import GroundMotionModel, Source, alike, events_of, plane

#: Events whose medians differ at no place by more than this count as one [-], in the logarithm.
CELL = 0.1

#: Share of the rate whose events are taken for ones that reach one state at most [-].
NEGLIGIBLE_SHARE = 2e-3


@dataclass(frozen=True, eq=False)
class SharedEvents:
    """Events as places feel them: ln im = μ + τη + φε, η one number for an event, ε alike at places that are near.

    Parameters
    ----------
    rate : array, shape (e,)
        [1/y]
    log_median : array, shape (e, s)
        μ at each place.
    between, within : float
        τ, φ.
    root : array, shape (s, s)
        Of the covariance of τη + φε from place to place: it is ``root @ root.T``.
    """

    rate: np.ndarray
    log_median: np.ndarray
    between: float
    within: float
    root: np.ndarray

    @property
    def spread(self) -> float:
        """Standard deviation of ln im at one place."""
        return float(np.hypot(self.between, self.within))

    @classmethod
    def of(
        cls, sources: Sequence[Source], model: GroundMotionModel, measure: str,
        places: Sequence[tuple[float, float]], vs30: Sequence[float], names: Sequence[str],
    ) -> SharedEvents:  # fmt: skip
        """Events of sources at places.

        Parameters
        ----------
        sources : sequence of Source
        model : GroundMotionModel
        measure : str
            ``pga`` or ``pgv``.
        places : sequence of (float, float)
            Longitude and latitude [degrees].
        vs30 : sequence of float
            [m/s]
        names : sequence of str
            Of the places.

        Raises
        ------
        InputError
            The model does not hold for a magnitude, or as far as a place lies from a source.
        """
        middle = (float(np.mean([one[0] for one in places])), float(np.mean([one[1] for one in places])))
        flat = plane(places, middle)
        rates, medians = [], []
        for source in sources:
            events = events_of(source, middle)
            rates.append(events.rate)
            felt = []
            for place, soil, name in zip(flat, vs30, names, strict=True):
                with within(f"source {source.name!r} at {name!r}"):
                    far = events.distance(place)
                    felt.append(model.log_median(measure, events.magnitude, far, soil, source.mechanism))
            medians.append(np.stack(felt, axis=1))
        rate, median = _gathered(np.concatenate(rates), np.concatenate(medians))
        apart = np.linalg.norm(flat[:, None] - flat[None], axis=2)
        between, inside = model.spread(measure)
        values, vectors = np.linalg.eigh(between**2 + inside**2 * alike(measure, apart))
        return cls(rate, median, between, inside, vectors * np.sqrt(np.maximum(values, 0.0)))

    def curve(self, im: np.ndarray) -> np.ndarray:
        """How often a year intensities are exceeded at each place, shape (s, k)."""
        z = (self.log_median[:, :, None] - np.log(im)) / self.spread
        return np.tensordot(self.rate, ndtr(z), axes=1)

    def each(self, place: np.ndarray, log_median: np.ndarray, beta: np.ndarray) -> np.ndarray:
        """Rate of each state by itself, in closed form, shape (n, k).

        Parameters
        ----------
        place : array of int, shape (n,)
        log_median, beta : array, shape (n, k)
            ln θ and β of the states.
        """
        wide = np.sqrt(beta**2 + self.spread**2)
        return np.array(
            [
                self.rate @ ndtr((self.log_median[:, at, None] - theta) / one)
                for at, theta, one in zip(place, log_median, wide, strict=True)
            ]
        )

    def together(
        self, sets: np.ndarray, structures: np.ndarray, place: np.ndarray, log_median: np.ndarray, beta: np.ndarray,
        each: np.ndarray, normal: np.ndarray,
    ) -> np.ndarray:  # fmt: skip
        """Rate of events that reach any state of each set, shape (m,).

        Σ_e ν_e E[1 − Π_structures (1 − max P(state | im))], the mean over drawn η and ε; what one event reaches twice is
        drawn, what it reaches by itself is exact, and Eq. (G9) bounds it.

        Parameters
        ----------
        sets : array of bool, shape (m, n)
        structures, place : array of int, shape (n,)
        log_median, beta, each : array, shape (n,)
            Of the states; ``each`` as :meth:`each` gives it.
        normal : array, shape (q, s)
            Independent standard normal numbers.
        """
        matter = self._that_matter(place, log_median, beta)
        shaken = self.log_median[matter, None, :] + normal @ self.root.T  # (e, q, s)
        missed = log_ndtr((log_median - shaken[..., place]) / beta).reshape(-1, len(place))
        survived = np.zeros((len(missed), len(sets)))
        for one in np.unique(structures):
            mine = np.flatnonzero(structures == one)
            if len(mine) == 1:
                survived += missed[:, mine] * sets[:, mine].T
            else:
                survived += np.where(sets[None][:, :, mine], missed[:, None, mine], 0.0).min(axis=2)
        reached = -np.expm1(missed) @ sets.T  # the sum of what each reaches, for every set
        twice = (-np.expm1(survived) - reached).reshape(-1, len(normal), len(sets)).mean(axis=1)
        found = sets @ each + self.rate[matter] @ twice
        least = np.where(sets, each, 0.0).max(axis=1)
        return np.clip(found, least, np.maximum(sets @ each, least))

    def _that_matter(self, place: np.ndarray, log_median: np.ndarray, beta: np.ndarray) -> np.ndarray:
        """Events that make all but :data:`LEFT_OUT` of what is reached: of the others nothing is reached twice."""
        z = (self.log_median[:, place] - log_median) / np.hypot(beta, self.spread)
        part = (self.rate[:, None] * ndtr(z)).sum(axis=1)
        order = np.argsort(part)
        return order[np.cumsum(part[order]) > NEGLIGIBLE_SHARE * part.sum()]


def _gathered(rate: np.ndarray, median: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Events that shake all places nearly alike, as one with their mean."""
    _, cell = np.unique(np.round(median / CELL), axis=0, return_inverse=True)
    cell = cell.ravel()
    total = np.bincount(cell, rate)
    mean = np.stack([np.bincount(cell, rate * one) / total for one in median.T], axis=1)
    return total, mean
