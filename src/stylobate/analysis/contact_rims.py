"""What joins bodies in programmes of contacts in space: rims of overlaps, and what holds with a bounded force."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..column.found_geometry import Edges


@dataclass(frozen=True, eq=False)
class Holder:
    """Holder of two bodies with a bounded force: a link, or the cohesion of a joint.

    Bodies are those of the programme by number, −1 what moves with the ground. Points are places in space of the upper and
    the lower end, ``axes`` the directions of the force on the upper body as columns: two of them for every direction
    between, or one that is pulled along only.
    """

    name: str
    action: str
    upper: int
    lower: int
    high: np.ndarray
    low: np.ndarray
    axes: np.ndarray
    capacity: float


@dataclass(frozen=True, eq=False)
class Rim:
    """The rim of a joint's overlap, seen from a place within it.

    ``frame`` has two directions along the joint and its normal into the body ``upper`` as columns, ``edges`` bound the
    overlap from ``origin`` [m], and so is ``middle``; ``half`` is half of its width [m].
    """

    upper: int
    lower: int
    frame: np.ndarray
    origin: np.ndarray
    edges: Edges
    middle: np.ndarray
    half: float
    friction: float
    cohesion: float = 0.0

    @property
    def held(self) -> Holder:
        """Its cohesion, as what holds at its middle."""
        place = self.in_space(self.middle)
        return Holder("", "shear", self.upper, self.lower, place, place, self.frame[:, :2], self.cohesion)

    @cached_property
    def corners(self) -> np.ndarray | None:
        """Places of its corners where no arc bounds it [m], shape (k, 2): what is linear is least at one of them."""
        if self.edges.discs:
            return None
        found = []
        for i, (one, bound) in enumerate(self.edges.sides):
            for other, limit in self.edges.sides[:i]:
                across = one[0] * other[1] - one[1] * other[0]
                if abs(across) > 1e-9:
                    place = np.array([bound * other[1] - limit * one[1], limit * one[0] - bound * other[0]]) / across
                    if all(normal @ place <= end + 1e-9 * self.half for normal, end in self.edges.sides):
                        found.append(place)
        kept: list[np.ndarray] = []
        for place in found:
            if all(math.dist(place, one) > 1e-6 * self.half for one in kept):
                kept.append(place)
        return np.array(kept)

    def places(self, angle: np.ndarray) -> np.ndarray:
        """Places of the rim in these directions from the middle, along the joint [m], shape (…, 2)."""
        way = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
        reach = np.full(np.shape(angle), math.inf)
        for centre, radius in self.edges.discs:
            off = self.middle - centre
            along = way @ off
            reach = np.minimum(reach, np.sqrt(along * along + radius * radius - off @ off) - along)
        for normal, bound in self.edges.sides:
            toward = way @ normal
            with np.errstate(divide="ignore"):
                reach = np.minimum(
                    reach,
                    np.where(toward > 1e-12, (bound - normal @ self.middle) / np.maximum(toward, 1e-300), math.inf),
                )
        return self.middle + reach[..., None] * way

    def in_space(self, place: np.ndarray) -> np.ndarray:
        """A place of the joint in space [m]."""
        return self.origin + self.frame[:, :2] @ place

    def force(self, way: np.ndarray) -> np.ndarray:
        """A unit of pressure with all its friction in a direction, on the upper body."""
        return self.frame @ (*(self.friction * way), 1.0)
