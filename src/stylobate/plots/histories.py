"""Histories of a response: displacements, energy, orbits in plan, and earthquakes one after another."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Ellipse, Patch, Rectangle

from ..column.shapes import CircularFrustum
from ..constants import g
from ..messages import say
from ..response import ENERGY_TERMS, Response
from ..response.events import turns
from ..response.recorded import ASIDE, size_of, way_of
from ..response.words import title_of
from .film import draw_filmstrip
from .joints import until_collapse
from .scene import seen
from .style import BLACK, BLUE, BROWN, CYCLE, GREY, RED, SAND, WIDTH, in_lines, only_panel, page, styled, zero_line

if TYPE_CHECKING:
    from ..response.events import Event


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
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
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
    labels : sequence of str, optional
        What the models are called; their names by default.
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
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


# -- The energy ledger over time --------------------------------------------------------------------------------------


@styled
def draw_energy(
    response: Response,
    title: str | None = None,
    *,
    window: tuple[float, float] | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Input work, where it is and where it went, and below what the ledger cannot account for.

    Parameters
    ----------
    response : Response
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
    """
    time, energy = response.time, response.energy
    figure = page(figure, (WIDTH, 4.2))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    zero_line(upper)
    present = [term for term in ENERGY_TERMS if term == "input" or np.any(energy.get(term, 0.0))]
    unit, factor = _unit(max((float(np.nanmax(np.abs(energy[t]))) for t in present if t in energy), default=0.0))
    for term, line in zip(present, CYCLE * 2):
        width = 1.8 if term == "input" else 1.0
        upper.plot(time, factor * energy[term], label=_NAMES[term], linewidth=width, **line)
    upper.set_ylabel(say("energy [{unit}]", unit=unit))
    upper.legend(loc="upper left", ncols=3)
    bottom, top = upper.get_ylim()
    upper.set_ylim(bottom, top + 0.25 * (top - bottom))
    upper.set_title(in_lines(title or title_of(response)))
    zero_line(lower)
    word, largest = say("input"), float(np.nanmax(np.abs(energy["input"])))
    if response.followed:  # what falls releases more than what shook it put in
        released = float(np.nanmax(-energy["gravitational"]))
        word, largest = (say("released"), released) if released > largest else (word, largest)
    lower.plot(time, response.imbalance / (largest or 1.0), color=GREY)
    lower.set_ylabel(say("imbalance\n/ {what}", what=word))
    lower.set_xlabel(say("time [s]"))
    lower.set_xlim(*seen(time, window))
    lower.set_title(
        say("missing at the end: {r.energy_imbalance:.1e} of the energy at stake", r=response),
        loc="right",
        fontsize=8.0,
    )
    figure.align_ylabels()
    return figure


_NAMES = {
    "input": say("input"),
    "kinetic": say("kinetic"),
    "gravitational": say("gravity"),
    "elastic": say("elastic"),
    "friction": say("friction loss"),
    "viscous": say("viscous loss"),
    "impact": say("impact loss"),
}


def _unit(largest: float) -> tuple[str, float]:
    if largest >= 1e6:
        return "MJ", 1e-6
    return ("kJ", 1e-3) if largest >= 1e3 else ("J", 1.0)


# -- Orbit of a column's top in plan ----------------------------------------------------------------------------------


#: Width and height of the picture [inch]: a column of a journal.
SIZE = (3.4, 3.75)


@styled
def draw_orbit(
    response: Response, title: str | None = None, *, figure: Figure | SubFigure | None = None, ax: Axes | None = None
) -> Figure:
    """Displacement of the middle of the top face in plan, relative to the base, in equal scales; the base behind it.

    A square marks the start, a circle the end, and a cross where collapse became certain.

    Parameters
    ----------
    response : Response
        Of a column, in space.
    """
    figure, axes = only_panel(ax, figure, SIZE)
    top, time = response.top_displacement, response.time
    fallen = not math.isnan(response.collapse_time)
    kept = until_collapse(response)
    last = int(np.flatnonzero(kept)[-1])
    peak = float(np.hypot(*top[kept].T).max())
    unit, factor = ("m", 1.0) if peak >= 0.1 else ("mm", 1000.0)
    x, y = factor * top[kept].T
    axes.axhline(0.0, color="#dddddd", linewidth=0.6, zorder=0)
    axes.axvline(0.0, color="#dddddd", linewidth=0.6, zorder=0)
    base = footprint(response, factor)
    axes.add_patch(base)
    axes.plot(x, y, color=BLACK, linewidth=0.8, zorder=3)
    axes.plot(x[0], y[0], "s", color=BLUE, markersize=5, zorder=4, label=say("start"))
    if fallen:
        axes.plot(
            x[-1], y[-1], "X", color=RED, markersize=7, zorder=5, label=say("collapse, {time:.2f} s", time=time[last])
        )
    else:
        axes.plot(x[-1], y[-1], "o", color=RED, markersize=5, zorder=5, label=say("end, {time:.2f} s", time=time[last]))
    handles, labels = axes.get_legend_handles_labels()
    half = 0.5 * factor * base_size(response)
    reach = max(1.12 * float(np.abs((x, y)).max(initial=0.0)), 1e-9)
    if 1.05 * half < 4.0 * reach:  # else the base would leave nothing to see
        reach = max(reach, 1.05 * half)
        handles, labels = [*handles, base], [*labels, say("base")]
    else:
        base.remove()
        axes.set_title(say("base {length} across", length=_length(base_size(response))), loc="right", fontsize=8.0)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    axes.set_xlabel(say("top, along x [{unit}]", unit=unit))
    axes.set_ylabel(say("top, along y [{unit}]", unit=unit))
    words = textwrap.fill(title or title_of(response), 52)
    if ax is not None:
        axes.legend(handles, labels, loc="best", handletextpad=0.4)
        axes.set_title(words, fontsize=9.0)
        return figure
    figure.legend(handles, labels, loc="outside lower center", ncols=3, columnspacing=1.0, handletextpad=0.4)
    figure.suptitle(words, x=0.02, ha="left", fontsize=9.0)
    return figure


def footprint(response: Response, factor: float) -> Patch:
    """Lowest face of a column in plan, times a factor."""
    shape = response.bodies.shapes[0]
    style = {"facecolor": SAND, "edgecolor": BROWN, "linewidth": 0.8, "zorder": 1}
    if isinstance(shape, CircularFrustum):
        return Ellipse((0.0, 0.0), factor * shape.bottom, factor * shape.bottom, **style)
    low, high = _ends(response)
    return Rectangle(tuple(factor * low), *(factor * (high - low)), **style)


def base_size(response: Response) -> float:
    """Larger side of the lowest face [m]."""
    low, high = _ends(response)
    return float((high - low).max())


def _ends(response: Response) -> tuple[np.ndarray, np.ndarray]:
    vertices = response.bodies.shapes[0].mesh().vertices
    lowest = vertices[vertices[:, 2] < vertices[:, 2].min() + 1e-9]
    return lowest[:, :2].min(axis=0), lowest[:, :2].max(axis=0)


def _length(value: float) -> str:
    return say("{value:g} m", value=value) if value >= 0.1 else say("{value:g} mm", value=1000.0 * value)


# -- Earthquakes one after another ------------------------------------------------------------------------------------


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
    """
    last = [float(event.run.time[-1]) for event in events]
    some = np.unique(np.linspace(0, len(last) - 1, min(len(last), MOST_STATES - 1)).round().astype(int))
    return draw_filmstrip(response, [float(response.time[0]), *(last[k] for k in some)], title=title, figure=figure)
