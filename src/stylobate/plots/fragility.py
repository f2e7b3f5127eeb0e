"""Fragility curves: the curve, how sure it is, what undecided runs could make of it, and the shares behind it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from ..analysis.fragility_curve import Fragility
from ..analysis.lognormal import curve
from ..analysis.side_by_side import median_words
from ..motion.intensity_specs import parse_measure
from .style import BLACK, BLUE, GREY, RED, legend_below, panel, styled

#: Width and height of a picture for one column of a printed page, where its text is still legible [inch].
NARROW = (4.4, 3.7)

#: A curve whose fit has a smaller p is told to fit badly.
BADLY = 0.05

_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": RED, "linestyle": "-", "marker": "o"},
    {"color": BLUE, "linestyle": (0, (5, 2)), "marker": "s"},
    {"color": BLACK, "linestyle": (0, (1.5, 1.2)), "marker": "^"},
    {"color": "#5aae61", "linestyle": "-.", "marker": "D"},
)


@styled
def draw_fragility(
    curves: Fragility | Sequence[Fragility], title: str | None = None, *, ax: Axes | None = None
) -> Figure:
    """Probability of a state over the intensity, each curve between the intensities that were run.

    Parameters
    ----------
    curves : Fragility or sequence of Fragility
        Of one intensity measure; two columns, or one with and without a measure.
    title : str, optional
        The state by default.
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
    found = [curves] if isinstance(curves, Fragility) else list(curves)
    figure, axes = panel(ax, NARROW)
    ends = min(one.span[0] for one in found), max(one.span[1] for one in found)
    fine = {"linewidth": 0.7, "linestyle": (0, (1, 1.5))}
    for one, look in zip(found, _LOOKS * len(found)):
        colour, x = look["color"], np.geomspace(*one.span, 300)
        below, above = one.interval(x)
        axes.fill_between(x, below, above, color=colour, alpha=0.18, linewidth=0.0)
        if one.evidence.count(-1) + one.evidence.count(-2):
            for extreme in one.extremes:
                axes.plot(x, curve(x, *extreme), color=colour, **fine)
        name = one.evidence.name if len(found) > 1 else "lognormal"
        badly = ", fits badly" if one.p_value < BADLY else ""
        spread = f"β {one.beta:.2f}" if one.bracket is None else "β not seen"
        label = f"{name}: {median_words(one.summary())}, {spread}, {one.records} {one.counted}{badly}"
        axes.plot(x, one.probability(x), color=colour, linestyle=look["linestyle"], linewidth=1.6, label=label)
        p = one.points
        bars = np.clip(np.stack((p.share - p.low, p.high - p.share)), 0.0, None)
        axes.errorbar(
            p.im, p.share, bars, color=colour, linestyle="none", marker=look["marker"], markersize=3.4, linewidth=0.8,
            markerfacecolor="white",
        )  # fmt: skip
    if any(one.evidence.count(-1) + one.evidence.count(-2) for one in found):
        axes.plot([], [], color=GREY if len(found) > 1 else RED, label="if all that is undecided did, or none", **fine)
    axes.set(ylim=(-0.03, 1.03), xlim=(ends[0] / 1.1, 1.1 * ends[1]))
    logarithmic(axes)
    measure, state = found[0].evidence.measure, found[0].evidence.state
    axes.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    axes.set_ylabel(f"probability of {state}")
    axes.grid(True)
    laws = " and laws of the joints" if any(one.laws for one in found) else ""
    axes.set_title(title or f"{state}, {100 * found[0].confidence:g} % bands over {found[0].counted}{laws}", fontsize=9)
    legend_below(axes, ax is None, handlelength=2.4, ncols=1, fontsize=8)
    return figure


def logarithmic(axes: Axes) -> None:
    """Plain numbers on a logarithmic intensity."""
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
