"""The bodies that a column or an assembly consists of: names, shapes, and what the poses of plane models refer to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..column.block import FAR_AWAY
from ..column.shapes import Shape
from ..column.structure import Structure
from ..constants import DEGREE
from .poses import Reference


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


def bodies_of(structure: Structure) -> Bodies:
    """Bodies of what stood that a run records."""
    bodies = structure.bodies[structure.first :]
    stand = [(*body.place, body.angle) if structure.relative else (0.0, 0.0, 0.0) for body in bodies]
    at = np.array(stand)
    return Bodies(
        tuple(body.name for body in bodies),
        tuple(body.shape for body in bodies),
        tuple(body.fixed for body in bodies),
        Reference(at[:, :2], at[:, 2], structure.as_found.base_tilt * DEGREE),
        structure.ground,
    )
