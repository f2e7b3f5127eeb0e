"""The models side by side: assumptions and limits as their classes state them, histories and shares of collapse."""

import inspect
import re

import numpy as np
from matplotlib.figure import Figure

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.registry import MODELS, make_model, model_class
from stylobate.motion import harmonic
from stylobate.plots import style
from stylobate.simulate import simulate, simulate_many

FREQUENCIES = (0.33, 0.5, 0.66, 0.8, 1.0, 1.25, 1.5, 2.0)
AMPLITUDES = np.linspace(0.15, 0.60, 46)

COLUMNS = (preset("paper-monolithic"), preset("paper-12-drums"))

#: Name in the figure: model, settings, friction coefficient of the column where it is not its own.
CASES = {
    "Housner": ("housner", {}, None),
    "rigid beam": ("rigid-beam", {}, None),
    "rigid beam, sliding": ("rigid-beam", {"sliding": "true"}, None),
    "rigid block": ("rigid-block", {}, None),
    "rigid block, no sliding": ("rigid-block", {}, 1e3),
    "distinct elements": ("dem2d", {}, None),
}

#: Page of theory of each model.
PAGES = {
    "housner": "housner",
    "rigid-beam": "rigid_beam",
    "rigid-block": "rigid_block",
    "dem2d": "distinct_element_2d",
    "dem3d": "distinct_element_3d",
}

#: Options and models in a sentence: name=value, a name with an underscore after more than a letter, dem2d, dem3d.
OPTION = re.compile(r"\b\w+=\w+|\b\w{2,}_\w+|\bdem[23]d\b")


def texts(out):
    """What each model assumes, and where it ends."""
    parts = []
    for name in MODELS:
        model = model_class(name)
        first = inspect.getdoc(model).split("\n")[0]
        parts.append(f"### `{name}`: {model.title}\n\n{first} [Theory](../theory/{PAGES[name]}.md).\n")
        for title, sentences in (("Assumptions", model.assumptions), ("Limits", model.limits)):
            items = "".join(f"- {OPTION.sub(lambda match: f'`{match[0]}`', sentence)}\n" for sentence in sentences)
            parts.append(f"*{title}*\n\n{items}")
    return [(out / "models.md", "\n".join(parts))]


def computed(out):
    """Table of the shares of collapse, and the figure."""
    shares = {column.name: shares_of(column) for column in COLUMNS}
    draw(shares).savefig(out / "models.png", dpi=150, facecolor="white")
    rows = [
        f"| {label if k == 0 else ''} | {name} | {' | '.join(f'{100 * value:.0f}' for value in share)} |\n"
        for label, column_shares in zip(("monolith", "12 drums"), shares.values(), strict=True)
        for k, (name, share) in enumerate(column_shares.items())
    ]
    head = (
        f"| column | model | {' | '.join(f'{f:g} Hz' for f in FREQUENCIES)} |\n|{' --- |' * (2 + len(FREQUENCIES))}\n"
    )
    return [(out / "shares.md", head + "".join(rows))]


def cases(column):
    """Name, model and column of the cases that fit a column."""
    for name, (model, settings, friction) in CASES.items():
        if model != "housner" or column.n == 1:
            stone = column if friction is None else column.with_joint(friction_coefficient=friction)
            yield name, make_model(model, settings), stone


def shares_of(column):
    """Share of the amplitudes that collapse the column, by case, over the frequencies."""
    motions = [harmonic(f, a * g, max(6.0, 5.0 / f)) for f in FREQUENCIES for a in AMPLITUDES]
    return {
        name: simulate_many(stone, motions, model)["collapsed"].to_numpy().reshape(len(FREQUENCIES), -1).mean(axis=1)
        for name, model, stone in cases(column)
    }


@style.styled
def draw(shares):
    """Histories above, shares of collapse below, one column of pictures for each column of stone."""
    figure = Figure(figsize=(style.WIDTH, 5.6))
    lines = dict(zip(CASES, style.CYCLE, strict=True))
    motion = harmonic(1.0, 0.3 * g, 4.0)
    for (above, below), column in zip(figure.subplots(2, 2).T, COLUMNS, strict=True):
        for name, model, stone in cases(column):
            history = simulate(stone, motion, model, output_interval=0.005).histories
            above.plot(history.time, history.top_displacement, **lines[name], label=name)
            below.plot(FREQUENCIES, 100.0 * shares[column.name][name], **lines[name], marker=".")
        above.set(title=column.name, xlabel="time [s]", ylabel="top, relative to the base [m]")
        below.set(xlabel="frequency [Hz]", ylabel="amplitudes that collapse it [%]", ylim=(-3, 100))
        style.zero_line(above)
        below.grid(True)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure
