"""Links of an assembly in space: where among its bodies, their parts and their joints they are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import InputError
from ..found_geometry import inside
from ..links.link import Link
from ..links.placed import BESIDE, Frame, JointPlace, PlacedLink, Point, Scene, beside_joint, no_joint
from ..shapes import UPRIGHT, Quaternion
from .touching import Solid, SpaceJoint


class SpaceScene(Scene):
    """Bodies in space, their parts and their joints.

    Parameters
    ----------
    bodies : sequence of Body
        The ground, if there is one, and the stones.
    joints : sequence of SpaceJoint
    solids : sequence of sequence of Solid
        Parts of each of the bodies as they stand; none of the ground.
    ground : float or None
        Its level [m].
    """

    def __init__(
        self, bodies: Sequence[Any], joints: Sequence[Any], solids: Sequence[Sequence[Solid]], ground: float | None
    ) -> None:
        super().__init__(bodies, joints)
        self.solids, self.ground = solids, ground

    def place(self, link: Link) -> PlacedLink:
        """A link whose ends, where they are given, have three numbers."""
        for end, given in zip(("at", "to"), link.ends, strict=True):
            if given is not None and len(given) != 3:
                raise InputError(
                    f"{end} of a {link.kind} is {list(given)} among bodies in space; give three numbers, [x, y, z] in m.",
                    end,
                )
        return super().place(link)

    def shown(self, place: Any) -> str:
        """x, y and z."""
        return f"[{', '.join(f'{coordinate:.4g}' for coordinate in place)}] m"

    def depth(self, body: int, points: np.ndarray, *, whole: bool) -> np.ndarray:
        """In the part in which the points are deepest."""
        if not self.solids[body]:
            assert self.ground is not None
            return self.ground - points[:, 2]
        return np.max([part.depth(points) for part in self.solids[body]], axis=0)

    def near(self, body: int, low: np.ndarray, high: np.ndarray) -> bool:
        """By the boxes around its parts."""
        parts = self.solids[body]
        return not parts or any((part.low < high).all() and (part.high > low).all() for part in parts)

    def joint_place(self, link: Any, first: int, other: int) -> JointPlace:
        """In the pair of faces in which the given place is deepest; in the middle of the only one where none is given."""
        every: Sequence[SpaceJoint] = self.joints  # pyright: ignore[reportAssignmentType]
        shared = [joint for joint in every if {joint.lower, joint.upper} == {first, other}]
        if not shared:
            raise no_joint(link)
        joint = shared[0]
        place = joint.origin
        if link.at is None and len(shared) > 1 and link.law != "pad":  # a pad covers them all
            raise InputError(
                f"{link.between[0]!r} and {link.between[1]!r} touch with {len(shared)} pairs of faces; give the place of a "
                f"{link.kind}, at = [x, y, z].",
                "at",
            )
        if link.at is not None:
            place = np.array(link.at)
            local = [joint.frame.T @ (place - joint.origin) for joint in shared]
            off = [abs(float(seen[2])) for seen in local]
            if min(off) > BESIDE:
                raise beside_joint(link, self.shown(place), min(off))
            near = [k for k, way in enumerate(off) if way <= BESIDE]
            joint = shared[max(near, key=lambda k: inside(shared[k].edges, local[k][:2]))]
        x, y, off = joint.frame.T @ (place - joint.origin)
        normal, deep = joint.frame[:, 2], inside(joint.edges, np.array([x, y]))
        tall = [
            float(self.solids[body][part].extent(np.array([normal, -normal])).sum()) if self.solids[body] else math.inf
            for body, part in ((joint.lower, joint.lower_part), (joint.upper, joint.upper_part))
        ]
        frame: Any = tuple(map(_three, joint.frame.T))
        ends = joint.lower, joint.upper
        return JointPlace(*ends, _three(place - off * normal), frame, deep, deep, (tall[0], tall[1]), joint.law)

    def clamp_frame(self, link: Link, low: Point, high: Point) -> Frame:
        """Across it twice, the first level where there is such, and along it."""
        way = np.subtract(high, low) / math.dist(low, high)
        level = np.array([way[1], -way[0], 0.0]) if math.hypot(way[0], way[1]) > 1e-6 else np.array([1.0, 0.0, 0.0])
        first = level - (level @ way) * way
        first = first / np.linalg.norm(first)
        return _three(first), _three(np.cross(way, first)), _three(way)

    def thickness(self, body: int, place: Point) -> float:
        """Of the part in which the place is deepest."""
        return max(self.solids[body], key=lambda part: float(part.depth(np.array([place]))[0])).thickness

    def pose(self, body: int) -> tuple[Point, Quaternion]:
        """As it stands."""
        placed_body: Any = self.bodies[body]
        return getattr(placed_body, "position", (0.0, 0.0, self.ground or 0.0)), getattr(
            placed_body, "orientation", UPRIGHT
        )

    def reach(self, body: int, way: Point) -> float:
        """From end to end of its parts; 0 of a ground without ends."""
        ways = np.outer((1.0, -1.0), way)
        return (
            float(np.max([part.extent(ways) for part in self.solids[body]], axis=0).sum()) if self.solids[body] else 0.0
        )


def _three(place: Any) -> Point:
    x, y, z = (float(coordinate) for coordinate in place)
    return x, y, z
