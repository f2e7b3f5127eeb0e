"""From which direction a motion does most harm: runs by the azimuth that their motion was turned to."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..motion import Motion
from . import verdicts as v
from .side_by_side import codes_of, shares

if TYPE_CHECKING:
    import pandas


def direction_of(motion: Motion) -> dict[str, Any]:
    """Azimuth of x [degrees], or None, and whether the horizontal components are reversed; as columns of tables."""
    asked = motion.metadata.get("direction") or {}
    known = (motion.metadata.get("azimuths") or {}).get("x")
    return {"azimuth_deg": asked.get("azimuth", known), "reversed": bool(asked.get("reversed", False))}


def bearing(row: Mapping[str, Any]) -> float | None:
    """Where the shaking along x points to [degrees]: the azimuth of x, or opposite to it where it is reversed."""
    if row.get("azimuth_deg") is None:
        return None
    return (float(row["azimuth_deg"]) + 180.0 * bool(row.get("reversed"))) % 360.0


def harm(row: Mapping[str, Any]) -> tuple[float, float, float]:
    """What rows are ordered by: probability of collapse, collapse of the column itself and how soon, peak displacement.

    Runs that failed come first, because they say nothing.
    """
    if v.verdict(row) == v.FAILED:
        return -1.0, 0.0, 0.0
    share = row.get("collapse_probability")
    fell = bool(row["collapsed"])
    likely = float(fell) if share is None or math.isnan(share) else float(share)
    return likely, 1.0 / (1.0 + row["collapse_time_s"]) if fell else 0.0, abs(row[_peak_of(row)])


def _peak_of(row: Mapping[str, Any]) -> str:
    """Name of the peak displacement: of the top of a column, or of the block of an assembly that goes farthest."""
    return next(name for name in ("peak_top_displacement_m", "peak_displacement_m") if name in row)


def worst(rows: Sequence[Mapping[str, Any]]) -> Mapping[str, Any] | None:
    """The row whose motion does most harm; None where all failed."""
    found = max(rows, key=harm, default=None)
    return None if found is None or v.verdict(found) == v.FAILED else found


#: Columns of the table of several runs.
SHOWN = ("motion", "outcome", "undecided", "collapse_time_s", "collapse_probability", "peak_top_displacement_m",
         "peak_displacement_m", "peak_rotation_rad")  # fmt: skip


def table_of_runs(rows: Sequence[Mapping[str, Any]]) -> pandas.DataFrame:
    """A row per run, of what a person compares; columns that are empty are left out."""
    import pandas

    table = pandas.DataFrame([{**one, "undecided": "undecided" * (v.verdict(one) == v.UNDECIDED)} for one in rows])
    return table.filter(list(SHOWN)).replace("", None).dropna(axis="columns", how="all")


@dataclass(frozen=True, eq=False)
class Compass:
    """A value by direction.

    Parameters
    ----------
    bearings : array
        [degrees], shape (D,), rising.
    values : array
        Shape (D,); infinite where it lies beyond what was looked at, NaN where nothing is known.
    low, high : array, optional
        Its interval.
    name : str
        With its unit.
    """

    bearings: np.ndarray
    values: np.ndarray
    name: str
    low: np.ndarray | None = None
    high: np.ndarray | None = None


def compass_of_shares(rows: Sequence[Mapping[str, Any]]) -> Compass:
    """Share of the runs from each direction that collapse, with its interval over records, of which each counts once."""
    named = [(bearing(row), v.verdict(row), str(row["record"])) for row in rows]
    bearings = sorted({one for one, *_ in named if one is not None})
    values = []
    for at in bearings:
        verdicts, records = zip(*(rest for one, *rest in named if one == at))
        (found,) = shares({"": codes_of(np.array(verdicts))}, records)
        decided = found.exceeded + found.not_exceeded
        values.append((found.low if decided else math.nan, *found.interval))
    share, low, high = np.array(values).reshape(-1, 3).T
    return Compass(np.array(bearings), share, "share of the runs that collapse [-]", low, high)


def compass_of_chances(rows: Sequence[Mapping[str, Any]]) -> Compass:
    """Probability of collapse from each direction, of several records the largest; without twins, the peak displacement."""
    sound = [row for row in rows if bearing(row) is not None and v.verdict(row) != v.FAILED]
    name = _peak_of(sound[0]) if sound else "peak_top_displacement_m"
    names, label = [name], f"peak {'top ' if 'top' in name else ''}displacement (collapse at the rim) [m]"
    if all(row.get("collapse_probability") is not None for row in sound):
        names = ["collapse_probability", "collapse_interval_low", "collapse_interval_high"]
        label = "probability of collapse [-]"
    found: dict[float, list[float]] = {}
    for row in sound:
        values = [math.inf if len(names) == 1 and row["collapsed"] else abs(row[name]) for name in names]
        at = float(bearing(row) or 0.0)
        if at not in found or values[0] > found[at][0]:
            found[at] = values
    columns = np.array([found[at] for at in sorted(found)]).reshape(-1, len(names)).T
    low, high = (columns[1], columns[2]) if len(names) == 3 else (None, None)
    return Compass(np.array(sorted(found)), columns[0], label, low, high)
