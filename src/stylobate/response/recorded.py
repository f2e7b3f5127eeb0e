"""Data of one run: what stood, histories, measures and provenance, and its bodies in space.

Words, tables, pages and files are made from it; :class:`stylobate.Response` is the same with all of these at hand.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..column import Column
from ..column.assembly import Assembly
from ..column.shapes import hull
from ..column.structure import Structure
from .bodies import Bodies, bodies_of
from .histories import Histories
from .measures import Measures
from .mechanism import Mechanism
from .poses import PlanePoses, SpacePoses, exaggerated, rotation_matrices
from .views import Views


@dataclass(frozen=True, eq=False, repr=False)
class Recorded(Views):
    """One run as data; everything relative to the moving base. The fields are those of :class:`stylobate.Response`."""

    structure: Structure
    histories: Histories
    measures: Measures
    model: str
    provenance: dict
    wall_time: float = 0.0
    mechanism: Mechanism | None = None
    followed: bool = False
    twins: tuple[Measures, ...] = ()

    @property
    def column(self) -> Column:
        """The column that stood."""
        return self.structure.must_be("column")

    @property
    def assembly(self) -> Assembly:
        """The assembly that stood."""
        return self.structure.must_be("assembly")

    # -- bodies --------------------------------------------------------------------------------------------------

    @cached_property
    def bodies(self) -> Bodies:
        """Names and shapes of all bodies."""
        return bodies_of(self.structure)

    @property
    def poses(self) -> SpacePoses:
        """Position and orientation of every body in space."""
        return self._in_space

    @cached_property
    def _in_space(self) -> SpacePoses:
        recorded = self.histories.poses
        return self.bodies.reference.space(recorded) if isinstance(recorded, PlanePoses) else recorded

    def outline(self, index: int, body: int, factor: float = 1.0) -> np.ndarray:
        """Corners of a body at a recorded state as seen along y, horizontally and upward [m], shape (k, 2).

        Parameters
        ----------
        index, body : int
            Number of the state and of the body, from 0.
        factor : float
            By which displacements and rotations are drawn larger.
        """
        shape, recorded = self.bodies.shapes[body], self.histories.poses
        if isinstance(recorded, PlanePoses):
            x, z, angle = self._plane(factor)[index, body] if factor != 1.0 else self._placed[index, body]
            c, s = np.cos(angle), np.sin(angle)
            return shape.outline @ np.array([[c, s], [-s, c]]) + (x, z)
        pose = exaggerated(recorded, index, factor)
        corners = shape.mesh().vertices @ rotation_matrices(pose.orientation[body]).T + pose.position[body]
        return hull(corners[:, [0, 2]])

    @cached_property
    def _placed(self) -> np.ndarray:
        return self._plane(1.0)

    def _plane(self, factor: float) -> np.ndarray:
        recorded = self.histories.poses
        assert isinstance(recorded, PlanePoses)
        return self.bodies.reference.plane(recorded, factor)
