"""Several domains side by side on the same axes: models beside each other, columns below each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from stylobate.constants import g
from stylobate.messages import percents
from stylobate.plots.domain import draw_boundary, draw_cells, draw_static_line
from stylobate.plots.style import BLACK, WIDTH, page, styled
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import Domain

from ..doubt import Doubt
from .maps_side_by_side import draw_panels, frame


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
    size = (max(0.6, columns / 4) * WIDTH, 0.75 + 1.85 * len(rows))
    figure, handles = draw_panels(rows, size, _domain, title, figure)
    order = [label for label in (*v.VERDICTS, "first collapse", "static uplift") if label in handles]
    figure.legend(
        handles=[handles[label] for label in order], loc="outside lower center", ncols=6 if columns > 3 else 3
    )
    return figure


def _domain(axes: Axes, domain: Domain) -> tuple[dict[str, Artist], str]:
    """One domain of several: its handles by label, and the share that collapses, cells without a verdict both ways."""
    handles = _verdicts(axes, domain, domain.verdicts)
    edge = draw_boundary(axes, domain, {"color": BLACK, "linestyle": "-"}, "first collapse")
    if edge is not None:
        handles["first collapse"] = edge
    uplift = draw_static_line(axes, domain)
    handles["static uplift"] = Line2D([], [], color=uplift.get_color(), linestyle=uplift.get_linestyle(),
                                      linewidth=uplift.get_linewidth(), label="static uplift")  # fmt: skip
    counts, cells = domain.counts, len(domain.rows)
    return handles, percents(counts[v.COLLAPSED] / cells, 1.0 - counts[v.STANDS] / cells)


def _verdicts(axes: Axes, domain: Domain, verdicts: np.ndarray) -> dict[str, Artist]:
    """Cells of a domain by verdict; their handles by label, without the number of cells."""
    handles: dict[str, Artist] = {}
    for patch in draw_cells(axes, domain.frequencies, domain.amplitudes, verdicts):
        patch.set_label(str(patch.get_label()).split(" (")[0])
        handles[str(patch.get_label())] = patch
    return handles


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
    handles: dict[str, Artist] = {}
    for axes, (name, verdicts, differing) in zip(grid, panels):
        handles = _verdicts(axes, domain, verdicts) | handles
        if differing is not None:
            i, j = np.nonzero(differing)
            look = {"color": "white", "markeredgecolor": BLACK, "markersize": 3.4, "markeredgewidth": 0.7}
            axes.plot(domain.frequencies[i], domain.amplitudes[j] / g, "o", zorder=5, **look)
            name += f"\n{differing.sum()} of {differing.size} verdicts change"
        frame(axes, domain.frequencies, domain.amplitudes)
        axes.set_title(name, fontsize=8.5)
        axes.set_xlabel("frequency [Hz]")
    grid[0].set_ylabel("amplitude [g]")
    dot = Line2D([], [], marker="o", linestyle="none", color="white", markeredgecolor=BLACK, markersize=4.5,
                 label="another verdict than as computed")  # fmt: skip
    order = [handles[verdict] for verdict in v.VERDICTS if verdict in handles]
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    figure.legend(handles=[*order, dot], loc="outside lower center", ncols=5)
    return figure
