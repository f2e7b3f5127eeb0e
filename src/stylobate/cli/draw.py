"""``stylobate draw``: what stands, dimensioned, before anything is run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ..errors import InputError
from . import options as o

#: Kinds of files that pictures are written as.
KINDS = (".png", ".svg", ".pdf")


def draw(
    column: o.StructureName,
    out: Path = o.option("FILE", "The picture: .png, .svg or .pdf; a file there is replaced.", ...),
    *,
    execution: Annotated[o.Execution, o.But(*o.COMPUTING, "out")],
) -> None:
    """Elevations from two sides, the plan, and the plan of every joint.

    Of a column or an assembly as it stands before the motion, its measures in m; what is as found is red, links are blue.
    """
    from . import console

    structure = o.the_structure(column)
    if out.suffix.lower() not in KINDS:
        raise InputError(f"--out is {str(out)!r}; allowed are files that end in {', '.join(KINDS)}.", "out")
    if out.is_dir() or not out.parent.is_dir():
        what = "is a folder" if out.is_dir() else f"lies in {str(out.parent)!r}, which is no folder"
        raise InputError(f"--out {str(out)!r} {what}; name a file in a folder that is there.", "out")
    from .. import plots

    files = plots.save_as(plots.draw_sheet(structure, structure.name), out)
    moving = sum(not body.fixed for body in structure.bodies)
    if execution.emits({"name": structure.name, "bodies": moving, "files": [str(file) for file in files]}):
        return
    console.say(f"{structure.name}, {moving} {'body' if moving == 1 else 'bodies'} that can move: {files[0]}", {})
