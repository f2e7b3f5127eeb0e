"""Friction of a face: a shear force and a torsion that remember, in two layers, within one limit surface.

Shear is carried by what touches, evenly, pressed much or little: a layer is a spring of stiffness k = k_s A in shear at
the centroid of its area A, and j in torsion about that centroid. Together they are the spring of all that touches, k and
j = κ k_s J at its centroid C, J the polar moment of the area about it. Such springs have a potential as long as their areas
are the same: the tangent stiffness is symmetric, and no closed loop of small motions does work. Only Coulomb's limit knows
the pressure, and its middle P.

What touches changes. Two layers remember: the *core* has touched all the time since the face last slipped; the *fresh* layer
is what has closed since, and came without force. The core keeps its place on the face below: a vibration that opens and
closes an edge moves C to and fro, and neither takes from the core nor moves its force, so that a lasting push neither creeps
nor flutters. What opens is taken from the fresh layer, and from the core what lies beyond the extent of what touches. It
takes its share of the force with it: stored energy never rises. At the limit the whole face slips, and all of it is core.
Under a drum that rolls the core is left behind, and what has closed meanwhile takes its place: what lasts across the way of
a toe is borne by turning on it, as of strips that enter free of shear (theory of rolling contact).
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

#: A layer of less than this share of what touches is none: areas are no more exact.
NO_LAYER = 1e-12

#: Extent of what touches over its polar radius of gyration; of a strip √12. A toe that wobbles twists with it by four fifths
#: of what it does node by node.
EXTENT = 3.0

#: The fresh layer becomes core where the face slips: all of it by a thousandth of the limit.
SLIPPED = 1e3


@long_law
def inverses(a, b, c, d, e):
    """Reciprocals of five positive numbers by one division."""
    ab, de = a * b, d * e
    abc, cde = ab * c, c * de
    all_of_them = 1.0 / (abc * de)
    return (
        b * cde * all_of_them,
        a * cde * all_of_them,
        ab * de * all_of_them,
        abc * e * all_of_them,
        abc * d * all_of_them,
    )


@long_law
def limited(force, torsion, before, turning, k, j, arm, n, limits):
    """Shear force at the centroid and torsion about it, brought back to the limit surface if they are beyond it.

    The surface is X + Y + 0.57 X Y / (X + Y) = 1, with X and Y the squares of the shares of the two limits: pure sliding and
    pure spinning are exact. The face slips along its normal (associated flow), where the forces are in the end:
    F' = F − λ K H F' with the stiffness K about P, in closed form, takes stored energy away however large the step. H hangs
    on how the shares of both limits stand to each other, which a face that slips on hardly changes in a step. Quotients
    share their divisions, and are exactly 1 or 0 where nothing slips.

    ``limits`` as of :func:`friction`; that of torsion is about the middle of pressure P, from which ``arm`` goes to the
    centroid. ``before`` and ``turning`` are force and torsion a step ago. The third result is how far they were beyond the
    surface, over its distance.
    """
    force_limit = max(limits[0] * limits[0], NO_LIMIT)
    moment_limit = max(limits[0] * limits[0] * limits[1], NO_LIMIT)
    inverse = 1.0 / (force_limit * moment_limit)
    per_force, per_moment = inverse * moment_limit, inverse * force_limit
    # moments about P
    of_force = dot(cross(arm, force), n)
    moment = torsion + of_force
    moment_before = turning + dot(cross(arm, before), n)
    # X and Y a step ago, and now
    x_before, y_before = dot(before, before) * per_force, moment_before * moment_before * per_moment
    x, y = dot(force, force) * per_force, moment * moment * per_moment
    sum_before, sum_now = max(x_before + y_before, NOTHING), max(x + y, NOTHING)
    inverse = 1.0 / (sum_before * sum_now)
    distance = math.sqrt(max((sum_now * sum_now + COUPLING * x * y) * sum_before * inverse, 1.0))
    # H = diag(a, a, b), and the slip and the spin along H F
    x_share, y_share = x_before * sum_now * inverse, y_before * sum_now * inverse
    a, b = per_force * (1.0 + COUPLING * y_share * y_share), per_moment * (1.0 + COUPLING * x_share * x_share)
    w = cross(n, arm)
    slip, spin = along(scaled(a, force), b * moment, w), b * moment
    # λ = flow/size, and 1 + λ k a and 1 + λ b (j + k arm²/(1 + λ k a)) by common denominators
    size = max(k * dot(slip, slip) + j * spin * spin, NOTHING)
    flow = (distance - 1.0) * distance * distance
    shear = size + flow * k * a
    turn = flow * b * (j * shear + k * dot(arm, arm) * size)
    both = size * shear + turn
    inverse = 1.0 / (shear * both)
    lost, per_size = flow * k * a * both * inverse, flow * both * inverse
    moment = (moment - of_force * lost) * (1.0 - turn * shear * inverse)
    force = along(scaled(1.0 - lost, force), -per_size * k * b * moment, w)
    # what is still beyond it: 2/(1 + q) is below 1/√q
    x, y = dot(force, force) * per_force, moment * moment * per_moment
    total = x + y
    surface = total * total + COUPLING * x * y
    less = 1.0 - max(surface - total, 0.0) / max(surface + total, NOTHING)
    force = scaled(less, force)
    return force, less * moment - dot(cross(arm, force), n), distance - 1.0


@long_law
def friction(core, fresh, face, n, slip, spin, dt, limits):  # Eq. (E6)
    """Friction of a face at t_n, from its layers a step ago.

    Parameters
    ----------
    core, fresh : tuple
        Layers: shear force on the upper body [N], torsion [N m], k [N/m], j [N m]; of the core its place as well.
    face : tuple
        Of what touches now: k, j, centroid C, middle of pressure P, and area over polar moment about C [1/m²].
    n : vector
        Normal of the face.
    slip, spin, dt : vector, float, float
        Velocity of the upper face over the lower one at C, across n, relative spin about n, step.
    limits : tuple
        Coulomb's limit of the force [N], and the square of the lever of torsion about P [m²].

    Returns
    -------
    core, fresh : tuple
        As given, now.
    force, torsion : vector, float
        Of both layers, at C and about it.
    """
    core_force, core_torsion, k_core, j_core, place = core
    fresh_force, fresh_torsion, k_fresh, j_fresh = fresh
    k, j, centre, middle, compact = face
    before = along(core_force, 1.0, fresh_force)
    # the core: beyond the extent of what touches it has opened, and its centroid moves towards C
    away = minus(place, centre)
    away = along(away, -dot(away, n), n)
    far = k / EXTENT * math.sqrt(dot(away, away) * compact)
    opened = max(k_core - k, far + 0.5 * (k_core - k), 0.0)
    gone = opened >= k_core  # all that touches becomes core, with the share of both layers that still touches
    core_stays = k if gone else k_core - opened
    closed_since = max(k - core_stays, 0.0)
    floor = max(closed_since, NO_LAYER * k, NOTHING)
    per_core, per_far, per_closed, per_k, per_j = inverses(
        max(k_core, NOTHING), max(far, NOTHING), floor, max(k_core + k_fresh, NOTHING), max(j_core + j_fresh, NOTHING)
    )
    keep = min(k * per_k, 1.0) if gone else 1.0 - opened * per_core
    keep_torsion = min(j * per_j, 1.0) if gone else keep
    away = scaled(0.0 if gone else 1.0 - min(0.5 * opened * per_far, 1.0), away)
    lever = core_stays * per_closed  # of the fresh layer's centroid from C, over that of the core, the other way
    core_force = along(scaled(keep, core_force), keep if gone else 0.0, fresh_force)
    core_torsion = keep_torsion * (core_torsion + (fresh_torsion if gone else 0.0))
    j_core = j if gone else keep * j_core
    # what the layers resist by where they are, beside their own torsion
    apart = k * lever * dot(away, away)
    j = max(j, apart)
    j_core_now = min(j_core, j - apart)
    j_fresh_now = j - apart - j_core_now
    # what opened is taken from them
    keep = 0.0 if gone else 1.0
    per_jc, per_fresh, per_j, per_k, per_all = inverses(
        max(j_core, NOTHING), max(k_fresh, NOTHING), max(j_fresh, NOTHING), max(k, NOTHING), max(j, NOTHING)
    )
    core_torsion *= 1.0 - (j_core - j_core_now) * per_jc
    fresh_force = scaled(keep * (1.0 - max(k_fresh - closed_since, 0.0) * per_fresh), fresh_force)
    fresh_torsion *= keep * (1.0 - max(j_fresh - j_fresh_now, 0.0) * per_j)
    k_core, j_core, k_fresh, j_fresh = core_stays, j_core_now, closed_since, j_fresh_now
    # both springs, in sum that of all that touches
    w = cross(n, away)
    turning = core_torsion + fresh_torsion + dot(along(core_force, -lever, fresh_force), w)
    total = along(along(core_force, 1.0, fresh_force), -k * dt, slip)
    core_force = along(core_force, -k_core * dt, along(slip, spin, w))
    fresh_torsion -= j_fresh * dt * spin
    fresh_force = minus(total, core_force)
    total = along(total, -dot(total, n), n)
    drawn, wound = total, turning - j * dt * spin
    total, twist, over = limited(drawn, wound, before, turning, k, j, minus(centre, middle), n, limits)
    # both slip alike; a layer of nothing, which is what is rounded, holds nothing
    spun = (wound - twist) * per_all
    fresh_force = along(fresh_force, -k_fresh, along(scaled(per_k, minus(drawn, total)), -lever * spun, w))
    fresh_force = scaled(1.0 if k_fresh > NO_LAYER * k else 0.0, fresh_force)
    fresh_torsion = fresh_torsion - j_fresh * spun if j_fresh > NO_LAYER * j else 0.0
    # where the face slips, all that touches becomes core: its centroid moves to C, and that of the fresh layer away from it
    keep = max(1.0 - SLIPPED * over, 0.0)
    fresh_force, fresh_torsion = scaled(keep, fresh_force), keep * fresh_torsion
    k_fresh, j_fresh = keep * k_fresh, keep * j_fresh
    core_force = minus(total, fresh_force)
    j_core += (1.0 - keep) * (j - j_fresh - j_core)
    core_torsion = twist - fresh_torsion - dot(along(scaled(keep, core_force), keep - 1.0 - lever, fresh_force), w)
    core_torsion = core_torsion if j_core > NO_LAYER * j else 0.0  # what is rounded
    core = core_force, core_torsion, k - k_fresh, j_core, along(centre, keep, away)
    return core, (fresh_force, fresh_torsion, k_fresh, j_fresh), total, twist


@long_law
def dragged(total, twist, face, n, slip, spin, beta, limits):
    """Force and torsion of dashpots parallel to the springs of friction, at C and about it; all of it in sum stays within
    Coulomb's limit. Parameters as of :func:`friction`, ``beta`` is dashpot over stiffness [s]."""
    k, j, centre, middle, _ = face
    force, torsion = along(total, -beta * k, slip), twist - beta * j * spin
    force, torsion, _ = limited(force, torsion, total, twist, k, j, minus(centre, middle), n, limits)
    return minus(force, total), torsion - twist


@law
def stored(core, fresh):
    """Energy that the two layers, force, torsion, k and j of each, hold in shear and in torsion [J]."""
    core_force, core_torsion, k_core, j_core = core
    fresh_force, fresh_torsion, k_fresh, j_fresh = fresh
    shear = dot(core_force, core_force) / max(k_core, NOTHING) + dot(fresh_force, fresh_force) / max(k_fresh, NOTHING)
    torsion = core_torsion * core_torsion / max(j_core, NOTHING) + fresh_torsion * fresh_torsion / max(j_fresh, NOTHING)
    return 0.5 * shear, 0.5 * torsion
