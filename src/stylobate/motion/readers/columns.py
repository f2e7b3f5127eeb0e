"""Columns of text: named by a header of our own (``time_s,ax_g``), or by ``columns`` as the caller states them."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from ...errors import InputError, within
from ..motion import Motion
from ..specs import TIME_UNITS, acceleration_unit
from .numbers import PIECE, count_numbers, read_numbers
from .record import (
    LONGEST_STEP,
    ROUNDING_SHARE,
    Component,
    UnstatedError,
    check_same_step,
    first_bad_step,
    rising_pairs,
    step_of,
)
from .source import Source

COLUMNS = "columns of numbers"

#: Lines of text that may stand above the numbers.
MAX_TITLE_LINES = 60

_COMMENT = ("#", "%", "!", "//", ";", "*", "'", '"#')
_NUMERIC = re.compile(r"[\s.eEdD+\-,;]*\d[\s\d.eEdD+\-,;]*")
#: The line behind the last numbers, as in ``*** End Data ***``; a row of asterisks alone is numbers that did not fit.
_END = re.compile(r"\W*(?:end|eof)\b[^\d]*", re.IGNORECASE)


#: A row of numbers of which one is none.
_NO_NUMBER = re.compile(r"[\s\d.eE+\-,;]*\d[\s,;]+[+-]?(?:nan|inf)\b.*", re.IGNORECASE)

_DECIMAL = re.compile(r"[+-]?\d*,\d+")


def is_ambiguous(rows: list[str]) -> bool:
    """Whether all rows are as ``0,15``: one number with a decimal comma, or two numbers."""
    return all(_DECIMAL.fullmatch(row.strip()) for row in rows if row.strip())


def first_row(lines: list[str]) -> int | None:
    """Index of the first line of numbers."""
    for index, line in enumerate(lines[: MAX_TITLE_LINES + 1]):
        text = line.strip()
        if text and not text.startswith(_COMMENT) and _NUMERIC.fullmatch(text):
            return index
    return None


def read_table(lines: list[str], start: int, file: str, *, alone: bool = False) -> np.ndarray:
    """The numbers from a line on as a table, shape (rows, columns); blank lines and comments are skipped.

    Parameters
    ----------
    lines : list of str
        Of the whole file.
    start : int
        Index of the first line of numbers.
    file : str
        For messages.
    alone : bool
        There is one column, so that the comma of ``0,15`` is the sign of decimals.

    Raises
    ------
    InputError
        There is text among the numbers, rows are of unequal length, or points stand beside decimal commas.
    """
    rows, texts = _rows(lines, start, file, alone)
    try:
        table = np.loadtxt(texts, dtype=np.float64, comments=None, ndmin=2)
        if np.isfinite(table).all():
            return table
    except ValueError:  # numbers that touch, exponents of Fortran, or a line to be named
        pass
    columns = len(read_numbers(texts[:1], start, file, "the first row"))
    values = _parts(rows, texts, file)
    counts = [count_numbers(row) for row in texts]
    lines_of_one = len(counts) > 1 and columns == 2 and set(counts[1:]) == {1}
    if lines_of_one and values[0] == len(counts) - 1 and values[1] > 0.0:
        raise InputError(
            f"{file}, line {start + 1}: {lines[start].strip()!r} holds the number of samples and the step [s], and no row "
            "of them; take out this line and those above it, and state `columns='x [g]'`, with the unit of the numbers, "
            f"and `dt={values[1]:g}`."
        )
    width, last = columns, counts[-1]
    if width > 4 and counts[:-1] == [width] * (len(counts) - 1) and last < width:  # a series, several numbers to a line
        return np.append(values, np.full(width - last, np.nan)).reshape(-1, width)
    for line, count in zip(rows, counts):
        if count != columns:
            raise InputError(
                f"{file}, line {line + 1}: {count} numbers where the rows above have {columns}; "
                "every row needs the same columns."
            )
    return values.reshape(-1, columns)


def _rows(lines: list[str], start: int, file: str, alone: bool) -> tuple[list[int], list[str]]:
    """Indices of the lines of numbers, and these with separators made blanks and decimal commas made points."""
    indices = [i for i in range(start, len(lines)) if (text := lines[i].strip()) and not text.startswith(("#", "%"))]
    if len(indices) > 1 and _END.fullmatch(lines[indices[-1]]):
        indices.pop()
    for i in range(start, indices[-1]):
        if re.match(r"\s*[#%].*[^\W_]", lines[i]):
            raise InputError(
                f"{file}, line {i + 1}: {lines[i].strip()[:60]!r} stands among the numbers, as above a second record; give "
                "every record a file, or take the line out."
            )
    sample = lines[indices[0]]
    texts = [lines[i] for i in indices]
    if ";" in sample or "," in sample:
        # Commas within numbers that blanks or semicolons separate are decimal ones.
        apart = (
            ";" in sample
            or (alone and _DECIMAL.fullmatch(sample.strip()))
            or (re.search(r"\S\s+\S", sample) is not None and re.search(r",\s|\s,", sample) is None)
        )
        decimal = "." not in sample and apart
        mixed = next((i for i in indices if "." in lines[i]), None) if decimal else None
        if mixed is not None:
            raise InputError(
                f"{file}, line {mixed + 1}: {lines[mixed].strip()[:60]!r} holds a point, and other numbers have decimal "
                "commas; write one decimal mark throughout, and none for thousands."
            )
        text = "\n".join(texts)
        text = text.replace(";", " ") if ";" in sample else text
        texts = text.replace(",", "." if decimal else "," if ";" in sample else " ").split("\n")
    return indices, texts


def _parts(rows: list[int], texts: list[str], file: str) -> np.ndarray:
    """All numbers in a row; a line that holds none is named as the file counts it."""
    parts = []
    for start in range(0, len(texts), PIECE):
        try:
            parts.append(read_numbers(texts[start : start + PIECE], rows[start], file, COLUMNS))
        except InputError:
            for index, row in zip(rows[start : start + PIECE], texts[start : start + PIECE]):
                read_numbers([row], index, file, COLUMNS)
            raise
    return np.concatenate(parts)


# -- Columns of text --------------------------------------------------------------------------------------------------


#: From so many numbers to a line on, they may be one series, written on from line to line.
SERIES = 5

#: What a table of columns can be converted to, for messages.
EXAMPLE = "time_s,ax_g"

_STATED_COLUMN = re.compile(r"(?P<axis>-|\w+)\s*(?:\[\s*(?P<unit>[^\]]*?)\s*\])?")
_OWN_COLUMN = re.compile(r"time_(?P<time>s|ms)|a(?P<axis>[xyz])(?:_(?P<unit>\S+))?")
#: Names of a column of the motion to north, in several languages.
_NORTH = re.compile(r"(?:\b|_)n(?:[-_/]?s|or(?:th|d|te)\w*)?(?![^\W_])")
#: A step that was done to a record, as this package writes it.
_DONE = re.compile(r"#\s*processing (?P<number>\d{1,9})\s*:\s*(?P<step>.*\S)")
_FACTS = ("station", "network", "event", "event_id", "start_time", "terms")


class Column(NamedTuple):
    """What a column of numbers holds.

    Parameters
    ----------
    axis : str
        ``t``, ``x``, ``y``, ``z`` (upward), or ``-`` for a column that is left out.
    unit : str, optional
        As written.
    """

    axis: str
    unit: str | None


def parse_columns(text: str) -> tuple[Column, ...]:
    """Columns as typed: ``t [s], x [g], -, z [g]``.

    Raises
    ------
    InputError
        The text cannot be understood; the message shows how to write it.
    """
    columns = []
    for part in text.split(","):
        match = _STATED_COLUMN.fullmatch(part.strip())
        if match is None or match["axis"] not in ("t", "x", "y", "z", "-"):
            raise InputError(
                f"`columns` {text!r}: {part.strip()!r} is not understood; allowed are t, x, y and z with a unit, and - for "
                "a column to leave out, such as 't [s], x [g], -, z [g]'.",
                "columns",
            )
        if match["axis"] == "t" and (match["unit"] or "") not in TIME_UNITS:
            raise InputError(
                f"`columns` {text!r}: {part.strip()!r} states no unit of time; allowed are {', '.join(TIME_UNITS)}, "
                "as in 't [s]'.",
                "columns",
            )
        if match["axis"] in "xyz" and match["unit"] is not None:
            with within("", "columns"):
                acceleration_unit(match["unit"])
        columns.append(Column(match["axis"], match["unit"]))
    _check_axes(columns, f"`columns` {text!r}")
    if "x" not in [column.axis for column in columns]:
        raise InputError(f"`columns` {text!r} names no x; name the column of the horizontal acceleration x.", "columns")
    return tuple(columns)


def _check_axes(columns: list[Column], where: str) -> None:
    axes = [column.axis for column in columns if column.axis != "-"]
    twice = next((axis for axis in axes if axes.count(axis) > 1), None)
    if twice is not None:
        raise InputError(f"{where} names {axes.count(twice)} columns {twice}; name each once.", "columns")
    if "y" in axes and "x" not in axes:
        raise InputError(f"{where} names a column y and none x; name the first horizontal acceleration x.", "columns")
    if not set("xyz") & set(axes):
        raise InputError(f"{where} names no column of acceleration; name it x, as in {EXAMPLE}.", "columns")


def recognises(source: Source) -> bool:
    """Whether there are lines of numbers, the first within the first lines of the file."""
    return source.is_text and first_row(source.lines) is not None


def read(source: Source, unit: str | None, dt: float | None, columns: str | None) -> tuple[list[Component], dict]:
    """Components and metadata of a file of columns.

    Raises
    ------
    InputError
        A header that is not ours and no ``columns``, no unit, no times and no step, unequal steps, rows of unequal length.
    """
    lines, file = source.lines, source.name
    first = first_row(lines)
    assert first is not None
    titles = [line.strip() for line in lines[:first] if line.strip()]
    if titles and _NO_NUMBER.fullmatch(titles[-1]):
        raise InputError(
            f"{file}: {titles[-1][:60]!r} holds no number in one of its columns; mend or remove that line."
        )
    header = _header(lines[:first], file)
    stated = None if columns is None else list(parse_columns(columns))
    table = read_table(lines, first, file, alone=len(stated or header or ()) == 1)
    if len(table) < 2:
        raise InputError(f"{file}, line {first + 1}: one row of numbers; give one row per time, at least two.")
    if columns is not None and header is not None:
        raise InputError(f"{file} names its columns itself (as {EXAMPLE} does); leave `columns` out.", "columns")
    if stated is not None:
        table = _series(table, stated, file)
    elif header is not None:
        stated = header
    else:
        stated = _bare(lines[:first], lines[first:], table, unit, file)
    if len(stated) != table.shape[1] or not np.isfinite(table).all():
        raise InputError(
            f"{file}: {'`columns`' if columns else 'its header'} names {len(stated)} columns, the rows hold "
            f"{table.shape[1]} numbers; name each column once, those to leave out -, and separate columns by semicolons "
            "where a comma is the sign of decimals.",
            "columns",
        )
    comments = _comments(titles) if header is not None else {}
    components, time, units = _components(table, stated, unit, file)
    if time is not None:
        _set_step(components, time, dt, comments, file, first)
    elif dt is None:
        raise UnstatedError(f"{file} has no time column; state the step: `dt=0.01`.", field="dt")
    if "sha256" in comments:
        _check_digest(components, comments["sha256"], file)
    history = _history(titles, file)
    for component in components:
        component.named = header is not None and not component.proven  # our own lone component is x, wherever it points
        component.history = history
        if f"azimuth_{component.label}_deg" in comments:
            component.azimuth = _comment_number(comments, f"azimuth_{component.label}_deg", file)
    facts = {"format": "columns of text", "unit": ", ".join(dict.fromkeys(units)), "stage": comments.get("stage")}
    facts |= {key: comments[key] for key in _FACTS if key in comments}
    if titles:
        facts["header"] = tuple(titles[:MAX_TITLE_LINES])
    if time is not None and abs(time[0]) > 0.0:
        facts["first_time"] = float(time[0])
    return components, facts


def _header(lines: list[str], file: str) -> list[Column] | None:
    """Columns of the line that names them as this package does; behind it stand comments at most."""
    for number, line in reversed(list(enumerate(lines, 1))):
        cells = [cell.strip('"') for cell in re.split(r"\s*[,;\t]\s*|\s+", line.lower().strip("#% \t,;"))]
        matches = [_OWN_COLUMN.fullmatch(cell) for cell in cells]
        if all(matches):
            columns = [
                Column("t", match["time"]) if match["time"] else Column(match["axis"], match["unit"])
                for match in matches
                if match
            ]
            _check_axes(columns, f"{file}, line {number}: {line.strip()!r}")
            return columns
        if line.strip() and not line.lstrip().startswith(("#", "%")):
            return None
    return None


def _bare(above: list[str], below: list[str], table: np.ndarray, unit: str | None, file: str) -> list[Column]:
    """Columns of numbers alone: one of acceleration, or times in equal steps and one; all else has to be stated."""
    rises = table.shape[1] > 1 and step_of(table[:, 0]) is not None
    if not any(line.strip() for line in above):
        if is_ambiguous(below):
            raise InputError(
                f"{file}, line 1: {below[0].strip()!r} may be one number with a decimal comma or two numbers; write decimal "
                f"points, or name the columns as in {EXAMPLE}."
            )
        if table.shape[1] == 1 + rises:
            return [Column("t", "s")] * rises + [Column("x", None)]
    number, line = next(
        ((i, text) for i, text in reversed(list(enumerate(above, 1))) if text.strip()), (len(above), "")
    )
    what = f"{file}, line {number}: {line.strip()[:200]!r} is not a header as {EXAMPLE} is" if line else (
        f"{file} has {table.shape[1]} columns of numbers without names"
    )  # fmt: skip
    unit = unit or next((known for text in reversed(above) if (known := _unit_in(text.lower()))), None)
    proposal = propose(line, table, unit)
    step = "" if proposal.startswith("t") else ", and `dt`, the time from sample to sample"
    none = "" if unit else ", of which it states none"
    raise UnstatedError(
        f"{what}; state what each column holds, which may be `columns='{proposal}'`{step}: check what is x, y and z "
        f"(upward), and the units{none}.",
        field="columns",
    )


def propose(line: str, table: np.ndarray, unit: str | None) -> str:
    """Columns that a line above numbers may mean: for a person to judge and to type, and never read.

    Parameters
    ----------
    line : str
    table : array
        Shape (rows, columns).
    unit : str, optional
        Of acceleration, where the line states none; g otherwise.
    """
    count = table.shape[1]
    text = line.lower().strip("#%!*/' \t")
    ways = (re.split(r"[,;\t|]", text), re.split(r"\s{2,}", text), text.split())
    cells = next((way for way in ways if len(way) == count), [""] * count)
    unit = next((known for cell in (*cells, text) if (known := _unit_in(cell))), unit or "g")
    rises = count > 1 and bool((np.diff(table[:, 0]) > 0.0).all())
    if count >= SERIES and not rises and not any(cells):
        return f"x [{unit}]"
    upward = re.compile(r"up|ver|ud|u-d|(?:\b|_)a?z(?![a-z])|_v(?![a-z])|^z|^v\b")
    free, columns = ["x", "y"], []
    for i, cell in enumerate(cells):
        if i == 0 and rises:
            columns.append(f"t [{'ms' if float(np.median(np.diff(table[:, 0]))) > LONGEST_STEP else 's'}]")
        elif re.search(r"vel|dis|^[vdu](?![pd])|[\[(_]\s*[cm]?m(?:/s(?:ec)?)?\s*[\])]?$", cell) and not _unit_in(cell):
            columns.append("-")
        elif upward.search(cell) and not any(column[0] == "z" for column in columns):
            columns.append(f"z [{_unit_in(cell) or unit}]")
        else:
            columns.append(f"{free.pop(0)} [{_unit_in(cell) or unit}]" if free else "-")
    if free[:1] == ["x"]:
        columns[rises] = f"x [{unit}]"
    if not free and _NORTH.search(cells[(x := next(i for i, column in enumerate(columns) if column[0] == "x"))]):
        y = next(
            i for i, column in enumerate(columns) if column[0] == "y"
        )  # with z upward, y is to the left of x: north of east
        columns[x], columns[y] = "y" + columns[x][1:], "x" + columns[y][1:]
    return ", ".join(columns)


def _unit_in(cell: str) -> str | None:
    """A unit of acceleration that a cell is, or holds behind a name: in brackets, or behind a stroke or a colon."""
    for candidate in (cell.strip(), *re.findall(r"[\[(_/:]\s*([^][(),:;\t|_]+)", cell)):
        try:
            return acceleration_unit(candidate)[0]
        except InputError:
            continue
    return None


def _series(table: np.ndarray, stated: list[Column], file: str) -> np.ndarray:
    """One series that is written on from line to line, as a column; any other table as it is."""
    if len(stated) > 1 or table.shape[1] < SERIES:
        return table
    if step_of(table[:, 0]) is not None:
        raise InputError(
            f"{file}: the first numbers of its lines rise in equal steps as times do, and `columns` names x alone; name "
            "every column, those to leave out -.",
            "columns",
        )
    values = table.ravel()
    return values[: len(values) - int(np.isnan(values).sum())][:, None]


def _comments(titles: list[str]) -> dict[str, str]:
    """Facts of the record in lines ``# key: value``, as this package writes them."""
    parts = (line.lstrip("# ").partition(":") for line in titles if line.startswith("#"))
    return {key.strip().lower(): value.strip() for key, colon, value in parts if colon}


def _history(titles: list[str], file: str) -> list[str]:
    """What was done to a record that this package wrote, in order."""
    matches = [match for line in titles if (match := _DONE.fullmatch(line))]
    numbers = [int(match["number"]) for match in matches]
    if numbers != list(range(1, len(numbers) + 1)):
        raise InputError(
            f"{file}: the lines '# processing N: …' are numbered {', '.join(map(str, numbers))}; allowed is 1, 2, 3 and so "
            "on, in this order: fetch the file again, as a step that was done to the record may be lost."
        )
    return [match["step"] for match in matches]


def _comment_number(comments: dict[str, str], key: str, file: str) -> float:
    try:
        return float(comments[key])
    except ValueError:
        raise InputError(f"{file}: the comment {key} is {comments[key]!r}; it should be a number.") from None


def _check_digest(components: list[Component], written: str, file: str) -> None:
    parts = {component.label: component.values for component in components}
    digest = Motion(components[0].dt, parts["x"], parts.get("y"), parts.get("z")).digest
    if digest != written:
        raise InputError(
            f"{file}: the numbers are not those that were written with the line '# sha256: …'; fetch the file again, or "
            "remove that line if you changed them."
        )
    for component in components:
        component.proven = True


def _components(
    table: np.ndarray, columns: list[Column], unit: str | None, file: str
) -> tuple[list[Component], np.ndarray | None, list[str]]:
    """Components x, y, z in this order, their times [s], and their units."""
    by_axis = {column.axis: (column.unit, table[:, i]) for i, column in enumerate(columns) if column.axis != "-"}
    time = None
    if "t" in by_axis:
        stated, values = by_axis.pop("t")
        time = values * TIME_UNITS[stated or "s"] if stated != "s" else values.copy()
    components, units = [], []
    for axis in sorted(by_axis):
        stated, values = by_axis[axis]
        if stated is None and unit is None:
            what = file if len(by_axis) == 1 else f"{file}: column {axis}"
            raise UnstatedError(f"{what} states no unit; state it: `unit='g'`, or m/s2, gal, mm/s2.", field="unit")
        with within(file):
            shown, size = acceleration_unit(stated or unit or "")
        if stated and unit and acceleration_unit(unit)[1] != size:
            raise InputError(
                f"{file}: its columns are in {stated}, but unit is given as {unit!r}; leave the unit out.", "unit"
            )
        units.append(shown)
        scaled = np.ascontiguousarray(values) * size if size != 1.0 else values.copy()
        components.append(Component(scaled, np.nan, axis, vertical=axis == "z"))
    return components, time, units


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
        check_same_step(stated, step, file, first)
        if abs(stated - step) * (len(time) - 1) <= ROUNDING_SHARE * step:
            step = stated
    for component in components:
        component.dt = np.nan if step is None else step
        component.time = time if step is None else None
        component.first = float(time[0])
