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
from ..shared import ledger
from ..shared.ground import ground_histories, values_at

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
        overturned = collapse_time >= 0.0
        collapsed, decided = (overturned, overturned) if failure or overturned else self.verdict(x, v, abs(unaccounted))
        if collapsed and not failure and begun + work < self.barrier:
            failure = ledger.MADE_ENERGY
        if failure:
            collapsed, decided = False, False
        opening = float(self.opening(max(peaks)))
        width = 2.0 * self.half_width
        tilts = np.array([peaks[0], -peaks[1], side * x, start])
        moved = self.displacement(tilts, self.height)[0]
        moved = moved[:3] - moved[3]  # from the start
        along, up = (float(values[0] - values[1]) for values in self.displacement(tilts[2:], self.centroid_height))
        return Measures(
            outcome=classify(collapsed, bool(failure), opening / width, 0.0),
            decided=decided,
            collapse_time=(collapse_time if overturned else end) if collapsed else math.nan,
            peak_top_displacement=float(np.abs(moved[:2]).max()),
            residual_top_displacement=float(moved[2]),
            peak_rotation=max(peaks),
            peak_joint_opening=opening,
            residual_joint_slip=0.0,
            energy_imbalance=imbalance,
            time_step=step,
            steps=steps,
            reason=failure or (say("overturns as one block") if collapsed else ""),
            residuals=Residuals.of_one(0.0, along, up, side * x),
            collapse=in_plane(collapse_time if overturned else end, 1, side) if collapsed else None,
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


def histories_of(block: RockingBlock, motion: Motion, times, rows, initial_rotation: float) -> Histories:
    """Histories of one run.

    Parameters
    ----------
    block : RockingBlock
    motion : Motion
    times : array
        [s], shape (T,).
    rows : array
        Rotation towards +x [rad], its velocity on the side the block stands on [rad/s], input work and loss at impacts over
        I₀ [1/s²], shape (T, 4).
    initial_rotation : float
        Counter-clockwise positive [rad].
    """
    tilt, v, work, loss = rows.T
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
