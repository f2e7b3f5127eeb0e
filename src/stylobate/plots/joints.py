"""Opening of every joint over time, one trace per joint, stacked like the joints."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..messages import say
from ..response import Response
from ..response.words import title_of
from .scene import seen
from .style import BLACK, BROWN, GREY, SAND, WIDTH, in_lines, only_panel, styled


@styled
def draw_joints(
    response: Response,
    title: str | None = None,
    *,
    window: tuple[float, float] | None = None,
    figure: Figure | SubFigure | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Largest opening of each joint over time, each drawn to its own peak, which stands beside it.

    Joints that open by less than a hundredth of the largest opening are drawn smaller.

    Parameters
    ----------
    response : Response
    title : str, optional
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    ax : Axes, optional
        To draw in, instead of a figure.
    """
    h, n = response.histories, response.opening.shape[1]
    opening = np.nan_to_num(np.abs(h.joint_opening))
    begin, end = seen(h.time, window)
    opening = np.where(((h.time >= begin) & (h.time <= end))[:, None], opening, np.nan)
    time = response.measures.collapse_time
    if not math.isnan(time):  # gaps of a fallen column are far larger and would flatten every other curve
        opening = np.where((h.time <= time)[:, None], opening, np.nan)
    largest = float(np.nanmax(opening)) if np.isfinite(opening).any() else 0.0
    figure, axes = only_panel(ax, figure, (WIDTH, 1.4 + 0.32 * max(n, 3)))
    for i in reversed(range(n)):
        peak = float(np.nanmax(opening[:, i])) if np.isfinite(opening[:, i]).any() else 0.0
        scale = 0.8 / max(peak, 0.01 * largest) if largest > 0.0 else 0.0
        trace = i + 1 + scale * opening[:, i]
        axes.fill_between(h.time, i + 1, trace, facecolor=SAND, edgecolor="none", zorder=2)
        axes.plot(h.time, trace, color=BROWN, linewidth=0.8, zorder=2)
        axes.axhline(i + 1, color=GREY, linewidth=0.4, zorder=1)
        axes.annotate(
            say("{peak:.3g} mm", peak=1000.0 * peak),
            (1.01, i + 1),
            xycoords=("axes fraction", "data"),
            fontsize=8.0,
            va="bottom",
        )
    axes.annotate(say("peak"), (1.01, n + 1), xycoords=("axes fraction", "data"), fontsize=8.0, va="bottom", color=GREY)
    if begin <= time <= end:
        axes.axvline(time, color=BLACK, linewidth=0.8, linestyle=(0, (1, 2)))
        axes.annotate(
            say("collapse {time:.2f} s", time=time) + "  ", (time, n + 1), fontsize=8.0, va="bottom", ha="right"
        )
    axes.set_xlim(*seen(h.time, window))
    axes.set_ylim(0.85, n + 1.35)
    every = 1 if n <= 30 else math.ceil(n / 25)
    axes.set_yticks(range(1, n + 1, every))
    axes.set_xlabel(say("time [s]"))
    axes.set_ylabel(say("joint, from the base\n(opening, each to its peak)"))
    axes.set_title(in_lines(title or title_of(response)))
    return figure
