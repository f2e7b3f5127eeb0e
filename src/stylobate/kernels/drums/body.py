"""Motion of rigid drums over lanes, whatever the law of their joints: one step of central differences, and its energies.

Legend in ``lanes.py``.
"""

import numpy as np

from ..jit import apart, law, strict
from ..run_codes import LANES
from .contact import turn


@law
def damped_velocity(v, a, dt, half, local):
    """Velocity a step later, and its mean over the step, with damping.

    ``half`` is half a step times the mass-proportional damping. ``local`` is Cundall's local damping, for settling only: a
    share of the unbalanced force, against the velocity.
    """
    a -= local * abs(a) * np.sign(v)
    new = (v * (1.0 - half) + a * dt) / (1.0 + half)
    return new, 0.5 * (v + new)


@apart
def move(drum, joint, lane, ground, k):
    """Motion of all drums from t_n to t_{n+1} under the forces at t_n."""
    o = lane[0]
    g0 = ground[k]
    g1 = ground[k + 1]
    for l in range(LANES):
        o.px[l] = 0.0
        o.pz[l] = 0.0
    for j in range(drum.shape[0] - 1):
        u = drum[j + 1]
        e = joint[j]
        damped = e.dn.shape[0] > 1
        a = joint[j + 1]  # the joint above; behind the topmost joint stands one without force
        for l in range(LANES):
            dt = o.dt[l]
            vx = u.vx[l]
            vz = u.vz[l]
            w = u.w[l]
            ax = (e.fx[l] - a.fx[l]) * u.im[l] - g0.ax[l] - o.gx[l]
            az = (e.fz[l] - a.fz[l]) * u.im[l] - g0.az[l] - o.g[l]
            aw = (e.mu_[l] - a.ml[l]) * u.ii[l]
            m = u.m[l]
            if damped:
                local = o.local[l]
                half = 0.5 * o.alpha[l] * dt
                nx, mx = damped_velocity(vx, ax, dt, half, local)
                nz, mz = damped_velocity(vz, az, dt, half, local)
                nw, mw = damped_velocity(w, aw, dt, half, local)
                o.visc[l] += o.alpha[l] * dt * (m * (mx * mx + mz * mz) + u.i[l] * mw * mw)
            else:
                nx = vx + ax * dt
                nz = vz + az * dt
                nw = w + aw * dt
            u.vx[l] = nx
            u.vz[l] = nz
            u.w[l] = nw
            u.x[l] += nx * dt
            u.z[l] += nz * dt
            u.th[l] += nw * dt
            c, s = turn(u.c[l], u.s[l], nw * dt)
            u.c[l] = c
            u.s[l] = s
            o.px[l] += m * nx
            o.pz[l] += m * nz
    # work of the body force −m a by the trapezoidal rule  # Eq. (D5)
    for l in range(LANES):
        mean_x = 0.5 * (g0.ax[l] + g1.ax[l])
        mean_z = 0.5 * (g0.az[l] + g1.az[l])
        o.work[l] -= (mean_x * o.px[l] + mean_z * o.pz[l]) * o.dt[l]


@strict
def kinetic_and_gravitational(drum, joint, lane, ground, k, dt, l):
    """Kinetic and gravitational energy of one lane at t_n [J], after its ``forces``; velocities as of the whole step."""
    o = lane[0]
    g = ground[k]
    kinetic = 0.0
    height = 0.0
    for j in range(drum.shape[0] - 1):
        u = drum[j + 1]
        e = joint[j]
        a = joint[j + 1]
        vx = u.vx[l] + 0.5 * dt * ((e.fx[l] - a.fx[l]) * u.im[l] - g.ax[l] - o.gx[l])
        vz = u.vz[l] + 0.5 * dt * ((e.fz[l] - a.fz[l]) * u.im[l] - g.az[l] - o.g[l])
        w = u.w[l] + 0.5 * dt * (e.mu_[l] - a.ml[l]) * u.ii[l]
        kinetic += 0.5 * (u.m[l] * (vx * vx + vz * vz) + u.i[l] * w * w)
        height += u.m[l] * (o.g[l] * u.z[l] + o.gx[l] * u.x[l])
    return kinetic, height
