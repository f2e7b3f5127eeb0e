"""One component under lines ``Key : value``: Europe's ESM and Italy's ITACA (DYNA headers), and their predecessors.

The Turkish network publishes its recent records with the header of ESM. Files of the European strong-motion CD-ROMs and
of the first ITACA (``.cor``, ``.cor.acc``) name the same things in other words.
"""

from __future__ import annotations

import re

import numpy as np

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import number_in, read_numbers
from stylobate.motion.readers.record import CUT, Component
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import acceleration_unit

from .stated import check_count, check_length, check_peak, check_peak_time, check_step, oriented
from .volume1 import is_numeric, number_after

#: Beginnings of the keys, after ``_`` has become a blank.
_KEYS = {
    "count": re.compile(r"n ?data\b|npts\b|(total )?(number|no\.?|num\.?) of (data|samples|points)\b"),
    "step": re.compile(r"(sampling|sample|time) (interval|period|step)\b|delta t\b|dt\b"),
    "rate": re.compile(r"(sampling|sample) (rate|frequency)\b"),
    "unit": re.compile(r"units?\b"),
    "label": re.compile(r"stream\b|component\b|channel\b|orientation\b"),
    "length": re.compile(r"duration\b|(record )?length\b"),
    "peak": re.compile(r"pga\b|peak (ground )?acceleration\b"),
    "peak time": re.compile(r"time pga\b|time of (pga|peak)"),
    "type": re.compile(r"data type\b"),
}
#: Of Italy's older headers: west-east is positive to the east.
_TO_EAST = {"WE": "EW", "W-E": "E-W"}
#: Width of the numbers in the older files, five to a line.
WIDTH = 14


def recognises(source: Source) -> bool:
    """Whether lines ``Key : value`` at the beginning name a number of samples and their step."""
    lines = source.head.split("\n")
    keys = [_key(line) for line in lines if ":" in line and not line.startswith("#")]
    return (
        len(keys) >= 4
        and ":" in next((line for line in lines if line.strip()), "")
        and any(_KEYS["count"].match(key) for key in keys)
        and any(_KEYS["step"].match(key) or _KEYS["rate"].match(key) for key in keys)
    )


def read(source: Source) -> tuple[list[Component], dict]:
    """The component and what the header says."""
    lines, file = source.lines, source.name
    start = next((i for i, line in enumerate(lines) if is_numeric(line)), len(lines))
    text: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(lines[:start], 1):
        key, colon, value = line.partition(":")
        if colon and key.strip():
            text.setdefault(_key(key), (value.strip(), number))
    fields = {
        name: next((entry for key, entry in text.items() if pattern.match(key) and entry[0]), ("", 0))
        for name, pattern in _KEYS.items()
    }
    kind, line = fields["type"]
    if kind and ("ACCELERATION" not in kind.upper() or "SPECTRUM" in kind.upper()):
        raise InputError(f"{file}, line {line}: data_type is {kind}; give the file of accelerations.")
    unit, size = _unit(fields["unit"], file)
    count = check_count(number_after(*fields["count"], "NDATA", file), file, fields["count"][1])
    if fields["step"][0]:
        dt = check_step(number_after(*fields["step"], "SAMPLING_INTERVAL", file), file, fields["step"][1])
    else:
        rate = number_after(*fields["rate"], "SAMPLING RATE", file)
        dt = check_step(1.0 / rate if rate > 0.0 else None, file, fields["rate"][1])
    values = _values(lines, start, count, file)
    label = _TO_EAST.get(fields["label"][0].upper(), fields["label"][0])
    component = oriented(Component(values * size, dt, label, metadata={"unit": unit}))
    check_length(count, dt, _first_word(fields["length"][0]), file, fields["length"][1])
    check_peak(component.values, _first_word(fields["peak"][0]), size, file, fields["peak"][1])
    check_peak_time(component.values, dt, _first_word(fields["peak time"][0]), file, fields["peak time"][1])
    facts = {key: value for key, (value, _) in text.items() if value}
    terms = [
        facts[key] for key in ("data license", "data citation") if key in facts and "NOT PRESENT" not in facts[key]
    ]
    dyna = "header format" in text or "database version" in text or "sampling interval s" in text
    return [component], {
        "format": "ESM / ITACA ASCII (DYNA)" if dyna else "ESM / ITACA ASCII",
        "stage": facts.get("processing") or facts.get("baseline correction"),
        "unit": unit,
        "station": facts.get("station code"),
        "station_name": facts.get("station name"),
        "network": facts.get("network"),
        "event": facts.get("event name") or facts.get("event id") or facts.get("earthquake name"),
        "event_id": facts.get("event id"),
        "start_time": facts.get("date time first sample yyyymmdd hhmmss") or facts.get("time of first sample"),
        "terms": "; ".join(terms) or None,
    }


def _values(lines: list[str], start: int, count: int, file: str) -> np.ndarray:
    """The accelerations; blocks of velocity and displacement may follow, each as long."""
    end = next((i for i in range(start, len(lines)) if not _is_data(lines[i])), len(lines))
    values = read_numbers(lines[start:end], start, file, "accelerations", count=count, width=WIDTH)
    while end < len(lines):
        if not re.match(r"\s*(->|stop\b|$)", lines[end], re.IGNORECASE):
            shown = lines[end].strip()[:40]
            raise InputError(f"{file}, line {end + 1}: expected numbers (accelerations), found {shown!r}; {CUT}.")
        first = end + 1
        end = next((i for i in range(first, len(lines)) if not _is_data(lines[i])), len(lines))
        if end > first:
            read_numbers(lines[first:end], first, file, "velocities or displacements", count=count, width=WIDTH)
    return values


def _is_data(line: str) -> bool:
    return bool(line.strip()) and (is_numeric(line) or not re.match(r"\s*(->|stop\b)", line, re.IGNORECASE))


def _unit(stated: tuple[str, int], file: str) -> tuple[str, float]:
    """The first unit of acceleration in the value: ``cm/s^2``, or ``m/s*s, m/s & s`` for three blocks."""
    value, _ = stated
    if not value:
        raise InputError(f"{file}: the header states no UNITS; add them, as in UNITS: cm/s^2.")
    return acceleration_unit(re.split(r"[,;&]", value)[0].strip().replace("/s*s", "/s2").replace("(s*s)", "s2"))


def _first_word(value: str) -> str | None:
    """The number that a value begins with, as printed; None where it begins with none."""
    match = re.match(r"[+-]?[0-9.]+(?:[eEdD][+-]?[0-9]+)?", value.strip())
    return match.group() if match and number_in(match.group()) is not None else None


def _key(line: str) -> str:
    """``SAMPLING_INTERVAL_S: 0.005`` → ``sampling interval s``."""
    return " ".join(line.partition(":")[0].lower().replace("_", " ").split())
