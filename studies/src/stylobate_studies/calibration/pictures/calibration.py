"""What joints lose: a measured free motion, motions with the losses found for it, and how both die away."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import LogLocator

from stylobate.plots.style import BLACK, RED, WIDTH, in_lines, page, styled, zero_line

from ..calibration import Calibration


@styled
def draw_calibration(
    calibration: Calibration, title: str | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """The measured motion, that with the likeliest losses, and below how far both still swing.

    The band holds motions with losses drawn as they are known. Phases part where decay does not: what is
    fitted is the picture below.

    Parameters
    ----------
    calibration : Calibration
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
    figure = page(figure, (WIDTH, 4.8))
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.3, 1.0))
    begin, wobbles = calibration.beginning, calibration.restitution is None
    first, *others = calibration.motions()

    def shown(lean: np.ndarray) -> np.ndarray:
        return np.degrees(np.hypot(*lean.T) if wobbles else lean[:, 0])

    measured = calibration.measured
    above.plot(measured.time, shown(measured.lean), color=BLACK, linewidth=0.9, label="measured")
    dashes = {"color": RED, "linewidth": 0.9, "linestyle": "--"}
    above.plot(begin.time + first.time, shown(first.lean), label="likeliest losses", **dashes)
    zero_line(above)
    above.set_ylabel("lean [°]" if wobbles else "tilt [°]")
    above.legend(loc="upper right", ncols=2)
    times = calibration.edges
    every = np.stack(
        [_largest_after(motion.time + begin.time, shown(motion.lean), times) for motion in (first, *others)]
    )
    below.fill_between(times, every[1:].min(axis=0), every[1:].max(axis=0), color=RED, alpha=0.18, linewidth=0.0)
    below.plot(times, every[0], **dashes)
    below.plot(times, np.degrees(calibration.amplitudes), "o", color=BLACK, markersize=3.5)
    below.set_yscale("log")
    below.yaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    for axis in (below.yaxis.set_major_formatter, below.yaxis.set_minor_formatter):
        axis("{x:g}")
    below.tick_params(axis="y", which="minor", labelsize=7.0)
    below.set_ylabel("largest lean of a swing [°]")
    below.set_xlabel("time [s]")
    below.set_xlim(0.0, float(measured.time[-1]))
    heading = f"{calibration.column.name}, let go: {calibration.history.name}"
    figure.suptitle(in_lines(title or heading), x=0.01, ha="left", fontsize=10.0)
    return figure


def _largest_after(time: np.ndarray, lean: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Largest lean in a swing about each time, where the time between them is that of a swing."""
    half = 0.5 * np.gradient(times)
    leans = []
    for at, wide in zip(times, half, strict=True):
        inside = (time >= at - wide) & (time <= at + wide)
        leans.append(np.abs(lean[inside]).max() if inside.any() else np.nan)
    return np.maximum(np.array(leans), 1e-3)
