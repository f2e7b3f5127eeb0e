"""The safe-unsafe domain: verdicts over frequency and amplitude, the boundary of collapse, and the static line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..analysis import verdicts as v
from ..analysis.domain import Domain
from ..analysis.domain import cell_edges as edges_of
from ..constants import g
from .style import BLACK, BLUE, CYCLE, HALO, SAND, WIDTH, legend_below, panel, styled

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
    """Cells by verdict, the boundary of the first collapse, and the static acceleration that opens a joint.

    Parameters
    ----------
    domain : Domain
    title : str, optional
        Column and model by default.
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
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
    title : str, optional
    looks : sequence of int, optional
        Number of each domain's line and mark, so that a model looks alike in several pictures; by default in order.
    ax : Axes, optional
        To draw in; those of a new figure by default.
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
    for one, fill in FILL.items():
        if number := fill_cells(axes, x, y, verdicts == one, fill):
            handles.append(Patch(label=f"{one} ({number})", **framed(fill)))
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
