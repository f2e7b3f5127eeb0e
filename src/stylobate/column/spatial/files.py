"""Files of assemblies in space (TOML): read and checked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...errors import InputError, warn
from ..joint import Joint
from ..links.tables import links_between
from ..materials import material
from ..plausible import Piece, piece_doubts
from ..tables import JointTable, density_of, joint_fields
from .assembly import SpatialAssembly, refuse_many
from .placing import block_of, lay_beam, refuse_crossing, stand_in_space
from .tables import SpatialTable


def spatial_assembly(table: SpatialTable, default_name: str, folder: Path) -> SpatialAssembly:
    """The assembly that the tables of a file describe.

    Parameters
    ----------
    table : SpatialTable
    default_name : str
        Of one that states none.
    folder : Path
        That paths in it start from.

    Raises
    ------
    InputError
        What cannot be, in one sentence that names it.
    """
    if table.ground is True:
        raise InputError("ground is true; give its level in m, or false for none.")
    if not (table.block or table.column):
        raise InputError("there is neither [[block]] nor [[column]]; add one of the two.")
    refuse_many(len(table.block or []))
    ground = None if table.ground is False else float(table.ground)
    standing, axes, links = stand_in_space(table.column or [], folder, table.gravity, ground)
    stone = None if table.material is None else material(table.material)
    common = table.density if table.density is not None or stone is None else stone.density.value
    if table.joint is None and stone is None and not axes:
        raise InputError("key 'joint' is missing; add it, or name a material.")

    def law(given: Any, where: str) -> Joint:
        values = {} if given is None else given.model_dump(exclude={"between"})
        return Joint(**joint_fields(values, stone, where))

    def surface(given: JointTable | None, who: str) -> Joint | None:
        return None if given is None else law(given, f"the surface of {who}")

    blocks = []
    for i, entry in enumerate(table.block or []):
        name = entry.name if entry.name is not None else f"block {i + 1}"
        density = density_of(f"block {name!r}", entry.density, common, 0.0 if entry.fixed else None)
        blocks.append(block_of(entry, name, density, folder, surface(entry.surface, f"block {name!r}")))
    beams = []
    for i, entry in enumerate(table.beam or []):
        name = entry.name or ("architrave" if len(table.beam or []) == 1 else f"architrave {i + 1}")
        last = standing[-1].density if standing else None
        density = density_of(f"beam {name!r}", entry.density, common, last)
        beams.append(lay_beam(entry, name, density, axes, surface(entry.surface, f"beam {name!r}")))
    refuse_crossing(beams)
    overrides = []
    for entry in table.joint_override or []:
        if len(entry.between) != 2:
            raise InputError(f"a joint_override is between {len(entry.between)} blocks; name two, e.g. ['a', 'b'].")
        where = f"the [[joint_override]] between {entry.between[0]!r} and {entry.between[1]!r}"
        overrides.append((*entry.between, law(entry, where)))
    # without [joint], as between the drums of the columns
    joint = axes[0].law if table.joint is None and stone is None else law(table.joint, "[joint]")
    alone = [*blocks, *beams]
    laws = [joint, *(block.surface for block in alone if block.surface), *(each for *_, each in overrides)]
    pieces = [
        Piece(block.name, block.sides, block.density, block.surface or joint) for block in alone if not block.fixed
    ]
    for doubt in piece_doubts(pieces, laws, table.gravity):
        warn(doubt)
    stones = (*standing, *beams, *blocks)
    name = table.name or default_name
    links += links_between(table.link or [])
    rest = tuple(overrides), table.settle, tuple(links), table.north
    return SpatialAssembly(stones, joint, name, table.gravity, ground, *rest)
