"""Does a column that stands now stand for good? What the energy that is left in it could still do.

Legend (axes along and normal to the base, from the middle of its contact)::

    stand[i]   m hc h         mass of drum i, height of its centroid and its own [kg], [m]
               tilt           inclination of its axis to the normal of its lower face [rad]
               left right     from the middle of that face to its ends, chips off [m];  under  half width of the face below
               rough          tan φ of the joint under it
               edge toe others  see shared/overturning.py
               lean cx cz ox oz low high   the drums put down flat with their offsets: inclination of the joint [rad],
                              centroid and middle of the face below [m], ends of the contact along it [m]
"""

import math

import numpy as np

from ..jit import kernel, strict
from ..shared.overturning import barrier
from .point_joint import face

STAND_TYPE = np.dtype(
    [
        (name, np.float64)
        for name in ("m hc h tilt left right under rough edge toe others lean cx cz ox oz low high".split())
    ]
)


@kernel
def put_down(stand, offset):
    """Puts the drums down flat on one another, each with its offset along the joint under it [m]."""
    x = z = lean = 0.0
    for i in range(stand.shape[0]):
        d = stand[i]
        d.lean = lean
        d.ox = x
        d.oz = z
        d.low = max(offset[i] - d.left, -d.under)
        d.high = min(offset[i] + d.right, d.under)
        axis = lean + d.tilt
        x += offset[i] * math.cos(lean)
        z += offset[i] * math.sin(lean)
        d.cx = x - d.hc * math.sin(axis)
        d.cz = z + d.hc * math.cos(axis)
        x -= d.h * math.sin(axis)
        z += d.h * math.cos(axis)
        lean = axis


@kernel
def lowest_barrier(stand, gravity, slope):
    """Lowest barrier of a column that is put down flat on a base of a slope [rad], in [J]; 0 if none is left.  # Eq. (V1)"""
    n = stand.shape[0]
    ux, uz = math.sin(slope), math.cos(slope)
    lowest = np.inf
    loose = np.inf
    mass = mx = mz = 0.0
    for j in range(n - 1, -1, -1):
        d = stand[j]
        mass += d.m
        mx += d.m * d.cx
        mz += d.m * d.cz
        # sliding on the base takes no support away: joints between drums count
        if j > 0:
            loose = min(loose, math.tan(max(math.atan(d.rough) - abs(d.lean + slope), 0.0)))
        for side in range(2):
            place = d.low if side == 0 else d.high
            ax = mx / mass - d.ox - place * math.cos(d.lean)
            az = mz / mass - d.oz - place * math.sin(d.lean)
            # across gravity, from the left and to the right end, and along it
            across = ax * uz - az * ux if side == 0 else az * ux - ax * uz
            if across <= 0.0:
                return 0.0
            # on a slope the end farther off may be the lower barrier, as it lies lower
            lowest = min(lowest, barrier(d, across, ax * ux + az * uz, loose, gravity * mass))
    return lowest


@strict
def centroids_inside(body, joint, n, slope, l):
    """Whether the centroid of every part of a column stands within its contact, seen along gravity.

    ``slope`` is the tangent of the base's.
    """
    mass = moment = 0.0
    for j in range(n - 1, -1, -1):
        u = body[j + 1]
        v = body[j]
        e = joint[j]
        mass += u.m[l]
        moment += u.m[l] * (u.x[l] - u.z[l] * slope)
        cf, sf = face(v, l, e.lc[l], e.ls[l])
        dx, dz = u.x[l] - v.x[l], u.z[l] - v.z[l]
        cosine, sine = u.c[l] * cf + u.s[l] * sf, u.s[l] * cf - u.c[l] * sf
        foot = cf * dx + sf * dz + sine * e.hb[l]
        low = max(foot - e.bl[l] * cosine, -e.wl[l])
        high = min(foot + e.br[l] * cosine, e.wr[l])
        ht = e.ht[l]
        left = (v.x[l] + cf * low - sf * ht) - (v.z[l] + sf * low + cf * ht) * slope
        right = (v.x[l] + cf * high - sf * ht) - (v.z[l] + sf * high + cf * ht) * slope
        if not left < moment / mass < right:
            return False
    return True


@strict
def all_stand(stand, offset, gravity, slope, energy, body, joint, lanes, out):
    """Whether columns in some lanes stand for good, shape (lanes,): see :func:`stands`; numbers of each are in rows."""
    for k in range(lanes.shape[0]):
        out[k] = stands(stand[k], offset[k], gravity[k], slope[k], energy[k], body, joint, lanes[k])


@strict
def stands(stand, offset, gravity, slope, energy, body, joint, l):
    """Whether a column that no input shakes any more can neither overturn nor slide apart; see ``models/plane/packing.py``.

    ``stand`` comes put down as found, and is put down with the ``offset`` of each drum along its joint [m].
    """
    if not centroids_inside(body, joint, stand.shape[0], math.tan(slope), l):
        return False
    # what sliding down a slope has set free is not there any more to fall back on
    lower = 0.0
    for i in range(stand.shape[0]):
        d = stand[i]
        lower += d.m * (math.sin(slope) * d.cx + math.cos(slope) * d.cz)
    put_down(stand, offset)
    for i in range(stand.shape[0]):
        d = stand[i]
        lower -= d.m * (math.sin(slope) * d.cx + math.cos(slope) * d.cz)
    lowest = lowest_barrier(stand, gravity, slope)
    return 0.0 < lowest and energy + max(gravity * lower, 0.0) < lowest
