"""Earthquakes one after another: how far the structure is out of place and tilted, over the ground's acceleration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..constants import g
from ..messages import say
from ..response.events import turns
from ..response.instants import ASIDE, size_of, way_of
from ..response.words import title_of
from .filmstrip import draw_filmstrip
from .style import BLACK, BLUE, GREY, RED, WIDTH, in_lines, page, styled, zero_line

if TYPE_CHECKING:
    from ..response import Response
    from ..response.events import Event

#: Most states of a strip, the start and the last end among them.
MOST_STATES = 9


@styled
def draw_sequence(
    response: Response, events: Sequence[Event], title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Displacement and tilt over a sequence of earthquakes; rest is grey, dots are what each of them leaves behind.

    The displacement is that of a column's top along x, or of an assembly's body that is farthest from its place; the tilt
    that of the body which has turned most since the start.

    Parameters
    ----------
    response : Response
    events : sequence of Event
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    figure = page(figure, (WIDTH, 4.6))
    upper, middle, lower = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.8, 1.0))
    time, ends = response.time, [len(event.run.time) - 1 for event in events]
    way, turn = np.nan_to_num(way_of(response)), np.nan_to_num(turns(response).max(axis=1))
    seen = np.abs(way) <= ASIDE * size_of(response)  # what has left the picture
    unit, factor = ("m", 1.0) if np.abs(way[seen]).max(initial=0.0) >= 0.1 else ("mm", 1000.0)
    for axes, values, color, shown in ((upper, factor * way, BLACK, seen), (middle, np.degrees(turn), BLUE, seen)):
        zero_line(axes)
        axes.plot(time, np.where(shown, values, np.nan), color=color)
        axes.plot(time[ends], np.where(shown, values, np.nan)[ends], "o", color=RED, markersize=3.5)
    zero_line(lower)
    lower.plot(time, response.histories.acceleration[:, 0] / g, color=GREY, linewidth=0.8)
    for event in events:
        for axes in (upper, middle, lower):
            axes.axvspan(event.span.quiet, event.span.ends, color="#efefef", linewidth=0.0, zorder=0)
        upper.annotate(
            str(event.number), (event.span.begins, 1.0), xycoords=("data", "axes fraction"), xytext=(1, -9),
            textcoords="offset points", fontsize=8.0,
        )  # fmt: skip
    if response.collapsed:
        for axes in (upper, middle):
            axes.axvline(response.collapse_time, color=BLACK, linewidth=0.8, linestyle=(0, (1, 2)))
    upper.set_ylabel(
        (say("top\n[{unit}]") if response.histories.top is not None else say("farthest body\n[{unit}]")).of(unit=unit)
    )
    middle.set_ylabel(say("largest tilt\n[°]"))
    lower.set_ylabel(say("ground\n[g]"))
    lower.set_xlabel(say("time [s]"))
    lower.set_xlim(0.0, time[-1])
    upper.set_title(in_lines(title or title_of(response)))
    figure.align_ylabels()
    return figure


def draw_ends(
    response: Response, events: Sequence[Event], title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """The structure before the first earthquake and at the end of each; of more than eight of some of them.

    Parameters
    ----------
    response : Response
    events : sequence of Event
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    last = [float(event.run.time[-1]) for event in events]
    some = np.unique(np.linspace(0, len(last) - 1, min(len(last), MOST_STATES - 1)).round().astype(int))
    return draw_filmstrip(response, [float(response.time[0]), *(last[k] for k in some)], title=title, figure=figure)
