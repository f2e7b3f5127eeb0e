"""Assemblies for the page: a file of blocks as it was uploaded, checked, with what is shown of it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, cast

from ..column.assembly import Assembly
from ..column.assembly_files import read_assembly
from ..column.links.placed import strokes
from ..column.presets import PRESETS
from ..column.spatial.tables import describes_space
from ..column.toml import parse_toml
from ..errors import InputError
from .words import doubted, warned

#: Largest assembly file: the address in the browser holds it [characters].
LARGEST = 100_000

#: Name in messages.
FILE = "your-assembly.toml"


def assembly_of(text: str) -> Assembly:
    """The assembly that a file describes; its columns are presets, as no other file is at hand here.

    Raises
    ------
    InputError
        It describes none, or takes a column from a file.
    """
    if len(text) > LARGEST:
        raise InputError(f"the assembly file has {len(text)} characters; the page takes up to {LARGEST}.")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / FILE
        path.write_text(text, encoding="utf-8")
        try:
            data = parse_toml(path)
            if describes_space(data):  # before anything is read that the file names, such as a mesh of this machine
                raise InputError(
                    "the page does not take assemblies in space yet; use 'stylobate run' with the model dem3d, 'limit' "
                    "and 'draw'."
                )
            _only_presets(data.get("column"))
            return cast(Assembly, read_assembly(path))
        except InputError as error:
            error.without(f"{folder}/")
            raise


def _only_presets(tables: Any) -> None:
    for table in tables if isinstance(tables, list) else []:
        file = table.get("file") if isinstance(table, dict) else None
        if file not in PRESETS:
            raise InputError(
                f"a column of the assembly comes from {str(file)[:100]!r}; the page has only presets at hand "
                f"({', '.join(PRESETS)}): give such a name."
            )


def describe(text: str) -> dict[str, Any]:
    """Assembly on the page: what it is, warnings, and outlines [m].

    Raises
    ------
    InputError
        The text describes none.
    """
    with doubted() as doubts:
        assembly = assembly_of(text)
    moving = [block for block in assembly.blocks if not block.fixed]
    return {
        "facts": {
            "name": assembly.name,
            "blocks": len(assembly.blocks),
            "fixed": len(assembly.blocks) - len(moving),
            "joints": len(assembly.joints),
            "links": len(assembly.links),
            "mass": sum(one.properties[0] for one in moving),
            "height": max(z for block in assembly.blocks for _, z in block.vertices),
            "digest": assembly.digest,
        },
        "links": {
            "xz": [
                [low[[0, 2]].round(4).tolist(), high[[0, 2]].round(4).tolist()]
                for _, (*_, low), (*_, high) in strokes(assembly.placed_links)
            ]
        },
        "outlines": {"xz": [block.corners.round(4).tolist() for block in assembly.blocks]},
        "held": [block.fixed for block in assembly.blocks],
        "ground": assembly.ground,
        "warnings": warned(doubts),
    }
