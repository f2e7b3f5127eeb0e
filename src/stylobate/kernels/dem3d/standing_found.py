"""Does a column as found in space stand for good? Its drums put down flat where they are, on joints that slope.

Legend (j joint, and the drum above it; besides ``standing.py``), in axes along and normal to the base::

    found[j]   frame own          axes of the joint, and of the drum as it was found, but for its turn, as columns [-]
               x y                offset of the drum in the joint as found [m]
               low high           lower face to centroid, and to the upper face [m]
               disc under         radii of the drum's face and of the one below [m]; infinite where they have corners
               right left back front   from the middle of its face to what chips leave of it [m]; infinite if round and whole
               wide deep          half widths of the face below, infinite if round, and of the base
               towards            azimuth of its chip, of a drum with corners 0 [rad]
               level rough        cosine of the joint's slope; tan φ that the slope leaves
    pull[m]    lower upper line   bodies of a pretensioned link; 1: straight between two points, else across a joint
               force a b          pretension [N]; its places on the two drums, in their axes [m]
"""

import math

import numpy as np

from ..jit import kernel, law, strict_of_arrays
from ..shared.overturning import barrier
from .standing import WALK, centroids_inside, turned_by, turns_of

FOUND_TYPE = np.dtype(
    [(name, np.float64, (3, 3)) for name in ("frame", "own")]
    + [
        (name, np.float64)
        for name in "x y low high disc under right left back front wide deep towards level rough".split()
    ]
)

PULL_TYPE = np.dtype(
    [(name, np.int64) for name in ("lower", "upper", "line")]
    + [("force", np.float64), ("a", np.float64, (3,)), ("b", np.float64, (3,))]
)


@law
def put(into, at, axes, x, y, z):
    """Writes where a place in these axes is, whose origin is ``at``."""
    for c in range(3):
        into[c] = at[c] + axes[c, 0] * x + axes[c, 1] * y + axes[c, 2] * z


@law
def inward(axes, x, y, z):
    """A vector in these axes."""
    return (
        axes[0, 0] * x + axes[1, 0] * y + axes[2, 0] * z,
        axes[0, 1] * x + axes[1, 1] * y + axes[2, 1] * z,
        axes[0, 2] * x + axes[1, 2] * y + axes[2, 2] * z,
    )


@law
def crossed(a, b):
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def put_down(found, slip, turns, origin, centroid, offset):
    """Puts the drums down flat, with these slips of their joints in the axes of the drums below [m]: shapes (n + 1, 3),
    (n, 3) and (n, 2); the first origin is that of all axes."""
    n = found.shape[0]
    for j in range(n):
        d = found[j]
        x, y = turned_by(slip[j, 0], slip[j, 1], math.cos(turns[j]), math.sin(turns[j]))
        offset[j, 0], offset[j, 1] = d.x + x, d.y + y
        put(origin[j + 1], origin[j], d.frame, offset[j, 0], offset[j, 1], 0.0)
        put(centroid[j], origin[j + 1], d.own, 0.0, 0.0, d.low)
        put(origin[j + 1], origin[j + 1], d.own, 0.0, 0.0, d.high)


@kernel
def place_on(found, k, turn, centroid, at, into):
    """Writes where a place of a link on body k, which is turned, is; on the base as it is given."""
    if k > 0:
        x, y = turned_by(at[0], at[1], math.cos(turn), math.sin(turn))
        put(into, centroid[k - 1], found[k - 1].own, x, y, at[2])
    else:
        for c in range(3):
            into[c] = at[c]


@kernel
def pulled_part(found, pull, turns, centroid, j, force, moment, low, high):
    """Writes force [N], and moment about the origin of all axes [N m], of pretensioned links on the part above joint j."""
    for c in range(3):
        force[c] = moment[c] = 0.0
    for m in range(pull.shape[0]):
        p = pull[m]
        if j < p.lower or j >= p.upper:
            continue
        place_on(found, p.upper, turns[p.upper], centroid, p.b, high)
        place_on(found, p.lower, turns[p.lower], centroid, p.a, low)
        size = 0.0
        for c in range(3):
            if p.line != 0:
                low[c] -= high[c]
            else:
                low[c] = -found[p.lower - 1].own[c, 2] if p.lower > 0 else -1.0 if c == 2 else 0.0
            size += low[c] * low[c]
        for c in range(3):
            low[c] *= p.force / math.sqrt(size)
            force[c] += low[c]
        x, y, z = crossed(high, low)
        moment[0] += x
        moment[1] += y
        moment[2] += z


@kernel
def inside_face(d, x, y, own_x, own_y, lower, upper):
    """How far a place along a joint is inside what is left of both faces; negative outside [m]. The drum below and the one
    above are turned by these angles [rad]."""
    least = min(d.disc - math.hypot(x - own_x, y - own_y), d.under - math.hypot(x, y))
    angle = upper + d.towards
    a, b = turned_by(x - own_x, y - own_y, math.cos(angle), -math.sin(angle))
    least = min(least, min(min(d.right - a, d.left + a), min(d.back - b, d.front + b)))
    a, b = turned_by(x, y, math.cos(lower), -math.sin(lower))
    return min(least, min(d.wide - abs(a), d.deep - abs(b)))


@strict_of_arrays
def lowest_found(found, stand, pull, slip, turns, up, gravity, walks):
    """As ``standing.lowest_barrier`` of a column as found, a lower bound [J]; and mass times height of its drums [kg m].

    On a joint that slopes by γ the nearest edge is b cos γ away across gravity, and may lie b sin γ lower; friction is what
    the slope leaves of it.
    """
    n = found.shape[0]
    origin, centroid, offset = np.zeros((n + 1, 3)), np.empty((n, 3)), np.empty((n, 2))
    drawn, moment, low, high = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    put_down(found, slip, turns, origin, centroid, offset)
    lowest = loose = np.inf
    mass = mx = my = mz = 0.0
    for j in range(n - 1, -1, -1):
        d = found[j]
        mass += stand[j].m
        mx += stand[j].m * centroid[j, 0]
        my += stand[j].m * centroid[j, 1]
        mz += stand[j].m * centroid[j, 2]
        if j > 0:
            loose = min(loose, d.rough)
        x, y, z = mx / mass - origin[j, 0], my / mass - origin[j, 1], mz / mass - origin[j, 2]
        height = x * up[0] + y * up[1] + z * up[2]
        arm = inward(d.frame, x, y, z)
        weight = gravity * mass
        force = inward(d.frame, -weight * up[0], -weight * up[1], -weight * up[2])
        turning = crossed(arm, force)
        if pull.shape[0] > 0:
            pulled_part(found, pull, turns, centroid, j, drawn, moment, low, high)
            x, y, z = crossed(origin[j], drawn)
            more = inward(d.frame, moment[0] - x, moment[1] - y, moment[2] - z)
            held = inward(d.frame, drawn[0], drawn[1], drawn[2])
            turning = turning[0] + more[0], turning[1] + more[1], turning[2] + more[2]
            force = force[0] + held[0], force[1] + held[1], force[2] + held[2]
        if not force[2] < 0.0:
            return 0.0, mx * up[0] + my * up[1] + mz * up[2]
        x, y = -turning[1] / force[2], turning[0] / force[2]
        half = inside_face(d, x, y, offset[j, 0], offset[j, 1], turns[j], turns[j + 1])
        if half <= 0.0:
            return 0.0, mx * up[0] + my * up[1] + mz * up[2]
        half *= 1.0 - WALK if walks and j > 0 else 1.0
        for c in range(3):
            height -= (d.frame[c, 0] * x + d.frame[c, 1] * y) * up[c]
        height += half * math.sqrt(1.0 - d.level * d.level)
        lowest = min(lowest, barrier(stand, j, half * d.level, height, loose, weight * d.level))
    return lowest, mx * up[0] + my * up[1] + mz * up[2]


@strict_of_arrays
def stands_as_found(found, stand, pull, slip, energy, high, up, gravity, walks, body, joint, lane, l):
    """Whether a column as found, with these slips and this energy [J], stands for good; see ``models/dem3d/verdict.py``.

    ``high`` is mass times height of its drums as they were found [kg m]: what sliding down a slope has set free is not there
    any more to fall back on.
    """
    if not centroids_inside(body, joint, lane, l):
        return False
    turns = turns_of(body, l)
    lowest, low = lowest_found(found, stand, pull, slip, turns - turns[0], up, gravity, walks)
    return energy + max((high - low) * gravity, 0.0) < lowest
