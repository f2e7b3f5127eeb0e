"""What stands before anything is run, dimensioned: elevations, views in space, and plans of its joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, SubFigure

from ..column import Column
from ..column.as_found import AS_BUILT, IN_LINE, SIDES, AsFound
from ..column.block import FAR_AWAY
from ..column.found_geometry import base_axes, rotation, space_geometry
from ..column.links.placed import strokes
from ..column.shapes import cut, hull, matrix_of
from ..column.spatial.touching import SpaceJoint
from ..column.structure import Body, Structure
from ..constants import DEGREE
from ..messages import digits, joined, say
from .scene import ALONG_X, ALONG_Y, MARK, OBLIQUE, STONE, Solid, Surface, View, painted, painting_order, surface_of
from .style import BLACK, BLUE, BROWN, GREY, RED, SAND, WIDTH, in_lines, page, panel, signed, styled

#: Height of the picture of a column, and most of an assembly's [inch].
ELEVATION_HEIGHT = 5.6

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
    """
    outlines, column = outlines_of(structure), structure.stack
    if column is None:
        return _blocks(structure, outlines, title, ax)
    built = outlines_of(column.replace(as_found=AS_BUILT)) if column.as_found else outlines
    figure, axes = panel(ax, (WIDTH, ELEVATION_HEIGHT))
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
        as_found = column.as_found
        side = say("the right") if slope > 0.0 else say("the left")
        to = side if as_found.base_azimuth in (0.0, 180.0) else f"{as_found.base_azimuth:g}°"
        words = say("base rises by {angle:g}° to {to}", angle=abs(as_found.base_tilt), to=to)
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
        text = digits(high - low, ".3f")
        axes.text(sheet.up(chain, -3.0), 0.5 * (low + high), text, fontsize=WORDS, ha="right", va="center")
    for z in (levels[0], levels[-1]):
        axes.plot([sheet.up(far, -4.0), sheet.up(chain, -4.0)], [z, z], color=GREY, linewidth=0.4)
        _tick(axes, far, z)
    axes.plot([far, far], [levels[0], levels[-1]], color=BLACK, linewidth=0.6)
    words = {"fontsize": 8.5, "ha": "right", "va": "center", "rotation": 90}
    text = say("{value:.3f} m", value=levels[-1] - levels[0])
    axes.text(sheet.up(far, -3.0), 0.5 * (levels[0] + levels[-1]), text, **words)


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
        label = say("joint {number}", number=i + 1)
        if abs(friction[i] - usual) > 1e-9:
            label += say(", μ = {value:.3g}", value=friction[i])
        if column.joints[i].ring_width is not None:
            label += say(", ring {width:g} m", width=column.joints[i].ring_width)
        axes.plot([edge, sheet.up(near, -2.0)], [level, level], color=GREY, linewidth=0.4, linestyle=(0, (1, 1.5)))
        axes.text(near, level, label, fontsize=6.5, ha="left", va="center" if i else "bottom", color=GREY)
        if drum.circular or drum.top_depth is None:
            wide = say("{round}{drum.bottom_width:.3f} – {drum.top_width:.3f}", round=round_, drum=drum)
        else:
            wide = say("{d.bottom_width:.3f} × {d.depth:.3f} – {d.top_width:.3f} × {d.upper_depth:.3f}", d=drum)
        height = level + 0.5 * drum.height
        found_words = joined(", ", words_of_found(column.as_found, i + 1))
        axes.text(far, height, wide, fontsize=WORDS, ha="left", va="bottom" if found_words and not tight else "center")
        if found_words:
            place = (sheet.up(far, 76.0), height) if tight else (far, height)
            axes.text(*place, found_words, fontsize=7.0, ha="left", va="center" if tight else "top", color=RED)


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
    text = say("{round}{width:.3f} m", round="⌀ " if section == "circular" else "", width=width)
    axes.text(float(ends[:, 0].mean()), sheet.up(level, 3.0), text, fontsize=WORDS, ha="center", va="bottom")


def _bottom(shape: np.ndarray) -> np.ndarray:
    return _width_where(shape, shape[:, 1] <= shape[:, 1].min() + 0.25 * np.ptp(shape[:, 1]))


def _top(shape: np.ndarray) -> np.ndarray:
    return _width_where(shape, shape[:, 1] >= shape[:, 1].max() - 0.25 * np.ptp(shape[:, 1]))


def _width_where(shape: np.ndarray, at: np.ndarray) -> np.ndarray:
    face = shape[at]
    return face[[int(face[:, 0].argmin()), int(face[:, 0].argmax())]]


def words_of_found(as_found: AsFound, number: int) -> list[str]:
    """State as found of a drum, in words: its offset on what is below, and where that leaves it if elsewhere."""
    drum = as_found.of(number)
    towards = lambda azimuth: say(" to {azimuth:g}°", azimuth=azimuth) if azimuth else ""  # noqa: E731
    parts = []
    if drum.offset:
        parts.append(
            say("offset {far} mm{to}", far=signed(1000.0 * drum.offset, ".0f"), to=towards(drum.offset_azimuth))
        )
        net, azimuth = as_found.place(number)
        if not net:
            parts.append(say("back in line"))
        elif any(lower.offset for lower in as_found.drums if lower.drum < number):
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
    tall = min(ELEVATION_HEIGHT, max(2.6, 0.75 * WIDTH * size[1] / size[0] + 1.2))
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
        middle = 0.5 * (shape.min(axis=0) + shape.max(axis=0))
        axes.text(float(middle[0]), float(middle[1]), name, **words)
    for _, (*_, start), (*_, end) in strokes(structure.placed_links):
        axes.plot([start[0], end[0]], [start[2], end[2]], color=BLUE, linewidth=1.2, zorder=5)
    for link in [placed for placed in structure.placed_links if placed.mark == "sheet"]:
        ends = np.array(link.place)[:, None] + 12.0 * sheet.metres * np.outer(link.along, (-1.0, 1.0))
        axes.plot(*ends, color=BLUE, linewidth=2.4, zorder=5)
    for along, start, end in ((0, low, high), (1, low, high)):
        dimension(axes, sheet, along, start, end)
    if title:
        axes.set_title(title)
    return figure


def dimension(axes: Axes, sheet: Sheet, along: int, low: np.ndarray, high: np.ndarray) -> None:
    """Width under the picture (0), or height to its left (1)."""
    if along == 0:
        level = sheet.up(float(low[1]), -20.0)
        axes.plot([low[0], high[0]], [level, level], color=BLACK, linewidth=0.6)
        for x in (float(low[0]), float(high[0])):
            _tick(axes, x, level)
        text = say("{value:.3f} m", value=high[0] - low[0])
        axes.text(0.5 * float(low[0] + high[0]), sheet.up(level, -3.0), text, fontsize=8.5, ha="center", va="top")
        return
    place = sheet.up(float(low[0]), -22.0)
    axes.plot([place, place], [low[1], high[1]], color=BLACK, linewidth=0.6)
    for z in (float(low[1]), float(high[1])):
        _tick(axes, place, z)
    words = {"fontsize": 8.5, "ha": "right", "va": "center", "rotation": 90}
    axes.text(
        sheet.up(place, -3.0), 0.5 * float(low[1] + high[1]), say("{value:.3f} m", value=high[1] - low[1]), **words
    )


# -- What stands in space before anything is run ----------------------------------------------------------------------


#: From above, x to the right and y upward.
PLAN = View(-0.5 * math.pi, 0.5 * math.pi)

#: Most and least height of the upper pictures [inch], and of the lower ones.
TALL, LOW = (4.6, 1.8), (3.2, 1.6)

#: Corners of a circle where it is measured, and room for two chains of dimensions [points].
ROUND, CHAINS = 720, 84.0

#: Least height of what is named in it [points].
LEAST = 5.5

#: What is nearer to the ground than this stands on it [m], and most feet whose distances are written.
FOOT, MOST_FEET = 2e-3, 12

#: A ground farther below what stands than this is left out of a picture [m].
BESIDE = 5.0


#: Elevations and plan, with what is said of each.
VIEWS = (
    (ALONG_X, say("along y: x to the right")),
    (ALONG_Y, say("against x: y to the right")),
    (PLAN, say("plan: x to the right, y upward")),
)


def solids_of(structure: Structure) -> tuple[list[Solid], list[str]]:
    """Parts of the bodies as they stand, as solids to be painted, and the names of their bodies; no ground."""
    named = [(body.name, body.fixed, part) for body in _near(structure) for part in body.placed]
    solids = [
        Solid(_plain(surface_of(part.shape, fixed)), np.array(part.place), matrix_of(part.orientation))
        for _, fixed, part in named
    ]
    return solids, [name for name, *_ in named]


def _near(structure: Structure) -> list[Body]:
    """Bodies that are drawn: all but a ground without ends."""
    return [body for body in structure.bodies if not (body.fixed and body.size > FAR_AWAY)]


def _proportions(solids: list[Solid]) -> tuple[float, float, list[float]]:
    """Extent along x and along y as drawn [m], and heights of the upper and the lower pictures [inch]."""
    size = np.ptp(np.concatenate([solid.vertices for solid in solids]), axis=0)
    across, up, deep = (max(float(extent), 0.05 * float(size.max())) for extent in (size[0], size[2], size[1]))
    share = 0.62 * WIDTH / (across + deep)
    return across, deep, [min(max(share * x + 1.0, least), most) for x, (most, least) in ((up, TALL), (deep, LOW))]


@dataclass(frozen=True, eq=False)
class StructureViews:
    """A structure as elevations and plans show it.

    Parameters
    ----------
    structure : Structure
    solids : list of Solid
        Parts of its bodies as they stand.
    names : list of str
        Of the body of each.
    ends : array
        Points of their outlines [m], round ones finely enough to be measured, shape (k, 3).
    levels : list of float
        Heights that are dimensioned [m].
    """

    structure: Structure
    solids: list[Solid]
    names: list[str]
    ends: np.ndarray
    levels: list[float]

    @classmethod
    def of(cls, structure: Structure) -> StructureViews:
        """A structure that is to be drawn."""
        solids, names = solids_of(structure)
        ends = np.concatenate([part.mesh(ROUND).vertices for body in _near(structure) for part in body.placed])
        levels = _levels(structure) if structure.stack is None else levels_of(structure.stack)
        return cls(structure, solids, names, ends, levels)

    def _ground(self, view: View) -> float | None:
        return None if view is PLAN else self.structure.ground

    def margins(self, view: View) -> dict[str, float]:
        """Room around what is seen for dimensions and words [points]."""
        return {
            "left": CHAINS if view is ALONG_X and len(self.levels) > 2 else 46.0,
            "right": 8.0,
            "below": 34.0,
            "above": 8.0,
        }

    def box(self, view: View) -> tuple[np.ndarray, np.ndarray]:
        """Corners of the box around what is seen, and around the ground where it is near [m], shape (2,) each."""
        flat = np.concatenate([view.across(solid.vertices) for solid in self.solids])
        low, high = flat.min(axis=0), flat.max(axis=0)
        level = self._ground(view)
        if level is not None:
            low[1] = min(low[1], max(level, low[1] - BESIDE))
        return low, high

    def sheet(self, axes: Axes, view: View, least: float = 0.0) -> Sheet:
        """Limits of axes around what is seen, ``least`` metres a point at least."""
        return Sheet.around(axes, *self.box(view), **self.margins(view), least=least)

    def draw(self, axes: Axes, sheet: Sheet, view: View) -> None:
        """An elevation or the plan, with dimensions in m and names."""
        level = self._ground(view)
        if level is not None:
            axes.axhline(level, color=BLACK, linewidth=1.2, zorder=0)
        _paint(axes, self.solids, view)
        _mark_found(axes, self, view)
        _mark_links(axes, self.structure, view)
        flat = view.across(self.ends)
        low, high = flat.min(axis=0), flat.max(axis=0)
        dimension(axes, sheet, 0, low, high)
        _feet(axes, sheet, self.structure, view, float(low[1]))
        if len(self.levels) > 2 and view is ALONG_X:
            draw_chain(axes, sheet, self.levels, float(low[0]))
        else:
            if view is not PLAN:  # one height from every side, whatever leans
                low[1] = self.levels[0] if self.structure.stack is not None else high[1] - self.structure.height
                high[1] = low[1] + self.structure.height
            dimension(axes, sheet, 1, low, high)
        if len(set(self.names)) <= NAMED:
            _names(axes, sheet, self.solids, self.names, view)


@styled
def draw_views(structure: Structure, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """What stands, before the motion: elevations along x and along y, the plan, and an oblique view, dimensions in m."""
    seen = StructureViews.of(structure)
    across, deep, heights = _proportions(seen.solids)
    figure = page(figure, (WIDTH, sum(heights)))
    ratio = min(max(across / deep, 0.6), 1.7)
    (front, side), (plan, oblique) = figure.subplots(2, 2, width_ratios=(ratio, 1.0), height_ratios=heights)
    sheets = [seen.sheet(axes, view) for axes, (view, _) in zip((front, side), VIEWS)]
    scale = max(sheet.metres for sheet in sheets)
    for axes, (view, caption) in zip((front, side, plan), VIEWS):
        seen.draw(axes, seen.sheet(axes, view, 0.0 if view is PLAN else scale), view)
        axes.set_title(caption, fontsize=8.5, color=GREY)
    _mark_north(plan, structure)
    _paint(oblique, seen.solids, OBLIQUE)
    _mark_links(oblique, structure, OBLIQUE)
    oblique.set_aspect("equal")
    oblique.autoscale_view()
    oblique.set_axis_off()
    if title:
        figure.suptitle(in_lines(title), x=0.02, ha="left")
    return figure


def _levels(structure: Structure) -> list[float]:
    """Heights of the undersides and tops of bodies that can move, each once [m]; none of more than are written."""
    bodies = [body for body in _near(structure) if not body.fixed]
    ends = [end for body in bodies for part in body.placed for end in _ends(part.mesh().vertices[:, 2])]
    levels = sorted(dict.fromkeys(round(end, 3) for end in ends))
    return levels if len(levels) <= WRITTEN + 1 else []


def _ends(values: np.ndarray) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _feet(axes: Axes, sheet: Sheet, structure: Structure, view: View, edge: float) -> None:
    """From axis to axis of what stands on the ground, under an elevation; the width of the foot of one alone."""
    if view is PLAN or (structure.ground is None and structure.stack is None):
        return
    level = structure.ground or 0.0
    feet = []
    for body in _near(structure):
        points = np.concatenate([part.mesh(ROUND).vertices for part in body.placed])
        if not body.fixed and abs(float(points[:, 2].min()) - level) < FOOT:
            feet.append(_ends(view.across(points[points[:, 2] < level + FOOT])[:, 0]))
    middles = sorted(dict.fromkeys(round(0.5 * sum(ends), 3) for ends in feet))
    marks = middles if len(middles) > 1 else sorted(feet[0]) if feet else []
    if 1 < len(marks) <= MOST_FEET:
        place = sheet.up(edge, -10.0)
        for start, end in pairwise(marks):
            line = {"arrowstyle": "|-|,widthA=0.2,widthB=0.2", "lw": 0.6, "shrinkA": 0, "shrinkB": 0}
            axes.annotate("", (start, place), (end, place), arrowprops=line)
            paper = {"pad": 0.6, "facecolor": "white", "edgecolor": "none"}
            text = digits(end - start, ".3f")
            axes.text(0.5 * (start + end), place, text, fontsize=6.5, ha="center", va="center", bbox=paper)


def _plain(surface: Surface) -> Surface:
    """The surface without the mark that shows how a body has turned: nothing has."""
    return Surface(surface.vertices, surface.faces, tuple(STONE if tone == MARK else tone for tone in surface.tones))


def _paint(axes: Axes, solids: list[Solid], view: View) -> None:
    polygons, colours, outlines = painted(solids, view)
    edges = np.where(np.array(outlines)[:, None], 0.35, colours)
    widths = [0.9 if outline else 0.2 for outline in outlines]
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=edges, linewidths=widths, zorder=2))


def _mark_links(axes: Axes, structure: Structure, view: View) -> None:
    """Lines for links, over the bodies, where these stand."""
    column = structure.stack
    at, base = (None, None) if column is None else (space_geometry(column), base_axes(column))

    def place(end: tuple[int, np.ndarray, np.ndarray]) -> np.ndarray:
        """Of an end, by its body of a column as found [m]."""
        number, own, drawn = end
        if at is None or base is None:
            return drawn
        return base @ (own if number == 0 else at.centroid[number - 1] + at.axes[number - 1] @ own)

    for stroke in strokes(structure.placed_links):
        ends = view.across(np.array([place(stroke.lower), place(stroke.upper)]))
        axes.plot(ends[:, 0], ends[:, 1], color=BLUE, linewidth=1.2, zorder=4, scalex=False, scaley=False)


def _mark_north(plan: Axes, structure: Structure) -> None:
    """An arrow to north beside the plan, where that is stated: x points so far clockwise from it."""
    if structure.north is None:
        return
    way = 22.0 * math.cos(structure.north * DEGREE), 22.0 * math.sin(structure.north * DEGREE)
    arrow = {"arrowstyle": "<-", "lw": 1.0, "color": BLACK, "shrinkB": 0}
    words = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center", "va": "center"}
    plan.annotate("N", (0.93, 0.9), way, arrowprops=arrow, fontsize=8, annotation_clip=False, **words)


def _mark_found(axes: Axes, seen: StructureViews, view: View) -> None:
    """Red outlines of drums that are not where they were built, and of those that are chipped."""
    column = seen.structure.stack
    if column is None or view is PLAN:
        return
    names = {
        f"drum {i}" for i in range(1, column.n + 1) if column.as_found.displaced(i) or column.as_found.of(i).chipped
    }
    for solid, name in zip(seen.solids, seen.names, strict=True):
        if name in names:
            outline = hull(view.across(solid.vertices))
            axes.fill(*outline.T, facecolor="none", edgecolor=RED, linewidth=1.1, zorder=3)


def _names(axes: Axes, sheet: Sheet, solids: list[Solid], names: list[str], view: View) -> None:
    """Names, or what is left of them, where they fit into what is seen of their body."""
    order = painting_order(solids, view)
    shapes = [hull(view.across(solid.vertices)) for solid in solids]
    size = {number: float(np.prod(np.ptp(shape, axis=0))) for number, shape in enumerate(shapes)}
    # of the parts of one body the largest bears its name
    bearing = {name: max((k for k, owner in enumerate(names) if owner == name), key=size.__getitem__) for name in names}
    for place, number in enumerate(order):
        if bearing[names[number]] != number:
            continue
        shape = shapes[number]
        wide, high = np.ptp(shape, axis=0) / sheet.metres
        name = next(
            (candidate for candidate in _shorter(names[number]) if 4.2 * len(candidate) <= max(wide, high)), None
        )
        if name is None or min(wide, high) < LEAST:
            continue
        turned = 90 if wide < 4.2 * len(name) else 0
        middle = 0.5 * (shape.min(axis=0) + shape.max(axis=0))
        half = 2.0 * len(name) * sheet.metres
        ends = middle + np.outer((-half, 0.0, half), (0.0, 1.0) if turned else (1.0, 0.0))
        if any(_covers(shapes[other], end) for other in order[place + 1 :] for end in ends):
            continue
        x, y = (float(coordinate) for coordinate in middle)
        axes.text(x, y, name, fontsize=6.5, ha="center", va="center", rotation=turned, zorder=5)


def _shorter(name: str) -> list[str]:
    """A name, and what is left of it where there is little room: of "column 1, drum 5" the drum, then its number."""
    own = name.rpartition(", ")[2]
    return [name, own, *([own.removeprefix("drum ")] if own.startswith("drum ") else [])]


def _covers(shape: np.ndarray, point: np.ndarray) -> bool:
    """Whether a point lies in a convex polygon, counter-clockwise."""
    side, way = np.roll(shape, -1, axis=0) - shape, point - shape
    return bool((side[:, 0] * way[:, 1] - side[:, 1] * way[:, 0] > 0.0).all())


# -- Plans of joints before the motion --------------------------------------------------------------------------------


#: Joints beside one another and height of a row of them [inch], of few and of many, and most joints that are drawn.
FEW, MANY, MOST = (4, 2.15), (6, 1.6), 30

#: From line to line of the words under a plan [points].
LINE = 8.2

#: Corners of a circle.
AROUND = 120


@dataclass(frozen=True, eq=False)
class JointPlan:
    """Faces of one joint, in its axes from a common origin [m].

    Parameters
    ----------
    below, above : array or None
        Corners of the upper face of what is below and of the lower face of what is above, shape (k, 2); None of a base.
    caption : str
        Sizes.
    as_found : str
        What is as found.
    links : tuple of (float, float)
        Where links cross it.
    offset : (float, float)
        Of the middle of the face above.
    """

    title: str
    below: np.ndarray | None
    above: np.ndarray
    caption: str = ""
    as_found: str = ""
    links: tuple[tuple[float, float], ...] = ()
    offset: tuple[float, float] = (0.0, 0.0)
    marked: bool = False


def joint_plans(structure: Structure) -> list[JointPlan]:
    """Plans of the joints of a column or of an assembly in space; those of one in the plane are lines and have none."""
    if structure.stack is not None:
        return _of_column(structure.stack)
    plans = []
    for number, joint in enumerate(structure.space_joints or (), 1):
        names = [structure.bodies[body].name for body in (joint.lower, joint.upper)]
        corners = []
        for face in (joint.below, joint.above):
            points = face.middle + np.pad(face.corners, ((0, 0), (0, 1))) @ face.frame.T
            corners.append(((points - joint.origin) @ joint.frame)[:, :2])
        on_ground = structure.ground is not None and joint.lower == 0
        pair = {joint.lower, joint.upper}
        links = [link for link in structure.placed_links if {link.lower, link.upper} == pair and not link.straight]
        crossing = [((np.array(link.middle) - joint.origin) @ joint.frame)[:2] for link in links]
        subtitle = f"{names[0]} –\n{names[1]}" if len("".join(names)) > 18 else f"{names[0]} – {names[1]}"
        sizes, words, offset = _of_round_faces(joint, on_ground)
        subtitle += f"\n{sizes}" * bool(sizes)
        below = None if on_ground else corners[0]
        plan = JointPlan(say("joint {number}", number=number), below, corners[1], subtitle, words, _pairs(crossing))
        plans.append(replace(plan, offset=offset, marked=bool(words)))
    return plans


def _of_round_faces(joint: SpaceJoint, on_ground: bool) -> tuple[str, str, tuple[float, float]]:
    """Diameters, what is off or lost where round faces meet, and by how much in the joint's axes [m]."""
    discs = [face.edges.discs for face in (joint.below, joint.above)]
    if len(discs[1]) != 1 or (not on_ground and len(discs[0]) != 1):
        return "", "", (0.0, 0.0)
    radii = [0.0 if not face_discs else face_discs[0][1] for face_discs in discs]
    same = on_ground or abs(radii[0] - radii[1]) < IN_LINE
    sizes = f"⌀ {2.0 * radii[1]:.3f}" + ("" if same else f" on ⌀ {2.0 * radii[0]:.3f}") + " m"
    words, off = [], (0.0, 0.0)
    if not on_ground:
        moved = joint.above.middle - joint.below.middle
        if math.hypot(*moved[:2]) >= IN_LINE:
            words.append(
                say(
                    "offset {far:.0f} mm to {azimuth:.0f}°",
                    far=1000.0 * math.hypot(*moved[:2]),
                    azimuth=_azimuth(moved),
                )
            )
            ((x, y),) = _pairs([((joint.above.middle - joint.origin) @ joint.frame)[:2]])
            off = x, y
    for normal, bound in joint.above.edges.sides:
        lost, towards = radii[1] - bound, joint.above.frame[:, :2] @ normal
        words.append(say("chip {far:.0f} mm to {azimuth:.0f}°", far=1000.0 * lost, azimuth=_azimuth(towards)))
    return sizes, joined("\n", words), off


def _azimuth(way: np.ndarray) -> float:
    """From x towards y [degrees]."""
    return math.degrees(math.atan2(way[1], way[0])) % 360.0


def _of_column(column: Column) -> list[JointPlan]:
    at, plans = space_geometry(column), []
    for j, drum in enumerate(column.drums):
        found_drum, middle = column.as_found.of(j + 1), at.offset[j]
        above = _face(drum.circular, drum.bottom_width, drum.depth, float(at.turned[j])) + middle
        if found_drum.chipped:
            turn = rotation(np.array([0.0, 0.0, 1.0]), float(at.turned[j]) + found_drum.chip_azimuth * DEGREE)[:2, :2]
            half = (0.5 * drum.bottom_width, 0.5 * (drum.bottom_width if drum.circular else drum.depth))
            for axis, sign, chip in ((0, -1, 0), (0, 1, 1), (1, -1, 2), (1, 1, 3)):
                normal = sign * turn[:, axis]
                above = cut(above, normal, float(normal @ middle) + half[axis] - found_drum.chips[chip])
        below, subtitle = None, _size(drum.circular, drum.bottom_width, drum.depth)
        if j:
            lower = column.drums[j - 1]
            below = _face(lower.circular, lower.top_width, lower.upper_depth, float(at.turned[j - 1]))
            if (lower.top_width, lower.upper_depth) != (drum.bottom_width, drum.depth):
                subtitle += f" on {_size(lower.circular, lower.top_width, lower.upper_depth)}"
        turn = rotation(np.array([0.0, 0.0, 1.0]), float(at.turned[j]))[:2, :2]
        crossing = [link for link in column.placed_links if link.crosses(j) and link.mark != "sheet"]
        places = [middle + turn @ np.array(link.middle[:2]) for link in crossing]
        found_words = joined("\n", words_of_found(column.as_found, j + 1))
        offset = float(middle[0]), float(middle[1])
        title = say("joint {number}", number=j + 1)
        plans.append(
            JointPlan(title, below, above, subtitle + " m", found_words, _pairs(places), offset, bool(found_words))
        )
    return plans


def _pairs(places: Sequence[np.ndarray]) -> tuple[tuple[float, float], ...]:
    return tuple((float(x), float(y)) for x, y in places)


def _face(circular: bool, width: float, depth: float, turned: float) -> np.ndarray:
    if circular:
        angle = np.arange(AROUND) * (2.0 * math.pi / AROUND)
        return 0.5 * width * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    corners = 0.5 * np.array([[-width, -depth], [width, -depth], [width, depth], [-width, depth]])
    return corners @ rotation(np.array([0.0, 0.0, 1.0]), turned)[:2, :2].T


def _size(circular: bool, width: float, depth: float) -> str:
    return f"⌀ {width:.3f}" if circular else f"{width:.3f} × {depth:.3f}"


@styled
def draw_sheet(structure: Structure, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """What stands, before the motion: :func:`draw_views`, and under it the plan of every joint, x to the right.

    The face above is sand, that below a dashed line; what is as found is red, links are blue.
    """
    plans = joint_plans(structure)
    shown = plans[:MOST]
    wide, high = WIDTH, sum(_proportions(solids_of(structure)[0])[2])
    beside, row = FEW if len(shown) <= 12 else MANY
    rows = -(-len(shown) // beside)
    row += LINE / 72.0 * max([0, *(lines_under(plan) - 2 for plan in shown)])
    if not rows:
        return draw_views(structure, title, figure=figure)
    figure = page(figure, (wide, high + row * rows + 0.3))
    parts: Any = figure.subfigures(2, 1, height_ratios=(high, row * rows + 0.3))
    above, below = parts
    draw_views(structure, title, figure=above)
    left_out = "" if len(plans) <= MOST else f"; joints {MOST + 1} to {len(plans)} are not drawn"
    heading = f"plans of joints, {plan_axes(structure)}{left_out}"
    below.suptitle(heading, x=0.02, ha="left", fontsize=8.5, color=GREY, weight="normal")
    panels = below.subplots(rows, beside, squeeze=False)
    for axes, plan, half in zip(panels.flat, shown, plan_reach(structure, shown)):
        draw_plan(axes, plan, half)
    for axes in panels.flat[len(shown) :]:
        axes.set_axis_off()
    return figure


def plan_axes(structure: Structure) -> str:
    """Which way plans of joints lie, and the slope of the base, in words."""
    seen = "each along its own axes" if structure.stack is None else "x to the right, y upward"
    tilt = structure.as_found.base_tilt
    rise = f"; the base rises by {abs(tilt):g}° to {structure.as_found.base_azimuth + 180.0 * (tilt < 0.0):g}°"
    return f"{seen}{rise}" if tilt else seen


def plan_reach(structure: Structure, plans: Sequence[JointPlan]) -> list[float]:
    """Half the side of the square around each plan [m]; of a column one for all, so that they can be laid on one another."""
    faces = [[_centred(plan), *([] if plan.below is None else [plan.below])] for plan in plans]
    each = [1.06 * float(np.abs(np.concatenate(outlines)).max()) for outlines in faces]
    return [max(each)] * len(each) if structure.stack is not None else each


def lines_under(plan: JointPlan) -> int:
    """Lines of words under a plan."""
    return sum(1 + words.count("\n") for words in (plan.caption, plan.as_found) if words)


def _centred(plan: JointPlan) -> np.ndarray:
    """The face above, from the middle of the picture [m]: its own where there is none below."""
    return plan.above if plan.below is not None else plan.above - _centre(plan.above)


def _centre(corners: np.ndarray) -> np.ndarray:
    return 0.5 * (corners.min(axis=0) + corners.max(axis=0))


def draw_plan(axes: Axes, plan: JointPlan, half: float) -> None:
    """One plan in the middle of a square of twice ``half`` [m]."""
    face, edge = ("#f7e3df", RED) if plan.marked else (SAND, BROWN)
    axes.fill(*plan.above.T, facecolor=face, edgecolor=edge, linewidth=0.8)
    if plan.below is not None:
        axes.fill(*plan.below.T, facecolor="none", edgecolor=GREY, linewidth=0.7, linestyle=(0, (4, 2)))
    for start, end in (((-half, 0.0), (half, 0.0)), ((0.0, -half), (0.0, half))):
        axes.plot(*zip(start, end), color=GREY, linewidth=0.35, linestyle=(0, (8, 2, 1, 2)))
    if plan.marked and any(plan.offset):
        axes.plot(*plan.offset, "+", color=RED, markersize=7, markeredgewidth=1.0)
    for x, y in plan.links:
        axes.plot(x, y, "s", color=BLUE, markersize=3.5)
    axes.set_aspect("equal")
    middle = _centre(plan.above) if plan.below is None else np.zeros(2)
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_axis_off()
    axes.set_title(plan.title, fontsize=8.0, weight="bold")
    lines = 0
    for words, colour in ((plan.caption, "black"), (plan.as_found, RED)):
        if words:
            place = {"xycoords": "axes fraction", "xytext": (0.0, -2.0 - LINE * lines), "textcoords": "offset points"}
            axes.annotate(words, (0.5, 0.0), **place, ha="center", va="top", fontsize=6.5, color=colour)
            lines += 1 + words.count("\n")
