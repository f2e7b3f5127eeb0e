"""A specimen: one convex body of any shape that stands on the base with its vertices."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..constants import DEGREE
from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError, check_name, check_range
from .block import ground_block
from .joint import Joint, stated_fields
from .shapes import ConvexSolid
from .structure import Bed, Body, Standing, Structure

#: Farthest that a body is turned to lie on a face that carries it [degrees].
FARTHEST_TURN = 10.0

#: Vertices that are nearer to a plane than this share of the body's size lie in it [-].
IN_PLANE = 1e-7

#: Most vertices of a body.
MOST_VERTICES = 5000


@dataclass(frozen=True, eq=False, repr=False)
class Specimen(Structure):
    """A rigid convex body at rest on the base: a boulder, a statue's block, a test specimen.

    It is laid on the face that needs the smallest turn from the axes given, and starts there in equilibrium.

    Parameters
    ----------
    mass : float
        [kg]
    inertia : array
        Tensor of inertia about the centroid, in the axes of ``vertices`` [kg m²], shape (3, 3); or three principal moments
        along them.
    vertices : array
        Points whose convex hull is the body, from its centroid, z up [m], shape (m, 3).
    name : str
    joint : Joint
        Stiffness per area and friction of the contact. Each vertex has the same stiffness: that of the resting footprint
        over its number of vertices.
    restitution : float
        Of a vertex [-]: the square root of the work that its normal force gives back over the work that it took, in every
        single impact, 1 for an elastic one.
    gravity : float
        g [m/s²].

    Raises
    ------
    InputError
        A mass or an inertia that no body has, vertices that bound no volume, or a centroid that is not above the footprint.
    """

    kind: ClassVar[str] = "specimen"
    joints_are: ClassVar[str] = "contact with the base"
    computed_by: ClassVar[str] = "dem3d (DistinctElement3D) can"

    mass: float
    inertia: Any
    vertices: Any
    name: str = "specimen"
    joint: Joint = field(default_factory=lambda: Joint(5e10, 2.5e10, friction_coefficient=0.7))
    restitution: float = 1.0
    gravity: float = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        check_name("the name of a specimen", self.name)
        object.__setattr__(
            self, "mass", check_range("mass of a specimen", self.mass, 0.0, 1e9, unit="kg", open_low=True)
        )
        object.__setattr__(self, "restitution", check_range("restitution of a specimen", self.restitution, 0.0, 1.0))
        object.__setattr__(self, "gravity", check_range("gravity", self.gravity, 1e-2, 100.0, unit="m/s²"))
        object.__setattr__(self, "inertia", _inertia(self.inertia))
        object.__setattr__(self, "vertices", _hull_vertices(self.vertices))
        if self.joint.ring_width is not None:
            raise InputError(f"the joint of {self.name!r} has a ring_width, and a specimen has no rings; leave it out.")
        if self.joint.cohesion:
            raise InputError(
                f"the joint of {self.name!r} has a cohesion of {self.joint.cohesion:g} Pa, and a specimen touches at "
                "points, which have no area for it to act on; leave it out."
            )
        turn = self.resting.turn / DEGREE
        if turn > FARTHEST_TURN:
            raise InputError(
                f"the centroid of {self.name!r} is not above its footprint: the nearest face that carries it is {turn:.3g}° "
                f"away; allowed is up to {FARTHEST_TURN:g}°: turn vertices and inertia so that it lies on a face."
            )

    @property
    def n(self) -> int:
        """Number of bodies: one."""
        return 1

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """The base and the body, at rest on it."""
        height, turn = self.resting.height, self.resting.rotation
        inertia, pose = float((turn @ self.inertia @ turn.T)[1, 1]), (np.array([0.0, 0.0, height]), turn)
        shape = ConvexSolid(self.vertices)
        return ground_block(0.0), Standing(self.name, shape, self.mass, inertia, (0.0, height), in_space=pose)

    @property
    def beds(self) -> tuple[Bed, ...]:
        """Its footprint, so stiff that a box with corners on it has vertices like these."""
        rest, count = self.resting, len(self.resting.footprint)
        plan = (self.vertices[rest.footprint] @ rest.rotation.T)[:, :2]
        stiffness = {name: 4.0 / count * getattr(self.joint, name) for name in ("normal_stiffness", "shear_stiffness")}
        return (Bed(0, 1, 1.0, plan, 0.0, rest.area, self.joint.changed(**stiffness)),)

    @cached_property
    def resting(self) -> Resting:
        """Pose of the body on the base."""
        return _resting(self.vertices)

    def to_dict(self) -> dict:
        """Plain values that make the specimen anew."""
        default = {field.name: field.default for field in fields(Joint)}
        joint = {name: value for name, value in stated_fields(self.joint).items() if value != default[name]}
        joint.pop("friction_angle")  # the coefficient tells it
        return {
            "name": self.name,
            "mass": self.mass,
            "inertia": self.inertia.tolist(),
            "vertices": self.vertices.tolist(),
            "joint": joint,
            "restitution": self.restitution,
            "gravity": self.gravity,
        }

    @classmethod
    def from_dict(cls, data: dict) -> Specimen:
        """The specimen that :meth:`to_dict` has written."""
        return cls(**{**data, "joint": Joint(**data["joint"])})


@dataclass(frozen=True, eq=False)
class Resting:
    """Pose of a body on the base.

    Parameters
    ----------
    rotation : array
        From the axes of the vertices to those of space, shape (3, 3).
    height : float
        Of the centroid over the base [m].
    footprint : array
        Numbers of the vertices that touch the base.
    area : float
        Of their convex hull [m²].
    turn : float
        Angle of the rotation [rad].
    """

    rotation: np.ndarray
    height: float
    footprint: np.ndarray
    area: float
    turn: float


def _inertia(given: Any) -> np.ndarray:
    tensor = np.array(given, dtype=float)
    tensor = np.diag(tensor) if tensor.shape == (3,) else tensor
    if tensor.shape != (3, 3) or not np.isfinite(tensor).all():
        raise InputError(
            "the inertia of a specimen is given in another shape; give 3 × 3 finite numbers, or three moments."
        )
    if np.abs(tensor - tensor.T).max() > 1e-9 * np.abs(tensor).max():
        raise InputError("the inertia of a specimen is not symmetric; give the tensor about the centroid.")
    a, b, c = np.linalg.eigvalsh(tensor)
    if not (a > 0.0 and a + b >= c * (1.0 - 1e-9)):
        raise InputError(
            f"the principal moments of inertia of a specimen are {a:.4g}, {b:.4g} and {c:.4g} kg m²; in a body they are "
            "positive and none is larger than the sum of the other two: check their unit and the signs of the products."
        )
    return 0.5 * (tensor + tensor.T)


def _hull_vertices(given: Any) -> np.ndarray:
    from scipy.spatial import ConvexHull, QhullError

    points = np.array(given, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 4 or not np.isfinite(points).all():
        raise InputError("the vertices of a specimen are at least four points of three finite coordinates [m].")
    if np.abs(points).max() > 1e3:
        raise InputError(
            f"a vertex of a specimen is {np.abs(points).max():.4g} m from the centroid; allowed is up to 1000 m."
        )
    try:
        hull = ConvexHull(points)
    except QhullError:
        raise InputError(
            "the vertices of a specimen lie in one plane or on one point; give those of a solid body."
        ) from None
    if len(hull.vertices) > MOST_VERTICES:
        raise InputError(
            f"the hull of a specimen has {len(hull.vertices)} vertices; allowed is up to {MOST_VERTICES}: thin them out."
        )
    if (hull.equations[:, 3] >= 0.0).any():
        raise InputError(
            "the centroid of a specimen is outside the hull of its vertices; give vertices from the centroid."
        )
    return points[np.sort(hull.vertices)]


def _resting(vertices: np.ndarray) -> Resting:
    """The face that carries the body and needs the smallest turn to lie on the base."""
    from scipy.spatial import ConvexHull, QhullError

    size = float(np.ptp(vertices, axis=0).max())
    hull: Any = ConvexHull(vertices)
    order = np.argsort(hull.equations[:, 2])  # outward normals, the most downward first
    for facet in order:
        outward, offset = hull.equations[facet, :3], hull.equations[facet, 3]
        turn = math.acos(max(-1.0, min(1.0, -float(outward[2]))))
        below = np.flatnonzero(vertices @ outward + offset > -IN_PLANE * size)
        rotation = _turned_down(outward)
        plan = (vertices[below] @ rotation.T)[:, :2]
        try:
            flat: Any = ConvexHull(plan)
        except QhullError:  # a sliver
            continue
        if (flat.equations[:, 2] < 0.0).all():  # the centroid's foot, the origin, is inside
            return Resting(rotation, -float(offset), below, float(flat.volume), turn)
    raise InputError("no face of a specimen carries it; check that vertices are given from the centroid.")


def _turned_down(outward: np.ndarray) -> np.ndarray:
    """The smallest rotation that turns a direction straight down."""
    down = np.array([0.0, 0.0, -1.0])
    axis, c = np.cross(outward, down), float(outward @ down)
    if c < -1.0 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + skew + skew @ skew / (1.0 + c)
