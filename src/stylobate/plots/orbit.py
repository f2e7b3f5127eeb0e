"""Orbit of a column's top in plan: where it went, in both horizontal directions."""

from __future__ import annotations

import math
import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Ellipse, Patch, Rectangle

from ..column.shapes import CircularFrustum
from ..messages import say
from ..response import Response
from ..response.words import title_of
from .panels import until_collapse
from .style import BLACK, BLUE, BROWN, RED, SAND, only_panel, styled

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
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    ax : Axes, optional
        To draw in, instead of a figure.
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
