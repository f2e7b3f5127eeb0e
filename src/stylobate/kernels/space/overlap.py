"""Overlap of two convex bodies: what its surface adds up to, without cases of corners, edges and faces.

The overlap is bounded by the parts of either surface that lie inside the other body. Fans of triangles over these parts give
its volume, its middle, and the vector area S of A's part, which is normal to the contact and as large as it. Only faces
that reach into the slab between the two bodies' supports along any direction n can bound it: nothing else is clipped.

Legend of ``total``, all about a point ``REF`` of the overlap::

    VOLUME                       [m³];  MOMENT 3   its first moment [m⁴]
    NORMAL 3                     vector area of A's part [m²]
    SHADOW, MIDDLE 3, SPREAD 6   area of A's part seen along n, its first and second moments (xx yy zz xy yz zx)
    REF 3
    DEEP_A 4, DEEP_B 4           of a drum: how deep the other surface reaches into its side [m], and from its axis where to
    INNER                        how many of its faces lie on other shapes of their body
"""

import math

from ..jit import kernel, long_law
from ..shared.vectors import along, cross, dot, minus, of, outward, place, put
from .records import DRUM

#: Places in ``total``.
VOLUME, MOMENT, NORMAL, SHADOW, MIDDLE, SPREAD, REF, DEEP_A, DEEP_B, INNER = 0, 1, 4, 7, 8, 11, 17, 20, 24, 28


@long_law
def cut(inp, count, plane, out):
    """What of a polygon lies within a plane; returns the number of its corners."""
    n = of(plane)
    d = plane[3]
    made = 0
    before = of(inp[count - 1])
    was = dot(n, before) - d
    for k in range(count):
        here = of(inp[k])
        now = dot(n, here) - d
        if (was <= 0.0) != (now <= 0.0):
            put(out[made], along(before, was / (was - now), minus(here, before)))
            made += 1
        if now <= 0.0:
            put(out[made], here)
            made += 1
        before = here
        was = now
    return made


@long_law
def crosses(inp, count, plane):
    """Where a polygon lies: 1 within a plane, −1 beyond it, 0 both."""
    n = of(plane)
    inside = 0
    for k in range(count):
        if dot(n, of(inp[k])) <= plane[3]:
            inside += 1
    return 1 if inside == count else -1 if inside == 0 else 0


@kernel
def add_face(total, polygon, count, n, of_a, begun):
    """Add a part of the surface to the sums."""
    first = of(polygon[0])
    if not begun:
        put(total[REF : REF + 3], first)
    ref = total[REF], total[REF + 1], total[REF + 2]
    p = minus(first, ref)
    q = minus(of(polygon[1]), ref)
    for k in range(2, count):
        r = minus(of(polygon[k]), ref)
        s = cross(minus(q, p), minus(r, p))  # twice the area
        m = p[0] + q[0] + r[0], p[1] + q[1] + r[1], p[2] + q[2] + r[2]  # three times the middle
        w = dot(p, s) / 6.0
        total[VOLUME] += w
        for c in range(3):
            total[MOMENT + c] += 0.25 * w * m[c]
        if of_a:
            e = 0.5 * dot(s, n)
            total[SHADOW] += e
            for c in range(3):
                total[NORMAL + c] += 0.5 * s[c]
                total[MIDDLE + c] += e * m[c] / 3.0
            e /= 12.0
            for c in range(3):
                d = (c + 1) % 3
                total[SPREAD + c] += e * (p[c] * p[c] + q[c] * q[c] + r[c] * r[c] + m[c] * m[c])
                total[SPREAD + 3 + c] += e * (p[c] * p[d] + q[c] * q[d] + r[c] * r[d] + m[c] * m[d])
        q = r


@kernel
def look_inside(deep, s, u, polygon, count):
    """Which point of the sides of a polygon is deepest inside the side of a drum: it shows where the drum is touched."""
    e = outward(u, of(s.e))
    c = along(place(u), 1.0, outward(u, of(s.c)))
    slope = (s.rt - s.rb) / s.h
    p = minus(of(polygon[count - 1]), c)
    up = dot(p, e)
    p = along(p, -up, e)
    for k in range(count):
        q = minus(of(polygon[k]), c)
        over = dot(q, e)
        q = along(q, -over, e)
        way = minus(q, p)
        x = min(max(-dot(p, way) / max(dot(way, way), 1e-300), 0.0), 1.0)
        at = along(p, x, way)
        depth = s.rb + slope * (up + x * (over - up)) - math.sqrt(dot(at, at))
        if depth > deep[0]:
            deep[0] = depth
            deep[1], deep[2], deep[3] = at
        p = q
        up = over


@kernel
def reaching(s, loop, corner, heights, faces, level, above, numbers):
    """Numbers of the faces of a shape of which a corner is above (or below) a level; returns how many."""
    count = 0
    for f in range(faces):
        l = loop[s.face + f]
        for k in range(l.first, l.first + l.count):
            h = heights[corner[k]]
            if (h > level) if above else (h < level):
                numbers[count] = f
                count += 1
                break
    return count


@kernel
def add_surface(
    total, n, s, t, v, loop, corner, points, mine, mine_count, planes, others, others_count, polygon, spare, of_a, begun
):
    """Add what of a shape's surface is inside the other shape t of body v; returns whether there is something by now."""
    for i in range(mine_count):
        l = loop[s.face + mine[i]]
        count = l.count
        for k in range(count):
            put(polygon[k], of(points[corner[l.first + k]]))
        for e in range(others_count):
            plane = planes[others[e]]
            side = crosses(polygon, count, plane)
            if side < 0:
                count = 0
                break
            if side == 0:
                count = cut(polygon, count, plane, spare)
                polygon, spare = spare, polygon
        if count > 2:
            add_face(total, polygon, count, n, of_a, begun)
            begun = True
            total[INNER] += l.inner
            if t.kind == DRUM:
                at = DEEP_B if of_a else DEEP_A
                look_inside(total[at : at + 4], t, v, polygon, count)
    return begun


@kernel
def overlap(a, u, b, v, na, nb, nx, ny, nz, loop, corner, top, low, work):
    """Sums over the surface of the overlap of two shapes that are drawn in ``work``; returns whether there is one.

    ``top`` and ``low`` are how far a reaches, and from where b does, along n: top > low.
    """
    va, pa, ha, vb, pb, hb, polygon, spare, fa, fb, total = work
    n = nx, ny, nz
    for k in range(total.shape[0]):
        total[k] = 0.0
    total[DEEP_A] = total[DEEP_B] = -math.inf
    count_a = reaching(a, loop, corner, ha, na, low, True, fa)
    count_b = reaching(b, loop, corner, hb, nb, top, False, fb)
    begun = add_surface(total, n, a, b, v, loop, corner, va, fa, count_a, pb, fb, count_b, polygon, spare, True, False)
    return add_surface(total, n, b, a, u, loop, corner, vb, fb, count_b, pa, fa, count_a, polygon, spare, False, begun)
