"""Curves of an incremental dynamic analysis, and the intensity measures of its capacities side by side."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..analysis.capacity import SHARES
from ..analysis.directions import peak_of
from ..analysis.ida_curves import Ida
from ..percent import percent
from .fragility import NARROW
from .style import BLACK, BLUE, GREY, RED, panel, styled

if TYPE_CHECKING:
    import pandas

#: Width of the picture over the largest response that stands.
ROOM = 1.25

#: A picture ends at so many times the median capacity; what lies above is said.
FAR = 3.0


@styled
def draw_ida(result: Ida, edp: str | None = None, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Intensity over the response of every record, collapses as plateaus, and the curves of 16, 50 and 84 %.

    Parameters
    ----------
    result : Ida
    edp : str, optional
        Measure of the response, as a column of the table of runs; the peak displacement by default. Displacements are
        drawn in base widths where there is a base.
    title : str, optional
        Column and model by default.
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
    figure, axes = panel(ax, (NARROW[0], 3.9))
    curves, table = result.curves(edp), result.fractiles(edp)
    edp = peak_of(result.runs) if edp is None else edp
    width = result.column.base_width if edp.endswith("displacement_m") else None
    size = 1.0 if width is None else width
    largest = max((float(curve.edp.max(initial=0.0)) for curve in curves), default=0.0) / size
    right = ROOM * (largest or 1.0)
    handles = {}
    for curve in curves:
        below = curve.im < curve.collapses
        x, y = np.concatenate(([0.0], curve.edp[below] / size)), np.concatenate(([0.0], curve.im[below]))
        if math.isfinite(curve.collapses):
            edge = math.sqrt(curve.stands * curve.collapses) if curve.stands else 0.5 * curve.collapses
            x, y = np.append(x, [x[-1], right]), np.append(y, [edge, edge])
        (handles["one record"],) = axes.plot(x, y, color=GREY, linewidth=0.6, alpha=0.8)
        if len(curve.resurrections):
            again = ~below
            (handles["stands again"],) = axes.plot(
                curve.edp[again] / size, curve.im[again], "o", color=BLUE, markersize=3.2, markerfacecolor="white"
            )
    for share, look in zip(SHARES, ((0, (1.2, 1.2)), "-", (0, (5, 2)))):
        edp_values = table[f"edp_{100 * share:.0f}"].to_numpy() / size
        known = ~np.isnan(edp_values)
        known &= np.cumsum(np.isinf(edp_values)) <= 1  # up to the plateau
        x = np.minimum(edp_values[known], right)
        (handles[f"{percent(share)} of the records"],) = axes.plot(
            x, table["im"].to_numpy()[known], color=RED if share == 0.5 else BLACK, linestyle=look, linewidth=1.6
        )
    fell = [curve.collapses for curve in curves if math.isfinite(curve.collapses)]
    high = max((float(curve.im.max(initial=0.0)) for curve in curves), default=1.0)
    if fell and max(fell) > FAR * float(np.median(fell)):
        high = min(high, FAR * float(np.median(fell)))
        hidden = sum(curve.collapses > high for curve in curves)
        title = title or f"{result.column.name}, {result.model}; {hidden} of {len(curves)} plateaus lie above"
    axes.set(xlim=(0.0, right), ylim=(0.0, 1.05 * max([high, *(one for one in fell if one <= high)])))
    words = edp.removesuffix("_m").removesuffix("_rad").replace("_", " ")
    unit = "base widths" if width is not None else "rad" if edp.endswith("_rad") else "m"
    axes.set_xlabel(f"{words} [{unit}], collapse →")
    axes.set_ylabel(result.measure.words)
    axes.grid(True)
    axes.set_title(title or f"{result.column.name}, {result.model}", fontsize=9)
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=2, fontsize=8)
    return figure


@styled
def draw_efficiency(table: pandas.DataFrame, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Dispersion of the capacities given each intensity measure, the smallest first, with its interval.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`stylobate.analysis.efficiency.which_tells_most`.
    title : str, optional
    ax : Axes, optional
        To draw in; those of a new figure by default.
    """
    figure, axes = panel(ax, (NARROW[0], 1.2 + 0.23 * len(table)))
    at = np.arange(len(table))
    beta = table["beta"].to_numpy(dtype=float)
    high = table["beta_high"].to_numpy(dtype=float)
    most = 1.05 * min(float(np.max(high)), 3.0 * float(beta.max()))
    axes.hlines(at, table["beta_low"], np.minimum(high, 2.0 * most), color=BLACK, linewidth=1.2)
    axes.plot(beta, at, "o", color=RED, markersize=4.5)
    axes.set_yticks(at, list(table["measure"]), fontsize=8)
    axes.set(ylim=(len(at) - 0.5, -0.5), xlim=(0.0, most))
    axes.set_xlabel("dispersion of the capacities, β [-]")
    axes.grid(True, axis="x")
    axes.set_title(title or "Which intensity measure tells most", fontsize=9)
    return figure
