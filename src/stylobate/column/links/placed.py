"""Links where they are: places in columns and assemblies, whether they can be there, and what is read of them in numbers."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ...errors import InputError, suggest, within
from ...messages import joined, say
from ..block import Block, FaceJoint
from ..drum import Drum
from ..joint import Joint
from ..shapes import UPRIGHT, Quaternion, matrix_of
from ..stack import Stack
from . import COLUMN_KINDS
from .anchorage import StoneAround, in_stone
from .kinds import Line
from .link import LEAST_LENGTH, Lies, Link, Mark, Numbers, Site, in_space, point

Point = tuple[float, float, float]
Result = TypeVar("Result")

#: Most links of a column or an assembly.
MAX_LINKS = 1000

#: Stone that must be left between a dowel and the rim of a face, and how deep a groove a tie may lie in [m].
RIM, GROOVE = 0.02, 0.02

#: Half of the stroke of a dowel whose embedment is not known, over the height of what it stands in [-].
STROKE = 0.15


@dataclass(frozen=True, kw_only=True)
class PlacedLink(Numbers):
    """A link in numbers between two bodies of a column or of an assembly, in space and as drawn.

    Parameters
    ----------
    name, kind : str
    law, lies, mark : str
        By which law it acts, where it lies and how it is drawn, as its kind does.
    lower, upper : int
        Bodies that it links; of a column 0 is the base and i drum i from the bottom, of an assembly their numbers.
    low, high : (float, float, float)
        Its ends as drawn, of a column as built: x and y from the axis, z above the base [m]. The same point for what lies in
        a joint.
    origins : pair of (float, float, float)
        The points of the two bodies that their poses refer to, in the same axes [m].
    turns : pair of (float, float, float, float)
        Unit quaternions from the axes of the two bodies to these axes, w first.
    joint : int
        Of a column that it crosses, from 1; 0 for a straight line, and in an assembly.
    frame : three of (float, float, float)
        Of what crosses a joint: two directions in which it slips, and its axis from the lower body to the upper one, each of
        length 1 and across the others. In a plane it slips in the first alone.
    stroke : float
        Half the length of its mark across a joint [m].
    alone : Numbers, optional
        What it holds by itself, without the stone around it.
    stone : StoneAround, optional
        What the stone around it bears, where that can be told.

    Others as for :class:`Numbers`, with capacities of the link in its stone; of a clamp ``lift`` is infinite, because it
    does not leave its groove by opening.
    """

    name: str
    kind: str
    law: str
    lies: Lies
    mark: Mark
    lower: int
    upper: int
    low: Point
    high: Point
    origins: tuple[Point, Point]
    turns: tuple[Quaternion, Quaternion] = (UPRIGHT, UPRIGHT)
    joint: int = 0
    frame: tuple[Point, Point, Point] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    stroke: float = 0.0
    alone: Numbers | None = None
    stone: StoneAround | None = None

    def limited_by(self, capacity: str) -> str:
        """Which limits a capacity of this name: ``link`` or ``stone``."""
        return "stone" if self.alone is not None and getattr(self, capacity) < getattr(self.alone, capacity) else "link"

    @property
    def breaks_stone(self) -> bool:
        """Whether the stone around it gives way before it does."""
        return "stone" in (self.limited_by("shear_capacity"), self.limited_by("axial_capacity"))

    @property
    def acts(self) -> bool:
        """Whether it does anything by itself: one without stiffness and dashpot only changes the law of its joint."""
        return self.shear_stiffness > 0.0 or self.axial_stiffness > 0.0 or self.damping > 0.0

    @property
    def straight(self) -> bool:
        """Whether it is a line between two points, rather than what crosses a joint."""
        return self.lies == "line"

    @property
    def two_ended(self) -> bool:
        """Whether it has an end in either body, as ties, cores and clamps have."""
        return self.lies != "joint"

    @property
    def length(self) -> float:
        """Of a straight line [m]; 0 for what crosses a joint."""
        return math.dist(self.low, self.high)

    @property
    def along(self) -> tuple[float, float]:
        """Direction in the plane of x and z in which it slips; its axis is to the left of that."""
        return self.frame[0][0], self.frame[0][2]

    @property
    def middle(self) -> Point:
        """Point of action across a joint, as drawn: halfway between its ends [m]."""
        x, y, z = (0.5 * (low + high) for low, high in zip(self.low, self.high, strict=True))
        return x, y, z

    @property
    def place(self) -> tuple[float, float]:
        """The same in the plane of x and z [m]."""
        return self.middle[0], self.middle[2]

    @property
    def arms(self) -> tuple[np.ndarray, np.ndarray]:
        """Points of action on the two bodies: from their origins, in their own axes [m], each of shape (3,)."""
        low, high = (self.low, self.high) if self.straight else (self.middle, self.middle)
        return self.on_body(0, low), self.on_body(1, high)

    def on_body(self, end: int, point: Sequence[float] | np.ndarray) -> np.ndarray:
        """A point as drawn, from the origin of the lower (0) or the upper body (1), in that body's axes [m], shape (3,)."""
        arm, turn = np.subtract(point, self.origins[end]), self.turns[end]
        return arm if turn == UPRIGHT else matrix_of(turn).T @ arm

    def crosses(self, joint: int) -> bool:
        """Whether it crosses joint 0 … n−1 of a column."""
        return self.lower <= joint < self.upper


def placed(alone: Numbers, **where: Any) -> PlacedLink:
    """A link that holds so much by itself, in its stone; ``where`` has the fields of its place."""
    numbers, stone = in_stone(alone)
    return PlacedLink(**vars(numbers), alone=alone, stone=stone, **where)


def stands_at(place: tuple[float, float], angle: float, arm: Sequence[float] | np.ndarray) -> Point:
    """Where a point is that is so far from the place of a body, in axes that are inclined by an angle [m], [rad]."""
    (x, y, z), c, s = (float(coordinate) for coordinate in arm), math.cos(angle), math.sin(angle)
    return place[0] + (c * x - s * z), y, place[1] + (s * x + c * z)


class Stroke(NamedTuple):
    """A line that stands for a link: of either end the body, its place in that body's axes, and the place as drawn [m]."""

    link: PlacedLink
    lower: tuple[int, np.ndarray, np.ndarray]
    upper: tuple[int, np.ndarray, np.ndarray]


def strokes(links: Sequence[PlacedLink]) -> list[Stroke]:
    """Every link as it is drawn: short through its joint, or from end to end; sheets in joints have no stroke."""
    drawn_links = []
    for link in links:
        if link.mark == "sheet":
            continue
        low, high, upper = np.array(link.low), np.array(link.high), 1
        if not link.two_ended:
            up, upper = link.stroke * np.array(link.frame[2]), 0
            low, high = low - up, low + up
        bodies = link.lower, link.upper
        ends = [(bodies[end], link.on_body(end, place), place) for end, place in ((0, low), (upper, high))]
        drawn_links.append(Stroke(link, ends[0], ends[1]))
    return drawn_links


def for_each(links: Sequence[Any], owner: str, do: Callable[[Link], Result]) -> list[Result]:
    """Facts of each link of a column or an assembly of this name.

    Raises
    ------
    InputError
        Too many, none, or a link that cannot be: one sentence that names it, the value and what is allowed.
    """
    if len(links) > MAX_LINKS:
        raise InputError(f"{owner!r} has {len(links)} links; allowed are up to {MAX_LINKS}.")
    facts = []
    for number, link in enumerate(links, 1):
        if not isinstance(link, Link):
            *others, last = (kind.__name__ for kind in COLUMN_KINDS.values())
            raise InputError(f"link {number} of {owner!r} is {link!r}; give a {', '.join(others)} or {last}.")
        with within(f"link {number} of {owner!r}", "link", number):
            facts.append(do(link))
    return facts


def place_all(links: Sequence[Link], owner: str, place: Callable[[Link], PlacedLink]) -> tuple[PlacedLink, ...]:
    """All links where they are, in their order, each under a name of its own; errors as of :func:`for_each`."""
    placed_links: list[PlacedLink] = []

    def checked(link: Link) -> None:
        placed_link = place(link)
        _check(placed_link, placed_links)
        placed_links.append(placed_link)

    for_each(links, owner, checked)
    names = [link.name for link in placed_links]
    return tuple(
        link
        if names.count(link.name) == 1
        else dataclasses.replace(link, name=f"{link.name}, {names[: i + 1].count(link.name)}")
        for i, link in enumerate(placed_links)
    )


def _check(link: PlacedLink, others: Sequence[PlacedLink]) -> None:
    """Refuse what no place can mend: pretension that it cannot hold, two laws for one joint."""
    if link.pretension > link.axial_capacity:
        raise InputError(
            f"pretension of a {link.kind} is {link.pretension:g} N, more than its axial capacity of "
            f"{link.axial_capacity:.4g} N ({link.governs}); make it smaller.",
            "pretension",
        )
    if link.pretension and not link.axial_stiffness:
        raise InputError(f"a {link.kind} without axial_stiffness cannot be pretensioned; give one.", "axial_stiffness")
    beside = [other for other in others if (other.lower, other.upper) == (link.lower, link.upper)]
    where = f"joint {link.joint}" if link.joint else "its joint"
    # in an assembly in the plane, whose links have no joint by number, one may stand behind the other
    for other in beside if link.joint and link.diameter else []:
        apart = math.dist(link.low, other.low)
        if other.diameter and apart < 0.5 * (link.diameter + other.diameter):
            raise InputError(
                f"a {link.kind} of {link.diameter:g} m and a {other.kind} of {other.diameter:g} m in {where} are "
                f"{apart:.3g} m apart from axis to axis, and would share stone; give them other places with at.",
                "at",
            )
    if link.friction_coefficient is not None and any(other.friction_coefficient is not None for other in beside):
        raise InputError(f"{where} has two layers with a friction_coefficient; keep one.", "joint")
    if link.bed_stiffness < math.inf and any(other.bed_stiffness < math.inf for other in beside):
        raise InputError(f"{where} has two {link.kind}s; keep one.", "joint")


# -- Force of pretensioned links on the part of a column above a joint, as it stands ----------------------------------


def pulls_in_plane(links: Sequence[PlacedLink]) -> bool:
    """Whether what pretensioned links pull has no part across the plane of x and z."""
    return not any(link.low[1] or link.high[1] for link in links if link.pretension)


def pull_on_part(
    links: Sequence[PlacedLink], centroids: np.ndarray, axes: np.ndarray, joint: int
) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] of pretensioned links on the part above a joint, and its moment about the origin of the axes [N m].

    Parameters
    ----------
    links : sequence of PlacedLink
        Of a column.
    centroids : array
        Of the drums [m], shape (n, 3).
    axes : array
        Of the drums, as columns, shape (n, 3, 3).
    joint : int
        0 … n−1.

    Returns
    -------
    force, moment : array
        Each of shape (3,).
    """
    force, moment = np.zeros(3), np.zeros(3)
    for link in links:
        if not link.pretension or not link.crosses(joint):
            continue
        low, high = link.arms
        upper = centroids[link.upper - 1] + axes[link.upper - 1] @ high
        if link.straight:
            lower = low if link.lower == 0 else centroids[link.lower - 1] + axes[link.lower - 1] @ low
            way = (lower - upper) / np.linalg.norm(lower - upper)
        else:
            way = -(np.eye(3) if link.lower == 0 else axes[link.lower - 1])[:, 2]
        force += link.pretension * way
        moment += np.cross(upper, link.pretension * way)
    return force, moment


# -- Where the stone around the links of a structure gives way before they do, in words -------------------------------


#: What follows where the stone gives way first: of capacities that are computed, and of those that are given.
BREAKS = say("Computed is that the stone breaks there, and the link then holds nothing.")
CAPACITY_STATED = say("That capacity is given, and taken as it is: it has to be known of the link in this stone.")


#: What limit analysis does not see of it.
LATE = say(
    "A limit analysis lets all links hold their capacity together: stone that breaks one by one bears less (pushover)."
)


def stone_words(links: Sequence[PlacedLink]) -> str:
    """Where the stone gives way before links do, and where that was not looked at, in sentences; empty without anchors."""
    anchors = [link for link in links if link.law in ("dowel", "clamp") and link.mark != "sheet" and link.acts]
    known = [(link, link.alone, link.stone) for link in anchors if link.alone and link.stone]
    ways = [
        (bears / holds, link, how, bears, holds, stone, f"{name}_capacity" in alone.stated)
        for link, alone, stone in known
        for how, name, bears, holds in (
            ("shear", "shear", stone.shear, alone.shear_capacity),
            ("tension", "axial", stone.pull, alone.axial_capacity),
        )
        if bears < holds
    ]
    sentences = []
    for given, words in ((False, BREAKS), (True, CAPACITY_STATED)):
        weak = [way for way in ways if way[-1] == given]
        if weak:
            _, link, how, bears, holds, stone, _ = min(weak, key=lambda way: way[0])
            bar = say("the bar holds {force:.4g} kN", force=1e-3 * holds)
            bar = bar if math.isfinite(holds) else say("the bar is without a limit")
            sentence = say(
                "The stone gives way before {number} of {all} links do, first around {link}: at {force:.4g} "
                "kN in {how}, where {bar} ({source}).",
                number=len({anchor.name for _, anchor, *_ in weak}), all=len(anchors), link=link.name, force=1e-3 * bears,
                how=say(how), bar=bar, source=stone.source,
            )  # fmt: skip
            sentences += [sentence, words]
    if known and not sentences:
        more = say(
            "The stone around {number} of {all} links bears more than they hold, by EN 1992-4 carried over from concrete."
        )
        sentences.append(more.of(number=len(known), all=len(anchors)))
    if len(known) < len(anchors):
        unknown = say(
            "The stone around {number} of {all} links was not checked, for want of an edge, a diameter or an embedment: "
            "stone_at_anchor tells what it bears."
        )
        sentences.append(unknown.of(number=len(anchors) - len(known), all=len(anchors)))
    return joined(" ", sentences)


def stone_at_limit(links: Sequence[PlacedLink]) -> str:
    """The same beside a limit analysis, which takes all links as ductile."""
    late = any(link.breaks_stone for link in links)
    return joined(" ", [stone_words(links), LATE if late else ""])


def stone_that_breaks(links: Sequence[PlacedLink]) -> str:
    """Links whose capacity is what the stone around them bears, in a sentence beside an answer; empty without."""
    anchors = [link for link in links if link.acts and link.mark != "sheet"]
    weak = [link for link in anchors if link.breaks_stone]
    if not weak:
        return ""
    sentence = say("The stone gives way before {number} of {all} links do: their capacity here is that of the stone.")
    return sentence.of(number=len(weak), all=len(anchors))


# Links of a column at their places, and whether they can be there: joints, sections, lengths of drums, clear ways.

#: Points along a tie at which it is looked at whether it passes through stone.
LOOKS_IN_COLUMN = 400


def place_in_column(stack: Stack, links: Sequence[Link], name: str) -> tuple[PlacedLink, ...]:
    """All links of a column of this name in numbers, in their order.

    Raises
    ------
    InputError
        A link that cannot be: one sentence that names it, the value and what is allowed.
    """

    def place(link: Link) -> PlacedLink:
        if link.between is not None:
            raise InputError(f"a {link.kind} of a column has no between; give its joint or drums by number.", "between")
        if link.lies == "side":
            raise InputError(f"a {link.kind} holds blocks side by side, of which a column has none; give a bar.")
        return _line(link, stack) if isinstance(link, Line) else _in_joint(link, stack)

    return place_all(links, name, place)


def _in_joint(link: Any, stack: Stack) -> PlacedLink:
    """Place of a link in a joint: in the section, from the drum below to the drum above."""
    if link.joint > stack.n:
        raise InputError(
            f"there is no joint {link.joint} for a {link.kind}; the joints are 1 (with the base) to {stack.n}.", "joint"
        )
    upper = link.joint - 1
    numbers = link.resistance(Site(math.nan, float(stack.joint_areas[upper]), stack.joint_edge(upper)))
    faces = [(stack.drums[upper], "bottom", link.joint)]
    faces += [(stack.drums[upper - 1], "top", upper)] if upper else []
    pin, edge = link.mark != "sheet", math.inf
    for drum, side, number in faces:
        inside = _inside(drum, side, link.at)
        where = f"a {link.kind} at {_place(link.at)} in joint {link.joint}"
        if inside < 0.0:
            raise InputError(
                f"{where} is outside the section, by {-inside:.3g} m on drum {number}; move it inward.", "at"
            )
        edge = min(edge, inside)
        inside -= 0.5 * numbers.diameter
        if pin and inside < RIM:
            raise InputError(
                f"{where} leaves {1000.0 * inside:.3g} mm of stone to the rim of drum {number}; at least "
                f"{1000.0 * RIM:g} mm must be left: move it inward or make it thinner.",
                "at",
            )
    for drum, _, number in faces:
        if numbers.lift < math.inf and numbers.lift > drum.height:
            raise InputError(
                f"a {link.kind} is embedded by {numbers.lift:g} m, and drum {number} is {drum.height:g} m high; make "
                "it shorter.",
                "embedment",
            )
    link.check_joint(stack.joints[upper])
    place = (*link.at, float(stack.joint_heights[upper]))
    half = numbers.lift if math.isfinite(numbers.lift) else STROKE * float(stack.heights[upper])
    called = link.name or say("{kind} in joint {joint}", kind=say(link.kind), joint=link.joint)
    numbers = replace(numbers, edge=edge if pin else math.inf)
    return _placed(link, numbers, called, stack, (upper, upper + 1), (place, place), joint=link.joint, stroke=half)


def _line(link: Line, stack: Stack) -> PlacedLink:
    """Straight links between a drum, or the base, and a drum above it."""
    upper = stack.n if link.to_drum is None else link.to_drum
    if upper > stack.n or link.from_drum >= upper:
        raise InputError(
            f"a {link.kind} goes from drum {link.from_drum} to drum {upper}; the drums are 1 to {stack.n}.", "to_drum"
        )
    bodies = link.from_drum, upper
    levels = [_level(stack, *end) for end in zip(bodies, link.holds_at, (link.from_height, link.to_height))]
    low, high = ((*place, level) for place, level in zip(link.in_plan, levels, strict=True))
    for drum, end, name in ((link.from_drum, low, "from_height"), (upper, high, "to_height")):
        bottom = float(stack.joint_heights[drum - 1]) if drum else -math.inf
        top = bottom + float(stack.heights[drum - 1]) if drum else 0.0
        if not bottom - 1e-9 <= end[2] <= top + 1e-9:
            allowed = f"{bottom:g} to {top:g} m" if drum else "up to 0 m"
            raise InputError(
                f"{name} of a {link.kind} is {end[2]:g} m; allowed on drum {drum} is {allowed} above the base.", name
            )
    length = math.dist(low, high)
    if length < 1e-3:
        raise InputError(f"a {link.kind} has no length: both its ends are at {_place(low)}; move one of them.", "to")
    numbers = link.resistance(Site(length))
    if link.through_stone:
        _check_hole(link, stack, low, high, numbers.diameter)
    else:
        _check_way(link, stack, low, high)
    ends = (
        say("{kind} from the base to drum {upper}")
        if link.from_drum == 0
        else say("{kind} from drum {lower} to drum {upper}")
    )
    called = link.name or ends.of(kind=say(link.kind), lower=link.from_drum, upper=upper)
    return _placed(link, numbers, called, stack, bodies, (low, high))


def _placed(
    link: Link, numbers: Any, called: str, stack: Stack, bodies: tuple[int, int], ends: tuple[Point, Point], **more: Any
) -> PlacedLink:
    origins = tuple((0.0, 0.0, float(stack.centroid_heights[body - 1]) if body else 0.0) for body in bodies)
    return placed(
        numbers, name=called, kind=link.kind, law=link.law, lies=link.lies, mark=link.mark,
        lower=bodies[0], upper=bodies[1], low=ends[0], high=ends[1], origins=(origins[0], origins[1]), **more,
    )  # fmt: skip


def _level(stack: Stack, drum: int, share: float, given: float | None) -> float:
    """Height of the end of a line on a drum, 0 being the base [m]."""
    if given is not None:
        return given
    return 0.0 if drum == 0 else float(stack.joint_heights[drum - 1] + share * stack.heights[drum - 1])


def _check_way(link: Link, stack: Stack, low: Point, high: Point) -> None:
    """Refuse a line that passes through stone."""
    for share in np.linspace(0.0, 1.0, LOOKS_IN_COLUMN + 1):
        x, y, z = (a + share * (b - a) for a, b in zip(low, high, strict=True))
        number = int(np.searchsorted(stack.joint_heights, z, side="right"))
        deep = -z if z < 0.0 else -1.0 if z > stack.height else _inside_at(stack, max(number, 1), (x, y), z)
        if deep > GROOVE:
            stone = "the base" if z < 0.0 else f"drum {number}"
            raise InputError(
                f"a {link.kind} passes through stone: {1000.0 * deep:.3g} mm inside {stone}, {z:.3g} m above the base; move "
                "it outward, or make it a core.",
                "at",
            )


def _check_hole(link: Line, stack: Stack, low: Point, high: Point, diameter: float) -> None:
    """Refuse a line in a hole that leaves too little stone."""
    for number in range(link.from_drum or 1, (stack.n if link.to_drum is None else link.to_drum) + 1):
        for z in (stack.joint_heights[number - 1], stack.joint_heights[number - 1] + stack.heights[number - 1]):
            share = min(max((float(z) - low[2]) / (high[2] - low[2]), 0.0), 1.0) if high[2] != low[2] else 0.0
            place = tuple(a + share * (b - a) for a, b in zip(low[:2], high[:2], strict=True))
            inside = _inside_at(stack, number, place, float(z)) - 0.5 * diameter
            if inside < RIM:
                raise InputError(
                    f"a {link.kind} leaves {1000.0 * inside:.3g} mm of stone to the rim of drum {number}; at least "
                    f"{1000.0 * RIM:g} mm must be left: move it inward or make it thinner.",
                    "at",
                )


def _inside(drum: Drum, side: str, place: tuple[float, ...]) -> float:
    """Depth of a place within a face [m]; negative outside."""
    width, depth = (drum.bottom_width, drum.depth) if side == "bottom" else (drum.top_width, drum.upper_depth)
    return _within(drum, width, depth, place)


def _inside_at(stack: Stack, number: int, place: tuple[float, ...], z: float) -> float:
    drum = stack.drums[number - 1]
    share = (z - float(stack.joint_heights[number - 1])) / drum.height
    width = drum.bottom_width + (drum.top_width - drum.bottom_width) * share
    return _within(drum, width, drum.depth_at(share * drum.height), place)


def _within(drum: Drum, width: float, depth: float, place: tuple[float, ...]) -> float:
    if drum.circular:
        return 0.5 * width - math.hypot(*place[:2])
    return min(0.5 * width - abs(place[0]), 0.5 * depth - abs(place[1]))


def _place(place: tuple[float, ...]) -> str:
    return f"[{', '.join(f'{coordinate:g}' for coordinate in place)}] m"


def ends_on_bodies(
    link: PlacedLink, lower: tuple[float, float], upper: tuple[float, float], foot: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray, tuple[float, float]]:
    """Places of a link on its two bodies in the axes of their faces [m], shape (3,), and in which direction it slips.

    Parameters
    ----------
    link : PlacedLink
    lower, upper : tuple of float
        Directions of the upper faces of the two bodies, as cosine and sine.
    foot : tuple of float
        Middle of the lower face of the upper body from its centroid, along the face and normal to it [m].
    """
    low, high = link.arms
    if link.straight:
        return _turned(low, *lower), _turned(high, *upper), lower
    return _turned(low, *lower), np.array([link.high[0] + foot[0], link.high[1], foot[1]]), lower


def _turned(place: np.ndarray, c: float, s: float) -> np.ndarray:
    """A place [m], shape (3,), turned in the plane by an angle of this cosine and sine."""
    return np.array([c * place[0] - s * place[2], place[1], s * place[0] + c * place[2]])


# Links of an assembly at their places, and whether they can be there: ends in bodies, joints, clear ways, legs.

#: Largest distance of the end of a tie from its body, on a bracket; and of a given place from its joint [m].
BRACKET, BESIDE = 1.0, 1e-3

#: Points along a straight link at which it is looked at whether it passes through stone.
LOOKS_IN_ASSEMBLY = 200

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
            place = self._in_joint(link, lower, upper)
            lower, upper, low, frame, edge = place.lower, place.upper, place.place, place.frame, place.edge
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
        points = np.linspace(low, high, LOOKS_IN_ASSEMBLY + 1)
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

    def _in_joint(self, link: Any, first: int, other: int) -> JointPlace:
        """Place of a dowel, bar, layer or pad, with the edge that it brings along or has there."""
        place, numbers = self.joint_place(link, first, other), link.numbers
        where = f"a {link.kind} at {self.shown(place.place)}"
        if place.deep < 0.0:
            raise InputError(f"{where} is outside the section, by {-place.deep:.3g} m; move it inward.", "at")
        rest = place.edge - 0.5 * numbers.diameter
        looked_at = numbers.edge < math.inf  # in the column that brings it along
        if numbers.diameter and not looked_at:
            if rest < RIM:
                raise InputError(
                    f"{where} leaves {1000.0 * rest:.3g} mm of stone to the rim; at least {1000.0 * RIM:g} mm must be left: "
                    "move it inward or make it thinner.",
                    "at",
                )
            for body, tall in zip((place.lower, place.upper), place.tall, strict=True):
                if not self.bodies[body].fixed and tall < numbers.lift < math.inf:
                    raise InputError(
                        f"a {link.kind} is embedded by {numbers.lift:g} m, and block {self.bodies[body].name!r} is "
                        f"{tall:.4g} m high there; make it shorter.",
                        "embedment",
                    )
        link.check_joint(place.law)
        return place._replace(edge=numbers.edge) if looked_at else place

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
        depths = np.array([_depth(block, (x, z)) for x, _, z in points.tolist()])
        return np.minimum(depths, 0.5 * block.depth - np.abs(points[:, 1])) if whole and not block.fixed else depths

    def near(self, body: int, low: np.ndarray, high: np.ndarray) -> bool:
        """Whether a body may reach into a box [m]."""
        return True

    def joint_place(self, link: Any, first: int, other: int) -> JointPlace:
        """Where in the joint of two bodies a link is: in its middle where no place is given."""
        joint = next((j for j in self.joints if {j.lower, j.upper} == {first, other}), None)
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
        x, z = (float(coordinate) for coordinate in left + s * t)
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
    missing = next((name for name in link.between if name not in names), None)
    if missing is not None:
        raise InputError(
            f"a {link.kind} names block {missing!r}, which does not exist; {suggest(missing, names)}correct its name.",
            "between",
        )
    first, other = (names.index(name) for name in link.between)
    if first == other:
        raise InputError(f"a {link.kind} is between {link.between[0]!r} and itself; name two blocks.", "between")
    if bodies[first].fixed and bodies[other].fixed:
        raise InputError(
            f"a {link.kind} is between two bodies that both move with the ground; name one that can move.", "between"
        )
    return first, other


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
    between = say("{kind} between {one} and {other}", kind=say(link.kind), one=link.between[0], other=link.between[1])
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
