"""California's strong-motion files, volume 1 (uncorrected) and 2 (corrected): CSMIP, before them CDMG.

Layout after the agency's report OSMS 85-03: per channel a block of text, one of integers, one of reals, the
samples, and a line that begins with ``/&``. Units stand in the text.
"""

from __future__ import annotations

import re

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import NUMBER, read_numbers
from stylobate.motion.readers.record import Component, check_same_step
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import acceleration_unit

from .stated import (
    check_count,
    check_direction,
    check_ended,
    check_length,
    check_peak,
    check_peak_time,
    check_step,
    fortran_width,
    oriented,
    warn_of_missing,
)
from .volume1 import pairs

_BLOCK = re.compile(
    r"^\s*(?P<count>\d+)\s+(?:points\s+of\s+)?(?P<what>accel|veloc|displ)\w*\.?\s+(?:points|pts|data)", re.IGNORECASE
)
_UNITS = re.compile(r"units?\s*(?::|of\s+uncor\s+\w+\s+are\s+sec\s+and|of)\s*(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_IN_UNITS = re.compile(r"\bsec(?:onds?)?,\s+in\s+(?P<unit>[a-z][a-z/0-9]*)", re.IGNORECASE)
_CHANNEL = re.compile(r"^\s*chan(?:nel)?\.?\s*\d+\s*:\s*(?P<label>.*?)\s*$", re.IGNORECASE)
_PEAK = re.compile(
    rf"(?:peak\s+(?P<what>acceleration|velocity|displacement)|(?<!uncor )max)\s*=\s*(?P<peak>{NUMBER})\s*"
    rf"(?P<unit>[a-z][a-z/0-9]*)\s*,?\s*at\s+(?P<time>{NUMBER})\s*sec",
    re.IGNORECASE,
)
_LENGTH = re.compile(rf"record\s+length\s*=\s*(?P<length>{NUMBER})\s*sec", re.IGNORECASE)
_SPACED = re.compile(rf"equally-spaced\s+intervals\s+of\s+(?P<step>{NUMBER})\s+sec", re.IGNORECASE)
_CHANNELS = re.compile(r"\(\s*(?P<count>\d+)\s+chns\b", re.IGNORECASE)
_POINTS = re.compile(r"no\.\s+of\s+points\s*=\s*(?P<count>\d+)(?![\w.])", re.IGNORECASE)
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
        and "renadic" not in source.head
    )


def read(source: Source) -> tuple[list[Component], dict]:
    """Components and metadata of all channels in the file."""
    lines = source.lines
    volume = 1 if source.head.lstrip().startswith("uncorrected") else 2
    components = []
    start = 0
    facts: dict = {}
    marks = [i for i, line in enumerate(lines) if line.lstrip().startswith("/&")]
    for end in [*marks, len(lines)]:
        if any(line.strip() for line in lines[start:end]):
            component = _channel(lines, start, end, volume, source.name)
            check_ended(end < len(lines), source.name, end, "/&")
            components.append(component)
            facts = facts or component.metadata
        start = end + 1
    warn_of_missing(len(components), _channel_count(lines, volume, source.name), source.name)
    keep = ("station", "station_name", "event", "start_time")
    return components, {
        "format": f"CSMIP V{volume}",
        "stage": "uncorrected" if volume == 1 else "corrected",
        "unit": ", ".join(dict.fromkeys(component.metadata["unit"] for component in components)),
    } | {key: facts[key] for key in keep if key in facts}


def _channel(lines: list[str], start: int, end: int, volume: int, file: str) -> Component:
    text_lines, integer_lines, real_lines = HEADER_LINES[volume]
    text = lines[start : start + text_lines]
    if end - start <= text_lines + integer_lines + real_lines:
        raise InputError(
            f"{file}, line {start + 1}: the channel that begins here ends within its header, at line {end}; the file "
            "is cut, fetch it again."
        )
    first = start + text_lines + integer_lines + real_lines
    label = next((match["label"] for line in text if (match := _CHANNEL.match(line))), "")
    facts = _facts(text)
    block = next((i for i in range(first - 2, min(first + 3, end)) if _BLOCK.match(lines[i][:WIDTH])), None)
    if block is None:
        component = _pairs(lines, first, end, text, file)
    else:
        component = _samples(lines, block, end, text, file)
        for line in (*text, *lines[block:end]):
            if (match := _SPACED.search(line[:WIDTH])) or (match := _STEP.search(line[:WIDTH])):
                check_same_step(component.dt, float(match["step"].rstrip(".")), file, block + 1)
        if match := next((match for line in text if (match := _LENGTH.search(line))), None):
            check_length(len(component.values), component.dt, match["length"], file, start + text_lines)
    _check_peak(component, text, start, file)
    component.label = label
    component.metadata |= facts
    component = oriented(component)
    integers = read_numbers(
        lines[start + text_lines : start + text_lines + integer_lines],
        start + text_lines,
        file,
        "header integers",
        count=100,
        width=5,
    )
    check_direction(component, float(integers[26]), file, start + text_lines + 2)
    return component


def _channel_count(lines: list[str], volume: int, file: str) -> int | None:
    """Channels of the record, as the first header's text says, or else its fourth integer."""
    first = HEADER_LINES[volume][0]
    match = next((match for line in lines[:first] if (match := _CHANNELS.search(line))), None)
    if match is not None:
        return int(match["count"])
    stated = int(read_numbers(lines[first : first + 7], first, file, "header integers", count=100, width=5)[3])
    return stated if 1 <= stated <= 3 else None


def _check_peak(component: Component, text: list[str], start: int, file: str) -> None:
    for i, line in enumerate(text):
        match = _PEAK.search(line)
        if match is None or (match["what"] or "acceleration").lower() != "acceleration":
            continue
        size = acceleration_unit(match["unit"].rstrip("."))[1]
        check_peak(component.values, match["peak"], size, file, start + i + 1)
        if component.time is None:
            check_peak_time(component.values, component.dt, match["time"], file, start + i + 1)


def _samples(lines: list[str], block: int, end: int, text: list[str], file: str) -> Component:
    """Samples at equal steps under a line that says how many, how far apart and in which unit."""
    header = lines[block]
    match = _BLOCK.match(header[:WIDTH])
    assert match is not None
    if match["what"].lower() != "accel":
        raise InputError(
            f"{file}, line {block + 1}: the first block holds {match['what'].lower()}., not acceleration; "
            "give the file of accelerations."
        )
    count = check_count(float(match["count"]), file, block + 1)
    following = next((i for i in range(block + 1, end) if _BLOCK.match(lines[i][:WIDTH])), end)
    values = read_numbers(
        lines[block + 1 : following], block + 1, file, "accelerations", count=count, width=fortran_width(header)
    )
    unit, size = _unit([header, *text], file, block)
    _check_blocks(lines, following, end, file)
    dt = check_step(_step([header, *text], file, block), file, block + 1)
    return Component(values * size, dt, metadata={"unit": unit})


def _check_blocks(lines: list[str], following: int, end: int, file: str) -> None:
    """The blocks of velocity and displacement hold as many numbers as they promise."""
    starts = [i for i in range(following, end) if _BLOCK.match(lines[i][:WIDTH])]
    for i, stop in zip(starts, [*starts[1:], end]):
        match = _BLOCK.match(lines[i][:WIDTH])
        assert match is not None
        count = check_count(float(match["count"]), file, i + 1)
        what = {"veloc": "velocities", "displ": "displacements"}.get(match["what"].lower(), "accelerations")
        read_numbers(lines[i + 1 : stop], i + 1, file, what, count=count, width=fortran_width(lines[i]))


def _pairs(lines: list[str], first: int, end: int, text: list[str], file: str) -> Component:
    """Pairs of time and acceleration, as digitised from film at unequal steps."""
    stated = next((float(match["count"]) for line in text if (match := _POINTS.search(line))), None)
    count = check_count(stated, file, first)
    total = next((match["length"] for line in text if (match := _LENGTH.search(line))), None)
    component = pairs(lines, first, end, count, file, width=7, total=total)
    component.metadata["unit"], size = _unit(text, file, first)
    component.values = component.values * size
    return component


def _unit(texts: list[str], file: str, line: int) -> tuple[str, float]:
    for text in texts:
        for pattern in (_UNITS, _IN_UNITS):
            for match in pattern.finditer(text):
                try:
                    return acceleration_unit(match["unit"].rstrip("."))
                except InputError:
                    continue
    raise InputError(
        f"{file}, near line {line + 1}: no unit of acceleration that is known here; convert it to columns."
    )


def _step(texts: list[str], file: str, line: int) -> float:
    for text in texts:
        if (match := _STEP.search(text)) and float(match["step"].rstrip(".")) > 0.0:
            return float(match["step"].rstrip("."))
        if (match := _RATE.search(text)) and float(match["rate"].rstrip(".")) > 0.0:
            return 1.0 / float(match["rate"].rstrip("."))
    raise InputError(f"{file}, line {line + 1}: no step between the samples is stated; convert the file to columns.")


def _facts(text: list[str]) -> dict:
    facts: dict = {}
    for i, line in enumerate(text):
        if (match := _STATION.search(line)) and "station" not in facts:
            facts["station"] = match["code"]
            if i + 1 < len(text):
                facts["station_name"] = re.sub(r"\s{2,}", "; ", text[i + 1].strip())
        if (match := _START.search(line)) and "start_time" not in facts:
            facts["start_time"] = match["time"]
    stated = [line for line in text[1:] if line.strip() and "to be determined" not in line.lower()]
    for pattern in ("earthquake", "rcrd of|record of"):
        named = [line for line in stated if re.search(pattern, line, re.IGNORECASE)]
        if named and "event" not in facts:
            facts["event"] = re.split(r"\s{3,}", named[0].strip())[0]
    return facts
