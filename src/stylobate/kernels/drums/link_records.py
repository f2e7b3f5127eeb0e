"""Records of links between drums over lanes, in the plane and in space.

Legend of ``lane[1 + m]``, link m (row 0 is the lane itself; one number for all lanes where marked †)::

    mlow mup †     bodies that it links: 0 is the base
    mline mten †   1: straight between two points, else across the joint under body mup; 1: holds against opening
    mks my †       stiffness in shear [N/m]; slip beyond the slack at which it yields [m]
    mcr mbr †      1: its capacity crushes the stone, so that its hole grows; 1: it snaps there
    mdeep mreach † lift up to which it is in its hole; how far beside its slack it finds it again [m]
    mus mc †       slip at which it is lost [m]; dashpot [N s/m]
    mnear †        1: within the next chunk of steps it may hold something in some lane
    mka mfa mua    stiffness and capacity in tension [N/m], [N]; elongation at which it is lost [m]
    max may maz    its place on the lower body, in that body's axes [m];  mbx mby mbz  on the upper one
    msx msy        where its upper place stood at the start, along the joint [m]
    mpx mpy mgap   where it is free of force, along the joint, and its slack there [m]
    mh ml0         lift, or length, at the start and where it is free of tension [m]
    mon mout       1 as long as it is whole; 1 while it is out of its hole
    mfx mfy mft    force against slip, along the joint, and tension [N]
    mdx mdy        dashpot force [N];  mdt  step [s]
    mlost mdrag    what has become heat in it, and in its dashpot [J]
    mslip mlong    slip of the joint at its place since the start, and its lift or the elongation of a line [m]
    mpeak mpull    largest force in shear and in tension [N];  mfar mmost  largest slip, and lift or elongation [m]
    mover          by how much it may leave its slack within the next chunk of steps [m]
    mwhen          step after which it was found broken; −1
    mfill          nothing
    mhold          largest moment that it can set, whole, against overturning about a joint that it crosses [N m]

Of ``watch``: hold, the same of all whole links by joint, one joint after the other [N m]; 0 without links. The records are
those of columns without links too, so that what both share is compiled once.
"""

import numpy as np

from ..run_codes import LANES

#: Numbers in a line of the cache.
LINE = 8

#: Most joints of a column.
MOST_JOINTS = 200

#: What all lanes share, whole numbers and others, and what each lane has of its own.
NUMBERS = "mlow mup mline mten mnear"
SHARED = "mks my mcr mbr mdeep mreach mus mc"
OWN = (
    "mka mfa mua max may maz mbx mby mbz msx msy mpx mpy mgap mh ml0 mon mout mfx mfy mft mdx mdy mdt mlost mdrag mslip "
    "mlong mpeak mpull mfar mmost mover mhold"
)


def link_fields() -> list[tuple]:
    """Fields that the records of lanes have besides: their rows behind the first, where there are some, are links.

    Filled up to whole lines of the cache behind what lanes share, so that what each lane has of its own begins on one in
    every row: a vector that lies across two lines costs two accesses.
    """
    shared = [*((name, np.int64) for name in NUMBERS.split()), *((name, np.float64) for name in SHARED.split())]
    return [
        *((name, np.float64, (LANES,)) for name in OWN.split()),
        ("mwhen", np.int64, (LANES,)),
        *shared,
        ("mfill", np.float64, (-len(shared) % LINE,)),
    ]


def hold_field() -> list[tuple]:
    """Field that the records of what is watched have besides."""
    return [("hold", np.float64, (MOST_JOINTS * LANES,))]
