"""Recorded histories of a run: poses of all bodies, joints, ground and energy, in the plane or in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .links import LinkHistories
from .poses import PlanePoses, SpacePoses

#: Terms of the energy ledger, in order: input = kinetic + gravitational + elastic + friction + viscous + impact + imbalance.
ENERGY_TERMS = ("input", "kinetic", "gravitational", "elastic", "friction", "viscous", "impact")


@dataclass(frozen=True, eq=False)
class Histories:
    """Recorded histories, relative to the moving base. Made by :meth:`of_drums`, :meth:`of_blocks` or :meth:`in_space`.

    Parameters
    ----------
    time : array
        [s], shape (T,)
    poses : PlanePoses or SpacePoses
        Of all bodies.
    opening : array
        Largest gap between the two faces of each joint, 0 when fully closed [m], shape (T, J).
    slip : array
        Offset along each joint of the body above to the one below, from the start [m], shape (T, J, 2): along x and y of
        the joint's lower face. The second is zero in the plane.
    twist : array
        Turn of the body above each joint about the joint's normal, from the start [rad], shape (T, J).
    acceleration, displacement : array
        Of the ground along x, y and z [m/s²], [m], shape (T, 3). Absolute displacement = relative + ground.
    energy : dict of str to array
        Ledger by :data:`ENERGY_TERMS` [J], each of shape (T,); terms that a model lacks are zero.
        ``input``, ``friction``, ``viscous`` and ``impact`` are sums since the start, the others changes since the start.
    base, top : array, optional
        Horizontal displacement of the middle of the lowest and of the topmost face [m], shape (T,), in space (T, 2).
    links : LinkHistories, optional
        Of the links of a column that has some.
    velocity, spin : array, optional
        Of the centroids, relative to the moving base [m/s], and of the bodies' turning [rad/s], in the axes of space, shape
        (T, N, 3); of an assembly.
    """

    time: np.ndarray
    poses: PlanePoses | SpacePoses
    opening: np.ndarray
    slip: np.ndarray
    twist: np.ndarray
    acceleration: np.ndarray
    displacement: np.ndarray
    energy: dict[str, np.ndarray]
    base: np.ndarray | None = None
    top: np.ndarray | None = None
    links: LinkHistories | None = None
    velocity: np.ndarray | None = None
    spin: np.ndarray | None = None

    # -- made from -----------------------------------------------------------------------------------------------

    @classmethod
    def of_drums(
        cls,
        time: np.ndarray,
        drum_x: np.ndarray,
        drum_z: np.ndarray,
        drum_rotation: np.ndarray,
        joint_opening: np.ndarray,
        joint_slip: np.ndarray,
        base_displacement: np.ndarray,
        top_displacement: np.ndarray,
        ground_acceleration: np.ndarray,
        ground_displacement: np.ndarray,
        energy: dict[str, np.ndarray],
    ) -> Histories:
        """A column in the plane.

        Parameters
        ----------
        time : array
            [s], shape (T,)
        drum_x, drum_z : array
            Displacement of each drum's centroid along and normal to the base, from the start [m], shape (T, n).
        drum_rotation : array
            From the start, counter-clockwise positive (the top goes to −x) [rad], shape (T, n).
        joint_opening, joint_slip : array
            [m], shape (T, n)
        base_displacement, top_displacement : array
            [m], shape (T,)
        ground_acceleration, ground_displacement : array
            Along x, or along all three axes [m/s²], [m], shape (T,) or (T, 3).
        energy : dict of str to array
        """
        return cls(
            time, PlanePoses(drum_x, drum_z, drum_rotation), joint_opening, _in_plane(joint_slip),
            np.zeros_like(joint_opening), _along_axes(ground_acceleration), _along_axes(ground_displacement), energy,
            base_displacement, top_displacement,
        )  # fmt: skip

    @classmethod
    def of_blocks(
        cls,
        time: np.ndarray,
        x: np.ndarray,
        z: np.ndarray,
        rotation: np.ndarray,
        joint_opening: np.ndarray,
        joint_slip: np.ndarray,
        ground_acceleration: np.ndarray,
        ground_displacement: np.ndarray,
        energy: dict[str, np.ndarray],
        velocity: np.ndarray | None = None,
    ) -> Histories:
        """An assembly in the plane: ``x`` and ``z`` are the places of the centroids [m]; the rest as for columns.

        ``velocity`` is that along x and z [m/s] and of the rotation, counter-clockwise [rad/s], shape (T, n, 3).
        """
        moving, spin = None, None
        if velocity is not None:
            zero = np.zeros_like(x)
            moving = np.stack((velocity[..., 0], zero, velocity[..., 1]), axis=-1)
            spin = np.stack((zero, -velocity[..., 2], zero), axis=-1)
        return cls(
            time, PlanePoses(x, z, rotation), joint_opening, _in_plane(joint_slip), np.zeros_like(joint_opening),
            _along_axes(ground_acceleration), _along_axes(ground_displacement), energy, velocity=moving, spin=spin,
        )  # fmt: skip

    @classmethod
    def in_space(
        cls,
        time: np.ndarray,
        position: np.ndarray,
        orientation: np.ndarray,
        joint_opening: np.ndarray,
        joint_slip: np.ndarray,
        joint_twist: np.ndarray,
        base_displacement: np.ndarray | None,
        top_displacement: np.ndarray | None,
        ground_acceleration: np.ndarray,
        ground_displacement: np.ndarray,
        energy: dict[str, np.ndarray],
        velocity: np.ndarray | None = None,
        spin: np.ndarray | None = None,
    ) -> Histories:
        """A column, a single body or an assembly in space.

        Parameters
        ----------
        time : array
            [s], shape (T,)
        position : array
            Centroids from the middle of the base's contact, which moves with the ground [m], shape (T, n, 3).
        orientation : array
            Unit quaternions from the body's axes (z along the drum's axis) to those of space, shape (T, n, 4).
        joint_opening, joint_twist : array
            [m], [rad], shape (T, n)
        joint_slip : array
            [m], shape (T, n, 2)
        base_displacement, top_displacement : array or None
            Along x and y, from the start [m], shape (T, 2); None of an assembly.
        ground_acceleration, ground_displacement : array
            [m/s²], [m], shape (T, 3)
        energy : dict of str to array
        velocity, spin : array, optional
            [m/s], [rad/s], shape (T, n, 3)
        """
        return cls(
            time, SpacePoses(position, orientation), joint_opening, joint_slip, joint_twist, ground_acceleration,
            ground_displacement, energy, base_displacement, top_displacement, velocity=velocity, spin=spin,
        )  # fmt: skip

    # -- views ---------------------------------------------------------------------------------------------------

    @property
    def dims(self) -> str:
        """``xz`` in the plane, ``xyz`` in space."""
        return "xz" if isinstance(self.poses, PlanePoses) else "xyz"

    @property
    def drum_x(self) -> np.ndarray:
        """Displacement of each centroid along x (in the plane: along the base) from the start [m], shape (T, n)."""
        return self.poses.x if isinstance(self.poses, PlanePoses) else self._moved(0)

    @property
    def drum_y(self) -> np.ndarray:
        """Displacement of each centroid along y from the start [m], shape (T, n); zero in the plane."""
        return np.zeros_like(self.poses.x) if isinstance(self.poses, PlanePoses) else self._moved(1)

    @property
    def drum_z(self) -> np.ndarray:
        """Displacement of each centroid upward (in the plane: normal to the base) from the start [m], shape (T, n)."""
        return self.poses.z if isinstance(self.poses, PlanePoses) else self._moved(2)

    @property
    def drum_rotation(self) -> np.ndarray:
        """Rotation of each drum about −y (top to −x) [rad], shape (T, n), as ``rotation``; in space of its axis."""
        if isinstance(self.poses, PlanePoses):
            return self.poses.rotation
        x, _, z = np.moveaxis(self.poses.axis, -1, 0)
        return np.arctan2(-x, z)

    @property
    def joint_opening(self) -> np.ndarray:
        """Largest gap between the two faces of each joint [m], shape (T, J); as ``opening``."""
        return self.opening

    @property
    def joint_slip(self) -> np.ndarray:
        """Offset along each joint, from the start [m], shape (T, J); in space as ``slip``, (T, J, 2)."""
        return self._plane_or_space(self.slip)

    @property
    def joint_twist(self) -> np.ndarray:
        """Turn about the normal of each joint, from the start [rad], shape (T, J); zero in the plane."""
        return self.twist

    @property
    def base_displacement(self) -> np.ndarray:
        """Horizontal displacement of the middle of the lowest face [m], shape (T,); in space (T, 2)."""
        return _there(self.base, "base")

    @property
    def top_displacement(self) -> np.ndarray:
        """Horizontal displacement of the middle of the topmost face [m], shape (T,); in space (T, 2)."""
        return _there(self.top, "top")

    @property
    def ground_acceleration(self) -> np.ndarray:
        """Of the base along x [m/s²], shape (T,); in space along all axes, shape (T, 3)."""
        return self._plane_or_space(self.acceleration)

    @property
    def ground_displacement(self) -> np.ndarray:
        """Of the base along x [m], shape (T,); in space along all axes, shape (T, 3)."""
        return self._plane_or_space(self.displacement)

    @property
    def imbalance(self) -> np.ndarray:
        """Input minus everything that the ledger accounts for [J], shape (T,)."""
        zero = np.zeros_like(self.time)
        terms = [self.energy.get(term, zero) for term in ENERGY_TERMS]
        return terms[0] - sum(terms[1:], zero)

    def _moved(self, axis: int) -> np.ndarray:
        assert isinstance(self.poses, SpacePoses)
        return self.poses.position[..., axis] - self.poses.position[:1, :, axis]

    def _plane_or_space(self, values: np.ndarray) -> np.ndarray:
        return values[..., 0] if self.dims == "xz" else values


def _in_plane(slip: np.ndarray) -> np.ndarray:
    return np.stack((slip, np.zeros_like(slip)), axis=-1)


def _along_axes(values: np.ndarray) -> np.ndarray:
    if values.ndim == 2:
        return values
    zero = np.zeros_like(values)
    return np.stack((values, zero, zero), axis=-1)


def _there(values: np.ndarray | None, what: str) -> np.ndarray:
    if values is None:
        raise AttributeError(f"an assembly has no {what}; its blocks have places: body_position")
    return values
