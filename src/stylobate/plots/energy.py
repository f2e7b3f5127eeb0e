"""The energy ledger over time: what the ground put in, and where it went."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..messages import say
from ..response import ENERGY_TERMS, Response
from ..response.words import title_of
from .scene import seen
from .style import CYCLE, GREY, WIDTH, in_lines, page, styled, zero_line


@styled
def draw_energy(
    response: Response,
    title: str | None = None,
    *,
    window: tuple[float, float] | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Input work, where it is and where it went, and below what the ledger cannot account for.

    Parameters
    ----------
    response : Response
    title : str, optional
    window : (float, float), optional
        Beginning and end of what is drawn [s]; all by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    time, energy = response.time, response.energy
    figure = page(figure, (WIDTH, 4.2))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    zero_line(upper)
    present = [term for term in ENERGY_TERMS if term == "input" or np.any(energy.get(term, 0.0))]
    unit, factor = _unit(max((float(np.nanmax(np.abs(energy[t]))) for t in present if t in energy), default=0.0))
    for term, line in zip(present, CYCLE * 2):
        width = 1.8 if term == "input" else 1.0
        upper.plot(time, factor * energy[term], label=_NAMES[term], linewidth=width, **line)
    upper.set_ylabel(say("energy [{unit}]", unit=unit))
    upper.legend(loc="upper left", ncols=3)
    bottom, top = upper.get_ylim()
    upper.set_ylim(bottom, top + 0.25 * (top - bottom))
    upper.set_title(in_lines(title or title_of(response)))
    zero_line(lower)
    word, largest = say("input"), float(np.nanmax(np.abs(energy["input"])))
    if response.followed:  # what falls releases more than what shook it put in
        released = float(np.nanmax(-energy["gravitational"]))
        word, largest = (say("released"), released) if released > largest else (word, largest)
    lower.plot(time, response.imbalance / (largest or 1.0), color=GREY)
    lower.set_ylabel(say("imbalance\n/ {what}", what=word))
    lower.set_xlabel(say("time [s]"))
    lower.set_xlim(*seen(time, window))
    lower.set_title(
        say("missing at the end: {r.energy_imbalance:.1e} of the energy at stake", r=response),
        loc="right",
        fontsize=8.0,
    )
    figure.align_ylabels()
    return figure


_NAMES = {
    "input": say("input"),
    "kinetic": say("kinetic"),
    "gravitational": say("gravity"),
    "elastic": say("elastic"),
    "friction": say("friction loss"),
    "viscous": say("viscous loss"),
    "impact": say("impact loss"),
}


def _unit(largest: float) -> tuple[str, float]:
    if largest >= 1e6:
        return "MJ", 1e-6
    return ("kJ", 1e-3) if largest >= 1e3 else ("J", 1.0)
