"""What is seen of a ruin, and what every draw would have left in its place: events that match or not, and numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .abc import vectors
from .ruin import Fact
from .simulations import FELL, STANDS, FinalState, Simulations

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
    left = table.left[fact.structure]
    if fact.kind == "state":
        return left.verdict == (FELL if fact.value[0] else STANDS)
    if fact.kind == "body":
        return left.fallen[:, fact.joint] == bool(fact.value[0])
    return (left.verdict == STANDS) & (left.largest <= fact.value[0])


def left_by(fact: Fact, table: Simulations) -> np.ndarray:
    """What every draw leaves in the place of a number that is seen, shape (draws, values)."""
    left = table.left[fact.structure]
    if fact.kind in VECTORS:
        return plan(fact, left)
    alone = {"fell towards": left.towards, "largest": left.largest}
    return (alone[fact.kind] if fact.kind in alone else left.twist[:, fact.joint])[:, None]


def errors(fact: Fact, shape: tuple[int, ...], seed: int) -> np.ndarray:
    """Errors that make what draws leave as badly measured as the ruin was, the same in whatever order facts are named."""
    stream = np.random.default_rng([seed, 1, fact.structure, list(_OF).index(fact.kind), fact.joint])
    return fact.sd * stream.standard_normal(shape)


def plan(fact: Fact, left: FinalState) -> np.ndarray:
    """What every draw leaves in the place of a vector in plan [m], shape (draws, 2)."""
    return (left.slip if fact.kind == "offset" else left.moved)[:, fact.joint]


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
        own = [(fact, one) for fact, one in zip(facts, values, strict=True) if fact.structure == structure]
        for kind, of in _OF.items():
            some = [(fact, one) for fact, one in own if fact.kind == kind]
            if some:
                for all_of_them, one in zip((levels, each, directions), of(some), strict=True):
                    all_of_them += one
    columns = levels if sizes else [*levels, *each, *directions, *_bumps(levels)]
    return np.column_stack(columns) if columns else np.zeros((len(values[0]) if values else 0, 0))


_Told = tuple[list[np.ndarray], list[np.ndarray], list[np.ndarray]]


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


def _of_offsets(some: Sequence[tuple[Fact, np.ndarray]]) -> _Told:
    x, y = np.stack([one.T / max(fact.sd, LEAST_OFFSET) for fact, one in some], axis=-1)  # each over its own error
    square = x * x + y * y
    length = np.sqrt(square)
    bottom, long = square.sum(axis=1) + len(some), length.sum(axis=1) + len(some)
    directions = [(x * x - y * y).sum(axis=1) / bottom, (2.0 * x * y).sum(axis=1) / bottom]
    directions += [x.sum(axis=1) / long, y.sum(axis=1) / long]
    overall = [np.arcsinh(length.max(axis=1))]
    if len(some) == 1:
        return overall, [], directions
    overall.append(np.arcsinh(np.sqrt(square.mean(axis=1))))
    axes = np.concatenate([x * x - y * y, 2.0 * x * y], axis=1) / np.tile(
        square + 1.0, 2
    )  # short where none can be told
    return overall, list(np.arcsinh(length).T), [*directions, *axes.T]


def _of_sizes(some: Sequence[tuple[Fact, np.ndarray]]) -> _Told:
    """Of numbers without a direction: twists, the largest offset."""
    least = [LEAST_OFFSET if fact.kind in LENGTHS else LEAST_TWIST for fact, _ in some]
    scale = np.array([max(fact.sd, one) for (fact, _), one in zip(some, least, strict=True)])
    sizes = np.arcsinh(np.abs(np.concatenate([one for _, one in some], axis=1)) / scale)
    return [sizes.max(axis=1)], list(sizes.T) if len(some) > 1 else [], []


def _of_falls(some: Sequence[tuple[Fact, np.ndarray]]) -> _Told:
    ((_, angle),) = some
    return [], [], [*vectors(angle[:, 0], 180.0).T, *vectors(angle[:, 0], 360.0).T]


#: Lengths of the whole, lengths of each, and directions, by the kind of facts.
_OF = {
    "offset": _of_offsets,
    "moved": _of_offsets,
    "largest": _of_sizes,
    "twist": _of_sizes,
    "fell towards": _of_falls,
}
