"""The USGS's SMC files, volumes 1 (film at unequal steps) and 2 (corrected): one component each, cm/s²."""

from __future__ import annotations

import re

import numpy as np

from stylobate.errors import InputError, warn
from stylobate.messages import say
from stylobate.motion.readers.numbers import count_numbers, read_numbers
from stylobate.motion.readers.record import CUT, Component, direction, rising_pairs
from stylobate.motion.readers.source import Source

from .stated import LABEL, check_count, check_peak, check_peak_time, check_step, oriented
from .volume1 import is_numeric

TEXT_LINES, INTEGER_LINES, REAL_LINES = 11, 6, 10
_FIRST = re.compile(r"^\s*(?P<volume>\d)\s+(?P<what>.*\S)\s*$")


def recognises(source: Source) -> bool:
    """Whether the first lines are those of the format: a volume number, and lines of a star."""
    lines = source.head.split("\n")
    return (
        len(lines) > TEXT_LINES
        and re.match(r"^\s*\d\s+((un)?corrected accelerogram|unknown|velocity|displacement|response|fourier)", lines[0])
        is not None
        and lines[1].strip() == "*"
    )


def read(source: Source) -> tuple[list[Component], dict]:
    """The component and what the header says."""
    lines, file = source.lines, source.name
    match = _FIRST.match(lines[0])
    kind = "" if match is None else match["what"].upper()
    if kind == "UNKNOWN":  # as programs write it that convert accelerograms
        unnamed = say("{file}, line 1: it does not say what the numbers are; they are read as accelerations in cm/s².")
        warn(unnamed.of(file=file))
    elif "ACCELEROGRAM" not in kind:
        raise InputError(f"{file}, line 1: expected an accelerogram, found {lines[0].strip()!r}; give that file.")
    corrected = "UNCORRECTED" not in kind
    at = TEXT_LINES + INTEGER_LINES
    integers = read_numbers(lines[TEXT_LINES:at], TEXT_LINES, file, "header integers", count=48, width=10)
    reals = read_numbers(lines[at : at + REAL_LINES], at, file, "header reals", count=50, width=15)
    comments = int(integers[15]) if 0 <= integers[15] <= 1000 else 0
    start = at + REAL_LINES + comments
    for number, line in enumerate(lines[at + REAL_LINES : start], at + REAL_LINES + 1):
        if not line.lstrip().startswith("|"):
            raise InputError(
                f"{file}, line {number}: expected one of the {comments} comment lines that the header promises, each of "
                f"which begins with '|', found {line.strip()[:40]!r}; {CUT}."
            )
    stated = check_count(float(integers[16]), file, TEXT_LINES + 3, "values")
    numbers, left_out, rows = _values(lines, start, stated, file)
    if corrected:
        rate = float(reals[1])
        if not 0.0 < rate < 1e5:
            raise InputError(
                f"{file}, line {at + 1}: expected the sampling rate, found {rate:g}; fetch the file again."
            )
        component = Component(numbers * 0.01, check_step(1.0 / rate, file, at + 1))
    else:
        if stated % 2:
            raise InputError(f"{file}, line {TEXT_LINES + 3}: {stated} values are not pairs of time and acceleration.")
        time, values = rising_pairs(numbers, file, start, rows)
        component = Component(values * 0.01, np.nan, time=time, first=float(time[0]))
    _check_peaks(component, reals, file, at + 6)
    if left_out:
        component.processing.append(
            say(
                "{left_out} numbers beyond the {stated} that the header promises were left out",
                left_out=left_out,
                stated=stated,
            )
        )
    component.label = _label(int(integers[12]), int(integers[13]), lines[5], file)
    component.metadata["unit"] = "cm/s2"
    head = [line.strip().strip("*") for line in lines[:TEXT_LINES]]
    terms = " ".join(line.lstrip("| ").strip() for line in lines[at + REAL_LINES : start]).strip()
    place = re.search(r"station\s*=\s*(?P<name>.*?)\s*component", head[5], re.IGNORECASE)
    return [oriented(component)], {
        "format": f"USGS SMC V{2 if corrected else 1}",
        "stage": "not stated" if kind == "UNKNOWN" else "corrected" if corrected else "uncorrected",
        "unit": "cm/s2",
        "station": place["name"].rstrip(", ") if place else None,
        "event": re.sub(r"\s{2,}", " ", head[3]) or None,
        "network": head[7].split("data source =")[-1].strip() if "data source =" in head[7] else None,
        "comments": terms or None,
    }


def _check_peaks(component: Component, reals: np.ndarray, file: str, line: int) -> None:
    """Reals 29 to 32: time and value of the largest and of the smallest acceleration."""
    for time, peak in (reals[28:30], reals[30:32]):
        if abs(peak) > 1e6 or abs(time) > 1e6:  # 1.7e38: not stated
            continue
        extreme = component.values.max() if peak > 0.0 else component.values.min()
        check_peak(np.array([extreme]), float(peak), 0.01, file, line)
        if component.time is None:
            check_peak_time(np.maximum(component.values * np.sign(peak), 0.0), component.dt, float(time), file, line)


def _values(lines: list[str], start: int, stated: int, file: str) -> tuple[np.ndarray, int, int]:
    """The numbers that the header promises, how many more there are (a stray last line is known in these files), their rows.

    There are eight numbers of ten characters to a row, or as many as the first row holds.
    """
    first = lines[start] if start < len(lines) else ""
    rows = -(-stated // (count_numbers(first) if is_numeric(first) else 8))
    numbers = read_numbers(lines[start : start + rows], start, file, "accelerations", count=stated, width=10)
    if len(lines) > start + rows + 1:
        raise InputError(
            f"{file}, line {start + rows + 1}: the header promises {stated} numbers, which end here, but more "
            "follow; the file is damaged, fetch it again."
        )
    beyond = read_numbers(lines[start + rows :], start + rows, file, "accelerations", width=10)
    return numbers, len(beyond), rows


def _label(from_vertical: int, azimuth: int, station: str, file: str) -> str:
    """Direction: integer 13 counts from the vertical (0 up, 180 down), integer 14 from north; else the text."""
    match = re.search(rf"component\s*=\s*(?P<label>{LABEL})", station, re.IGNORECASE)
    text = match["label"] if match else ""
    known = from_vertical in (0, 90, 180)
    by_text = direction(text)
    label = {0: "Up", 180: "Down"}.get(from_vertical, "")
    if not label and 0 <= azimuth <= 360 and (known or not by_text[1]):
        label = f"{azimuth} deg"
    by_numbers = direction(label)
    if label and (by_text[0] is not None or by_text[1]):
        apart = abs(((by_text[0] or 0.0) - (by_numbers[0] or 0.0) + 180.0) % 360.0 - 180.0)
        if by_text[1:] != by_numbers[1:] or apart > 1.0:
            raise InputError(
                f"{file}, line 6: the text states the direction {text!r}, integers 13 and 14 {label!r}; {CUT}."
            )
    return label or text
