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


@law
def beyond(shear2, torsion2, force, moment):
    """How far a shear force and a torsion moment (squares given) lie beyond the limit surface; 1 inside it.

    X + Y + 0.57 X Y / (X + Y) with X and Y the squares of the shares of the two limits: pure sliding and pure spinning
    are exact.
    """
    x = shear2 / max(force * force, NOTHING)
    y = torsion2 / max(moment * moment, NOTHING)
    both = x + y
    return math.sqrt(max(both + COUPLING * x * y / max(both, NOTHING), 1.0))
