"""The contact law in the plane: where two faces touch, and the force there. One law for every path through it.

Legend (all per joint, in the frame of the lower face: s along it, q along its normal, origin in its middle)::

    bl, br      from the foot of the upper drum's centroid to the left, right end of its lower face  [m]
    w           from the foot of the lower body's centroid to the left or right end of its face      [m]
    hb, ht      centroid to lower face of the upper drum, centroid to upper face of the lower drum   [m]
    c, s        cosine and sine of a rotation (suffix u upper, l lower, r relative)
    sl, ql      left corner of the upper face;  sr, qr  right corner                                 [m]
    lo, hi      ends of the overlap of the two faces along s                                         [m]
    fn, fs      normal force (≥ 0) and tangential force on the upper drum                            [N]
"""

from ..jit import law


@law
def relative_pose(xu, zu, cu, su, xl, zl, cl, sl, ht):
    """Centroid and rotation of the upper drum in the frame of the lower face: (s, q, cos, sin)."""
    dx = xu - xl
    dz = zu - zl
    return cl * dx + sl * dz, cl * dz - sl * dx - ht, cu * cl + su * sl, su * cl - cu * sl


@law
def face_corners(ps, pq, cr, sr, bl, br, hb):
    """Corners of the upper drum's lower face in the frame of the lower face: (s left, q left, s right, q right)."""
    ms = ps + sr * hb
    mq = pq - cr * hb
    return ms - bl * cr, mq - bl * sr, ms + br * cr, mq + br * sr


@law
def opening(sl, ql, sr_, qr, cr, sr, w):
    """Largest height of the upper face over the lower one within their overlap; continuous as a corner passes an edge."""
    slope = sr / max(cr, 0.05)
    left = ql + (max(sl, -w) - sl) * slope
    right = qr + (min(sr_, w) - sr_) * slope
    return max(max(left, right), 0.0)


@law
def left_contact(sl, ql, cr, sr, w):
    """Contact at the left end of the overlap: (s, q, gap, normal s, normal q).

    The upper drum's corner touches the lower face, with that face's normal, as long as it is above it; once it is past
    the edge, the lower drum's corner touches the upper face, with the upper face's normal.
    """
    inside = sl > -w
    gap = ql if inside else cr * ql - sr * (sl + w)
    return max(sl, -w), (ql if inside else 0.0), gap, (0.0 if inside else -sr), (1.0 if inside else cr)


@law
def right_contact(sr_, qr, cr, sr, w):
    """Contact at the right end of the overlap, as :func:`left_contact`."""
    inside = sr_ < w
    gap = qr if inside else cr * qr - sr * (sr_ - w)
    return min(sr_, w), (qr if inside else 0.0), gap, (0.0 if inside else -sr), (1.0 if inside else cr)


@law
def inner_contact(xi, lo, hi, sl, ql, cr, sr):
    """Contact at −1 < xi < 1 between the ends of the overlap, with the lower face's normal."""
    s = 0.5 * (lo + hi) + 0.5 * xi * (hi - lo)
    slope = sr / max(cr, 0.05)
    return s, 0.0, ql + (s - sl) * slope, 0.0, 1.0


@law
def contact_point(p, points, xi, lo, hi, sl, ql, sr_, qr, cr, sr, wl, wr):
    """Contact point p of a joint: the ends of the overlap first and last, the others between them."""
    if p == 0:
        return left_contact(sl, ql, cr, sr, wl)
    if p == points - 1:
        return right_contact(sr_, qr, cr, sr, wr)
    return inner_contact(xi, lo, hi, sl, ql, cr, sr)


@law
def contact_velocity(s, q, ns, nq, ps, pq, ht, vs, vq, wu, wl):
    """Velocity of the upper drum relative to the lower one at a point: (tangential, normal); tangent is (nq, −ns)."""
    us = vs - wu * (q - pq) + wl * (q + ht)
    uq = vq + wu * (s - ps) - wl * s
    return us * nq - uq * ns, us * ns + uq * nq


@law
def normal_force(ka, gap):
    """No-tension spring, fn = −k_n A gap while the gap is negative.  # Eq. (D1); Baraldi et al., Eq. 7"""
    return max(-ka * gap, 0.0)


@law
def shear_force(fs, ks_a, slip, limit):
    """Incremental Coulomb friction, fs ← fs − k_s A Δu_s, |fs| ≤ limit.  # Eq. (D1); Baraldi et al., Eq. 7"""
    return min(max(fs - ks_a * slip, -limit), limit)


@law
def normal_dashpot(fn, resistance, vn, give):
    """Dashpot beside the normal spring: ``resistance`` times the speed, and ``give`` times the spring's force.

    It never makes the sum of both forces a tension, and there is none while the contact is open.
    """
    return max(fn * give - resistance * vn, -fn) if fn > 0.0 else 0.0


@law
def shear_dashpot(fs, resistance, vt, limit):
    """Dashpot beside the shear spring; the sum of both forces stays within Coulomb's limit."""
    return min(max(-resistance * vt, -limit - fs), limit - fs)


@law
def restitution_share(eta, calm, vn):
    """Share of the spring's force by which it is larger while the contact closes (vn < 0) and smaller while it opens.

    ``eta`` from the speed ``calm`` [m/s] on, in proportion to the speed below it.
    """
    return eta * min(max(-vn / calm, -1.0), 1.0)


@law
def point_forces(old, gap, vn, vt, dt, ka, ksa, mu, cohesion, beta, give, damped):
    """Forces of one contact point: (fn, fs) of its springs and (dn, ds) of its dashpots.

    ``old`` is fs a step ago; ``cohesion`` is a force; ``give`` from :func:`restitution_share`, 0 for elastic contacts.
    """
    fn = normal_force(ka, gap)
    bond = cohesion if fn > 0.0 else 0.0
    if damped:
        dn = normal_dashpot(fn, beta * ka, vn, give)
        limit = mu * (fn + dn) + bond
        fs = shear_force(old, ksa, vt * dt, limit)
        return fn, fs, dn, shear_dashpot(fs, beta * ksa, vt, limit)
    return fn, shear_force(old, ksa, vt * dt, mu * fn + bond), 0.0, 0.0


@law
def point_load(fn, fs, ns, nq, at_s, at_q, ps, pq, ht):
    """Load of a contact point: its force along s and q, its moments about the upper and the lower body's centroid."""
    fa = fn * ns + fs * nq
    fb = fn * nq - fs * ns
    return fa, fb, (at_s - ps) * fb - (at_q - pq) * fa, at_s * fb - (at_q + ht) * fa


@law
def turn(c, s, angle):
    """Cosine and sine after a further small rotation, to second order.

    The angle made good differs from ``angle`` by angle³/6 (1e-13 rad for a step of 1e-4 rad); the length, by angle⁴/8,
    is renormalised whenever the lanes are looked at.
    """
    even = 1.0 - 0.5 * angle * angle
    return c * even - s * angle, s * even + c * angle
