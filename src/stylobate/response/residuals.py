"""Residuals with their directions: offsets and twists of joints, displacements and tilts of bodies at the end of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..column.structure import Structure
from .histories import Histories
from .poses import PlanePoses, rotation_matrices


@dataclass(frozen=True)
class Residuals:
    """What a run leaves behind, joint by joint and body by body, from how it stood before; of what fell as it lay then.

    Parameters
    ----------
    slip_x, slip_y : tuple of float
        Offset along each joint, along x and y of its lower face [m].
    twist : tuple of float
        Turn about each joint's normal, from x towards y [rad].
    moved_x, moved_y, moved_z : tuple of float
        Displacement of the centroid of each body that can move, in the axes of the base [m].
    tilt_x, tilt_y : tuple of float
        Turn of what was vertical in each of these bodies, along x and y of the direction in which it leans [rad].

    In the plane there is no ``slip_y``, ``twist``, ``moved_y`` and ``tilt_y``: they are None.
    """

    slip_x: tuple[float, ...] = ()
    slip_y: tuple[float, ...] | None = None
    twist: tuple[float, ...] | None = None
    moved_x: tuple[float, ...] = ()
    moved_y: tuple[float, ...] | None = None
    moved_z: tuple[float, ...] = ()
    tilt_x: tuple[float, ...] = ()
    tilt_y: tuple[float, ...] | None = None

    @classmethod
    def in_plane(cls, slip: np.ndarray, x: np.ndarray, z: np.ndarray, rotation: np.ndarray) -> Residuals:
        """From slips [m], shape (J,), displacements [m] and rotations, counter-clockwise [rad], shape (n,)."""
        return cls.all_in_plane(slip[None], x[None], z[None], rotation[None])[0]

    @classmethod
    def all_in_plane(cls, slip: np.ndarray, x: np.ndarray, z: np.ndarray, rotation: np.ndarray) -> list[Residuals]:
        """Those of many runs, whose axis comes first."""
        tilt = np.arctan2(-np.sin(rotation), np.cos(rotation)) + 0.0  # no -0.0
        rows = zip(*map(_rows, (slip, x, z, tilt)), strict=True)
        return [cls(slips, moved_x=right, moved_z=up, tilt_x=lean) for slips, right, up, lean in rows]

    @classmethod
    def of_one(cls, slip: float, x: float, z: float, tilt: float) -> Residuals:
        """Of a single body in the plane, which leans to the right by ``tilt`` [rad]: numbers cost less than arrays."""
        return cls((slip,), moved_x=(x,), moved_z=(z,), tilt_x=(math.atan2(math.sin(tilt), math.cos(tilt)),))

    @classmethod
    def in_space(cls, slip: np.ndarray, twist: np.ndarray, moved: np.ndarray, up: np.ndarray) -> Residuals:
        """From slips [m] and twists [rad] of joints, and displacements [m] and what was vertical [-] of bodies.

        Parameters
        ----------
        slip, twist : array
            Shapes (J, 2) and (J,).
        moved, up : array
            Shape (n, 3); ``up`` are unit vectors.
        """
        return cls.all_in_space(slip[None], twist[None], moved[None], up[None])[0]

    @classmethod
    def all_in_space(cls, slip: np.ndarray, twist: np.ndarray, moved: np.ndarray, up: np.ndarray) -> list[Residuals]:
        """Those of many runs, whose axis comes first."""
        x, y, z = np.moveaxis(up, -1, 0)
        flat = np.hypot(x, y)
        angle, along = np.arctan2(flat, z), np.where(flat > 0.0, flat, 1.0)
        tilt = angle * np.where(flat > 0.0, x / along, 1.0), angle * np.where(flat > 0.0, y / along, 0.0)
        fields = (*np.moveaxis(slip, -1, 0), twist, *np.moveaxis(moved, -1, 0), *tilt)
        return [cls(*row) for row in zip(*map(_rows, fields), strict=True)]

    @property
    def slips(self) -> tuple[float, ...]:
        """Length of the offset along each joint [m]."""
        return _plain(np.abs(self.slip_x) if self.slip_y is None else np.hypot(self.slip_x, self.slip_y))

    def of_joints(self) -> dict[str, list[float]]:
        """Those of joints, under the names of rows."""
        row = self._named("slip_x", "slip_y", "twist")
        if self.twist is not None:
            row["residual_slip_per_joint_m"] = list(self.slips)
            row["residual_twist_per_joint_rad"] = list(self.twist)
        return row

    def of_bodies(self) -> dict[str, list[float]]:
        """Those of bodies, under the names of rows."""
        return self._named("moved_x", "moved_y", "moved_z", "tilt_x", "tilt_y")

    def row(self) -> dict[str, list[float]]:
        """The facts under the names that scripts rely on."""
        return self.of_joints() | self.of_bodies()

    def _named(self, *names: str) -> dict[str, list[float]]:
        return {NAMES[name]: list(values) for name in names if (values := getattr(self, name)) is not None}


#: Names of residuals in rows, by field.
NAMES = {
    "slip_x": "residual_slip_x_m",
    "slip_y": "residual_slip_y_m",
    "twist": "residual_twist_rad",
    "moved_x": "residual_displacement_x_m",
    "moved_y": "residual_displacement_y_m",
    "moved_z": "residual_displacement_z_m",
    "tilt_x": "residual_tilt_x_rad",
    "tilt_y": "residual_tilt_y_rad",
}


def no_residuals(*, space: bool) -> Residuals:
    """Those of a run before there is one."""
    return Residuals(**dict.fromkeys(NAMES, ())) if space else Residuals()


def turned_up(axes: np.ndarray, first: np.ndarray) -> np.ndarray:
    """What was vertical at first [-], in the axes of space, by axes of bodies as columns, shape (…, n, 3, 3)."""
    return np.einsum("...nij,...nj->...ni", axes, first[..., 2, :])


def residuals_of(structure: Structure, histories: Histories, since: int | None = None) -> Residuals:
    """Residuals of a run by its last recorded state, from how it stood before the run, or from a later state on."""
    h, poses = histories, histories.poses
    slip, twist = h.slip[-1], h.twist[-1]
    if since is not None:
        slip, twist = slip - h.slip[since], twist - h.twist[since]
    free = [not body.fixed for body in structure.bodies[structure.first :]]
    if isinstance(poses, PlanePoses):
        states = np.stack((poses.x, poses.z, poses.rotation), axis=-1)[:, free]
        before = 0.0 if since is None and structure.relative else states[since or 0]
        return Residuals.in_plane(slip[:, 0], *(states[-1] - before).T)
    first, last = (rotation_matrices(poses.orientation[k, free]) for k in (since or 0, -1))
    moved = (poses.position[-1] - poses.position[since or 0])[free]
    return Residuals.in_space(slip, twist, moved, turned_up(last, first))


def _plain(values: np.ndarray) -> tuple[float, ...]:
    return tuple(np.asarray(values, dtype=float).tolist())


def _rows(values: np.ndarray) -> list[tuple[float, ...]]:
    return [tuple(row) for row in np.asarray(values, dtype=float).tolist()]
