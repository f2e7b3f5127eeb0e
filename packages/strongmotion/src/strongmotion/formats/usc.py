"""Volume 1 of the University of Southern California's Los Angeles network: film digitised at unequal steps."""

from __future__ import annotations

import re

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion.readers.numbers import read_numbers
from stylobate.motion.readers.record import Component
from stylobate.motion.readers.source import Source

from .stated import check_count, check_ended, oriented
from .volume1 import channel_end, channels, pairs, unit

TEXT_LINES = 13
#: Width of a number among the samples [characters], and numbers of a row.
WIDTH, PER_ROW = 7, 10
_CODES = {400: "Vert", 500: "Up", 600: "Down", 700: "Long", 800: "Tran"}


def recognises(source: Source) -> bool:
    """Whether the first line is that of USC's volume 1."""
    return "of uncorrected accelerogram data of" in source.head.split("\n")[0]


def read(source: Source) -> tuple[list[Component], dict]:
    """All channels and what the headers say."""
    lines, file = source.lines, source.name
    components = channels(lines, lambda start: _channel(lines, start, file))
    return components, {"format": "USC V1", "stage": "uncorrected", "network": "LA", **components[0].metadata}


def _rows(lines: list[str], count: int) -> tuple[list[str], bool]:
    """Lines from the first sample on, without the blank that may begin their rows (1X,10F7.3); whether all are there."""
    full, rest = divmod(2 * count, PER_ROW)
    widths = [WIDTH * PER_ROW] * full + [WIDTH * rest] * (rest > 0)
    rows = [line.rstrip() for line in lines[: len(widths)]]
    lead = len(rows[0]) - widths[0] == 1 and all(row[:1] in ("", " ") for row in rows)
    rows = [row[1:] for row in rows] if lead else rows
    return [*rows, *lines[len(widths) :]], [len(row) for row in rows] == widths


def _channel(lines: list[str], start: int, file: str) -> tuple[Component, int]:
    """One channel; the index of the line after it."""
    first = start + TEXT_LINES
    reals_at = first
    while reals_at < len(lines) and lines[reals_at].strip() and "." not in lines[reals_at]:
        reals_at += 1
    rows = reals_at - first
    if rows not in (5, 7) or reals_at + 7 >= len(lines):
        raise InputError(
            f"{file}, line {first + 1}: expected 7 (or 5) lines of integers and 7 of reals after the text, found "
            f"{rows} of integers; the file is damaged or cut, fetch it again."
        )
    # 100 integers: 16 of width 5 to a line, or 20 of width 4.
    width = 5 if rows == 7 else 4
    integers = read_numbers(lines[first:reals_at], first, file, "header integers", count=100, width=width)
    reals = read_numbers(lines[reals_at : reals_at + 7], reals_at, file, "header reals", count=50, width=10)
    count = check_count(float(integers[27]), file, first + 2)
    data = reals_at + 7
    rows, whole = _rows(lines[data:], count)
    lines = [*lines[:data], *rows]
    end, marked = channel_end(lines, data)
    component = pairs(lines, data, end, count, file, width=WIDTH, total=float(reals[2]))
    check_ended(whole or marked, file, end + 1, "/&")
    fraction = float(reals[4])
    if fraction > 0.0:
        size, label = fraction * g, "g/10" if abs(fraction - 0.1) < 1e-9 else f"{fraction:g} g"
    else:
        label, size = unit(lines[start:first], "g/10", file, start)
    component.values = component.values * size
    component.metadata = {
        "unit": label,
        "station": f"{int(integers[8])}",
        "station_name": re.split(r"\s{2,}", lines[start + 5].strip())[0] or None,
        "event": re.split(r"\s{2,}", lines[start + 1].strip())[0] or None,
    }
    code = int(integers[26])
    component.label = _CODES.get(code, f"{code} deg" if 0 <= code <= 360 else f"code {code}")
    return oriented(component), end + marked
