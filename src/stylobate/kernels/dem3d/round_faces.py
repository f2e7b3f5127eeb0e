"""Joints of round faces: how two faces stand to each other, the pressure of a law there, friction, forces on both drums.

A law of pressure, of faces that carry on their rims (``rims.py``) or on a bed (``beds.py``), is handed in. From the joint,
the lane, both drums, and how the faces stand to each other it gives::

    pressing, spread      normal force [N], mean square distance of pressure from its middle [m²]
    closed                area of what touches [m²]
    torsion               κ and λ of K_T = κ K_s ρ² and of the limit λ ρ μ N
    middle                of pressure [m]
    pressure, elastic     its force and moment about the middle of the face below; the same without dashpots
"""

import math

from ..jit import law
from .friction import NOTHING, kept, returned
from .pose import cross, faces, in_body, in_space, lean, middles, passing
from .records import BETA

#: Share of a relative rolling velocity that its resistance may take in one step.
STOPPING = 0.5


@law
def resistance(rolling, pressing, dx, dy, dz, ox, oy, oz, u, v, l, dt):
    """Moment that resists rolling, c N r against the part of the angular velocity along r.  # Eq. (E12)

    r = (dx, dy, dz) goes from the middle of the face to that of pressure; no step takes more than a share of the velocity,
    by the inertia that both drums have about r: a drum that lies on its side turns about its own axis there.
    """
    square = dx * dx + dy * dy + dz * dz
    each = 1.0 / math.sqrt(max(square, 1e-24))
    rate = (ox * dx + oy * dy + oz * dz) * each
    below = (u.kx[l] * dx + u.ky[l] * dy + u.kz[l] * dz) * each
    above = (v.kx[l] * dx + v.ky[l] * dy + v.kz[l] * dz) * each
    mobility = u.ia[l] + u.ic[l] * below * below + v.ia[l] + v.ic[l] * above * above
    most = STOPPING * abs(rate) / max(mobility * dt, NOTHING)
    size = min(rolling * pressing * square * each, most) * each
    size = -size if rate > 0.0 else size
    return size * dx, size * dy, size * dz


@law
def on_face(pressure_of, e, f, o, sums, u, v, l):
    """Forces at t_n of a joint of round faces under a law of pressure; brings its memory from t_{n−1} to t_n.

    ``sums`` takes the work of its springs and dashpots: the lane's own record, or one in which each joint adds for itself.
    """
    zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    rx, ry, rz, cx, cy, cz = faces(u, v, l)
    hx, hy, hz, tx, ty, tz, sine, cosine = lean(nx, ny, nz, zx, zy, zz, v.ix[l], v.iy[l], v.iz[l])
    vx, vy, vz, ox, oy, oz = passing(u, v, l, rx, ry, rz, cx, cy, cz)
    leaning = (nx, ny, nz, hx, hy, hz, tx, ty, tz, sine, cosine)
    way = middles(cx, cy, cz, hx, hy, hz, tx, ty, tz)
    face, velocity, spin = (rx, ry, rz, cx, cy, cz), (vx, vy, vz), (ox, oy, oz)
    pressing, spread, closed, torsion, middle, pressure, elastic = pressure_of(
        e, o, u, v, l, leaning, way, (cx, cy, cz), velocity, spin
    )
    rub(e, f, o, sums, u, v, l, pressing, spread, closed, torsion, face, middle, velocity, spin, pressure, elastic)


@law
def rub(e, f, o, sums, u, v, l, pressing, spread, closed, torsion, face, middle, velocity, spin, pressure, elastic):
    """Adds friction to the pressure of a joint and puts the sum on the two drums.

    Vectors, beside those of a law of pressure: ``face`` from the upper centroid to the middle of its face, and that middle
    from the one below; ``velocity`` of the upper face's middle and ``spin`` as seen from the drum below.
    """
    damped = e.d.shape[0] > 1
    kf, cohesion = e.ks[l] * closed, e.co[l] * closed
    rx, ry, rz, cx, cy, cz = face
    px, py, pz = middle
    vx, vy, vz = velocity
    ox, oy, oz = spin
    fx, fy, fz, mx, my, mz = pressure
    ex, ey, ez, ix, iy, iz = elastic
    dt = o.dt[l]
    zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
    ht = v.ht[l]
    # the tangent plane of friction
    nx, ny, nz = fx + NOTHING * zx, fy + NOTHING * zy, fz + NOTHING * zz
    each = 1.0 / math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx * each, ny * each, nz * each
    # slip and spin of the upper drum over the lower one at P
    ax, ay, az = cross(ox, oy, oz, px - cx, py - cy, pz - cz)
    ax, ay, az = vx + ax, vy + ay, vz + az
    slip = ax * nx + ay * ny + az * nz
    ax, ay, az = ax - slip * nx, ay - slip * ny, az - slip * nz
    turning = ox * nx + oy * ny + oz * nz
    # friction with one limit for both  # Eq. (E6)
    kt = torsion[0] * kf * spread * o.pivot[l]
    sx, sy, sz = in_space(v, l, e.s[0, l], e.s[1, l], e.s[2, l])
    old = e.t[l]
    keep = kept(kf, e.kf[l])
    out = sx * nx + sy * ny + sz * nz
    qx = keep * (sx - out * nx) - kf * dt * ax
    qy = keep * (sy - out * ny) - kf * dt * ay
    qz = keep * (sz - out * nz) - kf * dt * az
    twist = kept(kt, e.kt[l]) * old - kt * dt * turning
    limit = e.mu[l] * pressing + cohesion
    arm = torsion[1] * math.sqrt(spread)
    keep, less = returned(qx * qx + qy * qy + qz * qz, twist * twist, limit, limit * arm * o.pivot[l], kf, kt)
    qx, qy, qz, twist = qx * keep, qy * keep, qz * keep, twist * less
    sums.shear[l] -= 0.5 * dt * ((sx + qx) * ax + (sy + qy) * ay + (sz + qz) * az + (old + twist) * turning)
    e.s[0, l], e.s[1, l], e.s[2, l] = in_body(v, l, qx, qy, qz)
    e.t[l] = twist
    e.kf[l] = kf
    e.kt[l] = kt
    if damped:
        # dashpots parallel to the springs; friction in sum stays within Coulomb's
        drag = o.damp[BETA, l] * kf
        gx, gy, gz = qx - drag * ax, qy - drag * ay, qz - drag * az
        turn = twist - o.damp[BETA, l] * kt * turning
        keep, less = returned(gx * gx + gy * gy + gz * gz, turn * turn, limit, limit * arm * o.pivot[l], kf, kt)
        gx, gy, gz, turn = gx * keep - qx, gy * keep - qy, gz * keep - qz, turn * less - twist
        ex, ey, ez = fx - ex + gx, fy - ey + gy, fz - ez + gz
        ax, ay, az = cross(px, py, pz, gx, gy, gz)
        ix, iy, iz = mx - ix + ax + turn * nx, my - iy + ay + turn * ny, mz - iz + az + turn * nz
        if o.roll.shape[0] > 1:
            ax, ay, az = px - cx, py - cy, pz - cz
            slip = ax * nx + ay * ny + az * nz
            ax, ay, az = ax - slip * nx, ay - slip * ny, az - slip * nz
            ax, ay, az = resistance(o.roll[0, l], pressing, ax, ay, az, ox, oy, oz, u, v, l, dt)
            mx, my, mz = mx + ax, my + ay, mz + az
            ix, iy, iz = ix + ax, iy + ay, iz + az
        qx, qy, qz, twist = qx + gx, qy + gy, qz + gz, twist + turn
        ax, ay, az = cross(ox, oy, oz, cx, cy, cz)
        sums.visc[l] -= (
            0.5
            * dt
            * (
                (ex + e.d[0, l]) * (vx - ax)
                + (ey + e.d[1, l]) * (vy - ay)
                + (ez + e.d[2, l]) * (vz - az)
                + (ix + e.d[3, l]) * ox
                + (iy + e.d[4, l]) * oy
                + (iz + e.d[5, l]) * oz
            )
        )
        e.d[0, l], e.d[1, l], e.d[2, l] = ex, ey, ez
        e.d[3, l], e.d[4, l], e.d[5, l] = ix, iy, iz
    # all of it on the two drums
    fx, fy, fz = fx + qx, fy + qy, fz + qz
    ax, ay, az = cross(px, py, pz, qx, qy, qz)
    mx, my, mz = mx + ax + twist * nx, my + ay + twist * ny, mz + az + twist * nz
    ax, ay, az = cross(cx - rx, cy - ry, cz - rz, fx, fy, fz)
    f.f[0, l], f.f[1, l], f.f[2, l] = fx, fy, fz
    f.up[0, l], f.up[1, l], f.up[2, l] = mx - ax, my - ay, mz - az
    ax, ay, az = cross(-ht * zx, -ht * zy, -ht * zz, fx, fy, fz)
    f.lo[0, l], f.lo[1, l], f.lo[2, l] = ax - mx, ay - my, az - mz
