"""Time steps and soft joints: the largest stable step and the one taken, how far columns sink, and how they settle."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from ...column import Column
from ...errors import InputError
from ...kernels.run_codes import CHUNK
from ...messages import say
from ...motion import Motion

#: Largest sinking of a column under its own weight, as a share of its height [-].
LARGEST_SINKING = 0.01

#: Largest closure of a joint under the weight above, as a share of the height of the drum on it [-].
LARGEST_CLOSURE = 0.5

#: A step is no longer than this share of a sample, or than this share of the mean period where there are more samples.
SHARE_OF_SAMPLE, SHARE_OF_PERIOD = 0.5, 0.01


@lru_cache(maxsize=1024)
def check_sinking(column: Column) -> None:
    """Refuse a column that its own weight presses into its joints: their law is one of small deformations.

    Raises
    ------
    InputError
        It sinks by more than a hundredth of its height, or a drum by half of its own.
    """
    stiffness = np.array([joint.normal_stiffness for joint in column.joint_laws]) * column.joint_areas
    closure = column.joint_weights / stiffness
    share = float(closure.sum()) / column.height
    if share > LARGEST_SINKING:
        softest = min(joint.normal_stiffness for joint in column.joint_laws)
        raise InputError(
            f"column {column.name!r} sinks by {share:.3g} of its height under its own weight; allowed is up to "
            f"{LARGEST_SINKING:g}: its normal_stiffness ({softest:g} N/m³ where it is least) should be "
            f"{share / LARGEST_SINKING:.3g} times as large."
        )
    thin = int(np.argmax(closure / column.heights))
    if closure[thin] > LARGEST_CLOSURE * column.heights[thin]:
        raise InputError(
            f"drum {thin + 1} of {column.name!r} is {column.heights[thin]:.3g} m high and sinks by {closure[thin]:.3g} m "
            f"under the weight on its lower joint; allowed is up to half of its height: make that joint's normal_stiffness "
            f"({column.joint_laws[thin].normal_stiffness:g} N/m³) larger, or the drum higher."
        )


def longest_step(motion: Motion) -> float:
    """Longest step that resolves a motion [s]: half a sample, or a hundredth of the mean period where that is longer.

    Notes
    -----
    Joints so soft that the largest stable step passes over several cycles of the motion would see samples of it at
    random. The mean period is that of the acceleration and its slope, 2π rms(a) / rms(ȧ), which is 1/f for a harmonic.
    """
    step = SHARE_OF_SAMPLE * motion.dt
    a = motion.samples
    slope = float(np.sqrt(np.mean(np.diff(a) ** 2))) / motion.dt
    if slope > 0.0:
        step = max(step, SHARE_OF_PERIOD * 2.0 * math.pi * float(np.sqrt(np.mean(a**2))) / slope)
    return step


def resolving(step: float, motion: Motion) -> float:
    """The step, or the longest one that resolves the motion [s]."""
    return step if step <= SHARE_OF_SAMPLE * motion.dt else min(step, longest_step(motion))


def check_step_resolves(step: float | None, motion: Motion) -> None:
    """Refuse a stated step that passes over what the motion does.

    Raises
    ------
    InputError
    """
    if step is not None and resolving(step, motion) < step:
        raise InputError(
            f"time_step is {step:g} s; the longest one that resolves {motion.name!r} is {longest_step(motion):.3g} s: "
            "give at most that, or leave it out."
        )


def highest_frequency(stiffness: np.ndarray, inverse_masses: np.ndarray) -> float:
    """Highest circular frequency of bodies on springs [rad/s].

    Parameters
    ----------
    stiffness : array, shape (N, N)
        Symmetric.
    inverse_masses : array, shape (N,)
        1/m or 1/I of each degree of freedom; 0 where it is held.
    """
    root = np.sqrt(inverse_masses)
    return math.sqrt(max(float(np.linalg.eigvalsh(stiffness * np.outer(root, root))[-1]), 0.0))


def stable_step(omega: float, stiffness_damping: float) -> float:
    """Largest stable step of central differences [s]: 2/ω (√(1 + ζ²) − ζ), ζ = β ω/2.  # Eq. (D3)

    Parameters
    ----------
    omega : float
        Highest circular frequency of the closed joints [rad/s].
    stiffness_damping : float
        β [s]; the dashpots act with the velocity half a step back.
    """
    zeta = 0.5 * stiffness_damping * omega
    return 2.0 / omega * (math.sqrt(1.0 + zeta * zeta) - zeta)


def chosen_step(stable: float, step_factor: float, time_step: float | None, what: str) -> float:
    """The step asked for, or a share of the largest stable one [s].

    Parameters
    ----------
    stable : float
        Largest stable step [s].
    step_factor : float
        Share of it that is taken.
    time_step : float or None
        Step asked for instead [s].
    what : str
        Whose step it is, for the message.

    Raises
    ------
    InputError
        The step asked for is not below the largest stable one.
    """
    if time_step is None:
        return step_factor * stable
    if time_step >= stable:
        raise InputError(
            f"time_step is {time_step:g} s; the largest stable step for {what} is {stable:.4g} s: "
            f"give at most {0.9 * stable:.3g} s, or leave it out."
        )
    return time_step


def chunks_in(duration: float, step: float) -> int:
    """How many chunks of steps of at most ``step`` [s] fill a time [s]; the browser is given the same code, compiled."""
    return max(1, math.ceil(duration / (CHUNK * step)))


def whole_steps(motion: Motion, tail: float, step: float) -> tuple[float, int]:
    """Largest step up to ``step`` that resolves the motion and of which whole chunks fill it [s], and how many chunks
    there are with the tail.

    The tail has no say in the step: what happens before it does not depend on it.
    """
    step = resolving(step, motion)
    dt = motion.duration / (CHUNK * chunks_in(motion.duration, step))
    return dt, math.ceil((motion.duration + tail) / (CHUNK * dt) * (1.0 - 1e-12))


#: Share of the unbalanced force that acts against the velocity while something settles [-].
LOCAL_DAMPING = 0.8

#: Chunks of steps between two looks, of which there are at least so many however long the step.
CHUNKS, LOOKS = 100, 2


#: What comes to rest within the first share of a stone of where it is drawn is in equilibrium as drawn; beyond the second it
#: is worth a sentence. Soft joints under a tall structure sway by more than its smallest stone would.
AS_DRAWN, AWAY = 0.1, 0.01


def caution_of_settling(name: str, way: float, size: float) -> str | None:
    """Sentence about a structure that settles away from where it is drawn [m], by the size of its smallest stone [m]."""
    if math.isinf(way):
        return say("{name!r} is not in equilibrium as drawn; it moves from the start.", name=name)
    if way > AWAY * size:
        words = say("{name!r} sinks and sways by {far:.2g} mm under its own weight before it rests, and begins there.")
        return words.of(name=name, far=1000.0 * way)
    return None


def settled(
    advance: Callable[[int], None],
    residual: Callable[[], float],
    allowed: float,
    most_chunks: int,
    lost: Callable[[], bool] = lambda: False,
) -> bool:
    """Advance with local damping until nothing accelerates any more.

    Parameters
    ----------
    advance : callable
        Takes a number of chunks of steps.
    residual : callable
        Largest acceleration of a body in its present position [m/s²].
    allowed : float
        Residual acceleration at which all has settled [m/s²].
    most_chunks : int
        After which it is given up.
    lost : callable
        Whether to give up at once.

    Returns
    -------
    bool
        Whether it has settled.
    """
    each = min(CHUNKS, max(1, most_chunks // LOOKS))
    for _ in range(max(most_chunks // each, 1)):
        advance(each)
        if lost():
            return False
        if residual() < allowed:
            return True
    return False
