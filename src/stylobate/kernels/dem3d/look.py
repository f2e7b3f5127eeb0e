"""Looks between chunks of steps: the ground ahead, peaks, collapses, ends of runs; axes are renormalised.

Slip of a joint is read where its faces are closest, so that a drum that only leans has not slipped: the middle of a face
that leans about its rim moves sideways by R (1 - cos θ). What counts is where the upper drum's stone is that was pressed
there, on a chip the end of its chord. A closed joint has the offset of its middles.
"""

import math

from ..ground import BEFORE, MEAN, sample
from ..jit import kernel, law, long_law, strict
from ..run_codes import CHUNK, FAILED, RUNNING, SUPPORT_MARGIN
from ..shared.overturning import going_and_lost
from .corner import clamped
from .pose import cross, faces, in_body, in_space, lean
from .support import (
    corner_of,
    end_of_chipped,
    end_of_corners,
    end_of_discs,
    middle_of_chipped,
    middle_of_corners,
    middle_of_discs,
    opening_of_corners,
)


@long_law
def closest_of_discs(u, v, e, l, n, c):
    """Closest points of two discs, in the axes of the lower drum from the middle of its face [m].

    Of the ends of two discs the one that lies over the other disc touches: it is the less deep of the two. ``n`` is the
    normal of the upper face and ``c`` its middle.
    """
    nx, ny, nz = n
    cx, cy, cz = c
    sine = math.sqrt(nx * nx + ny * ny)
    flat = sine == 0.0
    each = 1.0 / (1.0 if flat else sine)
    hx, hy = (1.0 if flat else nx * each), ny * each
    dx, dy, dz = nz * hx, nz * hy, -sine
    if e.chip.shape[0] > 1:
        ax, ay, az = in_space(u, l, e.chip[0, l], e.chip[1, l], e.chip[2, l])
        ax, ay, az = in_body(v, l, ax, ay, az)
        bx, by, bz = cross(nx, ny, nz, ax, ay, az)
        if dx * ax + dy * ay + dz * az > e.chip[4, l]:
            side = -e.chip[5, l] if dx * bx + dy * by + dz * bz < 0.0 else e.chip[5, l]
            dx, dy, dz = e.chip[4, l] * ax + side * bx, e.chip[4, l] * ay + side * by, e.chip[4, l] * az + side * bz
    ru, rl = u.rb[l], v.rt[l]
    x, y, z = cx + ru * dx, cy + ru * dy, cz + ru * dz
    below = (cx - rl * hx) * nx + (cy - rl * hy) * ny + cz * nz
    return (x, y, z) if z >= below else (rl * hx, rl * hy, 0.0)


@long_law
def closest_of_corners(u, v, l, n, c):
    """The same of rectangular faces: the deepest corner of the upper one, brought to the nearest place on the lower one."""
    tx, ty = v.tx[l], v.ty[l]
    deepest, x, y, z = math.inf, 0.0, 0.0, 0.0
    for p in range(u.px.shape[0]):
        a, b, height = corner_of(u, v, l, p)
        over = (abs(a) < tx) & (abs(b) < ty)
        a, b = clamped(a, tx), clamped(b, ty)
        gap = height if over else (c[0] - a) * n[0] + (c[1] - b) * n[1] + c[2] * n[2]
        if gap < deepest:
            deepest, x, y, z = gap, a, b, height if over else 0.0
    return x, y, z


@long_law
def slip_where_closest(u, v, e, l, twist):
    """Slip of a joint in the axes of the drum below, at the place where its two faces are closest [m].

    ``twist`` is the turn of the upper drum about the joint's normal [rad].
    """
    _, _, _, cx, cy, cz = faces(u, v, l)
    c = in_body(v, l, cx, cy, cz)
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    n = in_body(v, l, nx, ny, nz)
    if u.px.shape[0] > 1:
        x, y, z = closest_of_corners(u, v, l, n, c)
    else:
        x, y, z = closest_of_discs(u, v, e, l, n, c)
    # that place in the axes of the upper drum, and where it would be had nothing slipped
    a, b, h = in_space(v, l, x - c[0], y - c[1], z - c[2])
    a, b, _ = in_body(u, l, a, b, h)
    cosine, sine = math.cos(twist), math.sin(twist)
    return x - (cosine * a - sine * b), y - (sine * a + cosine * b)


#: A lane whose positions are larger has failed [m].
FAR = 1.0e6

#: Cosine of the angle between two faces below which they count as parted, 75.5°: laws of faces do not hold beyond [-].
ON_EDGE = 0.25

#: Sine of a tilt below which a direction of lean means nothing [-].
UPRIGHT = 1e-3


@law
def base_acceleration(f, l, place, side):
    """Acceleration of the base in its own axes at a place of a lane's record [m/s²]."""
    last, factor = f.last[l], f.factor[l]
    x = factor * sample(f.x[l], last, place, side)
    y = factor * sample(f.y[l], last, place, side) if f.y[l] != 0 else 0.0
    z = factor * sample(f.z[l], last, place, side) if f.z[l] != 0 else 0.0
    return (
        f.r[0, l] * x + f.r[1, l] * y + f.r[2, l] * z,
        f.r[3, l] * x + f.r[4, l] * y + f.r[5, l] * z,
        f.r[6, l] * x + f.r[7, l] * y + f.r[8, l] * z,
    )


@strict
def bases(feed, lanes, places, out):
    """Acceleration of the bases of some lanes at a place of each record [m/s²], shape (lanes, 3)."""
    for k in range(lanes.shape[0]):
        out[k, 0], out[k, 1], out[k, 2] = base_acceleration(feed[0], lanes[k], places[k], BEFORE)


@long_law
def ground_at(g, f, running, k, l):
    """Acceleration of the base at step k of the chunk, in its own axes; none where no run goes on."""
    a = g.a
    if running:
        a[0, l], a[1, l], a[2, l] = base_acceleration(f, l, (f.step[l] + k) * f.ratio[l], MEAN)
    else:
        for c in range(3):
            a[c, l] = 0.0


@kernel
def fill_ground(ground, feed, watch):
    """Acceleration of the base for the next chunk, each lane from its own motion."""
    for l in range(watch[0].status.shape[0]):
        for k in range(CHUNK + 1):
            ground_at(ground[k], feed[0], watch[0].status[l] == RUNNING, k, l)


@strict
def lose(u, w, l):
    """A lane has failed in which a body is not anywhere, or far away."""
    size = abs(u.x[l]) + abs(u.y[l]) + abs(u.z[l]) + abs(u.wx[l]) + abs(u.wy[l]) + abs(u.wz[l])
    lost = w.status[l] == RUNNING and not (size < FAR)
    w.status[l] = FAILED if lost else w.status[l]


@strict
def check_finite(body, watch):
    """Lanes whose state is not finite, or that are far away, have failed."""
    for i in range(1, body.shape[0]):
        for l in range(watch[0].status.shape[0]):
            lose(body[i], watch[0], l)


@law
def straighten(u, l):
    """Gives the axes of a drum their length and right angles back."""
    each = 1.0 / math.sqrt(u.kx[l] * u.kx[l] + u.ky[l] * u.ky[l] + u.kz[l] * u.kz[l])
    kx, ky, kz = u.kx[l] * each, u.ky[l] * each, u.kz[l] * each
    along = u.ix[l] * kx + u.iy[l] * ky + u.iz[l] * kz
    ix, iy, iz = u.ix[l] - along * kx, u.iy[l] - along * ky, u.iz[l] - along * kz
    each = 1.0 / math.sqrt(ix * ix + iy * iy + iz * iz)
    ix, iy, iz = ix * each, iy * each, iz * each
    u.ix[l], u.iy[l], u.iz[l] = ix, iy, iz
    u.kx[l], u.ky[l], u.kz[l] = kx, ky, kz
    u.jx[l], u.jy[l], u.jz[l] = cross(kx, ky, kz, ix, iy, iz)


@law
def joint_numbers(u, v, l):
    """Opening of a joint [m], slip in the axes of the drum below [m], twist within half a turn [rad]."""
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    _, _, _, cx, cy, cz = faces(u, v, l)
    zx, zy, zz = v.kx[l], v.ky[l], v.kz[l]
    _, _, _, _, _, _, sine, _ = lean(nx, ny, nz, zx, zy, zz, v.ix[l], v.iy[l], v.iz[l])
    a, b, c = in_body(v, l, cx, cy, cz)
    if u.px.shape[0] > 1:
        over = opening_of_corners(u, v, l)
    else:
        over = min(c + u.rb[l] * sine, cx * nx + cy * ny + cz * nz + v.rt[l] * sine)
    p, q, _ = in_body(v, l, u.ix[l], u.iy[l], u.iz[l])
    r, s, _ = in_body(v, l, u.jx[l], u.jy[l], u.jz[l])
    return max(over, 0.0), a, b, math.atan2(q - r, p + s)


@law
def whole_turns(twist, last):
    """A twist known within half a turn, near the one at the last look [rad]."""
    return twist + 2.0 * math.pi * math.floor((last - twist) / (2.0 * math.pi) + 0.5)


@law
def keep_peaks(w, l):
    """Peaks as they are while no part of the column is on its way out of its support."""
    w.ktop[l], w.ktopx[l], w.ktopy[l] = w.top[l], w.topx[l], w.topy[l]
    w.kopen[l], w.kspin[l] = w.open[l], w.spin[l]
    w.kturn[l], w.klean[l] = w.turn[l], w.lean[l]


@law
def is_lying(u, l):
    """Whether a drum is upside down, or lies with its upper face below the ground."""
    return (u.kz[l] < 0.0) | (u.z[l] < -u.ht[l])


@law
def top_place(u, l):
    """Middle of a drum's upper face along the base [m]."""
    return u.x[l] + u.ht[l] * u.kx[l], u.y[l] + u.ht[l] * u.ky[l]


@long_law
def sum_up(body, w, l):
    """Sums over all drums of a lane, in ``watch``: mass, and its first moments and momentum; their axes are put right."""
    w.m[l] = w.x[l] = w.y[l] = w.z[l] = w.px[l] = w.py[l] = 0.0
    for i in range(1, body.shape[0]):
        u = body[i]
        straighten(u, l)
        m = u.m[l]
        w.m[l] += m
        w.x[l] += m * u.x[l]
        w.y[l] += m * u.y[l]
        w.z[l] += m * u.z[l]
        w.px[l] += m * u.vx[l]
        w.py[l] += m * u.vy[l]


@long_law
def take_off(u, w, l):
    """Takes a drum off those sums."""
    m = u.m[l]
    w.m[l] -= m
    w.x[l] -= m * u.x[l]
    w.y[l] -= m * u.y[l]
    w.z[l] -= m * u.z[l]
    w.px[l] -= m * u.vx[l]
    w.py[l] -= m * u.vy[l]


@long_law
def look_at_drums(body, w, l, standing):
    """Tilts of a lane's drums and the way of the topmost face, as long as the column stands."""
    for i in range(1, body.shape[0]):
        u = body[i]
        if standing:
            w.turn[l] = max(w.turn[l], 1.0 - u.kz[l])
            along = u.kx[l] * u.ax[l] + u.ky[l] * u.ay[l] + u.kz[l] * u.az[l]
            w.lean[l] = max(w.lean[l], 1.0 - along)
        elif is_lying(u, l):
            w.follow[l] = 0  # flanks touch nothing: what lies on the ground is followed no further
    if standing:
        tx, ty = top_place(body[body.shape[0] - 1], l)
        tx -= w.sx[l]
        ty -= w.sy[l]
        w.topx[l] = max(w.topx[l], abs(tx))
        w.topy[l] = max(w.topy[l], abs(ty))
        w.top[l] = max(w.top[l], math.sqrt(tx * tx + ty * ty))


@long_law
def leaving(u, v, e, o, w, l, a, b, margin, moment):
    """Whether what is above a joint has parted from it, is beyond its support and moves outward, is lost; and where to.

    ``a``, ``b`` is where the middle of its face is, ``margin`` the reserve of acceleration [m/s²], ``moment`` what links
    hold [N m].
    """
    # centroid of the part above, and how far it is beyond both faces on the side to which it leans
    each = 1.0 / w.m[l]
    gx, gy, gz = w.x[l] * each, w.y[l] * each, w.z[l] * each
    hx, hy, hz = v.x[l] + v.ht[l] * v.kx[l], v.y[l] + v.ht[l] * v.ky[l], v.z[l] + v.ht[l] * v.kz[l]
    if u.px.shape[0] > 1:
        mx, my, parted = middle_of_corners(u, v, l)
    else:
        mx, my, parted = middle_of_discs(u, v, l, a, b)
        if e.chip.shape[0] > 1:
            mx, my, parted = middle_of_chipped(u, v, e, l, a, b, mx, my, parted)
    # a drum that stands on its edge has left the face below as well
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    parted |= nx * v.kx[l] + ny * v.ky[l] + nz * v.kz[l] < ON_EDGE
    mx, my, _ = in_space(v, l, mx, my, 0.0)
    dx, dy = gx - hx - mx, gy - hy - my
    size = max(math.sqrt(dx * dx + dy * dy), 1e-12)
    dx, dy = dx / size, dy / size
    if u.px.shape[0] > 1:
        ex, ey, ez = end_of_corners(u, v, l, dx, dy)
    else:
        ex, ey, ez = end_of_discs(u, v, l, dx, dy)
        if e.chip.shape[0] > 1:
            ex, ey, ez = end_of_chipped(u, v, e, l, dx, dy, ex, ey, ez)
    ex, ey, ez = ex + hx, ey + hy, ez + hz
    ru = u.rb[l]
    out = (gx - ex) * dx + (gy - ey) * dy
    up = max(gz - ez, 0.0)
    bx, by, _ = cross(v.wx[l], v.wy[l], v.wz[l], ex - v.x[l], ey - v.y[l], ez - v.z[l])
    outward = (w.px[l] * each - v.vx[l] - bx) * dx + (w.py[l] * each - v.vy[l] - by) * dy
    down = max(o.g[2, l] - w.vmax[l], 0.0)
    against = max(w.amax[l] + o.g[0, l] * dx + o.g[1, l] * dy, 0.0) + margin
    # what spin about the own axis can hold while the body rolls round its rim
    axial = abs(u.wx[l] * u.kx[l] + u.wy[l] * u.ky[l] + u.wz[l] * u.kz[l])
    about = math.sqrt(u.wx[l] * u.wx[l] + u.wy[l] * u.wy[l] + u.wz[l] * u.wz[l])
    tilt = math.sqrt(max(1.0 - u.kz[l] * u.kz[l], 0.0))
    gyro = (ru * up + ru * ru) * axial * about / max(tilt, UPRIGHT)
    link_moment = moment * each
    going, lost = going_and_lost(out, outward, out * down, against * up + gyro + link_moment)
    return parted, going, lost, dx, dy


@long_law
def look_at_joint(u, v, e, o, w, l, j, step, standing, moment):
    """Peaks of a joint, and whether what is above it is lost for good."""
    opening, a, b, twist = joint_numbers(u, v, l)
    twist = whole_turns(twist, e.tw[l])
    e.tw[l] = twist
    if standing:
        w.open[l] = max(w.open[l], opening)
        w.spin[l] = max(w.spin[l], abs(twist - e.ot[l]))
    margin = SUPPORT_MARGIN if j > 0 else 0.0
    parted, going, lost, dx, dy = leaving(u, v, e, o, w, l, a, b, margin, moment)
    w.going[l] = 1.0 if going else w.going[l]
    hit = (lost | parted | is_lying(u, l)) & standing
    if hit and w.when[l] < 0:
        w.when[l] = step
        w.which[l] = j
        w.ex[l] = dx
        w.ey[l] = dy
        w.parted[l] = 1 if parted else 0
    if w.when[l] == step and opening > w.wide[l]:
        w.wide[l] = opening
        w.about[l] = j
    if parted:  # a joint that has parted does not close again
        e.kn[l] = e.ks[l] = e.co[l] = 0.0


@long_law
def look_at_lane(body, joint, o, w, step, hold, l):
    """Peaks of a lane, and certain collapse, as :func:`look_at_column` says."""
    standing = w.when[l] < 0
    w.wmax[l] = max(w.wmax[l], abs(o.work[l]))
    sum_up(body, w, l)
    look_at_drums(body, w, l, standing)
    w.going[l] = 0.0
    for j in range(joint.shape[0]):
        u = body[j + 1]
        moment = hold[j].moment[l] if j < hold.shape[0] else 0.0
        look_at_joint(u, body[j], joint[j], o, w, l, j, step, standing, moment)
        take_off(u, w, l)
    if w.when[l] < 0 and w.going[l] == 0.0:
        keep_peaks(w, l)


@kernel
def look_at_column(body, joint, lane, feed, watch, hold):
    """Look at all lanes: peaks, and certain collapses.

    A collapse is certain when, for the part of the column above a joint, its centroid lies beyond the overlap of the two
    faces, moves outward, and the moment of its weight about the edge exceeds what the strongest acceleration of the
    motion, the slope of the base and its own spin could ever set against it (for joints between drums, with
    SUPPORT_MARGIN on top); or when two faces no longer overlap.  # Eq. (E9)

    Peaks are kept apart as they were when last no part was beyond its support and moving outward: those of a column that
    falls are its peaks before it fell.
    """
    for l in range(watch[0].status.shape[0]):
        if watch[0].status[l] == RUNNING:
            look_at_lane(body, joint, lane[0], watch[0], feed[0].step[l], hold, l)


@strict
def column_state(body, joint, watch, l, opening, slip, twist):
    """Opening of every joint of a lane [m], and since the start its slip where it is closest, in the axes of the drum below
    [m], and its twist with its full turns [rad]."""
    for j in range(joint.shape[0]):
        u, v, e = body[j + 1], body[j], joint[j]
        opening[j], _, _, turn = joint_numbers(u, v, l)
        turn = whole_turns(turn, e.tw[l])
        x, y = slip_where_closest(u, v, e, l, turn)
        slip[j, 0], slip[j, 1] = x - e.ox[l], y - e.oy[l]
        twist[j] = turn - e.ot[l]
