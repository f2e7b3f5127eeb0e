"""The law of a point of contact in space: where a corner touches the face below, and spring, dashpot and friction there.

The plane model's law with one direction more: a no-tension spring along the normal, an incremental shear force that is a
vector within Coulomb's cone, dashpots that stay within both in sum. All in the axes of the body below. Rectangular faces
carry on their four corners.

Legend of a joint's scratch ``w``, in the axes of the drum below::

    0–8    axes i, j, k of the drum above        9–11   normal of its lower face        12–14  middle of its lower face [m]
    15–17  velocity of that middle as seen from the lower drum [m/s]                     18–20  relative angular velocity
    21     share of each corner in the area of the overlap [m²]
"""

import math

from ..jit import law
from .pose import cross, faces, in_body, in_space
from .records import BETA

#: Keeps quotients of nothing by nothing at nothing.
NOTHING = 1e-300

#: A point that leaves faster than this comes back with the lower stiffness in full [m/s].
SLOW = 2e-3


@law
def corner(u, w, p, l):
    """Corner p of a drum's lower face in the frame of the face below [m]; ``w`` is the joint's scratch."""
    a, b, c = u.px[p, l], u.py[p, l], u.pz[p, l]
    return (
        w[12, l] + a * w[0, l] + b * w[3, l] + c * w[6, l],
        w[13, l] + a * w[1, l] + b * w[4, l] + c * w[7, l],
        w[14, l] + a * w[2, l] + b * w[5, l] + c * w[8, l],
    )


@law
def clamped(x, half):
    """The nearest place within the half width of a face."""
    return min(max(x, -half), half)


@law
def contact(x, y, z, tx, ty, nx, ny, nz, cx, cy, cz):
    """Contact of a corner at x, y, z with a face of half widths tx, ty: place, gap, normal.  # Eq. (E21)

    Above the face the corner touches it, along its normal. Beyond an edge the nearest place on the edge touches the upper
    face, of normal n through c, along n.
    """
    inside = (abs(x) < tx) & (abs(y) < ty)
    x, y = clamped(x, tx), clamped(y, ty)
    beyond = nx * (cx - x) + ny * (cy - y) + nz * cz
    return (
        x,
        y,
        z if inside else 0.0,
        z if inside else beyond,
        0.0 if inside else nx,
        0.0 if inside else ny,
        1.0 if inside else nz,
    )


@law
def within(x, y, z, limit):
    """Factor that brings a vector within a length: 1 if it is."""
    square = x * x + y * y + z * z
    return math.sqrt(min(limit * limit / max(square, NOTHING), 1.0))


@law
def touch(gap, nx, ny, nz, vx, vy, vz, sx, sy, sz, kn, ks, beta, lost, mu, co, dt):
    """Forces at a point of contact.  # Eqs. (E22), (E25)

    Parameters: gap [m], normal, velocity of the upper body relative to the lower one, shear force until now [N], stiffnesses
    [N/m], dashpots over stiffness [s], share of the normal force that is missing while the point leaves, friction, cohesion
    [N], step [s]. Returns normal force of the spring, of what dissipates beside it, shear force of the spring (3), of the
    dashpot (3), and the work of the shear spring on its surroundings.
    """
    normal = max(-kn * gap, 0.0)
    closed = normal > 0.0
    speed = vx * nx + vy * ny + vz * nz
    leaving = min(max(speed * (1.0 / SLOW), 0.0), 1.0)
    push = max(-beta * kn * speed - lost * leaving * normal, -normal) if closed else 0.0
    limit = mu * (normal + push) + (co if closed else 0.0)
    vx, vy, vz = vx - speed * nx, vy - speed * ny, vz - speed * nz
    out = sx * nx + sy * ny + sz * nz
    qx = sx - out * nx - ks * dt * vx
    qy = sy - out * ny - ks * dt * vy
    qz = sz - out * nz - ks * dt * vz
    less = within(qx, qy, qz, limit)
    qx, qy, qz = qx * less, qy * less, qz * less
    work = 0.5 * dt * ((sx + qx) * vx + (sy + qy) * vy + (sz + qz) * vz)
    gx, gy, gz = qx - beta * ks * vx, qy - beta * ks * vy, qz - beta * ks * vz
    less = within(gx, gy, gz, limit)
    return normal, push, qx, qy, qz, gx * less - qx, gy * less - qy, gz * less - qz, work


@law
def meet(e, u, v, l):
    """Place and motion of the drum above, in the axes of the one below."""
    w = e.w
    w[0, l], w[1, l], w[2, l] = in_body(v, l, u.ix[l], u.iy[l], u.iz[l])
    w[3, l], w[4, l], w[5, l] = in_body(v, l, u.jx[l], u.jy[l], u.jz[l])
    w[6, l], w[7, l], w[8, l] = in_body(v, l, u.kx[l], u.ky[l], u.kz[l])
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    w[9, l], w[10, l], w[11, l] = in_body(v, l, nx, ny, nz)
    rx, ry, rz, cx, cy, cz = faces(u, v, l)
    w[12, l], w[13, l], w[14, l] = in_body(v, l, cx, cy, cz)
    ax, ay, az = cross(u.wx[l], u.wy[l], u.wz[l], rx, ry, rz)
    ht = v.ht[l]
    bx, by, bz = cross(v.wx[l], v.wy[l], v.wz[l], cx + ht * v.kx[l], cy + ht * v.ky[l], cz + ht * v.kz[l])
    w[15, l], w[16, l], w[17, l] = in_body(
        v, l, u.vx[l] + ax - v.vx[l] - bx, u.vy[l] + ay - v.vy[l] - by, u.vz[l] + az - v.vz[l] - bz
    )
    w[18, l], w[19, l], w[20, l] = in_body(v, l, u.wx[l] - v.wx[l], u.wy[l] - v.wy[l], u.wz[l] - v.wz[l])
    e.en[l] = 0.0


@law
def share_out(e, f, u, v, l):
    """Each corner's share in the area of the overlap; no load as yet."""
    w = e.w
    tx, ty = v.tx[l], v.ty[l]
    ax, ay, _ = corner(u, w, 0, l)
    bx, by, _ = corner(u, w, 1, l)
    cx, cy, _ = corner(u, w, 2, l)
    dx, dy, _ = corner(u, w, 3, l)
    ax, ay, bx, by = clamped(ax, tx), clamped(ay, ty), clamped(bx, tx), clamped(by, ty)
    cx, cy, dx, dy = clamped(cx, tx), clamped(cy, ty), clamped(dx, tx), clamped(dy, ty)
    area = 0.5 * ((ax - cx) * (by - dy) - (ay - cy) * (bx - dx))
    w[21, l] = 0.25 * max(area, 0.0)
    e.kc[l] = e.ks[l] * w[21, l]
    for c in range(3):
        f.f[c, l] = f.up[c, l] = 0.0


@law
def press(e, f, o, sums, u, v, p, l):
    """Adds corner p: its force and its moment about the middle of the face below, as yet in the axes of the drum below."""
    w = e.w
    damped = e.d.shape[0] > 1
    dt = o.dt[l]
    nx, ny, nz = w[9, l], w[10, l], w[11, l]
    cx, cy, cz = w[12, l], w[13, l], w[14, l]
    x, y, z = corner(u, w, p, l)
    x, y, z, gap, nx, ny, nz = contact(x, y, z, v.tx[l], v.ty[l], nx, ny, nz, cx, cy, cz)
    ax, ay, az = cross(w[18, l], w[19, l], w[20, l], x - cx, y - cy, z - cz)
    vx, vy, vz = w[15, l] + ax, w[16, l] + ay, w[17, l] + az
    share = w[21, l]
    kn, ks = e.kn[l] * share, e.kc[l]
    beta = o.damp[BETA, l] if damped else 0.0
    normal, push, sx, sy, sz, gx, gy, gz, work = touch(
        gap, nx, ny, nz, vx, vy, vz, e.s[3 * p, l], e.s[3 * p + 1, l], e.s[3 * p + 2, l],
        kn, ks, beta, 0.0, e.mu[l], e.co[l] * share, dt,
    )  # fmt: skip
    e.s[3 * p, l], e.s[3 * p + 1, l], e.s[3 * p + 2, l] = sx, sy, sz
    sums.shear[l] -= work
    e.en[l] -= 0.5 * normal * min(gap, 0.0)
    fx, fy, fz = normal * nx + sx, normal * ny + sy, normal * nz + sz
    if damped:
        gx, gy, gz = gx + push * nx, gy + push * ny, gz + push * nz
        sums.visc[l] -= (
            0.5 * dt * ((gx + e.d[3 * p, l]) * vx + (gy + e.d[3 * p + 1, l]) * vy + (gz + e.d[3 * p + 2, l]) * vz)
        )
        e.d[3 * p, l], e.d[3 * p + 1, l], e.d[3 * p + 2, l] = gx, gy, gz
        fx, fy, fz = fx + gx, fy + gy, fz + gz
    f.f[0, l] += fx
    f.f[1, l] += fy
    f.f[2, l] += fz
    ax, ay, az = cross(x, y, z, fx, fy, fz)
    f.up[0, l] += ax
    f.up[1, l] += ay
    f.up[2, l] += az


@law
def put_down(e, f, u, v, l):
    """All of it on the two drums, in space."""
    w = e.w
    ht = v.ht[l]
    fx, fy, fz = f.f[0, l], f.f[1, l], f.f[2, l]
    mx, my, mz = f.up[0, l], f.up[1, l], f.up[2, l]
    # from the middle of the face below to the centroid above
    rx = w[12, l] - u.fx[l] * w[0, l] - u.fy[l] * w[3, l] - u.fz[l] * w[6, l]
    ry = w[13, l] - u.fx[l] * w[1, l] - u.fy[l] * w[4, l] - u.fz[l] * w[7, l]
    rz = w[14, l] - u.fx[l] * w[2, l] - u.fy[l] * w[5, l] - u.fz[l] * w[8, l]
    ax, ay, az = cross(rx, ry, rz, fx, fy, fz)
    f.up[0, l], f.up[1, l], f.up[2, l] = in_space(v, l, mx - ax, my - ay, mz - az)
    f.lo[0, l], f.lo[1, l], f.lo[2, l] = in_space(v, l, ht * fy - mx, -ht * fx - my, -mz)
    f.f[0, l], f.f[1, l], f.f[2, l] = in_space(v, l, fx, fy, fz)


@law
def corner_joint(e, f, o, sums, u, v, l):
    """Forces at t_n of a joint of rectangular faces in one lane; ``sums`` takes the work of its springs and dashpots."""
    meet(e, u, v, l)
    share_out(e, f, u, v, l)
    for p in range(u.px.shape[0]):
        press(e, f, o, sums, u, v, p, l)
    put_down(e, f, u, v, l)


@law
def on_corners(e, f, o, u, v):
    """Forces at t_n of a joint of rectangular faces in all lanes: lanes inside, points outside, so that both are vectors."""
    lanes = range(o.dt.shape[0])
    for l in lanes:
        meet(e, u, v, l)
    for l in lanes:
        share_out(e, f, u, v, l)
    for p in range(u.px.shape[0]):
        for l in lanes:
            press(e, f, o, o, u, v, p, l)
    for l in lanes:
        put_down(e, f, u, v, l)
