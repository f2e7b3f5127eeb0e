"""Shaking-table tests as a folder: what is computed and how it is scored, fixed beforehand; motions; what was measured."""

from __future__ import annotations

import csv
import hashlib
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np

from stylobate.campaign.campaign import Campaign
from stylobate.campaign.cases import Study
from stylobate.campaign.study_files import RunsTable, structure_beside
from stylobate.column.structure import Structure
from stylobate.column.toml import Table, read_table
from stylobate.errors import InputError, check_choice, check_range, within
from stylobate.models.base import Model
from stylobate.motion import Motion
from stylobate.motion.request import MotionRequest
from stylobate.response.measures import blank_row
from stylobate.text_tables import SETTINGS, printable, read_bytes

#: The file that makes a folder one of tests.
FILE = "experiment.toml"

#: Most bytes of a table of tests or of a measured history.
LARGEST = 50_000_000

#: Columns of the table of tests besides what was measured.
COLUMNS = ("test", "structure", "motion", "unit", "scale", "azimuth", "history")

#: Measure of whether all fell.
COLLAPSED = "collapsed"

#: What is compared, and the range of its tolerance.
SCORES = {"share": (0.0, 1.0), "median": (1.0, 100.0), "distribution": (0.0, 1.0)}


class ScoreTable(Table):
    """``[[scores]]``: what is compared, and how far apart it may be."""

    measure: str
    score: Literal["share", "median", "distribution"]
    tolerance: float


class MotionTable(Table):
    """``[motions]``: what holds for all records."""

    unit: str | None = None
    condition: list[str] | None = None
    vertical: bool = True


class ExperimentFile(RunsTable):
    """``experiment.toml``."""

    fixed: date
    source: str = ""
    structure: str = ""
    tests: str = "tests.csv"
    motions: MotionTable = MotionTable()
    scores: list[ScoreTable]


@dataclass(frozen=True, eq=False)
class Test:
    """One test: its name, the name of what stood, the motion, and by measure what was measured; NaN where nothing was."""

    name: str
    structure: str
    motion: Motion
    measured: Mapping[str, float]


@dataclass
class Measured:
    """Tests of a folder, and what was fixed before any was computed.

    Parameters
    ----------
    name : str
    file : ExperimentFile
    digest : str
        SHA-256 of all that was fixed: ``experiment.toml`` and the files of what stood.
    structures : dict
        What stood, by name.
    model : Model
    campaign : Campaign
    tests : list of Test
    refused : list of str
        What cannot be used, and why.
    """

    name: str
    file: ExperimentFile
    digest: str
    structures: dict[str, Structure]
    model: Model
    campaign: Campaign
    tests: list[Test] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)

    def studies(self) -> list[tuple[list[Test], Study]]:
        """The tests of each structure, and the study that computes them."""
        pairs = []
        for name, structure in self.structures.items():
            if mine := [test for test in self.tests if test.structure == name]:
                motions = [test.motion for test in mine]
                pairs.append((mine, Study([structure], motions, [self.model], campaign=self.campaign)))
        return pairs

    @property
    def fixed(self) -> dict[str, Any]:
        """What was fixed beforehand, for the answer."""
        file, scatter = self.file, self.campaign.scatter
        return {
            "on": file.fixed.isoformat(),
            "digest": self.digest,
            "source": file.source,
            "model": self.model.name,
            "parameters": self.model.parameters(),
            "realisations": self.campaign.replicates,
            "scatter": "that of the structure" if scatter is None else scatter.describe(),
            "seed": self.campaign.seed,
            "tail_s": self.campaign.tail,
            "scores": [score.model_dump() for score in file.scores],
        }


def read_measured(folder: Path) -> Measured:
    """Read ``experiment.toml`` of a folder and the files that it names.

    Raises
    ------
    InputError
        What was fixed cannot be read. Single tests that cannot be used are refused in the result.
    """
    path = folder / FILE
    file = read_table(path, ExperimentFile)
    with within(printable(path)):
        name = file.name or folder.resolve().name
        if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*", name):
            raise InputError(f"name is {name!r}; allowed are letters, digits, - and _, as files are called after it.")
        if file.fixed > date.today():
            raise InputError(f"fixed is {file.fixed}, a day to come; give the day when all of this was fixed.")
        models = file.made_models(folder)
        if len(models) != 1:
            raise InputError("tests are compared with one model; give its name as model.")
        for score in file.scores:
            low, high = SCORES[score.score]
            check_range("tolerance", score.tolerance, low, high, open_low=True)
            if (score.score == "share") != (score.measure == COLLAPSED):
                raise InputError(f"{score.score} of {score.measure} is no score; a share is one of {COLLAPSED}.")
        if not file.scores:
            raise InputError("no score is fixed; add [[scores]] with measure, score and tolerance.")
        seal = hashlib.sha256(read_bytes(path, SETTINGS))
        experiment = Measured(name, file, "", {}, models[0], file.made_campaign())
        _read_tests(folder, experiment)
        for called, structure in experiment.structures.items():
            seal.update(f"{called} {structure.digest}".encode())
            known = _measures(structure, experiment.model)
            for score in file.scores:
                check_choice("measure", score.measure, known, of=f"a run of {structure.name}")
        experiment.digest = seal.hexdigest()
    return experiment


def _measures(structure: Structure, model: Model) -> list[str]:
    """Names of what a run of a structure measures as one number, of each body of an assembly too."""
    blocks = structure.base_width is None
    row = blank_row(space="y" in model.axes, blocks=blocks)
    names = [name for name in row if name.startswith(("peak_", "residual_")) and not isinstance(row[name], list)]
    each = ("peak_tilt_rad", "residual_displacement_m")
    bodies = [body.name for body in structure.bodies if not body.fixed] if blocks else []
    return [COLLAPSED, *names, *(f"{body}.{name}" for body in bodies for name in each)]


def csv_rows(path: Path) -> list[dict[str, str]]:
    """Rows of a CSV file by the names in its first line.

    Raises
    ------
    InputError
        It cannot be read.
    """
    try:
        return list(csv.DictReader(read_bytes(path, LARGEST).decode("utf-8-sig").splitlines()))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{printable(path)} cannot be read as a table ({error}).") from None


def _read_tests(folder: Path, experiment: Measured) -> None:
    rows, wanted = csv_rows(folder / experiment.file.tests), {score.measure for score in experiment.file.scores}
    if not rows:
        raise InputError(f"{experiment.file.tests} holds no test; give a row for each.")
    known, given = {*COLUMNS, COLLAPSED, *wanted}, [name for name in rows[0] if name]
    for name in given:
        if name not in known and not name.startswith("note"):
            remedy = "what a score is of, or note… for anything else"
            raise InputError(
                f"{experiment.file.tests} has the column {name!r}; known are {', '.join(sorted(known))}: {remedy}."
            )
    seen: set[str] = set()
    for number, row in enumerate(rows, 1):
        name = (row.get("test") or str(number)).strip()
        try:
            if name in seen:
                raise InputError("another row has this name")
            seen.add(name)
            experiment.tests.append(_test(folder, experiment, name, row, wanted))
        except InputError as error:
            experiment.refused.append(f"test {name} of {experiment.name}: {str(error).rstrip('.')}")


def _test(folder: Path, experiment: Measured, name: str, row: Mapping[str, str | None], wanted: set[str]) -> Test:
    if None in row or any(value is None for value in row.values()):
        raise InputError("its row has not as many cells as the first line")
    cell = {key: str(value).strip() for key, value in row.items()}
    stood = cell.get("structure") or experiment.file.structure
    if not stood:
        raise InputError("nothing says what stood; give structure in the table of tests or in experiment.toml")
    if stood not in experiment.structures:
        experiment.structures[stood] = structure_beside(folder, stood)
    fixed, number = experiment.file.motions, partial(_number, cell)
    azimuth = number("azimuth")
    motion = MotionRequest(
        files=tuple(folder / file.strip() for file in cell.get("motion", "").split(";") if file.strip()),
        unit=cell.get("unit") or fixed.unit,
        azimuths=() if math.isnan(azimuth) else (azimuth,),
        scale=None if math.isnan(scale := number("scale")) else scale,
        condition=tuple(fixed.condition or ()),
        vertical=fixed.vertical,
    ).motion()
    measured = {measure: number(measure) for measure in wanted | {COLLAPSED}}
    fell = measured[COLLAPSED]
    if not (math.isnan(fell) or fell in (0.0, 1.0)):
        raise InputError(f"{COLLAPSED} is {cell[COLLAPSED]}; allowed are 0 and 1")
    if cell.get("history"):
        history = _history(folder / cell["history"])
        for measure in wanted:
            if math.isnan(measured[measure]):
                measured[measure] = _of_history(history, measure)
    if fell == 1.0:  # what fell exceeds every size
        measured |= dict.fromkeys(wanted - {COLLAPSED}, math.inf)
    return Test(name, stood, motion.replace(name=f"test {name}"), measured)


def _number(cell: Mapping[str, str], key: str) -> float:
    """The number under a column; NaN where there is none."""
    if not (text := cell.get(key, "")):
        return math.nan
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{key} is {text!r}, which is no finite number")
    return value


def _history(path: Path) -> dict[str, np.ndarray]:
    """Columns of a measured history, ``time_s`` among them."""
    rows = csv_rows(path)
    try:
        columns = {name: np.array([float(row[name]) for row in rows]) for name in (rows[0] if rows else ()) if name}
    except (TypeError, ValueError):
        raise InputError(f"{printable(path)} holds what is no number") from None
    time = columns.get("time_s", np.zeros(0))
    if (
        len(time) < 2
        or not (np.diff(time) > 0.0).all()
        or not all(np.isfinite(values).all() for values in columns.values())
    ):
        raise InputError(f"{printable(path)} has no time_s that grows, or numbers that are not finite")
    return columns


def _of_history(history: Mapping[str, np.ndarray], measure: str) -> float:
    """A peak or residual from the history of the same name, from its first value; NaN where there is none."""
    *body, name = measure.rsplit(".", 1)
    kind, _, of = name.partition("_")
    samples = history.get(".".join([*body, of]))
    if samples is None:
        return math.nan
    moved = np.abs(samples - samples[0])
    return float(moved[-1] if kind == "residual" else moved.max())
