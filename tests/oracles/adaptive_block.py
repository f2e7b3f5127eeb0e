"""Housner's block by SciPy's adaptive Runge–Kutta method of order 8, impacts and starts from rest located: the ruler of the
fixed step."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from stylobate.column import Column
from stylobate.models.base import RunOptions
from stylobate.models.rocking.block import (
    REST,
    RockingBlock,
    histories_of,
    lightest_weight,
    off_the_ground,
    remaining_peak,
)
from stylobate.models.rocking.model import HousnerBlock
from stylobate.models.shared.ground import value_at
from stylobate.motion import Motion
from stylobate.response import Histories, Measures

#: Of the solver; the absolute one over the natural size of each variable: α, p α and (p α)².
RELATIVE_TOLERANCE = 1e-8
ABSOLUTE_TOLERANCE = 1e-9

#: Impacts in one run after which it is given up.
MOST_IMPACTS = 100_000


#: Places in a step at which an impact is looked for.
SAMPLES = 33


class Ground:
    """Ground acceleration over g at any time; ``push`` scales the horizontal one."""

    def __init__(self, motion: Motion, gravity: float, push: float = 1.0) -> None:
        self.dt = motion.dt
        self.last = motion.steps - 1
        self.duration = motion.duration
        vertical = motion.vertical
        self.horizontal = motion.acceleration * (push / gravity)
        self.weight = np.ones(motion.steps) if vertical is None else 1.0 + vertical / gravity
        self.lift = None if vertical is None else vertical / gravity

    def __call__(self, t: float) -> tuple[float, float]:
        """a_g/g and 1 + a_v/g."""
        place = t / self.dt
        return value_at(self.horizontal, place), 1.0 if self.lift is None else 1.0 + value_at(self.lift, place)

    def first_uplift(self, t: float, block: RockingBlock) -> tuple[float, float] | None:
        """Time at or after t at which a block at rest starts to rock, and the side (+1: towards +x); None if never."""
        a, g = self(t)
        if t < self.duration and abs(a) * block.uplift_cosine > g * block.uplift_sine:
            return t, -math.copysign(1.0, a)
        i = min(int(t / self.dt) + 1, self.last + 1)
        excess = np.abs(self.horizontal[i:]) * block.uplift_cosine - self.weight[i:] * block.uplift_sine
        above = np.flatnonzero(excess > 0.0)
        if not above.size:
            return None
        k = int(above[0])
        high, low = float(excess[k]), 0.0
        side = -math.copysign(1.0, self.horizontal[i + k])
        begin = max(t, (i + k - 1) * self.dt)
        end = (i + k) * self.dt
        a, g = self(begin)
        low = -side * a * block.uplift_cosine - g * block.uplift_sine
        return begin + (end - begin) * (-low / (high - low) if low < 0.0 else 0.0), side


def run_adaptive(
    model: HousnerBlock, column: Column, motion: Motion, options: RunOptions | None = None
) -> tuple[Histories, Measures]:
    """Follow one block through one motion."""
    options = options or RunOptions()
    block, initial_rotation = model.block(column), model.initial_rotation
    ground = Ground(motion, block.gravity, block.push)
    end = motion.duration + options.tail
    p2, alpha = block.p**2, block.alpha
    absolute = ABSOLUTE_TOLERANCE * np.array([alpha, block.p * alpha, p2 * alpha**2])
    remaining, lightest = (
        remaining_peak(motion) * abs(motion.factor) * block.push / block.gravity,
        lightest_weight(motion, block.gravity),
    )
    side = -math.copysign(1.0, initial_rotation) if initial_rotation else 1.0

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, v, _ = y
        a, g = ground(t)
        s, c = (alpha - x, 1.0) if block.linear else (math.sin(alpha - x), math.cos(alpha - x))
        # Eq. (H1); the third is the work of the input over I₀.
        return [v, -p2 * (g * s + side * a * c), -p2 * v * ((g - 1.0) * s + side * a * c)]

    def certain(t: float, x: float, v: float) -> bool:
        if x <= alpha or v <= 0.0:
            return False
        pull = remaining[min(int(t / motion.dt + 1e-9), motion.steps)] / lightest
        return x > alpha + (pull if block.linear else math.atan(pull))

    count = max(1, round(end / options.output_interval))
    times = np.append(np.arange(count) * options.output_interval, end)
    times = np.unique(np.minimum(times, end))
    rows = np.zeros((len(times), 5))  # tilt towards +x, velocity, work, impact loss, largest rotation so far
    state = {"t": 0.0, "x": abs(initial_rotation), "v": 0.0, "work": 0.0, "loss": 0.0}
    moving = initial_rotation != 0.0
    written = 0
    largest = 0.0
    peaks = {1.0: 0.0, -1.0: 0.0, side: abs(initial_rotation)}
    collapse_time, steps, impacts, smallest, failure = -1.0, 0, 0, math.inf, ""
    largest_step = min(0.02 / block.p, 16.0 * motion.dt)  # no start of the motion is stepped over

    def write_until(t: float, dense=None) -> None:
        nonlocal written
        upto = int(np.searchsorted(times, t, side="right"))
        if upto > written:
            part = slice(written, upto)
            y = dense(times[part]).T if dense else [[state["x"], state["v"], state["work"]]]
            rows[part, :3] = y
            rows[part, 0] *= side
            rows[part, 3] = state["loss"]
            written = upto

    while state["t"] < end and not failure:
        if not moving:
            start = ground.first_uplift(state["t"], block)
            at = end if start is None else min(start[0], end)
            write_until(math.nextafter(at, 0.0))
            state["t"] = at
            if start is None or start[0] >= end:
                break
            side, moving = start[1], True
        begun = state["t"]
        before = begun < motion.duration  # no step stands across the end of the motion
        begin, bound = (begun, min(motion.duration, end)) if before else (math.nextafter(begun, math.inf), end)
        solver = DOP853(  # no size or time in it is absolute, so that similar blocks move alike to the last bit
            rates, begin, np.array([state["x"], state["v"], state["work"]]), bound,
            rtol=RELATIVE_TOLERANCE,
            atol=absolute,  # pyright: ignore[reportArgumentType] (one per variable)
            max_step=largest_step, first_step=min(largest_step, bound - begin),
        )  # fmt: skip
        while solver.status == "running" and moving:
            message = solver.step()
            if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
                failure = f"the solver could not go on at t = {solver.t:.4f} s: {message or 'the state is not finite'}"
                break
            t0, t1, (x, v, work) = state["t"], float(solver.t), solver.y
            steps += 1
            smallest = min(smallest, t1 - t0)
            largest = max(largest, float(work))
            if x < 0.0:
                dense = solver.dense_output()
                t1 = _crossing(dense, t0, t1)
                write_until(math.nextafter(t1, 0.0), dense)
                _, v, work = dense(t1)
                v = min(float(v), 0.0)
                after = -block.restitution * v
                rest = after <= REST * block.p * alpha
                after = 0.0 if rest else after
                state = {"t": t1, "x": 0.0, "v": after, "work": float(work),
                         "loss": state["loss"] + 0.5 * (v * v - after * after)}  # Housner 1963: 1 − e²  # fmt: skip
                side, moving = -side, not rest
                impacts += 1
                if impacts > MOST_IMPACTS:
                    failure = f"more than {MOST_IMPACTS} impacts until t = {t1:.4f} s"
                break
            if written < len(times) and times[written] <= t1:
                write_until(t1, solver.dense_output())
            peaks[side] = max(peaks[side], float(x))
            if state["v"] > 0.0 > v:  # a summit within the step
                summit = t0 + (t1 - t0) * state["v"] / (state["v"] - v)
                peaks[side] = max(peaks[side], float(solver.dense_output()(summit)[0]))
            state |= {"t": t1, "x": float(x), "v": float(v), "work": float(work)}
            if collapse_time < 0.0 and certain(t1, x, v):
                collapse_time = t1
                if not options.until_end:
                    end = t1
            if x >= 0.5 * math.pi:
                end = t1
            if state["t"] >= end:
                break
    write_until(state["t"])
    times, rows = times[:written], rows[:written]
    if state["t"] > times[-1]:  # the state at the end of a run that was cut short
        times = np.append(times, state["t"])
        rows = np.vstack((rows, [side * state["x"], state["v"], state["work"], state["loss"], 0.0]))
    histories = histories_of(block, motion, times, rows[:, :4], initial_rotation)
    stored = 0.5 * state["v"] ** 2 + float(block.potential(state["x"]) - block.potential(abs(initial_rotation)))
    measures = block.measures(
        x=state["x"], v=state["v"], side=side, peaks=(peaks[1.0], peaks[-1.0]), start=-initial_rotation,
        collapse_time=collapse_time, end=state["t"],
        failure=off_the_ground(motion, block.gravity, collapse_time) or failure, work=largest,
        unaccounted=state["work"] - stored - state["loss"], step=smallest if steps else motion.dt, steps=steps,
    )  # fmt: skip
    return histories, measures


def _crossing(dense, t0: float, t1: float) -> float:
    """First time in (t0, t1] at which the rotation goes through zero downward; it is negative at t1, at t0 not.

    Looked for on samples, ever closer to t0: the rotation may go up and down more than once within a step, and a small
    hop after an impact is shorter than most steps.
    """
    end = t1
    for _ in range(12):
        times = np.linspace(t0, end, SAMPLES)
        x = dense(times)[0]
        up = np.flatnonzero(x > 0.0)
        if up.size:
            down = up[0] + np.flatnonzero(x[up[0] :] <= 0.0)
            return brentq(lambda t: dense(t)[0], times[down[0] - 1], times[down[0]], xtol=1e-300) if down.size else t1
        end = float(times[1])
    return t1
