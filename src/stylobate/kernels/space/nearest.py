"""Direction from one convex body to another along which they are apart (Gilbert, Johnson and Keerthi, 1988).

Drums are exact here. The nearest points are those of least distance in the difference of both bodies, found from ever
better corners of it.
"""

import math

from ..jit import kernel, long_law
from ..shared.vectors import along, cross, dot, minus, of, place, put, scaled
from .solids import farthest

#: Corners tried at most; a direction is good when no corner comes nearer by this share.
TRIED, GOOD = 40, 1e-6


@long_law
def on_triangle(a, b, c):
    """Nearest point to the origin on a triangle, and which of its corners it needs (bits 1, 2, 4)."""
    ab = minus(b, a)
    ac = minus(c, a)
    d1 = -dot(ab, a)
    d2 = -dot(ac, a)
    if d1 <= 0.0 and d2 <= 0.0:
        return a, 1
    d3 = -dot(ab, b)
    d4 = -dot(ac, b)
    if d3 >= 0.0 and d4 <= d3:
        return b, 2
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return along(a, d1 / (d1 - d3), ab), 3
    d5 = -dot(ab, c)
    d6 = -dot(ac, c)
    if d6 >= 0.0 and d5 <= d6:
        return c, 4
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return along(a, d2 / (d2 - d6), ac), 5
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 >= d3 and d5 >= d6:
        return along(b, (d4 - d3) / ((d4 - d3) + (d5 - d6)), minus(c, b)), 6
    each = 1.0 / (va + vb + vc)
    return along(along(a, vb * each, ab), vc * each, ac), 7


@long_law
def on_simplex(w, count):
    """Nearest point to the origin of so many corners, and which it needs; 15: the origin is inside."""
    a = of(w[0])
    if count == 1:
        return a, 1
    b = of(w[1])
    if count == 2:
        ab = minus(b, a)
        x = -dot(ab, a) / max(dot(ab, ab), 1e-300)
        if x <= 0.0:
            return a, 1
        if x >= 1.0:
            return b, 2
        return along(a, x, ab), 3
    c = of(w[2])
    if count == 3:
        return on_triangle(a, b, c)
    d = of(w[3])
    best = a
    least = math.inf
    bits = 15
    for k in range(4):
        if k == 0:
            p, q, r, s, first_bit, second_bit, third_bit = a, b, c, d, 1, 2, 4
        elif k == 1:
            p, q, r, s, first_bit, second_bit, third_bit = a, b, d, c, 1, 2, 8
        elif k == 2:
            p, q, r, s, first_bit, second_bit, third_bit = a, c, d, b, 1, 4, 8
        else:
            p, q, r, s, first_bit, second_bit, third_bit = b, c, d, a, 2, 4, 8
        n = cross(minus(q, p), minus(r, p))
        if -dot(n, p) * dot(n, minus(s, p)) <= 0.0:
            at, face_bits = on_triangle(p, q, r)
            size = dot(at, at)
            if size < least:
                least = size
                best = at
                bits = (
                    (first_bit if face_bits & 1 else 0)
                    + (second_bit if face_bits & 2 else 0)
                    + (third_bit if face_bits & 4 else 0)
                )
    return best, bits


@kernel
def parting(s, u, t, v, size, vertex, nx, ny, nz, w):
    """By how much two shapes are surely apart [m], 0 where they meet, and the unit direction from the first to the second.

    ``n`` is a unit vector with which the search begins, ``w`` a workspace of four rows, ``size`` scales the second shape
    about its body's centroid. Where they meet, ``n``.
    """
    at = best = nx, ny, nz
    between = minus(place(v), place(u))
    gap = 0.0
    square = math.inf
    count = 0
    for _ in range(TRIED):
        far = along(between, size, farthest(t, v, vertex, scaled(-1.0, at)))
        corner = minus(far, farthest(s, u, vertex, at))
        # a direction in which even the nearest corner lies ahead proves that the shapes are apart
        ahead = dot(at, corner)
        each = 1.0 / math.sqrt(dot(at, at))
        if ahead * each > gap:
            gap = ahead * each
            best = scaled(each, at)
        if count > 0 and square - ahead <= GOOD * square:
            break
        put(w[count], corner)
        count += 1
        at, bits = on_simplex(w, count)
        least = dot(at, at)
        if bits == 15 or least < 1e-24 or least >= square:
            break
        square = least
        kept = 0
        for k in range(count):
            if bits & (1 << k):
                put(w[kept], of(w[k]))
                kept += 1
        count = kept
    return gap, best[0], best[1], best[2]
