"""Several domains side by side on the same axes: models beside each other, columns below each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..analysis import verdicts as v
from ..analysis.domain import Domain, cell_edges
from ..analysis.doubt import Doubt
from ..constants import g
from .domain import draw_boundary, draw_cells, draw_static_line
from .style import BLACK, WIDTH, page, styled


@styled
def draw_domain_panels(
    rows: Sequence[tuple[str, Sequence[tuple[str, Domain]]]], title: str, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Verdicts of every cell of several domains on one grid, with the share that collapses.

    Parameters
    ----------
    rows : sequence of (label of the row, panels), panels as (title, domain)
    title : str
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    columns = max(len(panels) for _, panels in rows)
    figure = page(figure, (max(0.6, columns / 4) * WIDTH, 0.75 + 1.85 * len(rows)))
    grid = figure.subplots(len(rows), columns, sharex=True, sharey=True, squeeze=False)
    handles: dict[str, Patch | Line2D] = {}
    for line, (label, panels) in zip(grid, rows):
        for axes, (name, domain) in zip(line, panels):
            for patch in draw_cells(axes, domain.frequencies, domain.amplitudes, domain.verdicts):
                patch.set_label(str(patch.get_label()).split(" (")[0])
                handles.setdefault(str(patch.get_label()), patch)
            edge = draw_boundary(axes, domain, {"color": BLACK, "linestyle": "-"}, "first collapse")
            if edge is not None:
                handles["first collapse"] = edge
            uplift = draw_static_line(axes, domain)
            handles["static uplift"] = Line2D([], [], color=uplift.get_color(), linestyle=uplift.get_linestyle(),
                                              linewidth=uplift.get_linewidth(), label="static uplift")  # fmt: skip
            _frame(axes, domain.frequencies, domain.amplitudes)
            share = domain.counts[v.COLLAPSED] / len(domain.rows)
            axes.set_title(f"{name}\n{100.0 * share:.0f} % collapse", fontsize=8.5)
        line[0].set_ylabel(f"{label}\namplitude [g]")
    for axes in grid[-1]:
        axes.set_xlabel("frequency [Hz]")
    order = [one for one in (*v.VERDICTS, "first collapse", "static uplift") if one in handles]
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    figure.legend(handles=[handles[one] for one in order], loc="outside lower center", ncols=6 if columns > 3 else 3)
    return figure


@styled
def draw_doubt(doubt: Doubt, title: str, *, figure: Figure | SubFigure | None = None) -> Figure:
    """The same domain asked three times: as it is, with half of the time step, with stones that differ by 1 %.

    Parameters
    ----------
    doubt : Doubt
    title : str
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    domain = doubt.steps.domain
    figure = page(figure, (WIDTH, 3.5))
    grid = figure.subplots(1, 3, sharex=True, sharey=True)
    panels = (
        ("as computed\n", domain.verdicts, None),
        ("half of the time step", doubt.steps.halved.verdicts, doubt.steps.differing),
        ("stones that differ by 1 %", doubt.another, doubt.differing),
    )
    handles: dict[str, Patch] = {}
    for axes, (name, verdicts, differing) in zip(grid, panels):
        for patch in draw_cells(axes, domain.frequencies, domain.amplitudes, verdicts):
            patch.set_label(str(patch.get_label()).split(" (")[0])
            handles.setdefault(str(patch.get_label()), patch)
        if differing is not None:
            i, j = np.nonzero(differing)
            look = {"color": "white", "markeredgecolor": BLACK, "markersize": 3.4, "markeredgewidth": 0.7}
            axes.plot(domain.frequencies[i], domain.amplitudes[j] / g, "o", zorder=5, **look)
            name += f"\n{differing.sum()} of {differing.size} verdicts change"
        _frame(axes, domain.frequencies, domain.amplitudes)
        axes.set_title(name, fontsize=8.5)
        axes.set_xlabel("frequency [Hz]")
    grid[0].set_ylabel("amplitude [g]")
    dot = Line2D([], [], marker="o", linestyle="none", color="white", markeredgecolor=BLACK, markersize=4.5,
                 label="another verdict than as computed")  # fmt: skip
    order = [handles[one] for one in v.VERDICTS if one in handles]
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    figure.legend(handles=[*order, dot], loc="outside lower center", ncols=5)
    return figure


def _frame(axes: Axes, frequencies: np.ndarray, amplitudes: np.ndarray) -> None:
    x, y = cell_edges(frequencies), cell_edges(amplitudes / g)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
