"""Links of an assembly in space at their places, and whether they can be there: ends in bodies, joints, clear ways, legs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import InputError
from ..found_geometry import inside
from ..links.in_assembly import BESIDE, BRACKET, LOOKS, bodies_named, placed_between
from ..links.link import Link
from ..links.placed import GROOVE, RIM, STROKE, PlacedLink, Point, place_all
from ..structure import Body
from ..turning import UPRIGHT
from .touching import Solid, SpaceJoint

Frame = tuple[Point, Point, Point]


def place_in_space(
    bodies: Sequence[Body],
    solids: Sequence[Sequence[Solid]],
    joints: Sequence[SpaceJoint],
    ground: float | None,
    links: Sequence[Link],
    name: str,
) -> tuple[PlacedLink, ...]:
    """All links of an assembly in space of this name, each already in numbers, in their order.

    Parameters
    ----------
    bodies : sequence of Body
        The ground, if there is one, and the stones.
    solids : sequence of sequence of Solid
        Parts of each of the bodies as they stand; none of the ground.
    joints : sequence of SpaceJoint
    ground : float or None
        Its level [m].
    links : sequence of Link
    name : str

    Raises
    ------
    InputError
        A link that cannot be: one sentence that names it, the value and what is allowed.
    """
    scene = _Scene(bodies, solids, joints, ground)
    return place_all(links, name, scene.placed)


class _Scene:
    """Bodies in space, their parts and their joints, among which links find their places."""

    def __init__(
        self,
        bodies: Sequence[Body],
        solids: Sequence[Sequence[Solid]],
        joints: Sequence[SpaceJoint],
        ground: float | None,
    ) -> None:
        self.bodies, self.solids, self.joints, self.ground = bodies, solids, joints, ground

    def placed(self, link: Link) -> PlacedLink:
        """A link with its place."""
        lower, upper = bodies_named(link, self.bodies)
        for end, given in zip(("at", "to"), link.ends, strict=True):
            if given is not None and len(given) != 3:
                raise InputError(
                    f"{end} of a {link.kind} is {list(given)} among bodies in space; give three numbers, [x, y, z] in m.",
                    end,
                )
        frame: Frame = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        edge = math.inf
        if link.lies == "joint":
            lower, upper, low, frame, edge = self._in_joint(link, lower, upper)
            high = low
        else:
            low, high = self._ends(link, lower, upper)
        if link.lies == "side":
            frame = _along(low, high)
            self._check_legs(link, lower, upper, low, high)
        ends = lower, upper
        origins, turns = ([where(self.bodies[i]) for i in ends] for where in (self._origin, _turn))
        return placed_between(
            link, lower, upper, low, high, edge, origins=tuple(origins), turns=tuple(turns), frame=frame,
            stroke=STROKE * self._along(upper, frame[2]),
        )  # fmt: skip

    def _origin(self, body: Any) -> Point:
        return getattr(body, "position", (0.0, 0.0, self.ground or 0.0))

    def _along(self, body: int, way: Point) -> float:
        """How far a body reaches along a direction [m]; 0 of a ground without ends."""
        ways = np.outer((1.0, -1.0), way)
        return (
            float(np.max([part.extent(ways) for part in self.solids[body]], axis=0).sum()) if self.solids[body] else 0.0
        )

    def _depth(self, body: int, points: np.ndarray) -> np.ndarray:
        """Depth of points in a body [m], shape (m, 3) to (m,); negative outside, as far as they are beyond its faces."""
        if not self.solids[body]:
            assert self.ground is not None
            return self.ground - points[:, 2]
        return np.max([part.depth(points) for part in self.solids[body]], axis=0)

    def _ends(self, link: Link, lower: int, upper: int) -> tuple[Point, Point]:
        """Ends of a clamp, tie or core as drawn [m]."""
        low, high = (_three(end) for end in link.ends)
        far = BRACKET if link.lies == "line" else 0.0
        for body, end, name in ((lower, low, "at"), (upper, high, "to")):
            outside = -float(self._depth(body, np.array([end]))[0])
            if outside > far + 1e-6 * min(self.bodies[body].size, 1.0):
                within = f"within {far:g} m of it" if far else "in it"
                raise InputError(
                    f"{name} of a {link.kind} is {_point(end)}, {outside:.3g} m outside block {self.bodies[body].name!r}; "
                    f"its end must be {within}.",
                    name,
                )
        if not getattr(link, "through_stone", False):
            self._check_way(link, lower, upper, low, high)
        return low, high

    def _check_way(self, link: Link, lower: int, upper: int, low: Point, high: Point) -> None:
        """Refuse a line through stone; a clamp lies in its two bodies."""
        points = np.linspace(low, high, LOOKS + 1)
        first, last = points.min(axis=0), points.max(axis=0)
        for i, parts in enumerate(self.solids):
            if link.lies == "side" and i in (lower, upper):
                continue
            near = [one for one in parts if (one.low < last).all() and (one.high > first).all()]
            if parts and not near:
                continue
            deep = self._depth(i, points)
            worst = int(deep.argmax())
            if deep[worst] > GROOVE:
                remedy = (
                    f"a {link.kind} lies in two blocks only"
                    if link.lies == "side"
                    else "move it beyond the face, or make it a core"
                )
                raise InputError(
                    f"a {link.kind} passes through stone: {1000.0 * deep[worst]:.3g} mm inside block "
                    f"{self.bodies[i].name!r} at {_point(points[worst])}; {remedy}."
                )

    def _in_joint(self, link: Any, one: int, other: int) -> tuple[int, int, Point, Frame, float]:
        """Lower and upper body, place [m], axes of the joint and distance from its nearest edge [m] of a dowel, bar, layer
        or pad."""
        joint, place = self._joint_for(link, one, other)
        local = joint.frame.T @ (place - joint.origin)
        deep = inside(joint.edges, local[:2])
        if deep < 0.0:
            raise InputError(
                f"a {link.kind} at {_point(place)} is outside the section, by {-deep:.3g} m; move it inward.", "at"
            )
        left = deep - 0.5 * link.numbers.diameter
        looked_at = link.numbers.edge < math.inf  # in the column that brings it along
        if link.numbers.diameter and left < RIM and not looked_at:
            raise InputError(
                f"a {link.kind} at {_point(place)} leaves {1000.0 * left:.3g} mm of stone to the rim; at least "
                f"{1000.0 * RIM:g} mm must be left: move it inward or make it thinner.",
                "at",
            )
        lift, normal = link.numbers.lift, joint.frame[:, 2]
        for body, part in ((joint.lower, joint.lower_part), (joint.upper, joint.upper_part)):
            if self.bodies[body].fixed or not link.numbers.diameter or looked_at:
                continue
            tall = float(self.solids[body][part].extent(np.array([normal, -normal])).sum())
            if tall < lift < math.inf:
                raise InputError(
                    f"a {link.kind} is embedded by {lift:g} m, and block {self.bodies[body].name!r} is {tall:.4g} m high "
                    "there; make it shorter.",
                    "embedment",
                )
        link.check_joint(joint.law)
        i, j, k = (_three(axis) for axis in joint.frame.T)
        edge = link.numbers.edge if looked_at else deep
        return joint.lower, joint.upper, _three(place - local[2] * normal), (i, j, k), edge

    def _joint_for(self, link: Any, one: int, other: int) -> tuple[SpaceJoint, np.ndarray]:
        """The joint of two bodies in which a link is, and its place as given, or its middle [m]."""
        shared = [joint for joint in self.joints if {joint.lower, joint.upper} == {one, other}]
        names = f"{link.between[0]!r} and {link.between[1]!r}"
        if not shared:
            raise InputError(
                f"{names} have no joint for a {link.kind}; name two blocks whose faces touch, or make it a clamp or a tie.",
                "between",
            )
        if link.at is None:
            if len(shared) > 1 and link.law != "pad":  # a pad covers them all
                raise InputError(
                    f"{names} touch with {len(shared)} pairs of faces; give the place of a {link.kind}, at = [x, y, z].",
                    "at",
                )
            return shared[0], shared[0].origin
        place = np.array(link.at)
        local = [joint.frame.T @ (place - joint.origin) for joint in shared]
        off = [abs(float(seen[2])) for seen in local]
        if min(off) > BESIDE:
            raise InputError(
                f"a {link.kind} at {_point(place)} is {min(off):.3g} m from the joint of {names}; give a place in it, or "
                "leave at out for its middle.",
                "at",
            )
        near = [k for k, way in enumerate(off) if way <= BESIDE]
        return shared[max(near, key=lambda k: inside(shared[k].edges, local[k][:2]))], place

    def _check_legs(self, link: Any, lower: int, upper: int, low: Point, high: Point) -> None:
        """Refuse legs that are longer than the parts of stone that they are in are thick."""
        legs = link.numbers.lift
        for body, end in ((lower, low), (upper, high)):
            if self.bodies[body].fixed or not math.isfinite(legs):
                continue
            part = max(self.solids[body], key=lambda one: float(one.depth(np.array([end]))[0]))
            thick = part.thickness
            if thick < legs:
                raise InputError(
                    f"legs of a {link.kind} are {legs:g} m long, and block {self.bodies[body].name!r} is {thick:.4g} m "
                    "thick; make them shorter.",
                    "legs",
                )


def _turn(body: Any) -> Any:
    return getattr(body, "orientation", UPRIGHT)


def _along(low: Point, high: Point) -> Frame:
    """Axes of a clamp: across it twice, the first level where there is such, and along it."""
    way = np.subtract(high, low) / math.dist(low, high)
    level = np.array([way[1], -way[0], 0.0]) if math.hypot(way[0], way[1]) > 1e-6 else np.array([1.0, 0.0, 0.0])
    first = level - (level @ way) * way
    first = first / np.linalg.norm(first)
    return _three(first), _three(np.cross(way, first)), _three(way)


def _three(place: Any) -> Point:
    x, y, z = (float(one) for one in place)
    return x, y, z


def _point(place: Any) -> str:
    return f"[{', '.join(f'{one:.4g}' for one in place)}] m"
