"""Energy of an assembly: what the ground put in, where it is, and where it went.

Legend in ``step.py``.
"""

import math

from ..jit import strict
from . import narrow_phase as near
from .bed import place
from .links import add_to_ledger


@strict
def ledger(body, corner, joint, now, pairs, joined, links, law, memory, real, whole, gx, gz, out):
    """Ledger at t_n, after the forces there: input, kinetic, gravitational, elastic, friction, viscous [J].

    Velocities are brought to the whole step; middle three absolute (as ``ledger`` of the lanes).
    """
    o = now[0]
    dt = o.last
    kinetic = 0.0
    height = 0.0
    elastic = 0.0
    stored = 0.0
    for i in range(body.shape[0]):
        u = body[i]
        if u.im == 0.0:
            continue
        vx = u.vx + 0.5 * dt * (u.fx * u.im - gx - o.gx)
        vz = u.vz + 0.5 * dt * (u.fz * u.im - gz - o.g)
        w = u.w + 0.5 * dt * u.mo * u.ii
        kinetic += 0.5 * (u.m * (vx * vx + vz * vz) + u.i * w * w)
        height += u.m * (o.g * u.z + o.gx * u.x)
    for j in range(joint.shape[0]):
        e = joint[j]
        if e.live != 0:
            for p in range(e.fs.shape[0]):
                length = e.over * o.sh[p]
                if length > 0.0:
                    elastic += e.weight * 0.5 * e.fn[p] ** 2 / (e.kn * length)
                    stored += e.weight * 0.5 * e.fs[p] ** 2 / (e.ks * length)
    xa, za, xb, zb, px, pz, qx, qz = real
    from_b, q_from = whole
    for k in range(o.pairs):
        i = pairs[k, 0]
        h = pairs[k, 1]
        j = joined[i, h]
        share = 1.0 - joint[j].weight if j >= 0 and joint[j].live != 0 else 1.0
        if share == 0.0:
            continue
        a = body[i]
        b = body[h]
        na = place(a, corner, xa, za)
        nb = place(b, corner, xb, zb)
        n = near.clip(xb, zb, nb, xa, za, na, px, pz, from_b, qx, qz, q_from)
        if n == 0:
            continue
        _, _, _, gx_, gz_ = near.measure(px, pz, from_b, n)
        chord = math.sqrt(gx_ * gx_ + gz_ * gz_)
        if chord > 0.0:
            depth = min(a.depth, b.depth)
            elastic += 0.5 * share * law[i, h, 0] * depth * near.depth_square(px, pz, n, gx_ / chord, gz_ / chord)
            stored += 0.5 * memory[i, h, 0] ** 2 / (share * law[i, h, 1] * depth * chord)
    out[0] = o.work
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + stored
    out[4] = o.shear - stored
    out[5] = o.visc
    add_to_ledger(links, out)
