"""Tosses of a cube: how far the computed trajectories are from the measured ones."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure, SubFigure

from stylobate.plots.style import CYCLE, WIDTH, page, styled

from ..cube import WHEN


@styled
def draw_toss_errors(table: Any, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Share of tosses whose error stays below a value, after each impact and at rest.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`stylobate_studies.experiments.cube.run`.
    figure : Figure or SubFigure, optional
    """
    figure = page(figure, (WIDTH, 3.6))
    panels = figure.subplots(1, 2, sharey=True)
    for axes, what, label in zip(
        panels,
        ("position [widths]", "rotation [deg]"),
        ("error of position [widths of the cube]", "error of rotation [°]"),
    ):
        for when, look in zip(WHEN, CYCLE):
            if f"{when}: {what}" not in table:
                continue
            errors = np.sort(table[f"{when}: {what}"].dropna().to_numpy(dtype=float))
            share = (np.arange(len(errors)) + 1.0) / len(errors)
            axes.step(errors, share, where="post", label=when, **look)
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_xlabel(label)
        axes.set_ylim(0.0, 1.0)
        axes.grid()
    panels[0].set_ylabel("share of tosses [-]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure
