"""Design values of a measure: what every link bears and moves, with fractiles over records and their intervals."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..column.links.placed import PlacedLink
from ..errors import check_kind
from . import verdicts as v
from .states import StateComparison

if TYPE_CHECKING:
    import pandas

#: Shares of the motions that a design value is not exceeded under [-].
FRACTILES = (0.5, 0.84, 0.95)

#: What is told of each: itself, and the limits of its interval.
WHICH = ("value", "low", "high")

#: Levels that agree to so many decimals are one.
DIGITS = 9


class Quantity(NamedTuple):
    """What a link is designed for: name, unit, key in the row of a run, field of the link that limits it, and whether it
    acts along the link."""

    name: str
    unit: str
    key: str
    limit: str
    along: bool


QUANTITIES = (
    Quantity("shear force", "N", "link_peak_shear_n", "shear_capacity", False),
    Quantity("tension", "N", "link_peak_tension_n", "axial_capacity", True),
    Quantity("slip", "m", "link_peak_slip_m", "ultimate_slip", False),
    Quantity("elongation", "m", "link_peak_elongation_m", "ultimate_elongation", True),
)


def design_values(found: StateComparison, confidence: float = 0.95) -> pandas.DataFrame:
    """Peak force, slip and elongation of every link over records and twins, level by level, with utilisation.

    Parameters
    ----------
    found : StateComparison
        As of :func:`stylobate.compare_states`.
    confidence : float
        Of the intervals.

    Returns
    -------
    pandas.DataFrame
        One row per state, level, link with its ``kind``, and quantity: ``unit``, ``runs``, ``records``, ``gone`` (runs that
        collapse or lose the link) and ``undecided``; for 50, 84 and 95 %, ``value_84`` with ``low_84`` and ``high_84``, the
        value that this share of the motions does not exceed and its interval; ``capacity``, and ``use_value_84`` with
        ``use_low_84`` and ``use_high_84``, the same over it. Infinite: beyond all that was computed; NaN where there is no
        capacity.

    Notes
    -----
    A run that collapses, or in which the link is lost, exceeds every slip; its force is the capacity, which no force
    exceeds.
    An undecided run counts with its peaks so far in the value and the lower limit, and as a collapse in the upper one.
    Every record counts once, however many twins it has. The interval holds the values x for which Wilson's interval of the
    share of records that stay below x holds the fractile: with n records the upper limit of 84 % is finite from 21 of
    them on, n/(n + z²) ≥ 0.84.
    """
    import pandas

    check_kind("found", found, StateComparison)
    rows: list[dict[str, Any]] = []
    for label, structure in zip(found.labels, found.columns, strict=True):
        links = [link for link in structure.placed_links if link.acts]
        table: Any = found.table[found.table["state"] == label]
        if not links or QUANTITIES[0].key not in table:
            continue
        table = table[table["verdict"].isin((v.STANDS, v.COLLAPSED, v.UNDECIDED))]
        sizes = np.round(table["im"].to_numpy(dtype=float), DIGITS)
        for level in np.unique(sizes).tolist():
            told = _of_level(table[sizes == level], links, confidence)
            rows += [{"state": label, "level": level} | one for one in told]
    return pandas.DataFrame(rows)


def _of_level(table: Any, links: list[PlacedLink], confidence: float) -> list[dict[str, Any]]:
    """The rows of one state at one level."""
    said = table["verdict"].to_numpy(dtype=str)
    owner = np.unique(table["record"].to_numpy(dtype=str), return_inverse=True)[1]
    broken = np.array([[one is not None for one in run] for run in table["link_broken_s"]])
    rows = []
    for k, link in enumerate(links):
        gone = (said == v.COLLAPSED) | broken[:, k]
        for one in QUANTITIES:
            if not _has(link, one):
                continue
            limit = float(getattr(link, one.limit))
            most = limit if one.unit == "N" else math.inf
            peak = np.minimum(np.array([run[k] for run in table[one.key]], dtype=float), most)
            low = np.where(gone, most, peak)
            high = np.where(said == v.UNDECIDED, most, low)
            row: dict[str, Any] = {
                "link": link.name, "kind": link.kind, "quantity": one.name, "unit": one.unit, "runs": len(table),
                "records": int(owner.max()) + 1, "gone": int(gone.sum()), "undecided": int((said == v.UNDECIDED).sum()),
                "capacity": limit,
            }  # fmt: skip
            for share in FRACTILES:
                told = [min(x, most) for x in fractile(low, high, owner, share, confidence)]
                use = [x / limit if math.isfinite(limit) else math.nan for x in told]
                for name, values in (("", told), ("use_", use)):
                    row |= {f"{name}{which}_{100 * share:g}": x for which, x in zip(WHICH, values, strict=True)}
            rows.append(row)
    return rows


def worst_of(values: pandas.DataFrame, share: float = 0.84) -> pandas.DataFrame:
    """What has a capacity, at the largest level of every state; links that are used most come first.

    A ductile link at its capacity is judged by its slip, so that all quantities of a link stay together.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    share : float
        Fractile [-].
    """
    key = f"use_value_{100 * share:g}"
    known: Any = values[values[key].notna()]
    known = _at_largest_level(known)
    known = known.assign(most=known.groupby(["state", "link"])[key].transform("max"))
    known = known.sort_values(["state", "most", "link", key], ascending=[True, False, True, False], kind="stable")
    return known.drop(columns="most")


def clearances(values: pandas.DataFrame) -> pandas.DataFrame:
    """Slip of layers at the largest level of every state: the room that an isolated column needs around its foot.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    """
    layers: Any = values[(values["kind"] == "layer") & (values["quantity"] == "slip")]
    return _at_largest_level(layers)


def _at_largest_level(values: Any) -> Any:
    return values[values["level"] == values.groupby("state")["level"].transform("max")]


def _has(link: PlacedLink, one: Quantity) -> bool:
    """Whether a link does anything in the way of this quantity."""
    if one.along:
        return link.axial_stiffness > 0.0
    return not link.straight and (link.shear_stiffness > 0.0 or link.damping > 0.0)


def fractile(
    low: np.ndarray, high: np.ndarray, owner: np.ndarray, share: float, confidence: float = 0.95
) -> tuple[float, float, float]:
    """Value that a share of the records does not exceed, and the limits of its interval.

    Parameters
    ----------
    low, high : array, shape (n,)
        Of every run what it comes to at least, and at most.
    owner : array of int, shape (n,)
        Number of its record, from 0 without gaps; each record counts once.
    share, confidence : float

    Returns
    -------
    value, lower, upper : float
        The first two of ``low``, the last of ``high``; infinite where no value is large enough.
    """
    runs = np.bincount(owner)
    number = len(runs)

    def below(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        order = np.argsort(values, kind="stable")
        passed = np.round(np.cumsum(1.0 / runs[owner[order]]), 9)
        return np.append(values[order], math.inf), passed

    ends, passed = below(low)
    most, passed_most = below(high)
    trials = np.full(len(low), number)
    return (
        float(ends[np.searchsorted(passed / number, share - 1e-9)]),
        float(ends[np.searchsorted(v.wilson_interval(passed, trials, confidence)[1], share)]),
        float(most[np.searchsorted(v.wilson_interval(passed_most, trials, confidence)[0], share)]),
    )
