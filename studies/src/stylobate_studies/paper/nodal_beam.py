"""Accelerations of the rigid beam, written twice: in the drums' rotations, and in the paper's displacements of nodes."""

import numpy as np

from stylobate.column import Column
from stylobate.models.rigid_beam.state import BeamMatrices


def rotation_rates(matrices: BeamMatrices, moments, theta, a_g: float, gravity: float) -> np.ndarray:
    """θ̈ from the joint moments [rad/s²].  # Eq. (F3)

    Parameters
    ----------
    matrices : BeamMatrices
    moments : array, shape (n,)
        Resisting moment of each joint [N m].
    theta : array, shape (n,)
        [rad]
    a_g : float
        [m/s²]
    gravity : float
        g + a_v [m/s²]; 0 where the law holds the second-order effect.
    """
    tau = -moments + np.append(moments[1:], 0.0) - a_g * matrices.load + gravity * matrices.load * theta
    return np.linalg.solve(matrices.mass, tau)


def nodal_matrices(column: Column) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The paper's G, M_a and I_G with the columns of the base acceleration: T = M_a ü + A ü₁, M = G T + I_G ü + B ü₁.

    ü holds the absolute accelerations of the nodes 2 … n+1, T and M the shears and moments of the joints 1 … n,
    written here as the actions on the drum above its joint.  # Baraldi et al., Eq. 4
    """
    n = column.n
    share = (column.centroid_heights - column.joint_heights) / column.heights  # 1/2 for the paper's prisms
    # Acceleration of centroids and rotations from all n + 1 nodes.
    centre, turn = np.zeros((n, n + 1)), np.zeros((n, n + 1))
    for i in range(n):
        centre[i, i], centre[i, i + 1] = 1.0 - share[i], share[i]
        turn[i, i], turn[i, i + 1] = -1.0 / column.heights[i], 1.0 / column.heights[i]
    above = np.triu(np.ones((n, n)))
    # m_i ü_Ci = T_i − T_{i+1}, T_{n+1} = 0: sums over everything above.  # Baraldi et al., Eq. 2, put right
    shear = above @ (column.masses[:, None] * centre)
    # I_i θ̈_i = M_i − M_{i+1} − T_i z_i − T_{i+1} (h_i − z_i)
    own = share * column.heights
    arms = np.diag(own) + np.diag((column.heights - own)[:-1], 1)
    inertia = above @ (column.inertias[:, None] * turn)
    geometry = above @ arms
    return geometry, shear[:, 1:], inertia[:, 1:], shear[:, 0], inertia[:, 0]


def nodal_accelerations(matrices: BeamMatrices, moments, theta, a_g: float, gravity: float) -> np.ndarray:
    """Absolute nodal accelerations ü₂ … ü_{n+1} by the paper's Eq. 5 [m/s²], shape (n,); arguments as above."""
    geometry, shear, inertia, shear_base, inertia_base = nodal_matrices(matrices.column)
    second = np.triu(np.ones((matrices.column.n,) * 2)) @ (gravity * matrices.load * theta)
    right = -moments + second - (geometry @ shear_base + inertia_base) * a_g
    return np.linalg.solve(geometry @ shear + inertia, right)
