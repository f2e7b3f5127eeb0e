"""Demand on links at the collapse multiplier: the forces of a linear programme are not unique, the least ones are."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

#: A multiplier is the same if it differs by less than this share of itself [-].
SAME = 1e-6

#: A link holds its capacity if it must hold more than all but this share of it [-].
NEARLY = 1e-3

#: Most steps towards the least force of a link.
STEPS = 40


class Borne(NamedTuple):
    """Load of a programme with links of given capacities.

    ``multiplier`` [g]; ``worth``, by how much a larger capacity of each link would raise it [g/N], and ``held``, what each
    holds in this answer [N], shapes (links,); ``forces``, all of this answer.
    """

    multiplier: float
    worth: np.ndarray
    held: np.ndarray
    forces: np.ndarray


class Needed(NamedTuple):
    """Links in every answer of a programme.

    ``least`` [N], the least that each holds, with the sign of that answer; ``yields``, whether that is its capacity;
    ``idle``, whether it need not act: all that are idle may be so at once. ``forces`` of an answer in which they are.
    """

    least: np.ndarray
    yields: np.ndarray
    idle: np.ndarray
    forces: np.ndarray


def needed_forces(solve: Callable[[np.ndarray, float], Borne], capacity: np.ndarray, whole: Borne) -> Needed:
    """Demand on links at the multiplier that they reach together.

    Parameters
    ----------
    solve : callable
        The programme for capacities of the links [N], shape (links,); it may leave off where its multiplier is as large as
        the second argument [g], and says −∞ where what stands does not without them.
    capacity : array
        [N], infinite without limit.
    whole : Borne
        The programme's answer for these.

    Notes
    -----
    The multiplier λ(c) is a concave function of the capacities c that does not fall. A link that is worth something in one
    dual answer holds its capacity in every answer (complementary slackness). Of the others the least force is the smallest
    capacity with which λ stays the same: Newton's steps along the tangents of a concave function come to it from below,
    and never pass it. First all of them are left out at once, because mostly none is needed.
    """
    same = whole.multiplier - SAME * max(abs(whole.multiplier), 1e-3)
    finite = np.where(np.isfinite(capacity), capacity, 0.0)
    # The worth of what is left to this share of its capacity is beyond the errors of the programme.
    yields = whole.worth * finite > NEARLY * max(abs(whole.multiplier), 1e-3)
    least, idle = np.where(yields, np.sign(whole.held) * finite, 0.0), ~yields
    answer = solve(np.where(idle, 0.0, capacity), same) if idle.any() else whole
    if answer.multiplier >= same:
        return Needed(least, yields, idle, answer.forces)
    for k in np.flatnonzero(idle):
        least[k], yields[k] = _least(solve, capacity, int(k), whole, same)
    idle = least == 0.0
    answer = solve(np.where(idle, 0.0, capacity), same) if idle.any() else whole
    if answer.multiplier < same:  # each can be left out, all at once cannot: one stands in for another
        idle[:] = False
        answer = whole
    return Needed(least, yields, idle, answer.forces)


def _least(
    solve: Callable[[np.ndarray, float], Borne], capacity: np.ndarray, k: int, whole: Borne, same: float
) -> tuple[float, bool]:
    """The least that a link must hold [N], with its sign, and whether that is its capacity."""
    less, most = capacity.copy(), float(capacity[k])
    less[k], enough = 0.0, abs(float(whole.held[k]))
    for _ in range(STEPS):
        found = solve(less, same)
        if found.multiplier >= same:
            return float(found.held[k]) if less[k] else 0.0, False
        slope = float(found.worth[k])
        if found.multiplier == -np.inf and enough - less[k] > NEARLY * enough:  # without so much nothing stands
            less[k] = 0.5 * (less[k] + enough)
            continue
        if slope <= 0.0:
            break
        less[k] += (whole.multiplier - found.multiplier) / slope
        if less[k] >= most * (1.0 - NEARLY):
            return float(np.copysign(most, whole.held[k])), True
    return float(np.copysign(less[k], whole.held[k])), False
