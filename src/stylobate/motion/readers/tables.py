"""Rows of numbers as a table: separators, decimal commas, numbers that touch, a mark of the end."""

from __future__ import annotations

import re

import numpy as np

from ...errors import InputError
from .numbers import PIECE, count_numbers, read_numbers

COLUMNS = "columns of numbers"

#: Lines of text that may stand above the numbers.
MAX_TITLE_LINES = 60

_COMMENT = ("#", "%", "!", "//", ";", "*", "'", '"#')
_NUMERIC = re.compile(r"[\s.eEdD+\-,;]*\d[\s\d.eEdD+\-,;]*")
#: The line behind the last numbers, as in ``*** End Data ***``; a row of asterisks alone is numbers that did not fit.
_END = re.compile(r"\W*(?:end|eof)\b[^\d]*", re.IGNORECASE)


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
    found = [i for i in range(start, len(lines)) if (text := lines[i].strip()) and not text.startswith(("#", "%"))]
    if len(found) > 1 and _END.fullmatch(lines[found[-1]]):
        found.pop()
    for i in range(start, found[-1]):
        if re.match(r"\s*[#%].*[^\W_]", lines[i]):
            raise InputError(
                f"{file}, line {i + 1}: {lines[i].strip()[:60]!r} stands among the numbers, as above a second record; give "
                "every record a file, or take the line out."
            )
    sample = lines[found[0]]
    texts = [lines[i] for i in found]
    if ";" in sample or "," in sample:
        # Commas within numbers that blanks or semicolons separate are decimal ones.
        apart = (
            ";" in sample
            or (alone and _DECIMAL.fullmatch(sample.strip()))
            or (re.search(r"\S\s+\S", sample) is not None and re.search(r",\s|\s,", sample) is None)
        )
        decimal = "." not in sample and apart
        mixed = next((i for i in found if "." in lines[i]), None) if decimal else None
        if mixed is not None:
            raise InputError(
                f"{file}, line {mixed + 1}: {lines[mixed].strip()[:60]!r} holds a point, and other numbers have decimal "
                "commas; write one decimal mark throughout, and none for thousands."
            )
        text = "\n".join(texts)
        text = text.replace(";", " ") if ";" in sample else text
        texts = text.replace(",", "." if decimal else "," if ";" in sample else " ").split("\n")
    return found, texts


def _parts(rows: list[int], texts: list[str], file: str) -> np.ndarray:
    """All numbers in a row; a line that holds none is named as the file counts it."""
    found = []
    for start in range(0, len(texts), PIECE):
        try:
            found.append(read_numbers(texts[start : start + PIECE], rows[start], file, COLUMNS))
        except InputError:
            for index, row in zip(rows[start : start + PIECE], texts[start : start + PIECE]):
                read_numbers([row], index, file, COLUMNS)
            raise
    return np.concatenate(found)
