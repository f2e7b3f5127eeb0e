"""Looks between chunks of steps in the plane: the ground ahead, states that are not finite, peaks and collapses.

Records: ``records.py``.
"""

from ..ground import BEFORE, MEAN, sample
from ..jit import apart, kernel, law, strict
from ..run_codes import CHUNK, FAILED, RUNNING, SUPPORT_MARGIN
from ..shared.overturning import going_and_lost
from . import contact as ct
from .point_joint import face, meeting

#: A lane whose positions are larger has failed [m].
FAR = 1.0e6


@law
def along_base(ax, az, c, s):
    """An acceleration along and normal to the base."""
    return ax * c + az * s, az * c - ax * s


@law
def base_acceleration(f, l, place, side):
    """Acceleration of the base along and normal to it at a place of a lane's record [m/s²]."""
    ax = f.factor[l] * sample(f.x[l], f.last[l], place, side) if f.x[l] != 0 else 0.0
    az = f.factor[l] * sample(f.z[l], f.last[l], place, side) if f.z[l] != 0 else 0.0
    return along_base(ax, az, f.bc[l], f.bs[l])


@strict
def bases(feed, lanes, places, out):
    """Acceleration of the bases of some lanes at a place of each record [m/s²], shape (lanes, 2)."""
    for k in range(lanes.shape[0]):
        out[k, 0], out[k, 1] = base_acceleration(feed[0], lanes[k], places[k], BEFORE)


@law
def ground_at(g, f, running, k, l):
    """Acceleration of the base at step k of the chunk; none where no run goes on."""
    if running:
        g.ax[l], g.az[l] = base_acceleration(f, l, (f.step[l] + k) * f.ratio[l], MEAN)
    else:
        g.ax[l] = 0.0
        g.az[l] = 0.0


@kernel
def fill_ground(ground, feed, watch):
    """Acceleration of the base for the next chunk, each lane from its own motion."""
    f = feed[0]
    for l in range(f.x.shape[0]):
        for k in range(CHUNK + 1):
            ground_at(ground[k], f, watch[0].status[l] == RUNNING, k, l)


@strict
def lose(u, w, l):
    """A lane has failed in which a body is not anywhere, or far away."""
    lost = w.status[l] == RUNNING and not (abs(u.x[l]) + abs(u.z[l]) + abs(u.th[l]) < FAR) and u.im[l] > 0.0
    w.status[l] = FAILED if lost else w.status[l]


@strict
def check_finite(body, watch):
    """Lanes whose state is not finite, or that are far away, have failed."""
    w = watch[0]
    for i in range(1, body.shape[0]):
        u = body[i]
        for l in range(u.x.shape[0]):
            lose(u, w, l)


@law
def top_place(top, w, l):
    """Place of the middle of the topmost face along the base [m]."""
    _, st = face(top, l, w.tc[l], w.ts[l])
    return top.x[l] - st * w.th[l]


@law
def straighten_one(u, l):
    """Renormalises (cos, sin) of a body."""
    fix = 1.5 - 0.5 * (u.c[l] * u.c[l] + u.s[l] * u.s[l])
    u.c[l] *= fix
    u.s[l] *= fix


@apart
def straighten(body):
    """Renormalise (cos, sin) of all bodies."""
    for i in range(body.shape[0]):
        u = body[i]
        for l in range(u.x.shape[0]):
            straighten_one(u, l)


@law
def look_at_top(top, o, w, l):
    """Begins a look at one lane: the peak of its top, and sums over the column."""
    # peaks of a column that stands: they end with its collapse
    w.top[l] = max(w.top[l], abs(top_place(top, w, l) - w.stood[l])) if w.when[l] < 0 else w.top[l]
    w.going[l] = 0.0
    w.wmax[l] = max(w.wmax[l], abs(o.work[l]))
    w.m[l] = 0.0
    w.x[l] = 0.0
    w.z[l] = 0.0
    w.px[l] = 0.0
    w.link_moment[l] = 0.0


@law
def look_at_drum(u, w, l):
    """Adds a drum to the sums over the column."""
    w.turn[l] = max(w.turn[l], abs(u.th[l])) if w.when[l] < 0 else w.turn[l]
    w.m[l] += u.m[l]
    w.x[l] += u.m[l] * u.x[l]
    w.z[l] += u.m[l] * u.z[l]
    w.px[l] += u.m[l] * u.vx[l]


@law
def look_at_joint(u, v, e, o, f, w, j, l):
    """Looks at joint j with the sums over the drums above it, and takes the drum on it out of them."""
    margin = SUPPORT_MARGIN if j > 0 else 0.0
    cf, sf, _, _, c, s, ls, lq, rs, rq, lo, hi, _ = meeting(u, v, e, l)
    ht = e.ht[l]
    opening = ct.opening(ls, lq, rs, rq, c, s, e.wr[l])
    w.open[l] = max(w.open[l], opening) if w.when[l] < 0 else w.open[l]
    # centroid of the part above, and the end of the contact on the side to which it leans, in world axes
    each = 1.0 / w.m[l]
    cx = w.x[l] * each
    cz = w.z[l] * each
    middle = v.x[l] + 0.5 * cf * (lo + hi) - sf * ht
    side = 1.0 if cx > middle else -1.0
    end = hi if cx > middle else lo
    end_x = v.x[l] + cf * end - sf * ht
    end_z = v.z[l] + sf * end + cf * ht
    out = side * (cx - end_x)
    up = max(cz - end_z, 0.0)
    outward = side * (w.px[l] * each - (v.vx[l] - v.w[l] * (end_z - v.z[l])))
    down = max(o.g[l] - w.vmax[l], 0.0)
    against = max(w.amax[l] + side * o.gx[l], 0.0) + margin
    link_moment = w.link_moment[l] * each  # by links
    going, lost = going_and_lost(out, outward, out * down, against * up + link_moment)
    w.going[l] = 1.0 if going else w.going[l]
    parted = hi <= lo
    hit = (lost | parted) & (w.status[l] == RUNNING) & (w.when[l] < 0)
    w.when[l] = f.step[l] if hit else w.when[l]
    w.which[l] = j if hit else w.which[l]
    w.side[l] = (1 if cx > middle else -1) if hit else w.side[l]
    w.parted[l] = (1 if parted else 0) if hit else w.parted[l]
    wider = (w.when[l] == f.step[l]) & (opening > w.wide[l])
    w.wide[l] = opening if wider else w.wide[l]
    w.about[l] = j if wider else w.about[l]
    keep = 0.0 if parted else 1.0  # a joint that has parted does not close again
    e.kn[l] *= keep
    e.ks[l] *= keep
    e.co[l] *= keep
    w.m[l] -= u.m[l]
    w.x[l] -= u.m[l] * u.x[l]
    w.z[l] -= u.m[l] * u.z[l]
    w.px[l] -= u.m[l] * u.vx[l]


@law
def keep_peaks(w, l):
    """Keeps the peaks of a lane in which no part is on its way out."""
    calm = (w.when[l] < 0) & (w.going[l] == 0.0)
    w.ktop[l] = w.top[l] if calm else w.ktop[l]
    w.kopen[l] = w.open[l] if calm else w.kopen[l]
    w.kturn[l] = w.turn[l] if calm else w.kturn[l]


@apart
def observe(body, joint, lane, feed, watch, hold, drums):
    """Look at the column in all lanes: peaks, and certain collapses; renormalise (cos, sin) of all bodies.

    A collapse is certain when, for the part of the column above a joint, its centroid lies beyond the end of the contact,
    moves outward, and the moment of its weight about that end exceeds what the strongest acceleration of the motion and
    the slope of the base could ever set against it (for joints between drums, with SUPPORT_MARGIN on top); or when two
    faces no longer overlap.  # Eq. (D6)

    Peaks are kept apart as they were when last no part was beyond its support and moving outward: those of a column that
    falls are its peaks before it fell.
    """
    o = lane[0]
    f = feed[0]
    w = watch[0]
    lanes = w.status.shape[0]
    top = body[drums]
    for l in range(lanes):
        look_at_top(top, o, w, l)
    straighten(body)
    for i in range(1, drums + 1):
        u = body[i]
        for l in range(lanes):
            look_at_drum(u, w, l)
    for j in range(drums):
        u = body[j + 1]
        v = body[j]
        e = joint[j]
        if hold.shape[0] > 0:
            for l in range(lanes):
                w.link_moment[l] = hold[j].moment[l]
        for l in range(lanes):
            look_at_joint(u, v, e, o, f, w, j, l)
    for l in range(lanes):
        keep_peaks(w, l)


@law
def look_at_lane(body, joint, o, f, w, hold, l):
    """Look at the column in one lane: as :func:`check_finite` and :func:`observe` look at all of them."""
    drums = joint.shape[0]
    for i in range(1, drums + 1):
        lose(body[i], w, l)
    look_at_top(body[drums], o, w, l)
    for i in range(1, drums + 1):
        straighten_one(body[i], l)
    for i in range(1, drums + 1):
        look_at_drum(body[i], w, l)
    for j in range(drums):
        w.link_moment[l] = hold[j].moment[l] if j < hold.shape[0] else 0.0
        look_at_joint(body[j + 1], body[j], joint[j], o, f, w, j, l)
    keep_peaks(w, l)


@strict
def joint_state(body, joint, pair, l, opening, slip):
    """Opening and slip of every joint of one lane [m]; the slip is read at the edge that is less open."""
    for j in range(joint.shape[0]):
        e = joint[j]
        _, _, _, _, c, s, ls, lq, rs, rq, _, _, _ = meeting(body[pair[j].upper], body[pair[j].lower], e, l)
        opening[j] = ct.opening(ls, lq, rs, rq, c, s, e.wr[l])
        slip[j] = ls + e.bl[l] if lq < rq else rs - e.br[l]
