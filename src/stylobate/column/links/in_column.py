"""Links of a column at their places, and whether they can be there: joints, sections, lengths of drums, clear ways."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import InputError
from ...messages import say
from ..drum import Drum
from ..stack import Stack
from .kinds import Line
from .link import Link, Site
from .placed import GROOVE, RIM, STROKE, PlacedLink, Point, place_all, placed

#: Points along a tie at which it is looked at whether it passes through stone.
LOOKS = 400


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
    numbers = link.held(Site(math.nan, float(stack.joint_areas[upper]), stack.joint_edge(upper)))
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
    numbers = link.held(Site(length))
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
    for share in np.linspace(0.0, 1.0, LOOKS + 1):
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
    return f"[{', '.join(f'{one:g}' for one in place)}] m"


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
