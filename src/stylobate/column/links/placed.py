"""Links where they are, in numbers: what kernels, statics and pictures read, their pull, and the stone around them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ...errors import InputError, within
from ...messages import joined, say
from ..turning import UPRIGHT, Quaternion, matrix_of
from . import COLUMN_KINDS
from .anchorage import StoneAround, in_stone
from .link import Lies, Link, Mark, Numbers

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
    held, stone = in_stone(alone)
    return PlacedLink(**vars(held), alone=alone, stone=stone, **where)


def stands_at(place: tuple[float, float], angle: float, arm: Sequence[float] | np.ndarray) -> Point:
    """Where a point is that is so far from the place of a body, in axes that are inclined by an angle [m], [rad]."""
    (x, y, z), c, s = (float(one) for one in arm), math.cos(angle), math.sin(angle)
    return place[0] + (c * x - s * z), y, place[1] + (s * x + c * z)


class Stroke(NamedTuple):
    """A line that stands for a link: of either end the body, its place in that body's axes, and the place as drawn [m]."""

    link: PlacedLink
    lower: tuple[int, np.ndarray, np.ndarray]
    upper: tuple[int, np.ndarray, np.ndarray]


def strokes(links: Sequence[PlacedLink]) -> list[Stroke]:
    """Every link as it is drawn: short through its joint, or from end to end; sheets in joints have no stroke."""
    found = []
    for link in links:
        if link.mark == "sheet":
            continue
        low, high, upper = np.array(link.low), np.array(link.high), 1
        if not link.two_ended:
            up, upper = link.stroke * np.array(link.frame[2]), 0
            low, high = low - up, low + up
        bodies = link.lower, link.upper
        ends = [(bodies[end], link.on_body(end, place), place) for end, place in ((0, low), (upper, high))]
        found.append(Stroke(link, ends[0], ends[1]))
    return found


def for_each(links: Sequence[Any], owner: str, do: Callable[[Link], Result]) -> list[Result]:
    """Facts of each link of a column or an assembly of this name.

    Raises
    ------
    InputError
        Too many, none, or a link that cannot be: one sentence that names it, the value and what is allowed.
    """
    if len(links) > MAX_LINKS:
        raise InputError(f"{owner!r} has {len(links)} links; allowed are up to {MAX_LINKS}.")
    found = []
    for number, link in enumerate(links, 1):
        if not isinstance(link, Link):
            *others, last = (kind.__name__ for kind in COLUMN_KINDS.values())
            raise InputError(f"link {number} of {owner!r} is {link!r}; give a {', '.join(others)} or {last}.")
        with within(f"link {number} of {owner!r}", "link", number):
            found.append(do(link))
    return found


def place_all(links: Sequence[Link], owner: str, place: Callable[[Link], PlacedLink]) -> tuple[PlacedLink, ...]:
    """All links where they are, in their order, each under a name of its own; errors as of :func:`for_each`."""
    found: list[PlacedLink] = []

    def checked(link: Link) -> None:
        one = place(link)
        _check(one, found)
        found.append(one)

    for_each(links, owner, checked)
    names = [one.name for one in found]
    return tuple(
        one
        if names.count(one.name) == 1
        else dataclasses.replace(one, name=f"{one.name}, {names[: i + 1].count(one.name)}")
        for i, one in enumerate(found)
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
GIVEN = say("That capacity is given, and taken as it is: it has to be known of the link in this stone.")


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
    told = []
    for given, words in ((False, BREAKS), (True, GIVEN)):
        weak = [way for way in ways if way[-1] == given]
        if weak:
            _, link, how, bears, holds, stone, _ = min(weak, key=lambda way: way[0])
            bar = say("the bar holds {force:.4g} kN", force=1e-3 * holds)
            bar = bar if math.isfinite(holds) else say("the bar is without a limit")
            said = say(
                "The stone gives way before {number} of {all} links do, first around {link}: at {force:.4g} "
                "kN in {how}, where {bar} ({source}).",
                number=len({one.name for _, one, *_ in weak}), all=len(anchors), link=link.name, force=1e-3 * bears,
                how=say(how), bar=bar, source=stone.source,
            )  # fmt: skip
            told += [said, words]
    if known and not told:
        more = say(
            "The stone around {number} of {all} links bears more than they hold, by EN 1992-4 carried over from concrete."
        )
        told.append(more.of(number=len(known), all=len(anchors)))
    if len(known) < len(anchors):
        unknown = say(
            "The stone around {number} of {all} links was not checked, for want of an edge, a diameter or an embedment: "
            "stone_at_anchor tells what it bears."
        )
        told.append(unknown.of(number=len(anchors) - len(known), all=len(anchors)))
    return joined(" ", told)


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
    said = say("The stone gives way before {number} of {all} links do: their capacity here is that of the stone.")
    return said.of(number=len(weak), all=len(anchors))
