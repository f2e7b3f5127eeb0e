"""Stacks of blocks of any convex quadrilateral outline, with inclined joints, for the statics of stacks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stylobate.column import Joint
from stylobate.column.drum import section_area, section_second_moment
from stylobate.constants import g as STANDARD_GRAVITY
from stylobate.models.rigid_block.block_stack import BASE_REACH, BlockStack


def stack_of_quadrilaterals(
    outlines: np.ndarray,
    joints: Joint | Sequence[Joint],
    *,
    density: float,
    depth: float = 1.0,
    gravity: float = STANDARD_GRAVITY,
) -> BlockStack:
    """Blocks of any convex quadrilateral outline; joints may be inclined, and faces of unequal length.

    Parameters
    ----------
    outlines : array
        Corners counter-clockwise from the lower left, block by block from the bottom [m], shape (n, 4, 2).
        The lower face of a block lies on the line of the upper face of the block below it.
    joints : Joint or sequence of Joint
        One for all, or one under each block.
    density : float
        [kg/m³]
    depth : float
        [m]
    gravity : float
        [m/s²]
    """
    corners = np.asarray(outlines, dtype=float)
    n = len(corners)
    laws = [joints] * n if isinstance(joints, Joint) else list(joints)
    corners = corners - corners[0, :2].mean(axis=0)
    area, centroid, polar = _polygon(corners)
    joint, angle, upper, lower = _faces(corners)
    width = np.minimum(upper[:, 1], lower[:, 1]) - np.maximum(upper[:, 0], lower[:, 0])
    contact = np.array([section_area("rectangular", d, depth) for d in width])
    second = np.array([section_second_moment("rectangular", d, depth) for d in width])
    normal = np.array([joint.normal_stiffness for joint in laws])
    return BlockStack(
        mass=density * depth * area,
        inertia=density * depth * polar,
        centroid=centroid,
        joint=joint,
        angle=angle,
        width=width,
        area=contact,
        second_moment=second,
        upper_reach=upper,
        lower_reach=lower,
        top=corners[-1, 2:].mean(axis=0),
        gravity=gravity,
        outlines=corners,
        normal_stiffness=normal * contact,
        rotational_stiffness=normal * second,
        shear_stiffness=np.array([joint.shear_stiffness for joint in laws]) * contact,
        friction=np.array([joint.tan_phi for joint in laws]),
        cohesion=np.array([joint.cohesion for joint in laws]) * contact,
    )


def _polygon(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Area, centroid and polar second moment about it of convex quadrilaterals, by the sum over their edges."""
    ahead = np.roll(corners, -1, axis=1)
    cross = corners[..., 0] * ahead[..., 1] - corners[..., 1] * ahead[..., 0]
    area = 0.5 * cross.sum(axis=1)
    centroid = ((corners + ahead) * cross[..., None]).sum(axis=1) / (6.0 * area[:, None])
    squares = (corners * corners + corners * ahead + ahead * ahead).sum(axis=2)
    polar = (squares * cross).sum(axis=1) / 12.0 - area * (centroid**2).sum(axis=1)
    return area, centroid, polar


def _faces(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Middle and angle of each joint, and the reach of its two faces."""
    n = len(corners)
    joint, angle, upper, lower = np.empty((n, 2)), np.empty(n), np.empty((n, 2)), np.empty((n, 2))
    for i in range(n):
        start, end = corners[i, 0], corners[i, 1]
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        across = np.array([-along[1], along[0]])
        below = np.array([-BASE_REACH, BASE_REACH])
        if i:
            face = corners[i - 1, [3, 2]] - start
            below = face @ along
            assert np.abs(face @ across).max() < 1e-9 * length
        left, right = max(0.0, below[0]), min(length, below[1])
        middle = 0.5 * (left + right)
        joint[i] = start + middle * along
        angle[i] = np.arctan2(along[1], along[0])
        upper[i] = -middle, length - middle
        lower[i] = below - middle
    return joint, angle, upper, lower
