"""Points where the part of a column above a joint is held: ends of round faces, whole or chipped, corners of others."""

import math

from ..jit import law, long_law
from .corner import clamped
from .pose import cross, faces, in_body, in_space

#: Share of a face's corners' area below which two faces have parted [-].
PARTED = 1e-9


@long_law
def middle_of_discs(u, v, l, a, b):
    """Middle of the overlap of two discs in the frame of the face below, and whether they have parted.

    ``a``, ``b`` is where the upper disc's middle is.
    """
    ru, rl = u.rb[l], v.rt[l]
    gap = math.sqrt(a * a + b * b)
    middle = 0.5 * (max(-rl, gap - ru) + min(rl, gap + ru)) / max(gap, 1e-12)
    return a * middle, b * middle, gap >= ru + rl


@long_law
def end_of_discs(u, v, l, dx, dy):
    """The end of the overlap of two discs in a horizontal direction, from the middle of the face below, in space [m]."""
    _, _, _, cx, cy, cz = faces(u, v, l)
    ru, rl = u.rb[l], v.rt[l]
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    # ends of the upper and of the lower disc in that direction; the overlap reaches no further than either
    su = dx * nx + dy * ny
    sl = dx * v.kx[l] + dy * v.ky[l]
    eu = math.sqrt(max(1.0 - su * su, 0.0))
    el = math.sqrt(max(1.0 - sl * sl, 0.0))
    upper = cx * dx + cy * dy + ru * eu < rl * el
    if upper:
        scale = ru / max(eu, 1e-12)
        return cx + scale * (dx - su * nx), cy + scale * (dy - su * ny), cz - scale * su * nz
    scale = rl / max(el, 1e-12)
    return scale * (dx - sl * v.kx[l]), scale * (dy - sl * v.ky[l]), -scale * sl * v.kz[l]


@long_law
def middle_of_chipped(u, v, e, l, a, b, mx, my, parted):
    """As :func:`middle_of_discs` for an upper face with a chip, from what that has found."""
    x, y, z = in_space(u, l, e.chip[0, l], e.chip[1, l], e.chip[2, l])
    x, y, _ = in_body(v, l, x, y, z)
    ru, rl = u.rb[l], v.rt[l]
    reach = ru * e.chip[4, l]
    half = 0.5 * (reach - ru)
    # beyond the chord lies nothing
    return mx + half * x, my + half * y, parted | (reach + a * x + b * y <= -rl)


@long_law
def end_of_chipped(u, v, e, l, dx, dy, ex, ey, ez):
    """As :func:`end_of_discs` for an upper face with a chip, from what that has found: an end of the chord if nearer."""
    ru = u.rb[l]
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    ax, ay, az = in_space(u, l, e.chip[0, l], e.chip[1, l], e.chip[2, l])
    bx, by, bz = cross(nx, ny, nz, ax, ay, az)
    toward, beside = dx * ax + dy * ay, dx * bx + dy * by
    cosine = e.chip[4, l]
    sine = e.chip[5, l] if beside > 0.0 else -e.chip[5, l]
    # whether the end of the whole disc lies on the segment that is lost
    beyond = toward > cosine * math.sqrt(toward * toward + beside * beside)
    _, _, _, cx, cy, cz = faces(u, v, l)
    x, y, z = (
        cx + ru * (cosine * ax + sine * bx),
        cy + ru * (cosine * ay + sine * by),
        cz + ru * (cosine * az + sine * bz),
    )
    nearer = beyond & (x * dx + y * dy < ex * dx + ey * dy)
    return (x if nearer else ex), (y if nearer else ey), (z if nearer else ez)


@law
def corner_of(u, v, l, p):
    """Corner p of the upper drum's lower face in the frame of the face below [m]."""
    _, _, _, cx, cy, cz = faces(u, v, l)
    px, py, pz = in_space(u, l, u.px[p, l], u.py[p, l], u.pz[p, l])
    return in_body(v, l, cx + px, cy + py, cz + pz)


@long_law
def middle_of_corners(u, v, l):
    """Mean of the corners of the overlap of two rectangles in the frame of the face below, and whether they have parted."""
    tx, ty = v.tx[l], v.ty[l]
    x = y = area = 0.0
    last = u.px.shape[0] - 1
    fx, fy, _ = corner_of(u, v, l, last)
    fx, fy = clamped(fx, tx), clamped(fy, ty)
    for p in range(last + 1):
        gx, gy, _ = corner_of(u, v, l, p)
        gx, gy = clamped(gx, tx), clamped(gy, ty)
        area += 0.5 * (fx * gy - fy * gx)
        x += gx
        y += gy
        fx, fy = gx, gy
    each = 1.0 / (last + 1)
    return x * each, y * each, area < PARTED * u.rb[l] * u.rb[l]


@long_law
def end_of_corners(u, v, l, dx, dy):
    """The corner of the overlap of two rectangles that is farthest in a horizontal direction, as :func:`end_of_discs`."""
    far, ex, ey, ez = -math.inf, 0.0, 0.0, 0.0
    for p in range(u.px.shape[0]):
        a, b, c = corner_of(u, v, l, p)
        inside = (abs(a) < v.tx[l]) & (abs(b) < v.ty[l])
        x, y, z = in_space(v, l, clamped(a, v.tx[l]), clamped(b, v.ty[l]), c if inside else 0.0)
        if x * dx + y * dy > far:
            far, ex, ey, ez = x * dx + y * dy, x, y, z
    return ex, ey, ez


@law
def opening_of_corners(u, v, l):
    """Largest gap of a corner of the overlap of two rectangles [m]."""
    wide = 0.0
    _, _, _, cx, cy, cz = faces(u, v, l)
    cx, cy, cz = in_body(v, l, cx, cy, cz)
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    nx, ny, nz = in_body(v, l, nx, ny, nz)
    for p in range(u.px.shape[0]):
        a, b, c = corner_of(u, v, l, p)
        inside = (abs(a) < v.tx[l]) & (abs(b) < v.ty[l])
        x, y = clamped(a, v.tx[l]), clamped(b, v.ty[l])
        wide = max(wide, c if inside else nx * (cx - x) + ny * (cy - y) + nz * cz)
    return wide
