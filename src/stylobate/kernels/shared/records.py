"""Common parts of the engines in the plane and in space: the order of their records, and contacts as a list.

A contact of any kind leaves what it does in a record of loads; a body gathers its loads in the order of its own list, so
that sums do not depend on what is computed at the same time. Indices are unsigned: the compiler then adds no wrap-around.

Legend::

    pair[k]    lower upper    bodies of contact k: joints first, then links, then what a search has found
    span[i]    under above    the first contacts in which body i is the upper and the lower one; the last, idle one for none
               first count    where in ``touch`` its other contacts are;  fixed  1: it moves with the ground
    touch[t]   contact upper  a contact, and whether the body is the upper one there (1) or the lower one (0)
"""

import numpy as np

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
