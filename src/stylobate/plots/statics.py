"""Statics of rigid blocks: the pushover curve, the mechanism, and the multiplier by direction."""

from __future__ import annotations

from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Polygon
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from ..models.rigid_block.block_stack import BlockStack
from ..statics.limit import LimitByDirection, LimitResult
from ..statics.pushover import PushoverResult
from .style import BLACK, BLUE, BROWN, GREY, RED, SAND, WIDTH, in_lines, page, panel, styled, zero_line


@styled
def draw_pushover(
    stack: BlockStack,
    path: PushoverResult,
    limit: float | None = None,
    title: str = "",
    *,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Load multiplier over the displacement of the top, and the column where the path ends.

    Parameters
    ----------
    stack : BlockStack
    path : PushoverResult
    limit : float, optional
        Multiplier of the limit analysis [g], drawn as a line.
    """
    figure = page(figure, (WIDTH, 3.6))
    curve, picture = figure.subplots(1, 2, width_ratios=(2.2, 1.0))
    zero_line(curve)
    curve.plot(path.displacement, path.multiplier, color=BLACK, label="rigid blocks")
    if limit is not None:
        curve.axhline(limit, color=BLUE, linestyle="-.", label=f"limit analysis, {limit:.4g} g")
    word = "peak" if path.peaked else "still rising at the end"
    curve.plot(
        path.displacement[path.peak],
        path.largest_multiplier,
        marker="o",
        color=RED,
        linestyle="none",
        label=f"{word}, {path.largest_multiplier:.4g} g",
    )
    if np.isfinite(path.ultimate_displacement):
        curve.plot(
            path.ultimate_displacement,
            0.0,
            marker="s",
            color=RED,
            linestyle="none",
            label=f"ultimate displacement, {path.ultimate_displacement:.3g} m",
        )
    led = "the top" if path.at is None else f"drum {path.at}"
    curve.set(xlabel=f"displacement of {led} [m]", ylabel="load multiplier [g]", title=title)
    curve.set_xlim(left=0.0)
    curve.xaxis.set_major_locator(MaxNLocator(6))
    curve.grid(True)
    curve.legend(loc="lower left" if path.peaked else "lower right")
    if path.peaked:  # The elastic branch is a thousandth of the whole: it needs its own axes.
        curve.set_ylim(top=1.9 * path.collapse_multiplier)
        inset = curve.inset_axes((0.6, 0.7, 0.38, 0.28))
        near = path.displacement <= 6.0 * path.peak_displacement
        inset.plot(1e3 * path.displacement[near], path.multiplier[near], color=BLACK)
        inset.set(xlim=(0.0, None), ylim=(0.0, None), xlabel="[mm]")
        inset.tick_params(labelsize=7)
        picture.set_title(f"joint {path.governing_joint} governs")
    # A state in which the mechanism is plain to see and still standing: half way to the end.
    half = int(np.searchsorted(path.displacement, 0.5 * path.displacement[-1]))
    joints = {path.governing_joint} if path.peaked else set()
    _draw_blocks(picture, stack, path.position[min(half, len(path.position) - 1)], joints)
    return figure


@styled
def draw_mechanism(stack: BlockStack, result: LimitResult, title: str = "", *, ax: Axes | None = None) -> Figure:
    """The mechanism of the limit analysis, its velocities drawn as a displacement of a tenth of the height."""
    figure, axes = panel(ax, (0.6 * WIDTH, 4.4))
    _draw_blocks(
        axes, stack, result.mechanism * 0.1 * stack.top[1], {item.joint for item in result.active}, linear=True
    )
    modes = ", ".join(dict.fromkeys(f"joint {item.joint} {item.mode}" for item in result.active[:3]))
    axes.set_title(title or f"{result.multiplier:.4g} g: {modes}{' …' if len(result.active) > 3 else ''}")
    return figure


def _draw_blocks(
    axes: Axes, stack: BlockStack, position: np.ndarray, joints: set[int], *, linear: bool = False
) -> None:
    """Blocks where they stood (outline) and where they are (filled); the joints that give way in red."""
    for outline, centre, (x, z, turn) in zip(stack.outlines, stack.centroid, position, strict=True):
        c, s = (1.0, turn) if linear else (np.cos(turn), np.sin(turn))
        moved = centre + [x, z] + (outline - centre) @ np.array([[c, s], [-s, c]])
        axes.add_patch(Polygon(outline, fill=False, edgecolor=GREY, linewidth=0.5, linestyle=(0, (2, 2))))
        axes.add_patch(Polygon(moved, facecolor=SAND, edgecolor=BROWN, linewidth=0.8))
    for joint in joints:
        low = position[joint - 2] if joint > 1 else np.zeros(3)
        centre = stack.centroid[joint - 2] if joint > 1 else np.zeros(2)
        c, s = (1.0, low[2]) if linear else (np.cos(low[2]), np.sin(low[2]))
        along = np.array([np.cos(stack.angle[joint - 1]), np.sin(stack.angle[joint - 1])])
        ends = stack.joint[joint - 1] + 0.5 * stack.width[joint - 1] * np.array([-along, along])
        place = centre + low[:2] + (ends - centre) @ np.array([[c, s], [-s, c]])
        axes.plot(*place.T, color=RED, linewidth=2.0, solid_capstyle="butt")
    axes.axhline(0.0, color=BLACK, linewidth=0.8)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.08)
    axes.xaxis.set_major_locator(MaxNLocator(2))
    axes.set(xlabel="x [m]", ylabel="z [m]")


# -- The collapse multiplier all round a column -----------------------------------------------------------------------


#: Where the axes of the plan lie: unlike azimuths from north, these count from x towards y.
AXES = {0: " (x)", 90: " (y)", 180: " (−x)", 270: " (−y)"}


@styled
def draw_limit_directions(
    result: LimitByDirection, title: str = "", *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Multiplier over the azimuth that the forces push to: x to the right, y up, as seen from above."""
    figure = page(figure, (4.6, 4.9))
    axes = cast(PolarAxes, figure.add_subplot(projection="polar"))
    axes.set_thetagrids(np.arange(0, 360, 30), [f"{azimuth}°{AXES.get(azimuth, '')}" for azimuth in range(0, 360, 30)])
    order = np.argsort(result.azimuths % 360.0)
    angle, values = np.radians(result.azimuths[order]), result.multipliers[order]
    around = np.append(np.arange(len(angle)), 0)
    if len(angle) > 2:
        axes.plot(angle[around], values[around], color=BLACK, linewidth=0.9)
    for mode, colour in (("rocking", BLACK), ("sliding", BLUE), ("twisting", GREY)):
        of = np.array([result.limits[i].mode == mode for i in order])
        if of.any():
            axes.plot(angle[of], values[of], "o", color=colour, markersize=4.0, label=mode)
    weak = result.weakest
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
