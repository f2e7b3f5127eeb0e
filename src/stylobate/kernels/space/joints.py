"""Joints of two plane faces in space: pressure on the edge of their overlap, friction, and how they hand over to the bed."""

from ..jit import kernel, long_law
from ..plane.contact import normal_dashpot, restitution_share
from ..shared.handover import handover
from ..shared.vectors import along, cross, dot, length, minus, of, outward, place, put, scaled, velocity
from .acting import act_at, add, let_go, mobility, motion_then
from .boundary import AREA, EDGE, FIRST, LENGTH, LOWER, MOMENT, POLAR, PRESS, SECOND, SQUARE, boundary
from .friction import rub

#: Torsion over shear stiffness and polar moment of what touches, limit of torsion over that of shear and ρ: a closed disc
#: has K_s R²/2 and 2R/3.
TORSION, LEVER = 0.5, 2.0 / 3.0

#: Keeps quotients of nothing by nothing at nothing.
NOTHING = 1e-30


@long_law
def seen(v, i, j, k):
    """Components of a vector along three directions."""
    return dot(v, i), dot(v, j), dot(v, k)


@kernel
def face_pressure(e, u, v, beta, edge, up, arcs, sums):
    """Pressure of a joint between its faces, of the lower body u and the upper one v; its depth plus β times its rate.

    Returns its force on the upper body and its moment about the middle of the lower face [N], [N m], the same middle from
    the lower centroid [m], force, middle from there and mean square distance from it, elastic energy, area that touches,
    area of the overlap, and cosine of the tilt.
    """
    i, j = outward(u, of(e.il)), outward(u, of(e.jl))
    z = cross(i, j)
    p, q = outward(v, of(e.iu)), outward(v, of(e.ju))
    n = cross(p, q)
    ml, mu = outward(u, of(e.ml)), outward(v, of(e.mu))
    from_u = minus(along(place(v), 1.0, mu), place(u))
    at = seen(minus(from_u, ml), i, j, z)
    passing = scaled(beta, minus(velocity(v, mu), velocity(u, from_u)))
    turning = scaled(beta, spin_over(u, v))
    p, q = seen(p, i, j, z), seen(q, i, j, z)
    for k in range(e.many_u):
        x, y = edge[e.first_u + k, 0], edge[e.first_u + k, 1]
        put(up[k], along(along(at, x, p), y, q))
    low = edge[e.first_l : e.first_l + max(e.many_l, 1)]
    passing, turning = seen(passing, i, j, z), seen(turning, i, j, z)
    boundary(seen(n, i, j, z), at, passing, turning, low, e.many_l, e.rl, up, e.many_u, e.ru, arcs, sums)
    area = max(0.5 * sums[AREA], 0.0)
    k = e.kn * area / max(sums[EDGE], NOTHING)
    upper, lower = k * sums[PRESS], k * sums[LOWER + PRESS]
    first = scaled(k, (sums[FIRST], sums[FIRST + 1], sums[FIRST + 2]))
    other = scaled(k, (sums[LOWER + FIRST], sums[LOWER + FIRST + 1], sums[LOWER + FIRST + 2]))
    first = along(along(scaled(first[0], i), first[1], j), first[2], z)
    other = along(along(scaled(other[0], i), other[1], j), other[2], z)
    pressing = upper + lower
    middle = scaled(1.0 / max(pressing, NOTHING), along(first, 1.0, other))
    spread = k * (sums[SECOND] + sums[LOWER + SECOND]) / max(pressing, NOTHING) - dot(middle, middle)
    stored = 0.5 * k * (sums[SQUARE] + sums[LOWER + SQUARE])
    at = sums[MOMENT], sums[MOMENT + 1], sums[MOMENT + 2]
    touches, polar, at = touching(area / max(sums[EDGE], NOTHING), sums[LENGTH], at, sums[POLAR])
    closed = touches, polar, along(along(scaled(at[0], i), at[1], j), at[2], z)
    force = along(scaled(upper, z), lower, n)
    moment = along(cross(first, z), 1.0, cross(other, n))
    return force, moment, ml, pressing, middle, max(spread, 0.0), stored, closed, area, dot(z, n)


@long_law
def touching(rho, length, moment, polar):
    """Area of what touches, its polar moment about its centroid, and where that is, from sums over its edge."""
    at = scaled(1.0 / max(length, NOTHING), moment)
    return rho * length, rho * max(polar - length * dot(at, at), 0.0), at


@long_law
def spin_over(u, v):
    """Angular velocity of a body as seen from another."""
    return v.wx[0] - u.wx[0], v.wy[0] - u.wy[0], v.wz[0] - u.wz[0]


@kernel
def part(e, u, v, now):
    """Nothing is left of the contact."""
    let_go(e, u, v, now)
    put(e.gf, (0.0, 0.0, 0.0))
    put(e.gm, (0.0, 0.0, 0.0))


@kernel
def on_joint(e, u, v, edge, up, arcs, sums, now):
    """Force of a joint at t_n on its two bodies, by its weight; brings its memory from t_{n−1} to t_n."""
    pressure = face_pressure(e, u, v, 0.0, edge, up, arcs, sums)
    force, moment, ml, pressing, middle, spread, stored, closed, area, cosine = pressure
    e.over = area
    # under an edge the bed is so much softer that it carries only where nearly nothing is left of the joint
    e.weight = handover(cosine, area, e) ** 4
    if stored == 0.0 and (cosine < e.apart_c or area < e.apart):  # the law does not see a face that comes back askew
        e.weight = 0.0
    if e.weight == 0.0:
        e.live = 0
        part(e, u, v, now)
        return
    share = e.weight
    e.en = share * stored
    if now.beta > 0.0:
        elastic, turning = force, moment
        pressure = face_pressure(e, u, v, now.beta, edge, up, arcs, sums)
        force, moment, _, pressing, middle, spread, _, closed, _, _ = pressure
        drag, twist_ = scaled(share, minus(force, elastic)), scaled(share, minus(moment, turning))
        rv = minus(along(place(u), 1.0, ml), place(v))
        passing = minus(velocity(v, rv), velocity(u, ml))
        power = dot(along(drag, 1.0, of(e.gf)), passing) + dot(along(twist_, 1.0, of(e.gm)), spin_over(u, v))
        now.visc -= 0.5 * now.last * power
        put(e.gf, drag)
        put(e.gm, twist_)
    if pressing == 0.0:
        stored = e.en
        let_go(e, u, v, now)
        e.en = stored
        return
    n = scaled(1.0 / length(force), force)
    at = along(ml, 1.0, middle)
    rv = minus(along(place(u), 1.0, at), place(v))
    w = minus(velocity(v, rv), velocity(u, at))
    vn = dot(w, n)
    spin_u = dot((u.wx[0], u.wy[0], u.wz[0]), n)
    spin_v = dot((v.wx[0], v.wy[0], v.wz[0]), n)
    pressing *= share
    closed, polar, centre = closed
    k = share * e.ks * closed
    face = k, TORSION * share * e.ks * polar, along(ml, 1.0, centre), at, max(closed, 0.0) / max(polar, NOTHING)
    i, j = outward(u, of(e.il)), outward(u, of(e.jl))
    z = cross(i, j)
    core = along(along(along(ml, e.at[0], i), e.at[1], j), e.at[2], z)
    # a dashpot under much weight on a light body: a step takes at most an eighth of its momentum
    calm = max(now.calm, 8.0 * now.dull * pressing * now.last * (u.im[0] + v.im[0]))
    dn = normal_dashpot(pressing, 0.0, vn, restitution_share(now.dull, calm, vn))
    past, past_spin = motion_then(e, u, v)
    limits = e.tan * (pressing + dn) + share * e.co * closed, LEVER * LEVER * spread
    f, twist, core = rub(
        e, core, n, along(w, -vn, n), 0.5 * (spin_u + spin_v), spin_v - spin_u, past, past_spin,
        face, limits, scaled(dn, n), w, now,
    )  # fmt: skip
    put(e.at, seen(minus(core, ml), i, j, z))
    act_at(e, n, at, rv)
    if now.dull > 0.0:
        now.rate = max(now.rate, share * e.kn * closed * (mobility(u, at, n) + mobility(v, rv, n)))
    # friction at the middle of pressure, pressure at the middle of the lower face
    m = scaled(twist, n)
    add(v, rv, f, m)
    add(u, at, scaled(-1.0, f), scaled(-1.0, m))
    force, moment = scaled(share, force), scaled(share, moment)
    add(v, minus(along(place(u), 1.0, ml), place(v)), force, moment)
    add(u, ml, scaled(-1.0, force), scaled(-1.0, moment))
