"""Chile's RENADIC network, volume 1: pairs of time and acceleration in g/10."""

from __future__ import annotations

import re

from stylobate.motion.readers.record import Component
from stylobate.motion.readers.source import Source

from .stated import LABEL, check_ended, oriented, warn_of_missing
from .volume1 import channel_end, channels, check_stated_peak, header_ends, length, pairs, points, unit

TEXT_LINES, HEADER_LINES = 13, 27
_CHANNELS = re.compile(r"\(\s*(?P<count>\d+)\s+chns\b", re.IGNORECASE)


def recognises(source: Source) -> bool:
    """Whether the text block names the network."""
    return "universidad de chile - renadic" in source.head


def read(source: Source) -> tuple[list[Component], dict]:
    """All channels and what the headers say."""
    lines, file = source.lines, source.name
    components = channels(lines, lambda start: _channel(lines, start, file))
    stated = next((int(match["count"]) for line in lines[:TEXT_LINES] if (match := _CHANNELS.search(line))), None)
    warn_of_missing(len(components), None if stated is None else min(stated, 3), file)
    return components, {"format": "RENADIC V1", "stage": "uncorrected", "network": "C", **components[0].metadata}


def _channel(lines: list[str], start: int, file: str) -> tuple[Component, int]:
    """One channel; the index of the line after it."""
    text = lines[start : start + TEXT_LINES]
    data = start + HEADER_LINES
    if data >= len(lines):
        raise header_ends(file, start)
    count = points(text, file, start)
    end, marked = channel_end(lines, data)
    check_ended(marked, file, end + 1, "/&")
    component = pairs(lines, data, end, count, file, width=7, total=length(text))
    stated, size = unit(text, "g/10", file, start)
    component.metadata = {
        "unit": stated,
        "station": text[5].upper().split("S/N")[0].strip() or None,
        "event": text[1].strip() or None,
        "start_time": text[3].strip() or None,
    }
    component.values = component.values * size
    check_stated_peak(component, text, file, start)
    component.label = re.sub(r"^\W*(comp\w*|chan\w*|canal)\W*(\d+\W+)?", "", text[6].strip(), flags=re.IGNORECASE)
    match = re.match(LABEL, component.label, re.IGNORECASE)
    component.label = match.group() if match else ""
    return oriented(component), end + 1
