"""Probability of collapse over the amplitude of one motion, with its interval."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..analysis.critical_population import CriticalPopulation
from ..constants import g
from .style import BLACK, BLUE, WIDTH, legend_below, panel, styled


@styled
def draw_collapse_over_amplitude(
    population: CriticalPopulation, title: str | None = None, *, ax: Axes | None = None
) -> Figure:
    """Share of the twins that collapse over the amplitude, with its confidence band; above it the factor of the record.

    Where twins are undecided there is no line, but a bar: from the share if none of them collapses to that if all do.

    Parameters
    ----------
    population : CriticalPopulation
    title : str, optional
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
    figure, axes = panel(ax, (WIDTH, 3.4))
    amplitudes, (low, high) = population.amplitudes / g, population.interval
    band = f"{100.0 * population.confidence:g} % interval (Wilson; undecided counted both ways)"
    axes.fill_between(amplitudes, low, high, step="mid", color=BLUE, alpha=0.25, linewidth=0.0, label=band)
    least, most = population.probability, population.undecided_collapsed
    known = np.where(most > least, np.nan, least)
    axes.plot(amplitudes, known, "o-", color=BLACK, markersize=3.0, label="share that collapses", clip_on=False)
    if (open_ := np.isnan(known) & np.isfinite(most)).any():
        label = "its range where some are undecided"
        low = np.nan_to_num(least[open_])
        bars = axes.vlines(amplitudes[open_], low, most[open_], color=BLACK, linewidth=3.0, alpha=0.5, label=label)
        bars.set_clip_on(False)
    axes.set_ylim(-0.03, 1.03)
    axes.set_xlim(amplitudes[0], max(amplitudes[-1], amplitudes[0] * 1.0001))
    axes.grid(axis="y")
    axes.set_xlabel("amplitude of acceleration [g]")
    axes.set_ylabel(f"probability of collapse [-]\n{len(population.verdicts)} {population.drawn.like} like this one")
    if population.nominal:
        scale = population.nominal / g
        above = axes.secondary_xaxis(
            "top", functions=(lambda a: np.asarray(a) / scale, lambda f: np.asarray(f) * scale)
        )
        above.set_xlabel("factor of the record [-]")
    axes.set_title(title or "")
    legend_below(axes, ax is None, ncols=2)
    return figure
