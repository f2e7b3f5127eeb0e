"""Faces at which bodies are joined, in the plane: where each is on its body, and which two make a joint."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .joint import Joint


class Face(NamedTuple):
    """A face, in axes along the lower face of its body if that is a drum, in those in which it is drawn if it is a block.

    ``direction`` (cosine and sine) runs to the right with the joint's normal upward, ``height`` is from the body's centroid
    along that normal, without its sign; ``left`` and ``right`` are how far the ends are from the centroid's foot [m].
    """

    direction: tuple[float, float]
    height: float
    left: float
    right: float

    @property
    def width(self) -> float:
        """[m]"""
        return self.left + self.right


class FacePair(NamedTuple):
    """A joint: the upper face of the body ``lower`` and the lower face of the body ``upper``, by their numbers.

    ``area`` [m²] is that of the contact over a ``width`` [m] of it, so that stiffnesses per area become those per width.
    ``sides`` are the faces among the sides of the polygons of the two bodies, by the number of the corner they start at.
    """

    lower: int
    upper: int
    below: Face
    above: Face
    law: Joint
    area: float
    width: float
    sides: tuple[int, int]


def face_between(left: np.ndarray, right: np.ndarray, origin: tuple[float, float], *, upper: bool) -> Face:
    """The face between two points of a body as it stands [m], shape (2,), from the left to the right one.

    Parameters
    ----------
    left, right : array
    origin : (float, float)
        Of the body [m].
    upper : bool
        Whether it is the upper face of its body.
    """
    length = math.hypot(*(right - left))
    t, foot = (right - left) / length, left - origin
    height, before = float(foot[1] * t[0] - foot[0] * t[1]), -float(foot @ t)
    return Face((float(t[0]), float(t[1])), height if upper else -height, before, length - before)


class Bed(NamedTuple):
    """Faces that lie on one another.

    Parameters
    ----------
    lower, upper : int
        Bodies by number.
    rise : float
        Upward component of the unit normal from the one into the other [-].
    corners : array
        In plan; of a plane along it [m], shape (k, 1 or 2).
    level : float
        Height of the faces [m].
    area : float
        [m²]
    law : Joint
    round : bool
        Whether a circle bounds it.
    """

    lower: int
    upper: int
    rise: float
    corners: np.ndarray
    level: float
    area: float
    law: Joint
    round: bool = False
