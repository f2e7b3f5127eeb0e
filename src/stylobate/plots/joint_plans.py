"""Plans of joints before the motion: the faces on one another, offsets and chips as found, and links."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..column import Column
from ..column.as_found import IN_LINE
from ..column.found_in_space import rotation, space_geometry
from ..column.shapes import cut
from ..column.spatial.touching import SpaceJoint
from ..column.structure import Structure
from ..constants import DEGREE
from ..messages import joined, say
from .elevation import words_of_found
from .style import BLUE, BROWN, GREY, RED, SAND, page, styled
from .views import draw_views, sheet_size

#: Joints beside one another and height of a row of them [inch], of few and of many, and most joints that are drawn.
FEW, MANY, MOST = (4, 2.15), (6, 1.6), 30

#: From line to line of the words under a plan [points].
LINE = 8.2

#: Corners of a circle.
AROUND = 120


@dataclass(frozen=True, eq=False)
class JointPlan:
    """Faces of one joint, in its axes from a common origin [m].

    Parameters
    ----------
    title : str
    below, above : array or None
        Corners of the upper face of what is below and of the lower face of what is above, shape (k, 2); None of a base.
    said : str
        Sizes.
    found : str
        What is as found.
    links : tuple of (float, float)
        Where links cross it.
    offset : (float, float)
        Of the middle of the face above.
    """

    title: str
    below: np.ndarray | None
    above: np.ndarray
    said: str = ""
    found: str = ""
    links: tuple[tuple[float, float], ...] = ()
    offset: tuple[float, float] = (0.0, 0.0)
    marked: bool = False


def joint_plans(structure: Structure) -> list[JointPlan]:
    """Plans of the joints of a column or of an assembly in space; those of one in the plane are lines and have none."""
    if structure.stack is not None:
        return _of_column(structure.stack)
    found = []
    for number, joint in enumerate(structure.space_joints or (), 1):
        names = [structure.bodies[body].name for body in (joint.lower, joint.upper)]
        corners = []
        for face in (joint.below, joint.above):
            points = face.middle + np.pad(face.corners, ((0, 0), (0, 1))) @ face.frame.T
            corners.append(((points - joint.origin) @ joint.frame)[:, :2])
        on_ground = structure.ground is not None and joint.lower == 0
        pair = {joint.lower, joint.upper}
        links = [link for link in structure.placed_links if {link.lower, link.upper} == pair and not link.straight]
        crossing = [((np.array(link.middle) - joint.origin) @ joint.frame)[:2] for link in links]
        said = f"{names[0]} –\n{names[1]}" if len("".join(names)) > 18 else f"{names[0]} – {names[1]}"
        sizes, words, offset = _of_round_faces(joint, on_ground)
        said += f"\n{sizes}" * bool(sizes)
        below = None if on_ground else corners[0]
        plan = JointPlan(say("joint {number}", number=number), below, corners[1], said, words, _pairs(crossing))
        found.append(replace(plan, offset=offset, marked=bool(words)))
    return found


def _of_round_faces(joint: SpaceJoint, on_ground: bool) -> tuple[str, str, tuple[float, float]]:
    """Diameters, what is off or lost where round faces meet, and by how much in the joint's axes [m]."""
    discs = [face.edges.discs for face in (joint.below, joint.above)]
    if len(discs[1]) != 1 or (not on_ground and len(discs[0]) != 1):
        return "", "", (0.0, 0.0)
    radii = [0.0 if not one else one[0][1] for one in discs]
    same = on_ground or abs(radii[0] - radii[1]) < IN_LINE
    sizes = f"⌀ {2.0 * radii[1]:.3f}" + ("" if same else f" on ⌀ {2.0 * radii[0]:.3f}") + " m"
    words, off = [], (0.0, 0.0)
    if not on_ground:
        moved = joint.above.middle - joint.below.middle
        if math.hypot(*moved[:2]) >= IN_LINE:
            words.append(
                say(
                    "offset {far:.0f} mm to {azimuth:.0f}°",
                    far=1000.0 * math.hypot(*moved[:2]),
                    azimuth=_azimuth(moved),
                )
            )
            ((x, y),) = _pairs([((joint.above.middle - joint.origin) @ joint.frame)[:2]])
            off = x, y
    for normal, bound in joint.above.edges.sides:
        lost, towards = radii[1] - bound, joint.above.frame[:, :2] @ normal
        words.append(say("chip {far:.0f} mm to {azimuth:.0f}°", far=1000.0 * lost, azimuth=_azimuth(towards)))
    return sizes, joined("\n", words), off


def _azimuth(way: np.ndarray) -> float:
    """From x towards y [degrees]."""
    return math.degrees(math.atan2(way[1], way[0])) % 360.0


def _of_column(column: Column) -> list[JointPlan]:
    at, plans = space_geometry(column), []
    for j, drum in enumerate(column.drums):
        one, middle = column.as_found.of(j + 1), at.offset[j]
        above = _face(drum.circular, drum.bottom_width, drum.depth, float(at.turned[j])) + middle
        if one.chipped:
            turn = rotation(np.array([0.0, 0.0, 1.0]), float(at.turned[j]) + one.chip_azimuth * DEGREE)[:2, :2]
            half = (0.5 * drum.bottom_width, 0.5 * (drum.bottom_width if drum.circular else drum.depth))
            for axis, sign, chip in ((0, -1, 0), (0, 1, 1), (1, -1, 2), (1, 1, 3)):
                normal = sign * turn[:, axis]
                above = cut(above, normal, float(normal @ middle) + half[axis] - one.chips[chip])
        below, said = None, _size(drum.circular, drum.bottom_width, drum.depth)
        if j:
            lower = column.drums[j - 1]
            below = _face(lower.circular, lower.top_width, lower.upper_depth, float(at.turned[j - 1]))
            if (lower.top_width, lower.upper_depth) != (drum.bottom_width, drum.depth):
                said += f" on {_size(lower.circular, lower.top_width, lower.upper_depth)}"
        turn = rotation(np.array([0.0, 0.0, 1.0]), float(at.turned[j]))[:2, :2]
        crossing = [link for link in column.placed_links if link.crosses(j) and link.mark != "sheet"]
        places = [middle + turn @ np.array(link.middle[:2]) for link in crossing]
        found = joined("\n", words_of_found(column.as_found, j + 1))
        offset = float(middle[0]), float(middle[1])
        title = say("joint {number}", number=j + 1)
        plans.append(JointPlan(title, below, above, said + " m", found, _pairs(places), offset, bool(found)))
    return plans


def _pairs(places: Sequence[np.ndarray]) -> tuple[tuple[float, float], ...]:
    return tuple((float(x), float(y)) for x, y in places)


def _face(circular: bool, width: float, depth: float, turned: float) -> np.ndarray:
    if circular:
        angle = np.arange(AROUND) * (2.0 * math.pi / AROUND)
        return 0.5 * width * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    corners = 0.5 * np.array([[-width, -depth], [width, -depth], [width, depth], [-width, depth]])
    return corners @ rotation(np.array([0.0, 0.0, 1.0]), turned)[:2, :2].T


def _size(circular: bool, width: float, depth: float) -> str:
    return f"⌀ {width:.3f}" if circular else f"{width:.3f} × {depth:.3f}"


@styled
def draw_sheet(structure: Structure, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """What stands, before the motion: :func:`draw_views`, and under it the plan of every joint, x to the right.

    The face above is sand, that below a dashed line; what is as found is red, links are blue.

    Parameters
    ----------
    structure : Column, Assembly, SpatialAssembly or Specimen
    title : str, optional
        None by default.
    figure : Figure or SubFigure, optional
        Draw in it; a new one of the size that it needs by default.
    """
    plans = joint_plans(structure)
    shown = plans[:MOST]
    wide, high = sheet_size(structure)
    beside, row = FEW if len(shown) <= 12 else MANY
    rows = -(-len(shown) // beside)
    row += LINE / 72.0 * max([0, *(lines_under(plan) - 2 for plan in shown)])
    if not rows:
        return draw_views(structure, title, figure=figure)
    figure = page(figure, (wide, high + row * rows + 0.3))
    parts: Any = figure.subfigures(2, 1, height_ratios=(high, row * rows + 0.3))
    above, below = parts
    draw_views(structure, title, figure=above)
    left_out = "" if len(plans) <= MOST else f"; joints {MOST + 1} to {len(plans)} are not drawn"
    _heading(below, f"plans of joints, {plan_axes(structure)}{left_out}")
    panels = below.subplots(rows, beside, squeeze=False)
    for axes, plan, half in zip(panels.flat, shown, plan_reach(structure, shown)):
        draw_plan(axes, plan, half)
    for axes in panels.flat[len(shown) :]:
        axes.set_axis_off()
    return figure


def plan_axes(structure: Structure) -> str:
    """Which way plans of joints lie, and the slope of the base, in words."""
    seen = "each along its own axes" if structure.stack is None else "x to the right, y upward"
    tilt = structure.as_found.base_tilt
    rise = f"; the base rises by {abs(tilt):g}° to {structure.as_found.base_azimuth + 180.0 * (tilt < 0.0):g}°"
    return f"{seen}{rise}" if tilt else seen


def plan_reach(structure: Structure, plans: Sequence[JointPlan]) -> list[float]:
    """Half the side of the square around each plan [m]; of a column one for all, so that they can be laid on one another."""
    each = [1.06 * float(np.abs(np.concatenate([_centred(plan), _there(plan.below)])).max()) for plan in plans]
    return [max(each)] * len(each) if structure.stack is not None else each


def lines_under(plan: JointPlan) -> int:
    """Lines of words under a plan."""
    return sum(1 + words.count("\n") for words in (plan.said, plan.found) if words)


def _heading(figure: SubFigure, text: str) -> None:
    figure.suptitle(text, x=0.02, ha="left", fontsize=8.5, color=GREY, weight="normal")


def _there(corners: np.ndarray | None) -> np.ndarray:
    return np.empty((0, 2)) if corners is None else corners


def _centred(plan: JointPlan) -> np.ndarray:
    """The face above, from the middle of the picture [m]: its own where there is none below."""
    return plan.above if plan.below is not None else plan.above - _middle(plan.above)


def _middle(corners: np.ndarray) -> np.ndarray:
    return 0.5 * (corners.min(axis=0) + corners.max(axis=0))


def draw_plan(axes: Axes, plan: JointPlan, half: float) -> None:
    """One plan in the middle of a square of twice ``half`` [m]."""
    face, edge = ("#f7e3df", RED) if plan.marked else (SAND, BROWN)
    axes.fill(*plan.above.T, facecolor=face, edgecolor=edge, linewidth=0.8)
    if plan.below is not None:
        axes.fill(*plan.below.T, facecolor="none", edgecolor=GREY, linewidth=0.7, linestyle=(0, (4, 2)))
    for start, end in (((-half, 0.0), (half, 0.0)), ((0.0, -half), (0.0, half))):
        axes.plot(*zip(start, end), color=GREY, linewidth=0.35, linestyle=(0, (8, 2, 1, 2)))
    if plan.marked and any(plan.offset):
        axes.plot(*plan.offset, "+", color=RED, markersize=7, markeredgewidth=1.0)
    for x, y in plan.links:
        axes.plot(x, y, "s", color=BLUE, markersize=3.5)
    axes.set_aspect("equal")
    middle = _middle(plan.above) if plan.below is None else np.zeros(2)
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_axis_off()
    axes.set_title(plan.title, fontsize=8.0, weight="bold")
    lines = 0
    for words, colour in ((plan.said, "black"), (plan.found, RED)):
        if words:
            place = {"xycoords": "axes fraction", "xytext": (0.0, -2.0 - LINE * lines), "textcoords": "offset points"}
            axes.annotate(words, (0.5, 0.0), **place, ha="center", va="top", fontsize=6.5, color=colour)
            lines += 1 + words.count("\n")
