"""A convex body on the base, with contact at its vertices: forces, the step that goes with them, and what is looked at.

Records are those of ``records.py`` but for the joints: row 0 is the contact with the base as a whole, row 1 air, and every
further row a vertex of the body::

    joint[0]   f[3] up[3] lo[3]  force on the body [N], moments on body and base [N m];  en  elastic energy [J]
               st             energy that the shear springs hold [J]; kf kt s t  as in records.py, unused
    joint[2+]  x y z          vertex from the centroid, in the axes of the body [m];  rest  1 for those at rest, first
               kn ks          stiffness [N/m], 0 in rows that no vertex takes
               s[3] d[3]      shear force, dashpot force [N]
    lane       mu             friction of every vertex [-]
               lost           share of the normal force that is missing while a vertex leaves, 1 − e² [-]
               f[3] up[3] en st  sums over the vertices, which then go to joint[0]: in another array than the vertices, so
                              that the loop over lanes is one of vectors
               reach above    height from which the base is reached within the next steps; height of a vertex over it [m]
               near count     rows of the vertices that some lane may bring to the base within the next steps; how many
    drum[1]    nx ny nz       what was up at rest, in the axes of the body [-]
    drum[0]    x y z          where the point under the centroid stood [m];  i. j. k.  how the body stood
"""

import math

import numpy as np

from ..drums.frame import run_chunks
from ..jit import apart, kernel, strict
from ..run_codes import CHUNK, LANES, RUNNING
from . import move as moving
from . import records
from .corner import touch
from .ground import fill_ground
from .look import check_finite, straighten, whole_turns
from .move import move
from .pose import cross, in_space

#: The models read these here.
__all__ = ["FIRST", "advance", "block_types", "forces", "ledger"]

#: Row of the first vertex.
FIRST = 2

#: Most rows of vertices that a body may have.
MOST_ROWS = 5120

#: Cosine of the tilt beyond which a body has toppled [-].
TOPPLED = math.cos(0.25 * math.pi)


def block_types() -> tuple[np.dtype, ...]:
    """Record types (drum, joint, lane, ground, feed, watch); always with what dissipates at a vertex."""
    types = list(records.block_types(True, 4))

    def fields(single: str, **several: int) -> list[tuple]:
        return [(name, np.float64, (LANES,)) for name in single.split()] + [
            (name, np.float64, (rows, LANES)) for name, rows in several.items()
        ]

    types[1] = np.dtype(fields("x y z kn ks rest en st kf kt t", s=3, d=3, f=3, up=3, lo=3))
    types[2] = np.dtype(types[2].descr + fields("mu lost reach above en st count", f=3, up=3, near=MOST_ROWS // LANES))
    return tuple(types)


@apart
def forces(drum, joint, lane):
    """Forces of all vertices at t_n; brings the contact memory from t_{n−1} to t_n."""
    o = lane[0]
    u = drum[1]
    for l in range(LANES):
        o.en[l] = o.st[l] = 0.0
        for c in range(3):
            o.f[c, l] = o.up[c, l] = 0.0
    for n in range(int(o.count[0])):
        p = joint[int(o.near[n // LANES, n % LANES])]
        for l in range(LANES):
            dt = o.dt[l]
            rx, ry, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
            gap = u.z[l] + rz
            ax, ay, az = cross(u.wx[l], u.wy[l], u.wz[l], rx, ry, rz)
            vx, vy, vz = u.vx[l] + ax, u.vy[l] + ay, u.vz[l] + az
            kn, ks = p.kn[l], p.ks[l]
            normal, push, sx, sy, sz, gx, gy, gz, work = touch(
                gap, 0.0, 0.0, 1.0, vx, vy, vz, p.s[0, l], p.s[1, l], p.s[2, l],
                kn, ks, o.beta[l], o.lost[l], o.mu[l], 0.0, dt,
            )  # fmt: skip
            p.s[0, l], p.s[1, l], p.s[2, l] = sx, sy, sz
            o.shear[l] -= work
            o.en[l] -= 0.5 * normal * min(gap, 0.0)
            o.st[l] += 0.5 * (sx * sx + sy * sy + sz * sz) / max(ks, 1e-300)
            gz += push
            o.visc[l] -= 0.5 * dt * ((gx + p.d[0, l]) * vx + (gy + p.d[1, l]) * vy + (gz + p.d[2, l]) * vz)
            p.d[0, l], p.d[1, l], p.d[2, l] = gx, gy, gz
            fx, fy, fz = sx + gx, sy + gy, normal + sz + gz
            o.f[0, l] += fx
            o.f[1, l] += fy
            o.f[2, l] += fz
            ax, ay, az = cross(rx, ry, rz, fx, fy, fz)
            o.up[0, l] += ax
            o.up[1, l] += ay
            o.up[2, l] += az
    e = joint[0]
    for l in range(LANES):
        e.en[l], e.st[l] = o.en[l], o.st[l]
        for c in range(3):
            e.f[c, l], e.up[c, l], e.lo[c, l] = o.f[c, l], o.up[c, l], 0.0


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n, after its ``forces``; see ``move.py``."""
    moving.ledger(drum, joint, lane, ground, k, dt, l, out)
    out[3] += joint[0].st[l]
    out[4] -= joint[0].st[l]


@apart
def height_above(p, u, reach, out):
    """Height of a vertex over what it may reach, in every lane [m]."""
    for l in range(LANES):
        rz = u.iz[l] * p.x[l] + u.jz[l] * p.y[l] + u.kz[l] * p.z[l]
        out[l] = u.z[l] + rz - reach[l]


@kernel
def mark_near(drum, joint, lane, watch):
    """Which vertices may reach the base within the next chunk of steps in some lane."""
    u = drum[1]
    reach, above = lane[0].reach, lane[0].above
    for l in range(LANES):
        time = CHUNK * lane[0].dt[l]
        # three times as fast as anything on the body now, and ten times gravity on top
        turning = math.sqrt(u.wx[l] * u.wx[l] + u.wy[l] * u.wy[l] + u.wz[l] * u.wz[l])
        speed = abs(u.vx[l]) + abs(u.vy[l]) + abs(u.vz[l]) + turning * u.rb[l]
        reach[l] = 3.0 * speed * time + 10.0 * abs(lane[0].g[2, l]) * time * time
        if watch[0].status[l] != RUNNING:
            reach[l] = -1e9
    o = lane[0]
    count = 0
    for q in range(FIRST, joint.shape[0]):
        height_above(joint[q], u, reach, above)
        lowest = above[0]
        for l in range(1, LANES):
            lowest = min(lowest, above[l])
        if lowest < 0.0:
            o.near[count // LANES, count % LANES] = q
            count += 1
    o.count[0] = count


@kernel
def observe(drum, joint, lane, feed, watch):
    """Look at all lanes: peaks, and bodies that have toppled: whose tilt is beyond 45°."""
    u = drum[1]
    v = drum[0]
    w = watch[0]
    for l in range(LANES):
        if w.status[l] != RUNNING:
            continue
        straighten(u, l)
        w.wmax[l] = max(w.wmax[l], abs(lane[0].work[l]))
        if w.when[l] >= 0:
            continue
        hx, hy, up = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
        w.turn[l] = max(w.turn[l], 1.0 - up)
        # turn about the vertical from how it stood; the axes of the base's record keep that
        more = u.iy[l] * v.ix[l] + u.jy[l] * v.jx[l] + u.ky[l] * v.kx[l]
        less = u.ix[l] * v.iy[l] + u.jx[l] * v.jy[l] + u.kx[l] * v.ky[l]
        even = u.ix[l] * v.ix[l] + u.jx[l] * v.jx[l] + u.kx[l] * v.kx[l]
        even += u.iy[l] * v.iy[l] + u.jy[l] * v.jy[l] + u.ky[l] * v.ky[l]
        w.tw[l] = whole_turns(math.atan2(more - less, even), w.tw[l])
        w.spin[l] = max(w.spin[l], abs(w.tw[l]))
        tx, ty = u.x[l] + u.ht[l] * hx - w.sx[l], u.y[l] + u.ht[l] * hy - w.sy[l]
        w.topx[l] = max(w.topx[l], abs(tx))
        w.topy[l] = max(w.topy[l], abs(ty))
        w.top[l] = max(w.top[l], math.sqrt(tx * tx + ty * ty))
        for q in range(FIRST, joint.shape[0]):
            p = joint[q]
            if p.rest[l] == 0.0:
                break
            _, _, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
            w.open[l] = max(w.open[l], u.z[l] + rz)
        if up < TOPPLED:
            size = max(math.sqrt(hx * hx + hy * hy), 1e-300)
            w.when[l] = feed[0].step[l]
            w.which[l] = w.about[l] = 0
            w.ex[l], w.ey[l] = hx / size, hy / size


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, mark_near, forces, move, check_finite, observe, state, chunks)
