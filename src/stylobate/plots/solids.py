"""Bodies in space as painted: from where they are seen, and their shaded faces, the farther ones first."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..column.shapes import Chipped, CircularFrustum, Glued, Mesh, Shape, hull
from ..column.turning import matrix_of
from ..constants import DEGREE
from ..errors import InputError, check_range


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
    found = []
    for part in shape.parts:
        one = surface_of(part.shape, fixed)
        found.append(Surface(one.vertices @ matrix_of(part.orientation).T + np.array(part.place), one.faces, one.tones))
    return found


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
    found = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    return found / np.linalg.norm(found)


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


def common_point(one: np.ndarray, other: np.ndarray) -> np.ndarray | None:
    """A point inside two convex polygons, both counter-clockwise, shapes (k, 2); None where they do not overlap."""
    kept = one
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
    left = sorted(range(len(solids)), key=depth.__getitem__)
    before: dict[int, set[int]] = {i: set() for i in left}
    for i in left:
        for j in np.flatnonzero(((low[i] <= high) & (low <= high[i])).all(axis=1)).tolist():
            if j > i and (point := common_point(outlines[i], outlines[j])) is not None:
                nearer = reached(solids[i], point, view) > reached(solids[j], point, view)
                first, second = (j, i) if nearer else (i, j)
                before[second].add(first)
    order: list[int] = []
    while left:  # where they hide each other in a ring, the farthest is first
        taken = next((i for i in left if before[i].isdisjoint(left)), left[0])
        left.remove(taken)
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
