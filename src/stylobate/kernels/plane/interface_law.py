"""The law of a joint between rigid blocks: N, M and V from the relative position of two faces, by return mapping.

Legend: δ closure of the faces at the joint centre (positive pressed), ψ sine of the relative rotation
(counter-clockwise positive), r place along the upper face from the joint centre; a place closes by δ − r ψ.
n compression, e eccentricity (the place where n acts), m = n e, T shear, s plastic slip.
kn = k_n A, km = k_n J, ks = k_s A. The derivation is in docs/theory/rigid_block.md.
"""

from __future__ import annotations

from ..jit import law

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
def compression_with_strength(delta, psi, r_left, r_right, kn, km, crushing):
    """Compression n and eccentricity e with a strength f_c: the elastic trial, projected onto the curved domain.

    The domain is r_left n + w n² ≤ m ≤ r_right n − w n², w = (r_right − r_left)/(2 f_c A); it ends at n = f_c A. Reversible,
    as without strength. ``crushing`` is 1/(f_c A). For a given n the nearest m is the trial's, clipped; n is where the
    potential's derivative by n, which falls all the way, is zero: Newton's method in a bracket.  # Eq. (B6)
    """
    m_trial = -km * psi
    narrowing = 0.5 * (r_right - r_left) * crushing
    low, high = 0.0, 1.0 / crushing
    weak, _ = compression(delta, psi, r_left, r_right, kn, km)
    n = min(weak, high)
    for _ in range(6):
        left, right = r_left + narrowing * n, r_right - narrowing * n
        beyond = (m_trial - min(max(m_trial, left * n), right * n)) / km
        arm = right - narrowing * n if beyond > 0.0 else left + narrowing * n
        slope = delta - n / kn + arm * beyond
        low, high = (n, high) if slope > 0.0 else (low, n)
        curve = 1.0 / kn + 2.0 * narrowing * abs(beyond) + (arm * arm / km if beyond != 0.0 else 0.0)
        newton = n + slope / curve
        n = newton if low <= newton <= high else 0.5 * (low + high)
    # At both ends of the domain there is nothing to look for.
    beyond = (m_trial - 0.5 * (r_left + r_right) / crushing) / km
    if delta - 1.0 / (crushing * kn) + (r_left if beyond > 0.0 else r_right) * beyond >= 0.0:
        n = 1.0 / crushing
    if weak <= 0.0:
        n = 0.0
    e = min(max(m_trial / max(n, 1.0e-30), r_left + narrowing * n), r_right - narrowing * n)
    return n, e


@law
def shear(trial, n, friction, cohesion):
    """Shear T within Mohr–Coulomb: the trial, clipped; no dilatancy, so that n and e stay.  # Eq. (B7)

    Cohesion (a force, c A) acts while the joint is pressed.
    """
    limit = friction * n + (cohesion if n > 0.0 else 0.0)
    return min(max(trial, -limit), limit)
