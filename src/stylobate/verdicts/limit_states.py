"""Limit states, and the shares of runs that exceed them, of several states of a column side by side."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np

from ..column.structure import Structure
from ..errors import InputError
from ..messages import digits, joined, percents, say
from ..response.measures import MEASURES
from . import verdict as v
from .verdict import share_under_another_law

#: Answers of a run about a state.
EXCEEDED, NOT_EXCEEDED, OPEN, FAILED = 1, 0, -1, -2

#: Measures whose levels are limit states, by their names in tables.
LEVELLED = {measure.key: measure for measure in MEASURES if measure.unit in ("m", "rad")}

#: Short names of some of them. ``top`` and ``drums`` are those of Psycharis, Fragiadakis and Stefanou (2013).
SHORT = {measure.short: measure.key for measure in MEASURES if measure.short}

#: The levels of Psycharis, Fragiadakis and Stefanou (2013): at the top 0.15, 0.35 and 1 base diameters, between drums what
#: stays of a slip, 0.005, 0.01 and 0.02 of a joint's diameter.
LEVELS = ("top:0.15d", "top:0.35d", "top:1d", "drums:0.005d", "drums:0.01d", "drums:0.02d")

_SPEC = re.compile(r"(?P<what>\w+):(?P<level>[0-9.eE+-]+)(?P<unit>d|m|rad)?")


@dataclass(frozen=True)
class LimitState:
    """A state that a run exceeds or not.

    Parameters
    ----------
    what : str
        Column of a table of runs; empty for collapse.
    level : float
        [m], [rad], or diameters.
    in_diameters : bool
        Of the base for peaks; of the narrowest joint for a slip.
    """

    what: str = ""
    level: float = 0.0
    in_diameters: bool = False

    @property
    def name(self) -> str:
        """As it is typed."""
        if not self.what:
            return "collapse"
        short = next((key for key, value in SHORT.items() if value == self.what), self.what)
        return f"{short}:{self.level:g}{'d' if self.in_diameters else self._unit}"

    @property
    def words(self) -> str:
        """For a picture."""
        if not self.what:
            return "collapse"
        what = self.what.removesuffix(f"_{self._unit}").replace("_", " ")
        return f"{what} over {self.level:g} {'diameters' if self.in_diameters else self._unit}"

    @property
    def _unit(self) -> str:
        """That of the level, where it is not in diameters."""
        measure = LEVELLED.get(self.what)
        return "m" if measure is None else measure.unit

    def of(self, row: Mapping[str, Any]) -> int:
        """Answer of a run: exceeded, not exceeded, open (undecided) or failed.

        A collapse exceeds every state. A peak that is passed stays passed, whatever the end; what an undecided run has not
        passed yet is open.
        """
        verdict = row.get("verdict") or (v.verdict(row) if "outcome" in row else v.UNDECIDED)
        if verdict in (v.FAILED, v.NOT_RUN):
            return FAILED
        if verdict == v.COLLAPSED:
            return EXCEEDED
        if not self.what:
            return OPEN if verdict == v.UNDECIDED else NOT_EXCEEDED
        if self.what not in row:
            raise InputError(f"the state {self.name} needs {self.what!r}, which the runs do not have; use collapse.")
        value = row[self.what]
        if value is not None and (isinstance(value, bool) or not isinstance(value, Real)):
            raise InputError(
                f"the state {self.name} needs a number, and {self.what!r} of the runs is none; use collapse, or another "
                "measure."
            )
        size = math.nan if value is None else abs(float(value))
        if not math.isfinite(size):
            return OPEN
        passed = size >= self._limit(row)
        if verdict == v.UNDECIDED and not (passed and self.what.startswith("peak_")):
            return OPEN
        return EXCEEDED if passed else NOT_EXCEEDED

    def check_known(self, row: Mapping[str, Any], columns: Sequence[Structure]) -> None:
        """Refuse a state that runs do not tell, before there are any.

        Parameters
        ----------
        row : mapping
            Names of what runs measure (:func:`~stylobate.response.measures.blank_row`).
        columns : sequence of Structure
            What is to be run.

        Raises
        ------
        InputError
        """
        for column in columns:
            self._limit(column.widths)
            self.of({**row, **column.widths, "verdict": v.STANDS})

    def _limit(self, row: Mapping[str, Any]) -> float:
        if not self.in_diameters:
            return self.level
        key = LEVELLED[self.what].width if self.what in LEVELLED else "base_width_m"
        if row.get(key) is None:
            raise InputError(f"the state {self.name} needs {key!r}, which the runs do not have; state the level in m.")
        return self.level * float(row[key])


def parse_state(text: str) -> LimitState:
    """A state as typed: ``collapse``, ``top:0.35d``, ``drums:0.01d``, ``peak_rotation_rad:0.05``.

    Raises
    ------
    InputError
        It cannot be read.
    """
    if text.strip().lower() in ("collapse", "collapsed"):
        return LimitState()
    match = _SPEC.fullmatch(text.strip())
    try:
        level = float(match["level"]) if match else math.nan
    except ValueError:
        level = math.nan
    if match is None or not 0.0 < level < 1e6:
        raise InputError(
            f"state {text!r} cannot be read; allowed is collapse, a level in base diameters such as {', '.join(LEVELS)}, "
            "or a measure of runs and its level, such as peak_rotation_rad:0.05.",
            "state",
        )
    if match["what"] in SHORT and match["unit"] is None:
        unit = f"write {text.strip()}d for base diameters, or {text.strip()}m"
        raise InputError(f"state {text!r} has no unit; {unit}.", "state")
    return LimitState(SHORT.get(match["what"], match["what"]), level, match["unit"] == "d")


#: Intensities that differ by less are one [-].
CLOSE = 1e-6

#: Answer of a verdict on collapse.
CODES = {v.COLLAPSED: EXCEEDED, v.STANDS: NOT_EXCEEDED, v.UNDECIDED: OPEN, v.FAILED: FAILED, v.NOT_RUN: FAILED}


@dataclass(frozen=True)
class Share:
    """Number of the runs, computed for all, that exceed a limit state.

    Parameters
    ----------
    label : str
    runs : int
        The same for all that stand side by side: runs that failed, or were not made, for none of them.
    exceeded, not_exceeded, undecided : int
        Of these runs.
    failed : int
        Runs of this one that could not be computed, or were not made.
    records : int
        That these runs are of.
    interval : (float, float)
        95 % confidence limits of the share over records, each of which counts once however many runs are of it; the lower
        one as if no undecided run exceeded the state, the upper one as if every one did. They hold the share of the runs,
        too, which is another one where records have different numbers of them.
    """

    label: str
    runs: int
    exceeded: int
    not_exceeded: int
    undecided: int
    failed: int
    records: int
    interval: tuple[float, float]

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
        return percents(self.low, self.high) if self.runs else ""

    @property
    def interval_words(self) -> str:
        """Its confidence limits for people; empty without runs."""
        return percents(*self.interval) if self.runs else ""

    @property
    def counts(self) -> dict[str, Any]:
        """Under the names of JSON objects of commands."""
        return {
            "same_runs": self.runs,
            "same_records": self.records,
            "exceeded": self.exceeded,
            "not_exceeded": self.not_exceeded,
            "undecided": self.undecided,
            "failed": self.failed,
            "share_low": self.low,
            "share_high": self.high,
            "interval_low": self.interval[0],
            "interval_high": self.interval[1],
        }

    @property
    def collapses(self) -> str:
        """Number of runs that collapse, with the share and its interval, in a sentence."""
        if not self.runs:
            return say("{label}: no run could be computed.", label=self.label)
        alone = say("{s.label} collapses in {s.exceeded} of 1 run")
        words = [(alone if self.runs == 1 else say("{s.label} collapses in {s.exceeded} of {s.runs} runs")).of(s=self)]
        words += [say(", and {count} more may, which are undecided", count=self.undecided)] if self.undecided else []
        alone = say(": {share} (95 % interval over 1 record: {interval})")
        over = alone if self.records == 1 else say(": {share} (95 % interval over {count} records: {interval})")
        words.append(over.of(share=self.words, interval=self.interval_words, count=self.records))
        return joined(
            "", [*words, say("; {count} more could not be computed.", count=self.failed) if self.failed else "."]
        )


def shares(
    codes: Mapping[Any, np.ndarray],
    records: Sequence[Any] | np.ndarray | None = None,
    laws: np.ndarray | None = None,
) -> list[Share]:
    """The shares of all that stand side by side.

    Parameters
    ----------
    codes : mapping of a label to array of int
        By label what each run says, as of :mod:`~stylobate.verdicts.limit_states`; the runs of all in the same order.
    records : array, optional
        Of which record each run is, in the same order; each of its own by default.
    laws : array of int, optional
        Law of the joints of each run, where it varies: intervals hold the share under one more law, too.
    """
    same = np.all([code != FAILED for code in codes.values()], axis=0)
    names = (
        np.arange(len(same)) if records is None else np.unique(np.asarray(records, dtype=str), return_inverse=True)[1]
    )
    owner, result = names[same], []
    for label, mine in codes.items():
        exceeded, not_exceeded, undecided = (
            int(np.count_nonzero(mine[same] == code)) for code in (EXCEEDED, NOT_EXCEEDED, OPEN)
        )
        failed = int(np.count_nonzero(mine == FAILED))
        number, interval = len(np.unique(owner)), _interval(mine[same], owner)
        if laws is not None:
            interval = _with_laws(interval, mine[same], laws[same])
        result.append(Share(str(label), int(same.sum()), exceeded, not_exceeded, undecided, failed, number, interval))
    return result


def _interval(codes: np.ndarray, owner: np.ndarray) -> tuple[float, float]:
    """Confidence limits over records of the share that exceeds, none and all of the undecided counted in."""
    runs = np.bincount(owner)
    there = runs > 0
    hits = [codes == EXCEEDED, np.isin(codes, (EXCEEDED, OPEN))]
    passed = [float((np.bincount(owner, hit, len(runs))[there] / runs[there]).sum()) for hit in hits]
    low, high = (float(v.wilson_interval(total, there.sum())[k]) for k, total in enumerate(passed))
    return (min(low, float(hits[0].mean())), max(high, float(hits[1].mean()))) if len(codes) else (low, high)


def _with_laws(interval: tuple[float, float], codes: np.ndarray, laws: np.ndarray) -> tuple[float, float]:
    """Limits that hold those under one more law of the joints, none and all of the undecided counted in."""
    law = np.unique(laws, return_inverse=True)[1]
    number = np.bincount(law)
    least, most = (np.bincount(law, np.isin(codes, kind)) for kind in ((EXCEEDED,), (EXCEEDED, OPEN)))
    low, high = share_under_another_law(least, number)[0], share_under_another_law(most, number)[1]
    return min(interval[0], low), max(interval[1], high)


def codes_of(verdicts: np.ndarray) -> np.ndarray:
    """Collapse by verdicts, shape of ``verdicts``."""
    return np.select([verdicts == name for name in CODES], list(CODES.values()), FAILED).astype(np.int8)


def median_words(curve: Mapping[str, Any]) -> str:
    """The median of a curve with its unit, or from which to which what is undecided or failed can take it.

    Beyond the intensities that were run only their bound is known of it.

    Parameters
    ----------
    curve : mapping
        As of ``Fragility.summary()``, or of a JSON file, where an infinite median is None.
    """
    unit = "" if curve["unit"] == "-" else f" {curve['unit']}"
    ends = [curve["median"], curve["median"]]
    if curve["undecided"] + curve["failed"]:
        ends = sorted(known_end(curve, key) for key in ("if_open_exceed", "if_open_do_not"))
    low, *rest = dict.fromkeys(within(end, curve["levels"]) for end in ends)
    return (say("{low} to {high}", low=low, high=rest[0]) if rest else low) + unit


def median_name(*curves: Mapping[str, Any] | None) -> str:
    """Kind of median of these curves: never an interval of confidence.

    Parameters
    ----------
    *curves : mapping
        As there; None where there is no curve.
    """
    open_ = any(curve["undecided"] + curve["failed"] for curve in curves if curve is not None)
    return say("median (undecided both ways)") if open_ else say("median")


def known_end(curve: Mapping[str, Any], key: str) -> float:
    """The median with what is undecided or failed all counted one way; without a curve 0 or infinite."""
    value, none = curve[key]["median"], 0.0 if key == "if_open_exceed" else math.inf
    return none if value is None or math.isnan(value) else float(value)


def within(value: float, levels: Sequence[float]) -> str:
    """An intensity, or the bound of those that were run where it lies beyond them."""
    low, high = levels
    if value > high * (1.0 + CLOSE):
        return say("> {level:.3g}", level=high)
    return say("≤ {level:.3g}", level=low) if value < low * (1.0 - CLOSE) else digits(value, ".3g")
