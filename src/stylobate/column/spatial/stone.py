"""Stones: convex parts that are one body, where it stands, with mass and moments."""

from __future__ import annotations

import io
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, as_typed, check_all, check_kind, check_name, check_range
from ...text_tables import printable, read_bytes
from ..drum import DENSITIES, LENGTHS, Drum
from ..joint import Joint
from ..plausible import bulk_doubts
from ..shapes import (
    UPRIGHT,
    Chipped,
    CircularFrustum,
    ConvexSolid,
    Glued,
    Mesh,
    Outlined,
    Placed,
    Quaternion,
    RectangularFrustum,
    Shape,
    hull,
    matrix_of,
    narrowest,
    product,
)


class Moments(NamedTuple):
    """Mass [kg], centroid [m], shape (3,), and tensor of inertia about it [kg m²], shape (3, 3)."""

    mass: float
    centroid: np.ndarray
    tensor: np.ndarray


def moments_of(shape: Any, density: float) -> Moments:
    """Of a shape in its own axes, from its own origin; a chip keeps mass and inertia of its drum, as everywhere."""
    whole = shape.whole if isinstance(shape, Chipped) else shape
    if isinstance(whole, CircularFrustum | RectangularFrustum):
        drum = drum_of(whole, density)
        return Moments(drum.mass, np.zeros(3), np.diag([drum.cross_inertia, drum.inertia, drum.axial_inertia]))
    return mesh_moments(whole.mesh(), density)


def drum_of(shape: CircularFrustum | RectangularFrustum, density: float) -> Drum:
    """The drum that has this shape."""
    if isinstance(shape, CircularFrustum):
        return Drum(shape.height, shape.bottom, shape.top, density, "circular")
    (width, depth), (upper, upper_depth) = shape.bottom, shape.top
    return Drum(shape.height, width, upper, density, "rectangular", depth, upper_depth)


def mesh_moments(mesh: Mesh, density: float) -> Moments:
    """Of a closed surface of flat faces, by the tetrahedra between its triangles and a point within."""
    middle = mesh.vertices[sorted({i for face in mesh.faces for i in face})].mean(axis=0)
    corners = [mesh.vertices[list(face)] - middle for face in mesh.faces]
    triangles = np.array(
        [(corner[0], corner[i], corner[i + 1]) for corner in corners for i in range(1, len(corner) - 1)]
    )
    six = np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2]))
    volume = float(six.sum()) / 6.0
    sums = triangles.sum(axis=1)
    centroid = six @ sums / 24.0 / volume
    # ∫ x xᵀ over a tetrahedron with one corner in the origin is (Σ pᵢ pᵢᵀ + s sᵀ) V/20, s the sum of the others
    second = (np.einsum("i,ijk,ijl->kl", six, triangles, triangles) + np.einsum("i,ik,il->kl", six, sums, sums)) / 120.0
    second -= volume * np.outer(centroid, centroid)
    tensor = density * (np.trace(second) * np.eye(3) - second)
    return Moments(density * volume, middle + centroid, 0.5 * (tensor + tensor.T))


def together(parts: list[Moments]) -> Moments:
    """Of several solids that are one body, all told in its axes."""
    mass = sum(part.mass for part in parts)
    centroid = sum((part.mass * part.centroid for part in parts), np.zeros(3)) / mass
    tensor = np.zeros((3, 3))
    for part in parts:
        arm = part.centroid - centroid
        tensor += part.tensor + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Moments(mass, centroid, tensor)


# -- Parts of a body in space as plain values, as files of results keep them, and back --------------------------------


def plain_of(part: Placed) -> dict:
    """A part as plain values."""
    shape, cuts = part.shape, None
    if isinstance(shape, Chipped):
        shape, cuts = shape.whole, shape.cuts
    if isinstance(shape, CircularFrustum):
        plain: dict[str, Any] = {"drum": [shape.bottom, shape.top, shape.height, shape.centroid]}
    elif isinstance(shape, RectangularFrustum):
        plain = {"frustum": [list(shape.bottom), list(shape.top), shape.height, shape.centroid]}
    else:
        assert isinstance(shape, ConvexSolid)
        plain = {"hull": np.asarray(shape.vertices).tolist()}
    if cuts is not None:
        plain["cuts"] = np.asarray(cuts).tolist()
    return plain | {"place": list(part.place), "orientation": list(part.orientation)}


def part_of(plain: dict) -> Placed:
    """The part that plain values stand for."""
    shape: Any
    if "drum" in plain:
        shape = CircularFrustum(*plain["drum"])
    elif "frustum" in plain:
        low, high, height, centroid = plain["frustum"]
        shape = RectangularFrustum(tuple(low), tuple(high), height, centroid)
    else:
        shape = ConvexSolid(np.array(plain["hull"]))
    if "cuts" in plain:
        shape = Chipped(shape, np.array(plain["cuts"]))
    return Placed(shape, tuple(plain["place"]), tuple(plain["orientation"]))


# -- A body in space --------------------------------------------------------------------------------------------------


#: Farthest that a body may stand from the origin [m]; fastest that it may move and turn at the start [m/s], [rad/s].
FARTHEST, FASTEST, FASTEST_TURN = 1e4, 100.0, 1e3

#: A quaternion is of length 1 to this [-].
UNIT = 1e-6

#: Most parts of a body, and most corners of a part.
MOST_PARTS, MOST_CORNERS = 12, 200

Triple = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Stone(Outlined):
    """A rigid body of an assembly in space.

    Parameters
    ----------
    parts : sequence of Placed
        Its convex parts in its own axes, from any origin: where the centroid of each is [m], and how it is turned.
    position : (float, float, float)
        Where its centroid is [m].
    density : float
        [kg/m³]; 0 of a fixed body that has none.
    name : str
    orientation : (float, float, float, float)
        Unit quaternion from its own axes to those of space, w first.
    velocity, angular_velocity : (float, float, float)
        Of its centroid [m/s] and of its turning [rad/s] at the start, in the axes of space.
    fixed : bool
        Moves with the ground: a support.
    surface : Joint, optional
        Law of its contacts with bodies that come before it; the assembly's if left out.

    Raises
    ------
    InputError
        A value that is not finite or outside its range.
    """

    parts: tuple[Placed, ...]
    position: Triple
    density: float = 0.0
    name: str = "block"
    orientation: Quaternion = UPRIGHT
    velocity: Triple = (0.0, 0.0, 0.0)
    angular_velocity: Triple = (0.0, 0.0, 0.0)
    fixed: bool = False
    surface: Joint | None = None

    def __post_init__(self) -> None:
        who = f"block {check_name('the name of a block', self.name)!r}"
        object.__setattr__(self, "parts", tuple(check_all(f"parts of {who}", self.parts, Placed)))
        fixed = check_kind(f"fixed of {who}", self.fixed, (bool, np.bool_), allowed="True or False")
        object.__setattr__(self, "fixed", bool(fixed))
        check_kind(f"surface of {who}", self.surface, Joint, optional=True)
        if not 1 <= len(self.parts) <= MOST_PARTS:
            raise InputError(f"{who} has {len(self.parts)} parts; allowed are 1 to {MOST_PARTS}.")
        lightest = 0.0 if self.fixed else DENSITIES[0]
        density = check_range(f"density of {who}", self.density, lightest, DENSITIES[1], unit="kg/m³")
        object.__setattr__(self, "density", density)
        for field, unit, most in (
            ("position", "m", FARTHEST),
            ("velocity", "m/s", FASTEST),
            ("angular_velocity", "rad/s", FASTEST_TURN),
        ):
            object.__setattr__(self, field, triple(f"{field} of {who}", getattr(self, field), most, unit))
        object.__setattr__(self, "orientation", unit_quaternion(f"orientation of {who}", self.orientation))
        if self.fixed and any((*self.velocity, *self.angular_velocity)):
            raise InputError(f"{who} is fixed and has a velocity; leave one of the two out.")

    # -- ways to write one down ----------------------------------------------------------------------------------------

    @classmethod
    def box(cls, sides: Sequence[float], at: Sequence[float], density: float = 0.0, **others: Any) -> Stone:
        """A box.

        Parameters
        ----------
        sides : sequence of float
            Along x, y and z [m].
        at : sequence of float
            Middle of its lower face before it is turned [m].
        density : float
            [kg/m³]
        **others
            Of :class:`Stone`; an ``orientation`` turns it about its centroid.
        """
        return cls._standing(Placed(box_shape(sides, _who(others))), at, density, others)

    @classmethod
    def drum(
        cls, bottom: float, top: float, height: float, at: Sequence[float], density: float = 0.0, **others: Any
    ) -> Stone:
        """A round drum of two diameters and a height [m]; the rest as of :meth:`box`."""
        return cls._standing(Placed(drum_shape(bottom, top, height, _who(others))), at, density, others)

    @classmethod
    def hull(cls, vertices: Any, density: float = 0.0, **others: Any) -> Stone:
        """The convex hull of points in space [m], where they are; the rest as of :meth:`box`."""
        shape, middle = hull_shape(vertices, _who(others))
        return cls((Placed(shape),), _triple(middle), density, **others)

    @classmethod
    def _standing(cls, part: Placed, at: Sequence[float], density: float, others: Any) -> Stone:
        x, y, z = triple(f"at of {_who(others)}", at, FARTHEST, "m")
        return cls((part,), (x, y, z - float(part.mesh(4).vertices[:, 2].min())), density, **others)

    # -- what it is made of --------------------------------------------------------------------------------------------

    @cached_property
    def moments(self) -> Moments:
        """Mass, centroid and inertia in the axes of its parts; of a fixed body without density those of volume."""
        moments = []
        for part in self.parts:
            own, axes = moments_of(part.shape, self.density or 1.0), matrix_of(part.orientation)
            moments.append(Moments(own.mass, np.array(part.place), axes @ own.tensor @ axes.T))
        return moments[0] if len(moments) == 1 else together(moments)

    @property
    def mass(self) -> float:
        """[kg]; 0 of a fixed body without density."""
        return self.moments.mass if self.density else 0.0

    @cached_property
    def inertia_tensor(self) -> np.ndarray:
        """About the centroid in its own axes [kg m²], shape (3, 3)."""
        return self.moments.tensor if self.density else np.zeros((3, 3))

    @cached_property
    def pieces(self) -> tuple[Placed, ...]:
        """Its parts in its own axes, from its centroid."""
        if len(self.parts) == 1 and not any(self.moments.centroid):
            return self.parts
        centre = self.moments.centroid
        return tuple(
            Placed(part.shape, _triple(np.array(part.place) - centre), part.orientation) for part in self.parts
        )

    @cached_property
    def axes(self) -> np.ndarray:
        """Its own axes as columns, in those of space [-], shape (3, 3)."""
        return matrix_of(self.orientation)

    @property
    def placed(self) -> tuple[Placed, ...]:
        """Its parts where they stand, in the axes of space."""
        parts = []
        for piece in self.pieces:
            place = np.array(self.position) + self.axes @ piece.place
            parts.append(Placed(piece.shape, _triple(place), product(self.orientation, piece.orientation)))
        return tuple(parts)

    @cached_property
    def vertices(self) -> np.ndarray:
        """Corners of its parts where they stand, of circles 48 [m], shape (m, 3)."""
        return np.concatenate([part.mesh(48).vertices for part in self.placed])

    # -- as a body of a structure --------------------------------------------------------------------------------------

    @property
    def shape(self) -> Shape:
        """Its shape in its own axes, from its centroid."""
        piece = self.pieces[0]
        if len(self.pieces) == 1 and piece.orientation == UPRIGHT and not any(piece.place):
            return piece.shape
        return Glued(self.pieces)

    @property
    def inertia(self) -> float:
        """About the axis along y through the centroid, as it stands [kg m²]."""
        return float((self.axes @ self.inertia_tensor @ self.axes.T)[1, 1])

    @property
    def place(self) -> tuple[float, float]:
        """Where its centroid is, seen along y [m]."""
        return self.position[0], self.position[2]

    @property
    def angle(self) -> float:
        """Of axes as drawn [rad]."""
        return 0.0

    @property
    def lean(self) -> float:
        """Of the axes that faces are told in [rad]."""
        return 0.0

    @cached_property
    def corners(self) -> np.ndarray:
        """Outline as it stands, seen along y [m], shape (k, 2)."""
        return hull(self.vertices[:, [0, 2]])

    @property
    def outline(self) -> np.ndarray:
        """The same."""
        return self.corners

    @property
    def sides(self) -> tuple[float, ...]:
        """Of the box around it as it stands, turned about the vertical to where it is narrowest [m]."""
        return (*narrowest(hull(self.vertices[:, :2])), float(np.ptp(self.vertices[:, 2])))

    @cached_property
    def polygon(self) -> np.ndarray:
        """The same from its centroid [m]."""
        return self.corners - np.array(self.place)

    # -- plain values --------------------------------------------------------------------------------------------------

    def to_dict(self) -> dict:
        """Plain values that make it again."""
        plain: dict[str, Any] = {
            "parts": [plain_of(part) for part in self.parts],
            "position": list(self.position),
            "density": self.density,
            "name": self.name,
            "orientation": list(self.orientation),
            "velocity": list(self.velocity),
            "angular_velocity": list(self.angular_velocity),
            "fixed": self.fixed,
        }
        return plain | ({} if self.surface is None else {"surface": vars(self.surface).copy()})

    @classmethod
    def from_dict(cls, data: dict) -> Stone:
        """The body that :meth:`to_dict` has written."""
        surface, places = data.get("surface"), ("position", "orientation", "velocity", "angular_velocity")
        special: dict[str, Any] = {name: tuple(data[name]) for name in places}
        special["parts"] = tuple(part_of(part) for part in data["parts"])
        special["surface"] = None if surface is None else Joint(**surface)
        return cls(**(dict(data) | special))


def box_shape(sides: Sequence[float], who: str) -> RectangularFrustum:
    """A box of three sides [m]."""
    x, y, z = _lengths("box", sides, 3, who)
    return RectangularFrustum((x, y), (x, y), z, 0.5 * z)


def drum_shape(bottom: float, top: float, height: float, who: str) -> CircularFrustum:
    """A round drum of two diameters and a height [m]."""
    low, high, tall = _lengths("drum", (bottom, top, height), 3, who)
    shape = CircularFrustum(low, high, tall, 0.0)
    return CircularFrustum(low, high, tall, drum_of(shape, 1.0).centroid_height)


def hull_shape(vertices: Any, who: str) -> tuple[ConvexSolid, np.ndarray]:
    """The hull of points, from its centroid, and where that is [m].

    Raises
    ------
    InputError
        Points that are not finite, too many of them, or a hull without volume.
    """
    from scipy.spatial import ConvexHull, QhullError

    given = check_kind(f"vertices of {who}", vertices, (list, tuple, np.ndarray), allowed="a list of points")
    points = np.array(
        [triple(f"vertex {number} of {who}", point, FARTHEST, "m") for number, point in enumerate(given, 1)]
    )
    if len(points) < 4:
        raise InputError(f"{who} has {len(points)} vertices; give four or more, those of a solid.")
    middle, size = points.mean(axis=0), float(np.ptp(points, axis=0).max())
    if not LENGTHS[0] <= size <= LENGTHS[1]:
        raise InputError(f"{who} is {size:.4g} m large; allowed is {LENGTHS[0]:g} to {LENGTHS[1]:g} m: use SI units.")
    try:
        hull: Any = ConvexHull(points - middle)
    except QhullError:
        raise InputError(
            f"the vertices of {who} lie in one plane, and it has no thickness; give those of a solid."
        ) from None
    levels = (points - middle) @ hull.equations[:, :3].T + hull.equations[:, 3]  # at most 0, within a facet
    thin = float(-levels.min(axis=0).max())
    if thin < LENGTHS[0]:
        raise InputError(
            f"{who} has a thickness of {thin:.3g} m; allowed is {LENGTHS[0]:g} m or more: give it a thickness."
        )
    if len(hull.vertices) > MOST_CORNERS:
        raise InputError(f"{who} has {len(hull.vertices)} corners; allowed is up to {MOST_CORNERS}: thin them out.")
    corners = points[np.sort(hull.vertices)] - middle
    shift = mesh_moments(ConvexSolid(corners).mesh(), 1.0).centroid
    return ConvexSolid(corners - shift), middle + shift


def centre_of(parts: Sequence[Placed]) -> np.ndarray:
    """Common centroid of parts, in the axes in which they are told [m], shape (3,)."""
    moments = [Moments(moments_of(part.shape, 1.0).mass, np.array(part.place), np.zeros((3, 3))) for part in parts]
    return together(moments).centroid


def triple(name: str, values: Any, most: float, unit: str) -> Triple:
    """Three finite numbers up to a size.

    Raises
    ------
    InputError
    """
    try:
        x, y, z = values
    except (TypeError, ValueError):
        raise InputError(f"{name} is {as_typed(values)}; give three numbers, x, y and z [{unit}].") from None
    coordinates = [
        check_range(f"{axis} of {name}", coordinate, -most, most, unit=unit)
        for axis, coordinate in zip("xyz", (x, y, z))
    ]
    return coordinates[0], coordinates[1], coordinates[2]


def unit_quaternion(name: str, values: Any) -> Quaternion:
    """Four numbers of length 1, to the last bit as given where they are.

    Raises
    ------
    InputError
    """
    try:
        components = [float(value) for value in values]
    except (TypeError, ValueError):
        components = []
    length = math.sqrt(sum(component * component for component in components))
    if len(components) != 4 or not abs(length - 1.0) <= UNIT:
        raise InputError(f"{name} is {as_typed(values)}; give a unit quaternion [w, x, y, z], such as [1, 0, 0, 0].")
    share = 1.0 if abs(length - 1.0) < 1e-12 else 1.0 / length
    w, x, y, z = (share * component for component in components)
    return w, x, y, z


def _lengths(what: str, values: Sequence[float], count: int, who: str) -> list[float]:
    try:
        given = list(values)
    except TypeError:
        given = []
    if len(given) != count:
        raise InputError(f"{what} of {who} is {as_typed(values)}; give {count} lengths [m].")
    return [
        check_range(f"a length of the {what} of {who}", size, *LENGTHS, unit="m", remedy="use SI units")
        for size in given
    ]


def _who(others: dict[str, Any]) -> str:
    return f"block {others.get('name', 'block')!r}"


def _triple(values: Any) -> Triple:
    x, y, z = (float(value) for value in values)
    return x, y, z


# Meshes of stones: OBJ by its lines, PLY, STL and glTF by trimesh; closed, of plausible size, one convex part.

#: Endings of files that hold meshes, and those that trimesh reads.
OBJ, OTHERS = ".obj", (".ply", ".stl", ".glb", ".gltf")
MESHES = (OBJ, *OTHERS)

#: Axes that can be upward; that of glTF is y.
UPWARD, GLTF = ("y", "z"), (".glb", ".gltf")

#: Largest file [bytes].
LARGEST = 20_000_000


@dataclass(frozen=True, eq=False)
class MeshPart:
    """One surface of a file: its faces hang together.

    Parameters
    ----------
    name : str
    points : array
        Vertices, of which faces may use some [the file's unit], shape (m, 3).
    faces : tuple of tuple of int
        Numbers of their vertices.
    lines : tuple of int
        Line of the file that each face is on; empty where a format has none.
    rounding : float
        Half a unit of the last place of numbers in single precision [the file's unit]; 0 of other numbers.
    """

    name: str
    points: np.ndarray
    faces: tuple[tuple[int, ...], ...]
    lines: tuple[int, ...] = ()
    rounding: float = 0.0

    def in_metres(self, factor: float, up: str) -> MeshPart:
        """The surface in m with z upward, from a unit [m] and the axis that is upward, ``y`` or ``z``."""
        x, y, z = factor * self.points.T
        points = np.stack((x, -z, y) if up == "y" else (x, y, z), axis=1)
        return replace(self, points=points, rounding=factor * self.rounding)

    @property
    def used(self) -> np.ndarray:
        """Numbers of the vertices that its faces use, shape (k,)."""
        return np.unique(np.concatenate([np.array(face) for face in self.faces]))

    def face(self, number: int) -> str:
        """Name of a face in sentences."""
        return f"face on line {self.lines[number]}" if self.lines else f"face {number + 1}"


def parsed_parts(path: Path) -> list[MeshPart]:
    """Objects of a file that have faces.

    Raises
    ------
    InputError
        The ending is unknown, the file is none of its format, or trimesh, which reads it, is not installed.
    """
    name, suffix = printable(path), path.suffix.lower()
    if suffix not in MESHES:
        raise InputError(f"{name} ends in {suffix!r}; meshes are files that end in {', '.join(MESHES)}.")
    data = read_bytes(path, LARGEST, "thin the mesh out")
    parts = _obj(data, name, path.stem) if suffix == OBJ else _by_trimesh(data, suffix, path, name)
    if not all(np.isfinite(part.points[part.used]).all() for part in parts):
        raise InputError(f"{name} has a vertex that is not finite; mend the mesh.")
    return parts


def pieces_of(part: MeshPart) -> list[MeshPart]:
    """The same surface in pieces that hang together, under its name with a number where there are several.

    Faces hang together by the numbers of their vertices if that closes them, else by where their vertices are.
    """
    pieces = _pieces(part)
    if all(not _odd_edges(piece) for piece in pieces):
        return pieces
    return _pieces(_merged(part))


def edges_of(part: MeshPart) -> Counter[tuple[int, int]]:
    """How many faces pass from one vertex to another, by their numbers."""
    return Counter(edge for face in part.faces for edge in zip(face, (*face[1:], face[0]), strict=True))


def _odd_edges(part: MeshPart) -> bool:
    passed = edges_of(part)
    return any(times > 1 or passed[b, a] != 1 for (a, b), times in passed.items())


def _pieces(part: MeshPart) -> list[MeshPart]:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    first, other = np.array([(face[0], corner) for face in part.faces for corner in face[1:]]).T
    size = len(part.points)
    _, group = connected_components(
        coo_array((np.ones(len(first)), (first, other)), shape=(size, size)), directed=False
    )
    of_face = group[[face[0] for face in part.faces]]
    kinds = dict.fromkeys(of_face.tolist())
    if len(kinds) == 1:
        return [part]
    pieces = []
    for number, kind in enumerate(kinds, 1):
        own = np.flatnonzero(of_face == kind).tolist()
        lines = tuple(part.lines[i] for i in own) if part.lines else ()
        faces = tuple(part.faces[i] for i in own)
        pieces.append(replace(part, name=f"{part.name} {number}", faces=faces, lines=lines))
    return pieces


def _merged(part: MeshPart) -> MeshPart:
    """Vertices at the same place are the first of them; faces that lose their area by it are left out."""
    _, first, group = np.unique(part.points + 0.0, axis=0, return_index=True, return_inverse=True)
    same = first[group.ravel()].tolist()
    faces = [tuple(dict.fromkeys(same[i] for i in face)) for face in part.faces]
    kept = [i for i, face in enumerate(faces) if len(face) >= 3]
    lines = tuple(part.lines[i] for i in kept) if part.lines else ()
    return replace(part, faces=tuple(faces[i] for i in kept), lines=lines)


def _obj(data: bytes, name: str, stem: str) -> list[MeshPart]:
    """Objects of a Wavefront OBJ file."""
    points: list[list[float]] = []
    objects: dict[str, list[tuple[int, tuple[int, ...]]]] = {}
    current, text = stem, data.decode("utf-8", "replace").splitlines()
    names = ("o",) if any(line.split()[:1] == ["o"] for line in text) else ("g",)  # groups may be parts of a surface
    for number, line in enumerate(text, 1):
        word, *rest = line.split() or [""]
        try:
            if word == "v":
                x, y, z = (float(token) for token in rest[:3])
                points.append([x, y, z])
            elif word == "f":
                corners = [int(token.split("/")[0]) for token in rest]
                corners = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
                if len(corners) < 3 or not all(0 <= corner < len(points) for corner in corners):
                    raise ValueError
                objects.setdefault(current, []).append((number, tuple(corners)))
            elif word in names:
                current = " ".join(rest) or current
        except ValueError:
            raise InputError(
                f"line {number} of {name} is {line.strip()[:60]!r}, which is no line of an OBJ file."
            ) from None
    faces = sum(map(len, objects.values()))
    if len(points) < 4 or faces < 4:
        raise InputError(f"{name} holds {len(points)} vertices and {faces} faces; a solid has four of each at least.")
    vertices = np.array(points)
    return [
        MeshPart(label, vertices, tuple(face for _, face in numbered_faces), tuple(line for line, _ in numbered_faces))
        for label, numbered_faces in objects.items()
    ]


def _by_trimesh(data: bytes, suffix: str, path: Path, name: str) -> list[MeshPart]:
    """Meshes of a scene where they stand."""
    try:
        import trimesh
        from trimesh.resolvers import FilePathResolver
    except ImportError:
        raise InputError(f"{name} is read by trimesh; install stylobate[exchange], or give an OBJ file.") from None
    resolver = FilePathResolver(str(path)) if suffix == ".gltf" else None
    try:
        scene: Any = trimesh.load_scene(
            io.BytesIO(data), file_type=suffix[1:], resolver=resolver, process=False, maintain_order=True
        )
        order = {str(key): i for i, key in enumerate(scene.geometry)}
        placed = [(order[str(scene.graph[node][1])], str(node), node) for node in scene.graph.nodes_geometry]
        scenes = [(name, *scene.graph[node]) for _, name, node in sorted(placed)]
        meshes = [(name, turn, scene.geometry[key]) for name, turn, key in scenes]
        surfaces = [(node, turn, mesh.vertices, mesh.faces) for node, turn, mesh in meshes if hasattr(mesh, "faces")]
    except Exception as error:  # whatever a damaged file makes of the reader
        why = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(f"{name} is no {suffix[1:].upper()} file that can be read ({why}); write it again.") from None
    parts = []
    for node, turn, vertices, faces in surfaces:
        points = np.asarray(vertices, dtype=float) @ turn[:3, :3].T + turn[:3, 3]
        if len(faces):
            order = 1 if np.linalg.det(turn[:3, :3]) > 0.0 else -1  # mirrored, faces run the other way
            called = path.stem if suffix in (".ply", ".stl") and node.startswith("geometry_") else node
            single = points.astype("f4")
            rounding = 0.5 * float(np.spacing(np.abs(single).max())) if np.array_equal(single, points) else 0.0
            every = tuple(tuple(face[::order].tolist()) for face in np.asarray(faces))
            parts.append(MeshPart(called, points, every, rounding=rounding))
    vertices, faces = (sum(len(getattr(part, key)) for part in parts) for key in ("points", "faces"))
    if vertices < 4 or faces < 4:
        raise InputError(f"{name} holds {vertices} vertices and {faces} faces; a solid has four of each at least.")
    return parts


# -- Meshes of stones -------------------------------------------------------------------------------------------------


#: Units that a mesh may be in [m].
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}

#: How far a vertex may stand out of a face as a share of the size [-].
BULGE = 1e-4


def read_mesh(path: Path, unit: str = "m") -> np.ndarray:
    """Vertices of a convex stone from a mesh [m], shape (m, 3).

    Raises
    ------
    InputError
        No mesh; one of several parts, with holes, that is not convex, or of a size that no stone has.
    """
    name, factor = printable(path), unit_of(unit, printable(path))
    objects = parsed_parts(path)
    parts = objects if len(objects) > 1 else pieces_of(objects[0])
    if len(parts) > 1:
        first_names = ", ".join(part.name for part in parts[:3])
        more = ", …" if len(parts) > 3 else ""
        raise InputError(f"{name} holds {len(parts)} parts ({first_names}{more}); give each in a file of its own.")
    (part,) = parts
    _check_sizes([part], factor, name, "unit = " + ", ".join(f'"{known_unit}"' for known_unit in UNITS))
    check_closed(part, name)
    _check_convex(part, name)
    return part.in_metres(factor, upward(path)).points[part.used]


def upward(path: Path) -> str:
    """The axis that is upward in a format unless told otherwise, ``y`` or ``z``."""
    return "y" if path.suffix.lower() in GLTF else "z"


def read_stones(path: Path, unit: str = "m", up: str | None = None) -> list[MeshPart]:
    """Every closed surface of a mesh [m], z upward, each under a name of its own; ``up`` is the file's axis upward.

    Raises
    ------
    InputError
        No mesh; a part with holes; or sizes all of which no stone has.
    """
    name, factor = printable(path), unit_of(unit, printable(path))
    parts = [piece for part in parsed_parts(path) for piece in pieces_of(part)]
    _check_sizes(parts, factor, name, "`unit` " + ", ".join(UNITS))
    names = [part.name for part in parts]
    stones = []
    for number, part in enumerate(parts):
        own = part.name if names.count(part.name) == 1 else f"{part.name}, {names[: number + 1].count(part.name)}"
        check_closed(part, f"part {own!r} of {name}")
        stones.append(replace(part.in_metres(factor, up or upward(path)), name=own))
    return stones


def unit_of(unit: str, name: str) -> float:
    """A unit of a file [m]."""
    if unit not in UNITS:
        raise InputError(f"the unit of {name} is {unit!r}; allowed are {', '.join(UNITS)}.", "unit")
    return UNITS[unit]


def _check_sizes(parts: Sequence[MeshPart], factor: float, name: str, known: str) -> None:
    """Refuse a mesh of which no part has the size of a stone."""
    doubts = [
        bulk_doubts(f"the size of {name}", (factor * np.ptp(part.points[part.used], axis=0)).tolist()) for part in parts
    ]
    if all(doubts):
        raise InputError(f"{doubts[0][0]} Say it with {known}.", "unit")


def check_closed(part: MeshPart, name: str) -> None:
    """Refuse a surface of which an edge does not belong to two faces, which pass it in opposite directions.

    Raises
    ------
    InputError
    """
    passed = edges_of(part)
    for number, face in enumerate(part.faces):
        for a, b in zip(face, (*face[1:], face[0]), strict=True):
            times, back = passed[a, b], passed[b, a]
            if times == back == 1:
                continue
            where = f"at the edge of vertices {a + 1} and {b + 1} ({part.face(number)})"
            if times == back:
                raise InputError(
                    f"{name} has {times + back} faces {where}, as stones have that share corners; write each as an "
                    "object of its own."
                )
            what = "has a hole" if times == 1 and not back else "has faces of opposite directions"
            raise InputError(f"{name} {what} {where}; close the mesh, its faces counter-clockwise from outside.")


def _check_convex(part: MeshPart, name: str) -> None:
    """No vertex stands out of a face."""
    used, points = part.used, part.points
    size = float(np.ptp(points[used], axis=0).max())
    middle = points[used].mean(axis=0)
    for number, face in enumerate(part.faces):
        corners = points[list(face)]
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        length = np.linalg.norm(normal)
        if length <= 1e-12 * size * size:
            raise InputError(f"the {part.face(number)} of {name} has no area; mend the mesh.")
        normal = normal / length
        if normal @ (middle - corners[0]) > 0.0:
            normal = -normal
        out = (points[used] - corners.mean(axis=0)) @ normal
        if out.max() > BULGE * size:
            raise InputError(
                f"{name} is not convex at the {part.face(number)}: vertex {used[int(out.argmax())] + 1} stands "
                f"{float(out.max()):.3g} out of it; split the stone into convex parts, each a part of one block."
            )
