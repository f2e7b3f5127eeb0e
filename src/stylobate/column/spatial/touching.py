"""Where bodies in space touch: flat faces that lie on one another, their overlap, and how far apart bodies are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..found_geometry import Edges
from ..joint import Joint
from ..shapes import Chipped, CircularFrustum, Placed, cut, matrix_of

#: Faces touch when they are this close, as a share of the smaller body's size, and parallel to this angle [rad].
TOUCHING, PARALLEL = 1e-5, 1e-4

#: Corners of a circle where areas are counted, and where directions are looked at.
AROUND = 96

#: Best directions from which a farther one is looked for, the finest turn of it [rad], and most turns: along a ridge, where
#: only the finest ones lead farther, there is no end of them.
STARTS, FINEST, TURNS = 3, 1e-9, 1000


@dataclass(frozen=True, eq=False)
class FlatFace:
    """A flat face of a part, in the axes of space as it stands.

    Parameters
    ----------
    middle : array
        A point within it [m], shape (3,).
    frame : array
        Two directions along it and its outward normal as columns [-], shape (3, 3).
    corners : array
        Along it from the middle, counter-clockwise seen from outside [m], shape (k, 2); 96 around a circle.
    edges : Edges
        The disc and the straight sides that bound it, along it from the middle.
    """

    middle: np.ndarray
    frame: np.ndarray
    corners: np.ndarray
    edges: Edges

    @property
    def round(self) -> bool:
        """Whether a circle bounds it."""
        return bool(self.edges.discs)


@dataclass(frozen=True, eq=False)
class SpaceJoint:
    """Two faces that lie on one another.

    Parameters
    ----------
    lower, upper : int
        Bodies by number, the lower number first.
    lower_part, upper_part : int
        Which of their parts.
    law : Joint
    below, above : FlatFace
        The face of the first body, which of a ground is as large as the other, and that of the second.
    origin : array
        Middle of their overlap [m], shape (3,).
    frame : array
        Two directions along the joint and its normal, from the first body into the second, as columns [-], shape (3, 3).
    corners : array
        Of the overlap along the joint from its middle, counter-clockwise [m], shape (k, 2); many around arcs.
    edges : Edges
        Discs and sides that bound the overlap, in the same axes.
    area : float
        [m²]
    """

    lower: int
    upper: int
    lower_part: int
    upper_part: int
    law: Joint
    below: FlatFace
    above: FlatFace
    origin: np.ndarray
    frame: np.ndarray
    corners: np.ndarray
    edges: Edges
    area: float

    @property
    def round(self) -> bool:
        """Whether an arc bounds the overlap."""
        return bool(self.edges.discs)

    @property
    def width(self) -> float:
        """Largest extent of the overlap [m]."""
        return 2.0 * float(np.hypot(*self.corners.T).max())


class Overlap(NamedTuple):
    """Of two faces: place, axes, corners, edges and area, as of :class:`SpaceJoint`."""

    origin: np.ndarray
    frame: np.ndarray
    corners: np.ndarray
    edges: Edges
    area: float


class Solid:
    """A part as it stands, for those who ask where it is: its faces, its corners, its extent in a direction."""

    def __init__(self, part: Placed) -> None:
        self.part, self.axes, self.place = part, matrix_of(part.orientation), np.array(part.place)
        mesh = part.mesh(AROUND)
        self.vertices, self.loops = mesh.vertices, mesh.faces
        self.whole = part.shape if isinstance(part.shape, CircularFrustum) else None
        drum = part.shape.whole if isinstance(part.shape, Chipped) else part.shape
        self.drum = drum if isinstance(drum, CircularFrustum) else None
        self.low, self.high = (self.extent(-np.eye(3)) * -1.0, self.extent(np.eye(3)))
        self.size = float((self.high - self.low).max())

    @property
    def round(self) -> bool:
        """Whether it is a round drum, chipped or not."""
        return self.drum is not None

    def extent(self, ways: np.ndarray) -> np.ndarray:
        """How far it reaches in directions [m], shape (k, 3) to (k,)."""
        if self.whole is None:
            return (self.vertices @ ways.T).max(axis=0)
        axis, drum = self.axes[:, 2], self.whole
        along = ways @ axis
        across = np.sqrt(np.maximum(1.0 - along * along, 0.0))
        ends = [drum.bottom * 0.5 * across - along * drum.centroid]
        ends += [drum.top * 0.5 * across + along * (drum.height - drum.centroid)]
        return ways @ self.place + np.maximum(*ends)

    def depth(self, points: np.ndarray) -> np.ndarray:
        """Depth of points within it [m], shape (m, 3) to (m,); negative outside, as far as they are beyond its faces."""
        if self.whole is None:
            normals, bounds = self._planes
            return (bounds - points @ normals.T).min(axis=1)
        drum, axis = self.whole, self.axes[:, 2]
        away = points - self.place
        up = away @ axis + drum.centroid
        slope = 0.5 * (drum.bottom - drum.top) / drum.height
        out = np.linalg.norm(away - np.outer(away @ axis, axis), axis=1)
        side = (0.5 * drum.bottom - slope * up - out) / math.hypot(1.0, slope)
        return np.minimum(side, np.minimum(up, drum.height - up))

    @cached_property
    def _planes(self) -> tuple[np.ndarray, np.ndarray]:
        """Outward normals of its faces and how far these are out [-], [m], shapes (k, 3) and (k,)."""
        normals = []
        for loop in self.loops:
            corners = self.vertices[list(loop)]
            normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
            normals.append(normal / np.linalg.norm(normal))
        unit_normals = np.array(normals)
        return unit_normals, (self.vertices @ unit_normals.T).max(axis=0)

    @property
    def thickness(self) -> float:
        """Smallest distance of a face from what is farthest from it [m]; of a round side, the least diameter."""
        normals = self._planes[0]
        return float((self.extent(normals) + self.extent(-normals)).min())

    @cached_property
    def faces(self) -> tuple[FlatFace, ...]:
        """All that are flat, but for chips of round drums."""
        flat = self.loops[:2] if self.round else self.loops
        return tuple(self._face(np.array(self.vertices[list(loop)]), end) for end, loop in enumerate(flat))

    def _face(self, corners: np.ndarray, end: int) -> FlatFace:
        middle = corners.mean(axis=0)
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        normal = normal / np.linalg.norm(normal)
        if self.drum is not None:  # its middle is on the axis, whatever chips leave
            height = -self.drum.centroid if end == 0 else self.drum.height - self.drum.centroid
            middle = self.place + self.axes[:, 2] * height
            normal = self.axes[:, 2] * (-1.0 if end == 0 else 1.0)
        first = self.axes[:, int(np.abs(self.axes.T @ normal).argmin())]
        first = first - (first @ normal) * normal
        first = first / np.linalg.norm(first)
        frame = np.column_stack((first, np.cross(normal, first), normal))
        flat = (corners - middle) @ frame[:, :2]
        if self.drum is None:
            return FlatFace(middle, frame, flat, Edges((), _sides(flat)))
        radius = 0.5 * (self.drum.bottom if end == 0 else self.drum.top)
        chords: list[tuple[np.ndarray, float]] = []
        if isinstance(self.part.shape, Chipped):
            for *outward, distance in self.part.shape.cuts:
                way = frame[:, :2].T @ self.axes @ np.array(outward)
                bound = distance - outward[2] * float(self.axes[:, 2] @ (middle - self.place))
                if bound < radius * np.hypot(*way):
                    chords.append((way / np.hypot(*way), bound / float(np.hypot(*way))))
        return FlatFace(middle, frame, flat, Edges(((np.zeros(2), radius),), tuple(chords)))

    @cached_property
    def edge_ways(self) -> np.ndarray:
        """Directions of its straight edges, each once, and of a round drum's axis [-], shape (k, 3)."""
        if self.round:
            return self.axes[:, 2][None]
        ways: list[np.ndarray] = []
        for loop in self.loops:
            for i, k in zip(loop, (*loop[1:], loop[0]), strict=True):
                way = self.vertices[k] - self.vertices[i]
                way = way / np.linalg.norm(way)
                if all(abs(abs(float(way @ known_way)) - 1.0) > 1e-12 for known_way in ways):
                    ways.append(way)
        return np.array(ways)


def _sides(corners: np.ndarray) -> tuple[tuple[np.ndarray, float], ...]:
    """Outward normals and bounds of the sides of a polygon, counter-clockwise."""
    side = np.roll(corners, -1, axis=0) - corners
    length = np.hypot(*side.T)
    kept = length > 1e-12 * length.max()
    normal = np.stack((side[kept, 1], -side[kept, 0]), axis=1) / length[kept, None]
    return tuple((outward, float(outward @ corner)) for outward, corner in zip(normal, corners[kept], strict=True))


def separation(first: Solid, other: Solid, near: float) -> tuple[float, np.ndarray]:
    """Distance of two solids [m], negative where they overlap by that depth, and the direction from the first to the second.

    Beyond ``near`` [m] it is only known that they are farther apart than that.
    """
    ways = _candidates(first, other)
    gaps = -first.extent(ways) - other.extent(-ways)
    best = int(gaps.argmax())
    if gaps[best] > near or not (first.round or other.round):
        return float(gaps[best]), ways[best]
    separations = [_farther(first, other, ways[i], float(gaps[i])) for i in np.argsort(-gaps)[:STARTS]]
    return max(separations, key=lambda item: item[0])


def _candidates(first: Solid, other: Solid) -> np.ndarray:
    """Directions in which two solids may be farthest apart: normals of faces, across two edges, from axis to axis."""
    ways = [face.frame[:, 2] for face in first.faces] + [-face.frame[:, 2] for face in other.faces]
    across = np.cross(first.edge_ways[:, None], other.edge_ways[None]).reshape(-1, 3)
    between = other.place - first.place
    ways += [*across, *(-across), between]
    for solid, sign in ((first, 1.0), (other, -1.0)):
        if solid.round:
            axis, beside = solid.axes[:, 2], other if sign > 0.0 else first
            for point in (beside.place, *beside.vertices[:: max(1, len(beside.vertices) // 16)]):
                away = point - solid.place
                ways.append(sign * (away - (away @ axis) * axis))
    directions = np.array(ways)
    length = np.linalg.norm(directions, axis=1)
    return directions[length > 1e-9] / length[length > 1e-9, None]


def _farther(solid: Solid, other: Solid, way: np.ndarray, gap: float) -> tuple[float, np.ndarray]:
    """The largest gap that turning a direction by and by leads to."""
    angle = np.arange(8) * (0.25 * math.pi)
    step = 0.2
    for _ in range(TURNS):
        if step <= FINEST:
            break
        aside = np.linalg.svd(way[None])[2][1:]
        ways = way + step * (np.cos(angle)[:, None] * aside[0] + np.sin(angle)[:, None] * aside[1])
        ways = ways / np.linalg.norm(ways, axis=1)[:, None]
        gaps = -solid.extent(ways) - other.extent(-ways)
        best = int(gaps.argmax())
        if gaps[best] > gap:
            gap, way = float(gaps[best]), ways[best]
        else:
            step *= 0.5
    return gap, way


def overlaps(first: Solid, other: Solid, near: float) -> list[tuple[FlatFace, FlatFace, Overlap]]:
    """Pairs of faces of two solids that lie on one another, to a distance [m]."""
    pairs = []
    for below in first.faces:
        for above in other.faces:
            if below.frame[:, 2] @ above.frame[:, 2] > -math.cos(PARALLEL):
                continue
            if abs(float((above.middle - below.middle) @ below.frame[:, 2])) > 2.0 * near:
                continue
            over = overlap_of(below, above, near)
            if over is not None:
                pairs.append((below, above, over))
    return pairs


def overlap_of(below: FlatFace | None, above: FlatFace, near: float) -> Overlap | None:
    """Where two faces lie on one another; a face of a ground without ends is None. None where they only touch."""
    frame = above.frame @ np.diag([1.0, -1.0, -1.0])  # along the upper face, its normal into the upper body
    own = above.corners * (1.0, -1.0)
    pieces = [(above.edges, np.zeros(2), np.diag([1.0, -1.0]))]
    corners = own[::-1]
    if below is not None:
        turn = frame[:, :2].T @ below.frame[:, :2]
        shift = frame[:, :2].T @ (below.middle - above.middle)
        pieces.append((below.edges, shift, turn))
        other = below.corners @ turn.T + shift
        for normal, bound in _sides(other):
            corners = cut(corners, normal, bound)
            if len(corners) < 3:
                return None
    area, middle = _area_of(corners)
    if area <= near * float(np.hypot(*(corners - np.roll(corners, 1, axis=0)).T).sum()):
        return None
    discs: list[tuple[np.ndarray, float]] = []
    sides: list[tuple[np.ndarray, float]] = []
    for edges, shift, turn in pieces:
        discs += [(turn @ centre + shift - middle, radius) for centre, radius in edges.discs]
        for normal, bound in edges.sides:
            way = turn @ normal
            sides.append((way, bound + float(way @ (shift - middle))))
    corners = corners - middle
    reach = np.hypot(*corners.T).max()
    discs = [disc for disc in discs if np.hypot(*(corners - disc[0]).T).max() > disc[1] - 1e-3 * reach]
    sides = [side for side in sides if (corners @ side[0]).max() > side[1] - 1e-6 * reach]
    if len(discs) == 1 and not sides:  # a whole face
        area = math.pi * discs[0][1] ** 2
    elif discs:  # polygons in circles miss the same share of each
        area *= math.pi / (0.5 * AROUND * math.sin(2.0 * math.pi / AROUND))
    return Overlap(above.middle + frame[:, :2] @ middle, frame, corners, Edges(tuple(discs), tuple(sides)), area)


def _area_of(corners: np.ndarray) -> tuple[float, np.ndarray]:
    """Area [m²] and centroid [m] of a polygon."""
    p = corners - corners[0]
    q = np.roll(p, -1, axis=0)
    cross: Any = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    area = 0.5 * float(cross.sum())
    if area <= 0.0:
        return 0.0, corners.mean(axis=0)
    return area, corners[0] + ((p + q) * cross[:, None]).sum(axis=0) / (6.0 * area)
