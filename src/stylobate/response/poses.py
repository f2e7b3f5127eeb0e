"""Bodies of what stood: names, shapes, and places and rotations as a model records them and in space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..column.block import FAR_AWAY
from ..column.shapes import Shape
from ..column.structure import Structure
from ..constants import DEGREE


@dataclass(frozen=True, eq=False)
class PlanePoses:
    """Poses in the plane x–z as a plane model records them.

    Parameters
    ----------
    x, z : array
        Along and normal to the base, relative to it and to the reference of the body [m], shape (T, n).
    rotation : array
        Counter-clockwise with x to the right and z up, so about −y; from the reference [rad], shape (T, n).
    """

    x: np.ndarray
    z: np.ndarray
    rotation: np.ndarray


@dataclass(frozen=True, eq=False)
class SpacePoses:
    """Poses in space, relative to the moving base.

    Parameters
    ----------
    position : array
        Centroid of each body, x and y horizontal, z up [m], shape (T, n, 3).
    orientation : array
        Unit quaternion that turns the body's axes into those of space, real part first [-], shape (T, n, 4).
    """

    position: np.ndarray
    orientation: np.ndarray

    @cached_property
    def axis(self) -> np.ndarray:
        """The body's own z axis [-], shape (T, n, 3)."""
        w, x, y, z = np.moveaxis(self.orientation, -1, 0)
        return np.stack((2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)), axis=-1)


@dataclass(frozen=True, eq=False)
class Reference:
    """References of the poses of a plane model, body by body.

    Parameters
    ----------
    place : array
        Along and normal to the base [m], shape (n, 2).
    angle : array
        Inclination of the body's axes to the base, counter-clockwise [rad], shape (n,).
    slope : float
        Of the base, counter-clockwise [rad].
    """

    place: np.ndarray
    angle: np.ndarray
    slope: float = 0.0

    def plane(self, poses: PlanePoses, factor: float = 1.0) -> np.ndarray:
        """Horizontal and vertical place [m] and inclination [rad] of all bodies, shape (T, n, 3).

        Parameters
        ----------
        poses : PlanePoses
        factor : float
            By which displacements and rotations are made larger.
        """
        along = self.place + factor * np.stack((poses.x, poses.z), axis=-1)
        c, s = np.cos(self.slope), np.sin(self.slope)
        turned = self.slope + self.angle + factor * poses.rotation
        return np.concatenate((along @ np.array([[c, s], [-s, c]]), turned[..., None]), axis=-1)

    def space(self, poses: PlanePoses) -> SpacePoses:
        """The same poses in space: y is zero, bodies turn about −y."""
        x, z, angle = np.moveaxis(self.plane(poses), -1, 0)
        zero = np.zeros_like(x)
        quaternion = np.stack((np.cos(0.5 * angle), zero, -np.sin(0.5 * angle), zero), axis=-1)
        return SpacePoses(np.stack((x, zero, z), axis=-1), quaternion)


def rotation_matrices(orientation: np.ndarray) -> np.ndarray:
    """Matrices that turn body axes into those of space, of unit quaternions, shape (…, 4) to (…, 3, 3)."""
    w, x, y, z = np.moveaxis(orientation, -1, 0)
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def exaggerated(poses: SpacePoses, index: int, factor: float) -> SpacePoses:
    """One state with displacements and turns from the first state made larger, shapes (n, 3) and (n, 4)."""
    first, now = poses.orientation[0], poses.orientation[index]
    place = poses.position[0] + factor * (poses.position[index] - poses.position[0])
    if factor == 1.0:
        return SpacePoses(poses.position[index], now)
    w, x, y, z = np.moveaxis(first * [1.0, -1.0, -1.0, -1.0], -1, 0)
    a, b, c, d = np.moveaxis(now, -1, 0)
    turn = np.stack(  # the turn from the first state, now times the inverse of first
        (a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x,
         a * z + b * y - c * x + d * w), axis=-1,
    )  # fmt: skip
    turn = np.where(turn[..., :1] < 0.0, -turn, turn)
    size = np.linalg.norm(turn[..., 1:], axis=-1, keepdims=True)
    half = factor * np.arctan2(size, turn[..., :1])
    larger = np.concatenate((np.cos(half), np.sin(half) * turn[..., 1:] / np.where(size > 0.0, size, 1.0)), axis=-1)
    a, b, c, d = np.moveaxis(larger, -1, 0)
    w, x, y, z = np.moveaxis(first, -1, 0)
    orientation = np.stack(
        (a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x,
         a * z + b * y - c * x + d * w), axis=-1,
    )  # fmt: skip
    return SpacePoses(place, orientation)


def quaternions(matrices: np.ndarray) -> np.ndarray:
    """Unit quaternions, real part first and not negative, of rotation matrices, shape (…, 3, 3) to (…, 4)."""
    from scipy.spatial.transform import Rotation

    shape = matrices.shape[:-2]
    known = np.isfinite(matrices).all(axis=(-1, -2), keepdims=True)  # a run that failed may end in what is not finite
    imaginary_first = Rotation.from_matrix(np.where(known, matrices, np.eye(3)).reshape(-1, 3, 3)).as_quat()
    imaginary_first[~known.ravel()] = np.nan
    real_first = np.roll(imaginary_first, 1, axis=-1)
    return np.where(real_first[:, :1] < 0.0, -real_first, real_first).reshape(*shape, 4)


@dataclass(frozen=True, eq=False)
class Bodies:
    """All bodies of a structure, in the order of the response's columns.

    Parameters
    ----------
    names : tuple of str
    shapes : tuple of Shape
    fixed : tuple of bool
        Which of them move with the ground.
    reference : Reference
        What the poses of plane models refer to.
    level : float or None
        Height of the ground at x = 0 [m]; None for no ground.
    """

    names: tuple[str, ...]
    shapes: tuple[Shape, ...]
    fixed: tuple[bool, ...]
    reference: Reference
    level: float | None = 0.0

    @property
    def shown(self) -> tuple[int, ...]:
        """Bodies that a picture shows: all but a ground without ends."""
        far = [
            fixed and np.ptp(shape.outline, axis=0).max() > FAR_AWAY for shape, fixed in zip(self.shapes, self.fixed)
        ]
        return tuple(i for i, away in enumerate(far) if not away)


def bodies_of(structure: Structure) -> Bodies:
    """Bodies of what stood that a run records."""
    bodies = structure.bodies[structure.first :]
    stand = [(*body.place, body.angle) if structure.relative else (0.0, 0.0, 0.0) for body in bodies]
    at = np.array(stand)
    return Bodies(
        tuple(body.name for body in bodies),
        tuple(body.shape for body in bodies),
        tuple(body.fixed for body in bodies),
        Reference(at[:, :2], at[:, 2], structure.as_found.base_tilt * DEGREE),
        structure.ground,
    )
