"""The study: four structures of the same columns under the same records at the same levels, and what falls of each."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.campaign import Campaign, Progress
from stylobate.campaign.digests import Digests, Hasher
from stylobate.campaign.runs import Request, Runs, Stopped
from stylobate.column.assembly_files import read_assembly
from stylobate.column.spatial.assembly import SpatialAssembly
from stylobate.models.base import Case
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.motion import Motion
from stylobate.motion.intensity_specs import parse_measure
from stylobate.motion.orientation import rotated
from stylobate.simulate import run_options, simulate, thread_count

#: Structures by what the table calls them, and their files beside this one; all are made of ``column.toml``.
STRUCTURES = {"alone": "alone.toml", "two": "two.toml", "four in a row": "four.toml", "corner": "corner.toml"}

#: Directions in which every record shakes: its x along the row, and across it [degrees].
AZIMUTHS = (0.0, 90.0)

#: Measure to which records are scaled, the larger one of all directions; its levels [m/s].
MEASURE, LEVELS = "pgv@rotd100", (0.3, 0.45, 0.6, 0.75, 0.9, 1.1, 1.3)

#: What shakes along one line shakes across it by so much as well: nothing is that straight [-].
ACROSS = 0.01

#: Rest after each motion [s].
TAIL = 5.0

#: Between the two ends of what is plausible of stone, where the fewest runs are left rocking.
MODEL = DistinctElement3D(stiffness_damping=1e-4)


def structures() -> dict[str, SpatialAssembly]:
    """The structures of the study."""
    read: dict[str, Any] = {label: read_assembly(Path(__file__).with_name(name)) for label, name in STRUCTURES.items()}
    return read


def prepared(record: Motion) -> Motion:
    """A record as the study shakes with it: with a second horizontal component, where it has none."""
    return record if record.y_samples is not None else record.replace(ay=ACROSS * record.samples)


def directed(record: Motion, azimuth: float) -> Motion:
    """A record turned as a whole about the vertical, from its x towards y [degrees]."""
    bare = record.replace(metadata={key: value for key, value in record.metadata.items() if key != "azimuths"})
    return rotated(bare, azimuth) if azimuth else bare


def cases_of(
    records: Sequence[Motion], levels: Sequence[float] = LEVELS, labels: Sequence[str] = tuple(STRUCTURES)
) -> list[tuple[str, int, float, float]]:
    """All runs: structure, number of the record, azimuth, level; level by level, so that all are known coarsely first."""
    return [
        (label, record, azimuth, level)
        for level, record, azimuth, label in itertools.product(levels, range(len(records)), AZIMUTHS, labels)
    ]


def row_of(structure: SpatialAssembly, motion: Motion, model: DistinctElement3D) -> dict[str, Any]:
    """One run: how many of its columns lost a drum, how many architraves fell, when the first of all did."""
    response = simulate(structure, motion, model, tail=TAIL)
    measures = response.measures
    assert measures.blocks is not None
    fell = dict(measures.blocks.fell_at)
    columns = {stone.name.partition(",")[0] for stone in structure.stones if ", drum" in stone.name}
    return {
        "outcome": measures.outcome.label,
        "failed": measures.outcome.label == "failed",
        "reason": measures.reason,
        "decided": measures.decided,
        "at_rest": measures.blocks.at_rest,
        "columns": len(columns),
        "columns_fallen": len({name.partition(",")[0] for name in fell if ", drum" in name}),
        "architraves_fallen": sum(", drum" not in name for name in fell),
        "bodies_fallen": len(fell),
        "first_fall_s": min(fell.values(), default=None),
        "energy_imbalance": float(measures.energy_imbalance),
        "peak_displacement_m": float(measures.blocks.peak_displacement),
    }


def run(
    records: Sequence[Motion],
    levels: Sequence[float] = LEVELS,
    *,
    model: DistinctElement3D = MODEL,
    threads: int | None = None,
    progress: Progress | None = None,
    ledger: Path | None = None,
) -> Any:
    """All runs as a table; resumes from its ledger.

    Raises
    ------
    Stopped
        It was interrupted; what is finished is in the ledger.
    """
    import pandas

    built, measure = structures(), parse_measure(MEASURE)
    whole = [prepared(record) for record in records]
    size = [measure.of(record) for record in whole]
    todo = cases_of(whole, levels)

    def motion(number: int) -> Motion:
        _, record, azimuth, level = todo[number]
        return directed(whole[record], azimuth).scaled(level / size[record])

    hasher = Hasher(model, TAIL)
    digests = [
        hasher.of_product([built[label].digest, whole[record].digest, azimuth, level], __file__)
        for label, record, azimuth, level in todo
    ]
    rows: dict[int, dict[str, Any]] = {}
    cases = [Case(built[label], motion(number)) for number, (label, *_) in enumerate(todo)]
    request = Request(cases, Digests.of(digests), [(np.arange(len(todo)), model, run_options(TAIL))])

    def make(number: int) -> dict[str, Any]:
        return row_of(built[todo[number][0]], motion(number), model)

    try:
        with (
            closing(Runs(Campaign(ledger=ledger))) as runs,
            closing(runs.products(request, make, thread_count(threads))) as finished,
        ):
            for number, row in finished:
                rows[number] = row
                if progress:
                    progress(len(rows), len(todo))
    except KeyboardInterrupt:
        raise Stopped(len(rows), len(todo), ledger) from None
    return pandas.DataFrame(
        [
            {"structure": label, "record": whole[record].record, "azimuth_deg": azimuth, "pgv_m_s": level}
            | {"factor": level / size[record]}
            | {key: value for key, value in rows[number].items() if key != "case"}
            for number, (label, record, azimuth, level) in enumerate(todo)
        ]
    )
