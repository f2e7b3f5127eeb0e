"""A convex body on the base, with contact at its vertices: forces, the step that goes with them, and what is looked at.

Records are those of ``records.py`` but for the joints: row 0 is the contact with the base as a whole, row 1 air, and every
further row a vertex of the body::

    joint[0]   f[3] up[3] lo[3]  force on the body [N], moments on body and base [N m];  en  elastic energy [J]
               st             energy that the shear springs hold [J]; kf kt s t  as in records.py, unused
    joint[2+]  x y z          vertex from the centroid, in the axes of the body [m];  rest  1 for the resting ones
               kn ks mu       stiffness [N/m] and friction of a vertex
               near           1 in lane 0: some lane may bring the vertex to the base within the next steps
               s[3] d[3]      shear force, dashpot force [N]
    drum[1]    nx ny nz       what was up at rest, in the axes of the body [-]
    drum[0]    x y z          where the point under the centroid stood [m];  i. j. k.  how the body stood
"""

import math

import numpy as np

from ..drums.frame import run_chunks
from ..drums.lanes import CHUNK, COLLAPSED, ENDED, FAILED, FREE, LANES, RUNNING
from ..jit import apart, kernel, strict
from . import move as moving
from . import records
from .corner import touch
from .ground import fill_ground
from .look import check_finite, straighten, whole_turns
from .move import move
from .pose import cross, in_space

#: The models read these here.
__all__ = [
    "CHUNK", "COLLAPSED", "ENDED", "FAILED", "FIRST", "FREE", "LANES", "RUNNING", "advance", "block_types", "forces",
    "ledger",
]  # fmt: skip

#: Row of the first vertex.
FIRST = 2

#: Cosine of the tilt beyond which a body has toppled [-].
TOPPLED = math.cos(0.25 * math.pi)


def block_types(damped: bool) -> tuple[np.dtype, ...]:
    """Record types (drum, joint, lane, ground, feed, watch)."""
    types = list(records.block_types(damped, 4))
    row = (LANES,)
    single = [(name, np.float64, row) for name in "x y z kn ks mu near rest en st kf kt t".split()]
    several = {"s": 3, "d": 3 if damped else 1, "f": 3, "up": 3, "lo": 3}
    types[1] = np.dtype(single + [(name, np.float64, (rows, LANES)) for name, rows in several.items()])
    return tuple(types)


@apart
def forces(drum, joint, lane):
    """Forces of all vertices at t_n; brings the contact memory from t_{n−1} to t_n."""
    o = lane[0]
    u = drum[1]
    e = joint[0]
    for l in range(LANES):
        e.en[l] = e.st[l] = 0.0
        for c in range(3):
            e.f[c, l] = e.up[c, l] = e.lo[c, l] = 0.0
    for q in range(FIRST, joint.shape[0]):
        p = joint[q]
        if p.near[0] == 0.0:
            continue
        damped = p.d.shape[0] > 1
        for l in range(LANES):
            dt = o.dt[l]
            rx, ry, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
            gap = u.z[l] + rz
            ax, ay, az = cross(u.wx[l], u.wy[l], u.wz[l], rx, ry, rz)
            vx, vy, vz = u.vx[l] + ax, u.vy[l] + ay, u.vz[l] + az
            beta = o.beta[l] if damped else 0.0
            kn, ks = p.kn[l], p.ks[l]
            normal, push, sx, sy, sz, gx, gy, gz, work = touch(
                gap, 0.0, 0.0, 1.0, vx, vy, vz, p.s[0, l], p.s[1, l], p.s[2, l], kn, ks, beta, p.mu[l], 0.0, dt
            )
            p.s[0, l], p.s[1, l], p.s[2, l] = sx, sy, sz
            o.shear[l] -= work
            e.en[l] -= 0.5 * normal * min(gap, 0.0)
            e.st[l] += 0.5 * (sx * sx + sy * sy + sz * sz) / max(ks, 1e-300)
            fx, fy, fz = sx, sy, normal + sz
            if damped:
                gz += push
                o.visc[l] -= 0.5 * dt * ((gx + p.d[0, l]) * vx + (gy + p.d[1, l]) * vy + (gz + p.d[2, l]) * vz)
                p.d[0, l], p.d[1, l], p.d[2, l] = gx, gy, gz
                fx, fy, fz = fx + gx, fy + gy, fz + gz
            e.f[0, l] += fx
            e.f[1, l] += fy
            e.f[2, l] += fz
            ax, ay, az = cross(rx, ry, rz, fx, fy, fz)
            e.up[0, l] += ax
            e.up[1, l] += ay
            e.up[2, l] += az


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n, after its ``forces``; see ``move.py``."""
    moving.ledger(drum, joint, lane, ground, k, dt, l, out)
    out[3] += joint[0].st[l]
    out[4] -= joint[0].st[l]


@kernel
def mark_near(drum, joint, lane, watch):
    """Which vertices may reach the base within the next chunk of steps in some lane."""
    u = drum[1]
    for q in range(FIRST, joint.shape[0]):
        p = joint[q]
        near = 0.0
        for l in range(LANES):
            if watch[0].status[l] == RUNNING:
                _, _, rz = in_space(u, l, p.x[l], p.y[l], p.z[l])
                time = CHUNK * lane[0].dt[l]
                # three times as fast as anything on the body now, and ten times gravity on top
                turning = math.sqrt(u.wx[l] * u.wx[l] + u.wy[l] * u.wy[l] + u.wz[l] * u.wz[l])
                speed = abs(u.vx[l]) + abs(u.vy[l]) + abs(u.vz[l]) + turning * u.rb[l]
                if u.z[l] + rz < 3.0 * speed * time + 10.0 * abs(lane[0].g[2, l]) * time * time:
                    near = 1.0
        p.near[0] = near


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
            if p.rest[l] > 0.0:
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
