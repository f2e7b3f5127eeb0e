"""Several states of a column: their fragility curves, and what each changes, with intervals over the same records."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..analysis.fragility import Fragility
from ..analysis.states import StateComparison
from ..motion.intensity_specs import parse_measure
from .fragility import logarithmic
from .style import BLACK, CYCLE, GREY, RED, WIDTH, page, styled

#: Markers, after as many colours as the style has.
_MARKERS = ("", "o", "s", "^")


@styled
def draw_states(found: StateComparison, title: str = "", *, figure: Figure | SubFigure | None = None) -> Figure:
    """Fragility curves beside the differences in the share of runs that exceed the limit state.

    The band is that of the first state; those of the others stand in the table. Open circles: the interval holds zero.

    Parameters
    ----------
    found : StateComparison
    title : str
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    figure = page(figure, (WIDTH, 4.4))
    curves, bars = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    known = [one for one in found.curves if one is not None]
    if known:
        _draw_curves(curves, known, found.state)
    else:
        curves.text(0.5, 0.5, "no curve: all runs say the same,\nor too few records", ha="center", va="center")
        curves.set(xticks=[], yticks=[])
    if title:
        curves.set_title(title)
    places = np.arange(len(found.differences))[::-1]
    values = 100.0 * np.array([(one.share, one.share_low, one.share_high) for one in found.differences]).reshape(-1, 3)
    bars.axvline(0.0, color=GREY, linewidth=0.8)
    spread = np.clip(np.stack((values[:, 0] - values[:, 1], values[:, 2] - values[:, 0])), 0.0, None)
    for k, place in enumerate(places):
        worse, sure = values[k, 0] > 0.0, values[k, 1] > 0.0 or values[k, 2] < 0.0
        bars.errorbar(
            values[k, 0], place, xerr=spread[:, k : k + 1], color=RED if worse else BLACK, marker="o", markersize=4.5,
            linestyle="none", capsize=2.5, markerfacecolor=None if sure else "white",
        )  # fmt: skip
    bars.set_yticks(places, [one.state for one in found.differences])
    bars.set_ylim(-0.6, len(places) - 0.4)
    bars.set_xlabel(f"runs with {found.state},\nless those {found.labels[0]} [% of the runs]")
    bars.set_title("paired, 95 % over records", fontsize=9)
    bars.grid(True, axis="x")
    return figure


def _draw_curves(axes: Axes, known: list[Fragility], state: str) -> None:
    values = np.concatenate([one.evidence.im for one in known])
    x = np.geomspace(values.min() / 1.1, values.max() * 1.1, 300)
    low, high = known[0].interval(x)
    axes.fill_between(x, low, high, color=GREY, alpha=0.18, linewidth=0.0)
    for k, one in enumerate(known):
        marker, look = _MARKERS[k // len(CYCLE) % len(_MARKERS)], CYCLE[k % len(CYCLE)]
        label = f"{one.evidence.name}: {one.median:.2f} {one.evidence.unit}".removesuffix(" -")
        axes.plot(
            x, one.probability(x), **look, linewidth=1.5, marker=marker, markevery=40, markersize=3.5, label=label
        )
    axes.set(ylim=(-0.03, 1.03), xlim=(x[0], x[-1]), ylabel=f"probability of {state}")
    logarithmic(axes)
    measure = known[0].evidence.measure
    axes.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    axes.grid(True)
    axes.legend(loc="upper left", fontsize=7.5, handlelength=2.6)
