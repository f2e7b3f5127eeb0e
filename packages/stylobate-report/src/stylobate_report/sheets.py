"""Drawings to scale on sheets of paper: elevations, plan and plans of joints, to be measured with a ruler."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.column.structure import Structure
from stylobate.errors import InputError, check_choice, check_whole
from stylobate.plots.drawing import (
    LINE,
    PLAN,
    VIEWS,
    JointPlan,
    StructureViews,
    draw_plan,
    joint_plans,
    lines_under,
    plan_axes,
    plan_reach,
)
from stylobate.plots.scene import ALONG_X, ALONG_Y, View
from stylobate.plots.style import BLACK, GREY, styled
from stylobate.version import __version__

#: Sheets of ISO 216, upright [mm].
PAPERS = {"A4": (210.0, 297.0), "A3": (297.0, 420.0), "A2": (420.0, 594.0), "A1": (594.0, 841.0), "A0": (841.0, 1189.0)}

#: Scales that drawings of buildings have (ISO 5455 and 1:25), one to so much.
SCALES = (1, 2, 5, 10, 20, 25, 50, 100, 200, 500, 1000)

#: Edge on each side, and height of the title block [mm].
EDGE, BLOCK = 12.0, 16.0

#: From picture to picture, and above each for its heading [mm].
GAP, HEADING = 4.0, 6.0

#: Least room for the words beside and under the plan of a joint [mm].
LEAST_PLAN, WORDS = 30.0, 4.0

#: Points of typography and millimetres of an inch.
POINTS, INCH = 72.0, 25.4


@dataclass(frozen=True)
class Place:
    """Of a picture on its sheet [mm]: its lower left corner from that of the sheet, and its size."""

    x: float
    y: float
    wide: float
    high: float


@styled
def sheets_to_scale(
    structure: Structure, title: str | None = None, *, paper: str = "A4", scale: int | None = None
) -> tuple[Figure, ...]:
    """Sheets with elevations and plan of what stands at one scale, and with the plans of its joints at one scale.

    Parameters
    ----------
    structure : Column, Assembly, SpatialAssembly or Specimen
    title : str, optional
        Its name by default.
    paper : str
        ``A4`` to ``A0``, upright or across, whichever shows more.
    scale : int, optional
        Of the elevations, one to so much; the largest of ``SCALES`` that fits by default.

    Returns
    -------
    tuple of Figure
        Of the size of the paper each: print them without scaling.

    Raises
    ------
    InputError
        An unknown paper, or a scale at which the elevations do not fit.
    """
    check_choice("paper", paper, PAPERS)
    if scale is not None:
        check_whole("scale", scale, 1, SCALES[-1])
    name = title or structure.name
    seen = StructureViews.of(structure)
    size, scale, places = _fitting(seen, paper, scale)
    figures = [_sheet(size, name, scale, paper)]
    for view, words in VIEWS:
        axes = _axes(figures[0], size, places[view], words)
        seen.draw(axes, seen.sheet(axes, view, scale * 1e-3 * INCH / POINTS), view)
    plans = joint_plans(structure)
    reach = plan_reach(structure, plans)
    for number, page in _pages(size, plans, reach):
        figure = _sheet(size, f"{name}: plans of joints, {plan_axes(structure)}", number, paper)
        for which, place in page:
            draw_plan(_axes(figure, size, place, ""), plans[which], reach[which])
        figures.append(figure)
    return tuple(figures)


def _fitting(seen: StructureViews, paper: str, scale: int | None) -> tuple[tuple[float, float], int, dict[View, Place]]:
    """Sheet [mm], scale and places of elevations and plan on it; the largest scale, upright rather than across."""
    short, long = PAPERS[paper]
    sheets = ((short, long), (long, short))
    for number in SCALES if scale is None else (scale,):
        for size in sheets:
            places = _places(seen, size, number)
            if places is not None:
                return size, number, places
    least = next((candidate for candidate in SCALES if any(_places(seen, size, candidate) for size in sheets)), None)
    if least is None:
        raise InputError(
            f"{seen.structure.name!r} does not fit on {paper} at 1:{SCALES[-1]}; take a larger paper.", "paper"
        )
    raise InputError(
        f"scale is 1:{scale}, at which the drawing does not fit on {paper}; the largest usual one that does is 1:{least}; "
        "or take a larger paper.",
        "scale",
    )


def _places(seen: StructureViews, sheet: tuple[float, float], scale: int) -> dict[View, Place] | None:
    """Elevations beside one another on one ground and the plan under the first or beside them; None without room."""
    sizes = {}
    for view, _ in VIEWS:
        low, high = seen.box(view)
        room = {side: points * INCH / POINTS for side, points in seen.margins(view).items()}
        wide, high_ = (1000.0 / scale * (high - low)).tolist()
        sizes[view] = (wide + room["left"] + room["right"], high_ + room["below"] + room["above"])
    wide, high = sheet[0] - 2.0 * EDGE, sheet[1] - 2.0 * EDGE - BLOCK
    (a, up), (b, up_b), (c, deep) = (sizes[view] for view in (ALONG_X, ALONG_Y, PLAN))
    level = EDGE + BLOCK
    if max(a + GAP + b, c) <= wide and up + deep + GAP + 2.0 * HEADING <= high:
        above = level + deep + GAP + HEADING
        plan = Place(EDGE, level, c, deep)
    elif a + b + c + 2.0 * GAP <= wide and max(up, deep) + HEADING <= high:
        above = level
        plan = Place(EDGE + a + b + 2.0 * GAP, level, c, deep)
    else:
        return None
    return {ALONG_X: Place(EDGE, above, a, up), ALONG_Y: Place(EDGE + a + GAP, above, b, up_b), PLAN: plan}


def _pages(
    sheet: tuple[float, float], plans: Sequence[JointPlan], reach: Sequence[float]
) -> Iterator[tuple[int, list[tuple[int, Place]]]]:
    """Scale, and places of the plans of joints in rows from the top, sheet by sheet."""
    if not plans:
        return
    wide, high = sheet[0] - 2.0 * EDGE, sheet[1] - 2.0 * EDGE - BLOCK
    words = [LINE * lines_under(plan) * INCH / POINTS + WORDS for plan in plans]
    largest = 2000.0 * max(reach)
    # at least three beside one another, so that few sheets hold all
    scale = next(
        (candidate for candidate in SCALES if largest / candidate <= min(wide / 3.0 - GAP, 0.5 * high - max(words))),
        SCALES[-1],
    )
    sizes = [2000.0 * half / scale for half in reach]
    page: list[tuple[int, Place]] = []
    top = 0.0
    for row in _rows([max(size, LEAST_PLAN) for size in sizes], wide):
        tall = HEADING + max(sizes[which] + words[which] for which in row)
        if page and top + tall > high:
            yield scale, page
            page, top = [], 0.0
        x, level = EDGE, sheet[1] - EDGE - top - HEADING
        for which in row:
            size, room = sizes[which], max(sizes[which], LEAST_PLAN)
            page.append((which, Place(x + 0.5 * (room - size), level - size, size, size)))
            x += room + GAP
        top += tall + GAP
    yield scale, page


def _rows(widths: Sequence[float], wide: float) -> list[list[int]]:
    """Numbers of what stands beside one another, in order, with a gap between."""
    rows: list[list[int]] = []
    room = -1.0
    for which, width in enumerate(widths):
        if room < width:
            rows.append([])
            room = wide
        rows[-1].append(which)
        room -= width + GAP
    return rows


def _sheet(size: tuple[float, float], title: str, scale: int, paper: str) -> Figure:
    """An empty sheet with a frame, its title block and a scale bar."""
    figure = Figure(figsize=(size[0] / INCH, size[1] / INCH))
    figure.set_layout_engine("none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0.0, size[0])
    axes.set_ylim(0.0, size[1])
    axes.set_axis_off()
    frame = 0.5 * EDGE
    right, top, line = size[0] - frame, size[1] - frame, frame + BLOCK
    axes.plot([frame, right, right, frame, frame], [frame, frame, top, top, frame], color=BLACK, linewidth=0.9)
    axes.plot([frame, right], [line, line], color=BLACK, linewidth=0.9)
    axes.text(
        frame + 4.0, line - 4.0, textwrap.shorten(title, 84, placeholder=" …"), fontsize=9.5, weight="bold", va="top"
    )
    note = f"1:{scale} on {paper}, measures in m; what is as found is red, links are blue. stylobate {__version__}"
    axes.text(frame + 4.0, frame + 3.0, note, fontsize=6.5, color=GREY, va="bottom")
    _bar(axes, right - 6.0, frame + 4.5, scale)
    return figure


def _bar(axes: Axes, right: float, level: float, scale: int) -> None:
    """A scale bar of a round length, some 40 mm long, in five parts."""
    length = next(
        metres
        for power in range(-3, 5)
        for metres in (10.0**power, 2.0 * 10.0**power, 5.0 * 10.0**power)
        if 1000.0 * metres / scale >= 25.0
    )
    part = 200.0 * length / scale
    left = right - 5.0 * part
    for k in range(5):
        axes.fill_between(
            [left + k * part, left + (k + 1) * part],
            level,
            level + 1.4,
            facecolor=BLACK if k % 2 == 0 else "white",
            edgecolor=BLACK,
            linewidth=0.5,
        )
    for x, label in ((left, "0"), (right, f"{length:g} m")):
        axes.text(x, level + 2.2, label, fontsize=6.5, ha="center" if x == left else "right", va="bottom")


def _axes(figure: Figure, sheet: tuple[float, float], place: Place, title: str) -> Axes:
    axes = figure.add_axes((place.x / sheet[0], place.y / sheet[1], place.wide / sheet[0], place.high / sheet[1]))
    if title:
        axes.set_title(title, fontsize=8.0, color=GREY)
    return axes
