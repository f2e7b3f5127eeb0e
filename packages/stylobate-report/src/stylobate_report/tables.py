"""Tables of many runs in a report: any rows by their keys, shares with their intervals, and runs without a verdict."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from stylobate.messages import joined, say
from stylobate.verdicts.limit_states import Share

from . import numbers as n
from .page import Exact, Rows

#: Most rows of a table of a result; the CSV file in the folder holds them all.
MOST = 40

#: Columns of tables of shares, and what they are.
COUNTED = (
    *(say("same runs"), say("records"), say("collapse"), say("stand"), say("undecided"), say("share that collapses")),
    *(say("95 % interval"), say("failed or missing")),
)
COUNTED_HOW = say(
    "The share that collapses is told with none and with all of the undecided counted in; so is its interval, "
    "over records, each of which counts once."
)


def counts_of(share: Share) -> list[str]:
    """The cells of a share under :data:`COUNTED`."""
    counts = [share.runs, share.records, share.exceeded, share.not_exceeded, share.undecided]
    return [*map(str, counts), share.words or n.NONE, share.interval_words or n.NONE, str(share.failed)]


#: Keys of columns that hold names, which are in no language.
NAMES = (
    "name",
    "column",
    "motion",
    "record",
    "candidate",
    "hazard",
    "monument",
    "site",
    "model",
    "im",
    "measure",
    "unit",
)


def table(rows: Sequence[Any], keys: Sequence[str], caption: str, mark: str | None = None) -> Rows:
    """Rows by the keys that any of them has; ``mark`` is the key of a verdict, by which cells are coloured."""
    there = [key for key in keys if any(row.get(key) not in (None, "") for row in rows)]
    caption = joined(" ", [caption, n.first_of(MOST, len(rows))])
    body = [
        [Exact(row[key]) if key in NAMES and isinstance(row.get(key), str) else n.plain(row.get(key)) for key in there]
        for row in rows[:MOST]
    ]
    place = there.index(mark) if mark in there else None
    looks = {say("stands"): "good", say("collapsed"): "bad"}
    header = [n.named(key) for key in there]
    return Rows(header, body, caption, mark=place, looks=looks, numbers=True)
