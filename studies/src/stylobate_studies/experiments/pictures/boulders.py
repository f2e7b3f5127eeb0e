"""Boulders on the shaking table: verdicts computed and observed, fragility, reliability of probabilities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure, SubFigure

from stylobate.plots.style import BLACK, BLUE, BROWN, GREY, RED, WIDTH, legend_below, page, panel, styled
from stylobate.verdicts.verdict import wilson_interval

#: Observed, computed: how it is drawn, and said.
_MARKS: dict[tuple[bool, bool], tuple[dict[str, Any], str]] = {
    (False, False): ({"marker": "o", "color": GREY, "fillstyle": "none", "markersize": 4.0}, "stood, computed so"),
    (True, True): ({"marker": "X", "color": RED, "markersize": 5.5}, "toppled, computed so"),
    (True, False): ({"marker": "^", "color": BLUE, "markersize": 6.0}, "toppled, computed to stand"),
    (False, True): ({"marker": "v", "color": BLACK, "markersize": 6.0}, "stood, computed to topple"),
}


@styled
def draw_verdicts(table: Any, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Every test over its peak acceleration and velocity, one panel per specimen.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`stylobate_studies.experiments.granite.tests_table`.
    figure : Figure or SubFigure, optional
    """
    names = list(dict.fromkeys(table["specimen"]))
    figure = page(figure, (WIDTH, 4.2))
    panels = figure.subplots(1, len(names), sharex=True, sharey=True, squeeze=False)[0]
    handles = {}
    for axes, name in zip(panels, names):
        rows = table[table["specimen"] == name]
        for key, (mark, label) in _MARKS.items():
            here = rows[(rows["observed"] == key[0]) & (rows["computed"] == key[1])]
            handles[label] = axes.plot(here["pga_10hz_g"], here["pgv_m_s"], linestyle="none", **mark)[0]
        right = float((rows["observed"] == rows["computed"]).mean())
        axes.set_title(f"{name}: {len(rows)} tests, {right:.1%} right")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.set_xlabel("PGA below 10 Hz [g]")
        axes.grid()
    panels[0].set_ylabel("PGV [m/s]")
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=2)
    return figure


@styled
def draw_boulder_fragility(
    table: Any,
    half: Any,
    summary: Mapping[str, Any],
    *,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Share of tests that toppled over PGV, observed and computed; below, PGV at half of them in bins of PGV/PGA.

    Parameters
    ----------
    table, half : pandas.DataFrame
        Tests, and rows of :func:`stylobate_studies.experiments.granite.half_table`.
    summary : mapping
        ``granite`` of the summary.
    figure : Figure or SubFigure, optional
    """
    from scipy.special import ndtr

    names = list(dict.fromkeys(table["specimen"]))
    figure = page(figure, (WIDTH, 5.8))
    panels = figure.subplots(2, len(names), squeeze=False, sharey="row")
    looks = {"observed": (BLACK, "-", "o"), "computed": (RED, "--", "s")}
    for column, name in enumerate(names):
        rows, axes = table[table["specimen"] == name], panels[0, column]
        pgv = rows["pgv_m_s"].to_numpy()
        grid = np.geomspace(pgv.min(), pgv.max(), 200)
        edges = np.quantile(pgv, np.linspace(0.0, 1.0, 9))
        for key, (color, dashes, marker) in looks.items():
            curve = summary[name]["fragility_pgv_m_s"][key]
            axes.plot(
                grid, ndtr(np.log(grid / curve["median"]) / curve["beta"]), color=color, linestyle=dashes, label=key
            )
            if key == "observed":
                groups = np.clip(np.searchsorted(edges, pgv, side="right") - 1, 0, 7)
                k = np.array([rows[key].to_numpy()[groups == group].sum() for group in range(8)])
                n = np.array([(groups == group).sum() for group in range(8)])
                low, high = wilson_interval(k, n)
                at = np.array([np.exp(np.log(pgv[groups == group]).mean()) for group in range(8)])
                axes.errorbar(
                    at, k / n, [k / n - low, high - k / n], fmt=marker, color=GREY, markersize=3.5, linewidth=0.8
                )
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("")
        axes.set_title(name)
        axes.set_xlabel("PGV [m/s]")
        axes.grid()
        below, bins = panels[1, column], half[half["specimen"] == name]
        middle = np.sqrt(bins["pgv_over_pga_from_s"] * bins["pgv_over_pga_to_s"]).to_numpy()
        for (key, (color, _, marker)), aside in zip(looks.items(), (0.97, 1.03)):
            value = bins[f"{key}_median"].to_numpy(dtype=float)
            ends = [bins[f"{key}_median_{end}"].to_numpy(dtype=float) for end in ("low", "high")]
            below.errorbar(
                middle * aside, value, [value - ends[0], ends[1] - value], fmt=marker, color=color, markersize=4.5
            )
        below.set_xscale("log")
        below.xaxis.set_major_formatter("{x:g}")
        below.xaxis.set_minor_formatter("")
        below.set_xlabel("PGV/PGA [s], four bins of as many tests")
        below.grid()
    panels[0, 0].set_ylabel("share that toppled [-]")
    panels[1, 0].set_ylabel("PGV at half toppled [m/s]")
    panels[1, 0].set_ylim(bottom=0.0)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure


@styled
def draw_reliability(table: Any, *, ax: Any = None) -> Figure:
    """Observed share of toppled over the computed probability; on the diagonal the probability is what it says.

    Parameters
    ----------
    table : pandas.DataFrame
        Rows of :func:`stylobate_studies.experiments.scores.reliability` with ``specimen``.
    ax : Axes, optional
    """
    figure, axes = panel(ax, (4.6, 4.6))
    axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
    # numbers of the two specimens on either side of their marks: bins often hold the same share
    looks = ((BROWN, "o", -0.012, "right"), (BLUE, "s", 0.012, "left"))
    for (name, rows), (color, marker, aside, side) in zip(table.groupby("specimen"), looks):
        x, y = rows["probability"].to_numpy() + aside, rows["observed"].to_numpy()
        ends = [y - rows["observed_low"], rows["observed_high"] - y]
        axes.errorbar(x, y, ends, fmt=marker, color=color, markersize=5, linewidth=0.9, label=str(name))
        for point in zip(x, y, rows["tests"]):
            place = (-5 if side == "right" else 5, -9)
            axes.annotate(
                str(point[2]), point[:2], xytext=place, textcoords="offset points", ha=side, fontsize=7.5, color=color
            )
    axes.set_xlim(-0.09, 1.09)
    axes.set_ylim(-0.06, 1.04)
    axes.set_aspect("equal")
    axes.grid()
    axes.set_xlabel("computed probability of toppling [-]")
    axes.set_ylabel("share that toppled, with the number of tests [-]")
    legend_below(axes, ax is None, ncols=2)
    return figure
