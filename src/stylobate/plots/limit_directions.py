"""The collapse multiplier all round a column: in which direction it is weakest."""

from __future__ import annotations

from typing import cast

import numpy as np
from matplotlib.figure import Figure, SubFigure
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from ..analysis.limit_directions import LimitByDirection
from .style import BLACK, BLUE, GREY, RED, in_lines, page, styled

#: Where the axes of the plan lie: unlike azimuths from north, these count from x towards y.
AXES = {0: " (x)", 90: " (y)", 180: " (−x)", 270: " (−y)"}


@styled
def draw_limit_directions(
    found: LimitByDirection, title: str = "", *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Multiplier over the azimuth that the forces push to: x to the right, y up, as seen from above.

    Parameters
    ----------
    found : LimitByDirection
    title : str
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    figure = page(figure, (4.6, 4.9))
    axes = cast(PolarAxes, figure.add_subplot(projection="polar"))
    axes.set_thetagrids(np.arange(0, 360, 30), [f"{one}°{AXES.get(one, '')}" for one in range(0, 360, 30)])
    order = np.argsort(found.azimuths % 360.0)
    angle, values = np.radians(found.azimuths[order]), found.multipliers[order]
    around = np.append(np.arange(len(angle)), 0)
    if len(angle) > 2:
        axes.plot(angle[around], values[around], color=BLACK, linewidth=0.9)
    for mode, colour in (("rocking", BLACK), ("sliding", BLUE), ("twisting", GREY)):
        of = np.array([found.limits[i].mode == mode for i in order])
        if of.any():
            axes.plot(angle[of], values[of], "o", color=colour, markersize=4.0, label=mode)
    weak = found.weakest
    axes.plot(
        np.radians(weak.azimuth),
        weak.multiplier,
        "o",
        color=RED,
        markersize=9.0,
        fillstyle="none",
        markeredgewidth=1.8,
        label=f"weakest: {weak.azimuth:g}°, {weak.multiplier:.4g} g, joint {weak.joint}",
    )
    axes.set_ylim(0.0, 1.1 * float(values.max()))
    axes.yaxis.set_major_locator(MaxNLocator(4, prune="lower"))
    axes.set_rlabel_position(22.5)
    axes.set_title(f"{in_lines(title)}\ncollapse multiplier [g], from x towards y" if title else "", pad=14.0)
    figure.legend(loc="outside lower center", ncols=3)
    return figure
