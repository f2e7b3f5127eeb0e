"""How far a joint in space has slipped: read where its faces are closest, so that a drum that only leans has not slipped."""

from __future__ import annotations

import numpy as np


def slips_where_closest(drum: np.ndarray, lane: int, middles: np.ndarray, twists: np.ndarray) -> np.ndarray:
    """Slip of every joint in the axes of the drum below, at the place where its two faces are closest [m], shape (n, 2).

    The middle of a face that leans about its rim moves sideways by R (1 - cos θ), and nothing has slipped: what counts is
    where the upper drum's stone is that was pressed there. A closed joint has the offset of its middles.

    Parameters
    ----------
    drum : array
        Records of the drums, the base first (legend of the kernels).
    lane : int
    middles : array
        Middle of each upper face along the face below [m], shape (n, 2).
    twists : array
        Turn of each upper drum about the joint's normal [rad], shape (n,).
    """
    slips = middles.copy()
    for j, twist in enumerate(twists):
        slips[j] = _slip(drum, lane, j, float(twist))
    return slips


def _slip(drum: np.ndarray, lane: int, j: int, twist: float) -> np.ndarray:
    u, v = drum[j + 1], drum[j]

    def vector(record: np.void, names: str) -> np.ndarray:
        return np.array([record[name][..., lane] for name in names.split()])

    upper, lower = (np.stack([vector(record, f"{a}x {a}y {a}z") for a in "ijk"]) for record in (u, v))
    turn = lower @ upper.T  # axes of the upper drum as columns, in those of the lower one
    normal = turn @ vector(u, "nx ny nz")
    foot = vector(u, "fx fy fz")
    middle = lower @ (vector(u, "x y z") + foot @ upper - vector(v, "x y z")) - (0.0, 0.0, v["ht"][lane])
    cornered = u["px"].shape[0] > 1
    if cornered:
        places = middle + (turn @ vector(u, "px py pz")).T
        ends = vector(v, "tx ty")
        inside = (np.abs(places[:, :2]) < ends).all(axis=1)
        places[:, 2] *= inside
        places[:, :2] = np.clip(places[:, :2], -ends, ends)
    else:
        sine = float(np.hypot(normal[0], normal[1]))
        h = np.array([normal[0] / sine, normal[1] / sine, 0.0]) if sine > 0.0 else np.array([1.0, 0.0, 0.0])
        down = np.array([normal[2] * h[0], normal[2] * h[1], -sine])
        places = np.stack((middle + u["rb"][lane] * down, v["rt"][lane] * h))
        inside = np.array([True, False])
    gaps = np.where(inside, places[:, 2], (middle - places) @ normal)
    # of the ends of two discs the one that lies over the other disc touches: it is the less deep of the two
    place = places[int(gaps.argmin() if cornered else gaps.argmax())]
    stone = turn.T @ (place - middle)
    c, s = np.cos(twist), np.sin(twist)
    return place[:2] - (c * stone[0] - s * stone[1], s * stone[0] + c * stone[1])
