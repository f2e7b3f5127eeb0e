"""Volume, centroid and inertia of solids: of drums in closed form, of what has flat faces by its pyramids."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..drum import Drum
from ..shapes import Chipped, CircularFrustum, Mesh, RectangularFrustum


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
