"""Common parts of the engines in the plane and in space: the order of their records, and contacts as a list.

A contact of any kind leaves what it does in a record of loads; a body gathers its loads in the order of its own list, so
that sums do not depend on what is computed at the same time. Indices are unsigned: the compiler then adds no wrap-around.

Legend::

    pair[k]    lower upper    bodies of contact k: joints first, then links, then what a search has found
    span[i]    under above    the first contacts in which body i is the upper and the lower one; the last, idle one for none
               first count    where in ``touch`` its other contacts are;  fixed  1: it moves with the ground
    touch[t]   contact upper  a contact, and whether the body is the upper one there (1) or the lower one (0)

Legend of links between bodies: of ``bond[m]``, what link m is in all lanes::

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

from ..jit import kernel


@kernel
def list_contacts(pair, count, idle, span, touch):
    """List the first ``count`` contacts body by body, each body's by their numbers; ``idle`` is one that does nothing."""
    for i in range(span.shape[0]):
        span[i].under = idle
        span[i].above = idle
        span[i].count = 0
    for k in range(count):
        for side in range(2):
            s = span[pair[k].upper if side == 1 else pair[k].lower]
            if side == 1 and s.under == idle:
                s.under = k
            elif side == 0 and s.above == idle:
                s.above = k
            else:
                s.count += np.uint64(1)
    first = np.uint64(0)
    for i in range(span.shape[0]):
        span[i].first = first
        first += span[i].count
        span[i].count = 0
    for k in range(count):
        for side in range(2):
            s = span[pair[k].upper if side == 1 else pair[k].lower]
            if k != (s.under if side == 1 else s.above):
                t = s.first + s.count
                touch[t].contact = k
                touch[t].upper = side
                s.count += np.uint64(1)


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


#: Names of the records of an engine, in the order in which they are its state; the last is a number: how many drums the
#: column has that is looked at, bodies 1 … stack on joints 0 … stack − 1 (0: there is none).
STATE = (
    "body",
    "joint",
    "load",
    "link",
    "bond",
    "lane",
    "ground",
    "feed",
    "watch",
    "hold",
    "pair",
    "span",
    "touch",
    "stack",
)

#: Their places in it.
BODY, JOINT, LOAD, LINK, BOND, LANE, GROUND, FEED, WATCH, HOLD, PAIR, SPAN, TOUCH, STACK = range(len(STATE))


PAIR_TYPE = np.dtype([("lower", np.uint64), ("upper", np.uint64)])
SPAN_TYPE = np.dtype([(name, np.uint64) for name in ("under", "above", "first", "count")] + [("fixed", np.int64)])
TOUCH_TYPE = np.dtype([("contact", np.uint64), ("upper", np.int64)])


def rows(array, name: str) -> int:
    """Rows of a field of an array of records as the compiler knows it, 0 where it has no such field."""
    field = array.dtype.fields.get(name)
    return 0 if field is None else 1 if len(field.type.shape) == 1 else field.type.shape[0]
