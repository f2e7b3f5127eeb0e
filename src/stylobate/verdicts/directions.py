"""From which direction a motion does most harm: runs by the azimuth that their motion was turned to."""

from __future__ import annotations

import math
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..messages import joined, say
from ..motion import Motion
from . import verdict as v
from .limit_states import codes_of, shares

if TYPE_CHECKING:
    import pandas


def direction_of(motion: Motion) -> dict[str, Any]:
    """Azimuth of x [degrees], or None, and whether the horizontal components are reversed; as columns of tables."""
    direction = motion.metadata.get("direction") or {}
    known = (motion.metadata.get("azimuths") or {}).get("x")
    return {"azimuth_deg": direction.get("azimuth", known), "reversed": bool(direction.get("reversed", False))}


def bearing(row: Mapping[str, Any]) -> float | None:
    """Direction of the shaking along x [degrees]: the azimuth of x, or opposite to it where it is reversed."""
    if row.get("azimuth_deg") is None:
        return None
    return (float(row["azimuth_deg"]) + 180.0 * bool(row.get("reversed"))) % 360.0


def harm(row: Mapping[str, Any]) -> tuple[float, float, float]:
    """Order of rows: probability of collapse, collapse of the column itself and how soon, peak displacement.

    Runs that failed come first, because they say nothing.
    """
    if v.verdict(row) == v.FAILED:
        return -1.0, 0.0, 0.0
    share = row.get("collapse_probability")
    fell = bool(row["collapsed"])
    likely = float(fell) if share is None or math.isnan(share) else float(share)
    return likely, 1.0 / (1.0 + row["collapse_time_s"]) if fell else 0.0, abs(row[peak_of(row)])


def peak_of(row: Container[Any]) -> str:
    """Name of the peak displacement: of the top of a column, or of the block of an assembly that goes farthest."""
    return next(name for name in ("peak_top_displacement_m", "peak_displacement_m") if name in row)


def worst(rows: Sequence[Mapping[str, Any]], compass: Compass | None = None) -> Mapping[str, Any] | None:
    """The row whose motion does most harm, of those from the worst direction of a compass; None where all failed."""
    if compass is not None and compass.worst is not None:
        rows = [row for row in rows if bearing(row) == compass.worst]
    worst_row = max(rows, key=harm, default=None)
    return None if worst_row is None or v.verdict(worst_row) == v.FAILED else worst_row


#: Columns of the table of several runs.
TABLE_COLUMNS = ("motion", "outcome", "undecided", "collapse_time_s", "collapse_probability", "collapse_interval_low",
         "collapse_interval_high", "replicates", "peak_top_displacement_m", "peak_displacement_m",
         "peak_rotation_rad")  # fmt: skip


def table_of_runs(rows: Sequence[Mapping[str, Any]]) -> pandas.DataFrame:
    """A row per run, of what a person compares; columns that are empty are left out."""
    import pandas

    table = pandas.DataFrame([{**row, "undecided": "undecided" * (v.verdict(row) == v.UNDECIDED)} for row in rows])
    return table.filter(list(TABLE_COLUMNS)).replace("", None).dropna(axis="columns", how="all")


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
    worst : float, optional
        The direction that does most harm [degrees], by the value, then by the runs from there; None where none is known.
    beyond : str
        What an infinite value means.
    undecided : tuple of float
        Directions from which a run is undecided, and may yet collapse [degrees].
    cure : str
        What decides them, of :func:`stylobate.response.words.to_decide`.
    """

    bearings: np.ndarray
    values: np.ndarray
    name: str
    low: np.ndarray | None = None
    high: np.ndarray | None = None
    worst: float | None = None
    beyond: str = "no collapse seen"
    undecided: tuple[float, ...] = ()
    cure: str = ""

    @property
    def none_collapses(self) -> bool:
        """Whether these are shares, and from no direction anything collapses."""
        return self.low is not None and not np.any(self.values > 0.0)

    @property
    def words(self) -> str:
        """The worst direction and its value, or that from none anything collapses; empty where nothing is known."""
        if self.worst is None:
            return ""
        if self.none_collapses:
            return f"no direction {'surely ' if self.undecided else ''}collapses it"
        value = float(self.values[self.bearings == self.worst][0])
        return f"worst: {self.worst:g}°, {self.beyond if math.isinf(value) else f'{value:.3g}'}"

    @property
    def may_collapse(self) -> str:
        """How many directions have runs that may yet collapse, and what decides them; empty where none has."""
        count, every = len(self.undecided), len(self.bearings)
        if not count:
            return ""
        if not self.cure:
            return say(
                "From {count} of {every} directions runs are undecided and may collapse it.", count=count, every=every
            )
        words = say("From {count} of {every} directions runs are undecided and may collapse it: {cure}.")
        return words.of(count=count, every=every, cure=self.cure)


def harm_words(row: Mapping[str, Any], compass: Compass) -> str:
    """Which direction and motion do most harm, in a sentence.

    Parameters
    ----------
    row : mapping
        Of :func:`worst`, with that compass.
    compass : Compass
    """
    if compass.worst is None:
        words = say("Most harm: {motion}.")
    elif compass.none_collapses and compass.undecided:
        words = say("No direction surely collapses it; it moves most turned to {at:g}°, under {motion}.")
    elif compass.none_collapses:
        words = say("No direction collapses it; it moves most turned to {at:g}°, under {motion}.")
    elif compass.undecided and row["collapsed"]:
        words = say("Most harm: turned to {at:g}°, {motion}, which surely collapses.")
    else:
        words = say("Most harm: turned to {at:g}°, {motion}.")
    return joined(" ", (words.of(at=compass.worst, motion=row["motion"]), compass.may_collapse))


def compass_of_shares(rows: Sequence[Mapping[str, Any]], cure: str = "") -> Compass:
    """Share of the runs from each direction that collapse, with its interval over records, of which each counts once.

    A direction whose runs are all undecided has no share; it competes for the worst one by what its runs do, as any other.
    """
    named = [(bearing(row), v.verdict(row), str(row["record"])) for row in rows]
    bearings = sorted({azimuth for azimuth, *_ in named if azimuth is not None})
    values = []
    for at in bearings:
        verdicts, records = zip(*(rest for azimuth, *rest in named if azimuth == at))
        (bearing_share,) = shares({"": codes_of(np.array(verdicts))}, records)
        decided = bearing_share.exceeded + bearing_share.not_exceeded
        values.append((bearing_share.low if decided else math.nan, *bearing_share.interval))
    share, low, high = np.array(values).reshape(-1, 3).T
    by_bearing = {at: [row for row in rows if bearing(row) == at] for at in bearings}
    order = {
        at: (0.0 if math.isnan(value) else value, max(harm(row) for row in by_bearing[at]))
        for at, value in zip(bearings, share)
        if any(v.verdict(row) != v.FAILED for row in by_bearing[at])
    }
    undecided = tuple(at for at in bearings if any(map(may_collapse, by_bearing[at])))
    name = "share of the runs that collapse [-]"
    most = max(order, key=lambda at: order[at], default=None)
    return Compass(np.array(bearings), share, name, low, high, most, undecided=undecided, cure=cure)


def may_collapse(row: Mapping[str, Any]) -> bool:
    """Whether a run, or one of a column like it, is undecided."""
    return v.verdict(row) == v.UNDECIDED or bool((row.get("certainty") or {}).get(v.UNDECIDED))


def compass_of_chances(rows: Sequence[Mapping[str, Any]], cure: str = "") -> Compass:
    """Probability of collapse from each direction, of several records the largest; without twins, the peak displacement."""
    sound = [row for row in rows if bearing(row) is not None and v.verdict(row) != v.FAILED]
    name = peak_of(sound[0]) if sound else "peak_top_displacement_m"
    names, label = [name], f"peak {'top ' if 'top' in name else ''}displacement (collapse at the rim) [m]"
    if all(row.get("collapse_probability") is not None for row in sound):
        names = ["collapse_probability", "collapse_interval_low", "collapse_interval_high"]
        label = "probability of collapse [-]"
    largest: dict[float, list[float]] = {}
    for row in sound:
        values = [math.inf if len(names) == 1 and row["collapsed"] else abs(row[name]) for name in names]
        at = float(bearing(row) or 0.0)
        if at not in largest or values[0] > largest[at][0]:
            largest[at] = values
    columns = np.array([largest[at] for at in sorted(largest)]).reshape(-1, len(names)).T
    low, high = (columns[1], columns[2]) if len(names) == 3 else (None, None)
    first = worst(sound)
    undecided = tuple(sorted({float(bearing(row) or 0.0) for row in sound if may_collapse(row)}))
    most = None if first is None else bearing(first)
    return Compass(np.array(sorted(largest)), columns[0], label, low, high, most, "collapse", undecided, cure)
