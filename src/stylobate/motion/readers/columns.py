"""Columns of text: CSV whose header names the units, and plain numbers whose unit the caller states."""

from __future__ import annotations

import re

import numpy as np

from ...errors import InputError
from ..specs import TIME_UNITS, acceleration_unit
from .numbers import PIECE, count_numbers, read_numbers
from .record import Component, UnstatedError
from .source import Source
from .steps import ROUNDING_SHARE, first_bad_step, step_of

#: Lines of text that may stand above the numbers.
MAX_TITLE_LINES = 60
COLUMNS = "columns of numbers"
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
    rows, first = _rows(lines, start)
    table = _table(rows, first, source.name)
    columns = table.shape[1]
    if len(table) < 2:
        raise InputError(f"{source.name}, line {first + 1}: one row of numbers; give one row per time, at least two.")
    if names is not None and len(names) != columns:
        raise InputError(
            f"{source.name}, line {first + 1}: {columns} numbers under {len(names)} column names; every row needs "
            "one per name."
        )
    if names is None:
        components, time, unit_found = _bare(table, source.name, unit, dt)
    else:
        components, time, unit_found = _named(table, names, source.name, unit)
    if time is not None:
        _set_step(components, time, dt, comments, source.name, first)
    elif "dt_s" in comments:
        for one in components:
            one.dt = _comment_number(comments, "dt_s", source.name)
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


def _rows(lines: list[str], start: int) -> tuple[list[str], int]:
    """Lines of numbers, with the separators made blanks and decimal commas made points."""
    rows = lines[start:]
    sample = rows[0]
    if ";" in sample or "," in sample:
        text = "\n".join(rows)
        if ";" in sample:
            decimal_comma = "," in sample and "." not in sample
            text = text.replace(";", " ").replace(",", "." if decimal_comma else ",")
        else:
            text = text.replace(",", " ")
        rows = text.split("\n")
    return rows, start


def _table(rows: list[str], first: int, file: str) -> np.ndarray:
    """Numbers as a table, shape (rows, columns); blank and comment lines are skipped."""
    kept = [(i, row) for i, row in enumerate(rows) if row.strip() and not row.lstrip().startswith(("#", "%"))]
    texts = [row for _, row in kept]
    try:
        table = np.loadtxt(texts, dtype=np.float64, comments=None, ndmin=2)
        if np.isfinite(table).all():
            return table
    except ValueError:  # numbers that touch, exponents of Fortran, or a line to be named
        pass
    columns = len(read_numbers(texts[:1], first, file, "the first row"))
    values = _parts(kept, texts, first, file)
    counts = [count_numbers(row) for row in texts]
    for (index, _), found in zip(kept, counts):
        if found != columns:
            raise InputError(
                f"{file}, line {first + index + 1}: {found} numbers where the rows above have {columns}; "
                "every row needs the same columns."
            )
    return values.reshape(-1, columns)


def _parts(kept: list[tuple[int, str]], texts: list[str], first: int, file: str) -> np.ndarray:
    """All numbers in a row; a line that holds none is named as the file counts it."""
    found = []
    for start in range(0, len(texts), PIECE):
        try:
            found.append(read_numbers(texts[start : start + PIECE], first, file, COLUMNS))
        except InputError:
            for index, row in kept[start : start + PIECE]:
                read_numbers([row], first + index, file, COLUMNS)
            raise
    return np.concatenate(found)


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
    table: np.ndarray, file: str, unit: str | None, dt: float | None
) -> tuple[list[Component], np.ndarray | None, str]:
    """Numbers without column names: time, then x, y, z; the time is known by its growth."""
    columns = table.shape[1]
    grows = columns > 1 and bool((np.diff(table[:, 0]) >= 0.0).all()) and table[-1, 0] > table[0, 0]
    time = table[:, 0] if grows else None
    values = table[:, 1:] if time is not None else table
    if values.shape[1] > 3:
        raise InputError(
            f"{file} has rows of {columns} numbers without column names, and no format that is known here; give one "
            "column of acceleration, or time and up to three components, or a header such as time_s,ax_g."
        )
    if unit is None:
        raise UnstatedError(_no_unit(file))
    label, size = acceleration_unit(unit)
    if time is None and dt is None:
        raise UnstatedError(f"{file} has no time column; state the step: dt=0.01 (--dt 0.01s).")
    axes = "xyz"[: values.shape[1]]
    return (
        [Component(_scaled(values[:, i], size), np.nan, axis, vertical=axis == "z") for i, axis in enumerate(axes)],
        time,
        label,
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
            f"{file}, line {first + bad + 1}: the time goes from {time[bad - 1]:g} s to {time[bad]:g} s, unlike "
            "the other "
            "steps; mend it, or state a step to resample to: dt=0.01 (--dt 0.01s)."
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
