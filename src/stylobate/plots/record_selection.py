"""Chosen records against a target spectrum."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..analysis.record_selection import RecordSelection
from ..constants import g
from .style import WIDTH, page, styled

#: Ticks of the axes: periods [s], and ratios [-].
PERIODS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0)
RATIOS = (0.25, 0.5, 0.7, 0.9, 1.3, 2.0, 4.0)


@styled
def draw_record_selection(
    selection: RecordSelection, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Spectra of the records, their mean and the target, and the mean over the target with its bounds.

    Parameters
    ----------
    selection : RecordSelection
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    figure = page(figure, (WIDTH, 5.4))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    t, target = selection.periods, selection.wanted / g
    for k, row in enumerate(selection.spectra):
        upper.plot(t, row / g, color="0.65", linewidth=0.7, label="records" if k == 0 else None)
    upper.plot(t, selection.mean / g, color="C0", linewidth=1.8, label="their mean")
    upper.plot(t, target, color="k", linewidth=1.8, linestyle="--", label="target")
    upper.set_ylabel("pseudo-acceleration [g]")
    upper.set_ylim(bottom=0.0)
    upper.legend(loc="upper right")
    for row in selection.spectra:
        lower.plot(t, row / selection.wanted, color="0.65", linewidth=0.7)
    lower.plot(t, selection.ratio, color="C0", linewidth=1.8)
    lower.axhline(selection.least, color="k", linewidth=0.9, linestyle=":")
    if np.isfinite(selection.most):
        lower.axhline(selection.most, color="k", linewidth=0.9, linestyle=":")
    lower.set_yscale("log")
    low, high = lower.get_ylim()
    lower.set_yticks([tick for tick in RATIOS if low <= tick <= high], minor=False)
    lower.yaxis.set_major_formatter("{x:g}")
    lower.set_ylabel("over the target [-]")
    lower.set_xlabel("period [s]")
    for axes in (upper, lower):
        axes.set_xscale("log")
        axes.set_xticks([tick for tick in PERIODS if t[0] <= tick <= t[-1]], minor=False)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.minorticks_off()
        axes.margins(x=0.0)
    assumed = selection.target.assumed
    aim = f"{selection.target.name} ({assumed})" if assumed else selection.target.name
    upper.set_title(title or f"{len(selection.motions)} records for {aim}")
    figure.align_ylabels()
    return figure
