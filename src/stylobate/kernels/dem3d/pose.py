"""Places of two drums to each other at a joint, and their rates. Laws of numbers, in space axes."""

import math

from ..jit import law

#: Middles of faces that are closer than this lie on one another [m].
CENTRED = 1e-9


@law
def in_space(v, l, a, b, c):
    """The vector whose components in the axes of a drum are a, b, c."""
    return (
        a * v.ix[l] + b * v.jx[l] + c * v.kx[l],
        a * v.iy[l] + b * v.jy[l] + c * v.ky[l],
        a * v.iz[l] + b * v.jz[l] + c * v.kz[l],
    )


@law
def in_body(v, l, x, y, z):
    """Components of a vector in the axes of a drum."""
    return (
        x * v.ix[l] + y * v.iy[l] + z * v.iz[l],
        x * v.jx[l] + y * v.jy[l] + z * v.jz[l],
        x * v.kx[l] + y * v.ky[l] + z * v.kz[l],
    )


@law
def cross(ax, ay, az, bx, by, bz):
    """a × b."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@law
def faces(u, v, l):
    """From the upper drum's centroid to the middle of its lower face, and from the middle of the face below to there."""
    rx, ry, rz = in_space(u, l, u.fx[l], u.fy[l], u.fz[l])
    ht = v.ht[l]
    return (
        rx,
        ry,
        rz,
        u.x[l] + rx - v.x[l] - ht * v.kx[l],
        u.y[l] + ry - v.y[l] - ht * v.ky[l],
        u.z[l] + rz - v.z[l] - ht * v.kz[l],
    )


@law
def lean(nx, ny, nz, zx, zy, zz, ix, iy, iz):
    """Direction h in which a face of normal n leans over one of normal z, t = z × h, and sine and cosine of the angle.

    Faces that are parallel to rounding lean along the lower drum's first axis i.
    """
    cosine = nx * zx + ny * zy + nz * zz
    hx, hy, hz = nx - cosine * zx, ny - cosine * zy, nz - cosine * zz
    sine = math.sqrt(hx * hx + hy * hy + hz * hz)
    flat = sine < 1e-15
    each = 1.0 / max(sine, 1e-15)
    hx = ix if flat else hx * each
    hy = iy if flat else hy * each
    hz = iz if flat else hz * each
    tx, ty, tz = cross(zx, zy, zz, hx, hy, hz)
    return hx, hy, hz, tx, ty, tz, sine, cosine


@law
def passing(u, v, l, rx, ry, rz, cx, cy, cz):
    """Velocity of the middle of the upper face as seen from the drum below, and the relative angular velocity."""
    ht = v.ht[l]
    ax, ay, az = cross(u.wx[l], u.wy[l], u.wz[l], rx, ry, rz)
    bx, by, bz = cross(v.wx[l], v.wy[l], v.wz[l], cx + ht * v.kx[l], cy + ht * v.ky[l], cz + ht * v.kz[l])
    return (
        u.vx[l] + ax - v.vx[l] - bx,
        u.vy[l] + ay - v.vy[l] - by,
        u.vz[l] + az - v.vz[l] - bz,
        u.wx[l] - v.wx[l],
        u.wy[l] - v.wy[l],
        u.wz[l] - v.wz[l],
    )


@law
def middles(cx, cy, cz, hx, hy, hz, tx, ty, tz):
    """Place of the upper face's middle c from the lower one's: distance along the lower face, cosine and sine (≥ 0) of its
    angle to the direction of lean h, and on which side of h it is (±1)."""
    along = cx * hx + cy * hy + cz * hz
    across = cx * tx + cy * ty + cz * tz
    s = math.sqrt(along * along + across * across)
    side = -1.0 if across < 0.0 else 1.0
    each = 1.0 / max(s, CENTRED)
    near = s < CENTRED
    return s, (1.0 if near else along * each), (0.0 if near else side * across * each), side
