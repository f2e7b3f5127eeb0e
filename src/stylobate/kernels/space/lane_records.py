"""Records of assemblies in space in lanes, as long as nothing of them comes loose: every field one value per lane.

Legend; names not listed are those of ``records.py``, numbers of bodies and counts are the same in all lanes::

    body[i]    o[12]          place and axes at the start;  turned  how far its axes have turned since, at most [-]
    joint[j]   lower upper    its bodies;  level  1: the lower face is the ground, without ends
    corner[k]  x y z          corners of all faces in their planes (z is 0), one face after another [m]
    spot[k]    x y z          corners of the upper face of a joint, seen from the lower one [m]
    between[k] lower upper    two bodies that a bed would have to hold, and the gap between them at the start, gap [m]
    lane       dt last beta work shear visc g[3] p[3]  as in ``now``;  loose  1: joints do not tell all that happens any more
    work       what a joint shares within one evaluation:
               i j z          axes of the lower face in space;  ml  its middle from the lower centroid
               n p q c        normal, axes and middle of the upper face as seen from the lower one
               v w            β times velocity and angular velocity of the upper face as seen there
               m lift         depth along the lower edge is (x − c) · m − lift
               hx hy          horizontal direction in which the upper face rises least, sine of its tilt
               a b shared     shares of an edge between which it is over the other face, and that the other's edge has in it
               disc[12]       of a round face: where it is, radius as seen from above, depth in its middle, and how the depth
                              changes along its rim, see ``edges.py``
               arc[9]         sums over the ends of its arcs
               sums[19]       see ``boundary.py``;  force moment en  of the elastic pressure, where there is damping
    feed ground watch         as in ``dem3d/records.py``
"""

import numpy as np

from ..dem3d.records import fields
from .records import OF_SUMS

#: Rows of ``disc`` and ``arc``.
OF_DISC, OF_ARC = 12, 9


def types() -> dict[str, np.dtype]:
    """Record types by name."""

    def counts(names: str) -> list[tuple]:
        """Numbers of all lanes, filled up to a line of the cache: rows of lanes begin where one begins."""
        field_names = names.split()
        return [(name, np.uint64) for name in field_names] + [("filling", np.uint64, (8 - len(field_names),))]

    axes = " ".join(f"{axis}{c}" for axis in "ijk" for c in "xyz")
    return {
        "body": np.dtype(
            fields(f"x y z {axes} vx vy vz lx ly lz wx wy wz m im ia ic ib r turned")
            + fields("f mo", 3)
            + fields("o", 12)
            + counts("fixed")
        ),
        "joint": np.dtype(
            counts("lower upper level first_l many_l first_u many_u")
            + fields("ml il jl mu iu ju f d gf gm n ra rb s fs at", 3)
            + fields("rl ru kn ks tan co width from_c apart_c apart t dt kc jc en st ft kf jf")
        ),
        "corner": np.dtype(fields("x y z")),
        "between": np.dtype(counts("lower upper") + fields("gap")),
        "lane": np.dtype(fields("dt last beta work shear visc") + fields("g p", 3) + fields("loose", kind=np.int64)),
        "work": np.dtype(
            fields("i j z ml n p q c v w m force moment", 3)
            + fields("lift hx hy sine a b shared en")
            + fields("disc", OF_DISC)
            + fields("arc", OF_ARC)
            + fields("sums", OF_SUMS)
        ),
        "ground": np.dtype(fields("a", 3)),
        "feed": np.dtype(fields("x y z last step end", kind=np.int64) + fields("ratio factor") + fields("r", 9)),
        "watch": np.dtype(fields("status follow when", kind=np.int64)),
    }
