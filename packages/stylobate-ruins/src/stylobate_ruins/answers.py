"""What the draws of a table say to what is seen: those that are accepted, and the parameters that they leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stylobate.messages import joined, say

from . import abc
from .abc import vectors
from .ruin import Fact
from .simulations import FELL, STANDS, FinalState, Simulations

# What is seen of a ruin, and what every draw would have left in its place: events that match or not, and numbers.

#: Kinds of facts that a draw matches or does not.
EVENTS = ("state", "body", "no slip above")

#: Kinds of facts that are vectors in plan [m], and all that are lengths.
VECTORS = ("offset", "moved")
LENGTHS = (*VECTORS, "largest")

#: Least scale of an offset and of a twist: smaller ones are alike [m], [degrees].
LEAST_OFFSET, LEAST_TWIST = 1e-4, 0.1

#: Draws about which bumps are laid.
BUMPS = 100


def matches(fact: Fact, table: Simulations) -> np.ndarray:
    """Draws that leave an event as it is seen, shape (draws,)."""
    final_state = table.final_states[fact.structure]
    if fact.kind == "state":
        return final_state.verdict == (FELL if fact.value[0] else STANDS)
    if fact.kind == "body":
        return final_state.fallen[:, fact.joint] == bool(fact.value[0])
    return (final_state.verdict == STANDS) & (final_state.largest <= fact.value[0])


def left_by(fact: Fact, table: Simulations) -> np.ndarray:
    """What every draw leaves in the place of a number that is seen, shape (draws, values)."""
    final_state = table.final_states[fact.structure]
    if fact.kind in VECTORS:
        return plan(fact, final_state)
    alone = {"fell towards": final_state.towards, "largest": final_state.largest}
    return (alone[fact.kind] if fact.kind in alone else final_state.twist[:, fact.joint])[:, None]


def errors(fact: Fact, shape: tuple[int, ...], seed: int) -> np.ndarray:
    """Errors that make what draws leave as badly measured as the ruin was, the same in whatever order facts are named."""
    stream = np.random.default_rng([seed, 1, fact.structure, list(_FEATURES).index(fact.kind), fact.joint])
    return fact.sd * stream.standard_normal(shape)


def plan(fact: Fact, final_state: FinalState) -> np.ndarray:
    """What every draw leaves in the place of a vector in plan [m], shape (draws, 2)."""
    return (final_state.slip if fact.kind == "offset" else final_state.moved)[:, fact.joint]


def features(facts: Sequence[Fact], values: Sequence[np.ndarray], *, sizes: bool = False) -> np.ndarray:
    """Features of numbers that are seen, from which a regression expects parameters, shape (draws, features).

    Lengths on a scale that is linear below what can be measured and logarithmic above it, of each joint and of the whole
    structure; bumps over those of structures; directions as axes and as senses.

    Parameters
    ----------
    facts : sequence of Fact
        That are no events.
    values : sequence of array
        Of each fact, shape (draws, values); the last row is what is seen.
    sizes : bool
        How much has moved in each structure alone, not which joints and whereto.
    """
    levels: list[np.ndarray] = []
    each: list[np.ndarray] = []
    directions: list[np.ndarray] = []
    for structure in dict.fromkeys(fact.structure for fact in facts):
        own = [(fact, draws) for fact, draws in zip(facts, values, strict=True) if fact.structure == structure]
        for kind, of in _FEATURES.items():
            pairs = [(fact, draws) for fact, draws in own if fact.kind == kind]
            if pairs:
                for all_of_them, arrays in zip((levels, each, directions), of(pairs), strict=True):
                    all_of_them += arrays
    columns = levels if sizes else [*levels, *each, *directions, *_bumps(levels)]
    return np.column_stack(columns) if columns else np.zeros((len(values[0]) if values else 0, 0))


_Features = tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]


def _bumps(levels: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Bells over lengths about some draws (radial basis functions), by which a linear regression bends, shape (draws,) each.

    They are as wide as draws usually are apart; what is seen, the last row, is the middle of none.
    """
    if not levels:
        return []
    points = np.column_stack(levels)
    points = (points - points.mean(axis=0)) / (points.std(axis=0) + 1e-12)
    middles = points[np.linspace(0, max(0, len(points) - 2), min(BUMPS, len(points))).astype(int)]
    squares = (points**2).sum(axis=1)[:, None] + (middles**2).sum(axis=1) - 2.0 * points @ middles.T
    width = float(np.median(squares))
    return list(np.exp(-np.maximum(squares, 0.0) / width).T) if width > 1e-12 else []


def _of_offsets(pairs: Sequence[tuple[Fact, np.ndarray]]) -> _Features:
    x, y = np.stack([draws.T / max(fact.sd, LEAST_OFFSET) for fact, draws in pairs], axis=-1)  # each over its own error
    square = x * x + y * y
    length = np.sqrt(square)
    bottom, long = square.sum(axis=1) + len(pairs), length.sum(axis=1) + len(pairs)
    directions = [(x * x - y * y).sum(axis=1) / bottom, (2.0 * x * y).sum(axis=1) / bottom]
    directions += [x.sum(axis=1) / long, y.sum(axis=1) / long]
    overall = [np.arcsinh(length.max(axis=1))]
    if len(pairs) == 1:
        return overall, [], directions
    overall.append(np.arcsinh(np.sqrt(square.mean(axis=1))))
    axes = np.concatenate([x * x - y * y, 2.0 * x * y], axis=1) / np.tile(
        square + 1.0, 2
    )  # short where none can be told
    return overall, list(np.arcsinh(length).T), [*directions, *axes.T]


def _of_sizes(pairs: Sequence[tuple[Fact, np.ndarray]]) -> _Features:
    """Of numbers without a direction: twists, the largest offset."""
    least = [LEAST_OFFSET if fact.kind in LENGTHS else LEAST_TWIST for fact, _ in pairs]
    scale = np.array([max(fact.sd, floor) for (fact, _), floor in zip(pairs, least, strict=True)])
    sizes = np.arcsinh(np.abs(np.concatenate([draws for _, draws in pairs], axis=1)) / scale)
    return [sizes.max(axis=1)], list(sizes.T) if len(pairs) > 1 else [], []


def _of_falls(pairs: Sequence[tuple[Fact, np.ndarray]]) -> _Features:
    ((_, angle),) = pairs
    return [], [], [*vectors(angle[:, 0], 180.0).T, *vectors(angle[:, 0], 360.0).T]


#: Lengths of the whole, lengths of each, and directions, by the kind of facts.
_FEATURES = {
    "offset": _of_offsets,
    "moved": _of_offsets,
    "largest": _of_sizes,
    "twist": _of_sizes,
    "fell towards": _of_falls,
}

#: Parameters that are told, and their units.
UNITS = {"pgv_m_s": "m/s", "pga_g": "g", "period_s": "s", "azimuth_deg": "°"}

#: What they are called.
LABELS = {"pgv_m_s": "PGV", "pga_g": "PGA", "period_s": say("period"), "azimuth_deg": say("azimuth")}

#: Fewest draws that a posterior may rest on, and the share that is accepted of those that match all events.
FEWEST, SHARE = 100, 0.3

#: Share of them by which an observation is foretold from the others.
CLOSE = 0.1

#: What is known worse than by so many standard deviations of what draws leave tells nothing: at most log(1 + 1/BADLY²)/2.
BADLY = 3.0

#: The shapes do not tell a parameter of which they leave this share of the prior's spread.
UNINFORMATIVE_SPREAD = 0.9

#: Probability that a column has fallen without any earthquake, and the largest Bayes factor that is told.
FALLS_OTHERWISE, MOST_TIMES = 0.01, 1e9


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
        return self.spread < UNINFORMATIVE_SPREAD

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
        self.scores = {name: abc.Scores(table.parameters[name]) for name in UNITS if name != "azimuth_deg"}
        directions = abc.vectors(table.parameters["azimuth_deg"], table.prior.turn)
        self.targets = np.column_stack([*(scores.scores for scores in self.scores.values()), directions])
        self.matched = {fact: matches(fact, table) for fact in self.facts if fact.kind in EVENTS}
        self.exact = {fact: left_by(fact, table) for fact in self.facts if fact.kind not in EVENTS}
        self.values = {fact: exact + errors(fact, exact.shape, seed) for fact, exact in self.exact.items()}

    def matching(self, facts: Sequence[Fact]) -> np.ndarray:
        """Numbers of the draws that match all events among facts."""
        return np.flatnonzero(
            np.all([self.weights > 0.0, *(self.matched[fact] for fact in facts if fact in self.matched)], axis=0)
        )

    def of_draws(
        self, facts: Sequence[Fact], which: np.ndarray, *, sizes: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Features of numbers among facts: of draws, shape (draws, features), and of what is seen, shape (features,)."""
        precise_facts = [
            fact for fact in facts if fact in self.exact and fact.sd < BADLY * self.exact[fact][which].std(axis=0).max()
        ]
        if not precise_facts:
            return np.zeros((len(which), 0)), np.zeros(0)
        values = [np.vstack((self.values[fact][which], [fact.value])) for fact in precise_facts]
        all_features = features(precise_facts, values, sizes=sizes)
        return all_features[:-1], all_features[-1]

    def to(self, facts: Sequence[Fact]) -> abc.Accepted:
        """Draws that are accepted for facts."""
        which = self.matching(facts)
        drawn_features, seen = self.of_draws(facts, which)
        near = abc.accepted(drawn_features, self.targets[which], seen, self._count(which, SHARE), self.weights[which])
        return replace(near, which=which[near.which])

    def _count(self, which: np.ndarray, share: float) -> int:
        return max(FEWEST, int(share * abc.effective(self.weights[which])))

    def foretold(self, facts: Sequence[Fact], what: np.ndarray) -> abc.Accepted:
        """Draws in which as much has moved as facts say, with one number of each draw, shape (draws,), to foretell it.

        It is not moved along a line: where next to nothing has moved, lines through rare events lead astray.
        """
        which = self.matching(facts)
        drawn_features, seen = self.of_draws(facts, which, sizes=True)
        away = (drawn_features - seen) / (drawn_features.std(axis=0) + 1e-12)
        near = abc.nearest(away, what[which, None], self._count(which, CLOSE), self.weights[which])
        return replace(near, which=which[near.which])

    def posterior(self, taken: abc.Accepted) -> dict[str, Posterior]:
        """Parameters after accepted draws."""
        posteriors = {}
        for column, (name, scores) in enumerate(self.scores.items()):
            low, middle, high = scores.value(abc.quantiles(taken.targets[:, column], taken.weights)).tolist()
            before = float(scores.scores.std())
            spread_ratio = abc.spread(taken.targets[:, column], taken.weights) / before if before > 0.0 else 1.0
            posteriors[name] = Posterior(middle, low, high, spread_ratio)
        turn, prior = self.table.prior.turn, self.table.parameters["azimuth_deg"]
        angles = self.azimuths(taken)
        low, middle, high = abc.quantiles_around(angles, taken.weights, turn).tolist()
        before = abc.spread_around(prior, np.ones(len(prior)), turn)
        spread_ratio = abc.spread_around(angles, taken.weights, turn) / before if before > 0.0 else 1.0
        posteriors["azimuth_deg"] = Posterior(middle, low, high, spread_ratio)
        return posteriors

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
            return [other for other in self.facts if other.structure != fact.structure]
        return [other for other in self.facts if other is not fact and not self._is_body_of(fact, other)]

    @staticmethod
    def _is_body_of(state: Fact, fact: Fact) -> bool:
        """Whether a fact is how far a body has moved of which another says that it stands."""
        same = (state.structure, state.joint) == (fact.structure, fact.joint)
        return same and state.kind == "body" and fact.kind == "moved"

    def alone(self, fact: Fact) -> list[Fact]:
        """A fact alone, with the states that it needs."""
        return [
            candidate
            for candidate in self.facts
            if candidate is fact
            or (candidate.kind == "state" and candidate.structure == fact.structure)
            or self._is_body_of(candidate, fact)
        ]

    def bayes_factor(self) -> tuple[float, bool]:
        """How many times more probable what is seen is under the prior than without any earthquake; whether at least.

        By likelihoods of what is measured, with the errors of the survey. A mean of few draws is seldom far above what it
        estimates (Markov), and may be far below.
        """
        which = self.matching(self.facts)
        fallen = sum(fact.kind == "state" and fact.value[0] == 1.0 for fact in self.facts)
        standing = sum(fact.kind == "state" for fact in self.facts) - fallen
        logs = np.zeros(len(which) + 1)  # the last: nothing has moved
        for fact in self.exact:
            if fact.kind != "fell towards":  # it has any direction either way
                off = np.vstack((self.exact[fact][which], np.zeros(len(fact.value)))) - fact.value
                logs -= 0.5 * ((off / fact.sd) ** 2).sum(axis=1)
        likely = self.weights[which] * np.exp(logs[:-1] - logs[:-1].max())
        none = fallen * np.log(FALLS_OTHERWISE) + standing * np.log1p(-FALLS_OTHERWISE) + logs[-1] - logs[:-1].max()
        factor = min(MOST_TIMES, float(np.exp(min(700.0, np.log(likely.sum() / self.weights.sum()) - none))))
        measured = any(fact.kind != "fell towards" for fact in self.exact)
        return factor, bool(factor == MOST_TIMES or (measured and abc.effective(likely) < FEWEST))


def words_of(name: str, posterior: Posterior) -> str:
    """A posterior with its interval, for people."""
    unit = f" {UNITS[name]}" if UNITS[name] != "°" else "°"
    return say("{p.median:.3g}{unit}, {p.low:.3g} to {p.high:.3g}", p=posterior, unit=unit)


def listed(words: Sequence[str]) -> str:
    """Words as an enumeration."""
    return joined(say(" and "), [joined(", ", words[:-1]), words[-1]])
