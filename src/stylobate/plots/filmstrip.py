"""A film strip: what stood, deformed, at chosen instants, in true proportion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure

from ..errors import InputError
from ..response import AnyResponse, AssemblyResponse, Response
from .scene import ASIDE, Scene, describe, draw_bodies, scene_of
from .style import WIDTH, styled

#: Width that the words over a panel take [inch].
WORDS = 0.66

#: Most that the panels of a grid take in height, without their words [inch].
TALLEST = 6.0


@styled
def draw_filmstrip(
    response: AnyResponse,
    instants: Sequence[float] | None = None,
    *,
    magnification: float | None = None,
    title: str | None = None,
) -> Figure:
    """A column or an assembly at chosen instants, with the time and how far it has moved.

    That is the displacement of a column's top relative to the ground, and the largest one of an assembly's blocks.

    Parameters
    ----------
    response : Response or AssemblyResponse
    instants : sequence of float, optional
        [s]; the nearest recorded states are drawn. By default up to eight: at rest, at the largest
        displacement in each fifth of the clear motion of a column and before a collapse, or after equal ways of an
        assembly's blocks, and at the end.
    magnification : float, optional
        Factor on all displacements; by default 1, or a round number that makes small ones visible.
    title : str, optional
    """
    scene, way = scene_of(response), _way(response)
    frames = _frames(response, instants)
    factor = _magnification(scene, way) if magnification is None else magnification
    outlines = [scene.outlines(i, factor) for i in frames]
    draw = _grid if isinstance(response, AssemblyResponse) else _strip
    figure, panels = draw(scene, outlines, frames)
    peak = float(np.nanmax(np.abs(way[frames])))
    unit, size, digits = ("m", 1.0, 2) if peak >= 0.1 else ("mm", 1000.0, 1)
    sign = "" if isinstance(response, AssemblyResponse) else "+"
    for axes, index, shapes in zip(panels, frames, outlines):
        draw_bodies(axes, scene, shapes)
        far = f"{round(size * way[index], digits) + 0.0:{sign}.{digits}f}".replace("-", "−")
        axes.set_title(f"{scene.time[index]:.2f} s\n{far} {unit}", fontsize=8.5, loc="center")
    said = "" if factor == 1.0 else f" (displacements × {factor:g})"
    figure.suptitle((title or describe(response)) + said, x=0.01, ha="left", fontsize=10.0)
    return figure


def _strip(scene: Scene, outlines: list[list[np.ndarray]], frames: list[int]) -> tuple[Figure, np.ndarray]:
    """Panels in one row, each as wide as what it shows, in one scale."""
    spans = [_span(shape) for shape in outlines]
    floor = min(0.0, *(bottom for *_, bottom in spans))
    widths = [high - low for low, high, _, _ in spans]
    stood = max(float(corners[:, 1].max()) for corners in scene.outlines(0))
    height = max(stood, *(top for _, _, top, _ in spans)) - floor
    # One scale for all panels: as large as the page allows, with room for each panel's words.
    scale = 3.2 / (1.05 * height)
    while sum(max(scale * width, WORDS) for width in widths) > 0.96 * WIDTH and scale * height > 0.2:
        scale *= 0.98
    widths = [max(width, WORDS / scale) for width in widths]
    figure = Figure(figsize=(WIDTH, scale * 1.05 * height + 0.75))
    panels = np.ravel(figure.subplots(1, len(frames), width_ratios=widths))
    for axes, width, (low, high, _, _) in zip(panels, widths, spans):
        middle = 0.5 * (low + high)
        axes.set_xlim(middle - 0.5 * width, middle + 0.5 * width)
        axes.set_ylim(floor - 0.03 * height, floor + 1.02 * height)
        axes.set_anchor("S")
    return figure, panels


def _grid(scene: Scene, outlines: list[list[np.ndarray]], frames: list[int]) -> tuple[Figure, np.ndarray]:
    """Panels with the same view, in as many rows as make them largest."""
    low, high, bottom, top = scene.view(np.array(frames))
    n, width, height = len(frames), high - low, top - bottom

    def scale(across: int) -> float:
        return min(0.96 * WIDTH / across / width, TALLEST / math.ceil(n / across) / height)

    across = max(range(1, n + 1), key=scale)
    down = math.ceil(n / across)
    figure = Figure(figsize=(WIDTH, down * (scale(across) * height + 0.45) + 0.35))
    panels = np.ravel(figure.subplots(down, across))
    for axes in panels:
        axes.set_xlim(low, high)
        axes.set_ylim(bottom, top)
        axes.set_axis_off()
    return figure, panels


def _span(shape: list[np.ndarray]) -> tuple[float, float, float, float]:
    """Left and right end of a panel, with a margin, the highest and the lowest point [m]."""
    corners = np.concatenate(shape)
    corners = corners[np.isfinite(corners).all(axis=1)]
    low, high = float(corners[:, 0].min()), float(corners[:, 0].max())
    margin = 0.35 * (high - low)
    return low - margin, high + margin, float(corners[:, 1].max()), float(corners[:, 1].min())


def _way(response: AnyResponse) -> np.ndarray:
    """How far things have moved at every recorded state [m], shape (T,)."""
    if isinstance(response, AssemblyResponse):
        return response.displacement.max(axis=1)
    return response.histories.top_displacement


def _frames(response: AnyResponse, instants: Sequence[float] | None) -> list[int]:
    recorded = response.time
    if instants is None:
        assembly = isinstance(response, AssemblyResponse)
        return _frames_of_assembly(response) if assembly else _frames_of_column(response)
    for instant in instants:
        if not recorded[0] <= instant <= recorded[-1]:
            raise InputError(
                f"instant {instant:g} s is not recorded; allowed is {recorded[0]:g} to {recorded[-1]:g} s."
            )
    if not len(instants):
        raise InputError("no instant is given to draw; give at least one [s].")
    return [int(np.abs(recorded - instant).argmin()) for instant in instants]


def _frames_of_column(response: Response) -> list[int]:
    h = response.histories
    far = np.nan_to_num(np.abs(h.top_displacement))
    time, last = response.measures.collapse_time, _last_above_ground(response)
    before = far if math.isnan(time) else np.where(h.time <= time, far, 0.0)
    peak = int(before.argmax())
    far[last + 1 :] = before[last + 1 :] = 0.0
    moving = np.flatnonzero(np.abs(far[: last + 1] - far[last]) > 0.1 * before[peak])
    start, end = (int(moving[0]), int(moving[-1])) if moving.size else (0, last)
    start = max(start, int(np.argmax(before > 0.1 * before[peak])))
    edges = np.linspace(start, end + 1, 6).round().astype(int)
    spread = [low + int(far[low:high].argmax()) for low, high in pairwise(edges) if high > low]
    apart = 0.02 * (end - start)
    chosen = sorted({0, peak, *spread}) if last else []
    return [i for i in chosen if last - i > apart] + [last]


def _frames_of_assembly(response: AssemblyResponse) -> list[int]:
    """The start, the end, and states between which the blocks have gone equal ways; the farthest if nothing falls."""
    step = np.hypot(np.diff(response.x, axis=0), np.diff(response.z, axis=0))
    step[response.displacement[1:] > ASIDE * scene_of(response).size] = 0.0  # out of the picture
    gone = np.concatenate(([0.0], np.nan_to_num(step).sum(axis=1).cumsum()))
    last = len(gone) - 1
    chosen = set(np.searchsorted(gone, np.linspace(0.0, gone[-1], 8)[1:-1]).tolist())
    if not response.collapsed:
        chosen.add(int(np.nan_to_num(response.displacement).max(axis=1).argmax()))
    frames = [0]
    for i in sorted(chosen):
        if min(gone[i] - gone[frames[-1]], gone[-1] - gone[i]) > 0.03 * gone[-1]:
            frames.append(i)
    return [*frames, last] if last else frames


def _last_above_ground(response: Response) -> int:
    # A model without contact of what falls with the ground lets it pass: nothing is to be seen from there on.
    heights = response.column.centroid_heights + response.histories.drum_z
    below = np.flatnonzero((heights < 0.0).any(axis=1))
    return max(int(below[0]) - 1, 0) if below.size else len(heights) - 1


def _magnification(scene: Scene, way: np.ndarray) -> float:
    peak = float(np.nanmax(np.abs(way)))
    if peak <= 0.0 or peak > 0.02 * scene.size:
        return 1.0
    wanted = 0.05 * scene.size / peak
    decade = 10.0 ** math.floor(math.log10(wanted))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= wanted)
