"""The elastic bed between two bodies in space: a force k_n times the volume of their overlap, with friction and torsion.

It acts in the middle of the overlap along the vector area of its surface. One pair of convex shapes has one region of
contact and one memory. Legend: ``records.py``.
"""

import math

from ..jit import kernel, long_law
from ..plane.contact import normal_dashpot, restitution_share
from ..shared.vectors import across, along, cross, dot, inward, length, minus, of, outward, place, put, scaled, velocity
from .acting import act_at, add, mobility, motion_then
from .friction import late, relax, rub
from .nearest import parting
from .overlap import DEEP_A, DEEP_B, INNER, MIDDLE, MOMENT, NORMAL, REF, SHADOW, SPREAD, VOLUME, overlap
from .records import DRUM, GROUND, LESS
from .solids import draw, reach

#: (Mean distance from the middle)² over the mean of its square: of a line, and of a disc.  # Eq. (Q3)
OF_LINE, OF_DISC = 0.75, 8.0 / 9.0

#: A contact that opens gives all of its pressure as long as it holds this share of the pressure times the mean depth; a
#: face that is pressed holds one half, an edge two thirds, a corner three quarters.
HOLDS = 0.45

#: While it opens and holds more than this share it gives more, up to so many times its pressure.
LEFT, MORE = 0.8, 4.0

#: A drum is touched on its side where the normal is across its axis, to this cosine.
ON_SIDE = 0.05

#: The second of two shapes is taken so much smaller to see in which direction it lies, which is known to this angle [rad].
SMALLER, AGREE = 0.92, 0.01

#: A part of a contact beyond an inner face has at least this share of its area.
LEAST = 1e-6

#: Shapes that are nearer than this share of the smaller one's size have their direction found anew in each step.
NEAR = 0.01


@long_law
def lever(xx, yy, xy):
    """Mean square distance of a face from its middle, and (mean distance)², from its second moments over its area.

    Between a line and a disc by the share of the smaller of both principal moments: rectangles are met to 1 %.
    """
    square = max(xx + yy, 0.0)
    even = max(4.0 * (xx * yy - xy * xy), 0.0) / max(square * square, 1e-300)
    return square, (OF_LINE + (OF_DISC - OF_LINE) * min(even, 1.0)) * square


@long_law
def in_plane(total, n, g, t, q):
    """Second moments of the contact about its middle along t and q, across n, over its area [m²]."""
    each = 1.0 / total[SHADOW]
    a, b, c = total[SPREAD] * each, total[SPREAD + 1] * each, total[SPREAD + 2] * each
    d, e, f = total[SPREAD + 3] * each, total[SPREAD + 4] * each, total[SPREAD + 5] * each
    at = a * t[0] + d * t[1] + f * t[2], d * t[0] + b * t[1] + e * t[2], f * t[0] + e * t[1] + c * t[2]
    aq = a * q[0] + d * q[1] + f * q[2], d * q[0] + b * q[1] + e * q[2], f * q[0] + e * q[1] + c * q[2]
    x, y = dot(g, t), dot(g, q)
    return dot(t, at) - x * x, dot(q, aq) - y * y, dot(t, aq) - x * y


@long_law
def spread_of(total, n, a, u, b, v):
    """:func:`lever` of a contact; the width of a facet that stands for a drum's side is none."""
    if total[SHADOW] <= 0.0:  # two bodies deep in one another, which the last direction does not fit
        return 0.0, 0.0
    g = total[MIDDLE] / total[SHADOW], total[MIDDLE + 1] / total[SHADOW], total[MIDDLE + 2] / total[SHADOW]
    t = across(n)
    flat = 1.0
    for side in range(2):
        s, w = (a, u) if side == 0 else (b, v)
        if s.kind == DRUM:
            e = axis(s, w)
            up = abs(dot(n, e))
            if up < flat:
                flat = up
                t = cross(e, n)
                t = scaled(1.0 / max(length(t), 1e-300), t) if length(t) > 1e-9 else across(n)
    xx, yy, xy = in_plane(total, n, g, t, cross(n, t))
    return lever(flat * flat * xx, yy, flat * xy)


@long_law
def axis(s, u):
    """Axis of a drum in space."""
    return outward(u, of(s.e))


@long_law
def forget(p):
    """The contact is open: nothing is left of it but the direction."""
    relax(p)
    p.fn = p.pn = p.area = 0.0
    for c in range(3):
        p.ta[c] = p.tb[c] = 0.0


@kernel
def face_contact(p, n, a, u, b, v, vertex, total, simplex):
    """Turn the facets of drums to where they are touched, for the next step; returns whether they are touched there.

    On the side of a drum a block touches where it is deepest inside, another drum along the shortest way between the axes.
    Rims turn to the normal, which is that of the face they press on; or where they press on edges, of which the normal is
    the facet's own, in the direction in which both shapes are apart when one is a little smaller.
    """
    ea = axis(a, u)
    eb = axis(b, v)
    side_a = a.kind == DRUM and abs(dot(n, ea)) < ON_SIDE
    side_b = b.kind == DRUM and abs(dot(n, eb)) < ON_SIDE
    ta = n
    tb = scaled(-1.0, n)
    meet = True
    p.side = 0
    if side_a and side_b:
        way = between_axes(a, u, ea, b, v, eb)
        if max(abs(dot(way, ea)), abs(dot(way, eb))) < ON_SIDE * length(way):
            ta = way
            tb = scaled(-1.0, way)
            p.side = 1
    elif side_a and b.kind != DRUM:
        ta = of(total[DEEP_A + 1 : DEEP_A + 4])
        meet = total[DEEP_A] > 0.0
        p.side = 1
    elif side_b and a.kind != DRUM:
        tb = of(total[DEEP_B + 1 : DEEP_B + 4])
        meet = total[DEEP_B] > 0.0
        p.side = 2
    elif a.kind != GROUND and b.kind != GROUND:
        gap, nx, ny, nz = parting(a, u, b, v, SMALLER, vertex, n[0], n[1], n[2], simplex)
        if gap > 0.0:
            other = minus((nx, ny, nz), n)
            share = min(max(length(other) / AGREE - 1.0, 0.0), 1.0)
            ta = along(n, share, other)
            tb = scaled(-1.0, ta)
    put(p.ta, ta)
    put(p.tb, tb)
    return meet


@long_law
def between_axes(a, u, ea, b, v, eb):
    """The shortest way from the axis of a drum to that of another one."""
    w = minus(along(place(v), 1.0, outward(v, of(b.c))), along(place(u), 1.0, outward(u, of(a.c))))
    c = dot(ea, eb)
    p, q = dot(ea, w), dot(eb, w)
    sine = 1.0 - c * c
    x = 0.5 * a.h
    if sine > 1e-12:
        x = (p - c * q) / sine
    x = min(max(x, 0.0), a.h)
    y = min(max(c * x - q, 0.0), b.h)
    x = min(max(p + c * y, 0.0), a.h)
    return along(along(w, y, eb), -x, ea)


@kernel
def drawn(p, n, a, u, b, v, vertex, plane, loop, corner, wide, top, low, work):
    """Whether two shapes overlap as they are drawn, drums with their facets; ``top`` and ``low``: see ``overlap``."""
    va, pa, ha, vb, pb, hb, _, _, _, _, total = work
    ta = of(p.ta)
    tb = of(p.tb)
    _, fa = draw(a, u, vertex, plane, n, ta if dot(ta, ta) > 0.0 else n, 1.0, place(v), wide, va, pa, ha)
    turn = tb if dot(tb, tb) > 0.0 else scaled(-1.0, n)
    _, fb = draw(b, v, vertex, plane, n, turn, LESS, place(u), wide, vb, pb, hb)
    overlap(a, u, b, v, fa, fb, n[0], n[1], n[2], loop, corner, top, low, work)
    s = total[NORMAL], total[NORMAL + 1], total[NORMAL + 2]
    return total[VOLUME] > 0.0 and dot(s, s) > 0.0


@kernel
def touching(p, a, u, b, v, vertex, plane, loop, corner, wide, work, simplex):
    """Whether two shapes overlap; the sums over the surface of their overlap then stand in ``work``.

    The direction of the pair is that of the last contact; before there is one, that in which the shapes are apart.
    ``wide`` is a length beyond which nothing of a body on the ground is from below its centroid [m].
    """
    n = of(p.n)
    ground = a.kind == GROUND or b.kind == GROUND
    if a.kind == GROUND:
        n = u.kx[0], u.ky[0], u.kz[0]
    elif b.kind == GROUND:
        n = -v.kx[0], -v.ky[0], -v.kz[0]
    top = reach(a, u, vertex, 1.0, n[0], n[1], n[2])
    low = -reach(b, v, vertex, LESS, -n[0], -n[1], -n[2])
    round_ = a.kind == DRUM or b.kind == DRUM
    p.gap = low - top
    if low - top >= (NEAR * min(u.r, v.r) if round_ and not ground else 0.0):
        put(p.n, n)
        return False
    if p.area == 0.0 and not ground:
        gap, nx, ny, nz = parting(a, u, b, v, LESS, vertex, n[0], n[1], n[2], simplex)
        if gap > 0.0:
            p.n[0], p.n[1], p.n[2] = nx, ny, nz
            p.gap = gap
            return False
    if top <= low:
        return False
    put(p.n, n)
    meet = drawn(p, n, a, u, b, v, vertex, plane, loop, corner, wide, top, low, work)
    if meet and round_ and p.area == 0.0:
        # facets that come down for the first time are turned to where they would touch before they do
        total = work[10]
        s = total[NORMAL], total[NORMAL + 1], total[NORMAL + 2]
        meet = face_contact(p, scaled(1.0 / length(s), s), a, u, b, v, vertex, total, simplex)
        meet = meet and drawn(p, n, a, u, b, v, vertex, plane, loop, corner, wide, top, low, work)
        if not meet:
            forget(p)
    return meet


@kernel
def foresee(p, a, u, b, v, vertex, plane, loop, corner, wide, kn, now, work):
    """Count a contact that will close within a step with the stiffness that it will have then."""
    n = of(p.n)
    closing = dot(minus((u.vx[0], u.vy[0], u.vz[0]), (v.vx[0], v.vy[0], v.vz[0])), n)
    closing += u.r * length((u.wx[0], u.wy[0], u.wz[0])) + v.r * length((v.wx[0], v.wy[0], v.wz[0]))
    if p.gap >= closing * now.dt:
        return
    pose_u, pose_v = pose(u), pose(v)
    carry(u, now.dt)
    carry(v, now.dt)
    top = reach(a, u, vertex, 1.0, n[0], n[1], n[2])
    low = -reach(b, v, vertex, LESS, -n[0], -n[1], -n[2])
    if top > low and drawn(p, n, a, u, b, v, vertex, plane, loop, corner, wide, top, low, work):
        total = work[10]
        s = of(total[NORMAL : NORMAL + 3])
        area = length(s)
        n = scaled(1.0 / area, s)
        c = along(of(total[REF : REF + 3]), 1.0 / total[VOLUME], of(total[MOMENT : MOMENT + 3]))
        ease = mobility(u, minus(c, place(u)), n) + mobility(v, minus(c, place(v)), n)
        now.rate = max(now.rate, kn * area * ease)
    stand(u, pose_u)
    stand(v, pose_v)


@long_law
def pose(u):
    """Place and axes of a body."""
    return (
        (u.x[0], u.y[0], u.z[0]),
        (u.ix[0], u.iy[0], u.iz[0]),
        (u.jx[0], u.jy[0], u.jz[0]),
        (u.kx[0], u.ky[0], u.kz[0]),
    )


@long_law
def stand(u, at):
    """Put a body where it was."""
    u.x[0], u.y[0], u.z[0] = at[0]
    u.ix[0], u.iy[0], u.iz[0] = at[1]
    u.jx[0], u.jy[0], u.jz[0] = at[2]
    u.kx[0], u.ky[0], u.kz[0] = at[3]


@long_law
def carry(u, dt):
    """Move a body along its velocities, to the first order."""
    w = u.wx[0], u.wy[0], u.wz[0]
    x, i, j, k = pose(u)
    stand(
        u,
        (
            along(x, dt, (u.vx[0], u.vy[0], u.vz[0])),
            along(i, dt, cross(w, i)),
            along(j, dt, cross(w, j)),
            along(k, dt, cross(w, k)),
        ),
    )


@long_law
def on_line(p, c, a, u, b, v):
    """Middle of a contact, which on the side of a drum lies on the line that touches, not somewhere on the facet."""
    if p.side == 0:
        return c
    s, w, t = (a, u, of(p.ta)) if p.side == 1 else (b, v, of(p.tb))
    across_ = cross(axis(s, w), t)
    foot = along(place(w), 1.0, outward(w, of(s.c)))
    return along(c, -dot(minus(c, foot), across_) / max(dot(across_, across_), 1e-300), across_)


@long_law
def returnable(fn, last, gain, before, depth, vn, ease, dt, reserve):
    """Pressure of a contact [N], which never gives back more work than it has taken.

    ``fn`` is k_n times the volume [N], ``reserve`` the work that it holds, and ``before`` the work of the last pressure in
    half a step [J]. What holds too little gives less, and gains, while it closes, ``gain`` [N] at most on the ``last``
    pressure. ``ease`` is the mobility along the normal [1/kg]: the work of the step, with the velocity after it, is no
    more than what is held.
    """  # Eq. (Q4)
    if fn <= 0.0:
        return fn
    allowed = max(reserve, 0.0) / (HOLDS * depth)
    if vn < 0.0:
        allowed = max(allowed, last + gain)
    else:
        fn = max(fn, min(MORE * fn, max(reserve, 0.0) / (LEFT * depth)))
    most = (math.sqrt(vn * vn + 2.0 * ease * max(reserve - before, 0.0)) - vn) / max(ease * dt, 1e-300)
    return min(fn, allowed, most)


@long_law
def alone(p):
    """Vector area, volume and work of the contact of two shapes, where no other shape has a part in it."""
    put(p.va, of(p.total[NORMAL : NORMAL + 3]))
    p.whole, p.en_part = p.total[VOLUME], p.en


@kernel
def gather(pair, count, shape, p):
    """Vector area, volume and work of the contact that a pair is a part of, with what lies beyond inner faces of a body.

    The work that presses it belongs to its parts as their volumes do.
    """
    s, own = of(p.va), p.whole
    for k in range(count):
        q = pair[k]
        same = shape[q.a].body == shape[p.a].body and shape[q.b].body == shape[p.b].body
        if same and q.share > 0.0 and q.total[INNER] > 0.0 and (q.a != p.a or q.b != p.b):
            s = along(s, 1.0, of(q.total[NORMAL : NORMAL + 3]))
            p.whole += q.total[VOLUME]
            p.en_part += q.en
    if p.whole > own:
        p.en_part *= own / p.whole
        if dot(s, s) > 0.0:
            put(p.va, s)


@kernel
def press(p, a, u, b, v, vertex, numbers, now, simplex):
    """Force of the bed at t_n on two bodies that overlap, with k_n, k_s and tan φ; brings its memory from t_{n−1} to t_n."""
    total = p.total
    area = length(of(p.va))
    n = scaled(1.0 / area, of(p.va))
    mean_depth = p.whole / area
    volume = total[VOLUME]
    p.en = p.en_part
    if p.whole > volume:
        area = max(dot(of(total[NORMAL : NORMAL + 3]), n), LEAST * area)
    c = along(of(total[REF : REF + 3]), 1.0 / volume, of(total[MOMENT : MOMENT + 3]))
    centre = c  # of what touches
    if total[SHADOW] > 0.0:
        centre = along(of(total[REF : REF + 3]), 1.0 / total[SHADOW], of(total[MIDDLE : MIDDLE + 3]))
        centre = along(centre, dot(minus(c, centre), n), n)
    if a.kind == DRUM or b.kind == DRUM:
        face_contact(p, n, a, u, b, v, vertex, total, simplex)
        c, centre = on_line(p, c, a, u, b, v), on_line(p, centre, a, u, b, v)
    square, mean = spread_of(total, n, a, u, b, v)
    ru = minus(c, place(u))
    rv = minus(c, place(v))
    w = minus(velocity(v, rv), velocity(u, ru))
    vn = dot(w, n)
    spin_u = dot((u.wx[0], u.wy[0], u.wz[0]), n)
    spin_v = dot((v.wx[0], v.wy[0], v.wz[0]), n)
    kn, ks, mu = p.share * numbers[0], p.share * numbers[1], numbers[2]
    ease = mobility(u, ru, n) + mobility(v, rv, n)
    # no mean depth is more than that of the slab, but for what is rounded where hardly anything touches
    depth = min(mean_depth, -p.gap)
    # pressure  # Eq. (Q2)
    fn = kn * volume
    if now.last == 0.0:  # no work has pressed what overlaps at the start
        p.en = 0.5 * fn * depth
    past, past_spin = motion_then(p, u, v)
    before = late(p.pn, p.fn * dot(past, of(p.n)), now)
    fn = returnable(fn, p.fn, -kn * area * vn * now.last, before, depth, vn, ease, now.kick, p.en)
    dn = normal_dashpot(fn, now.beta * kn * area, vn, restitution_share(now.eta, now.calm, vn))
    p.pn = fn * vn
    p.en -= before + 0.5 * p.pn * now.last
    face = ks * area, ks * area * square, minus(centre, place(u)), ru, 1.0 / max(square, 1e-30)
    f, twist, core = rub(
        p, outward(u, of(p.at)), n, along(w, -vn, n), 0.5 * (spin_u + spin_v), spin_v - spin_u, past, past_spin,
        face, (mu * (fn + dn), mean), scaled(dn, n), w, now,
    )  # fmt: skip
    put(p.at, inward(u, core))
    p.fn = fn
    grown = max(area - p.area, 0.0) * (now.dt / max(now.last, 1e-300) if p.area > 0.0 else 1.0)
    p.area = area
    act_at(p, n, ru, rv)
    now.deepest = max(now.deepest, depth)
    now.rate = max(now.rate, kn * (area + grown) * ease)
    f = along(f, fn, n)
    m = scaled(twist, n)
    add(v, rv, f, m)
    add(u, ru, scaled(-1.0, f), scaled(-1.0, m))
