"""What each joint of a column carries in a run in the plane, from the motion of what stands on it.

Its weight, the joint and the links across it move what is above a joint, and nothing else does. With r the place of a drum's
centroid, u the displacement of the ground, θ̈ the rate of its spin, and c the middle of the face that stands on the joint,

    (V, N) = Σ m (r̈ + ü + g),    M = Σ [I θ̈ + (r − c) × m (r̈ + ü + g)],

the equations of motion of each drum (Baraldi et al., Eq. 2, with accelerations), summed over those above. The second
difference of a history over two recording intervals is its acceleration, averaged over them with weights that fall linearly
from their middle; so these are means of the forces, whatever acted in between, and the blows at impacts are spread over two
intervals. M is exact as far as the arms r − c hardly change in that time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..column import Column
from ..errors import InputError
from .poses import PlanePoses
from .recorded import Recorded


@dataclass(frozen=True, eq=False)
class JointForces:
    """Actions of the joints of a column on what stands on them, with those of the links across them.

    Parameters
    ----------
    time : array
        [s], shape (T,): recorded times but for the first and the last, until a part of the column has left its support.
    normal, shear : array
        Along and across the vertical: upward, and along x [N], shape (T, n); joints from the base.
    moment : array
        About the middle of the lower face of the drum above, counter-clockwise (x to the right, z up) [N m], shape (T, n).
    """

    time: np.ndarray
    normal: np.ndarray
    shear: np.ndarray
    moment: np.ndarray

    @property
    def eccentricity(self) -> np.ndarray:
        """Where the normal force acts, from the middle of the face along x [m], shape (T, n)."""
        return self.moment / self.normal


def joint_forces(response: Recorded) -> JointForces:
    """Normal force, shear and moment of every joint of a column, averaged over two recording intervals.

    Masses are those of the column as it stands, whatever shape a model gives its drums. The equations of the rigid beam have
    no vertical motion but the ground's, and so have its normal forces.

    Raises
    ------
    InputError
        It is no run of a column in the plane, or has fewer than three states at equal intervals.
    """
    h, column = response.histories, response.structure.stack
    if column is None or not isinstance(h.poses, PlanePoses):
        raise InputError("forces of joints are known for columns in the plane; take dem2d, rigid-block or rigid-beam.")
    step = float(h.time[1] - h.time[0]) if len(h.time) > 1 else 0.0
    even = (np.abs(np.diff(h.time) - step) < 1e-6 * step) & ~(h.time[1:] > response.measures.collapse_time)
    count = int(np.argmin(np.append(even, False))) + 1  # the end of a run may come between two recordings
    if count < 3:
        raise InputError(
            f"the run has {count} states at equal intervals; allowed are 3 or more: take a shorter output_interval."
        )
    seen = response.bodies.reference.plane(h.poses)[:count]
    at, angle = seen[..., :2], seen[..., 2]
    moved = at + h.displacement[:count, None, ::2]
    acceleration = _mean_acceleration(moved, step)
    if response.model == "rigid-beam":  # it moves across the vertical only: drums neither rise nor fall
        acceleration[..., 1] = _mean_acceleration(h.displacement[:count, None, 2], step)
    force = column.masses[:, None] * (acceleration + np.array([0.0, column.gravity]))
    torque = column.inertias * _mean_acceleration(angle, step)
    place = at[1:-1]
    own = torque + _cross(place, force)
    above = np.triu(np.ones((column.n, column.n)))
    total, about_origin = np.einsum("ij,tjk->tik", above, force), own @ above.T
    moment = about_origin - _cross(_faces(column, seen[1:-1]), total)
    return JointForces(h.time[1 : count - 1], total[..., 1], total[..., 0], moment)


def _faces(column: Column, seen: np.ndarray) -> np.ndarray:
    """Middle of the lower face of every drum [m], shape (T, n, 2); ``seen`` holds place and inclination, (T, n, 3)."""
    faces = [pair.above for pair in column.face_pairs]
    start = np.array([body.angle - body.lean for body in column.bodies[column.first :]])
    turned = seen[..., 2] - start + np.arctan2(*np.array([face.direction for face in faces]).T[::-1])
    along, down = np.array([(0.5 * (face.right - face.left), face.height) for face in faces]).T
    c, s = np.cos(turned), np.sin(turned)
    return seen[..., :2] + np.stack((c * along + s * down, s * along - c * down), axis=-1)


def _mean_acceleration(values: np.ndarray, step: float) -> np.ndarray:
    return (values[2:] - 2.0 * values[1:-1] + values[:-2]) / step**2


def _cross(arm: np.ndarray, force: np.ndarray) -> np.ndarray:
    return arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0]
