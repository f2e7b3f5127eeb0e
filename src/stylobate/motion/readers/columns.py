"""Columns of text: CSV whose header names the units, and plain numbers whose unit the caller states."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from ...errors import InputError
from ..motion import Motion
from ..specs import acceleration_unit
from .checks import CUT, LONGEST_STEP, check_length, check_peak, check_same_step, rising_pairs
from .comments import Stated, header_of, is_fact, stated
from .component import Component, UnstatedError
from .headers import Header
from .names import Name
from .record import oriented
from .source import Source
from .steps import ROUNDING_SHARE, first_bad_step, step_of
from .tables import check_commas, number_rows, read_series, read_table
from .vocabulary import time_unit

#: Lines of text that may stand above the numbers.
MAX_TITLE_LINES = 60
#: Rows from which on a first column that grows in equal steps is one of times.
FEWEST_STEPS = 4
_COMMENT = ("#", "%", "!", "//", ";", "*", "'", '"#')
#: A step that was done to a record, as this package writes it.
_DONE = re.compile(r"#\s*processing (?P<number>\d{1,9})\s*:\s*(?P<step>.*\S)")
_NUMERIC = re.compile(r"[\s.eEdD+\-,;]*\d[\s\d.eEdD+\-,;]*")


def recognises(source: Source) -> bool:
    """Whether the first lines that are not titles are columns of numbers."""
    if not source.is_text:
        return False
    start = first_row(source.lines)
    return start is not None


def read(source: Source, unit: str | None, dt: float | None) -> tuple[list[Component], dict]:
    """Components and metadata of a file of columns.

    Raises
    ------
    InputError
        No unit in the header and none stated, no time column and no step stated, unequal steps, rows of unequal length.
    """
    lines = source.lines
    start = first_row(lines)
    assert start is not None
    numbered = {line.strip(): number for number, line in enumerate(lines[:start], 1) if line.strip()}
    titles = list(numbered)
    comments = _comments(titles)
    rows, first = number_rows(lines, start, source.name)
    header, units = header_of(titles)
    named = header.line if header is not None and header.unknown is None else None
    if header is None or header.speaks_of_all is not None:
        check_commas(lines[start:], source.name, start)
    said = stated([line for line in _free(titles) if line != named], source.name)
    series = read_series(rows, first, source.name, said, header)
    table = read_table(rows, first, source.name) if series is None else series
    if len(table) < 2:
        raise InputError(f"{source.name}, line {first + 1}: one row of numbers; give one row per time, at least two.")
    names = _names(table, header, units, f"{source.name}, line {numbered.get(header.line if header else '', start)}")
    for line in titles:
        if header is not None and line != header.line:
            _check_other(Header(line), names, table, header, source.name)
    said = said if header is None or said.unit is not None else replace(said, unit=_unit_of_all(header))
    components, time, unit_found = _components(table, names, source.name, unit, said)
    if time is not None:
        _set_step(components, time, dt, comments, source.name, first)
    elif "dt_s" in comments:
        for component in components:
            component.dt = _comment_number(comments, "dt_s", source.name)
    elif said.step is not None:
        for component in components:
            component.dt = said.step
    elif dt is None:
        raise UnstatedError(f"{source.name} has no time column; state the step: `dt=0.01`.", field="dt")
    _check(components, said, source.name, first)
    if "sha256" in comments:
        _check_digest(components, comments["sha256"], source.name)
    history = _history(titles, source.name)
    for component in components:
        component.history = history
    for axis, component in zip("xy", (one for one in components if not one.vertical)):
        if f"azimuth_{axis}_deg" in comments:
            _set_azimuth(component, axis, _comment_number(comments, f"azimuth_{axis}_deg", source.name), source.name)
    facts = {"format": "columns of text", "unit": unit_found, "stage": comments.get("stage")}
    told = ("station", "network", "event", "event_id", "start_time", "terms")
    facts |= {key: comments[key] for key in told if key in comments}
    if titles:
        facts["header"] = tuple(titles[:MAX_TITLE_LINES])
    if time is not None and abs(time[0]) > 0.0:
        facts["first_time"] = float(time[0])
    return components, facts


def _free(titles: list[str]) -> list[str]:
    """Lines that may speak of the columns: not those of our own that say what was done."""
    return [line for line in titles if not re.match(r"#\s*(processing \d+|name|event(_id)?|station|terms)\s*:", line)]


def _check(components: list[Component], said: Stated, file: str, first: int) -> None:
    """Count, step, length and peaks that the lines above the numbers state are those of the numbers."""
    count = len(components[0].values)
    if said.count is not None and said.count != count:
        raise InputError(f"{file}: the lines above the numbers promise {said.count} samples, {count} are there; {CUT}.")
    dt = components[0].dt
    if np.isfinite(dt):
        if said.step is not None:
            check_same_step(said.step, dt, file, first)
        check_length(count, dt, said.length, file, first)
    _, size = acceleration_unit(said.unit or "m/s2")
    for component in components:
        high, low = (said.extremes or {}).get(component.label.upper(), (None, None))
        for extreme, value in ((high, component.values.max()), (low, component.values.min())):
            check_peak(np.array([value]), extreme, size, file, first, wrong=0.05)


def _check_digest(components: list[Component], written: str, file: str) -> None:
    parts = {component.label: component.values for component in components}
    found = Motion(components[0].dt, parts["x"], parts.get("y"), parts.get("z")).digest
    if found != written:
        raise InputError(
            f"{file}: the numbers are not those that were written with the line '# sha256: …'; fetch the file again, or "
            "remove that line if you changed them."
        )
    for component in components:
        component.proven = True
        component.named = False  # the one horizontal component of a motion is x, wherever it points


def first_row(lines: list[str]) -> int | None:
    """Index of the first line of numbers."""
    for index, line in enumerate(lines[: MAX_TITLE_LINES + 1]):
        text = line.strip()
        if text and not text.startswith(_COMMENT) and _NUMERIC.fullmatch(text):
            return index
    return None


def _comments(titles: list[str]) -> dict[str, str]:
    comments = {}
    for line in titles:
        if line.startswith("#") and (":" in line or "=" in line):
            key, value = re.split(r"[:=]", line.lstrip("# "), maxsplit=1)
            comments[key.strip().lower()] = value.strip()
    return comments


def _history(titles: list[str], file: str) -> list[str]:
    """What was done to a record that this package wrote, in order."""
    found = [match for line in titles if (match := _DONE.fullmatch(line))]
    numbers = [int(match["number"]) for match in found]
    if numbers != list(range(1, len(numbers) + 1)):
        raise InputError(
            f"{file}: the lines '# processing N: …' are numbered {', '.join(map(str, numbers))}; allowed is 1, 2, 3 and so "
            "on, in this order: fetch the file again, as a step that was done to the record may be lost."
        )
    return [match["step"] for match in found]


def _set_azimuth(component: Component, axis: str, stated: float, file: str) -> None:
    """The azimuth of a comment, which is that of the column's name where this has one."""
    named = component.azimuth
    if named is not None and abs((named - stated + 180.0) % 360.0 - 180.0) > 1.0:
        raise InputError(
            f"{file}: the column {component.label!r} points to {named:g}°, the comment azimuth_{axis}_deg says {stated:g}°; "
            "keep the one that is right."
        )
    component.azimuth = stated


def _comment_number(comments: dict[str, str], key: str, file: str) -> float:
    try:
        return float(comments[key])
    except ValueError:
        raise InputError(f"{file}: the comment {key} is {comments[key]!r}; it should be a number.") from None


def _names(table: np.ndarray, header: Header | None, units: list[str] | None, place: str) -> tuple[Name, ...]:
    """Kinds of the columns: as the line above states, else time (known by its growth), then x, y, z."""
    grows = [bool((np.diff(one) >= 0.0).all() and one[-1] > one[0]) for one in table.T]
    columns = len(grows)
    grows = grows if columns > 1 else [False]
    if header is not None and not (columns > 1 + grows[0] and units is None and header.speaks_of_all is not None):
        steady = grows[0] and len(table) >= FEWEST_STEPS and step_of(table[:, 0]) is not None
        return header.names(grows, steady, units, place)
    axes = "XYZ" if columns > 1 + grows[0] else ("",)
    plain = [Name("time")] * grows[0] + [Name("acceleration", axis) for axis in axes]
    if columns > len(plain):
        raise InputError(
            f"{place.partition(', line')[0]} has rows of {columns} numbers without column names, and no format that is "
            "known here; give one column of acceleration, or time and up to three components, or a header such as "
            "time_s,ax_g."
        )
    return tuple(plain[:columns])


def _unit_of_all(header: Header) -> str | None:
    return None if header.speaks_of_all is None else header.speaks_of_all.unit


def _check_other(other: Header, names: tuple[Name, ...], table: np.ndarray, header: Header, file: str) -> None:
    """No other line above the numbers names the columns in another way."""
    if other.unknown is not None or other.units or is_fact(other.line) or other.speaks_of_all is not None:
        return
    found = [reading for fields in (len(names), len(names) - 1) if fields > 1 for reading in other.readings(fields)]
    kinds = [(name.kind, name.direction, name.sign) for name in names]
    if found and all([(n.kind, n.direction, n.sign) for n in one] not in (kinds, kinds[1:]) for one in found):
        raise InputError(
            f"{file}: {other.line!r} and {header.line!r} name different columns; keep the one that is right."
        )


def _components(
    table: np.ndarray, names: tuple[Name, ...], file: str, unit: str | None, said: Stated
) -> tuple[list[Component], np.ndarray | None, str]:
    """Components of columns whose names are known, x and y before z where axes are named, and their times."""
    timed = next((i for i, name in enumerate(names) if name.kind == "time"), None)
    axes = [name.direction or "X" for name in names if name.kind != "time"]
    ranks = {"X": 0, "Y": 1, "Z": 2} if "X" in axes else {}
    order = sorted((i for i in range(len(names)) if i != timed), key=lambda i: ranks.get(names[i].direction, 0))
    components, units = [], []
    for i in order:
        name = names[i]
        label = name.direction or "X"
        stated = name.unit or said.unit
        if stated is None and unit is None:
            raise UnstatedError(
                _no_unit(file if len(order) == 1 else f"{file}: column {i + 1} ({label})"), field="unit"
            )
        shown, size = acceleration_unit(stated or unit or "")
        if stated and unit and acceleration_unit(unit)[1] != size:
            where = f"the line {said.unit_line!r}" if name.unit is None and said.unit_line else "the header"
            raise InputError(
                f"{file}: {where} says {stated}, but unit is given as {unit!r}; leave the unit out.", "unit"
            )
        units.append(shown)
        one = Component(_scaled(table[:, i], size * name.sign), np.nan, label.lower() if ranks else label)
        one.named = bool(name.direction)
        if name.sign < 0.0:
            one.processing.append("sign turned, as the line that names the columns says (-)")
        components.append(oriented(one))
    if timed is None:
        return components, None, ", ".join(dict.fromkeys(units))
    scale = time_unit(names[timed].unit or said.time_unit or "s")
    assert scale is not None
    return components, _scaled(table[:, timed], scale), ", ".join(dict.fromkeys(units))


def _scaled(values: np.ndarray, size: float) -> np.ndarray:
    return np.ascontiguousarray(values) * size if size != 1.0 else values.copy()


def _set_step(
    components: list[Component], time: np.ndarray, dt: float | None, comments: dict[str, str], file: str, first: int
) -> None:
    step = step_of(time)
    if step is None and dt is None:
        bad = first_bad_step(time)
        raise InputError(
            f"{file}, line {first + bad + 1}: the time goes from {time[bad - 1]:g} s to {time[bad]:g} s, unlike the "
            "other steps; mend it, or state a step to resample to: `dt=0.01`.",
            "dt",
        )
    if step is None and (np.diff(time) <= 0.0).any():
        bad = int(np.flatnonzero(np.diff(time) <= 0.0)[0]) + 1
        raise InputError(f"{file}, line {first + bad + 1}: the time does not increase ({time[bad]:g} s); mend it.")
    if step is None and np.median(np.diff(time)) <= LONGEST_STEP:  # no hole that a straight line would fill
        rising_pairs(np.repeat(time, 2), file, first, len(time))
    if step is not None and "dt_s" in comments:
        stated = _comment_number(comments, "dt_s", file)  # in every digit, where times are rounded
        if abs(stated - step) * (len(time) - 1) <= ROUNDING_SHARE * step:
            step = stated
    for component in components:
        component.dt = np.nan if step is None else step
        component.time = time if step is None else None
        component.first = float(time[0])


def _no_unit(what: str) -> str:
    return f"{what} states no unit; state it: `unit='g'`, or m/s2, gal, mm/s2."
