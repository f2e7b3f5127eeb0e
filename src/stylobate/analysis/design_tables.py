"""Design values as people read them: what their intervals hold, the links that are used most, clearances, in kN and mm."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..messages import say
from .unknown_law import few_laws

if TYPE_CHECKING:
    import pandas

#: Why an upper limit is infinite, in words.
OPEN = say(
    "Where it says inf, it is beyond all that was computed, because runs collapse or lose the link, or there are "
    "fewer than 21 records."
)


def basis_of(values: pandas.DataFrame) -> str:
    """What the intervals hold, in words.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    """
    laws = max(values["laws"].tolist(), default=0) if "laws" in values else 0
    if not laws:
        return say("over records; the law of the joints is taken as known")
    few = few_laws(laws)
    return say("over records and one more law of the joints") + (say("; {few}", few=few) if few else "")


def where(values: pandas.DataFrame) -> str:
    """At which level values are told; empty where there is only one."""
    which = say(" at one level") if "told" in values else say(" at the largest level")
    return which if len(set(values["level"])) > 1 else ""


def worst_of(values: pandas.DataFrame, share: float = 0.84) -> pandas.DataFrame:
    """What has a capacity, at the level of every state that is told; links that are used most come first, else by place.

    A ductile link at its capacity bears no more whatever happens, and is judged by its slip: all quantities of a link stay
    together, and of links that are used as much those come first whose ways are.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    share : float
        Fractile [-].
    """
    key = f"use_value_{100 * share:g}"
    known: Any = values[values[key].notna()] if len(values) else values
    if not len(known):
        return known
    known = _told(known)
    links = known.assign(way=known[key].where(known["unit"] == "m", 0.0)).groupby(["state", "link"], sort=False)
    uses = {"most_use": links[key].transform("max"), "most_way": links["way"].transform("max"), "place": links.ngroup()}
    by = {"state": True, "most_use": False, "most_way": False, "place": True, key: False}
    ordered = known.assign(**uses).sort_values(list(by), ascending=list(by.values()), kind="stable")
    return ordered.drop(columns=list(uses))


#: Units in which people read forces and ways, and how many of them are one of the SI.
READ_IN = {"N": ("kN", 1e-3), "m": ("mm", 1e3)}


def as_read(values: pandas.DataFrame) -> pandas.DataFrame:
    """The same in kN and mm, which people read without powers of ten.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`, some of its rows.
    """
    units = [READ_IN[unit] for unit in values["unit"].tolist()]
    size = np.array([factor for _, factor in units])
    read = [str(name) for name in values if str(name).startswith(("capacity", "value_", "low_", "high_"))]
    scaled = {name: values[name].to_numpy(dtype=float) * size for name in read}
    return values.assign(**scaled, unit=[name for name, _ in units])


def clearances(values: pandas.DataFrame) -> pandas.DataFrame:
    """Slip of layers at the level of every state that is told: the room that an isolated column needs around its foot.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    """
    if not len(values):
        return values
    layers: Any = values[(values["kind"] == "layer") & (values["quantity"] == "slip")]
    return _told(layers)


def governing(values: pandas.DataFrame) -> pandas.DataFrame:
    """All quantities of the link of one state that governs, at the level that is told.

    It is the one that is used most; where nothing has a capacity the layer that slips most, or what bears the largest force.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`, of one state.
    """
    told: Any = worst_of(values)
    if not len(told):
        told = clearances(values)
        told = (told if len(told) else _told(values)).sort_values("value_84", ascending=False, kind="stable")
    return told[told["link"] == told["link"].iloc[0]]


def _told(values: Any) -> Any:
    largest = values.groupby("state")["level"].transform("max")  # as earlier versions told them
    return values[values["told"] if "told" in values else values["level"] == largest]
