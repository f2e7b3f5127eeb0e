"""Stones from meshes: the frustum that fits a drum, or the convex hull, each with how far the mesh is from it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from stylobate.column.drum import LENGTHS
from stylobate.column.shapes import Mesh, cut, hull
from stylobate.column.spatial.stone import MOST_CORNERS, MeshPart, mesh_moments
from stylobate.errors import InputError

#: Between two corners a drum's side lies this share of its radius within the circle at most: twelve corners or more.
FLAT = 1.0 - math.cos(math.radians(15.5))

#: A drum is filled by its mesh to this share: twelve corners leave 4.5 % of a circle out.
FILLED = (0.94, 1.06)

#: Most corners that a frustum is fitted to; the distance of all is told.
MOST = 4000

#: Corners that are left of a hull that has too many.
FEW_CORNERS = 160

#: Rounds of fitting, each with faces told apart by the fit before it.
ROUNDS = 5

#: Number of the side among the three surfaces of a frustum.
SIDE = 2


class Frustum(NamedTuple):
    """A round drum in space.

    Parameters
    ----------
    foot : array
        Middle of its lower face [m], shape (3,).
    axis : array
        Unit vector from there to the middle of its upper face [-], shape (3,).
    bottom, top, height : float
        Diameters and height [m].
    residual : float
        Largest distance of the mesh from it, but for what lies evenly between corners [m].
    flat : float
        How far the sides of the mesh lie within it between their corners: the median of its faces [m].
    filled : float
        Volume of the mesh, as a share of its own [-].
    """

    foot: np.ndarray
    axis: np.ndarray
    bottom: float
    top: float
    height: float
    residual: float
    flat: float
    filled: float

    @property
    def lowest(self) -> float:
        """Level of its lowest point [m]."""
        lean, top = 0.5 * math.hypot(*self.axis[:2]), self.foot[2] + self.height * self.axis[2]
        return float(min(self.foot[2] - lean * self.bottom, top - lean * self.top))


class Hull(NamedTuple):
    """The convex hull of a mesh.

    Parameters
    ----------
    corners : array
        [m], shape (k, 3).
    residual : float
        How far the mesh lies within it at most [m].
    filled : float
        Volume of the mesh, as a share of its own [-].
    drum : Frustum or None
        The drum that fits best, and not well enough; None of what is not round at all.
    bent : str
        The face whose corners are farthest out of one plane, and by how much, in words; empty where all are plane.
    """

    corners: np.ndarray
    residual: float
    filled: float
    drum: Frustum | None = None
    bent: str = ""

    @property
    def lowest(self) -> float:
        """Level of its lowest point [m]."""
        return float(self.corners[:, 2].min())


def in_use(mesh: Mesh) -> Mesh:
    """A surface with only the vertices that its faces use."""
    used = sorted({i for face in mesh.faces for i in face})
    numbers = {old: new for new, old in enumerate(used)}
    return Mesh(mesh.vertices[used], tuple(tuple(numbers[i] for i in face) for face in mesh.faces))


def hull_of(part: MeshPart, what: str, drums: bool) -> Hull:
    """The hull of a part with the drum that fits it best, if it may be one, whatever their distances.

    Raises
    ------
    InputError
        The part is no solid.
    """
    mesh = in_use(Mesh(part.points, part.faces))
    volume = mesh_moments(mesh, 1.0).mass
    if not volume > LENGTHS[0] ** 3:
        inside = " its faces run clockwise: turn them round." if volume < 0.0 else " give a solid."
        raise InputError(f"{what} encloses {volume:.3g} m³;{inside}")
    drum = fit_frustum(mesh, volume) if drums else None
    return fit_hull(mesh, volume, what)._replace(drum=drum, bent=_bent(part))


def _bent(part: MeshPart) -> str:
    """The face of a part that is least plane, in words; empty where all are."""
    off = []
    for face in part.faces:
        corners = part.points[list(face)]
        corners = corners - corners.mean(axis=0)
        off.append(0.0 if len(face) == 3 else float(np.abs(corners @ np.linalg.svd(corners)[2][-1]).max()))
    worst = int(np.argmax(off))
    return f", and its {part.face(worst)} is out of plane by {1e3 * off[worst]:.3g} mm" if off[worst] > 1e-6 else ""


def within_tolerance(hull: Hull, tolerance: float, what: str) -> Frustum | Hull:
    """The drum of a part if it is no farther from it than the tolerance [m], or else the hull.

    Raises
    ------
    InputError
        The part is not convex by more than the tolerance.
    """
    drum = hull.drum
    if drum is not None and drum.residual <= tolerance:
        return drum
    if hull.residual > tolerance:
        drum_note = "" if drum is None else f", and a drum does not fit it by {1e3 * drum.residual:.3g} mm"
        raise InputError(
            f"{what} is not convex: it lies {1e3 * hull.residual:.3g} mm within its hull{drum_note}{hull.bent}; allowed are "
            f"{1e3 * tolerance:g} mm: split it into convex parts.",
            "tolerance",
        )
    return hull


def fit_hull(mesh: Mesh, volume: float, what: str) -> Hull:
    """The hull of a mesh, and the depth of the mesh within it [m]: of a vertex, or its mean where that is more."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        convex_hull: Any = ConvexHull(mesh.vertices)
    except QhullError:
        raise InputError(f"{what} lies in one plane and has no thickness; give a solid.") from None
    planes, points = convex_hull.equations, _points_on(mesh)
    batches = np.array_split(points, 1 + len(points) * len(planes) // 10_000_000)
    deepest = max(0.0, *(float(-(batch @ planes[:, :3].T + planes[:, 3]).max(axis=1).min()) for batch in batches))
    depth = max(deepest, float(convex_hull.volume - volume) / float(convex_hull.area))
    corners = mesh.vertices[np.sort(convex_hull.vertices)]
    if len(corners) <= MOST_CORNERS:
        return Hull(corners, depth, volume / float(convex_hull.volume))
    corners, out = _thinned(corners)
    return Hull(corners, max(depth, out), volume / float(ConvexHull(corners).volume))


def _thinned(corners: np.ndarray) -> tuple[np.ndarray, float]:
    """Corners of a hull without those that reach least beyond the others, and how far these do [m]."""
    from scipy.spatial import ConvexHull

    ways = np.array([way for way in np.ndindex(3, 3, 3) if way != (1, 1, 1)]) - 1.0
    kept = np.unique((corners @ ways.T).argmax(axis=0)).tolist()
    convex_hull: Any = ConvexHull(corners[kept], incremental=True)
    while True:
        out = (corners @ convex_hull.equations[:, :3].T + convex_hull.equations[:, 3]).max(axis=1)
        farthest = int(out.argmax())
        if len(kept) >= FEW_CORNERS or farthest in kept:
            return corners[np.sort(kept)], max(0.0, float(out[farthest]))
        kept.append(farthest)
        convex_hull.add_points(corners[[farthest]])


def _points_on(mesh: Mesh) -> np.ndarray:
    """Vertices, middles of edges and of faces [m], shape (k, 3): the edge within an L has its ends on the hull."""
    edges = {(min(edge), max(edge)) for face in mesh.faces for edge in zip(face, (*face[1:], face[0]), strict=True)}
    middles = mesh.vertices[np.array(sorted(edges))].mean(axis=1)
    return np.concatenate((mesh.vertices, middles, [mesh.vertices[list(face)].mean(axis=0) for face in mesh.faces]))


def fit_frustum(mesh: Mesh, volume: float) -> Frustum | None:
    """The frustum of the least squares of the distances of corners from it; None of what is not round.

    A corner is as far from it as from the lower face, the upper one, or the side: from all of them to which faces of the
    mesh belong that meet there. The axis begins as whichever principal axis, or the vertical, brings the corners nearest.

    Parameters
    ----------
    mesh : Mesh
    volume : float
        That it encloses [m³].
    """
    from scipy.optimize import least_squares

    moments = mesh_moments(mesh, 1.0)
    points, centre = mesh.vertices - moments.centroid, moments.centroid
    corner, owner = np.concatenate(mesh.faces), np.repeat(np.arange(len(mesh.faces)), [len(f) for f in mesh.faces])
    middles = np.array([points[list(face)].mean(axis=0) for face in mesh.faces])
    axes = [*np.linalg.eigh(moments.tensor)[1].T, np.array([0.0, 0.0, 1.0])]
    starts = [_start(points, axis) for axis in axes]
    frame, values = min(starts, key=lambda start: float(np.square(_distances(points, *start)).sum()))
    size = float(np.ptp(points, axis=0).max())
    kinds = sides = np.zeros(0, dtype=int)
    for _ in range(ROUNDS):
        costs = np.square(_from_surfaces(middles, frame, values))
        np.add.at(costs, owner, np.square(_from_surfaces(points, frame, values))[corner])
        least, second = np.sort(costs, axis=1)[:, :2].T
        new_kinds = np.where(
            4.0 * least <= second, costs.argmin(axis=1), -1
        )  # a face across an edge belongs to neither side
        if np.array_equal(new_kinds, kinds):
            break
        kinds = new_kinds
        sides = np.unique(np.stack((corner, kinds[owner]))[:, kinds[owner] >= 0], axis=1)
        if len(np.unique(sides[1])) < 3:
            return None
        sample = sides[:, :: max(1, len(sides[0]) // MOST)]

        def misfit(x: np.ndarray, subset: np.ndarray = sample) -> np.ndarray:
            return _from_surfaces(points[subset[0]], frame, x)[np.arange(len(subset[0])), subset[1]] / size

        values = least_squares(misfit, values, x_scale=size, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=60).x
        _, _, (low, high, bottom, top) = _unpacked(frame, values)
        if high - low < LENGTHS[0] or min(bottom, top) < 0.5 * LENGTHS[0]:
            return None
    foot, axis, (low, high, bottom, top) = _unpacked(frame, values)
    if axis[2] < 0.0:
        axis, low, high, bottom, top = -axis, -high, -low, top, bottom
    corners = np.abs(_from_surfaces(points[sides[0]], frame, values)[np.arange(len(sides[0])), sides[1]])
    depth = np.abs(_from_surfaces(middles, frame, values)[:, 2])
    flat = float(np.median(depth[kinds == SIDE]))
    between = np.maximum(_distances(_points_on(Mesh(points, mesh.faces)), frame, values) - flat, 0.0)
    filled = volume / (math.pi * (high - low) * (bottom**2 + bottom * top + top**2) / 3.0)
    if flat > FLAT * max(bottom, top) or not FILLED[0] <= filled <= FILLED[1]:
        return None
    axis = np.where(np.abs(axis) < 1e-9, 0.0, axis)
    axis = axis / np.linalg.norm(axis)
    residual = float(max(corners.max(), between.max()))
    return Frustum(centre + foot + low * axis, axis, 2.0 * bottom, 2.0 * top, high - low, residual, flat, filled)


def _start(points: np.ndarray, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Axes around a first axis as columns, and the first values of the eight numbers of a frustum."""
    across = np.cross(axis, np.eye(3)[int(np.abs(axis).argmin())])
    across /= np.linalg.norm(across)
    frame = np.stack((across, np.cross(axis, across), axis), axis=1)
    along, radius = points @ axis, np.linalg.norm(points @ frame[:, :2], axis=1)
    low, high = float(along.min()), float(along.max())
    third = 0.3 * (high - low)
    ends = [float(radius[near].max()) for near in (along <= low + third, along >= high - third)]
    return frame, np.array([0.0, 0.0, 0.0, 0.0, low, high, *ends])


def _unpacked(
    frame: np.ndarray, values: np.ndarray
) -> tuple[np.ndarray, np.ndarray, tuple[float, float, float, float]]:
    """A point of the axis, the axis, and its two ends along it and two radii."""
    aside, lean = values[:2], values[2:4]
    axis = frame @ (*lean, 1.0)
    low, high, bottom, top = (float(value) for value in values[4:])
    return frame[:, :2] @ aside, axis / np.linalg.norm(axis), (low, high, bottom, top)


def _from_surfaces(points: np.ndarray, frame: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Distances of points from the planes of the lower and the upper face and the cone of the side [m], shape (n, 3)."""
    foot, axis, (low, high, bottom, top) = _unpacked(frame, values)
    along = (points - foot) @ axis
    radius = np.linalg.norm(points - foot - np.outer(along, axis), axis=1)
    slope = (top - bottom) / (high - low)
    side = (radius - bottom - slope * (along - low)) / math.hypot(1.0, slope)
    return np.stack((along - low, along - high, side), axis=1)


def _distances(points: np.ndarray, frame: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Distances of points from the surface of a frustum: from the nearest of its two faces and its side [m]."""
    foot, axis, (low, high, bottom, top) = _unpacked(frame, values)
    along = (points - foot) @ axis
    radius = np.linalg.norm(points - foot - np.outer(along, axis), axis=1)
    side = np.array([top - bottom, high - low])
    share = np.clip(((radius - bottom) * side[0] + (along - low) * side[1]) / float(side @ side), 0.0, 1.0)
    from_side = np.hypot(radius - bottom - share * side[0], along - low - share * side[1])
    from_faces = [np.hypot(np.maximum(radius - r, 0.0), along - t) for t, r in ((low, bottom), (high, top))]
    return np.minimum(from_side, np.minimum(*from_faces))


# Faces of stones that touch, brought into common planes: gaps and overlaps below a tolerance are closed.

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

    first: int
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
    on = {name: [face for face, number in zip(faces, group, strict=True) if number == name] for name in touching}
    ends: dict[int, dict[int, int]] = {}
    for name in touching:
        for face in on[name]:
            for member in face.members:
                ends.setdefault(face.stone, {})[member] = name
    pairs = [
        tuple(stone_ends.values())
        for stone, stone_ends in ends.items()
        if stone >= 0 and isinstance(shapes[stone], Frustum) and len(stone_ends) == 2
    ]
    alike = _groups(len(faces), pairs)
    planes: dict[int, Plane] = {}
    for kind in {alike[name] for name in touching}:
        planes |= _planes({name: on[name] for name in touching if alike[name] == kind}, ground)
    moved, most, kept = list(shapes), 0.0, set[int]()
    for stone, shape in enumerate(shapes):
        own_planes = [
            (face.members, planes[group[i]])
            for i, face in enumerate(faces)
            if face.stone == stone and group[i] in planes
        ]
        new, shift = _on_planes(shape, own_planes)
        if shift <= max(tolerance, closing):
            moved[stone], most = new, max(most, shift)
        else:
            kept.add(stone)
    return moved, most, [closure for closure in closed.values() if not kept & {closure.first, closure.other}]


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

    convex_hull: Any = ConvexHull(shape.corners)
    normals = convex_hull.equations[:, :3]
    beside = [
        (i, k)
        for i, others in enumerate(convex_hull.neighbors)
        for k in others.tolist()
        if k > i and normals[i] @ normals[k] > math.cos(facing)
    ]
    group = np.array(_groups(len(normals), beside))
    faces = []
    for kind in np.unique(group):
        corners = shape.corners[convex_hull.simplices[group == kind]]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        normal = (area[:, None] * normals[group == kind]).sum(axis=0)
        members = np.unique(convex_hull.simplices[group == kind])
        faces.append(Face(stone, tuple(members.tolist()), shape.corners[members], normal / np.linalg.norm(normal)))
    return faces


def _groups(count: int, links: Iterable[tuple[int, ...]]) -> list[int]:
    """Numbers of the groups that links make of ``count`` things."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    first, other = np.array([*links, (0, 0)]).T
    return connected_components(coo_array((np.ones(len(first)), (first, other)), shape=(count, count)))[1].tolist()


def _contacts(faces: Sequence[Face], tolerance: float, closing: float, facing: float) -> dict[tuple[int, int], Closed]:
    """Pairs of faces of different stones that overlap, or are apart, by no more than is closed, by their numbers."""
    stones = sorted({face.stone for face in faces})
    own = {stone: [i for i, face in enumerate(faces) if face.stone == stone] for stone in stones}
    boxes = {k: np.concatenate([faces[i].corners for i in own[k]]) for k in stones}
    low, high = ({k: f(box, axis=0) for k, box in boxes.items()} for f in (np.min, np.max))
    contacts = {}
    for stone, other in combinations(stones, 2):
        if (low[stone] > high[other] + closing).any() or (low[other] > high[stone] + closing).any():
            continue
        normals = [np.array([faces[i].normal for i in own[k]]) for k in (stone, other)]
        for a, b in np.argwhere(normals[0] @ normals[1].T < -math.cos(facing)).tolist():
            pair = own[stone][a], own[other][b]
            apart = _apart(faces[pair[0]], faces[pair[1]])
            if apart is not None and apart.max() <= closing and -apart.min() <= tolerance:
                contacts[pair] = Closed(stone, other, max(float(apart.max()), 0.0), max(float(-apart.min()), 0.0))
    return contacts


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


def _apart(first: Face, other: Face) -> np.ndarray | None:
    """How far two faces that look at one another are apart at the corners of their overlap [m]; None where there is none."""
    normal = first.normal - other.normal
    normal = normal / np.linalg.norm(normal)
    across = np.linalg.svd(normal[None])[2][1:]
    if across[0] @ np.cross(across[1], normal) < 0.0:
        across = across[::-1]
    flat = [hull(face.corners @ across.T) for face in (first, other)]
    over = flat[0]
    for corner, after in zip(flat[1], np.roll(flat[1], -1, axis=0), strict=True):
        outward = np.array([after[1] - corner[1], corner[0] - after[0]])
        over = cut(over, outward, float(outward @ corner))
        if len(over) < 3:
            return None
    if _area(over) <= CONTACT * min(map(_area, flat)):
        return None
    levels = []
    for face in (first, other):  # heights of its plane over the corners of the overlap
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
        for corner in {member for members, _ in planes for member in members}:
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
    feet, tops = (
        np.array([frustum.foot + share * frustum.height * frustum.axis for frustum in (shape, new)])
        for share in (0.0, 1.0)
    )
    turned = 0.5 * max(shape.bottom, shape.top) * float(np.linalg.norm(axis - shape.axis))
    return new, turned + float(max(np.linalg.norm(np.diff(feet, axis=0)), np.linalg.norm(np.diff(tops, axis=0))))
