"""Contacts as a list: which two bodies each is between, and which contacts every body has.

A contact of any kind leaves what it does in a record of loads; a body gathers its loads in the order of its own list, so that
sums do not depend on what is computed at the same time. Indices are unsigned: the compiler then adds no wrap-around to them.

Legend::

    pair[k]    lower upper    bodies of contact k: joints first, then links, then what a search has found
    span[i]    first count    where in ``touch`` the contacts of body i are;  fixed  1: it moves with the ground
    touch[t]   contact upper  a contact, and whether the body is the upper one there (1) or the lower one (0)
"""

import numpy as np

from ..jit import kernel

PAIR = np.dtype([("lower", np.uint64), ("upper", np.uint64)])
SPAN = np.dtype([("first", np.uint64), ("count", np.uint64), ("fixed", np.int64)])
TOUCH = np.dtype([("contact", np.uint64), ("upper", np.int64)])


@kernel
def list_contacts(pair, count, span, touch):
    """List the first ``count`` contacts body by body, each body's by their numbers; contacts of fixed bodies too."""
    for i in range(span.shape[0]):
        span[i].count = 0
    for k in range(count):
        span[pair[k].lower].count += np.uint64(1)
        span[pair[k].upper].count += np.uint64(1)
    first = np.uint64(0)
    for i in range(span.shape[0]):
        span[i].first = first
        first += span[i].count
        span[i].count = 0
    for k in range(count):
        for side in range(2):
            i = pair[k].upper if side == 1 else pair[k].lower
            t = span[i].first + span[i].count
            touch[t].contact = k
            touch[t].upper = side
            span[i].count += np.uint64(1)
