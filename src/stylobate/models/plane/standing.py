"""Does a column that stands now stand for good? What the energy that is left in it could still do."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.found_geometry import geometry, gravity_vector
from ...constants import DEGREE
from ..drums.barriers import flat_barrier
from .block import Records


def stands_for_good(
    column: Column, records: Records, lane: int, slip: np.ndarray, energy: float, toes: np.ndarray
) -> bool:
    """Whether a column that no input shakes any more can neither overturn nor slide apart.

    Parameters
    ----------
    column : Column
    records : Records
        In which the column is.
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
    if not _centroids_inside(column, records, lane):
        return False
    offsets = np.array([column.as_found.of(i + 1).offset for i in range(column.n)]) + slip
    flat = geometry(column, offsets)
    # what sliding down a slope has set free is not there any more to fall back on
    lower = float(column.masses @ ((flat.centroid - geometry(column).centroid) @ gravity_vector(column)))
    return energy + max(lower, 0.0) < flat_barrier(column, flat, toes)


def _centroids_inside(column: Column, records: Records, lane: int) -> bool:
    """Whether the centroid of every part stands within its contact, seen along gravity."""
    x, z, c, s = (records.body[name][:, lane] for name in ("x", "z", "c", "s"))
    names = ("ht", "wl", "wr", "lc", "ls", "hb", "bl", "br")
    ht, wl, wr, lc, ls, hb, bl, br = (records.joint[name][:, lane] for name in names)
    slope = math.tan(column.as_found.base_tilt * DEGREE)
    plumb = x - z * slope  # places seen along gravity
    for j in range(column.n):
        mass = column.masses[j:]
        centroid = float(mass @ plumb[j + 1 :] / mass.sum())
        cf, sf = c[j] * lc[j] - s[j] * ls[j], s[j] * lc[j] + c[j] * ls[j]
        dx, dz = x[j + 1] - x[j], z[j + 1] - z[j]
        cosine, sine = c[j + 1] * cf + s[j + 1] * sf, s[j + 1] * cf - c[j + 1] * sf
        foot = cf * dx + sf * dz + sine * hb[j]
        low = max(foot - bl[j] * cosine, -wl[j])
        high = min(foot + br[j] * cosine, wr[j])
        left, right = ((x[j] + cf * end - sf * ht[j]) - (z[j] + sf * end + cf * ht[j]) * slope for end in (low, high))
        if not left < centroid < right:
            return False
    return True
