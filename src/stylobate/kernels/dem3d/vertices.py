"""A convex body on the base, with contact at its vertices: their forces, which of them are near, and what is looked at.

Records are those of ``records.py`` but for the joints, of which every row is a vertex of the body; contact 0 is that with
the base as a whole::

    joint[q]   x y z          vertex from the centroid, in the axes of the body [m];  rest  1 for those at rest, first
               kn ks          stiffness [N/m], 0 in rows that no vertex takes
               s[3] d[3]      shear force, dashpot force [N]
    lane       mu             friction of every vertex [-]
               lost           share of the normal force that is missing while a vertex leaves, 1 − e² [-]
               en st          elastic energy, and what the shear springs hold of it, of all vertices [J]
               reach above    height from which the base is reached within the next steps; height of a vertex over it [m]
               near count     rows of the vertices that some lane may bring to the base within the next steps; how many
    body[1]    nx ny nz       what was up at rest, in the axes of the body [-]
    body[0]    x y z          where the point under the centroid stood [m];  i. j. k.  how the body stood
"""

import math

from ..jit import apart, kernel, law, long_law, strict
from ..run_codes import CHUNK, RUNNING
from .corner import touch
from .look import keep_peaks, straighten, whole_turns
from .pose import cross, in_space
from .records import BETA

#: Cosine of the tilt beyond which a body has toppled [-].
TOPPLED = math.cos(0.25 * math.pi)


@law
def clear(o, f, l):
    """No load as yet."""
    o.en[l] = o.st[l] = 0.0
    for c in range(3):
        f.f[c, l] = f.up[c, l] = f.lo[c, l] = 0.0


@law
def press(p, f, o, u, l):
    """Adds a vertex to the load on the body."""
    dt = o.dt[l]
    rx, ry, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
    gap = u.z[l] + rz
    ax, ay, az = cross(u.wx[l], u.wy[l], u.wz[l], rx, ry, rz)
    vx, vy, vz = u.vx[l] + ax, u.vy[l] + ay, u.vz[l] + az
    kn, ks = p.kn[l], p.ks[l]
    normal, push, sx, sy, sz, gx, gy, gz, work = touch(
        gap, 0.0, 0.0, 1.0, vx, vy, vz, p.s[0, l], p.s[1, l], p.s[2, l],
        kn, ks, o.damp[BETA, l], o.lost[l], o.mu[l], 0.0, dt,
    )  # fmt: skip
    p.s[0, l], p.s[1, l], p.s[2, l] = sx, sy, sz
    o.shear[l] -= work
    o.en[l] -= 0.5 * normal * min(gap, 0.0)
    o.st[l] += 0.5 * (sx * sx + sy * sy + sz * sz) / max(ks, 1e-300)
    gz += push
    o.visc[l] -= 0.5 * dt * ((gx + p.d[0, l]) * vx + (gy + p.d[1, l]) * vy + (gz + p.d[2, l]) * vz)
    p.d[0, l], p.d[1, l], p.d[2, l] = gx, gy, gz
    fx, fy, fz = sx + gx, sy + gy, normal + sz + gz
    f.f[0, l] += fx
    f.f[1, l] += fy
    f.f[2, l] += fz
    ax, ay, az = cross(rx, ry, rz, fx, fy, fz)
    f.up[0, l] += ax
    f.up[1, l] += ay
    f.up[2, l] += az


@apart
def on_vertices(body, joint, load, pair, lane):
    """Forces of all vertices at t_n; brings the contact memory from t_{n−1} to t_n."""
    o = lane[0]
    u = body[pair[0].upper]
    f = load[0]
    lanes = range(o.dt.shape[0])
    for l in lanes:
        clear(o, f, l)
    for n in range(int(o.count[0])):
        p = joint[row(o, n)]
        for l in lanes:
            press(p, f, o, u, l)


@law
def row(o, n):
    """Row of the vertex that is number n of those near."""
    across = o.near.shape[1]
    return int(o.near[n // across, n % across])


@apart
def height_above(p, u, reach, out):
    """Height of a vertex over what it may reach, in every lane [m]."""
    for l in range(out.shape[0]):
        rz = u.iz[l] * p.x[l] + u.jz[l] * p.y[l] + u.kz[l] * p.z[l]
        out[l] = u.z[l] + rz - reach[l]


@law
def reaches(u, o, l):
    """Height from which the base may be reached within the next chunk of steps [m].

    Three times as fast as anything on the body now, and ten times gravity on top.
    """
    time = CHUNK * o.dt[l]
    turning = math.sqrt(u.wx[l] * u.wx[l] + u.wy[l] * u.wy[l] + u.wz[l] * u.wz[l])
    speed = abs(u.vx[l]) + abs(u.vy[l]) + abs(u.vz[l]) + turning * u.rb[l]
    return 3.0 * speed * time + 10.0 * abs(o.g[2, l]) * time * time


@kernel
def mark_near(body, joint, lane, watch):
    """Which vertices may reach the base within the next chunk of steps in some lane."""
    u = body[1]
    o = lane[0]
    for l in range(o.dt.shape[0]):
        o.reach[l] = reaches(u, o, l) if watch[0].status[l] == RUNNING else -1e9
    count = 0
    across = o.near.shape[1]
    for q in range(joint.shape[0]):
        height_above(joint[q], u, o.reach, o.above)
        lowest = o.above[0]
        for l in range(1, o.dt.shape[0]):
            lowest = min(lowest, o.above[l])
        if lowest < 0.0:
            o.near[count // across, count % across] = q
            count += 1
    o.count[0] = count


@law
def twist_of(u, v, last, l):
    """Turn about the vertical from how the body stood, near the one at the last look [rad]; ``v`` keeps how it stood."""
    more = u.iy[l] * v.ix[l] + u.jy[l] * v.jx[l] + u.ky[l] * v.kx[l]
    less = u.ix[l] * v.iy[l] + u.jx[l] * v.jy[l] + u.kx[l] * v.ky[l]
    even = u.ix[l] * v.ix[l] + u.jx[l] * v.jx[l] + u.kx[l] * v.kx[l]
    even += u.iy[l] * v.iy[l] + u.jy[l] * v.jy[l] + u.ky[l] * v.ky[l]
    return whole_turns(math.atan2(more - less, even), last)


@long_law
def look_at_lane(u, v, joint, o, w, step, l):
    """Peaks of a lane, and whether its body has toppled."""
    straighten(u, l)
    w.wmax[l] = max(w.wmax[l], abs(o.work[l]))
    if w.when[l] < 0:
        hx, hy, up = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
        w.turn[l] = max(w.turn[l], 1.0 - up)
        w.tw[l] = twist_of(u, v, w.tw[l], l)
        w.spin[l] = max(w.spin[l], abs(w.tw[l]))
        tx, ty = u.x[l] + u.ht[l] * hx - w.sx[l], u.y[l] + u.ht[l] * hy - w.sy[l]
        w.topx[l] = max(w.topx[l], abs(tx))
        w.topy[l] = max(w.topy[l], abs(ty))
        w.top[l] = max(w.top[l], math.sqrt(tx * tx + ty * ty))
        for q in range(joint.shape[0]):
            p = joint[q]
            if p.rest[l] == 0.0:
                break
            _, _, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
            w.open[l] = max(w.open[l], u.z[l] + rz)
        w.lean[l] = w.turn[l]
        keep_peaks(w, l)
        if up < TOPPLED:
            size = max(math.sqrt(hx * hx + hy * hy), 1e-300)
            w.when[l] = step
            w.which[l] = w.about[l] = 0
            w.ex[l], w.ey[l] = hx / size, hy / size


@kernel
def look_at_body(body, joint, lane, feed, watch, hold):
    """Look at all lanes: peaks, and bodies that have toppled: whose tilt is beyond 45°."""
    for l in range(watch[0].status.shape[0]):
        if watch[0].status[l] == RUNNING:
            look_at_lane(body[1], body[0], joint, lane[0], watch[0], feed[0].step[l], l)


@strict
def body_state(body, joint, watch, l, opening, slip, twist):
    """Height of the highest vertex of the footprint [m], and since the start the shift of the lowest one, so that a body
    that only leans has not slipped [m], and the twist [rad]."""
    u, v = body[1], body[0]
    highest = 0.0
    lowest, low = math.inf, 0
    for q in range(joint.shape[0]):
        p = joint[q]
        if p.rest[l] == 0.0:
            break
        _, _, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
        highest = max(highest, u.z[l] + rz)
        if u.z[l] + rz < lowest:
            lowest, low = u.z[l] + rz, q
    turn = twist_of(u, v, watch[0].tw[l], l)
    p = joint[low]
    rx, ry, _ = in_space(u, l, p.x[l], p.y[l], p.z[l])
    a, b, _ = in_space(v, l, p.x[l], p.y[l], p.z[l])  # where it was at rest, from the middle
    c, s = math.cos(turn), math.sin(turn)
    opening[0], twist[0] = highest, turn
    slip[0, 0] = u.x[l] + rx - v.x[l] - (c * a - s * b)
    slip[0, 1] = u.y[l] + ry - v.y[l] - (s * a + c * b)
