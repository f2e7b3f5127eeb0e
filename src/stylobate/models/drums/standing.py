"""Does a column that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_geometry import Geometry, geometry, gravity_vector
from ...constants import DEGREE
from ..shared.toes import given_by_toes


def lowest_barrier(column: Column) -> float:
    """Smallest energy that overturns the part above some joint of the upright column as one body [J]."""
    return min(
        column.gravity * mass * (math.hypot(half, height) - height)
        for (mass, height), half in zip(
            (_part(column, j) for j in range(column.n)), 0.5 * column.joint_widths, strict=True
        )
    )


def stands_for_good(
    column: Column, drum: np.ndarray, lane: int, slip: np.ndarray, energy: float, toes: np.ndarray
) -> bool:
    """Whether a column that no input shakes any more can neither overturn nor slide apart.

    Parameters
    ----------
    column : Column
    drum : array
        Records of the drums, the base first (legend of the kernel).
    lane : int
    slip : array
        Along each joint since the start [m], shape (n,).
    energy : float
        Kinetic, gravitational and elastic energy above that of the column at rest [J].
    toes : array
        What each joint gives with its load on its edge (:mod:`stylobate.models.shared.toes`) [J], shape (n,).

    Notes
    -----
    Two conditions, Eq. (V1). As the column is, the centroid of every part stands within its contact: it is on the
    near side of every barrier. And the energy is below the lowest barrier of the column put down flat with its
    present offsets: overturning as one body about the nearer end of the contact, m g (R − H); where some joint above
    is so slippery that it slides first, tan φ below the sine of the critical angle, sliding and lifting together: m g
    [tan φ b − H (1 − √(1 − tan² φ))]. On a slope H and b are measured along and across gravity, and friction is what
    the slope of the joint leaves of it. Soft joints give, and the barrier is lower by that.
    """
    if not _centroids_inside(column, drum, lane):
        return False
    offsets = np.array([column.as_found.of(i + 1).offset for i in range(column.n)]) + slip
    flat = geometry(column, offsets)
    # what sliding down a slope has set free is not there any more to fall back on
    lower = float(column.masses @ ((flat.centroid - geometry(column).centroid) @ gravity_vector(column)))
    return energy + max(lower, 0.0) < flat_barrier(column, flat, toes)


def _part(column: Column, j: int) -> tuple[float, float]:
    """Mass of the part above joint j and height of its centroid above that joint [kg], [m]."""
    mass = column.masses[j:]
    arm = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]))
    return float(mass.sum()), arm / float(mass.sum())


def _centroids_inside(column: Column, drum: np.ndarray, lane: int) -> bool:
    names = ("x", "z", "c", "s", "ht", "hb", "bl", "br", "t", "fc", "fs")
    x, z, c, s, ht, hb, bl, br, t, fc, fs = (drum[name][:, lane] for name in names)
    c_face, s_face = c * fc - s * fs, s * fc + c * fs
    slope = math.tan(column.as_found.base_tilt * DEGREE)
    plumb = x - z * slope  # places seen along gravity
    for j in range(column.n):
        mass = column.masses[j:]
        centroid = float(mass @ plumb[j + 1 :] / mass.sum())
        cf, sf = c_face[j], s_face[j]
        dx, dz = x[j + 1] - x[j], z[j + 1] - z[j]
        cosine, sine = c[j + 1] * cf + s[j + 1] * sf, s[j + 1] * cf - c[j + 1] * sf
        foot = cf * dx + sf * dz + sine * hb[j + 1]
        low = max(foot - bl[j + 1] * cosine, -t[j])
        high = min(foot + br[j + 1] * cosine, t[j])
        left, right = ((x[j] + cf * end - sf * ht[j]) - (z[j] + sf * end + cf * ht[j]) * slope for end in (low, high))
        if not left < centroid < right:
            return False
    return True


def flat_barrier(column: Column, flat: Geometry, toes: np.ndarray) -> float:
    """Lowest barrier of the column with its drums flat on one another, each with its offset [J]; 0 if none is left."""
    down = gravity_vector(column)
    up = -down / column.gravity
    slope = flat.lean + column.as_found.base_tilt * DEGREE
    friction = np.array(
        [math.tan(max(math.atan(rough) - abs(one), 0.0)) for rough, one in zip(column.friction, slope, strict=True)]
    )
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        centroid = mass @ flat.centroid[j:] / mass.sum()
        arms = [centroid - flat.end(j, side) for side in (-1, 1)]
        # across gravity, from the left and to the right end, and along it
        inside = [arms[0][0] * up[1] - arms[0][1] * up[0], arms[1][1] * up[0] - arms[1][0] * up[1]]
        near = int(np.argmin(inside))
        half, height = float(inside[near]), float(arms[near] @ up)
        if half <= 0.0:
            return 0.0
        radius = math.hypot(half, height)
        # sliding on the base takes no support away: joints between drums count
        loose = friction[max(j, 1) :].min(initial=math.inf)
        slides = loose < half / radius
        rise = loose * half - height * (1.0 - math.sqrt(1.0 - loose * loose)) if slides else radius - height
        barrier = column.gravity * float(mass.sum()) * rise - given_by_toes(column, toes, j, half, height)
        lowest = min(lowest, barrier)
    return lowest
