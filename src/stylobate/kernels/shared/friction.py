"""Friction of a face: a shear force and a torsion that remember, in two layers, within one limit surface.

Shear is carried by what touches, evenly, pressed much or little: a layer is a spring of stiffness k = k_s A in shear at
the centroid of its area A, and j = κ k_s J in torsion about that centroid, J the polar moment of the area about it. Such a
spring has a potential as long as its area is the same: the tangent stiffness is symmetric, and no closed loop of small
motions does work. Only Coulomb's limit knows the pressure, and its middle P.

What touches changes. Two layers remember: the *core* has touched all the time since the face last slipped; the *fresh* layer
is what has closed since, and came without force. What opens is taken from the fresh layer, and only then from the core, so
that a vibration that opens and closes an edge takes nothing from the core, and a lasting push does not creep. What opens
takes its share of the force with it: stored energy never rises. At the limit the whole face slips, and all of it is core.

Areas are known by three moments each: k, j and the centroid. A core that is part of what touches leaves a fresh layer whose
moments are those of an area, too::

    k_fresh = k − k_core      j_fresh = j − j_core − κ (k_core k / k_fresh) |C_core − C|² ≥ 0

where they would not be, under a drum that rolls, the core has moved with what touches: its centroid is taken along as far as
the inequality asks for. Forces go with it, as under a wheel that rolls without creeping.
"""

import math

from ..jit import law, long_law
from .vectors import along, cross, dot, minus, scaled

#: Coupling of the limit surface: with it the surface of a disc under even pressure is met to 1 %.
COUPLING = 0.57

#: Keeps quotients of nothing by nothing at nothing, and others far from overflowing.
NOTHING = 1e-30

#: Squares of limits below this are none [N²], [N² m²].
NO_LIMIT = 1e-12

#: No part of a face is farther from its centroid than so many radii of gyration, squared.
REACH = 9.0


@law
def remaining(now, before):
    """Share of a spring's force that remains when its stiffness changes.

    Parts that open take their share of the shear with them, parts that close come with none.
    """
    return min(now / max(before, NOTHING), 1.0)


@law
def limit_distance(x, y):
    """Distance of a shear force and a torsion from the origin, over that of the limit surface; 1 on it and inside.

    √(X + Y + 0.57 X Y / (X + Y)) with X and Y the squares of their shares of the two limits: pure sliding and pure
    spinning are exact.
    """
    both = x + y
    return math.sqrt(max(both + COUPLING * x * y / max(both, NOTHING), 1.0))


@long_law
def slipped(force, moment, k, j, arm, n, a, b):
    """A shear force and a torsion about P one step nearer to the limit surface, which has 1/√a and 1/√b for its limits.

    The face slips along the normal of the surface (associated flow) against its springs: slip and spin stand to each other
    as for a disc under even pressure. The surface is convex and its distance of first degree: a step ends on the surface or
    outside of it, and takes stored energy away. ``arm`` goes from P to the centroid, about which ``k`` and ``j`` are.
    """
    x, y = dot(force, force) * a, moment * moment * b
    distance = limit_distance(x, y)
    each = 1.0 / max(x + y, NOTHING)
    u, v = x * each, y * each
    spin = b * (1.0 + COUPLING * u * u) * moment
    slip = along(scaled(a * (1.0 + COUPLING * v * v), force), spin, cross(n, arm))
    size = (distance - 1.0) * distance / max(k * dot(slip, slip) + j * spin * spin, NOTHING)
    change = scaled(size * k, slip)
    return minus(force, change), moment - size * j * spin - dot(cross(arm, change), n)


@long_law
def limited(force, torsion, k, j, arm, n, limits):
    """Shear force at the centroid and torsion about it, brought back to the limit surface if they are beyond it.

    ``limits`` as of :func:`friction`; that of torsion is about the middle of pressure P, from which ``arm`` goes to the
    centroid. Also whether they were beyond it.
    """
    limit, lever, pivot = limits
    some = pivot > 0.0
    each = (1.0 if some else 0.0) / (pivot if some else 1.0)
    moment = torsion * each + dot(cross(arm, force), n)
    most = limit * lever
    a, b = 1.0 / max(limit * limit, NO_LIMIT), 1.0 / max(most * most, NO_LIMIT)
    beyond = limit_distance(dot(force, force) * a, moment * moment * b) > 1.0
    force, moment = slipped(force, moment, k, j, arm, n, a, b)
    force, moment = slipped(force, moment, k, j, arm, n, a, b)
    less = 1.0 / limit_distance(dot(force, force) * a, moment * moment * b)
    force = scaled(less, force)
    return force, pivot * (less * moment - dot(cross(arm, force), n)), beyond


@long_law
def friction(core, fresh, face, n, slip, spin, dt, limits):
    """Friction of a face at t_n, from its layers a step ago.

    Parameters
    ----------
    core : tuple
        Shear force [N], torsion about its centroid [N m], k [N/m], j [N m], centroid [m]; forces are on the upper body.
    fresh : tuple
        Shear force, torsion, k and j of the fresh layer.
    face : tuple
        Of what touches now: k, j, centroid C, middle of pressure P; and 1/κ.
    n : vector
        Normal of the face.
    slip, spin, dt : vector, float, float
        Velocity of the upper face over the lower one at C, across n, relative spin about n, step.
    limits : tuple
        Coulomb's limit of the force [N], the lever of torsion about P [m], and the share of torsion that acts [-].

    Returns
    -------
    core, fresh : tuple
        As given.
    force, torsion : vector, float
        Of both layers, at C and about it.
    power : float
        Of the friction a step ago and now, together, on the upper body [W].
    """
    before, turn_before, k_before, j_before, place = core
    f, t, kf_before, jf_before = fresh
    k, j, centre, middle, polar = face
    pivot = limits[2]
    none = k_before <= 0.0
    kc = k if none else min(k, k_before)
    jc = j if none else min(j, j_before)
    kf = k - kc
    # how far from C the centroid of the core may be, so that the fresh layer is an area
    away = minus(place, centre)
    square = dot(away, away)
    room = polar * (j - jc) * kf / max(kc * k, NOTHING)
    within = min(room, REACH * polar * j * kf * kf / max(k * kc * kc, NOTHING))
    near = math.sqrt(min(within / max(square, NOTHING), 1.0))
    away = scaled(near, away)
    jf = max((j - jc) * (1.0 - min(near * near * square / max(room, NOTHING), 1.0)), 0.0)
    other = scaled(-kc / max(kf, NOTHING), away)
    before, turn_before = scaled(remaining(kc, k_before), before), remaining(jc, j_before) * turn_before
    f_before, t_before = scaled(remaining(kf, kf_before), f), remaining(jf, jf_before) * t
    # both springs
    at_core, at_fresh = along(slip, spin, cross(n, away)), along(slip, spin, cross(n, other))
    out = dot(before, n)
    force = along(along(before, -out, n), -kc * dt, at_core)
    torsion = turn_before - pivot * jc * dt * spin
    out = dot(f_before, n)
    f = along(along(f_before, -out, n), -kf * dt, at_fresh)
    t = t_before - pivot * jf * dt * spin
    power = dot(before, at_core) + dot(f_before, at_fresh) + (turn_before + t_before) * spin
    total = along(force, 1.0, f)
    turning = torsion + t + dot(cross(away, force), n) + dot(cross(other, f), n)
    total, turning, beyond = limited(total, turning, k, j, minus(centre, middle), n, limits)
    power += dot(total, slip) + turning * spin
    # where the face slips, all that touches is core
    keep = 0.0 if beyond else 1.0
    core = (
        (
            total[0] if beyond else force[0],
            total[1] if beyond else force[1],
            total[2] if beyond else force[2],
        ),
        turning if beyond else torsion,
        k if beyond else kc,
        j if beyond else jc,
        along(centre, keep, away),
    )
    return core, (scaled(keep, f), keep * t, keep * kf, keep * jf), total, turning, power


@long_law
def dragged(total, turning, face, n, slip, spin, beta, limits):
    """Force and torsion of dashpots parallel to the springs of friction, at C and about it; all of it in sum stays within
    Coulomb's limit. Parameters as of :func:`friction`, ``beta`` is dashpot over stiffness [s]."""
    k, j, centre, middle, _ = face
    force, torsion = along(total, -beta * k, slip), turning - beta * limits[2] * j * spin
    force, torsion, _ = limited(force, torsion, k, j, minus(centre, middle), n, limits)
    return minus(force, total), torsion - turning


@law
def stored(core, fresh, pivot):
    """Energy that the two layers hold, of which a share ``pivot`` of torsion acts [J]."""
    f, t, k, j, _ = core
    g, s, kf, jf = fresh
    shear = dot(f, f) / max(k, NOTHING) + dot(g, g) / max(kf, NOTHING)
    return 0.5 * (shear + t * t / max(pivot * j, NOTHING) + s * s / max(pivot * jf, NOTHING))
