"""Maps over frequency and amplitude side by side on the same axes: models beside each other, columns below each other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from stylobate.constants import g
from stylobate.plots.style import page
from stylobate.verdicts.domain import CollapseProbability, Domain, cell_edges

Map = TypeVar("Map", Domain, CollapseProbability)


def draw_panels(
    rows: Sequence[tuple[str, Sequence[tuple[str, Map]]]],
    size: tuple[float, float],
    draw: Callable[[Axes, Map], tuple[dict[str, Artist], str]],
    title: str,
    figure: Figure | SubFigure | None,
) -> tuple[Figure, dict[str, Artist]]:
    """Draw all maps, each titled with its share of collapses; the figure, and what its legend needs by label.

    Parameters
    ----------
    rows : sequence of (label of the row, panels), panels as (title, map)
    size : tuple of float
        Of a new figure [in].
    draw : callable
        Draws one map; gives its handles by label, and the share that collapses in words.
    title : str
    figure : Figure or SubFigure or None
        To draw in; a new one for None.
    """
    figure = page(figure, size)
    grid = figure.subplots(len(rows), max(len(panels) for _, panels in rows), sharex=True, sharey=True, squeeze=False)
    handles: dict[str, Artist] = {}
    for line, (label, panels) in zip(grid, rows):
        for axes, (name, chart) in zip(line, panels):
            artists, share = draw(axes, chart)
            handles = artists | handles
            frame(axes, chart.frequencies, chart.amplitudes)
            axes.set_title(f"{name}\n{share} collapse", fontsize=8.5)
        line[0].set_ylabel(f"{label}\namplitude [g]")
    for axes in grid[-1]:
        axes.set_xlabel("frequency [Hz]")
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    return figure, handles


def frame(axes: Axes, frequencies: np.ndarray, amplitudes: np.ndarray) -> None:
    """Limits of the axes at the edges of the outermost cells."""
    x, y = cell_edges(frequencies), cell_edges(amplitudes / g)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
