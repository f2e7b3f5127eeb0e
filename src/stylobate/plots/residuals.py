"""Residual offsets and twists drum by drum in plan: what an archaeologist measures."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..column.shapes import Shape
from ..messages import digits, say
from ..response import Response
from ..response.words import title_of
from .panels import most, panels_for, put_title, until_collapse
from .style import BLUE, BROWN, GREY, SAND, styled
from .uplift import face_outline, rim_radius

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
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
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
