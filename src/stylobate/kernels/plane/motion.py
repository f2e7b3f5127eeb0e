"""Motion of rigid bodies in the plane: what their contacts add up to, one step of central differences, and its energies.

Records: ``records.py``.
"""

from ..jit import apart, law, strict
from .contact import turn
from .records import ALPHA, LOCAL


@law
def damped_velocity(v, a, dt, half, local):
    """Velocity a step later, and its mean over the step, with damping.

    ``half`` is half a step times the mass-proportional damping. ``local`` is Cundall's local damping, for settling only: a
    share of the unbalanced force, against the velocity.
    """
    a -= local * abs(a) * (1.0 if v > 0.0 else (-1.0 if v < 0.0 else 0.0))
    new = (v * (1.0 - half) + a * dt) / (1.0 + half)
    return new, 0.5 * (v + new)


@law
def gather_others(u, s, load, touch):
    """Force and moment of a body by its contacts but the first two, in the order of its list."""
    for l in range(u.x.shape[0]):
        u.fx[l] = u.fz[l] = u.mo[l] = 0.0
    for t in range(s.first, s.first + s.count):
        f = load[touch[t].contact]
        if touch[t].upper != 0:
            for l in range(u.x.shape[0]):
                u.fx[l] += f.fx[l]
                u.fz[l] += f.fz[l]
                u.mo[l] += f.mu_[l]
        else:
            for l in range(u.x.shape[0]):
                u.fx[l] -= f.fx[l]
                u.fz[l] -= f.fz[l]
                u.mo[l] -= f.ml[l]


@apart
def gather(body, load, span, touch):
    """Forces and moments of all bodies that can move."""
    for i in range(body.shape[0]):
        s = span[i]
        if s.fixed != 0:
            continue
        u = body[i]
        e = load[s.under]
        a = load[s.above]
        gather_others(u, s, load, touch)
        for l in range(u.x.shape[0]):
            u.fx[l] = e.fx[l] - a.fx[l] + u.fx[l]
            u.fz[l] = e.fz[l] - a.fz[l] + u.fz[l]
            u.mo[l] = e.mu_[l] - a.ml[l] + u.mo[l]


@law
def drift(u, o, sums, l, fx, fz, mo, gx, gz, kick, dt, damped):
    """Motion of a body under a force and a moment: velocities over a time ``kick``, positions over a step ``dt``.

    ``sums`` takes what its dampers take out, and its momentum: the lane's own record, or one of the body's own.
    """
    vx = u.vx[l]
    vz = u.vz[l]
    w = u.w[l]
    ax = fx * u.im[l] - gx - o.gx[l]
    az = fz * u.im[l] - gz - o.g[l]
    aw = mo * u.ii[l]
    m = u.m[l]
    if damped:
        local = o.damp[LOCAL, l]
        alpha = o.damp[ALPHA, l]
        half = 0.5 * alpha * kick
        nx, mx = damped_velocity(vx, ax, kick, half, local)
        nz, mz = damped_velocity(vz, az, kick, half, local)
        nw, mw = damped_velocity(w, aw, kick, half, local)
        sums.visc[l] += alpha * kick * (m * (mx * mx + mz * mz) + u.i[l] * mw * mw)
    else:
        nx = vx + ax * kick
        nz = vz + az * kick
        nw = w + aw * kick
    u.vx[l] = nx
    u.vz[l] = nz
    u.w[l] = nw
    u.x[l] += nx * dt
    u.z[l] += nz * dt
    u.th[l] += nw * dt
    c, s = turn(u.c[l], u.s[l], nw * dt)
    u.c[l] = c
    u.s[l] = s
    sums.px[l] += m * nx
    sums.pz[l] += m * nz


@law
def no_momentum(sums, l):
    """Begins the sum of momenta of a step."""
    sums.px[l] = 0.0
    sums.pz[l] = 0.0


@law
def move_between(u, e, a, o, sums, g, l):
    """Motion of a body with two contacts from t_n to t_{n+1}: in ``e`` it is the upper one, in ``a`` the lower one."""
    fx, fz, mo = e.fx[l] - a.fx[l], e.fz[l] - a.fz[l], e.mu_[l] - a.ml[l]
    drift(u, o, sums, l, fx, fz, mo, g.ax[l], g.az[l], o.dt[l], o.dt[l], o.damp.shape[0] > 1)


@law
def add_work(o, sums, g0, g1, l):
    """Adds the work of the body force −m a over a step by the trapezoidal rule.  # Eq. (D5)"""
    mean_x = 0.5 * (g0.ax[l] + g1.ax[l])
    mean_z = 0.5 * (g0.az[l] + g1.az[l])
    sums.work[l] -= (mean_x * sums.px[l] + mean_z * sums.pz[l]) * o.dt[l]


@apart
def move(body, load, span, touch, lane, ground, k):
    """Motion of all bodies from t_n to t_{n+1} under the forces at t_n, as :func:`gather` adds them up."""
    o = lane[0]
    g0 = ground[k]
    g1 = ground[k + 1]
    damped = o.damp.shape[0] > 1
    for l in range(o.dt.shape[0]):
        no_momentum(o, l)
    for i in range(body.shape[0]):
        s = span[i]
        if s.fixed != 0:
            continue
        u = body[i]
        e = load[s.under]
        a = load[s.above]
        if s.count == 0:
            for l in range(o.dt.shape[0]):
                move_between(u, e, a, o, o, g0, l)
        else:
            gather_others(u, s, load, touch)
            for l in range(o.dt.shape[0]):
                fx, fz = e.fx[l] - a.fx[l] + u.fx[l], e.fz[l] - a.fz[l] + u.fz[l]
                mo = e.mu_[l] - a.ml[l] + u.mo[l]
                drift(u, o, o, l, fx, fz, mo, g0.ax[l], g0.az[l], o.dt[l], o.dt[l], damped)
    for l in range(o.dt.shape[0]):
        add_work(o, o, g0, g1, l)


@strict
def kinetic_and_gravitational(body, span, lane, gx, gz, dt, l):
    """Kinetic and gravitational energy of one lane at t_n [J], with the forces there; velocities as of the whole step."""
    o = lane[0]
    kinetic = 0.0
    height = 0.0
    for i in range(body.shape[0]):
        if span[i].fixed != 0:
            continue
        u = body[i]
        vx = u.vx[l] + 0.5 * dt * (u.fx[l] * u.im[l] - gx - o.gx[l])
        vz = u.vz[l] + 0.5 * dt * (u.fz[l] * u.im[l] - gz - o.g[l])
        w = u.w[l] + 0.5 * dt * u.mo[l] * u.ii[l]
        kinetic += 0.5 * (u.m[l] * (vx * vx + vz * vz) + u.i[l] * w * w)
        height += u.m[l] * (o.g[l] * u.z[l] + o.gx[l] * u.x[l])
    return kinetic, height
