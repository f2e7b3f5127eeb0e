"""Links between bodies in the plane: the laws of links at places and along directions of the bodies.

Records and legend: ``shared/records.py``; the laws: ``shared/links.py``. Link m is contact ``joints + m``.
"""

import math

from ..jit import apart, chosen, kernel, law
from ..run_codes import CHUNK
from ..shared.links import (
    begun,
    clamped,
    link_force,
    look_at_hold,
    look_at_links,
    note_slack,
    note_slip,
    pulled,
    some_leaves,
)
from ..shared.records import rows
from .point_joint import face


@law
def at_place(u, v, k, l):
    """Place of the upper body: along the slip and across it, from the lower centroid; that direction; and from
    the lower and the upper centroid in the plane [m].
    """
    tc, ts = face(v, l, k.tc[l], k.ts[l])
    bx = u.c[l] * k.bx[l] - u.s[l] * k.bz[l]
    bz = u.s[l] * k.bx[l] + u.c[l] * k.bz[l]
    ax = u.x[l] + bx - v.x[l]
    az = u.z[l] + bz - v.z[l]
    return tc * ax + ts * az, tc * az - ts * ax, tc, ts, ax, az, bx, bz


@law
def slipping(u, v, l, tc, ts, ax, az, bx, bz):
    """Speed at which that place slips [m/s]."""
    return tc * (u.vx[l] - bz * u.w[l] - v.vx[l] + az * v.w[l]) + ts * (u.vz[l] + bx * u.w[l] - v.vz[l] - ax * v.w[l])


@law
def add(f, l, fx, fz, ax, az, bx, bz):
    """Adds a force on the upper body at b from its centroid, and its reaction at a from that of the lower one."""
    f.fx[l] += fx
    f.fz[l] += fz
    f.mu_[l] += bx * fz - bz * fx
    f.ml[l] += ax * fz - az * fx


@apart
def clear(load, k):
    """Lets a contact do nothing."""
    f = load[k]
    for l in range(f.fx.shape[0]):
        f.fx[l] = f.fz[l] = f.mu_[l] = f.ml[l] = 0.0


@apart
def across(body, load, link, bond, pair, n, m):
    """Adds a dowel, bar, layer or clamp: what holds against slip."""
    k = link[m]
    b = bond[m]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    f = load[n]
    for l in range(k.on.shape[0]):
        at_s, at_q, tc, ts, ax, az, bx, bz = at_place(u, v, k, l)
        far = abs(at_s - k.sx[l])
        long = at_q - k.h[l]
        way = at_s - k.px[l]
        side = 1.0 if way > 0.0 else -1.0
        force, on, wider, heat, whole, out, most = link_force(
            abs(way), k.gap[l], b.y, b.ks, long, b.deep, b.reach, k.on[l], k.out[l], b.br, b.cr, far, b.us,
            k.fx[l] * k.fx[l],
        )  # fmt: skip
        fs = -side * force
        k.px[l] += side * on
        k.fx[l] = fs
        note_slip(k, l, wider, heat, most, far, long, whole, out)
        add(f, l, tc * fs, ts * fs, ax, az, bx, bz)


@apart
def slowed(body, load, link, bond, pair, n, m):
    """Adds the dashpot of a layer."""
    k = link[m]
    b = bond[m]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    f = load[n]
    for l in range(k.on.shape[0]):
        _, _, tc, ts, ax, az, bx, bz = at_place(u, v, k, l)
        speed = slipping(u, v, l, tc, ts, ax, az, bx, bz)
        fs = -b.c * speed * k.on[l]
        k.drag[l] -= 0.5 * k.dt[l] * (fs + k.dx[l]) * speed
        k.dx[l] = fs
        add(f, l, tc * fs, ts * fs, ax, az, bx, bz)


@apart
def along_itself(body, load, link, bond, pair, n, m):
    """Adds what a clamp holds along itself, in both senses."""
    k = link[m]
    b = bond[m]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    f = load[n]
    for l in range(k.on.shape[0]):
        _, at_q, tc, ts, ax, az, bx, bz = at_place(u, v, k, l)
        pull = clamped(k, b, l, at_q)
        add(f, l, ts * pull, -tc * pull, ax, az, bx, bz)


@apart
def against_opening(body, load, link, pair, n, m):
    """Adds what a bar holds against the opening of a joint at its place."""
    k = link[m]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    f = load[n]
    for l in range(k.on.shape[0]):
        _, at_q, tc, ts, ax, az, bx, bz = at_place(u, v, k, l)
        pull = pulled(k, l, at_q)
        add(f, l, ts * pull, -tc * pull, ax, az, bx, bz)


@law
def ends(u, v, k, l):
    """Ends of a straight link from the centroids of its bodies, and the way from the lower to the upper one [m]."""
    ax = v.c[l] * k.ax[l] - v.s[l] * k.az[l]
    az = v.s[l] * k.ax[l] + v.c[l] * k.az[l]
    bx = u.c[l] * k.bx[l] - u.s[l] * k.bz[l]
    bz = u.s[l] * k.bx[l] + u.c[l] * k.bz[l]
    dx, dy, dz = u.x[l] + bx - v.x[l] - ax, k.by[l] - k.ay[l], u.z[l] + bz - v.z[l] - az
    return ax, az, bx, bz, dx, dz, math.sqrt(dx * dx + dy * dy + dz * dz)


@apart
def straight(body, load, link, pair, n, m):
    """Adds a tie or core between two points."""
    k = link[m]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    f = load[n]
    for l in range(k.on.shape[0]):
        ax, az, bx, bz, dx, dz, length = ends(u, v, k, l)
        # on the upper body, towards the lower end
        size = -pulled(k, l, length) / max(length, 1e-12)
        fx = size * dx
        fz = size * dz
        f.fx[l] += fx
        f.fz[l] += fz
        f.mu_[l] += bx * fz - bz * fx
        f.ml[l] += ax * fz - az * fx


@chosen
def link_forces(body, joint, load, link, bond, pair):
    """Forces of all links at t_n, where there are some; brings their memory from t_{n−1} to t_n."""
    if rows(link, "none"):
        return lambda body, joint, load, link, bond, pair: None
    return lambda body, joint, load, link, bond, pair: add_links(body, joint, load, link, bond, pair)


@kernel
def add_links(body, joint, load, link, bond, pair):
    """See :func:`link_forces`."""
    for m in range(link.shape[0]):
        b = bond[m]
        n = joint.shape[0] + m
        if b.near == 0:
            continue
        clear(load, n)
        if b.line != 0:
            straight(body, load, link, pair, n, m)
            continue
        if b.ks > 0.0 or b.both != 0:
            across(body, load, link, bond, pair, n, m)
        if b.c > 0.0:
            slowed(body, load, link, bond, pair, n, m)
        if b.both != 0:
            along_itself(body, load, link, bond, pair, n, m)
        elif b.ten != 0:
            against_opening(body, load, link, pair, n, m)


@apart
def slack_left(body, link, pair, n, m):
    """Notes how far a dowel is from leaving its slack in every lane."""
    k = link[m]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    for l in range(k.on.shape[0]):
        at_s, _, tc, ts, ax, az, bx, bz = at_place(u, v, k, l)
        speed = slipping(u, v, l, tc, ts, ax, az, bx, bz)
        note_slack(k, l, abs(at_s - k.px[l]), abs(at_s - k.sx[l]), abs(speed), CHUNK * k.dt[l])


@chosen
def look_ahead(body, joint, load, link, bond, pair, watch):
    """Which links may hold something within the next chunk of steps: all but dowels far within their slack."""
    if rows(link, "none"):
        return lambda body, joint, load, link, bond, pair, watch: None
    return lambda body, joint, load, link, bond, pair, watch: look_for_slack(body, joint, load, link, bond, pair, watch)


@kernel
def look_for_slack(body, joint, load, link, bond, pair, watch):
    """See :func:`look_ahead`."""
    for m in range(link.shape[0]):
        b = bond[m]
        if b.line == 0 and b.ten == 0 and b.both == 0 and b.c == 0.0:
            n = joint.shape[0] + m
            slack_left(body, link, pair, n, m)
            b.near = 1 if some_leaves(link, m, watch) else 0
            if b.near == 0:
                clear(load, n)


@chosen
def look_at_all(joint, link, bond, lane, feed, watch, hold, pair):
    """Between chunks of steps: peaks and breaks of links, and what the whole ones hold of a column."""
    if rows(link, "none"):
        return lambda joint, link, bond, lane, feed, watch, hold, pair: None
    return lambda joint, link, bond, lane, feed, watch, hold, pair: look_at_links_and_hold(
        joint, link, bond, lane, feed, watch, hold, pair
    )


@kernel
def look_at_links_and_hold(joint, link, bond, lane, feed, watch, hold, pair):
    """See :func:`look_at_all`."""
    look_at_links(link, bond, lane, feed, watch)
    look_at_hold(link, hold, pair, joint.shape[0])


@chosen
def set_step(link, dt):
    """Lets the dashpots of all links know the step of one lane [s]."""
    if rows(link, "none"):
        return lambda link, dt: None

    def of_all(link, dt):
        for m in range(link.shape[0]):
            link[m].dt[0] = dt

    return of_all


@kernel
def begin(body, joint, link, bond, pair):
    """Lets all links begin where the bodies are now: whole, free of force but for what they are pretensioned by, ``ft``."""
    for m in range(link.shape[0]):
        k = link[m]
        b = bond[m]
        n = joint.shape[0] + m
        u = body[pair[n].upper]
        v = body[pair[n].lower]
        for l in range(k.on.shape[0]):
            _, _, _, _, _, _, length = ends(u, v, k, l)
            at_s, at_q, _, _, _, _, _, _ = at_place(u, v, k, l)
            k.sx[l] = k.px[l] = at_s
            begun(k, b, l, length if b.line != 0 else at_q)
