"""Design values of links in a report: those used most, the room that layers need, and their picture."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from stylobate.messages import joined, say
from stylobate.motion.intensity import parse_measure
from stylobate.probability.design import (
    OPEN,
    WHICH_LEVEL,
    as_read,
    basis_of,
    clearances,
    design_values,
    governing,
    where,
    worst_of,
)
from stylobate.results import Comparison, Numbers, Result
from stylobate.verdicts.compare import Comparison as SideBySide

from . import numbers as n
from .page import Item, Rows
from .pictures import kept

if TYPE_CHECKING:
    import pandas

#: Most rows of a table.
MOST = 40

#: Columns of the tables, by heading; clearances go without the last two of what has a capacity.
SHOWN = {
    say("state"): "state", say("level"): "level", say("link"): "link", say("quantity"): "quantity", say("unit"): "unit",
    "84 %": "value_84", say("from"): "low_84", say("to"): "high_84", say("undecided"): "undecided",
    say("over capacity"): "use_value_84", say("at most"): "use_high_84",
}  # fmt: skip

#: The same of what bears least, and of when and where to a force acts, which older tables do not tell.
LIMITED = {say("limited by"): "limited_by"}
ACTS = {say("at [s]"): "instant_84_s", say("towards [°]"): "azimuth_84_deg"}


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
        motions = result.request.motions if result.request is not None else ()
        each = [motion.get("peaks_g") or {} for motion in motions]
        peaks = [
            max((motion_peaks[axis] for axis in "xy" if axis in motion_peaks), default=0.0) for motion_peaks in each
        ]
        return Design(values, _as_scaled([1.0], peaks or [0.0])) if len(values) else None
    tables = result.tables if isinstance(result, Numbers) else {}
    values = tables.get("design")
    if values is None or not len(values):
        return None
    if (runs := tables.get("suite")) is not None:
        return Design(values, _as_scaled(runs["factor"], runs["pga_g"]))
    states = tables.get("states")
    measure = "factor" if states is None or not len(states) else str(states["measure"].iloc[0])
    im = "×" if measure == "factor" else measure
    return Design(values, f"{im} {{level}} {'' if measure == 'factor' else parse_measure(measure).unit}".rstrip())


def _as_scaled(factors: Iterable[float], peaks: Iterable[float]) -> str:
    """How the one level of some motions is told: by their peak acceleration [g] where it is one, else by their factors."""
    for form, numbers in (("pga {level} g", peaks), ("× {level}", factors)):
        low, high = min(numbers), max(numbers)
        if 0.0 < high and high - low <= 1e-6 * high:
            return form.format(level=f"{low:.4g}")
    return f"× {low:.4g}–{high:.4g}"


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
    meant = say("{where}: what 84 % of the motions do not exceed, and its 95 % interval {basis}.").of(
        where=where(values), basis=basis_of(values)
    )
    which = WHICH_LEVEL if where(values) and "told" in values else ""
    items: list[Item] = []
    if len(worst := worst_of(values)):
        limited, acts = (columns if set(columns.values()) <= set(worst) else {} for columns in (LIMITED, ACTS))
        texts = [
            say("Design values") + meant,
            say("Both also over the capacity; links used most come first."),
            OPEN,
            which,
        ]
        texts.append(say("The file design.csv holds every level, quantity, and 50 and 95 %."))
        if limited:
            texts.append(say("The capacity is that of the link in its stone, with which it is computed."))
        if acts:
            texts.append(say("Forces are told at an instant of the run that governs; shear pushes the body above towards an "
                             "azimuth."))  # fmt: skip
        if len(worst) > MOST:
            texts.append(say("Rows beyond these are of links that are used less, and stand there."))
        items.append(_rows(worst, SHOWN | limited | acts, joined(" ", texts), level))
        caption = say("Links over their capacity: not exceeded under 84 % of the motions, with the interval; "
                      "arrow: beyond all that ran.")  # fmt: skip
        items += kept(pictures, "design", caption)
    if len(wide := clearances(values)):
        caption = joined(" ", [say("Clearance that layers need around the foot") + meant, OPEN, which])
        items.append(_rows(wide, dict(list(SHOWN.items())[:-2]), caption, level))
    return items


def governing_rows(design: Design) -> list[list[str]]:
    """Of every state the rows of the link that governs, as of :data:`SHOWN`."""
    values, level = design
    each = [governing(group) for _, group in values.groupby("state", sort=False)]
    return [row for frame in each for row in _texts(frame, SHOWN, level)]


def _rows(values: pandas.DataFrame, shown: dict[str, str], caption: str, level: str) -> Rows:
    return Rows(list(shown), _texts(values.head(MOST), shown, level), caption, numbers=True)


def _texts(values: pandas.DataFrame, shown: dict[str, str], level: str) -> list[list[str]]:
    rows = as_read(values.assign(level=[say(level, level=n.plain(value)) for value in values["level"].tolist()]))
    return [[n.plain(row[key]) for key in shown.values()] for row in rows.to_dict("records")]
