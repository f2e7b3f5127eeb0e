"""Rows of numbers as a table: separators, decimal commas, numbers that touch, a series written several to a line."""

from __future__ import annotations

import re

import numpy as np

from ...errors import InputError
from .comments import Stated
from .headers import Header
from .numbers import PIECE, count_numbers, read_numbers

COLUMNS = "columns of numbers"


def number_rows(lines: list[str], start: int, file: str) -> tuple[list[str], int]:
    """Lines of numbers, with the separators made blanks and decimal commas made points.

    Raises
    ------
    InputError
        There are points beside decimal commas, which may be of thousands; or words between numbers, as above a second
        record.
    """
    rows = lines[start:]
    last = max(i for i, row in enumerate(rows) if row.strip() and not row.lstrip().startswith(("#", "%")))
    between = next((i for i, row in enumerate(rows[:last]) if re.match(r"\s*[#%].*[^\W_]", row)), None)
    if between is not None:
        raise InputError(
            f"{file}, line {start + between + 1}: {rows[between].strip()[:60]!r} stands among the numbers, as above "
            "a second record; give every record a file, or take the line out."
        )
    sample = rows[0]
    if ";" in sample or "," in sample:
        text = "\n".join(rows)
        # Commas within numbers that blanks or semicolons separate are decimal ones.
        apart = ";" in sample or (re.search(r"\S\s+\S", sample) is not None and re.search(r",\s|\s,", sample) is None)
        decimal = "." not in sample and apart
        if decimal and "." in text:
            check_points(rows, start, file)
        if ";" in sample:
            text = text.replace(";", " ")
        text = text.replace(",", "." if decimal else "," if ";" in sample else " ")
        rows = text.split("\n")
    return rows, start


def check_points(rows: list[str], first: int, file: str) -> None:
    """Rows with decimal commas that hold points as well are refused: 1.234 may be 1234."""
    for line, row in enumerate(rows, first + 1):
        if "." in row and not row.lstrip().startswith(("#", "%")):
            raise InputError(
                f"{file}, line {line}: {row.strip()[:60]!r} holds a point, and other numbers have decimal commas; write one "
                "decimal mark throughout, and none for thousands."
            )


def check_commas(lines: list[str], file: str, first: int) -> None:
    """Nameless lines such as ``0,15`` are refused: one number with a decimal comma, or two numbers."""
    rows = [row.strip() for row in lines if row.strip()]
    if all(re.fullmatch(r"[+-]?\d*,\d+", row) for row in rows):
        raise InputError(
            f"{file}, line {first + 1}: {rows[0]!r} may be one number with a decimal comma or two numbers; write decimal "
            "points, or name the columns as in time_s,ax_g."
        )


def read_series(rows: list[str], first: int, file: str, said: Stated, header: Header | None) -> np.ndarray | None:
    """One series written several numbers to a line, as a column; known by the stated count or by a shorter last row."""
    texts = [row for row in rows if row.strip() and not row.lstrip().startswith(("#", "%"))]
    if len(texts) < 2:
        return None
    width, last = count_numbers(texts[0]), count_numbers(texts[-1])
    total = width * (len(texts) - 1) + last
    if width < 2 or (said.count != total and (width < 5 or last >= width)):
        return None
    if header is not None and (header.readings(width) or header.readings(width - 1)):
        return None
    values = read_numbers(texts, first, file, COLUMNS, count=total, width=None)
    heads = values[::width]
    if said.count != total and bool((np.diff(heads) > 0.0).all()):  # a table with its times, which was cut
        return None
    return values[:, None]


def read_table(rows: list[str], first: int, file: str) -> np.ndarray:
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
    for (index, _), count in zip(kept, counts):
        if count != columns:
            raise InputError(
                f"{file}, line {first + index + 1}: {count} numbers where the rows above have {columns}; "
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
