"""Assemblies for the page: a file of blocks as it was uploaded, checked, with what is shown of it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from stylobate.column.assembly_files import read_assembly
from stylobate.column.block import FAR_AWAY
from stylobate.column.links.placed import strokes
from stylobate.column.presets import PRESETS
from stylobate.column.structure import Structure
from stylobate.column.toml import parse_toml
from stylobate.errors import InputError

from .lines import point_to
from .words import doubted, warned

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
    blocks = [one for one in tables if isinstance(one, dict)] if isinstance(tables, list) else []
    parts = [
        part for one in blocks if isinstance(one.get("parts"), list) for part in one["parts"] if isinstance(part, dict)
    ]
    if any("mesh" in one for one in (*blocks, *parts)):
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
    from stylobate.plots.drawing import SEEN, solids_of
    from stylobate.plots.solids import OBLIQUE  # matplotlib is loaded for those who look at an assembly

    bodies = [one for one in assembly.bodies if not (one.fixed and one.size > FAR_AWAY)]
    plane, solids = assembly.space_joints is None, solids_of(assembly)[0]
    return {
        "facts": {
            "name": assembly.name,
            "blocks": len(bodies),
            "fixed": sum(body.fixed for body in bodies),
            "joints": len(assembly.space_joints or assembly.face_pairs),
            "links": len(assembly.links),
            "mass": sum(body.mass for body in bodies if not body.fixed),
            "height": max(float(body.corners[:, 1].max()) for body in bodies),
            "digest": assembly.digest,
        },
        "model": model_of(assembly),
        "views": [
            _seen(assembly, solids, view, said)
            for view, said in (SEEN[:1] if plane else (*SEEN, (OBLIQUE, "from above")))
        ],
        "warnings": warned(doubts),
    }


def _seen(assembly: Structure, solids: list[Any], view: Any, said: str) -> dict[str, Any]:
    """What is seen from a direction: polygons with their colours in the order of painting, links, the ground's level [m]."""
    from stylobate.plots.solids import painted

    polygons, colours, outlines = painted(solids, view)
    lines = [(low, high) for _, (*_, low), (*_, high) in strokes(assembly.placed_links)]
    return {
        "said": said,
        "polygons": [one.round(4).tolist() for one in polygons],
        "colours": ["#" + "".join(f"{round(255 * float(part)):02x}" for part in one) for one in colours],
        "outlines": outlines,
        "links": [[view.across(end).round(4).tolist() for end in ends] for ends in lines],
        "ground": assembly.ground if view.elevation == 0.0 else None,
    }
