"""A film strip: the deformed column at chosen instants, in true proportion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..errors import InputError
from ..response import Response
from .animation import base_slope
from .histories import describe
from .style import BLACK, BROWN, SAND, WIDTH, styled

#: Width that the words over a panel take [inch].
WORDS = 0.66


@styled
def draw_filmstrip(
    response: Response,
    instants: Sequence[float] | None = None,
    *,
    magnification: float | None = None,
    title: str | None = None,
) -> Figure:
    """The column at chosen instants, with the time and the displacement of the top relative to the ground.

    Parameters
    ----------
    response : Response
    instants : sequence of float, optional
        [s]; the nearest recorded states are drawn. By default up to eight: at rest, at the largest
        displacement in each fifth of the clear motion and before a collapse, and at the end.
    magnification : float, optional
        Factor on all displacements; by default 1, or a round number that makes small ones visible.
    title : str, optional
    """
    h = response.histories
    frames = _frames(response, instants)
    factor = _magnification(response) if magnification is None else magnification
    outlines = [[response.outline(i, drum, factor) for drum in range(response.column.n)] for i in frames]
    spans = [_span(shape) for shape in outlines]
    floor = min(0.0, *(bottom for *_, bottom in spans))
    widths = [high - low for low, high, _, _ in spans]
    height = max(response.column.height, *(top for _, _, top, _ in spans)) - floor
    # One scale for all panels: as large as the page allows, with room for each panel's words.
    scale = 3.2 / (1.05 * height)
    while sum(max(scale * width, WORDS) for width in widths) > 0.96 * WIDTH and scale * height > 0.2:
        scale *= 0.98
    widths = [max(width, WORDS / scale) for width in widths]
    figure = Figure(figsize=(WIDTH, scale * 1.05 * height + 0.75))
    peak = float(np.nanmax(np.abs(h.top_displacement[frames])))
    unit, size, digits = ("m", 1.0, 2) if peak >= 0.1 else ("mm", 1000.0, 1)
    panels = np.ravel(figure.subplots(1, len(frames), width_ratios=widths))
    for axes, index, shape, width, (low, high, _, _) in zip(panels, frames, outlines, widths, spans):
        _draw(axes, shape, base_slope(response))
        middle = 0.5 * (low + high)
        axes.set_xlim(middle - 0.5 * width, middle + 0.5 * width)
        axes.set_ylim(floor - 0.03 * height, floor + 1.02 * height)
        axes.set_aspect("equal", anchor="S")
        axes.set_axis_off()
        top = f"{round(size * h.top_displacement[index], digits) + 0.0:+.{digits}f}".replace("-", "−")
        axes.set_title(f"{h.time[index]:.2f} s\n{top} {unit}", fontsize=8.5, loc="center")
    said = "" if factor == 1.0 else f" (displacements × {factor:g})"
    figure.suptitle((title or describe(response)) + said, x=0.01, ha="left", fontsize=10.0)
    return figure


def _span(shape: list[np.ndarray]) -> tuple[float, float, float, float]:
    """Left and right end of a panel, with a margin, the highest and the lowest point [m]."""
    corners = np.concatenate(shape)
    corners = corners[np.isfinite(corners).all(axis=1)]
    low, high = float(corners[:, 0].min()), float(corners[:, 0].max())
    margin = 0.35 * (high - low)
    return low - margin, high + margin, float(corners[:, 1].max()), float(corners[:, 1].min())


def _draw(axes: Axes, shape: list[np.ndarray], slope: float) -> None:
    axes.axline((0.0, 0.0), slope=slope, color=BLACK, linewidth=1.2)
    for i, corners in enumerate(shape):
        axes.fill(corners[:, 0], corners[:, 1], facecolor=SAND, edgecolor=BROWN, linewidth=0.7, zorder=2 + i)


def _frames(response: Response, instants: Sequence[float] | None) -> list[int]:
    h = response.histories
    if instants is None:
        top = np.nan_to_num(np.abs(h.top_displacement))
        time = response.measures.collapse_time
        before = top if math.isnan(time) else np.where(h.time <= time, top, 0.0)
        peak = int(before.argmax())
        last = _last_above_ground(response)
        top[last + 1 :] = before[last + 1 :] = 0.0
        moving = np.flatnonzero(np.abs(top[: last + 1] - top[last]) > 0.1 * before[peak])
        start, end = (int(moving[0]), int(moving[-1])) if moving.size else (0, last)
        start = max(start, int(np.argmax(before > 0.1 * before[peak])))
        edges = np.linspace(start, end + 1, 6).round().astype(int)
        spread = [low + int(top[low:high].argmax()) for low, high in pairwise(edges) if high > low]
        apart = 0.02 * (end - start)
        chosen = sorted({0, peak, *spread}) if last else []
        return [i for i in chosen if last - i > apart] + [last]
    for instant in instants:
        if not h.time[0] <= instant <= h.time[-1]:
            raise InputError(f"instant {instant:g} s is not recorded; allowed is {h.time[0]:g} to {h.time[-1]:g} s.")
    if not len(instants):
        raise InputError("no instant is given to draw; give at least one [s].")
    return [int(np.abs(h.time - instant).argmin()) for instant in instants]


def _last_above_ground(response: Response) -> int:
    # A model without contact of what falls with the ground lets it pass: nothing is to be seen from there on.
    heights = response.column.centroid_heights + response.histories.drum_z
    below = np.flatnonzero((heights < 0.0).any(axis=1))
    return max(int(below[0]) - 1, 0) if below.size else len(heights) - 1


def _magnification(response: Response) -> float:
    peak = float(np.nanmax(np.abs(response.histories.top_displacement)))
    if peak <= 0.0 or peak > 0.02 * response.column.height:
        return 1.0
    wanted = 0.05 * response.column.height / peak
    decade = 10.0 ** math.floor(math.log10(wanted))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= wanted)
