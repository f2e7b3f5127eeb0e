"""The figures of Baraldi, Sarhosis and Milani: histories of thirty cases, moment–rotation laws, domains of all models."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.column import Column, preset
from stylobate.constants import g
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.plots.style import BLACK, BLUE, CYCLE, GREY, RED, SAND, WIDTH, styled, zero_line
from stylobate.statics.pushover import PushoverResult
from stylobate.verdicts import verdict as v

from ..cases import MONOLITH
from ..statics import joint_law

#: Ground of a panel that shows a collapse.
TINT = "#f3d9d2"


@styled
def draw_history_grid(histories: Any, column: Column, title: str, *, absolute: bool = False) -> Figure:
    """Base and top displacement of all cases, amplitudes rising upward, frequencies to the right.

    Tinted where it collapses, hatched where there is no verdict; dotted, the end of the shaking. In absolute terms, with
    the drift a t/ω of a ground that a sine of acceleration moves from rest.

    Parameters
    ----------
    histories : xarray.Dataset
        Over frequency, amplitude and time, as in ``PaperResults.histories``.
    column : Column
        Its base width is the unit of displacements relative to the ground.
    title : str
    absolute : bool
        Displacements in space [m], each panel with its own scale, instead of those relative to the ground.
    """
    f, a, time = (histories[name].values for name in ("frequency", "amplitude", "time"))
    end = histories.attrs["duration_s"]
    figure = Figure(figsize=(WIDTH, 6.0))
    figure.set_layout_engine("none")  # which would take seconds for thirty panels
    margins = {"left": 0.105, "right": 0.985, "bottom": 0.075, "top": 0.91, "wspace": 0.14, "hspace": 0.12}
    if absolute:
        margins |= {"left": 0.125, "wspace": 0.42}
    grid = figure.subplots(len(a), len(f), sharex=True, sharey=not absolute, gridspec_kw=margins)
    for j, amplitude in enumerate(a[::-1]):
        for i, frequency in enumerate(f):
            axes, case = grid[j, i], histories.sel(frequency=frequency, amplitude=amplitude)
            top, base = (_panel_displacement(case, name, column, absolute) for name in ("top", "base"))
            verdict = v.VERDICTS[int(case["verdict"])]
            zero_line(axes)
            axes.plot(time, top, color=BLACK, linestyle=(0, (3.0, 1.0)), linewidth=0.7)
            axes.plot(time, base, color=RED, linewidth=0.9)
            if absolute:
                drift = amplitude * np.array([0.0, end]) / (2.0 * np.pi * frequency)
                axes.plot([0.0, end], drift, color=BLUE, linewidth=0.7, linestyle=(0, (1.0, 1.0)))
            if end < time[-1]:
                axes.axvline(end, color=GREY, linewidth=0.6, linestyle=(0, (1.0, 1.5)), zorder=0)
            if verdict == v.COLLAPSED:
                _note(axes, f"collapse {float(case['collapse_time']):.1f} s", TINT)
            elif verdict != v.STANDS:
                _note(axes, verdict, "white")
                axes.patch.set(hatch="////", edgecolor="#cccccc")
            axes.set_xlim(0.0, time[-1])
            if absolute:
                axes.locator_params(axis="y", nbins=3)
            else:
                axes.set(ylim=(-1.05, 1.05), yticks=(-1.0, 0.0, 1.0))
            axes.tick_params(labelsize=6.0 if absolute else 7.0)
            if j == 0:
                axes.set_title(f"{frequency:g} Hz", fontsize=8.5)
            if i == 0:
                axes.set_ylabel(f"{amplitude / g:.1f} g", fontsize=8.5)
    figure.suptitle(title, x=0.01, y=0.985, ha="left", size=10.0)
    figure.supxlabel("time [s]", size=9.0, y=0.005)
    what = "displacement in space [m]" if absolute else "displacement relative to the ground / base width [–]"
    figure.supylabel(what, size=9.0, x=0.005)
    lines = [
        Line2D([], [], color=RED, label="base"),
        Line2D([], [], color=BLACK, linestyle=(0, (3.0, 1.0)), label="top"),
    ]
    if absolute:
        lines.append(Line2D([], [], color=BLUE, linestyle=(0, (1.0, 1.0)), label="drift a t/ω of the ground"))
    figure.legend(handles=lines, loc="upper right", ncols=3)
    return figure


def _panel_displacement(case: Any, name: str, column: Column, absolute: bool) -> np.ndarray:
    """A displacement of a case in what its panel is drawn in; where the column falls, no further than that shows."""
    if absolute:
        ground = case["ground"].values
        return ground + np.clip(case[name].values, -column.height, column.height)
    return np.clip(case[name].values / column.base_width, -1.2, 1.2)


def _note(axes: Axes, text: str, color: str) -> None:
    axes.set_facecolor(color)
    axes.text(
        0.96, 0.05, text, ha="right", fontsize=6.5, transform=axes.transAxes, zorder=5,
        bbox={"facecolor": color, "edgecolor": "none", "pad": 0.8},
    )  # fmt: skip


@styled
def draw_moment_laws() -> Figure:
    """The moment–rotation laws of the joint under the monolith, as the paper's Figure 3, and their first branch."""
    column = preset(MONOLITH)
    laws = {
        "Housner, rigid": RigidBeam.paper(moment_law="housner"),
        "bi-linear (ξ = 1)": RigidBeam.paper(),
        "tri-linear, ξ = 0.9": RigidBeam.paper(moment_law="trilinear", xi=0.9),
        "tri-linear, ξ = 0.7": RigidBeam.paper(moment_law="trilinear", xi=0.7),
        "elastic bed without tension": RigidBeam.paper(moment_law="winkler"),
    }
    seen = column.as_prism()
    ultimate = 0.5 * seen.joint_weights[0] * seen.joint_widths[0]
    alpha = float(RigidBeam.paper().critical_angles(seen)[0])
    figure = Figure(figsize=(WIDTH, 3.2))
    whole, near = figure.subplots(1, 2, sharey=True)
    for (label, model), line in zip(laws.items(), CYCLE):
        for axes, rotation in (
            (whole, np.linspace(0.0, 1.1 * alpha, 2000)[1:]),
            (near, np.linspace(0.0, 8e-5, 2000)[1:]),
        ):
            scale = alpha if axes is whole else 1e-6
            axes.plot(rotation / scale, joint_law(model, column, 1, rotation) / ultimate, label=label, **line)
    for axes, label in ((whole, "rotation / critical angle α [–]"), (near, "rotation [µrad]")):
        zero_line(axes)
        axes.set_xlabel(label)
        axes.set_xlim(left=0.0)
        axes.grid(True)
    whole.set_ylabel("moment / M$_u$ [–]")
    figure.suptitle(
        f"Moment–rotation laws, monolith: Mᵤ = {ultimate / 1e3:.1f} kN m, α = {alpha:.3f} rad",
        x=0.01,
        ha="left",
        size=10.0,
    )
    figure.legend(handles=whole.lines[: len(laws)], loc="outside lower center", ncols=3)
    return figure


@styled
def draw_pushover_paths(paths: Sequence[tuple[str, PushoverResult]], title: str) -> Figure:
    """Several pushover curves in one picture, whole and near the peak."""
    figure = Figure(figsize=(WIDTH, 3.2))
    whole, near = figure.subplots(1, 2, sharey=True)
    for (label, path), line in zip(paths, CYCLE):
        whole.plot(path.displacement, path.multiplier, label=f"{label}: {path.collapse_multiplier:.4f} g", **line)
        near.plot(1e3 * path.displacement, path.multiplier, **line)
    near.set_xlim(0.0, 8e3 * max(path.peak_displacement for _, path in paths))
    for axes, label in ((whole, "displacement of the top [m]"), (near, "displacement of the top [mm]")):
        axes.set_xlabel(label)
        axes.set_ylim(bottom=0.0)
        axes.grid(True)
        axes.patch.set_facecolor("white")
    whole.set_xlim(left=0.0)
    whole.set_ylabel("load multiplier [g]")
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    figure.legend(handles=whole.lines, loc="outside lower center", ncols=2)
    return figure


@styled
def draw_sensitivity(first: dict[str, np.ndarray], frequencies: np.ndarray, title: str) -> Figure:
    """First collapse at a few frequencies with one parameter changed at a time.

    Parameters
    ----------
    first : dict
        First collapse [g] by variant, NaN where none collapses, each of shape (frequencies,).
    frequencies : array
        [Hz]
    title : str
    """
    figure = Figure(figsize=(WIDTH, 1.0 + 0.22 * len(first)))
    panels = figure.subplots(1, len(frequencies), sharey=True, squeeze=False)[0]
    places = np.arange(len(first))[::-1]
    for i, (axes, frequency) in enumerate(zip(panels, frequencies)):
        values = np.array([thresholds[i] for thresholds in first.values()])
        fallen = ~np.isnan(values)
        axes.barh(places[fallen], values[fallen], height=0.62, color=SAND, edgecolor=BLACK, linewidth=0.6)
        for place, value in zip(places, values):
            axes.text(
                0.01 if np.isnan(value) else value + 0.01,
                place,
                "none" if np.isnan(value) else f"{value:.2f}",
                va="center",
                fontsize=7.0,
            )
        axes.set_title(f"{frequency:g} Hz", fontsize=8.5)
        axes.set(xlim=(0.0, 0.75), xticks=(0.0, 0.2, 0.4, 0.6), yticks=places, ylim=(-0.6, places[0] + 0.6))
        axes.set_yticklabels([name.replace("K_M", "$K_M$") for name in first], fontsize=7.5)
        axes.tick_params(axis="x", labelsize=7.5)
    figure.supxlabel("smallest amplitude that collapses the column [g]", size=9.0)
    figure.suptitle(title, x=0.01, ha="left", size=10.0)
    return figure
