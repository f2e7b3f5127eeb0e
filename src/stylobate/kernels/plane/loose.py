"""Loose bodies: one lane of bodies of which any two may touch, with the search for what does.

A joint hands over to the bed (``bed.py``) by a weight that is a function of the relative rotation and of the overlap alone,
so that no force jumps; once the weight has reached zero the joint is gone. Where the step changes, velocities in the middle
of steps are half of both apart.

Legend, besides the records of one lane (``records.py``) and ``search.py``; a search is a tuple of these in this order::

    now         dt last         step, and the last one taken [s]: while bodies may strike each other, or a joint hands over
                                (``loose`` > 0), or joints are dull, a step is taken in ``finer`` equal parts
                eta calm        restitution of the bed: F is larger by eta while it closes, smaller while it opens; below the
                                speed ``calm`` [m/s] in proportion to it; ``dull`` is the same of the joints
                skin deepest    of the boxes; largest depth of the bed so far [m]
                pairs touched   pairs of the search; first step with a foreign contact, −1
    hand[j]     width           the smaller of a joint's two faces [m]
                from_c to_c     cosines of the relative rotations from which the bed acts too, and alone
                weight          1 joint, 0 bed, between them both
                live            0: the faces have parted for good
    shape corner box order
    joined[a, b]   their joint or −1
    law[a, b]   bed of a pair, a < b: k_n, k_s [N/m³], tan φ [-]
    memory[a, b]   shear force of their bed, its normal and tangential dashpot forces [N]
    real whole  workspace
"""

import math

import numpy as np

from ..jit import kernel, strict
from ..run_codes import CHUNK, FAILED
from ..shared.handover import handover
from ..shared.records import BODY, BOND, FEED, GROUND, JOINT, LANE, LINK, LOAD, PAIR, SPAN, TOUCH, WATCH
from . import clip as near
from . import contact as ct
from .bed import bed_forces, stored_by_bed
from .links import link_forces, set_step
from .motion import drift, gather
from .point_joint import meeting, press, put, stored
from .records import ALPHA, BETA, LOCAL
from .search import place, renew_pairs
from .step import energies, fill_ground, look_at

MOST = near.MOST


def search_types():
    """Record types (now, hand, shape)."""

    def fields(names):
        return [(name, np.float64) for name in names.split()]

    def counts(names):
        return [(name, np.int64) for name in names.split()]

    return (
        np.dtype(fields("dt last eta dull calm skin deepest") + counts("pairs touched loose finer")),
        np.dtype(fields("width from_c to_c weight") + counts("live")),
        np.dtype(fields("r depth travel") + counts("first count")),
    )


@kernel
def loose_joints(body, joint, load, pair, lane, now, hand):
    """Forces of all joints that are left at t_n; brings their contact memory from t_{n−1} to t_n."""
    o = lane[0]
    dull = now[0].dull
    damped = o.damp[BETA, 0] > 0.0 or dull > 0.0
    for j in range(joint.shape[0]):
        h = hand[j]
        if h.live == 0:
            continue
        u = body[pair[j].upper]
        v = body[pair[j].lower]
        e = joint[j]
        at = meeting(u, v, e, 0)
        weight = handover(at[4], at[12], h)
        h.weight = weight
        if weight == 0.0:
            h.live = 0
            # what the springs still hold is lost with them
            e.over[0] = at[12]
            for p in range(e.fs.shape[0]):
                e.fs[p, 0] = e.fn[p, 0] = e.dn[p, 0] = e.ds[p, 0] = 0.0
            put(load[j], 0, at[0], at[1], 0.0, 0.0, 0.0, 0.0)
            continue
        sum_s, sum_q, upper, lower, shear, visc = press(u, v, e, o, 0, damped, dull, now[0].calm, now[0].last, at)
        if weight < 1.0:
            sum_s *= weight
            sum_q *= weight
            upper *= weight
            lower *= weight
            shear *= weight
            visc *= weight
        put(load[j], 0, at[0], at[1], sum_s, sum_q, upper, lower)
        o.shear[0] += shear
        o.visc[0] += visc


@kernel
def loose_forces(state, search):
    """Forces of all contacts on all bodies at t_n; brings their memory from t_{n−1} to t_n."""
    now, hand, shape, corner, _, _, joined, law, memory, real, whole = search
    body, joint, load, link, lane, pair = state[BODY], state[JOINT], state[LOAD], state[LINK], state[LANE], state[PAIR]
    loose_joints(body, joint, load, pair, lane, now, hand)
    set_step(link, now[0].last)
    link_forces(body, joint, load, link, state[BOND], pair)
    start = joint.shape[0] + link.shape[0]
    beta = lane[0].damp[BETA, 0]
    step = state[FEED][0].step[0]
    bed_forces(body, load, lane, pair, start, beta, now, hand, shape, corner, joined, law, memory, real, whole, step)
    gather(body, load, state[SPAN], state[TOUCH])


@kernel
def move_loose(state, search, gx, gz, gx1, gz1, dt):
    """Motion of all bodies over the next step ``dt``, with the ground's acceleration at its two ends.

    Returns the longest way since the boxes were made.
    """
    now, _, shape, _, _, _, _, _, _, _, _ = search
    body, o = state[BODY], state[LANE][0]
    kick = 0.5 * (now[0].last + dt)
    now[0].last = dt
    o.px[0] = 0.0
    o.pz[0] = 0.0
    damped = o.damp[ALPHA, 0] > 0.0 or o.damp[LOCAL, 0] > 0.0
    farthest = 0.0
    for i in range(body.shape[0]):
        if state[SPAN][i].fixed != 0:
            continue
        u = body[i]
        s = shape[i]
        drift(u, o, o, 0, u.fx[0], u.fz[0], u.mo[0], gx, gz, kick, dt, damped)
        s.travel += (abs(u.vx[0]) + abs(u.vz[0]) + s.r * abs(u.w[0])) * dt
        farthest = max(farthest, s.travel)
    o.work[0] -= (0.5 * (gx + gx1) * o.px[0] + 0.5 * (gz + gz1) * o.pz[0]) * dt
    return farthest


@kernel
def may_come_loose(state, search, time):
    """Whether bodies that are not joined may touch, or a joint may hand over, within a time at twice today's speeds."""
    now, hand, shape, corner, _, _, joined, _, _, real, _ = search
    body, joint, pair, g = state[BODY], state[JOINT], state[PAIR], state[LANE][0].g[0]
    fastest = 0.0
    for i in range(body.shape[0]):
        u = body[i]
        speed = math.sqrt(u.vx[0] * u.vx[0] + u.vz[0] * u.vz[0])
        fastest = max(fastest, speed + shape[i].r * abs(u.w[0]) + g * time)
    keep = now[0].skin
    now[0].skin = keep + 4.0 * fastest * time
    renew_pairs(state, search)
    now[0].skin = keep
    xa, za, xb, zb, _, _, _, _ = real
    start = joint.shape[0] + state[LINK].shape[0]
    for k in range(start, start + now[0].pairs):
        i, h = pair[k].lower, pair[k].upper
        if joined[i, h] < 0:
            a = body[i]
            b = body[h]
            na = place(a, shape[i], corner, xa, za)
            nb = place(b, shape[h], corner, xb, zb)
            closing = math.hypot(b.vx[0] - a.vx[0], b.vz[0] - a.vz[0])
            closing += shape[i].r * abs(a.w[0]) + shape[h].r * abs(b.w[0])
            gap = max(near.separation(xa, za, na, xb, zb, nb), near.separation(xb, zb, nb, xa, za, na))
            if gap < 2.0 * (closing + g * time) * time:
                return True
    for j in range(joint.shape[0]):
        e = joint[j]
        u = body[pair[j].upper]
        v = body[pair[j].lower]
        cl, sl, ps, pq, c, _, _, _, _, _, lo, hi, _ = meeting(u, v, e, 0)
        dvx = u.vx[0] - v.vx[0]
        dvz = u.vz[0] - v.vz[0]
        slip, _ = ct.contact_velocity(
            ps, 0.0, 0.0, 1.0, ps, pq, e.ht[0], cl * dvx + sl * dvz, cl * dvz - sl * dvx, u.w[0], v.w[0]
        )
        turning = abs(u.w[0] - v.w[0])
        more = 2.0 * (abs(slip) + turning * hand[j].width + g * time) * time
        turned = math.acos(min(max(c, -1.0), 1.0)) + 2.0 * turning * time
        if handover(math.cos(min(turned, math.pi)), hi - lo - more, hand[j]) < 1.0:
            return True
    return False


@strict
def ledger_loose(state, search, gx, gz, dt, out):
    """Ledger at t_n, after the forces there: see ``step.energies``; the joints by their weight, and the bed."""
    now, hand, shape, corner, _, _, joined, law, memory, real, whole = search
    joint, o = state[JOINT], state[LANE][0]
    elastic = 0.0
    shear_energy = 0.0
    for j in range(joint.shape[0]):
        if hand[j].live != 0:
            elastic, shear_energy = stored(joint[j], o, 0, hand[j].weight, elastic, shear_energy)
    start = joint.shape[0] + state[LINK].shape[0]
    pressed, sheared = stored_by_bed(
        state[BODY], state[PAIR], start, now, hand, shape, corner, joined, law, memory, real, whole
    )
    energies(state, elastic + pressed, shear_energy + sheared, gx, gz, dt, 0, out)


@kernel
def advance_loose(state, search, chunks):
    """Advance by ``chunks`` × CHUNK steps."""
    now = search[0][0]
    ground, feed, watch = state[GROUND], state[FEED], state[WATCH]
    for _ in range(chunks):
        fill_ground(ground, feed, watch)
        for k in range(CHUNK):
            parts = now.finer if now.loose > 0 or now.dull > 0.0 else 1
            x0 = ground[k].ax[0]
            z0 = ground[k].az[0]
            dx = (ground[k + 1].ax[0] - x0) / parts
            dz = (ground[k + 1].az[0] - z0) / parts
            for q in range(parts):
                loose_forces(state, search)
                farthest = move_loose(
                    state, search, x0 + q * dx, z0 + q * dz, x0 + (q + 1) * dx, z0 + (q + 1) * dz, now.dt / parts
                )
                if farthest > 0.5 * now.skin:
                    renew_pairs(state, search)
            feed[0].step[0] += 1
        look_at(state)
        if watch[0].status[0] == FAILED:
            break
