"""The numbers of the rocking equation, what follows from them, and what models that only rock warn of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...column import Column
from ...errors import warn
from ...messages import say
from ...motion import Motion
from ...outcome import classify
from ...response import Histories, Measures
from ...response.collapse import in_plane
from ...response.residuals import Residuals
from ..base import RunOptions
from ..shared import ledger
from ..shared.ground import ground_histories, value_at, values_at

#: Impact velocity over p α under which the block comes to rest; it would rise to 5e-11 α.
REST = 1.0e-5


@dataclass(frozen=True)
class RockingBlock:
    """One block that rocks: what the equation, the kinematics and the energies need.

    Parameters
    ----------
    p : float
        Frequency parameter [rad/s].
    alpha : float
        Slenderness [rad].
    restitution : float
        e [-].
    inertia : float
        About the pivot [kg m²].
    gravity : float
        g [m/s²].
    half_width, height, centroid_height : float
        Of the block [m].
    linear : bool
        Linearised equation and kinematics.
    push : float
        Horizontal acceleration that the equation sees over that of the ground [-]; 1 unless α is not b/h.
    """

    p: float
    alpha: float
    restitution: float
    inertia: float
    gravity: float
    half_width: float
    height: float
    centroid_height: float
    linear: bool = False
    push: float = 1.0

    @property
    def uplift_sine(self) -> float:
        """Factor of 1 + a_v/g in the condition of uplift: sin α, linearised α."""
        return self.alpha if self.linear else math.sin(self.alpha)

    @property
    def uplift_cosine(self) -> float:
        """Factor of |a_g|/g in the condition of uplift: cos α, linearised 1."""
        return 1.0 if self.linear else math.cos(self.alpha)

    @property
    def barrier(self) -> float:
        """Energy it takes to bring the block from upright to its balance point, over I₀ [1/s²]."""
        return float(self.potential(self.alpha))

    def potential(self, x):
        """Gravitational energy at rotation x ≥ 0 over I₀ [1/s²]."""
        if self.linear:
            return self.p**2 * x * (self.alpha - 0.5 * x)
        return self.p**2 * (np.cos(self.alpha - x) - math.cos(self.alpha))

    def displacement(self, tilt, height: float):
        """Displacement (x, z) of a point on the axis at a height, for a tilt towards +x [rad] [m]."""
        b, x = self.half_width, np.abs(tilt)
        if self.linear:
            return height * tilt, b * x
        horizontal = np.sign(tilt) * (b * (1.0 - np.cos(x)) + height * np.sin(x))
        return horizontal, b * np.sin(x) - height * (1.0 - np.cos(x))

    def opening(self, tilt):
        """Gap at the edge that opens [m]."""
        x = np.abs(tilt)
        return 2.0 * self.half_width * (x if self.linear else np.sin(x))

    def verdict(self, x: float, v: float, unaccounted: float) -> tuple[bool, bool]:
        """Whether the block has fallen or will, and whether that is decided, when no input is left.

        Parameters
        ----------
        x, v : float
            Rotation on the side the block stands on, and its velocity [rad], [rad/s].
        unaccounted : float
            Energy that the ledger cannot account for, over I₀ [1/s²].
        """
        energy = 0.5 * v * v + float(self.potential(x))
        if energy + unaccounted < self.barrier:
            return x > self.alpha, True
        collapsed = v > 0.0 and energy - unaccounted >= self.barrier
        return collapsed, collapsed

    def measures(
        self,
        *,
        x: float,
        v: float,
        side: float,
        peaks: tuple[float, float],
        start: float,
        collapse_time: float,
        end: float,
        failure: str,
        work: float,
        unaccounted: float,
        step: float,
        steps: int,
    ) -> Measures:
        """Measures of a run.

        Parameters
        ----------
        x, v, side : float
            Rotation and velocity at the end on the side the block stands on [rad], [rad/s], and that side (+1: +x).
        peaks : tuple of float
            Largest rotation towards +x and towards −x [rad].
        start : float
            Rotation at the start, towards +x positive [rad].
        collapse_time, end : float
            Time at which the collapse was certain, negative if it was not, and end of the run [s].
        failure : str
            Why the run failed, or empty.
        work, unaccounted : float
            Largest input work, and what the ledger cannot account for at the end, over I₀ [1/s²].
        step, steps : float, int
            Smallest step [s] and number of steps.
        """
        begun = float(self.potential(abs(start)))
        free = max(0.0, begun - float(self.potential(x)))
        imbalance = ledger.imbalance(unaccounted, work=work, start=begun, barrier=self.barrier, released=free)
        if not failure and not (math.isfinite(x) and math.isfinite(v) and math.isfinite(imbalance)):
            failure = "the state is not finite"
        failure = failure or ledger.out_of_balance(imbalance)
        found = collapse_time >= 0.0
        collapsed, decided = (found, found) if failure or found else self.verdict(x, v, abs(unaccounted))
        if collapsed and not failure and begun + work < self.barrier:
            failure = ledger.MADE_ENERGY
        if failure:
            collapsed, decided = False, False
        opening = float(self.opening(max(peaks)))
        width = 2.0 * self.half_width
        tilts = np.array([peaks[0], -peaks[1], side * x, start])
        moved = self.displacement(tilts, self.height)[0]
        moved = moved[:3] - moved[3]  # from the start
        along, up = (float(one[0] - one[1]) for one in self.displacement(tilts[2:], self.centroid_height))
        return Measures(
            outcome=classify(collapsed, bool(failure), opening / width, 0.0),
            decided=decided,
            collapse_time=(collapse_time if found else end) if collapsed else math.nan,
            peak_top_displacement=float(np.abs(moved[:2]).max()),
            residual_top_displacement=float(moved[2]),
            peak_rotation=max(peaks),
            peak_joint_opening=opening,
            residual_joint_slip=0.0,
            energy_imbalance=imbalance,
            time_step=step,
            steps=steps,
            reason=failure or ("overturns as one block" if collapsed else ""),
            residuals=Residuals.of_one(0.0, along, up, side * x),
            collapse=in_plane(collapse_time if found else end, 1, side) if collapsed else None,
        )


def half_steps(samples: np.ndarray, dt: float, step: float, steps: int) -> np.ndarray:
    """A motion at the half steps of its run, then zero, shape (2 steps + 2,), without its factor.

    The step that ends with the motion sees its last sample; that the one which starts there sees zero is up to the kernel.
    """
    positions = np.arange(2 * steps + 1) * (0.5 * step / dt)
    return np.append(values_at(samples, np.minimum(positions, len(samples) - 1)), 0.0)


def remaining_peak(motion: Motion) -> np.ndarray:
    """Largest |sample| from each sample on, then zero: what is left without the factor, shape (steps + 1,)."""
    return np.append(np.maximum.accumulate(np.abs(motion.samples)[::-1])[::-1], 0.0)


def lightest_weight(motion: Motion, gravity: float) -> float:
    """Smallest 1 + a_v/g of a motion, not below nearly nothing [-]."""
    vertical = motion.vertical
    return 1.0 if vertical is None else max(1e-9, min(1.0, 1.0 + float(vertical.min()) / gravity))


def off_the_ground(motion: Motion, gravity: float, collapse_time: float) -> str:
    """Why a run has failed whose column has no weight before it has collapsed; empty if it has not.

    ``collapse_time`` is negative or NaN without collapse [s].
    """
    vertical = motion.vertical
    if vertical is None or vertical.min() > -gravity:
        return ""
    k = int(np.argmax(vertical <= -gravity))
    share = (vertical[k - 1] + gravity) / (vertical[k - 1] - vertical[k]) if k else 1.0
    time = max(0.0, k - 1.0 + share) * motion.dt
    if 0.0 <= collapse_time <= time:
        return ""
    return say(
        "the vertical acceleration is {lowest:.2f} g at its lowest and falls below −1 g at {time:.4g} s: the column leaves "
        "the ground, which this model does not follow; dem2d does",
        lowest=vertical.min() / gravity,
        time=time,
    )


def warn_sliding(column: Column, alpha: float, name: str, remedy: str) -> None:
    """Warn of joints on which a column of slenderness α [rad] slides before it rocks, in a model without sliding."""
    joint = min(range(column.n), key=lambda i: column.joints[i].tan_phi)
    friction = column.joints[joint].tan_phi
    if math.tan(alpha) > friction:
        where = "" if column.n == 1 else say(" of joint {joint}", joint=joint + 1)
        words = say(
            "tan α = {slope:.3f} is above the friction coefficient {friction:.3f}{where}: the column slides before it "
            "rocks, and {model} as it is set has no sliding; {remedy}."
        )
        warn(words.of(slope=math.tan(alpha), friction=friction, where=where, model=name, remedy=remedy))


def warn_of_free_flight(column: Column, motion: Motion) -> None:
    """Warn of a motion under which the column would leave the ground."""
    vertical = motion.vertical
    if vertical is not None and float(vertical.min()) <= -column.gravity:
        warn(
            say(
                "the vertical acceleration of {motion.name!r} falls to {lowest:.2f} g; below −1 g the column would leave "
                "the ground, which this model does not follow: a run that gets there fails.",
                motion=motion,
                lowest=vertical.min() / column.gravity,
            )
        )


# One rocking block, once: an adaptive Runge–Kutta method of order 8 with impacts and starts from rest located.

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


def longest_step(p: float, motion: Motion) -> float:
    """Longest step of the solver for a block of frequency parameter p [1/s]: no start of the motion is stepped over [s]."""
    return min(0.02 / p, 16.0 * motion.dt)


def run_single(
    block: RockingBlock, motion: Motion, options: RunOptions, initial_rotation: float
) -> tuple[Histories, Measures]:
    """Follow one block through one motion.

    Parameters
    ----------
    block : RockingBlock
    motion : Motion
    options : RunOptions
    initial_rotation : float
        Counter-clockwise positive [rad].
    """
    from scipy.integrate import DOP853
    from scipy.optimize import brentq

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
    largest_step = longest_step(block.p, motion)

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
                t1 = _crossing(dense, t0, t1, brentq)
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
    histories = _histories(block, motion, times, rows, initial_rotation)
    stored = 0.5 * state["v"] ** 2 + float(block.potential(state["x"]) - block.potential(abs(initial_rotation)))
    measures = block.measures(
        x=state["x"], v=state["v"], side=side, peaks=(peaks[1.0], peaks[-1.0]), start=-initial_rotation,
        collapse_time=collapse_time, end=state["t"],
        failure=off_the_ground(motion, block.gravity, collapse_time) or failure, work=largest,
        unaccounted=state["work"] - stored - state["loss"], step=smallest if steps else motion.dt, steps=steps,
    )  # fmt: skip
    return histories, measures


def _crossing(dense, t0: float, t1: float, brentq) -> float:
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


def _histories(block: RockingBlock, motion: Motion, times, rows, initial_rotation: float) -> Histories:
    tilt, v, work, loss = rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3]
    first = -initial_rotation

    def moved(height: float) -> tuple[np.ndarray, np.ndarray]:
        (x, z), (x0, z0) = block.displacement(tilt, height), block.displacement(np.array(first), height)
        return x - x0, z - z0

    drum_x, drum_z = moved(block.centroid_height)
    a_g, u_g = ground_histories(motion, times)
    zero = np.zeros_like(times)
    x = np.abs(tilt)
    return Histories.of_drums(
        time=times,
        drum_x=drum_x[:, None],
        drum_z=drum_z[:, None],
        drum_rotation=-tilt[:, None],
        joint_opening=block.opening(tilt)[:, None],
        joint_slip=zero[:, None],
        base_displacement=moved(0.0)[0],
        top_displacement=moved(block.height)[0],
        ground_acceleration=a_g,
        ground_displacement=u_g,
        energy={
            "input": block.inertia * work,
            "kinetic": block.inertia * 0.5 * v**2,
            "gravitational": block.inertia * (block.potential(x) - block.potential(abs(first))),
            "impact": block.inertia * loss,
        },
    )
