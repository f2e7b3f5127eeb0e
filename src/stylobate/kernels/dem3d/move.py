"""Motion of drums in space under the forces of their joints: kicks, and drifts that are exact for free bodies."""

import math

from ..jit import apart, law, strict
from ..run_codes import LANES
from .pose import cross
from .turning import spun, turned


@law
def net(e, a, l, c):
    """Component c of the force of the joint under a drum and of the one above it."""
    return e.f[c, l] - a.f[c, l]


@law
def turning_moment(e, a, l, c):
    """Component c of the moments of the joint under a drum and of the one above it."""
    return e.up[c, l] + a.lo[c, l]


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


@apart
def move(drum, joint, lane, ground, k):
    """Motion of all drums from t_n to t_{n+1} under the forces at t_n."""
    o = lane[0]
    g = ground[k]
    for l in range(LANES):
        o.p[0, l] = 0.0
        o.p[1, l] = 0.0
        o.p[2, l] = 0.0
    for q in range(drum.shape[0] - 1):
        u = drum[q + 1]
        e = joint[q]
        damped = e.d.shape[0] > 1
        a = joint[q + 1]  # the joint above; behind the topmost joint stands one without force
        for l in range(LANES):
            dt = o.dt[l]
            free = o.free[l]
            im, m = u.im[l], u.m[l]
            ax = net(e, a, l, 0) * im - g.a[0, l] - o.g[0, l]
            ay = net(e, a, l, 1) * im - g.a[1, l] - o.g[1, l]
            az = net(e, a, l, 2) * im - g.a[2, l] - o.g[2, l]
            mx, my, mz = turning_moment(e, a, l, 0), turning_moment(e, a, l, 1), turning_moment(e, a, l, 2)
            vx, vy, vz = u.vx[l], u.vy[l], u.vz[l]
            lx, ly, lz = u.lx[l], u.ly[l], u.lz[l]
            if damped:
                # local damping (Cundall): a share of the unbalanced force, against the velocity; for settling only
                still = o.local[l]
                size = math.sqrt(ax * ax + ay * ay + az * az) / max(math.sqrt(vx * vx + vy * vy + vz * vz), 1e-30)
                ax, ay, az = ax - still * size * vx, ay - still * size * vy, az - still * size * vz
                size = math.sqrt(mx * mx + my * my + mz * mz) / max(math.sqrt(lx * lx + ly * ly + lz * lz), 1e-30)
                mx, my, mz = mx - still * size * lx, my - still * size * ly, mz - still * size * lz
                half = 0.5 * o.alpha[l] * dt
                less, each = 1.0 - half, 1.0 / (1.0 + half)
                px, py, pz = vx, vy, vz
                hx, hy, hz = lx, ly, lz
                vx, vy, vz = (vx * less + ax * dt) * each, (vy * less + ay * dt) * each, (vz * less + az * dt) * each
                lx, ly, lz = (lx * less + mx * dt) * each, (ly * less + my * dt) * each, (lz * less + mz * dt) * each
                vy, lx, lz = vy * free, lx * free, lz * free
                px, py, pz = px + vx, py + vy, pz + vz
                hx, hy, hz = hx + lx, hy + ly, hz + lz
                twice = m * (px * px + py * py + pz * pz) + twice_kinetic(u, l, hx, hy, hz)
                o.visc[l] += 0.25 * o.alpha[l] * dt * twice
            else:
                vx, vy, vz = vx + ax * dt, (vy + ay * dt) * free, vz + az * dt
                lx, ly, lz = (lx + mx * dt) * free, ly + my * dt, (lz + mz * dt) * free
            u.vx[l], u.vy[l], u.vz[l] = vx, vy, vz
            u.lx[l], u.ly[l], u.lz[l] = lx, ly, lz
            u.x[l] += vx * dt
            u.y[l] += vy * dt
            u.z[l] += vz * dt
            o.p[0, l] += m * vx
            o.p[1, l] += m * vy
            o.p[2, l] += m * vz
            # free rotation over the step  # Eq. (E7)
            if u.px.shape[0] > 1:
                half_about_i(u, l, lx, ly, lz, 0.5 * dt)
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
            if u.px.shape[0] > 1:
                half_about_i(u, l, lx, ly, lz, 0.5 * dt)
                wx, wy, wz = omega(u, l, lx, ly, lz)
                u.wx[l], u.wy[l], u.wz[l] = wx, wy, wz
            else:
                u.wx[l], u.wy[l], u.wz[l] = wx + spin * kx, wy + spin * ky, wz + spin * kz
    # work of the body force −m a by the trapezoidal rule  # Eq. (D5)
    h = ground[k + 1]
    for l in range(LANES):
        power = 0.0
        for c in range(3):
            power += (g.a[c, l] + h.a[c, l]) * o.p[c, l]
        o.work[l] -= 0.5 * power * o.dt[l]


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n, after its ``forces``, with velocities brought to the whole step.  # Eq. (D5)

    Writes input, kinetic, gravitational (absolute), elastic (absolute), friction, viscous [J].
    ``dt`` is the step of the lane (its own is 0 once it stands still), ``k`` the row of ``ground`` that holds t_n.
    """
    o = lane[0]
    g = ground[k]
    kinetic = 0.0
    height = 0.0
    elastic = 0.0
    stored = 0.0
    for q in range(drum.shape[0] - 1):
        u = drum[q + 1]
        e = joint[q]
        a = joint[q + 1]
        free = o.free[l]
        half = 0.5 * dt
        vx = u.vx[l] + half * (net(e, a, l, 0) * u.im[l] - g.a[0, l] - o.g[0, l])
        vy = (u.vy[l] + half * (net(e, a, l, 1) * u.im[l] - g.a[1, l] - o.g[1, l])) * free
        vz = u.vz[l] + half * (net(e, a, l, 2) * u.im[l] - g.a[2, l] - o.g[2, l])
        lx = (u.lx[l] + half * turning_moment(e, a, l, 0)) * free
        ly = u.ly[l] + half * turning_moment(e, a, l, 1)
        lz = (u.lz[l] + half * turning_moment(e, a, l, 2)) * free
        kinetic += 0.5 * (u.m[l] * (vx * vx + vy * vy + vz * vz) + twice_kinetic(u, l, lx, ly, lz))
        height += u.m[l] * (o.g[0, l] * u.x[l] + o.g[1, l] * u.y[l] + o.g[2, l] * u.z[l])
        elastic += e.en[l]
        if e.kf[l] > 0.0:
            for c in range(e.s.shape[0]):
                stored += 0.5 * e.s[c, l] ** 2 / e.kf[l]
        if e.kt[l] > 0.0:
            stored += 0.5 * e.t[l] ** 2 / e.kt[l]
    out[0] = o.work[l]
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + stored
    out[4] = o.shear[l] - stored
    out[5] = o.visc[l]
