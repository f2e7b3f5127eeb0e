"""What stands has outlasted all other shaking since a date: draws of a table weighed by a hazard curve.

Earthquakes of the site are a Poisson process, as frequent as the hazard curve says and otherwise like the draws. One of
them, θ in the year t, has left what is seen; all others, since the year t₀ and until today T, have left it as it was. The
density of such a history is

    Λ(θ) p(seen | θ) exp[−(t − t₀) μ₀ − (T − t) μ₁]

with Λ the rate of θ, μ₀ the rate of what would have felled any of the structures while all stood, and μ₁ that of what would
have felled, or moved farther than is seen, what stands today. For a rock of known age, and no earthquake to be told, the
exponential is the rule of Anderson and Brune (1999), who reject hazard under which a rock would hardly stand any more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from stylobate.errors import InputError
from stylobate.probability.risk import Hazard, read_hazard

from . import abc
from .answers import VECTORS, plan
from .ruin import Fact
from .simulations import FELL, STANDS, Simulations
from .survival import Outlasted

#: Parameter that the intensity of a hazard curve is, by its unit, and what such a curve is of.
MEASURES = {"m/s": ("pgv_m_s", "PGV"), "g": ("pga_g", "PGA")}

#: Share of the weakest draws that may change what stands: what is weaker still is in no draw.
WEAKEST = 0.05

#: Standard deviations by which a joint is moved farther than is seen.
FARTHER = 2.0

#: Chance of survival below which hazard and survival do not go together.
CHANCE = 0.05


@dataclass(frozen=True, eq=False)
class Outlasting:
    """What survival says.

    Parameters
    ----------
    hazard : Hazard
    weights : array
        Of the draws, of mean 1, shape (draws,).
    rates : array
        How often a year each draw comes [1/y], shape (draws,).
    chance : float
        Probability that no other shaking than the earthquake has changed what stands.
    since : array
        First year, 5, 50 and 95 %, shape (3,).
    year : array
        Of the earthquake, 5, 50 and 95 %, given that it has been outlasted, shape (3,).
    until : float
    """

    hazard: Hazard
    weights: np.ndarray
    rates: np.ndarray
    chance: float
    since: np.ndarray
    year: np.ndarray
    until: float

    @property
    def label(self) -> str:
        """As an observation."""
        return f"survival since {self.since[1]:.0f}"

    @property
    def odd(self) -> bool:
        """Whether by this hazard it should not stand any more."""
        return self.chance < CHANCE

    def sentence(self, which: np.ndarray) -> str:
        """In words; ``which`` are the draws that leave what is seen."""
        low, middle, high = self.year
        often, doubt = float(self.rates[which].sum()), self.hazard.doubt()
        dated = f"; the earthquake was in the year {middle:.0f}, {low:.0f} to {high:.0f}" if high - low >= 1.0 else ""
        return (
            f"By {self.hazard.called} what stands outlasts all other shaking from {self.since[1]:.0f} to {self.until:.0f} "
            f"with a chance of {self.chance:.2g}, and earthquakes of the prior that leave what is seen come once in "
            f"{1.0 / often:,.3g} years{dated}." + f" Mind that {doubt}." * bool(doubt)
        )

    def summary(self, which: np.ndarray) -> dict[str, Any]:
        """Plain values."""
        names = ("low", "median", "high")
        return {
            "hazard": self.hazard.name,
            "hazard_statistic": self.hazard.statistic or None,
            "chance": self.chance,
            "annual_rate_of_such_earthquakes": float(self.rates[which].sum()),
            "since": dict(zip(names, self.since.tolist(), strict=True)),
            "earthquake": dict(zip(names, self.year.tolist(), strict=True)),
            "until": self.until,
        }


def outlasting(table: Simulations, facts: list[Fact], survival: Outlasted, hazard: Hazard, seed: int) -> Outlasting:
    """Weigh the draws of a table by survival.

    Raises
    ------
    InputError
        The weakest draws already change what stands.
    """
    rates = rates_of(table.parameters[MEASURES[hazard.unit][0]], hazard)
    before, after = changes(table, facts)
    _refuse_weak(table, hazard, rates, before | after)
    dates = survival.dates(seed)
    years = np.stack((dates[:, 1] - dates[:, 0], survival.until - dates[:, 1]))  # before and after the earthquake
    unknown = np.stack([table.parameters[name] for name in ("law", "stiffness_damping_s")], axis=1)
    _, law = np.unique(unknown, axis=0, return_inverse=True)
    counts = np.bincount(law)
    share = [
        np.bincount(law, rates * changed) / np.maximum(np.bincount(law, rates), 1e-300) for changed in (before, after)
    ]
    mu = rates.sum() * np.array(share)  # [1/y], shape (2, laws): all earthquakes shake columns of the same law
    logs = -np.einsum("gl,gd->ld", mu, years)
    lasts = np.exp(logs - logs.max())
    weights = rates * lasts.mean(axis=1)[law]
    at = np.average(lasts, axis=0, weights=counts)
    return Outlasting(
        hazard,
        weights / weights.mean(),
        rates,
        float(np.exp(logs.max()) * at.mean()),
        np.quantile(dates[:, 0], abc.SHARES),
        abc.quantiles(dates[:, 1], at),
        survival.until,
    )


def hazard_of(survival: Outlasted) -> Hazard:
    """The hazard curve.

    Raises
    ------
    InputError
        It cannot be read, or is of something else than PGV and PGA.
    """
    hazard = read_hazard(survival.hazard, survival.site)
    wanted = MEASURES.get(hazard.unit, ("", "PGV or PGA"))[1]
    if hazard.imt.upper() != wanted:
        raise InputError(
            f"{hazard.name} is of {hazard.imt or 'an intensity without a name'}, and survival needs PGV or PGA: call its "
            "column pgv_m_s or pga_g.",
            "hazard",
        )
    hazard.doubt()
    return hazard


def rates_of(sizes: np.ndarray, hazard: Hazard) -> np.ndarray:
    """How often a year each draw comes, by the size of its shaking [1/y], shape (draws,).

    Draws of about the same size share the rate of what is between the ends of their class; there are as many classes as
    draws in each. What is stronger than all draws counts with the strongest of them; what is weaker than all counts nowhere.
    """
    order = np.argsort(sizes, kind="stable")
    classes = np.array_split(order, max(1, int(len(sizes) ** 0.5)))
    least = np.array([hazard.at(float(sizes[members[0]])) for members in classes])
    rates = np.empty(len(sizes))
    for draws, rate in zip(classes, least - np.append(least[1:], 0.0), strict=True):
        rates[draws] = rate / len(draws)
    return rates


def changes(table: Simulations, facts: list[Fact]) -> tuple[np.ndarray, np.ndarray]:
    """Draws that would have changed what stood before the earthquake, and what stands since, shape (draws,) each."""
    before, after = np.zeros((2, len(table)), dtype=bool)
    for fact in facts:
        state = table.final_states[fact.structure]
        stood = state.verdict == STANDS
        if fact.kind == "state":
            before |= state.verdict == FELL
            after |= (state.verdict == FELL) & (fact.value[0] == 0.0)
        elif fact.kind == "body":
            before |= state.fallen[:, fact.joint]
            after |= state.fallen[:, fact.joint] & (fact.value[0] == 0.0)
        elif fact.kind == "no slip above":
            after |= stood & (state.largest > fact.value[0])
        elif fact.kind == "largest":
            after |= stood & (state.largest > fact.value[0] + FARTHER * fact.sd)
        elif fact.kind in VECTORS:
            moved = np.linalg.norm(plan(fact, state), axis=1)
            after |= (stood if fact.kind == "offset" else ~state.fallen[:, fact.joint]) & (
                moved > float(np.linalg.norm(fact.value)) + FARTHER * fact.sd
            )
    return before | after, after


def _refuse_weak(table: Simulations, hazard: Hazard, rates: np.ndarray, changed: np.ndarray) -> None:
    name, peak = MEASURES[hazard.unit]
    counted = np.flatnonzero(rates > 0.0)
    if not len(counted):
        raise InputError(f"no {peak} of the prior is in {hazard.name}; widen one of the two.", "hazard")
    sizes = table.parameters[name][counted]
    weakest = counted[np.argsort(sizes, kind="stable")[: max(1, int(len(rates) ** 0.5))]]
    share = float(changed[weakest].mean())
    if share > WEAKEST:
        raise InputError(
            f"where prior and {hazard.name} begin, at a {peak} of {sizes.min():.2g} {hazard.unit}, {100.0 * share:.0f} of a "
            "hundred simulations change what stands already, and weaker shaking is not counted; begin lower.",
            "prior",
        )
