"""Links of an assembly at their places, and whether they can be there: ends in bodies, joints, clear ways, legs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, suggest
from ...messages import say
from ..block import Block, FaceJoint
from ..joint import Joint
from ..turning import UPRIGHT, Quaternion
from .link import LEAST_LENGTH, Link, in_space, point
from .placed import GROOVE, RIM, STROKE, PlacedLink, Point, for_each, place_all, placed

#: Largest distance of the end of a tie from its body, on a bracket; and of a given place from its joint [m].
BRACKET, BESIDE = 1.0, 1e-3

#: Points along a straight link at which it is looked at whether it passes through stone.
LOOKS = 200

#: Axes of a link: two across it, and its own.
Frame = tuple[Point, Point, Point]


class JointPlace(NamedTuple):
    """A place in the joint of two bodies by number: in space [m], with the axes of the joint, and its law.

    It is ``deep`` within the joint (negative outside), ``edge`` from the nearest edge of the faces, also those across a
    plane; and the bodies are as ``tall`` there, the lower and the upper one [m].
    """

    lower: int
    upper: int
    place: Point
    frame: Frame
    deep: float
    edge: float
    tall: tuple[float, float]
    law: Joint


class Scene:
    """Blocks of an assembly in the plane and the joints between them, among which links find their places."""

    def __init__(self, bodies: Sequence[Block], joints: Sequence[FaceJoint]) -> None:
        self.bodies, self.joints = bodies, joints

    def place(self, link: Link) -> PlacedLink:
        """A link with its place.

        Raises
        ------
        InputError
            A link that cannot be: the value, what is allowed, and a remedy.
        """
        lower, upper = bodies_named(link, self.bodies)
        frame: Frame = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        edge = math.inf
        if link.lies == "joint":
            found = self._in_joint(link, lower, upper)
            lower, upper, low, frame, edge = found.lower, found.upper, found.place, found.frame, found.edge
            high = low
        else:
            low, high = self._ends(link, lower, upper)
        if link.lies == "side":
            frame = self.clamp_frame(link, low, high)
            self._check_legs(link, (lower, low), (upper, high))
        origins, turns = zip(self.pose(lower), self.pose(upper), strict=True)
        where = {"origins": origins, "turns": turns, "frame": frame, "stroke": STROKE * self.reach(upper, frame[2])}
        return _placed_between(link, lower, upper, low, high, edge, **where)

    def _ends(self, link: Link, lower: int, upper: int) -> tuple[Point, Point]:
        """Ends of a clamp, tie or core in space as drawn [m]."""
        low, high = (in_space(end) for end in link.ends)
        far = BRACKET if link.lies == "line" else 0.0
        for body, end, name in ((lower, low, "at"), (upper, high, "to")):
            outside = -float(self.depth(body, np.array([end]), whole=False)[0])
            if outside > far + 1e-6 * min(self.bodies[body].size, 1.0):
                within = f"within {far:g} m of it" if far else "in it"
                raise InputError(
                    f"{name} of a {link.kind} is {self.shown(end)}, {outside:.3g} m outside block "
                    f"{self.bodies[body].name!r}; its end must be {within}.",
                    name,
                )
        if not getattr(link, "through_stone", False):
            self._check_way(link, lower, upper, low, high)
        return low, high

    def _check_way(self, link: Link, lower: int, upper: int, low: Point, high: Point) -> None:
        """Refuse a line through stone; a clamp lies in its two bodies."""
        points = np.linspace(low, high, LOOKS + 1)
        first, last = points.min(axis=0), points.max(axis=0)
        for i, body in enumerate(self.bodies):
            if (link.lies == "side" and i in (lower, upper)) or not self.near(i, first, last):
                continue
            deep = self.depth(i, points, whole=True)
            worst = int(deep.argmax())
            if deep[worst] > GROOVE:
                remedy = (
                    f"a {link.kind} lies in two blocks only"
                    if link.lies == "side"
                    else "move it beyond the face (at = [x, y, z]), or make it a core"
                )
                raise InputError(
                    f"a {link.kind} passes through stone: {1000.0 * deep[worst]:.3g} mm inside block {body.name!r} at "
                    f"{self.shown(points[worst])}; {remedy}."
                )

    def _in_joint(self, link: Any, one: int, other: int) -> JointPlace:
        """Place of a dowel, bar, layer or pad, with the edge that it brings along or has there."""
        found, numbers = self.joint_place(link, one, other), link.numbers
        where = f"a {link.kind} at {self.shown(found.place)}"
        if found.deep < 0.0:
            raise InputError(f"{where} is outside the section, by {-found.deep:.3g} m; move it inward.", "at")
        left = found.edge - 0.5 * numbers.diameter
        looked_at = numbers.edge < math.inf  # in the column that brings it along
        if numbers.diameter and not looked_at:
            if left < RIM:
                raise InputError(
                    f"{where} leaves {1000.0 * left:.3g} mm of stone to the rim; at least {1000.0 * RIM:g} mm must be left: "
                    "move it inward or make it thinner.",
                    "at",
                )
            for body, tall in zip((found.lower, found.upper), found.tall, strict=True):
                if not self.bodies[body].fixed and tall < numbers.lift < math.inf:
                    raise InputError(
                        f"a {link.kind} is embedded by {numbers.lift:g} m, and block {self.bodies[body].name!r} is "
                        f"{tall:.4g} m high there; make it shorter.",
                        "embedment",
                    )
        link.check_joint(found.law)
        return found._replace(edge=numbers.edge) if looked_at else found

    def _check_legs(self, link: Any, *ends: tuple[int, Point]) -> None:
        """Refuse legs that are longer than the stone that they are in is thick."""
        legs = link.numbers.lift
        for body, end in ends:
            if self.bodies[body].fixed or not math.isfinite(legs):
                continue
            thick = self.thickness(body, end)
            if thick < legs:
                raise InputError(
                    f"legs of a {link.kind} are {legs:g} m long, and block {self.bodies[body].name!r} is {thick:.4g} m "
                    "thick; make them shorter.",
                    "legs",
                )

    # -- in the plane; in space otherwise ---------------------------------------------------------------------------------

    def shown(self, place: Any) -> str:
        """A place in messages."""
        return point(place)

    def depth(self, body: int, points: np.ndarray, *, whole: bool) -> np.ndarray:
        """Depth of points in a body, in the plane alone unless ``whole`` [m], shape (m, 3) to (m,); negative outside."""
        block = self.bodies[body]
        found = np.array([_depth(block, (x, z)) for x, _, z in points.tolist()])
        return np.minimum(found, 0.5 * block.depth - np.abs(points[:, 1])) if whole and not block.fixed else found

    def near(self, body: int, low: np.ndarray, high: np.ndarray) -> bool:
        """Whether a body may reach into a box [m]."""
        return True

    def joint_place(self, link: Any, one: int, other: int) -> JointPlace:
        """Where in the joint of two bodies a link is: in its middle where no place is given."""
        joint = next((j for j in self.joints if {j.lower, j.upper} == {one, other}), None)
        if joint is None:
            raise no_joint(link)
        faces, sides = [], (joint.lower, joint.upper)
        for body, k in zip(sides, (joint.lower_face, joint.upper_face), strict=True):
            corners = self.bodies[body].corners
            faces.append(np.array([corners[k], corners[(k + 1) % len(corners)]]))
        right, left = faces[0]  # the lower body's face runs against the direction of the joint
        t = (right - left) / math.hypot(*(right - left))
        spans = [np.sort((face - left) @ t) for face in faces]
        low, high = max(span[0] for span in spans), min(span[1] for span in spans)
        s, y = 0.5 * (low + high), 0.0
        if link.at is not None:
            x, y, z = in_space(link.at)
            way = np.array([x, z]) - left
            s, off = float(way @ t), float(t[0] * way[1] - t[1] * way[0])
            if abs(off) > BESIDE:
                raise beside_joint(link, self.shown((x, y, z)), abs(off))
        deep = min(s - low, high - s)
        aside = min(0.5 * self.bodies[body].depth - abs(y) for body in sides if not self.bodies[body].fixed)
        tall = [float(np.ptp(self.bodies[body].corners @ np.array([-t[1], t[0]]))) for body in sides]
        x, z = (float(one) for one in left + s * t)
        frame = _frame(float(t[0]), float(t[1]))
        return JointPlace(*sides, (x, y, z), frame, deep, min(deep, aside), (tall[0], tall[1]), joint.law)

    def clamp_frame(self, link: Link, low: Point, high: Point) -> Frame:
        """Axes of a clamp between its ends: to the right of the way between them, across the plane, and along it."""
        x, z = high[0] - low[0], high[2] - low[2]
        length = math.hypot(x, z)
        if length < LEAST_LENGTH:
            raise InputError(
                f"a {link.kind} has no length: both its ends are at {self.shown(low)}; move one of them.", "to"
            )
        return _frame(z / length, -x / length)

    def thickness(self, body: int, place: Point) -> float:
        """Thickness of the stone of a body in which a leg at a place is [m]."""
        return self.bodies[body].thickness

    def pose(self, body: int) -> tuple[Point, Quaternion]:
        """Where a body is, and its axes."""
        x, z = self.bodies[body].origin
        return (x, 0.0, z), UPRIGHT

    def reach(self, body: int, way: Point) -> float:
        """How high a body is along a direction [m], for the mark of a link that is embedded in it."""
        return self.bodies[body].thickness


def _frame(c: float, s: float) -> Frame:
    """Axes in the plane, the first of this cosine and sine."""
    return (c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)


def no_joint(link: Any) -> InputError:
    """The refusal of a link in a joint that is not there."""
    return InputError(
        f"{link.between[0]!r} and {link.between[1]!r} have no joint for a {link.kind}; name two blocks whose faces touch, "
        "or make it a clamp or a tie.",
        "between",
    )


def beside_joint(link: Any, place: str, off: float) -> InputError:
    """The refusal of a link at a place that is so far from its joint [m]."""
    return InputError(
        f"a {link.kind} at {place} is {off:.3g} m from the joint of {link.between[0]!r} and {link.between[1]!r}; give a "
        "place in it, or leave at out for its middle.",
        "at",
    )


def place_between(scene: Scene, links: Sequence[Link], name: str) -> tuple[PlacedLink, ...]:
    """All links between bodies of an assembly of this name, each already in numbers, in their order.

    Raises
    ------
    InputError
        A link that cannot be: one sentence that names it, the value and what is allowed.
    """
    return place_all(links, name, scene.place)


def in_numbers(links: Sequence[Link], name: str) -> tuple[Link, ...]:
    """Links of an assembly of this name with what they hold in place of material and size; errors as of their kinds."""
    return tuple(for_each(links, name, Link.in_numbers))


def bodies_named(link: Link, bodies: Sequence[Any]) -> tuple[int, int]:
    """Numbers of the two bodies that a link names.

    Raises
    ------
    InputError
        A name that does not exist, one body twice, or two that are fixed.
    """
    assert link.between is not None
    names = [body.name for body in bodies]
    missing = next((one for one in link.between if one not in names), None)
    if missing is not None:
        raise InputError(
            f"a {link.kind} names block {missing!r}, which does not exist; {suggest(missing, names)}correct its name.",
            "between",
        )
    one, other = (names.index(name) for name in link.between)
    if one == other:
        raise InputError(f"a {link.kind} is between {link.between[0]!r} and itself; name two blocks.", "between")
    if bodies[one].fixed and bodies[other].fixed:
        raise InputError(
            f"a {link.kind} is between two bodies that both move with the ground; name one that can move.", "between"
        )
    return one, other


def _placed_between(
    link: Link, lower: int, upper: int, low: Point, high: Point, edge: float = math.inf, **where: Any
) -> PlacedLink:
    """A link of two bodies by number, between its ends as drawn [m]; so far from the nearest edge of its joint, where it
    brings no distance along [m]; ``where`` has the other fields of its place."""
    assert link.between is not None
    assert link.numbers is not None
    numbers = replace(link.numbers, edge=min(link.numbers.edge, edge))
    if link.lies == "side":  # it does not leave its groove by opening; its legs are longer than that
        numbers = replace(numbers, lift=math.inf)
    if math.isfinite(numbers.lift):
        where["stroke"] = numbers.lift
    between = say("{kind} between {l.between[0]} and {l.between[1]}", kind=say(link.kind), l=link)
    called = link.name or between
    return placed(
        numbers, name=called, kind=link.kind, law=link.law, lies=link.lies, mark=link.mark, lower=lower, upper=upper,
        low=low, high=high, **where,
    )  # fmt: skip


def _depth(block: Block, place: tuple[float, float]) -> float:
    """Depth of a place in a block [m]; negative outside, as far as its nearest side's line or corner is."""
    corners = block.corners
    side = np.roll(corners, -1, axis=0) - corners
    length = np.hypot(side[:, 0], side[:, 1])
    way = np.array(place) - corners
    inward = (side[:, 0] * way[:, 1] - side[:, 1] * way[:, 0]) / length
    if inward.min() >= 0.0:
        return float(inward.min())
    share = np.clip((way * side).sum(axis=1) / length**2, 0.0, 1.0)
    return -float(np.hypot(*(way - share[:, None] * side).T).min())
