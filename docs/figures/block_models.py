"""
How far do rigid beam, rigid block and distinct elements differ?
================================================================

One column, one motion, every plane model of the package: histories first, then the share of amplitudes that collapse the
column, over frequency. Single runs beyond the second impact are not comparable; shares of many runs are.

``python docs/figures/block_models.py FOLDER`` writes the figure there.
"""

import sys
from pathlib import Path

import numpy as np

from stylobate import harmonic, simulate, simulate_many
from stylobate.column import preset
from stylobate.models.registry import MODELS, make_model
from stylobate.plots import style

G = 9.81
FREQUENCIES = np.array([0.33, 0.5, 0.66, 0.8, 1.0, 1.25, 1.5, 2.0])
AMPLITUDES = np.linspace(0.15, 0.60, 46)

#: Name in the figure: model, settings, column changed.
CASES = {
    "Housner": ("housner", {}, None),
    "rigid beam": ("rigid-beam", {}, None),
    "rigid beam, sliding": ("rigid-beam", {"sliding": "true"}, None),
    "rigid block": ("rigid-block", {}, None),
    "rigid block, no sliding": ("rigid-block", {}, 1e3),
    "distinct elements": ("dem2d", {}, None),
}


def cases(column):
    """Name, model and column of the cases that fit a column."""
    for name, (model, settings, friction) in CASES.items():
        if model not in MODELS or (model == "housner" and column.n > 1):
            continue
        yield (
            name,
            make_model(model, settings),
            column if friction is None else column.with_joint(friction_coefficient=friction),
        )


def shares(column):
    """Share of the amplitudes that collapse the column, by case, over the frequencies."""
    found = {}
    for name, model, stone in cases(column):
        motions = [harmonic(f, a * G, max(6.0, 5.0 / f)) for f in FREQUENCIES for a in AMPLITUDES]
        table = simulate_many(stone, motions, model)
        found[name] = table.collapsed.to_numpy().reshape(len(FREQUENCIES), -1).mean(axis=1)
    return found


@style.styled
def draw(columns, motion, collapsed):
    """Histories above, shares of collapse below, one column of pictures for each column of stone."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(style.WIDTH, 5.6))
    axes = figure.subplots(2, len(columns))
    lines = dict(zip(CASES, style.CYCLE, strict=True))
    for (above, below), column in zip(axes.T, columns, strict=True):
        for name, model, stone in cases(column):
            response = simulate(stone, motion, model, output_interval=0.005)
            above.plot(response.histories.time, response.histories.top_displacement, **lines[name], label=name)
            below.plot(FREQUENCIES, 100.0 * collapsed[column.name][name], **lines[name], marker=".")
        above.set(title=column.name, xlabel="time [s]", ylabel="top, relative to the base [m]")
        below.set(xlabel="frequency [Hz]", ylabel="amplitudes that collapse it [%]", ylim=(-3, 100))
        style.zero_line(above)
        below.grid(True)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


if __name__ == "__main__":
    columns = [preset("paper-monolithic"), preset("paper-12-drums")]
    collapsed = {column.name: shares(column) for column in columns}
    for column in columns:
        for name, share in collapsed[column.name].items():
            print(f"{column.name:18s} {name:24s}", " ".join(f"{100 * value:4.0f}" for value in share))
    if len(sys.argv) > 1:
        figure = draw(columns, harmonic(1.0, 0.3 * G, 4.0), collapsed)
        style.save(figure, Path(sys.argv[1]) / "block_models")
