"""Warnings of models that only rock: of columns that would slide, and of motions that would lift them off the ground."""

from __future__ import annotations

import math

from ...column import Column
from ...errors import warn
from ...messages import say
from ...motion import Motion


def warn_sliding(column: Column, alpha: float, name: str, remedy: str) -> None:
    """Warn of joints on which a column of slenderness α [rad] slides before it rocks, in a model without sliding."""
    joint = min(range(column.n), key=lambda i: column.joints[i].tan_phi)
    friction = column.joints[joint].tan_phi
    if math.tan(alpha) > friction:
        where = "" if column.n == 1 else say(" of joint {joint}", joint=joint + 1)
        words = say(
            "tan α = {slope:.3f} is above the friction coefficient {friction:.3f}{where}: the column slides before it rocks, and "
            "{model} as it is set has no sliding; {remedy}."
        )
        warn(words.of(slope=math.tan(alpha), friction=friction, where=where, model=name, remedy=remedy))


def warn_of_free_flight(column: Column, motion: Motion) -> None:
    """Warn of a motion under which the column would leave the ground."""
    vertical = motion.vertical
    if vertical is not None and float(vertical.min()) <= -column.gravity:
        warn(
            f"the vertical acceleration of {motion.name!r} falls to {vertical.min() / column.gravity:.2f} g; below −1 g the "
            "column would leave the ground, which this model does not follow: a run that gets there fails."
        )
