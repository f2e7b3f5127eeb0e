"""Probability of collapse over frequency and amplitude: what is certain, what is not, and how wide the doubt is."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..analysis import probability as p
from ..analysis import verdicts as v
from ..analysis.domain import cell_edges
from ..analysis.probability import CollapseProbability
from ..constants import g
from ..percent import percent
from .domain import fill_cells, framed
from .style import BLACK, BLUE, HALO, RED, SAND, WIDTH, page, styled

#: Classes of the share that collapses: upper end, label, and a fill that darkens evenly, in grey as well.
CLASSES = (
    (0.0, "none", SAND),
    (1.0 / 3.0, "up to ⅓", "#f2bf8d"),
    (2.0 / 3.0, "⅓ to ⅔", "#dd8453"),
    (1.0, "over ⅔", "#a6372f"),
    (np.inf, "all", "#5a1215"),
)
_UNKNOWN: dict[str, Any] = {"facecolor": "#d9d9d9", "edgecolor": "#4d4d4d", "hatch": "////", "linewidth": 0.0}


@styled
def draw_probability(
    result: CollapseProbability, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Map of the share that collapses, the edges of the uncertain band, and one cut with its confidence intervals.

    Parameters
    ----------
    result : CollapseProbability
    title : str, optional
        Column and model by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    figure = page(figure, (WIDTH, 4.7))
    chart, cut = figure.subplots(1, 2, width_ratios=(1.75, 1.0), sharey=True)
    handles = [*draw_shares(chart, result), *draw_band(chart, result)]
    value = result.column.uplift_acceleration / g
    handles.append(
        chart.axhline(value, color=BLUE, linestyle=(0, (6, 2.5)), linewidth=1.3, label=f"static uplift, {value:.3f} g")
    )
    x, y = cell_edges(result.frequencies), cell_edges(result.amplitudes / g)
    chart.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    chart.set_xlabel("frequency of the base motion [Hz]")
    chart.set_ylabel("amplitude of acceleration [g]")
    _draw_cut(cut, result, chart)
    figure.suptitle(
        f"{title or f'{result.column.name}, {result.model}'}: {message(result)}", x=0.01, ha="left", size=9.5
    )
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=4,
        title=f"share of {result.replicates} variations that collapse",
    )
    return figure


def message(result: CollapseProbability) -> str:
    """Words on the picture, in one or two lines."""
    facts = result.summary()
    open_cells = facts["no_verdict"]
    if open_cells:
        said = f"{percent(open_cells / facts['cells'])} of the cells have no verdict: follow the column longer"
        if open_cells == facts["cells"]:
            return said
        return f"{_about_the_others(result, facts)}\n{said}"
    return _about_the_others(result, facts)


def _about_the_others(result: CollapseProbability, facts: dict) -> str:
    """Words of cells with a verdict."""
    if not facts["collapsed"]:
        return "no variation collapses here"
    width, cells = facts["band_width_median_g"], facts["some_collapse"]
    if not cells:
        return "all variations agree in every cell" + (" with a verdict" if facts["no_verdict"] else "")
    share = f"{percent(cells / facts['cells'])} of the cells are uncertain"
    if width is None:
        return f"{share};\nthe band reaches beyond the largest amplitude at every frequency that collapses"
    beyond = facts["band_open_frequencies"]
    more = f"; its top is not seen at {beyond} of {len(result.frequencies)} frequencies" if beyond else ""
    return f"{share};\nthe uncertain band is {width:.2g} g wide (median; up to {facts['band_width_largest_g']:.2g} g){more}"


def draw_shares(axes: Axes, result: CollapseProbability) -> list[Patch]:
    """Fill every cell by the share of its variations that collapse; returns what a legend shows."""
    x, y, share, kinds = (
        cell_edges(result.frequencies),
        cell_edges(result.amplitudes / g),
        result.frequency,
        result.kinds,
    )
    class_of = np.select(
        [kinds == p.UNKNOWN, kinds == p.SAFE, kinds == p.UNSAFE, share <= CLASSES[1][0], share <= CLASSES[2][0]],
        [-1, 0, 4, 1, 2],
        default=3,
    )
    handles = []
    for k, (_, label, color) in [*enumerate(CLASSES), (-1, (0.0, "no verdict", ""))]:
        fill: dict[str, Any] = {"facecolor": color, "edgecolor": "none"} if k >= 0 else _UNKNOWN
        if fill_cells(axes, x, y, class_of == k, fill) or k >= 0:
            handles.append(Patch(label=label, **framed(fill)))
    return handles


def draw_band(axes: Axes, result: CollapseProbability) -> list[Line2D]:
    """The edges of the uncertain band; returns what a legend shows."""
    x, edges = cell_edges(result.frequencies), cell_edges(result.amplitudes / g)
    low, high = result.band
    with np.errstate(invalid="ignore"):
        below = [np.nan if np.isnan(one) else edges[np.searchsorted(result.amplitudes, one)] for one in low]
        above = [
            np.nan if np.isnan([one, first]).any() or beyond else edges[np.searchsorted(result.amplitudes, one) + 1]
            for one, first, beyond in zip(high, low, result.band_is_open)
        ]
    shapes: list[Line2D] = []
    lines: list[tuple[Any, Any, str]] = [
        (below, "-", "below: none collapses"),
        (above, (0, (2, 1.2)), "above: all collapse"),
    ]
    for level, line, label in lines:
        axes.stairs(level, x, baseline=None, color=BLACK, linewidth=1.5, linestyle=line, zorder=3, path_effects=HALO)
        shapes.append(Line2D([], [], color=BLACK, linewidth=1.5, linestyle=line, label=label))
    return shapes


def _draw_cut(axes: Axes, result: CollapseProbability, chart: Axes) -> None:
    """Share that collapses over the amplitude at the frequency with most uncertain cells, with confidence intervals."""
    uncertain = (result.kinds == p.UNCERTAIN).sum(axis=1)
    i = int(np.argmax(uncertain)) if uncertain.any() else int(np.argmax(result.count(v.COLLAPSED).sum(axis=1)))
    share, (low, high) = result.frequency[i], result.interval
    known = ~np.isnan(share)
    level = result.amplitudes[known] / g
    axes.hlines(level, low[i][known], high[i][known], color=RED, linewidth=1.1)
    axes.plot(share[known], level, "o", color=BLACK, markersize=3.2, linestyle="none")
    axes.set(xlim=(-0.03, 1.03), xlabel="probability of collapse [–]")
    axes.set_title(f"at {result.frequencies[i]:.2f} Hz, {100 * result.confidence:g} % intervals", fontsize=8.5)
    axes.grid(True)
    chart.annotate(
        "", (result.frequencies[i], 1.0), xytext=(0, 9), xycoords=("data", "axes fraction"),
        textcoords="offset points", arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 0.8},
    )  # fmt: skip
