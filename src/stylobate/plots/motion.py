"""A ground motion: acceleration and velocity of each component over time."""

from __future__ import annotations

from matplotlib.figure import Figure, SubFigure

from ..constants import g
from ..messages import say
from ..motion import Motion, integrate
from ..motion.motion import peak_velocity
from .style import BLACK, BLUE, WIDTH, page, styled, zero_line

#: Components in words.
NAMES = {"x": say("horizontal x"), "y": say("horizontal y"), "z": say("vertical z")}


@styled
def draw_motion(motion: Motion, title: str | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Acceleration and velocity of each component, with their peaks.

    Parameters
    ----------
    motion : Motion
    title : str, optional
    figure : Figure or SubFigure, optional
        To draw in; a new one by default.
    """
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
            said = say("peak {value:.3g} {unit} at {time:.2f} s", value=largest, unit=unit, time=motion.time[peak])
            axes.set_title(said, loc="right", fontsize=8.0, pad=2.0)
            axes.margins(y=0.12)
        rows[2 * i].set_ylabel(say("{axis}\nacceleration [g]", axis=NAMES[axis]))
        rows[2 * i + 1].set_ylabel(say("velocity\n[m/s]"))
    rows[-1].set_xlabel(say("time [s]"))
    rows[-1].set_xlim(0.0, motion.duration)
    figure.suptitle(title or motion.name, x=0.01, ha="left", fontsize=10.0)
    figure.align_ylabels()
    return figure
