"""Links of an assembly at their places, and whether they can be there: ends in blocks, joints, clear ways, legs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import InputError, suggest
from ...messages import say
from ..block import Block, FaceJoint
from .link import LEAST_LENGTH, Link, in_space, point
from .placed import GROOVE, RIM, STROKE, PlacedLink, Point, for_each, place_all, placed

#: Largest distance of the end of a tie from its body, on a bracket; and of a given place from its joint [m].
BRACKET, BESIDE = 1.0, 1e-3

#: Points along a straight link at which it is looked at whether it passes through stone.
LOOKS = 200


def place_between(
    bodies: Sequence[Block], joints: Sequence[FaceJoint], links: Sequence[Link], name: str
) -> tuple[PlacedLink, ...]:
    """All links between bodies of an assembly of this name, each already in numbers, in their order.

    Raises
    ------
    InputError
        A link that cannot be: one sentence that names it, the value and what is allowed.
    """

    def place(link: Link) -> PlacedLink:
        return _placed(link, bodies, joints)

    return place_all(links, name, place)


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


def placed_between(
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


def _placed(link: Link, bodies: Sequence[Block], joints: Sequence[FaceJoint]) -> PlacedLink:
    one, other = bodies_named(link, bodies)
    along, edge = (1.0, 0.0), math.inf
    if link.lies == "joint":
        one, other, low, along, edge = _in_joint(link, bodies, joints, one, other)
        high = low
    else:
        low, high = _ends(link, bodies, one, other)
    if link.lies == "side":
        along = _beside(low, high)
        _check_legs(link, bodies[one], bodies[other])
    origins = [(x, 0.0, z) for x, z in (bodies[body].origin for body in (one, other))]
    frame = (along[0], 0.0, along[1]), (0.0, 1.0, 0.0), (-along[1], 0.0, along[0])
    stroke = STROKE * bodies[other].thickness
    return placed_between(
        link, one, other, low, high, edge, origins=(origins[0], origins[1]), frame=frame, stroke=stroke
    )


def _ends(link: Link, bodies: Sequence[Block], one: int, other: int) -> tuple[Point, Point]:
    """Ends of a clamp, tie or core in space as drawn [m]."""
    low, high = (in_space(end) for end in link.ends)
    far = BRACKET if link.lies == "line" else 0.0
    for body, end, name in ((one, low, "at"), (other, high, "to")):
        block = bodies[body]
        outside = -_depth(block, (end[0], end[2]))
        if outside > far + 1e-6 * min(block.size, 1.0):
            within = f"within {far:g} m of it" if far else "in it"
            raise InputError(
                f"{name} of a {link.kind} is {point(end)}, {outside:.3g} m outside block {block.name!r}; its end must be "
                f"{within}.",
                name,
            )
    if link.lies == "side" and math.hypot(high[0] - low[0], high[2] - low[2]) < LEAST_LENGTH:
        raise InputError(f"a {link.kind} has no length: both its ends are at {point(low)}; move one of them.", "to")
    if getattr(link, "through_stone", False):
        return low, high
    for share in np.linspace(0.0, 1.0, LOOKS + 1):
        x, y, z = (a + share * (b - a) for a, b in zip(low, high, strict=True))
        for i, block in enumerate(bodies):
            if link.lies == "side" and i in (one, other):
                continue
            deep = min(_depth(block, (x, z)), math.inf if block.fixed else 0.5 * block.depth - abs(y))
            if deep > GROOVE:
                remedy = (
                    f"a {link.kind} lies in two blocks only"
                    if link.lies == "side"
                    else "move it beyond the face (at = [x, y, z]), or make it a core"
                )
                raise InputError(
                    f"a {link.kind} passes through stone: {1000.0 * deep:.3g} mm inside block {block.name!r} at "
                    f"[{x:.3g}, {z:.3g}] m; {remedy}."
                )
    return low, high


def _in_joint(
    link: Any, bodies: Sequence[Block], joints: Sequence[FaceJoint], one: int, other: int
) -> tuple[int, int, Point, tuple[float, float], float]:
    """Lower and upper body, place in space [m], direction of the joint and distance from its nearest edge [m] of a dowel,
    bar or layer."""
    joint = next((j for j in joints if {j.lower, j.upper} == {one, other}), None)
    if joint is None:
        raise InputError(
            f"{link.between[0]!r} and {link.between[1]!r} have no joint for a {link.kind}; name two blocks whose faces "
            "touch, or make it a clamp or a tie.",
            "between",
        )
    faces = []
    for body, k in ((joint.lower, joint.lower_face), (joint.upper, joint.upper_face)):
        corners = bodies[body].corners
        faces.append(np.array([corners[k], corners[(k + 1) % len(corners)]]))
    right, left = faces[0]  # the lower body's face runs against the direction of the joint
    t = (right - left) / math.hypot(*(right - left))
    spans = [np.sort((face - left) @ t) for face in faces]
    low, high = max(span[0] for span in spans), min(span[1] for span in spans)
    if link.at is None:
        s, y = 0.5 * (low + high), 0.0
    else:
        place = in_space(link.at)
        y, way = place[1], np.array([place[0], place[2]]) - left
        s, off = float(way @ t), float(t[0] * way[1] - t[1] * way[0])
        if abs(off) > BESIDE:
            raise InputError(
                f"a {link.kind} at {point(place)} is {abs(off):.3g} m from the joint of {link.between[0]!r} and "
                f"{link.between[1]!r}; give a place in it, or leave at out for its middle.",
                "at",
            )
        if not low <= s <= high:
            raise InputError(
                f"a {link.kind} at {point(place)} is outside the section, by {max(low - s, s - high):.3g} m; move it "
                "inward.",
                "at",
            )
    aside = min(0.5 * bodies[body].depth - abs(y) for body in (joint.lower, joint.upper) if not bodies[body].fixed)
    edge = min(s - low, high - s, aside)
    inside = edge - 0.5 * link.numbers.diameter
    looked_at = link.numbers.edge < math.inf  # in the column that brings it along
    if link.numbers.diameter and inside < RIM and not looked_at:
        raise InputError(
            f"a {link.kind} at {s - low:.3g} m from the end of its joint leaves {1000.0 * inside:.3g} mm of stone to the "
            f"rim; at least {1000.0 * RIM:g} mm must be left: move it inward or make it thinner.",
            "at",
        )
    for body in (joint.lower, joint.upper):
        block = bodies[body]
        tall = float(np.ptp(block.corners @ np.array([-t[1], t[0]])))
        lift = link.numbers.lift
        if link.numbers.diameter and not block.fixed and tall < lift < math.inf and not looked_at:
            raise InputError(
                f"a {link.kind} is embedded by {lift:g} m, and block {block.name!r} is {tall:.4g} m high there; make "
                "it shorter.",
                "embedment",
            )
    link.check_joint(joint.law)
    x, z = (float(one) for one in left + s * t)
    edge = link.numbers.edge if looked_at else edge
    return joint.lower, joint.upper, (x, y, z), (float(t[0]), float(t[1])), edge


def _check_legs(link: Any, *blocks: Block) -> None:
    legs = link.numbers.lift
    for block in blocks:
        if not block.fixed and block.thickness < legs < math.inf:
            raise InputError(
                f"legs of a {link.kind} are {legs:g} m long, and block {block.name!r} is {block.thickness:.4g} m thick; "
                "make them shorter.",
                "legs",
            )


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


def _beside(low: tuple[float, ...], high: tuple[float, ...]) -> tuple[float, float]:
    """Direction in the plane across a clamp, to the right of the way from its first end to its second."""
    x, z = high[0] - low[0], high[2] - low[2]
    length = math.hypot(x, z)
    return z / length, -x / length
