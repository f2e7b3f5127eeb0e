"""Peak response of columns or assemblies to the records of a suite, against a measure of the records."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import LogLocator, NullFormatter

from ..analysis import verdicts as v
from ..analysis.suite import INTENSITIES
from ..errors import InputError
from .style import BLACK, BLUE, GREY, RED, WIDTH, page, styled

if TYPE_CHECKING:
    import pandas

#: Smaller responses are drawn here: a closed column sways by its joints' flexibility only.
SMALLEST = 1e-4

#: More records than this are not numbered in the picture.
MOST_NUMBERS = 40

#: Quantities in pictures, by the column of the table: of columns, of assemblies.
PEAKS = {
    "peak_top_over_base_width": "peak top displacement\n/ base width [-]",
    "peak_displacement_m": "peak displacement\nof a block [m]",
}

_MARKS: dict[str, dict[str, Any]] = {
    "at rest": {"marker": "o", "color": GREY, "fillstyle": "none"},
    "rocked": {"marker": "o", "color": BLACK},
    "displaced": {"marker": "D", "color": BLUE, "fillstyle": "none"},
    v.COLLAPSED: {"marker": "X", "color": RED},
    v.UNDECIDED: {"marker": "s", "color": GREY},
    v.FAILED: {"marker": "+", "color": BLUE},
}


@styled
def draw_suite(
    table: pandas.DataFrame,
    against: str = "pgv_m_s",
    title: str | None = None,
    *,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Peak displacement over a measure of the records, one panel per column or assembly; the numbers are the records'.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`stylobate.analysis.suite.suite_table`.
    against : str
        A key of :data:`stylobate.analysis.suite.INTENSITIES`.
    title : str, optional
        What stands behind the name of each column; the model by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.

    Raises
    ------
    InputError
        No such measure.
    """
    if against not in INTENSITIES or against not in table:
        raise InputError(f"there is no measure {against!r} of records; measures are {', '.join(INTENSITIES)}.")
    columns = list(dict.fromkeys(table["column"]))
    figure = page(figure, (WIDTH, 1.2 + 2.7 * len(columns)))
    panels = figure.subplots(len(columns), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    values = table[against].to_numpy(dtype=float)
    name = next(peak for peak in PEAKS if peak in table)
    peaks = table[name].to_numpy(dtype=float)
    groups = _groups(table)
    finite = peaks[np.isfinite(peaks) & (groups != v.COLLAPSED)]
    ceiling = 2.0 * max(float(finite.max(initial=0.0)), 0.5)
    floor = max(SMALLEST, 0.5 * float(finite.min(initial=1.0)))
    shown = np.where((groups == v.COLLAPSED) | ~np.isfinite(peaks), ceiling, np.maximum(peaks, floor))
    handles: dict[str, Any] = {}
    for axes, column in zip(panels, columns):
        here = (table["column"] == column).to_numpy() & np.isfinite(values)
        for group, mark in _MARKS.items():
            chosen = here & (groups == group)
            if chosen.any():
                points = axes.plot(values[chosen], shown[chosen], linestyle="none", markersize=5.5, **mark)[0]
                handles.setdefault(group, points)
        if len(table) <= MOST_NUMBERS * len(columns):
            _number(axes, values[here], shown[here], table["number"].to_numpy()[here])
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.set_ylim(0.6 * floor, 1.8 * ceiling)
        axes.grid()
        axes.set_title(f"{column}, {title or table['model'].iloc[0]}")
        axes.set_ylabel(PEAKS[name])
    drawn = values[np.isfinite(values)]
    if drawn.size and drawn.min() > 0.0 and drawn.max() > 5.0 * drawn.min():
        panels[-1].set_xscale("log")
        panels[-1].xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        panels[-1].xaxis.set_major_formatter("{x:g}")
        panels[-1].xaxis.set_minor_formatter(NullFormatter())
    panels[-1].set_xlabel(INTENSITIES[against])
    labels = [f"{group} (drawn at the top)" if group == v.COLLAPSED else group for group in handles]
    if (peaks < floor).any():
        labels = [f"{group} (drawn at {floor:g} at least)" if group == "at rest" else group for group in labels]
    figure.legend(list(handles.values()), labels, loc="outside lower center", ncols=3)
    return figure


def _groups(table: pandas.DataFrame) -> np.ndarray:
    """Outcome of a run that stands, else its verdict."""
    outcome, verdicts = table["outcome"].str.replace("_", " "), table["verdict"]
    return np.where(verdicts == v.STANDS, outcome, verdicts).astype(object)


def _number(axes: Axes, x: np.ndarray, y: np.ndarray, numbers: np.ndarray) -> None:
    for one in zip(x, y, numbers):
        axes.annotate(str(one[2]), one[:2], xytext=(4, 2), textcoords="offset points", fontsize=6.5, color=BLACK)
