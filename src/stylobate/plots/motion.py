"""Ground motions: their histories and spectra, and records chosen for a target spectrum."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure, SubFigure

from ..codes.records import RecordSelection
from ..constants import g
from ..messages import say
from ..motion import Motion, integrate
from ..motion.motion import peak_velocity
from ..motion.spectra import ResponseSpectrum, response_spectrum
from .style import BLACK, BLUE, CYCLE, WIDTH, page, styled, zero_line

#: Components in words.
NAMES = {"x": say("horizontal x"), "y": say("horizontal y"), "z": say("vertical z")}


@styled
def draw_motion(motion: Motion, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Acceleration and velocity of each component, with their peaks."""
    components = motion.components
    figure = page(figure, (WIDTH, 0.8 + 1.9 * len(components)))
    rows = figure.subplots(2 * len(components), 1, sharex=True, height_ratios=(1.4, 1.0) * len(components))
    for i, (axis, acceleration) in enumerate(components.items()):
        velocity = integrate(acceleration, motion.dt)
        for axes, values, largest, color, unit in (
            (rows[2 * i], acceleration / g, abs(acceleration).max() / g, BLACK, "g"),
            (rows[2 * i + 1], velocity, peak_velocity(acceleration, motion.dt), BLUE, "m/s"),
        ):
            zero_line(axes)
            axes.plot(motion.time, values, color=color, linewidth=0.7)
            peak = int(abs(values).argmax())
            axes.plot(motion.time[peak], values[peak], "o", color=color, markersize=3.5, fillstyle="none")
            caption = say("peak {value:.3g} {unit} at {time:.2f} s", value=largest, unit=unit, time=motion.time[peak])
            axes.set_title(caption, loc="right", fontsize=8.0, pad=2.0)
            axes.margins(y=0.12)
        rows[2 * i].set_ylabel(say("{axis}\nacceleration [g]", axis=NAMES[axis]))
        rows[2 * i + 1].set_ylabel(say("velocity\n[m/s]"))
    rows[-1].set_xlabel(say("time [s]"))
    rows[-1].set_xlim(0.0, motion.duration)
    figure.suptitle(title or motion.name, x=0.01, ha="left", fontsize=10.0)
    figure.align_ylabels()
    return figure


# -- Response spectra of a ground motion ------------------------------------------------------------------------------


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
    spectra : dict of str to ResponseSpectrum, optional
        By component; computed here by default.
    """
    by_axis = spectra or {
        axis: response_spectrum(motion, damping=damping, component=axis) for axis in motion.components
    }
    figure = page(figure, (WIDTH, 4.6))
    upper, lower = figure.subplots(2, 1, sharex=True)
    for (axis, spectrum), line in zip(by_axis.items(), CYCLE):
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
    level = next(iter(by_axis.values())).damping
    upper.set_title(title or f"{motion.name}, {100.0 * level:g} % damping")
    figure.align_ylabels()
    return figure


# -- Chosen records against a target spectrum -------------------------------------------------------------------------


#: Ticks of the axes: periods [s], and ratios [-].
PERIODS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0)
RATIOS = (0.25, 0.5, 0.7, 0.9, 1.3, 2.0, 4.0)


@styled
def draw_record_selection(
    selection: RecordSelection, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Spectra of the records, their mean and the target, and the mean over the target with its bounds."""
    figure = page(figure, (WIDTH, 5.4))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    t, target = selection.periods, selection.wanted / g
    for k, row in enumerate(selection.spectra):
        upper.plot(t, row / g, color="0.65", linewidth=0.7, label="records" if k == 0 else None)
    upper.plot(t, selection.mean / g, color="C0", linewidth=1.8, label="their mean")
    upper.plot(t, target, color="k", linewidth=1.8, linestyle="--", label="target")
    upper.set_ylabel("pseudo-acceleration [g]")
    upper.set_ylim(bottom=0.0)
    upper.legend(loc="upper right")
    for row in selection.spectra:
        lower.plot(t, row / selection.wanted, color="0.65", linewidth=0.7)
    lower.plot(t, selection.ratio, color="C0", linewidth=1.8)
    lower.axhline(selection.least, color="k", linewidth=0.9, linestyle=":")
    if np.isfinite(selection.most):
        lower.axhline(selection.most, color="k", linewidth=0.9, linestyle=":")
    lower.set_yscale("log")
    low, high = lower.get_ylim()
    lower.set_yticks([tick for tick in RATIOS if low <= tick <= high], minor=False)
    lower.yaxis.set_major_formatter("{x:g}")
    lower.set_ylabel("over the target [-]")
    lower.set_xlabel("period [s]")
    for axes in (upper, lower):
        axes.set_xscale("log")
        axes.set_xticks([tick for tick in PERIODS if t[0] <= tick <= t[-1]], minor=False)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.minorticks_off()
        axes.margins(x=0.0)
    assumed = selection.target.assumed
    aim = f"{selection.target.name} ({assumed})" if assumed else selection.target.name
    upper.set_title(title or f"{len(selection.motions)} records for {aim}")
    figure.align_ylabels()
    return figure
