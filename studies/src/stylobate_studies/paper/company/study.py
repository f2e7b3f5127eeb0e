"""The study: four structures of the same columns under the same records at the same levels, and what falls of each."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.campaign import Progress
from stylobate.campaign.cases import Study
from stylobate.column.assembly_files import read_assembly
from stylobate.column.spatial.assembly import SpatialAssembly
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.motion import Motion
from stylobate.motion.orientation import rotated
from stylobate.probability.studies import StudyResult, run_study
from stylobate.verdicts.verdict import FAILED, UNDECIDED

#: Files of the structures beside this one; all are made of ``column.toml``. The first is what the others are compared with.
STRUCTURES = ("alone", "two", "four", "corner")

#: Directions in which every record shakes: its x along the row, and across it [degrees].
AZIMUTHS = (0.0, 90.0)

#: Measure to which records are scaled, the larger one of all directions, and its levels [m/s].
MEASURE, LEVELS = "pgv@rotd100", (0.4, 0.6, 0.8)

#: What shakes along one line shakes across it by so much as well: nothing is that straight [-].
ACROSS = 0.01

#: Between the two ends of what is plausible of stone, where the fewest runs are left rocking.
MODEL = DistinctElement3D(stiffness_damping=1e-4)


@cache
def structures() -> tuple[SpatialAssembly, ...]:
    """The structures of the study."""
    read: list[Any] = [read_assembly(Path(__file__).with_name(f"{name}.toml")) for name in STRUCTURES]
    return tuple(read)


def directed(record: Motion, azimuth: float) -> Motion:
    """A record turned as a whole about the vertical, from its x towards y [degrees]; along a line it shakes across, too."""
    whole = record if record.y_samples is not None else record.replace(ay=ACROSS * record.samples)
    bare = whole.replace(metadata={key: value for key, value in whole.metadata.items() if key != "azimuths"})
    return rotated(bare, azimuth)


def study_of(records: Sequence[Motion], levels: Sequence[float] = LEVELS) -> Study:
    """All structures under all records in both directions at all levels."""
    motions = [directed(record, azimuth) for record in records for azimuth in AZIMUTHS]
    return Study(structures(), motions, (MODEL,), levels, MEASURE)


def falls(result: StudyResult) -> Any:
    """A row per finished run: what it is, its verdict, how many columns lost a drum, and how many bodies fell.

    Returns
    -------
    pandas.DataFrame
        With ``structure``, ``record``, ``azimuth_deg``, ``pgv_m_s``, ``failed``, ``open`` (nothing has fallen, and not all
        lies still), ``at_rest``, ``columns``, ``columns_fallen`` and ``bodies_fallen``.
    """
    import pandas

    table = result.table
    down = [
        [name for name, body in (bodies or {}).items() if body["fell_at_s"] is not None] for bodies in table["bodies"]
    ]
    columns = {
        structure.name: len({stone.name.partition(",")[0] for stone in structure.stones if ", drum" in stone.name})
        for structure in structures()
    }
    return pandas.DataFrame({"structure": table["column"], "pgv_m_s": table["im"]}).assign(
        record=table["record"],
        azimuth_deg=table["azimuth_deg"],
        failed=table["verdict"] == FAILED,
        open=table["verdict"] == UNDECIDED,
        at_rest=np.array(table["at_rest"], dtype=bool),
        columns=[columns[name] for name in table["column"]],
        columns_fallen=[len({name.partition(",")[0] for name in names if ", drum" in name}) for names in down],
        bodies_fallen=[len(names) for names in down],
    )


def company_piece(folder: Path, records: Sequence[Motion], threads: int, progress: Progress | None) -> Any:
    """A row per run of all structures under records, as :func:`falls` tells them; resumes in its folder."""
    folder.mkdir(exist_ok=True)
    return falls(run_study(study_of(records), folder, threads=threads, progress=progress))
