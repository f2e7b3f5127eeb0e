"""Motion of bodies in space: what their contacts add up to, kicks, and drifts that are exact for free bodies.

The axes i, j, k of a body (k the axis of symmetry) turn as exp(dt [L]x / A) · exp(dt (1/C − 1/A) (L·k) [k]x): about its
own axis first, then about its angular momentum. Angles of a step are small: series stand for sines and cosines.
"""

import math

from ..jit import apart, law, strict
from ..shared.friction import stored
from .pose import cross
from .records import ALPHA, LOCAL


@law
def spun(ax, ay, az, bx, by, bz, angle):
    """The first of two axes a, b after a turn by a small angle about the third."""
    square = angle * angle
    c = 1.0 - square * (0.5 - square * (1.0 / 24.0))
    s = angle * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0)))
    return c * ax + s * bx, c * ay + s * by, c * az + s * bz


@law
def turned(ax, ay, az, ux, uy, uz):
    """A vector a after a turn by a small rotation vector u."""
    square = ux * ux + uy * uy + uz * uz
    first = 1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0))
    second = 0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0))
    px, py, pz = uy * az - uz * ay, uz * ax - ux * az, ux * ay - uy * ax
    return (
        ax + first * px + second * (uy * pz - uz * py),
        ay + first * py + second * (uz * px - ux * pz),
        az + first * pz + second * (ux * py - uy * px),
    )


@law
def add_upper(force, moment, f, l):
    """Adds a load to the upper body of its contact."""
    for c in range(3):
        force[c, l] += f.f[c, l]
        moment[c, l] += f.up[c, l]


@law
def add_lower(force, moment, f, l):
    """Adds a load to the lower body of its contact."""
    for c in range(3):
        force[c, l] -= f.f[c, l]
        moment[c, l] += f.lo[c, l]


@law
def gather(force, moment, s, load, touch):
    """Force and moment on a body: the loads of all its contacts, the first two and then the others in their order."""
    lanes = range(force.shape[1])
    for l in lanes:
        for c in range(3):
            force[c, l] = moment[c, l] = 0.0
        add_upper(force, moment, load[s.under], l)
        add_lower(force, moment, load[s.above], l)
    for t in range(s.first, s.first + s.count):
        f = load[touch[t].contact]
        if touch[t].upper != 0:
            for l in lanes:
                add_upper(force, moment, f, l)
        else:
            for l in lanes:
                add_lower(force, moment, f, l)


@law
def two_loads(i, load, span, touch):
    """Two loads that are all that acts on a body, as the upper body of one contact and the lower one of another.

    Of a drum on another one, under a third, they are those of its joints, where they are; of others their sum, and nothing.
    """
    s = span[i]
    total, nothing = load[load.shape[0] - 2], load[load.shape[0] - 1]
    if s.count == 0:
        return load[s.under], load[s.above]
    gather(total.f, total.up, s, load, touch)
    return total, nothing


@law
def twice_kinetic(u, l, lx, ly, lz):
    """Twice the energy of rotation at an angular momentum [J]."""
    li = lx * u.ix[l] + ly * u.iy[l] + lz * u.iz[l]
    lk = lx * u.kx[l] + ly * u.ky[l] + lz * u.kz[l]
    return u.ia[l] * (lx * lx + ly * ly + lz * lz) + u.ib[l] * li * li + u.ic[l] * lk * lk


@law
def omega(u, l, lx, ly, lz):
    """Angular velocity of a body with three different moments [rad/s]."""
    a = u.ib[l] * (lx * u.ix[l] + ly * u.iy[l] + lz * u.iz[l])
    c = u.ic[l] * (lx * u.kx[l] + ly * u.ky[l] + lz * u.kz[l])
    ia = u.ia[l]
    return (
        ia * lx + a * u.ix[l] + c * u.kx[l],
        ia * ly + a * u.iy[l] + c * u.ky[l],
        ia * lz + a * u.iz[l] + c * u.kz[l],
    )


@law
def half_about_i(u, l, lx, ly, lz, time):
    """Turn of a body about its axis i at the share (1/B − 1/A) L·i of its angular velocity.  # Eq. (E20)

    None where B = A: the drift is then exact.
    """
    angle = u.ib[l] * (lx * u.ix[l] + ly * u.iy[l] + lz * u.iz[l]) * time
    kx, ky, kz = spun(u.kx[l], u.ky[l], u.kz[l], -u.jx[l], -u.jy[l], -u.jz[l], angle)
    u.kx[l], u.ky[l], u.kz[l] = kx, ky, kz
    u.jx[l], u.jy[l], u.jz[l] = cross(kx, ky, kz, u.ix[l], u.iy[l], u.iz[l])


@law
def drift(u, e, a, o, sums, g, l):
    """Motion of a body from t_n to t_{n+1} under two loads at t_n, as their upper and their lower body.

    ``sums`` takes what its dampers take out, and its momentum: the lane's own record, or one of the body's own.
    """
    dt = o.dt[l]
    free = o.free[l]
    im, m = u.im[l], u.m[l]
    ax = (e.f[0, l] - a.f[0, l]) * im - g.a[0, l] - o.g[0, l]
    ay = (e.f[1, l] - a.f[1, l]) * im - g.a[1, l] - o.g[1, l]
    az = (e.f[2, l] - a.f[2, l]) * im - g.a[2, l] - o.g[2, l]
    mx, my, mz = e.up[0, l] + a.lo[0, l], e.up[1, l] + a.lo[1, l], e.up[2, l] + a.lo[2, l]
    vx, vy, vz = u.vx[l], u.vy[l], u.vz[l]
    lx, ly, lz = u.lx[l], u.ly[l], u.lz[l]
    if o.damp.shape[0] > 1:
        # local damping (Cundall): a share of the unbalanced force, against the velocity; for settling only
        still, alpha = o.damp[LOCAL, l], o.damp[ALPHA, l]
        size = math.sqrt(ax * ax + ay * ay + az * az) / max(math.sqrt(vx * vx + vy * vy + vz * vz), 1e-30)
        ax, ay, az = ax - still * size * vx, ay - still * size * vy, az - still * size * vz
        size = math.sqrt(mx * mx + my * my + mz * mz) / max(math.sqrt(lx * lx + ly * ly + lz * lz), 1e-30)
        mx, my, mz = mx - still * size * lx, my - still * size * ly, mz - still * size * lz
        half = 0.5 * alpha * dt
        less, each = 1.0 - half, 1.0 / (1.0 + half)
        px, py, pz = vx, vy, vz
        hx, hy, hz = lx, ly, lz
        vx, vy, vz = (vx * less + ax * dt) * each, (vy * less + ay * dt) * each, (vz * less + az * dt) * each
        lx, ly, lz = (lx * less + mx * dt) * each, (ly * less + my * dt) * each, (lz * less + mz * dt) * each
        vy, lx, lz = vy * free, lx * free, lz * free
        px, py, pz = px + vx, py + vy, pz + vz
        hx, hy, hz = hx + lx, hy + ly, hz + lz
        twice = m * (px * px + py * py + pz * pz) + twice_kinetic(u, l, hx, hy, hz)
        sums.visc[l] += 0.25 * alpha * dt * twice
    else:
        vx, vy, vz = vx + ax * dt, (vy + ay * dt) * free, vz + az * dt
        lx, ly, lz = (lx + mx * dt) * free, ly + my * dt, (lz + mz * dt) * free
    u.vx[l], u.vy[l], u.vz[l] = vx, vy, vz
    u.lx[l], u.ly[l], u.lz[l] = lx, ly, lz
    u.x[l] += vx * dt
    u.y[l] += vy * dt
    u.z[l] += vz * dt
    sums.p[0, l] += m * vx
    sums.p[1, l] += m * vy
    sums.p[2, l] += m * vz
    rotate(u, l, lx, ly, lz, dt)


@law
def about_momentum(u, l, lx, ly, lz, dt):
    """Free rotation of a body with A = B over the step; returns the angular velocity about its axis k.  # Eq. (E7)"""
    kx, ky, kz = u.kx[l], u.ky[l], u.kz[l]
    ia = u.ia[l]
    spin = u.ic[l] * (lx * kx + ly * ky + lz * kz)
    ix, iy, iz = spun(u.ix[l], u.iy[l], u.iz[l], u.jx[l], u.jy[l], u.jz[l], spin * dt)
    wx, wy, wz = lx * ia, ly * ia, lz * ia
    ix, iy, iz = turned(ix, iy, iz, wx * dt, wy * dt, wz * dt)
    kx, ky, kz = turned(kx, ky, kz, wx * dt, wy * dt, wz * dt)
    u.ix[l], u.iy[l], u.iz[l] = ix, iy, iz
    u.kx[l], u.ky[l], u.kz[l] = kx, ky, kz
    u.jx[l], u.jy[l], u.jz[l] = cross(kx, ky, kz, ix, iy, iz)
    return spin


@law
def rotate_any(u, l, lx, ly, lz, dt):
    """Free rotation of a body with three different moments over the step.  # Eqs. (E7), (E20)"""
    half_about_i(u, l, lx, ly, lz, 0.5 * dt)
    about_momentum(u, l, lx, ly, lz, dt)
    half_about_i(u, l, lx, ly, lz, 0.5 * dt)
    u.wx[l], u.wy[l], u.wz[l] = omega(u, l, lx, ly, lz)


@law
def rotate(u, l, lx, ly, lz, dt):
    """Free rotation of a body over the step."""
    if u.px.shape[0] > 1:
        rotate_any(u, l, lx, ly, lz, dt)
    else:
        spin = about_momentum(u, l, lx, ly, lz, dt)
        ia = u.ia[l]
        kx, ky, kz = u.kx[l], u.ky[l], u.kz[l]
        u.wx[l], u.wy[l], u.wz[l] = lx * ia + spin * kx, ly * ia + spin * ky, lz * ia + spin * kz


@apart
def drift_in_lanes(u, e, a, o, g):
    """:func:`drift` in all lanes: of records that the compiler is told to be apart, whichever they are."""
    for l in range(u.x.shape[0]):
        drift(u, e, a, o, o, g, l)


@law
def no_momentum(sums, l):
    """Begins the sum of momenta of a step."""
    sums.p[0, l] = sums.p[1, l] = sums.p[2, l] = 0.0


@law
def add_work(o, sums, g, h, l):
    """Adds the work of the body force −m a over a step by the trapezoidal rule.  # Eq. (D5)"""
    power = 0.0
    for c in range(3):
        power += (g.a[c, l] + h.a[c, l]) * sums.p[c, l]
    sums.work[l] -= 0.5 * power * o.dt[l]


@apart
def move_all(body, load, span, touch, lane, ground, k):
    """Motion of all bodies from t_n to t_{n+1} under the loads at t_n."""
    o = lane[0]
    g, h = ground[k], ground[k + 1]
    lanes = range(o.dt.shape[0])
    for l in lanes:
        no_momentum(o, l)
    for i in range(1, body.shape[0]):
        u = body[i]
        e, a = two_loads(i, load, span, touch)
        drift_in_lanes(u, e, a, o, g)
    for l in lanes:
        add_work(o, o, g, h, l)


@apart
def gather_all(body, load, span, touch):
    """Forces and moments of all bodies but the base."""
    for i in range(1, body.shape[0]):
        gather(body[i].f, body[i].mo, span[i], load, touch)


@strict
def kinetic_and_gravitational(body, lane, ground, k, dt, l):
    """Kinetic and gravitational energy of one lane at t_n [J], with the forces there; velocities as of the whole step."""
    o = lane[0]
    g = ground[k]
    kinetic = 0.0
    height = 0.0
    for i in range(1, body.shape[0]):
        u = body[i]
        free = o.free[l]
        half = 0.5 * dt
        vx = u.vx[l] + half * (u.f[0, l] * u.im[l] - g.a[0, l] - o.g[0, l])
        vy = (u.vy[l] + half * (u.f[1, l] * u.im[l] - g.a[1, l] - o.g[1, l])) * free
        vz = u.vz[l] + half * (u.f[2, l] * u.im[l] - g.a[2, l] - o.g[2, l])
        lx = (u.lx[l] + half * u.mo[0, l]) * free
        ly = u.ly[l] + half * u.mo[1, l]
        lz = (u.lz[l] + half * u.mo[2, l]) * free
        kinetic += 0.5 * (u.m[l] * (vx * vx + vy * vy + vz * vz) + twice_kinetic(u, l, lx, ly, lz))
        height += u.m[l] * (o.g[0, l] * u.x[l] + o.g[1, l] * u.y[l] + o.g[2, l] * u.z[l])
    return kinetic, height


@strict
def stored_in_faces(joint, lane, l):
    """Energy that joints between faces hold in one lane by pressure, and by friction [J]."""
    elastic = 0.0
    shear_energy = 0.0
    for q in range(joint.shape[0]):
        e = joint[q]
        elastic += e.en[l]
        if e.s.shape[0] == 3:
            core = (e.s[0, l], e.s[1, l], e.s[2, l]), e.t[l], e.kc[l], e.jc[l]
            shear, torsion = stored(core, ((e.fs[0, l], e.fs[1, l], e.fs[2, l]), e.ft[l], e.kf[l], e.jf[l]))
            shear_energy += shear + lane[0].pivot[l] * torsion
        elif e.kc[l] > 0.0:
            for c in range(e.s.shape[0]):
                shear_energy += 0.5 * e.s[c, l] ** 2 / e.kc[l]
    return elastic, shear_energy
