"""Response spectra of a ground motion: pseudo-acceleration and displacement of each component over the period."""

from __future__ import annotations

from matplotlib.figure import Figure, SubFigure

from ..constants import g
from ..messages import say
from ..motion import Motion
from ..motion.spectra import ResponseSpectrum, response_spectrum
from .motion import NAMES
from .style import CYCLE, WIDTH, page, styled


@styled
def draw_spectra(
    motion: Motion,
    damping: float = 0.05,
    title: str | None = None,
    *,
    spectra: dict[str, ResponseSpectrum] | None = None,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Pseudo-acceleration and relative displacement over period.

    Parameters
    ----------
    motion : Motion
    damping : float
        Share of the critical damping [-].
    title : str, optional
    spectra : dict of str to ResponseSpectrum, optional
        By component; computed here by default.
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    found = spectra or {axis: response_spectrum(motion, damping=damping, component=axis) for axis in motion.components}
    figure = page(figure, (WIDTH, 4.6))
    upper, lower = figure.subplots(2, 1, sharex=True)
    for (axis, spectrum), line in zip(found.items(), CYCLE):
        upper.plot(spectrum.period, spectrum.psa / g, label=NAMES[axis], **line)
        lower.plot(spectrum.period, spectrum.sd, **line)
    for axes in (upper, lower):
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.grid(which="both")
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.0)
    upper.set_ylabel(say("pseudo-acceleration [g]"))
    lower.set_ylabel(say("relative displacement [m]"))
    lower.set_xlabel(say("period [s]"))
    upper.legend(loc="upper right")
    level = next(iter(found.values())).damping
    upper.set_title(title or f"{motion.name}, {100.0 * level:g} % damping")
    figure.align_ylabels()
    return figure
