"""The elastic bed between any two bodies that no joint holds alone: its force, and what it stores.

Where two outlines overlap: ``clip.py``; legend in ``loose.py``.
"""

import math

from ..jit import kernel, law, strict
from . import clip as near
from . import contact as ct
from .search import place


@law
def share_of_bed(i, h, joined, hand):
    """Share of a pair's contact that the bed has: what its joint leaves, if it has one."""
    j = joined[i, h]
    if j >= 0 and hand[j].live != 0:
        return 1.0 - hand[j].weight
    return 1.0


@kernel
def bed_forces(body, load, lane, pair, start, beta, now, hand, shape, corner, joined, law, memory, real, whole, step):
    """Forces of the bed at t_n between all pairs that may touch, where no joint acts alone; contacts from ``start`` on."""
    o = now[0]
    dt = o.last
    xa, za, xb, zb, px, pz, qx, qz = real
    from_b, q_from = whole
    o.loose = 0
    for k in range(o.pairs):
        i = pair[start + k].lower
        h = pair[start + k].upper
        f = load[start + k]
        f.fx[0] = f.fz[0] = f.mu_[0] = f.ml[0] = 0.0
        share = share_of_bed(i, h, joined, hand)
        if share == 0.0:
            memory[i, h, :] = 0.0
            continue
        o.loose += 1
        a = body[i]
        b = body[h]
        na = place(a, shape[i], corner, xa, za)
        nb = place(b, shape[h], corner, xb, zb)
        n = near.clip(xb, zb, nb, xa, za, na, px, pz, from_b, qx, qz, q_from)
        if n == 0:
            memory[i, h, :] = 0.0
            continue
        area, cx, cz, gx, gz = near.measure(px, pz, from_b, n)
        chord = math.sqrt(gx * gx + gz * gz)
        if not chord > 0.0:
            memory[i, h, :] = 0.0
            continue
        if o.touched < 0 and joined[i, h] < 0:
            o.touched = step
        # the part of b's outline in a: its right-hand normal points out of b; n points from a to b
        nx = -gz / chord
        nz = gx / chord
        depth = min(shape[i].depth, shape[h].depth)
        kn = share * law[i, h, 0] * depth
        ks = share * law[i, h, 1] * depth * chord
        o.deepest = max(o.deepest, area / chord)
        rx = cx - b.x[0]
        rz = cz - b.z[0]
        lx = cx - a.x[0]
        lz = cz - a.z[0]
        ux = (b.vx[0] - b.w[0] * rz) - (a.vx[0] - a.w[0] * lz)
        uz = (b.vz[0] + b.w[0] * rx) - (a.vz[0] + a.w[0] * lx)
        vn = ux * nx + uz * nz
        vt = ux * nz - uz * nx
        fn = kn * area
        dn = ct.normal_dashpot(fn, beta * kn * chord, vn, ct.restitution_share(o.eta, o.calm, vn))
        limit = law[i, h, 2] * (fn + dn)
        old = memory[i, h, 0]
        fs = ct.shear_force(old, ks, vt * dt, limit)
        ds = ct.shear_dashpot(fs, beta * ks, vt, limit)
        lane[0].shear[0] -= 0.5 * (old + fs) * vt * dt
        lane[0].visc[0] -= 0.5 * ((dn + memory[i, h, 1]) * vn + (ds + memory[i, h, 2]) * vt) * dt
        memory[i, h, 0] = fs
        memory[i, h, 1] = dn
        memory[i, h, 2] = ds
        fx = (fn + dn) * nx + (fs + ds) * nz
        fz = (fn + dn) * nz - (fs + ds) * nx
        f.fx[0] = fx
        f.fz[0] = fz
        f.mu_[0] = rx * fz - rz * fx
        f.ml[0] = lx * fz - lz * fx


@strict
def stored_by_bed(body, pair, start, now, hand, shape, corner, joined, law, memory, real, whole):
    """Energy that the bed holds by pressure and by shear [J]."""
    elastic = 0.0
    shear_energy = 0.0
    xa, za, xb, zb, px, pz, qx, qz = real
    from_b, q_from = whole
    for k in range(now[0].pairs):
        i = pair[start + k].lower
        h = pair[start + k].upper
        share = share_of_bed(i, h, joined, hand)
        if share == 0.0:
            continue
        na = place(body[i], shape[i], corner, xa, za)
        nb = place(body[h], shape[h], corner, xb, zb)
        n = near.clip(xb, zb, nb, xa, za, na, px, pz, from_b, qx, qz, q_from)
        if n == 0:
            continue
        _, _, _, gx, gz = near.measure(px, pz, from_b, n)
        chord = math.sqrt(gx * gx + gz * gz)
        if chord > 0.0:
            depth = min(shape[i].depth, shape[h].depth)
            elastic += 0.5 * share * law[i, h, 0] * depth * near.depth_square(px, pz, n, gx / chord, gz / chord)
            shear_energy += 0.5 * memory[i, h, 0] ** 2 / (share * law[i, h, 1] * depth * chord)
    return elastic, shear_energy
