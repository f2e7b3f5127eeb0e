"""Ranges of what stands of stone: what lies beyond one is computed as given, and warned of."""

from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from ..messages import joined, say
from .joint import Joint
from .stack import Stack


class Range(NamedTuple):
    """Values of a quantity that stone is known to have, from ``low`` to ``high`` in a unit."""

    known: str
    low: float
    high: float
    unit: str = ""

    def holds(self, value: float) -> bool:
        """Whether a value is in the range."""
        return self.low <= value <= self.high

    def doubts(self, values: Iterable[tuple[str, float]]) -> list[str]:
        """The doubt about the first of some values with their names that is beyond the range; else none."""
        unit = say(" {self.unit}", self=self) if self.unit else ""
        beyond = next(((name, value) for name, value in values if not self.holds(value)), None)
        if beyond is None:
            return []
        name, value = beyond
        return [
            say(
                "{name} is {value:.4g}{unit}, and {self.known} {self.low:g} to {self.high:g}{unit}: check it and its "
                "unit.",
                name=name,
                value=value,
                unit=unit,
                self=self,
            )
        ]


#: Columns and drums from models on a shaking table to half as large again as the largest that were ever put up.
COLUMN = Range(say("columns have"), 0.05, 60.0, "m")
DRUM = Range(say("drums have"), 0.005, 30.0, "m")
WIDTH = Range(say("stones have"), 0.005, 10.0, "m")
#: The longest side of a stone of an assembly, which may be a whole column, and the shortest one of what may be a support.
STONE = Range(say("stones have"), 0.05, 60.0, "m")
THINNEST = Range(say("stones have at their thinnest"), 0.0, 10.0, "m")
#: Height over width: half as much again as the most slender columns of stone that stand, and, where there are at least
#: :data:`MANY` drums, as the tallest drums of such columns.
SLENDER = Range(say("columns of stone have"), 0.0, 15.0)
TALL, MANY = Range(say("those of columns of many drums have"), 0.0, 2.2), 5
DENSITY = Range(say("stone has"), 500.0, 5000.0, "kg/m³")
#: Of joints of stone, as measured; by so much dry ones close under the weight on them.
STIFFNESS = Range(say("nobody has measured but"), 1e7, 1e13, "N/m³")
FRICTION = Range(say("nobody has measured but"), 0.0, 2.0)
CLOSURE = Range(say("dry joints of stone close by"), 0.0, 0.5, "mm")
#: What is stated of links, from a peg of a model on a shaking table to a tendon of a tower.
CAPACITY = Range(say("links bear"), 50.0, 1e8, "N")
LINK_STIFFNESS = Range(say("links have"), 1e4, 1e12, "N/m")
#: Share of the width of a joint beyond which a drum is hardly found off the one below: their centroids are near an edge.
OFFSET = Range(say("drums are found with"), 0.0, 0.3)


def unit_doubts(column: Stack) -> list[str]:
    """Parts of a column beyond what is known, each kind once: sizes, densities, joints."""
    return size_doubts(column) + law_doubts(column)


def law_doubts(column: Stack) -> list[str]:
    """Joints of a column beyond what was measured, or that close more than joints of stone."""
    doubts = joint_doubts(column.joints)
    closures = zip(column.joint_closures.tolist(), column.joints, strict=True)
    return doubts or closing_doubts(
        (say("joint {i}", i=i), closure, law) for i, (closure, law) in enumerate(closures, 1)
    )


def link_doubts(values: Mapping[str, Any]) -> list[str]:
    """Forces and stiffnesses that are stated of a link and that no link has: another unit is meant."""
    return [
        doubt
        for end, known in (
            ("_capacity", CAPACITY),
            ("axial_stiffness", LINK_STIFFNESS),
            ("shear_stiffness", LINK_STIFFNESS),
        )
        for doubt in known.doubts((name, value) for name, value in values.items() if name.endswith(end) and value)
    ]


def size_doubts(column: Stack) -> list[str]:
    """Sizes and densities of a column beyond what is known, each kind once."""
    drums = column.drums
    widths = [(drum.bottom_width, drum.top_width) for drum in drums]
    doubts = length_doubts(
        column.heights.tolist(), widths, [drum.depth for drum in drums if column.section != "circular"]
    )
    if not doubts:
        width = statistics.median(0.5 * sum(pair) for pair in widths)
        doubts = SLENDER.doubts([(say("the height of the column over its width"), column.height / width)])
        if not doubts and column.n >= MANY:
            doubts = TALL.doubts(
                [(say("the height of drums over their width"), statistics.median(column.heights) / width)]
            )
    return doubts + DENSITY.doubts(
        (say("the density of drum {i}", i=i), drum.density) for i, drum in enumerate(drums, 1)
    )


def length_doubts(
    heights: Sequence[float], widths: Sequence[tuple[float, float]], depths: Sequence[float] = ()
) -> list[str]:
    """Lengths of a column beyond what is known, each kind once.

    Parameters
    ----------
    heights : sequence of float
        Of the drums from the base up [m].
    widths : sequence of (float, float)
        Of their lower and upper faces [m].
    depths : sequence of float
        Of their lower faces, where these are not round [m].
    """
    faces = [
        (say("the width of the {face} face of drum {i}", face=face, i=i), width)
        for i, pair in enumerate(widths, 1)
        for face, width in zip(("lower", "upper"), pair, strict=True)
    ]
    high = DRUM.doubts((say("the height of drum {i}", i=i), height) for i, height in enumerate(heights, 1))
    high = high or COLUMN.doubts([(say("the height of the column"), sum(heights))])
    deep = WIDTH.doubts((say("the depth of drum {i}", i=i), depth) for i, depth in enumerate(depths, 1))
    return high + WIDTH.doubts(faces) + deep


def field_in_doubt(column: Stack) -> str | None:
    """Path of the first size or density of a drum that no drum has; None where all have been known."""
    for key, known in (("height", DRUM), ("bottom_width", WIDTH), ("top_width", WIDTH), ("density", DENSITY)):
        for number, drum in enumerate(column.drums, 1):
            if not known.holds(getattr(drum, key)):
                return f"drum.{number}.{key}"
    return None


class Piece(NamedTuple):
    """A stone of an assembly that can move.

    Its name, the sides of the box around it [m], the last of them upward, its density [kg/m³], and the law under it.
    """

    name: str
    sides: tuple[float, ...]
    density: float
    law: Joint


def piece_doubts(pieces: Sequence[Piece], laws: Iterable[Joint], gravity: float) -> list[str]:
    """Stones of an assembly and laws of its joints beyond what is known, each kind once."""
    sizes = [(say("the size of block {one.name!r}", one=piece), sorted(piece.sides)) for piece in pieces]
    doubts = STONE.doubts((name, sides[-1]) for name, sides in sizes)
    doubts = doubts or WIDTH.doubts((say("{name} across", name=name), sides[-2]) for name, sides in sizes)
    doubts += DENSITY.doubts((say("the density of block {one.name!r}", one=piece), piece.density) for piece in pieces)
    closed = (
        (say("the joint under block {name!r}", name=name), density * gravity * sides[-1] / law.normal_stiffness, law)
        for name, sides, density, law in pieces
    )
    return doubts + (joint_doubts(laws) or closing_doubts(closed))


def bulk_doubts(name: str, sides: Sequence[float]) -> list[str]:
    """The doubt about what may be a support by the sides of the box around it [m]: too long, or thick in every direction."""
    return STONE.doubts([(name, max(sides))]) or THINNEST.doubts([(name, min(sides))])


def joint_doubts(laws: Iterable[Joint]) -> list[str]:
    """Values of joints beyond all that was measured on stone, each kind once."""
    distinct_laws = list(dict.fromkeys(laws))
    doubts = FRICTION.doubts(("friction_coefficient", law.tan_phi) for law in distinct_laws)
    for name in ("normal_stiffness", "shear_stiffness"):
        doubts += STIFFNESS.doubts((name, getattr(law, name)) for law in distinct_laws)
    return doubts


def closing_doubts(closures: Iterable[tuple[str, float, Joint]]) -> list[str]:
    """The doubt about the first joint that closes too far [m] under the weight on it; else none."""
    return CLOSURE.doubts(
        (
            say(
                "with a normal_stiffness of {law.normal_stiffness:g} N/m³ the closure of {name} by weight",
                law=law,
                name=name,
            ),
            1e3 * closure,
        )
        for name, closure, law in closures
        if closure > 0.0  # a gravity that is none is refused where it is checked
    )


def found_doubts(column: Any) -> list[str]:
    """The doubt about the first drum of a column as found that stands near the edge of the one below; else none."""
    drums = column.as_found.drums
    return OFFSET.doubts(
        (
            say("the offset of drum {one.drum} over its width", one=drum),
            abs(drum.offset) / column.drums[drum.drum - 1].bottom_width,
        )
        for drum in drums
    )


def shape_doubts(column: Stack, name: str) -> list[str]:
    """Widths of a column that look as if they were swapped or turned over; capitals widen upward, and are none.

    A drum that widens upward is doubted where it would fit the faces that it touches better with its widths swapped, or
    where nothing stands on it or under it. Drums that all fit are doubted where the column is narrowest at the base.
    """
    drums = column.drums
    wide = [i for i, drum in enumerate(drums) if drum.top_width > drum.bottom_width * (1.0 + 1e-12)]
    swapped = [i for i in wide if column.n == 1 or _fits(column, i, swapped=True) < _fits(column, i) * (1.0 - 1e-9)]
    if swapped:
        which = joined(", ", (str(i + 1) for i in swapped[:5])) + (" …" if len(swapped) > 5 else "")
        return [
            say(
                "drum {which} of {name!r} widens upward (top_width > bottom_width); this is computed as given: swap the "
                "widths if it was not meant.",
                which=which,
                name=name,
            )
        ]
    narrowest = min(min(drum.bottom_width, drum.top_width) for drum in drums)
    if wide and wide[0] == 0 and drums[0].bottom_width <= narrowest * (1.0 + 1e-12):
        return [
            say(
                "{name!r} widens upward from its base, where it is narrowest; this is computed as given: drums are given "
                "from the bottom up, and bottom_width before top_width.",
                name=name,
            )
        ]
    return []


def _fits(column: Stack, i: int, *, swapped: bool = False) -> float:
    """By how much the widths of a drum's faces differ from those of the faces that they touch [m]."""
    bottom, top = column.drums[i].bottom_width, column.drums[i].top_width
    if swapped:
        bottom, top = top, bottom
    under = abs(bottom - column.drums[i - 1].top_width) if i else 0.0
    return under + (abs(top - column.drums[i + 1].bottom_width) if i + 1 < column.n else 0.0)
