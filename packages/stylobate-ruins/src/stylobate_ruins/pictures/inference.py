"""Pictures of inference: posteriors, what each observation tells, survival of what stands, hazards weighed by monuments."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Circle

from stylobate.messages import percents, say
from stylobate.motion.intensity import parse_measure
from stylobate.plots.fragility import NARROW
from stylobate.plots.style import BLACK, BLUE, GREY, RED, SAND, WIDTH, in_lines, page, panel, styled
from stylobate.probability.risk import years

from .. import abc
from ..answers import LABELS, UNITS
from ..infer import Inference
from ..ruin import joints_of
from ..simulations import FELL
from ..survival import Survival
from ..weighing import FRACTILES, WAYS, Weighing

if TYPE_CHECKING:
    from stylobate.column.structure import Structure

    from ..simulations import FinalState

#: Bars of a marginal.
BARS = 24

#: Draws beside the ruin, and by how much offsets are drawn too long.
MATCHES, TIMES = 10, 5.0


@styled
def draw_posterior(
    inference: Inference, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """PGV, PGA, period and azimuth after what is seen, the prior grey behind; the line is the median, the band 90 %."""
    figure = page(figure, (WIDTH, 4.4))
    answers, taken = inference.answers, inference.taken
    for number, (axes, name) in enumerate(zip(figure.subplots(2, 2).flat, UNITS, strict=True)):
        posterior, prior = inference.posterior[name], answers.table.parameters[name]
        if name == "azimuth_deg":
            turn, middle = answers.table.prior.turn, 0.5 * (posterior.low + posterior.high)
            before, after = (middle + abc.apart(angles, middle, turn) for angles in (prior, answers.azimuths(taken)))
            bins = np.linspace(middle - 0.5 * turn, middle + 0.5 * turn, BARS + 1)
        else:
            before, after = prior, answers.scores[name].value(taken.targets[:, number])
            bins = np.geomspace(before.min(), max(before.max(), 1.001 * before.min()), BARS + 1)
            axes.set_xscale("log")
            _plain_ticks(axes, bins[0], bins[-1])
        heights = np.ones(len(before)) / len(before)
        axes.hist(before, bins, weights=heights, color="#dddddd", label="prior")
        axes.hist(after, bins, weights=taken.weights, color=BLUE, histtype="step", linewidth=1.4, label="posterior")
        axes.axvspan(posterior.low, posterior.high, color=BLUE, alpha=0.08, linewidth=0.0)
        axes.axvline(posterior.median, color=BLUE, linewidth=0.9)
        axes.set_xlim(bins[0], bins[-1])
        axes.set_yticks([])
        axes.spines["left"].set_visible(False)
        axes.set_xlabel(f"{LABELS[name]} [{UNITS[name]}]" + (", from x towards y" if name == "azimuth_deg" else ""))
        axes.set_title("" if posterior.informative else "the shapes do not tell", fontsize=8.5, color=GREY)
        if number == 0:
            axes.legend(loc="best", fontsize=7.5)
    figure.suptitle(in_lines(title or _title(inference)), x=0.02, ha="left", fontsize=10.0)
    return figure


@styled
def draw_observations(
    inference: Inference, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """What is left of the prior's spread of ln PGV with each observation alone, and without it; odd ones in red."""
    rows, odd = inference.information, [check.odd for check in inference.checks]
    figure = page(figure, (WIDTH, 1.3 + 0.24 * len(rows)))
    axes = figure.subplots()
    at = np.arange(len(rows))
    axes.barh(
        at,
        [row["spread_alone"] for row in rows],
        0.62,
        color=SAND,
        edgecolor=GREY,
        linewidth=0.5,
        label="with it alone",
    )
    axes.plot([row["spread_without"] for row in rows], at, "o", color=BLUE, markersize=4.5, label="without it")
    whole = inference.posterior["pgv_m_s"].spread
    axes.axvline(whole, color=BLACK, linewidth=0.9, label="with all")
    axes.set_yticks(at, [row["observation"] for row in rows])
    for tick, strange in zip(axes.get_yticklabels(), odd, strict=True):
        tick.set_color(RED if strange else BLACK)
    axes.invert_yaxis()
    most = np.nanmax([1.0, *(row[key] for row in rows for key in ("spread_alone", "spread_without"))])
    axes.set_xlim(0.0, 1.05 * float(most))
    axes.set_xlabel("spread of ln PGV over the prior's [-]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=7.5)
    axes.set_title(in_lines(title or "Which observation tells what" + "; red: odd beside all others" * any(odd)))
    return figure


@styled
def draw_matches(inference: Inference, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """The ruin in plan beside the draws that are nearest to it, and the nearest of those that differ in a state.

    Offsets of drums are drawn five times as long as they are; an arrow is a fall.
    """
    answers, ruin = inference.answers, inference.ruin
    table, taken = answers.table, inference.taken
    order = taken.which[np.argsort(taken.distance, kind="stable")][:MATCHES]
    other = _best_that_differs(inference)
    panels: list[tuple[str, int | None]] = [("as it is seen", None)]
    panels += [(_of_draw(inference, int(k)), int(k)) for k in order]
    panels += [(say("differs: {of_draw}", of_draw=_of_draw(inference, other)), other)] if other is not None else []
    widths = [_width(structure) for structure in ruin.simulated]
    reach = 1.5 * max(widths, default=1.0)
    rows = -(-len(panels) // 3)
    figure = page(figure, (WIDTH, 0.7 + rows * 1.1))
    grid = figure.subplots(rows, 3, squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for axes, (caption, k) in zip(grid.flat, panels):
        for i, structure in enumerate(ruin.simulated):
            state = None if k is None else table.final_states[i]
            _column(axes, inference, i, (i * reach * 1.5, 0.0), widths[i], state, k)
            axes.text(i * reach * 1.5, -0.78 * reach, structure.name, ha="center", va="top", fontsize=6.5, color=GREY)
        axes.set_xlim(-0.8 * reach, (1.5 * len(widths) - 0.7) * reach)
        axes.set_ylim(-1.0 * reach, 0.75 * reach)
        axes.set_aspect("equal")
        differs = k is not None and k == other
        axes.set_title(
            caption, fontsize=7.5, color=RED if differs else BLACK, fontweight="bold" if k is None else "normal"
        )
    usual = "In plan, x to the right and y upward; offsets times five, an arrow where it fell, what is not seen dashed"
    figure.suptitle(in_lines(title or usual), x=0.02, ha="left", fontsize=9.0)
    return figure


def _column(
    axes: Axes,
    inference: Inference,
    i: int,
    at: tuple[float, float],
    width: float,
    state: FinalState | None,
    k: int | None,
) -> None:
    """One structure in plan: as it is seen, or as a draw leaves it."""
    facts = [fact for fact in inference.answers.facts if fact.structure == i]
    if state is None or k is None:
        fell = any(fact.kind == "state" and fact.value[0] for fact in facts)
        towards = next((fact.value[0] for fact in facts if fact.kind == "fell towards"), None)
        known = {fact.joint: fact.value for fact in facts if fact.kind == "offset"}
        joints = joints_of(inference.ruin.simulated[i])
        slips = np.array([known.get(joint, (np.nan, np.nan)) for joint in range(joints)])
    else:
        fell, towards, slips = state.verdict[k] == FELL, float(state.towards[k]), state.slip[k]
    x, y = at
    if fell:
        axes.add_patch(Circle(at, 0.5 * width, facecolor="none", edgecolor=RED, linewidth=0.8, linestyle=(0, (3, 2))))
        if towards is not None and np.isfinite(towards):
            east, north = np.cos(np.radians(towards)) * width, np.sin(np.radians(towards)) * width
            arrow = {"arrowstyle": "-|>", "color": RED, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
            axes.annotate("", (x + 0.9 * east, y + 0.9 * north), at, arrowprops=arrow)
        else:
            axes.text(x, y, "fell", ha="center", va="center", color=RED, fontsize=6.5)
        return
    axes.add_patch(Circle(at, 0.5 * width, facecolor=SAND, edgecolor=GREY, linewidth=0.5))
    for slip in slips:
        seen = bool(np.isfinite(slip).all())
        if seen:
            x, y = x + TIMES * float(slip[0]), y + TIMES * float(slip[1])
        style = "-" if seen else (0, (1, 2))
        axes.add_patch(Circle((x, y), 0.46 * width, facecolor="none", edgecolor=BLACK, linewidth=0.6, linestyle=style))


def _best_that_differs(inference: Inference) -> int | None:
    """The draw that leaves most events as they are seen, yet not all; among several the one nearest in PGV to the median."""
    events = list(inference.answers.matched.values())
    if not events:
        return None
    agree = np.sum(events, axis=0)
    candidates = np.flatnonzero(agree == max((int(count) for count in agree if count < len(events)), default=-1))
    if not len(candidates):
        return None
    pgv = np.log(inference.answers.table.parameters["pgv_m_s"][candidates])
    return int(candidates[np.argmin(np.abs(pgv - np.log(inference.posterior["pgv_m_s"].median)))])


def _of_draw(inference: Inference, k: int) -> str:
    p = inference.answers.table.parameters
    return f"{p['pgv_m_s'][k]:.2g} m/s, {p['period_s'][k]:.2g} s, {p['azimuth_deg'][k]:.0f}°"


def _width(structure: Structure) -> float:
    """Side of a structure in plan [m]."""
    column = structure.stack
    return float(max(column.joint_widths)) if column is not None else 1.0


def _title(inference: Inference) -> str:
    pgv = inference.posterior["pgv_m_s"]
    if not pgv.informative:
        return "What shaking was it? These shapes do not tell the PGV"
    estimate = f"PGV {pgv.median:.2g} m/s ({pgv.low:.2g} to {pgv.high:.2g}, 90 %)"
    if inference.odd:
        return f"Not as shaking alone leaves it; if it did all of it: {estimate}"
    return f"What shaking was it? {estimate}"


def _plain_ticks(axes: Axes, low: float, high: float) -> None:
    """Ticks of a logarithmic axis as plain numbers."""
    ticks = [m * 10.0**e for e in range(-5, 4) for m in (1.0, 2.0, 5.0)]
    visible = [tick for tick in ticks if low <= tick <= high]
    axes.set_xticks(visible, [f"{tick:g}" for tick in visible])
    axes.set_xticks([], minor=True)


# Survival: what the age of a column that still stands says about hazard curves.


@styled
def draw_survival(result: Survival, title: str | None = None, *, ax: Axes | None = None) -> Figure:
    """Probability that the column would still stand, by hazard curve, with the interval of its fragility."""
    figure, axes = panel(ax, (NARROW[0], 1.2 + 0.62 * len(result.risks)))
    low, high = result.interval
    at = np.arange(len(result.risks))
    axes.barh(at, result.probability, height=0.36, color=BLUE, alpha=0.6)
    axes.hlines(at, low, high, color=BLACK, linewidth=1.4)
    weight = result.likelihood / result.likelihood.sum()
    for k, risk in enumerate(result.risks):
        text = f"{risk.hazard.name}: {result.probability[k]:.2g}, weight {weight[k]:.2f}"
        axes.annotate(text, (0.0, k), xytext=(2, 15), textcoords="offset points", va="center", fontsize=8)
    axes.set_yticks([])
    axes.spines["left"].set_color(GREY)
    axes.set(xlim=(0.0, 1.02), ylim=(len(at) - 0.6, -0.8))
    axes.set_xlabel("probability that it would still stand [-]")
    axes.grid(True, axis="x")
    axes.set_title(
        title
        or say("{years} without {result.risks[0].fragility.evidence.state}", years=years(result.age), result=result),
        fontsize=9,
    )
    return figure


# Hazard weighed by monuments: branches and hazard curves before and after, and which monument tells what.

#: Most branches and sites that are drawn.
BRANCHES, SITES = 12, 6


@styled
def draw_weighing(result: Weighing, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Weights of branches, bits of monuments, and hazard curves of sites; grey before, blue after what is seen.

    The mark across a weight reaches from events that each site has for its own to events that shake all.
    """
    sites = list(result.im)[:SITES]
    order = np.argsort(-np.maximum(result.prior, result.weight), kind="stable")[:BRANCHES]
    rows, across = math.ceil(len(sites) / 2), min(len(sites), 2)
    top = 0.9 + 0.3 * max(len(order), len(result.information))
    figure = page(figure, (WIDTH, 0.7 + top + 2.3 * rows))
    upper, lower = np.ravel(np.asarray(figure.subfigures(2, 1, height_ratios=(top, 2.3 * rows))))
    left, right = upper.subplots(1, 2)
    at = np.arange(len(order))
    left.barh(at - 0.19, result.prior[order], 0.36, color="#dddddd", label="before")
    left.barh(at + 0.19, result.weight[order], 0.36, color=BLUE, alpha=0.75, label="after")
    ends = np.array([result.posterior(result.likelihood[way])[order] for way in WAYS])
    left.hlines(at + 0.19, ends.min(axis=0), ends.max(axis=0), color=BLACK, linewidth=1.2)
    left.set_yticks(at, [result.sites.branches[k].name for k in order])
    left.invert_yaxis()
    left.set_xlabel("weight of the branch [-]")
    left.legend(fontsize=7.5)
    if len(order) < len(result.weight):
        left.set_title(
            say("the first {order} of {weight} branches", order=len(order), weight=len(result.weight)),
            fontsize=8.0,
            color=GREY,
        )
    monuments = result.information
    at = np.arange(len(monuments))
    right.barh(at, [row["bits_alone"] for row in monuments], 0.5, color="#dddddd", label="by itself")
    right.plot(
        [row["bits_beside_others"] for row in monuments], at, "o", color=BLUE, markersize=4.5, label="beside the others"
    )
    right.set_yticks(at, [row["monument"] for row in monuments])
    right.invert_yaxis()
    right.set_xlim(0.0, None)
    right.set_xlabel("tells of the branches [bits]")
    right.legend(fontsize=7.5)
    measure = parse_measure(result.sites.monuments[0].capacity.measure).words
    for number, (axes, site) in enumerate(zip(lower.subplots(rows, across, squeeze=False).flat, sites)):
        im = result.im[site]
        for weight, color, called in ((result.prior, GREY, "before"), (result.weight, BLUE, "after")):
            low, _, high = result.fractiles(site, weight)
            label = f"{called}, {percents(FRACTILES[0], FRACTILES[-1])} of branches"
            axes.fill_between(im, low, high, color=color, alpha=0.18, linewidth=0.0, label=label)
            axes.plot(im, result.mean(site, weight), color=color, linewidth=1.5)
        axes.set(xscale="log", yscale="log", xlabel=measure, title=site)
        if number % across == 0:
            axes.set_ylabel("annual rate of exceedance [1/y]")
        if number == 0:
            axes.legend(fontsize=7.0, loc="lower left")
        axes.grid(True)
    figure.suptitle(
        in_lines(title or result.sentence.partition(";")[0].partition(". E")[0]), x=0.02, ha="left", fontsize=10.0
    )
    return figure
