"""Capacity: two levels between which something first falls, or only a bound."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..messages import say
from . import verdicts as v

#: Shares of many capacities that are told.
SHARES = (0.16, 0.5, 0.84)


class Capacity(NamedTuple):
    """A level above ``low`` and up to ``high``: the largest that was stood, and the smallest that brought collapse.

    ``low`` is 0 where no lower level was stood, ``high`` infinite where none brought collapse: only a bound is known then.
    """

    low: float
    high: float

    @property
    def value(self) -> float | None:
        """The smallest level that brought collapse; None where none did."""
        return self.high if math.isfinite(self.high) else None

    def bound(self, unit: float = 1.0) -> str | None:
        """The bound, such as "≤ 0.3", in units of such a size; None where levels on both sides are known."""
        if 0.0 < self.low and math.isfinite(self.high):
            return None
        if math.isfinite(self.high):
            return say("≤ {value:.4g}", value=self.high / unit)
        return say("> {value:.4g}", value=self.low / unit) if self.low > 0.0 else say("not known")


def of_levels(levels: Sequence[float] | np.ndarray, verdicts: Sequence[str]) -> Capacity:
    """Capacity on rising levels; what is undecided or failed below the first collapse may be one, and widens it."""
    high = v.first_collapse(np.asarray(levels), verdicts)
    low = 0.0
    for level, verdict in zip(levels, verdicts):
        if verdict != v.STANDS:
            break
        low = float(level)
    return Capacity(low, math.inf if high is None else high)


def quantiles(capacities: Iterable[Capacity], shares: Sequence[float] = SHARES) -> list[Capacity]:
    """Capacities that shares of many do not exceed: between those of their lower ends and those of their upper ones."""
    low, high = np.array(list(capacities), dtype=float).T
    ends = (np.quantile(np.sort(one), shares, method="inverted_cdf") for one in (low, high))
    return [Capacity(float(one), float(other)) for one, other in zip(*ends, strict=True)]


def bounds(named: Mapping[str, tuple[Capacity, float]]) -> dict[str, str]:
    """Those of named capacities, each with the size of its unit, of which only a bound is known: the bound by name."""
    found = {name: capacity.bound(unit) for name, (capacity, unit) in named.items()}
    return {name: one for name, one in found.items() if one is not None}
