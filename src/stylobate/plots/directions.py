"""Values by direction on a compass: where the shaking that does most harm points to."""

from __future__ import annotations

from typing import cast

import numpy as np
from matplotlib.figure import Figure, SubFigure
from matplotlib.projections.polar import PolarAxes

from ..analysis.directions import Compass
from .style import BLACK, BLUE, RED, in_lines, page, styled


@styled
def draw_directions(compass: Compass, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """A value over the direction of the shaking along x: north up, azimuths clockwise as those of records.

    The worst direction is marked. Values beyond what was looked at stand open at the rim.

    Parameters
    ----------
    compass : Compass
    title : str, optional
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    figure = page(figure, (4.6, 4.9))
    axes = cast(PolarAxes, figure.add_subplot(projection="polar"))
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    axes.set_thetagrids(np.arange(0, 360, 30), [f"{one}°" for one in range(0, 360, 30)])
    values = compass.values
    seen = np.isfinite(values)
    rim = 1.15 * float(np.nanmax(np.where(seen, values, np.nan))) if seen.any() and values[seen].max() > 0 else 1.0
    if compass.high is not None:
        rim = max(rim, 1.0)
    angle = np.radians(compass.bearings)
    shown = np.where(np.isposinf(values), rim, values)
    around = np.append(np.arange(len(angle)), 0)
    if compass.low is not None and compass.high is not None:
        axes.vlines(angle, compass.low, compass.high, color=BLUE, linewidth=2.4, alpha=0.45, label="95 % interval")
    axes.plot(angle[around], shown[around], color=BLACK, linewidth=0.9)
    axes.plot(angle[seen], values[seen], "o", color=BLACK, markersize=4.0)
    beyond = np.isposinf(values)
    if beyond.any():
        axes.plot(
            angle[beyond], shown[beyond], "o", color=BLACK, fillstyle="none", markersize=6.0, label=compass.beyond
        )
    if compass.worst is not None:
        at = compass.bearings == compass.worst
        (mark,) = axes.plot(angle[at], shown[at], "o", color=RED, fillstyle="none", label=compass.words)
        mark.set(markersize=8.0, markeredgewidth=1.8)
        if compass.none_collapses:
            mark.set_color("none")
    axes.set_ylim(0.0, rim * 1.02)
    axes.set_rlabel_position(15.0)  # between the lines, where no interval is drawn
    axes.set_title(in_lines(title or compass.name) if title is None else f"{in_lines(title)}\n{compass.name}", pad=14.0)
    figure.legend(loc="outside lower center", ncols=3)
    return figure
