"""The boundary law: two plane faces that carry on the edge of their overlap, in closed form.

The stiffness k_n A of a joint sits evenly on the edge of the overlap of its two faces. Pieces of the upper face's edge press
on the plane of the lower face, pieces of the lower one's edge on the plane of the upper face. Depth is linear along a
straight piece, and d + g cos φ along an arc, so that force, moments and energy are elementary. Disc on disc is the rim law.
Where two edges lie on one another, only one of them is counted, whichever is inside by rounding; half of it presses along
either normal, so that nothing hangs on which.

All in the frame of the lower face: origin in its middle, x and y along it, z out of it. Legend::

    n c            normal (up) and middle of the upper face
    v w            β times the velocity of that middle and the angular velocity of the upper face as seen from the lower one:
                   depth is taken as depth plus β times its rate
    low up         corners of the lower and the upper face, counter-clockwise from above; none of a disc, of radius rl or ru
    sums           of the pieces of the upper edge, then of those of the lower one, of edges that lie on one another half
                   and half in PRESS and FIRST: PRESS, integral of depth [m²];
                   FIRST 3, of depth times place [m³]; SECOND, of depth times place squared [m⁴]; SQUARE, of depth squared
                   [m³]; then of both: AREA twice that of the overlap [m²], EDGE, its length [m]; LENGTH of what touches
                   [m], MOMENT 3, of its place [m²], and POLAR, of its place squared [m³]
"""

import math

from ..dem3d.rim import overlap, press_askew
from ..jit import kernel, law, long_law
from ..shared.vectors import along, cross, dot, minus, of

#: Places in ``sums``, those of the lower edge behind those of the upper one.
PRESS, FIRST, SECOND, SQUARE, LOWER, AREA, EDGE, LENGTH, MOMENT, POLAR = 0, 1, 4, 5, 6, 12, 13, 14, 15, 18

#: Sines below this are none: faces that are parallel to rounding.
PARALLEL = 1e-15

#: Edges of both faces lie on one another where neither end of one is farther from the other than this share of it.
FLUSH = 1e-5


@law
def flush(a, b, square):
    """Share that the other face has in an edge, a half of one that lies on its own edge.

    ``a`` and ``b`` are distances of the ends from that edge times its length, ``square`` is its length squared.
    """
    return max(0.5 - 0.5 * max(abs(a), abs(b)) / (FLUSH * square), 0.0)


@long_law
def within_polygon(p, q, corners, count):
    """Shares of the way from p to q between which it is over a convex polygon, none if the second is not larger.

    And the share that the polygon's edges have in it, see :func:`flush`.
    """
    first, last, shared = 0.0, 1.0, 0.0
    for k in range(count):
        m = k + 1 if k + 1 < count else 0
        ex = corners[m, 0] - corners[k, 0]
        ey = corners[m, 1] - corners[k, 1]
        a = ex * (p[1] - corners[k, 1]) - ey * (p[0] - corners[k, 0])
        b = ex * (q[1] - corners[k, 1]) - ey * (q[0] - corners[k, 0])
        if a < 0.0 and b < 0.0:
            return 1.0, 0.0, 0.0
        if a < 0.0:
            first = max(first, a / (a - b))
        elif b < 0.0:
            last = min(last, a / (a - b))
        if max(abs(a), abs(b)) < FLUSH * (ex * ex + ey * ey):
            shared = flush(a, b, ex * ex + ey * ey)
    return first, last, shared


@long_law
def within_disc(p, q, x, y, radius):
    """Shares of the way from p to q between which it is over a disc."""
    ex, ey = q[0] - p[0], q[1] - p[1]
    px, py = p[0] - x, p[1] - y
    a = ex * ex + ey * ey
    b = ex * px + ey * py
    root = b * b - a * (px * px + py * py - radius * radius)
    if root <= 0.0 or a == 0.0:
        return 1.0, 0.0, 0.0
    root = math.sqrt(root)
    return max((-b - root) / a, 0.0), min((root - b) / a, 1.0), 0.0


@kernel
def add_segment(sums, at, p, q, d0, d1, shared):
    """Add a straight piece from p to q with the depths there; the overlap is to its left.

    ``shared`` of it counts as a piece of the other face's edge.
    """
    w = minus(q, p)
    flat = math.sqrt(w[0] * w[0] + w[1] * w[1])
    sums[AREA] += p[0] * q[1] - p[1] * q[0]
    sums[EDGE] += flat
    if d0 <= 0.0 and d1 <= 0.0:
        return
    share = 1.0
    if d0 < 0.0:
        share = d1 / (d1 - d0)
        p = along(q, -share, w)
        d0 = 0.0
    elif d1 < 0.0:
        share = d0 / (d0 - d1)
        q = along(p, share, w)
        d1 = 0.0
    size = share * math.sqrt(dot(w, w))
    own = (1.0 - shared) * size
    sums[at + PRESS] += 0.5 * own * (d0 + d1)
    for c in range(3):
        sums[at + FIRST + c] += own * ((2.0 * d0 + d1) * p[c] + (d0 + 2.0 * d1) * q[c]) / 6.0
    if shared > 0.0:
        others, other = shared * size, LOWER - at
        sums[other + PRESS] += 0.5 * others * (d0 + d1)
        for c in range(3):
            sums[other + FIRST + c] += others * ((2.0 * d0 + d1) * p[c] + (d0 + 2.0 * d1) * q[c]) / 6.0
    square = (3.0 * d0 + d1) * dot(p, p) + 2.0 * (d0 + d1) * dot(p, q) + (d0 + 3.0 * d1) * dot(q, q)
    sums[at + SECOND] += size * square / 12.0
    sums[at + SQUARE] += size * (d0 * d0 + d0 * d1 + d1 * d1) / 3.0
    reach = share * flat
    sums[LENGTH] += reach
    for c in range(3):
        sums[MOMENT + c] += 0.5 * reach * (p[c] + q[c])
    sums[POLAR] += reach * (dot(p, p) + dot(p, q) + dot(q, q)) / 3.0


@kernel
def add_arc(sums, at, c, e, t, radius, flat, depth, slope, side, x, y, psi, cos_psi, sin_psi):
    """Add an arc of half angle psi about the direction (x, y) along e and t, from the middle c of a disc.

    The depth is ``depth`` in the middle and grows by ``slope`` to the rim along e, by ``side`` along t; ``flat`` is the
    radius that is seen from above.
    """
    length, n, along_e, along_t, reach_e, reach_t = press_askew(depth, slope, side, x, y, psi, cos_psi, sin_psi)
    sums[AREA] += 2.0 * flat * flat * psi  # what depends on the middle is added by the caller
    sums[EDGE] += 2.0 * flat * psi
    m = along(along((0.0, 0.0, 0.0), along_e, e), along_t, t)
    sums[at + PRESS] += radius * n
    for k in range(3):
        sums[at + FIRST + k] += radius * (n * c[k] + radius * m[k])
    sums[at + SECOND] += radius * (n * dot(c, c) + 2.0 * radius * dot(c, m) + radius * radius * n)
    sums[at + SQUARE] += radius * (depth * n + slope * along_e + side * along_t)
    m = along(along((0.0, 0.0, 0.0), radius * reach_e, e), radius * reach_t, t)
    sums[LENGTH] += flat * length
    for k in range(3):
        sums[MOMENT + k] += flat * (length * c[k] + m[k])
    sums[POLAR] += flat * (length * (dot(c, c) + radius * radius) + 2.0 * dot(c, m))


@kernel
def arcs_within(x, y, radius, corners, count, arcs):
    """Arcs of a circle that are over a convex polygon: where they begin and end [rad]; returns their number."""
    arcs[0, 0], arcs[0, 1] = -math.pi, math.pi
    arc_count = 1
    whole = True
    for k in range(count):
        m = k + 1 if k + 1 < count else 0
        ex = corners[m, 0] - corners[k, 0]
        ey = corners[m, 1] - corners[k, 1]
        each = 1.0 / math.sqrt(ex * ex + ey * ey)
        inside = (ex * (y - corners[k, 1]) - ey * (x - corners[k, 0])) * each
        if inside >= radius:
            continue
        if inside <= -radius:
            return 0
        half = math.acos(inside / radius)
        middle = math.atan2(-ex, ey)  # the outward normal
        if whole:  # the circle is cut open where the first piece of it is lost
            whole = False
            arcs[0, 0], arcs[0, 1] = middle + half, middle - half + 2.0 * math.pi
            continue
        for turn in range(-2, 3):
            low = middle - half + 2.0 * math.pi * turn
            high = middle + half + 2.0 * math.pi * turn
            for i in range(arc_count):
                a, b = arcs[i, 0], arcs[i, 1]
                if low >= b or high <= a:
                    continue
                if low > a and high < b:
                    arcs[i, 1] = low
                    arcs[arc_count, 0], arcs[arc_count, 1] = high, b
                    arc_count += 1
                elif low > a:
                    arcs[i, 1] = low
                elif high < b:
                    arcs[i, 0] = high
                else:
                    arcs[i, 1] = a
    return arc_count


@kernel
def add_circle(sums, at, c, e, t, radius, flat, depth, slope, side, corners, count, arcs):
    """Add the arcs of a disc that are over a convex polygon."""
    arc_count = arcs_within(c[0], c[1], flat, corners, count, arcs)
    for i in range(arc_count):
        a, b = arcs[i, 0], arcs[i, 1]
        if b > a:
            psi, mid = 0.5 * (b - a), 0.5 * (a + b)
            x, y = math.cos(mid), math.sin(mid)
            sums[AREA] += flat * (c[0] * (math.sin(b) - math.sin(a)) - c[1] * (math.cos(b) - math.cos(a)))
            add_arc(
                sums, at, c, e, t, radius, flat, depth, slope, side,
                x * t[1] - y * t[0], x * t[0] + y * t[1], psi, math.cos(psi), math.sin(psi),
            )  # fmt: skip


@long_law
def rise(p, c, v, w):
    """β times the velocity of the upper body at p as seen from the lower one."""
    return along(v, 1.0, cross(w, minus(p, c)))


@kernel
def boundary(n, c, v, w, low, many_low, rl, up, many_up, ru, arcs, sums):
    """Sums over the edge of the overlap of two faces, a disc where there are no corners; up: x, y, z of its corners."""
    for k in range(sums.shape[0]):
        sums[k] = 0.0
    sine = math.sqrt(n[0] * n[0] + n[1] * n[1])
    hx, hy = (1.0, 0.0) if sine < PARALLEL else (n[0] / sine, n[1] / sine)
    h = hx, hy, 0.0
    t = -hy, hx, 0.0
    d = n[2] * hx, n[2] * hy, -sine  # steepest descent in the upper face
    ra = ru * n[2]
    nothing = 0.0, 0.0, 0.0
    lift = dot(minus(v, cross(w, c)), n)
    at_u, along_u, side_u = -c[2] - v[2], ru * (sine - cross(w, d)[2]), -ru * cross(w, t)[2]
    at_l, along_l, side_l = -dot(c, n) - lift, rl * (sine - dot(cross(w, h), n)), -rl * dot(cross(w, t), n)
    if many_low == 0 and many_up == 0:
        s = math.sqrt(c[0] * c[0] + c[1] * c[1])
        x, y = (1.0, 0.0) if s < 1e-9 else ((c[0] * hx + c[1] * hy) / s, (c[1] * hx - c[0] * hy) / s)
        psi_u, cos_u, sin_u, psi_l, cos_l, sin_l, area, rim = overlap(ra, rl, s)
        add_arc(sums, 0, c, d, t, ru, ra, at_u, along_u, side_u, -x, -y, psi_u, cos_u, sin_u)
        add_arc(sums, LOWER, nothing, h, t, rl, rl, at_l, along_l, side_l, x, y, psi_l, cos_l, sin_l)
        sums[AREA], sums[EDGE] = 2.0 * area, rim
        return
    # the edge of the upper face over the lower one
    if many_up == 0:
        add_circle(sums, 0, c, d, t, ru, ra, at_u, along_u, side_u, low, many_low, arcs)
    for k in range(many_up):
        p = of(up[k])
        q = of(up[k + 1 if k + 1 < many_up else 0])
        a, b, shared = within_polygon(p, q, low, many_low) if many_low > 0 else within_disc(p, q, 0.0, 0.0, rl)
        if b > a:
            way = minus(q, p)
            q = along(p, b, way)
            p = along(p, a, way)
            add_segment(sums, 0, p, q, -p[2] - rise(p, c, v, w)[2], -q[2] - rise(q, c, v, w)[2], shared)
    # the edge of the lower face under the upper one
    if many_low == 0:
        add_circle(sums, LOWER, nothing, h, t, rl, rl, at_l, along_l, side_l, up, many_up, arcs)
    for k in range(many_low):
        m = k + 1 if k + 1 < many_low else 0
        p = low[k, 0], low[k, 1], 0.0
        q = low[m, 0], low[m, 1], 0.0
        a, b, shared = within_polygon(p, q, up, many_up) if many_up > 0 else within_disc(p, q, c[0], c[1], ra)
        if b > a:
            way = minus(q, p)
            q = along(p, b, way)
            p = along(p, a, way)
            d0 = dot(minus(minus(p, c), rise(p, c, v, w)), n)
            d1 = dot(minus(minus(q, c), rise(q, c, v, w)), n)
            add_segment(sums, LOWER, p, q, d0, d1, shared)
