"""Drums on one another in the lanes of a block in space: how they start from a pose, and what is told of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...column import Column
from ...kernels.shared.records import LANE
from ...response import Collapse
from ...response.collapse import what_is_lost
from ..drums.records import Packed, sink
from ..start import check_in_plane, check_takes_pose
from .arrays import Records
from .pose import placed
from .verdict import found_numbers


class Stack:
    """See :class:`stylobate.models.dem3d.block.Bodies`.

    Parameters
    ----------
    planar : bool
        The motion is held in the plane of x and z, where no drum walks.
    pivots : bool
        Round drums turn about their axes with less than all of the torsional friction.
    """

    def __init__(self, *, planar: bool, pivots: bool = False) -> None:
        self.planar, self.pivots = planar, pivots and not planar

    def check_start(self, structure: Column, start: Any) -> None:
        """Refuse a start that is not one for this column."""
        check_takes_pose(start, structure)
        if self.planar:
            check_in_plane(start, "planar = True")

    def take_pose(self, records: Records, lane: int, structure: Column, start: Any) -> None:
        """Tilt a column that stands in a lane."""
        drums, joints, force = placed(structure, start, records.body, lane)
        records.fill(lane, body=drums, joint=joints)
        state = records.now()  # of bodies that sink
        state[LANE]["dt"][0, lane] = 0.0

        def carried() -> float:
            records.kernel.forces(state)
            return float(records.load["f"][0, 2, lane])

        sink(records.body["z"], lane, force, carried)

    def top(self, records: Records, lane: int) -> np.ndarray:
        """Place of the middle of the topmost face along the base [m], shape (2,)."""
        d = records.body[-1]
        return np.array([d[c][lane] + d["ht"][lane] * d["k" + c][lane] for c in "xy"])

    def foot(self, records: Records, lane: int, structure: Column) -> np.ndarray:
        """Place of the middle of the lowest face [m], shape (3,)."""
        return records.places(lane)[0] + records.axes(lane)[0] @ records.vectors(lane, "fx fy fz")[0]

    def stays(self, packed: Packed, records: Records, lane: int, structure: Column, energy: float) -> bool:
        """Whether the column in a lane with so much energy above that at rest [J] stands for good. Eq. (V1), in space.

        A drum that wobbles on another one may walk: joints between drums have their support narrowed by ``WALK``
        (``kernels/dem3d/standing.py``). Walking without slip costs nothing, so that no bound by energy is a proof; the
        margin is measured, see the theory page. What drums that pivot freely turn costs nothing either, and slopes, offsets
        and chips turn with them: nothing bounds where they come to.
        """
        from ...kernels.dem3d.standing import stands
        from ...kernels.dem3d.standing_found import stands_as_found

        _, slip, _ = records.joints(lane)
        walks, of_lane = not self.planar, (records.body, records.joint, records.lane, lane)
        if not structure.as_found:
            return bool(stands(packed.stand, slip, energy, structure.gravity, walks, *of_lane))
        drums = structure.as_found.drums
        if self.pivots and structure.section == "circular" and any(d.offset or d.tilt or d.chipped for d in drums):
            return False
        found, up, high = found_numbers(structure)
        numbers = found, packed.stand, slip, energy, high, up, structure.gravity, walks
        return bool(stands_as_found(*numbers, *of_lane))

    def lost(self, collapse: Collapse, structure: Column) -> str:
        """What has come down, in words."""
        return what_is_lost(collapse, structure.n)
