"""The largest stable step of central differences, and the step that a model takes."""

from __future__ import annotations

import math

import numpy as np

from ...errors import InputError
from ...kernels.run_codes import CHUNK
from ...motion import Motion
from .soft_joints import resolving


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
