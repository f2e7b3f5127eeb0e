"""An assembly of the plane in space: its polygons as prisms of their depth, beside the plane on both sides alike."""

from __future__ import annotations

import dataclasses

import numpy as np

from ...errors import InputError
from ..assembly import Assembly
from ..block import Block
from ..structure import Structure
from .assembly import SpatialAssembly
from .stone import Stone


def in_space(structure: Structure) -> Structure:
    """What stands in space: an assembly of the plane as prisms, anything else itself."""
    return as_prisms(structure) if isinstance(structure, Assembly) else structure


def as_prisms(assembly: Assembly, depth: float | None = None) -> SpatialAssembly:
    """The same blocks in space, x along the plane and z up.

    Parameters
    ----------
    assembly : Assembly
    depth : float, optional
        Of all blocks, along y [m]; each its own by default.

    Raises
    ------
    InputError
        It has links, or blocks that are no prisms; or the stones cannot stand in space.
    """
    if assembly.links:
        raise InputError(
            f"{assembly.name!r} has links, which are placed in the plane; write it in space, its blocks as box = [x, y, z]."
        )
    stones = tuple(_prism(block, depth) for block in assembly.blocks)
    return SpatialAssembly(
        stones, assembly.joint, assembly.name, assembly.gravity, assembly.ground, overrides=assembly.overrides
    )


def _prism(block: Block, depth: float | None) -> Stone:
    prism = dataclasses.replace(block, solid=None)
    if not np.allclose((prism.mass, *prism.place), (block.mass, *block.place), rtol=1e-9, atol=1e-9):
        raise InputError(
            f"{block.name!r} is no prism of its outline, as a round drum is none; write the assembly in space, where "
            "columns are round."
        )
    half = 0.5 * (block.depth if depth is None else depth)
    corners = [(x, y, z) for x, z in block.vertices for y in (-half, half)]
    return Stone.hull(corners, block.density, name=block.name, fixed=block.fixed, surface=block.surface)
