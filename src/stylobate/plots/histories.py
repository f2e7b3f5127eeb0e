"""Histories of a response: displacements, energy, orbits in plan, and earthquakes one after another."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Ellipse, Patch, Rectangle

from ..column.shapes import CircularFrustum, Shape, hull
from ..constants import g
from ..messages import digits, say
from ..response import ENERGY_TERMS, Response
from ..response.events import turns
from ..response.poses import rotation_matrices
from ..response.recorded import ASIDE, size_of, way_of
from ..response.words import title_of
from .film import draw_filmstrip
from .scene import time_window
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
    begin, end = time_window(response.time, window)
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
    begin, end = time_window(max((response.time for response in responses), key=lambda time: time[-1]), window)
    figure = page(figure, (WIDTH, 3.6))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    zero_line(upper)
    marks = []
    names = [response.model for response in responses] if labels is None else labels
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
    lower.set_xlim(*time_window(time, window))
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
    """The structure before the first earthquake and at the end of each; of more than eight of some of them."""
    last = [float(event.run.time[-1]) for event in events]
    chosen = np.unique(np.linspace(0, len(last) - 1, min(len(last), MOST_STATES - 1)).round().astype(int))
    return draw_filmstrip(response, [float(response.time[0]), *(last[k] for k in chosen)], title=title, figure=figure)


# Joints of a response: how far each opened and slipped, over time and in plan.

#: Joints that have a panel at most.
MOST = 24


def until_collapse(response: Response) -> np.ndarray:
    """Which recorded states are before a collapse, all without one, as long as all is finite, shape (T,)."""
    finite = np.isfinite(response.body_position).all(axis=(1, 2))
    last = math.inf if math.isnan(response.collapse_time) else response.collapse_time
    return np.logical_and(finite, response.time <= last)


def most(values: np.ndarray) -> list[int]:
    """Numbers of the joints with the largest of these values, as many as have a panel, from the base upward."""
    return sorted(np.argsort(-values, kind="stable")[:MOST].tolist())


def panels_for(count: int, figure: Figure | SubFigure | None, **options: Any) -> tuple[Figure, list[Axes]]:
    """A picture as wide as a column of a journal, three panels beside one another; with its panels."""
    across = min(3, count)
    down = math.ceil(count / across)
    figure = page(figure, (3.4, 1.42 * down + 0.6))
    panels = list(np.ravel(figure.subplots(down, across, squeeze=False, subplot_kw=options)))
    for axes in panels[count:]:
        axes.set_axis_off()
    return figure, panels[:count]


#: Width of a letter of a title over panels [inch].
LETTER = 0.07


def put_title(figure: Figure, title: str, left_out: int) -> None:
    """The title over the panels, and how many joints have none."""
    more = say(" Without {left_out} joints that moved less.", left_out=left_out) if left_out else ""
    letters = min(max(int(figure.get_figwidth() / LETTER), 20), 110)
    figure.suptitle(textwrap.fill(title + more, letters), x=0.02, ha="left", fontsize=8.0)


# -- Opening of every joint over time, one trace per joint, stacked like the joints -----------------------------------


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
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
    """
    h, n = response.histories, response.opening.shape[1]
    opening = np.nan_to_num(np.abs(h.joint_opening))
    begin, end = time_window(h.time, window)
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
    axes.set_xlim(*time_window(h.time, window))
    axes.set_ylim(0.85, n + 1.35)
    every = 1 if n <= 30 else math.ceil(n / 25)
    axes.set_yticks(range(1, n + 1, every))
    axes.set_xlabel(say("time [s]"))
    axes.set_ylabel(say("joint, from the base\n(opening, each to its peak)"))
    axes.set_title(in_lines(title or title_of(response)))
    return figure


# -- Uplift along the rims of a column's joints -----------------------------------------------------------------------


#: Directions around a rim.
AROUND = 72


def face_outline(shape: Shape, upper: bool) -> np.ndarray:
    """Corners of a body's upper or lower face, counter-clockwise, along its own axes [m], shape (k, 2)."""
    at = shape.mesh(AROUND).vertices
    level = at[:, 2].max() if upper else at[:, 2].min()
    return hull(at[np.abs(at[:, 2] - level) < 1e-9 * np.ptp(at[:, 2])][:, :2])


def rim_radius(shape: Shape, upper: bool, azimuth: np.ndarray) -> np.ndarray:
    """Distance of the rim of a body's upper or lower face from its axis [m], shape of the azimuths.

    Parameters
    ----------
    shape : Shape
    upper : bool
        Which face.
    azimuth : array
        From the body's x axis towards its y axis [rad].
    """
    if isinstance(shape, CircularFrustum):
        return np.full(np.shape(azimuth), 0.5 * (shape.top if upper else shape.bottom))
    face = face_outline(shape, upper)
    side = np.roll(face, -1, axis=0) - face
    outward = np.stack((side[:, 1], -side[:, 0]), axis=1)
    reach = (outward * face).sum(axis=1)
    toward = np.stack((np.cos(azimuth), np.sin(azimuth)), axis=-1) @ outward.T
    with np.errstate(divide="ignore"):
        return np.where(toward > 0.0, reach / np.where(toward > 0.0, toward, 1.0), np.inf).min(axis=-1)


def rim_uplift(response: Response, joint: int, azimuth: np.ndarray) -> np.ndarray:
    """Height of the rim above a joint over the face below it, since the start [m], shape (T, number of azimuths).

    Parameters
    ----------
    response : Response
        Of a column in space.
    joint : int
        From 0, at the base.
    azimuth : array
        Directions in space, from x towards y [rad].
    """
    turn = rotation_matrices(response.body_orientation[:, joint])
    own = np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1])  # turn about its axis
    angle = azimuth - own[:, None]
    shape = response.bodies.shapes[joint]
    radius = rim_radius(shape, False, angle)
    low = shape.mesh().vertices[:, 2].min()
    rim = np.stack((radius * np.cos(angle), radius * np.sin(angle), np.full(angle.shape, low)), axis=-1)
    rim = rim @ np.swapaxes(turn, 1, 2) + response.body_position[:, joint, None]
    if joint == 0:
        height = rim[..., 2]
    else:
        below, up = response.bodies.shapes[joint - 1], response.body_axis[:, joint - 1]
        face = response.body_position[:, joint - 1] + below.mesh().vertices[:, 2].max() * up
        height = ((rim - face[:, None]) * up[:, None]).sum(axis=-1)
    return height - height[0]


@styled
def draw_uplift(response: Response, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Largest uplift along the rim of each joint, by direction, until the collapse if there is one.

    Each joint is drawn to its own peak, which stands over it with its direction.

    Parameters
    ----------
    response : Response
        Of a column in space.
    """
    kept = until_collapse(response)
    azimuth = np.arange(AROUND) * (2.0 * np.pi / AROUND)
    joints = range(response.opening.shape[1])
    peaks = np.array([rim_uplift(response, i, azimuth)[kept].max(axis=0) for i in joints]).clip(0.0)
    shown = most(peaks.max(axis=1))
    figure, panels = panels_for(len(shown), figure, projection="polar")
    around = np.append(azimuth, azimuth[0])
    for axes, i in zip(panels, shown):
        values = 1000.0 * np.append(peaks[i], peaks[i][0])
        largest = float(values.max())
        axes.fill(around, values, facecolor=SAND, edgecolor=BROWN, linewidth=1.0)
        axes.set_ylim(0.0, 1.08 * largest if largest > 0.0 else 1.0)
        axes.set_yticks([])
        axes.set_xticks(np.arange(8) * 0.25 * np.pi, ["x", "", "y", "", "", "", "", ""], fontsize=7.0)
        axes.tick_params(pad=-3)
        axes.grid(color="#dddddd", linewidth=0.5)
        axes.spines["polar"].set(color=GREY, linewidth=0.6)
        toward = math.degrees(azimuth[int(peaks[i].argmax())])
        caption = say("{far:.3g} mm, {azimuth:.0f}°", far=largest, azimuth=toward) if largest > 5e-3 else say("closed")
        axes.set_title(say("joint {number}\n{said}", number=i + 1, said=caption), fontsize=7.0, loc="center", pad=4.0)
    put_title(figure, title or f"Largest uplift by direction: {title_of(response)}", len(peaks) - len(shown))
    return figure


# -- Residual offsets and twists drum by drum in plan -----------------------------------------------------------------


#: Offsets and twists are drawn so large that the largest is about this share of a radius, and this angle [rad].
FAR, TURNED = 0.3, 0.5


@styled
def draw_residuals(response: Response, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Each drum over what it stands on, in plan, at the end, or where collapse became certain.

    Dashed is where the drum stood, blue the mark on its side. Offsets and twists are those along and about the joint,
    from the start; small ones are drawn larger, by round numbers that the title says. The numbers are true.

    Parameters
    ----------
    response : Response
        Of a column in space.
    """
    last = int(np.flatnonzero(until_collapse(response))[-1])
    slip, twist = response.slip[last], response.twist[last]
    shapes = response.bodies.shapes
    sizes = [float(np.hypot(*face_outline(shape, False).T).max()) for shape in shapes]
    largest = max(sizes)
    far = round_factor(FAR * largest / max(float(np.hypot(*slip.T).max()), 1e-12))
    turned = round_factor(TURNED / max(float(np.abs(twist).max()), 1e-12))
    shown = most(np.hypot(*slip.T) + largest * np.abs(twist))
    reach = max(1.3 * largest, 1.05 * max(sizes[i] + far * float(np.hypot(*slip[i])) for i in shown))
    figure, panels = panels_for(len(shown), figure)
    for axes, i in zip(panels, shown):
        _draw_drum(axes, shapes[i], far * slip[i], turned * twist[i])
        axes.set_xlim(-reach, reach)
        axes.set_ylim(-reach, reach)
        offset = 1000.0 * float(np.hypot(*slip[i]))
        azimuth = math.degrees(math.atan2(slip[i, 1], slip[i, 0])) % 360.0
        toward = say(" to {azimuth:.0f}°", azimuth=azimuth) if offset >= 0.05 else ""
        turn = round(math.degrees(twist[i]), 2) + 0.0
        twisted = ("−" if turn < 0.0 else "") + digits(abs(turn), ".2f")
        words = say("drum {number}\n{far:.1f} mm{to}\ntwist {turn}°", number=i + 1, far=offset, to=toward, turn=twisted)
        axes.set_title(words, fontsize=7.0, loc="center", pad=1.0)
    when = "At the end" if math.isnan(response.collapse_time) else "Where collapse became certain"
    drawn = "as they are" if far == turned == 1.0 else f"offsets × {far:g}, twists × {turned:g}"
    words = f"{when} ({drawn}; x to the right, y up): {title_of(response)}"
    put_title(figure, title or words, len(twist) - len(shown))
    return figure


def _draw_drum(axes: Axes, shape: Shape, offset: np.ndarray, twist: float) -> None:
    axes.set_aspect("equal")
    axes.set_axis_off()
    face = face_outline(shape, False)
    face = np.append(face, face[:1], axis=0)
    c, s = math.cos(twist), math.sin(twist)
    placed = face @ np.array([[c, s], [-s, c]]) + offset
    axes.fill(*placed.T, facecolor=SAND, edgecolor=BROWN, linewidth=0.9)
    axes.plot(*face.T, color=GREY, linewidth=0.7, linestyle=(0, (3, 2)))
    size = float(rim_radius(shape, False, np.zeros(1))[0])
    axes.plot([0.0, size], [0.0, 0.0], color=GREY, linewidth=0.7, linestyle=(0, (3, 2)))
    axes.plot([offset[0], offset[0] + size * c], [offset[1], offset[1] + size * s], color=BLUE, linewidth=1.6)
    axes.plot(*offset, ".", color=BLUE, markersize=4)


def round_factor(wanted: float) -> float:
    """The largest of 1, 2, 5, 10 … 1000 that is not larger than this, and at least 1."""
    if wanted < 2.0:
        return 1.0
    wanted = min(wanted, 1000.0)
    decade = 10.0 ** math.floor(math.log10(wanted))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= wanted)
