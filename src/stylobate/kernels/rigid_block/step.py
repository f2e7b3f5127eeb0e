"""Rigid block dynamics over lanes: the drums of the plane distinct elements, each joint as one N–V–M interface.

Drums, ground, ends and collapses are those of ``drums/lanes.py`` (see there for the records ``drum``, ``lane``, ``ground``,
``feed`` and ``watch``), their motion that of ``drums/body.py``; only what a joint does is different::

    joint[j]   kn km ks       k_n A [N/m], k_n J [N m], k_s A [N/m]
               co mu          cohesion × area [N], tan φ
               crush[0]       1/(f_c A) [1/N]; that there is a second row tells the compiler that there is a strength
               tau chi        place of the upper face's middle along the face below [m] and cosine of the relative
                              rotation at the last step
               sp             plastic slip of the part above [m]
               fs fn el       shear on the part below, compression [N], energy stored by compression and bending [J]
               gap            largest opening so far, without what is elastic [m]
               dn ds          dashpot force [N]
               fx fz mu_ ml   force on the drum above, moments on the drums above and below about their centroids
"""

import numpy as np

from ..drums import contact as ct
from ..drums import lanes
from ..drums.body import kinetic_and_gravitational, move
from ..drums.frame import run_chunks
from ..drums.lanes import check_finite, fill_ground, joint_state
from ..drums.link_records import link_fields
from ..jit import apart, kernel, strict
from ..run_codes import LANES
from .interface_law import compression, compression_with_strength, shear

#: The models read these here.
__all__ = ["advance", "block_types", "forces", "joint_state", "ledger"]


def block_types(crushing, damped):
    """Record types (drum, joint, lane, ground, feed, watch); compiled once for each combination that is used."""
    drum, _, _, ground, feed, watch = lanes.block_types(2, damped)

    def fields(names, *shape):
        return [(name, np.float64, (*shape, LANES)) for name in names.split()]

    joint = fields("kn km ks co mu tau chi sp fs fn el gap fx fz mu_ ml")
    joint += fields("crush", 2 if crushing else 1) + fields("dn ds", 2 if damped else 1)
    return (
        drum,
        np.dtype(joint),
        np.dtype(fields("dt g gx beta alpha local work shear visc px pz") + link_fields()),
        ground,
        feed,
        watch,
    )


@apart
def forces(drum, joint, lane):
    """Forces of all joints at t_n; brings their memory from t_{n−1} to t_n."""
    o = lane[0]
    for j in range(drum.shape[0] - 1):
        u = drum[j + 1]
        v = drum[j]
        e = joint[j]
        crushing = e.crush.shape[0] > 1
        damped = e.dn.shape[0] > 1
        for l in range(LANES):
            cl = v.c[l]
            sl = v.s[l]
            ht = v.ht[l]
            w = v.t[l]
            b = u.br[l]
            hb = u.hb[l]
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
                dn = ct.normal_dashpot(n, o.beta[l] / soft, vn, 0.0)
                limit = e.mu[l] * (n + dn) + (e.co[l] if n > 0.0 else 0.0)
                ds = ct.shear_dashpot(fs, -o.beta[l] * ks, vt, limit)  # forces on the part below, hence the sign
                o.visc[l] += 0.5 * o.dt[l] * ((ds + e.ds[0, l]) * vt - (dn + e.dn[0, l]) * vn)
                e.dn[0, l] = dn
                e.ds[0, l] = ds
                n = n + dn
                fs = fs + ds
            e.fx[l] = -cl * fs - sl * n
            e.fz[l] = cl * n - sl * fs
            e.mu_[l] = (at_s - ps) * n + (at_q - pq) * fs
            e.ml[l] = at_s * n + (at_q + ht) * fs


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n, after its ``forces``; velocities brought to the whole step.  # Eq. (D5)

    Writes input, kinetic, gravitational (absolute), elastic (absolute), friction, viscous [J].
    ``dt`` is the step of the lane (its own is 0 once it stands still), ``k`` the row of ``ground`` that holds t_n.
    """
    o = lane[0]
    kinetic, height = kinetic_and_gravitational(drum, joint, lane, ground, k, dt, l)
    elastic = 0.0
    stored = 0.0
    for j in range(drum.shape[0] - 1):
        e = joint[j]
        if e.kn[l] > 0.0:
            elastic += e.el[l]
            stored += 0.5 * e.fs[l] ** 2 / e.ks[l]
    out[0] = o.work[l]
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + stored
    out[4] = o.shear[l] - stored
    out[5] = o.visc[l]


@kernel
def observe(drum, joint, lane, feed, watch):
    """Look at all lanes; the peak of openings without the elastic gap at an edge that the law keeps closed."""
    lanes.observe(drum, joint, lane, feed, watch)
    w = watch[0]
    for l in range(LANES):
        w.open[l] = 0.0
    for j in range(joint.shape[0] - 1):
        e = joint[j]
        for l in range(LANES):
            w.open[l] = max(w.open[l], e.gap[l])


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, None, forces, move, check_finite, observe, state, chunks)
