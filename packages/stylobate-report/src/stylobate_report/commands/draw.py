"""``stylobate draw``: what stands, dimensioned, before anything is run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from stylobate.cli import options as o
from stylobate.errors import InputError

#: Kinds of files that pictures are written as.
KINDS = (".png", ".svg", ".pdf")


def draw(
    column: str = o.STRUCTURE,
    out: Path = o.option("FILE", "The picture: .png, .svg or .pdf; a file there is replaced.", ...),
    paper: str | None = o.option("A4|A3|…", "Drawn to scale on sheets of this paper, A4 to A0; for .pdf."),
    scale: str | None = o.option("1:N", "Scale of the elevations on --paper; the largest usual one by default."),
    *,
    execution: Annotated[o.Execution, o.Without(*o.CAMPAIGNS, "out")],
) -> None:
    """Elevations from two sides, the plan, and the plan of every joint.

    Of a column or an assembly as it stands before the motion, its measures in m; what is as found is red, links are blue.
    With --paper the sheets are drawn to a scale that they name, to be printed as they are and measured with a ruler.
    """
    from stylobate.cli import console
    from stylobate.column.assembly_files import load_structure

    structure = load_structure(column)
    if out.suffix.lower() not in KINDS:
        raise InputError(f"`out` is {str(out)!r}; allowed are files that end in {', '.join(KINDS)}.", "out")
    if out.is_dir() or not out.parent.is_dir():
        what = "is a folder" if out.is_dir() else f"lies in {str(out.parent)!r}, which is no folder"
        raise InputError(f"`out` {str(out)!r} {what}; name a file in a folder that is there.", "out")
    if paper is None and scale is not None:
        raise InputError(
            f"`scale` {scale} is for drawings on paper; say which with `paper`, such as `paper=A4`.", "scale"
        )
    if paper is not None and out.suffix.lower() != ".pdf":
        raise InputError(f"`paper` {paper} draws sheets to scale, and `out` is {str(out)!r}; name a .pdf.", "out")
    from stylobate import plots

    from ..sheets import sheets_to_scale

    if paper is None:
        files = plots.save_as(plots.draw_sheet(structure, structure.name), out)
    else:
        sheets = sheets_to_scale(structure, structure.name, paper=paper.upper(), scale=parse_scale(scale))
        files = plots.save_sheets(sheets, out)
    moving = sum(not body.fixed for body in structure.bodies)
    if execution.emits({"name": structure.name, "bodies": moving, "files": [str(file) for file in files]}):
        return
    console.say(f"{structure.name}, {moving} {'body' if moving == 1 else 'bodies'} that can move: {files[0]}", {})


def parse_scale(text: str | None) -> int | None:
    """A scale such as ``1:50``, one to so much."""
    if text is None:
        return None
    from ..sheets import SCALES

    numerator, _, number = text.partition(":")
    if numerator.strip() != "1" or not number.strip().isdecimal() or not 1 <= int(number) <= SCALES[-1]:
        raise InputError(f"`scale` is {text!r}; allowed is 1:N with N from 1 to {SCALES[-1]}, such as 1:50.", "scale")
    return int(number)
