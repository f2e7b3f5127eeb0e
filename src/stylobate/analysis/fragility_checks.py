"""Runs that make no fragility: of too few records, or without a curve through them."""

from __future__ import annotations

import math

import numpy as np

from ..errors import InputError, check_range, check_whole
from . import lognormal
from .evidence import DIGITS, Evidence
from .limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN

#: Fewest records of which a fragility is made: fewer say nothing about the next earthquake.
FEWEST = 10

#: What is to be done about runs that are undecided.
DECIDE = "decide the runs that are undecided, as the command that made them says"

#: Fewest samples of a bootstrap, so that the quantiles of an interval of 95 % are among them.
FEWEST_SAMPLES = 40


def check_bootstrap(samples: int, seed: int, confidence: float) -> None:
    """Refuse numbers with which no interval can be made."""
    check_whole("`samples`", samples, FEWEST_SAMPLES)
    check_whole("`seed`", seed, 0, 2**63 - 1)
    check_range("confidence", confidence, 0.0, 1.0, open_low=True, open_high=True, remedy="such as 0.95")


def check_number(evidence: Evidence, records_are_one: bool) -> None:
    """Refuse what is no sample of earthquakes, whatever its runs say."""
    decided = evidence.codes >= 0
    if not decided.any():
        raise InputError(
            f"none of the {len(decided)} runs of {evidence.name} is decided ({evidence.count(OPEN)} undecided, "
            f"{evidence.count(FAILED)} failed), so that nothing is known of {evidence.state}; {DECIDE}."
        )
    count, every = len(np.unique(evidence.records[decided])), len(np.unique(evidence.records))
    if count >= FEWEST:
        return
    what = ("run" if records_are_one else "record") + ("" if count == 1 else "s")
    what += f" (of {every}; the others have no decided run)" if count < every else ""
    remedy = DECIDE if count < FEWEST <= every else f"give at least {FEWEST}"
    if not records_are_one:
        remedy += ", or say `records_are_one` to take every run for a record of its own"
    raise InputError(f"a fragility of {count} {what} says nothing about the next earthquake; {remedy}.")


def check_shape(evidence: Evidence, low: np.ndarray, high: np.ndarray, best: lognormal.Fit) -> None:
    """Refuse runs through which no fragility goes."""
    state, unit = evidence.state, "" if evidence.unit == "-" else f" {evidence.unit}"
    if math.isinf(best.log_median[0]):
        every = best.log_median[0] < 0.0
        raise InputError(
            f"{'every decided run exceeds' if every else 'no decided run exceeds'} {state}, so that no curve can be drawn; "
            f"give {'smaller' if every else 'larger'} intensities."
        )
    ends = np.concatenate((low, high))
    ends = np.unique(np.round(ends[np.isfinite(ends)], DIGITS))
    if len(ends) == 1:
        raise InputError(
            f"all runs of {evidence.name} are at one intensity, {evidence.measure} = {math.exp(ends[0]):.4g}{unit}, where "
            f"{evidence.count(EXCEEDED)} of {int((evidence.codes >= 0).sum())} exceed {state}: what happens at others is "
            "not known; give runs at several intensities."
        )
    if lognormal.falls(best):
        with_it, without = (
            math.exp(np.log(evidence.im[evidence.codes == one]).mean()) for one in (EXCEEDED, NOT_EXCEEDED)
        )
        raise InputError(
            f"runs of {evidence.name} do not exceed {state} more often where {evidence.measure} is larger (its geometric "
            f"mean is {with_it:.3g}{unit} where they do, {without:.3g}{unit} where they do not), and that is no fragility; "
            "check which value of 'collapsed' is which, or give intensities farther apart."
        )
