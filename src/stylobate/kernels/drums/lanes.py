"""Lanes of stacked drums: their records, the ground under them, and what is looked at between chunks of steps.

What plane models of drums have in common, whatever the law of their joints. A block advances ``LANES`` independent runs
together. The innermost loops run over lanes, without a branch that depends on one, so that they fill the vector registers.
Every array is one of records whose fields hold one value per lane: distances in memory are then known to the compiler. A
lane whose run is over has ``dt = 0`` and stands still; it is taken out before the block goes on.

Legend (i drum, 0 is the base; j joint, between drums j and j + 1; positions at t_n, velocities at t_{n−1/2})::

    drum[i]    x z th c s     centroid [m], rotation [rad], its cosine and sine
               vx vz w        velocities [m/s], [rad/s]
               m i im ii      mass [kg], inertia [kg m²], and their inverses
               hb ht          centroid to lower and to upper face [m]
               bl br t        from the centroid's foot on the lower face to that face's left and right end; half width of
                              the upper face, in whose middle the centroid's foot is [m]
               fc fs          cosine and sine of the upper face's inclination to the lower one
    joint[j]   kn ks co       k_n, k_s, cohesion × area per length of overlap      [N/m²], [N/m²], [N/m]
               mu             tan φ
               over           length of overlap of the two faces                   [m]
               fs[p] fn[p]    shear force and elastic normal force of contact point p [N]
               dn[p] ds[p]    dashpot forces of contact point p                    [N]
               fx fz mu_ ml   force on the drum above, moments on the drums above and below about their centroids
    lane       dt g gx        step [s], gravity normal to the base and along it (down to the left) [m/s²]
               beta alpha     stiffness- and mass-proportional damping [s], [1/s]; local: Cundall's local damping [-]
               xi[p] sh[p]    place (−1 … 1) and share of the area of contact point p
               work shear visc  work of the input, of the shear springs on their surroundings reversed, of the dampers [J]
               px pz          momentum of all drums [kg m/s]
               m…             links, see link_records.py
    ground[k]  ax az          acceleration of the base at step k of the chunk [m/s²]
    feed       x z            addresses of the samples of the lane's motion (z 0: no vertical component)
               last step end  index of the last sample, step now, last step
               ratio factor   step over sample interval, factor of the samples
               bc bs          cosine and sine of the base's slope, along which the motion is taken
    watch      status         RUNNING, ENDED, COLLAPSED, FAILED or FREE
               follow         1: go on after a collapse
               amax           largest horizontal acceleration of the motion, and of its vertical part vmax [m/s²]
               top open turn wmax   peaks: |top displacement| [m], joint opening [m], |rotation| [rad], |input work| [J]
               going          1 while some part is beyond its support and moves outward
               ktop kopen kturn     the peaks as they were when last no part was on its way out
               when which side      collapse: step, joint, side (±1); −1 while there is none
               stood          where the middle of the topmost face stood [m]
               m x z px       running sums over the drums above a joint
               hold           what links hold, see link_records.py
"""

import numpy as np

from ..ground import MEAN, sample
from ..jit import apart, kernel, law, strict
from ..run_codes import CHUNK, COLLAPSED, ENDED, FAILED, LANES, RUNNING, SUPPORT_MARGIN
from . import contact as ct
from .link_records import hold_field, link_fields

#: A lane whose positions are larger has failed [m].
FAR = 1.0e6


def block_types(points, damped):
    """Record types (drum, joint, lane, ground, feed, watch).

    The types carry the number of contact points per joint and whether there are dashpots (``dn``, ``ds`` of more than one
    row): the compiler makes one loop for each combination that is used, with both as constants.
    """
    row, rows = (LANES,), (points, LANES)
    dashpots = (points if damped else 1, LANES)

    def fields(single, several=""):
        return [(name, np.float64, row) for name in single.split()] + [
            (name, np.float64, rows) for name in several.split()
        ]

    return (
        np.dtype(fields("x z th c s vx vz w m i im ii hb ht bl br t fc fs")),
        np.dtype(
            fields("kn ks co mu over fx fz mu_ ml", "fs fn") + [(name, np.float64, dashpots) for name in ("dn", "ds")]
        ),
        np.dtype(fields("dt g gx beta alpha local work shear visc px pz", "xi sh") + link_fields()),
        np.dtype(fields("ax az")),
        np.dtype([(name, np.int64, row) for name in ("x", "z", "last", "step", "end")] + fields("ratio factor bc bs")),
        np.dtype(
            [(name, np.int64, row) for name in ("status", "follow", "when", "which", "side", "parted", "about")]
            + fields("amax vmax stood top open turn wmax wide going ktop kopen kturn m x z px")
            + hold_field()
        ),
    )


@law
def upper_face(v, l):
    """Cosine and sine of the direction of a drum's upper face."""
    return v.c[l] * v.fc[l] - v.s[l] * v.fs[l], v.s[l] * v.fc[l] + v.c[l] * v.fs[l]


@law
def along_base(ax, az, c, s):
    """An acceleration along and normal to the base."""
    return ax * c + az * s, az * c - ax * s


@kernel
def fill_ground(ground, feed, watch):
    """Acceleration of the base for the next chunk, each lane from its own motion."""
    f = feed[0]
    for l in range(LANES):
        running = watch[0].status[l] == RUNNING
        for k in range(CHUNK + 1):
            g = ground[k]
            if running:
                place = (f.step[l] + k) * f.ratio[l]
                ax = f.factor[l] * sample(f.x[l], f.last[l], place, MEAN)
                az = f.factor[l] * sample(f.z[l], f.last[l], place, MEAN) if f.z[l] != 0 else 0.0
                g.ax[l], g.az[l] = along_base(ax, az, f.bc[l], f.bs[l])
            else:
                g.ax[l] = 0.0
                g.az[l] = 0.0


@strict
def check_finite(drum, watch):
    """Lanes whose state is not finite, or that are far away, have failed."""
    w = watch[0]
    for i in range(1, drum.shape[0]):
        u = drum[i]
        for l in range(LANES):
            lost = w.status[l] == RUNNING and not (abs(u.x[l]) + abs(u.z[l]) + abs(u.th[l]) < FAR)
            w.status[l] = FAILED if lost else w.status[l]


@apart
def observe(drum, joint, lane, feed, watch):
    """Look at all lanes: peaks, and certain collapses; renormalise (cos, sin).

    A collapse is certain when, for the part of the column above a joint, its centroid lies beyond the end of the contact,
    moves outward, and the moment of its weight about that end exceeds what the strongest acceleration of the motion and
    the slope of the base could ever set against it (for joints between drums, with SUPPORT_MARGIN on top); or when two
    faces no longer overlap.  # Eq. (D6)

    Peaks are kept apart as they were when last no part was beyond its support and moving outward: those of a column that
    falls are its peaks before it fell.
    """
    drums = drum.shape[0] - 1
    o = lane[0]
    f = feed[0]
    w = watch[0]
    top = drum[drums]
    for l in range(LANES):
        # peaks of a column that stands: they end with its collapse
        _, st = upper_face(top, l)
        w.top[l] = max(w.top[l], abs(top.x[l] - st * top.ht[l] - w.stood[l])) if w.when[l] < 0 else w.top[l]
        w.going[l] = 0.0
        w.wmax[l] = max(w.wmax[l], abs(o.work[l]))
        w.m[l] = 0.0
        w.x[l] = 0.0
        w.z[l] = 0.0
        w.px[l] = 0.0
    for i in range(1, drums + 1):
        u = drum[i]
        for l in range(LANES):
            fix = 1.5 - 0.5 * (u.c[l] * u.c[l] + u.s[l] * u.s[l])
            u.c[l] *= fix
            u.s[l] *= fix
            w.turn[l] = max(w.turn[l], abs(u.th[l])) if w.when[l] < 0 else w.turn[l]
            w.m[l] += u.m[l]
            w.x[l] += u.m[l] * u.x[l]
            w.z[l] += u.m[l] * u.z[l]
            w.px[l] += u.m[l] * u.vx[l]
    for j in range(drums):
        u = drum[j + 1]
        v = drum[j]
        e = joint[j]
        margin = SUPPORT_MARGIN if j > 0 else 0.0
        for l in range(LANES):
            half = v.t[l]
            cf, sf = upper_face(v, l)
            ps, pq, c, s = ct.relative_pose(u.x[l], u.z[l], u.c[l], u.s[l], v.x[l], v.z[l], cf, sf, v.ht[l])
            ls, lq, rs, rq = ct.face_corners(ps, pq, c, s, u.bl[l], u.br[l], u.hb[l])
            lo = max(ls, -half)
            hi = min(rs, half)
            opening = ct.opening(ls, lq, rs, rq, c, s, half)
            w.open[l] = max(w.open[l], opening) if w.when[l] < 0 else w.open[l]
            # centroid of the part above, and the end of the contact on the side to which it leans, in world axes
            each = 1.0 / w.m[l]
            cx = w.x[l] * each
            cz = w.z[l] * each
            middle = v.x[l] + 0.5 * cf * (lo + hi) - sf * v.ht[l]
            side = 1.0 if cx > middle else -1.0
            end = hi if cx > middle else lo
            end_x = v.x[l] + cf * end - sf * v.ht[l]
            end_z = v.z[l] + sf * end + cf * v.ht[l]
            out = side * (cx - end_x)
            up = max(cz - end_z, 0.0)
            outward = side * (w.px[l] * each - (v.vx[l] - v.w[l] * (end_z - v.z[l])))
            down = max(o.g[l] - w.vmax[l], 0.0)
            against = max(w.amax[l] + side * o.gx[l], 0.0) + margin
            held = w.hold[j * LANES + l] * each  # by links
            lost = (out > 0.0) & (outward > 0.0) & (out * down > against * up + held)
            w.going[l] = 1.0 if (out > 0.0) & (outward > 0.0) else w.going[l]
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
    for l in range(LANES):
        calm = (w.when[l] < 0) & (w.going[l] == 0.0)
        w.ktop[l] = w.top[l] if calm else w.ktop[l]
        w.kopen[l] = w.open[l] if calm else w.kopen[l]
        w.kturn[l] = w.turn[l] if calm else w.kturn[l]


@kernel
def end_runs(lane, feed, watch):
    """Runs end at their last step, or at their collapse; lanes that are over get dt = 0."""
    f = feed[0]
    w = watch[0]
    for l in range(LANES):
        if w.status[l] == RUNNING:
            if w.when[l] >= 0 and w.follow[l] == 0:
                w.status[l] = COLLAPSED
            elif f.step[l] >= f.end[l]:
                w.status[l] = COLLAPSED if w.when[l] >= 0 else ENDED
        if w.status[l] != RUNNING:
            lane[0].dt[l] = 0.0


@strict
def joint_state(drum, l, opening, slip):
    """Opening and slip of every joint of one lane [m]; the slip is read at the edge that is less open."""
    for j in range(drum.shape[0] - 1):
        u = drum[j + 1]
        v = drum[j]
        cf, sf = upper_face(v, l)
        ps, pq, c, s = ct.relative_pose(u.x[l], u.z[l], u.c[l], u.s[l], v.x[l], v.z[l], cf, sf, v.ht[l])
        ls, lq, rs, rq = ct.face_corners(ps, pq, c, s, u.bl[l], u.br[l], u.hb[l])
        opening[j] = ct.opening(ls, lq, rs, rq, c, s, v.t[l])
        slip[j] = ls + u.bl[l] if lq < rq else rs - u.br[l]


@kernel
def running_lanes(watch):
    """Number of lanes whose run goes on."""
    count = 0
    for l in range(LANES):
        count += watch[0].status[l] == RUNNING
    return count
