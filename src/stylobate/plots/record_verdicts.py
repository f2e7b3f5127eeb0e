"""Verdicts of every record of a suite over its amplitude, and the share of the records that collapse the column."""

from __future__ import annotations

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Patch

from ..analysis.critical_suite import CriticalSuite
from ..constants import g
from .domain import FILL, edges_of
from .style import BLACK, BLUE, WIDTH, page, plain, styled

#: Longer names of records are cut.
LONGEST = 30


@styled
def draw_record_verdicts(
    suite: CriticalSuite, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Share of collapse over the peak acceleration, and below it one strip of verdicts per record.

    Parameters
    ----------
    suite : CriticalSuite
    title : str, optional
        Column and model by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    count, amplitudes = len(suite.results), suite.amplitudes / g
    column = suite.results[0].column
    figure = page(figure, (WIDTH, 2.9 + 0.24 * count))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.6, 0.4 + 0.24 * count))
    edges = edges_of(amplitudes)
    upper.stairs(suite.share_collapsed, edges, baseline=None, color=BLACK, linewidth=1.4)
    upper.set_ylim(-0.03, 1.03)
    upper.grid(axis="y")
    upper.set_ylabel("share of motions\nthat collapse it [-]")
    verdicts = suite.verdicts
    handles = []
    for one, fill in FILL.items():
        cells = [
            [(edges[j], i - 0.4), (edges[j + 1], i - 0.4), (edges[j + 1], i + 0.4), (edges[j], i + 0.4)]
            for i, j in np.argwhere(verdicts == one)
        ]
        if cells:
            lower.add_collection(PolyCollection(cells, antialiaseds=False, **fill))
            frame = {"edgecolor": "#999999", "linewidth": 0.5}
            handles.append(Patch(label=f"{one} ({len(cells)})", **(fill | frame if "hatch" not in fill else fill)))
    lower.set_yticks(range(count), [plain(_short(result.motion.name)) for result in suite.results], fontsize=7.5)
    lower.set_ylim(count - 0.5, -0.5)
    lower.set_xlim(edges[0], edges[-1])
    lower.set_xlabel("peak ground acceleration [g]")
    lower.set_ylabel("motion / verdict")
    uplift = column.uplift_acceleration / g
    for axes in (upper, lower):
        line = axes.axvline(uplift, color=BLUE, linestyle=(0, (6, 2.5)), linewidth=1.1)
    line.set_label(f"static uplift, {uplift:.3f} g")
    upper.set_title(title or f"{column.name}, {suite.results[0].model}: {count} motions")
    figure.legend(handles=[*handles, line], loc="outside lower center", ncols=4)
    return figure


def _short(name: str) -> str:
    return name if len(name) <= LONGEST else f"{name[: LONGEST - 1]}…"
