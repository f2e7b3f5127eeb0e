"""Which shapes may touch: spheres around them with a skin, listed anew when some body may have gone half of it.

The list is in the order of the shapes, and a pair keeps its memory as long as it is in the list.
"""

from ..jit import kernel, long_law
from ..run_codes import FAILED
from ..shared.vectors import dot, length, minus, of, outward, place, put, scaled
from .bed import forget
from .nearest import parting
from .records import GROUND

#: Where two shapes touch from the start, the second is taken so much smaller to see in which direction it lies.
SMALLER = 0.99


@long_law
def middle(s, u):
    """Middle of a shape's sphere."""
    at = outward(u, of(s.m))
    o = place(u)
    return o[0] + at[0], o[1] + at[1], o[2] + at[2]


@long_law
def gap(s, u, t, v):
    """Distance between the spheres of two shapes [m], of a half-space below its plane."""
    way = minus(middle(t, v), middle(s, u))
    if s.kind == GROUND:
        return dot(way, (u.kx[0], u.ky[0], u.kz[0])) - t.r
    if t.kind == GROUND:
        return -dot(way, (v.kx[0], v.ky[0], v.kz[0])) - s.r
    return length(way) - s.r - t.r


@long_law
def before(p, a, b):
    """Whether a pair comes before that of two shapes."""
    low, high = min(p.a, p.b), max(p.a, p.b)
    return low < a or (low == a and high < b)


@long_law
def is_of(p, a, b):
    """Whether a pair is that of two shapes."""
    return min(p.a, p.b) == a and max(p.a, p.b) == b


@kernel
def begin(p, s, u, t, v, vertex, simplex):
    """A pair that is new to the list: the direction in which its shapes are apart, or would be if one were smaller."""
    forget(p)
    if s.kind == GROUND or t.kind == GROUND:
        return
    way = minus(middle(t, v), middle(s, u))
    size = length(way)
    way = scaled(1.0 / size, way) if size > 0.0 else (0.0, 0.0, 1.0)
    _, nx, ny, nz = parting(s, u, t, v, SMALLER, vertex, way[0], way[1], way[2], simplex)
    put(p.n, (nx, ny, nz))


@kernel
def list_pairs(body, shape, vertex, pair, spare, joint, now, simplex):
    """List anew all pairs of shapes that may touch; joints come in the order of their shapes."""
    for i in range(body.shape[0]):
        body[i].travel = 0.0
    n = shape.shape[0]
    count = 0
    old = 0
    next_ = 0
    for a in range(n):
        s = shape[a]
        u = body[s.body]
        for b in range(a + 1, n):
            t = shape[b]
            v = body[t.body]
            if s.body == t.body or (u.fixed != 0 and v.fixed != 0) or gap(s, u, t, v) > now.skin:
                continue
            if count == spare.shape[0]:
                now.status = FAILED
                return
            while old < now.pairs and before(pair[old], a, b):
                old += 1
            p = spare[count]
            count += 1
            if old < now.pairs and is_of(pair[old], a, b):
                spare[count - 1] = pair[old]
                continue
            p.a = a
            p.b = b
            while next_ < joint.shape[0] and before(joint[next_], a, b):
                next_ += 1
            p.joint = next_ if next_ < joint.shape[0] and is_of(joint[next_], a, b) else -1
            begin(p, s, u, t, v, vertex, simplex)
    for k in range(count):
        pair[k] = spare[k]
    now.pairs = count
