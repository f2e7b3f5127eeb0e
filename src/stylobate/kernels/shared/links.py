"""Links between bodies over lanes: the law of what crosses a joint and of what is tied, and what is looked at.

The same law in the plane and in space: of lengths and sizes, with directions left to the loop that asks. Dowels and layers
hold against slip of a joint at their place, bars also against its opening there, ties and cores along the line between two
points. Whoever computes a force puts it on both bodies at the same place, so that momentum is kept.

Records and legend: ``records.py``.
"""

from ..jit import apart, chosen, kernel, law, strict
from ..run_codes import RUNNING
from .records import rows

#: Look ahead at what moves: at so many times the present speed, and at so much acceleration [m/s²].
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
    whole, stiffness, old = k.on[l], k.ka[l], k.ft[l]
    pull, more = tension(length, k.l0[l], stiffness, k.fa[l], whole)
    long = length - k.h[l]
    whole = 0.0 if long > k.ua[l] else whole
    pull = pull * whole
    k.lost[l] += released(old, 0.0, stiffness) * (1.0 - whole) + pull * more
    k.l0[l] += more
    k.ft[l] = pull
    k.pull[l] = max(k.pull[l], pull)
    k.on[l] = whole
    k.long[l] = long
    return pull


@law
def link_force(size, gap, yields, stiffness, lift, deepest, reach, whole, out, brittle, crush, far, lost, old):
    """Resistance of a link to a way of a size from where it is free: force; how far that place and the slack go on; heat;
    whole, out; and the largest force.  # Eq. (K1)

    ``old`` is the square of its force a step ago.
    """
    force, more, back, still, out = shear(size, gap, yields, stiffness, lift, deepest, reach, whole, out, brittle)
    largest = stiffness * yields if (whole > 0.0) & (still == 0.0) else 0.0  # it snapped at its capacity
    still = 0.0 if (far > lost) & (out == 0.0) else still  # one out of its hole is not bent
    acts = still * (1.0 - out)
    force *= acts
    heat = 0.5 * old / max(stiffness, 1e-300) * (1.0 - acts) + force * more
    return force, back + more * (1.0 - crush), more * crush, heat, still, out, max(largest, force)


@law
def note_slip(k, l, wider, heat, most, far, lift, whole, out):
    """Memory of a link that holds against slip, but for where it is free and its force, which have the directions of it."""
    k.gap[l] += wider
    k.lost[l] += heat
    k.peak[l] = max(k.peak[l], most)
    k.slip[l] = far
    k.long[l] = lift
    k.on[l] = whole
    k.out[l] = out


@law
def clamped(k, b, l, length):
    """Force of a clamp along itself at a length, tension positive, and its memory: as in shear, in both senses."""
    long = length - k.h[l]
    way = long - k.l0[l]
    side = 1.0 if way > 0.0 else -1.0
    force, on, wider, heat, whole, _, most = link_force(
        abs(way), k.back[l], b.ya, k.ka[l], 0.0, 1.0, 0.0, k.on[l], 0.0, b.bra, b.cra, abs(long), k.ua[l],
        k.ft[l] * k.ft[l],
    )  # fmt: skip
    pull = side * force
    k.l0[l] += side * on
    k.back[l] += wider
    k.lost[l] += heat
    k.pull[l] = max(k.pull[l], most)
    k.ft[l] = pull
    k.on[l] = whole
    k.long[l] = long
    return pull


@law
def begun(k, b, l, length):
    """Lets a link begin at a lift or length: whole, and free of force but for what it is pretensioned by, ``ft``."""
    free = -k.ft[l] / k.ka[l] if k.ft[l] > 0.0 else 0.0
    k.h[l] = length
    k.l0[l] = free if b.both != 0 else length + free
    k.pull[l] = k.ft[l]
    k.fx[l] = k.fy[l] = k.peak[l] = k.dx[l] = k.dy[l] = k.lost[l] = k.drag[l] = 0.0
    k.slip[l] = k.long[l] = k.far[l] = k.most[l] = k.out[l] = 0.0
    k.on[l] = 1.0
    k.when[l] = -1


@law
def note_slack(k, l, size, far, speed, time):
    """Notes of a dowel whose slip is so large and grows so fast by how much it may leave its slack within a time [s]."""
    way = SPEEDS * speed * time + HASTE * time * time
    holds = (k.fx[l] != 0.0) | (k.fy[l] != 0.0) | (k.out[l] > 0.0)
    k.over[l] = time if holds else size + way - k.gap[l]
    k.slip[l] = far


@kernel
def some_leaves(link, m, watch):
    """Whether a dowel may leave its slack in some lane whose run goes on."""
    over = link[m].over
    for l in range(over.shape[0]):
        if watch[0].status[l] == RUNNING and over[l] > 0.0:
            return True
    return False


@law
def released(force, other, stiffness):
    """Elastic energy of a spring under a force of two components [J]."""
    return 0.5 * (force * force + other * other) / max(stiffness, 1e-300)


@apart
def note_peaks(link, bond, m):
    """Peaks of slip, and of lift or elongation; those of forces are kept at every step."""
    k = link[m]
    b = bond[m]
    pressed = b.both != 0  # a clamp may be lost by being pressed, too
    for l in range(k.far.shape[0]):
        k.far[l] = max(k.far[l], k.slip[l])
        k.most[l] = max(k.most[l], abs(k.long[l]) if pressed else k.long[l])


@law
def handed_over(k, l):
    """Heat of a link and of its dashpot since it was asked last [J]."""
    lost, drag = k.lost[l], k.drag[l]
    k.lost[l] = k.drag[l] = 0.0
    return lost, drag


@law
def note_break(k, l, step):
    """Notes of a link that is lost the step after which it was seen first."""
    if k.on[l] == 0.0 and k.when[l] < 0:
        k.when[l] = step


@kernel
def look_at_links(link, bond, lane, feed, watch):
    """Between chunks of steps: peaks, links that have broken, what they have made heat of."""
    o = lane[0]
    w = watch[0]
    for m in range(link.shape[0]):
        k = link[m]
        b = bond[m]
        note_peaks(link, bond, m)
        if b.near == 0:
            continue
        for l in range(k.on.shape[0]):
            lost, drag = handed_over(k, l)
            o.shear[l] += lost
            o.visc[l] += drag
            if w.status[l] == RUNNING:
                note_break(k, l, feed[0].step[l])


@kernel
def look_at_hold(link, hold, pair, joints):
    """Resistance of whole links about every joint of a column that they cross; link m is contact ``joints + m``."""
    for j in range(hold.shape[0]):
        hold[j].moment[:] = 0.0
    for m in range(link.shape[0]):
        k = link[m]
        contact = pair[joints + m]
        for j in range(contact.lower, contact.upper):
            if j < hold.shape[0]:
                for l in range(k.on.shape[0]):
                    hold[j].moment[l] += k.whole[l] if k.on[l] > 0.0 else 0.0


@chosen
def add_to_ledger(link, bond, l, out):
    """Adds elastic energy and heat of all links of a lane to its ledger [J], where there are some."""
    if rows(link, "none"):
        return lambda link, bond, l, out: None
    return lambda link, bond, l, out: add_links_to_ledger(link, bond, l, out)


@strict
def add_links_to_ledger(link, bond, l, out):
    """See :func:`add_to_ledger`."""
    for m in range(link.shape[0]):
        k = link[m]
        b = bond[m]
        out[3] += released(k.fx[l], k.fy[l], b.ks) + released(k.ft[l], 0.0, k.ka[l])
        out[4] += k.lost[l]
        out[5] += k.drag[l]
