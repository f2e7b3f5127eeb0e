"""Limit states: what of a run counts as exceeded, collapse or a level of a displacement."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any

from ..column.structure import Structure
from ..errors import InputError
from ..response.measures import MEASURES
from . import verdicts as v

#: Answers of a run about a state.
EXCEEDED, NOT_EXCEEDED, OPEN, FAILED = 1, 0, -1, -2

#: Measures whose levels are limit states, by their names in tables.
LEVELLED = {one.key: one for one in MEASURES if one.unit in ("m", "rad")}

#: Short names of some of them. ``top`` and ``drums`` are those of Psycharis, Fragiadakis and Stefanou (2013).
SHORT = {one.short: one.key for one in MEASURES if one.short}

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
    found = _SPEC.fullmatch(text.strip())
    try:
        level = float(found["level"]) if found else math.nan
    except ValueError:
        level = math.nan
    if found is None or not 0.0 < level < 1e6:
        raise InputError(
            f"state {text!r} cannot be read; allowed is collapse, a level in base diameters such as {', '.join(LEVELS)}, "
            "or a measure of runs and its level, such as peak_rotation_rad:0.05.",
            "state",
        )
    if found["what"] in SHORT and found["unit"] is None:
        unit = f"write {text.strip()}d for base diameters, or {text.strip()}m"
        raise InputError(f"state {text!r} has no unit; {unit}.", "state")
    return LimitState(SHORT.get(found["what"], found["what"]), level, found["unit"] == "d")
