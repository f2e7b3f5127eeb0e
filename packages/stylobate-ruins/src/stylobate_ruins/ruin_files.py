"""Ruin files (TOML): columns as built, what is seen of them, and what may have shaken them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from stylobate.campaign.study_files import ColumnScatterTable, listed
from stylobate.column.assembly_files import load_structure
from stylobate.column.catalogue import PRESETS
from stylobate.column.joint import LAWS
from stylobate.column.scatter import LARGEST, Scatter
from stylobate.column.structure import Structure
from stylobate.column.toml import Table, read_table, words
from stylobate.constants import g
from stylobate.errors import InputError, as_typed, within
from stylobate.models.registry import make_model
from stylobate.motion import Motion
from stylobate.motion.request import MotionRequest
from stylobate.motion.specs import parse_acceleration, parse_angle, parse_time, parse_velocity
from stylobate.text_tables import printable

from .prior import LOSSES, Prior
from .ruin import DRAWN_OF_MODEL, STATES, USUAL_COUNT, Observed, Ruin, refuse_drawn
from .survival import Outlasted

#: Columns that are as surveyed: of a ``[prior.scatter]`` that names nothing.
AS_SURVEYED = Scatter(**dict.fromkeys(LARGEST, 0.0))


class ObservedTable(Table):
    """``[[observed]]``: what is seen of one column."""

    column: str
    state: Annotated[str, words(STATES)] = "unknown"
    fell_towards: Any = None
    towards_sd: Any = None
    offsets: list[list[int | float]] | None = None
    twists: list[list[int | float]] | None = None
    no_slip_above: float | None = None
    largest_slip: list[float] | None = None
    fell: list[str] | None = None
    stand: list[str] | None = None
    moved: list[list[Any]] | None = None


class PriorTable(Table):
    """``[prior]``: motions that may have been."""

    pgv: list[Any] | None = None
    pga: list[Any] | None = None
    period: list[Any] | None = None
    azimuth: list[Any] | None = None
    ellipticity: list[float] | None = None
    cycles: list[float] | None = None
    records: str | list[str] | None = None
    unit: str | None = None
    columns: str | None = None
    scale: list[float] | None = None
    law: list[str] | None = None
    stiffness_damping: list[Any] | None = None
    scatter: ColumnScatterTable | None = None
    unknown_stiffness: float | None = None


class SurvivalTable(Table):
    """``[survival]``: since when it has stood, and how often shaking comes."""

    hazard: str
    until: float
    since: float | list[float] | None = None
    since_sd: float = 0.0
    earthquake: float | list[float] | None = None
    earthquake_sd: float = 0.0
    site: list[float] | None = None


class RuinFile(Table):
    """A ruin file."""

    columns: list[str]
    observed: list[ObservedTable] | None = None
    prior: PriorTable
    survival: SurvivalTable | None = None
    simulations: int = USUAL_COUNT
    seed: int = 0
    model: str = "dem3d"
    set: dict[str, Any] | None = None


def read_ruin(path: str | Path) -> Ruin:
    """Read a ruin file; paths in it start from its folder.

    Raises
    ------
    InputError
        The file cannot be read, or describes no ruin; the message names the place and the remedy.
    """
    table, folder = read_table(path, RuinFile), Path(path).parent
    with within(printable(path)):
        structures = [load_structure(name if name in PRESETS else folder / name) for name in table.columns]
        observed = []
        for number, observation in enumerate(table.observed or [], 1):
            with within(f"[[observed]] number {number}", "observed", number):
                observed.append(_observed(observation, table.columns, structures))
        with within("[prior]", "prior"):
            prior = _prior(table.prior, folder)
        settings = {key: str(value) for key, value in (table.set or {}).items()}
        refuse_drawn([key for key in settings if key in DRAWN_OF_MODEL])
        model = make_model(table.model, settings)
        with within("[survival]", "survival"):
            survival = None if table.survival is None else _survival(table.survival, folder)
        return Ruin(structures, observed, prior, table.simulations, table.seed, model, survival)


def _observed(table: ObservedTable, files: Sequence[str], structures: Sequence[Structure]) -> Observed:
    """What is seen of a column, which is named by its file as the ruin lists it, or by its own name."""
    fields: dict[str, Any] = {name: getattr(table, name) for name in ("state", "no_slip_above", "largest_slip")}
    names = dict(zip(files, (structure.name for structure in structures), strict=True))
    names |= {Path(file).stem: name for file, name in names.items()}
    fields |= {name: tuple(getattr(table, name) or ()) for name in ("fell", "stand", "moved")}
    fields |= {
        "offsets": [tuple(row) for row in table.offsets or ()],
        "twists": [tuple(row) for row in table.twists or ()],
    }
    for name in ("fell_towards", "towards_sd"):
        value = getattr(table, name)
        fields[name] = None if value is None else _number(name, value, parse_angle)
    return Observed(names.get(table.column, table.column), **fields)


def _survival(table: SurvivalTable, folder: Path) -> Outlasted:
    given: dict[str, Any] = {
        name: tuple(value) if isinstance(value := getattr(table, name), list) else value
        for name in SurvivalTable.model_fields
    }
    given |= {"hazard": folder / table.hazard}
    return Outlasted(**given)


def _prior(table: PriorTable, folder: Path) -> Prior:
    plain = ("ellipticity", "cycles", "scale", "unknown_stiffness")
    fields: dict[str, Any] = {name: getattr(table, name) for name in plain}
    units = {
        "pgv": parse_velocity,
        "pga": lambda text: parse_acceleration(text) / g,
        "period": parse_time,
        "azimuth": parse_angle,
    }
    for name, parse in units.items():
        given = getattr(table, name)
        fields[name] = None if given is None else [_number(name, value, parse) for value in given]
    for name in ("ellipticity", "cycles", "scale", *units):
        fields[name] = None if fields[name] is None else tuple(fields[name])
    damping = table.stiffness_damping
    losses = LOSSES if damping is None else [_number("stiffness_damping", value, parse_time) for value in damping]
    scatter = None if table.scatter is None else table.scatter.scatter or AS_SURVEYED
    for name in ("unit", "columns"):
        if getattr(table, name) is not None and not table.records:
            raise InputError(f"`{name}` is for records, and none are given; leave it out.", name)
    records = _records(table, folder) if table.records is not None else ()
    return Prior(**fields, records=records, law=table.law or LAWS, stiffness_damping=losses, scatter=scatter)


def _records(table: PriorTable, folder: Path) -> Sequence[Motion]:
    """Records of a file, a folder, or several of them; what cannot be read is refused, not left out."""
    patterns = [table.records] if isinstance(table.records, str) else list(table.records or ())
    files = tuple(listed(patterns, folder, "[prior]", "ruin"))
    suite = MotionRequest(files=files, separate=True, unit=table.unit, columns=table.columns).expand()
    for name, reason in suite.refused.items():
        raise InputError(f"{name} cannot be used: {reason}", "records")
    return suite.motions


def _number(name: str, value: Any, parse: Any) -> float:
    """A number in the unit that is meant, or a text with its own."""
    if isinstance(value, str):
        with within("", name):
            return float(parse(value))
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"`{name}` is {as_typed(value)}; allowed are numbers, or texts with a unit.", name)
    return float(value)
