"""Several states of a column: their fragility curves, and what each changes, with intervals over the same records."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..analysis.states import StateComparison
from .fragility import draw_fragility
from .style import BLACK, GREY, WIDTH, page, styled


@styled
def draw_states(found: StateComparison, title: str = "") -> Figure:
    """Fragility curves beside the differences in the share of runs that exceed the limit state.

    Parameters
    ----------
    found : StateComparison
    title : str
    """
    figure = page(None, (WIDTH, 4.4))
    curves, bars = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    known = [one for one in found.curves if one is not None]
    if known:
        draw_fragility(known, title or found.state, ax=curves)
    else:
        curves.text(0.5, 0.5, "no curve: all runs say the same,\nor too few records", ha="center", va="center")
        curves.set(xticks=[], yticks=[])
    places = np.arange(len(found.differences))[::-1]
    values = 100.0 * np.array([(one.share, one.share_low, one.share_high) for one in found.differences]).reshape(-1, 3)
    bars.axvline(0.0, color=GREY, linewidth=0.8)
    spread = np.clip(np.stack((values[:, 0] - values[:, 1], values[:, 2] - values[:, 0])), 0.0, None)
    bars.errorbar(
        values[:, 0], places, xerr=spread, color=BLACK, marker="o", markersize=4.0, linestyle="none", capsize=2.5
    )
    bars.set_yticks(places, [one.state for one in found.differences])
    bars.set_ylim(-0.6, len(places) - 0.4)
    bars.set_xlabel(f"runs with {found.state}, less those {found.labels[0]} [%]")
    bars.set_title("paired, 95 % over records", fontsize=9)
    bars.grid(True, axis="x")
    return figure
