"""New Zealand's GeoNet, volumes 1 (V1A, uncorrected) and 2 (V2A, corrected): mm/s², three components in one file."""

from __future__ import annotations

import re

import numpy as np

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import NUMBER, read_numbers
from stylobate.motion.readers.record import CUT, Component, check_same_step
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import acceleration_unit

from .stated import (
    LABEL,
    check_count,
    check_direction,
    check_length,
    check_peak,
    check_peak_time,
    check_step,
    oriented,
    warn_of_missing,
)

TEXT_LINES, INTEGER_LINES, REAL_LINES = 16, 4, 6
_UNIT = re.compile(r"units\s+of\s+(?P<size>[\d.]+)\s*(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_PEAK = re.compile(
    rf"acceleration:\s+peak\s+(?P<peak>{NUMBER})\s*(?P<unit>[a-z][a-z/0-9]*)(?:\s+at\s+(?P<time>{NUMBER})\s*s)?",
    re.IGNORECASE,
)
_POINTS = re.compile(
    rf"number\s+of\s+points\s+(?P<count>\d+)(?:\s+duration\s+(?P<length>{NUMBER})\s*s)?", re.IGNORECASE
)
_STEP = re.compile(rf"at\s+(?:intervals\s+of\s+)?(?P<step>{NUMBER})\s*s(?:ec)?(?:\s+intervals)?\s*$", re.IGNORECASE)
_LABEL = re.compile(rf"component\s+(?P<label>{LABEL})", re.IGNORECASE)
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
    warn_of_missing(len(components), 3, file)
    corrected = not lines[0].lower().lstrip().startswith("un")
    return components, {
        "format": "GeoNet V2A" if corrected else "GeoNet V1A",
        "stage": "corrected" if corrected else "uncorrected",
        "network": "NZ",
        **components[0].metadata,
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
    _check_rest(lines, first + rows, end, integers, file)
    dt = check_step(float(reals[25]), file, reals_at + 3)
    _check_header(text, start, count, dt, file)
    factor = 1.0
    for line in text:
        if match := _UNIT.search(line) or _PEAK.search(line):
            factor = float(match["size"]) if "size" in match.groupdict() else 1.0
            unit, size = acceleration_unit(match["unit"])
            break
    else:
        raise InputError(f"{file}, below line {start + 1}: the header states no unit, where mm/s/s is expected.")
    label = next((match["label"] for line in text if (match := _LABEL.match(line))), "")
    component = Component(values * (size * factor), dt, label)
    component.metadata = {"unit": unit if factor == 1.0 else f"{factor:g} {unit}"} | _facts(text)
    for number, line in enumerate(text, start + 1):
        if match := _PEAK.search(line):
            check_peak(component.values, match["peak"], acceleration_unit(match["unit"])[1], file, number)
            _check_time(component, reals, match["time"], file, number)
    component = oriented(component)
    check_direction(component, float(integers[27]), file, integers_at + 3)
    return component


def _facts(text: list[str]) -> dict:
    return {
        "station": text[1].split()[1] if len(text[1].split()) > 1 else None,
        "station_name": text[2].strip() or None,
        "event": f"{text[6].strip()}; {text[8].strip()}",
        "start_time": text[7].strip() or None,
    }


def _check_time(component: Component, reals: np.ndarray, stated: str | None, file: str, line: int) -> None:
    """The time of the peak counts from the record's first sample, after the padding that real 22 states."""
    if stated is not None:
        time = float(stated) + max(0.0, float(reals[21]))
        check_peak_time(component.values, component.dt, time, file, line)


def _check_rest(lines: list[str], at: int, end: int, integers: np.ndarray, file: str) -> None:
    """Velocities and displacements follow, as many as the header promises, and nothing else."""
    for stated, what in ((integers[34], "velocities"), (integers[35], "displacements")):
        if stated <= 0.0:
            continue
        count = check_count(float(stated), file, at + 1)
        rows = -(-count // 10)
        read_numbers(lines[min(at, end) : min(at + rows, end)], at, file, what, count=count, width=8)
        at += rows
    if at < end and any(line.strip() for line in lines[at:end]):
        raise InputError(f"{file}, line {at + 1}: more follows than the header promises; {CUT}.")


def _check_header(text: list[str], start: int, count: int, dt: float, file: str) -> None:
    """Count, length and step in the text are those of the numbers."""
    for number, line in enumerate(text, start + 1):
        if match := _POINTS.search(line):
            if int(match["count"]) != count:
                raise InputError(f"{file}, line {number}: {match['count']} points, but {count} further below; {CUT}.")
            check_length(count, dt, match["length"], file, number)
        if match := _STEP.search(line):
            check_same_step(dt, float(match["step"]), file, number)
