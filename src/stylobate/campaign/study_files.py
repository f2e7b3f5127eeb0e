"""Study files (TOML) of columns × records × levels × models × realisations, as of ``stylobate study``."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from ..column.assembly_files import load_structure
from ..column.scatter import LARGEST, Scatter
from ..column.structure import Structure
from ..column.toml import Table, parse_toml, read_table
from ..constants import g
from ..errors import InputError, as_typed, check_whole, within
from ..models.base import Model
from ..models.registry import make_models
from ..motion import Motion, Suite, harmonic
from ..motion.intensity import IntensityMeasure, parse_measure
from ..motion.readers.source import PREFIX
from ..motion.request import MotionRequest
from ..motion.sequence import REST, in_sequence
from ..motion.specs import azimuth_range, parse_acceleration, parse_time, parse_velocity
from ..text_tables import printable
from .campaign import Campaign
from .cases import Study
from .grid import read_grid


class SequenceTable(Table):
    """``[[motions.sequences]]``: records one after another as one motion, a factor each if need be."""

    files: list[str]
    factors: list[float] | None = None
    rest: Any = REST
    repeat: int = 1
    name: str = ""


class MotionsTable(Table):
    """``[motions]``: records, or sequences of them, and the directions in which they act."""

    files: list[str] | None = None
    sequences: list[SequenceTable] | None = None
    unit: str | None = None
    columns: str | None = None
    components: str | None = None
    azimuths: Any = None
    signs: str = "+"
    condition: list[str] | None = None
    vertical: bool = True


class ScaleTable(Table):
    """``[scale]``: the sizes of every motion."""

    im: str = "factor"
    levels: Any


class ColumnScatterTable(Table):
    """How stones and joints may differ from what was surveyed: shares."""

    friction: float | None = None
    joint_stiffness: float | None = None
    density: float | None = None
    width: float | None = None
    height: float | None = None
    offset: float | None = None

    @property
    def scatter(self) -> Scatter | None:
        """All that is given, and nothing else varies; None where nothing is given."""
        sizes = {name: value for name in LARGEST if (value := getattr(self, name, None)) is not None}
        return Scatter(**(dict.fromkeys(LARGEST, 0.0) | sizes)) if sizes else None


class ScatterTable(ColumnScatterTable):
    """``[scatter]``: realisations of each column and how they differ."""

    realisations: int
    seed: int = 0
    stiffness_damping: float | None = None
    rolling_resistance: float | None = None
    law: float | None = None
    unknown_stiffness: float | None = None


class RunsTable(Table):
    """How runs are made: by which models, for how long, of which realisations."""

    name: str = ""
    model: str | None = None
    models: list[str] | None = None
    losses: str | None = None
    set: dict[str, Any] | None = None
    tail: Any = 0.0
    whole: bool = False
    scatter: ScatterTable | None = None

    def made_models(self, folder: Path) -> list[Model]:
        """The models with their parameters."""
        models = [*([self.model] if self.model else []), *(self.models or [])]
        settings = {key: str(value) for key, value in (self.set or {}).items()}
        if settings and len(models) > 1:
            raise InputError("[set] is for one model, and several are named; give each a study of its own.")
        losses = self.losses  # a name, or a file from the folder of the study on
        if losses is not None and (folder / losses).is_file():
            losses = str(folder / losses)
        return make_models([(model, settings) for model in models], losses)

    def made_campaign(self) -> Campaign:
        """Realisations, time after each motion and what of it is stepped."""
        drawn = {} if self.scatter is None else _twin_settings(self.scatter)
        return Campaign(**drawn, tail=_seconds(self.tail), whole=self.whole)


class StudyFile(RunsTable):
    """A study file."""

    column: str | None = None
    columns: list[str] | None = None
    keep: str = "rows"
    motions: MotionsTable
    scale: ScaleTable | None = None


def read_plan(path: str | Path) -> tuple[Study, dict[str, str]]:
    """Read a study file; paths in it start from its folder.

    A file with a harmonic grid (of ``stylobate domain``) is a study of harmonic motions.

    Returns
    -------
    study : Study
    refused : dict
        Records that could not be used, with the reason.

    Raises
    ------
    InputError
        The file cannot be read or describes no study; the message names the file and the remedy.
    """
    content = parse_toml(path)
    if "frequencies" in content or "amplitudes" in content:
        return _of_grid(path), {}
    if "motions" not in content:
        raise InputError(f"{printable(path)} names no record; add [motions] with files = [...].")
    table = read_table(path, StudyFile)
    with within(printable(path)):
        return _study(table, Path(path).parent)


def _study(table: StudyFile, folder: Path) -> tuple[Study, dict[str, str]]:
    names = [*([table.column] if table.column else []), *(table.columns or [])]
    models = table.made_models(folder)
    motions, refused = _motions(table.motions, folder)
    im, levels = (None, [1.0]) if table.scale is None else levels_of(table.scale.im, table.scale.levels)
    stands = [structure_beside(folder, name) for name in names]
    return Study(stands, motions, models, levels, im, keep=table.keep, campaign=table.made_campaign()), refused


def structure_beside(folder: Path, name: str) -> Structure:
    """What a file beside another one, or a preset, of that name describes."""
    return load_structure(folder / name if (folder / name).is_file() else name)


def _motions(table: MotionsTable, folder: Path) -> tuple[Sequence[Motion], dict[str, str]]:
    """Motions of a study: its records, then its sequences; and what could not be used, with the reason."""

    def expanded(patterns: Sequence[str]) -> Suite:
        return MotionRequest(
            files=tuple(listed(patterns, folder)),
            separate=True,
            unit=table.unit,
            columns=table.columns,
            component=_component(table.components),
            azimuths=_azimuths(table.azimuths),
            signs=table.signs,
            condition=tuple(table.condition or ()),
            vertical=table.vertical,
        ).expand()

    if not table.files and not table.sequences:
        raise InputError("the study names no record; give files = [...] in [motions], or [[motions.sequences]].")
    suite = expanded(table.files) if table.files else Suite((), {})
    motions = list(suite.motions)
    for number, sequence in enumerate(table.sequences or [], 1):
        with within(f"sequence {number} of [motions]"):
            motions += _in_sequence(sequence, [expanded([file]) for file in sequence.files])
    return motions, dict(suite.refused)


def _in_sequence(table: SequenceTable, parts: Sequence[Suite]) -> list[Motion]:
    """A sequence in each of the directions in which its records act; none of them is left out."""
    for part in parts:
        for name, reason in part.refused.items():
            raise InputError(f"{name} cannot be used: {reason}")
    sizes = table.factors or [1.0] * len(parts)
    if len(parts) == 1:
        parts = list(parts) * len(sizes)
    if len(sizes) != len(parts):
        raise InputError(f"{len(sizes)} factors are given for {len(parts)} files; give one for each.")
    if len({len(part.motions) for part in parts}) > 1:
        raise InputError(
            "each of its files must be one record, and have the same components and directions; name files."
        )
    rest = parse_time(table.rest, "rest") if isinstance(table.rest, str) else table.rest
    made: list[Motion] = []
    for motions in zip(*(part.motions for part in parts), strict=True):
        each = [motion if size == 1.0 else motion.scaled(size) for motion, size in zip(motions, sizes, strict=True)]
        made.append(in_sequence(each, rest, table.repeat))
    record = table.name or made[0].name
    for place, (motion, first) in enumerate(zip(made, parts[0].motions, strict=True)):
        known: dict[str, Any] = {"record": record}
        if "direction" in first.metadata:
            known["direction"] = {**first.metadata["direction"], "record": record}
        name = table.name and (table.name if len(made) == 1 else f"{table.name}, {first.name}")
        made[place] = motion.replace(name=name or motion.name, metadata={**motion.metadata, **known})
    return made


def _of_grid(path: str | Path) -> Study:
    grid = read_grid(path)
    motions = []
    units = [harmonic(float(frequency), 1.0, grid.duration) for frequency in grid.frequencies]
    for (frequency, unit), amplitude in product(zip(grid.frequencies, units), grid.amplitudes):
        name = f"{frequency:.4g} Hz, {amplitude / g:.4g} g"  # a motion of its own, no copy of a record
        motions.append(unit.replace(factor=unit.factor * float(amplitude), name=name))
    return Study([grid.column], motions, [grid.model], campaign=Campaign(tail=grid.tail))


def listed(patterns: Sequence[str], folder: Path, table: str = "[motions]", file: str = "study") -> list[str | Path]:
    """Files of records as a file names them: paths and patterns from its folder, and samples.

    Parameters
    ----------
    patterns : sequence of str
    folder : Path
    table, file : str
        What messages call the table, and the file that it stands in.
    """
    sources: list[str | Path] = []
    for pattern in patterns:
        if pattern.startswith(PREFIX):
            sources.append(pattern)
            continue
        if any(mark in pattern for mark in "*?["):
            matches: list[Path] = sorted(folder.glob(pattern)) if not Path(pattern).is_absolute() else [Path(pattern)]
            if not matches:
                raise InputError(
                    f"no file matches {pattern!r} in {table}; paths start from the folder of the {file} file."
                )
            sources += matches
        else:
            sources.append(folder / pattern)
    if not sources:
        raise InputError(f"the {file} names no record; give some in {table}.")
    return sources


def _component(component: str | None) -> str | None:
    return None if component in (None, "x") else component


def _azimuths(value: Any) -> tuple[float, ...]:
    if value is None:
        return ()
    text = value if isinstance(value, str) else ",".join(map(str, value)) if isinstance(value, list) else str(value)
    return tuple(azimuth_range(text).tolist())


def levels_of(im: str, given: Any) -> tuple[IntensityMeasure | None, list[float]]:
    """Intensity measure (None: factors) and levels of it, as typed: a list, one, or ``first:last:number``."""
    measure = None if im == "factor" else parse_measure(im)
    unit = "-" if measure is None else measure.unit
    if isinstance(given, str) and given.count(":") == 2:
        low, high, number = given.split(":")
        first, last = _level(low.strip(), unit), _level(high.strip(), unit)
        if not number.strip().isdecimal() or not 1 <= int(number) <= 10_000:
            raise InputError(
                f"levels are {as_typed(given)}; write them as first:last:number, such as 0.1m/s:1.0m/s:10."
            )
        return measure, np.linspace(first, last, int(number)).tolist()
    return measure, [_level(level, unit) for level in (given if isinstance(given, list) else [given])]


def _level(value: Any, unit: str) -> float:
    """A level with its unit as typed; in the unit of the measure."""
    if isinstance(value, str):
        if unit == "g":
            return parse_acceleration(value) / g
        if unit == "m/s":
            return parse_velocity(value)
        try:
            return float(value)
        except ValueError:
            raise InputError(f"level {as_typed(value)} is no number; write it as 1.5.") from None
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"level {as_typed(value)} is no number; write it as '0.2 {unit}'.")
    if unit in ("g", "m/s"):
        raise InputError(f"level {value:g} has no unit; write it as a text such as '{value:g}{unit}'.")
    return float(value)


def _twin_settings(table: ScatterTable) -> dict[str, Any]:
    """Fields of a campaign of a study's twins."""
    number = check_whole("realisations in [scatter]", table.realisations, 1)
    seed = check_whole("seed in [scatter]", table.seed, 0)
    return {"replicates": number, "scatter": table.scatter, "seed": seed}


def _seconds(value: Any) -> float:
    if isinstance(value, str):
        return parse_time(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"tail is {as_typed(value)}; write it with its unit, such as '5s'.")
    return float(value)
