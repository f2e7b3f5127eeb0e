"""The states of a response that tell its story, for film strips: chosen by how far things have moved."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .recorded import Recorded

#: Distance, in sizes of the structure, beyond which a body is out of every picture.
ASIDE = 3.0


def way_of(response: Recorded) -> np.ndarray:
    """Displacement [m], shape (T,): the top along x with its sign, or the body that has moved farthest."""
    top = response.histories.top
    if top is None:
        return response.displacement.max(axis=1)
    return top if top.ndim == 1 else top[:, 0]


def size_of(response: Recorded) -> float:
    """Larger side of the box around everything that can move, as it stood, seen along y [m]."""
    moving = [i for i, fixed in enumerate(response.bodies.fixed) if not fixed]
    return float(np.ptp(np.concatenate([response.outline(0, i) for i in moving]), axis=0).max())


def telling_states(response: Recorded) -> list[int]:
    """Up to eight recorded states, from the first to the last that can be seen."""
    return _of_a_top(response) if response.histories.top is not None else _of_bodies(response)


def _of_a_top(response: Recorded) -> list[int]:
    """At rest, at the largest displacement in each fifth of the clear motion and before a collapse, and at the end."""
    way = way_of(response) if response.dims == "xz" else np.hypot(*response.top_displacement.T)
    far = np.nan_to_num(np.abs(way))
    time, last = response.collapse_time, _last_above_ground(response)
    before = far if math.isnan(time) else np.where(response.time <= time, far, 0.0)
    peak = int(before.argmax())
    far[last + 1 :] = before[last + 1 :] = 0.0
    moving = np.flatnonzero(np.abs(far[: last + 1] - far[last]) > 0.1 * before[peak])
    start, end = (int(moving[0]), int(moving[-1])) if moving.size else (0, last)
    start = max(start, int(np.argmax(before > 0.1 * before[peak])))
    edges = np.linspace(start, end + 1, 6).round().astype(int)
    spread = [low + int(far[low:high].argmax()) for low, high in pairwise(edges) if high > low]
    apart = 0.02 * (end - start)
    chosen = sorted({0, peak, *spread}) if last else []
    return [i for i in chosen if last - i > apart] + [last]


def _of_bodies(response: Recorded) -> list[int]:
    """The start, the end, and states between which the bodies have gone equal ways; the farthest if nothing falls."""
    places = response.body_position
    step = np.linalg.norm(np.diff(places, axis=0), axis=-1)
    step[response.displacement[1:] > ASIDE * size_of(response)] = 0.0  # out of the picture
    gone = np.concatenate(([0.0], np.nan_to_num(step).sum(axis=1).cumsum()))
    last = len(gone) - 1
    chosen = set(np.searchsorted(gone, np.linspace(0.0, gone[-1], 8)[1:-1]).tolist())
    if not response.collapsed:
        chosen.add(int(np.nan_to_num(response.displacement).max(axis=1).argmax()))
    frames = [0]
    for i in sorted(chosen):
        if min(gone[i] - gone[frames[-1]], gone[-1] - gone[i]) > 0.03 * gone[-1]:
            frames.append(i)
    return [*frames, last] if last else frames


def _last_above_ground(response: Recorded) -> int:
    """The last state to be seen: a model that does not follow what falls to the ground lets it pass through."""
    if response.followed:
        return len(response.time) - 1
    below = np.flatnonzero((response.body_position[..., 2] < 0.0).any(axis=1))
    return max(int(below[0]) - 1, 0) if below.size else len(response.time) - 1
