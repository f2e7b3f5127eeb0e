"""Text files of Taiwan's network (TSMIP of the Central Weather Administration): times and three columns in gal."""

from __future__ import annotations

import re

import numpy as np

from stylobate.errors import InputError
from stylobate.messages import say
from stylobate.motion.readers.numbers import NUMBER, read_numbers
from stylobate.motion.readers.record import Component, check_same_step, step_of
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import acceleration_unit

from .stated import check_length, check_peak, check_step, oriented
from .volume1 import is_numeric, keyed, number_of

_COLUMN = re.compile(r"(?P<label>[UNE])\((?P<sign>[+-])\)")
_MOST = re.compile(rf"(?P<high>{NUMBER})\s*~\s*(?P<low>{NUMBER})")


def recognises(source: Source) -> bool:
    """Whether the first lines are those of the network."""
    return "#stationcode:" in source.head[:600] and "#datasequence:" in source.head[:1500]


def read(source: Source) -> tuple[list[Component], dict]:
    """Three components and what the header says."""
    lines, file = source.lines, source.name
    start = next((i for i, line in enumerate(lines[:60]) if is_numeric(line)), None)
    if start is None:
        raise InputError(f"{file}: no rows of numbers within the first 60 lines; fetch the file again.")
    header = keyed([line.strip().lstrip("#") for line in lines[:start]])
    text = {key: value for key, (value, _) in header.items()}
    unit = text.get("amplitudeunit", "").split(".")[0].strip()
    if acceleration_unit(unit or "gal")[0] != "gal" or not unit:
        raise InputError(f"{file}: AmplitudeUnit is {unit!r}, where gal is expected; convert the file to columns.")
    sequence, line = header.get("datasequence", ("", 0))
    time, *names = re.split(r"[;\s]+", sequence)
    matches = [_COLUMN.fullmatch(name) for name in names]
    if time != "Time" or sorted(match["label"] for match in matches if match) != ["E", "N", "U"]:
        raise InputError(
            f"{file}, line {line}: expected the columns Time U(+); N(+); E(+) in any order, found {sequence!r}; convert the "
            "file to columns under a header such as time_s,ax_g."
        )
    count = sum(1 for line in lines[start:] if line.strip())
    table = read_numbers(lines[start:], start, file, "rows of a time and three values", count=4 * count, width=10)
    times, *columns = table.reshape(-1, 4).T
    rate, line = number_of(header, "samplerate(hz)", file)
    dt, step = check_step(1.0 / rate if rate > 0.0 else None, file, line), step_of(times)
    check_same_step(dt, step or 0.0, file, line)
    check_length(count, dt, text.get("recordlength(sec)"), file, header.get("recordlength(sec)", ("", 0))[1])
    components = []
    for match, values in zip(matches, columns):
        assert match is not None
        if most := _MOST.search(text.get(f"amplitudemax. {match['label'].lower()}", "")):
            for stated, extreme in ((most["high"], values.max()), (most["low"], values.min())):
                check_peak(np.array([extreme]), stated, 1.0, file, start, wrong=0.05)
        sign = "" if match["sign"] == "+" else "-"
        component = Component(values * 0.01, dt, match["label"], first=float(times[0]))
        if sign and match["label"] != "U":
            component.values = -component.values
            component.processing.append(say("sign turned, as the line that names the columns says (-)"))
        elif sign:
            component.label = "-U"
        components.append(oriented(component))
    components.sort(key=lambda component: component.vertical)
    return components, {
        "format": "TSMIP text",
        "stage": "corrected" if "corr" in text.get("amplitudeunit", "") else "not stated",
        "unit": "gal",
        "station": text.get("stationcode") or None,
        "network": "TSMIP",
        "start_time": text.get("starttime") or None,
    }
