"""How far a joint in space has slipped: read where its faces are closest, so that a drum that only leans has not slipped."""

from __future__ import annotations

import numpy as np

from ...kernels.dem3d.records import CHIPS


def slips_where_closest(
    drum: np.ndarray, lane: int, middles: np.ndarray, twists: np.ndarray, chips: np.ndarray
) -> np.ndarray:
    """Slip of every joint in the axes of the drum below, at the place where its two faces are closest [m], shape (n, 2).

    The middle of a face that leans about its rim moves sideways by R (1 - cos θ), and nothing has slipped: what counts is
    where the upper drum's stone is that was pressed there: on a chip the end of its chord. A closed joint has the offset of
    its middles.

    Parameters
    ----------
    drum : array
        Records of the drums, the base first (legend of the kernels).
    lane : int
    middles : array
        Middle of each upper face along the face below [m], shape (n, 2).
    twists : array
        Turn of each upper drum about the joint's normal [rad], shape (n,).
    chips : array
        What chips have taken of the joints' upper faces (legend of the kernels), shape (n, 6); of one column without chips.
    """
    u, v = drum[1:], drum[:-1]

    def vectors(records: np.ndarray, names: str) -> np.ndarray:
        return np.stack([records[name][..., lane] for name in names.split()], axis=-1)

    # axes of each upper drum as columns, in those of the lower one
    upper, lower = (np.stack([vectors(one, f"{a}x {a}y {a}z") for a in "ijk"], axis=1) for one in (u, v))
    turn = lower @ upper.transpose(0, 2, 1)
    normal = (turn @ vectors(u, "nx ny nz")[:, :, None])[:, :, 0]
    foot = (vectors(u, "fx fy fz")[:, None, :] @ upper)[:, 0]
    middle = (lower @ (vectors(u, "x y z") + foot - vectors(v, "x y z"))[:, :, None])[:, :, 0]
    middle[:, 2] -= v["ht"][:, lane]
    n = len(middle)
    cornered = u["px"].shape[1] > 1
    if cornered:
        places = middle[:, None] + vectors(u, "px py pz") @ turn.transpose(0, 2, 1)
        ends = vectors(v, "tx ty")[:, None]
        inside = (np.abs(places[..., :2]) < ends).all(axis=-1)
        places[..., 2] *= inside
        places[..., :2] = np.clip(places[..., :2], -ends, ends)
    else:
        sine = np.hypot(normal[:, 0], normal[:, 1])
        flat = sine == 0.0
        each = 1.0 / np.where(flat, 1.0, sine)
        h = np.stack((np.where(flat, 1.0, normal[:, 0] * each), normal[:, 1] * each, np.zeros(n)), axis=1)
        down = np.stack((normal[:, 2] * h[:, 0], normal[:, 2] * h[:, 1], -sine), axis=1)
        if chips.shape[1] == CHIPS:
            toward = (turn @ chips[:, :3, None])[:, :, 0]
            beside = np.cross(normal, toward)
            side = np.where((down * beside).sum(axis=1) < 0.0, -1.0, 1.0)
            end = chips[:, 4, None] * toward + (side * chips[:, 5])[:, None] * beside
            down = np.where((down * toward).sum(axis=1, keepdims=True) > chips[:, 4, None], end, down)
        places = np.stack((middle + u["rb"][:, lane, None] * down, v["rt"][:, lane, None] * h), axis=1)
        inside = np.array([True, False])
    gaps = np.where(inside, places[..., 2], ((middle[:, None] - places) @ normal[:, :, None])[..., 0])
    # of the ends of two discs the one that lies over the other disc touches: it is the less deep of the two
    place = places[np.arange(n), gaps.argmin(axis=1) if cornered else gaps.argmax(axis=1)]
    stone = ((place - middle)[:, None, :] @ turn)[:, 0]
    c, s = np.cos(twists), np.sin(twists)
    moved = np.stack((c * stone[:, 0] - s * stone[:, 1], s * stone[:, 0] + c * stone[:, 1]), axis=1)
    return place[:, :2] - moved
