"""A column in space that starts tilted about its rim: where its drums are, how they move, and what holds it there."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_geometry import rotation
from ..start import Start
from .packing import CORNERS


def placed(
    column: Column, start: Start, drum: np.ndarray, lane: int
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray], float]:
    """Fields of drums and joints of a column that stands tilted and turns as one rigid body, and what it rests on.

    The friction of the base's contact, and the normal force [N] that comes back with the fields, are those that carry the
    rigid body rolling from there: nothing rings at the start.

    Parameters
    ----------
    column : Column
    start : Start
    drum : array
        Records of the column upright and at rest.
    lane : int
    """
    h = np.array([math.cos(start.azimuth), math.sin(start.azimuth), 0.0])
    turn = rotation(np.cross([0.0, 0.0, 1.0], h), start.tilt)
    omega = np.array(start.angular_velocity)
    centroids = np.stack([drum[c][1:, lane] for c in "xyz"], axis=-1)
    centroids[:, 2] += -drum["fz"][1, lane] - drum["z"][1, lane]  # the base's joint as yet open
    radius = float(drum["rb"][1, lane])
    rim, low = (radius * h, None) if column.section == "circular" else _lowest_corners(drum, lane, h)
    arms = (centroids - rim) @ turn.T
    mass, axial = drum["m"][1:, lane], turn[:, 2]
    transverse = 1.0 / drum["ia"][1:, lane]
    difference = 1.0 / (drum["ic"][1:, lane] + drum["ia"][1:, lane]) - transverse
    first = turn[:, 0]
    other = 1.0 / (drum["ib"][1:, lane] + drum["ia"][1:, lane]) - transverse
    momentum = np.outer(transverse, omega) + np.outer(difference * (axial @ omega), axial)
    momentum = momentum + np.outer(other * (first @ omega), first)
    # the column as one body, rolling
    whole = mass @ arms / mass.sum()
    spread = arms - whole
    own = float(transverse.sum()) * np.eye(3) + float(difference.sum()) * np.outer(axial, axial)
    own = own + float(other.sum()) * np.outer(first, first)
    inertia = own + sum(m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r in zip(mass, spread, strict=True))
    force = _rolling_force(float(mass.sum()), inertia, -whole, axial, omega, column.gravity, rolls=low is None)
    places = rim + arms
    velocities = np.cross(omega, arms)
    fields = {}
    for c, name in enumerate("xyz"):
        fields[name] = np.concatenate(([0.0], places[:, c]))
        fields["v" + name] = np.concatenate(([0.0], velocities[:, c]))
        fields["l" + name] = np.concatenate(([0.0], momentum[:, c]))
        fields["w" + name] = np.concatenate(([0.0], np.full(column.n, omega[c])))
        for a, axis in enumerate("ijk"):
            fields[axis + name] = np.concatenate(([float(a == c)], np.full(column.n, turn[c, a])))
    for name in "xyz":  # the base stays where it is
        fields[name][0] = drum[name][0, lane]
    shear = np.zeros((column.n, 3 if low is None else 3 * len(CORNERS)))
    for corner in (0,) if low is None else low:
        shear[0, 3 * corner : 3 * corner + 2] = force[:2] / (1 if low is None else len(low))
    return fields, {"s": shear}, max(float(force[2]), 0.0)


def _lowest_corners(drum: np.ndarray, lane: int, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Middle of the corners that stay down when the lowest drum leans towards h [m], and their numbers: one or two."""
    corners = np.stack([drum[name][1, :, lane] for name in ("px", "py", "pz")], axis=-1)
    far = corners @ h
    low = np.flatnonzero(far > far.max() - 1e-9 * np.abs(corners).max())
    return corners[low].mean(axis=0), low


def _rolling_force(
    mass: float,
    inertia: np.ndarray,
    arm: np.ndarray,
    axis: np.ndarray,
    omega: np.ndarray,
    gravity: float,
    rolls: bool,
) -> np.ndarray:
    """Force of the ground on a body that rolls, or turns about a corner, without slipping [N], shape (3,).

    ``arm`` goes from the centroid to the contact [m]. The contact of a round body stays lowest, so that ``arm`` turns with
    the direction of lean, not with the body: v + ω × r = 0 at all times gives a = −ω̇ × r − ω × (Ω × r). A corner turns
    with the body.
    """
    up = np.array([0.0, 0.0, 1.0])
    sine2 = axis[0] ** 2 + axis[1] ** 2
    frame = np.zeros(3) if rolls else omega
    if rolls and sine2 > 0.0:
        change = np.cross(omega, axis)  # of the axis
        frame = np.cross(axis, change) + axis * axis[2] * (axis[0] * change[1] - axis[1] * change[0]) / sine2
    centripetal = np.cross(omega, np.cross(frame, arm))

    def moment(turning: np.ndarray) -> np.ndarray:
        return inertia @ turning + mass * np.cross(arm, np.cross(turning, arm))

    matrix = np.stack([moment(column) for column in np.eye(3)], axis=1)
    given = np.cross(arm, mass * (gravity * up - centripetal)) - np.cross(omega, inertia @ omega)
    turning = np.linalg.solve(matrix, given)
    return mass * (gravity * up - np.cross(turning, arm) - centripetal)
