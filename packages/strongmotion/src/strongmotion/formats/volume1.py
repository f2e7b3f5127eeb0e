"""Common form of the descendants of Caltech's volume 1: blocks of text, integers and reals, then times and accelerations."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from stylobate.errors import InputError, within
from stylobate.motion.readers.numbers import NUMBER, number_in, read_numbers
from stylobate.motion.readers.record import CUT, Component, rising_pairs, step_of
from stylobate.motion.specs import acceleration_unit

from .stated import check_count, check_peak, check_peak_time, printed

# Headers of lines ``KEY: value`` or ``KEY   value``, as several networks write them.

_NUMERIC = re.compile(r"\s*[+-]?([0-9]|\.[0-9])[0-9\s.eEdD+-]*")


def is_numeric(line: str) -> bool:
    """Whether a line holds numbers and nothing else."""
    return _NUMERIC.fullmatch(line) is not None


def keyed(lines: Sequence[str]) -> dict[str, tuple[str, int]]:
    """Value and line (from 1) by key in lower case, for lines ``KEY: value``; the first of equal keys counts."""
    entries: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(lines, 1):
        key, colon, value = line.partition(":")
        if colon and key.strip():
            entries.setdefault(" ".join(key.lower().split()), (value.strip(), number))
    return entries


def number_of(header: dict[str, tuple[str, int]], key: str, file: str) -> tuple[float, int]:
    """The first number of a value, and its line.

    Raises
    ------
    InputError
        The key is missing, or holds no number.
    """
    value, line = next((entry for name, entry in header.items() if name.startswith(key)), ("", 0))
    return number_after(value, line, key.upper(), file), line


def number_after(value: str, line: int, key: str, file: str) -> float:
    """The number that a value begins with.

    Raises
    ------
    InputError
        It begins with none.
    """
    number = number_in(value)
    if number is None:
        where = f"line {line}" if line else "header"
        raise InputError(f"{file}, {where}: expected a number after {key!r}, found {value!r}; fetch it again.")
    return number


Channel = TypeVar("Channel")

_POINTS = re.compile(
    r"(?:no\.?|num\w*)\s*(?:of)?\s*(?:points|data|samples)[^\w+-]*(?P<count>\d+)(?![\w.])", re.IGNORECASE
)
_LENGTH = re.compile(rf"(?:duration|record\s+length|length)\s*[=:]?\s*(?P<length>{NUMBER})(?=\s|s|$)", re.IGNORECASE)
_UNIT = re.compile(
    r"units?\b.*?\band\s+(?P<unit>[a-z][a-z/0-9]*)|in units of\s+(?P<only>[a-z][a-z/0-9]*)", re.IGNORECASE
)
_PEAK = re.compile(
    rf"\bmax\s*=\s*(?P<peak>{NUMBER})\s*(?P<unit>[a-z][a-z/0-9]*)\s*,?\s*at\s+(?P<time>{NUMBER})\s*sec", re.IGNORECASE
)

#: A line between two channels.
END = re.compile(r"^\s*(/&|-&|\*?\s*-*\s*end of|\*{3,}|-{5,})", re.IGNORECASE)


def channels(lines: Sequence[str], read: Callable[[int], tuple[Channel, int]]) -> list[Channel]:
    """All channels of a file, one behind the other with nothing but empty lines between them.

    Parameters
    ----------
    lines : sequence of str
    read : callable
        Given the index of the line on which a channel begins, gives the channel and the index of the line after it.
    """
    all_channels, at = [], 0
    while at < len(lines):
        if lines[at].strip():
            channel, at = read(at)
            all_channels.append(channel)
        else:
            at += 1
    return all_channels


def header_ends(file: str, start: int) -> InputError:
    """The error for a file that ends before the samples of a channel begin."""
    return InputError(f"{file}, line {start + 1}: the channel that begins here ends within its header; fetch it again.")


def points(text: Sequence[str], file: str, first: int) -> int:
    """Number of samples as the text block states it."""
    for number, line in enumerate(text, first + 1):
        if match := _POINTS.search(line):
            return check_count(float(match["count"]), file, number)
    raise InputError(
        f"{file}, below line {first + 1}: expected NO. OF POINTS = …; the header is damaged, fetch it again."
    )


def length(text: Sequence[str]) -> str | None:
    """Length of the record as the text block states it [s], as printed."""
    return next((match["length"] for line in text if (match := _LENGTH.search(line))), None)


def unit(text: Sequence[str], otherwise: str, file: str, first: int) -> tuple[str, float]:
    """Unit that the text block states, or the one of the format where it states none."""
    for number, line in enumerate(text, first + 1):
        if match := _UNIT.search(line):
            stated = (match["unit"] or match["only"]).rstrip(".")
            with within(f"{file}, line {number}"):
                return acceleration_unit(stated)
    return acceleration_unit(otherwise)


def pairs(
    lines: list[str], first: int, end: int, count: int, file: str, width: int, total: str | float | None = None
) -> Component:
    """Pairs of time and acceleration, as digitised from film at unequal steps; values are not scaled yet.

    Parameters
    ----------
    total : str or float, optional
        Length of the record that the header states [s].
    """
    numbers = read_numbers(
        lines[first:end], first, file, "pairs of time and acceleration", count=2 * count, width=width
    )
    time, values = rising_pairs(numbers, file, first, end - first)
    if total is not None and (stated := printed(total))[0] > 0.0:
        # Counted from zero or from the first sample, to the last one or a step further.
        slack = 2.0 * float(np.diff(time).max()) + stated[1]
        if min(abs(time[-1] - stated[0]), abs(time[-1] - time[0] - stated[0])) > slack:
            raise InputError(
                f"{file}, below line {first + 1}: the times run from {time[0]:g} to {time[-1]:g} s, the header states a "
                f"length of {stated[0]:g} s; {CUT}."
            )
    step = step_of(time)
    component = Component(values, np.nan, time=time) if step is None else Component(values, step)
    component.first = float(time[0])
    return component


def check_stated_peak(component: Component, text: Sequence[str], file: str, first: int) -> None:
    """The peak that the text block states, as in ``MAX = -.353 G, AT 48.355 SEC``, is that of the samples."""
    for number, line in enumerate(text, first + 1):
        if (match := _PEAK.search(line)) and not re.search(r"uncor\s+max", line, re.IGNORECASE):
            check_peak(component.values, match["peak"], acceleration_unit(match["unit"])[1], file, number)
            if component.time is None:
                check_peak_time(component.values, component.dt, match["time"], file, number)


def channel_end(lines: list[str], first: int) -> tuple[int, bool]:
    """Index of the line that ends the samples which begin at ``first``, and whether it is a mark of that."""
    end = next((i for i in range(first, len(lines)) if re.search(r"[a-df-zA-DF-Z&*/]", lines[i])), len(lines))
    return end, end < len(lines) and END.match(lines[end]) is not None
