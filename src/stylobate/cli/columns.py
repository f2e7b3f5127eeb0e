"""``stylobate columns``: the presets, the closed-form properties of any column, and what an assembly consists of."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    from ..column import Column
    from ..column.as_found import FoundDrum
    from ..column.catalogue import KnownColumn
    from ..column.links.placed import PlacedLink
    from ..column.structure import Structure


def columns(
    which: list[str] | None = o.argument(
        "[COLUMN]...", "Presets, or files of columns or assemblies; all presets by default.", None
    ),
    catalogue: bool = o.option(None, "Presets in a table: what is measured of each, and what is assumed.", False),
    *,
    execution: o.Plain,
) -> None:
    """Presets, and properties of columns and assemblies.

    A preset by its name is shown with the source of every figure. With --out, writes columns as files to start from.
    """
    from ..column.assembly_files import load_structure
    from ..column.catalogue import CATALOGUE, PRESETS, known_column
    from ..column.files import write_column
    from . import console

    known = [known_column(name) for name in which or PRESETS] if catalogue else []
    chosen: list[Any] = [load_structure(name) for name in which or PRESETS]
    other = next((stone for stone in chosen if stone.stack is None), None)
    if execution.out is not None and other is not None:
        raise InputError(
            f"`out` writes column files, and {other.name!r} is {other.described}; leave one of the two out.",
            "out",
        )
    names = [f"{Path(stone.name).name or 'column'}.toml" for stone in chosen]
    double = next((name for name in names if names.count(name) > 1), None)
    if execution.out is not None and double is not None:
        raise InputError(f"two of the columns would be written to {double}; give each a name of its own.", "columns")
    with execution.files("columns", *names) as files:
        if files.wanted:
            files += [write_column(stone, files / name) for stone, name in zip(chosen, names)]
    listed = {"catalogue": [preset.to_dict() for preset in known]} if catalogue else {}
    if execution.emits(
        {
            "columns": [properties(stone) if stone.stack is not None else parts_of(stone) for stone in chosen],
            **listed,
            "files": files.names,
        }
    ):
        return
    if catalogue:
        _print_catalogue(known)
    for name, structure in zip(which or PRESETS, () if catalogue else chosen):
        facts = _facts(structure) if structure.stack is not None else _assembled(structure)
        console.say(structure.name, facts | (_sourced(CATALOGUE[name]) if which and name in CATALOGUE else {}))
    console.print_files(files)


def _print_catalogue(known: list[KnownColumn]) -> None:
    """A row for each column of the catalogue; a figure that is assumed has an asterisk."""
    import pandas

    from . import console

    def figure_in_words(column: KnownColumn, name: str) -> str:
        figure = column.figures[name]
        return f"{figure.value:.4g}" + ("" if figure.measured else "*")

    heads = {
        "height": "height m",
        "bottom_width": "below m",
        "top_width": "above m",
        "drums": "drums",
        "density": "kg/m³",
    }
    rows = [
        {"column": column.name}
        | {head: figure_in_words(column, name) for name, head in heads.items()}
        | {"what": column.title}
        for column in known
    ]
    console.print_table(pandas.DataFrame(rows))
    print(
        "* assumed; all else is measured, as its source states it. Joints are assumed. Sources: stylobate columns NAME"
    )


def _sourced(known: KnownColumn) -> dict[str, str]:
    """Figures of a preset with their sources, and the sources."""
    from ..bibliography import bibliography

    figures = {f"its {name.replace('_', ' ')}": figure.text for name, figure in known.figures.items()}
    return (
        {"what": known.title}
        | figures
        | {f"source {n}": bibliography()[key].text for n, key in enumerate(known.sources, 1)}
    )


def parts_of(structure: Structure) -> dict:
    """What an assembly consists of, under the names of the JSON object."""
    import numpy as np

    corners = np.concatenate(
        [part.mesh(48).vertices for body in structure.bodies if not body.fixed for part in body.placed]
    )
    moving = [body for body in structure.bodies if not body.fixed]
    heaviest = max(moving, key=lambda body: body.mass)
    joints = structure.joined_faces
    return {
        "name": structure.name,
        "kind": structure.kind,
        "bodies": [{"name": body.name, "mass_kg": body.mass} for body in moving],
        "fixed": [body.name for body in structure.bodies if body.fixed],
        "joints": len(joints),
        "mass_kg": sum(body.mass for body in moving),
        "heaviest": heaviest.name,
        "heaviest_mass_kg": heaviest.mass,
        "height_m": structure.height,
        "extent_m": np.ptp(corners, axis=0).tolist(),
        "frequency_parameter_rad_s": structure.frequency_parameter,
        "north_deg": structure.north,
        "links": [_link(link) for link in structure.placed_links],
    }


def _assembled(structure: Structure) -> dict[str, str]:
    p = parts_of(structure)
    fixed = [name for name in p["fixed"] if name != "ground"]
    fixed_words = f", {len(fixed)} fixed" if fixed else ""
    x, y, z = p["extent_m"]
    return {
        "kind": p["kind"],
        "bodies": f"{len(p['bodies'])} that can move{fixed_words}",
        "joints": f"{p['joints']}",
        "height": f"{p['height_m']:g} m",
        "extent": f"{x:.4g} m along x, {y:.4g} m along y, {z:.4g} m along z",
        "mass": f"{p['mass_kg']:.0f} kg",
        "heaviest": f"{p['heaviest']}, {p['heaviest_mass_kg']:.0f} kg",
        "north": structure.north_words,
        **{link["name"]: _resistance_words(link) for link in p["links"]},
        **_stone(structure),
    }


def properties(column: Column) -> dict:
    """Closed-form properties of a column, under the names of the JSON object."""
    from ..constants import g

    return {
        "name": column.name,
        "section": column.section,
        "drums": column.n,
        "height_m": column.height,
        "bottom_width_m": column.drums[0].bottom_width,
        "top_width_m": column.drums[-1].top_width,
        "mass_kg": column.mass,
        "centroid_height_m": column.centroid_height,
        "slenderness_rad": column.slenderness,
        "radius_m": column.radius,
        "frequency_parameter_rad_s": column.frequency_parameter,
        "restitution": column.restitution,
        "uplift_g": column.uplift_acceleration / g,
        "as_found": column.to_dict().get("as_found"),
        "north_deg": column.north,
        "links": [_link(link) for link in column.placed_links],
    }


def _link(link: PlacedLink) -> dict:
    """Kind and capacities of a link; None for what it does not limit."""
    stone = link.stone
    limits = {"shear_capacity_n": link.shear_capacity, "axial_capacity_n": link.axial_capacity}
    limits |= {
        "stone_shear_n": math.inf if stone is None else stone.shear,
        "stone_tension_n": math.inf if stone is None else stone.pull,
    }
    return {
        "name": link.name,
        **{name: value if math.isfinite(value) else None for name, value in limits.items()},
        "stone": None if stone is None else stone.source,
        "pretension_n": link.pretension,
        "governs": link.governs,
    }


def _facts(column: Column) -> dict[str, str]:
    p = properties(column)
    return {
        "drums": f"{p['drums']}, {p['section']}",
        "height": f"{p['height_m']:g} m",
        "widths": f"{p['bottom_width_m']:g} m at the bottom, {p['top_width_m']:g} m at the top",
        "height over width": f"{p['height_m'] / p['bottom_width_m']:.1f}",
        "mass": f"{p['mass_kg']:.0f} kg",
        "slenderness": f"{p['slenderness_rad']:.4f} rad",
        "frequency parameter": f"{p['frequency_parameter_rad_s']:.4f} rad/s",
        "static uplift": f"{p['uplift_g']:.4f} g",
        "north": column.north_words,
        **_as_found(column),
        **{link["name"]: _resistance_words(link) for link in p["links"]},
        **_stone(column),
    }


def _stone(structure: Structure) -> dict[str, str]:
    """What of the stone around links is to be minded; nothing without anchors."""
    from ..column.links.placed import stone_words

    words = stone_words(structure.placed_links)
    return {"stone around links": words} if words else {}


def _resistance_words(link: dict) -> str:
    """Resistance of a link, in words."""
    capacities = []
    for kind, name in (("shear", "shear"), ("tension", "axial")):
        if capacity := link[f"{name}_capacity_n"]:
            capacities.append(f"{capacity / 1e3:.4g} kN in {kind}")
    limit = f"holds {' and '.join(capacities)}" if capacities else "without a limit"
    pulled = f", pretensioned with {link['pretension_n'] / 1e3:.4g} kN" if link["pretension_n"] else ""
    return f"{limit}{pulled}" + (f"; {link['governs']}" if link["governs"] else "")


def _azimuth(drum: FoundDrum, name: str) -> str:
    angle = getattr(drum, f"{name}_azimuth", 0.0)
    return f" (azimuth {angle:g}°)" if angle else ""


#: Chips of a drum: the field, its words, and from where the azimuth of the chips is its own [degrees].
CHIPPED = (
    ("chip_left", "on the left", 180.0),
    ("chip_right", "on the right", 0.0),
    ("chip_front", "in front", 270.0),
    ("chip_back", "at the back", 90.0),
)


def _as_found(column: Column) -> dict[str, str]:
    """State as found, one line for the base and one for each drum."""
    facts = {}
    if column.as_found.base_tilt != 0.0:
        azimuth = column.as_found.base_azimuth
        towards = f"towards azimuth {azimuth:g}°" if azimuth else "to the right"
        facts["as found, base"] = f"slopes by {column.as_found.base_tilt:g}°, up {towards}"
    for drum in column.as_found.drums:
        phrases = [
            f"{word} {getattr(drum, name):g} {unit}" + _azimuth(drum, name)
            for name, word, unit in (("offset", "offset", "m"), ("tilt", "tilted", "degrees"))
            if getattr(drum, name) != 0.0
        ]
        for name, word, towards in CHIPPED:
            if size := getattr(drum, name):
                azimuth = (drum.chip_azimuth + towards) % 360.0
                phrases.append(f"chipped {f'towards {azimuth:g}°' if drum.chip_azimuth else word} by {size:g} m")
        phrases += [f"turned by {drum.turn:g} degrees"] if drum.turn else []
        if phrases:
            facts[f"as found, drum {drum.drum}"] = ", ".join(phrases)
    return facts
