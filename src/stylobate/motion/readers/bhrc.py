"""Iran's BHRC network, volume 1: three components in g/10, ten numbers of width 13 to a line."""

from __future__ import annotations

import re

from ...errors import InputError
from .numbers import read_numbers
from .record import Component, oriented
from .source import Source
from .volume1 import channel_end, length, points, unit

TEXT_LINES, HEADER_LINES = 13, 27


def recognises(source: Source) -> bool:
    """Whether the first and the seventh line are those of the format."""
    first = source.head.split("\n")[:8]
    return first[0].startswith("* vol") and any(line.startswith("comp") for line in first)


def read(source: Source) -> tuple[list[Component], dict]:
    """All components and what the headers say."""
    lines, file = source.lines, source.name
    components = []
    start = 0
    while start < len(lines):
        if not lines[start].strip():
            start += 1
            continue
        text = lines[start : start + TEXT_LINES]
        data = start + HEADER_LINES
        if data >= len(lines):
            raise InputError(
                f"{file}, line {start + 1}: the channel that begins here ends within its header; fetch it again."
            )
        count = points(text, file, start)
        total = length(text)
        if total is None or total <= 0.0:
            raise InputError(f"{file}, below line {start + 1}: expected the length of the record in s; fetch it again.")
        end = channel_end(lines, data)
        values = read_numbers(lines[data:end], data, file, "accelerations", count=count, width=13)
        component = Component(values, total / (count - 1), text[4].strip())
        component.metadata["unit"], size = unit(text, "g/10")
        component.values = values * size
        component = oriented(component)
        component.azimuth = _azimuth(component.label, text[7])
        components.append(component)
        start = end + 1
    number = re.search(r":\s*([^/\s]+)", lines[0])
    return components, {
        "format": "BHRC V1",
        "stage": "uncorrected",
        "unit": components[0].metadata["unit"],
        "station": number.group(1) if number else None,
        "station_name": re.split(r"station", lines[7], flags=re.IGNORECASE)[0].strip() or None,
        "network": "I1",
        "event": lines[2].strip() or None,
    }


def _azimuth(label: str, place: str) -> float | None:
    """Azimuth of the longitudinal (L) or transverse (T) component: the 4th and 5th number after the word station."""
    numbers = re.findall(r"[+-]?(?:\d+\.?\d*|\.\d+)", re.split(r"station", place, flags=re.IGNORECASE)[-1])
    index = {"L": 3, "T": 4}.get(label.strip().upper())
    return float(numbers[index]) % 360.0 if index is not None and len(numbers) > index else None
