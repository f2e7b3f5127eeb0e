"""The older text files of the Turkish network (AFAD): three columns in gal, by their heading."""

from __future__ import annotations

import re

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import NUMBER, read_numbers
from stylobate.motion.readers.record import Component
from stylobate.motion.readers.source import Source

from .stated import check_count, check_peak, check_step, oriented
from .volume1 import is_numeric, keyed, number_of

#: Labels of the format, by the words of its heading.
_LABELS = {
    "NS": "N-S", "N": "N-S", "NORTH": "N-S", "EW": "E-W", "E": "E-W", "EAST": "E-W", "UD": "U-D", "U": "U-D", "UP": "U-D",
    "Z": "U-D",
}  # fmt: skip


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
    above = lines[start - 1].strip()
    words = [] if ":" in above else above.upper().replace("(GAL)", " ").split()
    labels = [_LABELS.get(re.sub("[-/]", "", word.strip("()"))) for word in words] or ["N-S", "E-W", "U-D"]
    if sorted(map(str, labels)) != ["E-W", "N-S", "U-D"]:
        raise InputError(
            f"{file}, line {start}: {above!r} does not name the three columns, as N-S, E-W, U-D in gal do; convert the file "
            "to columns under a header such as time_s,ax_g."
        )
    table = read_numbers(lines[start:], start, file, "rows of three accelerations", count=3 * count).reshape(-1, 3)
    components = [oriented(Component(values * 0.01, dt, str(label))) for label, values in zip(labels, table.T)]
    peaks, line = next((entry for key, entry in header.items() if "pga values" in key), ("", 0))
    stated_peaks = re.findall(rf"(?:([NEU]-[SWD])\W*?)?({NUMBER})", peaks.upper())
    if len(stated_peaks) == 3:  # of the raw record: the one in the file may be corrected
        named = dict(stated_peaks)
        for component, (_, in_order) in zip(components, stated_peaks):
            peak = named.get(component.label, in_order)
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
