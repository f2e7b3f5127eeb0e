"""Magnitude and distance of records: of a file about them, or of a manifest beside them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

from ..errors import InputError
from ..motion import Motion
from ..motion.earthquakes import MAX_BYTES, is_catalogue, places_of, read_earthquake, station_of
from ..motion.readers.source import Source
from . import tables

#: What may be told of a record.
ABOUT = ("magnitude", "distance_km")

_MAGNITUDE = re.compile(r"\bM[wWlLsS]?\s?(\d\.\d)\b")


def facts_of_records(
    about: Path | None, sources: Sequence[Path], motions: Sequence[Motion]
) -> dict[str, dict[str, float]]:
    """Magnitude and distance [km] by record.

    Parameters
    ----------
    about : path, optional
        A table with the columns record, and magnitude or distance_km; a ``manifest.csv``; or the QuakeML of the one
        earthquake of all records,
        whose distance is that from the epicentre to stations whose StationXML lies with the records.
    sources : sequence of path
        Records, or folders of them; without ``about`` the ``manifest.csv`` of each is read.
    motions : sequence of Motion
        The records.

    Raises
    ------
    InputError
        The table cannot be read, or tells nothing.
    """
    names = {name for motion in motions for name in (motion.name, motion.record)}
    facts: dict[str, dict[str, float]] = {}
    for folder in (source for source in sources if about is None and (source / "manifest.csv").is_file()):
        facts |= _of_manifest(folder / "manifest.csv", names)
    if about is not None and is_catalogue(about):
        return _of_one_earthquake(about, sources, motions)
    if about is not None and _is_manifest(about):
        if not (facts := _of_manifest(about, names)):
            raise InputError(
                f"{about} tells the magnitude of none of these records; allowed is a column file with their names, and a "
                "magnitude such as Mw7.1 in the row; or give a table of record, magnitude, distance_km.",
                "about",
            )
    elif about is not None:
        table = tables.read(about, 10_000_000, "record", "the columns record, and magnitude or distance_km")
        known = [one for one in ABOUT if one in table.columns]
        if not known:
            raise InputError(f"{about} needs the columns record, and magnitude or distance_km.", "about")
        for name, *values in zip(table.texts("record"), *(table.numbers(one, math.nan) for one in known), strict=True):
            facts[name] = dict(zip(known, values, strict=True))
    return facts


def _is_manifest(path: Path) -> bool:
    """Whether the first line of a table names a column of files and none of records."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            names = file.readline(4000).strip().split(",")
    except OSError:
        return False
    return "file" in names and "record" not in names


def _of_manifest(path: Path, names: set[str]) -> dict[str, dict[str, float]]:
    """Magnitudes by file, of the rows of a manifest in which one is written."""
    import pandas

    try:
        rows = pandas.read_csv(path, dtype=str).fillna("").to_dict("records")
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot be read as CSV ({' '.join(str(error).split())[:120]}).", "about") from None
    found = {str(row.get("file")): _MAGNITUDE.search(" ".join(map(str, row.values()))) for row in rows}
    return {file: {"magnitude": float(told[1])} for file, told in found.items() if told and file in names}


def _of_one_earthquake(about: Path, sources: Sequence[Path], motions: Sequence[Motion]) -> dict[str, dict[str, float]]:
    """Magnitude of an earthquake and distances from its epicentre, of stations that are described beside the records."""
    earthquake = read_earthquake(about)
    folders = [source if source.is_dir() else source.parent for source in sources]
    beside = dict.fromkeys(path for folder in folders for path in sorted(folder.glob("*.xml")) if path != about)
    places = places_of(Source(path, path.read_bytes()) for path in beside if path.stat().st_size <= MAX_BYTES)
    facts = {}
    for motion in motions:
        place = places.get(station_of(motion.metadata) or "")
        known = {"magnitude": earthquake.magnitude}
        if place is not None:
            known["distance_km"] = earthquake.distance_km(*place)
        facts |= dict.fromkeys((motion.name, motion.record), known)
    return facts
