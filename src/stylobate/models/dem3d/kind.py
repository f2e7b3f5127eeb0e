"""Kinds of columns and bodies in space: what shares a block of lanes, and which records and kernels are for it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...kernels.dem3d.records import types
from ...kernels.run_codes import LANES
from ..drums.bodies import Topology

#: In place of a section: one body that stands on its vertices; round drums on rings, or with chips.
SPECIMEN, RING, CHIPPED = "specimen", "ring", "chipped"

#: On what the bodies of a section stand, as the kernels' records are told; others by the law of contact.
FACES = {SPECIMEN: "vertex", "rectangular": "corner", RING: "ring", CHIPPED: "chip"}

#: The contacts of a single body: with the base.
ALONE = Topology(2, ((0, 1),), stack=1)


class Kind(NamedTuple):
    """Common block of lanes.

    Parameters
    ----------
    topology : Topology
    section : str
    rows : int
        Of the records of joints.
    law : str
        Of round faces.
    damped, rolls : bool
        Whether there are dashpots, and resistance to rolling.
    """

    topology: Topology
    section: str
    rows: int
    law: str
    damped: bool
    rolls: bool

    @property
    def face(self) -> str:
        """On what the bodies stand, as the kernels' records are told."""
        return FACES.get(self.section, self.law)

    def record_types(self, linked: bool, lanes: int = LANES) -> dict[str, np.dtype]:
        """Types of the kernel's records, with links or without."""
        return types(self.face, self.damped, self.rolls, linked, lanes)
