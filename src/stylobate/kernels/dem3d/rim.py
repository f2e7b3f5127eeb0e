"""The rim law: two round faces that carry on the rims of their overlap, in closed form.

The stiffness k_n A of a joint sits on the rim of the overlap of its two faces: on an arc of the upper drum's rim, against
the plane of the lower face, and on an arc of the lower drum's rim, against the plane of the upper face. Along either rim
the depth is d + g cos φ, exactly and at any tilt, so that force and moments are elementary integrals.

Legend (all in one frame; origin in the middle of the lower face)::

    ru, rl        radii of the upper drum's lower face and of the lower drum's upper face   [m]
    s             distance of the two centres along the lower face                          [m]
    psi           half the angle of an arc of the overlap; gamma, to the middle of that arc  [rad]
    d, g          depth along a rim: d + g cos φ, φ from where it is deepest                 [m]
    rho           area of the overlap over the length of its rim                             [m]
    L N C S       length of the touching arc [rad], integrals of depth over it, of depth cos φ and of depth sin φ  [m]
    X Y           integrals of cos φ and of sin φ over the touching arc                      [rad]
"""

import math

from ..jit import law
from .pose import CENTRED

#: Below this a length is no direction any more [m].
TINY = 1e-18


@law
def over_root(x):
    """acos(x) / √(1 − x) for 0 ≤ x ≤ 1, to 5e-14: its Chebyshev interpolant."""
    p = 3.139129045303818e-05
    p = p * x - 0.00027199399719354117
    p = p * x + 0.0011120542916517799
    p = p * x - 0.002896219765138688
    p = p * x + 0.005523167239593235
    p = p * x - 0.008503457350174305
    p = p * x + 0.011493823555180352
    p = p * x - 0.01466134286289636
    p = p * x + 0.018621724287455857
    p = p * x - 0.024366397045309886
    p = p * x + 0.03368046433967888
    p = p * x - 0.050792762643682245
    p = p * x + 0.08904862081826843
    p = p * x - 0.21460183657961013
    return p * x + 1.5707963267948457


@law
def angle_of(versine):
    """Angle in [0, π], its cosine and its sine, from 1 − cos; small angles keep their relative accuracy."""
    u = min(max(versine, 0.0), 2.0)
    low = min(u, 2.0 - u)
    root = math.sqrt(low)
    angle = root * over_root(1.0 - low)
    return (angle if u <= 1.0 else math.pi - angle), 1.0 - u, root * math.sqrt(2.0 - low)


@law
def angle_to(c, s):
    """Angle in [0, π] of the unit vector (c, s) with s ≥ 0; small angles keep their relative accuracy."""
    low = s * s / (1.0 + abs(c))
    angle = math.sqrt(low) * over_root(1.0 - low)
    return angle if c >= 0.0 else math.pi - angle


@law
def overlap(ru, rl, s):
    """Arcs of the overlap of two discs: (psi, cos, sin) of the upper and of the lower one, area, length of the rim."""
    s = max(s, CENTRED)
    near = 2.0 * s
    psi_u, cos_u, sin_u = angle_of((rl - s + ru) * (rl + s - ru) / (near * ru))
    psi_l, cos_l, sin_l = angle_of((ru - rl + s) * (ru + rl - s) / (near * rl))
    area = ru * ru * (psi_u - cos_u * sin_u) + rl * rl * (psi_l - cos_l * sin_l)
    return psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, area, 2.0 * (ru * psi_u + rl * psi_l)


@law
def press(d, g, gamma, cos_gamma, sin_gamma, psi, cos_psi, sin_psi):
    """Integrals (L, N, C, S, X, Y) of the depth d + g cos φ where it is positive, over the arc gamma ± psi.

    Both angles lie in [0, π], so that the touching part is one or two intervals. Their ends are those of the arc or of
    the touching part of the whole rim: sines and cosines follow from the addition theorem.
    """
    phi, cos_phi, sin_phi = angle_of((g + d) / max(g, TINY))
    start, end = gamma - psi, gamma + psi
    first = start > -phi
    last = end < phi
    p = start if first else -phi
    cos_p = cos_gamma * cos_psi + sin_gamma * sin_psi if first else cos_phi
    sin_p = sin_gamma * cos_psi - cos_gamma * sin_psi if first else -sin_phi
    cos_end = cos_gamma * cos_psi - sin_gamma * sin_psi
    sin_end = sin_gamma * cos_psi + cos_gamma * sin_psi
    q = end if last else phi
    cos_q = cos_end if last else cos_phi
    sin_q = sin_end if last else sin_phi
    one = 1.0 if q > p else 0.0
    # what of the arc reaches beyond π comes back at −π
    again = end - 2.0 * math.pi
    two = 1.0 if again > -phi else 0.0
    within = again < phi
    r = again if within else phi
    cos_r = cos_end if within else cos_phi
    sin_r = sin_end if within else sin_phi
    length = one * (q - p) + two * (r + phi)
    sines = one * (sin_q - sin_p) + two * (sin_r + sin_phi)
    cosines = one * (cos_p - cos_q) + two * (cos_phi - cos_r)
    double = one * (sin_q * cos_q - sin_p * cos_p) + two * (sin_r * cos_r + sin_phi * cos_phi)
    squares = one * (sin_q * sin_q - sin_p * sin_p) + two * (sin_r * sin_r - sin_phi * sin_phi)
    n = max(d * length + g * sines, 0.0)
    c = d * sines + 0.5 * g * (length + double)
    s = d * cosines + 0.5 * g * squares
    # the middle of pressure lies within the rim, whatever is left of a force that goes to zero
    return length, n, min(max(c, -n), n), min(max(s, -n), n), sines, cosines


@law
def press_askew(d, along, across, x, y, psi, cos_psi, sin_psi):
    """As :func:`press` for the depth d + along · cos φ + across · sin φ, over the arc about the direction (x, y)."""
    g = math.sqrt(along * along + across * across)
    each = 1.0 / max(g, TINY)
    flat = g < TINY
    c = 1.0 if flat else along * each
    s = 0.0 if flat else across * each
    u, v = x * c + y * s, y * c - x * s
    side = -1.0 if v < 0.0 else 1.0
    v *= side
    length, n, first, second, p, q = press(d, g, angle_to(u, v), u, v, psi, cos_psi, sin_psi)
    second, q = second * side, q * side
    return length, n, first * c - second * s, first * s + second * c, p * c - q * s, p * s + q * c
