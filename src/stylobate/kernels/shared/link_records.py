"""Records of links between bodies over lanes, in the plane and in space.

Legend of ``bond[m]``, what link m is in all lanes::

    line ten both  1: straight between two points, else across a joint; 1: holds against opening; 1: holds along its axis as
                   in shear, in both senses (a clamp)
    ks y           stiffness in shear [N/m]; slip beyond the slack at which it yields [m]
    cr br          1: its capacity crushes the stone, so that its hole grows; 1: it snaps there
    deep reach     lift up to which it is in its hole; how far beside its slack it finds it again [m]
    us c           slip at which it is lost [m]; dashpot [N s/m]
    ya cra bra     of its axial law, as y, cr and br of its shear (a clamp)
    near           1: within the next chunk of steps it may hold something in some lane

Legend of ``link[m]``, what it is in each lane::

    ka fa ua       stiffness and capacity in tension [N/m], [N]; elongation at which it is lost [m]
    ax ay az       its place on the lower body, in that body's axes [m];  bx by bz  on the upper one
    tc ts          in the plane: direction in which it slips, in the axes of the lower body; it lengthens to the left of it
    sx sy          where its upper place stood at the start, along the slip [m]
    px py gap      where it is free of force, along the slip, and its slack there [m]
    back           slack of a clamp along its axis [m]
    h l0           lift, or length, at the start and where it is free of tension [m]; with ``both`` l0 counts from h
    on out         1 as long as it is whole; 1 while it is out of its hole
    fx fy ft       force against slip, along the slip, and tension [N]
    dx dy          dashpot force [N];  dt  step [s]
    lost drag      what has become heat in it, and in its dashpot [J]
    slip long      slip of its place since the start, and its lift or the elongation of a line [m]
    peak pull      largest force in shear and in tension [N];  far most  largest slip, and lift or elongation [m]
    over           by how much it may leave its slack within the next chunk of steps [m]
    whole          largest moment that it can set, whole, against overturning about a joint that it crosses [N m]
    when           step after which it was broken; −1

The bodies of link m are those of its contact, behind those of the joints. ``hold[j].moment`` is what whole links hold about
joint j of a column [N m]; no such rows without links.
"""

import numpy as np

#: Values that all lanes share, whole numbers and others, and what each lane has of its own.
NUMBERS = "line ten both near"
SHARED = "ks y cr br deep reach us c ya cra bra"
OWN = (
    "ka fa ua ax ay az bx by bz tc ts sx sy px py gap back h l0 on out fx fy ft dx dy dt lost drag slip long peak pull far "
    "most over whole"
)

BOND_TYPE = np.dtype([(name, np.int64) for name in NUMBERS.split()] + [(name, np.float64) for name in SHARED.split()])


#: Type of the records of links where there are none: nothing of them is compiled.
NO_LINK = np.dtype([("none", np.float64, (1,))])


def link_types(lanes: int) -> tuple[np.dtype, np.dtype]:
    """Record types (link, hold) for so many lanes."""
    link = [*((name, np.float64, (lanes,)) for name in OWN.split()), ("when", np.int64, (lanes,))]
    return np.dtype(link), np.dtype([("moment", np.float64, (lanes,))])
