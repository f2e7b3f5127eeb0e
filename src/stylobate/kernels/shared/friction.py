"""Friction of a face: a shear force and a torsion that remember, in two layers, within one limit surface.

Shear is carried by what touches, evenly, pressed much or little: a layer is a spring of stiffness k = k_s A in shear at
the centroid of its area A, and j = κ k_s J in torsion about that centroid, J the polar moment of the area about it. Such a
spring has a potential as long as its area is the same: the tangent stiffness is symmetric, and no closed loop of small
motions does work. Only Coulomb's limit knows the pressure, and its middle P.

What touches changes. Two layers remember: the *core* has touched all the time since the face last slipped; the *fresh* layer
is what has closed since, and came without force. What opens is taken from the fresh layer, and only then from the core, so
that a vibration that opens and closes an edge takes nothing from the core, and a lasting push does not creep. What opens
takes its share of the force with it: stored energy never rises. At the limit the whole face slips, and all of it is core.

Areas are known by three moments each: k, j and the centroid. What a core leaves of the area that touches is an area, too, if
its polar moment is none below 0::

    j − j_core − κ (k_core k / k_fresh) |C_core − C|² ≥ 0,   k_fresh = k − k_core

Where it would be, under a drum that rolls, the core has gone along with what touches: its centroid is taken as far as the
inequality asks for. Its force goes with it, as under a wheel that rolls without creeping, and what is fresh becomes core
on the way. A torsion does not go along: stone enters under a rolling edge free of shear, and what it gathers there by
spinning has no moment about the middle (strip theory of rolling contact: Johnson 1985, chapter 8).
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

#: The fresh layer becomes core where the face slips: all of it by a thousandth of the limit.
SLIPPED = 1e3

#: Of what is fresh so much becomes core while a face rolls on by a radius of gyration.
RENEWED = 4.0


@law
def limit_distance(x, y):
    """Distance of a shear force and a torsion from the origin, over that of the limit surface; 1 on it and inside.

    √(X + Y + 0.57 X Y / (X + Y)) with X and Y the squares of their shares of the two limits: pure sliding and pure
    spinning are exact.
    """
    both = x + y
    return math.sqrt(max(both + COUPLING * x * y / max(both, NOTHING), 1.0))


@long_law
def limited(force, torsion, k, j, arm, n, limits):
    """Shear force at the centroid and torsion about it, brought back to the limit surface if they are beyond it.

    ``limits`` as of :func:`friction`; that of torsion is about the middle of pressure P, from which ``arm`` goes to the
    centroid. Also how far they were beyond it, over its distance.

    The face slips along the normal of the surface (associated flow) against its springs: slip and spin stand to each other
    as for a disc under even pressure. The surface is convex and its distance of first degree: a step along the normal of
    where the forces are ends on the surface or outside of it, and takes stored energy away; so does the rest of the way,
    towards the origin.
    """
    moment = torsion + dot(cross(arm, force), n)
    square = max(limits[0] * limits[0], NO_LIMIT)
    other = max(limits[0] * limits[0] * limits[1] * limits[1], NO_LIMIT)
    each = 1.0 / (square * other)
    a, b = each * other, each * square
    x, y = dot(force, force) * a, moment * moment * b
    distance = limit_distance(x, y)
    each = 1.0 / max(x + y, NOTHING)
    u, v = x * each, y * each
    spin = b * (1.0 + COUPLING * u * u) * moment
    slip = along(scaled(a * (1.0 + COUPLING * v * v), force), spin, cross(n, arm))
    size = (distance - 1.0) * distance / max(k * dot(slip, slip) + j * spin * spin, NOTHING)
    force, torsion = along(force, -size * k, slip), torsion - size * j * spin
    moment = torsion + dot(cross(arm, force), n)
    less = 1.0 / limit_distance(dot(force, force) * a, moment * moment * b)
    return scaled(less, force), less * torsion, distance - 1.0


@law
def twisted(torsion, j, spin, dt, rolled):
    """Torsion of a layer after a step of spinning, in which what touches has rolled on by so many radii of gyration.

    Stone that has entered since holds none; only what turns faster than it rolls gathers some.
    """
    torsion *= max(1.0 - rolled, 0.0)
    way = j * abs(spin) * dt
    back = min(abs(torsion), way) if torsion * spin > 0.0 else 0.0
    way = back + max(way - back - j * rolled, 0.0)
    return torsion - (way if spin > 0.0 else -way)


@long_law
def friction(core, fresh, face, n, slip, spin, dt, limits):
    """Friction of a face at t_n, from its layers a step ago.

    Parameters
    ----------
    core : tuple
        Shear force [N], torsion about its centroid [N m], k [N/m], j [N m], centroid [m]; forces are on the upper body.
        Where the face slipped, k is negative.
    fresh : tuple
        Shear force, torsion, k and j of the fresh layer.
    face : tuple
        Of what touches now: k, j, centroid C, middle of pressure P; and 1/κ.
    n : vector
        Normal of the face.
    slip, spin, dt : vector, float, float
        Velocity of the upper face over the lower one at C, across n, relative spin about n, step.
    limits : tuple
        Coulomb's limit of the force [N], and the lever of torsion about P [m].

    Returns
    -------
    core, fresh : tuple
        As given.
    force, torsion : vector, float
        Of both layers, at C and about it.
    power, turning : float
        Of the force and of the torsion, a step ago and now, together, on the upper body [W].
    """
    before, turn_before, k_before, j_before, place = core
    f_before, t_before, kf_before, jf_before = fresh
    k, j, centre, middle, polar = face
    # what slips, or begins to touch, is all core
    whole, new = k_before <= 0.0, k_before == 0.0
    k_before, j_before = k if new else abs(k_before), j if new else j_before
    kc, jc = (k, j) if whole else (min(k, k_before), min(j, j_before))
    kf, jf = k - kc, j - jc
    # how far the centroid of the core is from C, and may be so that the rest is an area, in radii of gyration
    away = minus(place, centre)
    each = 1.0 / max(polar * j * kc, NOTHING)
    distance = 0.0 if whole else math.sqrt(dot(away, away) * k * kc * each)
    reach = math.sqrt(polar * kf * jf * each)
    rolled = min(max(distance - reach, 0.0), 1.0)
    renewed = min(RENEWED * rolled, 1.0)
    away = scaled((1.0 - renewed) * min(reach / max(distance, NOTHING), 1.0), away)
    at_core = along(slip, spin, cross(n, away))
    power, turning = dot(before, at_core) + dot(f_before, slip), (turn_before + t_before) * spin
    # what opens takes its share along
    each = 1.0 / max(k_before * j_before, NOTHING)
    before, turn_before = scaled(min(kc * j_before * each, 1.0), before), min(jc * k_before * each, 1.0) * turn_before
    each = 1.0 / max(kf_before * jf_before, NOTHING)
    f_before, t_before = scaled(min(kf * jf_before * each, 1.0), f_before), min(jf * kf_before * each, 1.0) * t_before
    before, f_before = along(before, renewed, f_before), scaled(1.0 - renewed, f_before)
    turn_before, t_before = turn_before + renewed * t_before, (1.0 - renewed) * t_before
    kc, jc, kf, jf = kc + renewed * kf, jc + renewed * jf, (1.0 - renewed) * kf, (1.0 - renewed) * jf
    # both springs
    force, f = along(before, -kc * dt, at_core), along(f_before, -kf * dt, slip)
    torsion, t = twisted(turn_before, jc, spin, dt, rolled), twisted(t_before, jf, spin, dt, rolled)
    total = along(force, 1.0, f)
    total = along(total, -dot(total, n), n)
    twist = torsion + t + dot(cross(away, force), n)
    total, twist, beyond = limited(total, twist, k, j, minus(centre, middle), n, limits)
    # where the face slips, all that touches becomes core
    keep = max(1.0 - SLIPPED * beyond, 0.0)
    away, f, t, kf, jf = scaled(keep, away), scaled(keep, f), keep * t, keep * kf, keep * jf
    force = minus(total, f)
    torsion = twist - t - dot(cross(away, force), n)
    kc = k - kf
    core = force, torsion, kc if keep > 0.0 else -kc, j - jf, along(centre, 1.0, away)
    return core, (f, t, kf, jf), total, twist, power + dot(total, slip), turning + twist * spin


@long_law
def dragged(total, twist, face, n, slip, spin, beta, limits):
    """Force and torsion of dashpots parallel to the springs of friction, at C and about it; all of it in sum stays within
    Coulomb's limit. Parameters as of :func:`friction`, ``beta`` is dashpot over stiffness [s]."""
    k, j, centre, middle, _ = face
    force, torsion = along(total, -beta * k, slip), twist - beta * j * spin
    force, torsion, _ = limited(force, torsion, k, j, minus(centre, middle), n, limits)
    return minus(force, total), torsion - twist


@law
def stored(core, fresh):
    """Energy that the two layers hold in shear and in torsion [J]."""
    f, t, k, j, _ = core
    g, s, kf, jf = fresh
    shear = dot(f, f) / max(abs(k), NOTHING) + dot(g, g) / max(kf, NOTHING)
    return 0.5 * shear, 0.5 * (t * t / max(j, NOTHING) + s * s / max(jf, NOTHING))
