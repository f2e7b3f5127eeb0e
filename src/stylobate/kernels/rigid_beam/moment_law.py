"""Moment–rotation laws of a joint of the rigid beam: three lines, or an elastic bed without tension.

Legend: φ relative rotation, N compression, Γ = 1 + a_v/g (scales N), K_M = k_n J, M_u = N d/2, α critical angle.
A joint is described by five numbers; moments are for the static N and scale with Γ, K_M does not:

* three lines: |M| = min(k |φ|, Γ (m1 + s1 |φ|), Γ (m2 + s2 |φ|));
* bed: k = K_M, m1 = M_u, s1 = rotation φ_d at which the joint opens (∝ N), s2 = slope of the falling branch.
  With z = (φ_d/|φ|)^¼ the moment is |M| = M_u (1 − Σ c_k z^k) + s2 |φ| beyond φ_d: a rectangle has 2/3 z² exactly,
  the circle's curve is a fit.
"""

import math
from functools import lru_cache

import numpy as np
from numba import types
from numba.extending import overload

from ..jit import kernel, law

#: Terms of the fit for the circle.
TERMS = 14


@lru_cache(1)
def circle() -> tuple[float, ...]:
    """Coefficients c_k, k = 0 … TERMS − 1, of 1 − |M|/M_u for a circular section; within 1e-5 for |φ| < 1e6 φ_d."""
    from numpy.polynomial import Chebyshev, Polynomial

    ratio, share = circle_curve(np.arccos(np.linspace(-1.0, 0.99999999, 40001)))
    z = ratio**-0.25
    nodes = 0.5 * (1.0 + np.cos(np.pi * np.arange(400) / 399.0)) * 0.97 + 0.03
    values = np.interp(nodes, z[::-1], 1.0 - share[::-1])
    fit = Chebyshev.fit(nodes, values, TERMS - 1, domain=[0.0, 1.0])
    return tuple(float(c) for c in fit.convert(kind=Polynomial).coef)


def circle_curve(psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Exact curve of a circle of radius R by the half angle ψ of its neutral axis (x₀ = R cos ψ): |φ|/φ_d and |M|/M_u.

    N = k_n |φ| R³ n(ψ), M = k_n |φ| R⁴ μ(ψ) by integration of k_n |φ| (x − x₀) over the compressed segment; ψ = π when
    the joint is just closed.
    """
    c, s = np.cos(psi), np.sin(psi)
    n = 2.0 / 3.0 * s**3 - c * (psi - s * c)
    mu = 0.25 * (psi - s * c * (2.0 * c * c - 1.0)) - c * 2.0 / 3.0 * s**3
    return np.pi / n, mu / n


@law
def three_lines(size, gamma, k, m1, s1, m2, s2):
    """|M| for a rotation of ``size``: the lowest of three lines.  # Eq. (R1); Baraldi et al., Fig. 3"""
    return min(k * size, min(gamma * (m1 + s1 * size), gamma * (m2 + s2 * size)))


def lost_share(q, bed):
    """1 − |M|/M_u of an open joint for q = φ_d/|φ|; ``bed`` is True for a rectangle, :func:`circle` for a circle."""
    raise NotImplementedError("for compiled code, which has one law for each type of bed")


@overload(lost_share, inline="always")
def _lost_share(q, bed):
    if not isinstance(bed, types.BaseTuple):
        return lambda q, bed: 2.0 / 3.0 * math.sqrt(q)

    def of_circle(q, bed):
        z = math.sqrt(math.sqrt(q))
        y = bed[13] * z + bed[12]
        y = y * z + bed[11]
        y = y * z + bed[10]
        y = y * z + bed[9]
        y = y * z + bed[8]
        y = y * z + bed[7]
        y = y * z + bed[6]
        y = y * z + bed[5]
        y = y * z + bed[4]
        y = y * z + bed[3]
        y = y * z + bed[2]
        y = y * z + bed[1]
        return y * z + bed[0]

    return of_circle


@law
def bed_moment(size, gamma, k, m1, s1, s2, bed):
    """|M| of an elastic bed without tension.  # Eq. (R2)"""
    start = gamma * s1
    lost = lost_share(start / max(size, start), bed)
    return (k * size if size <= start else gamma * m1 * (1.0 - lost)) + gamma * s2 * size


@kernel
def moments(phi, gamma, joints, bed, out):
    """Moments of all joints for relative rotations ``phi`` [rad]: out [N m], shape (n,).

    ``joints``: k, m1, s1, m2, s2 by joint, shape (5, n); ``bed``: None for three lines,
    True for a rectangular bed, :func:`circle` for a circular one.
    """
    for i in range(len(phi)):
        size = abs(phi[i])
        if bed is None:
            m = three_lines(size, gamma, joints[0, i], joints[1, i], joints[2, i], joints[3, i], joints[4, i])
        else:
            m = bed_moment(size, gamma, joints[0, i], joints[1, i], joints[2, i], joints[4, i], bed)
        out[i] = m if phi[i] >= 0.0 else -m


def closed(phi, gamma, joints, bed):
    """Whether each joint is on its first, elastic branch; arrays of any shape, joints (5, …)."""
    size = np.abs(phi)
    k, m1, s1, m2, s2 = joints
    if bed is not None:
        return size <= gamma * s1
    return k * size <= np.minimum(gamma * (m1 + s1 * size), gamma * (m2 + s2 * size))


def stored(phi, joints, bed):
    """Energy ∫ M dφ of each joint under its static compression [J], shape of ``phi``."""
    size = np.abs(np.asarray(phi, dtype=float))
    k, m1, s1, m2, s2 = (np.broadcast_to(row, size.shape) for row in joints)
    if bed is not None:
        opened = np.maximum(size, s1)
        z = (s1 / opened) ** 0.25
        lost = np.zeros_like(size)
        terms = [(2, 2.0 / 3.0)] if bed is True else list(enumerate(bed))
        for power, c in terms:  # ∫ z^power dφ with φ = φ_d z⁻⁴
            lost += c * (-4.0 * s1 * np.log(z) if power == 4 else 4.0 * s1 * (z ** (power - 4) - 1.0) / (4 - power))
        return 0.5 * k * np.minimum(size, s1) ** 2 + m1 * (opened - s1 - lost) + 0.5 * s2 * size**2
    with np.errstate(divide="ignore", invalid="ignore"):
        crossings = [m1 / (k - s1), m2 / (k - s2), (m2 - m1) / (s1 - s2)]
    marks = np.sort(np.nan_to_num(np.stack([np.clip(c, 0.0, size) for c in crossings]), nan=0.0), axis=0)
    marks = np.concatenate((np.zeros((1, *size.shape)), marks, size[None]))
    value = np.minimum(k * marks, np.minimum(m1 + s1 * marks, m2 + s2 * marks))
    return (0.5 * (value[1:] + value[:-1]) * np.diff(marks, axis=0)).sum(axis=0)
