"""Pictures with one small square panel for each joint of a column in space."""

from __future__ import annotations

import math
import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..messages import say
from ..response import Response
from .style import page

#: Joints that have a panel at most.
MOST = 24


def until_collapse(response: Response) -> np.ndarray:
    """Which recorded states are before a collapse, all without one, as long as all is finite, shape (T,)."""
    finite = np.isfinite(response.body_position).all(axis=(1, 2))
    last = math.inf if math.isnan(response.collapse_time) else response.collapse_time
    return np.logical_and(finite, response.time <= last)


def most(values: np.ndarray) -> list[int]:
    """Numbers of the joints with the largest of these values, as many as have a panel, from the base upward."""
    return sorted(np.argsort(-values, kind="stable")[:MOST].tolist())


def panels_for(count: int, figure: Figure | SubFigure | None, **options: Any) -> tuple[Figure, list[Axes]]:
    """A picture as wide as a column of a journal, three panels beside one another; with its panels."""
    across = min(3, count)
    down = math.ceil(count / across)
    figure = page(figure, (3.4, 1.42 * down + 0.6))
    panels = list(np.ravel(figure.subplots(down, across, squeeze=False, subplot_kw=options)))
    for axes in panels[count:]:
        axes.set_axis_off()
    return figure, panels[:count]


#: Width of a letter of a title over panels [inch].
LETTER = 0.07


def put_title(figure: Figure, title: str, left_out: int) -> None:
    """The title over the panels, and how many joints have none."""
    more = say(" Without {left_out} joints that moved less.", left_out=left_out) if left_out else ""
    letters = min(max(int(figure.get_figwidth() / LETTER), 20), 110)
    figure.suptitle(textwrap.fill(title + more, letters), x=0.02, ha="left", fontsize=8.0)
