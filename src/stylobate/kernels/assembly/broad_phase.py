"""Which bodies may touch: boxes with a skin, swept along x, kept until some body has moved far enough.

Legend::

    box[i]      x0 x1 z0 z1 of body i, wider by half the skin on every side [m]
    order       bodies by increasing x0
    pairs[k]    two bodies whose boxes overlap, the lower number first
    travel[i]   length of way that no point of body i can have exceeded since the boxes were made [m]
"""

from ..jit import kernel


@kernel
def make_boxes(body, corner, skin, box):
    """Boxes of all bodies where they are now."""
    for i in range(body.shape[0]):
        b = body[i]
        x0 = z0 = 1e300
        x1 = z1 = -1e300
        for k in range(b.first, b.first + b.count):
            x = b.x + b.c * corner[k, 0] - b.s * corner[k, 1]
            z = b.z + b.s * corner[k, 0] + b.c * corner[k, 1]
            x0 = min(x0, x)
            x1 = max(x1, x)
            z0 = min(z0, z)
            z1 = max(z1, z)
        box[i, 0] = x0 - 0.5 * skin
        box[i, 1] = x1 + 0.5 * skin
        box[i, 2] = z0 - 0.5 * skin
        box[i, 3] = z1 + 0.5 * skin
        b.travel = 0.0


@kernel
def sweep(body, box, order, pairs):
    """List the pairs of boxes that overlap, fixed bodies among themselves left out; returns how many.

    ``order`` is kept between calls: it is nearly sorted, so that sorting by insertion takes little.
    """
    n = body.shape[0]
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
            if not apart and (body[a].im > 0.0 or body[b].im > 0.0):
                pairs[count, 0] = min(a, b)
                pairs[count, 1] = max(a, b)
                count += 1
    # in the order of the bodies, so that sums do not depend on where things happen to be
    for i in range(1, count):
        a, b = pairs[i, 0], pairs[i, 1]
        j = i
        while j > 0 and (pairs[j - 1, 0] > a or (pairs[j - 1, 0] == a and pairs[j - 1, 1] > b)):
            pairs[j, 0] = pairs[j - 1, 0]
            pairs[j, 1] = pairs[j - 1, 1]
            j -= 1
        pairs[j, 0] = a
        pairs[j, 1] = b
    return count
