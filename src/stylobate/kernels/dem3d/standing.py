"""Does a column in space that stands now stand for good? What the energy that is left in it could still do.

Legend (j joint, and the drum above it)::

    stand[j]   m rough        mass of the drum [kg], tan φ of the joint
               along across   half widths of the drum's lower face [m]; of round drums both its radius
               under beside   the same of the face below it, infinite of the base
               over           height of the centroid of the part above over the joint [m]
               edge toe others  see shared/overturning.py

Of a column as found the drums are put down flat where they are, on joints that slope. Legend, beside the one above; a frame
has the axes of a joint as columns: its third one is normal to the faces, and it does not turn with the drum below::

    found[j]   lean               from the axes of the drum's lower face to those of its upper one, which turn with it [-]
               x y                offset of the drum in the joint as found, in the axes of the drum below [m]
               low high           lower face to centroid, and to the upper face [m]
               right left back front   from the middle of its lower face to what chips leave of it [m]; infinite of a
                                  round one without chips
               towards            azimuth of its chip, of a drum with corners 0 [rad]
"""

import math

import numpy as np

from ..jit import kernel, kernel_of_arrays, law, strict, strict_of_arrays
from ..shared.overturning import barrier
from .corner import clamped
from .pose import in_space
from .support import corner_of

STAND_TYPE = np.dtype([(name, np.float64) for name in "m rough along across under beside over edge toe others".split()])

#: Share of its margin that a drum on another one may walk off while it wobbles [-].
WALK = 0.4


@law
def turned_by(x, y, c, s):
    """A vector turned by an angle of this cosine and sine."""
    return c * x - s * y, s * x + c * y


@kernel
def inside_by(x, y, corners):
    """Depth of a point within a convex polygon given counter-clockwise, shape (k, 2); negative outside [m].

    Sides without length do not count.
    """
    longest, least = 0.0, np.inf
    for real in range(2):
        for p in range(corners.shape[0]):
            q = (p + 1) % corners.shape[0]
            dx, dy = corners[q, 0] - corners[p, 0], corners[q, 1] - corners[p, 1]
            length = math.hypot(dx, dy)
            if real == 0:
                longest = max(longest, length)
            elif length > 1e-9 * longest:
                least = min(least, (dx * (y - corners[p, 1]) - dy * (x - corners[p, 0])) / length)
    return least if longest > 0.0 else -math.hypot(x - corners[0, 0], y - corners[0, 1])


@law
def inside_discs(d, x, y, own_x, own_y):
    """Depth of a point within both of two discs, from the middle of the lower one; the upper one's is ``own`` [m]."""
    return min(d.along - math.hypot(x - own_x, y - own_y), d.under - math.hypot(x, y))


@kernel
def inside_rectangles(right, left, back, front, wide, deep, x, y, own_x, own_y, lower, upper, corners):
    """The same of two rectangles that are turned by these angles [rad]: of the upper one's corners on the lower one.

    The upper one reaches so far from its middle to each side; the lower one has these half widths [m].
    """
    c, s = math.cos(lower), -math.sin(lower)
    x, y = turned_by(x, y, c, s)
    own_x, own_y = turned_by(own_x, own_y, c, s)
    c, s = math.cos(upper - lower), math.sin(upper - lower)
    for p in range(4):
        a, b = turned_by(right if p < 2 else -left, back if 0 < p < 3 else -front, c, s)
        corners[p, 0], corners[p, 1] = clamped(own_x + a, wide), clamped(own_y + b, deep)
    return inside_by(x, y, corners)


@kernel_of_arrays
def lowest_barrier(stand, slip, turns, cornered, gravity, walks):
    """Lowest barrier of a column that is put down flat with these slips of its joints, in the axes of the drums below [m],
    shape (n, 2), and turns of its bodies, the base's first [rad]; 0 if none is left.  # Eq. (V1), in space

    A drum that wobbles on another one may walk where ``walks``: its support is narrowed.
    """
    n = stand.shape[0]
    place, corners = np.zeros((n + 1, 2)), np.empty((4, 2))
    for j in range(n):
        x, y = turned_by(slip[j, 0], slip[j, 1], math.cos(turns[j]), math.sin(turns[j]))
        place[j + 1, 0], place[j + 1, 1] = place[j, 0] + x, place[j, 1] + y
    lowest = loose = np.inf
    mass = mx = my = 0.0
    for j in range(n - 1, -1, -1):
        d = stand[j]
        mass += d.m
        mx += d.m * place[j + 1, 0]
        my += d.m * place[j + 1, 1]
        # sliding on the base takes no support away: joints between drums count
        if j > 0:
            loose = min(loose, d.rough)
        x, y = mx / mass - place[j, 0], my / mass - place[j, 1]
        own_x, own_y = place[j + 1, 0] - place[j, 0], place[j + 1, 1] - place[j, 1]
        if cornered:
            half = inside_rectangles(
                d.along, d.along, d.across, d.across, d.under, d.beside, x, y, own_x, own_y, turns[j], turns[j + 1],
                corners,
            )  # fmt: skip
        else:
            half = inside_discs(d, x, y, own_x, own_y)
        if half <= 0.0:
            return 0.0
        half *= 1.0 - WALK if walks and j > 0 else 1.0
        lowest = min(lowest, barrier(d, half, d.over, loose, gravity * mass))
    return lowest


@law
def within(x, y, z, g, l, cx, cy, cz, nx, ny, nz, radius):
    """Place of a point over a face along gravity, from the middle of that face, and whether within a radius."""
    drop = ((x - cx) * nx + (y - cy) * ny + (z - cz) * nz) / (g[0, l] * nx + g[1, l] * ny + g[2, l] * nz)
    x, y, z = x - drop * g[0, l] - cx, y - drop * g[1, l] - cy, z - drop * g[2, l] - cz
    return x, y, z, x * x + y * y + z * z < radius * radius


@strict
def is_over_discs(u, v, e, g, l, x, y, z):
    """Whether a point is over both round faces of a joint, less a chip of the upper one."""
    nx, ny, nz = in_space(u, l, u.nx[l], u.ny[l], u.nz[l])
    cx, cy, cz = in_space(u, l, u.fx[l], u.fy[l], u.fz[l])
    cx, cy, cz = u.x[l] + cx, u.y[l] + cy, u.z[l] + cz
    px, py, pz, upper = within(x, y, z, g, l, cx, cy, cz, nx, ny, nz, u.rb[l])
    if e.chip.shape[0] > 1:
        ax, ay, az = in_space(u, l, e.chip[0, l], e.chip[1, l], e.chip[2, l])
        upper &= px * ax + py * ay + pz * az < u.rb[l] * e.chip[4, l]
    kx, ky, kz, ht = v.kx[l], v.ky[l], v.kz[l], v.ht[l]
    cx, cy, cz = v.x[l] + ht * kx, v.y[l] + ht * ky, v.z[l] + ht * kz
    _, _, _, lower = within(x, y, z, g, l, cx, cy, cz, kx, ky, kz, v.rt[l])
    return upper & lower


@strict
def is_over_corners(u, v, g, l, x, y, z, corners):
    """Whether a point is over the corners of the overlap of a joint of rectangular faces."""
    kx, ky, kz, ht = v.kx[l], v.ky[l], v.kz[l], v.ht[l]
    for p in range(u.px.shape[0]):
        a, b, c = corner_of(u, v, l, p)
        c = c if (abs(a) < v.tx[l]) & (abs(b) < v.ty[l]) else 0.0
        dx, dy, dz = in_space(v, l, clamped(a, v.tx[l]), clamped(b, v.ty[l]), c)
        dz += v.z[l] + ht * kz
        corners[p, 0] = v.x[l] + ht * kx + dx - dz * g[0, l] / g[2, l]
        corners[p, 1] = v.y[l] + ht * ky + dy - dz * g[1, l] / g[2, l]
    return inside_by(x - z * g[0, l] / g[2, l], y - z * g[1, l] / g[2, l], corners) > 0.0


@strict_of_arrays
def centroids_inside(body, joint, lane, l):
    """Whether the centroid of every part of a column is over both faces of the joint under it, seen along gravity."""
    g, corners = lane[0].g, np.empty((4, 2))
    mass = mx = my = mz = 0.0
    for j in range(joint.shape[0] - 1, -1, -1):
        u, v = body[j + 1], body[j]
        mass += u.m[l]
        mx += u.m[l] * u.x[l]
        my += u.m[l] * u.y[l]
        mz += u.m[l] * u.z[l]
        x, y, z = mx / mass, my / mass, mz / mass
        if u.px.shape[0] > 1:
            inside = is_over_corners(u, v, g, l, x, y, z, corners)
        else:
            inside = is_over_discs(u, v, joint[j], g, l, x, y, z)
        if not inside:
            return False
    return True


@strict_of_arrays
def turns_of(body, l):
    """Azimuth of the first axis of every body [rad]."""
    turns = np.empty(body.shape[0])
    for i in range(body.shape[0]):
        turns[i] = math.atan2(body[i].iy[l], body[i].ix[l])
    return turns


@strict_of_arrays
def all_stand(stand, slip, energy, gravity, walks, body, joint, lane, lanes, out):
    """Whether columns as built in some lanes stand for good, shape (lanes,): see :func:`stands`; numbers of each in rows."""
    for k in range(lanes.shape[0]):
        out[k] = stands(stand[k], slip[k], energy[k], gravity[k], walks, body, joint, lane, lanes[k])


@strict_of_arrays
def stands(stand, slip, energy, gravity, walks, body, joint, lane, l):
    """Whether a column as built, with these slips and this energy [J], stands for good: see ``models/dem3d/packing.py``."""
    if not centroids_inside(body, joint, lane, l):
        return False
    lowest = lowest_barrier(stand, slip, turns_of(body, l), body[1].px.shape[0] > 1, gravity, walks)
    return 0.0 < lowest and energy < lowest


#: Numbers of a drum as found, see ``found_numbers`` in ``models/dem3d/packing.py``.
FOUND_DRUM_TYPE = np.dtype(
    [("lean", np.float64, (3, 3))]
    + [(name, np.float64) for name in "x y low high right left back front towards".split()]
)


@law
def write_place(into, at, axes, x, y, z):
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
def put_down_found(found_drums, slip, turns, frame, origin, centroid, offset):
    """Puts the drums down flat, with these slips of their joints in the axes of the drums below [m].

    A drum that has turned since it was found takes its slope with it, and what stands on it. Writes the frames and origins
    of all joints, shapes (n + 1, 3, 3) and (n + 1, 3), of which the first are those of the base, centroids, shape (n, 3),
    and offsets in the joints, shape (n, 2).
    """
    for j in range(found_drums.shape[0]):
        d = found_drums[j]
        x, y = turned_by(d.x + slip[j, 0], d.y + slip[j, 1], math.cos(turns[j]), math.sin(turns[j]))
        offset[j, 0], offset[j, 1] = x, y
        put_leaning(frame[j + 1], frame[j], d.lean, math.cos(turns[j + 1]), math.sin(turns[j + 1]))
        write_place(origin[j + 1], origin[j], frame[j], x, y, 0.0)
        write_place(centroid[j], origin[j + 1], frame[j + 1], 0.0, 0.0, d.low)
        write_place(origin[j + 1], origin[j + 1], frame[j + 1], 0.0, 0.0, d.high)


@law
def inside_chipped(d, x, y, turn):
    """Depth of a place, from the middle of a round face, within what chips leave of it; negative outside [m]."""
    a, _ = turned_by(x, y, math.cos(turn + d.towards), -math.sin(turn + d.towards))
    return min(d.right - a, d.left + a)


@strict_of_arrays
def lowest_found(found_drums, stand, slip, turns, up, cornered, gravity, walks):
    """As ``standing.lowest_barrier`` of a column as found, a lower bound [J]; and mass times height of its drums [kg m].

    On a joint that slopes by γ the nearest edge is b cos γ away across gravity, and may lie b sin γ lower; friction is what
    the slope leaves of it. What pretensioned links press is left out: they may break, and all that an elastic one gives
    back then is counted with the energy that is left.
    """
    n = found_drums.shape[0]
    frame, origin = np.zeros((n + 1, 3, 3)), np.zeros((n + 1, 3))
    centroid, offset, corners = np.empty((n, 3)), np.empty((n, 2)), np.empty((4, 2))
    for c in range(3):
        frame[0, c, c] = 1.0
    put_down_found(found_drums, slip, turns, frame, origin, centroid, offset)
    lowest = loose = np.inf
    mass = mx = my = mz = 0.0
    for j in range(n - 1, -1, -1):
        d, face = found_drums[j], stand[j]
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
def stands_as_found(found_drums, stand, slip, energy, high, up, gravity, walks, body, joint, lane, l):
    """Whether a column as found, with these slips and this energy [J], stands for good; see ``models/dem3d/packing.py``.

    ``high`` is mass times height of its drums as they were found [kg m]: what sliding down a slope has set free is not there
    any more to fall back on.
    """
    if not centroids_inside(body, joint, lane, l):
        return False
    turns, cornered = turns_of(body, l), body[1].px.shape[0] > 1
    lowest, low = lowest_found(found_drums, stand, slip, turns - turns[0], up, cornered, gravity, walks)
    return 0.0 < lowest and energy + max((high - low) * gravity, 0.0) < lowest
