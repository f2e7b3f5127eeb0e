"""Joints of assemblies in space in lanes: the law of ``joints.py``, of faces that have nowhere begun to part for good.

Legend: ``lane_records.py``; u is the body of the lower face, v that of the upper one.
"""

from ..dem3d.pose import in_space
from ..jit import apart, law
from ..shared.friction import dragged, friction
from ..shared.handover import OVERLAP_FROM
from ..shared.vectors import along, cross, dot, length, minus, scaled
from .boundary import AREA, EDGE, FIRST, LENGTH, LOWER, MOMENT, POLAR, PRESS, SECOND, SQUARE
from .friction import about_middle, at_centroid, turned
from .joints import LEVER, NOTHING, TORSION, touching


@law
def row(a, l):
    """A vector of a lane."""
    return a[0, l], a[1, l], a[2, l]


@law
def write(a, l, v):
    """Write a vector of a lane."""
    a[0, l], a[1, l], a[2, l] = v


@law
def outward(u, l, a):
    """The vector in space whose components in the axes of a body are a row."""
    return in_space(u, l, a[0, l], a[1, l], a[2, l])


@law
def at_point(u, l, r):
    """Velocity of the point of a body at r from its centroid."""
    w = cross((u.wx[l], u.wy[l], u.wz[l]), r)
    return u.vx[l] + w[0], u.vy[l] + w[1], u.vz[l] + w[2]


@law
def seen(s, l, a):
    """Components of a vector along the axes of the lower face."""
    return dot(a, row(s.i, l)), dot(a, row(s.j, l)), dot(a, row(s.z, l))


@apart
def look_along(e, u, v, s):
    """Where the upper face is as seen from the lower one."""
    for l in range(s.a.shape[0]):
        i, j = outward(u, l, e.il), outward(u, l, e.jl)
        write(s.i, l, i)
        write(s.j, l, j)
        write(s.z, l, cross(i, j))
        p, q = outward(v, l, e.iu), outward(v, l, e.ju)
        ml, mu = outward(u, l, e.ml), outward(v, l, e.mu)
        between = v.x[l] + mu[0] - u.x[l], v.y[l] + mu[1] - u.y[l], v.z[l] + mu[2] - u.z[l]
        write(s.ml, l, ml)
        write(s.c, l, seen(s, l, minus(between, ml)))
        write(s.n, l, seen(s, l, cross(p, q)))
        write(s.p, l, seen(s, l, p))
        write(s.q, l, seen(s, l, q))
        write(s.v, l, (0.0, 0.0, 0.0))
        write(s.w, l, (0.0, 0.0, 0.0))


@apart
def look_on(e, u, v, s, o):
    """β times the velocity of the upper face as seen from the lower one."""
    for l in range(s.a.shape[0]):
        mu = outward(v, l, e.mu)
        from_u = v.x[l] + mu[0] - u.x[l], v.y[l] + mu[1] - u.y[l], v.z[l] + mu[2] - u.z[l]
        passing = minus(at_point(v, l, mu), at_point(u, l, from_u))
        turning = v.wx[l] - u.wx[l], v.wy[l] - u.wy[l], v.wz[l] - u.wz[l]
        write(s.v, l, scaled(o.beta[l], seen(s, l, passing)))
        write(s.w, l, scaled(o.beta[l], seen(s, l, turning)))


@apart
def place_corner(s, corner, spot):
    """A corner of the upper face as seen from the lower one."""
    for l in range(s.a.shape[0]):
        at = along(along(row(s.c, l), corner.x[l], row(s.p, l)), corner.y[l], row(s.q, l))
        spot.x[l], spot.y[l], spot.z[l] = at


@law
def first_moment(s, at, l):
    """First moment of the pressure of one of both edges, in the axes of the lower face."""
    return s.sums[at + FIRST, l], s.sums[at + FIRST + 1, l], s.sums[at + FIRST + 2, l]


@law
def resultant(s, kn, l):
    """Pressure in the axes of the lower face: k, both edges' shares, their first moments, force, moment about its middle."""
    area = max(0.5 * s.sums[AREA, l], 0.0)
    k = kn * area / max(s.sums[EDGE, l], NOTHING)
    upper, lower = k * s.sums[PRESS, l], k * s.sums[LOWER + PRESS, l]
    first, other = scaled(k, first_moment(s, 0, l)), scaled(k, first_moment(s, LOWER, l))
    n = row(s.n, l)
    force = lower * n[0], lower * n[1], lower * n[2] + upper
    moment = along(cross(other, n), 1.0, (first[1], -first[0], 0.0))
    return area, k, upper + lower, along(first, 1.0, other), force, moment


@law
def in_axes(s, l, a):
    """A vector in space from its components along the axes of the lower face."""
    return along(along(scaled(a[0], row(s.i, l)), a[1], row(s.j, l)), a[2], row(s.z, l))


@apart
def keep_elastic(e, s):
    """Note the elastic pressure, before that with damping."""
    for l in range(s.a.shape[0]):
        _, k, _, _, force, moment = resultant(s, e.kn[l], l)
        write(s.force, l, force)
        write(s.moment, l, moment)
        s.en[l] = 0.5 * k * (s.sums[SQUARE, l] + s.sums[LOWER + SQUARE, l])


@law
def act(damped, e, u, v, s, o, l):
    """Force of a joint on its two bodies in a lane; brings its memory from t_{n−1} to t_n."""
    area, k, pressing, middle, force, moment = resultant(s, e.kn[l], l)
    ml, last = row(s.ml, l), o.last[l]
    away = v.x[l] - u.x[l], v.y[l] - u.y[l], v.z[l] - u.z[l]
    foot = minus(ml, away)  # the middle of the lower face from the upper centroid
    if damped:
        e.en[l] = s.en[l]
        drag, turn = in_axes(s, l, minus(force, row(s.force, l))), in_axes(s, l, minus(moment, row(s.moment, l)))
        passing = minus(at_point(v, l, foot), at_point(u, l, ml))
        over = v.wx[l] - u.wx[l], v.wy[l] - u.wy[l], v.wz[l] - u.wz[l]
        power = dot(along(drag, 1.0, row(e.gf, l)), passing) + dot(along(turn, 1.0, row(e.gm, l)), over)
        o.visc[l] -= 0.5 * last * power
        write(e.gf, l, drag)
        write(e.gm, l, turn)
    else:
        e.en[l] = 0.5 * k * (s.sums[SQUARE, l] + s.sums[LOWER + SQUARE, l])
    loose = (s.n[2, l] < e.from_c[l]) | (area < OVERLAP_FROM * e.width[l])
    loose |= (e.en[l] == 0.0) & ((s.n[2, l] < e.apart_c[l]) | (area < e.apart[l]))
    o.loose[l] = 1 if loose else o.loose[l]
    force, moment = in_axes(s, l, force), in_axes(s, l, moment)
    each = 1.0 / max(pressing, NOTHING)
    middle = in_axes(s, l, scaled(each, middle))
    spread = max(k * (s.sums[SECOND, l] + s.sums[LOWER + SECOND, l]) * each - dot(middle, middle), 0.0)
    centre = s.sums[MOMENT, l], s.sums[MOMENT + 1, l], s.sums[MOMENT + 2, l]
    rho = area / max(s.sums[EDGE, l], NOTHING)
    closed, polar, centre = touching(rho, s.sums[LENGTH, l], centre, s.sums[POLAR, l])
    n = along(force, NOTHING, row(s.z, l))
    n = scaled(1.0 / length(n), n)
    at = along(ml, 1.0, middle)
    rv = minus(at, away)
    w = minus(at_point(v, l, rv), at_point(u, l, at))
    spin_u = dot((u.wx[l], u.wy[l], u.wz[l]), n)
    spin_v = dot((v.wx[l], v.wy[l], v.wz[l]), n)
    past = minus(at_point(v, l, row(e.rb, l)), at_point(u, l, row(e.ra, l)))
    write(e.n, l, n)
    write(e.ra, l, at)
    write(e.rb, l, rv)
    slip, spin, before, turn = along(w, -dot(w, n), n), spin_v - spin_u, row(e.f, l), e.t[l]
    centre = along(ml, 1.0, in_axes(s, l, centre))
    face = e.ks[l] * closed, TORSION * e.ks[l] * polar, centre, at, max(closed, 0.0) / max(polar, NOTHING)
    limits = e.tan[l] * pressing + e.co[l] * closed, LEVER * LEVER * spread
    rolling = 0.5 * (spin_u + spin_v) * last
    core = turned(row(e.s, l), n, rolling), e.st[l], e.kc[l], e.jc[l], along(ml, 1.0, in_axes(s, l, row(e.at, l)))
    fresh = turned(row(e.fs, l), n, rolling), e.ft[l], e.kf[l], e.jf[l]
    there = at_centroid(face, n, slip, spin)
    core, fresh, f, torsion = friction(core, fresh, face, n, there, spin, last, limits)
    # nothing is remembered of a joint that is open
    keep = 1.0 if pressing > 0.0 else 0.0
    half = 0.5 * last
    write(e.s, l, scaled(keep, core[0]))
    write(e.at, l, seen(s, l, minus(core[4], ml)))
    write(e.fs, l, scaled(keep, fresh[0]))
    e.st[l], e.kc[l], e.jc[l] = keep * core[1], keep * core[2], keep * core[3]
    e.ft[l], e.kf[l], e.jf[l] = keep * fresh[1], keep * fresh[2], keep * fresh[3]
    twist = keep * about_middle(face, n, f, torsion)
    g, more = f, torsion
    f = scaled(keep, f)
    o.shear[l] -= half * (dot(before, past) + dot(f, slip) + (turn + twist) * spin)
    write(e.f, l, f)
    e.t[l] = twist
    if damped:
        g, more = dragged(g, more, face, n, there, spin, o.beta[l], limits)
        g, more = scaled(keep, g), keep * about_middle(face, n, g, more)
        o.visc[l] -= half * (dot(g, w) + dot(row(e.d, l), past) + (more + e.dt[l]) * spin)
        write(e.d, l, g)
        e.dt[l] = more
        f, twist = along(f, 1.0, g), twist + more
    # friction acts at the middle of pressure, pressure at the middle of the lower face
    m = along(moment, twist, n)
    up, low = along(cross(rv, f), 1.0, cross(foot, force)), along(cross(at, f), 1.0, cross(ml, force))
    force, up, low = along(force, 1.0, f), along(up, 1.0, m), along(low, 1.0, m)
    for c in range(3):
        u.f[c, l] -= force[c]
        u.mo[c, l] -= low[c]
        v.f[c, l] += force[c]
        v.mo[c, l] += up[c]


@apart
def act_elastic(e, u, v, s, o):
    """Force of a joint without damping."""
    for l in range(s.a.shape[0]):
        act(False, e, u, v, s, o, l)


@apart
def act_damped(e, u, v, s, o):
    """Force of a joint with damping."""
    for l in range(s.a.shape[0]):
        act(True, e, u, v, s, o, l)
