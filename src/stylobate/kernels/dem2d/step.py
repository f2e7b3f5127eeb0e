"""Plane distinct elements over lanes: explicit central differences of rigid drums on soft frictional joints.

Records, names and what is looked at between chunks of steps: ``drums/lanes.py``; the law of a contact: ``drums/contact.py``.
"""

import numpy as np

from ..drums import contact as ct
from ..drums.lanes import (
    CHUNK,
    COLLAPSED,
    ENDED,
    FAILED,
    FREE,
    LANES,
    RUNNING,
    block_types,
    close_chunk,
    fill_ground,
    joint_state,
    running_lanes,
    upper_face,
)
from ..jit import apart, kernel, law, strict

#: The models read these here.
__all__ = ["CHUNK", "COLLAPSED", "ENDED", "FAILED", "FREE", "LANES", "RUNNING", "block_types", "joint_state"]


@law
def contact_point(p, points, xi, lo, hi, sl, ql, sr, qr, c, s, w):
    """Contact point p of a joint: the ends of the overlap first and last, the others between them."""
    if p == 0:
        return ct.left_contact(sl, ql, c, s, w)
    if p == points - 1:
        return ct.right_contact(sr, qr, c, s, w)
    return ct.inner_contact(xi, lo, hi, sl, ql, c, s)


@apart
def forces(drum, joint, lane):
    """Forces of all joints at t_n; brings the contact memory from t_{n−1} to t_n."""
    o = lane[0]
    for j in range(drum.shape[0] - 1):
        u = drum[j + 1]
        v = drum[j]
        e = joint[j]
        points = e.fs.shape[0]
        damped = e.dn.shape[0] > 1
        for l in range(LANES):
            dt = o.dt[l]
            ht = v.ht[l]
            w = v.t[l]
            wl = v.w[l]
            wu = u.w[l]
            cl, sl = upper_face(v, l)
            ps, pq, c, s = ct.relative_pose(u.x[l], u.z[l], u.c[l], u.s[l], v.x[l], v.z[l], cl, sl, ht)
            left_s, left_q, right_s, right_q = ct.face_corners(ps, pq, c, s, u.bl[l], u.br[l], u.hb[l])
            lo = max(left_s, -w)
            hi = min(right_s, w)
            over = max(hi - lo, 0.0)
            e.over[l] = over
            dvx = u.vx[l] - v.vx[l]
            dvz = u.vz[l] - v.vz[l]
            vs = cl * dvx + sl * dvz
            vq = cl * dvz - sl * dvx
            kn = e.kn[l] * over
            ks = e.ks[l] * over
            co = e.co[l] * over
            mu = e.mu[l]
            sum_s = 0.0
            sum_q = 0.0
            upper = 0.0
            lower = 0.0
            shear = 0.0
            visc = 0.0
            for p in range(points):
                share = o.sh[p, l]
                at_s, at_q, gap, ns, nq = contact_point(
                    p, points, o.xi[p, l], lo, hi, left_s, left_q, right_s, right_q, c, s, w
                )
                vt, vn = ct.contact_velocity(at_s, at_q, ns, nq, ps, pq, ht, vs, vq, wu, wl)
                ka = kn * share
                ksa = ks * share
                old = e.fs[p, l]
                fn = ct.normal_force(ka, gap)
                cohesion = co * share if fn > 0.0 else 0.0
                if damped:
                    # dashpots parallel to the springs: no tension in sum, no friction above Coulomb's in sum
                    beta = o.beta[l]
                    dn = max(-beta * ka * vn, -fn) if fn > 0.0 else 0.0
                    limit = mu * (fn + dn) + cohesion
                    fs = ct.shear_force(old, ksa, vt * dt, limit)
                    ds = min(max(-beta * ksa * vt, -limit - fs), limit - fs)
                    visc -= 0.5 * dt * ((dn + e.dn[p, l]) * vn + (ds + e.ds[p, l]) * vt)
                    e.dn[p, l] = dn
                    e.ds[p, l] = ds
                    fn_all = fn + dn
                    fs_all = fs + ds
                else:
                    fs = ct.shear_force(old, ksa, vt * dt, mu * fn + cohesion)
                    fn_all = fn
                    fs_all = fs
                e.fs[p, l] = fs
                e.fn[p, l] = fn
                shear -= 0.5 * (old + fs) * vt * dt
                fa = fn_all * ns + fs_all * nq
                fb = fn_all * nq - fs_all * ns
                sum_s += fa
                sum_q += fb
                upper += (at_s - ps) * fb - (at_q - pq) * fa
                lower += at_s * fb - (at_q + ht) * fa
            e.fx[l] = cl * sum_s - sl * sum_q
            e.fz[l] = sl * sum_s + cl * sum_q
            e.mu_[l] = upper
            e.ml[l] = lower
            o.shear[l] += shear
            if damped:
                o.visc[l] += visc


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
                # local damping (Cundall): a share of the unbalanced force, against the velocity; for settling only
                local = o.local[l]
                ax -= local * abs(ax) * np.sign(vx)
                az -= local * abs(az) * np.sign(vz)
                aw -= local * abs(aw) * np.sign(w)
                half = 0.5 * o.alpha[l] * dt
                nx = (vx * (1.0 - half) + ax * dt) / (1.0 + half)
                nz = (vz * (1.0 - half) + az * dt) / (1.0 + half)
                nw = (w * (1.0 - half) + aw * dt) / (1.0 + half)
                mx = 0.5 * (vx + nx)
                mz = 0.5 * (vz + nz)
                mw = 0.5 * (w + nw)
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
            c, s = ct.turn(u.c[l], u.s[l], nw * dt)
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
    for j in range(drum.shape[0] - 1):
        u = drum[j + 1]
        e = joint[j]
        a = joint[j + 1]
        vx = u.vx[l] + 0.5 * dt * ((e.fx[l] - a.fx[l]) * u.im[l] - g.ax[l] - o.gx[l])
        vz = u.vz[l] + 0.5 * dt * ((e.fz[l] - a.fz[l]) * u.im[l] - g.az[l] - o.g[l])
        w = u.w[l] + 0.5 * dt * (e.mu_[l] - a.ml[l]) * u.ii[l]
        kinetic += 0.5 * (u.m[l] * (vx * vx + vz * vz) + u.i[l] * w * w)
        height += u.m[l] * (o.g[l] * u.z[l] + o.gx[l] * u.x[l])
        for p in range(e.fs.shape[0]):
            area = e.over[l] * o.sh[p, l]
            if area > 0.0 and e.kn[l] > 0.0:
                elastic += 0.5 * e.fn[p, l] ** 2 / (e.kn[l] * area)
                stored += 0.5 * e.fs[p, l] ** 2 / (e.ks[l] * area)
    out[0] = o.work[l]
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + stored
    out[4] = o.shear[l] - stored
    out[5] = o.visc[l]


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes by up to ``chunks`` × CHUNK steps; returns as soon as the run in some lane is over."""
    before = running_lanes(watch)
    for _ in range(chunks):
        if before == 0 or running_lanes(watch) < before:
            break
        fill_ground(ground, feed, watch)
        for k in range(CHUNK):
            forces(drum, joint, lane)
            move(drum, joint, lane, ground, k)
        close_chunk(drum, joint, lane, feed, watch)
