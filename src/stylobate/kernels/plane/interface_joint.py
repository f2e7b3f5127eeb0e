"""A joint that is one interface for compression, shear and moment, in one lane: the joint of rigid blocks as built.

Law: ``interface_law.py``; both faces lie along the axes of their bodies. Fields of its record besides those that all joints
have::

    kn km ks       k_n A [N/m], k_n J [N m], k_s A [N/m]
    co             cohesion × area [N]
    crush[0]       1/(f_c A) [1/N]; that there is a second row tells the compiler that there is a strength
    tau chi        place of the upper face's middle along the face below [m] and cosine of the relative rotation at the last
                   step
    sp             plastic slip of the part above [m]
    fs fn el       shear on the part below, compression [N], energy stored by compression and bending [J]
    gap            largest opening so far, without what is elastic [m]
    dn ds          dashpot force [N]
"""

from ..jit import apart, law
from . import contact as ct
from .interface_law import compression, compression_with_strength, shear
from .records import BETA


@law
def interface(u, v, e, f, o, l, crushing, damped):
    """Force of an interface at t_n, written as its load; brings its memory from t_{n−1} to t_n."""
    cl, sl = v.c[l], v.s[l]
    ht = e.ht[l]
    w = e.wr[l]
    b = e.br[l]
    hb = e.hb[l]
    kn = e.kn[l]
    km = e.km[l]
    ks = e.ks[l]
    ps, pq, c, s = ct.relative_pose(u.x[l], u.z[l], u.c[l], u.s[l], v.x[l], v.z[l], cl, sl, ht)
    tau = ps + s * hb
    closure = c * hb - pq
    # The faces' overlap, seen from the middle of the upper face: slip shortens it on one side.
    slip = e.sp[l]
    right = min(b, w - slip)
    left = max(-b, -w - slip)
    narrowing = 0.0
    if crushing:
        narrowing = 0.5 * (right - left) * e.crush[0, l]
        n, at = compression_with_strength(closure, s, left, right, kn, km, e.crush[0, l])
    else:
        n, at = compression(closure, s, left, right, kn, km)
    # Movement of the upper face's material point at the eccentricity, along the face below.
    move = tau - e.tau[l] + at * (c - e.chi[l])
    old = e.fs[l]
    trial = old + ks * move
    fs = shear(trial, n, e.mu[l], e.co[l])
    slip = slip + (trial - fs) / max(ks, 1.0)
    # Work of the shear spring; where slip moves the limit that n acts at, the stored energy changes with it.
    move_right = min(b, w - slip) - right
    move_left = max(-b, -w - slip) - left
    shrunk = 0.5 * n * e.crush[0, l] * (move_right - move_left) if crushing else 0.0
    moved = 0.0
    if at >= right - narrowing * n:
        moved = move_right - shrunk
    if at <= left + narrowing * n:
        moved = move_left + shrunk
    soft = 1.0 / kn + at * at / km
    o.shear[l] += 0.5 * (old + fs) * move + n * (s + n * at / km) * moved
    e.sp[l] = slip
    e.tau[l] = tau
    e.chi[l] = c
    e.fs[l] = fs
    e.fn[l] = n
    e.el[l] = 0.5 * n * (closure - at * s)
    if crushing:
        e.el[l] = n * (closure - at * s) - 0.5 * n * n * soft
    # Opening: what is left of closure and rotation without their elastic parts, at the wider edge.
    rest = closure - n / max(kn, 1.0)
    turned = s + n * at / km
    e.gap[l] = max(e.gap[l], max(right * turned, left * turned) - rest)
    at_s = tau + at * c
    at_q = at * s - closure
    if damped:
        # Dashpots at the point of contact: no tension in sum with its springs, no friction above Coulomb's.
        dvx = u.vx[l] - v.vx[l]
        dvz = u.vz[l] - v.vz[l]
        vs = cl * dvx + sl * dvz
        vq = cl * dvz - sl * dvx
        vt, vn = ct.contact_velocity(at_s, at_q, 0.0, 1.0, ps, pq, ht, vs, vq, u.w[l], v.w[l])
        beta = o.damp[BETA, l]
        dn = ct.normal_dashpot(n, beta / soft, vn, 0.0)
        limit = e.mu[l] * (n + dn) + (e.co[l] if n > 0.0 else 0.0)
        ds = ct.shear_dashpot(fs, -beta * ks, vt, limit)  # forces on the part below, hence the sign
        o.visc[l] += 0.5 * o.dt[l] * ((ds + e.ds[0, l]) * vt - (dn + e.dn[0, l]) * vn)
        e.dn[0, l] = dn
        e.ds[0, l] = ds
        n = n + dn
        fs = fs + ds
    f.fx[l] = -cl * fs - sl * n
    f.fz[l] = cl * n - sl * fs
    f.mu_[l] = (at_s - ps) * n + (at_q - pq) * fs
    f.ml[l] = at_s * n + (at_q + ht) * fs


@apart
def joint_forces(body, joint, load, pair, lane):
    """Forces of all joints at t_n; brings their memory from t_{n−1} to t_n."""
    o = lane[0]
    for j in range(joint.shape[0]):
        u = body[pair[j].upper]
        v = body[pair[j].lower]
        e = joint[j]
        f = load[j]
        crushing = e.crush.shape[0] > 1
        damped = e.dn.shape[0] > 1
        for l in range(e.fs.shape[0]):
            interface(u, v, e, f, o, l, crushing, damped)


@law
def stored(e, o, l, weight, elastic, shear_energy):
    """Adds what an interface of a weight holds by pressure and by shear to two energies [J]."""
    if e.kn[l] > 0.0:
        elastic += weight * e.el[l]
        shear_energy += weight * 0.5 * e.fs[l] ** 2 / e.ks[l]
    return elastic, shear_energy


@law
def look_at_gaps(joint, watch):
    """The peak of openings in every lane, of interfaces so far."""
    w = watch[0]
    for l in range(w.status.shape[0]):
        w.open[l] = 0.0
    for j in range(joint.shape[0]):
        e = joint[j]
        for l in range(w.status.shape[0]):
            w.open[l] = max(w.open[l], e.gap[l])
