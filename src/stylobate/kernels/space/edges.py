"""The boundary law in lanes: sums over the edge of the overlap of two faces, without a branch that hangs on a lane.

The sums are those of ``boundary.py``. Arcs of a disc over a polygon lie between the points where edges of the polygon leave
the disc and where they enter it. Along the rim the sums have an elementary integral, cut where the depth is 0: all arcs
together are this integral where edges enter less that where they leave, and as many whole circles as the way round the
polygon outside the disc passes the direction in which angles begin anew. Legend: ``work`` in ``lane_records.py``.
"""

import math

from ..dem3d.rim import TINY, angle_of, angle_to, overlap, press_askew
from ..jit import apart, kernel, law
from .boundary import (
    AREA,
    EDGE,
    FIRST,
    LENGTH,
    LOWER,
    MOMENT,
    PARALLEL,
    POLAR,
    PRESS,
    SECOND,
    SQUARE,
    flush,
)
from .records import OF_SUMS

#: Rows of ``disc``.
CX, CY, FLAT, DEPTH, SLOPE, SIDE, DEEP_X, DEEP_Y, STEEP, HALF, COSINE, SINE = range(12)

#: Rows of ``arc``: angle of the arcs, and sums of their ends along x and y; integrals of 1, cos φ, sin φ, cos 2φ, sin 2φ (as
#: in ``rim.py``) over what touches; whole circles.
TURN, ENDS_X, ENDS_Y, TOUCH, SINES, COSINES, DOUBLE, SQUARES, CIRCLES = range(9)


@apart
def begin(s):
    """Direction of the tilt, and the depth along the edge of the lower face; nothing is summed up yet."""
    for l in range(s.a.shape[0]):
        nx, ny, nz = s.n[0, l], s.n[1, l], s.n[2, l]
        wx, wy, wz = s.w[0, l], s.w[1, l], s.w[2, l]
        sine = math.sqrt(nx * nx + ny * ny)
        level = sine < PARALLEL
        each = 1.0 / max(sine, PARALLEL)
        s.sine[l] = sine
        s.hx[l] = 1.0 if level else nx * each
        s.hy[l] = 0.0 if level else ny * each
        s.m[0, l] = nx - (ny * wz - nz * wy)
        s.m[1, l] = ny - (nz * wx - nx * wz)
        s.m[2, l] = nz - (nx * wy - ny * wx)
        s.lift[l] = s.v[0, l] * nx + s.v[1, l] * ny + s.v[2, l] * nz
        for k in range(OF_SUMS):
            s.sums[k, l] = 0.0


@law
def upper_depth(s, l, x, y, z):
    """Depth of a place on the upper face under the lower one."""
    return -z - s.v[2, l] - (s.w[0, l] * (y - s.c[1, l]) - s.w[1, l] * (x - s.c[0, l]))


@law
def lower_depth(s, l, x, y):
    """Depth of a place on the lower face over the upper one."""
    return (x - s.c[0, l]) * s.m[0, l] + (y - s.c[1, l]) * s.m[1, l] - s.c[2, l] * s.m[2, l] - s.lift[l]


@law
def add_piece(s, at, l, live, px, py, pz, qx, qy, qz, d, e):
    """Add a straight piece from p to q with depths d and e there, where it is ``live``; the overlap is to its left.

    ``shared`` of it counts as a piece of the other face's edge.
    """
    wx, wy, wz = qx - px, qy - py, qz - pz
    flat = math.sqrt(wx * wx + wy * wy)
    s.sums[AREA, l] += px * qy - qx * py if live else 0.0
    s.sums[EDGE, l] += flat if live else 0.0
    first, last = max(d, 0.0), max(e, 0.0)
    cut = d * e < 0.0
    share = (first + last) / (abs(d - e) if cut else 1.0)
    share = share if cut else 1.0
    back, on = d < 0.0, (e < 0.0) & (d >= 0.0)
    px, py, pz, qx, qy, qz = (
        qx - share * wx if back else px,
        qy - share * wy if back else py,
        qz - share * wz if back else pz,
        px + share * wx if on else qx,
        py + share * wy if on else qy,
        pz + share * wz if on else qz,
    )
    both = first + last
    share = share if live & (both > 0.0) else 0.0
    size = share * math.sqrt(wx * wx + wy * wy + wz * wz)
    own, others, other = (1.0 - s.shared[l]) * size, s.shared[l] * size, LOWER - at
    s.sums[at + PRESS, l] += 0.5 * own * both
    s.sums[other + PRESS, l] += 0.5 * others * both
    weight_p, weight_q, each, rest = first + both, last + both, own * (1.0 / 6.0), others * (1.0 / 6.0)
    x, y, z = weight_p * px + weight_q * qx, weight_p * py + weight_q * qy, weight_p * pz + weight_q * qz
    s.sums[at + FIRST, l] += each * x
    s.sums[at + FIRST + 1, l] += each * y
    s.sums[at + FIRST + 2, l] += each * z
    s.sums[other + FIRST, l] += rest * x
    s.sums[other + FIRST + 1, l] += rest * y
    s.sums[other + FIRST + 2, l] += rest * z
    square = (weight_p + first) * (px * px + py * py + pz * pz) + 2.0 * both * (px * qx + py * qy + pz * qz)
    square += (weight_q + last) * (qx * qx + qy * qy + qz * qz)
    s.sums[at + SECOND, l] += size * square * (1.0 / 12.0)
    s.sums[at + SQUARE, l] += size * (first * first + first * last + last * last) * (1.0 / 3.0)
    reach = share * flat
    s.sums[LENGTH, l] += reach
    s.sums[MOMENT, l] += 0.5 * reach * (px + qx)
    s.sums[MOMENT + 1, l] += 0.5 * reach * (py + qy)
    s.sums[MOMENT + 2, l] += 0.5 * reach * (pz + qz)
    square = px * (px + qx) + qx * qx + py * (py + qy) + qy * qy + pz * (pz + qz) + qz * qz
    s.sums[POLAR, l] += reach * square * (1.0 / 3.0)


@law
def cut_off(p, q, c, d, l, first, last, shared):
    """Shares of the way from p to q between which it is to the left of the line through c and d, of those given.

    And the share that an edge along this line has in it.
    """
    ex, ey = d.x[l] - c.x[l], d.y[l] - c.y[l]
    a = ex * (p.y[l] - c.y[l]) - ey * (p.x[l] - c.x[l])
    b = ex * (q.y[l] - c.y[l]) - ey * (q.x[l] - c.x[l])
    out, off = a < 0.0, b < 0.0
    share = a / (a - b if out != off else 1.0)
    first = max(first, share) if out & (not off) else first
    last = min(last, share) if off & (not out) else last
    return first, -1.0 if out & off else last, max(shared, flush(a, b, ex * ex + ey * ey))


@apart
def cut_by_line(s, p, q, c, d):
    """Keep of the way from p to q what is to the left of the line through c and d."""
    for l in range(s.a.shape[0]):
        s.a[l], s.b[l], s.shared[l] = cut_off(p, q, c, d, l, s.a[l], s.b[l], s.shared[l])


@apart
def cut_by_four(s, p, q, c, d, e, f):
    """What of the way from p to q is over a face of four corners."""
    for l in range(s.a.shape[0]):
        first, last, shared = cut_off(p, q, c, d, l, 0.0, 1.0, 0.0)
        first, last, shared = cut_off(p, q, d, e, l, first, last, shared)
        first, last, shared = cut_off(p, q, e, f, l, first, last, shared)
        s.a[l], s.b[l], s.shared[l] = cut_off(p, q, f, c, l, first, last, shared)


@apart
def add_upper_piece(s, p, q):
    """Add what is left of the way from p to q, along the edge of the upper face."""
    for l in range(s.a.shape[0]):
        a, b = s.a[l], s.b[l]
        px, py, pz = p.x[l], p.y[l], p.z[l]
        wx, wy, wz = q.x[l] - px, q.y[l] - py, q.z[l] - pz
        qx, qy, qz = px + b * wx, py + b * wy, pz + b * wz
        px, py, pz = px + a * wx, py + a * wy, pz + a * wz
        add_piece(s, 0, l, b > a, px, py, pz, qx, qy, qz, upper_depth(s, l, px, py, pz), upper_depth(s, l, qx, qy, qz))


@apart
def add_lower_piece(s, p, q):
    """Add what is left of the way from p to q, along the edge of the lower face."""
    for l in range(s.a.shape[0]):
        a, b = s.a[l], s.b[l]
        px, py = p.x[l], p.y[l]
        wx, wy = q.x[l] - px, q.y[l] - py
        qx, qy = px + b * wx, py + b * wy
        px, py = px + a * wx, py + a * wy
        add_piece(s, LOWER, l, b > a, px, py, 0.0, qx, qy, 0.0, lower_depth(s, l, px, py), lower_depth(s, l, qx, qy))


@apart
def leave_whole(s):
    """All of the next edge is over the other face."""
    for l in range(s.a.shape[0]):
        s.a[l], s.b[l], s.shared[l] = 0.0, 1.0, 0.0


@law
def along_disc(s, l, upper, radius):
    """Depth in the middle of a face, and by how much it grows to the rim, along the direction of the tilt and across it."""
    hx, hy, sine = s.hx[l], s.hy[l], s.sine[l]
    nx, ny, nz = s.n[0, l], s.n[1, l], s.n[2, l]
    wx, wy, wz = s.w[0, l], s.w[1, l], s.w[2, l]
    cx, cy, cz = s.c[0, l], s.c[1, l], s.c[2, l]
    if upper:
        # steepest descent in the upper face is (n_z h, −sine); seen along z
        slope = sine - (wx * nz * hy - wy * nz * hx)
        return -cz - s.v[2, l], radius * slope, -radius * (wx * hx + wy * hy)
    # w × h and w × t, t = (−h_y, h_x, 0), along n
    slope = sine - (-wz * hy * nx + wz * hx * ny + (wx * hy - wy * hx) * nz)
    side = -wz * hx * nx - wz * hy * ny + (wx * hx + wy * hy) * nz
    m = s.lift[l] - (nx * (wy * cz - wz * cy) + ny * (wz * cx - wx * cz) + nz * (wx * cy - wy * cx))
    return -(cx * nx + cy * ny + cz * nz) - m, radius * slope, -radius * side


@law
def add_rim(s, at, l, upper, radius, flat, length, n, along, across, reach, beside):
    """Add an arc with its integrals of depth, along the steepest descent in the face and across it; and of what touches."""
    hx, hy = s.hx[l], s.hy[l]
    slant = s.n[2, l] if upper else 1.0
    fall = -s.sine[l] if upper else 0.0
    cx = s.c[0, l] if upper else 0.0
    cy = s.c[1, l] if upper else 0.0
    cz = s.c[2, l] if upper else 0.0
    mx = along * slant * hx - across * hy
    my = along * slant * hy + across * hx
    mz = along * fall
    s.sums[at + PRESS, l] += radius * n
    s.sums[at + FIRST, l] += radius * (n * cx + radius * mx)
    s.sums[at + FIRST + 1, l] += radius * (n * cy + radius * my)
    s.sums[at + FIRST + 2, l] += radius * (n * cz + radius * mz)
    square = n * (cx * cx + cy * cy + cz * cz + radius * radius) + 2.0 * radius * (cx * mx + cy * my + cz * mz)
    s.sums[at + SECOND, l] += radius * square
    mx = radius * (reach * slant * hx - beside * hy)
    my = radius * (reach * slant * hy + beside * hx)
    mz = radius * reach * fall
    s.sums[LENGTH, l] += flat * length
    s.sums[MOMENT, l] += flat * (length * cx + mx)
    s.sums[MOMENT + 1, l] += flat * (length * cy + my)
    s.sums[MOMENT + 2, l] += flat * (length * cz + mz)
    square = length * (cx * cx + cy * cy + cz * cz + radius * radius) + 2.0 * (cx * mx + cy * my + cz * mz)
    s.sums[POLAR, l] += flat * square


@apart
def two_discs(s, e):
    """Sums of a disc on a disc: the rim law."""
    for l in range(s.a.shape[0]):
        ru, rl = e.ru[l], e.rl[l]
        flat = ru * s.n[2, l]
        cx, cy = s.c[0, l], s.c[1, l]
        hx, hy = s.hx[l], s.hy[l]
        away = math.sqrt(cx * cx + cy * cy)
        each = 1.0 / max(away, 1e-9)
        on = away < 1e-9
        x = 1.0 if on else (cx * hx + cy * hy) * each
        y = 0.0 if on else (cy * hx - cx * hy) * each
        psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, area, rim = overlap(flat, rl, away)
        d, slope, side = along_disc(s, l, True, ru)
        length, n, along, across, p, q = press_askew(d, slope, side, -x, -y, psi_u, cos_u, sin_u)
        add_rim(s, 0, l, True, ru, flat, length, n, along, across, p, q)
        s.sums[SQUARE, l] += ru * (d * n + slope * along + side * across)
        d, slope, side = along_disc(s, l, False, rl)
        length, n, along, across, p, q = press_askew(d, slope, side, x, y, psi_l, cos_l, sin_l)
        add_rim(s, LOWER, l, False, rl, rl, length, n, along, across, p, q)
        s.sums[LOWER + SQUARE, l] += rl * (d * n + slope * along + side * across)
        s.sums[AREA, l] = 2.0 * area
        s.sums[EDGE, l] = rim


@apart
def begin_disc(s, e, upper, circles):
    """Depth along the rim of one of two faces, whose arcs are then added up; ``circles``: whole circles to begin with."""
    for l in range(s.a.shape[0]):
        radius = e.ru[l] if upper else e.rl[l]
        d, slope, side = along_disc(s, l, upper, radius)
        steep = math.sqrt(slope * slope + side * side)
        each = 1.0 / max(steep, TINY)
        x = 1.0 if steep < TINY else slope * each
        y = 0.0 if steep < TINY else side * each
        hx, hy = s.hx[l], s.hy[l]
        half, cosine, sine = angle_of((steep + d) / max(steep, TINY))
        s.disc[CX, l] = s.c[0, l] if upper else 0.0
        s.disc[CY, l] = s.c[1, l] if upper else 0.0
        s.disc[FLAT, l] = radius * s.n[2, l] if upper else radius
        s.disc[DEPTH, l], s.disc[STEEP, l] = d, steep
        s.disc[SLOPE, l], s.disc[SIDE, l] = x, y
        s.disc[DEEP_X, l], s.disc[DEEP_Y, l] = x * hx - y * hy, x * hy + y * hx
        s.disc[HALF, l], s.disc[COSINE, l], s.disc[SINE, l] = half, cosine, sine
        for k in range(8):
            s.arc[k, l] = 0.0
        s.arc[CIRCLES, l] = circles


@law
def passes(px, py, qx, qy):
    """How often the way from p to q passes the angle π counter-clockwise: 1, 0, or −1."""
    turn = px * qy - py * qx
    on = (py >= 0.0) & (qy < 0.0) & (turn > 0.0)
    back = (py < 0.0) & (qy >= 0.0) & (turn < 0.0)
    return 1.0 if on else -1.0 if back else 0.0


@law
def add_end(s, l, way, x, y):
    """Add an end of an arc in the direction (x, y) from the deepest one: by 1 where arcs end, by −1 where they begin."""
    angle = angle_to(x, abs(y))
    side = 1.0 if y >= 0.0 else -1.0
    wet = angle < s.disc[HALF, l]
    s.arc[TURN, l] += way * side * angle
    c = x if wet else s.disc[COSINE, l]
    n = side * (abs(y) if wet else s.disc[SINE, l])
    s.arc[TOUCH, l] += way * side * (angle if wet else s.disc[HALF, l])
    s.arc[SINES, l] += way * n
    s.arc[COSINES, l] -= way * c
    s.arc[DOUBLE, l] += way * n * c
    s.arc[SQUARES, l] += way * n * n


@apart
def cut_by_disc(s, p, q):
    """What of an edge of a polygon is over a disc, and the ends of arcs that are on it."""
    for l in range(s.a.shape[0]):
        flat = s.disc[FLAT, l]
        each = 1.0 / flat
        gx, gy = s.disc[DEEP_X, l] * each, s.disc[DEEP_Y, l] * each
        px, py = p.x[l] - s.disc[CX, l], p.y[l] - s.disc[CY, l]
        qx, qy = q.x[l] - s.disc[CX, l], q.y[l] - s.disc[CY, l]
        # from the deepest direction on, in radii
        px, py = px * gx + py * gy, py * gx - px * gy
        qx, qy = qx * gx + qy * gy, qy * gx - qx * gy
        wx, wy = qx - px, qy - py
        square, half = wx * wx + wy * wy, wx * px + wy * py
        from_, to = px * px + py * py, qx * qx + qy * qy
        root = half * half - square * (from_ - 1.0)
        meets = root > 0.0
        root = math.sqrt(max(root, 0.0))
        back = 1.0 / max(square, 1e-300)
        begins, ends = from_ >= 1.0, to >= 1.0  # outside
        a = min(max((-half - root) * back, 0.0), 1.0) if begins else 0.0
        b = min(max((root - half) * back, 0.0), 1.0) if ends else 1.0
        hit = (not begins) | (not ends) | (meets & (b > a))
        s.a[l] = a if hit else 1.0
        s.b[l] = b if hit else 0.0
        s.shared[l] = 0.0
        enter, leave = hit & begins, hit & ends
        ex, ey = px + a * wx, py + a * wy
        x, y = px + b * wx, py + b * wy
        s.arc[CIRCLES, l] += (passes(px, py, ex, ey) if enter else 0.0) + (passes(x, y, qx, qy) if leave else 0.0)
        s.arc[CIRCLES, l] += 0.0 if hit else passes(px, py, qx, qy)
        enter_sign, leave_sign = 1.0 if enter else 0.0, -1.0 if leave else 0.0
        s.arc[ENDS_X, l] += enter_sign * ex + leave_sign * x
        s.arc[ENDS_Y, l] += enter_sign * ey + leave_sign * y
        add_end(s, l, enter_sign, ex if enter else 1.0, ey if enter else 0.0)
        add_end(s, l, leave_sign, x if leave else 1.0, y if leave else 0.0)


@apart
def end_disc(s, e, upper):
    """Add all arcs of a disc to the sums."""
    for l in range(s.a.shape[0]):
        at = 0 if upper else LOWER
        radius, flat = e.ru[l] if upper else e.rl[l], s.disc[FLAT, l]
        d, steep = s.disc[DEPTH, l], s.disc[STEEP, l]
        circles = s.arc[CIRCLES, l]
        turn = s.arc[TURN, l] + 2.0 * math.pi * circles
        length = s.arc[TOUCH, l] + 2.0 * circles * s.disc[HALF, l]
        sines = s.arc[SINES, l] + 2.0 * circles * s.disc[SINE, l]
        double = s.arc[DOUBLE, l] + 2.0 * circles * s.disc[SINE, l] * s.disc[COSINE, l]
        n = max(d * length + steep * sines, 0.0)
        first = d * sines + 0.5 * steep * (length + double)
        second = d * s.arc[COSINES, l] + 0.5 * steep * s.arc[SQUARES, l]
        first, second = min(max(first, -n), n), min(max(second, -n), n)
        x, y = s.disc[SLOPE, l], s.disc[SIDE, l]
        along, across = first * x - second * y, first * y + second * x
        cosines = s.arc[COSINES, l]
        p, q = sines * x - cosines * y, sines * y + cosines * x
        add_rim(s, at, l, upper, radius, flat, length, n, along, across, p, q)
        s.sums[at + SQUARE, l] += radius * (d * n + steep * first)
        # ends of arcs back along x and y
        gx, gy = s.disc[DEEP_X, l], s.disc[DEEP_Y, l]
        dx = flat * (s.arc[ENDS_X, l] * gx - s.arc[ENDS_Y, l] * gy)
        dy = flat * (s.arc[ENDS_X, l] * gy + s.arc[ENDS_Y, l] * gx)
        s.sums[AREA, l] += s.disc[CX, l] * dy - s.disc[CY, l] * dx + flat * flat * turn
        s.sums[EDGE, l] += flat * turn


@kernel
def after(k, many):
    """Number of the corner that follows."""
    return k + 1 if k + 1 < many else 0


@kernel
def cut_by_polygon(s, p, q, corner, first, many):
    """What of the way from p to q is over a convex polygon."""
    if many == 4:
        cut_by_four(s, p, q, corner[first], corner[first + 1], corner[first + 2], corner[first + 3])
        return
    leave_whole(s)
    for k in range(many):
        cut_by_line(s, p, q, corner[first + k], corner[first + after(k, many)])


@kernel
def sum_up(s, e, corner, spot):
    """Sums over the edge of the overlap of the two faces of a joint."""
    begin(s)
    low, up, start = e.many_l, e.many_u, e.first_l
    if e.level != 0:
        if up == 0:
            begin_disc(s, e, True, 1.0)
            end_disc(s, e, True)
        else:
            leave_whole(s)
            for k in range(up):
                add_upper_piece(s, spot[k], spot[after(k, up)])
    elif low == 0 and up == 0:
        two_discs(s, e)
    elif up == 0:
        begin_disc(s, e, True, 0.0)
        for k in range(low):
            p, q = corner[start + k], corner[start + after(k, low)]
            cut_by_disc(s, p, q)
            add_lower_piece(s, p, q)
        end_disc(s, e, True)
    elif low == 0:
        begin_disc(s, e, False, 0.0)
        for k in range(up):
            p, q = spot[k], spot[after(k, up)]
            cut_by_disc(s, p, q)
            add_upper_piece(s, p, q)
        end_disc(s, e, False)
    else:
        for k in range(up):
            p, q = spot[k], spot[after(k, up)]
            cut_by_polygon(s, p, q, corner, start, low)
            add_upper_piece(s, p, q)
        for k in range(low):
            p, q = corner[start + k], corner[start + after(k, low)]
            cut_by_polygon(s, p, q, spot, 0, up)
            add_lower_piece(s, p, q)
