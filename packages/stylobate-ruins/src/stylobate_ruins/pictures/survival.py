"""Survival: what the age of a column that still stands says about hazard curves."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.messages import say
from stylobate.plots.fragility import NARROW
from stylobate.plots.style import BLACK, BLUE, GREY, panel, styled
from stylobate.probability.risk import years

from ..survival import Survival


@styled
def draw_survival(result: Survival, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Probability that the column would still stand, by hazard curve, with the interval of its fragility.

    Parameters
    ----------
    result : Survival
    """
    figure, axes = panel(ax, (NARROW[0], 1.2 + 0.62 * len(result.risks)))
    low, high = result.interval
    at = np.arange(len(result.risks))
    axes.barh(at, result.probability, height=0.36, color=BLUE, alpha=0.6)
    axes.hlines(at, low, high, color=BLACK, linewidth=1.4)
    weight = result.likelihood / result.likelihood.sum()
    for k, risk in enumerate(result.risks):
        text = f"{risk.hazard.name}: {result.probability[k]:.2g}, weight {weight[k]:.2f}"
        axes.annotate(text, (0.0, k), xytext=(2, 15), textcoords="offset points", va="center", fontsize=8)
    axes.set_yticks([])
    axes.spines["left"].set_color(GREY)
    axes.set(xlim=(0.0, 1.02), ylim=(len(at) - 0.6, -0.8))
    axes.set_xlabel("probability that it would still stand [-]")
    axes.grid(True, axis="x")
    axes.set_title(
        title
        or say("{years} without {result.risks[0].fragility.evidence.state}", years=years(result.age), result=result),
        fontsize=9,
    )
    return figure
