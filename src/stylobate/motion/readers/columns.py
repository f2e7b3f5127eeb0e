"""Columns of text: CSV whose header names the units, and plain numbers whose unit the caller states."""

from __future__ import annotations

import re

import numpy as np

from ...errors import InputError
from ..motion import Motion
from ..specs import TIME_UNITS, acceleration_unit
from .checks import CUT, check_length, check_peak, check_same_step
from .comments import Stated, stated
from .component import Component, UnstatedError
from .record import oriented
from .source import Source
from .steps import ROUNDING_SHARE, first_bad_step, step_of
from .tables import number_rows, read_series, read_table

#: Lines of text that may stand above the numbers.
MAX_TITLE_LINES = 60
_COMMENT = ("#", "%", "!", "//", ";", "*", "'", '"#')
_FIELD = re.compile(r"""["']?\s*(?P<name>[^()\[\]"']*?)\s*(?:[(\[]\s*(?P<unit>[^)\]]*)\s*[)\]])?\s*["']?""")
_AXES = {"ax": "x", "ay": "y", "az": "z", "a": "x", "acc": "x", "accel": "x", "acceleration": "x"}
_NUMERIC = re.compile(r"[\s.eEdD+\-,;]*\d[\s\d.eEdD+\-,;]*")


def recognises(source: Source) -> bool:
    """Whether the first lines that are not titles are columns of numbers."""
    if not source.is_text:
        return False
    start = _first_row(source.lines)
    return start is not None


def read(source: Source, unit: str | None, dt: float | None) -> tuple[list[Component], dict]:
    """Components and metadata of a file of columns.

    Raises
    ------
    InputError
        No unit in the header and none stated, no time column and no step stated, unequal steps, rows of unequal length.
    """
    lines = source.lines
    start = _first_row(lines)
    assert start is not None
    titles = [line.strip() for line in lines[:start] if line.strip()]
    comments = _comments(titles)
    names = _column_names(lines, start)
    rows, first = number_rows(lines, start)
    said = stated(_free(titles, names), source.name) if names is None else Stated()
    series = None if names is not None else read_series(rows, first, source.name, said)
    table = read_table(rows, first, source.name) if series is None else series
    columns = table.shape[1]
    if len(table) < 2:
        raise InputError(f"{source.name}, line {first + 1}: one row of numbers; give one row per time, at least two.")
    if names is not None and len(names) != columns:
        raise InputError(
            f"{source.name}, line {first + 1}: {columns} numbers under {len(names)} column names; every row needs "
            "one per name."
        )
    if names is None:
        components, time, unit_found = _bare(table, source.name, unit, dt, said)
    else:
        components, time, unit_found = _named(table, names, source.name, unit)
    if time is not None:
        _set_step(components, time, dt, comments, source.name, first)
    elif "dt_s" in comments:
        for one in components:
            one.dt = _comment_number(comments, "dt_s", source.name)
    elif said.step is not None:
        for one in components:
            one.dt = said.step
    _check(components, said, source.name, first)
    if "sha256" in comments:
        _check_digest(components, comments["sha256"], source.name)
    for axis, one in zip("xyz", components):
        if f"azimuth_{axis}_deg" in comments:
            one.azimuth = _comment_number(comments, f"azimuth_{axis}_deg", source.name)
    facts = {"format": "columns of text", "unit": unit_found, "stage": comments.get("stage")}
    facts |= {key: comments[key] for key in ("station", "network", "event", "start_time", "terms") if key in comments}
    if names is not None and (other := [name for name, _ in names if name not in ("t", "x", "y", "z")]):
        facts["columns_left_out"] = tuple(other)
    if titles:
        facts["header"] = tuple(titles[:MAX_TITLE_LINES])
    if time is not None and abs(time[0]) > 0.0:
        facts["first_time"] = float(time[0])
    return components, facts


def _free(titles: list[str], names: object) -> list[str]:
    """Lines that may speak of the columns: not those of our own that say what was done."""
    return [line for line in titles if not re.match(r"#\s*(processing \d+|name|event|station|terms)\s*:", line)]


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
    for one in components:
        high, low = (said.extremes or {}).get(one.label.upper(), (None, None))
        for extreme, value in ((high, one.values.max()), (low, one.values.min())):
            check_peak(np.array([value]), extreme, size, file, first, wrong=0.05)


def _check_digest(components: list[Component], written: str, file: str) -> None:
    parts = {one.label: one.values for one in components}
    found = Motion(components[0].dt, parts["x"], parts.get("y"), parts.get("z")).digest
    if found != written:
        raise InputError(
            f"{file}: the numbers are not those that were written with the line '# sha256: …'; fetch the file again, or "
            "remove that line if you changed them."
        )


def _first_row(lines: list[str]) -> int | None:
    """Index of the first line of numbers."""
    for index, line in enumerate(lines[: MAX_TITLE_LINES + 1]):
        text = line.strip()
        if text and not text.startswith(_COMMENT) and _NUMERIC.fullmatch(text):
            return index
    return None


def _comments(titles: list[str]) -> dict[str, str]:
    found = {}
    for line in titles:
        if line.startswith("#") and (":" in line or "=" in line):
            key, value = re.split(r"[:=]", line.lstrip("# "), maxsplit=1)
            found[key.strip().lower()] = value.strip()
    return found


def _comment_number(comments: dict[str, str], key: str, file: str) -> float:
    try:
        return float(comments[key])
    except ValueError:
        raise InputError(f"{file}: the comment {key} is {comments[key]!r}; it should be a number.") from None


def _column_names(lines: list[str], start: int) -> list[tuple[str, str | None]] | None:
    """Names and units of the columns from the last line above the numbers, if it is a header of ours or alike."""
    above = [line.strip() for line in lines[:start] if line.strip()]
    if not above:
        return None
    text = above[-1].lstrip("#%! ").strip()
    separator = next((mark for mark in (",", ";", "\t") if mark in text), None)
    fields = [
        field.strip() for field in (text.split(separator) if separator else re.split(r"\s{2,}|\s(?=a[xyz]_)", text))
    ]
    names = [_column_name(field) for field in fields]
    known = [name for name in names if name[0] in ("t", "x", "y", "z")]
    return names if any(name[0] in ("x", "y", "z") for name in known) else None


def _column_name(field: str) -> tuple[str, str | None]:
    """``time_s`` → ("t", "s"), ``ax_m_s2`` → ("x", "m_s2"), ``acceleration (cm/s^2)`` → ("x", "cm/s^2")."""
    found = _FIELD.fullmatch(field)
    name, unit = (found.group("name").lower(), found.group("unit")) if found else (field.lower(), None)
    name = name.strip().rstrip(",")
    head, _, tail = name.partition("_")
    if head in ("time", "t"):
        return "t", unit or tail or None
    if head in _AXES:
        return _AXES[head], unit or tail or None
    return name, unit


def _named(
    table: np.ndarray, names: list[tuple[str, str | None]], file: str, unit: str | None
) -> tuple[list[Component], np.ndarray | None, str]:
    keys = [name for name, _ in names]
    for key in ("t", "x", "y", "z"):
        if keys.count(key) > 1:
            raise InputError(f"{file}: {keys.count(key)} columns are named as {key}; name each column once.")
    if "x" not in keys:
        raise InputError(f"{file}: no column holds the horizontal acceleration ax_…; name it ax_g or ax_m_s2.")
    components, units = [], []
    for axis in "xyz":
        if axis not in keys:
            continue
        stated = names[keys.index(axis)][1]
        if stated is None and unit is None:
            raise UnstatedError(_no_unit(f"{file}: column a{axis}"))
        label, size = acceleration_unit(stated or unit or "")
        if stated and unit and acceleration_unit(unit)[1] != size:
            raise InputError(f"{file}: the header says {stated!r}, but unit is given as {unit!r}; leave the unit out.")
        units.append(label)
        components.append(Component(_scaled(table[:, keys.index(axis)], size), np.nan, axis, vertical=axis == "z"))
    time = None
    if "t" in keys:
        scale = TIME_UNITS.get((names[keys.index("t")][1] or "s").lower())
        if scale is None:
            raise InputError(f"{file}: unit of time is {names[keys.index('t')][1]!r}; allowed is s or ms.")
        time = _scaled(table[:, keys.index("t")], scale)
    return components, time, ", ".join(dict.fromkeys(units))


def _bare(
    table: np.ndarray, file: str, unit: str | None, dt: float | None, said: Stated
) -> tuple[list[Component], np.ndarray | None, str]:
    """Numbers without column names: as the lines above them say, else time, then x, y, z; time is known by its growth."""
    columns = table.shape[1]
    grows = columns > 1 and bool((np.diff(table[:, 0]) >= 0.0).all() and table[-1, 0] > table[0, 0])
    order = _order(said, columns, grows, file)
    if order is None:
        labels = [("time", 1.0)] * grows + [(axis, 1.0) for axis in "xyz"]
        if columns > len(labels):
            raise InputError(
                f"{file} has rows of {columns} numbers without column names, and no format that is known here; give "
                "one column of acceleration, or time and up to three components, or a header such as time_s,ax_g."
            )
        order = tuple(labels[:columns])
    if unit is None and said.unit is None:
        raise UnstatedError(_no_unit(file))
    label, size = acceleration_unit(unit or said.unit or "")
    if unit is not None and said.unit is not None and acceleration_unit(said.unit)[1] != size:
        raise InputError(f"{file}: the line {said.unit_line!r} says {said.unit}, but unit is given as {unit!r}.")
    time = next((table[:, i] for i, (name, _) in enumerate(order) if name == "time"), None)
    if time is None and dt is None and said.step is None:
        raise UnstatedError(f"{file} has no time column; state the step: dt=0.01 (--dt 0.01s).")
    components = []
    for i, (name, sign) in enumerate(order):
        if name == "time":
            continue
        one = Component(_scaled(table[:, i], size * sign), np.nan, name.lower() if name in ("X", "Y") else name)
        if said.order is None:
            one.vertical = name == "z"
        else:
            one = oriented(one)
        if sign < 0.0:
            one.processing.insert(0, "sign turned, as the line that names the columns says (-)")
        components.append(one)
    return components, time, label


def _order(said: Stated, columns: int, grows: bool, file: str) -> tuple[tuple[str, float], ...] | None:
    """Labels of the columns as a line names them; a line that does not fit the numbers is refused."""
    order = said.order
    if order is None:
        return None
    timed = any(name == "time" for name, _ in order)
    if len(order) == columns and timed == (grows or timed):
        return order
    if len(order) == columns - 1 and not timed and grows:
        return (("time", 1.0), *order)
    if len(order) == 2 and not timed:  # two words of a title, not columns
        return None
    raise InputError(
        f"{file}: the line {said.order_line!r} names {len(order)} columns ({', '.join(name for name, _ in order)}), the "
        f"rows hold {columns} numbers; write the columns under a header such as time_s,ax_g."
    )


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
            "other steps; mend it, or state a step to resample to: dt=0.01 (--dt 0.01s)."
        )
    if step is None and (np.diff(time) <= 0.0).any():
        bad = int(np.flatnonzero(np.diff(time) <= 0.0)[0]) + 1
        raise InputError(f"{file}, line {first + bad + 1}: the time does not increase ({time[bad]:g} s); mend it.")
    if step is not None and "dt_s" in comments:
        stated = _comment_number(comments, "dt_s", file)
        if abs(stated - step) * (len(time) - 1) <= ROUNDING_SHARE * step:
            step = stated
    for one in components:
        one.dt = np.nan if step is None else step
        one.time = time if step is None else None


def _no_unit(what: str) -> str:
    return f"{what} states no unit; state it: unit='g' (--unit g), or 'm/s2', 'gal', 'mm/s2'."
