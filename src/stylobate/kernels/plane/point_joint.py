"""A joint with contact points, in one lane: where its faces touch, and what its points do.

Records: ``records.py``; law of a point: ``contact.py``.
"""

from ..jit import apart, law
from . import contact as ct
from .records import BETA


@law
def face(b, l, c, s):
    """Cosine and sine of the direction of a face, given in the axes of its body."""
    return b.c[l] * c - b.s[l] * s, b.s[l] * c + b.c[l] * s


@law
def upper_face(u, e, l):
    """Cosine and sine of the direction of the upper face of a joint."""
    if e.turned.shape[0] > 1:
        return face(u, l, e.turned[0, l], e.turned[1, l])
    return u.c[l], u.s[l]


@law
def meeting(u, v, e, l):
    """Faces of a joint to one another: direction of the lower one; centroid, cosine and sine of the upper body;
    corners of its face; ends of the overlap, and its length.
    """
    ht = e.ht[l]
    cl, sl = face(v, l, e.lc[l], e.ls[l])
    cu, su = upper_face(u, e, l)
    ps, pq, c, s = ct.relative_pose(u.x[l], u.z[l], cu, su, v.x[l], v.z[l], cl, sl, ht)
    left_s, left_q, right_s, right_q = ct.face_corners(ps, pq, c, s, e.bl[l], e.br[l], e.hb[l])
    lo = max(left_s, -e.wl[l])
    hi = min(right_s, e.wr[l])
    return cl, sl, ps, pq, c, s, left_s, left_q, right_s, right_q, lo, hi, max(hi - lo, 0.0)


@law
def press(u, v, e, o, l, damped, dull, calm, dt, at):
    """Forces of all points of a joint at t_n, in the frame of the lower face: sums along and across it, moments on the upper
    and the lower body, work of the shear springs reversed, work of the dashpots.

    Brings the memory of the points from t_{n−1} to t_n. ``at`` is what :func:`meeting` gives, ``dull`` and ``calm`` what
    :func:`contact.restitution_share` takes.
    """
    cl, sl, ps, pq, c, s, left_s, left_q, right_s, right_q, lo, hi, over = at
    ht = e.ht[l]
    wl = v.w[l]
    wu = u.w[l]
    e.over[l] = over
    dvx = u.vx[l] - v.vx[l]
    dvz = u.vz[l] - v.vz[l]
    vs = cl * dvx + sl * dvz
    vq = cl * dvz - sl * dvx
    kn = e.kn[l] * over
    ks = e.ks[l] * over
    co = e.co[l] * over
    mu = e.mu[l]
    beta = o.damp[BETA, l]
    sum_s = 0.0
    sum_q = 0.0
    upper = 0.0
    lower = 0.0
    shear = 0.0
    visc = 0.0
    points = e.fs.shape[0]
    for p in range(points):
        share = o.sh[p, l]
        at_s, at_q, gap, ns, nq = ct.contact_point(
            p, points, o.xi[p, l], lo, hi, left_s, left_q, right_s, right_q, c, s, e.wl[l], e.wr[l]
        )
        vt, vn = ct.contact_velocity(at_s, at_q, ns, nq, ps, pq, ht, vs, vq, wu, wl)
        old = e.fs[p, l]
        give = ct.restitution_share(dull, calm, vn)
        fn, fs, dn, ds = ct.point_forces(
            old, gap, vn, vt, dt, kn * share, ks * share, mu, co * share, beta, give, damped
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
    return sum_s, sum_q, upper, lower, shear, visc


@law
def put(f, l, cl, sl, sum_s, sum_q, upper, lower):
    """Writes the load of a joint, from the frame of the lower face."""
    f.fx[l] = cl * sum_s - sl * sum_q
    f.fz[l] = sl * sum_s + cl * sum_q
    f.mu_[l] = upper
    f.ml[l] = lower


@law
def joint_force(u, v, e, f, o, sums, l):
    """Force of one joint at t_n in one lane; brings its memory from t_{n−1} to t_n.

    ``sums`` takes the work of its springs and dashpots: the lane's own record, or one in which each joint adds for itself.
    """
    damped = e.dn.shape[0] > 1
    at = meeting(u, v, e, l)
    sum_s, sum_q, upper, lower, shear, visc = press(u, v, e, o, l, damped, 0.0, 1.0, o.dt[l], at)
    put(f, l, at[0], at[1], sum_s, sum_q, upper, lower)
    sums.shear[l] += shear
    if damped:
        sums.visc[l] += visc


@apart
def joint_forces(body, joint, load, pair, lane):
    """Forces of all joints at t_n; brings the contact memory from t_{n−1} to t_n."""
    o = lane[0]
    for j in range(joint.shape[0]):
        u = body[pair[j].upper]
        v = body[pair[j].lower]
        e = joint[j]
        f = load[j]
        for l in range(e.over.shape[0]):
            joint_force(u, v, e, f, o, o, l)


@law
def stored(e, o, l, weight, elastic, shear_energy):
    """Adds what the points of a joint of a weight hold by pressure and by shear to two energies [J]."""
    for p in range(e.fs.shape[0]):
        area = e.over[l] * o.sh[p, l]
        if area > 0.0 and e.kn[l] > 0.0:
            elastic += weight * 0.5 * e.fn[p, l] ** 2 / (e.kn[l] * area)
            shear_energy += weight * 0.5 * e.fs[p, l] ** 2 / (e.ks[l] * area)
    return elastic, shear_energy
