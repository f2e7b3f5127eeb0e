"""The table of records on the page of when the plane suffices: thirty columns under nine records, in the plane and in space.

``python docs/evidence/when_the_plane_suffices.py RECORDS`` prints it; RECORDS is the folder that ``stylobate reproduce``
takes. Not a part of the tests: half an hour of one core.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

import stylobate as st
from stylobate.column.scatter import twins_of
from stylobate.motion.orientation import strongest
from stylobate.verdicts import verdict as v
from stylobate_studies.paper.cases import ALIKE, MONOLITH, POPULATIONS, paper_column
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


def runs(column: st.Column, motions: Sequence[st.Motion], model: st.Model, number: int, seed: int) -> list[np.ndarray]:
    """Of every motion what becomes of so many columns like it: verdicts, and peaks of the top [m]."""
    twins = [column, *twins_of(column, ALIKE, number - 1, seed)]
    cases = [(twin, motion) for motion in motions for twin in twins]
    table = st.simulate_many(*map(list, zip(*cases, strict=True)), model, tail=TAIL)
    verdicts = np.array([v.verdict(row) for row in table.to_dict("records")])
    return [verdicts.reshape(-1, number), table["peak_top_displacement_m"].to_numpy().reshape(-1, number)]


def main(records: Path) -> None:
    """Compute all of it, and print the rows."""
    plane, *_, space = models = list(POPULATIONS.values())
    open_ends = {v.UNDECIDED: 0, v.FAILED: 0}
    for motion in read_records(records):
        record = motion if motion.y_samples is None else strongest(motion)
        scaled = [record.replace(factor=record.factor * peak * st.g / record.pga) for peak in PEAKS]
        rows: list[list[str]] = [[], [], []]
        for column in columns().values():
            verdicts, peaks = zip(*(runs(column, [record], model, MANY, SEED) for model in (plane, space)), strict=True)
            rows[0].append(fallen(verdicts))
            rows[1].append(
                ", ".join(f"{np.median(peak[seen != v.COLLAPSED]):.2f}" for seen, peak in zip(verdicts, peaks))
            )
            count(open_ends, verdicts)
            few, _ = runs(column, scaled, space, FEW, OTHER)
            falls = np.flatnonzero((few == v.COLLAPSED).sum(axis=1) >= 2)
            if not falls.size:
                rows[2].append(f"stands up to {PEAKS[-1]:g} g")
                continue
            verdicts = [runs(column, [scaled[falls[0]]], model, MANY, SEED)[0] for model in models]
            count(open_ends, verdicts)
            rows[2].append(f"{PEAKS[falls[0]]:.2f} g: {fallen(verdicts)}")
        print(f"| {record.name} | {record.pga / st.g:.2f} g | as recorded: plane, space | {' | '.join(rows[0])} |")
        print(f"| | | median peak of the top [m] | {' | '.join(rows[1])} |")
        print(f"| | scaled | plane, twin, space | {' | '.join(rows[2])} |", flush=True)
    print(", ".join(f"{number} {end}" for end, number in open_ends.items()))


def count(open_ends: dict[str, int], verdicts: Iterable[np.ndarray]) -> None:
    """Add the runs without a certain verdict."""
    for end in open_ends:
        open_ends[end] += sum(int((seen == end).sum()) for seen in verdicts)


def fallen(verdicts: Iterable[np.ndarray]) -> str:
    """How many collapse, of each model."""
    return ", ".join(str(int((seen == v.COLLAPSED).sum())) for seen in verdicts)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
