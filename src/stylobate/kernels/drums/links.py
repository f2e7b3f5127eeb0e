"""Links between drums over lanes: the law of what crosses a joint and of what is tied, and their records.

The same law in the plane and in space: of lengths and sizes, with directions left to the loop that asks. Dowels and layers
hold against slip of a joint at their place, bars also against its opening there, ties and cores along the line between two
points. Whoever computes a force puts it on both bodies at the same place, so that momentum is kept.

Records and legend: ``link_records.py``.
"""

from ..jit import apart, kernel, law, strict
from ..run_codes import LANES, RUNNING

#: How far what moves is looked ahead: at so many times the present speed, and at so much acceleration [m/s²].
SPEEDS, HASTE = 3.0, 100.0


@law
def shear(size, gap, yields, stiffness, lift, deepest, reach, whole, out, brittle):
    """Law of a dowel at a slip of a size from where it is free: force, what yields, what it is pushed back, whole, out.

    Eq. (K1). Within its slack it holds nothing; beyond, it is elastic up to where it yields. Lifted out of its hole it holds
    nothing until it is back over it, by its slack and reach at most, and then begins without force.
    """
    over = max(size - gap, 0.0)
    away = (lift >= deepest) | ((out > 0.0) & (over > reach))
    back = over if (out > 0.0) & (not away) else 0.0
    acts = 0.0 if away else whole
    over = (over - back) * acts
    more = max(over - yields, 0.0)
    snaps = (more > 0.0) & (brittle > 0.0)
    force = 0.0 if snaps else stiffness * (over - more)
    return force, (0.0 if snaps else more), back, (0.0 if snaps else whole), (1.0 if away else 0.0)


@law
def tension(length, free, stiffness, capacity, whole):
    """Law of a tie at a length: tension, and what yields. It does not push.  # Eq. (K2)"""
    over = max(length - free, 0.0) * whole
    pull = min(stiffness * over, capacity)
    more = over - pull / max(stiffness, 1e-300)
    return pull, more


@law
def pulled(k, l, length):
    """Tension of a link at a length, and its memory."""
    whole, stiffness, old = k.mon[l], k.mka[l], k.mft[l]
    pull, more = tension(length, k.ml0[l], stiffness, k.mfa[l], whole)
    long = length - k.mh[l]
    whole = 0.0 if long > k.mua[l] else whole
    pull = pull * whole
    k.mlost[l] += released(old, 0.0, stiffness) * (1.0 - whole) + pull * more
    k.ml0[l] += more
    k.mft[l] = pull
    k.mpull[l] = max(k.mpull[l], pull)
    k.mon[l] = whole
    k.mlong[l] = long
    return pull


@law
def note_slack(k, l, size, far, speed, time):
    """Notes of a dowel whose slip is so large and grows so fast by how much it may leave its slack within a time [s]."""
    way = SPEEDS * speed * time + HASTE * time * time
    holds = (k.mfx[l] != 0.0) | (k.mfy[l] != 0.0) | (k.mout[l] > 0.0)
    k.mover[l] = time if holds else size + way - k.mgap[l]
    k.mslip[l] = far


@kernel
def some_leaves(lane, m, watch):
    """Whether a dowel may leave its slack in some lane whose run goes on."""
    over = lane[m].mover
    for l in range(LANES):
        if watch[0].status[l] == RUNNING and over[l] > 0.0:
            return True
    return False


@law
def released(force, other, stiffness):
    """Elastic energy of a spring under a force of two components [J]."""
    return 0.5 * (force * force + other * other) / max(stiffness, 1e-300)


@apart
def note_peaks(lane, m):
    """Peaks of slip, and of lift or elongation; those of forces are kept at every step."""
    k = lane[m]
    for l in range(LANES):
        k.mfar[l] = max(k.mfar[l], k.mslip[l])
        k.mmost[l] = max(k.mmost[l], k.mlong[l])


@kernel
def look_at_links(lane, feed, watch):
    """Between chunks of steps: peaks, links that have broken, what they have made heat of, what the whole ones can hold."""
    o = lane[0]
    w = watch[0]
    w.hold[:] = 0.0
    for m in range(1, lane.shape[0]):
        k = lane[m]
        note_peaks(lane, m)
        for j in range(k.mlow, k.mup):
            for l in range(LANES):
                w.hold[j * LANES + l] += k.mhold[l] if k.mon[l] > 0.0 else 0.0
        if k.mnear == 0:
            continue
        for l in range(LANES):
            o.shear[l] += k.mlost[l]
            o.visc[l] += k.mdrag[l]
            k.mlost[l] = k.mdrag[l] = 0.0
            if k.mon[l] == 0.0 and k.mwhen[l] < 0 and w.status[l] == RUNNING:
                k.mwhen[l] = feed[0].step[l]


@strict
def add_to_ledger(lane, l, out):
    """Adds elastic energy and heat of all links of a lane to its ledger [J]."""
    for m in range(1, lane.shape[0]):
        k = lane[m]
        out[3] += released(k.mfx[l], k.mfy[l], k.mks) + released(k.mft[l], 0.0, k.mka[l])
        out[4] += k.mlost[l]
        out[5] += k.mdrag[l]


@law
def add_all(straight, across, slowed, against_opening, drum, joint, lane):
    """Adds the forces of all links to those of the joints; a model gives its loop over the lanes for each kind of force."""
    for m in range(1, lane.shape[0]):
        k = lane[m]
        if k.mline != 0:
            straight(drum, joint, lane, m)
        elif k.mnear != 0:
            if k.mks > 0.0:
                across(drum, joint, lane, m)
            if k.mc > 0.0:
                slowed(drum, joint, lane, m)
            if k.mten != 0:
                against_opening(drum, joint, lane, m)


@law
def look_for_slack(slack_left, drum, lane, watch):
    """Which links may hold something within the next chunk of steps: all but dowels far within their slack."""
    for m in range(1, lane.shape[0]):
        k = lane[m]
        if k.mline == 0 and k.mten == 0 and k.mc == 0.0:
            slack_left(drum, lane, m)
            k.mnear = 1 if some_leaves(lane, m, watch) else 0
