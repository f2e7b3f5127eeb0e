"""The studies behind the page on strengthening: seven states of two columns under twelve motions, in the plane and in space.

``python docs/how_to/strengthening.py RECORDS OUT [bassae|drums] [plane|space] [STATE,STATE …]`` keeps its runs in
OUT and resumes there; it prints the table of the page and writes its picture. RECORDS is a folder with the files named
below, as their networks published them. Not a part of the tests: a column takes half an hour to an hour of one core in
space.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path

import stylobate as st
from stylobate import plots
from stylobate.campaign.study_files import levels_of
from stylobate.column.links import Link
from stylobate.probability.states import StateComparison, compare_states
from stylobate_studies.paper.records import FILES as NINE

#: Records by what the tables call them; the last three of those in space have one horizontal component.
FILES = {name: file for name, file in NINE.items() if name != "Waipukurau 2018"}

#: Components that shake in the plane: one motion each.
IN_PLANE = (("Northridge", "xy"), ("Ridgecrest", "xy"), ("Coalinga", "xy"), ("Kaikoura", "x"), ("El Centro", "x"))

#: Frequencies of the near-fault pulses [Hz].
PULSES = (0.45, 0.65, 0.95, 1.4)

#: Measure to which motions are scaled, in space the largest of all directions; its levels; time after the motions [s].
MEASURES, LEVELS, TAIL = {"plane": "pgv", "space": "pgv@rotd100"}, "0.3m/s:1.7m/s:8", {"plane": 3.0, "space": 10.0}

#: Columns like the one given under each motion, with the deviations that scatter draws where nobody says; 0 for that one.
TWINS = {("bassae", "space"): 4, ("drums", "space"): 2}

#: What shakes along one line in space shakes across it by so much as well: nothing is that straight [-].
ACROSS = 0.01


def column_of(which: str) -> st.Column:
    """The column like one of the temple at Bassae, or the paper's twelve drums."""
    if which == "drums":
        return st.preset("paper-12-drums")
    joint = st.Joint(1e10, 1e10, friction_coefficient=0.7)
    return st.Column.tapered(
        height=5.95, bottom_width=1.11, top_width=0.90, drums=8, density=2620.0, joint=joint, section="circular",
        name="Bassae-like",
    )  # fmt: skip


def states_of(column: st.Column) -> dict[str, st.Column]:
    """The column as built and with each of six measures."""
    between, every = range(2, column.n + 1), range(1, column.n + 1)
    weight = column.mass * column.gravity

    def titanium(diameter: float) -> tuple[Link, ...]:
        size = {"diameter": diameter, "embedment": 0.1, "material": "titanium", "clearance": 0.001}
        return tuple(st.Dowel(joint=j, at=(x, 0.0), **size) for j in between for x in (-0.15, 0.15))

    pole = {"diameter": 0.05, "embedment": 0.05, "material": "wood", "clearance": 0.001}
    bar = {"diameter": 0.04, "embedment": 0.2, "material": "stainless steel"}
    links: dict[str, tuple[Link, ...]] = {
        "as built": (),
        "wooden poles": tuple(st.Dowel(joint=j, **pole) for j in between),
        "titanium 20 mm": titanium(0.02),
        "titanium 40 mm": titanium(0.04),
        "steel bars": tuple(st.Bar(joint=j, at=(x, 0.0), **bar) for j in every for x in (-0.2, 0.2)),
        "core": (st.Core(diameter=0.036, material="stainless steel", pretension=0.5 * weight),),
        "sliding base": (
            st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=column.mass * (2.0 * math.pi / 3.0) ** 2),
        ),
    }
    return {name: column.replace(links=measure) for name, measure in links.items()}


def read(folder: Path, name: str) -> st.Motion:
    """A record by the beginning of its name."""
    called = next(candidate for candidate in FILES if candidate.startswith(name))
    unit = {"unit": "g"} if called.startswith("El Centro") else {}
    return st.read_motion(folder / FILES[called], **unit).replace(name=called)


def pulses() -> list[st.Motion]:
    """Near-fault pulses."""
    return [st.mavroeidis_papageorgiou(f, 0.3 * st.g).replace(name=f"near-fault pulse {1.0 / f:.1f} s") for f in PULSES]


def motions_in_plane(folder: Path) -> list[st.Motion]:
    """Twelve motions of one component, stepped from their first to their last sample."""
    motions = []
    for name, axes in IN_PLANE:
        whole = read(folder, name)
        motions += [st.Motion(whole.dt, whole.components[axis]).replace(name=f"{whole.name} {axis}") for axis in axes]
    return motions + pulses()


def motions_in_space(folder: Path) -> list[st.Motion]:
    """Twelve motions with all components that were recorded; those with one horizontal one shake a little across it."""
    motions = [read(folder, name) for name in FILES] + pulses()
    return [
        motion if motion.y_samples is not None else motion.replace(ay=ACROSS * motion.samples) for motion in motions
    ]


def table(comparison: StateComparison) -> str:
    """The table of the page, in Markdown."""
    links = comparison.links
    differences = {difference.state: difference for difference in comparison.differences}
    head = ("state", "collapses of {}", "median PGV (95 %)", "against as built, paired (95 %)", "saved, harmed",
            "links broken in a run, mean")  # fmt: skip
    runs = len(comparison.table) // len(comparison.labels)
    lines = [f"| {' | '.join(head)} |".format(runs), "|" + " --- |" * len(head)]
    for label, curve in zip(comparison.labels, comparison.curves, strict=True):
        fallen = int(comparison.table.loc[comparison.table["state"] == label, "collapsed"].fillna(0).sum())
        median = "" if curve is None else f"{curve.median:.2f} m/s ({_limits(*curve.median_interval)})"
        cells = [label, str(fallen), median, "", "", ""]
        if label in differences:
            difference = differences[label]
            shares = [
                f"{100.0 * value:+.0f}".replace("-", "−")
                for value in (difference.share, difference.share_low, difference.share_high)
            ]
            cells[3:5] = [f"{shares[0]} % ({shares[1]} to {shares[2]})", f"{difference.saved}, {difference.harmed}"]
        mine = links[links["state"] == label] if len(links) else links
        if len(mine):
            broken = mine["broken"].sum() / max(mine["runs"].max(), 1)
            cells[5] = f"{broken:.1f} of {len(mine)}" if broken >= 0.05 else "none" if broken == 0.0 else "next to none"
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _limits(low: float, high: float) -> str:
    """An interval; where too few runs fall the median has no end."""
    if math.isinf(high):
        return f"{low:.2f} or more" if low > 0.0 else "no interval"
    return f"{low:.2f} to {high:.2f}" if low > 0.0 else f"up to {high:.2f}"


def main(records: str, out: str, which: str = "bassae", where: str = "plane", only: str = "") -> None:
    """Run a study, or what is left of it."""
    began = time.process_time()
    folder = Path(out) / f"{which}_{where}"
    folder.mkdir(parents=True, exist_ok=True)
    chosen = only.split(",") if only else None
    column = column_of(which)
    states = {name: state for name, state in states_of(column).items() if chosen is None or name in chosen}
    plane = where == "plane"
    motions = motions_in_plane(Path(records)) if plane else motions_in_space(Path(records))
    model = st.DistinctElement2D() if plane else st.DistinctElement3D()
    measure, levels = levels_of(MEASURES[where], LEVELS)
    comparison = compare_states(
        states, motions, model, levels, measure, replicates=TWINS.get((which, where), 0), tail=TAIL[where], threads=1,
        out=folder,
    )  # fmt: skip
    (folder / "states.json").write_text(json.dumps(comparison.summary(), indent=1))
    plots.draw_states(comparison, f"{column.name}, in {'the plane' if plane else 'space'}").savefig(
        folder / "states.png", dpi=110
    )
    print(table(comparison))
    for difference in comparison.differences:
        print(
            difference.sentence,
            f"ratio {difference.ratio:.2f} ({difference.ratio_low:.2f} to {difference.ratio_high:.2f})",
        )
    print(f"{time.process_time() - began:.0f} s of a core")


if __name__ == "__main__":
    main(*sys.argv[1:])
