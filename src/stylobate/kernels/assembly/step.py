"""Any set of convex bodies in the plane: joints between faces that touch, an elastic bed between all other pairs.

A joint (``joints.py``) follows the law of the column's joints, in the same order of arithmetic as the lanes of
``dem2d/step.py``. It hands over to the bed (``bed.py``) by a weight that is a function of the relative
rotation and of the overlap alone, so that no force jumps; once the weight has reached zero the joint is gone.

Legend (positions at t_n, velocities at t_{n−1/2})::

    body[i]     x z th c s      centroid [m], rotation [rad], its cosine and sine
                vx vz w         velocities [m/s], [rad/s]
                m im ii i       mass, inverses of mass and inertia (0 where fixed), inertia
                fx fz mo        force [N], moment about the centroid [N m]
                r travel        largest distance of a corner from the centroid, way since the boxes were made [m]
                depth           thickness across the plane [m]
                first count     its corners in ``corner``
    joint[j]    lower upper     bodies; the face of the lower one is the frame
                lc ls uc us     direction of the face in the frame of the lower, of the upper body
                ht wl wr        lower centroid to its face; from the centroid's foot to the face's left and right end [m]
                hb bl br        the same of the upper body
                kn ks co mu     per length of overlap                                           [N/m²], [N/m²], [N/m], [-]
                fs fn dn ds     of each contact point: spring and dashpot forces                [N]
                over width      overlap, the smaller face                                       [m]
                from_c to_c     cosines of the relative rotations from which the bed acts too, and alone
                weight          1 joint, 0 bed, between them both                               [-]
                live            0: the faces have parted for good
    pairs       bodies that may touch; joined[a, b] their joint or −1
    law[a, b]   bed of a pair, a < b: k_n, k_s [N/m³], tan φ [-]
    links       what links two bodies each (``links.py``); none in most assemblies
    memory[a, b]   shear force of their bed, its normal and tangential dashpot forces [N]
    now         dt last         step, and the last one taken [s]: while bodies may strike each other, or a joint hands
                                over (``loose`` > 0), or joints are dull, a step is taken in ``finer`` equal parts
                g gx bc bs beta alpha local   gravity, slope of the base, damping (as in the lanes)
                eta calm        restitution of the bed: F is larger by eta while it closes, smaller while it opens; below
                                the speed ``calm`` [m/s] in proportion to it; ``dull`` is the same of the joints
                work shear visc px pz     as in the lanes
                deepest         largest depth of the bed seen [m];  touched  first step with a foreign contact, −1
                step pairs failed         steps done, number of pairs, 1: a state is not finite
"""

import math

import numpy as np

from ..drums import contact as ct
from ..drums import lanes
from ..drums.body import damped_velocity
from ..ground import MEAN, sample
from ..jit import kernel, strict
from ..run_codes import CHUNK
from . import narrow_phase as near
from .bed import bed_forces, place
from .broad_phase import make_boxes, sweep
from .joints import face, handover, joint_forces
from .links import link_forces, look_at_links

MOST = near.MOST


def types(points):
    """Record types (body, joint, now)."""

    def fields(names, shape=()):
        return [(name, np.float64, shape) for name in names.split()]

    def counts(names):
        return [(name, np.int64) for name in names.split()]

    body = fields("x z th c s vx vz w m i im ii fx fz mo r travel depth") + counts("first count")
    joint = (
        counts("lower upper live")
        + fields("lc ls uc us ht wl wr hb bl br kn ks co mu over width from_c to_c weight")
        + fields("fs fn dn ds", (points,))
    )
    now = (
        fields("dt last g gx bc bs beta alpha local eta dull calm work shear visc px pz skin deepest")
        + counts("step pairs touched failed loose finer")
        + fields("xi sh", (points,))
    )
    return np.dtype(body), np.dtype(joint), np.dtype(now)


@kernel
def move(body, now, gx, gz, gx1, gz1, dt):
    """Motion of all bodies over the next step ``dt``, with the ground's acceleration at its two ends.

    As ``move`` of the lanes; where the step changes, velocities in the middle of steps are half of both apart. Returns
    the longest way since the boxes were made.
    """
    o = now[0]
    kick = 0.5 * (o.last + dt)
    o.last = dt
    o.px = 0.0
    o.pz = 0.0
    half = 0.5 * o.alpha * kick
    damped = o.alpha > 0.0 or o.local > 0.0
    farthest = 0.0
    for i in range(body.shape[0]):
        u = body[i]
        if u.im == 0.0:
            continue
        vx = u.vx
        vz = u.vz
        w = u.w
        ax = u.fx * u.im - gx - o.gx
        az = u.fz * u.im - gz - o.g
        aw = u.mo * u.ii
        m = u.m
        if damped:
            nx, mx = damped_velocity(vx, ax, kick, half, o.local)
            nz, mz = damped_velocity(vz, az, kick, half, o.local)
            nw, mw = damped_velocity(w, aw, kick, half, o.local)
            o.visc += o.alpha * kick * (m * (mx * mx + mz * mz) + u.i * mw * mw)
        else:
            nx = vx + ax * kick
            nz = vz + az * kick
            nw = w + aw * kick
        u.vx = nx
        u.vz = nz
        u.w = nw
        u.x += nx * dt
        u.z += nz * dt
        u.th += nw * dt
        c, s = ct.turn(u.c, u.s, nw * dt)
        u.c = c
        u.s = s
        o.px += m * nx
        o.pz += m * nz
        u.travel += (abs(nx) + abs(nz) + u.r * abs(nw)) * dt
        farthest = max(farthest, u.travel)
    o.work -= (0.5 * (gx + gx1) * o.px + 0.5 * (gz + gz1) * o.pz) * dt
    return farthest


@kernel
def renew_pairs(body, corner, now, box, order, pairs):
    """Make the boxes and the list of pairs anew."""
    o = now[0]
    make_boxes(body, corner, o.skin, box)
    o.pairs = sweep(body, box, order, pairs)


@kernel
def may_come_loose(body, corner, joint, now, box, order, pairs, joined, real, time):
    """Whether bodies that are not joined may touch, or a joint may hand over, within a time at twice today's speeds."""
    o = now[0]
    fastest = 0.0
    for i in range(body.shape[0]):
        u = body[i]
        fastest = max(fastest, math.sqrt(u.vx * u.vx + u.vz * u.vz) + u.r * abs(u.w) + o.g * time)
    keep = o.skin
    o.skin = keep + 4.0 * fastest * time
    renew_pairs(body, corner, now, box, order, pairs)
    o.skin = keep
    xa, za, xb, zb, _, _, _, _ = real
    for k in range(o.pairs):
        if joined[pairs[k, 0], pairs[k, 1]] < 0:
            a = body[pairs[k, 0]]
            b = body[pairs[k, 1]]
            na = place(a, corner, xa, za)
            nb = place(b, corner, xb, zb)
            closing = math.hypot(b.vx - a.vx, b.vz - a.vz) + a.r * abs(a.w) + b.r * abs(b.w)
            gap = max(near.separation(xa, za, na, xb, zb, nb), near.separation(xb, zb, nb, xa, za, na))
            if gap < 2.0 * (closing + o.g * time) * time:
                return True
    for j in range(joint.shape[0]):
        e = joint[j]
        u = body[e.upper]
        v = body[e.lower]
        cl, sl = face(v, e.lc, e.ls)
        cu, su = face(u, e.uc, e.us)
        ps, pq, c, s = ct.relative_pose(u.x, u.z, cu, su, v.x, v.z, cl, sl, e.ht)
        left_s, _, right_s, _ = ct.face_corners(ps, pq, c, s, e.bl, e.br, e.hb)
        over = min(right_s, e.wr) - max(left_s, -e.wl)
        dvx = u.vx - v.vx
        dvz = u.vz - v.vz
        slip, _ = ct.contact_velocity(
            ps, 0.0, 0.0, 1.0, ps, pq, e.ht, cl * dvx + sl * dvz, cl * dvz - sl * dvx, u.w, v.w
        )
        turning = abs(u.w - v.w)
        more = 2.0 * (abs(slip) + turning * e.width + o.g * time) * time
        turned = math.acos(min(max(c, -1.0), 1.0)) + 2.0 * turning * time
        if handover(math.cos(min(turned, math.pi)), over - more, e) < 1.0:
            return True
    return False


@strict
def settle_lengths(body, now):
    """Renormalise (cos, sin); report bodies whose state is not finite or that are far away."""
    for i in range(body.shape[0]):
        u = body[i]
        fix = 1.5 - 0.5 * (u.c * u.c + u.s * u.s)
        u.c *= fix
        u.s *= fix
        if not (abs(u.x) + abs(u.z) + abs(u.th) < lanes.FAR) and u.im > 0.0:
            now[0].failed = 1


@kernel
def look(body, now, drum, stack_joint, lane, feed, watch):
    """Look at a column, the first bodies, as the lanes do: peaks, and certain collapses (first lane)."""
    for i in range(drum.shape[0]):
        u = body[i]
        d = drum[i]
        d.x[0] = u.x
        d.z[0] = u.z
        d.th[0] = u.th
        d.c[0] = u.c
        d.s[0] = u.s
        d.vx[0] = u.vx
        d.vz[0] = u.vz
        d.w[0] = u.w
    lane[0].work[0] = now[0].work
    feed[0].step[0] = now[0].step
    lanes.observe(drum, stack_joint, lane, feed, watch)


@kernel
def advance(
    body,
    corner,
    joint,
    now,
    box,
    order,
    pairs,
    joined,
    links,
    law,
    memory,
    real,
    whole,
    motion,
    ground,
    factor,
    ratio,
    stack,
    chunks,
):
    """Advance by ``chunks`` × CHUNK steps.

    ``motion`` holds the addresses of the samples along x and z (0: none) and the index of the last one; ``stack`` the
    arrays of the lanes through which a column is looked at (drums none: no column).
    """
    o = now[0]
    drum, stack_joint, lane, feed, watch = stack
    for _ in range(chunks):
        for k in range(CHUNK + 1):
            at = (o.step + k) * ratio
            ax = factor * sample(motion[0], motion[2], at, MEAN) if motion[0] != 0 else 0.0
            az = factor * sample(motion[1], motion[2], at, MEAN) if motion[1] != 0 else 0.0
            ground[k, 0], ground[k, 1] = lanes.along_base(ax, az, o.bc, o.bs)
        for k in range(CHUNK):
            parts = o.finer if o.loose > 0 or o.dull > 0.0 else 1
            x0 = ground[k, 0]
            z0 = ground[k, 1]
            dx = (ground[k + 1, 0] - x0) / parts
            dz = (ground[k + 1, 1] - z0) / parts
            for q in range(parts):
                joint_forces(body, joint, now)
                if links.shape[0] > 0:
                    link_forces(body, links, o.last)
                bed_forces(body, corner, joint, now, pairs, joined, law, memory, real, whole)
                farthest = move(body, now, x0 + q * dx, z0 + q * dz, x0 + (q + 1) * dx, z0 + (q + 1) * dz, o.dt / parts)
                if farthest > 0.5 * o.skin:
                    renew_pairs(body, corner, now, box, order, pairs)
            o.step += 1
        if drum.shape[0] > 0:
            look(body, now, drum, stack_joint, lane, feed, watch)
        if links.shape[0] > 0:
            look_at_links(links, o.step)
        settle_lengths(body, now)
        if o.failed != 0:
            break
