"""Overlap of two convex polygons, and the force of an elastic bed between them, without cases of corners and edges.

Both outlines are clipped against each other. The part of A's outline inside B, walked counter-clockwise, adds up to a
chord g: the vector between the points where the outlines cross. Its length is the width of the contact, its right-hand
normal points from A into B. A bed of stiffness k per area presses at every point of the chord with k times the depth of
the overlap there: the sum is k times the area, and acts in its centroid. Area, centroid and chord are continuous
functions of the two positions, whichever corner or edge touches which (chord as contact plane: Feng & Owen, 2004).

Legend::

    xa za, xb zb    vertices of the polygons in world axes, counter-clockwise        [m]
    na nb           their numbers
    px pz           vertices of the overlap; from_b is 1 where the edge that starts there is B's
    area cx cz      area and centroid of the overlap                                  [m²], [m]
    gx gz           chord                                                             [m]
"""

import numpy as np

from ..jit import kernel, strict, strict_of_arrays

#: Vertices that two clipped polygons can have together.
MOST = 64


@kernel
def clip(xa, za, na, xb, zb, nb, px, pz, from_b, qx, qz, q_from):
    """Overlap of two convex polygons (Sutherland and Hodgman); returns its number of vertices, 0 where there is none.

    The result is in ``px``, ``pz``, ``from_b``; ``qx``, ``qz``, ``q_from`` are workspace.
    """
    n = na
    for i in range(na):
        px[i] = xa[i]
        pz[i] = za[i]
        from_b[i] = 0
    for e in range(nb):
        ox = xb[e]
        oz = zb[e]
        f = e + 1 if e + 1 < nb else 0
        ex = xb[f] - ox
        ez = zb[f] - oz
        m = 0
        here = ez * (px[0] - ox) - ex * (pz[0] - oz)  # > 0 outside
        for i in range(n):
            k = i + 1 if i + 1 < n else 0
            there = ez * (px[k] - ox) - ex * (pz[k] - oz)
            if here <= 0.0:
                qx[m] = px[i]
                qz[m] = pz[i]
                q_from[m] = from_b[i]
                m += 1
            if (here <= 0.0) != (there <= 0.0):
                part = here / (here - there)
                qx[m] = px[i] + part * (px[k] - px[i])
                qz[m] = pz[i] + part * (pz[k] - pz[i])
                q_from[m] = 1 if here <= 0.0 else from_b[i]
                m += 1
            here = there
        if m < 3:
            return 0
        for i in range(m):
            px[i] = qx[i]
            pz[i] = qz[i]
            from_b[i] = q_from[i]
        n = m
    return n


@kernel
def measure(px, pz, from_b, n):
    """Area, centroid and chord of an overlap: (area, cx, cz, gx, gz)."""
    ox = px[0]
    oz = pz[0]
    twice = 0.0
    sx = 0.0
    sz = 0.0
    gx = 0.0
    gz = 0.0
    for i in range(n):
        k = i + 1 if i + 1 < n else 0
        ax = px[i] - ox
        az = pz[i] - oz
        bx = px[k] - ox
        bz = pz[k] - oz
        cross = ax * bz - az * bx
        twice += cross
        sx += (ax + bx) * cross
        sz += (az + bz) * cross
        if from_b[i] == 0:
            gx += bx - ax
            gz += bz - az
    if not twice > 0.0:
        return 0.0, ox, oz, 0.0, 0.0
    return 0.5 * twice, ox + sx / (3.0 * twice), oz + sz / (3.0 * twice), gx, gz


@kernel
def separation(xa, za, na, xb, zb, nb):
    """Largest distance of B from a face of A, along that face's normal [m]; negative where B crosses all of A's faces."""
    best = -1e300
    for e in range(na):
        f = e + 1 if e + 1 < na else 0
        ex = xa[f] - xa[e]
        ez = za[f] - za[e]
        least = 1e300
        for k in range(nb):
            least = min(least, ez * (xb[k] - xa[e]) - ex * (zb[k] - za[e]))
        best = max(best, least / np.sqrt(ex * ex + ez * ez))
    return best


@strict_of_arrays
def depth_square(px, pz, n, tx, tz):
    """∫ depth² ds along the chord of direction (tx, tz), depth the extent of the overlap across it [m³]."""
    s = np.empty(n)
    q = np.empty(n)
    for i in range(n):
        s[i] = (px[i] - px[0]) * tx + (pz[i] - pz[0]) * tz
        q[i] = (pz[i] - pz[0]) * tx - (px[i] - px[0]) * tz
    order = np.sort(s)
    total = 0.0
    for j in range(n - 1):
        h = order[j + 1] - order[j]
        if h > 0.0:
            # the depth is linear between neighbouring abscissae: two of its values fix the integral
            first = _extent(s, q, n, order[j] + 0.25 * h)
            second = _extent(s, q, n, order[j] + 0.75 * h)
            left, right = 1.5 * first - 0.5 * second, 1.5 * second - 0.5 * first
            total += h * (left * left + left * right + right * right) / 3.0
    return total


@strict
def _extent(s, q, n, at):
    low = np.inf
    high = -np.inf
    for i in range(n):
        k = i + 1 if i + 1 < n else 0
        if (s[i] - at) * (s[k] - at) < 0.0:
            value = q[i] + (q[k] - q[i]) * (at - s[i]) / (s[k] - s[i])
            low = min(low, value)
            high = max(high, value)
    return high - low if high > low else 0.0
