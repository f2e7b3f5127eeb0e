"""Limits of soft joints and long steps: a column stands on its joints, and a step resolves the motion too."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ...column import Column
from ...errors import InputError
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
