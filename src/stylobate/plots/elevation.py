"""A dimensioned elevation: what stands, with heights, widths, drums and joints by number, and what is as found in red."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..column import Column
from ..column.as_found import AS_BUILT, SIDES, AsFound
from ..column.block import FAR_AWAY
from ..column.found_in_space import base_axes
from ..column.links.placed import strokes
from ..column.structure import Structure
from ..constants import DEGREE
from ..messages import digits, joined, say
from .style import BLACK, BLUE, BROWN, GREY, RED, SAND, WIDTH, panel, signed, styled

#: Height of the picture of a column, and most of an assembly's [inch].
TALL = 5.6

#: Most drums whose dimensions are all written; of more, every second, third … is.
WRITTEN = 24

#: Most blocks of an assembly that are named in the picture.
NAMED = 40

#: Size of the words [points].
WORDS = 7.5


@styled
def draw_elevation(structure: Structure, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Structure before the motion, seen along y, in true proportion, with its dimensions in m.

    Of a column: heights of drums and of all, widths (diameters, with ⌀) of both faces of each drum, numbers of drums and
    joints, joints whose friction differs, links in blue. Red are drums that are not where they were built, over
    dashed outlines of the column as built, and what was measured.

    Parameters
    ----------
    structure : Column, Assembly or Specimen
    title : str, optional
        None by default.
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
    outlines, column = outlines_of(structure), structure.stack
    if column is None:
        return _blocks(structure, outlines, title, ax)
    built = outlines_of(column.replace(as_found=AS_BUILT)) if column.as_found else outlines
    figure, axes = panel(ax, (WIDTH, TALL))
    corners = np.concatenate([*outlines, *built])
    low, high = corners.min(axis=0), corners.max(axis=0)
    sheet = Sheet.around(axes, low, high, left=86.0, right=205.0, below=44.0, above=34.0)
    slope = _slope(column)
    axes.axline((0.0, 0.0), slope=math.tan(slope), color=BLACK, linewidth=1.4)
    for i, shape in enumerate(outlines):
        red = column.as_found.displaced(i + 1)
        axes.fill(*shape.T, facecolor="#f7e3df" if red else SAND, edgecolor=RED if red else BROWN, linewidth=0.9)
    if column.as_found:
        for shape in built:
            axes.fill(*shape.T, facecolor="none", edgecolor=GREY, linewidth=0.6, linestyle=(0, (3, 2)))
    _links(axes, sheet, column)
    draw_chain(axes, sheet, levels_of(column), low[0])
    _words_beside(axes, sheet, column, outlines, high[0])
    _width(axes, sheet, column.drums[0].bottom_width, _bottom(outlines[0]), -26.0, column.section)
    _width(axes, sheet, column.drums[-1].top_width, _top(outlines[-1]), 12.0, column.section)
    if slope:
        found = column.as_found
        side = say("the right") if slope > 0.0 else say("the left")
        to = side if found.base_azimuth in (0.0, 180.0) else f"{found.base_azimuth:g}°"
        words = say("base rises by {angle:g}° to {to}", angle=abs(found.base_tilt), to=to)
        axes.annotate(words, (low[0], sheet.up(low[1], -40.0)), color=RED, fontsize=WORDS, ha="left")
    if title:
        axes.set_title(title)
    return figure


def levels_of(column: Column) -> list[float]:
    """Heights of the joints of a column and of its top as built [m]."""
    return [*column.joint_heights.tolist(), column.height]


def outlines_of(structure: Structure) -> list[np.ndarray]:
    """Outlines of all bodies as they stand before the motion, seen along y [m], each of shape (k, 2)."""
    return [body.corners for body in structure.bodies[structure.first :]]


@dataclass(frozen=True)
class Sheet:
    """The paper around what is drawn: how many metres a point of it is."""

    metres: float

    @classmethod
    def around(
        cls,
        axes: Axes,
        low: np.ndarray,
        high: np.ndarray,
        *,
        left: float,
        right: float,
        below: float,
        above: float,
        least: float = 0.0,
    ) -> Sheet:
        """Limits with room for words on each side [points], in true proportion, ``least`` metres a point at least."""
        points = 72.0 / cast(Figure, axes.figure).dpi  # of a pixel; axes may stand in a part of a figure
        wide, tall = axes.bbox.width * points, axes.bbox.height * points
        size = high - low
        metres = max(size[0] / max(wide - left - right, 40.0), size[1] / max(tall - below - above, 40.0), least)
        axes.set_aspect("equal")
        axes.set_axis_off()
        spare = 0.5 * max(wide - left - right - size[0] / metres, 0.0)
        axes.set_xlim(low[0] - metres * (left + spare), high[0] + metres * (right + spare))
        axes.set_ylim(low[1] - metres * below, high[1] + metres * above)
        return cls(metres)

    def up(self, z: float, points: float) -> float:
        """A place so many points above a height, or right of a place [m]."""
        return z + self.metres * points


def draw_chain(axes: Axes, sheet: Sheet, levels: Sequence[float], edge: float) -> None:
    """Chains of dimensions to the left: from level to level, and that of all."""
    chain, far = sheet.up(edge, -26.0), sheet.up(edge, -66.0)
    for z in levels:
        axes.plot([sheet.up(chain, -4.0), sheet.up(edge, -4.0)], [z, z], color=GREY, linewidth=0.4)
        _tick(axes, chain, z)
    axes.plot([chain, chain], [levels[0], levels[-1]], color=BLACK, linewidth=0.6)
    every = math.ceil((len(levels) - 1) / WRITTEN)
    for low, high in list(pairwise(levels))[::every]:
        said = digits(high - low, ".3f")
        axes.text(sheet.up(chain, -3.0), 0.5 * (low + high), said, fontsize=WORDS, ha="right", va="center")
    for z in (levels[0], levels[-1]):
        axes.plot([sheet.up(far, -4.0), sheet.up(chain, -4.0)], [z, z], color=GREY, linewidth=0.4)
        _tick(axes, far, z)
    axes.plot([far, far], [levels[0], levels[-1]], color=BLACK, linewidth=0.6)
    words = {"fontsize": 8.5, "ha": "right", "va": "center", "rotation": 90}
    said = say("{value:.3f} m", value=levels[-1] - levels[0])
    axes.text(sheet.up(far, -3.0), 0.5 * (levels[0] + levels[-1]), said, **words)


def _tick(axes: Axes, x: float, z: float) -> None:
    axes.plot(x, z, marker=(2, 0, -45), color=BLACK, markersize=6, linestyle="none", markeredgewidth=0.9)


def _words_beside(axes: Axes, sheet: Sheet, column: Column, outlines: list[np.ndarray], edge: float) -> None:
    """Numbers of drums in them; widths, and what is as found, to the right; joints by number at their levels."""
    round_ = "⌀ " if column.section == "circular" else ""
    every = math.ceil(column.n / WRITTEN)
    friction = column.friction.tolist()
    usual = max(dict.fromkeys(friction), key=friction.count)
    near, far = sheet.up(edge, 12.0), sheet.up(edge, 62.0)
    tight = column.n > 9
    head = sheet.up(column.height, 4.0)
    axes.text(far, head, say("width below – above [m]"), fontsize=6.5, ha="left", va="bottom", color=GREY)
    for i, (drum, shape) in enumerate(zip(column.drums, outlines)):
        if i % every:
            continue
        middle = shape.mean(axis=0)
        axes.text(float(middle[0]), float(middle[1]), str(i + 1), fontsize=8.0, ha="center", va="center", weight="bold")
        level = float(column.joint_heights[i])
        said = say("joint {number}", number=i + 1)
        if abs(friction[i] - usual) > 1e-9:
            said += say(", μ = {value:.3g}", value=friction[i])
        if column.joints[i].ring_width is not None:
            said += say(", ring {width:g} m", width=column.joints[i].ring_width)
        axes.plot([edge, sheet.up(near, -2.0)], [level, level], color=GREY, linewidth=0.4, linestyle=(0, (1, 1.5)))
        axes.text(near, level, said, fontsize=6.5, ha="left", va="center" if i else "bottom", color=GREY)
        if drum.circular or drum.top_depth is None:
            wide = say("{round}{drum.bottom_width:.3f} – {drum.top_width:.3f}", round=round_, drum=drum)
        else:
            wide = say("{d.bottom_width:.3f} × {d.depth:.3f} – {d.top_width:.3f} × {d.upper_depth:.3f}", d=drum)
        height = level + 0.5 * drum.height
        found = joined(", ", words_of_found(column.as_found, i + 1))
        axes.text(far, height, wide, fontsize=WORDS, ha="left", va="bottom" if found and not tight else "center")
        if found:
            place = (sheet.up(far, 76.0), height) if tight else (far, height)
            axes.text(*place, found, fontsize=7.0, ha="left", va="center" if tight else "top", color=RED)


def _links(axes: Axes, sheet: Sheet, column: Column) -> None:
    """Dowels and bars across their joints, ties and cores from end to end, layers along theirs; at their true x."""

    def draw(x: list[float], z: list[float], marker: str = "", style: Any = "-") -> None:
        axes.plot(x, z, color=BLUE, linewidth=1.8, linestyle=style, marker=marker, markersize=4, zorder=6)

    for link in column.placed_links:
        (x, _, z), (to, _, top) = link.low, link.high
        if link.mark == "sheet":
            half = 0.5 * float(column.joint_widths[link.joint - 1])
            draw([-half, half], [z, z], style=(0, (3, 1.5)))
        elif link.mark == "line":
            draw([x, to], [z, top], "s")
        else:
            reach = link.lift if math.isfinite(link.lift) else 12.0 * sheet.metres
            draw([x, x], [z - reach, z + reach], "_" if link.mark == "anchor" else "")


def _width(axes: Axes, sheet: Sheet, width: float, ends: np.ndarray, away: float, section: str) -> None:
    """A horizontal dimension so many points over or under a face, which runs between two ends [m]."""
    level = sheet.up(float(ends[:, 1].mean()), away)
    for x, z in ends:
        axes.plot([x, x], [z, sheet.up(level, math.copysign(4.0, away))], color=GREY, linewidth=0.4)
        _tick(axes, float(x), level)
    axes.plot(ends[:, 0], [level, level], color=BLACK, linewidth=0.6)
    said = say("{round}{width:.3f} m", round="⌀ " if section == "circular" else "", width=width)
    axes.text(float(ends[:, 0].mean()), sheet.up(level, 3.0), said, fontsize=WORDS, ha="center", va="bottom")


def _bottom(shape: np.ndarray) -> np.ndarray:
    return _ends(shape, shape[:, 1] <= shape[:, 1].min() + 0.25 * np.ptp(shape[:, 1]))


def _top(shape: np.ndarray) -> np.ndarray:
    return _ends(shape, shape[:, 1] >= shape[:, 1].max() - 0.25 * np.ptp(shape[:, 1]))


def _ends(shape: np.ndarray, at: np.ndarray) -> np.ndarray:
    face = shape[at]
    return face[[int(face[:, 0].argmin()), int(face[:, 0].argmax())]]


def words_of_found(found: AsFound, number: int) -> list[str]:
    """State as found of a drum, in words: its offset on what is below, and where that leaves it if elsewhere."""
    drum = found.of(number)
    towards = lambda azimuth: say(" to {azimuth:g}°", azimuth=azimuth) if azimuth else ""  # noqa: E731
    parts = []
    if drum.offset:
        parts.append(
            say("offset {far} mm{to}", far=signed(1000.0 * drum.offset, ".0f"), to=towards(drum.offset_azimuth))
        )
        net, azimuth = found.place(number)
        if not net:
            parts.append(say("back in line"))
        elif any(one.offset for one in found.drums if one.drum < number):
            parts.append(say("in all {far:.0f} mm to {azimuth:.0f}°", far=1000.0 * net, azimuth=azimuth))
    if drum.tilt:
        parts.append(say("lean {angle}°{to}", angle=signed(drum.tilt, "g"), to=towards(drum.tilt_azimuth)))
    if drum.turn:
        parts.append(say("turned {angle}°", angle=signed(drum.turn, "g")))
    at = say(" (right at {azimuth:g}°)", azimuth=drum.chip_azimuth) if drum.chip_azimuth else ""
    parts += [
        say("chip {side} {width:.0f} mm{at}", side=say(side), width=1000.0 * width, at=at)
        for side, width in zip(SIDES, drum.chips, strict=True)
        if width
    ]
    return parts


def _slope(column: Column) -> float:
    """Of the ground in the picture, rising to the right [rad]."""
    if column.as_found.in_plane:
        return column.as_found.base_tilt * DEGREE
    normal = base_axes(column)[:, 2]
    return math.atan2(-float(normal[0]), float(normal[2]))


def _blocks(structure: Structure, shapes: list[np.ndarray], title: str | None, ax: Axes | None) -> Figure:
    """Blocks by name, with width and height of all that can move."""
    near = [shape for shape in shapes if np.ptp(shape, axis=0).max() <= FAR_AWAY]
    corners = np.concatenate(near)
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = high - low
    tall = min(TALL, max(2.6, 0.75 * WIDTH * size[1] / size[0] + 1.2))
    figure, axes = panel(ax, (WIDTH, tall))
    sheet = Sheet.around(axes, low, high, left=60.0, right=24.0, below=40.0, above=18.0)
    if structure.ground is not None:
        axes.axhline(structure.ground, color=BLACK, linewidth=1.4)
    many = len(shapes) > NAMED
    for k, (block, shape) in enumerate(zip(structure.bodies[structure.first :], shapes), 1):
        if np.ptp(shape, axis=0).max() > FAR_AWAY:
            continue
        face, edge = ("#dcdcdc", GREY) if block.fixed else (SAND, BROWN)
        axes.fill(*shape.T, facecolor=face, edgecolor=edge, linewidth=0.9)
        wide, high_ = np.ptp(shape, axis=0) / sheet.metres
        name = str(k) if many else block.name
        if 4.2 * len(name) > max(wide, high_):  # of "column 1, drum 5" the drum
            name = name.rpartition(", ")[2]
        turned = wide < 4.2 * len(name) and high_ > wide
        words = {"fontsize": 6.5 if many else WORDS, "ha": "center", "va": "center", "rotation": 90 if turned else 0}
        middle = _middle(shape)
        axes.text(float(middle[0]), float(middle[1]), name, **words)
    for _, (*_, start), (*_, end) in strokes(structure.placed_links):
        axes.plot([start[0], end[0]], [start[2], end[2]], color=BLUE, linewidth=1.2, zorder=5)
    for link in [one for one in structure.placed_links if one.mark == "sheet"]:
        ends = np.array(link.place)[:, None] + 12.0 * sheet.metres * np.outer(link.along, (-1.0, 1.0))
        axes.plot(*ends, color=BLUE, linewidth=2.4, zorder=5)
    for along, start, end in ((0, low, high), (1, low, high)):
        dimension(axes, sheet, along, start, end)
    if title:
        axes.set_title(title)
    return figure


def _middle(shape: np.ndarray) -> np.ndarray:
    return 0.5 * (shape.min(axis=0) + shape.max(axis=0))


def dimension(axes: Axes, sheet: Sheet, along: int, low: np.ndarray, high: np.ndarray) -> None:
    """Width under the picture (0), or height to its left (1)."""
    if along == 0:
        level = sheet.up(float(low[1]), -20.0)
        axes.plot([low[0], high[0]], [level, level], color=BLACK, linewidth=0.6)
        for x in (float(low[0]), float(high[0])):
            _tick(axes, x, level)
        said = say("{value:.3f} m", value=high[0] - low[0])
        axes.text(0.5 * float(low[0] + high[0]), sheet.up(level, -3.0), said, fontsize=8.5, ha="center", va="top")
        return
    place = sheet.up(float(low[0]), -22.0)
    axes.plot([place, place], [low[1], high[1]], color=BLACK, linewidth=0.6)
    for z in (float(low[1]), float(high[1])):
        _tick(axes, place, z)
    words = {"fontsize": 8.5, "ha": "right", "va": "center", "rotation": 90}
    axes.text(
        sheet.up(place, -3.0), 0.5 * float(low[1] + high[1]), say("{value:.3f} m", value=high[1] - low[1]), **words
    )
