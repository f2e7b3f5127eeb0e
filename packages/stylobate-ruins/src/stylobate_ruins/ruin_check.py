"""Is a ruin inside what the rest of it predicts? What was moved by another cause than shaking stands out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.messages import say

from . import abc
from .answers import EVENTS, LEAST_OFFSET, LEAST_TWIST, LENGTHS
from .ruin import Fact

if TYPE_CHECKING:
    from .answers import Answers

#: Kinds of facts that are states, of the whole or of a body.
STATES = ("state", "body")

#: Chance with which a ruin that shaking alone has made has a state, or anything else that is seen, called odd.
CHANCE = 0.05


@dataclass(frozen=True)
class Checked:
    """One thing seen, against what all else predicts.

    Parameters
    ----------
    label : str
    chance : float
        Probability of what is seen, or of anything farther from what is expected; NaN where too few draws match the rest.
    odd : bool
        Below what chance explains, over all that is checked.
    expected : str
        What is predicted, in words.
    """

    label: str
    chance: float
    odd: bool
    expected: str

    @property
    def sentence(self) -> str:
        """What stands out, in a sentence."""
        chance = say(" (chance {chance:.2g})", chance=max(self.chance, 1e-3))
        odd = say("Odd: {c.label}, where all else that is seen predicts {c.expected}{chance}.")
        return odd.of(c=self, chance="" if "of a hundred" in self.expected else chance)

    def summary(self) -> dict[str, Any]:
        """Plain values."""
        return {"observation": self.label, "chance": self.chance, "odd": self.odd, "expected": self.expected}


def checks_of(answers: Answers, fewest: int) -> list[Checked]:
    """Everything that is seen, each against what the other observations predict.

    Parameters
    ----------
    answers : Answers
    fewest : int
        Of draws that must match the rest.
    """
    predictions: list[tuple[Fact, float, str]] = []
    for fact in answers.facts:
        rest = answers.without(fact)
        if len(answers.matching(rest)) < fewest:
            predictions.append((fact, float("nan"), "nothing: too few simulations match the rest"))
            continue
        predictions.append((fact, *(_event if fact.kind in EVENTS else _number)(answers, fact, rest)))
    states = sum(fact.kind in STATES for fact in answers.facts)
    others = len(predictions) - states
    return [
        Checked(fact.label, chance, bool(chance * (states if fact.kind in STATES else others) < CHANCE), expected)
        for fact, chance, expected in predictions
    ]


def _event(answers: Answers, fact: Fact, rest: list[Fact]) -> tuple[float, str]:
    """Probability of an event, by the rule of succession, and in words."""
    taken = answers.foretold(rest, answers.matched[fact].astype(float))
    share = float(np.average(taken.targets[:, 0], weights=taken.weights))
    share = (share * taken.effective + 0.5) / (taken.effective + 1.0)
    return share, f"this in {100.0 * share:.2g} of a hundred cases"


def _number(answers: Answers, fact: Fact, rest: list[Fact]) -> tuple[float, str]:
    """Chance of a number as far from what is expected as that which is seen, and what is expected."""
    from scipy.stats import t

    seen = np.array(fact.value)
    if fact.kind == "fell towards":
        taken = answers.to(rest)
        predicted = answers.values[fact][taken.which, 0]
        middle = abc.middle_direction(predicted, taken.weights, 360.0)
        off = np.abs(abc.apart(predicted, middle, 360.0))
        share = float(taken.weights[off >= abs(float(abc.apart(seen[0], middle, 360.0)))].sum())
        return (share * taken.effective + 0.5) / (taken.effective + 1.0), say(
            "a fall towards {azimuth:.0f}°", azimuth=middle
        )
    scale = max(fact.sd, LEAST_OFFSET if fact.kind in LENGTHS else LEAST_TWIST)
    taken = answers.foretold(rest, np.arcsinh(np.linalg.norm(answers.values[fact], axis=1) / scale))
    level = taken.targets[:, 0]
    mean, sd = float(np.average(level, weights=taken.weights)), abc.spread(level, taken.weights)
    length = max(float(np.linalg.norm(seen)), fact.sd)  # who writes 0 ± 3 mm has seen none, not less than errors make
    off = (float(np.arcsinh(length / scale)) - mean) / max(sd, 1e-12)
    low, high = scale * np.sinh(np.maximum(abc.quantiles(level, taken.weights)[[0, 2]], 0.0))
    factor, unit = (1e3, "mm") if fact.kind in LENGTHS else (1.0, "°")
    return float(2.0 * t.sf(abs(off), max(1.0, taken.effective - 1.0))), say(
        "{low:.2g} to {high:.3g} {unit}", low=factor * low, high=factor * high, unit=unit
    )
