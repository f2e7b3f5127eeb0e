"""Rows of a ledger as lines that prove themselves, and the search for whole ones in a damaged file."""

from __future__ import annotations

import hashlib
import json
import re
import sqlite3
from collections.abc import Mapping
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

#: Longest text of a line that is looked for in the bytes of a file; longer ones lie in several pieces there.
LONGEST = 16_384

_LINE = re.compile(rb"([0-9a-f]{16}) (\d{1,18}) (?=\{)")


def write_line(number: int, row: Mapping[str, Any], campaign: str) -> str:
    """A run as one line: checksum, number, row."""
    rest = f"{number} {json.dumps(row)}"
    return f"{_sum(rest, campaign)} {rest}"


def number_of(line: Any) -> int | None:
    """The number that a line tells, whole or not; None if it tells none."""
    told = line.split(" ", 2)[1:2] if isinstance(line, str) else []
    return int(told[0]) if told and told[0].isdecimal() else None


def read_line(line: Any, campaign: str) -> tuple[int, dict] | None:
    """Number and row of a line; None if it is not whole, or of another campaign."""
    if not isinstance(line, str):
        return None
    checksum, _, rest = line.partition(" ")
    if checksum != _sum(rest, campaign):
        return None
    number, _, row = rest.partition(" ")
    return int(number), json.loads(row)


def whole_lines(path: Path, campaign: str) -> list[tuple[int, str]]:
    """Lines of a campaign that are whole in a damaged ledger (and what SQLite kept beside it): by number, once each."""
    found: dict[int, str] = {}
    for ending in ("", "-wal"):
        with suppress(OSError):
            found |= _in_bytes(Path(f"{path}{ending}").read_bytes(), campaign)
    found |= _in_table(path, campaign)
    return sorted(found.items())


def _in_bytes(data: bytes, campaign: str) -> dict[int, str]:
    found, decoder = {}, json.JSONDecoder()
    for one in _LINE.finditer(data):
        text = data[one.end() : one.end() + LONGEST].decode("ascii", "replace")
        with suppress(ValueError, RecursionError):
            line = one[0].decode("ascii") + text[: decoder.raw_decode(text)[1]]
            if read_line(line, campaign) is not None:
                found[int(one[2])] = line
    return found


def _in_table(path: Path, campaign: str) -> dict[int, str]:
    # Forwards and backwards, each until SQLite meets a damaged page.
    found: dict[int, str] = {}
    for order in ("ASC", "DESC"):
        with suppress(sqlite3.Error, OSError, UnicodeDecodeError), closing(_read_only(path)) as file:
            file.execute("PRAGMA writable_schema = ON")  # reads on where the file is shorter than it says
            for (line,) in file.execute(f"SELECT line FROM runs ORDER BY number {order}"):
                if (whole := read_line(line, campaign)) is not None:
                    found[whole[0]] = line
    return found


def text(data: bytes) -> str:
    """A text of a file that may be damaged: checksums tell, not the decoder."""
    return data.decode("utf-8", "replace")


def _read_only(path: Path) -> sqlite3.Connection:
    file = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)
    file.text_factory = text
    return file


def _sum(rest: str, campaign: str) -> str:
    return hashlib.sha256(f"{campaign} {rest}".encode("utf-8", "surrogatepass")).hexdigest()[:16]
