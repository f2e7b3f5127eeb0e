"""Rigid beam over lanes: the classical Runge–Kutta method of order 4, cost linear in the drums.

Without sliding the accelerations follow from two sweeps through the tridiagonal mass matrix of the nodal displacements
(M = U D Uᵀ); with sliding every drum is a body of its own and one sweep is enough. Rotations are positive towards +x
(clockwise), displacements relative to the base. A lane whose run is over has ``dt = 0`` and stands still.

Legend (drum 1 … n and its joint, the one under it; 0 is the base, n + 1 nothing)::

    drum[i]   th w ts ws       rotation and its velocity, now and at the stage [rad], [rad/s]
              st sw            sums of the stages
              k m1 s1 m2 s2    moment law of the joint, see moment_law.py
              gs sx            g S_i (0 where the law holds the second-order effect) and S_i = Σ_j m_j c_ji [N m], [kg m]
              ih p             1/h_i [1/m]; mass on node i [kg]
              di lo            1/D_i and U_{i−1,i} of the mass matrix
              y                right-hand side, eliminated
    sliding   x v xs vs sx_ sv displacement of the centroid and its velocity, at the stage, sums [m], [m/s]
              im ii zb zt      1/m, 1/I, centroid to lower and to upper face [m]
              ks mu co n       k_s A [N/m], N tan φ [N], cohesion × A [N], N with second-order effect, else 0 [N]
              pl               plastic slip of the joint [m]; te: rotation when the motion ends [rad]
    watched   m c half alpha   mass [kg], rotation at which the joint opens [rad], d/2 [m], critical angle of the law [rad]
              fl fu            half widths of the drum's lower face and of the face under it, without end for the base [m]
              mu_m sz          M_u and Σ_j≥i m_j (z_j − z_i): what gravity and a base acceleration do to the part above
    lane      dt rel beta      step [s]; 1 relative, 0 absolute rotation in the law; stiffness-proportional damping [s]
              work visc fric joint   input work, viscous and friction loss, work of the joints' moments [J]
              ax gm            a_g [m/s²] and 1 + a_v/g at the stage
              mo qa ya la ub pa  carried from drum to drum
              pw pv pj tw tv tj  powers now [W], and their sums over the stages
              g                gravity [m/s²]
    watch     status follow    RUNNING, ENDED, COLLAPSED, FAILED or FREE; 1: go on after a collapse
              x z last         addresses of the samples (z 0: no vertical component), index of the last sample
              step half_steps end   steps and half steps done, last step
              when which side  collapse: step, joint, side (+1: towards +x); −1 while there is none
              ratio factor lift  half a step over the sampling interval, factors of the samples (vertical: over g)
              pga until gmin   largest horizontal acceleration of the motion, its end [s], smallest 1 + a_v/g
              top open turn wmax shift stood  peaks: top displacement, opening, rotation, work, slip; top at the start
"""

import math

import numpy as np

from ..ground import fill_ground
from ..jit import apart, kernel, law, strict
from ..run_codes import COLLAPSED, ENDED, FAILED, LANES, RUNNING, SUPPORT_MARGIN
from .moment_law import bed_moment, three_lines

_ROW = (LANES,)


def _fields(names):
    return [(name, np.float64, _ROW) for name in names.split()]


DRUM = np.dtype(
    _fields(
        "th w ts ws st sw k m1 s1 m2 s2 gs sx ih p di lo y "
        "x v xs vs tx tv im ii zb zt ks mu co n pl te m c half fl fu alpha mu_m sz"
    )
)
LANE = np.dtype(_fields("dt rel beta ax gm work visc fric joint mo qa ya la ub pa pw pv pj tw tv tj g"))
WATCH = np.dtype(
    [(name, np.int64, _ROW) for name in ("status", "follow", "x", "z", "last", "half_steps", "step", "end")]
    + [(name, np.int64, _ROW) for name in ("when", "which", "side")]
    + _fields("ratio factor lift pga until gmin top open turn wmax shift stood")
)


@law
def signed(size, like):
    """``size`` with the sign of ``like``."""
    return size if like >= 0.0 else -size


@law
def joint_moment(phi, gamma, k, m1, s1, m2, s2, bed):
    """Moment of a joint by either kind of law."""
    size = abs(phi)
    if bed is None:
        return signed(three_lines(size, gamma, k, m1, s1, m2, s2), phi)
    else:
        return signed(bed_moment(size, gamma, k, m1, s1, s2, bed), phi)


@law
def joint_closed(phi, gamma, k, m1, s1, m2, s2, bed):
    """1 while the joint is on its elastic branch, else 0."""
    size = abs(phi)
    if bed is None:
        return 1.0 if k * size <= min(gamma * (m1 + s1 * size), gamma * (m2 + s2 * size)) else 0.0
    else:
        return 1.0 if size <= gamma * s1 else 0.0


@law
def advance_stage(now, sum_, slope, h, keep, weight, share, close):
    """One stage of the classical Runge–Kutta method for one variable.

    ``now`` at the start of the step, ``slope`` its rate at this stage. Returns the sum of weighted rates, and the value at
    the next stage (``share`` of a step on) or at the end of the step (``close`` = 1/6 in the last stage, else 0).
    """
    total = keep * sum_ + weight * slope
    return total, now + h * (share * slope + close * total)


@apart
def stage(drum, lane, keep, weight, share, close, bed, vertical, damped):
    """Accelerations at the stage values and the values of the next stage: no sliding.  # Eq. (F3)

    ``keep``, ``weight``, ``share``, ``close``: see :func:`advance_stage`.
    """
    n = len(drum) - 2
    s = lane[0]
    for l in range(LANES):
        s.mo[l] = s.qa[l] = s.ya[l] = s.la[l] = s.ub[l] = s.pw[l] = s.pv[l] = s.pj[l] = 0.0
    for i in range(n, 0, -1):
        d, below = drum[i], drum[i - 1]
        for l in range(LANES):
            gamma = s.gm[l]
            phi = d.ts[l] - s.rel[l] * below.ts[l]
            m = joint_moment(phi, gamma, d.k[l], d.m1[l], d.s1[l], d.m2[l], d.s2[l], bed)
            power = m * (d.ws[l] - below.ws[l])
            s.pj[l] += power
            if vertical is not None:
                # Work that the vertical input does by way of the weight: on the tilted drums and on the opened joints.
                still = joint_moment(phi, 1.0, d.k[l], d.m1[l], d.s1[l], d.m2[l], d.s2[l], bed)
                s.pw[l] += (gamma - 1.0) * d.gs[l] * d.ts[l] * d.ws[l] - (m - still) * (d.ws[l] - below.ws[l])
                s.pj[l] += (still - m) * (d.ws[l] - below.ws[l])
            if damped is not None:
                spin = d.ws[l] - below.ws[l]
                dash = s.beta[l] * d.k[l] * (d.ws[l] - s.rel[l] * below.ws[l])
                dash = dash * joint_closed(phi, gamma, d.k[l], d.m1[l], d.s1[l], d.m2[l], d.s2[l], bed)
                s.pv[l] += dash * spin
                m += dash
            q = d.ih[l] * (s.mo[l] - m + gamma * d.gs[l] * d.ts[l])
            y = q - s.qa[l] - s.ax[l] * d.p[l] - s.la[l] * s.ya[l]
            s.pw[l] -= s.ax[l] * d.sx[l] * d.ws[l]
            d.y[l] = y
            s.mo[l], s.qa[l], s.ya[l], s.la[l] = m, q, y, d.lo[l]
    for i in range(1, n + 1):
        d = drum[i]
        for l in range(LANES):
            h = s.dt[l]
            u = d.y[l] * d.di[l] - d.lo[l] * s.ub[l]
            turn = (u - s.ub[l]) * d.ih[l]
            s.ub[l] = u
            speed = d.ws[l]
            d.st[l], angle = advance_stage(d.th[l], d.st[l], speed, h, keep, weight, share, close)
            d.sw[l], spin = advance_stage(d.w[l], d.sw[l], turn, h, keep, weight, share, close)
            d.ts[l], d.ws[l] = angle, spin


@apart
def stage_sliding(drum, lane, keep, weight, share, close, bed, vertical, damped):
    """As :func:`stage`, with a slip at every joint: each drum moves by its own forces.  # Eqs. (R5), (R6)"""
    n = len(drum) - 2
    s = lane[0]
    for l in range(LANES):
        s.mo[l] = s.qa[l] = s.pa[l] = s.pw[l] = s.pv[l] = s.pj[l] = 0.0
    for i in range(n, 0, -1):
        d, below = drum[i], drum[i - 1]
        for l in range(LANES):
            gamma, h = s.gm[l], s.dt[l]
            phi = d.ts[l] - s.rel[l] * below.ts[l]
            spin = d.ws[l] - below.ws[l]
            m = joint_moment(phi, gamma, d.k[l], d.m1[l], d.s1[l], d.m2[l], d.s2[l], bed)
            slip = d.xs[l] - d.zb[l] * d.ts[l] - below.xs[l] - below.zt[l] * below.ts[l]
            rate = d.vs[l] - d.zb[l] * d.ws[l] - below.vs[l] - below.zt[l] * below.ws[l]
            # Mohr–Coulomb, elastic–perfectly plastic  # Eq. (R6)
            limit = max(gamma, 0.0) * d.mu[l] + d.co[l]
            trial = d.ks[l] * (slip - d.pl[l])
            shear = min(max(trial, -limit), limit)
            s.pj[l] += m * spin
            if vertical is not None:
                still = joint_moment(phi, 1.0, d.k[l], d.m1[l], d.s1[l], d.m2[l], d.s2[l], bed)
                s.pw[l] += (gamma - 1.0) * d.gs[l] * d.ts[l] * d.ws[l] - (m - still) * spin
                s.pw[l] += (gamma - 1.0) * d.n[l] * (below.ts[l] * rate + slip * below.ws[l])
                s.pj[l] += (still - m) * spin
            if damped is not None:
                dash = s.beta[l] * d.k[l] * spin
                dash = dash * joint_closed(phi, gamma, d.k[l], d.m1[l], d.s1[l], d.m2[l], d.s2[l], bed)
                m += dash
                drag = min(max(trial + s.beta[l] * d.ks[l] * rate, -limit), limit) - shear
                shear += drag
                s.pv[l] += dash * spin + drag * rate
            # the weight on a face that is tilted, and off the middle of the drum that carries it
            push = shear - gamma * d.n[l] * below.ts[l]
            tip = gamma * d.n[l] * slip
            s.pw[l] -= s.ax[l] * d.vs[l] / d.im[l]
            drive = (s.qa[l] - push) * d.im[l] - s.ax[l]
            moment = s.mo[l] - m + push * d.zb[l] + s.qa[l] * d.zt[l] + gamma * d.gs[l] * d.ts[l] + s.pa[l]
            turn = moment * d.ii[l]
            s.mo[l], s.qa[l], s.pa[l] = m, push, tip
            d.tx[l], place = advance_stage(d.x[l], d.tx[l], d.vs[l], h, keep, weight, share, close)
            d.tv[l], speed = advance_stage(d.v[l], d.tv[l], drive, h, keep, weight, share, close)
            d.st[l], angle = advance_stage(d.th[l], d.st[l], d.ws[l], h, keep, weight, share, close)
            d.sw[l], omega = advance_stage(d.w[l], d.sw[l], turn, h, keep, weight, share, close)
            d.xs[l], d.vs[l], d.ts[l], d.ws[l] = place, speed, angle, omega


@apart
def yield_joints(drum, lane, g):
    """Plastic slip of every joint brought up to the end of the step, and the friction loss.  # Eq. (R6)"""
    s = lane[0]
    for i in range(1, len(drum) - 1):
        d, below = drum[i], drum[i - 1]
        for l in range(LANES):
            slip = d.x[l] - d.zb[l] * d.th[l] - below.x[l] - below.zt[l] * below.th[l]
            limit = max(g[l], 0.0) * d.mu[l] + d.co[l]
            trial = d.ks[l] * (slip - d.pl[l])
            shear = min(max(trial, -limit), limit)
            more = (trial - shear) / d.ks[l]
            d.pl[l] += more
            s.fric[l] += shear * more


@apart
def sum_powers(lane, keep, weight, close):
    """Add the powers of this stage to the works, as the stages weight them."""
    s = lane[0]
    for l in range(LANES):
        s.tw[l] = keep * s.tw[l] + weight * s.pw[l]
        s.tv[l] = keep * s.tv[l] + weight * s.pv[l]
        s.tj[l] = keep * s.tj[l] + weight * s.pj[l]
        s.work[l] += close * s.dt[l] * s.tw[l]
        s.visc[l] += close * s.dt[l] * s.tv[l]
        s.joint[l] += close * s.dt[l] * s.tj[l]


@kernel
def close_step(drum):
    """The stage values are those at the end of the step."""
    for i in range(1, len(drum) - 1):
        d = drum[i]
        for l in range(LANES):
            d.th[l], d.w[l], d.x[l], d.v[l] = d.ts[l], d.ws[l], d.xs[l], d.vs[l]


@kernel
def one_step(drum, lane, a0, a1, a2, g0, g1, g2, sliding, bed, vertical, damped):
    """One step of every lane; ``a``, ``g`` at its start, its middle and its end."""
    for k in range(4):
        # the classical weights 1 2 2 1 over 6, the stages at 0, ½, ½ and 1
        keep, weight = (0.0 if k == 0 else 1.0), (2.0 if k == 1 or k == 2 else 1.0)
        share, close = (0.5 if k < 2 else 1.0 if k == 2 else 0.0), (1.0 / 6.0 if k == 3 else 0.0)
        a = a0 if k == 0 else a2 if k == 3 else a1
        g = g0 if k == 0 else g2 if k == 3 else g1
        for l in range(LANES):
            lane[0].ax[l], lane[0].gm[l] = a[l], g[l]
        if sliding is None:
            stage(drum, lane, keep, weight, share, close, bed, vertical, damped)
        else:
            stage_sliding(drum, lane, keep, weight, share, close, bed, vertical, damped)
        sum_powers(lane, keep, weight, close)
    close_step(drum)
    if sliding is not None:
        yield_joints(drum, lane, g2)


@kernel
def advance(drum, lane, watch, a, g, chunks, chunk, sliding, bed, vertical, damped):
    """Advance all lanes by up to ``chunks`` × ``chunk`` steps.

    Parameters
    ----------
    drum, lane, watch : record arrays
        DRUM of shape (n + 2,), LANE and WATCH of shape (1,).
    a, g : array, shape ((2 chunk + 1) * LANES,)
        Room for a_g and 1 + a_v/g at half steps.
    sliding, vertical, damped : True or None
        What the run has; the compiler makes one loop for each combination in use.
    bed : None, True or tuple of float
        Three lines, rectangular bed, circular bed.
    """
    f = watch[0]
    rows = 2 * chunk + 1
    for _ in range(chunks):
        running = 0
        for l in range(LANES):
            if f.status[l] == RUNNING:
                running += 1
        if running == 0:
            return
        fill_ground(a, rows, f.x, f.last, f.factor, f.half_steps, f.ratio, 0.0)
        if vertical is not None:
            fill_ground(g, rows, f.z, f.last, f.lift, f.half_steps, f.ratio, 1.0)
        for j in range(chunk):
            r = 2 * j * LANES
            one_step(
                drum, lane,
                a[r : r + LANES], a[r + LANES : r + 2 * LANES], a[r + 2 * LANES : r + 3 * LANES],
                g[r : r + LANES], g[r + LANES : r + 2 * LANES], g[r + 2 * LANES : r + 3 * LANES],
                sliding, bed, vertical, damped,
            )  # fmt: skip
        for l in range(LANES):
            if f.status[l] == RUNNING:
                f.step[l] += chunk
                f.half_steps[l] += 2 * chunk
        observe(drum, lane, watch)


@strict
def observe(drum, lane, watch):
    """Peaks, collapse, end and failure of every lane, once per chunk.

    A part above a joint is lost when gravity's moment about the edge of its support beats what is left of the input, and
    it moves outward  # Eq. (R8); or when its contact has gone
    """
    n = len(drum) - 2
    f, s = watch[0], lane[0]
    for l in range(LANES):
        if f.status[l] != RUNNING:
            continue
        time = f.step[l] * s.dt[l]
        left_over = f.until[l] - time  # of the motion, which ends where a chunk does
        pull = f.pga[l] if left_over > 0.5 * s.dt[l] else 0.0
        sliding = drum[1].ks[l] > 0.0
        # From the base up: the slip of every joint, kept in y; the displacement of the top at the end.
        face, lost, side, lying = 0.0, 0, 0, False
        finite = math.isfinite(s.work[l] + s.visc[l] + s.fric[l] + s.joint[l])
        for i in range(1, n + 1):
            d, below = drum[i], drum[i - 1]
            finite = finite and math.isfinite(d.th[l]) and math.isfinite(d.w[l])
            finite = finite and math.isfinite(d.x[l]) and math.isfinite(d.v[l])
            if left_over > -0.5 * s.dt[l]:
                d.te[l] = d.th[l]
            if sliding:
                bottom = d.x[l] - d.zb[l] * d.th[l]
                slip = bottom - face
            else:
                bottom, slip = face, 0.0
            phi = d.th[l] - below.th[l]
            size = abs(phi)
            gap = 2.0 * d.half[l] * (size - math.sqrt(size * d.c[l])) if size > d.c[l] else 0.0
            f.open[l] = max(f.open[l], gap)
            f.turn[l] = max(f.turn[l], abs(d.th[l]))
            f.shift[l] = max(f.shift[l], abs(slip))
            d.y[l] = slip
            face = bottom + d.th[l] / d.ih[l]
        if not finite:
            f.status[l] = FAILED
        f.top[l] = max(f.top[l], abs(face - f.stood[l]))
        f.wmax[l] = max(f.wmax[l], abs(s.work[l]))
        # From the top down: mass, first moment and momentum of everything above each joint, and the slips' share in them.
        mass, first, momentum, slid = 0.0, 0.0, 0.0, 0.0
        higher, higher_rate = 0.0, 0.0
        for i in range(n, 0, -1):
            d, below = drum[i], drum[i - 1]
            lever, lever_speed = d.th[l] / d.ih[l], d.w[l] / d.ih[l]
            own, own_speed = d.zb[l] * d.th[l], d.zb[l] * d.w[l]
            # sums are about the lower face of the drum above: shift to this drum's lower face
            first += mass * (lever + higher) + d.m[l] * own
            momentum += mass * (lever_speed + higher_rate) + d.m[l] * own_speed
            slid += mass * higher
            mass += d.m[l]
            slip, rate = d.y[l], 0.0
            if sliding:
                rate = d.v[l] - d.zb[l] * d.w[l] - below.v[l] - below.zt[l] * below.w[l]
            higher, higher_rate = slip, rate
            # what is left of the contact, from the middle of the lower face; sliding on the base takes none of it away
            right, left = min(d.fl[l], d.fu[l] - slip), min(d.fl[l], d.fu[l] + slip)
            reserve = pull + (SUPPORT_MARGIN if i > 1 else 0.0)
            if d.gs[l] > 0.0:
                away = 1.0 if first >= 0.5 * mass * (right - left) else -1.0
                edge = right if away > 0.0 else left
                driving = s.g[l] * (away * first - mass * edge)
                speed = momentum
            else:
                phi = d.th[l] - s.rel[l] * below.th[l]
                away = 1.0 if phi >= 0.0 else -1.0
                edge = right if away > 0.0 else left
                driving = d.mu_m[l] * (away * phi / d.alpha[l] - 1.0)
                driving += s.g[l] * (away * slid - mass * (edge - d.half[l]))
                speed = d.w[l] - s.rel[l] * below.w[l]
            # where the end of the contact is the lower drum's, it slides as well
            outward = away * (speed + (mass * rate if edge < d.fl[l] else 0.0)) > 0.0
            flat = abs(d.th[l]) > 0.5 * math.pi
            parted = right + left <= 0.0
            if parted:
                away = 1.0 if slip > 0.0 else -1.0
            if (outward and f.gmin[l] * driving > reserve * d.sz[l]) or flat or parted:
                lost, side = i, 1 if away > 0.0 else -1
            lying = lying or flat
        if f.status[l] == RUNNING and lost > 0 and f.when[l] < 0:
            f.when[l], f.which[l], f.side[l] = f.step[l], lost, side
        if f.status[l] == RUNNING and f.when[l] >= 0 and (f.follow[l] == 0 or lying):
            f.status[l] = COLLAPSED
        if f.status[l] == RUNNING and f.step[l] >= f.end[l]:
            f.status[l] = COLLAPSED if f.when[l] >= 0 else ENDED
        if f.status[l] != RUNNING:
            s.dt[l] = 0.0
