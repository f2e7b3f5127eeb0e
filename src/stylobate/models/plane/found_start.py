"""Start of a column as found, in lanes: every joint closed by its eccentric load, every drum where that puts it."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_geometry import Geometry, geometry, joint_load
from ...errors import InputError

#: Rounds of loads from positions and positions from loads; the elastic closures move the loads by 1e-5 of themselves.
ROUNDS = 4


def found_start(
    column: Column, stiffness: np.ndarray, xi: np.ndarray, share: np.ndarray
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Positions of the drums, and shear forces in the joints, in equilibrium under gravity.

    Parameters
    ----------
    column : Column
    stiffness : array
        Normal stiffness of each joint per length of its overlap [N/m²], shape (n,).
    xi, share : array
        Places (−1 … 1) and shares of the contact points of a joint, shapes (points,).

    Returns
    -------
    drum : dict of str to array
        Fields of the drums of the kernel that differ from those of a column as built, the base first, shapes (n + 1,).
    shear : array
        Shear force of every contact point [N], shape (n, points).
    """
    as_built = geometry(column)
    at, turned = as_built, np.zeros(column.n)
    gaps, shear = np.zeros((column.n, 2)), np.zeros((column.n, len(xi)))
    for _ in range(ROUNDS):
        for j in range(column.n):
            load = joint_load(column, at, j)
            length = float(as_built.high[j] - as_built.low[j])
            places = as_built.low[j] + 0.5 * length * (1.0 + xi)
            gaps[j], force = _closure(stiffness[j] * length * share, places, load.normal, load.place)
            shear[j] = -load.shear * force / load.normal
        at, turned = _settled(column, as_built, gaps)
    angle = at.lean + turned
    drum = {
        "x": (0.0, at.centroid[:, 0]),
        "z": (0.0, at.centroid[:, 1]),
        "c": (1.0, np.cos(angle)),
        "s": (0.0, np.sin(angle)),
    }
    return {name: np.concatenate(([base], values)) for name, (base, values) in drum.items()}, shear


def _closure(spring: np.ndarray, place: np.ndarray, load: float, at: float) -> tuple[np.ndarray, np.ndarray]:
    """Gaps at the first and the last contact point [m], and forces of all [N], that carry a load at a place.

    No-tension springs under a rigid face: two equations, linear as long as the same points bear; Newton's method.
    """
    reach = place - at
    line = np.array([load / spring.sum(), 0.0])  # closure at the load, and its slope along the joint
    for _ in range(100):
        closure = line[0] + line[1] * reach
        force = np.where(closure > 0.0, spring * closure, 0.0)
        rest = np.array([force.sum() - load, force @ reach])
        if abs(rest[0]) + abs(rest[1]) / np.ptp(reach) < 1e-12 * load:
            return -(line[0] + line[1] * reach[[0, -1]]), force
        bearing = np.where(closure > 0.0, spring, 0.0)
        moments = [float(bearing @ reach**power) for power in range(3)]
        if moments[0] * moments[2] - moments[1] ** 2 <= 0.0:  # one point bears: let all of them, half as much
            line = 0.5 * line + 0.5 * np.array([load / spring.sum(), 0.0])
            continue
        line = line - np.linalg.solve([[moments[0], moments[1]], [moments[1], moments[2]]], rest)
    raise InputError(
        "a joint of the column as found carries its load at the very edge; make its offset or tilt smaller."
    )


def _settled(column: Column, as_built: Geometry, gaps: np.ndarray) -> tuple[Geometry, np.ndarray]:
    """The column with its joints closed by these gaps at the ends of their contacts; rotation in each joint [rad]."""
    lean, origins, centroids = np.empty(column.n), np.empty((column.n, 2)), np.empty((column.n, 2))
    rotation = np.arctan2(gaps[:, 1] - gaps[:, 0], as_built.high - as_built.low)
    origin, angle = np.zeros(2), 0.0
    for i, drum in enumerate(column.drums):
        offset = column.as_found.of(i + 1).offset
        along = np.array([math.cos(angle), math.sin(angle)])
        gap = gaps[i, 0] + (offset - as_built.low[i]) * math.tan(rotation[i])
        lean[i], origins[i] = angle, origin
        middle = origin + offset * along + gap * np.array([-along[1], along[0]])
        angle += rotation[i] + as_built.tilt[i]
        up = np.array([-math.sin(angle), math.cos(angle)])
        centroids[i] = middle + drum.centroid_height * up
        origin = middle + drum.height * up
    return as_built._replace(lean=lean, origin=origins, centroid=centroids), rotation
