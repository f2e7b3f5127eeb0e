"""Friction of a face: one shear force and one torsion moment, with a common limit surface, passive."""

import math

from ..jit import law

#: Coupling of the limit surface: with it the surface of a disc under even pressure is met to 1 %.
COUPLING = 0.57

#: Keeps quotients of nothing by nothing at nothing, and others far from overflowing.
NOTHING = 1e-30


@law
def kept(now, before):
    """Share of a spring's force that stays when its stiffness changes.

    Parts that open take their share of the shear with them, parts that close come with none: the stored energy never
    rises.
    """
    return min(now / max(before, NOTHING), 1.0)


#: Squares of limits below this are none [N²], [N² m²].
NO_LIMIT = 1e-12


@law
def beyond(x, y):
    """Distance of a shear force and a torsion moment from the origin, over that of the limit surface; 1 on it.

    √(X + Y + 0.57 X Y / (X + Y)) with X and Y the squares of their shares of the two limits: pure sliding and pure
    spinning are exact.
    """
    both = x + y
    return math.sqrt(max(both + COUPLING * x * y / max(both, NOTHING), 1.0))


@law
def toward(x, y, one, two, a, b, excess):
    """Shares of shear and torsion after a return of size ``excess`` along the surface's normal at (one² X, two² Y)."""
    u, v = x * one * one, y * two * two
    square = (u + v) * (u + v)
    p, q = a * (square + COUPLING * v * v), b * (square + COUPLING * u * u)
    mean = max(p * x + q * y, NOTHING)
    more = excess * (x + y)
    p, q = mean + more * p, mean + more * q
    each = mean / (p * q)
    return each * q, each * p


@law
def returned(shear2, torsion2, force, moment, kf, kt):
    """Shares of a shear force and a torsion moment (squares given) that are left on the limit surface; both 1 inside it.

    What is taken off stands to the springs' stiffness as the normal of the surface where it is reached: slip and spin then
    stand to each other as for a disc under even pressure (associated flow). The normal is found in two rounds.
    """
    each, other = 1.0 / max(force * force, NO_LIMIT), 1.0 / max(moment * moment, NO_LIMIT)
    x, y, a, b = shear2 * each, torsion2 * other, kf * each, kt * other
    excess = beyond(x, y) - 1.0
    one, two = toward(x, y, 1.0, 1.0, a, b, excess)
    one, two = toward(x, y, one, two, a, b, excess)
    less = 1.0 / beyond(x * one * one, y * two * two)
    return one * less, two * less
