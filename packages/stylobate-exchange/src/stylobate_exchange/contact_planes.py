"""Faces of stones that touch, brought into common planes: gaps and overlaps below a tolerance are closed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from stylobate.column.shapes import cut, hull

from .fitting import Frustum, Hull

#: Faces look at one another, and triangles of a hull are one face, to this angle: of rounded and of measured corners [rad].
SMOOTH, ROUGH = 0.02, 0.2

#: A contact is no less than this share of the smaller face; planes that differ by less than this cut in no edge [-].
CONTACT, EDGE = 1e-3, 1e-3

#: Faces in contact within this are of one plane, whatever the tolerance [m]: courses of stones are not made level.
LEVEL = 1e-3

#: Corners around the end of a drum.
AROUND = 24

#: Outward normal [-], shape (3,), and distance from the origin [m].
Plane = tuple[np.ndarray, float]


class Face(NamedTuple):
    """A face of a hull, an end of a drum, or the ground.

    Parameters
    ----------
    stone : int
        Its number; -1 of the ground.
    members : tuple of int
        Numbers of the corners of the hull; of a drum 0 for its foot and 1 for its top.
    corners : array
        [m], shape (k, 3).
    normal : array
        Outward [-], shape (3,).
    """

    stone: int
    members: tuple[int, ...]
    corners: np.ndarray
    normal: np.ndarray


class Closed(NamedTuple):
    """What lay between two faces that were brought into one plane: numbers of their stones, largest gap and overlap [m]."""

    one: int
    other: int
    gap: float
    overlap: float


def brought_together(
    shapes: Sequence[Frustum | Hull], ground: float | None, tolerance: float, closing: float, facing: float
) -> tuple[list[Frustum | Hull], float, list[Closed]]:
    """Stones whose faces share a plane where they touch, how far a corner moved at most [m], and what was closed.

    A plane is that of the least squares of the corners on it, or the ground; ends of a drum stay parallel. A stone of which
    a corner would move farther than the tolerance stays as it is.

    Parameters
    ----------
    shapes : sequence of Frustum or Hull
    ground : float or None
        Its level [m].
    tolerance, closing : float
        Largest overlap, and largest gap, that is closed [m].
    facing : float
        Angle to which faces look at one another, and triangles of a hull are one face [rad].
    """
    faces = [face for number, shape in enumerate(shapes) for face in _faces(number, shape, facing)]
    low = np.min([face.corners.min(axis=0) for face in faces], axis=0) - 1.0
    high = np.max([face.corners.max(axis=0) for face in faces], axis=0) + 1.0
    if ground is not None:
        square = np.array([(x, y, ground) for x, y in (low[:2], (high[0], low[1]), high[:2], (low[0], high[1]))])
        faces.append(Face(-1, (), square, np.array([0.0, 0.0, 1.0])))
    closed = _contacts(faces, tolerance, closing, facing)
    contacts = list(closed)
    group = _groups(len(faces), [*contacts, *_level(faces, contacts, min(closing, LEVEL))])
    touching = {group[i] for i, _ in contacts}
    on = {name: [face for face, one in zip(faces, group, strict=True) if one == name] for name in touching}
    ends: dict[int, dict[int, int]] = {}
    for name in touching:
        for face in on[name]:
            for member in face.members:
                ends.setdefault(face.stone, {})[member] = name
    pairs = [
        tuple(found.values())
        for stone, found in ends.items()
        if stone >= 0 and isinstance(shapes[stone], Frustum) and len(found) == 2
    ]
    alike = _groups(len(faces), pairs)
    planes: dict[int, Plane] = {}
    for kind in {alike[name] for name in touching}:
        planes |= _planes({name: on[name] for name in touching if alike[name] == kind}, ground)
    moved, most, kept = list(shapes), 0.0, set[int]()
    for stone, shape in enumerate(shapes):
        found = [
            (face.members, planes[group[i]])
            for i, face in enumerate(faces)
            if face.stone == stone and group[i] in planes
        ]
        new, shift = _on_planes(shape, found)
        if shift <= max(tolerance, closing):
            moved[stone], most = new, max(most, shift)
        else:
            kept.add(stone)
    return moved, most, [one for one in closed.values() if not kept & {one.one, one.other}]


def _faces(stone: int, shape: Frustum | Hull, facing: float) -> list[Face]:
    """Flat faces of a stone; the triangles of a hull that lie in a plane are one."""
    if isinstance(shape, Frustum):
        angle = np.arange(AROUND) * (2.0 * math.pi / AROUND)
        across = np.linalg.svd(shape.axis[None])[2][1:]
        ring = np.cos(angle)[:, None] * across[0] + np.sin(angle)[:, None] * across[1]
        top = shape.foot + shape.height * shape.axis
        return [
            Face(stone, (0,), shape.foot + 0.5 * shape.bottom * ring, -shape.axis),
            Face(stone, (1,), top + 0.5 * shape.top * ring, shape.axis),
        ]
    from scipy.spatial import ConvexHull

    found: Any = ConvexHull(shape.corners)
    normals = found.equations[:, :3]
    beside = [
        (i, k)
        for i, others in enumerate(found.neighbors)
        for k in others.tolist()
        if k > i and normals[i] @ normals[k] > math.cos(facing)
    ]
    group = np.array(_groups(len(normals), beside))
    faces = []
    for kind in np.unique(group):
        corners = shape.corners[found.simplices[group == kind]]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        normal = (area[:, None] * normals[group == kind]).sum(axis=0)
        members = np.unique(found.simplices[group == kind])
        faces.append(Face(stone, tuple(members.tolist()), shape.corners[members], normal / np.linalg.norm(normal)))
    return faces


def _groups(count: int, links: Iterable[tuple[int, ...]]) -> list[int]:
    """Numbers of the groups that links make of ``count`` things."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    one, other = np.array([*links, (0, 0)]).T
    return connected_components(coo_array((np.ones(len(one)), (one, other)), shape=(count, count)))[1].tolist()


def _contacts(faces: Sequence[Face], tolerance: float, closing: float, facing: float) -> dict[tuple[int, int], Closed]:
    """Pairs of faces of different stones that overlap, or are apart, by no more than is closed, by their numbers."""
    stones = sorted({face.stone for face in faces})
    own = {stone: [i for i, face in enumerate(faces) if face.stone == stone] for stone in stones}
    boxes = {k: np.concatenate([faces[i].corners for i in own[k]]) for k in stones}
    low, high = ({k: f(box, axis=0) for k, box in boxes.items()} for f in (np.min, np.max))
    found = {}
    for one, other in combinations(stones, 2):
        if (low[one] > high[other] + closing).any() or (low[other] > high[one] + closing).any():
            continue
        normals = [np.array([faces[i].normal for i in own[k]]) for k in (one, other)]
        for a, b in np.argwhere(normals[0] @ normals[1].T < -math.cos(facing)).tolist():
            pair = own[one][a], own[other][b]
            apart = _apart(faces[pair[0]], faces[pair[1]])
            if apart is not None and apart.max() <= closing and -apart.min() <= tolerance:
                found[pair] = Closed(one, other, max(float(apart.max()), 0.0), max(float(-apart.min()), 0.0))
    return found


def _level(faces: Sequence[Face], contacts: Sequence[tuple[int, int]], tolerance: float) -> list[tuple[int, int]]:
    """Faces in contact that lie in one plane within a tolerance [m], of any stones: those that meet at edges stay apart."""
    order = sorted({i for pair in contacts for i in pair})
    corners = np.concatenate([faces[i].corners for i in order] or [np.zeros((0, 3))])
    owner = np.repeat(np.arange(len(order)), [len(faces[i].corners) for i in order])
    near = np.zeros((len(order), len(order)), dtype=bool)
    for row, i in enumerate(order):
        off = np.zeros(len(order))
        np.maximum.at(off, owner, np.abs((corners - faces[i].corners.mean(axis=0)) @ faces[i].normal))
        near[row] = off <= tolerance
    return [(order[a], order[b]) for a, b in np.argwhere(near & near.T).tolist() if a < b]


def _apart(one: Face, other: Face) -> np.ndarray | None:
    """How far two faces that look at one another are apart at the corners of their overlap [m]; None where there is none."""
    normal = one.normal - other.normal
    normal = normal / np.linalg.norm(normal)
    across = np.linalg.svd(normal[None])[2][1:]
    if across[0] @ np.cross(across[1], normal) < 0.0:
        across = across[::-1]
    flat = [hull(face.corners @ across.T) for face in (one, other)]
    over = flat[0]
    for corner, after in zip(flat[1], np.roll(flat[1], -1, axis=0), strict=True):
        outward = np.array([after[1] - corner[1], corner[0] - after[0]])
        over = cut(over, outward, float(outward @ corner))
        if len(over) < 3:
            return None
    if _area(over) <= CONTACT * min(map(_area, flat)):
        return None
    levels = []
    for face in (one, other):  # heights of its plane over the corners of the overlap
        slope = across @ face.normal / (face.normal @ normal)
        middle = face.corners.mean(axis=0)
        levels.append(middle @ normal - (over - across @ middle) @ slope)
    return levels[1] - levels[0]


def _area(polygon: np.ndarray) -> float:
    x, y = (polygon - polygon[0]).T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def _planes(on: Mapping[int, Sequence[Face]], ground: float | None) -> dict[int, Plane]:
    """Parallel planes of the least squares of the corners of faces, by the names of their groups."""
    corners = {name: np.concatenate([face.corners for face in faces if face.stone >= 0]) for name, faces in on.items()}
    middles = {name: points.mean(axis=0) for name, points in corners.items()}
    level = next((name for name, faces in on.items() if any(face.stone < 0 for face in faces)), None)
    if level is None or ground is None:
        normal = np.linalg.svd(np.concatenate([corners[name] - middles[name] for name in on]))[2][-1]
        return {name: (normal, float(normal @ middles[name])) for name in on}
    upward = np.array([0.0, 0.0, 1.0])
    return {name: (upward, ground if name == level else float(middles[name][2])) for name in on}


def _on_planes(shape: Frustum | Hull, planes: Sequence[tuple[tuple[int, ...], Plane]]) -> tuple[Frustum | Hull, float]:
    """A stone with faces on planes, and how far its corners moved at most [m]."""
    if not planes:
        return shape, 0.0
    if isinstance(shape, Hull):
        new = shape.corners.copy()
        for corner in {one for members, _ in planes for one in members}:
            normals, levels = zip(*(plane for members, plane in planes if corner in members), strict=True)
            a, b = np.array(normals), np.array(levels)
            new[corner] += np.linalg.lstsq(a, b - a @ new[corner], rcond=EDGE)[0]
        return shape._replace(corners=new), float(np.linalg.norm(new - shape.corners, axis=1).max())
    axis = planes[0][1][0]
    axis = axis if axis @ shape.axis > 0.0 else -axis
    middle, ends = shape.foot + 0.5 * shape.height * shape.axis, [-0.5 * shape.height, 0.5 * shape.height]
    for (end,), (normal, level) in planes:
        ends[end] = (level - float(normal @ middle)) / float(normal @ axis)
    new = shape._replace(foot=middle + ends[0] * axis, axis=axis, height=ends[1] - ends[0])
    feet, tops = (np.array([one.foot + share * one.height * one.axis for one in (shape, new)]) for share in (0.0, 1.0))
    turned = 0.5 * max(shape.bottom, shape.top) * float(np.linalg.norm(axis - shape.axis))
    return new, turned + float(max(np.linalg.norm(np.diff(feet, axis=0)), np.linalg.norm(np.diff(tops, axis=0))))
