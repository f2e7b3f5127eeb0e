"""Bodies in the plane in blocks of lanes, and the engines of columns: how a run begins, goes on and ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...column import Column
from ...constants import DEGREE
from ...kernels.run_codes import LANES
from ...kernels.shared.records import LANE, STATE
from ...motion import Motion
from ...response import Collapse
from ...response.collapse import in_plane
from ...response.residuals import Residuals
from ..base import RunOptions
from ..drums.records import LaneRecords, Packed, Topology, sink
from ..drums.runs import FinalStates, LaneRuns
from ..drums.stepped import StackEngine
from ..start import Start, check_in_plane
from .packing import Types, numbers_for


class Records(LaneRecords):
    """Records of bodies in the plane; others as for :class:`LaneRecords`.

    Parameters
    ----------
    types : mapping of str to dtype
        Of :mod:`stylobate.models.plane.packing`.
    """

    axes_of_base = 2

    def __init__(self, types: Types, topology: Topology, spare: int = 0) -> None:
        from ...kernels.plane import step

        super().__init__(types, topology, len(topology.joints), spare)
        self.types, self.kernel = types, step

    def forces(self, lane: int) -> tuple[np.ndarray, ...]:
        """Force along x and z [N] and moment [N m] on every body in its present position, on a copy; shapes (N,)."""
        state = self.now()
        state[STATE.index("lane")]["dt"][0, lane] = 0.0
        self.kernel.gather(state)
        body = state[STATE.index("body")]
        return tuple(body[name][:, lane] for name in ("fx", "fz", "mo"))

    def ledgers(
        self, state: tuple[Any, ...], lanes: np.ndarray, dt: np.ndarray, bases: np.ndarray, out: np.ndarray
    ) -> None:
        """Write the ledgers of lanes of a state whose forces are those of its positions."""
        self.kernel.ledgers(state, np.ascontiguousarray(bases), dt, lanes, out)

    def joint_states(self, lanes: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
        """Opening of every joint, and where the body above it is along it [m], each of shape (lanes, joints)."""
        opening, slip = np.empty((2, len(lanes), len(self.joint)))
        self.kernel.joint_states(self.state, np.array(lanes, dtype=np.int64), opening, slip)
        return opening, slip

    def acceleration(self, lane: int) -> float:
        """Largest acceleration of a body in its present position without input; of its edge, where it turns [m/s²]."""
        fx, fz, mo = self.forces(lane)
        free = self.span["fixed"] == 0
        ax = (fx * self.body["im"][:, lane] - self.lane["gx"][0, lane])[free]
        az = (fz * self.body["im"][:, lane] - self.lane["g"][0, lane])[free]
        edge = np.zeros(len(self.body))
        np.maximum.at(edge, self.pair["upper"][: len(self.joint)].astype(int), self.edges(lane))
        turn = (mo * self.body["ii"][:, lane] * edge)[free]
        return float(np.abs(np.concatenate((ax, az, turn))).max())

    def edges(self, lane: int) -> np.ndarray:
        """Distance of the ends of every joint's upper face from the centroid's foot on it, at most [m], shape (joints,)."""
        return np.maximum(self.joint["bl"][:, lane], self.joint["br"][:, lane])


def slope_base(records: Records, lane: int, motion: Motion, slope: float) -> None:
    """Let a lane's base move along a slope [rad], and note the largest accelerations across gravity and along it."""
    feed, watch = records.feed[0], records.watch[0]
    feed["bc"][lane], feed["bs"][lane] = math.cos(slope), math.sin(slope)
    peak_x, peak_z = motion.pga, motion.peaks.get("z", 0.0)
    watch["amax"][lane] = peak_x * math.cos(slope) + peak_z * abs(math.sin(slope))
    watch["vmax"][lane] = peak_x * abs(math.sin(slope)) + peak_z * math.cos(slope)


def placed(
    start: Start, records: Records, lane: int, gravity: float
) -> tuple[dict[str, np.ndarray], tuple[float, float]]:
    """Fields of the drums of a column that stands tilted and turns as one rigid body, and the force that it rests on.

    The force along x and z [N] is the one that carries the rigid body turning about its edge from there: nothing rings at
    the start.

    Parameters
    ----------
    start : Start
        In the plane of x and z.
    records : Records
        In which the column is, upright and at rest.
    lane : int
    gravity : float
        [m/s²]
    """
    side = leans_right(start)
    angle, rate = (-start.tilt if side else start.tilt), -start.angular_velocity[1]
    body, base = records.body, records.joint[0]
    x, z, m, i = (body[name][1:, lane] for name in ("x", "z", "m", "i"))
    edge = base["br"][lane] if side else -base["bl"][lane]
    across, along = x - x[0] - edge, z - z[0] + base["hb"][lane]  # the base's joint as yet open
    c, s = math.cos(angle), math.sin(angle)
    across, along = c * across - s * along, s * across + c * along
    # the column as one body that turns about its edge
    turning = -gravity * float(m @ across) / float(i.sum() + m @ (across**2 + along**2))
    push = -float(m @ (turning * along + rate**2 * across))
    lift = float(m @ (turning * across - rate**2 * along)) + float(m.sum()) * gravity
    even = np.ones(len(m))
    values = {
        "x": (0.0, x[0] + edge + across),
        "z": (body["z"][0, lane], along),
        "th": (0.0, angle * even),
        "c": (1.0, c * even),
        "s": (0.0, s * even),
        "vx": (0.0, -rate * along),
        "vz": (0.0, rate * across),
        "w": (0.0, rate * even),
    }
    fields = {name: np.concatenate(([base], rest)) for name, (base, rest) in values.items()}
    return fields, (push, max(lift, 0.0))


def leans_right(start: Start) -> bool:
    """Whether a column that starts in the plane leans towards x."""
    return math.cos(start.azimuth) > 0.0


def sink_in(records: Records, lane: int, force: float) -> None:
    """Lower the whole column in a lane until the base carries a force [N]."""
    state = records.now()
    state[LANE]["dt"][0, lane] = 0.0

    def carried() -> float:
        records.kernel.gather(state)
        return float(records.load["fz"][0, lane])

    sink(records.body["z"], lane, force, carried)


def residuals_in(state: dict[str, Any]) -> Residuals:
    """Residuals of a column by the state in which it is left."""
    return Residuals.in_plane(*(state[name] for name in ("slip", "x", "z", "rotation")))


class ColumnLanes(LaneRuns):
    """See :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    types : mapping of str to dtype
        Of the records, by the law of the joints.
    pack : callable
        Gives the numbers of a column.
    topology : Topology
        Of every column in this block.
    options : RunOptions
    cost : float
        About what a step of a run costs [s].
    """

    def __init__(
        self, types: Types, pack: Callable[[Column], Packed], topology: Topology, options: RunOptions, cost: float
    ) -> None:
        self.records = records = Records(types, topology)
        super().__init__(pack, records, options, cost)
        self.slip = np.zeros((self.lanes, topology.stack))
        self.placed = np.zeros((self.lanes, 2, topology.stack))

    def lean(self) -> np.ndarray:
        """Rotation of the lowest body of each lane, towards +x [rad]."""
        return -self.records.body["th"][1]

    def leans(self) -> np.ndarray:
        """The same, and none across the plane, shape (2, lanes)."""
        lean = self.lean()
        return np.stack([lean, np.zeros_like(lean)])

    # -- how a run begins ----------------------------------------------------------------------------------------

    def shake(self, lane: int, motion: Motion) -> None:
        """Note how the base of a lane moves."""
        slope_base(self.records, lane, motion, self.column(lane).as_found.base_tilt * DEGREE)

    @property
    def stood(self) -> tuple[np.ndarray, ...]:
        """Slips of joints, places of drums and of the top as the columns stood."""
        return self.slip, self.placed, self.watch["stood"][0]

    def stand(self, lane: int) -> None:
        """Note how a column stands in a lane."""
        body = self.records.body
        self.slip[lane] = self.records.joint_states([lane])[1][0]
        self.placed[lane] = body["x"][1:, lane], body["z"][1:, lane]
        self.watch["stood"][0, lane] = self.top(lane)

    def take_pose(self, lane: int, column: Column, start: Any) -> None:
        """Tilt a column that stands in a lane."""
        check_in_plane(start, "a model in the plane")
        records = self.records
        fields, (push, lift) = placed(start, records, lane, column.gravity)
        records.fill(lane, body=fields)
        records.joint["fs"][0, :, lane] = 0.0
        records.joint["fs"][0, -1 if leans_right(start) else 0, lane] = push
        sink_in(records, lane, lift)

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        self.records.kernel.advance(self.records.state, chunks)

    def energies_without_tension(self, lane: int, bare: Column) -> np.ndarray:
        """Ledger as if the column stood in a lane without its pretension; ``bare`` is that column [J]."""
        records = Records(self.records.types, Topology.of(bare))
        packed = self.pack(bare)
        records.put(0, packed.lane)
        records.bond[...], records.feed[...] = packed.bond, self.feed
        return records.energies([0], self.dt[lane:], self.ground_accelerations([lane]))[0]

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start; without a pose, of drums that do not move yet in a base that may."""
        half, records = 0.5 * self.dt[lane], self.records
        body = records.body
        ground = self.ground_acceleration(lane)
        turn: float | np.ndarray = 0.0
        if self.options.start is not None:
            fx, fz, mo = (force[1:] for force in records.forces(lane))
            ground = (
                ground[0] - fx * body["im"][1:, lane],
                ground[1] + records.lane["g"][0, lane] - fz * body["im"][1:, lane],
            )
            turn = mo * body["ii"][1:, lane]
        body["vx"][1:, lane] += half * ground[0]
        body["vz"][1:, lane] += half * ground[1]
        body["w"][1:, lane] -= half * turn

    # -- what it tells -------------------------------------------------------------------------------------------

    def top(self, lanes: Any) -> Any:
        """Place of the middle of the topmost face along the base [m], of a lane or of several."""
        b, w = self.records.body[-1], self.watch[0]
        return b["x"][lanes] - (b["s"][lanes] * w["tc"][lanes] + b["c"][lanes] * w["ts"][lanes]) * w["th"][lanes]

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        bottom = self.records.body[1]
        state = {name: values[0] for name, values in self.poses([lane]).items()} | {
            "time": self.time(lane),
            "base": bottom["x"][lane] + bottom["s"][lane] * self.records.joint["hb"][0, lane],
            "top": float(self.top(lane) - self.watch["stood"][0, lane]),
            "energy": self.energies(lane),
        }
        return state | self.links_now(lane)

    def poses(self, lanes: list[int]) -> dict[str, np.ndarray]:
        """Displacements and rotations of drums, openings and slips of joints, from how the columns stood.

        Of shape (lanes, n).
        """
        body, (opening, slip) = self.records.body, self.records.joint_states(lanes)
        x, z, rotation = (body[name][1:, lanes].T for name in ("x", "z", "th"))
        return {
            "x": x - self.placed[lanes, 0],
            "z": z - self.placed[lanes, 1],
            "rotation": rotation,
            "opening": opening,
            "slip": slip - self.slip[lanes],
        }

    def final_states(self, lanes: list[int]) -> FinalStates:
        """What the runs of some lanes leave behind."""
        state = self.poses(lanes)
        slip, residuals = state["slip"], Residuals.all_in_plane(*(state[key] for key in ("slip", "x", "z", "rotation")))
        top = self.top(lanes) - self.watch["stood"][0, lanes]
        return FinalStates(residuals, np.abs(slip), slip, top, self.peaks(lanes, "turn"))

    def stay(self, lanes: list[int], energy: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Whether columns that no input shakes any more can neither overturn nor slide apart, shape (lanes,).

        Two conditions, Eq. (V1). As the column is, the centroid of every part stands within its contact: it is on the near
        side of every barrier. And the energy is below the lowest barrier of the column put down flat with its present
        offsets: overturning as one body about the nearer end of the contact, m g (R − H); where some joint above is so
        slippery that it slides first, tan φ below the sine of the critical angle, sliding and lifting together:
        m g [tan φ b − H (1 − √(1 − tan² φ))]. On a slope H and b are measured along and across gravity, and friction is what
        the slope of the joint leaves of it. Soft joints give, and the barrier is lower by that,
        Eq. (V5).
        """
        from ...kernels.plane.standing import all_stand

        columns, records = [self.column(lane) for lane in lanes], self.records
        stand, offsets = zip(*map(numbers_for, columns), strict=True)
        stand = np.array([array.view(float) for array in stand]).view(
            stand[0].dtype
        )  # numpy stacks records field by field
        stand["toe"], stand["others"] = np.array([self.packed[lane].stand for lane in lanes]).swapaxes(0, 1)
        gravity, slope = np.array([(column.gravity, column.as_found.base_tilt * DEGREE) for column in columns]).T
        where, stays = np.array(lanes, dtype=np.int64), np.zeros(len(lanes), dtype=bool)
        numbers = offsets + slip, gravity.copy(), slope.copy(), energy
        all_stand(stand, *numbers, records.body, records.joint, where, stays)
        return stays

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane: what is lost turns about the joint that is widest open, there or higher up."""
        watch = self.watch[0]
        parted = bool(watch["parted"][lane])
        joint = 1 + int(watch["which" if parted else "about"][lane])
        time = float(watch["when"][lane] * self.dt[lane])
        return in_plane(time, joint, float(watch["side"][lane]), slid_off=parted)


class PlaneStack(StackEngine):
    """Base of the engines of columns in the plane; each gives the law of their joints."""

    def record_types(self, linked: bool, lanes: int = LANES) -> Types:
        """Types of the records by the law of the joints, for columns with links or without."""
        raise NotImplementedError

    def block_for(self, kind: Topology, options: RunOptions, lanes: int = LANES) -> ColumnLanes:
        """A block of lanes for columns of a kind."""
        types = self.record_types(bool(kind.links), lanes)
        return ColumnLanes(types, self.pack, kind, options, self.model.cost(kind.stack))
