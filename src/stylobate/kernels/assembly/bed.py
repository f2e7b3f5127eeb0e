"""The elastic bed between any two bodies of an assembly, where no joint acts alone.

Legend in ``step.py``.
"""

import math

from ..drums import contact as ct
from ..jit import kernel, law
from . import narrow_phase as near


@law
def place(b, corner, x, z):
    """Corners of a body in world axes; returns their number."""
    for k in range(b.count):
        cx = corner[b.first + k, 0]
        cz = corner[b.first + k, 1]
        x[k] = b.x + b.c * cx - b.s * cz
        z[k] = b.z + b.s * cx + b.c * cz
    return b.count


@kernel
def bed_forces(body, corner, joint, now, pairs, joined, law, memory, real, whole):
    """Forces of the bed at t_n between all pairs that may touch, where no joint acts alone."""
    o = now[0]
    dt = o.last
    xa, za, xb, zb, px, pz, qx, qz = real
    from_b, q_from = whole
    o.loose = 0
    for k in range(o.pairs):
        i = pairs[k, 0]
        h = pairs[k, 1]
        j = joined[i, h]
        share = 1.0
        if j >= 0 and joint[j].live != 0:
            share = 1.0 - joint[j].weight
            if share == 0.0:
                memory[i, h, :] = 0.0
                continue
        o.loose += 1
        a = body[i]
        b = body[h]
        na = place(a, corner, xa, za)
        nb = place(b, corner, xb, zb)
        n = near.clip(xb, zb, nb, xa, za, na, px, pz, from_b, qx, qz, q_from)
        if n == 0:
            memory[i, h, :] = 0.0
            continue
        area, cx, cz, gx, gz = near.measure(px, pz, from_b, n)
        chord = math.sqrt(gx * gx + gz * gz)
        if not chord > 0.0:
            memory[i, h, :] = 0.0
            continue
        if o.touched < 0 and j < 0:
            o.touched = o.step
        # the part of b's outline in a: its right-hand normal points out of b; n points from a to b
        nx = -gz / chord
        nz = gx / chord
        depth = min(a.depth, b.depth)
        kn = share * law[i, h, 0] * depth
        ks = share * law[i, h, 1] * depth * chord
        o.deepest = max(o.deepest, area / chord)
        rx = cx - b.x
        rz = cz - b.z
        lx = cx - a.x
        lz = cz - a.z
        ux = (b.vx - b.w * rz) - (a.vx - a.w * lz)
        uz = (b.vz + b.w * rx) - (a.vz + a.w * lx)
        vn = ux * nx + uz * nz
        vt = ux * nz - uz * nx
        fn = kn * area
        dn = ct.normal_dashpot(fn, o.beta * kn * chord, vn, ct.restitution_share(o.eta, o.calm, vn))
        limit = law[i, h, 2] * (fn + dn)
        old = memory[i, h, 0]
        fs = ct.shear_force(old, ks, vt * dt, limit)
        ds = ct.shear_dashpot(fs, o.beta * ks, vt, limit)
        o.shear -= 0.5 * (old + fs) * vt * dt
        o.visc -= 0.5 * ((dn + memory[i, h, 1]) * vn + (ds + memory[i, h, 2]) * vt) * dt
        memory[i, h, 0] = fs
        memory[i, h, 1] = dn
        memory[i, h, 2] = ds
        fx = (fn + dn) * nx + (fs + ds) * nz
        fz = (fn + dn) * nz - (fs + ds) * nx
        b.fx += fx
        b.fz += fz
        b.mo += rx * fz - rz * fx
        a.fx -= fx
        a.fz -= fz
        a.mo -= lx * fz - lz * fx
