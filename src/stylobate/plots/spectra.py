"""Response spectra of a ground motion: pseudo-acceleration of each component over the period."""

from __future__ import annotations

from matplotlib.figure import Figure

from ..constants import g
from ..motion import Motion
from ..motion.spectra import response_spectrum
from .motion import NAMES
from .style import CYCLE, WIDTH, styled


@styled
def draw_spectra(motion: Motion, damping: float = 0.05, title: str | None = None) -> Figure:
    """Pseudo-acceleration over period.

    Parameters
    ----------
    motion : Motion
    damping : float
        Share of the critical damping [-].
    title : str, optional
    """
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    for axis, line in zip(motion.components, CYCLE):
        spectrum = response_spectrum(motion, damping=damping, component=axis)
        axes.plot(spectrum.period, spectrum.psa / g, label=NAMES[axis], **line)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(which="both")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    axes.set_xlabel("period [s]")
    axes.set_ylabel("pseudo-acceleration [g]")
    axes.legend(loc="upper right")
    axes.set_title(title or f"{motion.name}, {100.0 * damping:g} % damping")
    return figure
