"""Dowels, bars, ties and layers between drums in the plane: what they add to the forces of the joints of any law.

Records and legend of links: ``link_records.py``; their laws: ``links.py``.
"""

import math

from ..jit import apart, kernel, law
from ..run_codes import CHUNK, LANES
from . import contact as ct
from .lanes import upper_face
from .links import add_all, look_for_slack, note_slack, pulled, shear


@law
def at_joint(u, v, k, l):
    """Direction of the face below; the upper centroid and the place of a link on that drum, along the face and over it."""
    cl, sl = upper_face(v, l)
    ps, pq, c, s = ct.relative_pose(u.x[l], u.z[l], u.c[l], u.s[l], v.x[l], v.z[l], cl, sl, v.ht[l])
    return cl, sl, ps, pq, ps + s * u.hb[l] + c * k.mbx[l], pq - c * u.hb[l] + s * k.mbx[l]


@law
def slipping(u, v, l, cl, sl, ps, pq, at_s, at_q):
    """Speed at which that place slips along the face below [m/s]."""
    dvx = u.vx[l] - v.vx[l]
    dvz = u.vz[l] - v.vz[l]
    vs = cl * dvx + sl * dvz
    vq = cl * dvz - sl * dvx
    speed, _ = ct.contact_velocity(at_s, at_q, 0.0, 1.0, ps, pq, v.ht[l], vs, vq, u.w[l], v.w[l])
    return speed


@apart
def across(drum, joint, lane, m):
    """Adds a dowel, bar or layer across a joint."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    e = joint[k.mlow]
    stiffness, yields, brittle, crush = k.mks, k.my, k.mbr, k.mcr
    deepest, reach, lost = k.mdeep, k.mreach, k.mus
    half = 0.5 / max(stiffness, 1e-300)
    for l in range(LANES):
        cl, sl, _, pq, at_s, at_q = at_joint(u, v, k, l)
        slip = at_s - k.mpx[l]
        side = 1.0 if slip > 0.0 else -1.0
        held, more, back, whole, out = shear(
            abs(slip), k.mgap[l], yields, stiffness, at_q - k.mh[l], deepest, reach, k.mon[l], k.mout[l], brittle
        )
        far = abs(at_s - k.msx[l])
        snapped = (k.mon[l] > 0.0) & (whole == 0.0)  # at its capacity
        whole = 0.0 if (far > lost) & (out == 0.0) else whole  # one out of its hole is not bent
        acts = whole * (1.0 - out)
        held = held * acts
        k.mpeak[l] = max(k.mpeak[l], stiffness * yields if snapped else held)
        old = k.mfx[l]
        k.mlost[l] += half * old * old * (1.0 - acts) + held * more
        k.mpx[l] += side * (back + more * (1.0 - crush))
        k.mgap[l] += more * crush
        fs = -side * held
        k.mfx[l] = fs
        k.mslip[l] = far
        k.mon[l] = whole
        k.mout[l] = out
        e.fx[l] += cl * fs
        e.fz[l] += sl * fs
        e.mu_[l] -= (at_q - pq) * fs
        e.ml[l] -= (at_q + v.ht[l]) * fs


@apart
def slowed(drum, joint, lane, m):
    """Adds the dashpot of a layer."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    e = joint[k.mlow]
    dash = k.mc
    for l in range(LANES):
        cl, sl, ps, pq, at_s, at_q = at_joint(u, v, k, l)
        speed = slipping(u, v, l, cl, sl, ps, pq, at_s, at_q)
        fs = -dash * speed * k.mon[l]
        k.mdrag[l] -= 0.5 * k.mdt[l] * (fs + k.mdx[l]) * speed
        k.mdx[l] = fs
        e.fx[l] += cl * fs
        e.fz[l] += sl * fs
        e.mu_[l] -= (at_q - pq) * fs
        e.ml[l] -= (at_q + v.ht[l]) * fs


@apart
def against_opening(drum, joint, lane, m):
    """Adds what a bar holds against the opening of a joint at its place."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    e = joint[k.mlow]
    for l in range(LANES):
        cl, sl, ps, _, at_s, at_q = at_joint(u, v, k, l)
        pull = pulled(k, l, at_q)
        e.fx[l] += sl * pull
        e.fz[l] -= cl * pull
        e.mu_[l] -= (at_s - ps) * pull
        e.ml[l] -= at_s * pull


@apart
def straight(drum, joint, lane, m):
    """Adds a tie or core between two points."""
    k = lane[m]
    low, up = k.mlow, k.mup
    v = drum[low]
    u = drum[up]
    above = joint[up - 1]
    for l in range(LANES):
        cl, sl = upper_face(v, l)
        cu, su = upper_face(u, l)
        ax = cl * k.max[l] - sl * k.maz[l]
        az = sl * k.max[l] + cl * k.maz[l]
        bx = cu * k.mbx[l] - su * k.mbz[l]
        bz = su * k.mbx[l] + cu * k.mbz[l]
        dx = u.x[l] + bx - v.x[l] - ax
        dy = k.mby[l] - k.may[l]
        dz = u.z[l] + bz - v.z[l] - az
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        # on the upper body, towards the lower end
        size = -pulled(k, l, length) / max(length, 1e-12)
        fx = size * dx
        fz = size * dz
        k.mdx[l] = fx
        k.mdy[l] = fz
        above.mu_[l] += bx * fz - bz * fx
    e = joint[low]
    for l in range(LANES):
        cl, sl = upper_face(v, l)
        ax = cl * k.max[l] - sl * k.maz[l]
        az = sl * k.max[l] + cl * k.maz[l]
        e.ml[l] += ax * k.mdy[l] - az * k.mdx[l]
    for q in range(low, up):  # what is between passes it on
        e = joint[q]
        for l in range(LANES):
            e.fx[l] += k.mdx[l]
            e.fz[l] += k.mdy[l]


@kernel
def add_links(drum, joint, lane):
    """Adds the forces of all links at t_n to those of the joints; brings their memory from t_{n−1} to t_n."""
    add_all(straight, across, slowed, against_opening, drum, joint, lane)


@apart
def slack_left(drum, lane, m):
    """Notes how far a dowel is from leaving its slack in every lane."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    for l in range(LANES):
        cl, sl, ps, pq, at_s, at_q = at_joint(u, v, k, l)
        speed = slipping(u, v, l, cl, sl, ps, pq, at_s, at_q)
        note_slack(k, l, abs(at_s - k.mpx[l]), abs(at_s - k.msx[l]), abs(speed), CHUNK * k.mdt[l])


@kernel
def look_ahead(drum, joint, lane, watch):
    """Which links may hold something within the next chunk of steps: all but dowels far within their slack."""
    look_for_slack(slack_left, drum, lane, watch)
