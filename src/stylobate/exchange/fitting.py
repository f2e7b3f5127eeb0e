"""Stones from meshes: the frustum that fits a drum, or the convex hull, each with how far the mesh is from it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..column.drum import LENGTHS
from ..column.shapes import Mesh
from ..column.spatial.mesh_formats import MeshPart
from ..column.spatial.moments import mesh_moments
from ..errors import InputError

#: A ring of a drum has corners that are no farther apart than this, as seen from its axis [rad]: a twelfth of a turn.
GAP = math.radians(31.0)

#: A drum is filled by its mesh to this share: twelve corners leave 4.5 % of a circle out.
FILLED = (0.94, 1.06)

#: Most vertices that a frustum is fitted to; the distance of all is told.
MOST = 4000


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
        Largest distance of a vertex of the mesh from its surface [m].
    """

    foot: np.ndarray
    axis: np.ndarray
    bottom: float
    top: float
    height: float
    residual: float

    @property
    def volume(self) -> float:
        """[m³]"""
        return math.pi * self.height * (self.bottom**2 + self.bottom * self.top + self.top**2) / 12.0


class Hull(NamedTuple):
    """The convex hull of a mesh: its corners [m], shape (k, 3), and how far the mesh lies within it at most [m]."""

    corners: np.ndarray
    residual: float


def solid_of(part: MeshPart) -> Mesh:
    """The surface of a part, with the vertices that it uses."""
    numbers = {int(old): new for new, old in enumerate(part.used)}
    return Mesh(part.points[part.used], tuple(tuple(numbers[i] for i in face) for face in part.faces))


def fitted(part: MeshPart, tolerance: float, what: str) -> Frustum | Hull:
    """The frustum whose surface no vertex of a part is farther from than the tolerance [m], or else its hull.

    Raises
    ------
    InputError
        The part is no solid, or is not convex by more than the tolerance.
    """
    mesh = solid_of(part)
    volume = mesh_moments(mesh, 1.0).mass
    if not volume > LENGTHS[0] ** 3:
        inside = " its faces run clockwise: turn them round." if volume < 0.0 else " give a solid."
        raise InputError(f"{what} encloses {volume:.3g} m³;{inside}")
    drum = fit_frustum(mesh)
    if drum is not None and not FILLED[0] <= volume / drum.volume <= FILLED[1]:
        drum = None
    if drum is not None and drum.residual <= tolerance:
        return drum
    hull, within = fit_hull(mesh, volume, what)
    if within > tolerance:
        said = "" if drum is None else f", and a drum does not fit it by {1e3 * drum.residual:.3g} mm"
        raise InputError(
            f"{what} is not convex: it lies {1e3 * within:.3g} mm within its hull{said}; allowed are "
            f"{1e3 * tolerance:g} mm: split it into convex parts, or allow more with `tolerance`.",
            "tolerance",
        )
    return hull


def fit_hull(mesh: Mesh, volume: float, what: str) -> tuple[Hull, float]:
    """The hull of a mesh, and the depth of the mesh within it [m]: of a vertex, or its mean where that is more."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        found: Any = ConvexHull(mesh.vertices)
    except QhullError:
        raise InputError(f"{what} lies in one plane and has no thickness; give a solid.") from None
    planes, points = found.equations, _points_on(mesh)
    some = np.array_split(points, 1 + len(points) * len(planes) // 10_000_000)
    deepest = max(0.0, *(float(-(one @ planes[:, :3].T + planes[:, 3]).max(axis=1).min()) for one in some))
    depth = max(deepest, float(found.volume - volume) / float(found.area))
    return Hull(mesh.vertices[np.sort(found.vertices)], depth), depth


def _points_on(mesh: Mesh) -> np.ndarray:
    """Vertices, middles of edges and of faces [m], shape (k, 3): the edge within an L has its ends on the hull."""
    edges = {(min(edge), max(edge)) for face in mesh.faces for edge in zip(face, (*face[1:], face[0]), strict=True)}
    middles = mesh.vertices[np.array(sorted(edges))].mean(axis=1)
    return np.concatenate((mesh.vertices, middles, [mesh.vertices[list(face)].mean(axis=0) for face in mesh.faces]))


def fit_frustum(mesh: Mesh) -> Frustum | None:
    """The frustum nearest to the vertices of a mesh, by least squares of their distances; None of what is not round.

    The axis begins as whichever principal axis of the solid, or the vertical, brings the vertices nearest.
    """
    from scipy.optimize import least_squares

    moments = mesh_moments(mesh, 1.0)
    points, centre = mesh.vertices - moments.centroid, moments.centroid
    axes = [*np.linalg.eigh(moments.tensor)[1].T, np.array([0.0, 0.0, 1.0])]
    starts = [_start(points, axis) for axis in axes]
    best = min(starts, key=lambda one: float(np.square(_distances(points, *one)).sum()))
    frame, first = best
    size = float(np.ptp(points, axis=0).max())
    some = points[:: max(1, len(points) // MOST)]
    found: Any = least_squares(
        lambda x: _distances(some, frame, x) / size,
        first,
        x_scale=size,
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
        max_nfev=60,
    )
    values = found.x if found.cost <= 0.5 * float(np.square(_distances(some, frame, first) / size).sum()) else first
    foot, axis, (low, high, bottom, top) = _unpacked(frame, values)
    if high - low < LENGTHS[0] or min(bottom, top) < 0.5 * LENGTHS[0]:
        return None
    if axis[2] < 0.0:
        axis, low, high, bottom, top = -axis, -high, -low, top, bottom
    along = (points - foot) @ axis
    out = points - foot - np.outer(along, axis)
    outer = np.linalg.norm(out, axis=1) > 0.7 * min(bottom, top)
    for near in (along < low + 0.3 * (high - low), along > high - 0.3 * (high - low)):
        if not _round(out[outer & near], axis):
            return None
    residual = float(np.abs(_distances(points, frame, values)).max())
    axis = np.where(np.abs(axis) < 1e-9, 0.0, axis)
    axis = axis / np.linalg.norm(axis)
    return Frustum(centre + foot + low * axis, axis, 2.0 * bottom, 2.0 * top, high - low, residual)


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
    low, high, bottom, top = (float(one) for one in values[4:])
    return frame[:, :2] @ aside, axis / np.linalg.norm(axis), (low, high, bottom, top)


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


def _round(out: np.ndarray, axis: np.ndarray) -> bool:
    """Whether what lies outward from an axis leaves no gap around it."""
    if len(out) < 3:
        return False
    across = out[0] / np.linalg.norm(out[0])
    angle = np.sort(np.arctan2(out @ np.cross(axis, across), out @ across))
    return float(np.diff(angle, append=angle[0] + 2.0 * math.pi).max()) <= GAP
