"""Motions for the page: the one asked for, thinned for its plot, with its measures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from stylobate.column import Column
from stylobate.constants import g
from stylobate.motion import Motion, MotionRequest
from stylobate.motion.intensity import motion_summary, rocking_measures, warn_of_drift

from .forms import doubted, warned
from .job_request import MotionChoice

#: Most points of a plotted line, and of the path in plan.
POINTS, PATH = 2400, 1500


def describe(motion_choice: MotionChoice, files: Sequence[str], column: Column | None) -> dict[str, Any]:
    """Motion on the page.

    Parameters
    ----------
    motion_choice : MotionChoice
    files : sequence of str
        Of the record.
    column : Column, optional
        For measures relative to it.

    Raises
    ------
    InputError
        There is no such motion.
    """
    with doubted() as doubts:
        request = MotionRequest.typed(**motion_choice.words(files))
        motion = request.motion(None if column is None else column.frequency_parameter)
        summary = motion_summary(motion, spectrum=False)
        warn_of_drift(motion)
        relative = None
        peak, axis = motion.horizontal_peak
        if column is not None and peak > 0.0:
            relative = rocking_measures(motion, math.tan(column.slenderness), column.frequency_parameter, axis)
    return {
        "summary": summary,
        "relative": relative,
        "duration": motion.duration,
        "lines": {axis: _thinned(motion.time, values / g) for axis, values in motion.components.items()},
        "path": _path(motion),
        "warnings": warned(doubts),
    }


def _thinned(time: np.ndarray, values: np.ndarray) -> list[list[float]]:
    """Times and values of a line that looks the same: of every piece its least and its largest value."""
    if len(values) <= POINTS:
        return [time.round(5).tolist(), values.round(6).tolist()]
    size = -(-len(values) // (POINTS // 2))
    whole = np.arange(0, len(values), size)
    low = np.array([start + int(values[start : start + size].argmin()) for start in whole])
    high = np.array([start + int(values[start : start + size].argmax()) for start in whole])
    chosen = np.unique(np.concatenate((low, high, [0, len(values) - 1])))
    return [time[chosen].round(5).tolist(), values[chosen].round(6).tolist()]


def _path(motion: Motion) -> list[list[float]] | None:
    """The acceleration in plan [g]: x and y; None along x alone."""
    if motion.lateral is None:
        return None
    step = -(-motion.steps // PATH)
    return [(motion.components[axis][::step] / g).round(5).tolist() for axis in "xy"]
