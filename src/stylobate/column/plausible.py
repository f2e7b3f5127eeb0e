"""Implausible values: sizes, densities and joints that a slip of units makes, and widths that seem swapped."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from ..messages import say
from .joint import Joint
from .stack import Stack


class Measure(NamedTuple):
    """Plausible values of a quantity of stone columns: its unit, its range, a usual value, and other units in that unit."""

    unit: str
    low: float
    high: float
    usual: float
    others: Mapping[str, float]

    def holds(self, value: float) -> bool:
        """Whether a value is plausible."""
        return self.low <= value <= self.high

    def doubt(self, name: str, value: float, what: str, alike: Sequence[Quantity] = ()) -> list[str]:
        """The doubt about a value beyond the range, as a list of one sentence without its full stop; else none.

        The unit that it names is one in which the value is plausible, and with it all that was measured ``alike``.
        """
        if self.holds(value):
            return []
        doubt = say("{name} is {value:g} {m.unit}, and {what} {m.low:g} to {m.high:g} {m.unit}: {unit}")
        return [doubt.of(name=name, value=value, what=what, m=self, unit=likely_unit(alike or [Quantity(self, value)]))]


class Quantity(NamedTuple):
    """A value and what it measures."""

    measure: Measure
    value: float


def likely_unit(alike: Sequence[Quantity]) -> str:
    """The question that ends a doubt: whether values are in the unit that brings all of them nearest to the usual ones.

    Inches and feet have to bring them nearer than cm by a factor of :data:`RARER`, in the mean over the values.
    """

    def distance(name: str) -> float:
        away = [abs(math.log(value * measure.others[name] / measure.usual)) for measure, value in alike]
        return statistics.fmean(away) + (math.log(RARER) if name in ("inches", "feet") else 0.0)

    fits = [
        name
        for name in alike[0].measure.others
        if all(measure.holds(value * measure.others[name]) for measure, value in alike)
    ]
    return say("was it meant in {unit}?", unit=min(fits, key=distance)) if fits else say("is the unit right?")


#: How much less often stones are measured in inches and feet than in cm, as a factor of how usual the size is [-].
RARER = 2.0

_LENGTHS = {"cm": 1e-2, "mm": 1e-3, "inches": 0.0254, "feet": 0.3048}

#: Columns and drums from models on a shaking table to half as large again as the largest that were ever put up.
COLUMN = Measure("m", 0.05, 60.0, 8.0, _LENGTHS)
DRUM = Measure("m", 0.005, 30.0, 1.0, _LENGTHS)
WIDTH = Measure("m", 0.005, 10.0, 1.2, _LENGTHS)

#: The longest side of a stone of an assembly, which may be a whole column.
STONE = Measure("m", 0.05, 60.0, 1.2, _LENGTHS)

DENSITY = Measure("kg/m³", 500.0, 5000.0, 2500.0, {"g/cm³": 1e3, "kN/m³": 101.97, "lb/ft³": 16.018})

#: Range of values outside which nobody has measured joints of stone.
STIFFNESS = Measure("N/m³", 1e7, 1e13, 2e10, {"kN/m³": 1e3, "MPa/m": 1e6, "N/mm³": 1e9})

#: Largest friction coefficient that was measured on stone [-].
ROUGHEST = 2.0

#: Largest height over width of columns, and of drums where there are so many of them: half as much again as the most
#: slender columns of stone that stand, and as the tallest drums of such columns [-].
SLENDEREST, DRUMS, TALLEST = 15.0, 5, 2.2

#: Largest over smallest of what is alike, and how far from it a decimal point in the wrong place puts a value at least [-].
ALIKE, DECIMAL = 2.5, 5.0

#: Share of the width of a joint beyond which a drum is hardly found off the one below: their centroids are near an edge [-].
FARTHEST = 0.3

#: By so much dry joints of stone close under the weight on them, at most [m].
CLOSES = 5e-4


def unit_doubts(column: Stack) -> list[str]:
    """Parts of a column that look like a slip of units, each kind once: sizes, densities, joints."""
    return size_doubts(column) + law_doubts(column)


def law_doubts(column: Stack) -> list[str]:
    """Joints of a column that look like a slip of units, or that it sinks into as into none."""
    return first(joint_doubts(joint) for joint in dict.fromkeys(column.joints)) or _sinking(column)


def size_doubts(column: Stack) -> list[str]:
    """Sizes and densities of a column that look like a slip of units, each kind once."""
    widths = [(one.bottom_width, one.top_width) for one in column.drums]
    depths = [one.depth for one in column.drums if column.section != "circular"]
    doubts = length_doubts(column.heights.tolist(), widths, depths) or _slenderness_doubt(column)
    doubts += decimal_doubts("height", column.heights.tolist())
    doubts += decimal_doubts("width", [0.5 * sum(pair) for pair in widths])
    densities = [drum.density for drum in column.drums]
    return doubts + first(
        DENSITY.doubt(f"the density of drum {i + 1}", density, "stone has") for i, density in enumerate(densities)
    )


def length_doubts(
    heights: Sequence[float], widths: Sequence[tuple[float, float]], depths: Sequence[float] = ()
) -> list[str]:
    """Lengths of a column that look like a slip of units, each kind once, and all in one unit.

    Parameters
    ----------
    heights : sequence of float
        Of the drums from the base up [m].
    widths : sequence of (float, float)
        Of their lower and upper faces [m].
    depths : sequence of float
        Of their lower faces, where these are not round [m].
    """
    drums = [(f"the height of drum {i}", float(one)) for i, one in enumerate(heights, 1)]
    column = [("the height of the column", float(sum(heights)))]
    single = 0 < sum(not DRUM.holds(height) for _, height in drums) < len(drums)  # else one drum alone, or all of it
    faces = [
        (f"the width of the {face} face of drum {i}", float(width))
        for i, pair in enumerate(widths, 1)
        for face, width in zip(("lower", "upper"), pair, strict=True)
    ]
    sides = [(f"the depth of drum {i}", float(depth)) for i, depth in enumerate(depths, 1)]
    kinds = [(DRUM, drums, "drums have") if single else (COLUMN, column, "columns have")]
    kinds += [(WIDTH, faces, "stones have"), (WIDTH, sides, "stones have")]
    alike = []
    for measure, named, _ in kinds:
        beyond = [value for _, value in named if not measure.holds(value)]
        alike += [Quantity(measure, max(beyond, key=lambda value: abs(math.log(value))))] if beyond else []
        if measure is COLUMN and beyond and len(drums) > 1:
            alike.append(Quantity(DRUM, statistics.median(heights)))
    return [
        doubt
        for measure, named, what in kinds
        for doubt in first(measure.doubt(name, value, what, alike) for name, value in named)
    ]


def decimal_doubts(name: str, values: Sequence[float]) -> list[str]:
    """The doubt about one drum among others alike that a decimal point in the wrong place makes; else none.

    Parameters
    ----------
    name : str
        What was measured.
    values : sequence of float
        Of the drums from the base up [m].
    """
    if len(values) < DRUMS:
        return []
    for number, value in enumerate(values, 1):
        others = [*values[: number - 1], *values[number:]]
        usual = statistics.median(others)
        if max(others) <= ALIKE * min(others) and DECIMAL <= max(value / usual, usual / value) <= DECIMAL * 4.0:
            doubt = say(
                "the {name} of drum {number} is {value:g} m, and that of the others {low:g} to {high:g} m: is its decimal "
                "point in the right place?"
            )
            return [doubt.of(name=say(name), number=number, value=value, low=min(others), high=max(others))]
    return []


def field_in_doubt(column: Stack) -> str | None:
    """Path of the first size or density of a drum that no drum has, or of the one that is unlike the others; else None."""
    for key, measure in (("height", DRUM), ("bottom_width", WIDTH), ("top_width", WIDTH), ("density", DENSITY)):
        values = [getattr(drum, key) for drum in column.drums]
        usual = statistics.median(values)
        most = max(range(len(values)), key=lambda i: abs(math.log(values[i] / usual)))
        beyond = [i for i, value in enumerate(values) if not measure.holds(value)]
        if beyond or decimal_doubts(key, values):
            return f"drum.{(beyond or [most])[0] + 1}.{key}"
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
    """Stones of an assembly and laws of its joints that look like a slip of units, each kind once."""
    doubts = first(side_doubts(f"the size of block {one.name!r}", one.sides) for one in pieces)
    doubts += first(DENSITY.doubt(f"the density of block {one.name!r}", one.density, "stone has") for one in pieces)
    beyond = first(joint_doubts(law) for law in dict.fromkeys(laws))
    return doubts + (
        beyond
        or first(
            sinking_doubt(
                say("block {name!r}", name=name),
                density * gravity * sides[-1] / law.normal_stiffness,
                law.normal_stiffness,
            )
            for name, sides, density, law in pieces
        )
    )


def side_doubts(name: str, sides: Sequence[float]) -> list[str]:
    """The doubt about a stone by the sides of the box around it [m]: too long, or too wide across; else none."""
    *_, across, along = sorted(sides)
    alike = [one for one in (Quantity(STONE, along), Quantity(WIDTH, across)) if not one.measure.holds(one.value)]
    doubts = STONE.doubt(name, along, "stones have", alike)
    return doubts or WIDTH.doubt(f"{name} across", across, "stones have", alike)


def bulk_doubts(name: str, sides: Sequence[float]) -> list[str]:
    """As :func:`side_doubts`, of what may be a support: too long, or too thick in every direction."""
    doubts = STONE.doubt(name, max(sides), "stones have")
    return doubts or (WIDTH.doubt(name, min(sides), "stones have at their thinnest") if min(sides) > WIDTH.high else [])


def _slenderness_doubt(column: Stack) -> list[str]:
    """The doubt about a column far more slender than any that stands, as one becomes whose radii are given for widths."""
    width = statistics.median(0.5 * (drum.bottom_width + drum.top_width) for drum in column.drums)
    often, of_drums = column.height / width, statistics.median(column.heights) / width
    if often > SLENDEREST:
        what = f"the height of the column, {column.height:g} m, is {often:.3g} times its width of {width:.3g} m"
        what += ", and columns of stone"
        most = SLENDEREST
    elif column.n >= DRUMS and of_drums > TALLEST:
        what = f"drums are {of_drums:.3g} times as high as wide ({width:.3g} m), and those of columns of many drums"
        most = TALLEST
    else:
        return []
    slip = "the radius, where the diameter is asked for" if column.section == "circular" else "half of the width"
    return [f"{what} reach some {most:g} times: is {width:.3g} m {slip}?"]


def joint_doubts(joint: Joint) -> list[str]:
    """Values of a joint beyond all that was measured on stone, in words."""
    found = []
    if joint.tan_phi > ROUGHEST:
        found.append(
            f"friction_coefficient is {joint.tan_phi:.4g}, and nobody has measured more than {ROUGHEST:g} on stone: "
            "was it meant as friction_angle?"
        )
    for name in ("normal_stiffness", "shear_stiffness"):
        found += STIFFNESS.doubt(name, getattr(joint, name), "nobody has measured but")
    return found


def sinking_doubt(name: str, closure: float, stiffness: float) -> list[str]:
    """The doubt about what sinks into its joint by ``closure`` [m] under its weight, on ``stiffness`` [N/m³]; else none."""
    if closure <= CLOSES:
        return []
    doubt = say(
        "{name} sinks by {depth:.2g} mm into its joint under the weight on it, whose normal_stiffness is {stiffness:g} N/m³, "
        "and dry joints of stone close by less than {limit:g} mm: {unit}"
    )
    unit = likely_unit([Quantity(STIFFNESS, stiffness)])
    return [doubt.of(name=name, depth=1e3 * closure, stiffness=stiffness, limit=1e3 * CLOSES, unit=unit)]


def _sinking(column: Stack) -> list[str]:
    most = int(column.joint_closures.argmax())
    closure, law = float(column.joint_closures[most]), column.joints[most]
    return sinking_doubt(say("drum {number}", number=most + 1), closure, law.normal_stiffness)


def found_doubts(column: Any) -> list[str]:
    """The doubt about the first drum of a column as found that stands near the edge of the one below; else none."""
    said = say("drum {drum} is found {far:g} m off the one below, {share:.2g} of its width: is the unit right?")
    return first(
        [said.of(drum=one.drum, far=abs(one.offset), share=often)]
        for one in column.as_found.drums
        if (often := abs(one.offset) / column.drums[one.drum - 1].bottom_width) > FARTHEST
    )


def shape_doubts(column: Stack, name: str) -> list[str]:
    """Widths of a column that look as if they were swapped or turned over; capitals widen upward, and are none.

    A drum that widens upward is doubted where it would fit the faces that it touches better with its widths swapped, or
    where nothing stands on it or under it. Drums that all fit are doubted where the column is narrowest at the base.
    """
    drums = column.drums
    wide = [i for i, drum in enumerate(drums) if drum.top_width > drum.bottom_width * (1.0 + 1e-12)]
    swapped = [i for i in wide if column.n == 1 or _fits(column, i, swapped=True) < _fits(column, i) * (1.0 - 1e-9)]
    end = "this is computed as given:"
    if swapped:
        which = ", ".join(str(i + 1) for i in swapped[:5]) + (" …" if len(swapped) > 5 else "")
        said = f"drum {which} of {name!r} widens upward (top_width > bottom_width)"
        return [f"{said}; {end} swap the widths if it was not meant."]
    narrowest = min(min(drum.bottom_width, drum.top_width) for drum in drums)
    if wide and wide[0] == 0 and drums[0].bottom_width <= narrowest * (1.0 + 1e-12):
        return [
            f"{name!r} widens upward from its base, where it is narrowest; {end} drums are given from the bottom up, "
            "and bottom_width before top_width."
        ]
    return []


def _fits(column: Stack, i: int, *, swapped: bool = False) -> float:
    """By how much the widths of a drum's faces differ from those of the faces that they touch [m]."""
    bottom, top = column.drums[i].bottom_width, column.drums[i].top_width
    if swapped:
        bottom, top = top, bottom
    under = abs(bottom - column.drums[i - 1].top_width) if i else 0.0
    return under + (abs(top - column.drums[i + 1].bottom_width) if i + 1 < column.n else 0.0)


def first(found: Iterable[Sequence[str]]) -> list[str]:
    """The first of them that says anything."""
    return list(next((one for one in found if one), ()))
