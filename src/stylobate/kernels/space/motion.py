"""Motion of bodies in space, each alone: kicks by what acts on it, and drifts that are exact for what is free."""

import math

from ..dem3d.look import straighten
from ..dem3d.move import omega, rotate_any, twice_kinetic
from ..jit import kernel, law, strict
from ..run_codes import FAILED
from ..shared.vectors import along, dot, length, of, put, scaled


@law
def carried_on(u, l, v, momentum, dt):
    """Drift of a body over a step with a velocity and an angular momentum."""
    u.vx[l], u.vy[l], u.vz[l] = v
    u.lx[l], u.ly[l], u.lz[l] = momentum
    u.x[l] += v[0] * dt
    u.y[l] += v[1] * dt
    u.z[l] += v[2] * dt
    rotate_any(u, l, momentum[0], momentum[1], momentum[2], dt)


@kernel
def move(body, now, a, b, dt):
    """Motion of all bodies over the next step ``dt``, with the ground's acceleration at its two ends.

    Returns the longest way since the pairs were listed.
    """
    kick = 0.5 * (now.last + dt)
    now.earlier = now.last
    now.last = dt
    g = of(now.g)
    base = a[0] + g[0], a[1] + g[1], a[2] + g[2]
    px = py = pz = 0.0
    farthest = 0.0
    for i in range(body.shape[0]):
        u = body[i]
        if u.fixed != 0:
            continue
        v = u.vx[0], u.vy[0], u.vz[0]
        l = u.lx[0], u.ly[0], u.lz[0]
        f = along(scaled(u.im[0], of(u.f)), -1.0, base)
        m = of(u.mo)
        if u.local > 0.0:
            # local damping (Cundall): a share of the unbalanced force, against the velocity
            w = omega(u, 0, l[0], l[1], l[2])
            drag, brake = u.local * length(f), u.local * length(m)
            now.visc += kick * (u.m[0] * drag * length(v) + brake * dot(w, l) / max(length(l), 1e-30))
            f = along(f, -drag / max(length(v), 1e-30), v)
            m = along(m, -brake / max(length(l), 1e-30), l)
        v = along(v, kick, f)
        l = along(l, kick, m)
        put(u.past, omega(u, 0, l[0], l[1], l[2]))
        carried_on(u, 0, v, l, dt)
        px += u.m[0] * v[0]
        py += u.m[0] * v[1]
        pz += u.m[0] * v[2]
        u.travel += (length(v) + u.r * length((u.wx[0], u.wy[0], u.wz[0]))) * dt
        farthest = max(farthest, u.travel)
    now.work -= 0.5 * ((a[0] + b[0]) * px + (a[1] + b[1]) * py + (a[2] + b[2]) * pz) * dt
    return farthest


@strict
def check(body, now):
    """Give the axes of all bodies their right angles back; a state that is not finite has failed."""
    for i in range(body.shape[0]):
        u = body[i]
        straighten(u, 0)
        total = u.x[0] + u.y[0] + u.z[0] + u.vx[0] + u.vy[0] + u.vz[0] + u.ix[0] + u.kx[0] + u.lx[0] + u.ly[0] + u.lz[0]
        if not math.isfinite(total):
            now.status = FAILED


@strict
def kinetic_and_gravitational(body, now, a):
    """Kinetic and gravitational energy at t_n [J], with the forces there; velocities brought to the whole step."""
    half = 0.5 * now.last
    g = of(now.g)
    base = a[0] + g[0], a[1] + g[1], a[2] + g[2]
    kinetic = 0.0
    height = 0.0
    for i in range(body.shape[0]):
        u = body[i]
        if u.fixed != 0:
            continue
        v = along((u.vx[0], u.vy[0], u.vz[0]), half, along(scaled(u.im[0], of(u.f)), -1.0, base))
        l = along((u.lx[0], u.ly[0], u.lz[0]), half, of(u.mo))
        kinetic += 0.5 * (u.m[0] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + twice_kinetic(u, 0, l[0], l[1], l[2]))
        height += u.m[0] * (g[0] * u.x[0] + g[1] * u.y[0] + g[2] * u.z[0])
    return kinetic, height
