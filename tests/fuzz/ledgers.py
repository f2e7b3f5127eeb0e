"""Ledgers, damaged in every way: refused in a sentence and left as they are, or read with no row altered and added to."""

from __future__ import annotations

import random
from contextlib import closing
from pathlib import Path

from stylobate.campaign.ledger import Ledger, rows_in
from stylobate.errors import InputError

from .target import Fault, Target, sentence


def row(number):
    """What a run leaves."""
    return {"outcome": "rocked", "peak_m": number / 7.0, "time_s": None, "note": "x" * 400}


def damaged(data, rng):
    """A kind of damage, and the file after it."""
    kind = rng.choice(["cut", "empty", "noise", "zeros", "hole", "bytes", "foreign", "header", "shifted", "appended"])
    size = len(data)
    if kind == "cut":
        return kind, data[: rng.randrange(size)]
    if kind == "empty":
        return kind, b""
    if kind == "noise":
        return kind, rng.randbytes(rng.randrange(1, 2 * size))
    if kind == "zeros":
        return kind, bytes(size)
    if kind == "hole":
        start = rng.randrange(size)
        length = rng.randrange(1, 8192)
        return kind, data[:start] + bytes(len(data[start : start + length])) + data[start + length :]
    if kind == "foreign":
        return kind, rng.choice([b"\x89PNG\r\n\x1a\n", b"\x89HDF\r\n\x1a\n", b"PK\x03\x04", b"a,b\n1,2\n"]) * 50
    if kind == "shifted":
        return kind, data[rng.randrange(1, size) :] + data[:100]
    if kind == "appended":
        return kind, data + rng.randbytes(rng.randrange(1, 10_000))
    new = bytearray(data)
    for _ in range(rng.randrange(1, 40)):
        new[rng.randrange(100 if kind == "header" else size)] = rng.randrange(256)
    return kind, bytes(new)


def attempt(rng: random.Random, folder: Path) -> str:
    """Fill a ledger, damage it, and open it again."""
    path, runs = folder / "runs.sqlite", rng.choice([0, 1, 30, 200])
    with closing(Ledger(path)) as book:
        for number in range(runs):
            book.record(number, row(number))
    kind, bad = damaged(path.read_bytes(), rng)
    path.write_bytes(bad)
    if rng.random() < 0.3:
        path.with_name(f"{path.name}-wal").write_bytes(rng.randbytes(rng.randrange(5000)))
    try:
        kept_rows = rows(path)
    except InputError as error:
        sentence(error)
        if path.read_bytes() != bad:
            raise Fault(f"{kind}: a refused file was changed") from error
        return "refused"
    if any(line != row(number) for number, line in kept_rows.items()):
        raise Fault(f"{kind}: a row was altered")
    with closing(Ledger(path)) as book:
        book.record(runs, row(runs))
    if set(rows(path)) != {*kept_rows, runs}:
        raise Fault(f"{kind}: nothing can be added")
    return "all kept" if len(kept_rows) == runs else "part kept"


def rows(path):
    """Rows of a ledger by their number."""
    with closing(Ledger(path)):
        return dict(rows_in(path, lambda number: True))


TARGET = Target("ledgers", 1000, 25, attempt)
