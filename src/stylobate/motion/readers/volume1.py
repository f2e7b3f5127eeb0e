"""What the descendants of Caltech's volume 1 share: blocks of text, integers and reals, then times and "
"accelerations."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from ...errors import InputError
from ..specs import acceleration_unit
from .numbers import read_numbers
from .record import Component, check_count

_POINTS = re.compile(r"(?:no\.?|num\w*)\s*(?:of)?\s*(?:points|data|samples)\D*?(?P<count>\d+)", re.IGNORECASE)
_LENGTH = re.compile(r"(?:duration|record\s+length|length)\D*?(?P<length>\d*\.?\d+)\s*sec", re.IGNORECASE)
_UNIT = re.compile(
    r"units?\b.*?\band\s+(?P<unit>[a-z][a-z/0-9]*)|in units of\s+(?P<only>[a-z][a-z/0-9]*)", re.IGNORECASE
)

#: A line between two channels.
END = re.compile(r"^\s*(/&|-&|\*?\s*-*\s*end of|\*{3,}|-{5,})", re.IGNORECASE)


def points(text: Sequence[str], file: str, first: int) -> int:
    """Number of samples as the text block states it."""
    for number, line in enumerate(text, first + 1):
        if found := _POINTS.search(line):
            return check_count(float(found["count"]), file, number)
    raise InputError(
        f"{file}, below line {first + 1}: expected NO. OF POINTS = …; the header is damaged, fetch it again."
    )


def length(text: Sequence[str]) -> float | None:
    """Length of the record as the text block states it [s]."""
    return next((float(found["length"]) for line in text if (found := _LENGTH.search(line))), None)


def unit(text: Sequence[str], otherwise: str) -> tuple[str, float]:
    """Unit that the text block states, or the one of the format."""
    for line in text:
        if found := _UNIT.search(line):
            try:
                return acceleration_unit((found["unit"] or found["only"]).rstrip("."))
            except InputError:
                continue
    return acceleration_unit(otherwise)


def pairs(lines: list[str], first: int, end: int, count: int, file: str, width: int) -> Component:
    """Pairs of time and acceleration, as digitised from film at unequal steps; values are not scaled yet."""
    numbers = read_numbers(
        lines[first:end], first, file, "pairs of time and acceleration", count=2 * count, width=width
    )
    time, values = numbers.reshape(-1, 2).T.copy()
    if (np.diff(time) < 0.0).any():
        bad = int(np.flatnonzero(np.diff(time) < 0.0)[0]) + 1
        raise InputError(
            f"{file}, below line {first + 1}: the time falls at sample {bad + 1} ({time[bad]:g} s); mend it."
        )
    return Component(values, np.nan, time=time)


def channel_end(lines: list[str], first: int) -> int:
    """Index of the line that ends the samples which begin at ``first``."""
    return next((i for i in range(first, len(lines)) if re.search(r"[a-df-zA-DF-Z&*/]", lines[i])), len(lines))
