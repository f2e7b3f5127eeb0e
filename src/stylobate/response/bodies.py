"""The bodies that a column or an assembly consists of: names, shapes, and what the poses of plane models refer to."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from ..column import Column, Drum
from ..column.as_found import FoundDrum
from ..column.assembly import FAR_AWAY, Assembly
from ..column.found_geometry import CHIP_SLOPE, geometry
from ..column.specimen import Specimen
from ..constants import DEGREE
from .poses import Reference
from .shapes import Chipped, CircularFrustum, ConvexSolid, Prism, RectangularFrustum, Shape


@dataclass(frozen=True, eq=False)
class Bodies:
    """All bodies of a structure, in the order of the response's columns.

    Parameters
    ----------
    names : tuple of str
    shapes : tuple of Shape
    fixed : tuple of bool
        Which of them move with the ground.
    reference : Reference
        What the poses of plane models refer to.
    level : float or None
        Height of the ground at x = 0 [m]; None for no ground.
    """

    names: tuple[str, ...]
    shapes: tuple[Shape, ...]
    fixed: tuple[bool, ...]
    reference: Reference
    level: float | None = 0.0

    @property
    def shown(self) -> tuple[int, ...]:
        """Bodies that a picture shows: all but a ground without ends."""
        far = [
            fixed and np.ptp(shape.outline, axis=0).max() > FAR_AWAY for shape, fixed in zip(self.shapes, self.fixed)
        ]
        return tuple(i for i, away in enumerate(far) if not away)


@singledispatch
def bodies_of(structure: object) -> Bodies:
    """Bodies of what stood; a new kind of structure registers its own."""
    raise TypeError(f"{type(structure).__name__} has no bodies that could be shaken.")


@bodies_of.register
def _(structure: Column) -> Bodies:
    at, found = geometry(structure), structure.as_found
    slope = found.base_tilt * DEGREE
    shapes: list[Shape] = []
    for i, drum in enumerate(structure.drums):
        one, high = found.of(i + 1), drum.centroid_height
        if drum.circular:
            whole = CircularFrustum(drum.bottom_width, drum.top_width, drum.height, high)
        else:
            sides = (drum.bottom_width, drum.depth), (drum.top_width, drum.upper_depth)
            whole = RectangularFrustum(*sides, drum.height, high)
        shapes.append(Chipped(whole, chips_of(drum, one)) if one.chipped else whole)
    names = tuple(f"drum {i + 1}" for i in range(structure.n))
    return Bodies(names, tuple(shapes), (False,) * structure.n, Reference(at.centroid, at.lean + at.tilt, slope))


def chips_of(drum: Drum, one: FoundDrum) -> np.ndarray:
    """Planes that cut the chips off a drum: outward normals, and distances from its centroid [m], shape (k, 4)."""
    planes = []
    for chip, azimuth, low, high in zip(
        one.chips,
        np.array([180.0, 0.0, 270.0, 90.0]) + one.chip_azimuth,
        (drum.bottom_width, drum.bottom_width, drum.depth, drum.depth),
        (drum.top_width, drum.top_width, drum.upper_depth, drum.upper_depth),
        strict=True,
    ):
        if chip:
            share = min(CHIP_SLOPE * chip / drum.height, 0.5)
            along, up = chip + 0.5 * share * (high - low), share * drum.height
            size, angle = math.hypot(along, up), azimuth * DEGREE
            normal = np.array([up * math.cos(angle), up * math.sin(angle), -along]) / size
            planes.append((*normal, (up * (0.5 * low - chip) + along * drum.centroid_height) / size))
    return np.array(planes)


@bodies_of.register
def _(structure: Assembly) -> Bodies:
    blocks = structure.bodies
    return Bodies(
        tuple(block.name for block in blocks),
        tuple(Prism(block.corners - block.origin, block.depth) for block in blocks),
        tuple(block.fixed for block in blocks),
        Reference(np.zeros((len(blocks), 2)), np.zeros(len(blocks))),
        structure.ground,
    )


@bodies_of.register
def _(structure: Specimen) -> Bodies:
    return Bodies(
        (structure.name,),
        (ConvexSolid(structure.vertices),),
        (False,),
        Reference(np.zeros((1, 2)), np.zeros(1)),
    )
