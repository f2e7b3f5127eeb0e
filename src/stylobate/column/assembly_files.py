"""Assemblies from files (TOML), of the plane and in space, and structures from the plain values that they give."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError, warn, within
from ..text_tables import printable
from .assembly import Assembly, Block
from .catalogue import ASSEMBLIES, PRESETS
from .column import Column
from .files import column_from_dict, load_column
from .joint import Joint
from .links import link_from_dict
from .links.tables import BlockLinkTable, links_between
from .materials import Material, material
from .plausible import Piece, piece_doubts
from .spatial.assembly import SpatialAssembly
from .spatial.files import spatial_assembly
from .spatial.tables import SpatialTable, describes_space, refuse_mixed
from .specimen import Specimen
from .standing import BeamTable, ColumnsTable, lay, stand
from .structure import Structure
from .tables import JointTable, density_of, describes_assembly, joint_fields
from .toml import Table, checked, parse_toml


class BlockTable(Table):
    """``[[block]]``: corners in m, counter-clockwise."""

    name: str | None = None
    vertices: list[list[float]]
    density: float | None = None
    depth: float | None = None
    fixed: bool = False
    surface: JointTable | None = None


class BetweenTable(JointTable):
    """``[[joint_override]]``: the law between two blocks by name; ``ground`` is the ground."""

    between: list[str]


class AssemblyTable(Table):
    """An assembly file."""

    name: str | None = None
    density: float | None = None
    material: str | None = None
    depth: float = 1.0
    gravity: float = STANDARD_GRAVITY
    north: float | None = None
    ground: float | bool = 0.0
    joint: JointTable | None = None
    block: list[BlockTable] | None = None
    column: list[ColumnsTable] | None = None
    beam: list[BeamTable] | None = None
    joint_override: list[BetweenTable] | None = None
    link: list[BlockLinkTable] | None = None


def is_assembly(path: str | Path) -> bool:
    """Whether a TOML file describes an assembly: it has blocks, beams, or columns from files."""
    return describes_assembly(parse_toml(path))


def load_structure(text: str | Path) -> Column | Assembly | SpatialAssembly:
    """The preset of that name, or what the file of that path describes: a column or an assembly.

    Raises
    ------
    InputError
        There is neither, or the file cannot be used.
    """
    name = str(text)
    if name in ASSEMBLIES:
        return read_assembly(ASSEMBLIES[name])
    if name not in PRESETS and (Path(name).exists() or name.endswith(".toml")) and is_assembly(name):
        return read_assembly(name)
    return load_column(name)


def read_assembly(path: str | Path) -> Assembly | SpatialAssembly:
    """Read an assembly file (TOML): it is in space where any of its entries is.

    Raises
    ------
    InputError
        The file cannot be read or does not describe an assembly; the message names the block and the remedy.
    """
    data, name, folder = parse_toml(path), printable(Path(path).stem), Path(path).parent
    with within(printable(path)):
        if describes_space(data):
            refuse_mixed(data)
    table = checked(data, SpatialTable if describes_space(data) else AssemblyTable, printable(path))
    with within(printable(path)):
        if isinstance(table, SpatialTable):
            return spatial_assembly(table, name, folder)
        return _assembly(table, name, folder)


def assembly_from_dict(data: Mapping[str, Any]) -> Assembly:
    """The assembly that :meth:`Assembly.to_dict` described."""
    blocks = []
    for fields in data["blocks"]:
        surface, solid = fields["surface"], fields["solid"]
        special = {
            "vertices": tuple(tuple(corner) for corner in fields["vertices"]),
            "surface": None if surface is None else Joint(**surface),
            "solid": None if solid is None else tuple(solid),
        }
        blocks.append(Block(**(dict(fields) | special)))
    overrides = tuple((first, other, Joint(**law)) for first, other, law in data["overrides"])
    special = {"blocks": tuple(blocks), "joint": Joint(**data["joint"]), "overrides": overrides}
    special["links"] = tuple(link_from_dict(fields) for fields in data.get("links", ()))
    return Assembly(**(dict(data) | special))


def _assembly(table: AssemblyTable, default_name: str, folder: Path) -> Assembly:
    blocks, standing, laid, links = [], *stand(table.column or [], folder, table.gravity, table.ground)
    if not (table.block or standing):
        raise InputError("there is neither [[block]] nor [[column]]; add one of the two.")
    stone = None if table.material is None else material(table.material)
    common = table.density if table.density is not None or stone is None else stone.density.value
    if table.joint is None and stone is None and not standing:
        raise InputError("key 'joint' is missing; add it, or name a material.")
    for i, entry in enumerate(table.block or []):
        name = entry.name if entry.name is not None else f"block {i + 1}"
        density = density_of(f"block {name!r}", entry.density, common, 0.0 if entry.fixed else None)
        corners = tuple(tuple(corner) for corner in entry.vertices)
        surface = None if entry.surface is None else _law(entry.surface, stone, f"the surface of block {name!r}")
        depth = entry.depth if entry.depth is not None else table.depth
        blocks.append(Block(corners, density, name, depth, entry.fixed, surface))  # pyright: ignore[reportArgumentType]
    blocks = standing + blocks
    for i, entry in enumerate(table.beam or []):
        name = entry.name or ("architrave" if len(table.beam or []) == 1 else f"architrave {i + 1}")
        last = standing[-1].density if standing else None
        density = density_of(f"beam {name!r}", entry.density, common, last)
        surface = None if entry.surface is None else _law(entry.surface, stone, f"the surface of beam {name!r}")
        blocks.append(lay(entry, name, density, laid, surface))
    overrides = []
    for entry in table.joint_override or []:
        if len(entry.between) != 2:
            raise InputError(f"a joint_override is between {len(entry.between)} blocks; name two, e.g. ['a', 'b'].")
        where = f"the [[joint_override]] between {entry.between[0]!r} and {entry.between[1]!r}"
        overrides.append((*entry.between, _law(entry, stone, where)))
    if table.ground is True:
        raise InputError("ground is true; give its level in m, or false for none.")
    ground = None if table.ground is False else float(table.ground)
    if table.joint is None and stone is None:  # as between the drums of the columns
        joint = laid[0].law
    else:
        joint = _law(table.joint, stone, "[joint]")
    links += links_between(table.link or [])
    alone = blocks[len(standing) :]
    laws = [joint, *(block.surface for block in alone if block.surface), *(law for _, _, law in overrides)]
    pieces = [_piece(block, block.surface or joint) for block in alone if not block.fixed]
    for doubt in piece_doubts(pieces, laws, table.gravity):
        warn(doubt)
    return Assembly(
        tuple(blocks),
        joint,
        default_name if table.name is None else table.name,
        table.gravity,
        ground,
        tuple(overrides),
        tuple(links),
        table.north,
    )


def _law(table: Table | None, stone: Material | None, where: str) -> Joint:
    given = {} if table is None else table.model_dump(exclude={"between"})
    return Joint(**joint_fields(given, stone, where))


def _piece(block: Block, law: Joint) -> Piece:
    """A block as it is doubted."""
    across, upward = block.sides
    return Piece(block.name, (across, block.depth, upward), block.density, law)


# -- Kinds of structures by their word --------------------------------------------------------------------------------


#: Makers of a structure from what its ``to_dict`` gives, by its kind.
FROM_DICT: dict[str, Callable[[Any], Structure]] = {
    Column.kind: column_from_dict,
    Assembly.kind: assembly_from_dict,
    Specimen.kind: Specimen.from_dict,
    SpatialAssembly.kind: SpatialAssembly.from_dict,
}
