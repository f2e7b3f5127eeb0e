"""Design values of links in a report: those used most, the room that layers need, and their picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..analysis.design_tables import OPEN, as_read, basis_of, clearances, where, worst_of
from ..analysis.design_values import WHICH_LEVEL
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


def design_items(values: pandas.DataFrame | None, pictures: dict[str, Path]) -> list[Item]:
    """Tables and picture of design values; nothing where there are none.

    Parameters
    ----------
    values : pandas.DataFrame or None
        As of :func:`stylobate.design_values`, or read from ``design.csv``.
    pictures : dict of str to path
        Of the folder.
    """
    if values is None or not len(values):
        return []
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
        items.append(_rows(worst, SHOWN | limited | acts, caption))
        caption = (
            "Links over their capacity: not exceeded under 84 % of the motions, with the interval; arrow: beyond all "
        )
        items += kept(pictures, "design", caption + "that ran.")
    if len(wide := clearances(values)):
        caption = f"Clearance that layers need around the foot{where(values)}: {meant} {open_}"
        items.append(_rows(wide, dict(list(SHOWN.items())[:-2]), caption))
    return items


def _rows(values: pandas.DataFrame, shown: dict[str, str], caption: str) -> Rows:
    body = [[n.plain(one[key]) for key in shown.values()] for one in as_read(values.head(MOST)).to_dict("records")]
    return Rows(list(shown), body, caption, numbers=True)
