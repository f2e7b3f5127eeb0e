"""Probabilities of collapse side by side on the same axes: models beside each other, columns below each other."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from stylobate.messages import percent
from stylobate.plots.domain import draw_band, draw_shares
from stylobate.plots.style import WIDTH, styled
from stylobate.verdicts.domain import CollapseProbability

from .maps_side_by_side import draw_panels


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
    figure, handles = draw_panels(rows, (WIDTH, 1.0 + 2.1 * len(rows)), _shares, title, figure)
    figure.legend(
        handles=list(handles.values()),
        loc="outside lower center",
        ncols=6,
        title="share that collapses; under the full line none does, above the dashed line all do",
        title_fontsize=8.5,
    )
    return figure


def _shares(axes: Axes, probability: CollapseProbability) -> tuple[dict[str, Artist], str]:
    """One map of several: its handles by label, and the mean share that collapses."""
    handles: dict[str, Artist] = {str(patch.get_label()): patch for patch in draw_shares(axes, probability)}
    draw_band(axes, probability)
    return handles, percent(probability.mean)
