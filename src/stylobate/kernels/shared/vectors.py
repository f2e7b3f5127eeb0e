"""Vectors in space as three numbers: what laws of contacts do with them."""

import math

from ..jit import long_law


@long_law
def dot(a, b):
    """a · b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@long_law
def cross(a, b):
    """a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@long_law
def minus(a, b):
    """a − b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@long_law
def along(a, x, u):
    """a + x u."""
    return a[0] + x * u[0], a[1] + x * u[1], a[2] + x * u[2]


@long_law
def scaled(x, a):
    """x a."""
    return x * a[0], x * a[1], x * a[2]


@long_law
def length(a):
    """|a|."""
    return math.sqrt(dot(a, a))


@long_law
def of(row):
    """The first three numbers of a row."""
    return row[0], row[1], row[2]


@long_law
def put(row, a):
    """Write a vector into a row."""
    row[0], row[1], row[2] = a


@long_law
def across(n):
    """A unit vector across another."""
    x, y, z = n
    if abs(x) < 0.6:
        each = 1.0 / math.sqrt(y * y + z * z)
        return 0.0, z * each, -y * each
    each = 1.0 / math.sqrt(x * x + y * y)
    return y * each, -x * each, 0.0


@long_law
def place(u):
    """Centroid of a body."""
    return u.x[0], u.y[0], u.z[0]


@long_law
def outward(u, a):
    """The vector in space whose components in the axes of a body are a."""
    return (
        a[0] * u.ix[0] + a[1] * u.jx[0] + a[2] * u.kx[0],
        a[0] * u.iy[0] + a[1] * u.jy[0] + a[2] * u.ky[0],
        a[0] * u.iz[0] + a[1] * u.jz[0] + a[2] * u.kz[0],
    )


@long_law
def inward(u, a):
    """Components in the axes of a body of a vector in space."""
    return (
        a[0] * u.ix[0] + a[1] * u.iy[0] + a[2] * u.iz[0],
        a[0] * u.jx[0] + a[1] * u.jy[0] + a[2] * u.jz[0],
        a[0] * u.kx[0] + a[1] * u.ky[0] + a[2] * u.kz[0],
    )


@long_law
def velocity(u, r):
    """Velocity of the point of a body at r from its centroid."""
    w = cross((u.wx[0], u.wy[0], u.wz[0]), r)
    return u.vx[0] + w[0], u.vy[0] + w[1], u.vz[0] + w[2]
