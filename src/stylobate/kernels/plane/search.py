"""Which bodies may touch: boxes with a skin, swept along x, kept until some body has moved far enough.

Legend::

    shape[i]    first count   corners of body i in ``corner``, from its centroid in its axes [m]
                r depth       largest distance of a corner from the centroid, thickness across the plane [m]
                travel        length of way that no point of body i can have exceeded since the boxes were made [m]
    box[i]      x0 x1 z0 z1 of body i, wider by half the skin on every side [m]
    order       bodies by increasing x0
    pair[k]     behind the joints and links: two bodies whose boxes overlap, the lower number first
    now         see ``loose.py``
"""

from ..jit import kernel, law
from ..shared.records import BODY, JOINT, LINK, LOAD, PAIR, SPAN, TOUCH, list_contacts


@law
def place(b, s, corner, x, z):
    """Corners of a body in world axes; returns their number."""
    for k in range(s.count):
        cx = corner[s.first + k, 0]
        cz = corner[s.first + k, 1]
        x[k] = b.x[0] + b.c[0] * cx - b.s[0] * cz
        z[k] = b.z[0] + b.s[0] * cx + b.c[0] * cz
    return s.count


@kernel
def make_boxes(body, shape, corner, skin, box):
    """Boxes of all bodies where they are now."""
    for i in range(body.shape[0]):
        b = body[i]
        s = shape[i]
        x0 = z0 = 1e300
        x1 = z1 = -1e300
        for k in range(s.first, s.first + s.count):
            x = b.x[0] + b.c[0] * corner[k, 0] - b.s[0] * corner[k, 1]
            z = b.z[0] + b.s[0] * corner[k, 0] + b.c[0] * corner[k, 1]
            x0 = min(x0, x)
            x1 = max(x1, x)
            z0 = min(z0, z)
            z1 = max(z1, z)
        box[i, 0] = x0 - 0.5 * skin
        box[i, 1] = x1 + 0.5 * skin
        box[i, 2] = z0 - 0.5 * skin
        box[i, 3] = z1 + 0.5 * skin
        s.travel = 0.0


@kernel
def sweep(span, box, order, pair, start):
    """List the pairs of boxes that overlap from ``start`` on, fixed bodies among themselves left out; returns how many.

    ``order`` is kept between calls: it is nearly sorted, so that sorting by insertion takes little.
    """
    n = span.shape[0]
    for i in range(1, n):
        k = order[i]
        j = i
        while j > 0 and box[order[j - 1], 0] > box[k, 0]:
            order[j] = order[j - 1]
            j -= 1
        order[j] = k
    count = 0
    for i in range(n):
        a = order[i]
        for j in range(i + 1, n):
            b = order[j]
            if box[b, 0] > box[a, 1]:
                break
            apart = box[a, 2] > box[b, 3] or box[b, 2] > box[a, 3]
            if not apart and (span[a].fixed == 0 or span[b].fixed == 0):
                pair[start + count].lower = min(a, b)
                pair[start + count].upper = max(a, b)
                count += 1
    # in the order of the bodies, so that sums do not depend on where things happen to be
    for i in range(start + 1, start + count):
        a, b = pair[i].lower, pair[i].upper
        j = i
        while j > start and (pair[j - 1].lower > a or (pair[j - 1].lower == a and pair[j - 1].upper > b)):
            pair[j].lower = pair[j - 1].lower
            pair[j].upper = pair[j - 1].upper
            j -= 1
        pair[j].lower = a
        pair[j].upper = b
    return count


@kernel
def renew_pairs(state, search):
    """Make the boxes and the list of pairs anew, and with it the lists of the bodies' contacts."""
    now, _, shape, corner, box, order, _, _, _, _, _ = search
    start = state[JOINT].shape[0] + state[LINK].shape[0]
    make_boxes(state[BODY], shape, corner, now[0].skin, box)
    now[0].pairs = sweep(state[SPAN], box, order, state[PAIR], start)
    list_contacts(state[PAIR], start + now[0].pairs, state[LOAD].shape[0] - 1, state[SPAN], state[TOUCH])
