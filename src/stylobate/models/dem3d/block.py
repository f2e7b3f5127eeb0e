"""A block of lanes of drums in space: the way of a case into the kernels' arrays, and of its results out of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...column import Column
from ...column.found_in_space import base_axes
from ...kernels.run_codes import COLLAPSED, FAILED, RUNNING
from ...outcome import Outcome, classify
from ...response import Collapse, Measures
from ...response.collapse import OVERTURNED, SLID_OFF
from ...response.measures import SpaceMeasures
from ..base import Case, RunOptions
from ..drums.histories import ledger_imbalance
from ..drums.packing import PackedColumn, whole_steps
from ..drums.runs import CALLS_PER_RUN, LaneRuns
from ..shared import ledger
from ..shared.ground import value_at
from ..start import check_in_plane
from .arrays import join_links, stack_arrays, state_of
from .links import SpaceLinks
from .pose import placed, sink
from .touching import slips_where_closest
from .verdict import stands_for_good


class SpaceBlock(LaneRuns):
    """See :class:`stylobate.models.shared.lanes.LaneBlock`; others as for :class:`LaneRuns`.

    Parameters
    ----------
    types : dict of dtype
        Of the kernel's records by their names.
    planar : bool
        Hold the motion in the plane of x and z.
    """

    def __init__(
        self,
        kernel: Any,
        types: dict[str, np.dtype],
        pack: Callable[[Any], PackedColumn],
        drums: int,
        options: RunOptions,
        cost: float,
        links: int = 0,
        rows: int | None = None,
        *,
        planar: bool,
    ) -> None:
        self.kernel, self.planar = kernel, planar
        self.arrays = stack_arrays(types, drums + 1, drums if rows is None else rows, links)
        self.drum, self.joint, self.ground = (self.arrays[name] for name in ("body", "joint", "ground"))
        self.state = state_of(self.arrays)
        lane, feed, watch, link = (self.arrays[name] for name in ("lane", "feed", "watch", "link"))
        super().__init__(pack, (lane, feed, watch, link), options, cost)

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        self.cases[lane] = case
        motion = case.motion
        dt, chunks = whole_steps(motion, self.options.tail, self.place(lane, case))
        steps = chunks * self.chunk
        feed, watch = self.feed[0], self.watch[0]
        for name, samples in (("x", motion.samples), ("y", motion.y_samples), ("z", motion.z_samples)):
            feed[name][lane] = 0 if samples is None else samples.ctypes.data
        feed["last"][lane] = motion.steps - 1
        feed["step"][lane], feed["end"][lane] = self.spans.begin(lane, case, dt, steps)
        feed["ratio"][lane] = dt / motion.dt
        feed["factor"][lane] = motion.factor
        base = self.base(case)
        feed["r"][:, lane] = base.T.ravel()
        for name in watch.dtype.names:
            watch[name][lane] = 0
        watch["status"][lane] = RUNNING
        watch["follow"][lane] = self.options.until_end
        watch["when"][lane] = watch["which"][lane] = watch["wide"][lane] = -1
        sides = np.zeros(2) if motion.y_samples is None else motion.y_samples
        flat = motion.samples**2 + sides**2 if len(sides) == motion.steps else motion.samples**2
        along = math.sqrt(float(flat.max())) * abs(motion.factor)
        high = 0.0 if motion.z_samples is None else float(np.abs(motion.z_samples).max()) * abs(motion.factor)
        level, slope = float(base[2, 2]), math.hypot(*base[2, :2])
        watch["amax"][lane] = along + slope * high
        watch["vmax"][lane] = level * high + slope * along
        self.lane["dt"][0, lane] = self.dt[lane] = dt
        if self.tied:
            links = self.pack(case.column).links
            assert links is not None
            self.put_links(links, lane, dt)
        watch["sx"][lane], watch["sy"][lane] = self.top_place(lane)
        self.mark_start(lane)
        self.steps[lane] = steps
        self.chunks_per_call = max(1, chunks // CALLS_PER_RUN)
        self.begin(lane)

    def base(self, case: Case) -> np.ndarray:
        """Axes of the base as columns, in those of the motion [-], shape (3, 3)."""
        return base_axes(case.column)

    def place(self, lane: int, case: Case) -> float:
        """Put a column at rest into a lane; its step [s]."""
        packed = self.pack(case.column)
        for array, fields in zip((self.drum, self.joint, self.lane), packed.fields, strict=True):
            for name, values in fields.items():
                array[name][..., lane] = values
        self.joint["d"][..., lane] = 0.0
        return packed.step

    def put_links(self, links: SpaceLinks, lane: int, step: float) -> None:
        """Write links into a lane; ``step`` is that of time [s]."""
        for name, values in links.bond.items():
            self.arrays["bond"][name] = values
        for name, values in links.link.items():
            self.link[name][..., lane] = values
        self.link["dt"][:, lane] = step
        join_links(self.arrays, links.lower, links.upper)

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        self.kernel.advance(self.state, chunks)

    def mark_start(self, lane: int) -> None:
        """Keep where the drums stood, and how on each other."""
        self.joint["tw"][:, lane] = 0.0
        _, slip, twist = self.joints(lane)
        self.joint["ox"][:, lane], self.joint["oy"][:, lane] = slip.T
        self.joint["ot"][:, lane] = self.joint["tw"][:, lane] = twist
        for c in "xyz":
            self.drum["a" + c][..., lane] = self.drum["k" + c][..., lane]

    def take_pose(self, lane: int, column: Any, start: Any) -> None:
        """Tilt a column that stands in a lane."""
        if self.planar:
            check_in_plane(start, "planar = True")
        drums, joints, force = placed(column, start, self.drum, lane)
        for array, fields in ((self.drum, drums), (self.joint, joints)):
            for name, values in fields.items():
                array[name][..., lane] = values
        now = self.copies(lane, body=self.drum)  # which sinks

        def carried() -> float:
            self.kernel.forces(state_of(now))
            return float(now["load"]["f"][0, 2, lane])

        sink(self.drum, lane, force, carried)

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start; without a pose, of drums that do not move yet in a base that may."""
        half, drum = 0.5 * self.dt[lane], self.drum
        kick = np.repeat(self.ground_acceleration(lane, self.time(lane))[None], len(drum) - 1, axis=0)
        if self.options.start is not None:
            force, moment = self.net(lane)
            kick = kick + self.lane["g"][0, :, lane] - force * drum["im"][1:, lane, None]
            for c, name in enumerate("xyz"):
                drum["l" + name][1:, lane] -= half * moment[:, c]
            self.turn_with_momentum(lane)
        for c, name in enumerate(("vx", "vy", "vz")):
            drum[name][1:, lane] += half * kick[:, c]
        if self.planar:
            for name in ("vy", "lx", "lz"):
                drum[name][1:, lane] = 0.0

    def turn_with_momentum(self, lane: int) -> None:
        """Angular velocities that go with the angular momenta."""
        one = {name: self.drum[name][1:, lane, None] for name in ("ia", "ib", "ic")}
        momentum, i, k = (np.stack([self.drum[a + c][1:, lane] for c in "xyz"], axis=-1) for a in "lik")
        about_i, about_k = ((momentum * axis).sum(axis=1, keepdims=True) * axis for axis in (i, k))
        turning = one["ia"] * momentum + one["ib"] * about_i + one["ic"] * about_k
        for c, name in enumerate("xyz"):
            self.drum["w" + name][1:, lane] = turning[:, c]

    def ground_acceleration(self, lane: int, time: float) -> np.ndarray:
        """Acceleration of the base in its own axes at a time [m/s²], shape (3,)."""
        case = self.cases[lane]
        assert case is not None
        motion = case.motion
        place, a = time / motion.dt, np.zeros(3)
        for c, samples in enumerate((motion.samples, motion.y_samples, motion.z_samples)):
            if samples is not None:
                a[c] = value_at(samples, place) * motion.factor
        return self.feed["r"][0, :, lane].reshape(3, 3) @ a

    def joints(self, lane: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Opening of every joint [m], its slip where it is closest [m], and its twist, with its full turns [rad].

        Shapes (n,), (n, 2), (n,).
        """
        n = len(self.drum) - 1
        opening, slip, twist = np.empty(n), np.empty((n, 2)), np.empty(n)
        self.kernel.joint_state(self.drum, self.joint, lane, opening, slip, twist)
        return opening, slips_where_closest(self.drum, lane, slip, twist, self.joint["chip"][:, :, lane]), twist

    def since_start(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Slip [m] and twist [rad] of every joint since the start, shapes (n, 2) and (n,)."""
        _, slip, twist = self.joints(lane)
        return self._moved(lane, slip, twist)

    def _moved(self, lane: int, slip: np.ndarray, twist: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        first = np.stack((self.joint["ox"][:, lane], self.joint["oy"][:, lane]), axis=1)
        return slip - first, twist - self.joint["ot"][:, lane]

    def top_place(self, lane: int) -> np.ndarray:
        """Place of the middle of the topmost face along the base [m], shape (2,)."""
        d = self.drum[-1]
        return np.array([d[c][lane] + d["ht"][lane] * d["k" + c][lane] for c in "xy"])

    def axes(self, lane: int) -> np.ndarray:
        """Axes of every drum as the columns of a matrix [-], shape (n, 3, 3)."""
        return np.stack([np.stack([self.drum[a + c][1:, lane] for c in "xyz"], axis=-1) for a in "ijk"], axis=-1)

    def copies(self, lane: int, step: float = 0.0, **others: np.ndarray) -> dict[str, Any]:
        """The arrays, with copies of all that changes where forces are asked for, for a step of a lane [s]."""
        names = ("body", "joint", "load", "link", "lane")
        found = self.arrays | {name: self.arrays[name].copy() for name in names} | others
        found["lane"]["dt"][0, lane] = step
        return found

    def net(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Forces [N] and moments [N m] of their contacts on every drum in its present position, each of shape (n, 3)."""
        now = self.copies(lane)
        self.kernel.gather(state_of(now))
        return now["body"]["f"][1:, :, lane], now["body"]["mo"][1:, :, lane]

    def energies(self, lane: int) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J]."""
        # the forces at the present positions, found as the next step will find them
        return self.ledger_of(lane, self.copies(lane, self.dt[lane]))

    def ledger_of(self, lane: int, now: dict[str, Any]) -> np.ndarray:
        """The same of these arrays, which are changed."""
        ground: Any = np.zeros(1, self.ground.dtype)
        now["ground"] = ground
        ground["a"][0, :, lane] = self.ground_acceleration(lane, self.time(lane))
        state = state_of(now)
        self.kernel.gather(state)
        out = np.empty(6)
        self.kernel.ledger(state, 0, self.dt[lane], lane, out)
        return out

    def energies_without_tension(self, lane: int, bare: Column) -> np.ndarray:
        """Ledger of a lane as if the column stood there without its pretension; ``bare`` is that column [J]."""
        now = self.copies(lane, self.dt[lane])
        for name, fields in zip(("body", "joint", "lane"), self.pack(bare).fields, strict=True):
            for field, values in fields.items():
                now[name][field][..., lane] = values
        now["lane"]["dt"][0, lane] = self.dt[lane]
        now["link"]["on"][:, lane] = now["link"]["ft"][:, lane] = 0.0
        return self.ledger_of(lane, now)

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration of a drum in its present position without input; of its edge, where it turns [m/s²]."""
        force, moment = self.net(lane)
        linear = force * self.drum["im"][1:, lane, None] - self.lane["g"][0, :, lane]
        turning = moment * (self.drum["ia"] * self.drum["rb"])[1:, lane, None]
        return float(max(np.abs(linear).max(), np.abs(turning).max()))

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        drum = self.drum
        opening, slip, twist = self.joints(lane)
        slip, twist = self._moved(lane, slip, twist)
        axes = self.axes(lane)
        foot = np.array([drum[name][1, lane] for name in ("fx", "fy", "fz")])
        return {
            "time": self.time(lane),
            "position": np.stack([drum[c][1:, lane] for c in "xyz"], axis=-1),
            "axes": axes,
            "opening": opening,
            "slip": slip,
            "twist": twist,
            "base": np.array([drum[c][1, lane] for c in "xy"]) + (axes[0] @ foot)[:2],
            "top": self.top_place(lane) - [self.watch[c][0, lane] for c in ("sx", "sy")],
            "energy": self.energies(lane),
        } | self.links_now(lane)

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run is over."""
        case = self.cases[lane]
        assert case is not None
        column, watch = case.column, self.watch[0]
        change = self.energies(lane) - self.start[lane]
        imbalance = ledger_imbalance(change, float(watch["wmax"][lane]), self.begun(lane, change), column)
        slip, twist = self.since_start(lane)
        tilt, lean = (math.acos(max(-1.0, 1.0 - self.peak(lane, name))) for name in ("turn", "lean"))
        slips = np.hypot(*slip.T)
        collapsed = watch["status"][lane] == COLLAPSED
        failed = watch["status"][lane] == FAILED or bool(ledger.out_of_balance(imbalance))
        widths = column.joint_widths
        outcome = classify(collapsed, failed, float(watch["open"][lane] / widths.min()), float((slips / widths).max()))
        mechanical = float(change[1] + change[2] + change[3] + self.rest[lane]) + self.held_by_links(lane)
        return Measures(
            outcome=outcome,
            decided=outcome is Outcome.COLLAPSED or (not failed and self.stays(column, lane, slip, mechanical)),
            collapse_time=float(watch["when"][lane] * self.dt[lane]) if watch["when"][lane] >= 0 else math.nan,
            peak_top_displacement=self.peak(lane, "top"),
            residual_top_displacement=float(np.hypot(*(self.top_place(lane) - (watch["sx"][lane], watch["sy"][lane])))),
            peak_rotation=lean,
            peak_joint_opening=self.peak(lane, "open"),
            residual_joint_slip=float(slips.max()),
            energy_imbalance=imbalance,
            time_step=float(self.dt[lane]),
            steps=int(self.feed["step"][0, lane] - self.spans.left_out[lane]),
            reason=self.reason(lane, outcome, imbalance),
            collapse=self.collapse(lane) if outcome is Outcome.COLLAPSED else None,
            stepped=self.spans.stepped(lane, int(self.feed["step"][0, lane]), float(self.dt[lane])),
            links=self.links_done(lane),
            space=SpaceMeasures(
                peak_top_x=self.peak(lane, "topx"),
                peak_top_y=self.peak(lane, "topy"),
                peak_tilt=tilt,
                peak_twist=self.peak(lane, "spin"),
                residual_slip_per_joint=tuple(float(one) for one in slips),
                residual_twist_per_joint=tuple(float(one) for one in twist),
            ),
        )

    def stays(self, column: Column, lane: int, slip: np.ndarray, energy: float) -> bool:
        """Whether the column in a lane stands for good; in the plane no drum walks."""
        toes, walks = self.pack(column).toes, not self.planar
        return stands_for_good(column, self.drum, lane, slip, energy, toes, walks=walks)

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

    def direction(self, lane: int) -> str:
        """Where a collapse goes, in words."""
        azimuth = math.degrees(self.collapse(lane).azimuth or 0.0)
        return f"towards azimuth {round(azimuth) % 360}° (from x towards y)"
