"""Links between bodies in space: the laws of links at places and along directions of the bodies, in one lane; their loops.

Records and legend: ``shared/records.py``; the laws: ``shared/links.py``. Link m is contact ``joint.shape[0] + m``.
"""

import math

from ..jit import apart, kernel, law, long_law
from ..run_codes import CHUNK
from ..shared.links import link_force, look_at_hold, look_at_links, note_slack, note_slip, pulled, some_leaves
from .pose import cross, in_body, in_space


@law
def at_place(u, v, k, l):
    """Place of a link on the upper body over the face below, in that drum's axes; from both centroids in space
    [m]."""
    bx, by, bz = in_space(u, l, k.bx[l], k.by[l], k.bz[l])
    x, y, z = u.x[l] + bx - v.x[l], u.y[l] + by - v.y[l], u.z[l] + bz - v.z[l]
    a, b, c = in_body(v, l, x, y, z)
    return a, b, c - v.ht[l], x, y, z, bx, by, bz


@law
def slipping(u, v, l, ax, ay, az, bx, by, bz):
    """Speed of slip of a place as seen from the drum below, along its axes [m/s]."""
    wx, wy, wz = cross(u.wx[l], u.wy[l], u.wz[l], bx, by, bz)
    vx, vy, vz = cross(v.wx[l], v.wy[l], v.wz[l], ax, ay, az)
    va, vb, _ = in_body(v, l, u.vx[l] + wx - v.vx[l] - vx, u.vy[l] + wy - v.vy[l] - vy, u.vz[l] + wz - v.vz[l] - vz)
    return va, vb


@law
def length_of(x, y):
    """Length of a vector in the plane of a joint."""
    return math.sqrt(x * x + y * y)


@law
def put(f, l, fx, fy, fz, ax, ay, az, bx, by, bz):
    """Adds a force on the upper body at b from its centroid, and its reaction at a from that of the lower one."""
    f.f[0, l] += fx
    f.f[1, l] += fy
    f.f[2, l] += fz
    mx, my, mz = cross(bx, by, bz, fx, fy, fz)
    f.up[0, l] += mx
    f.up[1, l] += my
    f.up[2, l] += mz
    mx, my, mz = cross(ax, ay, az, fx, fy, fz)
    f.lo[0, l] -= mx
    f.lo[1, l] -= my
    f.lo[2, l] -= mz


@long_law
def clear(k, b, f, u, v, l):
    """Lets a contact do nothing."""
    for c in range(3):
        f.f[c, l] = f.up[c, l] = f.lo[c, l] = 0.0


@long_law
def across(k, b, f, u, v, l):
    """Adds a dowel, bar or layer: what holds against slip."""
    along, aside, lift, ax, ay, az, bx, by, bz = at_place(u, v, k, l)
    px, py = along - k.px[l], aside - k.py[l]
    size = length_of(px, py)
    each = 1.0 / max(size, 1e-300)
    px, py = px * each, py * each
    far = length_of(along - k.sx[l], aside - k.sy[l])
    old = k.fx[l] * k.fx[l] + k.fy[l] * k.fy[l]
    force, on, wider, heat, whole, out, most = link_force(
        size, k.gap[l], b.y, b.ks, lift - k.h[l], b.deep, b.reach, k.on[l], k.out[l], b.br, b.cr, far, b.us, old
    )
    k.px[l] += px * on
    k.py[l] += py * on
    fa, fb = -px * force, -py * force
    k.fx[l] = fa
    k.fy[l] = fb
    note_slip(k, l, wider, heat, most, far, lift - k.h[l], whole, out)
    fx, fy, fz = in_space(v, l, fa, fb, 0.0)
    put(f, l, fx, fy, fz, ax, ay, az, bx, by, bz)


@long_law
def slowed(k, b, f, u, v, l):
    """Adds the dashpot of a layer."""
    _, _, _, ax, ay, az, bx, by, bz = at_place(u, v, k, l)
    va, vb = slipping(u, v, l, ax, ay, az, bx, by, bz)
    fa, fb = -b.c * va * k.on[l], -b.c * vb * k.on[l]
    k.drag[l] -= 0.5 * k.dt[l] * ((fa + k.dx[l]) * va + (fb + k.dy[l]) * vb)
    k.dx[l] = fa
    k.dy[l] = fb
    fx, fy, fz = in_space(v, l, fa, fb, 0.0)
    put(f, l, fx, fy, fz, ax, ay, az, bx, by, bz)


@long_law
def against_opening(k, b, f, u, v, l):
    """Adds what a bar holds against the opening of a joint at its place."""
    _, _, lift, ax, ay, az, bx, by, bz = at_place(u, v, k, l)
    pull = pulled(k, l, lift)
    put(f, l, -pull * v.kx[l], -pull * v.ky[l], -pull * v.kz[l], ax, ay, az, bx, by, bz)


@law
def ends(u, v, k, l):
    """Ends of a straight link from the centroids of its bodies, the way from the lower to the upper one, its length [m]."""
    ax, ay, az = in_space(v, l, k.ax[l], k.ay[l], k.az[l])
    bx, by, bz = in_space(u, l, k.bx[l], k.by[l], k.bz[l])
    dx, dy, dz = u.x[l] + bx - v.x[l] - ax, u.y[l] + by - v.y[l] - ay, u.z[l] + bz - v.z[l] - az
    return ax, ay, az, bx, by, bz, dx, dy, dz, math.sqrt(dx * dx + dy * dy + dz * dz)


@long_law
def straight(k, b, f, u, v, l):
    """Adds a tie or core between two points."""
    ax, ay, az, bx, by, bz, dx, dy, dz, length = ends(u, v, k, l)
    size = -pulled(k, l, length) / max(length, 1e-12)
    put(f, l, size * dx, size * dy, size * dz, ax, ay, az, bx, by, bz)


@long_law
def slack_left(k, b, f, u, v, l):
    """Notes how far a dowel is from leaving its slack."""
    along, aside, _, ax, ay, az, bx, by, bz = at_place(u, v, k, l)
    va, vb = slipping(u, v, l, ax, ay, az, bx, by, bz)
    size = length_of(along - k.px[l], aside - k.py[l])
    note_slack(k, l, size, length_of(along - k.sx[l], aside - k.sy[l]), length_of(va, vb), CHUNK * k.dt[l])


@long_law
def in_all_lanes(lane_law, body, load, link, bond, pair, n, m):
    """A law of link m, which is contact n, in all lanes."""
    k = link[m]
    b = bond[m]
    f = load[n]
    u = body[pair[n].upper]
    v = body[pair[n].lower]
    for l in range(k.on.shape[0]):
        lane_law(k, b, f, u, v, l)


@apart
def clear_all(body, load, link, bond, pair, n, m):
    """See :func:`clear`."""
    in_all_lanes(clear, body, load, link, bond, pair, n, m)


@apart
def across_all(body, load, link, bond, pair, n, m):
    """See :func:`across`."""
    in_all_lanes(across, body, load, link, bond, pair, n, m)


@apart
def slowed_all(body, load, link, bond, pair, n, m):
    """See :func:`slowed`."""
    in_all_lanes(slowed, body, load, link, bond, pair, n, m)


@apart
def against_opening_all(body, load, link, bond, pair, n, m):
    """See :func:`against_opening`."""
    in_all_lanes(against_opening, body, load, link, bond, pair, n, m)


@apart
def straight_all(body, load, link, bond, pair, n, m):
    """See :func:`straight`."""
    in_all_lanes(straight, body, load, link, bond, pair, n, m)


@apart
def slack_left_all(body, load, link, bond, pair, n, m):
    """See :func:`slack_left`."""
    in_all_lanes(slack_left, body, load, link, bond, pair, n, m)


@kernel
def add_links(body, load, link, bond, pair, joints):
    """Forces of all links at t_n; brings their memory from t_{n−1} to t_n."""
    for m in range(link.shape[0]):
        b = bond[m]
        n = joints + m
        if b.near == 0:
            continue
        clear_all(body, load, link, bond, pair, n, m)
        if b.line != 0:
            straight_all(body, load, link, bond, pair, n, m)
            continue
        if b.ks > 0.0:
            across_all(body, load, link, bond, pair, n, m)
        if b.c > 0.0:
            slowed_all(body, load, link, bond, pair, n, m)
        if b.ten != 0:
            against_opening_all(body, load, link, bond, pair, n, m)


@kernel
def look_for_slack(body, load, link, bond, pair, joints, watch):
    """Which links may hold something within the next chunk of steps: all but dowels far within their slack."""
    for m in range(link.shape[0]):
        b = bond[m]
        if b.line == 0 and b.ten == 0 and b.c == 0.0:
            n = joints + m
            slack_left_all(body, load, link, bond, pair, n, m)
            b.near = 1 if some_leaves(link, m, watch) else 0
            if b.near == 0:
                clear_all(body, load, link, bond, pair, n, m)


@kernel
def look_at_all(link, bond, lane, feed, watch, hold, pair, joints):
    """Between chunks of steps: peaks and breaks of links, and what the whole ones hold."""
    look_at_links(link, bond, lane, feed, watch)
    look_at_hold(link, hold, pair, joints)
