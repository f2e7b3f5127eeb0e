"""The law of a joint between rigid blocks: N, M and V from the relative position of two faces, by return mapping.

Legend: δ closure of the faces at the joint centre (positive pressed), ψ sine of the relative rotation
(counter-clockwise positive), r place along the upper face from the joint centre; a place closes by δ − r ψ.
n compression, e eccentricity (the place where n acts), m = n e, T shear, s plastic slip.
kn = k_n A, km = k_n J, ks = k_s A. The derivation is in docs/theory/rigid_block.md.
"""

from __future__ import annotations

from .jit import law

#: States of a joint, shared with the pushover analysis and the figures.
ELASTIC, SLIDING, ROCKING, OPEN = 0, 1, 2, 3


@law
def compression(delta, psi, r_left, r_right, kn, km):
    """Compression n and eccentricity e: the elastic trial, projected onto r_left n ≤ m ≤ r_right n in the energy norm.

    Reversible: the law derives from the potential n (δ − e ψ)/2.  # Eq. (B4)
    """
    n_trial = kn * delta  # Baraldi et al., Eq. 8
    m_trial = -km * psi
    # Inside the cone e = m/n; outside it the corner that is pressed. Without compression at the centre only a corner
    # can be in contact: the one that the rotation presses.
    e = min(max(m_trial / max(n_trial, 1.0e-30), r_left), r_right)
    n = max(delta - e * psi, 0.0) / (1.0 / kn + e * e / km)
    return n, e


@law
def crushed(delta, psi, reach, e, kn, km, crushing):
    """Limit of eccentricity that the crushing toe keeps: e where the strength allows it, else less.

    ``reach`` is the half width on the pressed side, e > 0 and ψ < 0 there (mirror the other side), ``crushing`` is
    1/(f_c A). Solves e = reach (1 − n/(f_c A)) with n = k (δ − e ψ), k the stiffness at the toe.  # Eq. (B6)
    """
    allowed = e
    for _ in range(24):
        k = 1.0 / (1.0 / kn + allowed * allowed / km)
        limit = reach * (1.0 - crushing * k * delta) / (1.0 - reach * crushing * k * psi)
        allowed = max(min(limit, e), 0.0)
    return allowed


@law
def shear(trial, n, friction, cohesion):
    """Shear T within Mohr–Coulomb: the trial, clipped; no dilatancy, so that n and e stay.  # Eq. (B7)

    Cohesion (a force, c A) acts while the joint is pressed.
    """
    limit = friction * n + (cohesion if n > 0.0 else 0.0)
    return min(max(trial, -limit), limit)
