"""Whether the links of a column can be where they are said to be: joints, sections, lengths of drums, clear ways."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from .link_laws import line_ends, properties
from .links import Clamp, Core, Dowel, Layer, Link, Tie

if TYPE_CHECKING:
    from .column import Column
    from .drum import Drum

#: Stone that must be left between a dowel and the rim of a face [m].
RIM = 0.02

#: Most links of a column.
MAX_LINKS = 1000

#: Points along a tie at which it is looked at whether it passes through stone, and how deep a groove it may lie in [m].
LOOKS, GROOVE = 400, 0.02


def check_links(column: Column) -> None:
    """Refuse links that cannot be.

    Raises
    ------
    InputError
        One sentence that names the link, the value and what is allowed.
    """
    if len(column.links) > MAX_LINKS:
        raise InputError(f"{column.name!r} has {len(column.links)} links; allowed are up to {MAX_LINKS}.")
    layered: set[int] = set()
    for number, link in enumerate(column.links, 1):
        if not isinstance(link, Link):
            raise InputError(f"link {number} of {column.name!r} is {link!r}; give a Dowel, Bar, Tie, Core or Layer.")
        if isinstance(link, Clamp):
            raise InputError(
                f"link {number} of {column.name!r} is a clamp, and a column has no blocks side by side; give a bar."
            )
        try:
            _check(link, column)
        except InputError as error:
            raise InputError(f"link {number} of {column.name!r}: {error}") from None
        if isinstance(link, Layer) and link.friction_coefficient is not None:
            if link.joint in layered:
                raise InputError(
                    f"link {number} of {column.name!r}: joint {link.joint} has two layers with a friction_coefficient; "
                    "keep one."
                )
            layered.add(link.joint)
    for number, one in enumerate(properties(column), 1):
        if one.pretension > one.axial_capacity:
            raise InputError(
                f"link {number} of {column.name!r}: pretension of a {one.kind} is {one.pretension:g} N, more than its axial "
                f"capacity of {one.axial_capacity:.4g} N; make it smaller."
            )
        if one.pretension and not one.axial_stiffness:
            raise InputError(
                f"link {number} of {column.name!r}: a {one.kind} without axial_stiffness cannot be pretensioned; give one."
            )


def _check(link: Link, column: Column) -> None:
    if isinstance(link, Tie):
        _check_line(link, column)
        return
    assert isinstance(link, (Dowel, Layer))
    if link.joint > column.n:
        raise InputError(
            f"there is no joint {link.joint} for a {link.kind}; the joints are 1 (with the base) to {column.n}."
        )
    above, below = column.drums[link.joint - 1], column.drums[link.joint - 2] if link.joint > 1 else None
    half = 0.5 * (link.diameter or 0.0) if isinstance(link, Dowel) else 0.0
    rim = RIM if isinstance(link, Dowel) else 0.0
    faces = [(above, "bottom", link.joint)] + ([] if below is None else [(below, "top", link.joint - 1)])
    for drum, side, number in faces:
        inside = _inside(drum, side, link.at)
        where = f"a {link.kind} at {_place(link.at)} in joint {link.joint}"
        if inside < 0.0:
            raise InputError(f"{where} is outside the section, by {-inside:.3g} m on drum {number}; move it inward.")
        if inside - half < rim:
            raise InputError(
                f"{where} leaves {1000.0 * (inside - half):.3g} mm of stone to the rim of drum {number}; at least "
                f"{1000.0 * RIM:g} mm must be left: move it inward or make it thinner."
            )
    if isinstance(link, Dowel) and link.embedment is not None:
        for drum, _, number in faces:
            if link.embedment > drum.height:
                raise InputError(
                    f"a {link.kind} is embedded by {link.embedment:g} m, and drum {number} is {drum.height:g} m high; make "
                    "it shorter."
                )


def _check_line(link: Tie, column: Column) -> None:
    upper = column.n if link.to_drum is None else link.to_drum
    if upper > column.n or link.from_drum >= upper:
        raise InputError(
            f"a {link.kind} goes from drum {link.from_drum} to drum {upper}; the drums are 1 to {column.n}."
        )
    low, high = line_ends(link, column)
    for drum, end, name in ((link.from_drum, low, "from_height"), (upper, high, "to_height")):
        bottom = float(column.joint_heights[drum - 1]) if drum else -math.inf
        top = bottom + float(column.heights[drum - 1]) if drum else 0.0
        if not bottom - 1e-9 <= end[2] <= top + 1e-9:
            allowed = f"{bottom:g} to {top:g} m" if drum else "up to 0 m"
            raise InputError(
                f"{name} of a {link.kind} is {end[2]:g} m; allowed on drum {drum} is {allowed} above the base."
            )
    if math.dist(low, high) < 1e-3:
        raise InputError(f"a {link.kind} has no length: both its ends are at {_place(low)}; move one of them.")
    if isinstance(link, Core):
        _check_core(link, column, low, high)
        return
    for share in np.linspace(0.0, 1.0, LOOKS + 1):
        x, y, z = (a + share * (b - a) for a, b in zip(low, high, strict=True))
        number = int(np.searchsorted(column.joint_heights, z, side="right"))
        deep = -z if z < 0.0 else -1.0 if z > column.height else _inside_at(column, max(number, 1), (x, y), z)
        if deep > GROOVE:
            stone = "the base" if z < 0.0 else f"drum {number}"
            raise InputError(
                f"a {link.kind} passes through stone: {1000.0 * deep:.3g} mm inside {stone}, {z:.3g} m above the base; move "
                "it outward, or make it a core."
            )


def _check_core(link: Core, column: Column, low: tuple[float, float, float], high: tuple[float, float, float]) -> None:
    for number in range(link.from_drum or 1, (column.n if link.to_drum is None else link.to_drum) + 1):
        for z in (column.joint_heights[number - 1], column.joint_heights[number - 1] + column.heights[number - 1]):
            share = min(max((float(z) - low[2]) / (high[2] - low[2]), 0.0), 1.0) if high[2] != low[2] else 0.0
            place = tuple(a + share * (b - a) for a, b in zip(low[:2], high[:2], strict=True))
            inside = _inside_at(column, number, place, float(z)) - 0.5 * (link.diameter or 0.0)
            if inside < RIM:
                raise InputError(
                    f"a core leaves {1000.0 * inside:.3g} mm of stone to the rim of drum {number}; at least "
                    f"{1000.0 * RIM:g} mm must be left: move it inward or make it thinner."
                )


def _inside(drum: Drum, side: str, place: tuple[float, ...]) -> float:
    """How far a place is inside a face [m]; negative outside."""
    width, depth = (drum.bottom_width, drum.depth) if side == "bottom" else (drum.top_width, drum.upper_depth)
    return _within(drum, width, depth, place)


def _inside_at(column: Column, number: int, place: tuple[float, ...], z: float) -> float:
    drum = column.drums[number - 1]
    share = (z - float(column.joint_heights[number - 1])) / drum.height
    width = drum.bottom_width + (drum.top_width - drum.bottom_width) * share
    return _within(drum, width, drum.depth_at(share * drum.height), place)


def _within(drum: Drum, width: float, depth: float, place: tuple[float, ...]) -> float:
    if drum.circular:
        return 0.5 * width - math.hypot(*place[:2])
    return min(0.5 * width - abs(place[0]), 0.5 * depth - abs(place[1]))


def _place(place: tuple[float, ...]) -> str:
    return f"[{', '.join(f'{one:g}' for one in place)}] m"
