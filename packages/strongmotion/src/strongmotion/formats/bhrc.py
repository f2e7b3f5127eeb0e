"""Iran's BHRC network, volume 1: three components in g/10, ten numbers of width 13 to a line."""

from __future__ import annotations

import re

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import number_in, read_numbers
from stylobate.motion.readers.record import CUT, Component
from stylobate.motion.readers.source import Source

from .stated import check_ended, check_length, check_step, oriented, printed, warn_of_missing
from .volume1 import channel_end, channels, header_ends, length, points, unit

TEXT_LINES, HEADER_LINES = 13, 27
#: Line of the reals, from the first line of the channel, that begins with the samples per second.
RATE_LINE = 21
_AZIMUTHS = re.compile(r"azimuth\s+l\s+(?P<l>\d{1,3})\s+t\s+(?P<t>\d{1,3})(?!\d)", re.IGNORECASE)


def recognises(source: Source) -> bool:
    """Whether the first and the seventh line are those of the format."""
    first = source.head.split("\n")[:8]
    return first[0].startswith("* vol") and any(line.startswith("comp") for line in first)


def read(source: Source) -> tuple[list[Component], dict]:
    """All components and what the headers say."""
    lines, file = source.lines, source.name
    components = channels(lines, lambda start: _component(lines, start, file))
    warn_of_missing(len(components), 3, file)
    return components, {"format": "BHRC V1", "stage": "uncorrected", "network": "I1", **components[0].metadata}


def _component(lines: list[str], start: int, file: str) -> tuple[Component, int]:
    text = lines[start : start + TEXT_LINES]
    data = start + HEADER_LINES
    if data >= len(lines):
        raise header_ends(file, start)
    count = points(text, file, start)
    total = length(text)
    if total is None or printed(total)[0] <= 0.0:
        raise InputError(f"{file}, below line {start + 1}: expected the length of the record in s; fetch it again.")
    label = text[4].strip()
    again = re.match(r"\s*comp\s+([a-z]+)", text[6], re.IGNORECASE)
    if again is not None and again.group(1).upper() != label.upper():
        raise InputError(
            f"{file}, lines {start + 5} and {start + 7}: the component is {label!r} and {again.group(1)!r}; {CUT}."
        )
    dt = check_step(_step(printed(total)[0], count, number_in(lines[start + RATE_LINE])), file, start + 11)
    check_length(count, dt, total, file, start + 11)
    end, marked = channel_end(lines, data)
    check_ended(marked, file, end + 1, "/&")
    values = read_numbers(lines[data:end], data, file, "accelerations", count=count, width=13)
    component = Component(values, dt, label)
    number = re.search(r":\s*([^/\s]+)", text[0])
    stated, size = unit(text, "g/10", file, start)
    component.metadata = {
        "unit": stated,
        "station": number.group(1) if number else None,
        "station_name": re.split(r"station", text[7], flags=re.IGNORECASE)[0].strip() or None,
        "event": text[2].strip() or None,
    }
    component.values = values * size
    component = oriented(component)
    if not component.vertical and (match := _AZIMUTHS.search(text[7])) and label.upper() in ("L", "T"):
        component.azimuth = float(match[label.lower()]) % 360.0
    return component, end + 1


def _step(total: float, count: int, rate: float | None) -> float:
    """Step from the length, which runs to the last sample or a step beyond it, and the rate where it is stated."""
    if rate is not None and rate > 0.0:
        return 1.0 / rate
    # The one that is a short decimal: 0.005 s, not 0.0050005 s.
    return min((total / (count - 1), total / count), key=lambda dt: abs(dt - float(f"{dt:.2g}")) / dt)
