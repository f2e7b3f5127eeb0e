"""Tables in text files of other people: every row has the fields that the header names, or it is refused with its line."""

from __future__ import annotations

import codecs
import csv
import io
import os
import re
import stat
from dataclasses import dataclass
from pathlib import Path

from .errors import InputError, suggest

# Files of other people: kind and size are looked at before anything is read, and names are made fit to be shown.

#: Most that a text of settings (a column, a study, an assembly) may hold [bytes].
SETTINGS = 2_000_000


def read_bytes(path: str | Path, most: int, remedy: str = "give another file") -> bytes:
    """Content of a file of at most ``most`` bytes.

    Parameters
    ----------
    path : str or Path
    most : int
        [bytes]
    remedy : str
        One clause that says what to do with a file that is larger.

    Raises
    ------
    InputError
        There is no such file, it cannot be read, is larger, or is no file: a folder, a pipe or a device, which might
        never end.
    """
    check_file(path, most, remedy)
    try:
        with Path(path).open("rb") as file:
            size = min(os.fstat(file.fileno()).st_size, most)
            data = file.read(size + 1)  # a buffer of this size: not of the most that is allowed
            if len(data) > size:  # it grows, or its size is not told beforehand; no more even so
                data += file.read(most + 1 - len(data))
    except OSError as error:
        raise _unreadable(path, error) from None
    if len(data) > most:
        raise InputError(f"{printable(path)} holds more than {most} bytes, which is the most here: {remedy}.")
    return data


def check_file(path: str | Path, most: int, remedy: str = "give another file") -> None:
    """Refuse what is no file or too large a one, without opening it; see :func:`read_bytes`."""
    try:
        status = Path(path).stat()
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from None
    if stat.S_ISDIR(status.st_mode):
        raise InputError(f"{printable(path)} is a folder; name the file in it.")
    if not stat.S_ISREG(status.st_mode):
        raise InputError(f"{printable(path)} is not a file but a pipe or a device; give a file.")
    if status.st_size > most:
        raise InputError(f"{printable(path)} holds {status.st_size} bytes; allowed is up to {most}: {remedy}.")


def printable(path: str | Path) -> str:
    """A path as it can be printed and stored: bytes that are no UTF-8, and control characters, as ``\\x…``."""
    text = os.fsencode(str(path)).decode("utf-8", "backslashreplace")
    return "".join(
        character if character.isprintable() else character.encode("unicode_escape").decode() for character in text
    )


def _unreadable(path: str | Path, error: OSError | ValueError) -> InputError:
    if isinstance(error, FileNotFoundError):
        slashed = str(path).replace("\\", "/")
        if slashed != str(path) and Path(slashed).exists():
            return InputError(f"there is no file {printable(path)}; write {slashed}.")
        folder = Path(path).parent
        near = suggest(Path(path).name, (entry.name for entry in folder.iterdir())) if folder.is_dir() else ""
        return InputError(f"there is no file {printable(path)}; {near}check its name and folder.")
    reason = getattr(error, "strerror", None) or str(error)
    return InputError(f"{printable(path)} cannot be read: {reason}; check the path.")


#: Separators of columns.
DELIMITERS = (",", ";", "\t")

#: Longest part of a strange line that a message shows [characters].
LONGEST = 120


@dataclass(frozen=True)
class Table:
    """Cells of a table.

    Parameters
    ----------
    name : str
        Of the file, as it can be shown.
    columns : tuple of str
        In small letters.
    lines : list of int
        The line of the file on which each row ends.
    rows : list of list of str
        As long as ``columns``; blanks around the cells are gone.
    commas : bool
        Commas separate the columns.
    """

    name: str
    columns: tuple[str, ...]
    lines: list[int]
    rows: list[list[str]]
    commas: bool

    def texts(self, column: str) -> list[str]:
        """Cells of a column."""
        k = self.columns.index(column)
        return [row[k] for row in self.rows]

    def numbers(self, column: str, missing: float | None = None) -> list[float]:
        """Cells of a column as numbers; what stands for an empty one may be given.

        Raises
        ------
        InputError
            One is none.
        """
        numbers = []
        for line, text in zip(self.lines, self.texts(column), strict=True):
            try:
                numbers.append(missing if missing is not None and not text else float(text.replace("_", "?")))
            except ValueError:
                raise InputError(
                    f"line {line} of {self.name} has {printable(text)[:LONGEST]!r} as {column}, where a number is "
                    f"needed{points(text)}; mend the file."
                ) from None
        return numbers

    def refuse_halves(self, column: str, known: tuple[str, ...]) -> None:
        """Refuse numbers that may have been cut in two at decimal commas, as many fields as the header may name.

        Parameters
        ----------
        column : str
            Of the numbers; whole ones are doubtful where a column of digits follows that is none of the known ones.
        known : tuple of str
        """
        k = self.columns.index(column) if column in self.columns else len(self.columns)
        if not self.commas or k + 1 >= len(self.columns) or self.columns[k + 1] in known or not self.rows:
            return
        if all(row[k].isdigit() and row[k + 1].isdigit() for row in self.rows):
            raise InputError(
                f"{self.name} has whole numbers only as {column} and as {printable(self.columns[k + 1])!r} behind it, which "
                f"may be numbers with decimal commas; write {column} with a decimal point, such as {self.rows[0][k]}.0."
            )

    def to_csv(self) -> io.StringIO:
        """The cells as a plain CSV text, to be read by others."""
        text = io.StringIO()
        writer = csv.writer(text)
        writer.writerow(self.columns)
        writer.writerows(self.rows)
        text.seek(0)
        return text


def points(text: str) -> str:
    """The clause about a number with commas: how it is to be written."""
    return " (decimal points, and nothing between thousands)" if "," in text else ""


def read(path: str | Path, most: int, key: str, needs: str) -> Table:
    """Read a table: CSV, or columns separated by semicolons or tabulators.

    Above the header lines may begin with ``#``; empty lines are passed over, and so is the line ``sep=;`` of a spreadsheet.

    Parameters
    ----------
    path : path
    most : int
        Largest size [bytes].
    key : str
        A column that it must have, by which the header is known.
    needs : str
        What it needs, for a message.

    Raises
    ------
    InputError
        It cannot be read, has no such column, two columns of one name, or a row with more or fewer fields than the header.
    """
    name = printable(path)
    text = text_of(read_bytes(path, most), name)
    lines = io.StringIO(text, newline=None).readlines()
    above = next((k for k, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#")), len(lines))
    for delimiter in DELIMITERS:
        table = _parse(name, lines[above:], delimiter, above, key)
        if table is not None:
            return table
    first = f"; its first line is {printable(lines[above].strip())[:LONGEST]!r}" if above < len(lines) else ""
    raise InputError(f"{name} has no column {key!r}{first}; it needs {needs}.")


#: The line by which a spreadsheet is told what separates the columns.
_SEPARATOR = re.compile(r"\ufeff?[ \t]*\"?sep=(.)\"?[ \t;,]*(?:\r\n|\r|\n|$)", re.IGNORECASE)


def text_of(content: bytes, name: str) -> str:
    """The text of a table: UTF-8, or Latin-1 as older spreadsheets write; a line ``sep=;`` at its beginning becomes empty.

    Parameters
    ----------
    content : bytes
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        It is no text.
    """
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        text = content.decode("utf-16", "replace")
    else:
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = content.decode("cp1252", "replace")  # Latin-1, with the signs that spreadsheets add to it
    if "\x00" in text:
        raise InputError(f"{name} is no text (it holds bytes of 0); save it as CSV in UTF-8.")
    return _SEPARATOR.sub("\n", text, count=1) if _SEPARATOR.match(text) else text


def _parse(name: str, lines: list[str], delimiter: str, above: int, key: str) -> Table | None:
    """The table, if its header has the key with this delimiter."""
    reader = csv.reader(lines, delimiter=delimiter, skipinitialspace=True, strict=True)
    try:
        header = [cell.strip().lower() for cell in next(reader, [])]
    except csv.Error:  # quotation marks of another delimiter
        return None
    if key not in header:
        return None
    twice = next((heading for k, heading in enumerate(header) if heading and heading in header[:k]), None)
    if twice is not None:
        raise InputError(f"{name} has two columns called {printable(twice)!r}; rename or remove one.")
    numbers, rows = [], []
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            if not any(cells):
                continue
            line = above + reader.line_num
            if len(cells) != len(header):
                raise _ragged(name, line, cells, header, delimiter)
            numbers.append(line)
            rows.append(cells)
    except csv.Error as error:
        raise InputError(
            f"line {above + reader.line_num} of {name} is no row of a table ({error}); mend its quotation marks."
        ) from None
    named = [k for k, heading in enumerate(header) if heading]
    for line, row in zip(numbers, rows):
        if len(named) < len(header) and any(row[k] for k in range(len(header)) if k not in named):
            raise InputError(f"line {line} of {name} has a value in a column without a name; name it in the header.")
    if len(named) < len(header):
        rows = [[row[k] for k in named] for row in rows]
    return Table(name, tuple(header[k] for k in named), numbers, rows, delimiter == ",")


def _ragged(name: str, line: int, cells: list[str], header: list[str], delimiter: str) -> InputError:
    if cells[0].startswith("#"):
        why = "comments stand above the header"
    elif len(cells) > len(header) and delimiter == ",":
        why = "write numbers with decimal points, not commas, and texts that hold a comma in quotation marks"
    else:
        why = "an empty field needs its separator, too"
    text = printable(delimiter.join(cells))[:LONGEST]
    return InputError(
        f"line {line} of {name} has {len(cells)} fields where the header names {len(header)}: {text!r}; {why}."
    )
