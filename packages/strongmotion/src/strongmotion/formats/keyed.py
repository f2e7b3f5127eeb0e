"""Headers of lines ``KEY: value`` or ``KEY   value``, as several networks write them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from stylobate.errors import InputError
from stylobate.motion.readers.numbers import number_in

_NUMERIC = re.compile(r"\s*[+-]?([0-9]|\.[0-9])[0-9\s.eEdD+-]*")


def is_numeric(line: str) -> bool:
    """Whether a line holds numbers and nothing else."""
    return _NUMERIC.fullmatch(line) is not None


def keyed(lines: Sequence[str]) -> dict[str, tuple[str, int]]:
    """Value and line (from 1) by key in lower case, for lines ``KEY: value``; the first of equal keys counts."""
    found: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(lines, 1):
        key, colon, value = line.partition(":")
        if colon and key.strip():
            found.setdefault(" ".join(key.lower().split()), (value.strip(), number))
    return found


def number_of(header: dict[str, tuple[str, int]], key: str, file: str) -> tuple[float, int]:
    """The first number of a value, and its line.

    Raises
    ------
    InputError
        The key is missing, or holds no number.
    """
    value, line = next((entry for name, entry in header.items() if name.startswith(key)), ("", 0))
    return number_after(value, line, key.upper(), file), line


def number_after(value: str, line: int, key: str, file: str) -> float:
    """The number that a value begins with.

    Raises
    ------
    InputError
        It begins with none.
    """
    number = number_in(value)
    if number is None:
        where = f"line {line}" if line else "header"
        raise InputError(f"{file}, {where}: expected a number after {key!r}, found {value!r}; fetch it again.")
    return number
