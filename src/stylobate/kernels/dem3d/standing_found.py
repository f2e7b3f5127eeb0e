"""Does a column as found in space stand for good? Its drums put down flat where they are, on joints that slope.

Legend (j joint, and the drum above it; masses and half widths of faces are in ``standing.py``). A frame has the axes of a
joint as columns: its third one is normal to the faces, and it does not turn with the drum below::

    found[j]   lean               from the axes of the drum's lower face to those of its upper one, which turn with it [-]
               x y                offset of the drum in the joint as found, in the axes of the drum below [m]
               low high           lower face to centroid, and to the upper face [m]
               right left back front   from the middle of its lower face to what chips leave of it [m]; infinite of a
                                  round one without chips
               towards            azimuth of its chip, of a drum with corners 0 [rad]
"""

import math

import numpy as np

from ..jit import kernel, law, strict_of_arrays
from ..shared.overturning import barrier
from .standing import WALK, centroids_inside, inside_discs, inside_rectangles, turned_by, turns_of

FOUND_TYPE = np.dtype(
    [("lean", np.float64, (3, 3))]
    + [(name, np.float64) for name in "x y low high right left back front towards".split()]
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
def put_leaning(into, axes, lean, c, s):
    """Writes the frame over a drum that leans so in its own axes, which are turned in ``axes``, by cosine and sine."""
    for r in range(3):
        x, y, z = c * axes[r, 0] + s * axes[r, 1], c * axes[r, 1] - s * axes[r, 0], axes[r, 2]
        a = x * lean[0, 0] + y * lean[1, 0] + z * lean[2, 0]
        b = x * lean[0, 1] + y * lean[1, 1] + z * lean[2, 1]
        into[r, 0], into[r, 1] = c * a - s * b, s * a + c * b
        into[r, 2] = x * lean[0, 2] + y * lean[1, 2] + z * lean[2, 2]


@kernel
def put_down_found(found, slip, turns, frame, origin, centroid, offset):
    """Puts the drums down flat, with these slips of their joints in the axes of the drums below [m].

    A drum that has turned since it was found takes its slope with it, and what stands on it. Writes the frames and origins
    of all joints, shapes (n + 1, 3, 3) and (n + 1, 3), of which the first are those of the base, centroids, shape (n, 3),
    and offsets in the joints, shape (n, 2).
    """
    for j in range(found.shape[0]):
        d = found[j]
        x, y = turned_by(d.x + slip[j, 0], d.y + slip[j, 1], math.cos(turns[j]), math.sin(turns[j]))
        offset[j, 0], offset[j, 1] = x, y
        put_leaning(frame[j + 1], frame[j], d.lean, math.cos(turns[j + 1]), math.sin(turns[j + 1]))
        put(origin[j + 1], origin[j], frame[j], x, y, 0.0)
        put(centroid[j], origin[j + 1], frame[j + 1], 0.0, 0.0, d.low)
        put(origin[j + 1], origin[j + 1], frame[j + 1], 0.0, 0.0, d.high)


@law
def inside_chipped(d, x, y, turn):
    """Depth of a place, from the middle of a round face, within what chips leave of it; negative outside [m]."""
    a, _ = turned_by(x, y, math.cos(turn + d.towards), -math.sin(turn + d.towards))
    return min(d.right - a, d.left + a)


@strict_of_arrays
def lowest_found(found, stand, slip, turns, up, cornered, gravity, walks):
    """As ``standing.lowest_barrier`` of a column as found, a lower bound [J]; and mass times height of its drums [kg m].

    On a joint that slopes by γ the nearest edge is b cos γ away across gravity, and may lie b sin γ lower; friction is what
    the slope leaves of it. What pretensioned links press is left out: they may break, and all that an elastic one gives
    back then is counted with the energy that is left.
    """
    n = found.shape[0]
    frame, origin = np.zeros((n + 1, 3, 3)), np.zeros((n + 1, 3))
    centroid, offset, corners = np.empty((n, 3)), np.empty((n, 2)), np.empty((4, 2))
    for c in range(3):
        frame[0, c, c] = 1.0
    put_down_found(found, slip, turns, frame, origin, centroid, offset)
    lowest = loose = np.inf
    mass = mx = my = mz = 0.0
    for j in range(n - 1, -1, -1):
        d, face = found[j], stand[j]
        mass += face.m
        mx += face.m * centroid[j, 0]
        my += face.m * centroid[j, 1]
        mz += face.m * centroid[j, 2]
        level = min(frame[j, 0, 2] * up[0] + frame[j, 1, 2] * up[1] + frame[j, 2, 2] * up[2], 1.0)
        if j > 0:
            loose = min(loose, math.tan(max(math.atan(face.rough) - math.acos(level), 0.0)))
        arm = inward(frame[j], mx / mass - origin[j, 0], my / mass - origin[j, 1], mz / mass - origin[j, 2])
        against = inward(frame[j], up[0], up[1], up[2])
        # where the centroid's plumb line meets the joint
        x, y = arm[0] - arm[2] * against[0] / against[2], arm[1] - arm[2] * against[1] / against[2]
        own_x, own_y = offset[j, 0], offset[j, 1]
        if cornered:
            half = inside_rectangles(
                d.right, d.left, d.back, d.front, face.under, face.beside, x, y, own_x, own_y, turns[j], turns[j + 1],
                corners,
            )  # fmt: skip
        else:
            half = min(inside_discs(face, x, y, own_x, own_y), inside_chipped(d, x - own_x, y - own_y, turns[j + 1]))
        if half <= 0.0:
            return 0.0, mx * up[0] + my * up[1] + mz * up[2]
        half *= 1.0 - WALK if walks and j > 0 else 1.0
        height = arm[2] / against[2] + half * math.sqrt(1.0 - level * level)
        lowest = min(lowest, barrier(face, half * level, height, loose, gravity * mass * level))
    return lowest, mx * up[0] + my * up[1] + mz * up[2]


@strict_of_arrays
def stands_as_found(found, stand, slip, energy, high, up, gravity, walks, body, joint, lane, l):
    """Whether a column as found, with these slips and this energy [J], stands for good; see ``models/dem3d/packing.py``.

    ``high`` is mass times height of its drums as they were found [kg m]: what sliding down a slope has set free is not there
    any more to fall back on.
    """
    if not centroids_inside(body, joint, lane, l):
        return False
    turns, cornered = turns_of(body, l), body[1].px.shape[0] > 1
    lowest, low = lowest_found(found, stand, slip, turns - turns[0], up, cornered, gravity, walks)
    return 0.0 < lowest and energy + max((high - low) * gravity, 0.0) < lowest
