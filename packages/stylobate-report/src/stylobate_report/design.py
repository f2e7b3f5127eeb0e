"""Design values of links in a report: those used most, the room that layers need, and their picture."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from stylobate.analysis.compare import Comparison as SideBySide
from stylobate.analysis.design_tables import OPEN, as_read, basis_of, clearances, governing, where, worst_of
from stylobate.analysis.design_values import WHICH_LEVEL, design_values
from stylobate.motion.intensity_specs import parse_measure
from stylobate.results import Comparison, Numbers, Result

from . import numbers as n
from .page import Item, Rows
from .pictures import kept

if TYPE_CHECKING:
    import pandas

#: Most rows of a table.
MOST = 40

#: Columns of the tables, by heading; clearances go without the last two of what has a capacity.
SHOWN = {
    "state": "state", "level": "level", "link": "link", "quantity": "quantity", "unit": "unit", "84 %": "value_84",
    "from": "low_84", "to": "high_84", "undecided": "undecided", "over capacity": "use_value_84", "at most": "use_high_84",
}  # fmt: skip

#: The same of what bears least, and of when and where to a force acts, which older tables do not tell.
LIMITED = {"limited by": "limited_by"}
ACTS = {"at [s]": "instant_84_s", "towards [°]": "azimuth_84_deg"}


class Design(NamedTuple):
    """Design values of a result.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`stylobate.design_values`, or read from ``design.csv``.
    level : str
        How a level is told, with a place for its number.
    """

    values: pandas.DataFrame
    level: str


def design_of(result: Result) -> Design | None:
    """Design values of a result; None where there are none."""
    if isinstance(result, Comparison):
        if not result.responses:
            return None
        values = design_values(SideBySide(list(result.responses.values()), list(result.responses)))
        motions = result.asked.motions if result.asked is not None else ()
        each = [one.get("peaks_g") or {} for one in motions]
        peaks = [max((one[axis] for axis in "xy" if axis in one), default=0.0) for one in each]
        return Design(values, _as_scaled([1.0], peaks or [0.0])) if len(values) else None
    tables = result.tables if isinstance(result, Numbers) else {}
    values = tables.get("design")
    if values is None or not len(values):
        return None
    if (runs := tables.get("suite")) is not None:
        return Design(values, _as_scaled(runs["factor"], runs["pga_g"]))
    states = tables.get("states")
    measure = "factor" if states is None or not len(states) else str(states["measure"].iloc[0])
    return Design(values, "× {}" if measure == "factor" else f"{measure} {{}} {parse_measure(measure).unit}")


def _as_scaled(factors: Iterable[float], peaks: Iterable[float]) -> str:
    """How the one level of some motions is told: by their peak acceleration [g] where it is one, else by their factors."""
    for form, numbers in (("pga {} g", peaks), ("× {}", factors)):
        low, high = min(numbers), max(numbers)
        if 0.0 < high and high - low <= 1e-6 * high:
            return form.format(n.plain(low))
    return f"× {n.plain(low)}–{n.plain(high)}"


def design_items(design: Design | None, pictures: dict[str, Path]) -> list[Item]:
    """Tables and picture of design values; nothing where there are none.

    Parameters
    ----------
    design : Design, optional
    pictures : dict of str to path
        Of the folder.
    """
    if design is None:
        return []
    values, level = design
    meant = f"what 84 % of the motions do not exceed, and its 95 % interval {basis_of(values)}."
    open_ = OPEN
    if where(values) and "told" in values:
        open_ += f" {WHICH_LEVEL}"
    items: list[Item] = []
    if len(worst := worst_of(values)):
        caption = (
            f"Design values{where(values)}: {meant} Both also over the capacity; links used most come first. {open_} "
        )
        caption += "The file design.csv holds every level, quantity, and 50 and 95 %."
        limited, acts = (told if set(told.values()) <= set(worst) else {} for told in (LIMITED, ACTS))
        if limited:
            caption += " The capacity is that of the link in its stone, with which it is computed."
        if acts:
            caption += " Forces are told at an instant of the run that governs; shear pushes the body above "
            caption += "towards an azimuth."
        if len(worst) > MOST:
            caption += " Rows beyond these are of links that are used less, and stand there."
        items.append(_rows(worst, SHOWN | limited | acts, caption, level))
        caption = (
            "Links over their capacity: not exceeded under 84 % of the motions, with the interval; arrow: beyond all "
        )
        items += kept(pictures, "design", caption + "that ran.")
    if len(wide := clearances(values)):
        caption = f"Clearance that layers need around the foot{where(values)}: {meant} {open_}"
        items.append(_rows(wide, dict(list(SHOWN.items())[:-2]), caption, level))
    return items


def governing_rows(design: Design) -> list[list[str]]:
    """Of every state the rows of the link that governs, as of :data:`SHOWN`."""
    values, level = design
    each = [governing(some) for _, some in values.groupby("state", sort=False)]
    return [row for some in each for row in _texts(some, SHOWN, level)]


def _rows(values: pandas.DataFrame, shown: dict[str, str], caption: str, level: str) -> Rows:
    return Rows(list(shown), _texts(values.head(MOST), shown, level), caption, numbers=True)


def _texts(values: pandas.DataFrame, shown: dict[str, str], level: str) -> list[list[str]]:
    rows = as_read(values.assign(level=[level.format(n.plain(one)) for one in values["level"].tolist()]))
    return [[n.plain(one[key]) for key in shown.values()] for one in rows.to_dict("records")]
