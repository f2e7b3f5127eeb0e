"""Drums in space with links: the steps of the laws of contact, and what dowels, bars, ties and layers add to their forces.

Records and legend of links: ``drums/link_records.py``. A column without links is computed by the modules of the laws.
"""

import math
from types import SimpleNamespace

from ..drums.frame import run_chunks
from ..drums.links import add_all, add_to_ledger, look_at_links, look_for_slack, note_slack, pulled, shear
from ..jit import apart, kernel, law, strict
from ..run_codes import CHUNK, LANES
from . import bed_forces, chipped_forces, corner_forces, rim_forces
from .ground import fill_ground
from .look import check_finite, joint_state
from .look import observe as observe_drums
from .move import ledger as ledger_of_joints
from .move import move
from .pose import cross, in_body, in_space

#: The models read these here.
__all__ = ["LAWS"]


@law
def at_joint(u, v, l, bx, by, bz):
    """Where a place b of the upper body, from its centroid in space, is over the face below, in that drum's axes [m]."""
    ht = v.ht[l]
    x, y, z = u.x[l] + bx - v.x[l], u.y[l] + by - v.y[l], u.z[l] + bz - v.z[l]
    a, b, c = in_body(v, l, x, y, z)
    return a, b, c - ht, x, y, z


@law
def put(e, l, fx, fy, fz, ax, ay, az, bx, by, bz):
    """Adds a force on the upper body at b from its centroid, and its reaction at a from that of the lower one."""
    e.f[0, l] += fx
    e.f[1, l] += fy
    e.f[2, l] += fz
    mx, my, mz = cross(bx, by, bz, fx, fy, fz)
    e.up[0, l] += mx
    e.up[1, l] += my
    e.up[2, l] += mz
    mx, my, mz = cross(ax, ay, az, fx, fy, fz)
    e.lo[0, l] -= mx
    e.lo[1, l] -= my
    e.lo[2, l] -= mz


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
        bx, by, bz = in_space(u, l, k.mbx[l], k.mby[l], k.mbz[l])
        a, b, c, ax, ay, az = at_joint(u, v, l, bx, by, bz)
        px, py = a - k.mpx[l], b - k.mpy[l]
        size = math.sqrt(px * px + py * py)
        each = 1.0 / max(size, 1e-300)
        px, py = px * each, py * each
        held, more, back, whole, out = shear(
            size, k.mgap[l], yields, stiffness, c - k.mh[l], deepest, reach, k.mon[l], k.mout[l], brittle
        )
        mx, my = a - k.msx[l], b - k.msy[l]
        far = math.sqrt(mx * mx + my * my)
        snapped = (k.mon[l] > 0.0) & (whole == 0.0)  # at its capacity
        whole = 0.0 if (far > lost) & (out == 0.0) else whole  # one out of its hole is not bent
        acts = whole * (1.0 - out)
        held = held * acts
        k.mpeak[l] = max(k.mpeak[l], stiffness * yields if snapped else held)
        old = k.mfx[l] * k.mfx[l] + k.mfy[l] * k.mfy[l]
        k.mlost[l] += half * old * (1.0 - acts) + held * more
        move = back + more * (1.0 - crush)
        k.mpx[l] += px * move
        k.mpy[l] += py * move
        k.mgap[l] += more * crush
        fa, fb = -px * held, -py * held
        k.mfx[l] = fa
        k.mfy[l] = fb
        k.mslip[l] = far
        k.mon[l] = whole
        k.mout[l] = out
        fx, fy, fz = in_space(v, l, fa, fb, 0.0)
        put(e, l, fx, fy, fz, ax, ay, az, bx, by, bz)


@law
def slipping(u, v, l, ax, ay, az, bx, by, bz):
    """Speed of slip of a place as seen from the drum below, along its axes [m/s]."""
    wx, wy, wz = cross(u.wx[l], u.wy[l], u.wz[l], bx, by, bz)
    vx, vy, vz = cross(v.wx[l], v.wy[l], v.wz[l], ax, ay, az)
    va, vb, _ = in_body(v, l, u.vx[l] + wx - v.vx[l] - vx, u.vy[l] + wy - v.vy[l] - vy, u.vz[l] + wz - v.vz[l] - vz)
    return va, vb


@apart
def slowed(drum, joint, lane, m):
    """Adds the dashpot of a layer."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    e = joint[k.mlow]
    dash = k.mc
    for l in range(LANES):
        bx, by, bz = in_space(u, l, k.mbx[l], k.mby[l], k.mbz[l])
        _, _, _, ax, ay, az = at_joint(u, v, l, bx, by, bz)
        va, vb = slipping(u, v, l, ax, ay, az, bx, by, bz)
        fa, fb = -dash * va * k.mon[l], -dash * vb * k.mon[l]
        k.mdrag[l] -= 0.5 * k.mdt[l] * ((fa + k.mdx[l]) * va + (fb + k.mdy[l]) * vb)
        k.mdx[l] = fa
        k.mdy[l] = fb
        fx, fy, fz = in_space(v, l, fa, fb, 0.0)
        put(e, l, fx, fy, fz, ax, ay, az, bx, by, bz)


@apart
def against_opening(drum, joint, lane, m):
    """Adds what a bar holds against the opening of a joint at its place."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    e = joint[k.mlow]
    for l in range(LANES):
        bx, by, bz = in_space(u, l, k.mbx[l], k.mby[l], k.mbz[l])
        _, _, c, ax, ay, az = at_joint(u, v, l, bx, by, bz)
        pull = pulled(k, l, c)
        put(e, l, -pull * v.kx[l], -pull * v.ky[l], -pull * v.kz[l], ax, ay, az, bx, by, bz)


@apart
def straight(drum, joint, lane, m):
    """Adds a tie or core between two points."""
    k = lane[m]
    low, up = k.mlow, k.mup
    v = drum[low]
    u = drum[up]
    above = joint[up - 1]
    below = joint[low]
    for l in range(LANES):
        ax, ay, az = in_space(v, l, k.max[l], k.may[l], k.maz[l])
        bx, by, bz = in_space(u, l, k.mbx[l], k.mby[l], k.mbz[l])
        dx, dy, dz = u.x[l] + bx - v.x[l] - ax, u.y[l] + by - v.y[l] - ay, u.z[l] + bz - v.z[l] - az
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        size = -pulled(k, l, length) / max(length, 1e-12)
        fx, fy, fz = size * dx, size * dy, size * dz
        for q in range(low, up):  # what is between passes it on
            joint[q].f[0, l] += fx
            joint[q].f[1, l] += fy
            joint[q].f[2, l] += fz
        mx, my, mz = cross(bx, by, bz, fx, fy, fz)
        above.up[0, l] += mx
        above.up[1, l] += my
        above.up[2, l] += mz
        mx, my, mz = cross(ax, ay, az, fx, fy, fz)
        below.lo[0, l] -= mx
        below.lo[1, l] -= my
        below.lo[2, l] -= mz


@kernel
def add_links(drum, joint, lane):
    """Adds the forces of all links; brings their memory from t_{n−1} to t_n."""
    add_all(straight, across, slowed, against_opening, drum, joint, lane)


@apart
def slack_left(drum, lane, m):
    """Notes how far a dowel is from leaving its slack in every lane."""
    k = lane[m]
    u = drum[k.mup]
    v = drum[k.mlow]
    for l in range(LANES):
        bx, by, bz = in_space(u, l, k.mbx[l], k.mby[l], k.mbz[l])
        a, b, _, ax, ay, az = at_joint(u, v, l, bx, by, bz)
        va, vb = slipping(u, v, l, ax, ay, az, bx, by, bz)
        size = length_of(a - k.mpx[l], b - k.mpy[l])
        note_slack(k, l, size, length_of(a - k.msx[l], b - k.msy[l]), length_of(va, vb), CHUNK * k.mdt[l])


@law
def length_of(x, y):
    """Length of a vector in the plane of a joint."""
    return math.sqrt(x * x + y * y)


@kernel
def look_ahead(drum, joint, lane, watch):
    """Which links may hold something within the next chunk of steps: all but dowels far within their slack."""
    look_for_slack(slack_left, drum, lane, watch)


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n; see ``move.py``. What links hold is elastic."""
    ledger_of_joints(drum, joint, lane, ground, k, dt, l, out)
    add_to_ledger(lane, l, out)


@kernel
def observe(drum, joint, lane, feed, watch):
    """Look at the links, then at the drums."""
    look_at_links(lane, feed, watch)
    observe_drums(drum, joint, lane, feed, watch)


on_rims, on_beds = rim_forces.forces, bed_forces.forces
on_corners, on_chips = corner_forces.forces, chipped_forces.forces


@kernel
def rims(drum, joint, lane):
    """Forces of joints on rims, and of links."""
    on_rims(drum, joint, lane)
    add_links(drum, joint, lane)


@kernel
def beds(drum, joint, lane):
    """Forces of joints on elastic beds, and of links."""
    on_beds(drum, joint, lane)
    add_links(drum, joint, lane)


@kernel
def corners(drum, joint, lane):
    """Forces of joints on corners, and of links."""
    on_corners(drum, joint, lane)
    add_links(drum, joint, lane)


@kernel
def chips(drum, joint, lane):
    """Forces of joints of chipped round drums, and of links."""
    on_chips(drum, joint, lane)
    add_links(drum, joint, lane)


@kernel
def advance_rims(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, look_ahead, rims, move, check_finite, observe, state, chunks)


@kernel
def advance_beds(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, look_ahead, beds, move, check_finite, observe, state, chunks)


@kernel
def advance_corners(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, look_ahead, corners, move, check_finite, observe, state, chunks)


@kernel
def advance_chips(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, look_ahead, chips, move, check_finite, observe, state, chunks)


def _law(forces, advance):
    return SimpleNamespace(forces=forces, advance=advance, ledger=ledger, joint_state=joint_state)


#: What a model asks of the module of a law, by that module's name.
LAWS = {
    "rim_forces": _law(rims, advance_rims),
    "bed_forces": _law(beds, advance_beds),
    "corner_forces": _law(corners, advance_corners),
    "chipped_forces": _law(chips, advance_chips),
}
