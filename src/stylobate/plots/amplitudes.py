"""Peak response and verdict over the amplitudes of one motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..analysis import verdicts as v
from ..analysis.critical import CriticalAmplitude
from ..constants import g
from .style import BLACK, BLUE, GREY, RED, WIDTH, legend_below, panel, styled

_MARKS: dict[str, dict[str, Any]] = {
    v.STANDS: {"marker": "o", "color": BLACK, "fillstyle": "none"},
    v.COLLAPSED: {"marker": "x", "color": RED},
    v.UNDECIDED: {"marker": "s", "color": GREY, "fillstyle": "none"},
    v.FAILED: {"marker": "+", "color": BLUE},
}


@styled
def draw_amplitudes(result: CriticalAmplitude, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Peak top displacement of the runs that have one, the verdict of every run, and the lowest collapse, of twins too.

    Parameters
    ----------
    result : CriticalAmplitude
    title : str, optional
        Column and model by default.
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
    amplitudes, verdicts = result.amplitudes / g, np.array(result.verdicts)
    if (width := result.column.base_width) is None:  # nor is there one top
        peaks, label = (
            result.rows.floats("peak_displacement_m"),
            "peak displacement of a block [m]\n(collapse: at the top)",
        )
    else:
        peaks = result.rows.floats("peak_top_displacement_m") / width
        label = "peak top displacement\n/ base width (collapse: at the top)"
    finite = peaks[np.isfinite(peaks) & (verdicts != v.COLLAPSED)]
    ceiling = 1.25 * max(float(finite.max()) if finite.size else 0.0, 0.1)
    shown = np.where((verdicts == v.COLLAPSED) | ~np.isfinite(peaks), ceiling, np.minimum(peaks, ceiling))
    figure, axes = panel(ax, (WIDTH, 3.4))
    for one, mark in _MARKS.items():
        chosen = verdicts == one
        if chosen.any():
            counted = f"{one} ({int(chosen.sum())})"
            axes.plot(amplitudes[chosen], shown[chosen], linestyle="none", markersize=5.0, label=counted, **mark)
    if result.critical is not None:
        at = result.critical / g
        whose = "" if result.population is None else " of this one"
        axes.axvline(at, color=RED, linewidth=0.8, label=f"lowest collapse{whose}, {at:.4g} g")
    if result.population is not None and (fell := float(result.population.critical.min())) < math.inf:
        label_of_likes = f"lowest of {len(result.population.verdicts)} like it, {fell / g:.4g} g"
        axes.axvline(fell / g, color=RED, linestyle=(0, (1.2, 1.2)), linewidth=1.2, label=label_of_likes)
    if (opens := result.column.uplift_acceleration) is not None:
        uplift = opens / g
        axes.axvline(uplift, color=BLUE, linestyle=(0, (6, 2.5)), linewidth=1.0, label=f"static uplift, {uplift:.3f} g")
    axes.set_ylim(0.0, 1.1 * ceiling)
    axes.set_xlabel("amplitude of acceleration [g]")
    axes.set_ylabel(label)
    axes.set_title(title or f"{result.column.name}, {result.model}")
    legend_below(axes, ax is None, ncols=3)
    return figure
