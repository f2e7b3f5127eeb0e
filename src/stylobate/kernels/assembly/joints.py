"""Joints of an assembly: the law of the column's joints, in any direction, which hands over to the bed.

Legend in ``step.py``.
"""

from ..drums import contact as ct
from ..jit import kernel, law

#: A joint acts alone as long as the overlap is more than this share of the smaller face, the bed alone below the second.
OVERLAP_FROM, OVERLAP_TO = 0.05, 0.01


@law
def handover(c, over, e):
    """Weight of the joint's law: 1 while it acts alone, 0 when the bed does, linear in cosine and overlap between."""
    turned = (c - e.to_c) / (e.from_c - e.to_c)
    left = (over - OVERLAP_TO * e.width) / ((OVERLAP_FROM - OVERLAP_TO) * e.width)
    return min(max(min(turned, left), 0.0), 1.0)


@law
def face(b, c, s):
    """Cosine and sine of the direction of a face, given in the frame of its body."""
    return b.c * c - b.s * s, b.s * c + b.c * s


@kernel
def joint_forces(body, joint, now):
    """Forces of all joints at t_n; brings their contact memory from t_{n−1} to t_n (as ``forces`` of the lanes)."""
    o = now[0]
    dt = o.last
    beta = o.beta
    damped = beta > 0.0 or o.dull > 0.0
    for i in range(body.shape[0]):
        body[i].fx = 0.0
        body[i].fz = 0.0
        body[i].mo = 0.0
    for j in range(joint.shape[0]):
        e = joint[j]
        if e.live == 0:
            continue
        points = e.fs.shape[0]
        u = body[e.upper]
        v = body[e.lower]
        wl = v.w
        wu = u.w
        ht = e.ht
        cl, sl = face(v, e.lc, e.ls)
        cu, su = face(u, e.uc, e.us)
        ps, pq, c, s = ct.relative_pose(u.x, u.z, cu, su, v.x, v.z, cl, sl, ht)
        left_s, left_q, right_s, right_q = ct.face_corners(ps, pq, c, s, e.bl, e.br, e.hb)
        lo = max(left_s, -e.wl)
        hi = min(right_s, e.wr)
        over = max(hi - lo, 0.0)
        e.over = over
        weight = handover(c, over, e)
        e.weight = weight
        if weight == 0.0:
            e.live = 0
            # what the springs still hold is lost with them
            for p in range(points):
                e.fs[p] = 0.0
                e.fn[p] = 0.0
                e.dn[p] = 0.0
                e.ds[p] = 0.0
            continue
        dvx = u.vx - v.vx
        dvz = u.vz - v.vz
        vs = cl * dvx + sl * dvz
        vq = cl * dvz - sl * dvx
        kn = e.kn * over
        ks = e.ks * over
        co = e.co * over
        mu = e.mu
        sum_s = 0.0
        sum_q = 0.0
        upper = 0.0
        lower = 0.0
        shear = 0.0
        visc = 0.0
        for p in range(points):
            share = o.sh[p]
            at_s, at_q, gap, ns, nq = ct.contact_point(
                p, points, o.xi[p], lo, hi, left_s, left_q, right_s, right_q, c, s, e.wl, e.wr
            )
            vt, vn = ct.contact_velocity(at_s, at_q, ns, nq, ps, pq, ht, vs, vq, wu, wl)
            old = e.fs[p]
            give = ct.restitution_share(o.dull, o.calm, vn)
            fn, fs, dn, ds = ct.point_forces(
                old, gap, vn, vt, dt, kn * share, ks * share, mu, co * share, beta, give, damped
            )
            if damped:
                visc -= 0.5 * dt * ((dn + e.dn[p]) * vn + (ds + e.ds[p]) * vt)
                e.dn[p] = dn
                e.ds[p] = ds
            e.fs[p] = fs
            e.fn[p] = fn
            shear -= 0.5 * (old + fs) * vt * dt
            fa, fb, about_upper, about_lower = ct.point_load(fn + dn, fs + ds, ns, nq, at_s, at_q, ps, pq, ht)
            sum_s += fa
            sum_q += fb
            upper += about_upper
            lower += about_lower
        if weight < 1.0:
            sum_s *= weight
            sum_q *= weight
            upper *= weight
            lower *= weight
            shear *= weight
            visc *= weight
        fx = cl * sum_s - sl * sum_q
        fz = sl * sum_s + cl * sum_q
        u.fx += fx
        u.fz += fz
        u.mo += upper
        v.fx -= fx
        v.fz -= fz
        v.mo -= lower
        o.shear += shear
        o.visc += visc
