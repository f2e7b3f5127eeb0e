"""Verdicts over the amplitude of a motion: of one column, of columns like it, and of every record of a suite."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Polygon
from matplotlib.projections.polar import PolarAxes

from ..column.block import FAR_AWAY
from ..column.shapes import hull, matrix_of
from ..column.structure import Body
from ..constants import g
from ..response import Response
from ..verdicts import verdict as v
from ..verdicts.critical import CriticalAmplitude, CriticalPopulation, CriticalSuite
from ..verdicts.directions import Compass
from ..verdicts.population import BodyOverTwins, not_yet_debris, only_as_seen
from .domain import FILL, edges_of
from .style import (
    BLACK,
    BLUE,
    CYCLE,
    GREY,
    RED,
    SAND,
    WIDTH,
    in_lines,
    legend_below,
    only_panel,
    page,
    panel,
    plain,
    styled,
)

_MARKS: dict[str, dict[str, Any]] = {
    v.STANDS: {"marker": "o", "color": BLACK, "fillstyle": "none"},
    v.COLLAPSED: {"marker": "x", "color": RED},
    v.UNDECIDED: {"marker": "s", "color": GREY, "fillstyle": "none"},
    v.FAILED: {"marker": "+", "color": BLUE},
}


@styled
def draw_amplitudes(result: CriticalAmplitude, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Peak top displacement of the runs that have one, the verdict of every run, and the lowest collapse, of twins too."""
    amplitudes, verdicts = result.amplitudes / g, np.array(result.verdicts)
    if (width := result.column.base_width) is None:  # nor is there one top
        peaks, label = (
            result.rows.floats("peak_displacement_m"),
            "peak displacement of a block [m]\n(collapse: at the top)",
        )
    else:
        peaks = result.rows.floats("peak_top_displacement_m") / width
        label = "peak top displacement\n/ base width (collapse: at the top)"
    finite = peaks[np.isfinite(peaks) & (verdicts != v.COLLAPSED)]
    ceiling = 1.25 * max(float(finite.max()) if finite.size else 0.0, 0.1)
    shown = np.where((verdicts == v.COLLAPSED) | ~np.isfinite(peaks), ceiling, np.minimum(peaks, ceiling))
    figure, axes = panel(ax, (WIDTH, 3.4))
    for verdict, mark in _MARKS.items():
        chosen = verdicts == verdict
        if chosen.any():
            counted = f"{verdict} ({int(chosen.sum())})"
            axes.plot(amplitudes[chosen], shown[chosen], linestyle="none", markersize=5.0, label=counted, **mark)
    if result.critical is not None:
        at = result.critical / g
        whose = "" if result.population is None else " of this one"
        axes.axvline(at, color=RED, linewidth=0.8, label=f"lowest collapse{whose}, {at:.4g} g")
    if result.population is not None and (fell := float(result.population.critical.min())) < math.inf:
        label_of_likes = f"lowest of {len(result.population.verdicts)} like it, {fell / g:.4g} g"
        axes.axvline(fell / g, color=RED, linestyle=(0, (1.2, 1.2)), linewidth=1.2, label=label_of_likes)
    if (opens := result.column.uplift_acceleration) is not None:
        uplift = opens / g
        axes.axvline(uplift, color=BLUE, linestyle=(0, (6, 2.5)), linewidth=1.0, label=f"static uplift, {uplift:.3f} g")
    axes.set_ylim(0.0, 1.1 * ceiling)
    axes.set_xlabel("amplitude of acceleration [g]")
    axes.set_ylabel(label)
    axes.set_title(title or f"{result.column.name}, {result.model}")
    legend_below(axes, ax is None, ncols=3)
    return figure


# -- Probability of collapse over the amplitude of one motion, with its interval --------------------------------------


@styled
def draw_collapse_over_amplitude(
    population: CriticalPopulation, title: str | None = None, *, ax: Axes | None = None
) -> Figure:
    """Share of the twins that collapse over the amplitude, with its confidence band; above it the factor of the record.

    Where twins are undecided there is no line, but a bar: from the share if none of them collapses to that if all do.
    """
    figure, axes = panel(ax, (WIDTH, 3.4))
    amplitudes, (low, high) = population.amplitudes / g, population.interval
    band = f"{100.0 * population.confidence:g} % interval (Wilson; undecided counted both ways)"
    axes.fill_between(amplitudes, low, high, step="mid", color=BLUE, alpha=0.25, linewidth=0.0, label=band)
    least, most = population.probability, population.undecided_collapsed
    known = np.where(most > least, np.nan, least)
    axes.plot(amplitudes, known, "o-", color=BLACK, markersize=3.0, label="share that collapses", clip_on=False)
    if (open_ := np.isnan(known) & np.isfinite(most)).any():
        label = "its range where some are undecided"
        low = np.nan_to_num(least[open_])
        bars = axes.vlines(amplitudes[open_], low, most[open_], color=BLACK, linewidth=3.0, alpha=0.5, label=label)
        bars.set_clip_on(False)
    axes.set_ylim(-0.03, 1.03)
    axes.set_xlim(amplitudes[0], max(amplitudes[-1], amplitudes[0] * 1.0001))
    axes.grid(axis="y")
    axes.set_xlabel("amplitude of acceleration [g]")
    axes.set_ylabel(f"probability of collapse [-]\n{len(population.verdicts)} {population.drawn.like} like this one")
    if population.nominal:
        scale = population.nominal / g
        above = axes.secondary_xaxis(
            "top", functions=(lambda a: np.asarray(a) / scale, lambda f: np.asarray(f) * scale)
        )
        above.set_xlabel("factor of the record [-]")
    axes.set_title(title or "")
    legend_below(axes, ax is None, ncols=2)
    return figure


# -- Verdicts of every record of a suite over its amplitude, and the share of the records that collapse the column ----


#: Longer names of records are cut.
LONGEST = 30


@styled
def draw_record_verdicts(
    suite: CriticalSuite, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Share of collapse over the peak acceleration, and below it one strip of verdicts per record."""
    count, amplitudes = len(suite.results), suite.amplitudes / g
    column = suite.results[0].column
    figure = page(figure, (WIDTH, 2.9 + 0.24 * count))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.6, 0.4 + 0.24 * count))
    edges = edges_of(amplitudes)
    upper.stairs(suite.share_collapsed, edges, baseline=None, color=BLACK, linewidth=1.4)
    upper.set_ylim(-0.03, 1.03)
    upper.grid(axis="y")
    upper.set_ylabel("share of motions\nthat collapse it [-]")
    verdicts = suite.verdicts
    handles = []
    for verdict, fill in FILL.items():
        cells = [
            [(edges[j], i - 0.4), (edges[j + 1], i - 0.4), (edges[j + 1], i + 0.4), (edges[j], i + 0.4)]
            for i, j in np.argwhere(verdicts == verdict)
        ]
        if cells:
            lower.add_collection(PolyCollection(cells, antialiaseds=False, **fill))
            frame = {"edgecolor": "#999999", "linewidth": 0.5}
            handles.append(Patch(label=f"{verdict} ({len(cells)})", **(fill | frame if "hatch" not in fill else fill)))
    lower.set_yticks(range(count), [plain(_short(result.motion.name)) for result in suite.results], fontsize=7.5)
    lower.set_ylim(count - 0.5, -0.5)
    lower.set_xlim(edges[0], edges[-1])
    lower.set_xlabel("peak ground acceleration [g]")
    lower.set_ylabel("motion / verdict")
    uplift = column.uplift_acceleration / g
    for axes in (upper, lower):
        line = axes.axvline(uplift, color=BLUE, linestyle=(0, (6, 2.5)), linewidth=1.1)
    line.set_label(f"static uplift, {uplift:.3f} g")
    upper.set_title(title or f"{column.name}, {suite.results[0].model}: {count} motions")
    figure.legend(handles=[*handles, line], loc="outside lower center", ncols=4)
    return figure


def _short(name: str) -> str:
    return name if len(name) <= LONGEST else f"{name[: LONGEST - 1]}…"


# -- Values by direction on a compass ---------------------------------------------------------------------------------


@styled
def draw_directions(compass: Compass, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """A value over the direction of the shaking along x: north up, azimuths clockwise as those of records.

    The worst direction is marked. Values beyond what was looked at stand open at the rim.
    """
    figure = page(figure, (4.6, 4.9))
    axes = cast(PolarAxes, figure.add_subplot(projection="polar"))
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    axes.set_thetagrids(np.arange(0, 360, 30), [f"{azimuth}°" for azimuth in range(0, 360, 30)])
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


# Plan of where the bodies of an assembly lay at the end, over its twins: regions, never one picture of debris.

#: Colours of the bodies that fell most often; others are grey.
COLOURS = tuple(line["color"] for line in CYCLE[:5])


@styled
def draw_debris(
    response: Response,
    bodies: Sequence[BodyOverTwins],
    title: str | None = None,
    *,
    figure: Figure | SubFigure | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Plan with the places of the centroids of all bodies that fell in some twin, at the end of each run.

    A dot is a twin; half of the dots of a body lie in its full circle and 90 % in the dashed one, about the median place.
    What stood at the start is drawn behind it.

    Parameters
    ----------
    response : Response
        Of the assembly itself, in space.
    bodies : sequence of BodyOverTwins
        ``Population.bodies``.
    """
    figure, axes = only_panel(ax, figure, (WIDTH, 5.6))
    fallen = sorted((body for body in bodies if body.fell), key=lambda body: -body.fell)
    for body in response.structure.bodies:
        if body.fixed and body.size > FAR_AWAY:
            continue
        for shape in _footprints(body):
            axes.add_patch(Polygon(shape, facecolor=SAND, edgecolor=GREY, linewidth=0.5, zorder=1))
    names = response.bodies.names
    starts = dict(zip(names, response.body_position[0, :, :2], strict=True))
    handles = []
    for number, fallen_body in enumerate(fallen):
        colour = COLOURS[number] if number < len(COLOURS) else GREY
        ends = starts[fallen_body.name] + fallen_body.ends
        middle = starts[fallen_body.name] + fallen_body.middle
        axes.plot(*ends.T, ".", color=colour, markersize=4.0, zorder=3)
        for radius, style in zip(fallen_body.radii, ("-", (0, (4, 2))), strict=True):
            x, y = (float(place) for place in middle)
            circle = Circle((x, y), radius, fill=False, edgecolor=colour, linewidth=0.9, linestyle=style, zorder=2)
            axes.add_patch(circle)
        if number < len(COLOURS):
            label = (
                f"{fallen_body.name}: fell in {fallen_body.fell} of {fallen_body.runs}"
                + f", {fallen_body.open} undecided" * bool(fallen_body.open)
            )
            handles.append(Line2D([], [], color=colour, marker=".", label=label))
    if len(fallen) > len(COLOURS):
        handles.append(Line2D([], [], color=GREY, marker=".", label=f"{len(fallen) - len(COLOURS)} more that fell"))
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_ylabel("y [m]")
    if handles:
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=7.5)
    else:
        axes.text(0.5, 0.02, "nothing fell in any of them", transform=axes.transAxes, ha="center", color=BLACK)
    runs = len(bodies[0].ends) if bodies else 0
    moving = not_yet_debris(bodies)
    heading = f"{response.structure.name}: where bodies were at the end of {runs} runs"
    axes.set_title(in_lines(title or heading + f"; {moving}" * bool(moving)))
    lines = ["x [m]", "full circle: 50 %, dashed: 90 % of all runs, about the median place;"]
    lines += ["runs in which a body stands count, too", *filter(None, [only_as_seen(runs)])]
    axes.set_xlabel("\n".join(lines))
    return figure


def _footprints(body: Body) -> list[np.ndarray]:
    """Outlines of the parts of a body in plan, as they stand [m]."""
    return [
        hull((part.shape.mesh().vertices @ matrix_of(part.orientation).T + np.array(part.place))[:, :2])
        for part in body.placed
    ]
