"""Fragility, incremental dynamic analyses, states of a column side by side, design values and risk."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import LogLocator, NullFormatter

from ..errors import InputError
from ..messages import percent
from ..motion.intensity import parse_measure
from ..probability.design import basis_of, where, worst_of
from ..probability.evidence import Ida
from ..probability.fragility import FEWEST, Fragility
from ..probability.lognormal import curve
from ..probability.risk import Risk, years
from ..probability.states import INCONCLUSIVE, STRONGER, WEAKER, Difference, StateComparison
from ..probability.suite import INTENSITIES
from ..verdicts import verdict as v
from ..verdicts.directions import peak_of
from ..verdicts.limit_states import FAILED, OPEN, median_name, median_words
from ..verdicts.verdict import SHARES
from .style import BLACK, BLUE, CYCLE, GREY, RED, WIDTH, in_lines, legend_below, page, panel, plain, styled

if TYPE_CHECKING:
    import pandas


#: Width and height of a picture for one column of a printed page, where its text is still legible [inch].
NARROW = (4.4, 3.7)

#: A curve whose fit has a smaller p is told to fit badly.
BADLY = 0.05

_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": RED, "linestyle": "-", "marker": "o"},
    {"color": BLUE, "linestyle": (0, (5, 2)), "marker": "s"},
    {"color": BLACK, "linestyle": (0, (1.5, 1.2)), "marker": "^"},
    {"color": "#5aae61", "linestyle": "-.", "marker": "D"},
)


@styled
def draw_fragility(
    curves: Fragility | Sequence[Fragility], title: str | None = None, *, ax: Axes | None = None
) -> Figure:
    """Probability of a state over the intensity, each curve between the intensities that were run.

    Parameters
    ----------
    curves : Fragility or sequence of Fragility
        Of one intensity measure; two columns, or one with and without a measure.
    """
    fits = [curves] if isinstance(curves, Fragility) else list(curves)
    figure, axes = panel(ax, NARROW)
    ends = min(fit.span[0] for fit in fits), max(fit.span[1] for fit in fits)
    fine = {"linewidth": 0.7, "linestyle": (0, (1, 1.5))}
    for fit, look in zip(fits, _LOOKS * len(fits)):
        colour, x = look["color"], np.geomspace(*fit.span, 300)
        below, above = fit.interval(x)
        axes.fill_between(x, below, above, color=colour, alpha=0.18, linewidth=0.0)
        if fit.evidence.count(-1) + fit.evidence.count(-2):
            for extreme in fit.extremes:
                axes.plot(x, curve(x, *extreme), color=colour, **fine)
        name = fit.evidence.name if len(fits) > 1 else "lognormal"
        badly = ", fits badly" if fit.p_value < BADLY else ""
        spread = f"β {fit.beta:.2f}" if fit.bracket is None else "β not seen"
        label = f"{name}: {median_words(fit.summary())}, {spread}, {fit.records} {fit.counted}{badly}"
        axes.plot(x, fit.probability(x), color=colour, linestyle=look["linestyle"], linewidth=1.6, label=label)
        p = fit.points
        bars = np.clip(np.stack((p.share - p.low, p.high - p.share)), 0.0, None)
        axes.errorbar(
            p.im, p.share, bars, color=colour, linestyle="none", marker=look["marker"], markersize=3.4, linewidth=0.8,
            markerfacecolor="white",
        )  # fmt: skip
    if any(fit.evidence.count(-1) + fit.evidence.count(-2) for fit in fits):
        axes.plot([], [], color=GREY if len(fits) > 1 else RED, label="if all that is undecided did, or none", **fine)
    axes.set(ylim=(-0.03, 1.03), xlim=(ends[0] / 1.1, 1.1 * ends[1]))
    logarithmic(axes)
    measure, state = fits[0].evidence.measure, fits[0].evidence.state
    axes.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    axes.set_ylabel(f"probability of {state}")
    axes.grid(True)
    laws = " and laws of the joints" if any(fit.laws for fit in fits) else ""
    axes.set_title(title or f"{state}, {100 * fits[0].confidence:g} % bands over {fits[0].counted}{laws}", fontsize=9)
    legend_below(axes, ax is None, handlelength=2.4, ncols=1, fontsize=8)
    return figure


def logarithmic(axes: Axes) -> None:
    """Plain numbers on a logarithmic intensity."""
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())


# -- Curves of an incremental dynamic analysis, and the intensity measures of its capacities side by side -------------


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
    """
    figure, axes = panel(ax, (NARROW[0], 3.9))
    curves, table = result.curves(edp), result.fractiles(edp)
    edp = peak_of(result.runs) if edp is None else edp
    width = result.column.base_width if edp.endswith("displacement_m") else None
    size = 1.0 if width is None else width
    largest = max((float(record.edp.max(initial=0.0)) for record in curves), default=0.0) / size
    right = ROOM * (largest or 1.0)
    handles = {}
    for record in curves:
        below = record.im < record.collapses
        x, y = np.concatenate(([0.0], record.edp[below] / size)), np.concatenate(([0.0], record.im[below]))
        if math.isfinite(record.collapses):
            edge = math.sqrt(record.stands * record.collapses) if record.stands else 0.5 * record.collapses
            x, y = np.append(x, [x[-1], right]), np.append(y, [edge, edge])
        (handles["one record"],) = axes.plot(x, y, color=GREY, linewidth=0.6, alpha=0.8)
        if len(record.resurrections):
            again = ~below
            (handles["stands again"],) = axes.plot(
                record.edp[again] / size, record.im[again], "o", color=BLUE, markersize=3.2, markerfacecolor="white"
            )
    for share, look in zip(SHARES, ((0, (1.2, 1.2)), "-", (0, (5, 2)))):
        edp_values = table[f"edp_{100 * share:.0f}"].to_numpy() / size
        known = ~np.isnan(edp_values)
        known &= np.cumsum(np.isinf(edp_values)) <= 1  # up to the plateau
        x = np.minimum(edp_values[known], right)
        (handles[f"{percent(share)} of the records"],) = axes.plot(
            x, table["im"].to_numpy()[known], color=RED if share == 0.5 else BLACK, linestyle=look, linewidth=1.6
        )
    fell = [record.collapses for record in curves if math.isfinite(record.collapses)]
    high = max((float(record.im.max(initial=0.0)) for record in curves), default=1.0)
    if fell and max(fell) > FAR * float(np.median(fell)):
        high = min(high, FAR * float(np.median(fell)))
        hidden = sum(record.collapses > high for record in curves)
        title = title or f"{result.column.name}, {result.model}; {hidden} of {len(curves)} plateaus lie above"
    axes.set(xlim=(0.0, right), ylim=(0.0, 1.05 * max([high, *(level for level in fell if level <= high)])))
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
        From :func:`stylobate.probability.ida.which_tells_most`.
    """
    table = table.dropna(subset=["beta"])  # levels too far apart show no dispersion
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


# -- Peak response of columns or assemblies to the records of a suite, against a measure of the records ---------------


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
        From :func:`stylobate.probability.suite.suite_table`.
    against : str
        A key of :data:`stylobate.probability.suite.INTENSITIES`.

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
    outcome, verdicts = table["outcome"].str.replace("_", " "), table["verdict"]
    groups = np.where(verdicts == v.STANDS, outcome, verdicts).astype(object)
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
            for x, y, number in zip(values[here], shown[here], table["number"].to_numpy()[here]):
                axes.annotate(str(number), (x, y), xytext=(4, 2), textcoords="offset points", fontsize=6.5, color=BLACK)
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


# -- Several states of a column ---------------------------------------------------------------------------------------


#: Markers, after as many colours as the style has.
_MARKERS = ("", "o", "s", "^")


@styled
def draw_states(comparison: StateComparison, title: str = "", *, figure: Figure | SubFigure | None = None) -> Figure:
    """Fragility curves beside the differences in the share of runs that exceed the limit state.

    Without any curve the differences stand alone. The band is that of the first state with a curve; those of the others
    stand in the table. A state with undecided runs
    has two thin curves: if all of them exceeded the limit state, and if none did. Right: thick from the best to the worst
    that the undecided can come to, a circle where all is decided; the interval over records holds both ends. Grey: nothing
    is concluded.
    """
    known = [fit for fit in comparison.curves if fit is not None]
    figure = page(figure, (WIDTH, 4.4 if known else min(2.2 + 0.4 * len(comparison.differences), 4.4)))
    if known:
        curves, bars = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        _draw_curves(curves, known, comparison.state)
        for label, fit in zip(comparison.labels, comparison.curves, strict=True):
            if fit is None:
                curves.plot([], [], color="none", label=f"{label}: no curve")
        curves.legend(loc="upper left", fontsize=7.5, handlelength=2.6)
    else:
        bars = figure.subplots()
    if title:
        figure.suptitle(in_lines(title), x=0.02, ha="left")
    places = np.arange(len(comparison.differences))[::-1]
    bars.axvline(0.0, color=GREY, linewidth=0.8)
    for difference, place in zip(comparison.differences, places):
        _draw_difference(bars, difference, float(place))
    several = len({difference.against for difference in comparison.differences}) > 1
    names = [
        plain(difference.state) + (f"\nagainst {plain(difference.against)}" if several else "")
        for difference in comparison.differences
    ]
    bars.set_yticks(places, names)
    bars.set_ylim(-0.6, len(places) - 0.4)
    against = "the other one" if several else f"“{plain(comparison.differences[0].against)}”"
    bars.set_xlabel(f"share of runs with {comparison.state},\nless that of {against}\n[percentage points], paired")
    _say_which_side(bars, comparison)
    if any(difference.undecided for difference in comparison.differences):
        bars.plot([], [], color=BLACK, linewidth=4.0, alpha=0.5, label="undecided, both ways")
        figure.legend(*bars.get_legend_handles_labels(), loc="outside lower right", fontsize=7.5)
    bars.grid(True, axis="x")
    return figure


def _say_which_side(axes: Axes, comparison: StateComparison) -> None:
    """Room on both sides of zero, and what they mean."""
    ends = [
        end
        for difference in comparison.differences
        for end in (difference.share_best, difference.share_worst, difference.share_low, difference.share_high)
    ]
    known = 100.0 * np.array([end for end in ends if np.isfinite(end)] or [0.0])
    left, right = max(-known.min(), 0.0), max(known.max(), 0.0)
    least = 0.5 * max(left, right, 5.0)
    axes.set_xlim(-1.1 * max(left, least), 1.1 * max(right, least))
    for text, side in (("← stronger  ", "right"), ("  weaker →", "left")):
        axes.annotate(text, (0.0, 1.02), xycoords=("data", "axes fraction"), ha=side, fontsize=9)


def _draw_difference(axes: Axes, difference: Difference, place: float) -> None:
    """The interval over records, and in it what the runs themselves leave open."""
    color = {WEAKER: RED, STRONGER: BLACK}.get(difference.conclusion, GREY)
    ends = 100.0 * np.array([difference.share_best, difference.share_worst])
    low, high = 100.0 * difference.share_low, 100.0 * difference.share_high
    if difference.records >= FEWEST:
        axes.errorbar(
            [0.5 * (low + high)], [place], xerr=[[0.5 * (high - low)]] * 2, color=color, linestyle="none", capsize=2.5
        )
    if difference.undecided:
        axes.plot(ends, [place, place], color=color, linewidth=4.0, alpha=0.5, solid_capstyle="butt")
    else:
        hollow = "white" if difference.conclusion == INCONCLUSIVE else None
        axes.plot(ends[:1], [place], color=color, marker="o", markersize=4.5, linestyle="none", markerfacecolor=hollow)


def _draw_curves(axes: Axes, known: list[Fragility], state: str) -> None:
    values = np.concatenate([fit.evidence.im for fit in known])
    for k, fit in enumerate(known):
        x = np.geomspace(*fit.levels, 300)
        if k == 0:
            axes.fill_between(x, *fit.interval(x), color=GREY, alpha=0.18, linewidth=0.0)
        marker, look = _MARKERS[k // len(CYCLE) % len(_MARKERS)], CYCLE[k % len(CYCLE)]
        summary = fit.summary()
        name = median_name(summary).replace(" (", "\n(")
        label = f"{fit.evidence.name}: {median_words(summary)}, {name}"
        common = {**look, "marker": marker, "markevery": 40, "markersize": 3.5}
        if fit.evidence.count(OPEN) + fit.evidence.count(FAILED) == 0:
            axes.plot(x, fit.probability(x), **common, linewidth=1.5, label=label)
            continue
        ends = [curve(x, *extreme) for extreme in fit.extremes]
        axes.fill_between(x, ends[0], ends[1], color=look["color"], alpha=0.1, linewidth=0.0)
        for end, name in zip(ends, (label, None)):
            axes.plot(x, end, **common, linewidth=0.9, label=name)
    axes.set(ylim=(-0.03, 1.03), xlim=(values.min() / 1.1, values.max() * 1.1), ylabel=f"probability of {state}")
    logarithmic(axes)
    measure = known[0].evidence.measure
    axes.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    axes.grid(True)


# -- Utilisation of links ---------------------------------------------------------------------------------------------


#: Most letters of a line beneath the picture.
WIDE = 100

#: Most rows in a picture, as many of every state.
MOST = 24


@styled
def draw_design_values(values: pandas.DataFrame, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Links at the level that is told, those used most: a dot, its 95 % interval, and capacity at 1.

    The capacity is that of the link, or of the stone around it where that is less, as its name says. Under it a force has
    the instant of the run that governs, and a shear force its azimuth, from x towards y. An arrow: the upper limit is
    beyond all that was computed; without a dot, so is the value itself.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`stylobate.design_values`.
    """
    worst = worst_of(values)
    shown = worst.groupby("state", sort=False).head(max(MOST // max(len(set(worst["state"])), 1), 1))
    labels = [f"{plain(row['link'])}, {row['quantity']}{_stone(row)}{_acts(row)}" for row in shown.to_dict("records")]
    figure = page(figure, (WIDTH, 1.7 + 0.27 * sum(1 + label.count("\n") for label in labels)))
    axes = figure.subplots()
    value, low, high = (shown[f"use_{which}_84"].to_numpy(dtype=float) for which in ("value", "low", "high"))
    ends = np.concatenate((value, low, high, [1.0]))
    far = 1.15 * float(ends[np.isfinite(ends)].max())
    states = list(dict.fromkeys(shown["state"]))
    looks = {state: CYCLE[k % len(CYCLE)]["color"] for k, state in enumerate(states)}
    for k, state in enumerate(shown["state"]):
        place, color = len(shown) - 1 - k, looks[state]
        axes.plot(np.minimum([low[k], high[k]], far), [place, place], color=color, linewidth=1.4)
        if not np.isfinite(high[k]):
            axes.plot([far], [place], color=color, marker=">", markersize=5.0, clip_on=False)
        if np.isfinite(value[k]):
            axes.plot(value[k : k + 1], [place], color=color, marker="o", markersize=5.0)
    axes.axvline(1.0, color=GREY, linewidth=1.6, zorder=0)
    axes.set_yticks(np.arange(len(shown))[::-1], labels)
    axes.set(xlim=(0.0, far), ylim=(-0.6, len(shown) - 0.4))
    meant = f"over capacity [-]: not exceeded under 84 % of the motions, and its 95 % interval {basis_of(values)}"
    at = {}
    if where(values) and "told" in values:
        at = {
            state: f", level {level:g}" for state, level in shown.groupby("state", sort=False)["level"].first().items()
        }
    if len(shown) < len(worst):
        axes.set_title(f"{len(shown)} of {len(worst)} rows, all in design.csv", loc="left", fontsize=8)
    figure.supxlabel(textwrap.fill(meant, WIDE), fontsize=9)  # longer than the axes are wide
    for state in states:
        axes.plot([], [], color=looks[state], marker="o", label=plain(state) + at.get(state, ""))
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=min(len(states), 3), fontsize=8, frameon=False)
    axes.grid(True, axis="x")
    return figure


def _stone(row: dict[str, Any]) -> str:
    """That the capacity is what the stone around the link bears."""
    return " over that of the stone" if row.get("limited_by") == "stone" else ""


def _acts(row: dict[str, Any]) -> str:
    """When and where to a force acts in the run that governs; empty where it is not told."""
    instant, azimuth = (row.get(key, math.nan) for key in ("instant_84_s", "azimuth_84_deg"))
    if not math.isfinite(instant):
        return ""
    return f"\n{f'towards {azimuth:.0f}° ' if math.isfinite(azimuth) else ''}at {instant:.2f} s"


# -- Risk -------------------------------------------------------------------------------------------------------------


@styled
def draw_risk(result: Risk, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Hazard curve and fragility, and below them how much of the rate comes from which intensity."""
    figure = page(figure, (NARROW[0], 4.6))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.2, 1.0))
    hazard, f = result.hazard, result.fragility
    (line,) = upper.plot(hazard.im, hazard.rate, color=BLACK, linewidth=1.4, label="hazard")
    upper.set_yscale("log")
    upper.set_ylabel("annual rate of\nexceedance [1/y]")
    right = upper.twinx()
    x = np.geomspace(hazard.im[0], hazard.im[-1], 300)
    (own,) = right.plot(x, f.probability(x), color=RED, linestyle=(0, (5, 2)), linewidth=1.4, label=f.evidence.state)
    right.set_ylim(0.0, 1.03)
    right.spines["right"].set_visible(True)
    right.set_ylabel(f"probability of {f.evidence.state}")
    upper.legend(handles=[line, own], loc="center left")
    share = result.parts[:-1] / max(result.rate, 1e-300)
    lower.stairs(100.0 * share, result.edges[:-1], fill=True, color=BLUE, alpha=0.6)
    lower.stairs(100.0 * share, result.edges[:-1], color=BLUE, linewidth=0.8)
    rest = result.parts[-1] / max(result.rate, 1e-300)
    if rest >= 0.005:
        lower.set_title(f"{percent(rest)} beyond", loc="right", fontsize=8)
    lower.set_ylabel("share of the rate [%]")
    lower.set_xlim(hazard.im[0], hazard.im[-1])
    lower.grid(True, axis="y")
    logarithmic(lower)
    measure = f.evidence.measure
    lower.set_xlabel("intensity" if measure == "im" else parse_measure(measure).words)
    period = "never" if result.rate == 0.0 else f"once in {years(1.0 / result.rate)}"
    upper.set_title(title or f"{f.evidence.state}: {period}", fontsize=9)
    return figure
