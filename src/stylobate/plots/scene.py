"""Scene of films and film strips: bodies from their shapes and poses, links, the ground, and the words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from ..column.found_geometry import base_axes
from ..column.links.placed import Stroke, strokes
from ..column.shapes import hull
from ..constants import g
from ..errors import InputError
from ..response import Response
from ..response.poses import exaggerated, rotation_matrices
from ..response.recorded import ASIDE, size_of, way_of
from .solids import Solid, Surface, View, painted, surfaces_of
from .style import BLACK, BLUE, BROWN, GREY, RED, SAND

#: A picture goes no farther below what stood at first than by this share of its size, and no farther aside than ``ASIDE``:
#: what flies off, or falls where there is no ground, is let go.
DOWN = 0.75

#: Radius of the ground that is shown in space, over that of what stands on it.
PLATE = 2.6


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies at every recorded state, as they are seen, in metres.

    Parameters
    ----------
    response : Response
    seen_from : View, optional
        Of a response in space; by default everything is seen along y.
    """

    response: Response
    seen_from: View | None = None

    @property
    def name(self) -> str:
        """Of what stood."""
        return self.response.structure.name

    @property
    def sentence(self) -> str:
        """Outcome."""
        return self.response.sentence

    @property
    def time(self) -> np.ndarray:
        """[s], shape (T,)"""
        return self.response.time

    @property
    def shown(self) -> tuple[int, ...]:
        """Bodies in the picture: all but a ground without ends."""
        return self.response.bodies.shown

    @property
    def fixed(self) -> tuple[bool, ...]:
        """Which of the bodies in the picture move with the ground."""
        return tuple(self.response.bodies.fixed[i] for i in self.shown)

    @property
    def level(self) -> float | None:
        """Of the ground at x = 0 [m]; None for no ground."""
        return self.response.bodies.level

    @property
    def slope(self) -> float:
        """Rise of the ground to the right [-]; in space, where its plane cuts that of the picture."""
        if self.seen_from is None:
            return math.tan(self.response.bodies.reference.slope)
        normal = self.base[:, 2]
        return float(-(normal @ self.seen_from.right) / (normal @ self.seen_from.up))

    @cached_property
    def base(self) -> np.ndarray:
        """Axes of the base as columns, z upward [-], shape (3, 3): a base out of level leans."""
        return base_axes(self.response.structure)

    @property
    def upright(self) -> np.ndarray:
        """Rotation of poses, in space of those in the base's axes, into a picture's whose z is upward [-], shape (3, 3)."""
        return self.base if self.response.dims == "xyz" else np.eye(3)

    @property
    def ground(self) -> np.ndarray:
        """Acceleration of the ground along x [g], shape (T,)."""
        return self.response.histories.acceleration[:, 0] / g

    @property
    def ground_across(self) -> np.ndarray | None:
        """Acceleration of the ground along y [g], shape (T,); None in the plane."""
        return self.response.histories.acceleration[:, 1] / g if self.response.dims == "xyz" else None

    def outlines(self, index: int, factor: float = 1.0) -> list[np.ndarray]:
        """Corners of every body at a recorded state, displacements times a factor [m], each of shape (k, 2)."""
        if self.seen_from is None:
            return [self.response.outline(index, i, factor) for i in self.shown]
        points: list[list[np.ndarray]] = [[] for _ in self.shown]
        for (place, _), solid in zip(self.parts, self.solids(index, factor), strict=True):
            points[place].append(self.seen_from.across(solid.vertices))
        return [hull(np.concatenate(some)) for some in points]

    def solids(self, index: int, factor: float = 1.0) -> list[Solid]:
        """Every part of a body in space at a recorded state, displacements and turns times a factor."""
        poses = exaggerated(self.response.poses, index, factor)
        turns = self.upright @ rotation_matrices(poses.orientation)
        places = poses.position @ self.upright.T
        shown = list(self.shown)
        return [Solid(surface, places[shown[k]], turns[shown[k]]) for k, surface in self.parts]

    @cached_property
    def parts(self) -> tuple[tuple[int, Surface], ...]:
        """Surfaces of the convex parts of what is shown, in the axes of their bodies, each with its body's place there."""
        bodies = self.response.bodies
        each = ((k, surfaces_of(bodies.shapes[i], bodies.fixed[i])) for k, i in enumerate(self.shown))
        return tuple((k, surface) for k, surfaces in each for surface in surfaces)

    @cached_property
    def way(self) -> np.ndarray:
        """Displacement [m], shape (T,); of a top in space, to the right."""
        top = self.response.histories.top
        if self.seen_from is None or top is None:
            return way_of(self.response)
        return top @ self.seen_from.right[:2]

    @property
    def signed(self) -> bool:
        """Whether the way has a sign: there is a top that goes to and fro."""
        return self.response.histories.top is not None

    @cached_property
    def size(self) -> float:
        """Larger side of the box around everything that can move, as it stood [m]."""
        return size_of(self.response)

    def view(self, indices: np.ndarray, least: float = 0.0) -> tuple[float, float, float, float]:
        """Left, right, lower and upper end of a picture that holds all these states [m].

        Parameters
        ----------
        indices : array of int
        least : float
            Least width over height [-]; a picture that is narrower is made wider.
        """
        stood = np.concatenate(self._moving(0))
        low, high = stood.min(axis=0) - self.size * np.array([ASIDE, DOWN]), stood.max(axis=0) + ASIDE * self.size
        corners = np.concatenate([np.concatenate(self._moving(int(i))) for i in (0, *indices)])
        corners = corners[((corners >= low) & (corners <= high)).all(axis=1)]
        low, high = corners.min(axis=0), corners.max(axis=0)
        # as much of the supports as is near
        near = 0.25 * (high - low).max()
        supports = [shape for shape, fixed in zip(self.outlines(0), self.fixed, strict=True) if fixed]
        corners = np.concatenate([corners, *(np.clip(shape, low - near, high + near) for shape in supports)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        if self.seen_from is not None and self.seen_from.elevation > 0.0:
            plate = self.seen_from.across(self.plate)
            low, high = np.minimum(low, plate.min(axis=0)), np.maximum(high, plate.max(axis=0))
        if self.level is not None:
            low[1] = min(low[1], max(self.level, low[1] - near))
        margin = 0.05 * max(self.size, (high - low).max())
        low, high = low - margin, high + margin
        aside = max(0.0, 0.5 * (least * (high[1] - low[1]) - (high[0] - low[0])))
        return low[0] - aside, high[0] + aside, low[1], high[1]

    @cached_property
    def plate(self) -> np.ndarray:
        """A round piece of the ground around what stands, in space [m], shape (k, 3)."""
        stood = np.concatenate([solid.vertices for solid in self.solids(0)])
        low = stood[stood[:, 2] < stood[:, 2].min() + 0.05 * np.ptp(stood[:, 2])]
        angle = np.arange(72) * (2.0 * np.pi / 72)
        radius = PLATE * float(np.hypot(*low[:, :2].T).max())
        flat = np.stack((radius * np.cos(angle), radius * np.sin(angle), np.full(72, self.level or 0.0)), axis=1)
        return flat @ self.base.T

    @property
    def directions(self) -> np.ndarray:
        """Arrows along x and y on the ground, from and to, in space [m], shape (2, 2, 3)."""
        radius = float(np.linalg.norm(self.plate[0] - self.plate.mean(axis=0)))
        arrows = self.plate.mean(axis=0) + np.zeros((2, 2, 3))
        for number in range(2):
            arrows[number] += np.outer((0.72, 1.0), radius * self.base[:, number])
        return arrows

    def _moving(self, index: int) -> list[np.ndarray]:
        return [shape for shape, fixed in zip(self.outlines(index), self.fixed, strict=True) if not fixed]


def seen(time: np.ndarray, window: tuple[float, float] | None) -> tuple[float, float]:
    """Beginning and end of what is drawn [s]: a window, or everything that is recorded.

    Raises
    ------
    InputError
        The window is empty, or holds nothing that is recorded.
    """
    first, last = float(time[0]), float(time[-1])
    if window is None:
        return first, last or 1.0
    begin, end = window
    if not begin < end or end <= first or begin >= last:
        raise InputError(
            f"the window from {begin:g} to {end:g} s holds nothing; give two times between {first:g} and {last:g} s, the "
            "earlier first."
        )
    return max(begin, first), min(end, last)


def draw_bodies(axes: Axes, scene: Scene, outlines: list[np.ndarray], linewidth: float = 0.7) -> None:
    """The ground and all bodies, in true proportion."""
    if scene.level is not None:
        axes.axline((0.0, scene.level), slope=scene.slope, color=BLACK, linewidth=1.2)
    for i, (corners, fixed) in enumerate(zip(outlines, scene.fixed, strict=True)):
        face, edge = ("#dcdcdc", GREY) if fixed else (SAND, BROWN)
        axes.fill(corners[:, 0], corners[:, 1], facecolor=face, edgecolor=edge, linewidth=linewidth, zorder=2 + i)
    axes.set_aspect("equal")
    axes.set_axis_off()


def scale_bar(width: float) -> float:
    """A round length of at most a fifth of a picture's width [m]."""
    decade = 10.0 ** math.floor(math.log10(0.2 * width))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= 0.2 * width)


# -- Marks of links in pictures ---------------------------------------------------------------------------------------


class Mark(NamedTuple):
    """The mark of a link: a body by its number and a place in its axes for either end, or no body and a place in space [m].

    ``broken`` is when it broke [s], infinite if it is whole.
    """

    lower: tuple[int | None, np.ndarray]
    upper: tuple[int | None, np.ndarray]
    broken: float


def marks_of(scene: Scene) -> list[Mark]:
    """Marks of every link but layers."""
    structure = scene.response.structure
    broken = {link.name: link.broken_at for link in scene.response.measures.links if link.broken}

    def body(number: int, place: np.ndarray) -> tuple[int | None, np.ndarray]:
        recorded = number - structure.first
        return (recorded, place) if recorded >= 0 else (None, scene.base @ place)

    def mark(one: Stroke) -> Mark:
        return Mark(body(*one.lower[:2]), body(*one.upper[:2]), broken.get(one.link.name, math.inf))

    return [mark(stroke) for stroke in strokes(structure.placed_links)]


def link_marks(scene: Scene, index: int, factor: float = 1.0) -> list[tuple[np.ndarray, bool]]:
    """Ends of every link but layers as seen at a recorded state [m], shape (2, 2), and whether it is broken."""
    marks = marks_of(scene)
    if not marks:
        return []
    poses = exaggerated(scene.response.poses, index, factor)
    turns, places = scene.upright @ rotation_matrices(poses.orientation), poses.position @ scene.upright.T

    def seen(body: int | None, place: np.ndarray) -> np.ndarray:
        point = place if body is None else places[body] + turns[body] @ place
        return point[[0, 2]] if scene.seen_from is None else scene.seen_from.across(point)

    now = scene.response.time[index]
    return [(np.array([seen(*mark.lower), seen(*mark.upper)]), now >= mark.broken) for mark in marks]


def draw_links(axes: Axes, scene: Scene, index: int, factor: float = 1.0) -> None:
    """Mark the links of a state, over the bodies: whole ones in blue, broken ones in red and dotted."""
    for line in [one for one in axes.lines if one.get_gid() == "link"]:
        line.remove()
    for ends, broken in link_marks(scene, index, factor):
        (line,) = axes.plot(
            ends[:, 0], ends[:, 1], color=RED if broken else BLUE, linestyle=":" if broken else "-", linewidth=1.1,
            zorder=900, scalex=False, scaley=False,
        )  # fmt: skip
        line.set_gid("link")


# -- Bodies in space in a frame of a film -----------------------------------------------------------------------------


def draw_solids(axes: Axes, scene: Scene, index: int) -> None:
    """The ground, the directions of x and y on it, and all bodies at a recorded state, in true proportion."""
    view = scene.seen_from
    assert view is not None
    axes.fill(*view.across(scene.plate).T, facecolor="#f4f4f4", edgecolor=GREY, linewidth=0.7, zorder=1)
    for name, (start, end) in zip("xy", scene.directions, strict=True):
        axes.annotate(
            "",
            tuple(view.across(end)),
            xytext=tuple(view.across(start)),
            arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 0.9},
            zorder=2,
        )
        right, up = 1.08 * view.across(end)
        axes.text(float(right), float(up), name, fontsize=8.5, ha="center", va="center", zorder=2)
    axes.add_collection(PolyCollection([], zorder=3), autolim=False)
    axes.set_aspect("equal")
    axes.set_axis_off()
    paint(axes, scene, index)


def paint(axes: Axes, scene: Scene, index: int) -> None:
    """Paint the bodies as they are at another recorded state."""
    assert scene.seen_from is not None
    polygons, colours, outlines = painted(scene.solids(index), scene.seen_from)
    faces = next(collection for collection in axes.collections if isinstance(collection, PolyCollection))
    faces.set_verts(polygons)
    faces.set_facecolor([tuple(colour) for colour in colours])
    faces.set_edgecolor([BROWN if outline else tuple(colour) for outline, colour in zip(outlines, colours)])
    faces.set_linewidth([1.4 if outline else 0.3 for outline in outlines])
