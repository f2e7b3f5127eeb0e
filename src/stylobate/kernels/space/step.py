"""The step of bodies in space of which any two may touch: forces, motion, list of pairs, and the ledger.

State, a tuple in this order: body, shape, vertex, plane, loop, corner, pair, spare, joint, edge, law, now, feed, ground,
the workspaces of a contact, of a joint and of a search, and the links; see ``records.py``.
"""

import math

from ..dem3d.look import ground_at
from ..jit import kernel, strict
from ..run_codes import CHUNK, FAILED
from ..shared.links import add_to_ledger
from .acting import let_go
from .bed import alone, foresee, forget, gather, press, touching
from .friction import spring_energy_of
from .joints import on_joint
from .links import add_links, look_at_links
from .motion import check, kinetic_and_gravitational, move
from .overlap import INNER
from .search import list_pairs

#: A step is taken in parts of which none is longer than this over the circular frequency of the stiffest contact.
PART = 0.25

#: Most parts of a step.
MOST_PARTS = 8


@kernel
def forces(state):
    """Forces of all contacts on all bodies at t_n; brings their memory from t_{n−1} to t_n."""
    body, shape, vertex, plane, loop, corner, pair, _, joint, edge, law, now_, feed, _, work, places, simplex, ties = (
        state
    )
    now = now_[0]
    for i in range(body.shape[0]):
        for c in range(3):
            body[i].f[c] = body[i].mo[c] = 0.0
    now.rate = 0.0
    total = work[10]
    contacts = 0
    up, arcs, sums = places
    for j in range(joint.shape[0]):
        e = joint[j]
        if e.live != 0:
            on_joint(e, body[shape[e.a].body], body[shape[e.b].body], edge, up, arcs, sums, now)
    for k in range(now.pairs):
        p = pair[k]
        a = shape[p.a]
        b = shape[p.b]
        u = body[a.body]
        v = body[b.body]
        joined = p.joint >= 0 and joint[p.joint].live != 0
        share = 1.0 - joint[p.joint].weight if joined else 1.0
        p.share = 0.0
        wide = 2.0 * min(u.r, v.r)
        if share > 0.0 and touching(p, a, u, b, v, vertex, plane, loop, corner, wide, work, simplex):
            p.share = share
            contacts += 1
            for m in range(total.shape[0]):
                p.total[m] = total[m]
            alone(p)
            # what a joint has held and handed over strikes only when it has been apart
            if now.touched < 0 and (p.joint < 0 or (not joined and p.area == 0.0)):
                now.touched = feed[0].step[0]
        elif share > 0.0:
            if p.area > 0.0:
                let_go(p, u, v, now)
                forget(p)
            stiffness = share * law[a.body, b.body, 0]
            foresee(p, a, u, b, v, vertex, plane, loop, corner, wide, stiffness, now, work)
    for k in range(now.pairs if contacts > 1 else 0):
        if pair[k].share > 0.0 and pair[k].total[INNER] > 0.0:
            gather(pair, now.pairs, shape, pair[k])
    for k in range(now.pairs if contacts > 0 else 0):
        p = pair[k]
        if p.share > 0.0:
            a, b = shape[p.a], shape[p.b]
            press(p, a, body[a.body], b, body[b.body], vertex, law[a.body, b.body], now, simplex)
    add_links(body, ties, now.last)


@kernel
def list_all(state):
    """List anew all pairs of shapes that may touch."""
    body, shape, vertex, _, _, _, pair, spare, joint, _, _, now, _, _, _, _, simplex, _ = state
    list_pairs(body, shape, vertex, pair, spare, joint, now[0], simplex)


@kernel
def advance(state, chunks):
    """Advance by ``chunks`` × CHUNK steps."""
    body, _, _, _, _, _, _, _, _, _, _, now_, feed, ground, _, _, _, ties = state
    now = now_[0]
    for _ in range(chunks):
        for k in range(CHUNK + 1):
            ground_at(ground[k], feed[0], feed[0].last[0] > 0, k, 0)
        for k in range(CHUNK):
            now.kick = 0.5 * (now.last + now.dt)
            forces(state)
            parts = min(max(math.ceil(now.dt * math.sqrt(now.rate) / PART), 1), MOST_PARTS)
            g = ground[k].a
            h = ground[k + 1].a
            each = 1.0 / parts
            for q in range(parts):
                x = q * each
                y = x + each
                if q > 0:
                    now.kick = now.last
                    forces(state)
                farthest = move(
                    body,
                    now,
                    (
                        g[0, 0] + x * (h[0, 0] - g[0, 0]),
                        g[1, 0] + x * (h[1, 0] - g[1, 0]),
                        g[2, 0] + x * (h[2, 0] - g[2, 0]),
                    ),
                    (
                        g[0, 0] + y * (h[0, 0] - g[0, 0]),
                        g[1, 0] + y * (h[1, 0] - g[1, 0]),
                        g[2, 0] + y * (h[2, 0] - g[2, 0]),
                    ),
                    now.dt * each,
                )
                if farthest > 0.5 * now.skin:
                    list_all(state)
            feed[0].step[0] += 1
        look_at_links(ties, now, feed[0].step[0])
        check(body, now)
        if now.status == FAILED:
            break


@strict
def ledger(state, a, out):
    """Ledger at t_n, after the forces there: input, kinetic, gravitational, elastic, friction, viscous [J].

    The middle three are absolute. ``a`` is the acceleration of the base at t_n.
    """
    body, _, _, _, _, _, pair, _, joint, _, _, now_, _, _, _, _, _, ties = state
    now = now_[0]
    elastic = 0.0
    spring_energy = 0.0
    for j in range(joint.shape[0]):
        elastic += joint[j].en
        spring_energy += spring_energy_of(joint[j])
    for k in range(now.pairs):
        elastic += pair[k].en
        spring_energy += spring_energy_of(pair[k])
    kinetic, height = kinetic_and_gravitational(body, now, (a[0], a[1], a[2]))
    out[0] = now.work
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + spring_energy
    out[4] = now.shear - spring_energy
    out[5] = now.visc
    add_to_ledger(ties[0], ties[1], 0, out)
