"""What the draws of a table say to what is seen: those that are accepted, and the parameters that they leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..campaign.ruin import Fact
from ..campaign.simulations import Simulations
from . import abc
from .traces import EVENTS, LENGTHS, features, left_by, matches

#: Parameters that are told, and their units.
TOLD = {"pgv_m_s": "m/s", "pga_g": "g", "period_s": "s", "azimuth_deg": "°"}

#: What they are called.
CALLED = {"pgv_m_s": "PGV", "pga_g": "PGA", "period_s": "period", "azimuth_deg": "azimuth"}

#: Fewest draws that a posterior may rest on, and the share that is accepted of those that match all events.
FEWEST, SHARE = 100, 0.3

#: Share of them by which an observation is foretold from the others.
CLOSE = 0.1

#: The shapes do not tell a parameter of which they leave this share of the prior's spread.
UNTOLD = 0.9

#: Share of the draws that match by which motions that are none are compared, and how many of these are made.
NEAR, NONE_MADE = 0.1, 4000

#: Probability that a column has fallen without any earthquake.
FALLS_OTHERWISE = 0.01


@dataclass(frozen=True)
class Posterior:
    """A parameter after what is seen.

    Parameters
    ----------
    median, low, high : float
        And the ends of 90 %; of an azimuth counted from the mean direction either way, so that they may lie beyond a turn.
    spread : float
        Standard deviation over that of the prior [-]: of normal scores, of an azimuth in degrees.
    """

    median: float
    low: float
    high: float
    spread: float

    @property
    def informative(self) -> bool:
        """Whether the shapes tell it."""
        return self.spread < UNTOLD

    def summary(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "median": self.median, "low": self.low, "high": self.high, "spread_over_prior": self.spread,
            "informative": self.informative,
        }  # fmt: skip


class Answers:
    """What the draws of a table say to facts: to all that are seen, or to some of them.

    Parameters
    ----------
    table : Simulations
    facts : sequence of Fact
    seed : int
        Of the errors with which is measured what draws leave.
    weights : array, optional
        Of the draws before any of these facts, shape (draws,); all alike by default.
    """

    def __init__(self, table: Simulations, facts: Sequence[Fact], seed: int, weights: np.ndarray | None = None) -> None:
        self.table, self.facts, self.seed = table, tuple(facts), seed
        self.weights = np.ones(len(table)) if weights is None else weights
        self.scores = {name: abc.Scores(table.parameters[name]) for name in TOLD if name != "azimuth_deg"}
        directions = abc.vectors(table.parameters["azimuth_deg"], table.prior.turn)
        self.targets = np.column_stack([*(one.scores for one in self.scores.values()), directions])
        streams = [np.random.default_rng([seed, 1, number]) for number in range(len(self.facts))]
        self.matched = {fact: matches(fact, table) for fact in self.facts if fact.kind in EVENTS}
        self.values = {
            fact: left_by(fact, table, stream)
            for fact, stream in zip(self.facts, streams, strict=True)
            if fact.kind not in EVENTS
        }

    def matching(self, facts: Sequence[Fact]) -> np.ndarray:
        """Numbers of the draws that match all events among facts."""
        return np.flatnonzero(
            np.all([self.weights > 0.0, *(self.matched[one] for one in facts if one in self.matched)], axis=0)
        )

    def of_draws(
        self, facts: Sequence[Fact], which: np.ndarray, *, sizes: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Features of numbers among facts: of draws, shape (draws, features), and of what is seen, shape (features,)."""
        told = [fact for fact in facts if fact.kind not in EVENTS]
        if not told:
            return np.zeros((len(which), 0)), np.zeros(0)
        values = [np.vstack((self.values[one][which], [one.value])) for one in told]
        found = features(told, values, sizes=sizes)
        return found[:-1], found[-1]

    def to(self, facts: Sequence[Fact]) -> abc.Accepted:
        """Draws that are accepted for facts."""
        which = self.matching(facts)
        found, seen = self.of_draws(facts, which)
        near = abc.accepted(found, self.targets[which], seen, self._count(which, SHARE), self.weights[which])
        return replace(near, which=which[near.which])

    @staticmethod
    def _count(which: np.ndarray, share: float) -> int:
        return max(FEWEST, int(share * len(which)))

    def foretold(self, facts: Sequence[Fact], what: np.ndarray) -> abc.Accepted:
        """Draws in which as much has moved as facts say, with one number of each draw, shape (draws,), to foretell it.

        It is not moved along a line: where next to nothing has moved, lines through rare events lead astray.
        """
        which = self.matching(facts)
        found, seen = self.of_draws(facts, which, sizes=True)
        size = found.std(axis=0) + 1e-12
        count = self._count(which, CLOSE)
        near = abc.nearest(found / size, what[which, None], seen / size, count, self.weights[which])
        taken = which[near.which]
        return replace(near, which=taken, targets=what[taken, None])

    def posterior(self, taken: abc.Accepted) -> dict[str, Posterior]:
        """Parameters after accepted draws."""
        found = {}
        for column, (name, scores) in enumerate(self.scores.items()):
            low, middle, high = scores.value(abc.quantiles(taken.targets[:, column], taken.weights)).tolist()
            before = float(scores.scores.std())
            left = abc.spread(taken.targets[:, column], taken.weights) / before if before > 0.0 else 1.0
            found[name] = Posterior(middle, low, high, left)
        turn, prior = self.table.prior.turn, self.table.parameters["azimuth_deg"]
        angles = self.azimuths(taken)
        low, middle, high = abc.quantiles_around(angles, taken.weights, turn).tolist()
        before = abc.spread_around(prior, np.ones(len(prior)), turn)
        left = abc.spread_around(angles, taken.weights, turn) / before if before > 0.0 else 1.0
        found["azimuth_deg"] = Posterior(middle, low, high, left)
        return found

    def azimuths(self, taken: abc.Accepted) -> np.ndarray:
        """Azimuths of accepted draws, not moved [degrees].

        Moved along a line, vectors of directions that are hardly told turn too far: of 966 ruins 90 % intervals held 87 %.
        """
        return self.table.parameters["azimuth_deg"][taken.which]

    def spread_of_pgv(self, facts: Sequence[Fact]) -> float:
        """What facts leave of the prior's spread of ln PGV; NaN where too few draws match them."""
        if len(self.matching(facts)) < FEWEST:
            return float("nan")
        return self.posterior(self.to(facts))["pgv_m_s"].spread

    def without(self, fact: Fact) -> list[Fact]:
        """All facts but one; without a state also what is seen of that structure or body besides."""
        if fact.kind == "state":
            return [one for one in self.facts if one.structure != fact.structure]
        return [one for one in self.facts if one is not fact and not self._is_body_of(fact, one)]

    @staticmethod
    def _is_body_of(state: Fact, fact: Fact) -> bool:
        """Whether a fact is how far a body has moved of which another says that it stands."""
        same = (state.structure, state.joint) == (fact.structure, fact.joint)
        return same and state.kind == "body" and fact.kind == "moved"

    def alone(self, fact: Fact) -> list[Fact]:
        """A fact alone, with the states that it needs."""
        return [
            one
            for one in self.facts
            if one is fact or (one.kind == "state" and one.structure == fact.structure) or self._is_body_of(one, fact)
        ]

    def shares(self) -> tuple[float, float, bool]:
        """Probabilities of what is seen under the prior and without any earthquake, and whether the latter is a limit."""
        which = self.matching(self.facts)
        share = float(self.weights[which].sum() / self.weights.sum())
        fallen = sum(fact.kind == "state" and fact.value[0] == 1.0 for fact in self.facts)
        standing = sum(fact.kind == "state" for fact in self.facts) - fallen
        none = FALLS_OTHERWISE**fallen * (1.0 - FALLS_OTHERWISE) ** standing
        told = [fact for fact in self.facts if fact.kind in (*LENGTHS, "twist")]  # a fall has any direction either way
        if not told:
            return share, none, False
        stream = np.random.default_rng([self.seed, 2])
        made = [fact.sd * stream.standard_normal((NONE_MADE, len(fact.value))) for fact in told]
        values = [
            np.vstack(([fact.value], self.values[fact][which], one)) for fact, one in zip(told, made, strict=True)
        ]
        found = features(told, values, sizes=True)
        away = np.linalg.norm((found[1:] - found[0]) / (found[1 : len(which) + 1].std(axis=0) + 1e-12), axis=1)
        near = max(FEWEST // 5, int(NEAR * len(which)))
        reach = np.sort(away[: len(which)])[near - 1]
        beside = float(np.mean(away[len(which) :] <= reach))
        return share * near / len(which), none * max(beside, 1.0 / NONE_MADE), beside == 0.0

    def by_likelihood(self) -> Posterior:
        """PGV by a synthetic likelihood, over the draws that match all events."""
        which = self.matching(self.facts)
        found, seen = self.of_draws(self.facts, which)
        told, at = abc.summaries(found, self.targets[which], seen[None, :])
        weights = self.weights[which] / self.weights[which].sum()
        if told.shape[1]:
            weights = weights * abc.likelihood_weights(told, at[0], self.targets[which])
            weights /= weights.sum()
        scores = self.scores["pgv_m_s"]
        low, middle, high = scores.value(abc.quantiles(scores.scores[which], weights)).tolist()
        return Posterior(middle, low, high, abc.spread(scores.scores[which], weights))


def words_of(name: str, one: Posterior) -> str:
    """A posterior with its interval, for people."""
    unit = f" {TOLD[name]}" if TOLD[name] != "°" else "°"
    return f"{one.median:.3g}{unit}, {one.low:.3g} to {one.high:.3g}"


def listed(words: Sequence[str]) -> str:
    """Words as an enumeration."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
