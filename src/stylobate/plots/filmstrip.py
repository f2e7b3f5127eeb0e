"""A film strip: what stood, deformed, at chosen instants, in true proportion."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..errors import InputError
from ..messages import digits as number
from ..messages import say
from ..response import Response
from ..response.instants import ASIDE, telling_states
from ..response.words import title_of
from .link_marks import draw_links
from .scene import Scene, draw_bodies
from .style import GREY, WIDTH, in_lines, page, signed, styled
from .view import ALONG_X, ALONG_Y

#: What the picture of one collapse in space is not: debris as such.
ONE_DRAW = "; where pieces lie is one draw of many"

#: Width that the words over a panel take [inch].
WORDS = 0.66

#: Most that the panels take in height, without their words [inch].
TALLEST = 6.0


@styled
def draw_filmstrip(
    response: Response,
    instants: Sequence[float] | None = None,
    *,
    magnification: float | None = None,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """States at chosen instants, with the time and how far the structure has moved.

    That is the displacement of a column's top relative to the ground, and the largest one of an assembly's blocks. What
    moved in space is drawn twice: as seen along y, with x to the right, and against x, with y to the right.

    Parameters
    ----------
    response : Response
    instants : sequence of float, optional
        [s]; the nearest recorded states are drawn. By default up to eight: at rest, at the largest
        displacement in each fifth of the clear motion of a column and before a collapse, or after equal ways of an
        assembly's blocks, and at the end.
    magnification : float, optional
        Factor on all displacements; by default 1, or a round number that makes small ones visible.
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    space = response.dims == "xyz"
    scenes = [Scene(response, view) for view in ((ALONG_X, ALONG_Y) if space else (None,))]
    scene = scenes[0]
    frames = telling_states(response) if instants is None else _frames_at(response.time, instants)
    factor = _magnification(scenes) if magnification is None else magnification
    outlines = [[one.outlines(i, factor) for i in frames] for one in scenes]
    stood = np.ptp(np.concatenate([np.concatenate(one.outlines(0)) for one in scenes]), axis=0)
    draw = _strip if stood[1] > TALL * stood[0] and not any(scene.fixed) else _grid
    figure, panels = draw(scenes, outlines, frames, figure)
    peak = max(float(np.nanmax(np.abs(one.way[frames]))) for one in scenes)
    unit, size, digits = ("m", 1.0, 2) if peak >= 0.1 else ("mm", 1000.0, 1)
    shown = [(one, i, shapes) for one, strip in zip(scenes, outlines) for i, shapes in zip(frames, strip)]
    for axes, (one, index, shapes) in zip(panels, shown, strict=True):
        draw_bodies(axes, one, shapes)
        draw_links(axes, one, index, factor)
        way = round(size * one.way[index], digits) + 0.0
        far = signed(way, f".{digits}f") if scene.signed else number(way, f".{digits}f")
        along = ("x ", "y ")[scenes.index(one)] if space and scene.signed else ""
        if space and not scene.signed:
            toward = "xy"[scenes.index(one)]
            axes.text(0.01, 0.0, f"{toward} →", transform=axes.transAxes, fontsize=6.5, color=GREY, ha="left", va="top")
        words = say("{time:.2f} s\n{along}{far} {unit}", time=scene.time[index], along=along, far=far, unit=unit)
        axes.set_title(words, fontsize=8.5, loc="center")
    said = "" if factor == 1.0 else say(" (displacements × {factor:g})", factor=factor)
    said += ONE_DRAW * (response.structure.space_joints is not None and response.collapsed)
    figure.suptitle(
        title + said if title == " " else in_lines((title or title_of(response)) + said),
        x=0.01,
        ha="left",
        fontsize=10.0,
    )
    return figure


#: From this ratio of height to width on, each panel is as wide as what it shows; else all panels have the same view.
TALL = 1.5


def _strip(
    scenes: list[Scene], outlines: list[list[list[np.ndarray]]], frames: list[int], figure: Figure | SubFigure | None
) -> tuple[Figure, list[Axes]]:
    """Panels each as wide as what it shows, all in one scale, in one row if that is not much smaller than in several."""
    stood = np.concatenate([np.concatenate(scene.outlines(0)) for scene in scenes])
    aside, margin = ASIDE * scenes[0].size, 0.35 * float(np.ptp(stood[:, 0]))
    limits = float(stood[:, 0].min()) - aside, float(stood[:, 0].max()) + aside
    spans = [_span(shape, limits, margin) for strip in outlines for shape in strip]
    floor = min(0.0, *(bottom for *_, bottom in spans))
    rows, scale = _rows([high - low for low, high, _, _ in spans], [top - floor for _, _, top, _ in spans], len(frames))
    heights = [max(spans[i][2] for i in row) - floor for row in rows]
    size = (WIDTH, 1.05 * scale * sum(heights) + 0.5 * len(rows) + 0.25)
    figure = page(figure, size)
    shares = [[max(spans[i][1] - spans[i][0], WORDS / scale) for i in row] for row in rows]
    total = max(map(sum, shares))
    panels: list[Axes] = []
    lines = figure.add_gridspec(len(rows), 1, height_ratios=[1.05 * scale * height + 0.5 for height in heights])
    for k, (row, height) in enumerate(zip(rows, heights)):
        rest = max(total - sum(shares[k]), 1e-3 * total)
        cells = lines[k].subgridspec(1, len(row) + 1, width_ratios=[*shares[k], rest])
        for place, (i, share) in enumerate(zip(row, shares[k])):
            middle = 0.5 * (spans[i][0] + spans[i][1])
            axes = figure.add_subplot(cells[place])
            axes.set_xlim(middle - 0.5 * share, middle + 0.5 * share)
            axes.set_ylim(floor - 0.03 * height, floor + 1.02 * height)
            axes.set_anchor("S")
            panels.append(axes)
    return figure, panels


def _rows(widths: list[float], heights: list[float], together: int) -> tuple[list[list[int]], float]:
    """Which panels stand in which row, and the scale of all [inch/m], from their widths and heights [m].

    A strip of so many panels begins a row.
    """
    found: dict[int, tuple[list[list[int]], float]] = {}
    least = len(widths) // together
    scale = LARGEST / (1.05 * max(heights))
    while True:
        rows: list[list[int]] = []
        room = -1.0
        for i, width in enumerate(widths):
            taken = max(scale * width, WORDS)
            if taken > room or i % together == 0:
                rows.append([])
                room = 0.96 * WIDTH
            rows[-1].append(i)
            room -= taken
        wide = max(sum(max(scale * widths[i], WORDS) for i in row) for row in rows)
        high = scale * sum(max(heights[i] for i in row) for row in rows)
        smallest = scale * max(heights) < 0.2
        if smallest or (wide <= 0.96 * WIDTH and (len(rows) == least or high <= TALLEST)):
            found.setdefault(len(rows), (rows, scale))
            if len(rows) == least or smallest:
                break
        scale *= 0.98
    largest = max(scale for _, scale in found.values())
    return found[min(count for count, (_, scale) in found.items() if scale >= NEARLY * largest)]


#: Fewer rows are taken where the scale is at least this share of the largest.
NEARLY = 0.7

#: Height of the panels of a strip in one row [inch].
LARGEST = 3.2


def _grid(
    scenes: list[Scene], outlines: list[list[list[np.ndarray]]], frames: list[int], figure: Figure | SubFigure | None
) -> tuple[Figure, list[Axes]]:
    """Panels with the same view, in as many rows as make them largest."""
    del outlines
    ends = [scene.view(np.array(frames)) for scene in scenes]
    low, high, bottom, top = (pick(end[k] for end in ends) for k, pick in enumerate((min, max, min, max)))
    n, width, height = len(frames), high - low, top - bottom

    def scale(across: int) -> float:
        return min(0.96 * WIDTH / across / width, TALLEST / (len(scenes) * math.ceil(n / across)) / height)

    across = max(range(1, n + 1), key=scale)
    down = len(scenes) * math.ceil(n / across)
    figure = page(figure, (WIDTH, down * (scale(across) * height + 0.45) + 0.35))
    panels = list(np.ravel(figure.subplots(down, across)))
    for axes in panels:
        axes.set_xlim(low, high)
        axes.set_ylim(bottom, top)
        axes.set_axis_off()
    each = len(panels) // len(scenes)
    return figure, [axes for k in range(len(scenes)) for axes in panels[k * each :][:n]]


def _span(shape: list[np.ndarray], limits: tuple[float, float], margin: float) -> tuple[float, float, float, float]:
    """Left and right end of a panel, with a margin, the highest and the lowest point [m]."""
    corners = np.concatenate(shape)
    corners = corners[np.isfinite(corners).all(axis=1)]
    low, high = (float(np.clip(end, *limits)) for end in (corners[:, 0].min(), corners[:, 0].max()))
    return low - margin, high + margin, float(corners[:, 1].max()), float(corners[:, 1].min())


def _frames_at(recorded: np.ndarray, instants: Sequence[float]) -> list[int]:
    for instant in instants:
        if not recorded[0] <= instant <= recorded[-1]:
            raise InputError(
                f"instant {instant:g} s is not recorded; allowed is {recorded[0]:g} to {recorded[-1]:g} s."
            )
    if not len(instants):
        raise InputError("no instant is given to draw; give at least one [s].")
    return [int(np.abs(recorded - instant).argmin()) for instant in instants]


def _magnification(scenes: list[Scene]) -> float:
    scene, peak = scenes[0], max(float(np.nanmax(np.abs(one.way))) for one in scenes)
    if peak <= 0.0 or peak > 0.02 * scene.size:
        return 1.0
    wanted = 0.05 * scene.size / peak
    decade = 10.0 ** math.floor(math.log10(wanted))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= wanted)
