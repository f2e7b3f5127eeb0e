"""PEER's AT2 files, one component each: the strong-motion catalogue of the 1990s and the NGA databases."""

from __future__ import annotations

import re

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import NUMBER, number_in, read_numbers
from stylobate.motion.readers.record import Component
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import acceleration_unit

from .stated import check_count, check_length, check_step, oriented
from .volume1 import is_numeric

_UNIT = re.compile(
    r"accel\w*\s+time\s+(?:series|history)\s+in\s+units\s+of\s+(?P<unit>[a-z][a-z/0-9^]*)", re.IGNORECASE
)
_COUNT = (
    re.compile(r"npts\s*=\s*(?P<value>\d+)(?![\w.])", re.IGNORECASE),
    re.compile(r"^\s*(?P<value>\d+)\s+[\d.eE+-]+\s+npts\s*,\s*dt", re.IGNORECASE),
)
#: Lines above the numbers, whatever their order.
HEADER_LINES = 4
_STEP = (
    re.compile(rf"\bdt\s*=\s*(?P<value>{NUMBER})(?=\s|,|s|$)", re.IGNORECASE),
    re.compile(rf"^\s*\d+\s+(?P<value>{NUMBER})\s+npts\s*,\s*dt", re.IGNORECASE),
)


_LENGTH = re.compile(rf"\bduration\s*=\s*(?P<length>{NUMBER})", re.IGNORECASE)


def recognises(source: Source) -> bool:
    """Whether the four header lines of PEER stand at the beginning, in whatever order."""
    first = "\n".join(source.head.split("\n")[:8])
    return "npts" in first and "dt" in first and re.search(r"time (series|history)", first) is not None


def read(source: Source) -> tuple[list[Component], dict]:
    """The component and what the header says."""
    lines, file = source.lines, source.name
    head = lines[:8]
    at = max(i for i, line in enumerate(head) if "npts" in line.lower() or _UNIT.search(line))
    while at + 1 < HEADER_LINES and at + 1 < len(lines) and not is_numeric(lines[at + 1]):
        at += 1
    count = check_count(_value(head, _COUNT), file, at + 1)
    dt = _value(head, _STEP)
    if not dt:
        raise InputError(f"{file}, line {at + 1}: expected the step, as in DT= .0050 SEC; add it.")
    check_step(dt, file, at + 1)
    for number, line in enumerate(head, 1):
        if match := _LENGTH.search(line):
            check_length(count, dt, match["length"], file, number)
    stated = next((match for line in head if (match := _UNIT.search(line))), None)
    if stated is None:
        raise InputError(
            f"{file}, line 3: expected ACCELERATION TIME SERIES IN UNITS OF G; give the file of accelerations (AT2)."
        )
    unit, size = acceleration_unit(stated["unit"])
    values = read_numbers(lines[at + 1 :], at + 1, file, "accelerations", count=count)
    title = next((line for line in head if line.count(",") >= 2 and "npts" not in line.lower()), "")
    parts = [part.strip() for part in title.split(",")]
    label = parts[-1] if parts else ""
    component = oriented(Component(values * size, dt, label, metadata={"unit": unit}))
    facts = {"format": "PEER AT2", "stage": "processed", "unit": unit, "event": parts[0] or None}
    if len(parts) >= 3:
        facts["station"] = parts[-2]
        facts["start_time"] = parts[1] if len(parts) > 3 else None
    return [component], facts


def _value(head: list[str], patterns: tuple[re.Pattern, ...]) -> float | None:
    for line in head:
        for pattern in patterns:
            if match := pattern.search(line):
                return number_in(match["value"])
    return None
