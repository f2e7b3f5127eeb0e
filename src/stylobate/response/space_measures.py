"""What a run of an assembly in space comes down to: opening, slip, twist of its joints, what fell and when, the outcome."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ..column.structure import Structure
from .assembly_measures import TURNED, fallen_since, lowest_standing, measures_of_bodies
from .collapse import Touch
from .histories import Histories
from .links import LinkHistories
from .poses import quaternions
from .recorded import Recorded
from .residuals import Residuals, turned_up


def recorded_in_space(
    structure: Structure,
    time: np.ndarray,
    position: np.ndarray,
    axes: np.ndarray,
    energy: dict[str, np.ndarray],
    ground_acceleration: np.ndarray,
    ground_displacement: np.ndarray,
    *,
    failure: str,
    model: str,
    provenance: dict[str, Any],
    held: LinkHistories | None = None,
    velocity: np.ndarray | None = None,
    spin: np.ndarray | None = None,
    struck_at: float | None = None,
    **ended: Any,
) -> Recorded:
    """A run of an assembly in space from the recorded poses of its bodies.

    Parameters
    ----------
    structure : Structure
    time : array
        [s], shape (T,)
    position, axes : array
        Centroids of ``structure.bodies`` [m], shape (T, N, 3), and their axes as columns, shape (T, N, 3, 3).
    energy : dict of str to array
        Ledger [J], each term of shape (T,).
    ground_acceleration, ground_displacement : array
        [m/s²], [m], shape (T, 3)
    failure : str
        Why the run has failed and has no verdict; empty if it has one.
    model, provenance, held
        As of an assembly in the plane.
    velocity, spin : array, optional
        Of the centroids [m/s], and of the bodies' turning in the axes of space [rad/s], shape (T, N, 3).
    struck_at : float, optional
        When bodies that no joint holds together first touched [s].
    **ended
        How the run began and ended: see :func:`~stylobate.response.assembly_measures.measures_of_bodies`.
    """
    opening, slip, twist = joint_histories(structure, position, axes)
    moved = np.linalg.norm(position - position[0], axis=-1)
    down = fallen(structure, position[0], axes[0], position, axes)
    since = {} if failure else fallen_since(down)
    tilt = np.arccos(np.clip(_upright(axes[0], axes), -1.0, 1.0))
    free = [not body.fixed for body in structure.bodies]
    left = Residuals.in_space(
        slip[-1], twist[-1], (position[-1] - position[0])[free], turned_up(axes[-1, free], axes[0, free])
    )
    measures = measures_of_bodies(
        structure, time, position, moved, tilt, since, opening, np.linalg.norm(slip[-1], axis=-1),
        failed=bool(failure), reason=failure, touched=None if struck_at is None else Touch(struck_at), residuals=left,
        **ended,
    )  # fmt: skip
    histories = Histories.in_space(
        time, position, quaternions(axes), opening, slip, twist, None, None, ground_acceleration,
        ground_displacement, energy, velocity=velocity, spin=spin,
    )  # fmt: skip
    if held is not None:
        histories = replace(histories, links=held)
    return Recorded(structure, histories, measures, model, provenance, followed=True)


def fallen(
    structure: Structure, first: np.ndarray, first_axes: np.ndarray, position: np.ndarray, axes: np.ndarray
) -> np.ndarray:
    """Which bodies have fallen: lower than at the start by a share of their size, or tilted by more than 45°.

    Parameters
    ----------
    structure : Structure
    first, first_axes : array
        Centroids and axes at the start [m], [-], shape (N, 3), (N, 3, 3).
    position, axes : array
        At other times, shape (…, N, 3), (…, N, 3, 3).
    """
    return (position[..., 2] < lowest_standing(structure, first[:, 2])) | (
        _upright(first_axes, axes) < math.cos(TURNED)
    )


def _upright(first: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Cosine of the tilt since the start of what was vertical then, shape (…, N)."""
    return np.einsum("nk,...nk->...n", first[:, 2, :], axes[..., 2, :])


def _as_drawn(structure: Structure, body: int) -> tuple[np.ndarray, np.ndarray]:
    """Centroid of a body as drawn [m], and its axes as columns; those of the ground for the body that is it."""
    stone: Any = structure.bodies[body]
    if getattr(stone, "pieces", None) is None:
        return np.array([0.0, 0.0, structure.ground]), np.eye(3)
    return np.array(stone.position), stone.axes


def joint_histories(
    structure: Structure, position: np.ndarray, axes: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Largest gap of every joint [m], and since the start offset along it [m] and twist about its normal [rad].

    A gap is counted from where the faces touch without pressure, as they are drawn: an edge that rises less than its weight
    has pressed it has not opened. Shapes (T, J), (T, J, 2), (T, J).
    """
    joints = structure.space_joints or ()
    count = len(position), len(joints)
    opening, slip, twist = np.zeros(count), np.zeros((*count, 2)), np.zeros(count)
    for k, joint in enumerate(joints):
        u, v = joint.lower, joint.upper
        (place_u, axes_u), (place_v, axes_v) = (_as_drawn(structure, i) for i in (u, v))
        # what was drawn at the joint on either body, seen from the body below in the axes of the joint
        frame = axes[:, u] @ (axes_u.T @ joint.frame)
        below = position[:, u] + frame @ (joint.frame.T @ (joint.origin - place_u))
        turned = frame.swapaxes(1, 2) @ (axes[:, v] @ axes_v.T)
        moved = np.einsum("tba,tb->ta", frame, position[:, v] - below)
        corners = joint.origin + joint.corners @ joint.frame[:, :2].T - place_v
        gap = np.maximum((moved[:, 2, None] + turned[:, 2] @ corners.T).max(axis=1), 0.0)
        offset = moved[:, :2] + turned[:, :2] @ corners.mean(axis=0)
        opening[:, k] = np.maximum(gap - gap[0], 0.0)
        slip[:, k] = offset - offset[0]
        relative = turned @ joint.frame
        twist[:, k] = np.unwrap(
            np.arctan2(relative[:, 1, 0] - relative[:, 0, 1], relative[:, 0, 0] + relative[:, 1, 1])
        )
    return opening, slip, twist
