"""Lines of a file that is edited on the page: where in its text an error lies."""

from __future__ import annotations

import re

from stylobate.errors import InputError

#: Where the reader of TOML says that it stopped; a block that a sentence names; the name that one without a name has.
_AT, _NAMED, _NUMBERED = (
    re.compile(r"\(at line (\d+),"),
    re.compile(r"\b(?:block|called) '([^']*)'"),
    re.compile(r"block (\d+)"),
)


def point_to(error: InputError, text: str, field: str) -> None:
    """Make an error one of the field that holds the text: with the number of its line, such as ``assembly.12``, if known."""
    line = _line(error, text.split("\n"))
    error.field = field if line is None else f"{field}.{line}"


def _line(error: InputError, lines: list[str]) -> int | None:
    """Number of the line that an error is about, from 1."""
    said, (*table, key) = str(error), (error.field or "").split(".")
    if (stopped := _AT.search(said)) is not None:
        return int(stopped[1])
    if len(table) == 2 and table[1].isdecimal():
        begins = _header(lines, table[0], int(table[1]))
        return begins and (_key(lines, key, begins) or begins)
    if key and (found := _key(lines, key)) is not None:
        return found
    for name in _NAMED.findall(said):
        named = next(
            (k for k, one in enumerate(lines, 1) if re.match(rf"\s*name\s*=\s*(['\"]){re.escape(name)}\1", one)), None
        )
        numbered = _NUMBERED.fullmatch(name)
        if named is None and numbered is not None:
            named = _header(lines, "block", int(numbered[1]))
        if named is not None:
            return named
    return None


def _header(lines: list[str], table: str, number: int) -> int | None:
    """Line at which the table of that number in a list begins."""
    headers = [k for k, one in enumerate(lines, 1) if re.match(rf"\s*\[\[\s*{re.escape(table)}\s*\]\]", one)]
    return headers[number - 1] if 0 < number <= len(headers) else None


def _key(lines: list[str], key: str, begins: int | None = None) -> int | None:
    """First line that gives a key; of the table that begins at a line, where there is one."""
    for k, one in enumerate(lines[begins or 0 :], 1 + (begins or 0)):
        if begins is not None and re.match(r"\s*\[", one) and not re.match(r"\s*\[\s*-?[\d\[]", one):
            return None
        if re.match(rf"\s*(['\"]?){re.escape(key)}\1\s*=", one):
            return k
    return None
