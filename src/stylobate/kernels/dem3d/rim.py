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

A chip takes the segment of the upper drum's lower face beyond a chord. The stiffness of the joint then sits on the rim of
what is left of the overlap: on the arcs of both circles that are within the chord, and on the chord within the face below.
Depth is linear along a chord, so that its pressure is as elementary as that of an arc.

What is left of an arc are one or two intervals, counted from its middle towards the side of the chip. Angles go as (angle,
cosine, sine): all sines and cosines follow from the addition theorem.

Legend of chips::

    e, f          directions in the upper face: towards the chip, and a quarter turn on
    chip[0–2]     e in the axes of the upper drum                                           [-]
    chip[3–5]     half the angle of the chip's segment, its cosine and its sine
    tau           distance of the chord from the middle of the lower face, along e           [m]
    kept          ends of the intervals that are left of an arc: start, end, start, end

What two rims of a joint are, whole or chipped, is handed in to ``on_rims``: ``remains`` gives what is left of them and
the overlap's area over its rim, ``upper`` and ``lower`` the pressure of either rim, over what remains, for a depth d +
along · cos φ + across · sin φ. That of the upper one, which may have a chord, comes as: force, first moments along and
across, second moment about its middle, twice the energy; and of what touches the length, its moments along and across,
and the second one about its middle [m], [m²], [m³]. That of the lower one as the arc's length [rad], the integrals of
depth and of its moments over it, and of cos φ and sin φ.
"""

import math

from ..jit import law
from ..shared.friction import NOTHING
from .pose import CENTRED, cross, in_space
from .records import BETA

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
    main = 1.0 if q > p else 0.0
    # what of the arc reaches beyond π comes back at −π
    again = end - 2.0 * math.pi
    wrapped = 1.0 if again > -phi else 0.0
    within = again < phi
    r = again if within else phi
    cos_r = cos_end if within else cos_phi
    sin_r = sin_end if within else sin_phi
    length = main * (q - p) + wrapped * (r + phi)
    sines = main * (sin_q - sin_p) + wrapped * (sin_r + sin_phi)
    cosines = main * (cos_p - cos_q) + wrapped * (cos_phi - cos_r)
    double = main * (sin_q * cos_q - sin_p * cos_p) + wrapped * (sin_r * cos_r + sin_phi * cos_phi)
    squares = main * (sin_q * sin_q - sin_p * sin_p) + wrapped * (sin_r * sin_r - sin_phi * sin_phi)
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


#: A whole turn.
TURN = 2.0 * math.pi


@law
def later(a, b):
    """The larger one of two angles."""
    first = a[0] > b[0]
    return a[0] if first else b[0], a[1] if first else b[1], a[2] if first else b[2]


@law
def earlier(a, b):
    """The smaller one of two angles."""
    first = a[0] < b[0]
    return a[0] if first else b[0], a[1] if first else b[1], a[2] if first else b[2]


@law
def left_of(x, y, half, ex, ey, lost):
    """Part of an arc about the direction (x, y) that a chip towards (ex, ey), of so much half an angle, leaves.

    Returns the ends of two intervals, either of which may be empty, and the side of the arc's middle on which the chip lies.
    """
    c, s = x * ex + y * ey, x * ey - y * ex
    side = -1.0 if s < 0.0 else 1.0
    s *= side
    to, other = angle_to(c, s), lost[0]
    start = (to - other, c * lost[1] + s * lost[2], s * lost[1] - c * lost[2])
    end = (to + other, c * lost[1] - s * lost[2], s * lost[1] + c * lost[2])
    p = later((-half[0], half[1], -half[2]), (end[0] - TURN, end[1], end[2]))
    return (p, later(earlier(half, start), p), end, later(half, end)), side


@law
def extent(x, y, kept, side):
    """Length of what is left of an arc about (x, y), and the integrals of cosine and sine over it."""
    p, q, r, t = kept
    along = q[2] - p[2] + t[2] - r[2]
    across = side * (p[1] - q[1] + r[1] - t[1])
    return q[0] - p[0] + t[0] - r[0], along * x - across * y, along * y + across * x


@law
def up_to(end, deepest, touching):
    """An end of an interval from where the depth is largest, held within the touching part; and the whole turns to there."""
    angle = end[0] - deepest[0]
    c = end[1] * deepest[1] + end[2] * deepest[2]
    s = end[2] * deepest[1] - end[1] * deepest[2]
    turns = 1.0 if angle > math.pi else -1.0 if angle < -math.pi else 0.0
    angle -= TURN * turns
    before, after = angle < -touching[0], angle > touching[0]
    angle = -touching[0] if before else touching[0] if after else angle
    c = touching[1] if before | after else c
    s = -touching[2] if before else touching[2] if after else s
    return angle, c, s, turns


@law
def press_left(d, along, across, x, y, kept, side):
    """Integrals (L, N, C, S, X, Y; ``rim.py``) of the depth d + along · cos φ + across · sin φ where it is positive.

    Over what is left of the arc about (x, y).
    """
    g = math.sqrt(along * along + across * across)
    each = 1.0 / max(g, TINY)
    flat = g < TINY
    gx = 1.0 if flat else along * each
    gy = 0.0 if flat else across * each
    c, s = x * gx + y * gy, side * (x * gy - y * gx)
    to = angle_to(c, abs(s))
    deepest = (-to if s < 0.0 else to, c, s)
    touching = angle_of((g + d) / max(g, TINY))
    p = up_to(kept[0], deepest, touching)
    q = up_to(kept[1], deepest, touching)
    r = up_to(kept[2], deepest, touching)
    t = up_to(kept[3], deepest, touching)
    turns = 2.0 * (q[3] - p[3] + t[3] - r[3])
    length = q[0] - p[0] + t[0] - r[0] + turns * touching[0]
    sines = q[2] - p[2] + t[2] - r[2] + turns * touching[2]
    cosines = p[1] - q[1] + r[1] - t[1]
    double = q[2] * q[1] - p[2] * p[1] + t[2] * t[1] - r[2] * r[1] + turns * touching[2] * touching[1]
    squares = q[2] * q[2] - p[2] * p[2] + t[2] * t[2] - r[2] * r[2]
    n = max(d * length + g * sines, 0.0)
    first = d * sines + 0.5 * g * (length + double)
    second = d * cosines + 0.5 * g * squares
    first, second, cosines = min(max(first, -n), n), side * min(max(second, -n), n), side * cosines
    return (
        length, n, first * gx - second * gy, first * gy + second * gx, sines * gx - cosines * gy, sines * gy + cosines * gx,
    )  # fmt: skip


@law
def chord(ru, rl, cosine, reach, sine, tau):
    """Ends of the chord within the face below, along f from its middle [m].

    ``reach`` is how far along f from the middle of that face the chord's middle lies, ``sine`` that of half its angle.
    """
    wide, under = ru * sine, math.sqrt(max(rl * rl - tau * tau, 0.0))
    each = 1.0 / cosine
    low = max(-wide, (-reach - under) * each)
    return low, max(min(wide, (under - reach) * each), low)


@law
def press_chord(d, slope, low, high):
    """Integrals over a chord where the depth d + slope · y is positive: of depth times 1, y, y², and depth; of 1, y, y²."""
    steep = slope if abs(slope) > TINY else TINY
    zero = min(max(-d / steep, low), high)
    p, q = (zero if steep > 0.0 else low), (high if steep > 0.0 else zero)
    p2, q2 = p * p, q * q
    n = max((q - p) * (d + 0.5 * slope * (p + q)), 0.0)
    first = 0.5 * d * (q2 - p2) + slope * (q2 * q - p2 * p) * (1.0 / 3.0)
    second = d * (q2 * q - p2 * p) * (1.0 / 3.0) + 0.25 * slope * (q2 * q2 - p2 * p2)
    # pressure lies on the chord, whatever rounding leaves of one that is none
    first = min(max(first, low * n), high * n)
    second = min(max(second, 0.0), max(low * low, high * high) * n)
    cube = (q2 * q - p2 * p) * (1.0 / 3.0)
    return n, first, second, max(d * n + slope * first, 0.0), q - p, 0.5 * (q2 - p2), cube


@law
def press_upper(d, along, across, ru, x, y, kept, side, ex, ey, cosine, low, high):
    """Pressure of the upper drum's arc and chord on the face below, over k_n ρ.  # Eq. (E26)

    For the depth d + along · cos φ + across · sin φ on the rim; ``cosine`` is that of half the chip's angle. Returns the
    integral of depth, its moments along the slope and across it, that of the square of the distance from the middle of the
    face, the integral of the depth's square; and of what touches the length, its moments along and across, and that of the
    square of the distance [m], [m²], [m³].
    """
    length, n, c, s, p, q = press_left(d, along, across, x, y, kept, side)
    far, each = ru * cosine, 1.0 / ru
    toward, slope = (along * ex + across * ey) * each, (across * ex - along * ey) * each
    m, beside, second, square, reach, middle, spread = press_chord(d + far * toward, slope, low, high)
    return (
        ru * n + m,
        ru * ru * c + far * m * ex - beside * ey,
        ru * ru * s + far * m * ey + beside * ex,
        ru * ru * ru * n + far * far * m + second,
        ru * (d * n + along * c + across * s) + square,
        ru * length + reach,
        ru * ru * p + far * reach * ex - middle * ey,
        ru * ru * q + far * reach * ey + middle * ex,
        ru * ru * ru * length + far * far * reach + spread,
    )


#: Torsion over shear stiffness and polar moment of what touches, limit of torsion over that of shear and ρ: a closed disc
#: has K_s R²/2 and 2R/3.
ON_RIM = (0.5, 2.0 / 3.0)


@law
def whole_remains(e, u, l, steepest, tangent, way, ru, rl, cosine):
    """Both arcs of the overlap of two whole discs, about the line of their middles.  # Eq. (E2)"""
    s, cos_g, sin_g, side = way
    ra = ru * cosine
    psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, area, rim = overlap(ra, rl, s)
    return (cos_g, sin_g, side, psi_u, cos_u, sin_u, psi_l, cos_l, sin_l), area / max(rim, NOTHING)


@law
def whole_upper_still(kn, d, along, across, r, arcs):
    """Pressure of the upper drum's arc where depth does not vary across the lean."""
    cos_g, sin_g, side, psi, cos_psi, sin_psi, _, _, _ = arcs
    k = kn * r
    length, n, c, s, x, y = press(d, along, math.pi - angle_to(cos_g, sin_g), -cos_g, sin_g, psi, cos_psi, sin_psi)
    twice = k * (d * n + along * c)
    s, y, p, square, reach = -side * s, -side * y, k * n, r * r, r * length
    return p, k * r * c, k * r * s, p * square, twice, reach, square * x, square * y, square * reach


@law
def whole_upper(kn, d, along, across, r, arcs):
    """Pressure of the upper drum's arc."""
    cos_g, sin_g, side, psi, cos_psi, sin_psi, _, _, _ = arcs
    k = kn * r
    _, n, c, s, _, _ = press_askew(d, along, across, -cos_g, -side * sin_g, psi, cos_psi, sin_psi)
    p = k * n
    return p, k * r * c, k * r * s, p * r * r, 0.0, 0.0, 0.0, 0.0, 0.0


@law
def whole_lower_still(d, along, across, arcs):
    """Pressure of the lower drum's arc where depth does not vary across the lean."""
    cos_g, sin_g, side, _, _, _, psi, cos_psi, sin_psi = arcs
    length, n, c, s, x, y = press(d, along, angle_to(cos_g, sin_g), cos_g, sin_g, psi, cos_psi, sin_psi)
    return length, n, c, s * side, x, y * side


@law
def whole_lower(d, along, across, arcs):
    """Pressure of the lower drum's arc."""
    cos_g, sin_g, side, _, _, _, psi, cos_psi, sin_psi = arcs
    return press_askew(d, along, across, cos_g, side * sin_g, psi, cos_psi, sin_psi)


@law
def chipped_remains(e, u, l, steepest, tangent, way, ru, rl, cosine):
    """Parts of both arcs, and the chord, that a chip of the upper face leaves.  # Eqs. (E2), (E26)"""
    s, cos_g, sin_g, side = way
    sin_g *= side
    dx, dy, dz = steepest
    tx, ty, tz = tangent
    ra = ru * cosine
    psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, _, _ = overlap(ra, rl, s)
    half_u, half_l = (psi_u, cos_u, sin_u), (psi_l, cos_l, sin_l)
    ax, ay, az = in_space(u, l, e.chip[0, l], e.chip[1, l], e.chip[2, l])
    ex, ey = ax * dx + ay * dy + az * dz, ax * tx + ay * ty + az * tz
    chip = (e.chip[3, l], e.chip[4, l], e.chip[5, l])
    reach = s * (sin_g * ex - cos_g * ey)
    tau = ra * chip[1] + s * (cos_g * ex + sin_g * ey)
    kept_u, side_u = left_of(-cos_g, -sin_g, half_u, ex, ey, chip)
    kept_l, side_l = left_of(cos_g, sin_g, half_l, ex, ey, angle_of((rl - tau) / rl))
    low, high = chord(ru, rl, cosine, reach, chip[2], tau)
    # area of what is left of the overlap, by Green's theorem round its rim
    lu, cu, su = extent(-cos_g, -sin_g, kept_u, side_u)
    ll, _, _ = extent(cos_g, sin_g, kept_l, side_l)
    lc = cosine * (high - low)
    area = 0.5 * (ra * (ra * lu + s * (cos_g * cu + sin_g * su)) + rl * rl * ll + tau * lc)
    rho = max(area, 0.0) / max(ra * lu + rl * ll + lc, NOTHING)
    return (cos_g, sin_g, kept_u, side_u, kept_l, side_l, ex, ey, chip[1], low, high), rho


@law
def chipped_upper(kn, d, along, across, r, arcs):
    """Pressure of what is left of the upper drum's arc, and of the chord."""
    cos_g, sin_g, kept, side, _, _, ex, ey, cosine, low, high = arcs
    p, c, s, q, twice, reach, x, y, square = press_upper(
        d, along, across, r, -cos_g, -sin_g, kept, side, ex, ey, cosine, low, high
    )
    return kn * p, kn * c, kn * s, kn * q, kn * twice, reach, x, y, square


@law
def chipped_lower(d, along, across, arcs):
    """Pressure of what is left of the lower drum's arc."""
    cos_g, sin_g, _, _, kept, side, _, _, _, _, _ = arcs
    return press_left(d, along, across, cos_g, sin_g, kept, side)


@law
def first_moment(p, middle, a, axis, b, other):
    """p c + a e + b f: the first moment of a rim's pressure, from its middle c and its axes e and f."""
    return (
        p * middle[0] + a * axis[0] + b * other[0],
        p * middle[1] + a * axis[1] + b * other[1],
        p * middle[2] + a * axis[2] + b * other[2],
    )


@law
def resultant(pu, cu, su, pl, cl, sl, c, d, h, t, z, n):
    """First moments of both rims' pressures about the middle of the face below; force and moment there."""
    u = first_moment(pu, c, cu, d, su, t)
    w = first_moment(0.0, c, cl, h, sl, t)
    ax, ay, az = cross(u[0], u[1], u[2], z[0], z[1], z[2])
    bx, by, bz = cross(w[0], w[1], w[2], n[0], n[1], n[2])
    force = pu * z[0] + pl * n[0], pu * z[1] + pl * n[1], pu * z[2] + pl * n[2], ax + bx, ay + by, az + bz
    return u, w, force


@law
def on_rims(remains, upper_still, lower_still, upper, lower, e, o, u, v, l, leaning, way, c, velocity, spin):
    """Pressure of a joint of round faces on what is left of the rims of their overlap."""
    nx, ny, nz, hx, hy, hz, tx, ty, tz, sine, cosine = leaning
    zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
    cx, cy, cz = c
    # steepest descent in the upper face
    dx, dy, dz = cosine * hx - sine * zx, cosine * hy - sine * zy, cosine * hz - sine * zz
    z, n, h, t, d = (zx, zy, zz), (nx, ny, nz), (hx, hy, hz), (tx, ty, tz), (dx, dy, dz)
    ru, rl = u.rb[l], v.rt[l]
    arcs, rho = remains(e, u, l, d, t, way, ru, rl, cosine)
    kn = e.kn[l] * rho
    kl = kn * rl
    # depths along the rims and their pressure  # Eq. (E4)
    du, dl = -(cx * zx + cy * zy + cz * zz), -(cx * nx + cy * ny + cz * nz)
    pu, cu, su, qu, twice, lu, xu, yu, squares = upper_still(kn, du, ru * sine, 0.0, ru, arcs)
    ll, nl, cl, sl, xl, yl = lower_still(dl, rl * sine, 0.0, arcs)
    # area of what touches, its centroid, and its second moment about that
    lu, xu, yu, squares = cosine * lu, cosine * xu, cosine * yu, cosine * squares
    ll, xl, yl = rl * ll, rl * rl * xl, rl * rl * yl
    each = 1.0 / max(lu + ll, NOTHING)
    px, py, pz = first_moment(lu, c, xu, d, yu, t)
    wx, wy, wz = first_moment(0.0, c, xl, h, yl, t)
    squares += rl * rl * ll + 2.0 * (cx * px + cy * py + cz * pz) - lu * (cx * cx + cy * cy + cz * cz)
    px, py, pz = px + wx, py + wy, pz + wz
    squares -= each * (px * px + py * py + pz * pz)
    centre = px * each, py * each, pz * each
    touching = rho * (lu + ll), rho * max(squares, 0.0), centre
    e.en[l] = 0.5 * (twice + kl * (dl * nl + rl * sine * cl))
    pl, cl, sl = kl * nl, kl * rl * cl, kl * rl * sl
    first, second, elastic = resultant(pu, cu, su, pl, cl, sl, c, d, h, t, z, n)
    pressure = elastic
    if e.d.shape[0] > 1:
        # depth plus β × its rate, which is linear along a rim as well: no contact pulls  # Eq. (E5)
        beta = o.damp[BETA, l]
        vx, vy, vz = velocity
        ox, oy, oz = spin
        ax, ay, az = cross(ox, oy, oz, zx, zy, zz)
        along = ru * (sine + beta * (ax * dx + ay * dy + az * dz))
        across = ru * beta * (ax * tx + ay * ty + az * tz)
        du -= beta * (vx * zx + vy * zy + vz * zz)
        pu, cu, su, qu, _, _, _, _, _ = upper(kn, du, along, across, ru, arcs)
        ax, ay, az = cross(ox, oy, oz, nx, ny, nz)
        along = rl * (sine + beta * (ax * hx + ay * hy + az * hz))
        across = rl * beta * (ax * tx + ay * ty + az * tz)
        ax, ay, az = cross(ox, oy, oz, cx, cy, cz)
        dl -= beta * ((vx - ax) * nx + (vy - ay) * ny + (vz - az) * nz)
        _, nl, cl, sl, _, _ = lower(dl, along, across, arcs)
        pl, cl, sl = kl * nl, kl * rl * cl, kl * rl * sl
        first, second, pressure = resultant(pu, cu, su, pl, cl, sl, c, d, h, t, z, n)
    # normal resultant, its middle P and its spread about P
    pressing = pu + pl
    least, most_u, most_l = max(pressing, NOTHING), max(pu, NOTHING), max(pl, NOTHING)
    inverse = 1.0 / (least * most_u * most_l)
    each, eu, el = inverse * most_u * most_l, inverse * least * most_l, inverse * least * most_u
    ux, uy, uz = first
    wx, wy, wz = second
    middle = (ux + wx) * each, (uy + wy) * each, (uz + wz) * each
    gx, gy, gz = ux * eu - wx * el, uy * eu - wy * el, uz * eu - wz * el
    spread = (
        qu
        - (cu * cu + su * su) * eu
        + pl * rl * rl
        - (cl * cl + sl * sl) * el
        + pu * pl * each * (gx * gx + gy * gy + gz * gz)
    ) * each
    return pressing, max(spread, 0.0), touching, ON_RIM, middle, pressure, elastic


@law
def whole_rims(e, o, u, v, l, leaning, way, c, velocity, spin):
    """Pressure of a joint of whole faces on the rims of their overlap."""
    return on_rims(
        whole_remains, whole_upper_still, whole_lower_still, whole_upper, whole_lower,
        e, o, u, v, l, leaning, way, c, velocity, spin,
    )  # fmt: skip


@law
def chipped_rims(e, o, u, v, l, leaning, way, c, velocity, spin):
    """Pressure of a joint whose upper face may have lost a segment on what is left of the rims of their overlap."""
    return on_rims(
        chipped_remains, chipped_upper, chipped_lower, chipped_upper, chipped_lower,
        e, o, u, v, l, leaning, way, c, velocity, spin,
    )  # fmt: skip
