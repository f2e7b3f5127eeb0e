"""The verdict of a run: the one place where runs are counted as collapse, or not.

A run that failed, or ended while the column was still far from rest, is no collapse and no survival: it is counted
apart.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

import numpy as np

STANDS, COLLAPSED, UNDECIDED, FAILED, NOT_RUN = "stands", "collapsed", "undecided", "failed", "not run"
VERDICTS = (STANDS, COLLAPSED, UNDECIDED, FAILED, NOT_RUN)


def verdict(row: Mapping[str, Any] | None) -> str:
    """Verdict of a run from its row (``Measures.row()``); None stands for a run that was not made."""
    if row is None:
        return NOT_RUN
    if row["outcome"] == "failed":
        return FAILED
    if not row["decided"]:
        return UNDECIDED
    return COLLAPSED if row["collapsed"] else STANDS


def count(verdicts: Sequence[str] | np.ndarray) -> dict[str, int]:
    """How many runs have each verdict."""
    values = np.asarray(verdicts).ravel()
    return {one: int(np.count_nonzero(values == one)) for one in VERDICTS}


def first_collapse(amplitudes: np.ndarray, verdicts: Sequence[str]) -> float | None:
    """Smallest amplitude that collapses, or None."""
    return next((float(a) for a, one in zip(amplitudes, verdicts) if one == COLLAPSED), None)


def all_collapse_above(amplitudes: np.ndarray, verdicts: Sequence[str]) -> float | None:
    """Smallest amplitude from which on every run collapses, or None."""
    found = None
    for amplitude, one in zip(amplitudes[::-1], reversed(list(verdicts))):
        if one != COLLAPSED:
            break
        found = float(amplitude)
    return found


def alternations(amplitudes: np.ndarray, verdicts: Sequence[str]) -> list[tuple[float, float, str, int]]:
    """Stretches of equal verdict along the amplitudes: (first amplitude, last amplitude, verdict, runs)."""
    out = []
    for one, group in groupby(zip(amplitudes, verdicts), key=lambda pair: pair[1]):
        stretch = [float(amplitude) for amplitude, _ in group]
        out.append((stretch[0], stretch[-1], one, len(stretch)))
    return out
