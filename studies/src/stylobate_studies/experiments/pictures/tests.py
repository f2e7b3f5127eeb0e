"""Tests of columns: how what was measured is distributed, and what is computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure, SubFigure

from stylobate.plots.style import CYCLE, WIDTH, page, styled


@styled
def draw_tests(table: Any, scores: Sequence[Mapping[str, Any]], *, figure: Figure | SubFigure | None = None) -> Figure:
    """Share of tests in which each measure that is scored stays below a value, measured and computed.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`stylobate_studies.experiments.measured.tests_table`.
    scores : sequence of mapping
        Scores, of which the measures are drawn, ``collapsed`` as 0 and 1.
    figure : Figure or SubFigure, optional
    """
    names = list(dict.fromkeys(score["measure"] for score in scores))
    figure = page(figure, (WIDTH, 3.6))
    panels = figure.subplots(1, len(names), sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, names):
        for who, look in zip(("measured", "computed"), CYCLE):
            values = np.sort(table[f"{who} {name}"].dropna().to_numpy(dtype=float))
            there = values[np.isfinite(values)]
            axes.step(there, (np.arange(len(there)) + 1.0) / max(1, len(values)), where="post", label=who, **look)
        axes.set_xlabel(name)
        axes.set_ylim(0.0, 1.0)
        axes.grid()
    panels[0].set_ylabel("share of tests [-]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
