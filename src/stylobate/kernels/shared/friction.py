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


@law
def limit_distance(x, y):
    """Distance of a shear force and a torsion from the origin, over that of the limit surface; 1 on it and inside.

    √(X + Y + 0.57 X Y / (X + Y)) with X and Y the squares of their shares of the two limits: pure sliding and pure
    spinning are exact.
    """
    both = x + y
    return math.sqrt(max(both + COUPLING * x * y / max(both, NOTHING), 1.0))


@long_law
def slipped(force, moment, before, turning, k, j, arm, n, surface):
    """A shear force and the moment about P after a step towards the limit surface, and how far they were beyond it.

    ``surface``: one over the squares of both limits; ``before``, ``turning``: force and moment a step ago. The face slips
    along the surface's normal (associated flow), where the forces are in the end: F' = F − λ K H F' with the stiffness K
    about P, in closed form, takes stored energy away however large the step. H hangs on how the shares of both limits stand
    to each other, which a face that slips on hardly changes in a step.
    """
    a, b = surface
    x, y = dot(before, before) * a, turning * turning * b
    each = 1.0 / max(x + y, NOTHING)
    u, v = x * each, y * each
    distance = limit_distance(dot(force, force) * a, moment * moment * b)
    a, b = a * (1.0 + COUPLING * v * v), b * (1.0 + COUPLING * u * u)
    w = cross(n, arm)
    slip, spin = along(scaled(a, force), b * moment, w), b * moment
    size = (distance - 1.0) * distance * distance / max(k * dot(slip, slip) + j * spin * spin, NOTHING)
    each = 1.0 / (1.0 + size * k * a)
    twist = dot(cross(arm, force), n)
    moment = (moment - twist * (1.0 - each)) / (1.0 + size * b * (j + k * dot(arm, arm) * each))
    return scaled(each, along(force, -size * k * b * moment, w)), moment, distance - 1.0


@long_law
def limited(force, torsion, before, turning, k, j, arm, n, limits):
    """Shear force at the centroid and torsion about it, brought back to the limit surface if they are beyond it.

    ``limits`` as of :func:`friction`; that of torsion is about the middle of pressure P, from which ``arm`` goes to the
    centroid. ``before`` and ``turning`` are force and torsion a step ago. Also how far they were beyond it, over its
    distance.
    """
    square = max(limits[0] * limits[0], NO_LIMIT)
    other = max(limits[0] * limits[0] * limits[1] * limits[1], NO_LIMIT)
    each = 1.0 / (square * other)
    surface = each * other, each * square
    moment = torsion + dot(cross(arm, force), n)
    turning += dot(cross(arm, before), n)
    force, moment, beyond = slipped(force, moment, before, turning, k, j, arm, n, surface)
    less = 1.0 / limit_distance(dot(force, force) * surface[0], moment * moment * surface[1])
    force = scaled(less, force)
    return force, less * moment - dot(cross(arm, force), n), beyond


@long_law
def friction(core, fresh, face, n, slip, spin, dt, limits):  # Eq. (E6)
    """Friction of a face at t_n, from its layers a step ago.

    Parameters
    ----------
    core, fresh : tuple
        Layers: shear force on the upper body [N], torsion [N m], k [N/m], j [N m]; of the core its place as well.
    face : tuple
        Of what touches now: k, j, centroid C, middle of pressure P, square of the polar radius of gyration about C [m²].
    n : vector
        Normal of the face.
    slip, spin, dt : vector, float, float
        Velocity of the upper face over the lower one at C, across n, relative spin about n, step.
    limits : tuple
        Coulomb's limit of the force [N], and the lever of torsion about P [m].

    Returns
    -------
    core, fresh : tuple
        As given, now.
    force, torsion : vector, float
        Of both layers, at C and about it.
    """
    s, core_torsion, kc, jc, place = core
    f, torsion, kf, jf = fresh
    k, j, centre, middle, square = face
    before = along(s, 1.0, f)
    # the core: beyond the extent of what touches it has opened, and its centroid moves towards C
    away = minus(place, centre)
    away = along(away, -dot(away, n), n)
    far = k * math.sqrt(dot(away, away) / max(EXTENT * EXTENT * square, NOTHING))
    lost = max(kc - k, far + 0.5 * (kc - k), 0.0)
    each = 1.0 / (max(kc, NOTHING) * max(far, NOTHING))
    # where nothing is left of it, the fresh layer becomes core; what touches nowhere holds nothing
    new = lost >= kc
    whole = 1.0 if k > 0.0 else 0.0
    keep, joins, rest = (whole, whole, 0.0) if new else (1.0 - lost * max(far, NOTHING) * each, 0.0, 1.0)
    away = scaled(0.0 if new else 1.0 - min(0.5 * lost * kc * each, 1.0), away)
    s, core_torsion = along(scaled(keep, s), joins, f), keep * core_torsion + joins * torsion
    kc, jc = (k, j) if new else (keep * kc, keep * jc)
    # the fresh layer, its centroid beyond C; what the layers resist by where they are, beside their own torsion
    left = max(k - kc, 0.0)
    beyond = kc / max(left, NO_LAYER * k, NOTHING)
    apart = k * beyond * dot(away, away)
    j = max(j, apart)
    most = min(jc, j - apart)
    turns = j - apart - most
    # what opened is taken from it
    jc, kf, jf = max(jc, NOTHING), max(kf, NOTHING), max(jf, NOTHING)
    each = 1.0 / (jc * kf * jf)
    core_torsion *= most * kf * jf * each
    f = scaled(rest * min(left * jc * jf * each, 1.0), f)
    torsion *= rest * min(turns * jc * kf * each, 1.0)
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
    each = 1.0 / (max(k, NOTHING) * max(j, NOTHING))
    turned = (wound - twist) * k * each
    f = along(f, -kf, along(scaled(j * each, minus(drawn, total)), -beyond * turned, w))
    torsion -= jf * turned
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
