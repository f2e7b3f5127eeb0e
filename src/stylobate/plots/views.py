"""What stands in space before anything is run: elevations from two sides, the plan, and a view from above a corner."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, SubFigure

from ..column.block import FAR_AWAY
from ..column.found_in_space import base_axes, space_geometry
from ..column.links.placed import strokes
from ..column.shapes import hull
from ..column.structure import Body, Structure
from ..column.turning import matrix_of
from ..constants import DEGREE
from ..messages import digits, say
from .elevation import NAMED, WRITTEN, Sheet, dimension, draw_chain, levels_of
from .solids import MARK, STONE, Solid, Surface, painted, painting_order, surface_of
from .style import BLACK, BLUE, GREY, RED, WIDTH, in_lines, page, styled
from .view import ALONG_X, ALONG_Y, OBLIQUE, View

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
SEEN = (
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
    return [one for one in structure.bodies if not (one.fixed and one.size > FAR_AWAY)]


def _proportions(solids: list[Solid]) -> tuple[float, float, list[float]]:
    """Extent along x and along y as drawn [m], and heights of the upper and the lower pictures [inch]."""
    size = np.ptp(np.concatenate([solid.vertices for solid in solids]), axis=0)
    across, up, deep = (max(float(one), 0.05 * float(size.max())) for one in (size[0], size[2], size[1]))
    share = 0.62 * WIDTH / (across + deep)
    return across, deep, [min(max(share * x + 1.0, least), most) for x, (most, least) in ((up, TALL), (deep, LOW))]


def sheet_size(structure: Structure) -> tuple[float, float]:
    """Width and height of :func:`draw_views` [inch]."""
    return WIDTH, sum(_proportions(solids_of(structure)[0])[2])


@dataclass(frozen=True, eq=False)
class Seen:
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
    def of(cls, structure: Structure) -> Seen:
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
    """What stands, before the motion: elevations along x and along y, the plan, and an oblique view, dimensions in m.

    Parameters
    ----------
    structure : Column, Assembly, SpatialAssembly or Specimen
    title : str, optional
        None by default.
    figure : Figure or SubFigure, optional
        Where it is drawn; a new figure by default.
    """
    seen = Seen.of(structure)
    across, deep, heights = _proportions(seen.solids)
    figure = page(figure, (WIDTH, sum(heights)))
    ratio = min(max(across / deep, 0.6), 1.7)
    (front, side), (plan, oblique) = figure.subplots(2, 2, width_ratios=(ratio, 1.0), height_ratios=heights)
    sheets = [seen.sheet(axes, view) for axes, (view, _) in zip((front, side), SEEN)]
    scale = max(sheet.metres for sheet in sheets)
    for axes, (view, said) in zip((front, side, plan), SEEN):
        seen.draw(axes, seen.sheet(axes, view, 0.0 if view is PLAN else scale), view)
        axes.set_title(said, fontsize=8.5, color=GREY)
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
    bodies = [one for one in _near(structure) if not one.fixed]
    ends = [end for one in bodies for part in one.placed for end in _ends(part.mesh().vertices[:, 2])]
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
            said = digits(end - start, ".3f")
            axes.text(0.5 * (start + end), place, said, fontsize=6.5, ha="center", va="center", bbox=paper)


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


def _mark_found(axes: Axes, seen: Seen, view: View) -> None:
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
    bearing = {name: max((k for k, one in enumerate(names) if one == name), key=size.__getitem__) for name in names}
    for place, number in enumerate(order):
        if bearing[names[number]] != number:
            continue
        shape = shapes[number]
        wide, high = np.ptp(shape, axis=0) / sheet.metres
        name = next((one for one in _shorter(names[number]) if 4.2 * len(one) <= max(wide, high)), None)
        if name is None or min(wide, high) < LEAST:
            continue
        turned = 90 if wide < 4.2 * len(name) else 0
        middle = 0.5 * (shape.min(axis=0) + shape.max(axis=0))
        half = 2.0 * len(name) * sheet.metres
        ends = middle + np.outer((-half, 0.0, half), (0.0, 1.0) if turned else (1.0, 0.0))
        if any(_covers(shapes[other], end) for other in order[place + 1 :] for end in ends):
            continue
        x, y = (float(one) for one in middle)
        axes.text(x, y, name, fontsize=6.5, ha="center", va="center", rotation=turned, zorder=5)


def _shorter(name: str) -> list[str]:
    """A name, and what is left of it where there is little room: of "column 1, drum 5" the drum, then its number."""
    own = name.rpartition(", ")[2]
    return [name, own, *([own.removeprefix("drum ")] if own.startswith("drum ") else [])]


def _covers(shape: np.ndarray, point: np.ndarray) -> bool:
    """Whether a point lies in a convex polygon, counter-clockwise."""
    side, way = np.roll(shape, -1, axis=0) - shape, point - shape
    return bool((side[:, 0] * way[:, 1] - side[:, 1] * way[:, 0] > 0.0).all())
