"""Several states of a column: their fragility curves, and what each changes, with intervals over the same records."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..analysis.difference import NOT_TOLD, STRONGER, WEAKER, Difference
from ..analysis.fragility_checks import FEWEST
from ..analysis.fragility_curve import Fragility
from ..analysis.limit_states import FAILED, OPEN
from ..analysis.lognormal import curve
from ..analysis.side_by_side import median_name, median_words
from ..analysis.states import StateComparison
from ..motion.intensity_specs import parse_measure
from .fragility import logarithmic
from .style import BLACK, CYCLE, GREY, RED, WIDTH, in_lines, page, plain, styled

#: Markers, after as many colours as the style has.
_MARKERS = ("", "o", "s", "^")


@styled
def draw_states(found: StateComparison, title: str = "", *, figure: Figure | SubFigure | None = None) -> Figure:
    """Fragility curves beside the differences in the share of runs that exceed the limit state.

    Without any curve the differences stand alone. The band is that of the first state with a curve; those of the others
    stand in the table. A state with undecided runs
    has two thin curves: if all of them exceeded the limit state, and if none did. Right: thick from the best to the worst
    that the undecided can come to, a circle where all is decided; the interval over records holds both ends. Grey: nothing
    is concluded.

    Parameters
    ----------
    found : StateComparison
    title : str
    figure : matplotlib figure or subfigure, optional
        Where to draw.
    """
    known = [one for one in found.curves if one is not None]
    figure = page(figure, (WIDTH, 4.4 if known else min(2.2 + 0.4 * len(found.differences), 4.4)))
    if known:
        curves, bars = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        _draw_curves(curves, known, found.state)
        for label, one in zip(found.labels, found.curves, strict=True):
            if one is None:
                curves.plot([], [], color="none", label=f"{label}: no curve")
        curves.legend(loc="upper left", fontsize=7.5, handlelength=2.6)
    else:
        bars = figure.subplots()
    if title:
        figure.suptitle(in_lines(title), x=0.02, ha="left")
    places = np.arange(len(found.differences))[::-1]
    bars.axvline(0.0, color=GREY, linewidth=0.8)
    for difference, place in zip(found.differences, places):
        _draw_difference(bars, difference, float(place))
    several = len({difference.against for difference in found.differences}) > 1
    names = [
        plain(difference.state) + (f"\nagainst {plain(difference.against)}" if several else "")
        for difference in found.differences
    ]
    bars.set_yticks(places, names)
    bars.set_ylim(-0.6, len(places) - 0.4)
    against = "the other one" if several else f"“{plain(found.differences[0].against)}”"
    bars.set_xlabel(f"share of runs with {found.state},\nless that of {against}\n[percentage points], paired")
    _say_which_side(bars, found)
    if any(difference.undecided for difference in found.differences):
        bars.plot([], [], color=BLACK, linewidth=4.0, alpha=0.5, label="undecided, both ways")
        figure.legend(*bars.get_legend_handles_labels(), loc="outside lower right", fontsize=7.5)
    bars.grid(True, axis="x")
    return figure


def _say_which_side(axes: Axes, comparison: StateComparison) -> None:
    """Room on both sides of zero, and what they mean."""
    ends = [
        end
        for difference in comparison.differences
        for end in (difference.share_best, difference.share_worst, difference.share_low, difference.share_high)
    ]
    known = 100.0 * np.array([end for end in ends if np.isfinite(end)] or [0.0])
    left, right = max(-known.min(), 0.0), max(known.max(), 0.0)
    least = 0.5 * max(left, right, 5.0)
    axes.set_xlim(-1.1 * max(left, least), 1.1 * max(right, least))
    for text, side in (("← stronger  ", "right"), ("  weaker →", "left")):
        axes.annotate(text, (0.0, 1.02), xycoords=("data", "axes fraction"), ha=side, fontsize=9)


def _draw_difference(axes: Axes, difference: Difference, place: float) -> None:
    """The interval over records, and in it what the runs themselves leave open."""
    color = {WEAKER: RED, STRONGER: BLACK}.get(difference.conclusion, GREY)
    ends = 100.0 * np.array([difference.share_best, difference.share_worst])
    low, high = 100.0 * difference.share_low, 100.0 * difference.share_high
    if difference.records >= FEWEST:
        axes.errorbar(
            [0.5 * (low + high)], [place], xerr=[[0.5 * (high - low)]] * 2, color=color, linestyle="none", capsize=2.5
        )
    if difference.undecided:
        axes.plot(ends, [place, place], color=color, linewidth=4.0, alpha=0.5, solid_capstyle="butt")
    else:
        hollow = "white" if difference.conclusion == NOT_TOLD else None
        axes.plot(ends[:1], [place], color=color, marker="o", markersize=4.5, linestyle="none", markerfacecolor=hollow)


def _draw_curves(axes: Axes, known: list[Fragility], state: str) -> None:
    values = np.concatenate([one.evidence.im for one in known])
    for k, one in enumerate(known):
        x = np.geomspace(*one.levels, 300)
        if k == 0:
            axes.fill_between(x, *one.interval(x), color=GREY, alpha=0.18, linewidth=0.0)
        marker, look = _MARKERS[k // len(CYCLE) % len(_MARKERS)], CYCLE[k % len(CYCLE)]
        summary = one.summary()
        name = median_name(summary).replace(" (", "\n(")
        label = f"{one.evidence.name}: {median_words(summary)}, {name}"
        common = {**look, "marker": marker, "markevery": 40, "markersize": 3.5}
        if one.evidence.count(OPEN) + one.evidence.count(FAILED) == 0:
            axes.plot(x, one.probability(x), **common, linewidth=1.5, label=label)
            continue
        ends = [curve(x, *extreme) for extreme in one.extremes]
        axes.fill_between(x, ends[0], ends[1], color=look["color"], alpha=0.1, linewidth=0.0)
        for end, name in zip(ends, (label, None)):
            axes.plot(x, end, **common, linewidth=0.9, label=name)
    axes.set(ylim=(-0.03, 1.03), xlim=(values.min() / 1.1, values.max() * 1.1), ylabel=f"probability of {state}")
    logarithmic(axes)
    measure = known[0].evidence.measure
    axes.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    axes.grid(True)
