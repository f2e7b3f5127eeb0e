"""``stylobate materials``: published densities, friction and stiffness of stone and its joints, with their sources."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from . import options as o

if TYPE_CHECKING:
    from ..column.materials import Material, Quantity


def materials(
    which: list[str] | None = o.argument(
        "[MATERIAL]...", "Such as 'marble, worn'; one by one with sources. All by default.", None
    ),
    *,
    execution: o.Plain,
) -> None:
    """Stone and joints by name, for column files.

    What is published on density, friction and stiffness, its range and its source.
    """
    from ..column.materials import LOST, MATERIALS, material
    from . import console

    chosen = [material(name) for name in which] if which else list(MATERIALS.values())
    lost = {name: dataclasses.asdict(quantity) | {"cited": quantity.cited} for name, quantity in LOST.items()}
    summary: dict = {"materials": [entry.to_dict() for entry in chosen], "losses": lost, "files": []}
    with execution.files("materials", "materials.json") as files:
        if files.wanted:
            files.json(summary, "materials.json")
            summary["files"] = files.names
    if execution.emits(summary):
        return
    if which:
        for stone in chosen:
            console.say(
                stone.name, {name.replace("_", " "): _in_full(q) for name, q in (stone.quantities | LOST).items()}
            )
    else:
        import pandas

        console.print_table(pandas.DataFrame([_row(entry) for entry in chosen]))
        print("Ranges in brackets. Sources and notes: stylobate materials 'marble, worn'. In a file: material = \"…\"")
    if summary["files"]:
        print(f"1 file in {summary['files'][0]}")


def _row(material: Material) -> dict[str, str]:
    return {
        "material": material.name,
        "density kg/m³": _short(material.density),
        "friction": _short(material.friction_coefficient),
        "k_n N/m³": _short(material.normal_stiffness),
        "k_s N/m³": _short(material.shear_stiffness),
        "cohesion Pa": _short(material.cohesion),
    }


def _short(q: Quantity | None) -> str:
    if q is None:
        return "-"
    return f"{q.value:.4g}" + (f" [{q.low:.4g}–{q.high:.4g}]" if q.low < q.high else "")


def _in_full(q: Quantity) -> str:
    unit = "" if q.unit == "-" else f" {q.unit}"
    span = f", {q.low:.4g} to {q.high:.4g}{unit}" if q.low < q.high else ""
    return f"{q.value:.4g}{unit}{span}; {q.cited}: {q.note}"
