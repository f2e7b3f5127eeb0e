"""Hunt and fill: which levels of intensity are run next, so that each run of a record tells something."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from . import verdicts as v

#: Each level of the hunt is so many times the one before [-].
GROWTH = 2.0

#: Levels that one record asks for at a time.
TOGETHER = 3

#: Levels that are closer than this tell nothing more [-].
CLOSE = 1.04


def next_levels(
    levels: Sequence[float], verdicts: Sequence[str], first: float, largest: float, left: int
) -> list[float]:
    """Levels that a record asks for, from what has been found so far.

    First ever larger ones until the column collapses; then those that split the stretch between the largest level that
    it stands, below the first collapse, and that collapse; then the widest stretches, above the first collapse too.

    Parameters
    ----------
    levels : sequence of float
        That have been run, in any order.
    verdicts : sequence of str
        Of each of them.
    first : float
        Where the hunt begins: below it no joint opens.
    largest : float
        No level is larger.
    left : int
        Runs that are left for the record.

    Returns
    -------
    list of float
        Empty where nothing is left, or nothing tells anything more.

    References
    ----------
    Vamvatsikos and Cornell (2004).
    """
    count = min(left, TOGETHER)
    if count <= 0:
        return []
    first = min(first, largest)
    if not levels:
        return _up(first, largest, count + 1)[: min(left, TOGETHER + 1)]
    order = np.argsort(levels)
    at, found = np.asarray(levels, dtype=float)[order], [verdicts[i] for i in order]
    fell = [x for x, one in zip(at, found) if one == v.COLLAPSED]
    if not fell and at[-1] < largest / CLOSE:
        return _up(min(at[-1] * GROWTH, largest), largest, count)
    if fell:
        high = fell[0]
        stood = [x for x, one in zip(at, found) if one == v.STANDS and x < high]
        low = stood[-1] if stood else high / GROWTH**2
        if high > CLOSE * low:
            inside = np.geomspace(low, high, count + (2 if stood else 1))
            new = inside[1:-1] if stood else inside[:-1]
            new = [float(x) for x in new if np.abs(np.log(at / x)).min() > 0.5 * math.log(CLOSE)]
            if new:
                return new
    top = min(largest, GROWTH * fell[0]) if fell else largest
    edges = np.unique(np.concatenate(([first], at[at <= top], [top])))
    widest = np.argsort(-np.diff(np.log(edges)), kind="stable")[:count]
    wide = [k for k in widest if edges[k + 1] > CLOSE**2 * edges[k]]
    return sorted(float(math.sqrt(edges[k] * edges[k + 1])) for k in wide)


def _up(first: float, largest: float, count: int) -> list[float]:
    found = [first]
    while len(found) < count and found[-1] < largest / CLOSE:
        found.append(min(found[-1] * GROWTH, largest))
    return found
