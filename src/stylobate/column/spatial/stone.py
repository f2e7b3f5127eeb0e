"""Stones: convex parts that are one body, where it stands, with mass and moments."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, as_typed, check_all, check_kind, check_name, check_range
from ..drum import DENSITIES, LENGTHS, Drum
from ..joint import Joint
from ..shapes import (
    Chipped,
    CircularFrustum,
    ConvexSolid,
    Glued,
    Mesh,
    Outlined,
    Placed,
    RectangularFrustum,
    Shape,
    hull,
    narrowest,
)
from ..turning import UPRIGHT, Quaternion, matrix_of, product


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
        found = []
        for part in self.parts:
            own, axes = moments_of(part.shape, self.density or 1.0), matrix_of(part.orientation)
            found.append(Moments(own.mass, np.array(part.place), axes @ own.tensor @ axes.T))
        return found[0] if len(found) == 1 else together(found)

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
        found = []
        for piece in self.pieces:
            place = np.array(self.position) + self.axes @ piece.place
            found.append(Placed(piece.shape, _triple(place), product(self.orientation, piece.orientation)))
        return tuple(found)

    @cached_property
    def vertices(self) -> np.ndarray:
        """Corners of its parts where they stand, of circles 48 [m], shape (m, 3)."""
        return np.concatenate([one.mesh(48).vertices for one in self.placed])

    # -- as a body of a structure --------------------------------------------------------------------------------------

    @property
    def shape(self) -> Shape:
        """Its shape in its own axes, from its centroid."""
        one = self.pieces[0]
        if len(self.pieces) == 1 and one.orientation == UPRIGHT and not any(one.place):
            return one.shape
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
    points = np.array([triple(f"vertex {number} of {who}", one, FARTHEST, "m") for number, one in enumerate(given, 1)])
    if len(points) < 4:
        raise InputError(f"{who} has {len(points)} vertices; give four or more, those of a solid.")
    middle, size = points.mean(axis=0), float(np.ptp(points, axis=0).max())
    if not LENGTHS[0] <= size <= LENGTHS[1]:
        raise InputError(f"{who} is {size:.4g} m large; allowed is {LENGTHS[0]:g} to {LENGTHS[1]:g} m: use SI units.")
    try:
        found: Any = ConvexHull(points - middle)
    except QhullError:
        raise InputError(
            f"the vertices of {who} lie in one plane, and it has no thickness; give those of a solid."
        ) from None
    levels = (points - middle) @ found.equations[:, :3].T + found.equations[:, 3]  # at most 0, within a facet
    thin = float(-levels.min(axis=0).max())
    if thin < LENGTHS[0]:
        raise InputError(
            f"{who} has a thickness of {thin:.3g} m; allowed is {LENGTHS[0]:g} m or more: give it a thickness."
        )
    if len(found.vertices) > MOST_CORNERS:
        raise InputError(f"{who} has {len(found.vertices)} corners; allowed is up to {MOST_CORNERS}: thin them out.")
    corners = points[np.sort(found.vertices)] - middle
    shift = mesh_moments(ConvexSolid(corners).mesh(), 1.0).centroid
    return ConvexSolid(corners - shift), middle + shift


def centre_of(parts: Sequence[Placed]) -> np.ndarray:
    """Common centroid of parts, in the axes in which they are told [m], shape (3,)."""
    found = [Moments(moments_of(part.shape, 1.0).mass, np.array(part.place), np.zeros((3, 3))) for part in parts]
    return together(found).centroid


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
    found = [check_range(f"{axis} of {name}", one, -most, most, unit=unit) for axis, one in zip("xyz", (x, y, z))]
    return found[0], found[1], found[2]


def unit_quaternion(name: str, values: Any) -> Quaternion:
    """Four numbers of length 1, to the last bit as given where they are.

    Raises
    ------
    InputError
    """
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError):
        found = []
    length = math.sqrt(sum(one * one for one in found))
    if len(found) != 4 or not abs(length - 1.0) <= UNIT:
        raise InputError(f"{name} is {as_typed(values)}; give a unit quaternion [w, x, y, z], such as [1, 0, 0, 0].")
    share = 1.0 if abs(length - 1.0) < 1e-12 else 1.0 / length
    w, x, y, z = (share * one for one in found)
    return w, x, y, z


def _lengths(what: str, values: Sequence[float], count: int, who: str) -> list[float]:
    try:
        given = list(values)
    except TypeError:
        given = []
    if len(given) != count:
        raise InputError(f"{what} of {who} is {as_typed(values)}; give {count} lengths [m].")
    return [
        check_range(f"a length of the {what} of {who}", one, *LENGTHS, unit="m", remedy="use SI units") for one in given
    ]


def _who(others: dict[str, Any]) -> str:
    return f"block {others.get('name', 'block')!r}"


def _triple(values: Any) -> Triple:
    x, y, z = (float(value) for value in values)
    return x, y, z
