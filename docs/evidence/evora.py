"""What the page on the Roman temple of Évora tells of what it bears, of its fragility and of where its stones lie.

``python docs/evidence/evora.py OUT [limits|fragility|debris]`` keeps what it computes in OUT, resumes there, prints the
tables and writes pictures. Not a part of the tests: a limit takes some eight seconds of one core, of a single column one,
the fragility more than an hour of two cores, the debris ten minutes.
"""

from __future__ import annotations

import json
import math
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection

import stylobate as st
from stylobate import plots
from stylobate.column.assembly_files import load_structure
from stylobate.column.structure import Structure
from stylobate.constants import DEGREE
from stylobate.motion.conditioning import trim
from stylobate.plots.drawing import solids_of
from stylobate.plots.scene import View, painted
from stylobate.plots.style import BLACK, GREY, RED, page
from stylobate.statics.limit import limit_directions

#: Directions of the forces [degrees]; the weakest is looked for between them.
AZIMUTHS = [45.0 * k for k in range(8)]

#: Simulated motions, and peak ground velocities to which each is scaled [m/s].
MOTIONS, LEVELS = 10, (0.2, 0.3, 0.45, 0.65)

#: From where the temple is seen: from its corner A6 [rad].
SEEN_FROM = View(-50.0 * DEGREE, 16.0 * DEGREE)


def parts_of(temple: Any) -> dict[str, Structure]:
    """The podium with each column alone, and the temple as a whole, by name."""
    stones: dict[str, list[Any]] = {}
    for stone in temple.stones:
        stones.setdefault(stone.name.rpartition(" ")[0], []).append(stone)
    podium = stones["podium"]
    columns = {name: (*podium, *own) for name, own in stones.items() if name.startswith("Column")}
    return {name: replace(temple, stones=own, name=name) for name, own in columns.items()} | {"temple": temple}


def facts_of(structure: Structure) -> dict[str, Any]:
    """What is borne all round, and the weakest direction with the joint and the number of blocks that move."""
    directions = limit_directions(structure, AZIMUTHS)
    weak = directions.weakest
    return {
        "weakest": weak.multiplier,
        "azimuth": weak.azimuth,
        "mode": weak.mode,
        "between": weak.between,
        "moving": len(weak.moving),
        "all": dict(zip(map(str, directions.azimuths.tolist()), directions.multipliers.tolist(), strict=True)),
    }


def draw(temple: Any, facts: dict[str, dict[str, Any]], path: Path) -> None:
    """The temple, and what it and its columns bear all round."""
    figure = page(None, (9.0, 4.4))
    seen, round_ = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2, projection="polar")
    polygons, colours, outlines = painted(solids_of(temple)[0], SEEN_FROM)
    edges = [(0.35, 0.35, 0.35) if outline else colour for outline, colour in zip(outlines, colours, strict=True)]
    widths = [0.7 if outline else 0.2 for outline in outlines]
    seen.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=edges, linewidths=widths))
    flat = np.concatenate([SEEN_FROM.across(stone.vertices) for stone in temple.stones if not stone.fixed])
    seen.set_aspect("equal")
    seen.set_xlim(flat[:, 0].min() - 1.0, flat[:, 0].max() + 1.0)
    seen.set_ylim(flat[:, 1].min() - 1.0, flat[:, 1].max() + 1.0)
    seen.set_axis_off()
    for name, part in facts.items():
        turns = sorted((float(azimuth) % 360.0, value) for azimuth, value in part["all"].items())
        angles, values = zip(*turns, turns[0], strict=True)
        weak = name in ("Column_A3", "Column_A4")
        colour, width = (BLACK, 1.8) if name == "temple" else (RED, 1.0) if weak else (GREY, 0.5)
        label = {"temple": "the temple", "Column_A3": "columns A3 and A4 alone", "Column_E1": "each other column alone"}
        round_.plot([angle * DEGREE for angle in angles], values, color=colour, linewidth=width, label=label.get(name))
    round_.set_xticks([0.5 * math.pi * k for k in range(4)], ["x", "y", "−x", "−y"])
    round_.set_yticks([0.05, 0.1, 0.15], ["0.05 g", "0.10 g", "0.15 g"], fontsize=7.5)
    round_.set_ylim(0.0, 0.17)
    round_.set_rlabel_position(250.0)
    figure.legend(loc="outside lower center", ncols=3, fontsize=7.5)
    figure.savefig(path, dpi=110)


def limits(temple: Any, out: Path) -> None:
    """Table and picture of what the temple and each of its columns bear."""
    kept = out / "limits.json"
    facts: dict[str, dict[str, Any]] = json.loads(kept.read_text()) if kept.exists() else {}
    for name, structure in parts_of(temple).items():
        if name not in facts:
            facts[name] = facts_of(structure)
            kept.write_text(json.dumps(facts, indent=1))
        part = facts[name]
        joint = " – ".join(text.rpartition(" ")[2] if name != "temple" else text for text in part["between"])
        print(
            f"| {name} | {part['weakest']:.4f} | {part['azimuth']:.0f} | {joint}, {part['mode']} | {part['moving']} |"
        )
    draw(temple, facts, out / "evora.png")


def motions() -> list[st.Motion]:
    """Simulated motions of magnitude 6.5 at 10 km in two components, from 3 to 97 % of their energy."""
    drawn = (st.stochastic_motion(6.5, 10e3, "greece", seed=seed, horizontal=2) for seed in range(MOTIONS))
    return [trim(motion, 0.03, 0.97) for motion in drawn]


def fragility(temple: Any, out: Path) -> None:
    """Runs of every motion at every level until they are decided, their table, curve and picture."""
    analysis = st.ida(
        temple, motions(), st.DistinctElement3D(), "pgv", levels=LEVELS, largest_factor=100.0, tail=3.0,
        ledger=out / "fragility.sqlite", progress=lambda done, total: print(f"{done} of {total}", flush=True),
    )  # fmt: skip
    analysis.runs.to_csv(out / "fragility.csv", index=False)
    curve = st.fragility(analysis)
    print(analysis.runs.to_string(), curve.sentence, json.dumps(curve.summary(), indent=1, default=float), sep="\n")
    plots.draw_fragility(curve).savefig(out / "evora_fragility.png", dpi=110)


def debris(temple: Any, out: Path) -> None:
    """Where the stones of the temple and of fifteen like it are, five seconds after a pulse."""
    pulse = st.ricker(0.5, 0.2 * st.g, duration=7.5)
    certainty = st.certainty(
        temple, pulse, st.DistinctElement3D(), replicates=15, tail=5.0, ledger=out / "debris.sqlite",
        progress=lambda done, total: print(f"{done:.3g} of {total:.3g}", flush=True),
    )  # fmt: skip
    certainty.population.table.to_csv(out / "debris.csv", index=False)
    certainty.population.table_of_bodies.to_csv(out / "debris_bodies.csv", index=False)
    print(certainty.sentence)
    plots.draw_debris(certainty.response, certainty.population.bodies).savefig(out / "evora_debris.png", dpi=110)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore")
    for task in sys.argv[2:] or ("limits",):
        {"limits": limits, "fragility": fragility, "debris": debris}[task](load_structure("evora"), folder)
