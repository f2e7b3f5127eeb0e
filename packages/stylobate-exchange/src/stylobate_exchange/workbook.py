"""Workbooks of spreadsheets as rows of cells: the one sheet that holds something, and nothing of it left out unseen."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from stylobate.errors import InputError

if TYPE_CHECKING:
    from openpyxl.worksheet.worksheet import Worksheet

#: A cell of a sheet, which may be one of several that are merged.
Cell = Any

#: Endings of workbooks that are read.
WORKBOOKS = (".xlsx", ".xlsm")

#: Most cells of the smallest rectangle around all that a sheet holds.
MOST_CELLS = 500_000


def rows_of_workbook(content: bytes, name: str) -> list[list[str]]:
    """Cells of the only sheet that holds something, a list for each row, as text; of formulas what they came to.

    Raises
    ------
    InputError
        There are several such sheets; a cell has failed, or has no value yet; rows or columns that hold something are
        hidden; cells are merged over what is no single row and column.
    """
    try:
        from openpyxl import load_workbook
    except ImportError:
        raise InputError(
            f"{name} is the workbook of a spreadsheet, and openpyxl, which reads them, is not installed; install "
            "stylobate-exchange[spreadsheet], or save the survey as CSV (UTF-8)."
        ) from None
    try:
        found, written = (load_workbook(io.BytesIO(content), data_only=values).worksheets for values in (True, False))
    except Exception as error:  # openpyxl raises whatever its parts do
        raise InputError(
            f"{name} is no workbook of a spreadsheet ({type(error).__name__}); save the survey as CSV (UTF-8)."
        ) from None
    for values, formulas in zip(found, written, strict=True):
        for cell in cells_of(formulas):
            _check_formula(cell, values[cell.coordinate], name)
    full = [sheet for sheet in found if any(cell.value is not None for cell in cells_of(sheet))]
    if len(full) > 1:
        raise InputError(
            f"{name} has {len(full)} sheets that hold something ({', '.join(repr(sheet.title) for sheet in full)}); leave "
            "the survey alone in it, or save its sheet as CSV (UTF-8)."
        )
    return _rows(full[0], name) if full else []


def cells_of(sheet: Worksheet) -> Iterator[Cell]:
    """Cells that are in the file: a sheet makes all others between them when its rows are asked for."""
    yield from sheet._cells.values()


def _check_formula(cell: Cell, value: Cell, name: str) -> None:
    """Refuse a cell that has failed, or whose formula has come to nothing yet; one that has come to no text has."""
    if value.data_type == "e":
        raise InputError(
            f"{name} has {str(value.value)!r} in {value.coordinate}, where a formula of the spreadsheet has failed; mend it "
            "there."
        )
    if cell.data_type == "f" and value.value is None and value.data_type not in ("s", "str"):
        raise InputError(
            f"{name} has a formula without a value in {cell.coordinate}; open it in the spreadsheet, and save it again."
        )


def _rows(sheet: Worksheet, name: str) -> list[list[str]]:
    held = {(cell.row, cell.column): str(cell.value) for cell in cells_of(sheet) if cell.value is not None}
    rows, columns = (range(min(places), max(places) + 1) for places in zip(*held, strict=True))
    if len(rows) * len(columns) > MOST_CELLS:
        raise InputError(
            f"{name} has cells in {len(rows)} rows and {len(columns)} columns; a survey is smaller: leave the survey alone "
            "in it."
        )
    hidden_columns = [range(one.min or 0, (one.max or 0) + 1) for one in sheet.column_dimensions.values() if one.hidden]
    for row, column in held:
        if sheet.row_dimensions[row].hidden or any(column in some for some in hidden_columns):
            place = sheet.cell(row, column).coordinate
            raise InputError(f"{name} holds something in {place}, which is hidden; show it, or delete it.")
    for merged in sheet.merged_cells.ranges:
        # a title over a whole row is alone in it; any other cell would count for the first of its rows and columns only
        alone = merged.min_row == merged.max_row and sum(row == merged.min_row for row, _ in held) == 1
        if (merged.min_row, merged.min_col) in held and not alone:
            raise InputError(f"{name} has merged cells in {merged.coord}; undo that, and fill in every one of them.")
    return [[held.get((row, column), "") for column in columns] for row in rows]
