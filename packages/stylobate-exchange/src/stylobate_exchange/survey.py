"""Surveys of columns drum by drum as a table (CSV, or a workbook), to column files and back without loss."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.column import Column
from stylobate.column.files import tables_of
from stylobate.column.plausible import length_doubts
from stylobate.errors import InputError, suggest
from stylobate.text_tables import SETTINGS, printable, read_bytes, text_of

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
        sheets, written = (load_workbook(io.BytesIO(content), data_only=values).worksheets for values in (True, False))
    except Exception as error:  # openpyxl raises whatever its parts do
        raise InputError(
            f"{name} is no workbook of a spreadsheet ({type(error).__name__}); save the survey as CSV (UTF-8)."
        ) from None
    for values, formulas in zip(sheets, written, strict=True):
        for cell in cells_of(formulas):
            _check_formula(cell, values[cell.coordinate], name)
    full = [sheet for sheet in sheets if any(cell.value is not None for cell in cells_of(sheet))]
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
    texts = {(cell.row, cell.column): str(cell.value) for cell in cells_of(sheet) if cell.value is not None}
    rows, columns = (range(min(places), max(places) + 1) for places in zip(*texts, strict=True))
    if len(rows) * len(columns) > MOST_CELLS:
        raise InputError(
            f"{name} has cells in {len(rows)} rows and {len(columns)} columns; a survey is smaller: leave the survey alone "
            "in it."
        )
    hidden_columns = [
        range(dimension.min or 0, (dimension.max or 0) + 1)
        for dimension in sheet.column_dimensions.values()
        if dimension.hidden
    ]
    for row, column in texts:
        if sheet.row_dimensions[row].hidden or any(column in span for span in hidden_columns):
            place = sheet.cell(row, column).coordinate
            raise InputError(f"{name} holds something in {place}, which is hidden; show it, or delete it.")
    for merged in sheet.merged_cells.ranges:
        # a title over a whole row is alone in it; any other cell would count for the first of its rows and columns only
        alone = merged.min_row == merged.max_row and sum(row == merged.min_row for row, _ in texts) == 1
        if (merged.min_row, merged.min_col) in texts and not alone:
            raise InputError(f"{name} has merged cells in {merged.coord}; undo that, and fill in every one of them.")
    return [[texts.get((row, column), "") for column in columns] for row in rows]


# -- Surveys of columns drum by drum as a table (CSV, or a workbook), to column files and back without loss -----------


#: Columns that are lengths, and what they may be in [m].
LENGTHS = (
    *("height", "bottom_width", "top_width", "depth", "top_depth"),
    *("offset", "chip_left", "chip_right", "chip_front", "chip_back"),
)
UNITS = {"m": 1.0, "cm": 100.0, "mm": 1000.0}

#: Columns that are angles [degrees].
ANGLES = ("offset_azimuth", "tilt", "tilt_azimuth", "turn", "chip_azimuth")

#: The same as bearings, clockwise from north, and the azimuths that they make where north is stated [degrees].
BEARINGS = {"offset_bearing": "offset_azimuth", "tilt_bearing": "tilt_azimuth", "base_bearing": "base_azimuth"}

#: Columns of the joint under a drum, with their units.
JOINT = {
    "normal_stiffness": "n_m3",
    "shear_stiffness": "n_m3",
    "friction_angle": "deg",
    "friction_coefficient": "",
    "cohesion": "pa",
    "ring_width": "m",
}

#: What the surveyor has to say of a drum: a comment of the column file.
NOTE = "note"

#: What stands for a column that is left out, where columns are stated; and all names of columns.
IGNORED = "-"
DIRECTIONS = (*ANGLES, *list(BEARINGS)[:2])
NAMES = ("drum", "density", *LENGTHS, *DIRECTIONS, *JOINT, NOTE)

#: What spreadsheets show where a formula has failed.
FAILED_CELL = re.compile(r"#[A-Z0-9/_]+[!?]?|Err:\d+")

#: What spreadsheets leave around the text of a line.
BLANK = '";,\t\r\n '

#: What is said of the whole column, in lines ``# key: value`` above the table.
FACTS = ("name", "section", "material", "gravity", "north", "base_tilt", "base_azimuth", "base_bearing")

_SIZES = ("height", "bottom_width", "top_width", "depth", "top_depth", "density")


def survey_text(column: Column) -> str:
    """A survey of a column: a row a drum from the base up, lengths in m, angles in degrees, numbers to the last digit.

    Raises
    ------
    InputError
        The column has links, which a survey does not hold.
    """
    if column.links:
        raise InputError(
            f"{column.name!r} has {len(column.links)} {'link' if len(column.links) == 1 else 'links'}, and a survey holds "
            "drums and joints only; keep the column file."
        )
    as_found, table = column.as_found, tables_of(column)
    facts = {"name": column.name, "section": column.drums[0].section, "material": column.material}
    facts |= {"gravity": column.gravity, "north": column.north}
    facts |= {"base_tilt": as_found.base_tilt, "base_azimuth": as_found.base_azimuth}
    overrides = {override["index"]: override for override in table.get("joint_override", ())}
    rows = []
    for i, drum in enumerate(table["drum"], 1):
        joint = overrides.get(i, table["joint"])
        state = {key: value for key, value in vars(as_found.of(i)).items() if key != "drum" and value != 0.0}
        rows.append({"drum": i} | drum | state | {key: joint[key] for key in JOINT if key in joint})
    names = ["drum", *(key for key in (*_SIZES, *LENGTHS, *ANGLES, *JOINT) if any(key in row for row in rows))]
    names = list(dict.fromkeys(names))
    text = io.StringIO()
    for key, value in facts.items():
        if value is not None and (value or key == "north"):
            text.write(f"# {key}: {' '.join(str(value).split())}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([_header(name) for name in names])
    writer.writerows([["" if name not in row else repr(row[name]) for name in names] for row in rows])
    return text.getvalue()


def _header(name: str) -> str:
    unit = (
        "kg_m3" if name == "density" else "m" if name in LENGTHS else "deg" if name in ANGLES else JOINT.get(name, "")
    )
    return f"{name}_{unit}" if unit else name


def survey_tables(
    path: Path, stone: str | None = None, stated: str | None = None, north: float | None = None
) -> tuple[dict[str, Any], list[str]]:
    """Content of a column file of a survey, and what is said of it: its section if not stated, and of drums, "drum 3: …".

    Separated by commas, semicolons or tabs; decimal commas are read where commas do not separate. Of a workbook the one
    sheet that holds something, with the values that its formulas had when it was saved. The first row names the columns;
    lengths say their unit there (``height_mm``), which is m otherwise.

    Parameters
    ----------
    path : Path
    stone : str, optional
        Name of a material; that of the survey if left out.
    stated : str, optional
        What each column holds, where the row of names is not ours, such as
        ``drum, height [cm], bottom_width [cm], top_width [cm], -``.
    north : float, optional
        Bearing of the x axis, clockwise from north [degrees]; that of the survey if left out.

    Raises
    ------
    InputError
        What cannot be, in one sentence that names row and column.
    """
    name, content = printable(path), read_bytes(path, SETTINGS, "a survey is smaller")
    if path.suffix.lower() in WORKBOOKS:
        rows, separator = rows_of_workbook(content, name), ","
    else:
        rows, separator = _rows_of_text(text_of(content, name), name)
    facts, rows = _facts(rows, separator, name)
    if len(rows) < 2:
        raise InputError(f"{name} holds no row of a drum; give a row of names, and one for each drum from the base up.")
    # spreadsheets save columns that were formatted, or left free, as well
    free = {k for k in range(max(map(len, rows))) if not any(row[k].strip() for row in rows if k < len(row))}
    head, *rows = ([cell for k, cell in enumerate(row) if k not in free] for row in rows)
    decimal = "," if separator != "," else "."
    if stated is None:
        columns = _columns_of(head, rows, decimal, name)
    else:
        columns = _typed_columns(stated)
        if len(columns) != len(head):
            raise InputError(
                f"`columns` names {len(columns)} columns, {name} has {len(head)}; name each once, those to leave out -.",
                "columns",
            )
        if all(_is_number(cell, decimal) for cell, (key, _) in zip(head, columns) if key in LENGTHS):  # no row of names
            rows = [head, *rows]
    known = [key for key, _ in columns]
    double = next((key for key in known if known.count(key) > 1 and key != IGNORED), None)
    if double is not None:
        raise InputError(f"{name} has two columns of {double!r}; keep one.")
    missing = next((key for key in ("height", "bottom_width", "top_width") if key not in known), None)
    if missing is not None:
        raise InputError(f"{name} has no column {missing!r}; add it, such as {missing}_m.")
    read = [_row(row, columns, number, decimal, name) for number, row in enumerate(rows, 1)]
    if north is not None:
        facts["north"] = north
    for fields in (facts, *read):
        _turn_bearings(fields, facts.get("north"), name)
    numbers = [row.pop("drum", None) for row in read]
    if any(drum_number is not None for drum_number in numbers) and numbers != [
        float(i) for i in range(1, len(read) + 1)
    ]:
        raise InputError(
            f"{name} numbers its drums otherwise than 1, 2, 3 … from the base up; put the rows in that order."
        )
    doubts = length_doubts([row["height"] for row in read], [(row["bottom_width"], row["top_width"]) for row in read])
    if doubts:
        raise InputError(
            f"{doubts[0]} Lengths in {name} are in m unless the name of their column ends in _cm or _mm, such as height_cm."
        )
    notes = [] if "section" in facts else ["taken as round: no line `# section: rectangular` says otherwise"]
    notes += [f"drum {i}: {note}" for i, row in enumerate(rows, 1) if (note := _note(row, known))]
    return _tables(facts, read, stone, name), notes


def _rows_of_text(text: str, name: str) -> tuple[list[list[str]], str]:
    """Cells of every row of a table of text, and what separates them: what the row of names has most of."""
    lines = [line for line in text.splitlines() if not line.strip('";,\t ').startswith("#") and line.strip()]
    head, below = (*lines, "", "")[:2]
    separators = ";\t,"
    if any(separator in below for separator in separators) and not any(separator in head for separator in separators):
        raise InputError(
            f"{name} has a line {printable(head.strip())!r} above its table, which is no row of names; put a # before it."
        )
    separator = max(separators, key=head.count)
    try:
        return list(csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)), separator
    except csv.Error as error:
        raise InputError(f"{name} is no table: {error}; save the survey as CSV.") from None


def _note(row: list[str], columns: list[str]) -> str:
    """What a row says of its drum, in one line."""
    notes = [cell for cell, key in zip(row, columns) if key == NOTE]
    return " ".join("".join(character if character.isprintable() else " " for character in "".join(notes)).split())


def _tables(facts: dict[str, Any], rows: list[dict[str, float]], stone: str | None, name: str) -> dict[str, Any]:
    table: dict[str, Any] = {key: facts[key] for key in ("name", "material", "gravity", "north") if key in facts}
    table["section"] = facts.get("section", "circular")
    if stone is not None:
        table["material"] = stone
    if "material" not in table:
        short = next((key for key in ("density", "normal_stiffness", "shear_stiffness") if key not in rows[0]), None)
        if short is not None:
            raise InputError(
                f"{name} says nothing of its stone: it names no material and has no column {short!r}; name one, such as "
                "`material='marble'`.",
                "material",
            )
    table["drum"] = [{key: row[key] for key in _SIZES if key in row} for row in rows]
    joints = [{key: row[key] for key in JOINT if key in row} for row in rows]
    if joints[0] or "material" not in table:
        table["joint"] = joints[0]
    others = [{"index": i, **joint} for i, joint in enumerate(joints, 1) if joint != joints[0]]
    if others:
        table["joint_override"] = others
    states = [{key: row[key] for key in (*LENGTHS[5:], *ANGLES) if key in row} for row in rows]
    as_found: dict[str, Any] = {key: facts[key] for key in ("base_tilt", "base_azimuth") if key in facts}
    drums = [{"index": i, **state} for i, state in enumerate(states, 1) if any(state.values())]
    if drums:
        as_found["drum"] = drums
    return table | ({"as_found": as_found} if as_found else {})


def _turn_bearings(fields: dict[str, Any], north: float | None, name: str) -> None:
    """Azimuths from x towards y in place of bearings, which run the other way round and from north."""
    for bearing in [key for key in BEARINGS if key in fields]:
        azimuth = BEARINGS[bearing]
        if azimuth in fields:
            raise InputError(f"{name} has {bearing} and {azimuth}, which are one thing; keep one of the two.")
        if north is None:
            raise InputError(
                f"{name} states {bearing}, clockwise from north, and does not say where north is; give the bearing of the x "
                "axis of the column: a line `# north: 37` above its table, or `north`.",
                "north",
            )
        fields[azimuth] = (north - fields.pop(bearing)) % 360.0


def _facts(rows: list[list[str]], separator: str, name: str) -> tuple[dict[str, Any], list[list[str]]]:
    """What rows that begin with ``#`` say of the whole column, and the other rows that hold something.

    Those rows are above the names of the columns; below, what stands alone in its row. A fact whose value is in a cell of
    its own, or has what separates cells in it, is one all the same.
    """
    facts: dict[str, Any] = {}
    rest: list[list[str]] = []
    for row in rows:
        full = [cell.strip() for cell in row if cell.strip()]
        wrong = next((cell for cell in full if FAILED_CELL.fullmatch(cell)), None)
        if wrong is not None:
            raise InputError(
                f"{name} has a cell {wrong!r}, where a formula of the spreadsheet has failed; mend it there."
            )
        if not full or not full[0].startswith("#") or (rest and len(full) > 1):
            rest.extend([row] if full else [])
            continue
        key, sign, value = separator.join(row).strip(BLANK)[1:].partition(":")
        key, value = key.strip().lower(), value.strip(BLANK)
        if not sign:
            continue
        if key not in FACTS:
            raise InputError(f"{name} says {key!r} of the column; {suggest(key, FACTS)}allowed are {', '.join(FACTS)}.")
        facts[key] = _number(value, f"{key} of {name}", ".") if key in FACTS[3:] else value
    return facts, rest


def _typed_columns(text: str) -> list[tuple[str, float]]:
    """Columns as typed, and how many of their units are one of the SI."""
    columns = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(?P<name>-|\w[\w ]*?)\s*(?:\[\s*(?P<unit>[^\]]*?)\s*\])?\s*", part)
        name, unit = (match["name"].replace(" ", "_"), match["unit"]) if match else ("", None)
        if name in LENGTHS and unit in UNITS:
            columns.append((name, UNITS[unit]))
        elif name in (IGNORED, "drum", NOTE, "density", *DIRECTIONS, *JOINT) and unit in (None, _unit_of(name)):
            columns.append((name, 1.0))
        else:
            remedy = f"write it as {name} [m], for one; " if name in LENGTHS else suggest(name, NAMES)
            raise InputError(
                f"`columns` {text!r}: {part.strip()!r} is not understood; {remedy}allowed are lengths "
                f"({', '.join(LENGTHS)}) with [m], [cm] or [mm], {', '.join(key for key in NAMES if key not in LENGTHS)}, "
                "and - for a column to leave out.",
                "columns",
            )
    return columns


def _unit_of(name: str) -> str:
    """Unit of a column that has one only, as typed."""
    units = {"density": "kg/m3", "normal_stiffness": "N/m3", "shear_stiffness": "N/m3", "cohesion": "Pa"}
    return "deg" if name in DIRECTIONS or name == "friction_angle" else units.get(name, "")


def _columns_of(head: list[str], rows: list[list[str]], decimal: str, name: str) -> list[tuple[str, float]]:
    """Columns by our own names; or the refusal of the first name that is none, with columns proposed that can be typed."""
    try:
        return [_column(cell, name) for cell in head]
    except InputError as error:
        proposal = _proposed(head, rows, decimal)
        if proposal is not None:
            line = printable(", ".join(head))[:200]
            raise InputError(
                f"{error} Or state what each column of the row {line!r} holds, which may be `columns='{proposal}'`: check "
                "names and units.",
                "columns",
            ) from None
        raise


def _proposed(head: list[str], rows: list[list[str]], decimal: str) -> str | None:
    """Columns that a row of other names may mean, for a person to judge and to type; None where too few hold numbers."""
    wanted = ["drum"] if [row[0].strip() for row in rows if row] == [str(i + 1) for i in range(len(rows))] else []
    wanted += ["height", "bottom_width", "top_width"]
    own = []
    for cell in head:
        text = _text(cell)
        own.append(
            max((candidate for candidate in NAMES if re.match(rf"{candidate}(?![a-z]|_a)", text)), key=len, default="")
        )
    wanted = [candidate for candidate in wanted if candidate not in own]
    columns = []
    for k, (cell, key) in enumerate(zip(head, own)):
        numbers = all(k < len(row) and _is_number(row[k], decimal) for row in rows)
        key = key or (wanted.pop(0) if numbers and wanted else IGNORED)
        unit = re.search(r"[\[(_ ](mm|cm|m)[\])]?\s*$", cell.lower())
        columns.append(f"{key} [{unit[1] if unit else 'm'}]" if key in LENGTHS else key)
    return None if wanted else ", ".join(columns)


def _is_number(cell: str, decimal: str) -> bool:
    try:
        return math.isfinite(float(cell.replace(",", ".") if decimal == "," else cell))
    except ValueError:
        return False


def _text(cell: str) -> str:
    """A name of a column in small letters, its words and its unit with _ between them."""
    return "_".join(re.sub(r"[\[\]()]", " ", cell.lower()).split())


def _column(cell: str, name: str) -> tuple[str, float]:
    """What a column holds, and how many of its unit are one of the SI."""
    text = _text(cell)
    if text in NAMES:
        return text, 1.0
    stem, _, unit = text.rpartition("_")
    if stem in LENGTHS and unit in UNITS:
        return stem, UNITS[unit]
    if text == "density_kg_m3" or (stem in DIRECTIONS and unit in ("deg", "degrees", "°")):
        return "density" if text == "density_kg_m3" else stem, 1.0
    own = next((key for key, unit in JOINT.items() if unit and text == f"{key}_{unit}"), None)
    if own is not None:
        return own, 1.0
    raise InputError(
        f"{name} has a column {cell.strip()!r}; {suggest(text, NAMES)}known are {', '.join(NAMES)}, lengths with _m, _cm or "
        "_mm behind them."
    )


def _row(row: list[str], columns: list[tuple[str, float]], number: int, decimal: str, name: str) -> dict[str, float]:
    if len(row) > len(columns) and any(cell.strip() for cell in row[len(columns) :]):
        raise InputError(
            f"row {number} of {name} has {len(row)} cells and the table {len(columns)} columns; mend the row."
        )
    values: dict[str, float] = {}
    for cell, (key, factor) in zip(row, columns):
        if cell.strip() and key not in (NOTE, IGNORED):
            value = _number(cell.strip(), f"{key} in row {number} of {name}", decimal)
            values[key] = value / factor
    missing = next((key for key in ("height", "bottom_width", "top_width") if key not in values), None)
    if missing is not None:
        raise InputError(f"row {number} of {name} has no {missing}; measure it, or leave the drum out.")
    none = next((key for key in LENGTHS[:5] if not values.get(key, 1.0) > 0.0), None)
    if none is not None:
        raise InputError(f"{none} in row {number} of {name} is {values[none]:g} m; give a length above 0 m.")
    return values


def _number(text: str, what: str, decimal: str) -> float:
    try:
        value = float(text.replace(",", ".") if decimal == "," else text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or "_" in text:
        raise InputError(f"{what} is {text!r}; give a number.")
    return value
