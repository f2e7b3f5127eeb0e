"""The page on columns of the world: their figures, their sources, and the fragility of each, from one command.

``python docs/reference/columns_of_the_world.py OUT [plane|space]`` runs every column of the catalogue under the motions
below, keeps the runs in OUT and resumes there, and writes ``docs/reference/columns_of_the_world.md``. Not a part of the
tests: a quarter of an hour of one core in space.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import stylobate as st
from stylobate.bibliography import bibliography
from stylobate.column.catalogue import CATALOGUE, JOINT, PAPER, KnownColumn
from stylobate.probability.fragility import Fragility

PAGE = Path(__file__).with_suffix(".md")

#: Records that come with the package, as far as they are strong enough to be scaled.
RECORDS = ("el-centro-1940", "hanmer-springs-2016")

#: Frequencies of the near-fault pulses [Hz].
PULSES = (0.2, 0.27, 0.35, 0.5, 0.65, 0.8, 0.95, 1.1, 1.4, 1.8)

#: PGV to which motions are scaled [m/s]; time after the motions [s].
LEVELS, TAIL = (0.2, 0.4, 0.7, 1.1, 1.6, 2.4), 5.0

#: What shakes along one line in space shakes across it by so much as well: nothing is that straight [-].
ACROSS = 0.01


#: The page above its table.
PAGE_TEXT = """# Columns of the world

{world} columns that stand or stood, and the founding paper's two, are presets: each name works wherever a column is
asked for.

```
stylobate columns --catalogue            # a table: what is measured, what is assumed
stylobate columns segesta                # one of them, with the source of each figure
stylobate run segesta --model dem3d --motion sample:el-centro-1940 --pga 0.4g
stylobate columns segesta --out mine     # as a file to change
```

**Measured** is a figure that a source states and that was read there. Some sources are pages for travellers, or quote
another that was not read: they say so, and where sources contradict each other the words tell it. **Assumed**, with
an asterisk in tables, is everything else: an upper diameter by the taper of columns of its kind, a number of drums by
a usual height, the density of the stone. All are straight tapers without entasis and flutes, of drums of equal height
that nothing ties together, free of what they carry or carried. Their joints have {normal:g} and {shear:g} GPa/m and
tan φ = {friction:g}, an assumption for all. Where you know better, write a [column file](column_files.md).

## Fragility

The state is collapse, the intensity PGV, the interval one of 95 % over motions, computed {model}: {records} records
and {pulses} near-fault pulses of {first:g} to {last:g} Hz, each at {levels} m/s; {runs} runs for each column,
followed for {tail:g} s after the motion. That is a small size (nine minutes of one core). Columns whose intervals
overlap are not ranked by it, motions are multiplied by up to eleven for the upper levels, and no column is judged by
it at its site.

```
python docs/reference/columns_of_the_world.py OUT {where}
```

| column | height m | below m | above m | drums | kg/m³ | median PGV (95 %) | collapses of {runs} |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""


def motions() -> list[st.Motion]:
    """Twelve motions, each along x, with a hundredth of it across."""
    along = [st.sample_motion(name) for name in RECORDS]
    shakings = [st.Motion(record.dt, record.samples).replace(name=record.name) for record in along]
    shakings += [st.mavroeidis_papageorgiou(f, 0.3 * st.g).replace(name=f"near-fault pulse {f:g} Hz") for f in PULSES]
    return [shaking.replace(ay=ACROSS * shaking.samples) for shaking in shakings]


def fragility_of(known: KnownColumn, folder: Path, where: str) -> tuple[Fragility | str, int]:
    """Fragility of a column in PGV, or why there is none; and how many runs fell."""
    model = st.DistinctElement3D() if where == "space" else st.DistinctElement2D()
    shaking = motions() if where == "space" else [motion.replace(ay=None) for motion in motions()]
    analysis = st.ida(
        known.column, shaking, model, "pgv", levels=LEVELS, largest_factor=100.0, tail=TAIL, threads=1,
        ledger=folder / "runs.sqlite",
    )  # fmt: skip
    fallen = int(analysis.runs["collapsed"].fillna(0).sum())
    try:
        return st.fragility(st.evidence(analysis), method="runs"), fallen
    except st.InputError as reason:
        return str(reason), fallen


def median_cell(curve: Fragility | str) -> str:
    """Median and its interval, as far as they lie within the levels."""
    if isinstance(curve, str):
        return "no fragility goes through the runs"
    low, high = curve.median_interval
    most = LEVELS[-1]  # what lies beyond is told by the shape of the curve, not by the runs
    median, end = (f"> {most:g}" if value > most else f"{value:.2f}" for value in (curve.median, high))
    return f"{median} m/s ({low:.2f} to {end})"


def page(rows: list[str], where: str) -> str:
    """The page as Markdown."""
    runs = (len(RECORDS) + len(PULSES)) * len(LEVELS)
    levels = ", ".join(f"{level:g}" for level in LEVELS)
    model = (
        "in space (`dem3d`)"
        if where == "space"
        else "in the plane (`dem2d`), where round columns stand more than in space"
    )
    introduction = PAGE_TEXT.format(
        world=len(CATALOGUE) - len(PAPER), normal=JOINT.normal_stiffness / 1e9, shear=JOINT.shear_stiffness / 1e9,
        friction=JOINT.tan_phi, model=model, records=len(RECORDS), pulses=len(PULSES), first=PULSES[0], last=PULSES[-1],
        levels=levels, runs=runs, tail=TAIL, where=where,
    )  # fmt: skip
    text = introduction + "\n".join(rows) + "\n\n## Figures\n"
    for known in CATALOGUE.values():
        text += f"\n**{known.title}** (`{known.name}`)\n\n"
        text += "".join(f"- {name.replace('_', ' ')}: {figure.text}\n" for name, figure in known.figures.items())
    keys = dict.fromkeys(key for known in CATALOGUE.values() for key in known.sources)
    text += "\n## Sources\n\n" + "\n\n".join(sorted(bibliography()[key].text for key in keys)) + "\n"
    return text


def main(out: str, where: str = "space") -> None:
    """Run what is left of it, and write the page."""
    began, rows = time.time(), []
    (Path(out) / where).mkdir(parents=True, exist_ok=True)
    for known in CATALOGUE.values():
        curve, fallen = fragility_of(known, Path(out) / where, where)
        figures = [known.figures[name] for name in ("height", "bottom_width", "top_width", "drums", "density")]
        cells = [f"{figure.value:.4g}" + ("" if figure.measured else "\\*") for figure in figures]
        rows.append(f"| {' | '.join([f'`{known.name}`', *cells, median_cell(curve), str(fallen)])} |")
        print(f"{time.time() - began:.0f} s", rows[-1], curve if isinstance(curve, str) else "", flush=True)
    PAGE.write_text(page(rows, where), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
