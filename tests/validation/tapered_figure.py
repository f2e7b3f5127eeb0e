"""The picture and the table of the tapered column: published thresholds of other codes beside what the models find here."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from stylobate.plots.style import BLACK, BLUE, HALO, RED, SAND, WIDTH, styled

from . import tapered_column as column

LINES = {
    "UDEC": {"color": BLACK, "marker": "^"},
    "LMGC90": {"color": BLUE, "marker": "x"},
    "HybriDFEM": {"color": "#e08214", "marker": "o"},
}

#: What collapses in the map.
FALLEN = "#e5b3ad"


@styled
def thresholds_of_codes() -> Figure:
    """Map of the verdicts in the plane, with the published thresholds."""
    lengths, sizes, fell = column.plane_map()
    figure = Figure(figsize=(WIDTH, 4.2))
    axes = figure.subplots()
    axes.pcolormesh(
        edges(lengths),
        edges(sizes),
        np.ma.masked_invalid(fell),
        cmap=ListedColormap([SAND, FALLEN]),
        vmin=0.0,
        vmax=1.0,
    )
    for code, row in column.PUBLISHED.items():
        axes.plot(*zip(*row.items(), strict=True), label=code, markersize=4, path_effects=HALO, **LINES[code])
    firsts = column.replicates()
    axes.errorbar(
        list(firsts),
        [float(np.median(amplitudes)) for amplitudes in firsts.values()],
        yerr=[
            [float(np.median(amplitudes)) - min(amplitudes) for amplitudes in firsts.values()],
            [max(amplitudes) - float(np.median(amplitudes)) for amplitudes in firsts.values()],
        ],
        fmt="s", color=RED, markersize=3.5, capsize=3, label="dem2d, eight columns ±1 %: first collapse",
    )  # fmt: skip
    axes.axhline(column.column().uplift_acceleration / column.g, color="#767676", linestyle="--", linewidth=0.8)
    axes.annotate(
        "static uplift", (0.99, 0.184), fontsize=8, color="#767676", ha="right", va="top", xytext=(0.99, 0.189)
    )
    axes.set(yscale="log", xlim=(0.14, 1.03), ylim=(0.175, 2.6))
    axes.set(xlabel="length of the first pulse, t_p [s]", ylabel="amplitude of the first pulse [g]")
    axes.set_yticks((0.2, 0.3, 0.5, 1.0, 2.0), ("0.2", "0.3", "0.5", "1", "2"))
    axes.minorticks_off()
    axes.set_title("Tapered column of eight blocks: dem2d collapses (red), stands (sand), undecided (white)")
    axes.legend(loc="upper right")
    return figure


def edges(centres: np.ndarray) -> np.ndarray:
    """Edges of cells around values."""
    inner = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate(([2 * centres[0] - inner[0]], inner, [2 * centres[-1] - inner[-1]]))


def table() -> str:
    """Published rows and ours, one line for each length of the pulse (Markdown)."""
    firsts = column.replicates()
    thresholds = {name: column.thresholds(name) for name in column.MODELS}
    head = ["t_p [s]", *column.PUBLISHED, *thresholds, "`dem2d`, eight columns ±1 %"]
    lines = [f"| {' | '.join(head)} |\n|{' --- |' * len(head)}\n"]
    for length in column.LENGTHS:
        cells = [f"{row[length]:.2f}" if length in row else "–" for row in column.PUBLISHED.values()]
        cells += [mixed(*row[length]) for row in thresholds.values()]
        amplitudes = firsts[length]
        cells.append(f"{min(amplitudes):.2f} – {np.median(amplitudes):.2f} – {max(amplitudes):.2f}")
        lines.append(f"| {length:.2f} | {' | '.join(cells)} |\n")
    return "".join(lines) + f"\nOurs computed on {column.stored()['date']}.\n"


def mixed(first: float | None, all_from: float | None) -> str:
    """First collapse, and from which amplitude on all collapse where that is another."""
    if first is None:
        return "none"
    if all_from is None:
        return f"{first:.2f} …"
    return f"{first:.2f}" if abs(all_from - first) < 1e-9 else f"{first:.2f} … {all_from:.2f}"
