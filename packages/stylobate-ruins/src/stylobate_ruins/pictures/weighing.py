"""Hazard weighed by monuments: branches and hazard curves before and after, and which monument tells what."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure, SubFigure

from stylobate.messages import percents, say
from stylobate.motion.intensity_specs import parse_measure
from stylobate.plots.style import BLACK, BLUE, GREY, WIDTH, in_lines, page, styled

from ..weighing import FRACTILES, WAYS, Weighing

#: Most branches and sites that are drawn.
BRANCHES, SITES = 12, 6


@styled
def draw_weighing(result: Weighing, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Weights of branches, bits of monuments, and hazard curves of sites; grey before, blue after what is seen.

    The mark across a weight reaches from events that each site has for its own to events that shake all.

    Parameters
    ----------
    result : Weighing
    """
    sites = list(result.im)[:SITES]
    order = np.argsort(-np.maximum(result.prior, result.weight), kind="stable")[:BRANCHES]
    rows, across = math.ceil(len(sites) / 2), min(len(sites), 2)
    top = 0.9 + 0.3 * max(len(order), len(result.told))
    figure = page(figure, (WIDTH, 0.7 + top + 2.3 * rows))
    upper, lower = np.ravel(np.asarray(figure.subfigures(2, 1, height_ratios=(top, 2.3 * rows))))
    left, right = upper.subplots(1, 2)
    at = np.arange(len(order))
    left.barh(at - 0.19, result.prior[order], 0.36, color="#dddddd", label="before")
    left.barh(at + 0.19, result.weight[order], 0.36, color=BLUE, alpha=0.75, label="after")
    ends = np.array([result.posterior(result.likelihood[one])[order] for one in WAYS])
    left.hlines(at + 0.19, ends.min(axis=0), ends.max(axis=0), color=BLACK, linewidth=1.2)
    left.set_yticks(at, [result.asked.branches[k].name for k in order])
    left.invert_yaxis()
    left.set_xlabel("weight of the branch [-]")
    left.legend(fontsize=7.5)
    if len(order) < len(result.weight):
        left.set_title(
            say("the first {order} of {weight} branches", order=len(order), weight=len(result.weight)),
            fontsize=8.0,
            color=GREY,
        )
    told = result.told
    at = np.arange(len(told))
    right.barh(at, [one["bits_alone"] for one in told], 0.5, color="#dddddd", label="by itself")
    right.plot(
        [one["bits_beside_others"] for one in told], at, "o", color=BLUE, markersize=4.5, label="beside the others"
    )
    right.set_yticks(at, [one["monument"] for one in told])
    right.invert_yaxis()
    right.set_xlim(0.0, None)
    right.set_xlabel("tells of the branches [bits]")
    right.legend(fontsize=7.5)
    measure = parse_measure(result.asked.monuments[0].capacity.measure).words
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
