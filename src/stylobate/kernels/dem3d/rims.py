"""The rim law of a joint of round faces: pressure on what is left of the rims of their overlap, whole or chipped.

What two rims are is handed in: ``remains`` gives what is left of them and the overlap's area over its rim, ``upper`` and
``lower`` the pressure of either rim, over what remains, for a depth d + along · cos φ + across · sin φ. That of the upper
one, which may have a chord, comes as: force, first moments along and across, second moment about its middle, twice the
energy; and of what touches the length, its moments along and across, and the second one about its middle [m], [m²], [m³].
That of the lower one as the arc's length [rad], the integrals of depth and of its moments over it, and of cos φ and sin φ.
"""

import math

from ..jit import law
from ..shared.friction import NOTHING
from .chipped import chord, extent, left_of, press_left, press_upper
from .pose import cross, in_space
from .records import BETA
from .rim import angle_of, angle_to, overlap, press, press_askew

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
def whole_upper_still(kn, d, along, across, r, left):
    """Pressure of the upper drum's arc where depth does not vary across the lean."""
    cos_g, sin_g, side, psi, cos_psi, sin_psi, _, _, _ = left
    k = kn * r
    length, n, c, s, x, y = press(d, along, math.pi - angle_to(cos_g, sin_g), -cos_g, sin_g, psi, cos_psi, sin_psi)
    twice = k * (d * n + along * c)
    s, y, p, square, reach = -side * s, -side * y, k * n, r * r, r * length
    return p, k * r * c, k * r * s, p * square, twice, reach, square * x, square * y, square * reach


@law
def whole_upper(kn, d, along, across, r, left):
    """Pressure of the upper drum's arc."""
    cos_g, sin_g, side, psi, cos_psi, sin_psi, _, _, _ = left
    k = kn * r
    _, n, c, s, _, _ = press_askew(d, along, across, -cos_g, -side * sin_g, psi, cos_psi, sin_psi)
    p = k * n
    return p, k * r * c, k * r * s, p * r * r, 0.0, 0.0, 0.0, 0.0, 0.0


@law
def whole_lower_still(d, along, across, left):
    """Pressure of the lower drum's arc where depth does not vary across the lean."""
    cos_g, sin_g, side, _, _, _, psi, cos_psi, sin_psi = left
    length, n, c, s, x, y = press(d, along, angle_to(cos_g, sin_g), cos_g, sin_g, psi, cos_psi, sin_psi)
    return length, n, c, s * side, x, y * side


@law
def whole_lower(d, along, across, left):
    """Pressure of the lower drum's arc."""
    cos_g, sin_g, side, _, _, _, psi, cos_psi, sin_psi = left
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
def chipped_upper(kn, d, along, across, r, left):
    """Pressure of what is left of the upper drum's arc, and of the chord."""
    cos_g, sin_g, kept, side, _, _, ex, ey, cosine, low, high = left
    p, c, s, q, twice, reach, x, y, square = press_upper(
        d, along, across, r, -cos_g, -sin_g, kept, side, ex, ey, cosine, low, high
    )
    return kn * p, kn * c, kn * s, kn * q, kn * twice, reach, x, y, square


@law
def chipped_lower(d, along, across, left):
    """Pressure of what is left of the lower drum's arc."""
    cos_g, sin_g, _, _, kept, side, _, _, _, _, _ = left
    return press_left(d, along, across, cos_g, sin_g, kept, side)


@law
def first_moment(p, middle, a, one, b, other):
    """p c + a e + b f: the first moment of a rim's pressure, from its middle c and its axes e and f."""
    return (
        p * middle[0] + a * one[0] + b * other[0],
        p * middle[1] + a * one[1] + b * other[1],
        p * middle[2] + a * one[2] + b * other[2],
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
    left, rho = remains(e, u, l, d, t, way, ru, rl, cosine)
    kn = e.kn[l] * rho
    kl = kn * rl
    # depths along the rims and their pressure  # Eq. (E4)
    du, dl = -(cx * zx + cy * zy + cz * zz), -(cx * nx + cy * ny + cz * nz)
    pu, cu, su, qu, twice, lu, xu, yu, squares = upper_still(kn, du, ru * sine, 0.0, ru, left)
    ll, nl, cl, sl, xl, yl = lower_still(dl, rl * sine, 0.0, left)
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
        pu, cu, su, qu, _, _, _, _, _ = upper(kn, du, along, across, ru, left)
        ax, ay, az = cross(ox, oy, oz, nx, ny, nz)
        along = rl * (sine + beta * (ax * hx + ay * hy + az * hz))
        across = rl * beta * (ax * tx + ay * ty + az * tz)
        ax, ay, az = cross(ox, oy, oz, cx, cy, cz)
        dl -= beta * ((vx - ax) * nx + (vy - ay) * ny + (vz - az) * nz)
        _, nl, cl, sl, _, _ = lower(dl, along, across, left)
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
