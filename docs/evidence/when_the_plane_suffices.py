"""The table of records on the page of when the plane suffices: thirty columns under nine records, in the plane and in space.

``python docs/evidence/when_the_plane_suffices.py RECORDS`` prints it; RECORDS is the folder that ``stylobate reproduce``
takes. Not a part of the tests: a quarter of an hour of one core.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import stylobate as st
from stylobate.column.scatter import twins_of
from stylobate.motion.orientation import strongest
from stylobate.verdicts import verdict as v
from stylobate_studies.paper.cases import ALIKE, MONOLITH, POPULATIONS, SPACE, paper_column
from stylobate_studies.paper.records import read_records

#: Columns of a share, and columns that say which peak is shown; seeds of both; time after a motion [s].
MANY, FEW, SEED, OTHER, TAIL = 30, 3, 0, 1, 5.0

#: Peaks that are tried [g].
PEAKS = np.geomspace(0.2, 3.0, 16)


def columns() -> dict[str, st.Column]:
    """The paper's two as round columns, and one like those of the temple at Bassae."""
    joint = st.Joint(1e10, 1e10, friction_coefficient=0.7)
    bassae = st.Column.tapered(
        height=5.95, bottom_width=1.11, top_width=0.90, drums=8, density=2620.0, joint=joint, section="circular",
        name="Bassae-like",
    )  # fmt: skip
    drums = paper_column("paper-12-drums", "circular")
    return {"monolith": paper_column(MONOLITH, "circular"), "12 drums": drums, "Bassae-like": bassae}


def runs(column: st.Column, motion: st.Motion, model: st.Model, number: int, seed: int) -> tuple[int, float, int]:
    """How many of so many columns like it collapse, the median peak of the others [m], and how many are undecided."""
    twins = [column, *twins_of(column, ALIKE, number - 1, seed)]
    table = st.simulate_many(twins, [motion] * number, model, tail=TAIL)
    verdicts = np.array([v.verdict(row) for row in table.to_dict("records")])
    stands = verdicts != v.COLLAPSED
    peak = float(np.median(table["peak_top_displacement_m"][stands])) if stands.any() else float("nan")
    return int((~stands).sum()), peak, int((verdicts == v.UNDECIDED).sum())


def main(records: Path) -> None:
    """Compute all of it, and print the rows."""
    models, undecided = list(POPULATIONS.values()), 0
    for record in map(strongest, read_records(records)):
        recorded, peaks, scaled = [], [], []
        for column in columns().values():
            counts = [runs(column, record, model, MANY, SEED) for model in (models[0], models[-1])]
            recorded.append(", ".join(str(count) for count, *_ in counts))
            peaks.append(", ".join(f"{peak:.2f}" for _, peak, _ in counts))
            undecided += sum(number for *_, number in counts)
            for peak in PEAKS:
                shaken = record.replace(factor=record.factor * peak * st.g / record.pga)
                if runs(column, shaken, POPULATIONS[SPACE], FEW, OTHER)[0] >= 2:
                    counts = [runs(column, shaken, model, MANY, SEED) for model in models]
                    undecided += sum(number for *_, number in counts)
                    scaled.append(f"{peak:.2f} g: " + ", ".join(str(count) for count, *_ in counts))
                    break
            else:
                scaled.append("stands up to 3 g")
        print(f"| {record.name} | {record.pga / st.g:.2f} g | as recorded: plane, space | {' | '.join(recorded)} |")
        print(f"| | | median peak of the top [m] | {' | '.join(peaks)} |")
        print(f"| | scaled | plane, twin, space | {' | '.join(scaled)} |", flush=True)
    print(f"{undecided} undecided")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
