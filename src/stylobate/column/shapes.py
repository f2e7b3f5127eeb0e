"""Shapes of bodies, in their own axes: origin at the centroid, z along the body's axis, lengths in metres."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..constants import DEGREE
from .as_found import FoundDrum
from .drum import Drum

# Orientations of bodies in space: unit quaternions (w, x, y, z) and their matrices.

#: Axes as those of space.
UPRIGHT = (1.0, 0.0, 0.0, 0.0)

Quaternion = tuple[float, float, float, float]


def matrix_of(turn: Quaternion) -> np.ndarray:
    """Axes of a body as columns [-], shape (3, 3)."""
    w, x, y, z = turn
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion_of(axes: np.ndarray) -> Quaternion:
    """The quaternion of a rotation matrix, its first component not negative."""
    four = np.array(
        [
            1.0 + axes[0, 0] + axes[1, 1] + axes[2, 2],
            1.0 + axes[0, 0] - axes[1, 1] - axes[2, 2],
            1.0 - axes[0, 0] + axes[1, 1] - axes[2, 2],
            1.0 - axes[0, 0] - axes[1, 1] + axes[2, 2],
        ]
    )
    largest = int(four.argmax())
    size = 2.0 * math.sqrt(four[largest])
    skew = axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]
    both = axes[1, 0] + axes[0, 1], axes[2, 0] + axes[0, 2], axes[2, 1] + axes[1, 2]
    rows = (
        (0.25 * size * size, skew[0], skew[1], skew[2]),
        (skew[0], 0.25 * size * size, both[0], both[1]),
        (skew[1], both[0], 0.25 * size * size, both[2]),
        (skew[2], both[1], both[2], 0.25 * size * size),
    )
    w, x, y, z = (float(component) / size for component in rows[largest])
    return (w, x, y, z) if w >= 0.0 else (-w, -x, -y, -z)


def product(turn: Quaternion, other: Quaternion) -> Quaternion:
    """The turn that is the second and then the first."""
    a, b, c, d = turn
    e, f, g, h = other
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def about(axis: tuple[float, float, float], angle: float) -> Quaternion:
    """Turn by an angle [rad] about an axis of length 1."""
    if angle == 0.0:
        return UPRIGHT
    s = math.sin(0.5 * angle)
    return math.cos(0.5 * angle), axis[0] * s, axis[1] * s, axis[2] * s


#: Height of a chip as a share of its width: a spall runs steeper than 45°.
CHIP_SLOPE = 1.5

#: Facets of a hull whose unit normals differ by less than this are one face [-].
ONE_PLANE = 1e-6

#: Decimals of a metre to which corners of a cut body are the same.
SAME = 10


class Outlined:
    """Bodies that have an outline as they stand."""

    @property
    def outline(self) -> np.ndarray:
        """Corners as it stands, along and normal to the base [m], shape (k, 2)."""
        raise NotImplementedError

    @property
    def sides(self) -> tuple[float, ...]:
        """Sides of the box around it as it stands [m]."""
        return tuple(np.ptp(self.outline, axis=0).tolist())

    @property
    def size(self) -> float:
        """Largest side of the box around it [m]."""
        return max(self.sides)

    @property
    def thickness(self) -> float:
        """Smallest distance between two parallels that hold it [m]."""
        return narrowest(self.outline)[0]


class Mesh(NamedTuple):
    """A closed surface of flat faces: vertices [m], shape (m, 3); vertex numbers of each face, counter-clockwise outside."""

    vertices: np.ndarray
    faces: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class CircularFrustum:
    """A round drum.

    Parameters
    ----------
    bottom, top : float
        Diameters of the lower and upper face [m].
    height : float
        [m]
    centroid : float
        Height of the centroid over the lower face [m].
    """

    bottom: float
    top: float
    height: float
    centroid: float

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners (x, z) of what is seen along y [m], shape (4, 2)."""
        return _trapezium(self.bottom, self.top, self.height, self.centroid)

    @property
    def depth(self) -> float:
        """Mean thickness across the width [m]."""
        return 0.25 * math.pi * (0.5 * (self.bottom + self.top))

    def mesh(self, around: int = 32) -> Mesh:
        """The surface."""
        angle = np.arange(around) * (2.0 * np.pi / around)
        ring = np.stack((np.cos(angle), np.sin(angle)), axis=1)
        return _between(0.5 * self.bottom * ring, 0.5 * self.top * ring, self.height, self.centroid)


@dataclass(frozen=True)
class RectangularFrustum:
    """A drum or block with two rectangular faces.

    Parameters
    ----------
    bottom, top : (float, float)
        Sides of the lower and upper face along x and y [m].
    height : float
        [m]
    centroid : float
        Height of the centroid over the lower face [m].
    """

    bottom: tuple[float, float]
    top: tuple[float, float]
    height: float
    centroid: float

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners (x, z) of what is seen along y [m], shape (4, 2)."""
        return _trapezium(self.bottom[0], self.top[0], self.height, self.centroid)

    @property
    def depth(self) -> float:
        """Mean thickness [m]."""
        return 0.5 * (self.bottom[1] + self.top[1])

    def mesh(self, around: int = 32) -> Mesh:
        """The surface; it has no circles."""
        del around
        corners = 0.5 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        return _between(corners * self.bottom, corners * self.top, self.height, self.centroid)


@dataclass(frozen=True, eq=False)
class Chipped:
    """A drum with chipped edges: what planes leave of it.

    Parameters
    ----------
    whole : CircularFrustum or RectangularFrustum
    cuts : array
        Unit normals of the planes, outward, and their distances from the origin [m], shape (k, 4).
    """

    whole: CircularFrustum | RectangularFrustum
    cuts: np.ndarray

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners (x, z) of what is seen along y [m], shape (k, 2)."""
        return hull(self.mesh(128).vertices[:, [0, 2]])

    @property
    def depth(self) -> float:
        """Mean thickness of the whole drum [m]."""
        return self.whole.depth

    def mesh(self, around: int = 32) -> Mesh:
        """The surface: the faces of the whole drum in their order, then those of the chips."""
        vertices, faces = self.whole.mesh(around)
        polygons = [vertices[list(face)] for face in faces]
        for *normal, distance in self.cuts:
            kept = [cut(polygon, np.array(normal), distance) for polygon in polygons]
            # the new face has what lies in the plane, in order round its middle
            edge = np.concatenate([polygon[np.abs(polygon @ normal - distance) < 1e-9] for polygon in kept])
            along = np.cross((0.0, 0.0, 1.0), normal)
            flat = np.stack((edge @ along, edge @ np.cross(normal, along)), axis=1)
            from_middle = flat - flat.mean(axis=0)
            polygons = [*kept, edge[np.argsort(np.arctan2(from_middle[:, 1], from_middle[:, 0]))]]
        # corners that several faces share are one vertex
        points, numbers = np.unique(np.concatenate(polygons).round(SAME), axis=0, return_inverse=True)
        ends = np.cumsum([len(polygon) for polygon in polygons])[:-1]
        around_each = [part.tolist() for part in np.split(numbers.ravel(), ends)]
        return Mesh(
            points, tuple(tuple(i for i, j in zip(loop, loop[1:] + loop[:1]) if i != j) for loop in around_each)
        )


def cut(polygon: np.ndarray, normal: np.ndarray, distance: float) -> np.ndarray:
    """Part of a convex polygon within a line in its plane, or a plane in space [m], shape (k, 2) or (k, 3)."""
    inside = distance - polygon @ normal
    after, beyond = np.roll(inside, -1), np.roll(polygon, -1, axis=0)
    crosses = inside * after < 0.0
    share = inside / np.where(crosses, inside - after, 1.0)
    both = np.stack((polygon, polygon + share[:, None] * (beyond - polygon)), axis=1).reshape(-1, polygon.shape[1])
    return both[np.stack((inside >= 0.0, crosses), axis=1).ravel()]


@dataclass(frozen=True, eq=False)
class Prism:
    """A convex polygon in the plane x–z, of constant thickness along y: a block of an assembly.

    Parameters
    ----------
    corners : array
        (x, z) from the body's origin, counter-clockwise with x to the right and z up [m], shape (k, 2).
    depth : float
        Thickness [m].
    """

    corners: np.ndarray
    depth: float

    @property
    def outline(self) -> np.ndarray:
        """Corners (x, z) [m], shape (k, 2)."""
        return self.corners

    def mesh(self, around: int = 32) -> Mesh:
        """The surface; it has no circles."""
        del around
        n, half = len(self.corners), 0.5 * self.depth
        x, z = self.corners.T
        near, far = (np.stack((x, np.full(n, y), z), axis=1) for y in (-half, half))
        sides = [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]
        return Mesh(np.concatenate((near, far)), (tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1)), *sides))


@dataclass(frozen=True, eq=False)
class ConvexSolid:
    """The convex hull of points.

    Parameters
    ----------
    vertices : array
        From the body's centroid [m], shape (m, 3).
    """

    vertices: np.ndarray

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners (x, z) of what is seen along y [m], shape (k, 2)."""
        return hull(np.asarray(self.vertices)[:, [0, 2]])

    @property
    def depth(self) -> float:
        """Largest thickness [m]."""
        return float(np.ptp(np.asarray(self.vertices)[:, 1]))

    def mesh(self, around: int = 32) -> Mesh:
        """The surface, in flat faces; it has no circles."""
        del around
        return Mesh(np.asarray(self.vertices, dtype=float), self._faces)

    @cached_property
    def _faces(self) -> tuple[tuple[int, ...], ...]:
        from scipy.spatial import ConvexHull

        points = np.asarray(self.vertices, dtype=float)
        hull: Any = ConvexHull(points)
        normals, groups = hull.equations[:, :3], list(range(len(hull.simplices)))
        for triangle, beside in enumerate(
            hull.neighbors
        ):  # triangles of one plane are one face, called by its first one
            for other in beside:
                if other < triangle and np.linalg.norm(normals[triangle] - normals[other]) < ONE_PLANE:
                    old, new = groups[triangle], groups[other]
                    groups = [new if group == old else group for group in groups]
        return tuple(
            _around(points, _rim(hull.simplices[np.array(groups) == group]), normal)
            for group, normal in enumerate(normals)
            if group in groups
        )


def _rim(triangles: np.ndarray) -> set[int]:
    """Corners of the face that triangles make: those on an edge of one of them alone; others lie within it."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    once, times = np.unique(edges, axis=0, return_counts=True)
    return set(once[times == 1].ravel().tolist())


def _around(points: np.ndarray, members: set[int], normal: np.ndarray) -> tuple[int, ...]:
    """Corners of a convex face in their order, counter-clockwise seen against its normal."""
    order = sorted(members)
    flat = points[order] - points[order].mean(axis=0)
    across = np.cross(normal, flat[0])
    angle = np.arctan2(flat @ across, (flat @ flat[0]) * np.linalg.norm(across) / np.linalg.norm(flat[0]))
    return tuple(order[i] for i in np.argsort(angle))


@dataclass(frozen=True, eq=False)
class Placed:
    """A convex part of a body: its shape, where its centroid is, and how it is turned, in the axes of the body.

    Parameters
    ----------
    shape : CircularFrustum, RectangularFrustum, Chipped, Prism or ConvexSolid
    place : (float, float, float)
        [m]
    orientation : (float, float, float, float)
        Unit quaternion, w first.
    """

    shape: CircularFrustum | RectangularFrustum | Chipped | Prism | ConvexSolid
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    orientation: Quaternion = UPRIGHT

    def mesh(self, around: int = 32) -> Mesh:
        """The surface, where the part is."""
        vertices, faces = self.shape.mesh(around)
        return Mesh(vertices @ matrix_of(self.orientation).T + np.array(self.place), faces)


@dataclass(frozen=True, eq=False)
class Glued:
    """Several convex parts that are one body.

    Parameters
    ----------
    parts : tuple of Placed
        From the centroid of all.
    """

    parts: tuple[Placed, ...]

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners (x, z) of the hull of what is seen along y [m], shape (k, 2)."""
        return hull(self.mesh(128).vertices[:, [0, 2]])

    @property
    def depth(self) -> float:
        """Largest thickness [m]."""
        return float(np.ptp(self.mesh().vertices[:, 1]))

    def mesh(self, around: int = 32) -> Mesh:
        """The surfaces of all parts, one after another."""
        meshes, faces, first = [part.mesh(around) for part in self.parts], [], 0
        for mesh in meshes:
            faces += [tuple(first + i for i in face) for face in mesh.faces]
            first += len(mesh.vertices)
        return Mesh(np.concatenate([surface.vertices for surface in meshes]), tuple(faces))


#: Interface of shapes: ``outline``, seen along y, ``depth`` along it, and ``mesh()``, its surface.
Shape = CircularFrustum | RectangularFrustum | Chipped | Prism | ConvexSolid | Glued

#: Shapes of drums.
DRUMS = (CircularFrustum, RectangularFrustum, Chipped)


def shape_of(drum: Drum, found_drum: FoundDrum) -> Shape:
    """The shape of a drum, as it was found."""
    high = drum.centroid_height
    if drum.circular:
        whole = CircularFrustum(drum.bottom_width, drum.top_width, drum.height, high)
    else:
        sides = (drum.bottom_width, drum.depth), (drum.top_width, drum.upper_depth)
        whole = RectangularFrustum(*sides, drum.height, high)
    return Chipped(whole, chips_of(drum, found_drum)) if found_drum.chipped else whole


def chips_of(drum: Drum, found_drum: FoundDrum) -> np.ndarray:
    """Planes that cut the chips off a drum: outward normals, and distances from its centroid [m], shape (k, 4)."""
    planes = []
    for chip, azimuth, low, high in zip(
        found_drum.chips,
        np.array([180.0, 0.0, 270.0, 90.0]) + found_drum.chip_azimuth,
        (drum.bottom_width, drum.bottom_width, drum.depth, drum.depth),
        (drum.top_width, drum.top_width, drum.upper_depth, drum.upper_depth),
        strict=True,
    ):
        if chip:
            share = min(CHIP_SLOPE * chip / drum.height, 0.5)
            along, up = chip + 0.5 * share * (high - low), share * drum.height
            size, angle = math.hypot(along, up), azimuth * DEGREE
            normal = np.array([up * math.cos(angle), up * math.sin(angle), -along]) / size
            planes.append((*normal, (up * (0.5 * low - chip) + along * drum.centroid_height) / size))
    return np.array(planes)


def hull(points: np.ndarray) -> np.ndarray:
    """Corners of the convex hull of points in a plane, counter-clockwise [m], shape (k, 2); NaN where one is not finite."""
    if not np.isfinite(points).all():
        return np.full((3, 2), np.nan)
    from scipy.spatial import ConvexHull

    return points[ConvexHull(points).vertices]


def narrowest(corners: np.ndarray) -> tuple[float, float]:
    """Smallest distance of two parallels that hold a convex polygon, and its extent along them [m].

    Parameters
    ----------
    corners : array
        In their order [m], shape (k, 2).
    """
    side = np.roll(corners, -1, axis=0) - corners
    along = side / np.hypot(side[:, 0], side[:, 1])[:, None]
    normal = np.stack((-along[:, 1], along[:, 0]), axis=1)
    across = np.ptp(corners @ normal.T, axis=0)
    k = int(across.argmin())
    return float(across[k]), float(np.ptp(corners @ along[k]))


def _trapezium(bottom: float, top: float, height: float, centroid: float) -> np.ndarray:
    low, high = -centroid, height - centroid
    return np.array([[-0.5 * bottom, low], [0.5 * bottom, low], [0.5 * top, high], [-0.5 * top, high]])


def _between(lower: np.ndarray, upper: np.ndarray, height: float, centroid: float) -> Mesh:
    """The surface between two parallel faces with as many corners, counter-clockwise from above."""
    n = len(lower)
    vertices = np.concatenate(
        (np.column_stack((lower, np.full(n, -centroid))), np.column_stack((upper, np.full(n, height - centroid))))
    )
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return Mesh(vertices, (tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n)), *sides))
