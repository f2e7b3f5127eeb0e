"""What became of each body of an assembly: its tilt, whether, when and to which side it fell, where it is at the end."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from ..outcome import SHIFT_RATIO
from .measures import BodyMeasures

#: A body that fell with its centroid nearly over its place, to this share of its size, fell to no side.
STRAIGHT_DOWN = 0.01


def body_measures(
    names: Sequence[str],
    sizes: Sequence[float],
    time: np.ndarray,
    position: np.ndarray,
    tilt: np.ndarray,
    since: dict[int, int],
    shifted: Iterable[int],
) -> tuple[BodyMeasures, ...]:
    """Measures of the bodies that can move.

    Parameters
    ----------
    names, sizes
        Of all bodies; the size of one that cannot move is NaN [m].
    time : array
        [s], shape (T,)
    position, tilt : array
        Centroids [m], shape (T, N, 3), and turns since the start of what was vertical [rad], shape (T, N).
    since : dict of int to int
        Recorded state from which on a body had fallen, by its number.
    shifted : iterable of int
        Bodies that are shifted at the end, by their numbers; none where not all lies still then.
    """
    found, out_of_place = [], set(shifted)
    for i, (name, size) in enumerate(zip(names, sizes, strict=True)):
        if math.isnan(size):
            continue
        fell, azimuth = since.get(i), None
        if fell is not None:
            x, y = (position[fell, i] - position[0, i])[:2]
            azimuth = math.atan2(y, x) if math.hypot(x, y) > STRAIGHT_DOWN * size else None
        x, y, z = (float(one) for one in position[-1, i] - position[0, i])
        found.append(
            BodyMeasures(
                name,
                float(np.nanmax(tilt[:, i], initial=0.0)),
                None if fell is None else float(time[fell]),
                azimuth,
                (x, y, z),
                fell is None and i in out_of_place,
            )
        )
    return tuple(found)


def azimuth_of_fall(bodies: Iterable[BodyMeasures], fell_at: Sequence[tuple[str, float]]) -> float | None:
    """Side to which the first body fell [rad]; None where none fell, or straight down."""
    first = next((name for name, _ in fell_at), None)
    return next((body.fall_azimuth for body in bodies if body.name == first), None)


def shifted_bodies(
    joints: Sequence[tuple[int, int]], slip: np.ndarray, moved: np.ndarray, free: Sequence[int], free_shares: np.ndarray
) -> set[int]:
    """Bodies that are shifted: by a joint the one of its two bodies that moved more, and what no joint holds by itself.

    Parameters
    ----------
    joints : sequence of (int, int)
        Bodies of each joint.
    slip : array
        Residual slip of each joint over its width [-], shape (J,).
    moved : array
        Of each body at the end [m], shape (N,).
    free : sequence of int
        Bodies that no joint holds.
    free_shares : array
        Their way at the end over their size [-].
    """
    by_joints = {
        max(pair, key=lambda i: moved[i]) for pair, share in zip(joints, slip, strict=True) if not share <= SHIFT_RATIO
    }
    return by_joints | {i for i, share in zip(free, free_shares, strict=True) if not share <= SHIFT_RATIO}
