"""New Zealand's GeoNet, volumes 1 (V1A, uncorrected) and 2 (V2A, corrected): mm/s², three components in one file."""

from __future__ import annotations

import re

from ...errors import InputError
from ..specs import acceleration_unit
from .numbers import read_numbers
from .record import Component, check_count, oriented
from .source import Source

TEXT_LINES, INTEGER_LINES, REAL_LINES = 16, 4, 6
_UNIT = re.compile(r"units\s+of\s+(?P<size>[\d.]+)\s*(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_PEAK = re.compile(r"acceleration:\s+peak\s+[-\d.]+\s*(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_START = re.compile(r"^\s*(un)?corrected\s+accelerogram", re.IGNORECASE)


def recognises(source: Source) -> bool:
    """Whether the first lines are those of GeoNet."""
    lines = source.head.split("\n")
    return _START.match(lines[0]) is not None and len(lines) > 1 and lines[1].startswith("site ")


def read(source: Source) -> tuple[list[Component], dict]:
    """All components and what the headers say."""
    lines, file = source.lines, source.name
    starts = [i for i, line in enumerate(lines) if _START.match(line)]
    components = [_component(lines, a, b, file) for a, b in zip(starts, [*starts[1:], len(lines)])]
    first = lines[:TEXT_LINES]
    corrected = not lines[0].lower().lstrip().startswith("un")
    return components, {
        "format": "GeoNet V2A" if corrected else "GeoNet V1A",
        "stage": "corrected" if corrected else "uncorrected",
        "unit": components[0].metadata["unit"],
        "station": first[1].split()[1] if len(first[1].split()) > 1 else None,
        "station_name": first[2].strip() or None,
        "network": "NZ",
        "event": f"{first[6].strip()}; {first[8].strip()}",
        "start_time": first[7].strip() or None,
    }


def _component(lines: list[str], start: int, end: int, file: str) -> Component:
    text = lines[start : start + TEXT_LINES]
    integers_at = start + TEXT_LINES
    reals_at = integers_at + INTEGER_LINES
    first = reals_at + REAL_LINES
    if first >= end:
        raise InputError(
            f"{file}, line {start + 1}: the component that begins here ends within its header; fetch it again."
        )
    integers = read_numbers(lines[integers_at:reals_at], integers_at, file, "header integers", count=40, width=8)
    reals = read_numbers(lines[reals_at:first], reals_at, file, "header reals", count=60, width=8)
    count = check_count(float(integers[33]), file, integers_at + 4)  # accelerations; then velocities, displacements
    rows = -(-count // 10)
    values = read_numbers(lines[first : min(first + rows, end)], first, file, "accelerations", count=count, width=8)
    dt = float(reals[25])
    if not dt > 0.0:
        raise InputError(
            f"{file}, line {reals_at + 3}: expected the step of the samples, found {dt:g}; fetch it again."
        )
    factor = 1.0
    for line in text:
        if found := _UNIT.search(line) or _PEAK.search(line):
            factor = float(found["size"]) if "size" in found.groupdict() else 1.0
            unit, size = acceleration_unit(found["unit"])
            break
    else:
        raise InputError(f"{file}, below line {start + 1}: the header states no unit, where mm/s/s is expected.")
    stated = next((line for line in text if line.lower().startswith("component")), "")
    component = Component(values * (size * factor), dt, " ".join(stated.split()[1:2]))
    component.metadata["unit"] = unit if factor == 1.0 else f"{factor:g} {unit}"
    return oriented(component)
