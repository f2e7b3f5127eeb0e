"""A block of lanes of bodies in space: the way of a case into the engine's records, and of its results out of them.

What drums on one another and a single body do each in their own way is asked of what is handed to the block.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...column import Column
from ...kernels.shared.records import LANE, STATE
from ...messages import say
from ...motion import Motion
from ...response import Collapse
from ...response.collapse import OVERTURNED, SLID_OFF, what_is_lost
from ...response.measures import SpaceMeasures
from ...response.residuals import Residuals, turned_up
from ..base import RunOptions
from ..drums.records import Packed, sink
from ..drums.runs import FinalStates, LaneRuns
from ..shared.lanes import in_rows
from ..start import check_in_plane, check_takes_pose
from .packing import Records, found_numbers, placed
from .specimen import FreeBody


class Stack:
    """Drums on one another: how they start from a pose, and what is told of them; a single body is a :class:`FreeBody`.

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

    def top(self, records: Records, lanes: np.ndarray) -> np.ndarray:
        """Place of the middle of the topmost face along the base [m], shape (lanes, 2)."""
        d = records.body[-1]
        return np.stack([d[c][lanes] + d["ht"][lanes] * d["k" + c][lanes] for c in "xy"], axis=-1)

    def leaning(self, records: Records) -> np.ndarray:
        """Component towards +x of the axis of the lowest drum of each lane [-]."""
        return records.body["kx"][1]

    def foot(self, records: Records, lane: int, structure: Column) -> np.ndarray:
        """Place of the middle of the lowest face [m], shape (3,)."""
        return records.places(lane)[0] + records.axes(lane)[0] @ records.vectors(lane, "fx fy fz")[0]

    def stay(
        self,
        packed: Sequence[Packed],
        records: Records,
        lanes: np.ndarray,
        structures: Sequence[Column],
        energy: np.ndarray,
        slip: np.ndarray,
    ) -> np.ndarray:
        """Whether columns in lanes with so much energy above that at rest [J] stand for good. Eq. (V1), in space.

        A drum that wobbles on another one may walk: joints between drums have their support narrowed by ``WALK``
        (``kernels/dem3d/standing.py``). Walking without slip costs nothing, so that no bound by energy is a proof; the
        margin is measured, see the theory page. What drums that pivot freely turn costs nothing either, and slopes, offsets
        and chips turn with them: nothing bounds where they come to.
        """
        from ...kernels.dem3d.standing import all_stand

        walks, of_lanes = not self.planar, (records.body, records.joint, records.lane)
        stays = np.zeros(len(lanes), dtype=bool)
        built = np.array([not structure.as_found for structure in structures])
        if built.any():
            stand, gravity = zip(
                *((packed[k].stand, structures[k].gravity) for k in np.flatnonzero(built).tolist()), strict=True
            )
            stand = np.array([array.view(float) for array in stand]).view(
                stand[0].dtype
            )  # numpy stacks records field by field
            numbers = stand, slip[built], energy[built], np.array(gravity)
            verdicts = np.zeros(len(stand), dtype=bool)
            all_stand(*numbers, walks, *of_lanes, lanes[built], verdicts)
            stays[built] = verdicts
        for k in np.flatnonzero(~built).tolist():
            stays[k] = self._stays_as_found(
                packed[k], structures[k], float(energy[k]), slip[k], *of_lanes, int(lanes[k])
            )
        return stays

    def _stays_as_found(
        self, packed: Packed, structure: Column, energy: float, slip: np.ndarray, *of_lane: Any
    ) -> bool:
        """The same of a column that is not as built; ``of_lane`` are records of bodies, joints and lanes, and its lane."""
        from ...kernels.dem3d.standing import stands_as_found

        drums = structure.as_found.drums
        if self.pivots and structure.section == "circular" and any(d.offset or d.tilt or d.chipped for d in drums):
            return False
        found_drums, up, high = found_numbers(structure)
        numbers = found_drums, packed.stand, slip, energy, high, up, structure.gravity, not self.planar
        return bool(stands_as_found(*numbers, *of_lane))

    def lost(self, collapse: Collapse, structure: Column) -> str:
        """Fallen bodies, in words."""
        return what_is_lost(collapse, structure.n)


#: Methods that stacked drums and a single body have each in their own way.
Bodies = Stack | FreeBody


class SpaceBlock(LaneRuns):
    """See :class:`stylobate.models.shared.lanes.LaneBlock`; others as for :class:`LaneRuns`.

    Parameters
    ----------
    records : Records
    bodies : Bodies
    pack : callable
        Gives the numbers of a column or a body.
    planar : bool
        Hold the motion in the plane of x and z.
    """

    def __init__(
        self,
        records: Records,
        bodies: Bodies,
        pack: Callable[[Any], Packed],
        options: RunOptions,
        cost: float,
        *,
        planar: bool = False,
    ) -> None:
        super().__init__(pack, records, options, cost)
        self.records, self.bodies, self.planar = records, bodies, planar
        n = len(records.body) - 1
        self.placed = np.zeros((self.lanes, n, 3)), np.zeros((self.lanes, n, 3, 3))

    # -- how a run begins ----------------------------------------------------------------------------------------

    def lean(self) -> np.ndarray:
        """Rotation of the lowest body of each lane, held in its plane, towards +x [rad]."""
        return np.arcsin(np.clip(self.bodies.leaning(self.records), -1.0, 1.0))

    def leans(self) -> np.ndarray:
        """Lean of the lowest body of each lane from its upright axis, towards x and y [rad], shape (2, lanes)."""
        flat = np.stack([self.records.body[name][1] for name in ("kx", "ky")])
        size = np.hypot(*flat)
        lean = np.arctan2(size, self.records.body["kz"][1])
        return flat * np.divide(lean, size, out=np.ones_like(size), where=size > 0.0)

    @property
    def stood(self) -> tuple[np.ndarray, ...]:
        """Places and axes of bodies as they stood."""
        return self.placed

    def stand(self, lane: int) -> None:
        """Note how a column stands in a lane."""
        for kept, current in zip(self.placed, (self.records.places(lane), self.records.axes(lane)), strict=True):
            kept[lane] = current

    def shake(self, lane: int, motion: Motion) -> None:
        """Note how the base of a lane moves."""
        feed, watch = self.feed[0], self.watch[0]
        flat, high = motion.plan_peak, motion.peaks.get("z", 0.0)
        level, slope = float(feed["r"][8, lane]), math.hypot(feed["r"][2, lane], feed["r"][5, lane])
        watch["amax"][lane] = flat + slope * high
        watch["vmax"][lane] = level * high + slope * flat

    def check_start(self, column: Any) -> None:
        """Refuse a start that is not one for what stands in the block."""
        self.bodies.check_start(column, self.options.start)

    def take_pose(self, lane: int, column: Any, start: Any) -> None:
        """Put what stands in a lane where a run starts from."""
        self.bodies.take_pose(self.records, lane, column, start)

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start; without a pose, of bodies that do not move yet in a base that may."""
        half, records, body = 0.5 * self.dt[lane], self.records, self.records.body
        kick = self.ground_acceleration(lane)[None]
        if self.options.start is not None:
            force, moment = records.net(lane)
            kick = kick + records.lane["g"][0, :, lane] - force * body["im"][1:, lane, None]
            for c, name in enumerate("xyz"):
                body["l" + name][1:, lane] -= half * moment[:, c]
            self.turn_with_momentum(lane)
        for c, name in enumerate(("vx", "vy", "vz")):
            body[name][1:, lane] += half * kick[:, c]
        if self.planar:
            for name in ("vy", "lx", "lz"):
                body[name][1:, lane] = 0.0

    def turn_with_momentum(self, lane: int) -> None:
        """Angular velocities that go with the angular momenta."""
        body = self.records.body
        inertia_terms = {name: body[name][1:, lane, None] for name in ("ia", "ib", "ic")}
        momentum, i, k = (self.records.vectors(lane, f"{a}x {a}y {a}z") for a in "lik")
        about_i, about_k = ((momentum * axis).sum(axis=1, keepdims=True) * axis for axis in (i, k))
        turning = inertia_terms["ia"] * momentum + inertia_terms["ib"] * about_i + inertia_terms["ic"] * about_k
        for c, name in enumerate("xyz"):
            body["w" + name][1:, lane] = turning[:, c]

    def energies_without_tension(self, lane: int, bare: Column) -> np.ndarray:
        """Ledger of a lane as if the column stood there without its pretension; ``bare`` is that column [J]."""
        state = self.records.now("body")
        numbers, end = self.pack(bare).lane, 0
        for name in ("body", "joint", "lane"):
            rows = in_rows(state[STATE.index(name)], self.lanes)
            begin, end = end, end + len(rows)
            rows[:, lane] = numbers[begin:end]
        link = state[STATE.index("link")]
        link["on"][:, lane] = link["ft"][:, lane] = 0.0
        return self.records.energies([lane], self.dt, self.ground_accelerations([lane]), state)[0]

    # -- how it goes on ------------------------------------------------------------------------------------------

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        self.records.kernel.advance(self.records.state, chunks)

    # -- what it tells -------------------------------------------------------------------------------------------

    def top(self, lanes: np.ndarray) -> np.ndarray:
        """Displacement of the top along the base [m], shape (lanes, 2)."""
        return self.bodies.top(self.records, lanes) - np.stack(
            [self.watch[name][0, lanes] for name in ("sx", "sy")], axis=-1
        )

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        column = self.column(lane)
        axes, own = self.records.axes(lane), self.packed[lane].axes
        opening, slip, twist = self.records.joints(lane)
        return {
            "time": self.time(lane),
            "position": self.records.places(lane),
            "axes": axes if own is None else axes @ own,
            "opening": opening,
            "slip": slip,
            "twist": twist,
            "base": self.bodies.foot(self.records, lane, column)[:2],
            "top": self.top(np.array([lane]))[0],
            "energy": self.energies(lane),
        } | self.links_now(lane)

    def final_states(self, lanes: list[int]) -> FinalStates:
        """What the runs of some lanes leave behind."""
        which, records = np.array(lanes, dtype=np.int64), self.records
        _, slip, twist = records.joints(which)
        place, axes = (array[which] for array in self.placed)
        up = turned_up(records.axes(which), axes)
        residuals = Residuals.all_in_space(slip, twist, records.places(which) - place, up)
        topx, topy, lean, turn, spin = (
            self.peaks(lanes, name).tolist() for name in ("topx", "topy", "lean", "turn", "spin")
        )
        lean, tilt = ([math.acos(max(-1.0, 1.0 - peak)) for peak in peaks] for peaks in (lean, turn))
        space = [SpaceMeasures(*row) for row in zip(topx, topy, tilt, spin, strict=True)]
        top = np.hypot(*self.top(which).T)
        return FinalStates(residuals, np.hypot(*np.moveaxis(slip, -1, 0)), slip, top, np.array(lean), space)

    def stay(self, lanes: list[int], energy: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Whether what stands in lanes with so much energy above that at rest [J] stands for good, shape (lanes,)."""
        packed, columns = zip(*((self.packed[lane], self.column(lane)) for lane in lanes), strict=True)
        return self.bodies.stay(packed, self.records, np.array(lanes, dtype=np.int64), columns, energy, slip)

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane, with its direction in plan."""
        watch = self.watch[0]
        parted = bool(watch["parted"][lane])
        return Collapse(
            time=float(watch["when"][lane] * self.dt[lane]),
            joint=1 + int(watch["which" if parted else "about"][lane]),
            mechanism=SLID_OFF if parted else OVERTURNED,
            azimuth=math.atan2(watch["ey"][lane], watch["ex"][lane]),
        )

    def lost(self, collapse: Collapse, column: Any) -> str:
        """Fallen bodies, and their places, in words."""
        azimuth = math.degrees(collapse.azimuth or 0.0)
        return say(
            "{lost}, towards azimuth {azimuth}° (from x towards y)",
            lost=self.bodies.lost(collapse, column),
            azimuth=round(azimuth) % 360,
        )
