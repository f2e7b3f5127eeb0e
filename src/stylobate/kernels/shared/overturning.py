"""Overturning of a part of a stack: when it is lost for good, and what energy lifts it over its edge.

Legend: ``stand[i]`` holds of every joint at least ``weight`` above it [N], ``moment``, the largest that it can carry [N m],
``over``, the height of the centroid above over it [m], and ``toe``, what it gives with its load on its edge [J].
"""

import math

from ..jit import kernel, law


@law
def going_and_lost(out, outward, turning, holding):
    """Whether a part whose centroid is ``out`` beyond its edge moves outward, and whether it is lost for good.

    It is once the moment of its weight about the edge exceeds what could ever be set against it.  # Eqs. (D6), (E9)
    """
    going = (out > 0.0) & (outward > 0.0)
    return going, going & (turning > holding)


@kernel
def given_by_toes(stand, j, half, height):
    """Energy of all joints, at most, while the part above joint j stands on an edge ``half`` from under its centroid [J].

    A joint gives more than in proportion to the square of the moment that it carries: with the moment's share of the
    largest one squared, the toe's energy bounds it.
    """
    given = 0.0
    for i in range(stand.shape[0]):
        d = stand[i]
        carried = min(d.moment, stand[j].moment)
        if i == j:
            carried = d.moment
        elif i > j:  # above j all lean alike
            carried = min(d.moment, d.weight * d.over * half / height)
        given += d.toe * (carried / d.moment) ** 2
    return given


@kernel
def barrier(stand, j, half, height, loose, weight):
    """Energy that lifts the part above joint j over an edge ``half`` beside and ``height`` under its centroid.  # Eq. (V1)

    Where a joint above is so slippery, ``loose`` its tan φ, that it slides first, that of sliding and lifting together.
    """
    radius = math.hypot(half, height)
    slides = loose < half / radius
    slip = min(loose, 1.0)  # none slides beyond that; the root is real
    rise = slip * half - height * (1.0 - math.sqrt(1.0 - slip * slip)) if slides else radius - height
    return weight * rise - given_by_toes(stand, j, half, height)
