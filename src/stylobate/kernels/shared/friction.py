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
    square = max(limits[0] * limits[0], NO_LIMIT)
    other = max(limits[0] * limits[0] * limits[1], NO_LIMIT)
    each = 1.0 / (square * other)
    one, two = each * other, each * square
    twist = dot(cross(arm, force), n)
    moment = torsion + twist
    turning += dot(cross(arm, before), n)
    # shares of both limits a step ago, and now
    u, v = dot(before, before) * one, turning * turning * two
    x, y = dot(force, force) * one, moment * moment * two
    past, now = max(u + v, NOTHING), max(x + y, NOTHING)
    each = 1.0 / (past * now)
    distance = math.sqrt(max((now * now + COUPLING * x * y) * past * each, 1.0))
    u, v = u * now * each, v * now * each
    # the step along the normal
    a, b = one * (1.0 + COUPLING * v * v), two * (1.0 + COUPLING * u * u)
    w = cross(n, arm)
    slip, spin = along(scaled(a, force), b * moment, w), b * moment
    more = (distance - 1.0) * distance * distance
    size = max(k * dot(slip, slip) + j * spin * spin, NOTHING)
    shear = size + more * k * a
    turn = more * b * (j * shear + k * dot(arm, arm) * size)
    whole = size * shear + turn
    each = 1.0 / (shear * whole)
    gone, size = more * k * a * whole * each, more * whole * each
    moment = (moment - twist * gone) * (1.0 - turn * shear * each)
    force = along(scaled(1.0 - gone, force), -size * k * b * moment, w)
    # what is still beyond it: 2/(1 + q) is below 1/√q
    x, y = dot(force, force) * one, moment * moment * two
    past, now = x + y, (x + y) * (x + y) + COUPLING * x * y
    less = 1.0 - max(now - past, 0.0) / max(now + past, NOTHING)
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
    s, core_torsion, kc, jc, place = core
    f, torsion, kf, jf = fresh
    k, j, centre, middle, compact = face
    before = along(s, 1.0, f)
    # the core: beyond the extent of what touches it has opened, and its centroid moves towards C
    away = minus(place, centre)
    away = along(away, -dot(away, n), n)
    far = k / EXTENT * math.sqrt(dot(away, away) * compact)
    lost = max(kc - k, far + 0.5 * (kc - k), 0.0)
    # where nothing is left of it, the fresh layer becomes core; what touches nowhere holds nothing
    new = lost >= kc
    whole = 1.0 if k > 0.0 else 0.0
    rest = k if new else kc - lost
    left = max(k - rest, 0.0)
    kc, far, least = max(kc, NOTHING), max(far, NOTHING), max(left, NO_LAYER * k, NOTHING)
    each = 1.0 / (kc * far * least)
    keep, joins = (whole, whole) if new else (1.0 - lost * far * least * each, 0.0)
    away = scaled(0.0 if new else 1.0 - min(0.5 * lost * kc * least * each, 1.0), away)
    beyond = rest * kc * far * each  # of the fresh layer's centroid from C, over the core's
    s, core_torsion = along(scaled(keep, s), joins, f), keep * core_torsion + joins * torsion
    kc, jc = rest, j if new else keep * jc
    # what the layers resist by where they are, beside their own torsion
    apart = k * beyond * dot(away, away)
    j = max(j, apart)
    most = min(jc, j - apart)
    turns = j - apart - most
    # what opened is taken from them
    keep = 0.0 if new else 1.0
    closed, opened, unwound = jc - most, max(kf - left, 0.0), max(jf - turns, 0.0)
    jc, kf, jf, both = max(jc, NOTHING), max(kf, NOTHING), max(jf, NOTHING), max(k, NOTHING) * max(j, NOTHING)
    each = 1.0 / (jc * kf * jf * both)
    core_torsion *= 1.0 - closed * kf * jf * both * each
    f = scaled(keep * (1.0 - opened * jc * jf * both * each), f)
    torsion *= keep * (1.0 - unwound * jc * kf * both * each)
    both = jc * kf * jf * each
    jc, kf, jf = most, left, turns
    # both springs, in sum that of all that touches
    w = cross(n, away)
    turning = core_torsion + torsion + dot(along(s, -beyond, f), w)
    total = along(along(s, 1.0, f), -k * dt, slip)
    s = along(s, -kc * dt, along(slip, spin, w))
    torsion -= jf * dt * spin
    f = minus(total, s)
    total = along(total, -dot(total, n), n)
    drawn, wound = total, turning - j * dt * spin
    total, twist, over = limited(drawn, wound, before, turning, k, j, minus(centre, middle), n, limits)
    # both slip alike; where the face slips, all that touches becomes core
    turned = (wound - twist) * k * both
    f = along(f, -kf, along(scaled(j * both, minus(drawn, total)), -beyond * turned, w))
    torsion -= jf * turned
    # what is rounded: a layer of nothing holds nothing
    f = scaled(1.0 if kf > NO_LAYER * k else 0.0, f)
    torsion = torsion if jf > NO_LAYER * j else 0.0
    keep = max(1.0 - SLIPPED * over, 0.0)
    f, torsion, kf, jf = scaled(keep, f), keep * torsion, keep * kf, keep * jf
    s = minus(total, f)
    jc += (1.0 - keep) * (j - jf - jc)
    core_torsion = twist - torsion - dot(along(scaled(keep, s), -beyond, f), w)
    core_torsion = core_torsion if jc > NO_LAYER * j else 0.0  # what is rounded
    return (s, core_torsion, k - kf, jc, along(centre, keep, away)), (f, torsion, kf, jf), total, twist


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
    f, t, k, j = core
    g, s, kf, jf = fresh
    shear = dot(f, f) / max(k, NOTHING) + dot(g, g) / max(kf, NOTHING)
    return 0.5 * shear, 0.5 * (t * t / max(j, NOTHING) + s * s / max(jf, NOTHING))
