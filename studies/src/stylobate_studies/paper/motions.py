"""The paper's columns under real motions, which it announces: all models under the same records, and in space."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.campaign import Progress
from stylobate.campaign.cases import Study
from stylobate.column.catalogue import PAPER
from stylobate.errors import LeftOutWarning
from stylobate.motion import Motion
from stylobate.probability.studies import StudyResult, run_study
from stylobate.verdicts import verdict as v

from .cases import DEM, MODELS, POPULATIONS, SPACE, TAIL, paper_column

#: Peak velocities along the records' x to which they are scaled [m/s].
LEVELS = (0.3, 0.6, 0.9)

#: A column rocks when its top moves by more than this [m].
ROCKS = 0.005

#: Models by what the table calls them; those of the plane leave what acts across it out.
COMPARED = {**MODELS, "distinct elements in space, both components": POPULATIONS[SPACE]}


def motions_piece(folder: Path, records: Sequence[Motion], threads: int, progress: Progress | None) -> StudyResult:
    """Both columns, round, by all models under records at all levels; resumes in its folder."""
    columns = [paper_column(name, "circular") for name in PAPER]
    study = Study(columns, records, list(COMPARED.values()), LEVELS, "pgv", tail=TAIL)
    folder.mkdir(exist_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LeftOutWarning)
        return run_study(study, folder, threads=threads, progress=progress)


def against(result: StudyResult, name: str, label: str) -> tuple[np.ndarray, np.ndarray]:
    """Whether a model's verdicts are those of distinct elements, where both have one; and ratios of peaks, where both rock
    and stand [-]."""
    mine, peaks = outcome_of(result, name, label)
    theirs, others = outcome_of(result, name, DEM)
    known = np.isin(mine, (v.STANDS, v.COLLAPSED)) & np.isin(theirs, (v.STANDS, v.COLLAPSED))
    both = (mine == v.STANDS) & (theirs == v.STANDS) & (peaks > ROCKS) & (others > ROCKS)
    return (mine == theirs)[known], peaks[both] / others[both]


def outcome_of(result: StudyResult, name: str, label: str) -> tuple[np.ndarray, np.ndarray]:
    """Verdicts and peak displacements of the top [m] of a column by a model, in the order of motions and levels."""
    shape = result.plan.shape
    model, column = list(COMPARED).index(label), PAPER.index(name)

    def part(values: Any) -> np.ndarray:
        return np.asarray(values).reshape(shape)[model, column].ravel()

    return part(result.verdicts), part(result.rows.floats("peak_top_displacement_m"))
