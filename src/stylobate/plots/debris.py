"""Plan of where the bodies of an assembly lay at the end, over its twins: regions, never one picture of debris."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

from ..column.block import FAR_AWAY
from ..column.shapes import hull
from ..column.structure import Body
from ..column.turning import matrix_of
from ..response import Response
from ..verdicts.population import BodyOverTwins, not_yet_debris, only_as_seen
from .style import BLACK, CYCLE, GREY, SAND, WIDTH, in_lines, only_panel, styled

#: Colours of the bodies that fell most often; others are grey.
COLOURS = tuple(line["color"] for line in CYCLE[:5])


@styled
def draw_debris(
    response: Response,
    bodies: Sequence[BodyOverTwins],
    title: str | None = None,
    *,
    figure: Figure | SubFigure | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Plan with the places of the centroids of all bodies that fell in some twin, at the end of each run.

    A dot is a twin; half of the dots of a body lie in its full circle and 90 % in the dashed one, about the median place.
    What stood at the start is drawn behind it.

    Parameters
    ----------
    response : Response
        Of the assembly itself, in space.
    bodies : sequence of BodyOverTwins
        ``Population.bodies``.
    """
    figure, axes = only_panel(ax, figure, (WIDTH, 5.6))
    fallen = sorted((one for one in bodies if one.fell), key=lambda one: -one.fell)
    for body in response.structure.bodies:
        if body.fixed and body.size > FAR_AWAY:
            continue
        for shape in _footprints(body):
            axes.add_patch(Polygon(shape, facecolor=SAND, edgecolor=GREY, linewidth=0.5, zorder=1))
    names = response.bodies.names
    starts = dict(zip(names, response.body_position[0, :, :2], strict=True))
    handles = []
    for number, one in enumerate(fallen):
        colour = COLOURS[number] if number < len(COLOURS) else GREY
        ends = starts[one.name] + one.ends
        middle = starts[one.name] + one.middle
        axes.plot(*ends.T, ".", color=colour, markersize=4.0, zorder=3)
        for radius, style in zip(one.radii, ("-", (0, (4, 2))), strict=True):
            x, y = (float(place) for place in middle)
            circle = Circle((x, y), radius, fill=False, edgecolor=colour, linewidth=0.9, linestyle=style, zorder=2)
            axes.add_patch(circle)
        if number < len(COLOURS):
            label = f"{one.name}: fell in {one.fell} of {one.runs}" + f", {one.open} undecided" * bool(one.open)
            handles.append(Line2D([], [], color=colour, marker=".", label=label))
    if len(fallen) > len(COLOURS):
        handles.append(Line2D([], [], color=GREY, marker=".", label=f"{len(fallen) - len(COLOURS)} more that fell"))
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_ylabel("y [m]")
    if handles:
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=7.5)
    else:
        axes.text(0.5, 0.02, "nothing fell in any of them", transform=axes.transAxes, ha="center", color=BLACK)
    runs = len(bodies[0].ends) if bodies else 0
    moving = not_yet_debris(bodies)
    said = f"{response.structure.name}: where bodies were at the end of {runs} runs"
    axes.set_title(in_lines(title or said + f"; {moving}" * bool(moving)))
    lines = ["x [m]", "full circle: 50 %, dashed: 90 % of all runs, about the median place;"]
    lines += ["runs in which a body stands count, too", *filter(None, [only_as_seen(runs)])]
    axes.set_xlabel("\n".join(lines))
    return figure


def _footprints(body: Body) -> list[np.ndarray]:
    """Outlines of the parts of a body in plan, as they stand [m]."""
    return [
        hull((part.shape.mesh().vertices @ matrix_of(part.orientation).T + np.array(part.place))[:, :2])
        for part in body.placed
    ]
