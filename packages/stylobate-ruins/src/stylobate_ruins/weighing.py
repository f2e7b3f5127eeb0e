"""Hazard weighed by monuments: what their survival and damage make of the branches of a logic tree, all of them together.

Given the fragilities and the ages, earthquakes come as a Poisson process, and what is seen has the probability of Eq. (G8).
It is averaged over what is not known of fragilities and ages before branches are compared: Eq. (G10).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.special import ndtri

from stylobate.errors import InputError, check_kind, within
from stylobate.messages import percent
from stylobate.notebook import NotebookSummary
from stylobate.probability.risk import Hazard, doubts, rates

from .ground_motion import SharedEvents
from .monuments import Branch, Sites
from .survival import Pattern, together

#: Draws of ages, and of fragilities with each, where events are known by hazard curves and where they are drawn.
DRAWS, DRAWS_OF_EVENTS = (64, 16), (16, 8)

#: Draws of the residuals of each event, with every draw of the fragilities.
RESIDUALS = 16

#: Below this probability of what is seen nothing is weighed: digits are lost, and no branch explains it.
LEAST = 1e-9

#: Bits below which what is seen does not tell branches apart.
SILENT = 0.02

#: Intensities of curves, and fractiles over branches.
INTENSITIES, FRACTILES = 40, (0.05, 0.5, 0.95)

#: Ways in which events may shake sites; the first is what is told, the others bound it.
WAYS = ("as weighed", "each its own", "all shared")


@dataclass(frozen=True, eq=False)
class Weighing(NotebookSummary):
    """Weights of branches before and after what is seen.

    Parameters
    ----------
    sites : Sites
    likelihood : mapping of str to array
        Of what is seen, by branch and draw, shape (b, k), for each of :data:`WAYS`.
    without, alone : mapping of str to array
        By monument: of all else, and of itself, shape (b, k).
    annual_rate : array, shape (n, b)
        Of each state of a monument under each branch, by the best fragility [1/y].
    im : mapping of str to array
        Intensities by site, shape (j,).
    curves : mapping of str to array
        How often a year they are exceeded, by site, shape (b, j) [1/y].
    warnings : tuple of str
    """

    sites: Sites
    likelihood: Mapping[str, np.ndarray]
    without: Mapping[str, np.ndarray]
    alone: Mapping[str, np.ndarray]
    annual_rate: np.ndarray
    im: Mapping[str, np.ndarray]
    curves: Mapping[str, np.ndarray]
    warnings: tuple[str, ...]

    @cached_property
    def prior(self) -> np.ndarray:
        """Weights before, shape (b,)."""
        weight = np.array([branch.weight for branch in self.sites.branches], dtype=float)
        return weight / weight.sum()

    def posterior(self, likelihood: np.ndarray) -> np.ndarray:
        """Weights after, shape (b,), of likelihoods by branch and draw.  # Eq. (G10)"""
        weight = self.prior * likelihood.mean(axis=1)
        return weight / weight.sum() if weight.any() else self.prior

    @cached_property
    def weight(self) -> np.ndarray:
        """Weights after what is seen, shape (b,)."""
        return self.posterior(self.likelihood[WAYS[0]])

    @property
    def weight_error(self) -> np.ndarray:
        """Standard errors of the weights by the number of draws, shape (b,)."""
        pieces = np.array_split(self.likelihood[WAYS[0]], 8, axis=1)
        return np.std([self.posterior(piece) for piece in pieces], axis=0, ddof=1) / np.sqrt(len(pieces))

    @cached_property
    def information(self) -> list[dict[str, Any]]:
        """Bits that each monument tells of the branches: by itself, and beside all others."""
        names = dict.fromkeys(monument.name for monument in self.sites.monuments)
        rows = []
        for name in names:
            seen = "; ".join(monument.words for monument in self.sites.monuments if monument.name == name)
            alone, others = self.posterior(self.alone[name]), self.posterior(self.without[name])
            rows.append(
                {
                    "monument": name,
                    "seen": seen,
                    "bits_alone": bits(alone, self.prior),
                    "bits_beside_others": bits(self.weight, others),
                    "weights_without": others.tolist(),
                }
            )
        return rows

    @property
    def bits(self) -> float:
        """How much all that is seen tells of the branches."""
        return bits(self.weight, self.prior)

    def mean(self, site: str, weight: np.ndarray) -> np.ndarray:
        """Mean hazard curve of a site [1/y], shape (j,)."""
        return weight @ self.curves[site]

    def fractiles(self, site: str, weight: np.ndarray) -> np.ndarray:
        """Fractiles of the rate over branches [1/y], shape (3, j)."""
        order = np.argsort(self.curves[site], axis=0)
        ordered = np.take_along_axis(self.curves[site], order, axis=0)
        below = np.cumsum(weight[order], axis=0)
        at = [(below < share - 1e-12).sum(axis=0).clip(max=len(weight) - 1) for share in FRACTILES]
        return np.array([ordered[index, np.arange(ordered.shape[1])] for index in at])

    def once_in(self, site: str, weight: np.ndarray, period: float = 475.0) -> float | None:
        """Intensity that the mean curve exceeds once in a period of years; None where it is beyond its ends."""
        rate = self.mean(site, weight)
        if not rate[-1] <= 1.0 / period <= rate[0]:
            return None
        return float(np.exp(np.interp(np.log(period), -np.log(rate), np.log(self.im[site]))))

    @property
    def sentence(self) -> str:
        """What the monuments say, in words."""
        number = len(self.information)
        who = f"{number} monuments" if number > 1 else self.information[0]["monument"]
        if len(self.prior) == 1:
            (only,) = self.sites.branches
            chance = self.likelihood[WAYS[0]].mean()
            return f"By {only.name} what is seen of {who} has a probability of {chance:.2g}."
        if self.bits < SILENT:
            return f"What is seen of {who} does not tell the branches apart."
        names = [branch.name for branch in self.sites.branches]
        up, down = int(np.argmax(self.weight - self.prior)), int(np.argmin(self.weight - self.prior))
        text = (
            f"What is seen of {who} speaks for {names[up]} (weight {percent(self.prior[up])} before, "
            f"{percent(self.weight[up])} after) and against {names[down]} ({percent(self.prior[down])}, "
            f"{percent(self.weight[down])})"
        )
        if number > 1:
            most = max(self.information, key=lambda row: row["bits_beside_others"])
            text += f"; {most['monument']} tells most beside the others"
        if not self.sites.branches[0].sources and number > 1:
            shared = self.posterior(self.likelihood[WAYS[2]])[up]
            text += (
                f". Earthquakes are taken as each site's own: did all shake every site, {names[up]} would weigh "
                f"{percent(shared)}"
            )
        return text + "."

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate survival`` of several sites."""
        mean, low, high = (
            np.mean(self.likelihood[WAYS[0]], axis=1),
            *np.quantile(self.likelihood[WAYS[0]], [0.025, 0.975], axis=1),
        )
        own, shared = (self.posterior(self.likelihood[way]) for way in WAYS[1:])
        error = self.weight_error
        return {
            "sentence": self.sentence,
            "bits": self.bits,
            "earthquakes": "from sources, shared" if self.sites.branches[0].sources else "each site its own",
            "hazards": [
                {
                    "hazard": branch.name,
                    "prior_weight": float(self.prior[k]),
                    "weight": float(self.weight[k]),
                    "weight_error": float(error[k]),
                    "weight_if_own": float(own[k]),
                    "weight_if_shared": float(shared[k]),
                    "probability": float(mean[k]),
                    "probability_low": float(low[k]),
                    "probability_high": float(high[k]),
                    "annual_rates": {
                        state.called: float(rate)
                        for state, rate in zip(self.sites.monuments, self.annual_rate[:, k], strict=True)
                    },
                }
                for k, branch in enumerate(self.sites.branches)
            ],
            "monuments": self.information,
            "im": self.sites.monuments[0].capacity.measure,
            "unit": self.sites.monuments[0].capacity.unit,
            "sites": [
                {
                    "site": site,
                    "once_in_475_years_before": self.once_in(site, self.prior),
                    "once_in_475_years": self.once_in(site, self.weight),
                }
                for site in self.im
            ],
            "warnings": list(self.warnings),
        }

    def table(self) -> list[dict[str, Any]]:
        """Hazard curves before and after, a row for each site and intensity."""
        rows = []
        for site, im in self.im.items():
            columns: dict[str, np.ndarray] = {"im": im}
            for when, weight in (("before", self.prior), ("after", self.weight)):
                columns[f"mean_{when}"] = self.mean(site, weight)
                for share, fractile in zip(FRACTILES, self.fractiles(site, weight), strict=True):
                    columns[f"fractile_{100.0 * share:.0f}_{when}"] = fractile
            rows += [{"site": site, **dict(zip(columns, map(float, row)))} for row in zip(*columns.values())]
        return rows


def bits(after: np.ndarray, before: np.ndarray) -> float:
    """Information that turns weights into others, Σ p log₂(p/q)."""
    positive = (after > 0.0) & (before > 0.0)
    return max(float((after[positive] * np.log2(after[positive] / before[positive])).sum()), 0.0)


def weigh(sites: Sites) -> Weighing:
    """Weigh hazards by what is seen of monuments.

    Raises
    ------
    InputError
        Fragilities and hazards do not fit each other, a ground-motion model does not hold, or no branch explains what is
        seen.
    """
    check_kind("sites", sites, Sites)
    states, branches = sites.monuments, sites.branches
    names = list(dict.fromkeys(state.name for state in states))
    used = [site for site in sites.sites if any(state.site == site.name for state in states)]
    structures = np.array([names.index(state.name) for state in states])
    place = np.array([[site.name for site in used].index(state.site) for state in states])
    rng = np.random.default_rng(sites.seed)
    felt = [_events(sites, branch, used) for branch in branches]
    many = DRAWS if felt[0] is None else DRAWS_OF_EVENTS
    ages = _evenly(rng, many[0], 2 * len(names)).reshape(many[0], len(names), 2)
    theta, beta = _capacities(sites, rng, structures, many[0] * many[1])
    each, annual, warnings = _each(sites, felt, place, theta, beta)
    reached = np.array([state.seen == "reached" for state in states])
    everything = np.ones(len(states), bool)
    variants = [
        everything,
        *(structures != k for k in range(len(names))),
        *(structures == k for k in range(len(names))),
    ]
    probabilities = np.empty((len(variants) + 2, len(branches), theta.shape[1]))
    for number, share in enumerate(ages):
        now = slice(number * many[1], (number + 1) * many[1])
        begin, end = sites.windows(share[structures])
        patterns = [_restricted(variant, reached, begin, end) for variant in variants]
        sets, back = np.unique(np.concatenate([pattern.sets for pattern in patterns]), axis=0, return_inverse=True)
        places = np.split(back.ravel(), np.cumsum([len(pattern.sets) for pattern in patterns])[:-1])
        own, shared = (together(each[..., now], sets, structures, how) for how in (False, True))
        rate = own if felt[0] is None else _drawn(felt, sets, structures, place, theta, beta, each, now, rng, len(used))
        for k, (pattern, at) in enumerate(zip(patterns, places, strict=True)):
            probabilities[k, :, now] = pattern.probability(rate[at])
        probabilities[-2, :, now], probabilities[-1, :, now] = (
            patterns[0].probability(bound[places[0]]) for bound in (own, shared)
        )
    if probabilities[0].mean(axis=1).max() < LEAST:
        raise InputError(
            f"no branch gives what is seen a probability above {LEAST:g}: ages, fragilities and hazards do not go together; "
            "check their units and years."
        )
    without, alone = (dict(zip(names, probabilities[begin : begin + len(names)])) for begin in (1, 1 + len(names)))
    im, curves = _curves(sites, felt, [site.name for site in used])
    likelihood: dict[str, np.ndarray] = dict(zip(WAYS, (probabilities[0], probabilities[-2], probabilities[-1])))
    return Weighing(sites, likelihood, without, alone, annual, im, curves, tuple(dict.fromkeys(warnings)))


def _events(sites: Sites, branch: Branch, used: list[Any]) -> SharedEvents | None:
    if branch.model is None:
        return None
    capacity = sites.monuments[0].capacity
    measure, _, component = capacity.measure.partition("@")
    if measure not in branch.model.coefficients or component not in ("", "geomean"):
        raise InputError(
            f"{branch.model.words} tells {' and '.join(branch.model.coefficients)} of the geometric mean, and the "
            f"fragilities are over {capacity.measure}; give fragilities over pgv@geomean or pga@geomean.",
            "im",
        )
    with within(f"branch {branch.name!r}"):
        places = [site.at or (0.0, 0.0) for site in used]
        names, soils = [site.name for site in used], [site.vs30 for site in used]
        return SharedEvents.of(branch.sources, branch.model, measure, places, soils, names)


def _evenly(rng: np.random.Generator, number: int, many: int) -> np.ndarray:
    """Numbers between 0 and 1, one in each of as many equal parts, shape (number, many)."""
    parts = np.tile(np.arange(number)[:, None], (1, many))
    return (rng.permuted(parts, axis=0) + rng.random((number, many))) / number


def _capacities(
    sites: Sites, rng: np.random.Generator, structures: np.ndarray, many: int
) -> tuple[np.ndarray, np.ndarray]:
    """ln θ and β of each state, shape (n, k): states of one monument are weak together."""
    normal = ndtri(_evenly(rng, many, 2 * (structures.max() + 1))).reshape(many, -1, 2)
    drawn = [
        state.capacity.draw(normal[:, structure]) for state, structure in zip(sites.monuments, structures, strict=True)
    ]
    return np.array([theta for theta, _ in drawn]), np.array([beta for _, beta in drawn])


def _restricted(chosen: np.ndarray, reached: np.ndarray, begin: np.ndarray, end: np.ndarray) -> Pattern:
    """Pattern of some of the states alone, its sets of all of them; of none of them it is certain."""
    if not chosen.any():
        return Pattern(np.zeros((1, len(chosen)), bool), np.zeros((1, 1)), np.ones(1))
    pattern = Pattern.of(reached[chosen], begin[chosen], end[chosen])
    sets = np.zeros((len(pattern.sets), len(chosen)), bool)
    sets[:, chosen] = pattern.sets
    return Pattern(sets, pattern.years, pattern.signs)


def _each(
    sites: Sites, felt: list[SharedEvents | None], place: np.ndarray, theta: np.ndarray, beta: np.ndarray
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Rate of each state under each branch and draw, shape (n, b, k); by the best fragility, shape (n, b); and doubts."""
    states, warnings = sites.monuments, [doubt for state in sites.monuments for doubt in state.capacity.doubts]
    best = (
        np.array([[state.capacity.log_median] for state in states]),
        np.exp([[state.capacity.log_beta] for state in states]),
    )
    every = np.concatenate((best[0], theta), axis=1), np.concatenate((best[1], beta), axis=1)
    state_rates = np.empty((len(states), len(felt), every[0].shape[1]))
    for b, (branch, events) in enumerate(zip(sites.branches, felt, strict=True)):
        if events is not None:
            state_rates[:, b] = events.each(place, *every)
            continue
        for n, state in enumerate(states):
            hazard, capacity = branch.curves[state.site], state.capacity
            with within(f"branch {branch.name!r}, {state.called}"):
                state_rates[n, b] = rates(hazard, every[0][n], every[1][n])
                middle, rate = (float(best[0][n, 0]), float(best[1][n, 0])), float(state_rates[n, b, 0])
                warnings += doubts(hazard, capacity.measure, capacity.unit, *middle, rate, capacity.state)
    warnings += [
        f"the fragility of {state.called} is taken as exactly known; give median_95 and beta_95."
        for state in states
        if not any(state.capacity.median_sides)
    ]
    if felt[0] is not None and "@" not in states[0].capacity.measure:
        measure = states[0].capacity.measure
        warnings.append(
            f"ground-motion models tell the geometric mean of both horizontal components; the {measure} of the fragilities "
            f"is taken for that: fit them over {measure}@geomean."
        )
    return state_rates[..., 1:], state_rates[..., 0], warnings


def _drawn(
    felt: list[SharedEvents | None], sets: np.ndarray, structures: np.ndarray, place: np.ndarray, theta: np.ndarray,
    beta: np.ndarray, each: np.ndarray, now: slice, rng: np.random.Generator, number: int,
) -> np.ndarray:  # fmt: skip
    """Rates of sets with events drawn, shape (m, b, k); residuals are those of all branches."""
    set_rates = np.empty((len(sets), len(felt), now.stop - now.start))
    for k in range(now.start, now.stop):
        normal = ndtri(_evenly(rng, RESIDUALS, number))
        for b, events in enumerate(felt):
            assert events is not None
            set_rates[:, b, k - now.start] = events.together(
                sets, structures, place, theta[:, k], beta[:, k], each[:, b, k], normal
            )
    return set_rates


def _curves(
    sites: Sites, felt: list[SharedEvents | None], used: list[str]
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Intensities, and rates of all branches there, by site: as far as all curves of the site reach."""
    ims, rates_by_site = {}, {}
    for number, site in enumerate(used):
        if felt[0] is not None:
            middle = sites.monuments[0].capacity.log_median
            ims[site] = np.exp(middle + np.linspace(-3.5, 1.5, INTENSITIES))
            rates_by_site[site] = np.array([events.curve(ims[site])[number] for events in felt if events is not None])
            continue
        curves: list[Hazard] = [branch.curves[site] for branch in sites.branches]
        low, high = max(curve.im[0] for curve in curves), min(curve.im[-1] for curve in curves)
        if low >= high:
            raise InputError(f"the hazard curves of {site!r} have no intensity in common; give curves that overlap.")
        ims[site] = np.geomspace(low, high, INTENSITIES)
        ims[site][[0, -1]] = low, high
        rates_by_site[site] = np.array([[curve.at(x) for x in ims[site]] for curve in curves])
    return ims, rates_by_site
