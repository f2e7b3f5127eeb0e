"""Displacement histories of base and top as Baraldi et al. draw them, of the tops of several models, and of blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..constants import g
from ..response import Response
from ..response.instants import ASIDE, size_of
from .scene import describe
from .style import BLACK, CYCLE, GREY, RED, WIDTH, styled, zero_line

#: Blocks of an assembly that are drawn by name.
NAMED = 5


@styled
def draw_histories(response: Response, title: str | None = None) -> Figure:
    """Displacements over the acceleration of the ground: horizontal of a column's base and top, or of an assembly's blocks.

    Parameters
    ----------
    response : Response
    title : str, optional
        Column or assembly, motion and outcome by default.
    """
    if response.histories.top is None:
        return _draw_blocks(response, title)
    h = response.histories
    figure = Figure(figsize=(WIDTH, 3.6))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    zero_line(upper)
    upper.plot(h.time, h.top_displacement, color=BLACK, linestyle=(0, (4.5, 1.6)), label="top")
    upper.plot(h.time, h.base_displacement, color=RED, label="base")
    upper.set_ylabel("displacement\nrelative to the ground [m]")
    _mark_collapse(upper, [(response, BLACK)])
    _focus(upper, [response])
    upper.legend(loc="upper left", ncols=2)
    upper.set_title(title or describe(response))
    _draw_ground(lower, response)
    figure.align_ylabels()
    return figure


def _draw_blocks(response: Response, title: str | None) -> Figure:
    """Horizontal and vertical displacement of every block; those that move most by name, all others in grey."""
    names = response.bodies.names
    moving = [i for i, fixed in enumerate(response.bodies.fixed) if not fixed]
    farthest = np.nan_to_num(response.displacement).max(axis=0)
    named = sorted(moving, key=lambda i: -farthest[i])[:NAMED]
    figure = Figure(figsize=(WIDTH, 5.4))
    panels = figure.subplots(3, 1, sharex=True, height_ratios=(2.4, 2.4, 1.0))
    unit, factor = ("m", 1.0) if farthest.max() >= 0.1 else ("mm", 1000.0)
    gone = response.displacement > ASIDE * size_of(response)
    for axes, places, word in zip(panels, (response.x, response.z), ("horizontal", "vertical")):
        values = np.where(gone, np.nan, factor * (places - places[0]))
        zero_line(axes)
        for i in moving:
            if i not in named:
                axes.plot(response.time, values[:, i], color="#c8c8c8", linewidth=0.6)
        for i, line in zip(named, CYCLE):
            axes.plot(response.time, values[:, i], label=names[i], **line)
        axes.set_ylabel(f"{word}\ndisplacement [{unit}]")
    others = len(moving) - len(named)
    handles, labels = panels[0].get_legend_handles_labels()
    panels[0].legend(handles, labels, loc="best", ncols=min(3, len(labels)))
    if response.collapsed:
        first = response.collapse_time
        for axes in panels[:2]:
            axes.axvline(first, color=BLACK, linewidth=0.8, linestyle=(0, (1, 2)))
    said = f"; in grey the other {others} blocks" if others > 0 else ""
    panels[1].set_title(f"relative to the ground{said}", loc="right", fontsize=8.0)
    panels[0].set_title(title or describe(response))
    _draw_ground(panels[2], response)
    figure.align_ylabels()
    return figure


@styled
def draw_comparison(responses: Sequence[Response], title: str | None = None) -> Figure:
    """Top displacement of several models under one motion, over the acceleration of the ground."""
    figure = Figure(figsize=(WIDTH, 3.6))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    zero_line(upper)
    marks = []
    for response, line in zip(responses, CYCLE * (1 + len(responses) // len(CYCLE))):
        label = f"{response.model} ({response.outcome.label.replace('_', ' ')})"
        upper.plot(response.histories.time, response.histories.top_displacement, label=label, **line)
        marks.append((response, line["color"]))
    upper.set_ylabel("top displacement\nrelative to the ground [m]")
    _mark_collapse(upper, marks)
    _focus(upper, responses)
    upper.legend(loc="upper left", ncols=2)
    upper.set_title(title or f"{responses[0].column.name}, {responses[0].provenance.get('motion', 'motion')}")
    _draw_ground(lower, responses[0])
    figure.align_ylabels()
    return figure


def _draw_ground(axes: Axes, response: Response) -> None:
    zero_line(axes)
    axes.plot(response.time, response.ground_acceleration / g, color=GREY, linewidth=0.8)
    axes.set_ylabel("ground\n[g]")
    axes.set_xlabel("time [s]")
    axes.set_xlim(float(response.time[0]), float(response.time[-1]) or 1.0)


def _mark_collapse(axes: Axes, responses: Sequence[tuple[Response, str]]) -> None:
    for i, (response, color) in enumerate(responses):
        time = response.measures.collapse_time
        if math.isnan(time):
            continue
        axes.axvline(time, color=color, linewidth=0.8, linestyle=(0, (1, 2)))
        early = time < 0.7 * response.histories.time[-1]
        axes.annotate(
            f"collapse {time:.2f} s",
            (time, 0.04 + 0.09 * i),
            xycoords=("data", "axes fraction"),
            xytext=(3 if early else -3, 0),
            textcoords="offset points",
            ha="left" if early else "right",
            fontsize=8.0,
            color=color,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
        )


def _focus(axes: Axes, responses: Sequence[Response]) -> None:
    # What falls after the collapse must not squeeze what came before it.
    low = high = 0.0
    for response in responses:
        values = np.nan_to_num(response.histories.top_displacement)
        if not math.isnan(response.measures.collapse_time):
            limit = 2.0 * response.column.base_width
            values = np.clip(values, -limit, limit)
        low, high = min(low, float(values.min())), max(high, float(values.max()))
    size = high - low
    if size > 0.0:
        axes.set_ylim(low - 0.15 * size, high + 0.3 * size)  # room for the legend
