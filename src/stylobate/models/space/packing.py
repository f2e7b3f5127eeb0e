"""Assemblies in space as the engine wants them: bodies as plain numbers, laws between them, joints of their faces, links."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...column.links.placed import PlacedLink
from ...column.shapes import CircularFrustum, Mesh, Placed, cut, matrix_of
from ...column.spatial.touching import SpaceJoint
from ...column.structure import Structure
from ...kernels.shared.records import NUMBERS, OWN, SHARED
from ...kernels.space.records import BLOCK, DRUM, FACETS, GROUND, LESS, MOST_FACES, MOST_VERTICES, types
from ..drums.links import LinkStiffness, law_fields, link_matrices
from ..shared.stable_step import highest_frequency

#: A face of a part is an inner one where others of its body cover it to this share of its area and of its size.
COVERED = 1e-6

#: Corners around the end of a drum where it is looked for what covers it.
AROUND = 24

#: Shares of the tilt at which faces have parted: from which on they hand over, and beyond which they part as soon as they
#: open; so they do with less than this share of their overlap at the start.
HANDING_OVER, APART, LEFT = 0.7, 0.4, 0.3


class Drum(NamedTuple):
    """A frustum of a cone: middle of its lower face [m], unit axis, height and both radii [m], in the axes of its body."""

    foot: np.ndarray
    axis: np.ndarray
    height: float
    bottom: float
    top: float


class HalfSpace(NamedTuple):
    """All that is below the origin of its body, across the third of its axes."""


class Solid(NamedTuple):
    """A rigid body of convex parts.

    Parameters
    ----------
    parts : sequence of Mesh, Drum or HalfSpace
        In the axes of the body, from its centroid.
    place : array
        Centroid [m], shape (3,).
    axes : array
        Axes of the body as columns, shape (3, 3).
    mass : float
        [kg]; 0 of what moves with the ground.
    inertia : array
        About the centroid, in the axes of the body [kg m²], shape (3, 3).
    velocity, spin : array
        [m/s], [rad/s], shape (3,).
    """

    parts: Sequence[Mesh | Drum | HalfSpace]
    place: np.ndarray
    axes: np.ndarray
    mass: float = 0.0
    inertia: np.ndarray = np.eye(3)
    velocity: np.ndarray = np.zeros(3)
    spin: np.ndarray = np.zeros(3)


class Face(NamedTuple):
    """A plane face of a body, in the axes of the body, from its centroid.

    Parameters
    ----------
    middle : array
        [m], shape (3,).
    frame : array
        Two directions along the face and its outward normal as columns, shape (3, 3).
    corners : array
        Along the face from its middle, counter-clockwise seen from outside [m], shape (k, 2); none of a disc.
    radius : float
        Of a disc [m].
    """

    middle: np.ndarray
    frame: np.ndarray
    corners: np.ndarray
    radius: float = 0.0

    @property
    def area(self) -> float:
        """[m²]"""
        if not len(self.corners):
            return math.pi * self.radius**2
        x, y = self.corners.T
        return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


class FacesJoined(NamedTuple):
    """A joint of two faces: numbers of their parts over all bodies, the faces, k_n, k_s [N/m³], tan φ, cohesion [Pa], the
    relative tilt at which they have parted [rad], and their overlap at the start, by default the smaller face [m²]."""

    lower: int
    upper: int
    below: Face
    above: Face
    kn: float
    ks: float
    tan_phi: float
    cohesion: float
    last: float
    over: float = math.inf


class Packed(NamedTuple):
    """Records and arrays of bodies, as the kernels want them; ``turn`` leads from the axes of each body to its principal
    ones, as columns."""

    body: np.ndarray
    shape: np.ndarray
    vertex: np.ndarray
    plane: np.ndarray
    loop: np.ndarray
    corner: np.ndarray
    turn: np.ndarray


def principal(inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Moments about the principal axes i, j, k of a body [kg m²], and these as columns; k is the one that stands out."""
    moments, axes = np.linalg.eigh(inertia)
    if np.allclose(inertia, np.diag(np.diag(inertia)), rtol=0.0, atol=1e-12 * float(moments[-1])):
        moments, axes = np.diag(inertia).copy(), np.eye(3)
    order = np.argsort(moments)
    alone = order[0] if moments[order[1]] - moments[order[0]] > moments[order[2]] - moments[order[1]] else order[2]
    turn = [(alone + 1) % 3, (alone + 2) % 3, alone]
    axes = axes[:, turn]
    return moments[turn], axes * np.array([1.0, 1.0, np.linalg.det(axes)])


def pack(solids: Sequence[Solid]) -> Packed:
    """The arrays of bodies in their order."""
    kinds = types()
    body, rows = np.zeros(len(solids), kinds["body"]), _Rows()
    turns = np.empty((len(solids), 3, 3))
    for i, (solid, u) in enumerate(zip(solids, body, strict=True)):
        moments, turn = principal(solid.inertia) if solid.mass else (np.ones(3), np.eye(3))
        turns[i], axes = turn, solid.axes @ turn
        u["fixed"] = 0 if solid.mass else 1
        if solid.mass:
            u["m"], u["im"] = solid.mass, 1.0 / solid.mass
            b, a, c = moments
            u["ia"], u["ib"], u["ic"] = 1.0 / a, 1.0 / b - 1.0 / a, 1.0 / c - 1.0 / a
        momentum = axes @ (moments * (axes.T @ solid.spin)) * (1.0 if solid.mass else 0.0)
        for c, name in enumerate("xyz"):
            u[name], u["v" + name], u["w" + name], u["l" + name] = (
                solid.place[c],
                solid.velocity[c],
                solid.spin[c],
                momentum[c],
            )
            for k, axis in enumerate("ijk"):
                u[axis + name] = axes[c, k]
        inner = inner_faces(solid.parts)
        u["r"] = max(rows.add(i, part, turn, faces) for part, faces in zip(solid.parts, inner, strict=True))
    return Packed(body, *rows.arrays(kinds), turns)


class _Rows:
    """Shapes and the rows of vertices, planes, loops and corners that they share."""

    def __init__(self) -> None:
        self.shapes: list[dict[str, Any]] = []
        self.vertices: list[np.ndarray] = []
        self.planes: list[np.ndarray] = []
        self.loops: list[tuple[int, ...]] = []
        self.inner: list[bool] = []

    def add(self, body: int, part: Mesh | Drum | HalfSpace, turn: np.ndarray, inner: Sequence[bool]) -> float:
        """Add a part of a body, and which of its faces are inner ones; returns the distance of its farthest point from the
        centroid [m]."""
        self.inner += inner
        if isinstance(part, HalfSpace):
            self.shapes.append({"body": body, "kind": GROUND, "face": len(self.loops), "faces": 1, "r": 1e9})
            self.loops.append((0, 1, 2, 3))
            self.planes.append(np.zeros(4))
            return 1e9
        if isinstance(part, Drum):
            foot, axis = turn.T @ part.foot, turn.T @ part.axis
            rim = np.array([np.hypot(0.5 * part.height, radius) for radius in (part.bottom, part.top)])
            middle = foot + 0.5 * part.height * axis
            numbers = {"m": middle, "r": rim.max(), "c": foot, "e": axis, "h": part.height}
            face = self._drum_faces()
            self.shapes.append(
                {"body": body, "kind": DRUM, "rb": part.bottom, "rt": part.top, "face": face, "faces": FACETS + 2}
                | numbers
            )
            return float(np.linalg.norm(middle) + rim.max())
        vertices = np.asarray(part.vertices) @ turn
        if len(vertices) > MOST_VERTICES or len(part.faces) > MOST_FACES:
            raise ValueError(f"{len(vertices)} vertices, {len(part.faces)} faces")
        middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
        self.shapes.append(
            {
                "body": body,
                "kind": BLOCK,
                "first": sum(map(len, self.vertices)),
                "count": len(vertices),
                "face": len(self.loops),
                "faces": len(part.faces),
                "m": middle,
                "r": float(np.linalg.norm(vertices - middle, axis=1).max()),
            }
        )
        self.vertices.append(vertices)
        self.loops += part.faces
        self.planes += [plane_of(vertices[list(face)]) for face in part.faces]
        return float(np.linalg.norm(vertices, axis=1).max())

    def _drum_faces(self) -> int:
        """Where the faces of the prism are that stands for a drum: facets, and both ends."""
        first, n = len(self.loops), FACETS
        self.loops += [(k, (k + 1) % n, n + (k + 1) % n, n + k) for k in range(n)]
        self.loops += [tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n))]
        self.planes += [np.zeros(4)] * (n + 2)
        return first

    def arrays(self, kinds: dict[str, np.dtype]) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Shapes, vertices, planes, loops, corners."""
        shape, loop = np.zeros(len(self.shapes), kinds["shape"]), np.zeros(len(self.loops), kinds["loop"])
        for row, numbers in zip(shape, self.shapes, strict=True):
            for name, value in numbers.items():
                row[name] = value
        loop["count"], loop["inner"] = [len(face) for face in self.loops], self.inner
        loop["first"] = np.cumsum([0, *loop["count"]])[:-1]
        vertices = np.concatenate(self.vertices) if self.vertices else np.zeros((1, 3))
        corners = np.array([k for face in self.loops for k in face], dtype=np.int64)
        return shape, np.ascontiguousarray(vertices), np.array(self.planes), loop, corners


def inner_faces(parts: Sequence[Mesh | Drum | HalfSpace]) -> list[list[bool]]:
    """Of every part of a body which of its faces are all covered by faces of other ones; of drums the two ends come last."""
    ends = [_flat_faces(part) for part in parts]
    covered = []
    for part, mine in zip(parts, ends, strict=True):
        others = [face for faces in ends if faces is not mine for face in faces]
        before = FACETS if isinstance(part, Drum) else 0
        covered.append([False] * before + [_covered(face, others) for face in mine])
    return covered


def _flat_faces(part: Mesh | Drum | HalfSpace) -> list[np.ndarray]:
    """Corners of the plane faces of a part, counter-clockwise seen from outside [m], shape (k, 3) each."""
    if isinstance(part, Mesh):
        return [np.asarray(part.vertices)[list(face)] for face in part.faces]
    if isinstance(part, HalfSpace):
        return [np.zeros((3, 3))]
    radial = np.cross(part.axis, np.eye(3)[np.argmin(np.abs(part.axis))])
    radial /= np.linalg.norm(radial)
    angle = 2.0 * math.pi * np.arange(AROUND)[:, None] / AROUND
    ring = np.cos(angle) * radial + np.sin(angle) * np.cross(part.axis, radial)
    top = part.foot + part.height * part.axis
    return [part.foot + part.bottom * ring[::-1], top + part.top * ring]


def _covered(face: np.ndarray, others: Sequence[np.ndarray]) -> bool:
    """Whether faces that look the other way, in the same plane, cover a face."""
    plane, covered_area = plane_of(face) if others else np.zeros(4), 0.0
    area = _area(face)
    near = COVERED * math.sqrt(area)
    for other in others:
        opposite = plane_of(other)
        if opposite[:3] @ plane[:3] > COVERED - 1.0 or np.abs(other @ plane[:3] - plane[3]).max() > near:
            continue
        common = other
        for p, q in zip(face, np.roll(face, -1, axis=0), strict=True):
            outward = np.cross(q - p, plane[:3])
            common = cut(common, outward, float(outward @ p)) if len(common) else common
        covered_area += _area(common)
    return covered_area > (1.0 - COVERED) * area > 0.0


def _area(polygon: np.ndarray) -> float:
    """Area of a plane polygon in space [m²]."""
    if len(polygon) < 3:
        return 0.0
    p = polygon - polygon[0]
    return 0.5 * float(np.linalg.norm(np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)))


def pack_joints(joints: Sequence[FacesJoined], packed: Packed) -> tuple[np.ndarray, np.ndarray]:
    """Records of joints in the order of their shapes, and the corners of all faces, one after another."""
    ordered = sorted(joints, key=lambda joint: (min(joint.lower, joint.upper), max(joint.lower, joint.upper)))
    records, rows, first = np.zeros(len(joints), types()["joint"]), [np.zeros((1, 2))], 1
    for e, joint in zip(records, ordered, strict=True):
        e["a"], e["b"] = joint.lower, joint.upper
        sides = (("l", joint.lower, joint.below, 1.0, LESS), ("u", joint.upper, joint.above, -1.0, 1.0))
        for side, shape, face, way, size in sides:
            turn = packed.turn[packed.shape["body"][shape]].T
            # seen from above, the upper face's frame is turned over about its first direction
            e["m" + side], e["i" + side], e["j" + side] = (
                turn @ face.middle,
                turn @ face.frame[:, 0],
                way * turn @ face.frame[:, 1],
            )
            corners = face.corners if way > 0.0 else (face.corners * (1.0, -1.0))[::-1]
            e["first_" + side], e["many_" + side], e["r" + side] = first, len(corners), face.radius
            rows.append(size * corners)
            first += len(corners)
        e["kn"], e["ks"], e["tan"], e["co"] = joint.kn, joint.ks, joint.tan_phi, joint.cohesion
        e["width"] = min(joint.below.area, joint.above.area)
        e["from_c"], e["to_c"], e["apart_c"] = (math.cos(share * joint.last) for share in (HANDING_OVER, 1.0, APART))
        e["apart"] = LEFT * min(joint.over, e["width"])
        e["live"], e["weight"] = 1, 1.0
    return records, np.concatenate(rows)


def plane_of(polygon: np.ndarray) -> np.ndarray:
    """Outward unit normal of a face and its distance from the origin, shape (4,)."""
    after = np.roll(polygon, -1, axis=0)
    normal = np.cross(polygon, after).sum(axis=0)
    normal /= np.linalg.norm(normal)
    return np.append(normal, float((polygon @ normal).mean()))


class Ties(NamedTuple):
    """Arrays of the links as the kernels want them, of as many rows each; see ``kernels/space/records.py``."""

    link: np.ndarray
    bond: np.ndarray
    seat: np.ndarray
    load: np.ndarray


def ties_of(links: tuple[PlacedLink, ...], turn: np.ndarray) -> Ties:
    """Records of links that have not begun.

    Parameters
    ----------
    links : tuple of PlacedLink
        That act.
    turn : array
        From the axes of each body to its principal ones, as columns, shape (N, 3, 3).
    """
    kinds = types()
    ties = Ties(*(np.zeros(len(links), kinds[name]) for name in Ties._fields))
    for name, values in (law_fields(links) if links else {}).items():
        if name in OWN.split():
            ties.link[name][:, 0] = values
        if name in (*NUMBERS.split(), *SHARED.split()):
            ties.bond[name] = values
    for link, k, b in zip(links, ties.link, ties.bond, strict=True):
        b["lower"], b["upper"] = link.lower, link.upper
        k["ft"] = link.pretension
        for end, body, arm in zip("ab", (link.lower, link.upper), link.arms, strict=True):
            for c, value in zip("xyz", turn[body].T @ arm, strict=True):
                k[end + c] = value
        own = turn[link.lower].T @ matrix_of(link.turns[0]).T
        for name, axis in zip("ijk", link.frame, strict=True):
            b[name] = own @ axis
    return ties


def stiffness_of(links: tuple[PlacedLink, ...], root: np.ndarray) -> LinkStiffness:
    """Stiffness of links against the bodies' masses.

    Parameters
    ----------
    links : tuple of PlacedLink
    root : array
        Of the inverse of the mass matrix of all bodies, three places and three turns each, the factor by Cholesky.
    """
    if not links:
        return LinkStiffness(0.0, 0.0)

    def row(link: PlacedLink, way: np.ndarray) -> np.ndarray:
        coefficients, straight = np.zeros(len(root)), link.straight
        points: Any = (link.low, link.high) if straight else (link.middle, link.middle)
        for body, point, origin, sign in zip((link.lower, link.upper), points, link.origins, (-1.0, 1.0), strict=True):
            coefficients[6 * body : 6 * body + 6] = sign * np.concatenate(
                (way, np.cross(np.subtract(point, origin), way))
            )
        return coefficients

    springs, dashpots = (root.T @ matrix @ root for matrix in link_matrices(links, row, len(root)))
    ones = np.ones(len(root))
    return LinkStiffness(highest_frequency(springs, ones), highest_frequency(dashpots, ones) ** 2)


#: Half the side of a face of the ground: no body that stands on it comes to its end [m].
WIDE = 1e3

#: Normals that rise less than this are level: either body of such a joint counts as the lower one.
LEVEL = 1e-6

#: Relative tilt from which faces that lay on one another are a bed like all others [rad].
LAST_TILT = math.radians(50.0)


def solids_of(structure: Structure) -> tuple[list[Solid], np.ndarray]:
    """Bodies of an assembly in space in their order, and the number of the first part of each, shape (N + 1,)."""
    solids = []
    for body in structure.bodies:
        stone: Any = body
        if getattr(stone, "pieces", None) is None:
            solids.append(Solid([HalfSpace()], np.array([0.0, 0.0, structure.ground]), np.eye(3)))
            continue
        mass = 0.0 if stone.fixed else stone.mass
        solids.append(
            Solid(
                [part_of(piece) for piece in stone.pieces],
                np.array(stone.position),
                stone.axes,
                mass,
                stone.inertia_tensor if mass else np.eye(3),
                np.array(stone.velocity),
                np.array(stone.angular_velocity),
            )
        )
    return solids, np.cumsum([0, *(len(solid.parts) for solid in solids)])


def part_of(part: Placed) -> Any:
    """A convex part in the axes of its body: exact where it is a round drum, else its surface."""
    shape, turned = part.shape, matrix_of(part.orientation)
    if isinstance(shape, CircularFrustum):
        foot = np.array(part.place) - shape.centroid * turned[:, 2]
        return Drum(foot, turned[:, 2], shape.height, 0.5 * shape.bottom, 0.5 * shape.top)
    return part.mesh(AROUND)


def joints_of(structure: Structure, solids: list[Solid], first: np.ndarray) -> list[FacesJoined]:
    """Joints of the faces that lie on one another at the start."""
    joints = []
    for joint in structure.joined_faces:
        lower, upper = solids[joint.lower], solids[joint.upper]
        ground = isinstance(lower.parts[0], HalfSpace)
        sides = [
            (int(first[joint.lower]) + joint.lower_part, _level(joint, lower) if ground else _face(joint.below, lower)),
            (int(first[joint.upper]) + joint.upper_part, _face(joint.above, upper)),
        ]
        (low, below), (high, above) = sides[::-1] if turned_over(joint) else sides
        law = joint.law
        joints.append(
            FacesJoined(
                low,
                high,
                below,
                above,
                law.normal_stiffness,
                law.shear_stiffness,
                law.tan_phi,
                law.cohesion,
                LAST_TILT,
                joint.area,
            )
        )
    return joints


def turned_over(joint: SpaceJoint) -> bool:
    """Whether the second body of a joint is under the first one, however they are numbered."""
    return bool(joint.frame[2, 2] < -LEVEL)


def _face(face: Any, solid: Solid) -> Face:
    """A face from space into the axes of its body; a disc where nothing but a circle bounds it."""
    middle = solid.axes.T @ (face.middle - solid.place)
    frame = solid.axes.T @ face.frame
    if face.edges.discs and not len(face.edges.sides):
        offset, radius = face.edges.discs[0]
        return Face(middle + frame[:, :2] @ offset, frame, np.zeros((0, 2)), float(radius))
    return Face(middle, frame, face.corners)


def _level(joint: Any, ground: Solid) -> Face:
    """The face of the ground under a joint, without ends."""
    corners = WIDE * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return Face(joint.origin - ground.place, joint.frame, corners)
