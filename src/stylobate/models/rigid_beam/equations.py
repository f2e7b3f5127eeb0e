"""The rigid beam's equations as matrices: coordinates θ, energies, frequencies and barriers.

Rotations here are positive towards +x (clockwise), as in the equations; the response turns them round.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...column import Column
from ...errors import InputError


@dataclass(frozen=True, eq=False)
class BeamMatrices:
    """Mass, gravity and load of the rigid beam in the drums' rotations (and joint slips).

    Parameters
    ----------
    column : Column
        As the model sees it: idealised already.
    """

    column: Column

    @cached_property
    def lever(self) -> np.ndarray:
        """c_ji: horizontal displacement of drum j's centroid for a unit rotation of drum i [m], shape (n, n)."""
        n = self.column.n
        own = self.column.centroid_heights - self.column.joint_heights
        return np.tril(np.broadcast_to(self.column.heights, (n, n)), -1) + np.diag(own)

    @cached_property
    def mass(self) -> np.ndarray:
        """Σ_j m_j c_ji c_jk + I_i δ_ik [kg m²], shape (n, n).  # Eq. (F3)"""
        c = self.lever
        return c.T @ (self.column.masses[:, None] * c) + np.diag(self.column.inertias)

    @cached_property
    def load(self) -> np.ndarray:
        """S_i = Σ_j m_j c_ji [kg m], shape (n,).  # Eq. (F2)"""
        return self.lever.T @ self.column.masses

    @cached_property
    def overturning(self) -> np.ndarray:
        """Σ_j≥i m_j (z_j − z_i): moment about joint i of a unit acceleration of everything above it [kg m], shape (n,)."""
        return np.cumsum(self.load[::-1])[::-1]

    @cached_property
    def sliding_mass(self) -> np.ndarray:
        """Mass matrix for rotations and slips, shape (2n, 2n).  # Eq. (R5)"""
        n = self.column.n
        full = np.hstack((self.lever, np.tril(np.ones((n, n)))))
        out = full.T @ (self.column.masses[:, None] * full)
        out[:n, :n] += np.diag(self.column.inertias)
        return out

    # -- closed joints ---------------------------------------------------------------------------------------------

    def highest_frequency(self, stiffness, gravity: float, relative: bool, shear_stiffness=None) -> float:
        """Largest ω of the column with all joints closed [rad/s].

        Parameters
        ----------
        stiffness : array, shape (n,)
            K_M [N m].
        gravity : float
            As above.
        relative : bool
            Whether the law is in the relative rotation.
        shear_stiffness : array, optional
            k_s A [N/m], with sliding.
        """
        from scipy.linalg import eigvals, eigvalsh

        n = self.column.n
        difference = np.eye(n) - np.eye(n, k=-1)
        if shear_stiffness is not None:
            # The diagonal of D gives a bound in closed form, but the eigenvalues are the sharp one.
            stiff = np.zeros((2 * n, 2 * n))
            stiff[:n, :n] = difference.T @ (stiffness[:, None] * difference)
            stiff[n:, n:] = np.diag(shear_stiffness)
            return float(np.sqrt(eigvalsh(stiff, self.sliding_mass)[-1]))
        if relative:
            stiff = difference.T @ (stiffness[:, None] * difference) - gravity * np.diag(self.load)
            return float(np.sqrt(eigvalsh(stiff, self.mass)[-1]))
        values = eigvals(difference.T @ np.diag(stiffness) - gravity * np.diag(self.load), self.mass)
        return float(np.sqrt(np.abs(values).max()))


def tridiagonal(column: Column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass matrix of the nodal displacements, M = U D Uᵀ: 1/D_i, U_{i−1,i} (0 for i = 1), and the nodes' masses [kg].

    Each of shape (n,). The mass of a node is the one on which the ground acceleration acts.
    """
    n = column.n
    share = (column.centroid_heights - column.joint_heights) / column.heights
    m, turn = column.masses, column.inertias / column.heights**2
    own, next_ = m * share**2 + turn, m * (1.0 - share) ** 2 + turn
    diagonal = own + np.append(next_[1:], 0.0)
    beside = m * share * (1.0 - share) - turn  # between node i − 1 and node i
    nodes = m * share + np.append((m * (1.0 - share))[1:], 0.0)
    pivot, upper = np.empty(n), np.zeros(n)
    for i in range(n - 1, -1, -1):
        pivot[i] = diagonal[i] - (upper[i + 1] * beside[i + 1] if i + 1 < n else 0.0)
        upper[i] = beside[i] / pivot[i] if i else 0.0
    if not np.all(pivot > 0.0):
        raise InputError(f"the mass matrix of {column.name!r} is not positive; check the drums' heights and widths.")
    return 1.0 / pivot, upper, nodes
