"""Cells of a domain while it is computed: read from the command's ledger, and from its table in the end."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from stylobate.analysis.verdicts import verdict
from stylobate.campaign.grid import read_grid
from stylobate.campaign.ledger import RUNS_FILE, rows_in

from .asked import RESULT, STUDY


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
    found = _in_table(table) if table.is_file() else _in_ledger(folder, known)
    new = [one for one in found if one[0] not in known]
    known.update(one[0] for one in new)
    return new


def _in_table(path: Path) -> Iterator[list[Any]]:
    with suppress(OSError, ValueError, KeyError), path.open(encoding="utf-8", newline="") as file:
        for number, row in enumerate(csv.DictReader(file)):
            yield [number, row["verdict"], _number(row["peak_top_displacement_m"])]


def _in_ledger(folder: Path, known: set[int]) -> Iterator[list[Any]]:
    ledger = folder / RESULT / RUNS_FILE
    if ledger.is_file() and (folder / STUDY).is_file():
        cells = {number: cell for cell, number in enumerate(_numbers(folder / STUDY)) if cell not in known}
        for number, row in rows_in(ledger, cells.__contains__):
            yield [cells[number], verdict(row), _number(row.get("peak_top_displacement_m"))]


@lru_cache(maxsize=16)
def _numbers(study: Path) -> list[int]:
    """Numbers of the cells of a study in its ledger; the study of a job does not change."""
    return read_grid(study).request().digests.keys.tolist()


def _number(value: Any) -> float | None:
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return round(number, 5) if abs(number) < 1e6 else None
