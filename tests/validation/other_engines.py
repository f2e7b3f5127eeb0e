"""Tables and the picture of what other engines find for the same cases, from the stored results of ``make peers``."""

import json
import math
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from stylobate.plots.style import BLACK, BLUE, GREY, RED, WIDTH, styled, zero_line

FILE = Path(__file__).parents[2] / "peers" / "results.json"

#: Variants in all tables, and their lines in the pictures; the rigid beam, whose swings are ten times as large, has none.
LINES: dict[str, dict] = {
    "stylobate": {"color": RED, "marker": "s"},
    "stylobate, β = 10⁻⁴ s": {"color": "#e08214", "marker": "D"},
    "stylobate, losses of stone": {"color": "#7f3b08", "marker": "*"},
    "stylobate, rigid beam": {},
    "MuJoCo, stiff contact": {"color": BLUE, "marker": "o"},
    "MuJoCo, default contact": {"color": "#92c5de", "marker": "o"},
    "PyBullet": {"color": "#5aae61", "marker": "^"},
    "LMGC90": {"color": BLACK, "marker": "x"},
}

#: Variants that only pass nearly in a plane: other lengths of a contact, to see what they do.
EXPERIMENTS = {
    "stylobate, β = 10⁻³ s": {"color": "#fdb863", "marker": "v"},
    "MuJoCo, sharp contact": {"color": "#053061", "marker": "v"},
    "MuJoCo, ringing contact": {"color": "#4393c3", "marker": "P"},
    "PyBullet, short steps": {"color": "#1b7837", "marker": "v"},
}

#: Precessions at the start of a pass [rad/s], as in ``peers/measures.py``.
PRECESSIONS = (0.1, 0.03, 0.01, 0.003, 0.001, 0.0001)

#: A swing that is smaller is none: drums rattle [m].
SMALLEST_SWING = 0.02

#: What a rigid impact without bouncing leaves of the energy of the paper's monolith (Housner 1963).
HOUSNER = 0.886

#: The same of the round column 4 m high and 1 m wide.
STRUCK = 0.831


@cache
def results() -> dict:
    """The stored results."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def parts(variant: str) -> dict:
    """What a variant found, by part."""
    return results()["engines"][variant]["parts"]


def round_part(variant: str) -> dict:
    """What a variant found for a round column, or for the polygon in its place."""
    seen = parts(variant)
    return seen.get("0") or seen.get("12", {})


def swings(variant: str, column: str) -> list[float]:
    """Largest displacements between changes of side [m]."""
    out: list[float] = []
    for value in parts(variant)["plane"][column]["swings"]:
        if abs(value) < SMALLEST_SWING:
            continue
        if out and value * out[-1] > 0.0:
            out[-1] = max(out[-1], value, key=abs)
        else:
            out.append(value)
    return out


def markdown(head: list[str], rows: list[list[str]]) -> str:
    """A table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def number(value, form: str = "{:.3f}") -> str:
    """A stored number; a dash for what is none."""
    value = float(value)
    return form.format(value) if math.isfinite(value) else "–"


def settings() -> str:
    """Engines, versions and settings."""
    engines: dict[str, tuple[str, str]] = {}
    for variant, entry in results()["engines"].items():
        engines.setdefault(variant.split(",")[0], (str(entry.get("version", "–")), str(entry.get("settings", "–"))))
    return markdown(["engine", "version", "settings"], [[name, *both] for name, both in engines.items()])


def plane_table() -> str:
    """Statics, free rocking, swings and seconds of the plane cases."""
    head = ["engine", "static threshold", "time to upright", "energy after an impact"]
    head += ["monolith: swings [m]", "12 drums: swings [m]", "seconds per run: monolith, drums"]
    rows = []
    for variant in LINES:
        seen = parts(variant).get("plane", {})
        if "failed" in seen or not seen:
            rows.append([variant, seen.get("failed", "–"), *["–"] * 5])
            continue
        both = [", ".join(f"{swing:.3f}" for swing in swings(variant, name)[:5]) for name in ("monolith", "drums")]
        seconds = " / ".join(f"{seen[name]['wall']:.2g}" for name in ("monolith", "drums"))
        rows.append(
            [variant, *(number(seen.get(key, math.nan)) for key in ("static", "quarter", "kept")), *both, seconds]
        )
    return markdown(head, rows)


def agreeing(variant: str, part: str, column: str | None = None) -> str:
    """Cells with the same verdict as the first engine's, and how many each collapses."""
    mine, other = (verdicts(engine, part, column) for engine in ("stylobate", variant))
    cells = [cell for cell in mine if cell in other]
    if not cells:
        return "–"
    same = sum(mine[cell] == other[cell] for cell in cells)
    return (
        f"{same} of {len(cells)} ({sum(other[cell] for cell in cells)} fall, {sum(mine[cell] for cell in cells)} here)"
    )


def verdicts(variant: str, part: str, column: str | None) -> dict[str, bool]:
    """Whether the column collapses, by cell."""
    seen = round_part(variant) if part == "round" else parts(variant).get(part, {})
    return (seen.get(column, {}) if column else seen).get("verdicts", {})


def verdict_table() -> str:
    """Cells in which an engine says the same as the models here."""
    head = ["engine", "monolith, plane", "12 drums, plane", "round column", "12 round drums"]
    rows = [
        [
            variant, agreeing(variant, "plane", "monolith"), agreeing(variant, "plane", "drums"),
            agreeing(variant, "round"), agreeing(variant, "drums"),
        ]
        for variant in list(LINES)[1:]
    ]  # fmt: skip
    return markdown(head, rows)


def round_table() -> str:
    """Statics, rolling and depth of a round column and of polygons."""
    head = ["engine", "facets", "static threshold: corner, edge", "tilt after 2 s [rad]", "azimuth, less exact [rad]"]
    head += ["energy lost", "depth of the rim at 17°, 30° [mm]"]
    rows = []
    for variant in LINES:
        for part in ("0", "12", "16", "24", "48"):
            seen = parts(variant).get(part)
            if seen is None:
                continue
            name = [variant, "round" if part == "0" else part]
            if "failed" in seen:
                rows.append([*name, f"process ended: {seen['failed']}", *["–"] * 4])
                continue
            rolling = seen["rolling"]
            turning = (
                ["falls through the ground", "–", "–"]
                if "fell" in rolling
                else [
                    number(rolling["tilt"], "{:.4f}"),
                    number(rolling["azimuth"]),
                    number(100.0 * float(rolling["lost"]), "{:.2f} %"),
                ]
            )
            depth = ", ".join(number(1e3 * float(sinking), "{:.2f}") for sinking in seen["sinking"])
            rows.append(
                [*name, ", ".join(number(threshold, "{:.4f}") for threshold in seen["static"]), *turning, depth]
            )
    return markdown(head, rows)


def passing() -> dict[str, dict]:
    """What each variant with a round primitive finds of passes nearly in a plane."""
    return {
        variant: parts(variant)["passes"]
        for variant in (*LINES, *EXPERIMENTS)
        if "kept" in parts(variant).get("passes", {})
    }


def fallen(variant: str) -> int:
    """How many columns of a variant's population collapse."""
    return sum(not math.isfinite(float(peak)) for peak in passing()[variant]["population"])


def passes_table() -> str:
    """Energy that a pass keeps, growth of what is across, and what a population does at 1 Hz and 0.3 g."""
    shown = (0, 1, 2, 3, 5)
    head = ["engine", *(f"kept at {PRECESSIONS[k]:g} rad/s" for k in shown), "aside at 0.01 [rad]", "precession grows"]
    head += ["collapses", "peaks: least, median [m]"]
    rows = []
    for variant, seen in passing().items():
        peaks = [float(peak) for peak in seen["population"]]
        middle = peaks[len(peaks) // 2]
        rows.append(
            [
                variant, *(number(seen["kept"][k]) for k in shown), number(seen["aside"][2]),
                number(seen["growth"][-1], "{:.1f} times"), f"{fallen(variant)} of {len(peaks)}",
                f"{peaks[0]:.2f}, {f'{middle:.2f}' if math.isfinite(middle) else 'falls'}",
            ]
        )  # fmt: skip
    return markdown(head, rows)


#: Swings after an impact, by what they are called in the table: of the monolith and of drums in the plane; of a round column
#: what half a turn keeps of its energy, the largest displacement over six imperfections, and of a population of 24.
AFTER_IMPACT = (
    "monolith, swings",
    "12 drums, swings",
    "round: a pass keeps",
    "round: largest swing",
    "round: population",
)


def after_impact(variant: str) -> dict[str, list[float]]:
    """What a variant finds after an impact, case by case, by the names of :data:`AFTER_IMPACT`."""
    plane, passed = parts(variant).get("plane", {}), parts(variant).get("passes", {})
    series = [
        [abs(swing) for swing in swings(variant, name)[:5]] if name in plane else [] for name in ("monolith", "drums")
    ]
    series += [passed.get("kept", []), parts(variant).get("0", {}).get("peaks", []), passed.get("population", [])]
    return {name: [float(value) for value in values] for name, values in zip(AFTER_IMPACT, series, strict=True)}


def within(variant: str) -> dict[str, tuple[int, int]]:
    """In how many cases a variant of ours lies between the least and the largest of the other engines, and of how many."""
    others = [after_impact(engine) for engine in results()["engines"] if not engine.startswith("stylobate")]
    counts = {}
    for name, mine in after_impact(variant).items():
        pairs = [(x, [other[name][k] for other in others if k < len(other[name])]) for k, x in enumerate(mine)]
        cases = [(x, all_) for x, all_ in pairs if len(all_) > 1]
        counts[name] = sum(min(all_) <= x <= max(all_) for x, all_ in cases), len(cases)
    return counts


def within_table() -> str:
    """Cases after an impact in which ours lie within the spread of the other engines."""
    rows = []
    for variant in (engine for engine in results()["engines"] if engine.startswith("stylobate")):
        counts = within(variant)
        around = [counts[name] for name in AFTER_IMPACT if name.startswith("round")]
        whole = tuple(map(sum, zip(*around, strict=True)))
        cells = [f"{hit} of {of}" if of else "–" for hit, of in (*counts.values(), whole)]
        rows.append([variant, *cells[:-1], f"{cells[-1]} ({100 * whole[0] / whole[1]:.0f} %)" if whole[1] else "–"])
    return markdown(["here", *AFTER_IMPACT, "round, together"], rows)


@styled
def passes_compared() -> Figure:
    """Energy kept in one pass over the precession it starts with, and how many columns collapse over what one pass keeps."""
    figure = Figure(figsize=(WIDTH, 4.2))
    left, right = figure.subplots(1, 2)
    for variant, seen in passing().items():
        line = (LINES | EXPERIMENTS)[variant]
        left.plot(PRECESSIONS, seen["kept"], markersize=4, label=variant, **line)
        right.plot(seen["kept"][2], fallen(variant), markersize=7, linestyle="none", **line)
    left.axhline(1.0, color=GREY, linewidth=0.9)
    left.annotate("rigid rolling", (1.1e-4, 1.0), va="bottom", fontsize=8, color=GREY)
    left.axhline(STRUCK, color=GREY, linewidth=0.9, linestyle="--")
    left.annotate("rigid impact in the plane", (1e-1, STRUCK), ha="right", va="top", fontsize=8, color=GREY)
    left.set_xscale("log")
    left.set_ylim(0.805, 1.015)
    left.set(xlabel="precession at the start [rad/s]", ylabel="energy kept in one pass [-]")
    right.set(xlabel="energy kept at 0.01 rad/s [-]", ylabel="collapses of 24 at 1 Hz, 0.3 g")
    right.set_ylim(-1.0, 25.0)
    right.set_yticks(range(0, 25, 6))
    for axes in (left, right):
        axes.grid()
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


@styled
def engines_compared() -> Figure:
    """Swings of both columns in the plane, peaks of a round one over its imperfection, and what facets do to rolling."""
    figure = Figure(figsize=(WIDTH, 6.4))
    grid = figure.subplots(2, 2)
    for axes, name, title in ((grid[0, 0], "monolith", "monolith"), (grid[0, 1], "drums", "12 drums")):
        for variant, line in LINES.items():
            if line and name in parts(variant).get("plane", {}):
                row = swings(variant, name)
                axes.plot(range(1, len(row) + 1), row, markersize=4, label=variant, **line)
        axes.set(xlabel="swing", ylabel="largest displacement of the top [m]", title=f"Plane, 1 Hz, 0.3 g: {title}")
        zero_line(axes)
    left, right = grid[1]
    for variant, line in LINES.items():
        peaks = [float(peak) for peak in round_part(variant).get("peaks", [])]
        if peaks:
            left.plot(range(len(peaks)), np.clip(np.nan_to_num(peaks, posinf=1.2), None, 1.2), markersize=4, **line)
    left.set_xticks(range(6), ("0", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"))
    left.set_yticks((0.4, 0.6, 0.8, 1.0, 1.2), ("0.4", "0.6", "0.8", "1.0", "falls"))
    left.set(xlabel="share of the motion across", ylabel="largest displacement of the top [m]")
    left.set_title("Round column, 1 Hz, 0.3 g, in space")
    facets = [12, 16, 24, 48]
    seen = parts("MuJoCo, stiff contact")
    losses = [100.0 * float(seen[str(n)]["rolling"].get("lost", math.nan)) for n in facets]
    right.plot(facets, losses, markersize=4, **LINES["MuJoCo, stiff contact"])
    for variant in ("stylobate", "MuJoCo, stiff contact", "PyBullet"):
        exact = 100.0 * float(parts(variant)["0"]["rolling"].get("lost", math.nan))
        right.axhline(exact, linestyle="--", color=LINES[variant]["color"], linewidth=0.9)
    right.annotate("dashed: round primitives", (48, 0.0), ha="right", va="bottom", fontsize=8, color=GREY)
    right.set_xticks(facets, [str(n) for n in facets])
    right.set(xlabel="facets (MuJoCo, stiff contact)", ylabel="energy lost in 2 s of rolling [%]")
    right.set_title("What facets do to rolling")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def dated() -> str:
    """When and where the table was made."""
    return f"Made on {results()['date']} ({results()['machine']})."
