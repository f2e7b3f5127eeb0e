"""A column found out of the plane, projected onto a vertical plane: what of it lies there, and what is lost."""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from ..constants import DEGREE
from ..errors import InputError, check_range, warn, within
from ..messages import Message, joined, say
from .as_found import AS_BUILT, AsFound, FoundDrum
from .column import Column
from .drum import Drum
from .found_geometry import Edges, geometry, joint_load, overlap_edges, space_geometry, space_load
from .links import Line, Link

#: Lengths [m], angles [degrees] and shares of a direction below this are rounding.
NOTHING = 1e-9

#: A chip below this is seen in no survey, and is not told of [m].
SMALLEST_CHIP = 1e-4


class Projection(NamedTuple):
    """A column in a plane, and in words what of it lies across that plane and is lost."""

    column: Column
    lost: tuple[str, ...]


def projected(column: Column, azimuth: float) -> Column:
    """The column in the vertical plane of an azimuth, in which x points there, for models in the plane.

    Parameters
    ----------
    column : Column
    azimuth : float
        From x towards y [degrees].

    Raises
    ------
    InputError
        As in :func:`project`.

    Warns
    -----
    OutOfRangeWarning
        What lies across the plane and is lost.
    """
    projection = project(column, azimuth)
    none, left_out = say("nothing of it lies across"), say("left out is what lies across it: {lost}")
    lost = left_out.of(lost=joined("; ", projection.lost)) if projection.lost else none
    words = say(
        "{name!r} is projected onto the vertical plane of azimuth {azimuth:g}°, along which x of the motion acts; {lost}."
    )
    warn(words.of(name=column.name, azimuth=azimuth, lost=lost))
    return projection.column


def project(column: Column, azimuth: float) -> Projection:
    """A column in the vertical plane of an azimuth, and what is lost.

    Parameters
    ----------
    column : Column
    azimuth : float
        From x towards y [degrees].

    Raises
    ------
    InputError
        Rectangular drums in a plane across their edges, or a column that is not in equilibrium in the plane.

    Notes
    -----
    Offsets d and the tangents of leans and of the base's slope τ keep their parts along the plane, d cos(φ − α) and
    tan τ cos(ψ − α). Each joint keeps the section of its contact by the plane through the place at which it is pressed, so
    that the lever of its weight to either side is that in space; what the section is shorter than the faces is a chip.
    Links keep their places along the plane and beside it, as links of a plane column have them.
    """
    angle = check_range("the azimuth of a projection", azimuth, -360.0, 360.0, unit="degrees", field="azimuth")
    way = _exact(angle)
    drums = column.drums if column.section == "circular" else tuple(_across(drum, way, column) for drum in column.drums)
    state, at = column.as_found, space_geometry(column)
    ones = [state.of(i + 1) for i in range(column.n)]
    offsets = [_parts(found_drum.offset, found_drum.offset_azimuth, angle) for found_drum in ones]
    leans = [_angles(found_drum.tilt, found_drum.tilt_azimuth, angle) for found_drum in ones]
    slope = _angles(state.base_tilt, state.base_azimuth, angle)
    whole = AsFound(
        tuple(FoundDrum(i, offset[0], lean[0]) for i, (offset, lean) in enumerate(zip(offsets, leans, strict=True), 1)),
        slope[0],
    )
    name = f"{column.name}, projected onto {angle:g}°"
    links = tuple(_turned(link, at.turned, angle) for link in column.links)
    with within(f"{column.name!r} cannot be projected onto azimuth {angle:g}°"):
        north = None if column.north is None else column.north - angle
        plane = column.replace(drums=drums, as_found=whole, name=name, links=links, north=north)
        chips = [_chips(column, plane, j, way) for j in range(column.n)]
        kept = tuple(
            dataclasses.replace(found_drum, chip_left=left, chip_right=right)
            for found_drum, (left, right) in zip(whole.drums, chips, strict=True)
        )
        as_found = AsFound(
            tuple(found_drum for found_drum in kept if found_drum != FoundDrum(found_drum.drum)), slope[0]
        )
        result = plane.replace(as_found=as_found or AS_BUILT)
    across = [
        _most(say("offsets across of up to {size:.3g} mm (drum {drum})"), [1e3 * offset[1] for offset in offsets]),
        _most(say("leans across of up to {size:.3g}° (drum {drum})"), [lean[1] for lean in leans]),
        _most(say("turns of up to {size:.3g}° (drum {drum})"), [found_drum.turn for found_drum in ones]),
        say("the slope of the base across, {angle:.3g}°", angle=abs(slope[1])) if abs(slope[1]) > NOTHING else "",
        _chipped(ones, kept),
        _beside(links),
    ]
    return Projection(result, tuple(text for text in across if text))


def _exact(angle: float) -> np.ndarray:
    """Direction of an azimuth [degrees], along the axes without rounding."""
    way = np.array([math.cos(angle * DEGREE), math.sin(angle * DEGREE)])
    return np.where(np.abs(way) < NOTHING, 0.0, way)


def _parts(size: float, azimuth: float, plane: float) -> tuple[float, float]:
    """Parts of a length at an azimuth along a plane and across it."""
    along, across = _exact(azimuth - plane)
    return size * float(along), size * float(across)


def _angles(angle: float, azimuth: float, plane: float) -> tuple[float, float]:
    """Angles [degrees] of what leans towards an azimuth, as seen in a plane and across it."""
    along, across = _parts(math.tan(angle * DEGREE), azimuth, plane)
    return math.atan(along) / DEGREE, math.atan(across) / DEGREE


def _across(drum: Drum, way: np.ndarray, column: Column) -> Drum:
    """A rectangular drum as seen across a plane along its edges."""
    if way[1] == 0.0:
        return drum
    if way[0] == 0.0:
        return dataclasses.replace(
            drum, bottom_width=drum.depth, top_width=drum.upper_depth, depth=drum.bottom_width, top_depth=drum.top_width
        )
    raise InputError(
        f"the drums of {column.name!r} are rectangular, and a plane across their edges cuts them into no rectangles; "
        "project it onto 0, 90, 180 or 270 degrees, or use dem3d."
    )


def _turned(link: Link, turned: np.ndarray, plane: float) -> Link:
    """A link with its places along a plane and beside it, where its drums have turned them [rad]."""

    def place(point: tuple[float, float], drum: int) -> tuple[float, float]:
        own = float(turned[drum - 1]) if drum else 0.0
        c, s = _exact(own / DEGREE - plane)
        return float(c * point[0] - s * point[1]), float(s * point[0] + c * point[1])

    if isinstance(link, Line):
        upper = len(turned) if link.to_drum is None else link.to_drum
        low, high = link.in_plan
        return dataclasses.replace(link, at=place(low, link.from_drum), to=place(high, upper))
    return dataclasses.replace(link, at=place(_in_plan(link.at), getattr(link, "joint", None) or 0))


def _in_plan(place: tuple[float, ...] | None) -> tuple[float, float]:
    """A place in plan; the middle where none is given [m]."""
    return (place[0], place[1]) if place else (0.0, 0.0)


def section(edges: Edges, place: np.ndarray, way: np.ndarray) -> tuple[float, float]:
    """Reach of a contact from a place within it against a direction and along it [m]."""
    out = []
    for toward in (-way, way):
        reach = math.inf
        for middle, radius in edges.discs:
            off = place - middle
            along = float(toward @ off)
            reach = min(reach, math.sqrt(max(along * along + radius * radius - float(off @ off), 0.0)) - along)
        for normal, bound in edges.sides:
            speed = float(toward @ normal)
            if speed > 1e-12:
                reach = min(reach, (bound - float(normal @ place)) / speed)
        out.append(reach)
    return out[0], out[1]


def _chips(column: Column, plane: Column, joint: int, way: np.ndarray) -> tuple[float, float]:
    """Lack of the drum on a joint in the plane to the left and the right, so that its contact is the section in space."""
    at = space_geometry(column)
    load = space_load(column, at, joint)
    behind, ahead = section(overlap_edges(column, at, joint), load.place, way)
    flat = geometry(plane)
    place = joint_load(plane, flat, joint).place
    middle, half = plane.as_found.of(joint + 1).offset, 0.5 * plane.drums[joint].bottom_width
    left, right = place - behind, place + ahead
    near = 1e-7 * half  # of what is equal but for rounding
    return (
        left - (middle - half) if left > flat.low[joint] + near else 0.0,
        middle + half - right if right < flat.high[joint] - near else 0.0,
    )


def _most(words: Message, values: list[float]) -> str:
    """The largest of some values that the drums have, in words; empty if there is none."""
    sizes = np.abs(values)
    worst = int(sizes.argmax())
    if sizes[worst] <= NOTHING:
        return ""
    return words.of(size=sizes[worst], drum=worst + 1)


def _chipped(ones: list[FoundDrum], kept: tuple[FoundDrum, ...]) -> str:
    """The chips of which the plane shows something else, to a tenth of a millimetre."""
    phrases = []
    for found_drum, now in zip(ones, kept, strict=True):
        before, after = (sorted(part for part in drum.chips if part > SMALLEST_CHIP) for drum in (found_drum, now))
        if before and not (len(before) == len(after) and np.allclose(before, after, rtol=1e-6)):
            deep, shown = (
                joined(say(" and "), (say("{depth:.3g} mm", depth=1e3 * part) for part in parts))
                for parts in (before, after)
            )
            part_shown = say(
                "of the chips of drum {drum}, {deep} deep, the plane shows {shown} at the ends of its faces"
            )
            none_shown = say("of the chips of drum {drum}, {deep} deep, the plane shows none")
            phrases.append((part_shown if shown else none_shown).of(drum=found_drum.drum, deep=deep, shown=shown))
    return joined(", ", phrases)


def _beside(links: tuple[Link, ...]) -> str:
    """The links that are beside the plane."""
    ends = [(link.at, getattr(link, "to", None) or link.at) for link in links]
    far = [max(abs(_in_plan(end)[1]) for end in pair) for pair in ends]
    beside = [distance for distance in far if distance > NOTHING]
    if not beside:
        return ""
    alone = say("a link acts beside it, by up to {far:.3g} m, without the torsion of that")
    several = say("{count} links act beside it, by up to {far:.3g} m, without the torsion of that")
    return (alone if len(beside) == 1 else several).of(count=len(beside), far=max(beside))
