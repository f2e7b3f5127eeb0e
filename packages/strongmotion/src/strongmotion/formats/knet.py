"""Japan's K-NET and KiK-net: one component each, counts with a scale factor in the header."""

from __future__ import annotations

import re
from datetime import datetime, timedelta

from stylobate.errors import InputError
from stylobate.messages import say
from stylobate.motion.readers.numbers import read_numbers
from stylobate.motion.readers.record import CUT, Component
from stylobate.motion.readers.source import Source

from .stated import check_count, check_peak, check_step, oriented

_KEYS = (
    "origin time",
    "station code",
    "sampling freq",
    "scale factor",
    "dir.",
    "record time",
    "duration time",
    "max. acc",
)
_SCALE = re.compile(r"(?P<full>[\d.]+)\s*\(\s*gal\s*\)\s*/\s*(?P<counts>[\d.]+)", re.IGNORECASE)
#: KiK-net numbers its sensors: 1 to 3 at the bottom of the borehole, 4 to 6 at the surface.
_KIK = {"1": "N-S", "2": "E-W", "3": "U-D", "4": "N-S", "5": "E-W", "6": "U-D"}


def recognises(source: Source) -> bool:
    """Whether the header carries the keys of the format."""
    return "scale factor" in source.head and "sampling freq(hz)" in source.head


def read(source: Source) -> tuple[list[Component], dict]:
    """The component and what the header says. The zero level of the counts, their mean, is taken off."""
    lines, file = source.lines, source.name
    header = {}
    for number, line in enumerate(lines[:25], 1):
        for key in _KEYS:
            if line.lower().startswith(key):
                header[key] = (line[18:].strip() if len(line) > 18 else "", number)
    start = next((i for i, line in enumerate(lines[:25]) if line.lower().startswith("memo")), 16) + 1
    scale, line = header.get("scale factor", ("", 0))
    match = _SCALE.search(scale)
    if match is None or float(match["counts"]) == 0.0:
        raise InputError(f"{file}, line {line}: expected a scale factor such as 2000(gal)/8388608, found {scale!r}.")
    size = float(match["full"]) / float(match["counts"]) * 0.01
    rate = re.match(r"[\d.]+", header.get("sampling freq", ("", 0))[0])
    if rate is None or float(rate.group()) <= 0.0:
        raise InputError(f"{file}: expected a sampling frequency such as 100Hz in the header; fetch the file again.")
    frequency = 1.0 / check_step(1.0 / float(rate.group()), file, header["sampling freq"][1])
    counts = read_numbers(lines[start:], start, file, "counts")
    check_count(len(counts), file, start + 1, "counts")
    length = re.match(r"[\d.]+", header.get("duration time", ("", 0))[0])
    # The network writes whole seconds.
    if length is not None and abs(len(counts) - float(length.group()) * frequency) >= 1.0:
        raise InputError(
            f"{file}, line {header['duration time'][1]}: {len(counts)} counts at {frequency:g} Hz last "
            f"{len(counts) / frequency:g} s, the header promises {length.group()} s; {CUT}."
        )
    zero = float(counts.mean())
    raw = header.get("dir.", ("", 0))[0]
    component = oriented(Component((counts - zero) * size, 1.0 / frequency, _KIK.get(str(raw), str(raw))))
    peak, line = header.get("max. acc", ("", 0))
    check_peak(component.values, peak or None, 0.01, file, line, wrong=0.1)  # of their own zero level
    component.metadata = {"unit": "counts", "m_s2_per_count": size, "direction_as_found": raw}
    component.processing.insert(
        0,
        say(
            "counts × {size:.6g} m/s², after the zero level of {zero:.6g} counts (their mean) was taken off",
            size=size,
            zero=zero,
        ),
    )
    place = {"1": "borehole", "2": "borehole", "3": "borehole", "4": "surface", "5": "surface", "6": "surface"}.get(raw)
    station = header.get("station code", ("", 0))[0] or None
    return [component], {
        "format": "K-NET / KiK-net",
        "stage": "raw counts",
        "unit": "counts",
        "station": station if place is None else f"{station} ({place})",
        "event": header.get("origin time", ("", 0))[0] or None,
        "start_time": _first_sample(header.get("record time", ("", 0))[0]),
    }


def _first_sample(recorded: str) -> str | None:
    """Time of the first sample: the record time minus the trigger delay of 15 s."""
    try:
        return str(datetime.strptime(recorded, "%Y/%m/%d %H:%M:%S") - timedelta(seconds=15.0))
    except (ValueError, OverflowError):
        return recorded or None
