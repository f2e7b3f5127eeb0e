"""Verdicts over frequency and amplitude: the safe-unsafe domain, probabilities of collapse, the rocking spectrum."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, NullLocator

from ..constants import g
from ..messages import percent
from ..verdicts import domain as p
from ..verdicts import verdict as v
from ..verdicts.domain import CollapseProbability, Domain, cell_edges
from ..verdicts.domain import cell_edges as edges_of
from ..verdicts.rocking_spectrum import RockingSpectrum
from .style import BLACK, BLUE, CYCLE, HALO, RED, SAND, WIDTH, legend_below, page, panel, styled

# Light where it stands, dark where it collapses: also in grey.
FILL = {
    v.STANDS: {"facecolor": SAND, "edgecolor": "none"},
    v.COLLAPSED: {"facecolor": "#a6372f", "edgecolor": "none"},
    v.UNDECIDED: {"facecolor": "#c0c0c0", "edgecolor": "#404040", "hatch": "////", "linewidth": 0.0},
    v.FAILED: {"facecolor": "white", "edgecolor": BLACK, "hatch": "xxxx", "linewidth": 0.5},
    v.NOT_RUN: {"facecolor": "white", "edgecolor": "none"},
}


@styled
def draw_domain(domain: Domain, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Cells by verdict, the boundary of the first collapse, and the static acceleration that opens a joint."""
    figure, axes = panel(ax, (WIDTH, 4.4))
    handles = draw_cells(axes, domain.frequencies, domain.amplitudes, domain.verdicts)
    handles += [
        draw_boundary(axes, domain, {"color": BLACK, "linestyle": "-"}, "first collapse"),
        draw_static_line(axes, domain),
    ]
    _finish(axes, domain, title or f"{domain.column.name}, {domain.model}")
    legend_below(axes, ax is None, handles=[h for h in handles if h is not None], ncols=4)
    return figure


@styled
def draw_boundaries(
    domains: Sequence[Domain], title: str | None = None, looks: Sequence[int] | None = None, *, ax: Axes | None = None
) -> Figure:
    """Boundaries of the first collapse of several domains of one column in one picture.

    Parameters
    ----------
    domains : sequence of Domain
    looks : sequence of int, optional
        Number of each domain's line and mark, so that a model looks alike in several pictures; by default in order.
    """
    figure, axes = panel(ax, (WIDTH, 4.4))
    handles = [
        draw_boundary(axes, domain, CYCLE[i % len(CYCLE)], domain.model, marker="os^Dv"[i % 5])
        for i, domain in zip(range(len(domains)) if looks is None else looks, domains)
    ]
    handles.append(draw_static_line(axes, domains[0]))
    _finish(axes, domains[0], title or f"{domains[0].column.name}: first collapse")
    legend_below(axes, ax is None, handles=[h for h in handles if h is not None], ncols=4)
    return figure


def draw_cells(axes: Axes, frequencies: np.ndarray, amplitudes: np.ndarray, verdicts: np.ndarray) -> list[Patch]:
    """Fill the cells by verdict; returns what the legend shows, each with its number of cells."""
    x, y = edges_of(frequencies), edges_of(amplitudes / g)
    handles = []
    for verdict, fill in FILL.items():
        if number := fill_cells(axes, x, y, verdicts == verdict, fill):
            handles.append(Patch(label=f"{verdict} ({number})", **framed(fill)))
    return handles


def fill_cells(axes: Axes, x: np.ndarray, y: np.ndarray, where: np.ndarray, fill: dict[str, Any]) -> int:
    """Fill some cells of a grid; returns how many.

    Parameters
    ----------
    axes : Axes
    x, y : array
        Edges of the cells, shapes (F + 1,) and (A + 1,).
    where : array of bool
        Which cells, shape (F, A).
    fill : dict
        How they look.
    """
    cells = [[(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])] for i, j in np.argwhere(where)]
    if cells:
        axes.add_collection(PolyCollection(cells, antialiaseds=False, zorder=1, rasterized=len(cells) > 20_000, **fill))
    return len(cells)


def framed(fill: dict[str, Any]) -> dict[str, Any]:
    """The look of cells in a legend: with a frame, where they are not hatched."""
    frame = {"edgecolor": "#999999", "linewidth": 0.5}
    return frame | fill if "hatch" in fill else fill | frame


def draw_boundary(axes: Axes, domain: Domain, line: dict, label: str, marker: str | None = None) -> Line2D | None:
    """Lower edge of the smallest collapsing cell at each frequency, interrupted where nothing collapses."""
    first = domain.first_collapse
    if np.isnan(first).all():
        return None
    if marker is not None:
        shape = {"marker": marker, "markersize": 4.5, "fillstyle": "none"}
        return axes.plot(domain.frequencies, first / g, label=label, zorder=3, **shape, **line)[0]
    x, lower = edges_of(domain.frequencies), edges_of(domain.amplitudes / g)[:-1]
    level = np.where(np.isnan(first), np.nan, lower[np.searchsorted(domain.amplitudes, first) % len(lower)])
    axes.stairs(level, x, baseline=None, linewidth=1.6, zorder=3, **line)
    return Line2D([], [], linewidth=1.6, label=label, **line)


def draw_static_line(axes: Axes, domain: Domain) -> Line2D:
    """The static acceleration that opens a joint, seen on light and on dark cells."""
    value = domain.column.uplift_acceleration / g
    look: dict[str, Any] = {"color": BLUE, "linestyle": (0, (6, 2.5)), "linewidth": 1.3, "zorder": 2}
    return axes.axhline(value, label=f"static uplift, {value:.3f} g", path_effects=HALO, **look)


def _finish(axes: Axes, domain: Domain, title: str) -> None:
    x, y = edges_of(domain.frequencies), edges_of(domain.amplitudes / g)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(min(y[0], 0.95 * domain.column.uplift_acceleration / g), y[-1])
    axes.set_xlabel("frequency of the base motion [Hz]")
    axes.set_ylabel("amplitude of acceleration [g]")
    axes.set_title(title)


# -- Probability of collapse over frequency and amplitude -------------------------------------------------------------


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
    """Map of the share that collapses, the edges of the uncertain band, and one cut with its confidence intervals."""
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
        sentence = f"{percent(open_cells / facts['cells'])} of the cells have no verdict: follow the column longer"
        if open_cells == facts["cells"]:
            return sentence
        return f"{_about_the_others(result, facts)}\n{sentence}"
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
        below = [
            np.nan if np.isnan(amplitude) else edges[np.searchsorted(result.amplitudes, amplitude)] for amplitude in low
        ]
        above = [
            np.nan if np.isnan([upper, first]).any() or beyond else edges[np.searchsorted(result.amplitudes, upper) + 1]
            for upper, first, beyond in zip(high, low, result.band_is_open)
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


# -- The rocking spectrum of a motion ---------------------------------------------------------------------------------


#: Light to dark in colour and in grey, and lighter than the blocks that fell.
SHADES = LinearSegmentedColormap.from_list("rotation", ["#fdf3c4", "#f0b75a", "#cb643c", "#963a30"])
_FILL: dict[str, dict[str, Any]] = {
    "closed": {"facecolor": "white", "edgecolor": "#999999", "linewidth": 0.5},
    "overturned": {"facecolor": "#141414", "edgecolor": "none"},
    "undecided": {"facecolor": "#d9d9d9", "edgecolor": "#4d4d4d", "hatch": "////", "linewidth": 0.0},
}

_TICKS = (0.2, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 10.0, 15.0, 20.0, 30.0, 50.0)


@styled
def draw_rocking_spectrum(
    spectrum: RockingSpectrum, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Peak rotation over slenderness, on the map of p and α; beside them ω_g/p and PGA/(g tan α)."""
    figure = page(figure, (WIDTH, 5.0))
    axes = figure.subplots()
    p, alpha = spectrum.frequency_parameter, spectrum.slenderness
    x, y = np.exp(edges_of(np.log(p))), edges_of(alpha)
    fallen = spectrum.collapsed & spectrum.decided
    rocking = spectrum.decided & ~spectrum.collapsed & ~spectrum.closed
    shown = np.ma.masked_where(~rocking, np.clip(spectrum.ratio, 0.0, 1.0))
    mesh = axes.pcolormesh(x, y, shown.T, cmap=SHADES, vmin=0.0, vmax=1.0, rasterized=True)
    handles = []
    groups = {"closed": spectrum.closed, "overturned": fallen, "undecided": ~spectrum.decided}
    for name, chosen in groups.items():
        if number := int(chosen.sum()):
            if name != "closed":
                fill_cells(axes, x, y, chosen, _FILL[name])
            handles.append(Patch(label=f"{name} ({number})", **_FILL[name]))
    axes.set_xscale("log")
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    axes.xaxis.set_major_locator(FixedLocator([tick for tick in _TICKS if x[0] <= tick <= x[-1]]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_xlabel("frequency parameter of the block p [rad/s]")
    axes.set_ylabel("slenderness of the block α [rad]")
    _relations(axes, spectrum, (y[0], y[-1]))
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, fraction=0.05)
    bar.set_label("peak rotation / α of blocks that rock [-]")
    figure.suptitle(title or f"{spectrum.motion}: rocking spectrum", x=0.01, ha="left", fontsize=10.0)
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _relations(axes: Axes, spectrum: RockingSpectrum, limits: tuple[float, float]) -> None:
    """Second scales: what the motion is for the blocks."""
    if spectrum.pga == 0.0:
        return
    if math.isfinite(spectrum.pulse_period):
        omega = 2.0 * math.pi / spectrum.pulse_period
        low, high = axes.get_xlim()
        ratios = [tick for tick in _TICKS if low <= omega / tick <= high]
        top = axes.twiny()
        top.set_xscale("log")
        top.set_xlim(low, high)
        top.set_xticks([omega / tick for tick in ratios], [f"{tick:g}" for tick in ratios])
        top.xaxis.set_minor_locator(NullLocator())
        top.spines["top"].set_visible(True)
        top.set_xlabel(f"ω$_g$/p [-], strongest pulse of the motion {spectrum.pulse_period:.2g} s")
    peak = spectrum.pga / g
    ratios = [tick for tick in _TICKS if limits[0] <= math.atan(peak / tick) <= limits[1]]
    right = axes.twinx()
    right.set_ylim(limits)
    right.set_yticks([math.atan(peak / tick) for tick in ratios], [f"{tick:g}" for tick in ratios])
    right.spines["right"].set_visible(True)
    right.set_ylabel(f"PGA/(g tan α) [-], PGA {peak:.3g} g")
    if limits[0] < math.atan(peak) < limits[1]:
        right.axhline(math.atan(peak), color=BLACK, linewidth=0.8, linestyle=(0, (6, 2.5)))
