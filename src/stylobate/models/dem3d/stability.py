"""Largest stable time step of drums in space, from the stiffness of the closed column."""

from __future__ import annotations

import numpy as np

from ...column import Column
from ..shared.stable_step import highest_frequency as of_springs


def highest_frequency(column: Column, kn: np.ndarray, ks: np.ndarray, share: float) -> float:
    """Highest angular frequency of the column with all joints closed [rad/s].

    Parameters
    ----------
    column : Column
    kn, ks : array
        Normal and shear stiffness per area of each joint [N/m³], shape (n,).
    share : float
        χ: bending stiffness of a joint over k_n J, less 1 (1 for the rim law, 0 for an elastic bed, 2 for corners).

    Notes
    -----
    An open or sliding joint is softer than a closed one, so that this bounds every state. Bending and sway of a vertical
    plane (x, z, θ per drum), the same in all directions for round drums, in two for rectangular ones; and torsion.
    """
    n = column.n
    second, across = column.joint_second_moments, column.joint_second_moments
    torsion_of, mass = 1.0, column.masses
    planes = [(second, column.inertias)]
    if column.section != "circular":
        depth = column.joint_areas / column.joint_widths
        across = column.joint_areas * depth**2 / 12.0
        torsion_of = 1.0 + share  # the corners are at the same distance in torsion as in bending
        planes.append((across, np.array([drum.cross_inertia for drum in column.drums])))
    axial = np.array([drum.axial_inertia for drum in column.drums])
    around = np.eye(n) - np.eye(n, k=-1)
    torsion = around.T @ np.diag(torsion_of * ks * (second + across)) @ around
    highest = of_springs(torsion, 1.0 / axial)
    for bending, inertia in planes:
        stiffness = _sway(column, kn, ks, (1.0 + share) * bending)
        highest = max(highest, of_springs(stiffness, 1.0 / np.stack((mass, mass, inertia), axis=1).ravel()))
    return highest


def _sway(column: Column, kn: np.ndarray, ks: np.ndarray, bending: np.ndarray) -> np.ndarray:
    """Stiffness of the closed column in a vertical plane, for x, z and θ of every drum, shape (3 n, 3 n)."""
    n = column.n
    stiffness = np.zeros((3 * n, 3 * n))
    centroid = np.array([drum.centroid_height for drum in column.drums])
    for j in range(n):
        area = column.joint_areas[j]
        rows = np.zeros((3, 3 * n))  # shear, closure, rotation of the joint per degree of freedom
        rows[0, 3 * j], rows[0, 3 * j + 2] = 1.0, centroid[j]
        rows[1, 3 * j + 1] = rows[2, 3 * j + 2] = 1.0
        if j:
            rows[0, 3 * j - 3], rows[0, 3 * j - 1] = -1.0, column.drums[j - 1].height - centroid[j - 1]
            rows[1, 3 * j - 2] = rows[2, 3 * j - 1] = -1.0
        stiffness += rows.T @ np.diag([ks[j] * area, kn[j] * area, kn[j] * bending[j]]) @ rows
    return stiffness
