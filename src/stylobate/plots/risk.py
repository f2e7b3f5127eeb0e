"""Risk: which shaking brings a column down, deaggregated by intensity."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..analysis.risk import Risk, years
from ..motion.intensity_specs import parse_measure
from ..percent import percent
from .fragility import NARROW, logarithmic
from .style import BLACK, BLUE, RED, page, styled


@styled
def draw_risk(result: Risk, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Hazard curve and fragility, and below them how much of the rate comes from which intensity.

    Parameters
    ----------
    result : Risk
    title : str, optional
        The return period by default.
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    figure = page(figure, (NARROW[0], 4.6))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.2, 1.0))
    hazard, f = result.hazard, result.fragility
    (line,) = upper.plot(hazard.im, hazard.rate, color=BLACK, linewidth=1.4, label="hazard")
    upper.set_yscale("log")
    upper.set_ylabel("annual rate of\nexceedance [1/y]")
    right = upper.twinx()
    x = np.geomspace(hazard.im[0], hazard.im[-1], 300)
    (own,) = right.plot(x, f.probability(x), color=RED, linestyle=(0, (5, 2)), linewidth=1.4, label=f.evidence.state)
    right.set_ylim(0.0, 1.03)
    right.spines["right"].set_visible(True)
    right.set_ylabel(f"probability of {f.evidence.state}")
    upper.legend(handles=[line, own], loc="center left")
    share = result.parts[:-1] / max(result.rate, 1e-300)
    lower.stairs(100.0 * share, result.edges[:-1], fill=True, color=BLUE, alpha=0.6)
    lower.stairs(100.0 * share, result.edges[:-1], color=BLUE, linewidth=0.8)
    rest = result.parts[-1] / max(result.rate, 1e-300)
    if rest >= 0.005:
        lower.set_title(f"{percent(rest)} beyond", loc="right", fontsize=8)
    lower.set_ylabel("share of the rate [%]")
    lower.set_xlim(hazard.im[0], hazard.im[-1])
    lower.grid(True, axis="y")
    logarithmic(lower)
    measure = f.evidence.measure
    lower.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    period = "never" if result.rate == 0.0 else f"once in {years(1.0 / result.rate)}"
    upper.set_title(title or f"{f.evidence.state}: {period}", fontsize=9)
    return figure
