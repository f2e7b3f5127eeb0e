"""Displacement histories of base and top as Baraldi et al. draw them, of the tops of several models, and of blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..constants import g
from ..messages import say
from ..response import Response
from ..response.instants import ASIDE, size_of, way_of
from ..response.words import title_of
from .scene import seen
from .style import BLACK, BLUE, CYCLE, GREY, RED, WIDTH, in_lines, page, styled, zero_line

#: Blocks of an assembly that are drawn by name.
NAMED = 5


@styled
def draw_histories(
    response: Response,
    title: str | None = None,
    *,
    window: tuple[float, float] | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Displacements over the acceleration of the ground: horizontal of a column's base and top, or of an assembly's blocks.

    In space there is one panel for each horizontal direction, all in one scale.

    Parameters
    ----------
    response : Response
    title : str, optional
        Column or assembly, motion and outcome by default.
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    begin, end = seen(response.time, window)
    if response.histories.top is None:
        return _draw_blocks(response, title, (begin, end), figure)
    h = response.histories
    space = response.dims == "xyz"
    figure = page(figure, (WIDTH, 5.0 if space else 3.6))
    *uppers, lower = figure.subplots(
        3 if space else 2, 1, sharex=True, height_ratios=(*(3.2,) * (1 + space), 1.0 + space)
    )
    for k, upper in enumerate(uppers):
        zero_line(upper)
        of = (slice(None), k) if space else ...
        upper.plot(h.time, h.top_displacement[of], color=BLACK, linestyle=(0, (4.5, 1.6)), label=say("top"))
        upper.plot(h.time, h.base_displacement[of], color=RED, label=say("base"))
        upper.set_ylabel(
            say("{axis}, relative\nto the ground [m]", axis="xy"[k])
            if space
            else say("displacement\nrelative to the ground [m]")
        )
        _mark_collapse(upper, [(response, BLACK)])
        _focus(upper, [response], (begin, end))
    uppers[0].legend(loc="upper left", ncols=2)
    uppers[0].set_title(in_lines(title or title_of(response)))
    _draw_ground(lower, response, (begin, end))
    figure.align_ylabels()
    return figure


def _draw_blocks(
    response: Response, title: str | None, window: tuple[float, float], figure: Figure | SubFigure | None
) -> Figure:
    """Horizontal and vertical displacement of every block; those that move most by name, all others in grey."""
    names = response.bodies.names
    moving = [i for i, fixed in enumerate(response.bodies.fixed) if not fixed]
    inside = (response.time >= window[0]) & (response.time <= window[1])
    farthest = np.nan_to_num(response.displacement[inside]).max(axis=0, initial=0.0)
    named = sorted(moving, key=lambda i: -farthest[i])[:NAMED]
    space = response.dims == "xyz"
    places = {"x": response.x, "y": response.y, say("vertical"): response.z}
    if not space:
        places = {say("horizontal"): response.x, say("vertical"): response.z}
    figure = page(figure, (WIDTH, 3.4 + len(places)))
    panels = figure.subplots(len(places) + 1, 1, sharex=True, height_ratios=(*(2.4,) * len(places), 1.0 + 0.3 * space))
    unit, factor = ("m", 1.0) if farthest.max() >= 0.1 else ("mm", 1000.0)
    gone = response.displacement > ASIDE * size_of(response)
    for axes, (word, place) in zip(panels, places.items()):
        values = np.where(gone | ~inside[:, None], np.nan, factor * (place - place[0]))
        zero_line(axes)
        for i in moving:
            if i not in named:
                axes.plot(response.time, values[:, i], color="#c8c8c8", linewidth=0.6)
        for i, line in zip(named, CYCLE):
            axes.plot(response.time, values[:, i], label=names[i], **line)
        axes.set_ylabel(say("{direction}\ndisplacement [{unit}]", direction=word, unit=unit))
    ground = len(places)
    others = len(moving) - len(named)
    handles, labels = panels[0].get_legend_handles_labels()
    if space:
        figure.legend(handles, labels, loc="outside lower center", ncols=min(3, len(labels)))
    else:
        panels[0].legend(handles, labels, loc="best", ncols=min(3, len(labels)))
    first = response.collapse_time
    if window[0] <= first <= window[1]:
        for axes in panels[:ground]:
            axes.axvline(first, color=BLACK, linewidth=0.8, linestyle=(0, (1, 2)))
    grey = say("relative to the ground; in grey the other {count} blocks", count=others)
    panels[1].set_title(grey if others > 0 else say("relative to the ground"), loc="right", fontsize=8.0)
    panels[0].set_title(in_lines(title or title_of(response)))
    _draw_ground(panels[ground], response, window)
    figure.align_ylabels()
    return figure


@styled
def draw_comparison(
    responses: Sequence[Response],
    title: str | None = None,
    *,
    labels: Sequence[str] | None = None,
    window: tuple[float, float] | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Top displacement of several models under one motion, or that of an assembly's farthest body, over that of the ground.

    Parameters
    ----------
    responses : sequence of Response
    title : str, optional
    labels : sequence of str, optional
        What the models are called; their names by default.
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    begin, end = seen(max((one.time for one in responses), key=lambda time: time[-1]), window)
    figure = page(figure, (WIDTH, 3.6))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    zero_line(upper)
    marks = []
    names = [one.model for one in responses] if labels is None else labels
    for response, name, line in zip(responses, names, CYCLE * (1 + len(responses) // len(CYCLE))):
        label = f"{name} ({response.outcome.label.replace('_', ' ')})"
        upper.plot(response.time, way_of(response), label=label, **line)
        marks.append((response, line["color"]))
    top = responses[0].histories.top is not None
    upper.set_ylabel(f"{'top displacement' if top else 'farthest body'}\nrelative to the ground [m]")
    _mark_collapse(upper, marks)
    _focus(upper, responses, (begin, end))
    upper.legend(loc="upper left", ncols=2)
    named = f"{responses[0].structure.name}, {responses[0].provenance.get('motion', 'motion')}"
    upper.set_title(in_lines(title or named))
    _draw_ground(lower, responses[0], (begin, end))
    figure.align_ylabels()
    return figure


def _draw_ground(axes: Axes, response: Response, window: tuple[float, float]) -> None:
    zero_line(axes)
    along, across = response.histories.acceleration[:, :2].T / g
    axes.plot(response.time, along, color=GREY, linewidth=0.8, label="x")
    if response.dims == "xyz":
        axes.plot(response.time, across, color=BLUE, linewidth=0.8, linestyle=(0, (4, 1.5)), label="y")
        axes.legend(loc="upper right", ncols=2, fontsize=7.5)
    axes.set_ylabel(say("ground\n[g]"))
    axes.set_xlabel(say("time [s]"))
    axes.set_xlim(*window)


def _mark_collapse(axes: Axes, responses: Sequence[tuple[Response, str]]) -> None:
    for i, (response, color) in enumerate(responses):
        time = response.measures.collapse_time
        if math.isnan(time):
            continue
        axes.axvline(time, color=color, linewidth=0.8, linestyle=(0, (1, 2)))
        early = time < 0.7 * response.histories.time[-1]
        axes.annotate(
            say("collapse {time:.2f} s", time=time),
            (time, 0.04 + 0.09 * i),
            xycoords=("data", "axes fraction"),
            xytext=(3 if early else -3, 0),
            textcoords="offset points",
            ha="left" if early else "right",
            fontsize=8.0,
            color=color,
            annotation_clip=True,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
        )


def _focus(axes: Axes, responses: Sequence[Response], window: tuple[float, float]) -> None:
    # What falls after the collapse must not squeeze what came before it.
    low = high = 0.0
    for response in responses:
        inside = (response.time >= window[0]) & (response.time <= window[1])
        top = response.histories.top
        values = np.nan_to_num((way_of(response) if top is None else top)[inside])
        if not math.isnan(response.measures.collapse_time):
            limit = size_of(response) if top is None else 2.0 * response.column.base_width
            values = np.clip(values, -limit, limit)
        low, high = min(low, float(values.min(initial=0.0))), max(high, float(values.max(initial=0.0)))
    size = high - low
    if size > 0.0:
        axes.set_ylim(low - 0.15 * size, high + 0.3 * size)  # room for the legend
