"""The best of a few numbers of a measure: candidates under the same records, and those not to be told from the best."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..column.links.link import PLACES, Link
from ..column.links.placed import PlacedLink
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..response.links import AT_CAPACITY
from .design_tables import basis_of, worst_of
from .design_values import WHICH, design_values
from .evidence import evidence
from .fragility import SAMPLES
from .fragility_checks import FEWEST
from .side_by_side import shares
from .states import StateComparison, with_undecided

if TYPE_CHECKING:
    import pandas

#: Fields of a placed link by which candidates must differ: how it looks and how it finds its hole again is too little.
HELD = (
    "shear_stiffness", "shear_capacity", "axial_stiffness", "axial_capacity", "clearance", "damping", "lift", "pretension",
    "ultimate_slip", "ultimate_elongation", "friction_coefficient", "bed_stiffness", "bed_shear_stiffness", "failure",
)  # fmt: skip

#: The same of its place.
PLACE = ("kind", "lower", "upper", "low", "high")

#: Most candidates: each is run under all records, levels and twins.
MOST = 64

#: Entry for the distance of a place in plan from the axis of a column; others are x, y and z.
RADIUS = "radius"


def candidates(structure: Structure, vary: Mapping[str, Sequence[float]]) -> dict[str, Structure]:
    """The structure with each combination of the numbers of its links.

    Parameters
    ----------
    structure : Column, Assembly or SpatialAssembly
        With the measure.
    vary : mapping of str to sequence of float
        Values [SI] by ``kind.field``, such as ``dowel.diameter`` or ``dowel.joint``; of a place by coordinate,
        ``dowel.at.x``, of a column also ``dowel.at.radius``. All links of that kind take them.

    Returns
    -------
    dict of str to Structure
        By the numbers in words.

    Raises
    ------
    InputError
        A kind that the structure does not have, what is no number of it, a value that the kind refuses, numbers that change
        nothing because others are given beside them, two links at one place, or more than 64 candidates.
    """
    stands: Any = check_kind("structure", structure, Structure).stack or structure
    if not vary:
        raise InputError("no number is varied; give one, such as dowel.diameter.", "vary")
    for name in vary:
        _check_number(name, stands)
    every = list(itertools.product(*vary.values()))
    if not 2 <= len(every) <= MOST:
        raise InputError(f"{len(every)} candidates are asked for; allowed are from 2 to {MOST}.", "vary")
    found: dict[str, Structure] = {}
    for values in every:
        told = {name: float(value) for name, value in zip(vary, values, strict=True)}
        links = list(stands.links)
        for name, value in told.items():
            kind, _, field = name.partition(".")
            links = [_changed(link, field, value) if link.kind == kind else link for link in links]
        label = ", ".join(f"{name}={value:g}" for name, value in told.items())
        remade: Any = stands.unwarned if structure.stack is not None else partial(dataclasses.replace, stands)
        found[label] = remade(links=tuple(links))
        if len(set(_places(found[label]))) < len(set(_places(stands))):
            raise InputError(
                f"{label} puts two links at one place; vary what keeps them apart, or one of them.", "vary"
            )
    if len({tuple(_told(link, HELD + PLACE) for link in one.placed_links) for one in found.values()}) < len(every):
        raise InputError(
            f"two of the candidates by {' and '.join(vary)} are the same: a value is given twice, or what the links hold is "
            "given beside it and does not follow from it; leave that out of the file.",
            "vary",
        )
    return found


def _check_number(name: str, stands: Structure) -> None:
    """Refuse what is no number of the links of a kind, or of a place that is not given."""
    kind, _, field = name.partition(".")
    mine = [link for link in stands.links if link.kind == kind]
    if not mine:
        known = ", ".join(sorted({link.kind for link in stands.links})) or "none"
        raise InputError(f"{name!r} is varied, and {stands.name!r} has no link {kind!r}; it has {known}.", "vary")
    for link in mine:
        if link.numbers is not None and link.made is None:
            raise InputError(
                f"{name!r} is varied, and a {kind} of {stands.name!r} comes with a column, or only in numbers; write a file "
                "for each candidate and compare them as states.",
                "vary",
            )
        made = link.made or link
        words = {one.name: set(str(one.type).split(" | ")) for one in dataclasses.fields(made)}
        numbers = [one for one, types in words.items() if types & {"float", "int"}]
        if link.between is not None:
            numbers = [one for one in numbers if one not in PLACES]
        for end, place in zip(("at", "to"), link.ends, strict=True):
            numbers += [f"{end}.{axis}" for axis in _axes(link, place)]
        if field not in numbers:
            raise InputError(f"{name!r} is no number of a {kind}; those are {', '.join(numbers)}.", "vary")


def _axes(link: Link, place: tuple[float, ...] | None) -> tuple[str, ...]:
    """Names of the coordinates of a place that is given."""
    if place is None:
        return ()
    if link.between is None:
        return "x", "y", RADIUS
    return ("x", "z") if len(place) == 2 else ("x", "y", "z")


def _changed(link: Link, field: str, value: float) -> Link:
    """A link with another number, as made of material and size."""
    made = link
    if link.made is not None:
        ends = {name: end for name, end in zip(("at", "to"), link.ends, strict=True) if end is not None}
        made = dataclasses.replace(link.made, **ends, name=link.name, between=link.between)
    name, _, axis = field.partition(".")
    if not axis:
        return dataclasses.replace(made, **{name: int(value) if value.is_integer() and name in PLACES else value})
    place = getattr(made, name)
    if axis == RADIUS:
        size = math.hypot(*place)
        way = (1.0, 0.0) if size == 0.0 else (place[0] / size, place[1] / size)
        place = value * way[0], value * way[1]
    else:
        k = _axes(link, place).index(axis)
        place = (*place[:k], value, *place[k + 1 :])
    return dataclasses.replace(made, **{name: place})


def _told(link: PlacedLink, names: Sequence[str]) -> tuple[Any, ...]:
    return tuple(getattr(link, name) for name in names)


def _places(stands: Structure) -> list[tuple[Any, ...]]:
    return [_told(link, PLACE) for link in stands.placed_links]


@dataclass(frozen=True)
class Best:
    """The best of some candidates, as far as these records tell.

    Parameters
    ----------
    best : str or None
        Label of the smallest share of runs that exceed the limit state, undecided ones counted in, of those whose links stay
        below their capacity; the first of equal ones. None where all reach it.
    alike : tuple of str
        Candidates that cannot be told from it, itself among them: their share is not shown to be larger, nor that their
        links come to their capacity.
    table : pandas.DataFrame
        One row per candidate: ``candidate``, ``share_low`` and ``share_high`` (undecided out and in),
        ``interval_low`` and ``interval_high``, ``use``, ``use_low`` and ``use_high`` of its links (84 %, largest level),
        ``within`` its capacity; ``difference_low`` and ``difference_high`` of its share from that of the best; ``alike``.
        The last three are missing where no candidate is allowed.
    runs, records : int
    words : str
        What it comes to, in sentences.
    """

    best: str | None
    alike: tuple[str, ...]
    table: pandas.DataFrame
    runs: int
    records: int
    words: str

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate states``."""
        rows = self.table.astype(object).where(self.table.notna(), None).to_dict("records")
        said = {"best": self.best, "alike": list(self.alike), "runs": self.runs, "records": self.records}
        return said | {"words": self.words, "candidates": rows}


def best_of(
    found: StateComparison, labels: Sequence[str], *, samples: int = SAMPLES, seed: int = 0, confidence: float = 0.95
) -> Best:
    """The best of candidates that were run as states, and the set of those that cannot be told from it.

    Parameters
    ----------
    found : StateComparison
        The same records, levels and twins for all.
    labels : sequence of str
        States that are candidates.
    samples, seed, confidence
        Of the bootstrap over records.

    Notes
    -----
    A candidate is told from the best where the interval of the paired difference of their shares does not hold zero. Which
    one is best is itself chance, so that the intervals are those of all pairs of K candidates together: each has the
    confidence 1 − (1 − c)/(K (K − 1)/2) (Bonferroni). Nothing is told of fewer than ten records. A candidate whose links
    come to their capacity in these runs, but need not under others, is not the best one and stays in the set.
    """
    import pandas

    check_kind("found", found, StateComparison)
    if unknown := [label for label in labels if label not in found.labels]:
        raise InputError(f"no state is called {unknown[0]!r}; there are {', '.join(found.labels)}.", "labels")
    table: Any = found.table
    told = {
        label: evidence(table[table["state"] == label], None, found.state, label, doubt=found.doubt) for label in labels
    }
    first = next(iter(told.values()))
    designed = design_values(found, level=float(table["im"].max()), instants=False)
    most: Any = worst_of(designed)
    rows = []
    for share in shares({label: one.codes for label, one in told.items()}, first.records, first.laws):
        mine = most[most["state"] == share.label] if len(most) else most
        use, use_low, use_high = (float(mine[f"use_{one}_84"].max()) if len(mine) else 0.0 for one in WHICH)
        rows.append({
            "candidate": share.label, "share_low": share.low, "share_high": share.high, "interval_low": share.interval[0],
            "interval_high": share.interval[1], "use": use, "use_low": use_low, "use_high": use_high,
            "within": use < AT_CAPACITY,
        })  # fmt: skip
    within = [row for row in rows if row["within"] and np.isfinite(row["share_high"])]
    best = min(within, key=lambda row: row["share_high"])["candidate"] if within else None
    pairs = len(labels) * (len(labels) - 1) // 2
    each, records = 1.0 - (1.0 - confidence) / max(pairs, 1), len(np.unique(first.records))
    for row in rows:
        low, high = (0.0, 0.0) if best is not None else (math.nan, math.nan)
        if best is not None and row["candidate"] != best:
            difference = with_undecided(told[best], told[row["candidate"]], None, None, samples, seed, each)
            low, high = difference.share_low, difference.share_high
        row |= {"difference_low": low, "difference_high": high}
        may = row["use_low"] < AT_CAPACITY and np.isfinite(row["share_high"])
        row["alike"] = None if best is None else may and (records < FEWEST or not low > 0.0)
    alike = tuple(row["candidate"] for row in rows if row["alike"])
    sure = all(row["use_high"] < AT_CAPACITY for row in rows if row["alike"])
    words = f"{_words(best, alike, len(labels), records, found.state)} {len(found.table)} runs; {100 * confidence:g} % "
    words += f"intervals for all pairs together, {basis_of(designed) if len(designed) else 'over records'}."
    if best is not None and not sure:
        words += (
            " That the links, and the stone around them, stay below their capacity is not sure: the upper limit of "
        )
        words += "their use reaches it."
    return Best(best, alike, pandas.DataFrame(rows), len(found.table), records, words)


def _words(best: str | None, alike: Sequence[str], number: int, records: int, state: str) -> str:
    """What the comparison comes to."""
    if best is None:
        return (
            f"None of the {number} candidates is allowed: at the largest level each collapses or comes to the capacity of a "
            "link, or of the stone around it, under 16 % of the motions or more; strengthen the links, or run lower levels. "
            "That one is stronger than another state only compares collapses under these motions: it is no leave to build "
            "it."
        )
    few = f"; nothing is told from fewer than {FEWEST} records" if records < FEWEST else ""
    said = f"Least {state} of {number} candidates: {best}"
    others = len(alike) - 1
    if not others:
        return f"{said}; the others are worse or reach their capacity."
    return f"{said}; {others} more cannot be told from it under {records} record{'s' * (records != 1)}{few}."
