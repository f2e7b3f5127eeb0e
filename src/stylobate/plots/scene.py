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
from ..column.shapes import Chipped, CircularFrustum, Glued, Mesh, Shape, hull, matrix_of
from ..constants import DEGREE, g
from ..errors import InputError, check_range
from ..response import Response
from ..response.poses import exaggerated, rotation_matrices
from ..response.recorded import ASIDE, size_of, way_of
from .style import BLACK, BLUE, BROWN, GREY, RED, SAND

# Bodies in space as painted: from where they are seen, and their shaded faces, the farther ones first.


@dataclass(frozen=True)
class View:
    """Direction of the viewer.

    Parameters
    ----------
    azimuth : float
        From x towards y [rad].
    elevation : float
        Above the horizontal [rad].
    """

    azimuth: float
    elevation: float

    @property
    def right(self) -> np.ndarray:
        """Direction to the right of the picture [-], shape (3,)."""
        return np.array([-math.sin(self.azimuth), math.cos(self.azimuth), 0.0])

    @property
    def up(self) -> np.ndarray:
        """Direction that is upward in the picture [-], shape (3,)."""
        s, c = math.sin(self.elevation), math.cos(self.elevation)
        return np.array([-math.cos(self.azimuth) * s, -math.sin(self.azimuth) * s, c])

    @property
    def toward(self) -> np.ndarray:
        """To the viewer [-], shape (3,)."""
        s, c = math.sin(self.elevation), math.cos(self.elevation)
        return np.array([math.cos(self.azimuth) * c, math.sin(self.azimuth) * c, s])

    def across(self, points: np.ndarray) -> np.ndarray:
        """Points in the picture, to the right and upward [m], shape (…, 3) to (…, 2)."""
        return points @ np.stack((self.right, self.up), axis=1)


#: Elevations: x to the right, seen along y; y to the right, seen against x.
ALONG_X, ALONG_Y = View(-0.5 * math.pi, 0.0), View(0.0, 0.0)

#: From where films show bodies in space unless they are told otherwise.
OBLIQUE = View(-40.0 * DEGREE, 18.0 * DEGREE)


def parse_view(text: str) -> View:
    """A view from two angles in degrees, such as ``-40,18``.

    Raises
    ------
    InputError
        Not two numbers, or a viewer below the ground.
    """
    try:
        azimuth, elevation = (float(part.strip().removesuffix("deg")) for part in text.split(","))
    except ValueError:
        raise InputError(
            f"the view is {text!r}; allowed are azimuth and elevation of the viewer in degrees, such as -40,18."
        ) from None
    check_range("azimuth of the view", azimuth, -360.0, 360.0, unit="°")
    check_range("elevation of the view", elevation, 0.0, 90.0, unit="°")
    return View(azimuth * DEGREE, elevation * DEGREE)


# -- Solids as painted ------------------------------------------------------------------------------------------------


#: Flutes around a round drum, as on a Doric shaft.
FLUTES = 20

#: Tones of faces: stone, the dark half of a flute, the mark that shows how a body is turned, and what moves with the ground.
STONE, FLUTE, MARK, FIXED = range(4)

#: Colours of the tones in full light [-].
COLOURS = np.array([[0.97, 0.93, 0.84], [0.80, 0.72, 0.56], [0.13, 0.40, 0.67], [0.86, 0.86, 0.86]])

#: Direction of light, to the right, upward and towards the viewer [-]; and the share that comes from everywhere.
LIGHT, DIFFUSE = np.array([-0.45, 0.55, 0.70]), 0.6


@dataclass(frozen=True, eq=False)
class Surface:
    """A body's surface in its own axes.

    Parameters
    ----------
    vertices : array
        [m], shape (m, 3)
    faces : tuple of tuple of int
        Vertices of each face, counter-clockwise from outside.
    tones : tuple of int
        Of the faces.
    """

    vertices: np.ndarray
    faces: tuple[tuple[int, ...], ...]
    tones: tuple[int, ...]

    @cached_property
    def normals(self) -> np.ndarray:
        """Of the faces, outward [-], shape (f, 3)."""
        return np.array([_normal(self.vertices[list(face)]) for face in self.faces])


def surface_of(shape: Shape, fixed: bool = False) -> Surface:
    """Surface of a body: a round one is fluted, and every one is marked on the side towards its own x axis.

    Parameters
    ----------
    shape : Shape
    fixed : bool
        Whether it moves with the ground: then it is plain.
    """
    mesh = shape.mesh(2 * FLUTES)
    if fixed:
        return Surface(mesh.vertices, mesh.faces, (FIXED,) * len(mesh.faces))
    chips = len(shape.cuts) if isinstance(shape, Chipped) else 0
    if not isinstance(shape.whole if isinstance(shape, Chipped) else shape, CircularFrustum):
        return _marked(mesh)
    sides = len(mesh.faces) - 2 - chips
    strips = [MARK if i in (0, sides - 1) else FLUTE if i % 2 else STONE for i in range(sides)]
    return Surface(mesh.vertices, mesh.faces, (STONE, STONE, *strips, *(STONE,) * chips))


def surfaces_of(shape: Shape, fixed: bool = False) -> list[Surface]:
    """Surfaces of the convex parts of a body, each in the axes of the body, as of :func:`surface_of`."""
    if not isinstance(shape, Glued):
        return [surface_of(shape, fixed)]
    surfaces = []
    for part in shape.parts:
        surface = surface_of(part.shape, fixed)
        surfaces.append(
            Surface(
                surface.vertices @ matrix_of(part.orientation).T + np.array(part.place), surface.faces, surface.tones
            )
        )
    return surfaces


def _marked(mesh: Mesh) -> Surface:
    """A body with flat sides: that towards x has a strip, or is marked as a whole where it has not four corners."""
    at, faces = mesh.vertices, mesh.faces
    facing = int(np.argmax([_normal(at[list(face)])[0] for face in faces]))
    if len(faces[facing]) != 4:
        return Surface(at, faces, tuple(MARK if i == facing else STONE for i in range(len(faces))))
    a, b, c, d = faces[facing]
    new = [at[p] + share * (at[q] - at[p]) for p, q in ((a, b), (d, c)) for share in (0.4, 0.6)]
    e, f, h, i = range(len(at), len(at) + 4)
    others = (*faces[:facing], *faces[facing + 1 :])
    strips = ((a, e, h, d), (e, f, i, h), (f, b, c, i))
    tones = (*(STONE,) * len(others), STONE, MARK, STONE)
    return Surface(np.concatenate((at, new)), (*others, *strips), tones)


def _normal(corners: np.ndarray) -> np.ndarray:
    """Unit normal of a flat polygon, outward, shape (3,)."""
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    return normal / np.linalg.norm(normal)


@dataclass(frozen=True, eq=False)
class Solid:
    """A body in its place.

    Parameters
    ----------
    surface : Surface
    place : array
        Of its centroid [m], shape (3,).
    turn : array
        Rotation matrix from the body's axes to those of space, shape (3, 3).
    """

    surface: Surface
    place: np.ndarray
    turn: np.ndarray

    @cached_property
    def vertices(self) -> np.ndarray:
        """[m], shape (m, 3)"""
        return self.surface.vertices @ self.turn.T + self.place

    @cached_property
    def normals(self) -> np.ndarray:
        """Of the faces, outward [-], shape (f, 3)."""
        return self.surface.normals @ self.turn.T

    @cached_property
    def levels(self) -> np.ndarray:
        """Distances of the faces' planes from the origin [m], shape (f,)."""
        return (self.normals * self.vertices[[face[0] for face in self.surface.faces]]).sum(axis=1)


def reached(solid: Solid, point: np.ndarray, view: View) -> float:
    """Nearness of a body to the viewer, along the line of sight through a point of the picture [m]."""
    slope, eye = solid.normals @ view.toward, point[0] * view.right + point[1] * view.up
    front = slope > 1e-9
    return float(((solid.levels - solid.normals @ eye)[front] / slope[front]).min())


def common_point(outline: np.ndarray, other: np.ndarray) -> np.ndarray | None:
    """A point inside two convex polygons, both counter-clockwise, shapes (k, 2); None where they do not overlap."""
    kept = outline
    for corner, side in zip(other, np.roll(other, -1, axis=0) - other, strict=True):
        inside = side[0] * (kept[:, 1] - corner[1]) - side[1] * (kept[:, 0] - corner[0])
        if (inside <= 0.0).all():
            return None
        if (inside >= 0.0).all():
            continue
        after, beyond = np.roll(inside, -1), np.roll(kept, -1, axis=0)
        crosses = inside * after < 0.0
        share = inside / np.where(crosses, inside - after, 1.0)
        both = np.stack((kept, kept + share[:, None] * (beyond - kept)), axis=1).reshape(-1, 2)
        kept = both[np.stack((inside >= 0.0, crosses), axis=1).ravel()]
    return kept.mean(axis=0)


def painting_order(solids: list[Solid], view: View) -> list[int]:
    """Numbers of the bodies, in the order in which they are painted."""
    return _ordered(solids, [hull(view.across(solid.vertices)) for solid in solids], view)


def _ordered(solids: list[Solid], outlines: list[np.ndarray], view: View) -> list[int]:
    low, high = (np.array([getattr(outline, end)(axis=0) for outline in outlines]) for end in ("min", "max"))
    depth = [float(solid.place @ view.toward) for solid in solids]
    remaining = sorted(range(len(solids)), key=depth.__getitem__)
    before: dict[int, set[int]] = {i: set() for i in remaining}
    for i in remaining:
        for j in np.flatnonzero(((low[i] <= high) & (low <= high[i])).all(axis=1)).tolist():
            if j > i and (point := common_point(outlines[i], outlines[j])) is not None:
                nearer = reached(solids[i], point, view) > reached(solids[j], point, view)
                first, second = (j, i) if nearer else (i, j)
                before[second].add(first)
    order: list[int] = []
    while remaining:  # where they hide each other in a ring, the farthest is first
        taken = next((i for i in remaining if before[i].isdisjoint(remaining)), remaining[0])
        remaining.remove(taken)
        order.append(taken)
    return order


def painted(solids: list[Solid], view: View) -> tuple[list[np.ndarray], np.ndarray, list[bool]]:
    """Polygons in the order of painting: of each body its outline, then the faces that are turned to the viewer.

    Returns
    -------
    polygons : list of array
        Corners [m], each of shape (k, 2).
    colours : array
        [-], shape (p, 3)
    outlines : list of bool
        Which of them are outlines.
    """
    light = LIGHT / np.linalg.norm(LIGHT) @ np.stack((view.right, view.up, view.toward))
    polygons: list[np.ndarray] = []
    colours: list[np.ndarray] = []
    outlines: list[bool] = []
    solids = [solid for solid in solids if np.isfinite(solid.vertices).all()]
    hulls = [hull(view.across(solid.vertices)) for solid in solids]
    for number in _ordered(solids, hulls, view):
        solid = solids[number]
        surface, points = solid.surface, view.across(solid.vertices)
        shade = DIFFUSE + (1.0 - DIFFUSE) * np.clip(solid.normals @ light, 0.0, 1.0)
        polygons.append(hulls[number])
        colours.append(COLOURS[surface.tones[0]])
        outlines.append(True)
        for i in np.flatnonzero(solid.normals @ view.toward > 1e-9).tolist():
            polygons.append(points[list(surface.faces[i])])
            colours.append(shade[i] * COLOURS[surface.tones[i]])
            outlines.append(False)
    return polygons, np.array(colours), outlines


#: A picture goes no farther below what stood at first than by this share of its size, and no farther aside than ``ASIDE``:
#: what flies off, or falls where there is no ground, is let go.
DOWN = 0.75

#: Radius of the ground that is shown in space, over that of what stands on it; the farthest it goes beyond, over the size.
PLATE, BEYOND = 2.6, 0.25


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
        return [hull(np.concatenate(corners)) for corners in points]

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
        middle = 0.5 * (low.min(axis=0) + low.max(axis=0))[:2]
        reach = float(np.hypot(*(low[:, :2] - middle).T).max())
        radius, angle = min(PLATE * reach, reach + BEYOND * self.size), np.arange(72) * (2.0 * np.pi / 72)
        ring = middle + radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)
        return np.column_stack((ring, np.full(72, self.level or 0.0))) @ self.base.T

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


def time_window(time: np.ndarray, window: tuple[float, float] | None) -> tuple[float, float]:
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

    def mark(stroke: Stroke) -> Mark:
        return Mark(body(*stroke.lower[:2]), body(*stroke.upper[:2]), broken.get(stroke.link.name, math.inf))

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
    for line in [artist for artist in axes.lines if artist.get_gid() == "link"]:
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
