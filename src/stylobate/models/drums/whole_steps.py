"""The step of a run of drums: whole chunks of steps fill its motion."""

from __future__ import annotations

import math

from ...kernels.run_codes import CHUNK
from ...motion import Motion
from ..shared.soft_joints import resolving


def whole_steps(motion: Motion, tail: float, step: float) -> tuple[float, int]:
    """Largest step up to ``step`` that resolves the motion and of which whole chunks fill it [s], and how many chunks
    there are with the tail.

    The tail has no say in the step: what happens before it does not depend on it.
    """
    step = resolving(step, motion)
    dt = motion.duration / (CHUNK * max(1, math.ceil(motion.duration / (CHUNK * step))))
    return dt, math.ceil((motion.duration + tail) / (CHUNK * dt) * (1.0 - 1e-12))
