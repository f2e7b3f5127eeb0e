"""Study files (TOML): a column, a model and the grid of a domain, so that a campaign can be repeated by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..column import Column
from ..column.files import load_column
from ..column.toml import Table, parse_toml, read_table
from ..errors import InputError, as_typed, check_range
from ..models.base import Model
from ..models.registry import make_model
from ..motion.ranges import amplitude_range, frequency_range
from ..motion.specs import parse_acceleration, parse_frequency
from ..reading import shown


class StudyTable(Table):
    """A study file."""

    column: str
    model: str
    frequencies: Any  # a range as a text, or a list of values
    amplitudes: Any
    duration: float = 10.0
    tail: float = 0.0
    set: dict[str, Any] | None = None


@dataclass(frozen=True, eq=False)
class Study:
    """What a study file asks for.

    Parameters
    ----------
    column : Column
    model : Model
    frequencies : array
        [Hz]
    amplitudes : array
        [m/s²]
    duration, tail : float
        Length of each motion, and time to go on after it [s].
    """

    column: Column
    model: Model
    frequencies: np.ndarray
    amplitudes: np.ndarray
    duration: float = 10.0
    tail: float = 0.0


def is_study(path: str | Path) -> bool:
    """Whether a TOML file is a study, not a column: it names a column, a model or a grid."""
    return not {"column", "model", "frequencies", "amplitudes"}.isdisjoint(parse_toml(path))


def read_study(path: str | Path) -> Study:
    """Read a study file; the path of a column file in it starts from the study file's folder.

    Raises
    ------
    InputError
        The file cannot be read or does not describe a study; the message names the file, the key and the remedy.
    """
    table = read_table(path, StudyTable)
    beside = Path(path).parent / table.column
    settings = {key: str(value) for key, value in (table.set or {}).items()}
    try:
        return Study(
            column=load_column(beside if beside.is_file() else table.column),
            model=make_model(table.model, settings),
            frequencies=_values("frequencies", table.frequencies, frequency_range, parse_frequency, unit="Hz"),
            amplitudes=_values("amplitudes", table.amplitudes, amplitude_range, parse_acceleration, unit=None),
            duration=check_range("duration", table.duration, 0.0, 1e4, unit="s", open_low=True),
            tail=check_range("tail", table.tail, 0.0, 1e4, unit="s"),
        )
    except InputError as error:
        raise InputError(f"{shown(path)}: {error}") from None


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
    for one in given:
        if isinstance(one, str):
            values.append(parse(one))
        elif isinstance(one, bool) or not isinstance(one, (int, float)):
            raise InputError(
                f"one of the {name} is {as_typed(one)}; it must be a number, or a text with a number and its unit."
            )
        elif unit is None:
            raise InputError(f"one of the {name} is {one:g}, without a unit; write it as a text such as '0.3g'.")
        else:
            values.append(float(one))
    return np.array(values)
