"""Numbers out of columns of text: separated, glued by a minus sign, or of fixed width."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from ...errors import InputError

#: A sign directly after a digit or a point begins a new number: Fortran fields may leave no blank between numbers.
_GLUED = re.compile(r"(?<=[0-9.])(?=[+-])")
_STRANGE = re.compile(r"[^0-9\s.eEdD+\-]")

#: A number as headers write it, with the exponents of Fortran too.
NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][+-]?[0-9]+)?"
#: The same, not followed by what would make it another number or a word; seconds and hertz may touch it.
_FIRST = re.compile(rf"(?<![\w.]){NUMBER}(?=(?:s|sec|hz)\b|(?!\w|\.[0-9]))", re.IGNORECASE)


#: Lines that are turned into numbers at once.
PIECE = 5000


def number_in(text: str) -> float | None:
    """The first number in ``text``, or None; letters that touch it (``5V``) make it none."""
    match = _FIRST.search(text)
    value = float(re.sub(r"[dD]", "e", match.group())) if match else math.nan
    return value if math.isfinite(value) else None


def count_numbers(line: str) -> int:
    """Number of numbers in a line that is known to hold nothing else, also where they touch."""
    return len(_GLUED.sub(" ", line).split())


def read_numbers(
    lines: Sequence[str], first: int, file: str, what: str, *, count: int | None = None, width: int | None = None
) -> np.ndarray:
    """All numbers of some lines, in reading order.

    Parameters
    ----------
    lines : sequence of str
    first : int
        Index of the first of them in the file, from 0: messages name lines from 1.
    file, what : str
        Name of the file and of the numbers, for messages.
    count : int, optional
        Number that the header promises.
    width : int, optional
        Width of a fixed field. Without it numbers are separated by blanks, or by the minus sign of the next one.

    Returns
    -------
    array
        Shape (count,).

    Raises
    ------
    InputError
        Text where numbers should be, or another number of them than promised.
    """
    values = _parse(lines, None)
    if width is not None and (values is None or len(values) != count):
        fixed = _parse(lines, width)
        values = fixed if fixed is not None else values
    if values is None:
        index = next(
            (
                start + k
                for start in range(0, len(lines), PIECE)
                if not _reads(lines[start : start + PIECE], width)
                for k, line in enumerate(lines[start : start + PIECE])
                if not _reads([line], width)
            ),
            None,
        )
        if index is None:  # each line can be read in one way or the other, but not all in the same
            raise InputError(
                f"{file}, lines {first + 1} to {first + len(lines)}: expected numbers ({what}) of one layout; the file is "
                "damaged, fetch it again."
            )
        shown = lines[index].strip()
        shown = shown if len(shown) <= 40 else shown[:40] + "…"
        raise InputError(
            f"{file}, line {first + index + 1}: expected numbers ({what}), found {shown!r}; mend or remove that line."
        )
    if count is not None and len(values) != count:
        raise InputError(
            f"{file}, lines {first + 1} to {first + len(lines)}: the header promises {count} numbers ({what}), "
            f"{len(values)} are there; the file is damaged or cut, fetch it again."
        )
    if count is not None and _cut_short(lines):
        raise InputError(
            f"{file}, line {first + len(lines)}: the last number ({what}) is shorter than those before it; the file is "
            "damaged or cut, fetch it again."
        )
    return values


def _reads(lines: Sequence[str], width: int | None) -> bool:
    return _parse(lines, None) is not None or (width is not None and _parse(lines, width) is not None)


def _parse(lines: Sequence[str], width: int | None) -> np.ndarray | None:
    """Numbers of the lines, or None if something there is no finite number. In pieces, so that memory stays small."""
    parts = []
    for start in range(0, len(lines), PIECE):
        piece = lines[start : start + PIECE]
        if width is None:
            text = "\n".join(piece)
        else:
            text = "\n".join(
                line[i : i + width].strip().replace(" ", "?")  # a blank inside a field: not laid out as declared
                for line in map(str.rstrip, piece)
                for i in range(0, len(line), width)
            )
        if _STRANGE.search(text):
            return None
        numbers = _floats(text)
        if numbers is None:
            text = text.replace("D", "e").replace("d", "e")
            numbers = _floats(_GLUED.sub(" ", text) if width is None else text)
        if numbers is None:
            return None
        parts.append(numbers)
    values = np.concatenate(parts) if parts else np.empty(0)
    return values if np.isfinite(values).all() else None


def _floats(text: str) -> np.ndarray | None:
    try:
        return np.array(text.split(), dtype=np.float64)
    except ValueError:
        return None


def _cut_short(lines: Sequence[str]) -> bool:
    """Whether the last number lacks its exponent, or a digit of it, where all before it in its lines have theirs."""
    text = " ".join([line for line in lines[-4:] if line.strip()][-2:])
    powers = [match[0].upper().partition("E")[2].lstrip("+-") for match in re.finditer(NUMBER, text)]
    return len(powers) > 1 and len(powers[-1]) < min(map(len, powers[:-1]))
