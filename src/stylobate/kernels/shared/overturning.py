"""Overturning of a part of a stack: when it is lost for good, and what energy lifts it over its edge.

Legend: a row ``d`` of what stands holds of every joint at least its half width ``edge`` [m] and, with the part above on that
edge, what the joint gives itself, ``toe``, and what all others do, ``others`` [J]: see ``models/shared/toes.py``.
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
def barrier(d, half, height, loose, weight):
    """Energy that lifts the part above a joint over an edge ``half`` beside and ``height`` under its centroid.  # Eq. (V1)

    Where a joint above is so slippery, ``loose`` its tan φ, that it slides first, that of sliding and lifting together. What
    the other joints give rises at least with the square of the moment on them, and that with ``half``.
    """
    radius = math.hypot(half, height)
    slides = loose < half / radius
    slip = min(loose, 1.0)  # none slides beyond that; the root is real
    rise = slip * half - height * (1.0 - math.sqrt(1.0 - slip * slip)) if slides else radius - height
    return weight * rise - d.toe - d.others * (half / d.edge) ** 2
