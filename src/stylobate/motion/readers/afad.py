"""The older text files of the Turkish network (AFAD): three columns N-S, E-W, U-D in gal."""

from __future__ import annotations

import re

from ...errors import InputError
from .checks import check_peak, check_step
from .keyed import is_numeric, keyed, number_of
from .numbers import NUMBER, read_numbers
from .record import Component, check_count, oriented
from .source import Source


def recognises(source: Source) -> bool:
    """Whether the first line names the network's collection."""
    return "strong ground motion records of turk" in source.head[:200]


def read(source: Source) -> tuple[list[Component], dict]:
    """Three components and what the header says."""
    lines, file = source.lines, source.name
    start = next((i for i, line in enumerate(lines[:60]) if is_numeric(line)), None)
    if start is None:
        raise InputError(f"{file}: no rows of numbers within the first 60 lines; fetch the file again.")
    header = keyed(lines[:start])
    if "gal" not in "\n".join(lines[:start]).lower() and "cm/s" not in "\n".join(lines[:start]).lower():
        raise InputError(f"{file}: the header states no unit, where gal is expected; convert the file to columns.")
    stated, line = number_of(header, "number of data", file)
    count = check_count(stated, file, line)
    stated_dt, line_of_step = number_of(header, "sampling interval", file)
    dt = check_step(stated_dt, file, line_of_step)
    heading = lines[start - 1].upper().split()
    labels = [word for word in heading if word.strip("().") in ("N-S", "E-W", "U-D")]
    labels = labels if len(labels) == 3 else ["N-S", "E-W", "U-D"]
    table = read_numbers(lines[start:], start, file, "rows of three accelerations", count=3 * count).reshape(-1, 3)
    components = [oriented(Component(table[:, i] * 0.01, dt, label)) for i, label in enumerate(labels)]
    peaks, line = next((entry for key, entry in header.items() if "pga values" in key), ("", 0))
    stated_peaks = re.findall(NUMBER, peaks)
    if len(stated_peaks) == 3:  # of the raw record: the one in the file may be corrected
        for component, peak in zip(components, stated_peaks):
            check_peak(component.values, peak, 0.01, file, line, wrong=0.2)
    text = {key: value for key, (value, _) in header.items()}
    return components, {
        "format": "AFAD text",
        "stage": "not stated",
        "unit": "gal",
        "station": text.get("station id") or None,
        "station_name": text.get("place") or None,
        "network": "TK",
        "event": text.get("earthquake date") or None,
        "start_time": text.get("record time") or None,
    }
