"""Shares as percentages: the one rule of rounding for pages, reports, pictures and the command line."""

from __future__ import annotations

import math

from .messages import say

#: Shares that differ by less are one: 0.575 is a little less in binary digits, and is rounded as it is written [%].
CLOSE = 1e-9


def whole(share: float) -> str:
    """A share in whole per cent, the nearest to it, half of a per cent rounded up; a dash where there is none.

    What is not nothing is never written as 0, and what is not all never as 100.
    """
    if not math.isfinite(share):
        return "–"
    size = 100.0 * share
    if CLOSE < size < 0.5 - CLOSE:
        return "<1"
    return ">99" if 99.5 - CLOSE <= size < 100.0 - CLOSE else str(math.floor(size + 0.5 + CLOSE))


def percent(share: float) -> str:
    """A share as a percentage."""
    return f"{whole(share)} %"


def percents(low: float, high: float) -> str:
    """From which share to which, as percentages; one where both are written alike."""
    if whole(low) == whole(high):
        return percent(low)
    return say("{low} to {high} %", low=whole(low), high=whole(high))
