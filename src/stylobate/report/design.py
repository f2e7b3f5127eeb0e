"""Design values of links in a report: those used most, the room that layers need, and their picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..analysis.design_tables import OPEN, as_read, basis_of, clearances, where, worst_of
from ..analysis.design_values import WHICH_LEVEL
from ..motion.intensity_specs import parse_measure
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

#: Columns of the first page of a report, which tells what governs alone.
FRONT = {key: name for key, name in SHOWN.items() if key not in ("undecided", "at most")}

#: The same of what bears least, and of when and where to a force acts, which older tables do not tell.
LIMITED = {"limited by": "limited_by"}
ACTS = {"at [s]": "instant_84_s", "towards [°]": "azimuth_84_deg"}


def level_words(runs: pandas.DataFrame | None) -> str:
    """How a level is told: of scaled motions with its measure and unit, of others as their factor.

    Parameters
    ----------
    runs : pandas.DataFrame, optional
        Of the states, whose column ``measure`` names it; of motions as they are there is none.
    """
    measure = "factor" if runs is None or not len(runs) else str(runs["measure"].iloc[0])
    return "× {}" if measure == "factor" else f"{measure} {{}} {parse_measure(measure).unit}"


def design_items(
    values: pandas.DataFrame | None, pictures: dict[str, Path], runs: pandas.DataFrame | None = None
) -> list[Item]:
    """Tables and picture of design values; nothing where there are none.

    Parameters
    ----------
    values : pandas.DataFrame or None
        As of :func:`stylobate.design_values`, or read from ``design.csv``.
    pictures : dict of str to path
        Of the folder.
    runs : pandas.DataFrame, optional
        As of :func:`level_words`.
    """
    if values is None or not len(values):
        return []
    level = level_words(runs)
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
            caption += " The capacity is that of the link, or what the stone around it bears where that is less."
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


def governing_rows(values: pandas.DataFrame, runs: pandas.DataFrame | None) -> list[list[str]]:
    """Of every state the row that is used most, or the slip of layers where nothing has a capacity, as of :data:`FRONT`.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_items`.
    runs : pandas.DataFrame, optional
        As of :func:`level_words`.
    """
    found: list[list[str]] = []
    for state in dict.fromkeys(values["state"]):
        mine: Any = values[values["state"] == state]
        told = worst_of(mine) if len(worst_of(mine)) else clearances(mine)
        found += _texts(told.head(1), FRONT, level_words(runs))
    return found


def _rows(values: pandas.DataFrame, shown: dict[str, str], caption: str, level: str) -> Rows:
    return Rows(list(shown), _texts(values.head(MOST), shown, level), caption, numbers=True)


def _texts(values: pandas.DataFrame, shown: dict[str, str], level: str) -> list[list[str]]:
    rows = as_read(values.assign(level=[level.format(n.plain(one)) for one in values["level"].tolist()]))
    return [[n.plain(one[key]) for key in shown.values()] for one in rows.to_dict("records")]
