"""Slip of a joint in space: read where its faces are closest, so that a drum that only leans has not slipped.

The middle of a face that leans about its rim moves sideways by R (1 - cos θ), and nothing has slipped: what counts is where
the upper drum's stone is that was pressed there, on a chip the end of its chord. A closed joint has the offset of its
middles.
"""

import math

from ..jit import long_law
from .corner import clamped
from .pose import cross, faces, in_body, in_space
from .support import corner_of


@long_law
def closest_of_discs(u, v, e, l, n, c):
    """Closest points of two discs, in the axes of the lower drum from the middle of its face [m].

    Of the ends of two discs the one that lies over the other disc touches: it is the less deep of the two. ``n`` is the
    normal of the upper face and ``c`` its middle.
    """
    nx, ny, nz = n
    cx, cy, cz = c
    sine = math.sqrt(nx * nx + ny * ny)
    flat = sine == 0.0
    each = 1.0 / (1.0 if flat else sine)
    hx, hy = (1.0 if flat else nx * each), ny * each
    dx, dy, dz = nz * hx, nz * hy, -sine
    if e.chip.shape[0] > 1:
        ax, ay, az = in_space(u, l, e.chip[0, l], e.chip[1, l], e.chip[2, l])
        ax, ay, az = in_body(v, l, ax, ay, az)
        bx, by, bz = cross(nx, ny, nz, ax, ay, az)
        if dx * ax + dy * ay + dz * az > e.chip[4, l]:
            side = -e.chip[5, l] if dx * bx + dy * by + dz * bz < 0.0 else e.chip[5, l]
            dx, dy, dz = e.chip[4, l] * ax + side * bx, e.chip[4, l] * ay + side * by, e.chip[4, l] * az + side * bz
    ru, rl = u.rb[l], v.rt[l]
    x, y, z = cx + ru * dx, cy + ru * dy, cz + ru * dz
    below = (cx - rl * hx) * nx + (cy - rl * hy) * ny + cz * nz
    return (x, y, z) if z >= below else (rl * hx, rl * hy, 0.0)


@long_law
def closest_of_corners(u, v, l, n, c):
    """The same of rectangular faces: the deepest corner of the upper one, brought to the nearest place on the lower one."""
    tx, ty = v.tx[l], v.ty[l]
    deepest, x, y, z = math.inf, 0.0, 0.0, 0.0
    for p in range(u.px.shape[0]):
        a, b, height = corner_of(u, v, l, p)
        over = (abs(a) < tx) & (abs(b) < ty)
        a, b = clamped(a, tx), clamped(b, ty)
        gap = height if over else (c[0] - a) * n[0] + (c[1] - b) * n[1] + c[2] * n[2]
        if gap < deepest:
            deepest, x, y, z = gap, a, b, height if over else 0.0
    return x, y, z


@long_law
def slip_where_closest(u, v, e, l, twist):
    """Slip of a joint in the axes of the drum below, at the place where its two faces are closest [m].

    ``twist`` is the turn of the upper drum about the joint's normal [rad].
    """
    _, _, _, cx, cy, cz = faces(u, v, l)
    c = in_body(v, l, cx, cy, cz)
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    n = in_body(v, l, nx, ny, nz)
    if u.px.shape[0] > 1:
        x, y, z = closest_of_corners(u, v, l, n, c)
    else:
        x, y, z = closest_of_discs(u, v, e, l, n, c)
    # that place in the axes of the upper drum, and where it would be had nothing slipped
    a, b, h = in_space(v, l, x - c[0], y - c[1], z - c[2])
    a, b, _ = in_body(u, l, a, b, h)
    cosine, sine = math.cos(twist), math.sin(twist)
    return x - (cosine * a - sine * b), y - (sine * a + cosine * b)
