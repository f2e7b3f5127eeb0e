"""Utilisation of links: what 84 % of the motions do not exceed over their capacity, with its interval."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..analysis.design_values import basis_of, worst_of
from .style import CYCLE, GREY, WIDTH, page, plain, styled

if TYPE_CHECKING:
    import pandas

#: Most rows in a picture, as many of every state.
MOST = 24


@styled
def draw_design_values(values: pandas.DataFrame, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Links at the largest level, those used most: a dot, its 95 % interval, and capacity at 1.

    An arrow: the upper limit is beyond all that was computed; without a dot, so is the value itself.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`stylobate.design_values`.
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    found = worst_of(values)
    shown = found.groupby("state", sort=False).head(max(MOST // max(len(set(found["state"])), 1), 1))
    figure = page(figure, (WIDTH, 1.5 + 0.27 * len(shown)))
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
    labels = [f"{plain(link)}, {quantity}" for link, quantity in zip(shown["link"], shown["quantity"], strict=True)]
    axes.set_yticks(np.arange(len(shown))[::-1], labels)
    axes.set(xlim=(0.0, far), ylim=(-0.6, len(shown) - 0.4))
    axes.set_xlabel(
        "over capacity [-]: not exceeded under 84 % of the motions, and its 95 % interval\n" + basis_of(values)
    )
    for state in states:
        axes.plot([], [], color=looks[state], marker="o", label=plain(state))
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=min(len(states), 3), fontsize=8, frameon=False)
    axes.grid(True, axis="x")
    return figure
