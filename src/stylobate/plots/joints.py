"""Joints of a response: how far each opened and slipped, over time and in plan."""

from __future__ import annotations

import math
import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..column.shapes import CircularFrustum, Shape, hull
from ..messages import digits, say
from ..response import Response
from ..response.poses import rotation_matrices
from ..response.words import title_of
from .scene import seen
from .style import BLACK, BLUE, BROWN, GREY, SAND, WIDTH, in_lines, only_panel, page, styled

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
        said = say("{far:.3g} mm, {azimuth:.0f}°", far=largest, azimuth=toward) if largest > 5e-3 else say("closed")
        axes.set_title(say("joint {number}\n{said}", number=i + 1, said=said), fontsize=7.0, loc="center", pad=4.0)
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
