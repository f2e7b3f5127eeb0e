"""The step of assemblies in space in lanes, as long as nothing of them may come loose: joints alone, and the motion.

The law of a joint is that of ``joints.py``. Where it is no longer all that happens, because a joint is about to hand over or
two bodies that no joint holds might touch, the lane has failed: the engine that finds contacts goes on with its run from the
last state that was kept.

State, a tuple in this order: body, joint, corner, spot, between, lane, ground, feed, watch, work; see ``lane_records.py``.
The frame of the run finds lane, ground, feed and watch where they are in the state of every engine.
"""

import math

from ..dem3d.look import fill_ground, straighten
from ..dem3d.move import twice_kinetic
from ..ground import BEFORE, sample
from ..jit import apart, kernel, law, strict
from ..run_codes import CHUNK, FAILED, RUNNING
from ..shared.frame import run_chunks
from ..shared.friction import stored
from ..shared.vectors import along, dot, length, minus, place, scaled
from .edges import sum_up
from .joints import NOTHING
from .lane_joints import act_damped, act_elastic, keep_elastic, look_along, look_on, place_corner, row
from .motion import carried_on
from .nearest import parting
from .records import GROUND
from .solids import reach


@apart
def clear(u):
    """Nothing acts on a body yet."""
    for l in range(u.x.shape[0]):
        for c in range(3):
            u.f[c, l] = u.mo[c, l] = 0.0


@kernel
def forces(state):
    """Forces of all joints at t_n on all bodies; brings their memory from t_{n−1} to t_n."""
    body, joint, corner, spot, _, lane, _, _, _, work = state
    o, s = lane[0], work[0]
    damped = False
    for l in range(o.beta.shape[0]):
        damped = damped or o.beta[l] > 0.0
    for i in range(body.shape[0]):
        clear(body[i])
    for q in range(joint.shape[0]):
        e = joint[q]
        u, v = body[e.lower], body[e.upper]
        look_along(e, u, v, s)
        for k in range(e.many_u):
            place_corner(s, corner[e.first_u + k], spot[k])
        sum_up(s, e, corner, spot)
        if damped:
            keep_elastic(e, s)
            look_on(e, u, v, s, o)
            sum_up(s, e, corner, spot)
            act_damped(e, u, v, s, o)
        else:
            act_elastic(e, u, v, s, o)


@apart
def drift(u, o, g):
    """Motion of a body from t_n to t_{n+1} under what acts on it at t_n."""
    for l in range(o.dt.shape[0]):
        dt, kick, im, m = o.dt[l], 0.5 * (o.last[l] + o.dt[l]), u.im[l], u.m[l]
        vx = u.vx[l] + kick * (u.f[0, l] * im - g.a[0, l] - o.g[0, l])
        vy = u.vy[l] + kick * (u.f[1, l] * im - g.a[1, l] - o.g[1, l])
        vz = u.vz[l] + kick * (u.f[2, l] * im - g.a[2, l] - o.g[2, l])
        lx, ly, lz = u.lx[l] + kick * u.mo[0, l], u.ly[l] + kick * u.mo[1, l], u.lz[l] + kick * u.mo[2, l]
        carried_on(u, l, (vx, vy, vz), (lx, ly, lz), dt)
        o.p[0, l] += m * vx
        o.p[1, l] += m * vy
        o.p[2, l] += m * vz


@apart
def work_done(o, g, h):
    """Adds the work of the body force −m a over a step by the trapezoidal rule."""
    for l in range(o.dt.shape[0]):
        power = 0.0
        for c in range(3):
            power += (g.a[c, l] + h.a[c, l]) * o.p[c, l]
            o.p[c, l] = 0.0
        o.work[l] -= 0.5 * power * o.dt[l]
        o.last[l] = o.dt[l]


@kernel
def move(state, k):
    """Motion of all bodies over step k of the chunk."""
    body, _, _, _, _, lane, ground, _, _, _ = state
    for i in range(body.shape[0]):
        if body[i].fixed == 0:
            drift(body[i], lane[0], ground[k])
    work_done(lane[0], ground[k], ground[k + 1])


@law
def turned(u, l):
    """How far the axes of a body have turned since the start, at most [-]."""
    ix, iy, iz = u.ix[l] - u.o[3, l], u.iy[l] - u.o[4, l], u.iz[l] - u.o[5, l]
    jx, jy, jz = u.jx[l] - u.o[6, l], u.jy[l] - u.o[7, l], u.jz[l] - u.o[8, l]
    kx, ky, kz = u.kx[l] - u.o[9, l], u.ky[l] - u.o[10, l], u.kz[l] - u.o[11, l]
    return math.sqrt(ix * ix + iy * iy + iz * iz + jx * jx + jy * jy + jz * jz + kx * kx + ky * ky + kz * kz)


@apart
def look_at_body(u, o):
    """Gives the axes of a body their right angles back, and notes how far they have turned."""
    for l in range(o.dt.shape[0]):
        straighten(u, l)
        u.turned[l] = turned(u, l)


@apart
def look_between(b, u, v, o):
    """Two bodies that no joint holds may touch once they may have come nearer by their gap, or will before the next look."""
    for l in range(o.dt.shape[0]):
        x = v.x[l] - u.x[l] - v.o[0, l] + u.o[0, l]
        y = v.y[l] - u.y[l] - v.o[1, l] + u.o[1, l]
        z = v.z[l] - u.z[l] - v.o[2, l] + u.o[2, l]
        p, q, r = v.vx[l] - u.vx[l], v.vy[l] - u.vy[l], v.vz[l] - u.vz[l]
        spin_u = math.sqrt(u.wx[l] * u.wx[l] + u.wy[l] * u.wy[l] + u.wz[l] * u.wz[l])
        spin_v = math.sqrt(v.wx[l] * v.wx[l] + v.wy[l] * v.wy[l] + v.wz[l] * v.wz[l])
        way = math.sqrt(x * x + y * y + z * z) + u.r[l] * u.turned[l] + v.r[l] * v.turned[l]
        speed = math.sqrt(p * p + q * q + r * r) + u.r[l] * spin_u + v.r[l] * spin_v
        near = way + 2.0 * CHUNK * o.dt[l] * speed > b.gap[l]
        o.loose[l] = 1 if near else o.loose[l]


@strict
def fail_loose(body, lane, watch):
    """Lanes of which joints do not tell everything, or whose state is not finite, have failed."""
    w = watch[0]
    for l in range(w.status.shape[0]):
        sound = lane[0].loose[l] == 0
        for i in range(body.shape[0]):
            u = body[i]
            sound = sound and math.isfinite(u.x[l] + u.y[l] + u.z[l] + u.vx[l] + u.vy[l] + u.vz[l])
            sound = sound and math.isfinite(u.ix[l] + u.kx[l] + u.lx[l] + u.ly[l] + u.lz[l])
        if w.status[l] == RUNNING and not sound:
            w.status[l] = FAILED


@kernel
def look(state):
    """Looks between chunks of steps."""
    body, _, _, _, between, lane, _, _, watch, _ = state
    for i in range(body.shape[0]):
        if body[i].fixed == 0:
            look_at_body(body[i], lane[0])
    for k in range(between.shape[0]):
        b = between[k]
        look_between(b, body[b.lower], body[b.upper], lane[0])
    fail_loose(body, lane, watch)


@strict
def spring_energy_of(e, l):
    """Energy that the friction springs of a joint hold [J]."""
    core = row(e.s, l), e.st[l], e.kc[l], e.jc[l]
    shear, torsion = stored(core, (row(e.fs, l), e.ft[l], e.kf[l], e.jf[l]))
    return shear + torsion


@strict
def base_now(f, l):
    """Acceleration of the base of a lane at t_n [m/s²]."""
    place, last, factor = f.step[l] * f.ratio[l], f.last[l], f.factor[l]
    x = factor * sample(f.x[l], last, place, BEFORE) if f.x[l] != 0 else 0.0
    y = factor * sample(f.y[l], last, place, BEFORE) if f.y[l] != 0 else 0.0
    z = factor * sample(f.z[l], last, place, BEFORE) if f.z[l] != 0 else 0.0
    return x, y, z


@strict
def energies(state, which, out):
    """Ledger at t_n: input, kinetic, gravitational, elastic, friction, viscous [J], of those lanes, shape (6, lanes).

    The middle three are absolute. The memory of the state is brought there.
    """
    forces(state)
    body, joint, _, _, _, lane, _, feed, _, _ = state
    o = lane[0]
    for l in range(o.dt.shape[0]):
        if not which[l]:
            continue
        elastic = spring_energy = kinetic = height = 0.0
        for q in range(joint.shape[0]):
            elastic += joint[q].en[l]
            spring_energy += spring_energy_of(joint[q], l)
        half = 0.5 * o.last[l]
        g = o.g[0, l], o.g[1, l], o.g[2, l]
        push = along(base_now(feed[0], l), 1.0, g)
        for i in range(body.shape[0]):
            u = body[i]
            if u.fixed != 0:
                continue
            v = along((u.vx[l], u.vy[l], u.vz[l]), half, along(scaled(u.im[l], row(u.f, l)), -1.0, push))
            k = along((u.lx[l], u.ly[l], u.lz[l]), half, row(u.mo, l))
            kinetic += 0.5 * (u.m[l] * dot(v, v) + twice_kinetic(u, l, k[0], k[1], k[2]))
            height += u.m[l] * dot(g, (u.x[l], u.y[l], u.z[l]))
        out[0, l], out[1, l], out[2, l] = o.work[l], kinetic, height
        out[3, l], out[4, l], out[5, l] = elastic + spring_energy, o.shear[l] - spring_energy, o.visc[l]


@kernel
def gap(s, u, t, v, vertex, simplex):
    """By how much two shapes are surely apart [m], 0 where they meet."""
    if s.kind == GROUND:
        return -reach(t, v, vertex, 1.0, -u.kx[0], -u.ky[0], -u.kz[0]) - dot(place(u), (u.kx[0], u.ky[0], u.kz[0]))
    way = minus(place(v), place(u))
    way = scaled(1.0 / max(length(way), NOTHING), way)
    return parting(s, u, t, v, 1.0, vertex, way[0], way[1], way[2], simplex)[0]


@kernel
def gaps(state, out):
    """Gaps between any two bodies, shapes that a joint holds aside [m], shape (N, N); of a state in ``records.py``."""
    body, shape, vertex, _, _, _, _, _, joint, _, _, _, _, _, _, _, simplex, _ = state
    for a in range(shape.shape[0]):
        s = shape[a]
        for b in range(shape.shape[0]):
            t = shape[b]
            if s.body >= t.body:
                continue
            joined = False
            for q in range(joint.shape[0]):
                joined = joined or (joint[q].a == a and joint[q].b == b) or (joint[q].a == b and joint[q].b == a)
            if not joined:
                between = gap(s, body[s.body], t, body[t.body], vertex, simplex)
                out[s.body, t.body] = min(out[s.body, t.body], between)


@kernel
def look_ahead(state):
    """Nothing is searched before a chunk of steps."""


@kernel
def advance(state, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    run_chunks(fill_ground, look_ahead, forces, move, look, state, chunks)
