"""Utilisation of links: what 84 % of the motions do not exceed over their capacity, with its interval."""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..analysis.design_tables import basis_of, where, worst_of
from .style import CYCLE, GREY, WIDTH, page, plain, styled

if TYPE_CHECKING:
    import pandas

#: Most letters of a line beneath the picture.
WIDE = 100

#: Most rows in a picture, as many of every state.
MOST = 24


@styled
def draw_design_values(values: pandas.DataFrame, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Links at the level that is told, those used most: a dot, its 95 % interval, and capacity at 1.

    The capacity is that of the link, or of the stone around it where that is less, as its name says. Under it a force has
    the instant of the run that governs, and a shear force its azimuth, from x towards y. An arrow: the upper limit is
    beyond all that was computed; without a dot, so is the value itself.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`stylobate.design_values`.
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    found = worst_of(values)
    shown = found.groupby("state", sort=False).head(max(MOST // max(len(set(found["state"])), 1), 1))
    labels = [f"{plain(row['link'])}, {row['quantity']}{_stone(row)}{_acts(row)}" for row in shown.to_dict("records")]
    figure = page(figure, (WIDTH, 1.7 + 0.27 * sum(1 + one.count("\n") for one in labels)))
    axes = figure.subplots()
    value, low, high = (shown[f"use_{which}_84"].to_numpy(dtype=float) for which in ("value", "low", "high"))
    ends = np.concatenate((value, low, high, [1.0]))
    far = 1.15 * float(ends[np.isfinite(ends)].max())
    states = list(dict.fromkeys(shown["state"]))
    looks = {state: CYCLE[k % len(CYCLE)]["color"] for k, state in enumerate(states)}
    for k, state in enumerate(shown["state"]):
        place, color = len(shown) - 1 - k, looks[state]
        axes.plot(np.minimum([low[k], high[k]], far), [place, place], color=color, linewidth=1.4)
        if not np.isfinite(high[k]):
            axes.plot([far], [place], color=color, marker=">", markersize=5.0, clip_on=False)
        if np.isfinite(value[k]):
            axes.plot(value[k : k + 1], [place], color=color, marker="o", markersize=5.0)
    axes.axvline(1.0, color=GREY, linewidth=1.6, zorder=0)
    axes.set_yticks(np.arange(len(shown))[::-1], labels)
    axes.set(xlim=(0.0, far), ylim=(-0.6, len(shown) - 0.4))
    meant = f"over capacity [-]: not exceeded under 84 % of the motions, and its 95 % interval {basis_of(values)}"
    at = {}
    if where(values) and "told" in values:
        at = {
            state: f", level {level:g}" for state, level in shown.groupby("state", sort=False)["level"].first().items()
        }
    if len(shown) < len(found):
        axes.set_title(f"{len(shown)} of {len(found)} rows, all in design.csv", loc="left", fontsize=8)
    figure.supxlabel(textwrap.fill(meant, WIDE), fontsize=9)  # longer than the axes are wide
    for state in states:
        axes.plot([], [], color=looks[state], marker="o", label=plain(state) + at.get(state, ""))
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=min(len(states), 3), fontsize=8, frameon=False)
    axes.grid(True, axis="x")
    return figure


def _stone(row: dict[str, Any]) -> str:
    """That the capacity is what the stone around the link bears."""
    return " over that of the stone" if row.get("limited_by") == "stone" else ""


def _acts(row: dict[str, Any]) -> str:
    """When and where to a force acts in the run that governs; empty where it is not told."""
    instant, azimuth = (row.get(key, math.nan) for key in ("instant_84_s", "azimuth_84_deg"))
    if not math.isfinite(instant):
        return ""
    return f"\n{f'towards {azimuth:.0f}° ' if math.isfinite(azimuth) else ''}at {instant:.2f} s"
