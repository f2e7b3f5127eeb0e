"""The rim law of round faces with chips: what is left of the rims, and the chords along which the chips broke off.

A chip takes the segment of the upper drum's lower face beyond a chord. The stiffness of the joint then sits on the rim of
what is left of the overlap: on the arcs of both circles that are within the chord, and on the chord within the face below.
Depth is linear along a chord, so that its pressure is as elementary as that of an arc.

What is left of an arc are one or two intervals, counted from its middle towards the side of the chip. Angles go as (angle,
cosine, sine): all sines and cosines follow from the addition theorem.

Legend, beside that of ``rim.py``::

    e, f          directions in the upper face: towards the chip, and a quarter turn on
    chip[0–2]     e in the axes of the upper drum                                           [-]
    chip[3–5]     half the angle of the chip's segment, its cosine and its sine
    tau           distance of the chord from the middle of the lower face, along e           [m]
    kept          ends of the intervals that are left of an arc: start, end, start, end
"""

import math

from ..jit import law
from .rim import TINY, angle_of, angle_to

#: A whole turn.
TURN = 2.0 * math.pi


@law
def later(a, b):
    """The larger one of two angles."""
    first = a[0] > b[0]
    return a[0] if first else b[0], a[1] if first else b[1], a[2] if first else b[2]


@law
def earlier(a, b):
    """The smaller one of two angles."""
    first = a[0] < b[0]
    return a[0] if first else b[0], a[1] if first else b[1], a[2] if first else b[2]


@law
def left_of(x, y, half, ex, ey, lost):
    """Part of an arc about the direction (x, y) that a chip towards (ex, ey), of so much half an angle, leaves.

    Returns the ends of two intervals, either of which may be empty, and the side of the arc's middle on which the chip lies.
    """
    c, s = x * ex + y * ey, x * ey - y * ex
    side = -1.0 if s < 0.0 else 1.0
    s *= side
    to, other = angle_to(c, s), lost[0]
    start = (to - other, c * lost[1] + s * lost[2], s * lost[1] - c * lost[2])
    end = (to + other, c * lost[1] - s * lost[2], s * lost[1] + c * lost[2])
    p = later((-half[0], half[1], -half[2]), (end[0] - TURN, end[1], end[2]))
    return (p, later(earlier(half, start), p), end, later(half, end)), side


@law
def extent(x, y, kept, side):
    """Length of what is left of an arc about (x, y), and the integrals of cosine and sine over it."""
    p, q, r, t = kept
    along = q[2] - p[2] + t[2] - r[2]
    across = side * (p[1] - q[1] + r[1] - t[1])
    return q[0] - p[0] + t[0] - r[0], along * x - across * y, along * y + across * x


@law
def up_to(end, deepest, touching):
    """An end of an interval from where the depth is largest, held within the touching part; and the whole turns to there."""
    angle = end[0] - deepest[0]
    c = end[1] * deepest[1] + end[2] * deepest[2]
    s = end[2] * deepest[1] - end[1] * deepest[2]
    turns = 1.0 if angle > math.pi else -1.0 if angle < -math.pi else 0.0
    angle -= TURN * turns
    before, after = angle < -touching[0], angle > touching[0]
    angle = -touching[0] if before else touching[0] if after else angle
    c = touching[1] if before | after else c
    s = -touching[2] if before else touching[2] if after else s
    return angle, c, s, turns


@law
def press_left(d, along, across, x, y, kept, side):
    """Integrals (L, N, C, S, X, Y; ``rim.py``) of the depth d + along · cos φ + across · sin φ where it is positive.

    Over what is left of the arc about (x, y).
    """
    g = math.sqrt(along * along + across * across)
    each = 1.0 / max(g, TINY)
    flat = g < TINY
    gx = 1.0 if flat else along * each
    gy = 0.0 if flat else across * each
    c, s = x * gx + y * gy, side * (x * gy - y * gx)
    to = angle_to(c, abs(s))
    deepest = (-to if s < 0.0 else to, c, s)
    touching = angle_of((g + d) / max(g, TINY))
    p = up_to(kept[0], deepest, touching)
    q = up_to(kept[1], deepest, touching)
    r = up_to(kept[2], deepest, touching)
    t = up_to(kept[3], deepest, touching)
    turns = 2.0 * (q[3] - p[3] + t[3] - r[3])
    length = q[0] - p[0] + t[0] - r[0] + turns * touching[0]
    sines = q[2] - p[2] + t[2] - r[2] + turns * touching[2]
    cosines = p[1] - q[1] + r[1] - t[1]
    double = q[2] * q[1] - p[2] * p[1] + t[2] * t[1] - r[2] * r[1] + turns * touching[2] * touching[1]
    squares = q[2] * q[2] - p[2] * p[2] + t[2] * t[2] - r[2] * r[2]
    n = max(d * length + g * sines, 0.0)
    first = d * sines + 0.5 * g * (length + double)
    second = d * cosines + 0.5 * g * squares
    first, second, cosines = min(max(first, -n), n), side * min(max(second, -n), n), side * cosines
    return (
        length, n, first * gx - second * gy, first * gy + second * gx, sines * gx - cosines * gy, sines * gy + cosines * gx,
    )  # fmt: skip


@law
def chord(ru, rl, cosine, reach, sine, tau):
    """Ends of the chord within the face below, along f from its middle [m].

    ``reach`` is how far along f from the middle of that face the chord's middle lies, ``sine`` that of half its angle.
    """
    wide, under = ru * sine, math.sqrt(max(rl * rl - tau * tau, 0.0))
    each = 1.0 / cosine
    low = max(-wide, (-reach - under) * each)
    return low, max(min(wide, (under - reach) * each), low)


@law
def press_chord(d, slope, low, high):
    """Integrals over a chord where the depth d + slope · y is positive: of depth times 1, y, y², and depth; of 1, y, y²."""
    steep = slope if abs(slope) > TINY else TINY
    zero = min(max(-d / steep, low), high)
    p, q = (zero if steep > 0.0 else low), (high if steep > 0.0 else zero)
    p2, q2 = p * p, q * q
    n = max((q - p) * (d + 0.5 * slope * (p + q)), 0.0)
    first = 0.5 * d * (q2 - p2) + slope * (q2 * q - p2 * p) * (1.0 / 3.0)
    second = d * (q2 * q - p2 * p) * (1.0 / 3.0) + 0.25 * slope * (q2 * q2 - p2 * p2)
    # pressure lies on the chord, whatever rounding leaves of one that is none
    first = min(max(first, low * n), high * n)
    second = min(max(second, 0.0), max(low * low, high * high) * n)
    cube = (q2 * q - p2 * p) * (1.0 / 3.0)
    return n, first, second, max(d * n + slope * first, 0.0), q - p, 0.5 * (q2 - p2), cube


@law
def press_upper(d, along, across, ru, x, y, kept, side, ex, ey, cosine, low, high):
    """Pressure of the upper drum's arc and chord on the face below, over k_n ρ.  # Eq. (E26)

    For the depth d + along · cos φ + across · sin φ on the rim; ``cosine`` is that of half the chip's angle. Returns the
    integral of depth, its moments along the slope and across it, that of the square of the distance from the middle of the
    face, the integral of the depth's square; and of what touches the length, its moments along and across, and that of the
    square of the distance [m], [m²], [m³].
    """
    length, n, c, s, p, q = press_left(d, along, across, x, y, kept, side)
    far, each = ru * cosine, 1.0 / ru
    toward, slope = (along * ex + across * ey) * each, (across * ex - along * ey) * each
    m, beside, second, square, reach, middle, spread = press_chord(d + far * toward, slope, low, high)
    return (
        ru * n + m,
        ru * ru * c + far * m * ex - beside * ey,
        ru * ru * s + far * m * ey + beside * ex,
        ru * ru * ru * n + far * far * m + second,
        ru * (d * n + along * c + across * s) + square,
        ru * length + reach,
        ru * ru * p + far * reach * ex - middle * ey,
        ru * ru * q + far * reach * ey + middle * ex,
        ru * ru * ru * length + far * far * reach + spread,
    )
