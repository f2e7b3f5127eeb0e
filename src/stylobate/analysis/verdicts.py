"""The verdict of a run: the one place where runs are counted as collapse, or not.

One rule for every count, share, interval and table:

* A run is ``failed`` if it could not be computed; ``undecided`` if it ended while the column could still change its mind;
  else it ``collapsed`` or ``stands``. Counts name all of them; a run that failed or is undecided is no collapse.
* Shares and probabilities are over all runs but those that failed or were not made. An undecided run counts as not
  collapsed: left out, it would make the share too large, because a collapse decides a run at once and standing needs time.
* In an interval the undecided are counted for both sides: as standing in the lower limit, as collapsed in the upper one.
* Two models are compared where both have a verdict.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from statistics import NormalDist
from typing import Any

import numpy as np

from ..messages import joined, say
from ..response.rows import Rows

STANDS, COLLAPSED, UNDECIDED, FAILED, NOT_RUN = "stands", "collapsed", "undecided", "failed", "not run"
VERDICTS = (STANDS, COLLAPSED, UNDECIDED, FAILED, NOT_RUN)

#: Verdicts of runs that were made.
MADE = (COLLAPSED, STANDS, UNDECIDED, FAILED)

#: Attribute of a labelled array that holds verdicts as their places in VERDICTS.
FLAGS = {
    "long_name": "verdict of the run",
    "flag_values": np.arange(len(VERDICTS), dtype=np.int8),
    "flag_meanings": " ".join(one.replace(" ", "_") for one in VERDICTS),
}


def verdict(row: Mapping[str, Any] | None) -> str:
    """Verdict of a run from its row (``Measures.row()``); None stands for a run that was not made."""
    if row is None:
        return NOT_RUN
    if row["outcome"] == "failed":
        return FAILED
    if not row["decided"]:
        return UNDECIDED
    return COLLAPSED if row["collapsed"] else STANDS


def verdicts_of(rows: Rows) -> np.ndarray:
    """Verdicts of many runs, as :func:`verdict` gives them; texts, shape (runs,)."""
    collapsed, decided = rows.floats("collapsed") == 1.0, rows.floats("decided") == 1.0
    states = (
        (~rows.made, NOT_RUN),
        (rows.are("outcome", "failed"), FAILED),
        (~decided, UNDECIDED),
        (collapsed, COLLAPSED),
    )
    return np.select([where for where, _ in states], [name for _, name in states], STANDS)


def count(verdicts: Sequence[str] | np.ndarray) -> dict[str, int]:
    """Number of runs of each verdict."""
    values = np.asarray(verdicts).ravel()
    return {one: int(np.count_nonzero(values == one)) for one in VERDICTS}


def open_runs(counts: Mapping[str, Any], so: str = say("not counted as collapse")) -> str:
    """Number of runs without a verdict, as a sentence behind another one; empty where all have one."""
    undecided, failed = counts.get(UNDECIDED), counts.get(FAILED)
    alone = say("1 run is undecided") if undecided == 1 else say("{count} runs are undecided", count=undecided)
    failing = say("1 run failed") if failed == 1 else say("{count} runs failed", count=failed)
    found = [text for text, number in ((alone, undecided), (failing, failed)) if number]
    return say(" {runs}: {so}.", runs=joined(say(" and "), found), so=so) if found else ""


def tally(verdicts: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Numbers of runs that collapsed, stand and are undecided along an axis of an array of verdicts."""
    collapsed, stands, undecided = ((verdicts == one).sum(axis=axis) for one in (COLLAPSED, STANDS, UNDECIDED))
    return collapsed, stands, undecided


def share_collapsed(collapsed: Any, stands: Any, undecided: Any) -> np.ndarray:
    """Share of the runs that collapse, undecided ones counted as not collapsed; NaN where no run is decided.

    Parameters
    ----------
    collapsed, stands, undecided : array of int
        Numbers of runs; those that failed are in none of them.
    """
    fell, stood, open_ = (np.asarray(one) for one in (collapsed, stands, undecided))
    trials = fell + stood + open_
    return np.divide(fell, trials, out=np.full(trials.shape, np.nan), where=fell + stood > 0)


def collapse_interval(
    collapsed: Any, stands: Any, undecided: Any, confidence: float = 0.95
) -> tuple[np.ndarray, np.ndarray]:
    """Confidence limits of the probability of collapse; arguments as of :func:`share_collapsed`.

    The lower one as if every undecided run had come to stand, the upper one as if it had collapsed.
    """
    fell, stood, open_ = (np.asarray(one) for one in (collapsed, stands, undecided))
    trials = fell + stood + open_
    low, _ = wilson_interval(fell, trials, confidence)
    return low, wilson_interval(fell + open_, trials, confidence)[1]


def wilson_interval(successes: Any, trials: Any, confidence: float = 0.95) -> tuple[np.ndarray, np.ndarray]:
    """Confidence limits of a probability from counts; 0 and 1 where there is no trial.

    Parameters
    ----------
    successes, trials : array of int
    confidence : float

    References
    ----------
    Wilson 1927: the probabilities p with (successes/trials − p)² ≤ z² p (1 − p)/trials.
    """
    k, n = np.asarray(successes, dtype=float), np.asarray(trials, dtype=float)
    z2 = NormalDist().inv_cdf(0.5 + 0.5 * confidence) ** 2
    centre = (k + 0.5 * z2) / (n + z2)
    half = np.sqrt(z2) / (n + z2) * np.sqrt(np.divide(k * (n - k), n, out=np.zeros_like(n), where=n > 0) + 0.25 * z2)
    low = np.where(k == 0, 0.0, np.maximum(0.0, centre - half))
    return low, np.where(k == n, 1.0, np.minimum(1.0, centre + half))


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
