"""Implausible values: sizes, densities and joints that a slip of units makes, and widths that seem swapped."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from .joint import Joint
from .stack import Stack


class Measure(NamedTuple):
    """Plausible values of a quantity of stone columns: its unit, its range, a usual value, and other units in that unit."""

    unit: str
    low: float
    high: float
    usual: float
    others: Mapping[str, float]

    def likely_unit(self, value: float) -> str:
        """The question that ends a doubt: whether the value is in the unit that brings it nearest to the usual one."""

        def distance(name: str) -> float:
            return abs(math.log(value * self.others[name] / self.usual))

        fits = [name for name, factor in self.others.items() if self.low <= value * factor <= self.high]
        return f"was it meant in {min(fits, key=distance)}?" if fits else "is the unit right?"

    def doubt(self, name: str, value: float, what: str) -> list[str]:
        """The doubt about a value beyond the range, as a list of one sentence without its full stop; else none."""
        if self.low <= value <= self.high:
            return []
        return [
            f"{name} is {value:g} {self.unit}, and {what} {self.low:g} to {self.high:g} {self.unit}: "
            f"{self.likely_unit(value)}"
        ]


_LENGTHS = {"cm": 1e-2, "mm": 1e-3, "inches": 0.0254, "feet": 0.3048}

#: Columns and drums from models on a shaking table to half as large again as the largest that were ever put up.
COLUMN = Measure("m", 0.05, 60.0, 8.0, _LENGTHS)
DRUM = Measure("m", 0.005, 30.0, 1.0, _LENGTHS)
WIDTH = Measure("m", 0.005, 10.0, 1.2, _LENGTHS)
DENSITY = Measure("kg/m³", 500.0, 5000.0, 2500.0, {"g/cm³": 1e3, "kN/m³": 101.97, "lb/ft³": 16.018})

#: Range of values outside which nobody has measured joints of stone.
STIFFNESS = Measure("N/m³", 1e7, 1e13, 2e10, {"kN/m³": 1e3, "MPa/m": 1e6, "N/mm³": 1e9})

#: Largest friction coefficient that was measured on stone [-].
ROUGHEST = 2.0

#: Largest height over width of columns, and of drums where there are so many of them: half as much again as the most
#: slender columns of stone that stand, and as the tallest drums of such columns [-].
SLENDEREST, DRUMS, TALLEST = 15.0, 5, 2.2

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
    single = [DRUM.doubt(f"the height of drum {i}", float(h), "drums have") for i, h in enumerate(column.heights, 1)]
    doubts = [] if all(single) else first(single)  # one drum alone, or the whole column
    doubts = doubts or COLUMN.doubt("the height of the column", column.height, "columns have")
    doubts += first(
        WIDTH.doubt(f"the width of the {face} face of drum {i}", width, "columns have")
        for i, one in enumerate(column.drums, 1)
        for face, width in (("lower", one.bottom_width), ("upper", one.top_width))
    )
    doubts = doubts or _slenderness_doubt(column)
    densities = [drum.density for drum in column.drums]
    return doubts + first(
        DENSITY.doubt(f"the density of drum {i + 1}", density, "stone has") for i, density in enumerate(densities)
    )


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
    return [
        f"{name} sinks by {1e3 * closure:.2g} mm into its joint under the weight on it, whose normal_stiffness is "
        f"{stiffness:g} N/m³, and dry joints of stone close by less than {1e3 * CLOSES:g} mm: "
        f"{STIFFNESS.likely_unit(stiffness)}"
    ]


def _sinking(column: Stack) -> list[str]:
    most = int(column.joint_closures.argmax())
    closure, law = float(column.joint_closures[most]), column.joints[most]
    return sinking_doubt(f"drum {most + 1}", closure, law.normal_stiffness)


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
