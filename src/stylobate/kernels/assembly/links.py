"""Links between any two bodies of an assembly: the laws of the drums' links, at places and along directions of the bodies.

Records: those of ``drums/link_records.py`` for one lane, where the lower body is the one whose axes the link goes by, and::

    mtc mts     direction in which the link slips, in the axes of the lower body; it lengthens to the left of that
    mboth       1: its axial law is that of its shear, in both senses (a clamp)
    mback       its slack along its axis [m] (a clamp)
    mya mcra mbra   of its axial law, as my, mcr, mbr of its shear (a clamp)
    mpre        pretension [N]
"""

import math

import numpy as np

from ..drums.link_records import NUMBERS, OWN, SHARED
from ..drums.links import pulled, released, shear
from ..jit import kernel, law, strict
from .joints import face


def link_type():
    """Record type of a link."""
    return np.dtype(
        [(name, np.int64) for name in (*NUMBERS.split(), "mboth")]
        + [(name, np.float64) for name in (*SHARED.split(), "mtc", "mts", "mya", "mcra", "mbra", "mpre")]
        + [(name, np.float64, (1,)) for name in (*OWN.split(), "mback")]
        + [("mwhen", np.int64, (1,))]
    )


@law
def at_place(u, v, k):
    """Where the place of the upper body is: along the slip and across it, from the lower centroid; that direction; and from
    the lower and the upper centroid in the plane [m].
    """
    tc, ts = face(v, k.mtc, k.mts)
    bx = u.c * k.mbx[0] - u.s * k.mbz[0]
    bz = u.s * k.mbx[0] + u.c * k.mbz[0]
    ax = u.x + bx - v.x
    az = u.z + bz - v.z
    return tc * ax + ts * az, tc * az - ts * ax, tc, ts, ax, az, bx, bz


@law
def put(u, v, fx, fz, ax, az, bx, bz):
    """Adds a force on the upper body at b from its centroid, and its reaction at a from that of the lower one."""
    u.fx += fx
    u.fz += fz
    u.mo += bx * fz - bz * fx
    v.fx -= fx
    v.fz -= fz
    v.mo -= ax * fz - az * fx


@law
def held(way, gap, yields, stiffness, lift, deepest, reach, whole, out, brittle, crush, far, lost, old):
    """What a link holds against a way from where it is free: force; how far that place and the slack go on; heat; whole,
    out; and the largest force.  # Eq. (K1)
    """
    side = 1.0 if way > 0.0 else -1.0
    force, more, back, still, out = shear(abs(way), gap, yields, stiffness, lift, deepest, reach, whole, out, brittle)
    largest = stiffness * yields if (whole > 0.0) & (still == 0.0) else 0.0  # it snapped at its capacity
    still = 0.0 if (far > lost) & (out == 0.0) else still  # one out of its hole is not bent
    acts = still * (1.0 - out)
    force *= acts
    heat = released(old, 0.0, stiffness) * (1.0 - acts) + force * more
    return -side * force, side * (back + more * (1.0 - crush)), more * crush, heat, still, out, max(largest, force)


@law
def across(u, v, k, dt):
    """Adds a dowel, bar, layer or clamp: what holds against slip, and along its axis."""
    at_s, at_q, tc, ts, ax, az, bx, bz = at_place(u, v, k)
    far = abs(at_s - k.msx[0])
    long = at_q - k.mh[0]
    fs, on, wider, heat, whole, out, most = held(
        at_s - k.mpx[0], k.mgap[0], k.my, k.mks, long, k.mdeep, k.mreach, k.mon[0], k.mout[0], k.mbr, k.mcr, far, k.mus,
        k.mfx[0],
    )  # fmt: skip
    k.mpx[0] += on
    k.mgap[0] += wider
    k.mlost[0] += heat
    k.mpeak[0] = max(k.mpeak[0], most)
    k.mfx[0] = fs
    k.mslip[0] = far
    k.mlong[0] = long
    k.mon[0] = whole
    k.mout[0] = out
    if k.mc > 0.0:
        speed = tc * (u.vx - bz * u.w - v.vx + az * v.w) + ts * (u.vz + bx * u.w - v.vz - ax * v.w)
        drag = -k.mc * speed * whole
        k.mdrag[0] -= 0.5 * dt * (drag + k.mdx[0]) * speed
        k.mdx[0] = drag
        fs += drag
    pull = 0.0
    if k.mboth != 0:
        fq, on, wider, heat, whole, _, most = held(
            long - k.ml0[0], k.mback[0], k.mya, k.mka[0], 0.0, 1.0, 0.0, whole, 0.0, k.mbra, k.mcra, abs(long),
            k.mua[0], k.mft[0],
        )  # fmt: skip
        pull = -fq
        k.ml0[0] += on
        k.mback[0] += wider
        k.mlost[0] += heat
        k.mpull[0] = max(k.mpull[0], most)
        k.mft[0] = pull
        k.mon[0] = whole
    elif k.mten != 0:
        pull = pulled(k, 0, at_q)
    put(u, v, tc * fs + ts * pull, ts * fs - tc * pull, ax, az, bx, bz)


@law
def ends(u, v, k):
    """Ends of a straight link from the centroids of its bodies, and the way from the lower to the upper one [m]."""
    ax = v.c * k.max[0] - v.s * k.maz[0]
    az = v.s * k.max[0] + v.c * k.maz[0]
    bx = u.c * k.mbx[0] - u.s * k.mbz[0]
    bz = u.s * k.mbx[0] + u.c * k.mbz[0]
    dx, dy, dz = u.x + bx - v.x - ax, k.mby[0] - k.may[0], u.z + bz - v.z - az
    return ax, az, bx, bz, dx, dz, math.sqrt(dx * dx + dy * dy + dz * dz)


@law
def straight(u, v, k):
    """Adds a tie or core between two points."""
    ax, az, bx, bz, dx, dz, length = ends(u, v, k)
    size = -pulled(k, 0, length) / max(length, 1e-12)
    put(u, v, size * dx, size * dz, ax, az, bx, bz)


@kernel
def link_forces(body, links, dt):
    """Adds the forces of all links at t_n; brings their memory from t_{n−1} to t_n."""
    for m in range(links.shape[0]):
        k = links[m]
        u = body[k.mup]
        v = body[k.mlow]
        if k.mline != 0:
            straight(u, v, k)
        else:
            across(u, v, k, dt)


@kernel
def look_at_links(links, step):
    """Between chunks of steps: peaks of slip and elongation, and links that have broken."""
    for m in range(links.shape[0]):
        k = links[m]
        k.mfar[0] = max(k.mfar[0], k.mslip[0])
        # a clamp may be lost by being pressed, too
        k.mmost[0] = max(k.mmost[0], abs(k.mlong[0]) if k.mboth != 0 else k.mlong[0])
        if k.mon[0] == 0.0 and k.mwhen[0] < 0:
            k.mwhen[0] = step


@kernel
def begin(body, links, clearance):
    """Lets all links begin where the bodies are now: whole, free of force but for their pretension."""
    for m in range(links.shape[0]):
        k = links[m]
        u = body[k.mup]
        v = body[k.mlow]
        _, _, _, _, _, _, length = ends(u, v, k)
        at_s, at_q, _, _, _, _, _, _ = at_place(u, v, k)
        k.msx[0] = k.mpx[0] = at_s
        k.mh[0] = length if k.mline != 0 else at_q
        free = -k.mpre / k.mka[0] if k.mpre > 0.0 else 0.0
        k.ml0[0] = free if k.mboth != 0 else k.mh[0] + free
        k.mgap[0] = k.mback[0] = clearance[m]
        k.mft[0] = k.mpull[0] = k.mpre
        k.mfx[0] = k.mpeak[0] = k.mdx[0] = k.mlost[0] = k.mdrag[0] = 0.0
        k.mslip[0] = k.mlong[0] = k.mfar[0] = k.mmost[0] = k.mout[0] = 0.0
        k.mon[0] = 1.0
        k.mwhen[0] = -1


@strict
def add_to_ledger(links, out):
    """Adds elastic energy and heat of all links to a ledger [J]."""
    for m in range(links.shape[0]):
        k = links[m]
        out[3] += released(k.mfx[0], 0.0, k.mks) + released(k.mft[0], 0.0, k.mka[0])
        out[4] += k.mlost[0]
        out[5] += k.mdrag[0]
