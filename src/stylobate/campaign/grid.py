"""A grid of harmonic motions, the request of a domain, and its file (TOML), so that it can be repeated by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..column import Column
from ..column.files import load_column
from ..column.structure import Structure
from ..column.toml import Table, parse_toml, read_table
from ..errors import InputError, as_typed, check_kind, check_range, within
from ..models.base import Case, Cases, Model
from ..models.registry import make_models
from ..motion import harmonic
from ..motion.specs import amplitude_range, frequency_range, parse_acceleration, parse_frequency
from ..text_tables import printable
from .campaign import DECIDED
from .digests import Hasher
from .runs import Request

#: Largest number of cells.
MAX_CELLS = 1_000_000


class GridTable(Table):
    """A study file of a grid."""

    column: str
    model: str
    frequencies: Any  # a range as a text, or a list of values
    amplitudes: Any
    duration: float = 10.0
    tail: float = 0.0
    losses: str | None = None
    set: dict[str, Any] | None = None


@dataclass(frozen=True, eq=False)
class HarmonicGrid:
    """A column under harmonic motions of all frequencies and amplitudes.

    Parameters
    ----------
    column : Column
    model : Model
    frequencies : array
        [Hz], shape (F,), rising.
    amplitudes : array
        [m/s²], shape (A,), rising.
    duration, tail : float
        Length of each motion, and time to go on after it [s].

    Raises
    ------
    InputError
        An impossible grid.
    """

    column: Column
    model: Model
    frequencies: np.ndarray
    amplitudes: np.ndarray
    duration: float = 10.0
    tail: float = 0.0

    def __post_init__(self) -> None:
        check_kind("column", self.column, Structure)
        check_kind("model", self.model, Model)
        if self.column.stack is None:
            raise InputError(
                f"column is {self.column.name!r}, which is {self.column.described}; allowed is a Column: run a study of "
                "harmonic motions instead."
            )
        f = grid_axis("frequencies", self.frequencies, 1e-3, 1e3, "Hz")
        a = grid_axis("amplitudes", self.amplitudes, 0.0, 1e4, "m/s²")
        if len(f) * len(a) > MAX_CELLS:
            raise InputError(f"the domain has {len(f)} × {len(a)} cells; allowed is up to {MAX_CELLS}: give fewer.")
        object.__setattr__(self, "frequencies", f)
        object.__setattr__(self, "amplitudes", a)

    def request(self) -> Request:
        """Its cases, frequency by frequency; motions of one frequency share their samples."""
        a = self.amplitudes
        units = [harmonic(float(frequency), 1.0, self.duration) for frequency in self.frequencies]

        def case(cell: int) -> Case:
            return Case(self.column, units[cell // len(a)].scaled(float(a[cell % len(a)])))

        return Request.of(Cases(len(units) * len(a), case), Hasher(self.model, replace(DECIDED, tail=self.tail)))


def is_grid(path: str | Path) -> bool:
    """Whether a TOML file is a study of a grid, not a column: it names a column, a model or a grid."""
    return not {"column", "model", "frequencies", "amplitudes"}.isdisjoint(parse_toml(path))


def read_grid(path: str | Path) -> HarmonicGrid:
    """Read a study file of a grid; the path of a column file in it starts from the study file's folder.

    Raises
    ------
    InputError
        The file cannot be read or does not describe a study; the message names the file, the key and the remedy.
    """
    table = read_table(path, GridTable)
    beside = Path(path).parent / table.column
    settings = {key: str(value) for key, value in (table.set or {}).items()}
    with within(printable(path)):
        return HarmonicGrid(
            column=load_column(beside if beside.is_file() else table.column),
            model=make_models([(table.model, settings)], table.losses)[0],
            frequencies=_values("frequencies", table.frequencies, frequency_range, parse_frequency, unit="Hz"),
            amplitudes=_values("amplitudes", table.amplitudes, amplitude_range, parse_acceleration, unit=None),
            duration=check_range("duration", table.duration, 0.0, 1e4, unit="s", open_low=True),
            tail=check_range("tail", table.tail, 0.0, 1e4, unit="s"),
        )


def grid_axis(name: str, values: Sequence[float] | np.ndarray, low: float, high: float, unit: str) -> np.ndarray:
    """One side of a grid, checked: finite, inside (low, high], rising; shape (values,)."""
    try:
        axis = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} are not an array of numbers; give them in {unit}.", name) from None
    if axis.ndim != 1 or axis.size == 0:
        raise InputError(f"{name} have the shape {axis.shape}; give at least one value in one row [{unit}].", name)
    for value in axis:
        check_range(f"one of the {name}", value, low, high, unit=unit, open_low=True, field=name)
    if (np.diff(axis) <= 0.0).any():
        raise InputError(f"{name} must rise from value to value; sort them and leave doubles out.", name)
    return axis


def _values(
    name: str,
    given: Any,
    parse_range: Callable[[str], np.ndarray],
    parse: Callable[[str], float],
    unit: str | None,
) -> np.ndarray:
    if isinstance(given, str):
        return parse_range(given)
    if not isinstance(given, list):
        raise InputError(f"{name} is {as_typed(given)}; it must be a list, or a text such as first:last:number.")
    values = []
    for value in given:
        if isinstance(value, str):
            values.append(parse(value))
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            raise InputError(
                f"one of the {name} is {as_typed(value)}; it must be a number, or a text with a number and its unit."
            )
        elif unit is None:
            raise InputError(f"one of the {name} is {value:g}, without a unit; write it as a text such as '0.3g'.")
        else:
            values.append(float(value))
    return np.array(values)
