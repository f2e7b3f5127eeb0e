"""Europe's Engineering Strong-Motion database and Italy's ITACA: ASCII with a DYNA header, one component each.

The Turkish network publishes its recent records with the same header.
"""

from __future__ import annotations

from ...errors import InputError
from ..specs import acceleration_unit
from .keyed import is_numeric, keyed, number_of
from .numbers import read_numbers
from .record import Component, check_count, oriented
from .source import Source


def recognises(source: Source) -> bool:
    """Whether the header carries the keys of the format."""
    return "sampling_interval_s" in source.head and "ndata:" in source.head.replace(" ", "")


def read(source: Source) -> tuple[list[Component], dict]:
    """The component and what the header says."""
    lines, file = source.lines, source.name
    start = next((i for i, line in enumerate(lines) if is_numeric(line)), len(lines))
    header = keyed(lines[:start])
    text = {key: value for key, (value, _) in header.items()}
    if text.get("data_type", "ACCELERATION").upper() not in ("ACCELERATION", ""):
        raise InputError(
            f"{file}, line {header['data_type'][1]}: data_type is {text['data_type']}; give the file of accelerations."
        )
    if not text.get("units"):
        raise InputError(f"{file}: the header states no UNITS; add them, as in UNITS: cm/s^2.")
    unit, size = acceleration_unit(text["units"])
    dt, _ = number_of(header, "sampling_interval_s", file)
    stated, line = number_of(header, "ndata", file)
    count = check_count(stated, file, line)
    values = read_numbers(lines[start:], start, file, "accelerations", count=count)
    label = text.get("stream", "") or text.get("component", "")
    component = oriented(Component(values * size, dt, label, metadata={"unit": unit}))
    terms = [text[key] for key in ("data_license", "data_citation") if text.get(key) and "NOT PRESENT" not in text[key]]
    return [component], {
        "format": "ESM / ITACA ASCII (DYNA)",
        "stage": text.get("processing") or text.get("baseline_correction") or None,
        "unit": unit,
        "station": text.get("station_code") or None,
        "station_name": text.get("station_name") or None,
        "network": text.get("network") or None,
        "event": text.get("event_name") or text.get("event_id") or None,
        "start_time": text.get("date_time_first_sample_yyyymmdd_hhmmss") or None,
        "terms": "; ".join(terms) or None,
    }
