"""``stylobate convert``: models of other tools, and surveys, to column and assembly files and back."""

from __future__ import annotations

from pathlib import Path

from stylobate.cli import options as o
from stylobate.errors import InputError


def convert(
    model: str = o.argument(
        "MODEL",
        "Mesh (OBJ, PLY, STL, glTF), COMPAS JSON, 3DEC data file, survey (CSV, workbook), preset, column or assembly file.",
    ),
    to: Path = o.option(
        "FILE", "What to write: .toml, .json, .csv, .obj, .ply, .stl or .glb; nothing may be there.", ...
    ),
    material: str | None = o.option("NAME", "Stone and joints of a mesh, COMPAS model or survey, such as marble."),
    kind: str = o.option("assembly|column", "What stones of a mesh become.", "assembly", flag="--as"),
    mesh_unit: str = o.option("m|cm|mm|inch|foot", "Of a mesh.", "m", flag="--unit"),
    up: str | None = o.option("y|z", "Axis of a mesh that is upward; y of glTF, z of others if not given."),
    tolerance: str = o.option("LENGTH", "Largest distance of a mesh from what stands for it.", "1mm"),
    closing: str | None = o.option(
        "LENGTH", "Largest gap between faces that is closed; --tolerance if not given, 1mm of 3DEC."
    ),
    ground: str | None = o.option(
        "LEVEL|none", "Where the ground lies; the lowest point if not given, none where there are supports."
    ),
    columns: str | None = o.option(
        "NAMES", 'Columns of a survey: "drum, height [cm], bottom_width [cm], top_width [cm], -", - to leave one out.'
    ),
    fixed: list[str] | None = o.option("NAME", "A stone that moves with the ground; may be repeated."),
    glued: list[str] | None = o.option("NAME+NAME", "Parts that are one stone; may be repeated."),
    north: float | None = o.option(
        "DEG", "Bearing of the x axis of a survey that states bearings, clockwise from north."
    ),
    compas: str = o.option("dem|assembly", "Package of COMPAS that .json is written for.", "dem"),
    *,
    execution: o.Plain,
) -> None:
    """Models of other tools to files, and back.

    Each closed part of a mesh becomes a drum where a frustum fits it, else a convex block.
    """
    from stylobate.cli import console

    from ..convert import Reading
    from ..convert import convert as converted

    reading = Reading(
        material, kind, mesh_unit, _length(tolerance, "tolerance"), _level(ground), tuple(fixed or ()), columns, north,
        up, None if closing is None else _length(closing, "closing"), tuple(glued or ()),
    )  # fmt: skip
    structure, words, files = converted(model, execution.place(to), reading, compas)
    words = [console.in_options(line) for line in words]
    moving = sum(not body.fixed for body in structure.bodies)
    summary = {"name": structure.name, "kind": structure.kind, "bodies": moving, "fitted": words}
    if execution.emits(summary | {"files": [str(file) for file in files]}):
        return
    console.say(
        f"{structure.name}, {structure.described} of {moving} {'body' if moving == 1 else 'bodies'}: {files[0]}", {}
    )
    for line in words:
        print(f"  {line}")


def _length(text: str, option: str) -> float:
    """A length such as ``5mm`` in m; a number alone is in m."""
    stem, factor = text.strip(), 1.0
    for unit, size in (("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)):
        if stem.endswith(unit):
            stem, factor = stem.removesuffix(unit), size
            break
    try:
        return factor * float(stem)
    except ValueError:
        raise InputError(f"`{option}` is {text!r}; allowed is a length such as 1mm.", option) from None


def _level(text: str | None) -> float | bool | None:
    if text is None:
        return None
    if text == "none":
        return False
    try:
        return float(text.strip().removesuffix("m"))
    except ValueError:
        raise InputError(f"`ground` is {text!r}; allowed is a level in m, or none.", "ground") from None
