"""California's strong-motion files, volume 1 (uncorrected) and 2 (corrected): CSMIP, before them CDMG.

Layout after the agency's report OSMS 85-03: per channel a block of text, one of integers, one of reals, the
samples, and a line that begins with ``/&``. Units stand in the text.
"""

from __future__ import annotations

import re

import numpy as np

from ...errors import InputError
from ..specs import acceleration_unit
from .numbers import fortran_width, read_numbers
from .record import Component, check_count, oriented
from .source import Source

_BLOCK = re.compile(
    r"^\s*(?P<count>\d+)\s+(?:points\s+of\s+)?(?P<what>accel|veloc|displ)\w*\.?\s+(?:points|pts|data)", re.IGNORECASE
)
_UNITS = re.compile(r"units?\s*(?::|of\s+uncor\s+\w+\s+are\s+sec\s+and|of)\s*(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_IN_UNITS = re.compile(r"\bsec(?:onds?)?,\s+in\s+(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_CHANNEL = re.compile(r"^\s*chan(?:nel)?\.?\s*\d+\s*:\s*(?P<label>.*?)\s*$", re.IGNORECASE)
_POINTS = re.compile(r"no\.\s+of\s+points\s*=\s*(?P<count>\d+)", re.IGNORECASE)
_STATION = re.compile(r"station\s+(?:no|id)\.?\s*(?P<code>\S+)", re.IGNORECASE)
_START = re.compile(r"(?:trigger|start)\s+time:\s*(?P<time>.*?)\s*$", re.IGNORECASE)
_STEP = re.compile(r"spaced\s+at\s+(?P<step>[\d.]+)\s+sec", re.IGNORECASE)
_RATE = re.compile(r"\bat\s+(?P<rate>[\d.]+)\s+(?:pts|points|samples)/sec", re.IGNORECASE)

#: Lines of text, integers and reals above the samples of volumes 1 and 2.
HEADER_LINES = {1: (13, 7, 7), 2: (25, 7, 13)}


#: Headers stand within so many characters of a line.
WIDTH = 160


def recognises(source: Source) -> bool:
    """Whether the first lines say that this is a volume 1 or 2 of CSMIP."""
    first = source.head[:200].lstrip()
    return bool(
        re.match(r"(un)?corrected accelerogram", first)
        and re.search(r"^\s*chan(nel)?\.?\s*\d+\s*:", source.head, re.MULTILINE)
        and "usc" not in first.split("\n")[0]
    )


def read(source: Source) -> tuple[list[Component], dict]:
    """Components and metadata of all channels in the file."""
    lines = source.lines
    volume = 1 if source.head.lstrip().startswith("uncorrected") else 2
    components = []
    start = 0
    facts: dict = {}
    for end in [i for i, line in enumerate(lines) if line.lstrip().startswith("/&")] + [len(lines)]:
        if any(line.strip() for line in lines[start:end]):
            component = _channel(lines, start, end, volume, source.name)
            components.append(component)
            facts = facts or component.metadata
        start = end + 1
    keep = ("station", "station_name", "event", "start_time")
    return components, {
        "format": f"CSMIP V{volume}",
        "stage": "uncorrected" if volume == 1 else "corrected",
        "unit": ", ".join(dict.fromkeys(one.metadata["unit"] for one in components)),
    } | {key: facts[key] for key in keep if key in facts}


def _channel(lines: list[str], start: int, end: int, volume: int, file: str) -> Component:
    text_lines, integer_lines, real_lines = HEADER_LINES[volume]
    text = lines[start : start + text_lines]
    if end - start <= text_lines + integer_lines + real_lines:
        raise InputError(
            f"{file}, line {start + 1}: the channel that begins here ends within its header, at line {end}; the "
            "file is "
            "cut, fetch it again."
        )
    first = start + text_lines + integer_lines + real_lines
    label = next((found["label"] for line in text if (found := _CHANNEL.match(line))), "")
    facts = _facts(text)
    block = next((i for i in range(first - 2, min(first + 3, end)) if _BLOCK.match(lines[i][:WIDTH])), None)
    if block is None:
        component = _pairs(lines, first, end, text, file)
    else:
        component = _samples(lines, block, end, text, file)
    component.label = label
    component.metadata |= facts
    return oriented(component)


def _samples(lines: list[str], block: int, end: int, text: list[str], file: str) -> Component:
    """Samples at equal steps under a line that says how many, how far apart and in which unit."""
    header = lines[block]
    found = _BLOCK.match(header[:WIDTH])
    assert found is not None
    if found["what"].lower() != "accel":
        raise InputError(
            f"{file}, line {block + 1}: the first block holds {found['what'].lower()}., not acceleration; "
            "give the file of accelerations."
        )
    count = check_count(float(found["count"]), file, block + 1)
    following = next((i for i in range(block + 1, end) if _BLOCK.match(lines[i][:WIDTH])), end)
    values = read_numbers(
        lines[block + 1 : following], block + 1, file, "accelerations", count=count, width=fortran_width(header)
    )
    unit, size = _unit([header, *text], file, block)
    return Component(values * size, _step([header, *text], file, block), metadata={"unit": unit})


def _pairs(lines: list[str], first: int, end: int, text: list[str], file: str) -> Component:
    """Pairs of time and acceleration, as digitised from film at unequal steps."""
    stated = next((float(found["count"]) for line in text if (found := _POINTS.search(line))), None)
    count = check_count(stated, file, first)
    numbers = read_numbers(
        lines[first:end], first, file, "pairs of time and acceleration", count=2 * count, width=7
    ).reshape(-1, 2)
    unit, size = _unit(text, file, first)
    time = numbers[:, 0].copy()
    if (np.diff(time) < 0.0).any():
        bad = int(np.flatnonzero(np.diff(time) < 0.0)[0]) + 1
        raise InputError(
            f"{file}, below line {first + 1}: the time falls at sample {bad + 1} ({time[bad]:g} s); mend it."
        )
    return Component(numbers[:, 1] * size, np.nan, time=time, metadata={"unit": unit})


def _unit(texts: list[str], file: str, line: int) -> tuple[str, float]:
    for text in texts:
        for pattern in (_UNITS, _IN_UNITS):
            for found in pattern.finditer(text):
                try:
                    return acceleration_unit(found["unit"].rstrip("."))
                except InputError:
                    continue
    raise InputError(
        f"{file}, near line {line + 1}: no unit of acceleration that is known here; convert it to columns."
    )


def _step(texts: list[str], file: str, line: int) -> float:
    for text in texts:
        if (found := _STEP.search(text)) and float(found["step"].rstrip(".")) > 0.0:
            return float(found["step"].rstrip("."))
        if (found := _RATE.search(text)) and float(found["rate"].rstrip(".")) > 0.0:
            return 1.0 / float(found["rate"].rstrip("."))
    raise InputError(f"{file}, line {line + 1}: no step between the samples is stated; convert the file to columns.")


def _facts(text: list[str]) -> dict:
    facts: dict = {}
    for i, line in enumerate(text):
        if (found := _STATION.search(line)) and "station" not in facts:
            facts["station"] = found["code"]
            if i + 1 < len(text):
                facts["station_name"] = re.sub(r"\s{2,}", "; ", text[i + 1].strip())
        if (found := _START.search(line)) and "start_time" not in facts:
            facts["start_time"] = found["time"]
    stated = [line for line in text[1:] if line.strip() and "to be determined" not in line.lower()]
    for pattern in ("earthquake", "rcrd of|record of"):
        named = [line for line in stated if re.search(pattern, line, re.IGNORECASE)]
        if named and "event" not in facts:
            facts["event"] = re.split(r"\s{3,}", named[0].strip())[0]
    return facts
