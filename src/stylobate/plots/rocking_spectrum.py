"""The rocking spectrum of a motion: peak rotation of free-standing blocks over their size and slenderness."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, NullLocator

from ..analysis.rocking_spectrum import RockingSpectrum
from ..constants import g
from .domain import edges_of, fill_cells
from .style import BLACK, WIDTH, page, styled

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
    """Peak rotation over slenderness, on the map of p and α; beside them ω_g/p and PGA/(g tan α).

    Parameters
    ----------
    spectrum : RockingSpectrum
    title : str, optional
        Name of the motion by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
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
