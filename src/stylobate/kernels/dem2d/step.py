"""Plane distinct elements over lanes: explicit central differences of rigid drums on soft frictional joints.

Records, names and what is looked at between chunks of steps: ``drums/lanes.py``; the law of a contact: ``drums/contact.py``.
"""

from ..drums import contact as ct
from ..drums.body import kinetic_and_gravitational, move
from ..drums.frame import run_chunks
from ..drums.lanes import block_types, check_finite, fill_ground, joint_state, observe, upper_face
from ..jit import apart, kernel, strict
from ..run_codes import LANES

#: The models read these here.
__all__ = ["advance", "block_types", "forces", "joint_state", "ledger"]


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
                at_s, at_q, gap, ns, nq = ct.contact_point(
                    p, points, o.xi[p, l], lo, hi, left_s, left_q, right_s, right_q, c, s, w, w
                )
                vt, vn = ct.contact_velocity(at_s, at_q, ns, nq, ps, pq, ht, vs, vq, wu, wl)
                old = e.fs[p, l]
                fn, fs, dn, ds = ct.point_forces(
                    old, gap, vn, vt, dt, kn * share, ks * share, mu, co * share, o.beta[l], 0.0, damped
                )
                if damped:
                    visc -= 0.5 * dt * ((dn + e.dn[p, l]) * vn + (ds + e.ds[p, l]) * vt)
                    e.dn[p, l] = dn
                    e.ds[p, l] = ds
                e.fs[p, l] = fs
                e.fn[p, l] = fn
                shear -= 0.5 * (old + fs) * vt * dt
                fa, fb, about_upper, about_lower = ct.point_load(fn + dn, fs + ds, ns, nq, at_s, at_q, ps, pq, ht)
                sum_s += fa
                sum_q += fb
                upper += about_upper
                lower += about_lower
            e.fx[l] = cl * sum_s - sl * sum_q
            e.fz[l] = sl * sum_s + cl * sum_q
            e.mu_[l] = upper
            e.ml[l] = lower
            o.shear[l] += shear
            if damped:
                o.visc[l] += visc


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n, after its ``forces``, with velocities brought to the whole step.  # Eq. (D5)

    Writes input, kinetic, gravitational (absolute), elastic (absolute), friction, viscous [J].
    ``dt`` is the step of the lane (its own is 0 once it stands still), ``k`` the row of ``ground`` that holds t_n.
    """
    o = lane[0]
    kinetic, height = kinetic_and_gravitational(drum, joint, lane, ground, k, dt, l)
    elastic = 0.0
    stored = 0.0
    for j in range(drum.shape[0] - 1):
        e = joint[j]
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
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, None, forces, move, check_finite, observe, state, chunks)
