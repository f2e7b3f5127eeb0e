"""Cells of a domain while it is computed: read from the command's ledger, and from its table in the end."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from ..analysis.verdicts import verdict
from ..campaign.ledger import RUNS_FILE, asked_in, rows_in
from .asked import RESULT


def new_cells(folder: Path, known: set[int]) -> list[list[Any]]:
    """Cells of a job that are finished and were not known: number, verdict, peak top displacement [m].

    Parameters
    ----------
    folder : Path
        Of the job.
    known : set of int
        Numbers of the cells that the caller has; what is returned is added to it.
    """
    table = folder / RESULT / "domain.csv"
    found = _in_table(table) if table.is_file() else _in_ledger(folder / RESULT / RUNS_FILE, known)
    new = [one for one in found if one[0] not in known]
    known.update(one[0] for one in new)
    return new


def _in_table(path: Path) -> Iterator[list[Any]]:
    with suppress(OSError, ValueError, KeyError), path.open(encoding="utf-8", newline="") as file:
        for number, row in enumerate(csv.DictReader(file)):
            yield [number, row["verdict"], _number(row["peak_top_displacement_m"])]


def _in_ledger(path: Path, known: set[int]) -> Iterator[list[Any]]:
    asked = np.frombuffer(asked_in(path), dtype=np.int64).tolist()
    cells = {number: cell for cell, number in enumerate(asked) if cell not in known}
    for number, row in rows_in(path, cells.__contains__):
        yield [cells[number], verdict(row), _number(row.get("peak_top_displacement_m"))]


def _number(value: Any) -> float | None:
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return round(number, 5) if abs(number) < 1e6 else None
