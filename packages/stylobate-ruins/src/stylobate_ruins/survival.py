"""What the age of a column that still stands says about hazard curves, by events that come as a Poisson process.

The one place of the law of survival, Eq. (G6): of one state, of several of one structure, and of structures that one event
may reach together, Eq. (G8).
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.errors import InputError, as_typed, check_all, check_kind, check_range
from stylobate.notebook import NotebookSummary
from stylobate.probability.fragility import Fragility
from stylobate.probability.risk import Hazard, Risk, risk


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
        avoided = np.broadcast_to(~reached, (len(bits), len(reached))).copy()
        avoided[:, which] = bits.astype(bool)
        rows = (exposed[None] & avoided[:, None]).reshape(-1, len(reached))
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
    total = np.zeros((len(sets), *rates.shape[1:]))
    for structure in np.unique(structures):
        mine = np.flatnonzero(structures == structure)
        chosen = sets[:, mine].reshape(len(sets), len(mine), *(1,) * (rates.ndim - 1))
        total += np.where(chosen, rates[mine], 0.0).max(axis=1)
    return total


# -- What the age of a column that still stands says about hazard curves ----------------------------------------------


@dataclass(frozen=True, eq=False)
class Survival(NotebookSummary):
    """Evidence of the age of a column that still stands on hazard curves.

    Parameters
    ----------
    risks : tuple of Risk
        One per hazard curve.
    age : float
        [y]
    """

    risks: tuple[Risk, ...]
    age: float

    @property
    def probability(self) -> np.ndarray:
        """Probability that the column would still stand, by hazard curve, shape (k,): exp(−λ t)."""
        return stands(np.array([risk.rate for risk in self.risks]), self.age)

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Its limits, by the interval of the rate."""
        low, high = (np.array([getattr(risk, name) for risk in self.risks]) for name in ("high", "low"))
        return stands(low, self.age), stands(high, self.age)

    @property
    def likelihood(self) -> np.ndarray:
        """Likelihood of each hazard curve given that the column stands, over the largest one, shape (k,)."""
        exponent = -self.age * np.array([risk.rate for risk in self.risks])
        return np.exp(exponent - exponent.max())

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate survival``."""
        low, high = self.interval
        likelihood = self.likelihood
        return {
            "age_y": self.age,
            "survival_probability": {
                risk.hazard.name: float(p) for risk, p in zip(self.risks, self.probability, strict=True)
            },
            "hazards": [
                {
                    "hazard": risk.hazard.name,
                    "hazard_statistic": risk.hazard.statistic or None,
                    "annual_rate": risk.rate,
                    "return_period_y": 1.0 / risk.rate if risk.rate > 0.0 else None,
                    "survival_probability": float(self.probability[k]),
                    "survival_probability_low": float(low[k]),
                    "survival_probability_high": float(high[k]),
                    "relative_likelihood": float(likelihood[k]),
                    "weight": float(likelihood[k] / likelihood.sum()),
                }
                for k, risk in enumerate(self.risks)
            ],
            "state": self.risks[0].fragility.evidence.state,
            "warnings": list(dict.fromkeys(text for risk in self.risks for text in risk.warnings)),
        }


def survival(fragility: Fragility, age: float, hazards: Sequence[Hazard]) -> Survival:
    """Evidence of an age about hazard curves.

    Parameters
    ----------
    fragility : Fragility
    age : float
        Years that the column has stood as it is.
    hazards : sequence of Hazard
    """
    check_kind("fragility", fragility, Fragility)
    hazards = check_all("hazards", hazards, Hazard)
    years = check_range("age", age, 0.0, 1e6, unit="years", open_low=True)
    if not hazards:
        raise InputError("no hazard curve is given; give at least one of them.")
    names = [hazard.name for hazard in hazards]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(
            f"two hazard curves are called {twice!r}; results go by their names: give each one of its own."
        )
    return Survival(tuple(risk(fragility, hazard) for hazard in hazards), years)


def parse_age(text: str) -> float:
    """An age as typed, ``2400y`` [y]."""
    match = re.fullmatch(r"\s*([0-9.eE+-]+)\s*(y|yr|a|years?)\s*", text)
    try:
        value = float(match[1]) if match else math.nan
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise InputError(f"age {text!r} cannot be read; write it in years, such as 2400y.", "age")
    return check_range("age", value, 0.0, 1e6, unit="years", open_low=True)


# Survival as an observation: what stands has outlasted all shaking since a date, of which a hazard curve says how often.

#: Years in which something may have been built, shaken and surveyed; those before Christ are negative.
FIRST, LAST = -10_000.0, 3000.0

#: Pairs of dates that are drawn, and the fewest of them that must be in their order.
DATES, FEWEST_IN_ORDER = 4000, 40

#: A date: a year, or the first and the last that it may be.
Year = float | tuple[float, float]


@dataclass(frozen=True)
class Outlasted:
    """What stands today has outlasted all shaking since a date but the earthquake that left it so.

    Parameters
    ----------
    hazard : path
        Hazard curve of PGV or PGA, as ``stylobate risk`` reads it.
    until : float
        Year of the survey.
    since : float or pair of float, optional
        Year from which on it has stood, negative before Christ; of a pair each year between is as likely.
    earthquake : float or pair of float, optional
        Year of the earthquake; by default any since ``since``.
    since_sd, earthquake_sd : float
        Standard deviations of years [y].
    site : pair of float, optional
        Longitude and latitude [degrees], for a hazard file of several sites.

    Raises
    ------
    InputError
        Neither of the dates, a number outside its range, or dates that contradict one another.
    """

    hazard: str | Path
    until: float
    since: Year | None = None
    earthquake: Year | None = None
    since_sd: float = 0.0
    earthquake_sd: float = 0.0
    site: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        check_kind("hazard", self.hazard, (str, Path))
        check_range("until", self.until, FIRST, LAST, unit="(a year)", field="until")
        if self.since is None and self.earthquake is None:
            raise InputError("neither since nor earthquake is given; give at least one of the two years.", "since")
        for name in ("since", "earthquake"):
            given, sd = getattr(self, name), getattr(self, f"{name}_sd")
            pair = isinstance(given, (list, tuple))
            if pair and (len(given) != 2 or not given[0] < given[1]):
                raise InputError(
                    f"`{name}` is {as_typed(list(given))}; allowed are a year, or the first and the last.", name
                )
            for year in () if given is None else given if pair else (given,):
                check_range(f"a year of `{name}`", year, FIRST, LAST, unit="(a year)", field=name)
            check_range(f"`{name}_sd`", sd, 0.0, 5000.0, unit="y", field=f"{name}_sd")
            if sd and (pair or given is None):
                raise InputError(
                    f"{name}_sd is given, and {name} is no single year; leave one of the two out.", f"{name}_sd"
                )
        if self.site is not None and len(self.site) != 2:
            raise InputError("`site` holds longitude and latitude, two numbers.", "site")
        self.dates(0)

    def dates(self, seed: int) -> np.ndarray:
        """Years from which on it has stood, and of the earthquake, drawn in their order, shape (draws, 2)."""
        stream = np.random.default_rng([seed, 3])
        even, normal = stream.random((DATES, 3)), stream.standard_normal((DATES, 2))
        drawn = [
            None if year is None else year[0] + (year[1] - year[0]) * even[:, k] if isinstance(year, (list, tuple))
            else year + sd * normal[:, k]
            for k, (year, sd) in enumerate(((self.since, self.since_sd), (self.earthquake, self.earthquake_sd)))
        ]  # fmt: skip
        built, shaken = drawn
        if shaken is None:
            assert built is not None
            shaken = built + (self.until - built) * even[:, 2]
        built = shaken if built is None else built
        ordered = (built <= shaken) & (shaken <= self.until)
        if ordered.sum() < FEWEST_IN_ORDER:
            raise InputError(
                "the years contradict one another: since comes first, then the earthquake, then until; mend them.",
                "until",
            )
        return np.stack((built, shaken), axis=1)[ordered]
