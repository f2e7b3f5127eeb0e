"""Joints between drums: their stiffness per area, their contact points, and what is damped."""

from __future__ import annotations

import math

import numpy as np

from ...column.structure import Structure


def joint_stiffnesses(structure: Structure, block_modulus: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Normal and shear stiffness per area of each joint [N/m³]; with a column's stone in series if its modulus is given.

    1/k_n′ = 1/k_n + h/2E of the drum above + h/2E of the drum below (the base is rigid); k_s keeps its ratio to k_n.
    Eq. (D2).
    """
    laws = [pair.law for pair in structure.face_pairs]
    kn, ks = (np.array([getattr(law, name) for law in laws]) for name in ("normal_stiffness", "shear_stiffness"))
    return with_stone(structure, kn, ks, block_modulus)


def with_stone(
    structure: Structure, kn: np.ndarray, ks: np.ndarray, block_modulus: float | None
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffnesses per area [N/m³] with the stone of each drum and of the next below in series, along the last axis."""
    if block_modulus is None:
        return kn, ks
    half = 0.5 * structure.must_be("column").heights / block_modulus
    soft = 1.0 / (1.0 / kn + half + np.concatenate(([0.0], half[:-1])))
    return soft, ks * soft / kn


def contact_points(section: str, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (−1 … 1) and shares of the area of a joint's contact points.

    Gauss–Lobatto's rule for the chord of the section: weight 1 for a rectangle, √(1 − ξ²) for a circle. Its inner points
    are the roots of the Jacobi polynomial for the weight times 1 − ξ²; the ends take what is left.
    """
    if points == 2:
        return np.array([-1.0, 1.0]), np.array([0.5, 0.5])
    from scipy.special import roots_jacobi

    power, total = (1.5, math.pi / 2.0) if section == "circular" else (1.0, 2.0)
    inner, weight = roots_jacobi(points - 2, power, power)
    inner = 0.5 * (inner - inner[::-1])
    weight = 0.5 * (weight + weight[::-1]) / (1.0 - inner**2)
    end = 0.5 * (total - weight.sum())
    return np.concatenate(([-1.0], inner, [1.0])), np.concatenate(([end], weight, [end])) / total


def damping_rows(damped: bool, stiffness_damping: float, mass_damping: float) -> np.ndarray:
    """Rows of a lane's ``damp``, without local damping; one row of nothing where nothing is damped."""
    return np.array([stiffness_damping, mass_damping, 0.0]) if damped else np.zeros(1)
