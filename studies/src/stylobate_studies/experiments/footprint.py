"""The footprint of a boulder from several scans of one form: brought into one frame, and their weighted mean as a body.

A scan is the stone's surface with noise. The hull of a noisy surface rests on its farthest peaks: its resting face and the
steps of its rocking are too large, and noise that is put on top makes them larger still. Bodies are therefore averaged, by
their support functions (Minkowski's mean), in which what is in one scan alone shrinks; the share of each scan is drawn
evenly among all shares (a Bayesian bootstrap), which says how much the mean itself is unknown.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from .granite_files import Scan

#: Directions over the sphere in which two scans are compared.
COMPARED = 3000

#: Distances between scans beyond which one counts ever less: scans differ at broken edges [m].
BROKEN = 2e-3

#: Directions of a mean's vertices: rings from straight down [°], directions in each, and those over the whole sphere.
RINGS, FARTHEST, AROUND, COARSE = 60, 70.0, 90, 400


def sphere(count: int) -> np.ndarray:
    """So many directions, evenly over the sphere (Fibonacci's spiral), shape (count, 3)."""
    k = np.arange(count) + 0.5
    z, azimuth = 1.0 - 2.0 * k / count, k * math.pi * (3.0 - math.sqrt(5.0))
    level = np.sqrt(1.0 - z * z)
    return np.stack((level * np.cos(azimuth), level * np.sin(azimuth), z), axis=1)


def directions() -> np.ndarray:
    """Directions in which a mean gets its vertices, the denser the nearer to straight down, shape (k, 3)."""
    return np.concatenate((downwards(np.geomspace(0.1, FARTHEST, RINGS), AROUND), sphere(COARSE)))


def downwards(tilts: np.ndarray, around: int) -> np.ndarray:
    """Directions at some angles from straight down [°], so many all round at each, shape (k, 3)."""
    tilt, azimuth = np.radians(tilts)[:, None], 2.0 * math.pi * np.arange(around) / around
    x, y = np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth)
    return np.stack((x, y, np.broadcast_to(-np.cos(tilt), x.shape)), axis=-1).reshape(-1, 3)


def support(vertices: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Reach of a body in some directions [m]."""
    return (along @ vertices.T).max(axis=1)


@lru_cache(maxsize=16)
def registered(scan: Scan, reference: Scan) -> Scan:
    """A scan in the frame of another one of the same form: the rotation and the shift that bring their hulls together."""
    if scan is reference:
        return scan
    turn, shift = _brought(scan.vertices, reference.vertices)
    return replace(scan, vertices=scan.vertices @ turn.T + shift, inertia=turn @ scan.inertia @ turn.T, centroid=shift)


def _brought(vertices: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and shift [m] of a body onto another, by robust least squares of their support functions."""
    from scipy.optimize import least_squares
    from scipy.spatial.transform import Rotation

    along = sphere(COMPARED)
    there = support(reference, along)

    def apart(q: np.ndarray) -> np.ndarray:
        return support(vertices @ Rotation.from_rotvec(q[:3]).as_matrix().T + q[3:], along) - there

    solution = least_squares(apart, np.zeros(6), loss="soft_l1", f_scale=BROKEN).x
    return Rotation.from_rotvec(solution[:3]).as_matrix(), solution[3:]


def mean_of(scans: Sequence[Scan], weights: Sequence[float]) -> Scan:
    """Minkowski's mean of scans in one frame with weights that sum to 1, about its centroid; name and mass of the first."""
    along = directions()
    vertices = sum(w * scan.vertices[np.argmax(along @ scan.vertices.T, axis=1)] for w, scan in zip(weights, scans))
    centroid = sum(w * scan.centroid for w, scan in zip(weights, scans))
    inertia = sum(w * scan.inertia for w, scan in zip(weights, scans))
    return replace(
        scans[0],
        vertices=np.unique(np.asarray(vertices - centroid), axis=0),
        inertia=np.asarray(inertia),
        centroid=np.zeros(3),
    )


def worn(scan: Scan, radius: float) -> Scan:
    """A scan whose edges and corners are worn round: all that a ball of this radius [m] reaches from within.

    The body of an opening: its faces moved inward by the radius, and the ball carried along what is left.
    """
    from scipy.spatial import ConvexHull, HalfspaceIntersection

    faces = ConvexHull(scan.vertices).equations.copy()
    faces[:, 3] += radius
    inner = HalfspaceIntersection(faces, np.zeros(3)).intersections
    along = np.concatenate((downwards(np.geomspace(0.3, FARTHEST, 14), 24), sphere(100)))
    reached = inner[np.argmax(along @ inner.T, axis=1)] + radius * along
    return replace(scan, vertices=np.unique(reached.round(9), axis=0))
