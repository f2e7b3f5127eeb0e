"""Files edited as text on the page, assemblies and ruins: checked, what is shown of them, and where an error lies."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

from stylobate.column.assembly_files import read_assembly
from stylobate.column.block import FAR_AWAY
from stylobate.column.catalogue import PRESETS
from stylobate.column.files import write_column
from stylobate.column.links.placed import strokes
from stylobate.column.structure import Structure
from stylobate.column.toml import parse_toml
from stylobate.errors import InputError
from stylobate_ruins.ruin import Ruin
from stylobate_ruins.ruin_files import read_ruin

from .forms import doubted, warned
from .job_request import ASSEMBLY, COLUMN, RUIN

#: Largest assembly file: the address in the browser holds it [characters].
LARGEST = 100_000

#: Name in messages.
FILE = "your-assembly.toml"


def assembly_of(text: str) -> Structure:
    """The assembly of a file, in the plane or in space; its columns are presets, as no other file is at hand here.

    Raises
    ------
    InputError
        It describes none, or takes a column or a mesh from a file.
    """
    if len(text) > LARGEST:
        raise InputError(f"the assembly file has {len(text)} characters; the page takes up to {LARGEST}.", "assembly")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / FILE
        path.write_text(text, encoding="utf-8")
        try:
            data = parse_toml(path)
            _only_presets(data.get("column"))  # before anything of this machine is read that the file names
            _no_meshes(data.get("block"))
            return read_assembly(path)
        except InputError as error:
            error.without(f"{folder}/")
            point_to(error, text, "assembly")
            raise


def _only_presets(tables: Any) -> None:
    for table in tables if isinstance(tables, list) else []:
        file = table.get("file") if isinstance(table, dict) else None
        if file not in PRESETS:
            raise InputError(
                f"a column of the assembly comes from {str(file)[:100]!r}; the page has only presets at hand "
                f"({', '.join(PRESETS)}): give such a name."
            )


def _no_meshes(tables: Any) -> None:
    blocks = [block for block in tables if isinstance(block, dict)] if isinstance(tables, list) else []
    parts = [
        part
        for block in blocks
        if isinstance(block.get("parts"), list)
        for part in block["parts"]
        if isinstance(part, dict)
    ]
    if any("mesh" in table for table in (*blocks, *parts)):
        raise InputError(
            "a block of the assembly is a mesh, and the page has no other file at hand; give its vertices."
        )


def model_of(assembly: Structure) -> str:
    """Name of the model that computes it."""
    return "dem2d" if assembly.space_joints is None else "dem3d"


def describe(text: str) -> dict[str, Any]:
    """Assembly on the page: what it is, warnings, and outlines [m].

    Raises
    ------
    InputError
        The text describes none.
    """
    try:
        with doubted() as doubts:
            assembly = assembly_of(text)
    except InputError as error:
        error.args = (str(error).replace(f"{FILE}: ", "").replace(FILE, "the file"),)  # it is the text at hand
        raise
    from stylobate.plots.drawing import VIEWS, solids_of
    from stylobate.plots.scene import OBLIQUE

    bodies = [body for body in assembly.bodies if not (body.fixed and body.size > FAR_AWAY)]
    plane, solids = assembly.space_joints is None, solids_of(assembly)[0]
    return {
        "facts": {
            "name": assembly.name,
            "blocks": len(bodies),
            "fixed": sum(body.fixed for body in bodies),
            "joints": len(assembly.joined_faces),
            "links": len(assembly.links),
            "mass": sum(body.mass for body in bodies if not body.fixed),
            "height": max(float(body.corners[:, 1].max()) for body in bodies),
            "digest": assembly.digest,
        },
        "model": model_of(assembly),
        "views": [
            _view(assembly, solids, view, caption)
            for view, caption in (VIEWS[:1] if plane else (*VIEWS, (OBLIQUE, "from above")))
        ],
        "warnings": warned(doubts),
    }


def _view(assembly: Structure, solids: list[Any], view: Any, caption: str) -> dict[str, Any]:
    """What is seen from a direction: polygons with their colours in the order of painting, links, the ground's level [m]."""
    from stylobate.plots.scene import painted

    polygons, colours, outlines = painted(solids, view)
    lines = [(low, high) for _, (*_, low), (*_, high) in strokes(assembly.placed_links)]
    return {
        "said": caption,
        "polygons": [polygon.round(4).tolist() for polygon in polygons],
        "colours": ["#" + "".join(f"{round(255 * float(part)):02x}" for part in colour) for colour in colours],
        "outlines": outlines,
        "links": [[view.across(end).round(4).tolist() for end in ends] for ends in lines],
        "ground": assembly.ground if view.elevation == 0.0 else None,
    }


#: Largest ruin file: the address in the browser holds it [characters]; most simulations.
LARGEST_RUIN, MOST = 50_000, 20_000


def ruin_of(text: str | None, stone: Structure, assembly: str | None) -> Ruin:
    """The ruin of a file.

    Parameters
    ----------
    text : str or None
    stone : Structure
        What stands on the page: ``column.toml`` in the file, or ``assembly.toml``.
    assembly : str or None
        Its file, where it is an assembly.

    Raises
    ------
    InputError
        The text describes none, or names another file: of this machine nothing else is read.
    """
    if not text or len(text) > LARGEST_RUIN:
        raise InputError(f"the ruin file has {len(text or '')} characters; allowed are 1 to {LARGEST_RUIN}.", "ruin")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / RUIN
        path.write_text(text, encoding="utf-8")
        try:
            data = parse_toml(path)
            _only_what_is_here(data, COLUMN if assembly is None else ASSEMBLY)
            if assembly is None:
                write_column(stone.stack, Path(folder) / COLUMN)
            else:
                (Path(folder) / ASSEMBLY).write_text(assembly, encoding="utf-8")
            ruin = read_ruin(path)
        except InputError as error:
            error.without(f"{folder}/")
            error.without(f"{RUIN}: ")
            point_to(error, text, "ruin")
            raise
    if ruin.simulations > MOST:
        raise InputError(f"{ruin.simulations} simulations are asked for; the page takes up to {MOST}.", "ruin")
    return ruin


def _only_what_is_here(data: dict[str, object], here: str) -> None:
    columns, prior = data.get("columns"), data.get("prior")
    for name in columns if isinstance(columns, list) else []:
        if name != here and name not in PRESETS:
            raise InputError(
                f"a column of the ruin comes from {str(name)[:100]!r}; the page has {here}, which stands on it, and presets "
                f"({', '.join(PRESETS)}): give such a name."
            )
    if isinstance(prior, dict) and "records" in prior:
        raise InputError("the prior of the ruin names records, which the page has not at hand; give pgv and period.")
    if "survival" in data:
        raise InputError("the ruin names a hazard curve, which the page has not at hand; leave survival out.")


#: Where the reader of TOML says that it stopped; a block that a sentence names; the name that one without a name has.
_AT, _NAMED, _NUMBERED = (
    re.compile(r"\(at line (\d+),"),
    re.compile(r"\b(?:block|called) '([^']*)'"),
    re.compile(r"block (\d+)"),
)


def point_to(error: InputError, text: str, field: str) -> None:
    """Make an error one of the field that holds the text: with the number of its line, such as ``assembly.12``, if known."""
    line = _line(error, text.split("\n"))
    error.field = field if line is None else f"{field}.{line}"


def _line(error: InputError, lines: list[str]) -> int | None:
    """Number of the line that an error is about, from 1."""
    message, (*table, key) = str(error), (error.field or "").split(".")
    if (stopped := _AT.search(message)) is not None:
        return int(stopped[1])
    if len(table) == 2 and table[1].isdecimal():
        begins = _header(lines, table[0], int(table[1]))
        return begins and (_key(lines, key, begins) or begins)
    if key and (number := _key(lines, key)) is not None:
        return number
    for name in _NAMED.findall(message):
        named = next(
            (k for k, text in enumerate(lines, 1) if re.match(rf"\s*name\s*=\s*(['\"]){re.escape(name)}\1", text)), None
        )
        numbered = _NUMBERED.fullmatch(name)
        if named is None and numbered is not None:
            named = _header(lines, "block", int(numbered[1]))
        if named is not None:
            return named
    return None


def _header(lines: list[str], table: str, number: int) -> int | None:
    """Line at which the table of that number in a list begins."""
    headers = [k for k, line in enumerate(lines, 1) if re.match(rf"\s*\[\[\s*{re.escape(table)}\s*\]\]", line)]
    return headers[number - 1] if 0 < number <= len(headers) else None


def _key(lines: list[str], key: str, begins: int | None = None) -> int | None:
    """First line that gives a key; of the table that begins at a line, where there is one."""
    for k, line in enumerate(lines[begins or 0 :], 1 + (begins or 0)):
        if begins is not None and re.match(r"\s*\[", line) and not re.match(r"\s*\[\s*-?[\d\[]", line):
            return None
        if re.match(rf"\s*(['\"]?){re.escape(key)}\1\s*=", line):
            return k
    return None
