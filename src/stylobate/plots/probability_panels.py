"""Probabilities of collapse side by side on the same axes: models beside each other, columns below each other."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Patch

from ..analysis.domain import cell_edges
from ..analysis.probability import CollapseProbability
from ..constants import g
from .probability import draw_band, draw_shares
from .style import WIDTH, page, styled


@styled
def draw_probability_panels(
    rows: Sequence[tuple[str, Sequence[tuple[str, CollapseProbability]]]],
    title: str,
    *,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Share of the variations that collapse in every cell of several maps, with the mean of all cells.

    Parameters
    ----------
    rows : sequence of (label of the row, panels), panels as (title, map)
    title : str
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    columns = max(len(panels) for _, panels in rows)
    figure = page(figure, (WIDTH, 1.0 + 2.1 * len(rows)))
    grid = figure.subplots(len(rows), columns, sharex=True, sharey=True, squeeze=False)
    handles: dict[str, Patch] = {}
    for line, (label, panels) in zip(grid, rows):
        for axes, (name, one) in zip(line, panels):
            handles |= {str(patch.get_label()): patch for patch in draw_shares(axes, one)}
            draw_band(axes, one)
            x, y = cell_edges(one.frequencies), cell_edges(one.amplitudes / g)
            axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
            axes.set_title(f"{name}\n{100.0 * one.mean:.0f} % collapse", fontsize=8.5)
        line[0].set_ylabel(f"{label}\namplitude [g]")
    for axes in grid[-1]:
        axes.set_xlabel("frequency [Hz]")
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    figure.legend(
        handles=list(handles.values()),
        loc="outside lower center",
        ncols=6,
        title="share that collapses; under the full line none does, above the dashed line all do",
        title_fontsize=8.5,
    )
    return figure
