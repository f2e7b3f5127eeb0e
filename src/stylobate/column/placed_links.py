"""Links of an assembly in numbers, at their places: whether they can be where they are said to be."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import InputError, suggest
from .block_links import BlockLink, in_space, length_of, told
from .link_checks import GROOVE, MAX_LINKS, RIM
from .link_laws import LinkProperties
from .link_loads import STROKE

if TYPE_CHECKING:
    from .assembly import Assembly, Block

#: How far a bracket may hold the end of a tie from its body; how far from its joint a place may be given [m].
BRACKET, BESIDE = 1.0, 1e-3

#: Points along a straight link at which it is looked at whether it passes through stone.
LOOKS = 200


@dataclass(frozen=True)
class PlacedLink(LinkProperties):
    """A link in numbers, between two bodies by their numbers.

    ``low`` and ``high`` are its ends as drawn; ``joint`` is 0.

    Parameters
    ----------
    along : (float, float)
        Direction in the plane in which it slips; its axis is to the left of that, from the lower body to the upper one.
    axial_failure : str
        Of a clamp along itself.
    """

    along: tuple[float, float] = (1.0, 0.0)
    axial_failure: str = "ductile"

    @property
    def straight(self) -> bool:
        """Whether it is a line between two points, rather than what crosses a joint."""
        return self.kind in ("tie", "core")

    @property
    def two_ended(self) -> bool:
        """Whether it has an end in either body, as ties, cores and clamps have."""
        return self.straight or self.kind == "clamp"

    @property
    def place(self) -> tuple[float, float]:
        """Where what crosses a joint acts, as drawn: halfway between its ends [m]."""
        return 0.5 * (self.low[0] + self.high[0]), 0.5 * (self.low[2] + self.high[2])


class BlockStroke(NamedTuple):
    """A link as it is drawn: its ends, each with the body on which it stays and the place as drawn, x and z [m]."""

    link: PlacedLink
    lower: tuple[int, np.ndarray]
    upper: tuple[int, np.ndarray]


def strokes_between(assembly: Assembly) -> list[BlockStroke]:
    """Every link as it is drawn: short through its joint, or from end to end; layers have none."""
    found = []
    for link in assembly.link_properties:
        low, high = np.array([link.low[0], link.low[2]]), np.array([link.high[0], link.high[2]])
        if link.kind == "layer":
            continue
        if link.two_ended:
            found.append(BlockStroke(link, (link.lower, low), (link.upper, high)))
            continue
        half = link.lift if math.isfinite(link.lift) else STROKE * assembly.bodies[link.upper].thickness
        up = half * np.array([-link.along[1], link.along[0]])
        found.append(BlockStroke(link, (link.lower, low - up), (link.lower, low + up)))
    return found


def placed_links(assembly: Assembly) -> tuple[PlacedLink, ...]:
    """Links of an assembly in numbers.

    Raises
    ------
    InputError
        A link that cannot be: one sentence that names it, the value and what is allowed.
    """
    found: list[PlacedLink] = []
    layered: set[tuple[int, int]] = set()
    if len(assembly.links) > MAX_LINKS:
        raise InputError(f"{assembly.name!r} has {len(assembly.links)} links; allowed are up to {MAX_LINKS}.")
    for number, link in enumerate(assembly.links, 1):
        try:
            found.append(_placed(link, assembly))
            pair = found[-1].lower, found[-1].upper
            if link.friction_coefficient is not None and pair in layered:
                raise InputError("its joint has two layers with a friction_coefficient; keep one.")
            if link.friction_coefficient is not None:
                layered.add(pair)
        except InputError as error:
            raise InputError(f"link {number} of {assembly.name!r}: {error}") from None
    names = [one.name for one in found]
    return tuple(
        one
        if names.count(one.name) == 1
        else dataclasses.replace(one, name=f"{one.name}, {names[: i + 1].count(one.name)}")
        for i, one in enumerate(found)
    )


def _placed(link: BlockLink, assembly: Assembly) -> PlacedLink:
    bodies = assembly.bodies
    names = [block.name for block in bodies]
    missing = next((one for one in link.between if one not in names), None)
    if missing is not None:
        raise InputError(
            f"a {link.kind} names block {missing!r}, which does not exist; {suggest(missing, names)}correct its name."
        )
    one, other = (names.index(name) for name in link.between)
    if one == other:
        raise InputError(f"a {link.kind} is between {link.between[0]!r} and itself; name two blocks.")
    if bodies[one].fixed and bodies[other].fixed:
        raise InputError(f"a {link.kind} is between two bodies that both move with the ground; name one that can move.")
    if link.pretension > link.axial_capacity:
        raise InputError(
            f"pretension of a {link.kind} is {link.pretension:g} N, more than its axial capacity of "
            f"{link.axial_capacity:.4g} N; make it smaller."
        )
    if link.pretension and not link.axial_stiffness:
        raise InputError(f"a {link.kind} without axial_stiffness cannot be pretensioned; give one.")
    numbers = {
        field.name: getattr(link, field.name)
        for field in dataclasses.fields(LinkProperties)
        if hasattr(link, field.name) and field.name not in ("name", "kind")
    }
    numbers["axial_failure"] = link.axial_failure
    if link.straight or link.kind == "clamp":
        low, high = _ends(link, assembly, one, other)
        along = _beside(low, high) if link.kind == "clamp" else (1.0, 0.0)
    else:
        one, other, low, along = _in_joint(link, assembly, one, other)
        high = low
    numbers |= {"lower": one, "upper": other, "joint": 0, "low": low, "high": high, "along": along}
    if link.kind == "clamp":  # it does not leave its groove by opening; its legs are longer than that
        _check_legs(link, bodies[one], bodies[other])
        numbers["lift"] = math.inf
    return PlacedLink(link.called, link.kind, **numbers)


def _ends(link: BlockLink, assembly: Assembly, one: int, other: int) -> tuple[Any, Any]:
    """Ends of a clamp, tie or core in space as drawn [m]."""
    length_of(link.kind, link.at, link.to)
    low, high = in_space(link.at), in_space(link.to)
    far = BRACKET if link.straight else 0.0
    for body, end, name in ((one, low, "at"), (other, high, "to")):
        block = assembly.bodies[body]
        outside = -_depth(block, (end[0], end[2]))
        if outside > far + 1e-6 * min(block.size, 1.0):
            within = f"within {far:g} m of it" if far else "in it"
            raise InputError(
                f"{name} of a {link.kind} is {told(end)}, {outside:.3g} m outside block {block.name!r}; its end must be "
                f"{within}."
            )
    if link.kind == "core":
        return low, high
    for share in np.linspace(0.0, 1.0, LOOKS + 1):
        x, y, z = (a + share * (b - a) for a, b in zip(low, high, strict=True))
        for i, block in enumerate(assembly.bodies):
            if link.kind == "clamp" and i in (one, other):
                continue
            deep = min(_depth(block, (x, z)), math.inf if block.fixed else 0.5 * block.depth - abs(y))
            if deep > GROOVE:
                remedy = (
                    "a clamp lies in two blocks only"
                    if link.kind == "clamp"
                    else "move it beyond the face (at = [x, y, z]), or make it a core"
                )
                raise InputError(
                    f"a {link.kind} passes through stone: {1000.0 * deep:.3g} mm inside block {block.name!r} at "
                    f"[{x:.3g}, {z:.3g}] m; {remedy}."
                )
    return low, high


def _in_joint(link: BlockLink, assembly: Assembly, one: int, other: int) -> tuple[int, int, Any, tuple[float, float]]:
    """Lower and upper body, place in space [m] and direction of the joint in which a dowel, bar or layer is."""
    if link.to is not None:
        raise InputError(f"a {link.kind} has one place, at; leave to out, or make it a clamp or a tie.")
    joint = next((j for j in assembly.joints if {j.lower, j.upper} == {one, other}), None)
    if joint is None:
        raise InputError(
            f"{link.between[0]!r} and {link.between[1]!r} have no joint for a {link.kind}; name two blocks whose faces "
            "touch, or make it a clamp or a tie."
        )
    faces = []
    for body, k in ((joint.lower, joint.lower_face), (joint.upper, joint.upper_face)):
        corners = assembly.bodies[body].corners
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
                f"a {link.kind} at {told(place)} is {abs(off):.3g} m from the joint of {link.between[0]!r} and "
                f"{link.between[1]!r}; give a place in it, or leave at out for its middle."
            )
        if not low <= s <= high:
            raise InputError(
                f"a {link.kind} at {told(place)} is outside the section, by {max(low - s, s - high):.3g} m; move it inward."
            )
    inside = min(s - low, high - s) - 0.5 * link.diameter
    if link.diameter and inside < RIM:
        raise InputError(
            f"a {link.kind} at {s - low:.3g} m from the end of its joint leaves {1000.0 * inside:.3g} mm of stone to the "
            f"rim; at least {1000.0 * RIM:g} mm must be left: move it inward or make it thinner."
        )
    for body in (joint.lower, joint.upper):
        block = assembly.bodies[body]
        tall = float(np.ptp(block.corners @ np.array([-t[1], t[0]])))
        if link.diameter and not block.fixed and link.lift > tall and math.isfinite(link.lift):
            raise InputError(
                f"a {link.kind} is embedded by {link.lift:g} m, and block {block.name!r} is {tall:.4g} m high there; make "
                "it shorter."
            )
    x, z = (float(one) for one in left + s * t)
    return joint.lower, joint.upper, (x, y, z), (float(t[0]), float(t[1]))


def _check_legs(link: BlockLink, *blocks: Block) -> None:
    for block in blocks:
        if math.isfinite(link.lift) and not block.fixed and link.lift > block.thickness:
            raise InputError(
                f"legs of a clamp are {link.lift:g} m long, and block {block.name!r} is {block.thickness:.4g} m thick; "
                "make them shorter."
            )


def _depth(block: Block, place: tuple[float, float]) -> float:
    """How deep a place is in a block [m]; negative outside, as far as its nearest side's line or corner is."""
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
