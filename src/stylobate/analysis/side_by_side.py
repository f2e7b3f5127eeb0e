"""Shares of several states, columns or models side by side: of the same runs, with what is undecided as an interval."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import verdicts as v
from .limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN

#: What a verdict says about collapse.
CODES = {v.COLLAPSED: EXCEEDED, v.STANDS: NOT_EXCEEDED, v.UNDECIDED: OPEN, v.FAILED: FAILED, v.NOT_RUN: FAILED}


@dataclass(frozen=True)
class Share:
    """How many of the runs that could be computed for all exceed a limit state.

    Parameters
    ----------
    label : str
    runs : int
        The same for all that stand side by side: runs that failed, or were not made, for none of them.
    exceeded, not_exceeded, undecided : int
        Of these runs.
    failed : int
        Runs of this one that could not be computed, or were not made.
    """

    label: str
    runs: int
    exceeded: int
    not_exceeded: int
    undecided: int
    failed: int

    @property
    def low(self) -> float:
        """Share that exceeds the state if no undecided run does; NaN without runs."""
        return self.exceeded / self.runs if self.runs else math.nan

    @property
    def high(self) -> float:
        """Share that exceeds the state if every undecided run does; NaN without runs."""
        return (self.exceeded + self.undecided) / self.runs if self.runs else math.nan

    @property
    def words(self) -> str:
        """The share for people: a percentage, or from which to which where runs are undecided; empty without runs."""
        return share_words(self.exceeded, self.undecided, self.runs)


def share_words(exceeded: int, undecided: int, runs: int) -> str:
    """A share as a percentage, or from which to which where runs are undecided; empty without runs."""
    if not runs:
        return ""
    low, high = (f"{100.0 * count / runs:.0f}" for count in (exceeded, exceeded + undecided))
    return f"{low} to {high} %" if undecided else f"{low} %"


def shares(codes: Mapping[Any, np.ndarray]) -> list[Share]:
    """The shares of all that stand side by side.

    Parameters
    ----------
    codes : mapping of a label to array of int
        By label what each run says, as of :mod:`~stylobate.analysis.limit_states`; the runs of all in the same order.
    """
    same = np.all([one != FAILED for one in codes.values()], axis=0)
    found = []
    for label, mine in codes.items():
        exceeded, not_exceeded, undecided = (
            int(np.count_nonzero(mine[same] == one)) for one in (EXCEEDED, NOT_EXCEEDED, OPEN)
        )
        failed = int(np.count_nonzero(mine == FAILED))
        found.append(Share(str(label), int(same.sum()), exceeded, not_exceeded, undecided, failed))
    return found


def codes_of(verdicts: np.ndarray) -> np.ndarray:
    """What verdicts say about collapse, shape of ``verdicts``."""
    return np.select([verdicts == name for name in CODES], list(CODES.values()), FAILED).astype(np.int8)


def median_words(curve: Mapping[str, Any]) -> str:
    """The median of a curve with its unit, or from which to which what is undecided or failed can take it.

    Parameters
    ----------
    curve : mapping
        As of ``Fragility.summary()``, or of a JSON file, where an infinite median is None.
    """
    unit = "" if curve["unit"] == "-" else f" {curve['unit']}"
    if not curve["undecided"] + curve["failed"]:
        return f"{curve['median']:.3g}{unit}"
    ends = [curve[key]["median"] for key in ("if_open_exceed", "if_open_do_not")]
    known = sorted(one for one in ends if one is not None and math.isfinite(one))
    return " to ".join(f"{one:.3g}" for one in known) + " or more" * (len(known) < len(ends)) + unit
