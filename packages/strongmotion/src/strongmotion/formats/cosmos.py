"""COSMOS strong-motion format 1.20, volumes 0 (counts), 1 (uncorrected) and 2 (corrected), one or more channels.

Published by the Consortium of Organizations for Strong-Motion Observation Systems (2001). Per channel: 13 lines of
text, 100 integers, 100 reals, comments, blocks of samples, and a closing line.
"""

from __future__ import annotations

import re

import numpy as np

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.messages import say
from stylobate.motion.readers.numbers import NUMBER, read_numbers
from stylobate.motion.readers.record import CUT, Component, direction
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
)
from .volume1 import channels

_HEADER = re.compile(
    r"^\s*(?P<count>\d+)\s+(?P<kind>integer|real)-header values follow on\s+(?P<lines>\d+)", re.IGNORECASE
)
_COMMENTS = re.compile(r"^\s*(?P<count>\d+)\s+comment line", re.IGNORECASE)
_BLOCK = re.compile(
    r"^\s*(?P<count>\d+)\s+(?P<what>.*?)\s*(?:pts|points)\b.*?approx\s+(?P<length>[\d.]+)\s*sec.*?"
    r"units\s*=\s*(?P<unit>[^,(]+)",
    re.IGNORECASE,
)
_END = re.compile(r"^\s*(?:/&|end-of-data)", re.IGNORECASE)
_CHANNEL = re.compile(r"^\s*sta\s+cha\w*[\s:]*[^\s:]*\s*:\s*(?P<label>.*?)\s*(?:\(|location|$)", re.IGNORECASE)
_LENGTH = re.compile(rf"record length\s*=\s*(?P<length>{NUMBER})\s*sec", re.IGNORECASE)
_PEAK = re.compile(
    rf"(?<!uncor )\bmax\s*=\s*(?P<peak>{NUMBER})\s*(?P<unit>[a-z][a-z/0-9]*)\s*,?\s*at\s+(?P<time>{NUMBER})\s*sec",
    re.IGNORECASE,
)
_SCNL = re.compile(r"<SCNL>\s*(?P<station>[^.\s]*)\.(?P<channel>[^.\s]*)\.(?P<network>[^.\s]*)", re.IGNORECASE)
_STATION = re.compile(r"code:\s*(?P<network>[^-\s]+)-(?P<station>\S+)\s*(?P<name>.*?)\s*$", re.IGNORECASE)
_UNKNOWN = -999.0


#: Headers stand within so many characters of a line.
WIDTH = 160


def recognises(source: Source) -> bool:
    """Whether the first lines carry the blocks of the COSMOS format."""
    return "integer-header values follow" in source.head and "format v" in source.head


def read(source: Source) -> tuple[list[Component], dict]:
    """Components and metadata of all channels in the file."""
    lines, file = source.lines, source.name
    pairs = channels(lines, lambda start: _channel(lines, start, file))
    components, stages = [component for component, _ in pairs], [stage for _, stage in pairs]
    first = components[0].metadata
    keep = ("station", "station_name", "network", "event", "start_time")
    return components, {
        "format": "COSMOS 1.20",
        "stage": ", ".join(dict.fromkeys(stages)),
        "unit": ", ".join(dict.fromkeys(component.metadata["unit"] for component in components)),
    } | {key: first[key] for key in keep if key in first}


def _channel(lines: list[str], start: int, file: str) -> tuple[tuple[Component, str], int]:
    """One channel and its stage; the index of the line after it."""
    at, integers = _numbers(lines, start, "integer", file)
    text = [line for line in lines[start:at] if not _HEADER.match(line)]
    text = text[: next((i for i, line in enumerate(lines[start:at]) if _HEADER.match(line)), len(text))]
    at, reals = _numbers(lines, at, "real", file)
    comments: list[str] = []
    if at < len(lines) and (match := _COMMENTS.match(lines[at])):
        count = int(match["count"])
        comments = lines[at + 1 : at + 1 + count]
        at += 1 + count
    block = _BLOCK.match(lines[at][:WIDTH]) if at < len(lines) else None
    if block is None:
        shown = lines[at].strip()[:40] if at < len(lines) else "the end of the file"
        raise InputError(f"{file}, line {at + 1}: expected the line that announces the samples, found {shown!r}.")
    end = next((i for i in range(at + 1, len(lines)) if _END.match(lines[i])), len(lines))
    stop = next((i for i in range(at + 1, end) if _BLOCK.match(lines[i][:WIDTH])), end)
    if "acc" not in block["what"].lower():
        raise InputError(
            f"{file}, line {at + 1}: the block holds {block['what'].strip()!r}, not acceleration; "
            "give the file of accelerations."
        )
    check_ended(end < len(lines), file, end, "End-of-data")
    count = check_count(float(block["count"]), file, at + 1)
    width = fortran_width(lines[at])
    values = read_numbers(lines[at + 1 : stop], at + 1, file, "accelerations", count=count, width=width)
    component = Component(values, _step(reals, float(block["length"].rstrip(".")), count, file, at))
    component.metadata = _facts(text, comments)
    component.label = _label(text, comments, integers)
    stage = {0: "raw counts", 1: "uncorrected", 2: "corrected", 3: "spectra"}.get(int(integers[0]), "not stated")
    if "count" in block["unit"].lower():
        _check_counts(values, reals, component.dt, file, start)
    _scale(component, block["unit"].strip(), reals, file, at)
    _check(component, text, reals, stage, file, start)
    component = oriented(component)
    if component.azimuth is None and not component.vertical and 0 < integers[53] <= 360:
        component.azimuth = float(integers[53]) % 360.0
    check_direction(component, float(integers[53]), file, start + 1)
    return (component, stage), end + 1


def _check(component: Component, text: list[str], reals: np.ndarray, stage: str, file: str, start: int) -> None:
    """Length, step and peak as the header states them: real 63 the length, 64 the peak, 65 its time; text lines too."""
    count, dt = len(component.values), component.dt
    if reals[62] > 0.0:
        check_length(count, dt, float(reals[62]), file, start + 1)
    if stage == "corrected":
        for number, line in enumerate(text, start + 1):
            if match := _PEAK.search(line):
                check_peak(component.values, match["peak"], acceleration_unit(match["unit"])[1], file, number)
                check_peak_time(component.values, dt, match["time"], file, number)
    else:
        lengths = [match["length"] for line in text if (match := _LENGTH.search(line))]
        check_length(count, dt, lengths[0] if lengths else None, file, start + 1)
    if reals[63] != _UNKNOWN and component.metadata["unit"] != "counts":
        check_peak(component.values, float(reals[63]), component.metadata["m_s2"], file, start + 1)
        check_peak_time(component.values, dt, float(reals[64]), file, start + 1)


def _check_counts(values: np.ndarray, reals: np.ndarray, dt: float, file: str, start: int) -> None:
    """Raw counts: the largest one (real 64), its time (65) and the mean that was taken off (66)."""
    if reals[63] not in (_UNKNOWN, 0.0):
        check_peak(values, float(reals[63]), 1.0, file, start + 1, wrong=0.0, what=say("largest count"))
        check_peak_time(values, dt, float(reals[64]), file, start + 1)
    stated, mean = float(reals[65]), float(values.mean())
    if stated not in (_UNKNOWN, 0.0) and min(abs(mean + stated), abs(mean - stated)) > 1e-4:
        raise InputError(
            f"{file}, line {start + 1}: the header states a mean of {-stated:g} counts (real 66), the samples hold "
            f"{mean:.6f}; {CUT}."
        )


def _numbers(lines: list[str], start: int, kind: str, file: str) -> tuple[int, np.ndarray]:
    """A block of integers or reals of the header; the index after it, and the numbers."""
    for at in range(start, min(start + 40, len(lines))):
        match = _HEADER.match(lines[at])
        if match and match["kind"].lower() == kind:
            body = lines[at + 1 : at + 1 + int(match["lines"])]
            count = check_count(float(match["count"]), file, at + 1, "header values")
            if count < 64:
                raise InputError(f"{file}, line {at + 1}: {count} {kind} header values; the format has 100.")
            width = fortran_width(re.sub(r"i", "f", lines[at].split("=")[-1], flags=re.IGNORECASE))
            values = read_numbers(body, at + 1, file, f"{kind} header values", count=count, width=width)
            return at + 1 + len(body), values
    raise InputError(
        f"{file}, line {start + 1}: no block of {kind} header values follows here; the file is damaged or cut, "
        "fetch it again."
    )


def _step(reals: np.ndarray, length: float, count: int, file: str, line: int) -> float:
    """Step of the samples: real 62, in milliseconds; the one of real 34 is the recorder's."""
    if reals[61] <= 0.0:
        raise InputError(
            f"{file}, line {line + 1}: the header states a step of {reals[61]:g} ms (real 62), where one above 0 is "
            "expected, and the length in this line is rounded; convert the file to columns, with the step of the network."
        )
    dt = check_step(float(reals[61]) / 1000.0, file, line + 1)
    if length > 0.0 and abs(count * dt - length) > max(2.0, 0.02 * length):
        raise InputError(
            f"{file}, line {line + 1}: {count} samples in about {length:g} s disagree with the step of {dt:g} "
            f"s in the header (real 62); {CUT}."
        )
    return dt


def _scale(component: Component, unit: str, reals: np.ndarray, file: str, line: int) -> None:
    if "count" not in unit.lower():
        component.metadata["unit"], size = acceleration_unit(unit)
        component.metadata["m_s2"] = size
        component.values = component.values * size
        return
    microvolt, sensitivity, gain = (float(reals[i]) for i in (21, 41, 46))  # reals 22, 42 and 47
    if not (microvolt > 0.0 and sensitivity > 0.0):
        raise InputError(
            f"{file}, line {line + 1}: counts without the recorder's step (real 22, found {microvolt:g}) and the "
            f"sensor's sensitivity (real 42, found {sensitivity:g}); give a processed file of the record (V1 or V2)."
        )
    size = microvolt * 1e-6 / (sensitivity * (gain if gain > 0.0 else 1.0))  # g per count
    component.metadata |= {"unit": "counts", "g_per_count": size}
    zero = float(component.values.mean())
    component.values = (component.values - zero) * (size * g)
    component.processing.append(
        say(
            "counts × {size:.6g} g, after the zero level of {zero:.6g} counts (their mean) was taken off: raw counts "
            "have no zero of their own",
            size=size,
            zero=zero,
        )
    )


def _label(text: list[str], comments: list[str], integers: np.ndarray) -> str:
    """Direction: the text's; else the channel code's last letter; else that of integer 54."""
    stated = next((match["label"] for line in text if (match := _CHANNEL.match(line))), "")
    azimuth, vertical, _ = direction(stated)
    if azimuth is not None or vertical:
        return stated
    code = next((match["channel"] for line in comments if (match := _SCNL.search(line))), "")
    azimuth, vertical, _ = direction(code)
    if azimuth is not None or vertical:
        return code
    number = int(integers[53])
    if not stated and 0 <= number <= 360:
        return f"{number} deg"
    return {400: "Up", 401: "Down", 402: "Up"}.get(number, stated or code)


def _facts(text: list[str], comments: list[str]) -> dict:
    facts: dict = {}
    if len(text) > 1:
        facts["event"] = text[1].strip()
    for line in text:
        if match := _STATION.search(line):
            facts |= {"network": match["network"], "station": match["station"], "station_name": match["name"]}
        if match := re.search(r"start time:\s*(?P<time>.*?)(?:\(|RcrdId|$)", line, re.IGNORECASE):
            facts["start_time"] = match["time"].strip()
    for line in comments:
        if match := _SCNL.search(line):
            facts["channel"] = match["channel"]
    return facts
