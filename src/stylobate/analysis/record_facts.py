"""Magnitude and distance of records: of a file about them, or of a manifest beside them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

from ..errors import InputError
from . import tables

#: What may be told of a record.
ABOUT = ("magnitude", "distance_km")

_MAGNITUDE = re.compile(r"\bM[wWlLsS]?\s?(\d\.\d)\b")


def facts_of_records(about: Path | None, sources: Sequence[Path], names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Magnitude and distance [km] by record.

    Parameters
    ----------
    about : path, optional
        A table with the columns record, and magnitude or distance_km.
    sources : sequence of path
        Records, or folders of them; without ``about`` the ``manifest.csv`` of each is read.
    names : sequence of str
        Of the records.

    Raises
    ------
    InputError
        The table cannot be read, or tells nothing.
    """
    import pandas

    facts: dict[str, dict[str, float]] = {}
    for folder in (source for source in sources if about is None and (source / "manifest.csv").is_file()):
        table = pandas.read_csv(folder / "manifest.csv", dtype=str).fillna("")
        for row in table.to_dict("records"):
            told = _MAGNITUDE.search(" ".join(str(one) for one in row.values()))
            if told and row.get("file") in names:
                facts[str(row["file"])] = {"magnitude": float(told[1])}
    if about is not None:
        table = tables.read(about, 10_000_000, "record", "the columns record, and magnitude or distance_km")
        known = [one for one in ABOUT if one in table.columns]
        if not known:
            raise InputError(f"{about} needs the columns record, and magnitude or distance_km.", "about")
        for name, *values in zip(table.texts("record"), *(table.numbers(one, math.nan) for one in known), strict=True):
            facts[name] = dict(zip(known, values, strict=True))
    return facts
