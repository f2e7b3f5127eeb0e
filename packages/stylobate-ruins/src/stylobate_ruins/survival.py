"""What the age of a column that still stands says about hazard curves."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stylobate.analysis.fragility_curve import Fragility
from stylobate.analysis.hazard import Hazard
from stylobate.analysis.risk import Risk, risk
from stylobate.errors import InputError, check_all, check_kind, check_range
from stylobate.notebook import Shown

from .poisson import stands


@dataclass(frozen=True, eq=False)
class Survival(Shown):
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
        return stands(np.array([one.rate for one in self.risks]), self.age)

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Its limits, by the interval of the rate."""
        low, high = (np.array([getattr(one, name) for one in self.risks]) for name in ("high", "low"))
        return stands(low, self.age), stands(high, self.age)

    @property
    def likelihood(self) -> np.ndarray:
        """Likelihood of each hazard curve given that the column stands, over the largest one, shape (k,)."""
        exponent = -self.age * np.array([one.rate for one in self.risks])
        return np.exp(exponent - exponent.max())

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate survival``."""
        low, high = self.interval
        likelihood = self.likelihood
        return {
            "age_y": self.age,
            "survival_probability": {
                one.hazard.name: float(p) for one, p in zip(self.risks, self.probability, strict=True)
            },
            "hazards": [
                {
                    "hazard": one.hazard.name,
                    "hazard_statistic": one.hazard.statistic or None,
                    "annual_rate": one.rate,
                    "return_period_y": 1.0 / one.rate if one.rate > 0.0 else None,
                    "survival_probability": float(self.probability[k]),
                    "survival_probability_low": float(low[k]),
                    "survival_probability_high": float(high[k]),
                    "relative_likelihood": float(likelihood[k]),
                    "weight": float(likelihood[k] / likelihood.sum()),
                }
                for k, one in enumerate(self.risks)
            ],
            "state": self.risks[0].fragility.evidence.state,
            "warnings": list(dict.fromkeys(text for one in self.risks for text in one.warnings)),
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
    names = [one.name for one in hazards]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(
            f"two hazard curves are called {twice!r}; results go by their names: give each one of its own."
        )
    return Survival(tuple(risk(fragility, hazard) for hazard in hazards), years)


def parse_age(text: str) -> float:
    """An age as typed, ``2400y`` [y]."""
    found = re.fullmatch(r"\s*([0-9.eE+-]+)\s*(y|yr|a|years?)\s*", text)
    try:
        value = float(found[1]) if found else math.nan
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise InputError(f"age {text!r} cannot be read; write it in years, such as 2400y.", "age")
    return check_range("age", value, 0.0, 1e6, unit="years", open_low=True)
