"""Which contacts every body has, from the list of all contacts; records and legend: ``records.py``."""

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
