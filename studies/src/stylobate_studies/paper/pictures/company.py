"""Shares that fall over the level of the shaking, of the same columns in four structures."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure, SubFigure

from stylobate.plots.style import CYCLE, WIDTH, page, styled

from ..company.shares import KINDS, counts


@styled
def draw_shares(table: Any, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Share of the columns that lose a drum, and of the runs in which anything falls, over PGV.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`stylobate_studies.paper.company.study.falls`.
    figure : Figure or SubFigure, optional
    """
    figure = page(figure, (WIDTH, 3.6))
    panels = figure.subplots(1, 2, sharey=True)
    for axes, (kind, words) in zip(panels, KINDS.items(), strict=True):
        sums = counts(table, kind).groupby(["structure", "pgv_m_s"], sort=False)[["fell", "of"]].sum()
        for label, look in zip(dict.fromkeys(table["structure"]), CYCLE):
            mine = sums.loc[label].sort_index()
            axes.plot(mine.index, mine["fell"] / mine["of"], marker="o", label=label, **look)
        axes.set_xlabel("PGV, largest of all directions [m/s]")
        axes.set_title(words)
        axes.set_ylim(0.0, 1.0)
        axes.grid()
    panels[0].set_ylabel("share [-]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure
