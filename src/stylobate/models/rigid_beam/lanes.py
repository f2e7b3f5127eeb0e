"""Rigid beams by the fixed-step method: a block of lanes, for a batch and for a single run alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...column import Column
from ...kernels.rigid_beam import step as kernel
from ...kernels.run_codes import CHUNK, FAILED, FREE, LANES, RUNNING
from ...messages import say
from ...motion import Motion
from ...response import Histories, Measures
from ..base import Case, RunOptions
from ..rocking.block import lightest_weight, off_the_ground
from ..shared import ledger
from ..shared.lanes import longest_piece
from .state import PackedBeam, energy_at_loss, faces, histories_of, measures_of, tridiagonal

#: Wanted time between two looks at a run [s], and calls of the kernel per run.
LOOK = 0.01
CALLS_PER_RUN = 20

#: About what a step of a single run costs on one core for each drum [s]; a batch shares it among its lanes.
COST = 2e-7


class Loop(NamedTuple):
    """Kind of a compiled loop: runs that share it share blocks."""

    drums: int
    steps: int
    sliding: bool
    bed: tuple[float, ...] | bool | None
    vertical: bool
    damped: bool


def loop_for(beam: PackedBeam, motion: Motion) -> Loop:
    """The loop that a beam under a motion needs."""
    step = beam.step_for(motion)
    steps = 2 ** max(0, min(round(math.log2(CHUNK)), math.floor(math.log2(LOOK / step))))
    vertical = motion.z_samples is not None
    return Loop(beam.column.n, steps, beam.sliding, beam.bed, vertical, beam.stiffness_damping > 0.0)


class BeamLanes:
    """A block of lanes of rigid beams; see :class:`stylobate.models.shared.lanes.LaneBlock`.

    Parameters
    ----------
    pack : callable
        Gives the beam of a column.
    loop : Loop
    options : RunOptions
    """

    lanes = LANES

    def __init__(self, pack: Callable[[Column], PackedBeam], loop: Loop, options: RunOptions) -> None:
        self.pack, self.loop, self.options = pack, loop, options
        self.drum = np.zeros(loop.drums + 2, kernel.DRUM)
        self.values = self.drum.view(np.float64).reshape(loop.drums + 2, -1, self.lanes)
        self.lane = np.zeros(1, kernel.LANE)
        self.watch = np.zeros(1, kernel.WATCH)
        self.watch["status"] = FREE
        self.a = np.zeros((2 * loop.steps + 1) * self.lanes)
        self.g = np.ones((2 * loop.steps + 1) * self.lanes)
        self.dt = np.zeros(self.lanes)
        self.start = np.zeros((self.lanes, 3))
        self.cases: list[tuple[Case, PackedBeam] | None] = [None] * self.lanes
        self.calls = 1
        self.piece = longest_piece(COST * loop.drums, loop.steps)

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane that is free."""
        column, motion = case = case.multiplied
        beam = self.pack(column)
        self.cases[lane] = (case, beam)
        self.values[..., lane] = 0.0  # clear all fields: a NaN of the last run would persist
        for name, values in _drum_fields(beam).items():
            self.drum[name][1:-1, lane] = values
        seen, theta = beam.column, -beam.initial_rotation
        for name in ("th", "ts"):
            self.drum[name][1:-1, lane] = theta
        for name in ("x", "xs"):
            self.drum[name][1:-1, lane] = theta * seen.centroid_heights
        # the motion is a whole number of chunks: no step stands across its end, and the tail changes nothing before it
        chunk = self.loop.steps
        chunks = max(1, math.ceil(motion.duration / (chunk * beam.step_for(motion)) - 1e-9))
        dt = motion.duration / (chunks * chunk)
        chunks += math.ceil(self.options.tail / (chunk * dt) - 1e-9)
        steps = chunks * chunk
        self.dt[lane] = dt
        state = self.lane[0]
        for name in kernel.LANE.names or ():
            state[name][lane] = 0.0
        state["dt"][lane], state["g"][lane] = dt, seen.gravity
        state["rel"][lane] = 1.0 if beam.relative else 0.0
        state["beta"][lane] = beam.stiffness_damping
        watch = self.watch[0]
        for name in kernel.WATCH.names or ():
            watch[name][lane] = 0
        z = motion.z_samples
        watch["status"][lane] = RUNNING
        watch["follow"][lane] = self.options.until_end
        watch["x"][lane], watch["z"][lane] = motion.samples.ctypes.data, 0 if z is None else z.ctypes.data
        watch["last"][lane], watch["end"][lane] = motion.steps - 1, steps
        watch["when"][lane] = -1
        watch["ratio"][lane] = 0.5 * dt / motion.dt
        watch["factor"][lane], watch["lift"][lane] = motion.factor, motion.factor / seen.gravity
        watch["pga"][lane], watch["until"][lane] = motion.pga, motion.duration
        watch["stood"][lane] = theta * seen.height
        watch["gmin"][lane] = lightest_weight(motion, seen.gravity)
        self.calls = max(1, chunks // CALLS_PER_RUN)
        self.start[lane] = self._energies(lane) if beam.initial_rotation else 0.0

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by a share of a run."""
        loop = self.loop
        flags = (loop.sliding or None, loop.bed, loop.vertical or None, loop.damped or None)
        remaining = min(self.calls, self.piece) if chunks is None else chunks
        while remaining > 0:
            count = min(remaining, self.piece)
            kernel.advance(self.drum, self.lane, self.watch, self.a, self.g, count, loop.steps, *flags)
            remaining -= count

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended."""
        return self.watch["status"][0, lane] != RUNNING

    def time(self, lane: int) -> float:
        """Time of the lane's present state [s]."""
        return float(self.watch["step"][0, lane]) * self.dt[lane]

    def state(self, lane: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """θ, θ̇, slip, its velocity and its plastic part; each of shape (n,)."""
        drum, beam = self.drum[1:-1], self._beam(lane)
        theta, omega = drum["th"][:, lane].copy(), drum["w"][:, lane].copy()
        if not beam.sliding:
            zero = np.zeros_like(theta)
            return theta, omega, zero, zero, zero
        lever = beam.matrices.lever
        slip = np.diff(drum["x"][:, lane] - lever @ theta, prepend=0.0)
        rate = np.diff(drum["v"][:, lane] - lever @ omega, prepend=0.0)
        return theta, omega, slip, rate, drum["pl"][:, lane].copy()

    def _beam(self, lane: int) -> PackedBeam:
        loaded = self.cases[lane]
        assert loaded is not None
        return loaded[1]

    def _energies(self, lane: int) -> np.ndarray:
        beam = self._beam(lane)
        out = beam.energies(*self.state(lane))
        if not beam.relative:  # no potential: the work of the moments instead
            out[2] = self.lane["joint"][0, lane]
        return out

    def ledger(self, lane: int) -> np.ndarray:
        """Input, kinetic, gravitational, elastic, friction, viscous [J], since the start."""
        return self._ledger(lane, self._energies(lane))

    def _ledger(self, lane: int, energies: np.ndarray) -> np.ndarray:
        change = energies - self.start[lane]
        work, fric, visc = (float(self.lane[name][0, lane]) for name in ("work", "fric", "visc"))
        return np.array([work, *change, fric, visc])

    @np.errstate(over="ignore", invalid="ignore")
    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended."""
        loaded = self.cases[lane]
        assert loaded is not None
        beam = loaded[1]
        watch = {name: self.watch[name][0, lane] for name in kernel.WATCH.names or ()}
        theta, omega, slip, _, _ = self.state(lane)
        energies = self._energies(lane)
        failed = watch["status"] == FAILED
        row, largest = self._ledger(lane, energies), float(watch["wmax"])
        time = float(watch["when"]) * self.dt[lane]
        not_finite = say("the state is not finite at {time:.4g} s; shorten the time_step")
        failure = not_finite.of(time=self.time(lane)) if failed else ""
        at_end = self.drum["te"][1:-1, lane]
        after = time > loaded[0].motion.duration and beam.inside(at_end, np.zeros_like(at_end))
        return measures_of(
            beam,
            {
                "theta": theta, "omega": omega, "slip": slip,
                "energy": float(energies.sum()), "start": float(np.sum(self.start[lane])), "work": largest,
                "given": energy_at_loss(row, largest, after),
                "unaccounted": ledger.unaccounted(row), "released": ledger.released(row),
                "lost": int(watch["which"]), "side": int(watch["side"]),
                "time": time, "end": self.time(lane),
                "failure": off_the_ground(loaded[0].motion, beam.column.gravity, time) or failure,
                "top": float(watch["top"]), "turn": float(watch["turn"]), "opening": float(watch["open"]),
                "residual": float((theta + beam.initial_rotation) @ beam.column.heights + slip.sum()),
                "step": float(self.dt[lane]), "steps": int(watch["step"]),
            },
        )  # fmt: skip


@np.errstate(over="ignore", invalid="ignore")  # a state that is not finite is reported by the measures
def run_one(beam: PackedBeam, column: Column, motion: Motion, options: RunOptions) -> tuple[Histories, Measures]:
    """One run with histories, through the loop of a batch; ``column`` as it is, ``beam`` as the model sees it."""
    block = BeamLanes(lambda _: beam, loop_for(beam, motion), options)
    block.load(0, Case(column, motion))
    stride = max(1, round(options.output_interval / (block.loop.steps * block.dt[0])))
    rows = [(0.0, *block.state(0)[:3:2], block.ledger(0))]
    while not block.is_over(0):
        block.advance(stride)
        rows.append((block.time(0), *block.state(0)[:3:2], block.ledger(0)))
    time, theta, slip, energy = (np.array(part) for part in zip(*rows, strict=True))
    return histories_of(beam, motion, time, theta, slip, energy), block.collect(0)


@lru_cache(64)
def _drum_fields(beam: PackedBeam) -> dict[str, np.ndarray]:
    column, matrices = beam.column, beam.matrices
    pivot, upper, nodes = tridiagonal(column)
    weight = column.gravity if beam.geometric else 0.0
    own = column.centroid_heights - column.joint_heights
    friction = np.array([joint.tan_phi for joint in column.joints])
    cohesion = np.array([joint.cohesion for joint in column.joints])
    k, m1, s1, m2, s2 = beam.joints
    face, under = faces(column)
    return {
        "k": k, "m1": m1, "s1": s1, "m2": m2, "s2": s2,
        "gs": weight * matrices.load, "sx": matrices.load, "ih": 1.0 / column.heights, "p": nodes,
        "di": pivot, "lo": upper,
        "im": 1.0 / column.masses, "ii": 1.0 / column.inertias, "zb": own, "zt": column.heights - own,
        "ks": beam.shear if beam.sliding else np.zeros(column.n),
        "mu": friction * column.joint_weights, "co": cohesion * column.joint_areas,
        "n": column.joint_weights if beam.geometric else np.zeros(column.n),
        "m": column.masses, "c": beam.opening, "half": 0.5 * column.joint_widths, "fl": face, "fu": under,
        "alpha": beam.alpha, "mu_m": beam.ultimate, "sz": matrices.overturning,
    }  # fmt: skip
