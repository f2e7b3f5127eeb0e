"""Shapes where they are: how far they reach, and as polyhedra; a drum as a prism that turns a facet to the contact.

The facets of the prism touch the drum along lines of its cone, so that how far a drum reaches in the direction of contact is
exact however it rolls, and no edge ever comes down.
"""

import math

import numpy as np

from ..jit import kernel, long_law
from ..shared.vectors import across, along, cross, dot, inward, minus, of, outward, place, put, scaled
from .records import BLOCK, DRUM, FACETS, GROUND

#: Cosine and sine of the middle of every facet, and of the edge before it, from the middle of the first.
RING = np.array(
    [
        (math.cos(a), math.sin(a), math.cos(a - math.pi / FACETS), math.sin(a - math.pi / FACETS))
        for a in (2.0 * math.pi * k / FACETS for k in range(FACETS))
    ]
)

#: Edges of the prism over the radius of the drum.
WIDER = 1.0 / math.cos(math.pi / FACETS)


@long_law
def farthest(s, u, vertex, n):
    """Point of a body that is farthest in a direction, in space from the body's centroid."""
    d = inward(u, n)
    if s.kind == DRUM:
        e = of(s.e)
        up = dot(d, e)
        t = along(d, -up, e)
        size = math.sqrt(dot(t, t))
        t = scaled(1.0 / size, t) if size > 1e-12 else across(e)
        low = s.rb * size
        high = s.h * up + s.rt * size
        best = along(of(s.c), s.rb, t) if low > high else along(along(of(s.c), s.h, e), s.rt, t)
    else:
        best = of(vertex[s.first])
        reach = dot(best, d)
        for k in range(s.first + 1, s.first + s.count):
            other = dot(of(vertex[k]), d)
            if other > reach:
                reach = other
                best = of(vertex[k])
    return outward(u, best)


@kernel
def reach(s, u, vertex, size, nx, ny, nz):
    """How far a shape, scaled about its body's centroid, reaches in a direction [m]; a half-space, along its normal."""
    n = nx, ny, nz
    if s.kind == GROUND:
        return dot(n, place(u))
    return size * dot(n, farthest(s, u, vertex, n)) + dot(n, place(u))


@kernel
def draw(s, u, vertex, plane, n, turn, size, other, wide, points, planes, heights):
    """Vertices and planes of a shape in space, a prism with a facet towards ``turn`` for a drum; returns their numbers.

    ``size`` scales the shape about its body's centroid; ``heights`` are those of its vertices along n. Of a half-space, a
    square so wide [m] below or above the point ``other``.
    """
    o = place(u)
    if s.kind == BLOCK:
        count = s.count
        faces = s.faces
        for k in range(count):
            put(points[k], along(o, size, outward(u, of(vertex[s.first + k]))))
        for k in range(faces):
            p = outward(u, of(plane[s.face + k]))
            put(planes[k], p)
            planes[k, 3] = dot(p, o) + size * plane[s.face + k, 3]
    elif s.kind == DRUM:
        count = 2 * FACETS
        faces = FACETS + 2
        e = outward(u, of(s.e))
        c = along(o, size, outward(u, of(s.c)))
        h = size * s.h
        t = along(turn, -dot(turn, e), e)
        most = math.sqrt(dot(t, t))
        t = scaled(1.0 / most, t) if most > 1e-12 else across(e)
        q = cross(e, t)
        slope = (s.rb - s.rt) / s.h
        each = 1.0 / math.sqrt(1.0 + slope * slope)
        for k in range(FACETS):
            edge = along(scaled(RING[k, 2], t), RING[k, 3], q)
            put(points[k], along(c, size * WIDER * s.rb, edge))
            put(points[FACETS + k], along(along(c, h, e), size * WIDER * s.rt, edge))
            p = scaled(each, along(along(scaled(RING[k, 0], t), RING[k, 1], q), slope, e))
            put(planes[k], p)
            planes[k, 3] = dot(p, of(points[k]))
        put(planes[FACETS], scaled(-1.0, e))
        planes[FACETS, 3] = -dot(e, c)
        put(planes[FACETS + 1], e)
        planes[FACETS + 1, 3] = dot(e, c) + h
    else:
        count = 4
        faces = 1
        i = u.ix[0], u.iy[0], u.iz[0]
        j = u.jx[0], u.jy[0], u.jz[0]
        k3 = u.kx[0], u.ky[0], u.kz[0]
        middle = along(other, -dot(minus(other, o), k3), k3)
        put(points[0], along(along(middle, -wide, i), -wide, j))
        put(points[1], along(along(middle, wide, i), -wide, j))
        put(points[2], along(along(middle, wide, i), wide, j))
        put(points[3], along(along(middle, -wide, i), wide, j))
        put(planes[0], k3)
        planes[0, 3] = dot(k3, o)
    for k in range(count):
        heights[k] = dot(n, of(points[k]))
    return count, faces
