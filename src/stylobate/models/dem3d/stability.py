"""Largest stable time step of round drums in space, from the stiffness of the closed column."""

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
        χ: bending stiffness of a joint over k_n J, less 1 (1 for the rim law, 0 for an elastic bed).

    Notes
    -----
    An open or sliding joint is softer than a closed one, so that this bounds every state. The column is the same in all
    vertical planes: bending and sway of one plane (x, z, θ per drum), and torsion.
    """
    n = column.n
    stiffness, torsion = np.zeros((3 * n, 3 * n)), np.zeros((n, n))
    centroid = np.array([drum.centroid_height for drum in column.drums])
    for j in range(n):
        area, second = column.joint_areas[j], column.joint_second_moments[j]
        rows = np.zeros((3, 3 * n))  # shear, closure, rotation of the joint per degree of freedom
        rows[0, 3 * j], rows[0, 3 * j + 2] = 1.0, centroid[j]
        rows[1, 3 * j + 1] = rows[2, 3 * j + 2] = 1.0
        around = np.zeros(n)
        around[j] = 1.0
        if j:
            rows[0, 3 * j - 3], rows[0, 3 * j - 1] = -1.0, column.drums[j - 1].height - centroid[j - 1]
            rows[1, 3 * j - 2] = rows[2, 3 * j - 1] = -1.0
            around[j - 1] = -1.0
        own = np.diag([ks[j] * area, kn[j] * area, (1.0 + share) * kn[j] * second])
        stiffness += rows.T @ own @ rows
        torsion += 2.0 * ks[j] * second * np.outer(around, around)
    mass, inertia = column.masses, column.inertias
    axial = np.array([drum.axial_inertia for drum in column.drums])
    highest = 0.0
    for matrix, masses in ((stiffness, np.stack((mass, mass, inertia), axis=1).ravel()), (torsion, axial)):
        highest = max(highest, of_springs(matrix, 1.0 / masses))
    return highest
