"""Figures of the validation page, drawn from what the cases compute."""

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure

from stylobate.plots.style import BLACK, BLUE, CYCLE, GREY, RED, SAND, WIDTH, styled, zero_line

from . import agreement, conservation, convergence, paper, rocking, sliding, statics
from . import overturning as pulses
from .tapered_figure import thresholds_of_codes

#: Marks of the models in all figures.
MARKS = {
    "housner": {"marker": "o", "color": BLACK, "fillstyle": "none"},
    "rigid-beam": {"marker": "^", "color": BLUE, "fillstyle": "none"},
    "rigid-block": {"marker": "s", "color": "#e08214", "fillstyle": "none"},
    "dem2d": {"marker": "x", "color": RED},
}


@styled
def free_rocking() -> Figure:
    """Quarter period of free rocking over the tilt it starts from."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    shares = np.linspace(0.01, 0.97, 100)
    axes.plot(shares, np.arccosh(1.0 / (1.0 - shares)), color=GREY, label="Housner 1963, linear")
    axes.plot(
        shares,
        [rocking.nonlinear_quarter(s) for s in shares],
        color=GREY,
        linestyle="--",
        label="nonlinear, by quadrature",
    )
    axes.plot(rocking.SHARES, rocking.quarter_period(), linestyle="", label="housner", **MARKS["housner"])
    axes.plot(rocking.SHARES[1:], rocking.quarter_period_dem(), linestyle="", label="dem2d, α = 0.05", **MARKS["dem2d"])
    axes.set(xlabel="tilt at the start, θ₀/α [-]", ylabel="quarter period, p T/4 [-]")
    axes.set_title("Free rocking")
    axes.legend()
    axes.grid(True)
    return figure


@styled
def overturning() -> Figure:
    """Smallest amplitude of a pulse that overturns, closed forms and models."""
    figure = Figure(figsize=(WIDTH, 3.6))
    left, right = figure.subplots(1, 2)
    size = np.geomspace(0.2, 3.5, 100)
    left.plot(size, [pulses.constant(pt) for pt in size], color=GREY, label="Housner 1963")
    left.plot(pulses.PT, pulses.constant_pulse(), linestyle="", label="housner", **MARKS["housner"])
    left.plot((0.5, 1.0, 2.0), pulses.constant_pulse_beam(), linestyle="", label="rigid-beam", **MARKS["rigid-beam"])
    left.plot(pulses.PT, pulses.constant_pulse_dem(), linestyle="", label="dem2d", **MARKS["dem2d"])
    left.set(
        xlabel="length of the pulse, p t [-]", ylabel="smallest A/(g α) that overturns [-]", title="Constant pulse"
    )
    left.legend()
    curves = {
        "half sine": (pulses.half_sine, np.geomspace(0.8, 9.0, 60), "-"),
        "one sine": (pulses.one_sine, np.geomspace(0.8, 9.0, 60), "--"),
        "one cosine": (pulses.one_cosine, np.geomspace(0.4, 2.6, 60), "-."),
    }
    for name, (closed, w, dashes) in curves.items():
        right.plot(w, [closed(frequency) for frequency in w], color=GREY, linestyle=dashes, label=name)
    for w, amplitudes in (
        (pulses.HALF_SINE, pulses.half_sine_pulse()),
        (pulses.HALF_SINE, pulses.one_sine_pulse()),
        (pulses.ONE_COSINE, pulses.one_cosine_pulse()),
    ):
        right.plot(w, amplitudes, linestyle="", **MARKS["housner"])
    for amplitudes in (pulses.half_sine_pulse_dem(), pulses.one_sine_pulse_dem()):
        right.plot(pulses.HALF_SINE, amplitudes, linestyle="", **MARKS["dem2d"])
    right.set(xlabel="frequency of the pulse, ω/p [-]", title="Pulses, without impact")
    right.legend()
    for axes, across, up in ((left, pulses.PT, (1, 2, 3, 4, 5)), (right, (0.5, 1, 2, 4, 8), (1, 2, 5, 10, 15))):
        axes.set(xscale="log", yscale="log")
        axes.minorticks_off()
        axes.set_xticks(across, [f"{x:g}" for x in across])
        axes.set_yticks(up, [f"{y:g}" for y in up])
        axes.grid(True)
    return figure


@styled
def slip() -> Figure:
    """Slip of a block under a rectangular pulse."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    amplitudes = np.linspace(0.2, 1.55, 100)
    axes.plot(amplitudes, [sliding.newmark(a) for a in amplitudes], color=GREY, label="Newmark 1965")
    joints = {"rigid-beam": 1e10, "rigid-block": 1e11, "dem2d": 1e11}
    models = {
        "rigid-beam": sliding.RigidBeam(sliding=True),
        "rigid-block": sliding.RigidBlock(),
        "dem2d": sliding.DistinctElement2D(),
    }
    for name, model in models.items():
        joint = sliding.Joint(joints[name], 0.5 * joints[name], friction_coefficient=sliding.FRICTION)
        axes.plot(sliding.AMPLITUDES, sliding.slips(model, joint), linestyle="", label=name, **MARKS[name])
    axes.set(xlabel="acceleration of the pulse of 0.5 s [g]", ylabel="residual slip [m]")
    axes.set_title(f"Sliding on a friction of {sliding.FRICTION:g}")
    axes.legend()
    axes.grid(True)
    return figure


@styled
def elastic_bed() -> Figure:
    """Moment of a joint over its rotation: elastic bed and contact points."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    column = convergence.bed_column("rectangular")
    opening = convergence.RigidBeam().pack(column).opening[0]
    ultimate = column.joint_weights[0] * column.base_width / 2.0
    ratio = np.linspace(0.02, 8.0, 120)
    exact = [convergence.bed_moment(column, r * opening) / ultimate for r in ratio]
    axes.plot(ratio, exact, color=GREY, linewidth=4.0, alpha=0.5, label="elastic bed, Eq. R2")
    for points, line in zip((2, 3, 8, 32), CYCLE, strict=False):
        moments = [convergence.dem_moment(column, points, r * opening) / ultimate for r in ratio]
        axes.plot(ratio, moments, label=f"dem2d, {points} points", **line)
    axes.set(xlabel="rotation over that which opens the bed, φ/φ_d [-]", ylabel="moment, M/M_u [-]", ylim=(0, 1.05))
    axes.set_title("A joint under constant compression")
    axes.legend(loc="lower right")
    axes.grid(True)
    return figure


@styled
def static_paths() -> Figure:
    """Pushover curves and tan(α − θ)."""
    figure = Figure(figsize=(WIDTH, 3.6))
    axes = figure.subplots()
    for (name, path), line in zip(statics.paths().items(), CYCLE, strict=False):
        axes.plot(-path.rotation[:, 0], path.multiplier, label=name, **line)
    turn = np.linspace(0.0, 0.22, 50)
    for i, alpha in enumerate(sorted({round(column.slenderness, 9) for column in statics.COLUMNS.values()})):
        label = "tan(α − θ)" if i == 0 else None
        axes.plot(turn[turn < alpha], np.tan(alpha - turn[turn < alpha]), "|", color=GREY, markersize=8, label=label)
    for value, place in ((0.205, 0.06), (0.16, 0.012)):
        axes.plot([0.0, place], [value, value], color=RED, linewidth=0.8)
        axes.annotate(f"paper {value:g} g", (place, value), xytext=(3, 0), textcoords="offset points", va="center",
                      color=RED, bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6})  # fmt: skip
    axes.set(xlabel="rotation of the lowest drum [rad]", ylabel="multiplier of the weight [g]")
    axes.set(xlim=(-0.002, 0.225), ylim=(0, 0.235), title="Pushover")
    axes.legend()
    axes.grid(True)
    return figure


@styled
def ledgers() -> Figure:
    """Missing energy over the step."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    series = {
        "dem2d, monolith": (conservation.monolith_dem(), {"marker": "x", "color": RED, "linestyle": "-"}),
        "dem2d, 12 drums": (conservation.drums_dem(), {"marker": "x", "color": RED, "linestyle": "--"}),
        "rigid-block, 12 drums": (conservation.drums_block(), {**MARKS["rigid-block"], "linestyle": "-."}),
    }
    for name, (medians, line) in series.items():
        axes.plot(conservation.FACTORS, medians, label=name, **line)
    axes.plot((0.1, 0.4), (1e-4, 16e-4), color=GREY, linewidth=0.8, label="second order")
    axes.set(xscale="log", yscale="log", xlabel="step over the largest stable one [-]")
    axes.set(ylabel="energy missed over input work [-]", title="Energy ledger, median of 32 amplitudes")
    axes.set_xticks(conservation.FACTORS, [f"{s:g}" for s in conservation.FACTORS])
    axes.minorticks_off()
    axes.legend()
    axes.grid(True)
    return figure


@styled
def orders() -> Figure:
    """Error over the step."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    series = {
        "housner, between impacts": (convergence.housner_errors(False), {**MARKS["housner"], "linestyle": "-"}),
        "housner, through impacts": (convergence.housner_errors(True), {**MARKS["housner"], "linestyle": "--"}),
        "rigid-beam": (convergence.beam_errors(False), {**MARKS["rigid-beam"], "linestyle": "-"}),
        "rigid-beam, sliding": (convergence.beam_errors(True), {**MARKS["rigid-beam"], "linestyle": "--"}),
        "dem2d": (convergence.dem_errors(), {**MARKS["dem2d"], "linestyle": "-"}),
    }
    for name, (errors, line) in series.items():
        axes.plot(convergence.REFINED, errors / errors[0], label=name, **line)
    for order in (2, 4):
        axes.plot(convergence.REFINED, convergence.REFINED**order, color=GREY, linewidth=0.8)
        axes.annotate(f"order {order}", (0.35, 0.35**order), xytext=(4, -10), textcoords="offset points", color=GREY)
    axes.set(
        xscale="log", yscale="log", xlabel="step over the longest one [-]", ylabel="error over the largest one [-]"
    )
    axes.set_xticks(convergence.REFINED, ["1", "1/2", "1/4"])
    axes.minorticks_off()
    axes.set_title("Convergence of the last displacement")
    axes.legend(loc="lower right")
    axes.grid(True)
    return figure


@styled
def three_models() -> Figure:
    """Histories that must coincide until impacts part them."""
    figure = Figure(figsize=(WIDTH, 3.4))
    axes = figure.subplots()
    time, turns, first, second = agreement.rotations()
    zero_line(axes)
    for (name, turn), line in zip(turns.items(), CYCLE, strict=False):
        axes.plot(time, turn, label=name, **line)
    for at, label in ((first, "first impact"), (second, "second impact")):
        if np.isfinite(at):
            axes.axvline(at, color=GREY, linewidth=0.8, linestyle=":")
            axes.annotate(label, (at, 0.03), xycoords=("data", "axes fraction"), xytext=(3, 0),
                          textcoords="offset points", color=GREY)  # fmt: skip
    axes.set(xlabel="time [s]", ylabel="rotation [rad]", title="The monolith under one sine of 0.8 Hz and 0.26 g")
    axes.legend()
    return figure


@styled
def unsafe_cells() -> Figure:
    """Collapsed cells of both columns, by model."""
    figure = Figure(figsize=(WIDTH, 3.2))
    axes = figure.subplots()
    models = {
        "rigid beam,\nas the paper reads": paper.RigidBeam.paper(),
        "rigid beam,\ntrue drums": paper.RigidBeam(),
        "rigid beam,\nsliding": paper.RigidBeam(sliding=True),
        "distinct\nelements": paper.DistinctElement2D(),
    }
    counts = np.array([[int(cells.sum()) for cells in paper.cells(model)] for model in models.values()])
    places = np.arange(len(models))
    for k, (label, fill, shift) in enumerate((("monolith", SAND, -0.2), ("12 drums", "#a6372f", 0.2))):
        bars = axes.bar(
            places + shift, counts[:, k], width=0.38, color=fill, edgecolor=BLACK, linewidth=0.6, label=label
        )
        axes.bar_label(bars, padding=2)
    total = len(paper.FREQUENCIES) * len(paper.AMPLITUDES)
    axes.set_xticks(places, list(models))
    axes.set(ylabel=f"collapsed of {total} cells", ylim=(0, 1.2 * counts.max()))
    axes.set_title("0.66, 1 and 1.5 Hz, 0.15 to 0.60 g")
    axes.legend(ncols=2, loc="upper right")
    return figure


#: Figures of the page by kind of evidence: function and what it shows.
FIGURES: dict[str, dict[Callable[[], Figure], str]] = {
    "closed forms": {
        free_rocking: "Quarter period of free rocking over the tilt from which the block is let go.",
        overturning: "Smallest pulse that overturns a block without impact. Lines: closed forms; marks: models.",
        slip: "Residual slip of a flat block. Line: closed form; marks: models.",
        static_paths: "Equilibrium paths down to zero, with the closed form of the softening branch.",
    },
    "conservation": {ledgers: "Energy that the ledger misses over the step."},
    "convergence": {
        orders: "Error of the last displacement over the step.",
        elastic_bed: "Moment of a joint over its rotation: contact points approach the elastic bed.",
    },
    "agreement": {three_models: "The same column and motion through three models: one motion until impacts part them."},
    "paper": {unsafe_cells: "Drums are more prone than the monolith in the rigid beam, less where they may slide."},
    "other codes": {
        thresholds_of_codes: "Verdicts of dem2d over the length and the amplitude of the pulse, and the smallest "
        "amplitudes that collapse the column in three other codes, as published."
    },
}
