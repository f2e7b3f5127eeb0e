"""What joints lose, from a measured free motion: losses, and the restitution of impacts in closed form."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from stylobate.column import Column
from stylobate.column.joint import LAWS
from stylobate.errors import InputError, check_kind, check_range
from stylobate.models.base import Model
from stylobate.models.drums.impact import Free, one_body, released
from stylobate.models.drums.stepped import LossyDrums
from stylobate.models.start import Start, check_takes_pose

from .calibration import Calibration, Loss, losses_at, start_of
from .free_history import FreeHistory
from .loss_likelihood import likelihoods, searched
from .swings import Wobble, beginning, envelope, kept, kept_at, of_increments, sides_of, swings

#: Damping is looked for between these, over the time of contact 1/√(k_n A/m) of the column as one body [-]: less than the
#: first loses nothing beside what springs and friction do, more than the last nothing more than a plastic impact.
DAMPING = 1e-3, 10.0

#: Resistance to rolling is looked for between these [-]; :data:`stylobate.column.materials.ROLLING` lies in their middle.
ROLLING = 1e-4, 0.1

#: Motions that are computed of each law, in a plane and in space: at first, in each further round, and rounds at most.
IN_PLANE, IN_SPACE = (48, 48, 4), (384, 192, 5)

#: Discrepancies of decrements at least: of an impact in a plane, and of a wobble, whose phase is lost [-].
LEAST_OF_IMPACTS, LEAST_OF_WOBBLES = 0.0025, 0.01

#: Restitutions are looked for by so much of their logarithm to either side of the mean, at so many places.
AROUND, PLACES = 0.15, 241

#: Fewest steps of a history in a swing.
FEWEST_STEPS = 15

#: Fewest decrements, and most windows of a wobble.
FEWEST, MOST = 2, 12

#: A wobble counts as long as its lean is this multiple of its noise, and this share of its first extreme.
OVER_NOISE, LEAST = 10.0, 0.05

#: Share of that to which computed motions are followed [-].
FLOOR = 0.05


def calibrate(
    history: FreeHistory,
    column: Column,
    model: Model | None = None,
    *,
    height: float | None = None,
    noise: float | None = None,
    confidence: float = 0.9,
    progress: Callable[[int, int], None] | None = None,
) -> Calibration:
    """Losses of a column from its measured free rocking in a plane, or wobbling in space.

    Parameters
    ----------
    history : FreeHistory
        One column of values for a body that rocks in a plane, two for one that wobbles.
    column : Column
        As built; a single drum, or several that move as one body.
    model : DistinctElement3D or DistinctElement2D, optional
        What computes it, without losses; ``DistinctElement3D()`` by default. Round columns wobble, but for models that are
        held in a plane.
    height : float, optional
        At which a displacement is measured, above the base [m]; the column's by default.
    noise : float, optional
        Standard deviation of the values, white [rad or m]; estimated by default.
    confidence : float
        Of intervals.
    progress : callable, optional
        Called with the number of motions computed, and of all.

    Returns
    -------
    Calibration

    Raises
    ------
    InputError
        A history that does not swing, is too short or too coarse, or is not of this column.
    """
    model = _checked(history, column, model)
    check_range("confidence", confidence, 0.5, 0.999)
    if height is not None:
        check_range("height", height, 0.0, 2.0 * column.height, unit="m", open_low=True)
    if noise is not None:
        check_range("noise", noise, 0.0, 1e3, open_low=True)
    lean, sd = history.tilts(column.height if height is None else height, 0.5 * column.base_width, noise)
    size, alpha = np.hypot(lean[:, 0], lean[:, -1] * (lean.shape[1] - 1)), one_body(column).slenderness
    if float(size.max()) >= alpha:
        raise InputError(
            f"{history.name} leans by {math.degrees(size.max()):.3g}°, and {column.name!r} falls from "
            f"{math.degrees(alpha):.3g}° on: check the column, and the unit of the history."
        )
    measured = Free(history.time, lean if lean.shape[1] == 2 else np.hstack((lean, np.zeros_like(lean))))
    done = 0
    first, further, rounds = IN_PLANE if lean.shape[1] == 1 else IN_SPACE
    of = len(_laws(column, model)) * (first + further * rounds)

    def advance(number: int) -> None:
        nonlocal done
        done += number
        if progress is not None:
            progress(done, of)

    restitution = None
    if lean.shape[1] == 1:
        fields = _of_swings(history, column, model, lean[:, 0], sd, advance)
        logs, covariance = fields.pop("impacts")
        restitution = _restitution(logs, covariance, confidence)
    else:
        fields = _of_wobble(history, column, model, lean, sd, advance)
    return Calibration(column, model, history, confidence, sd, measured, **fields, restitution=restitution)


def _checked(history: FreeHistory, column: Column, model: Model | None) -> LossyDrums:
    """The model that computes it, held in a plane where the history is of one; whatever does not go together is refused."""
    from stylobate.models.dem3d.model import DistinctElement3D

    check_kind("history", history, FreeHistory)
    check_kind("column", column, Column)
    check_kind("model", model, Model, optional=True)
    model = DistinctElement3D() if model is None else model
    if not isinstance(model, LossyDrums) or model.damped:
        raise InputError(
            f"losses are looked for, with {model.name} as it is given; give dem2d or dem3d without damping of its own.",
            "model",
        )
    check_takes_pose(Start(0.0), column)
    wobbles = column.section == "circular" and not model.is_plane(model.parameters())
    two = history.values.shape[1] == 2
    if wobbles and not two:
        raise InputError(
            f"{history.name} has one column of values, and {column.name!r} is round: one direction does not tell how far it "
            "leans; give two (x and y), or, if it rocked in one plane, compute it in one plane (planar = true).",
            "history",
        )
    if two and not wobbles:
        raise InputError(
            f"{history.name} has two columns of values, and what rocks in a plane has one; give the one in its plane.",
            "history",
        )
    return dataclasses.replace(model, planar=True) if isinstance(model, DistinctElement3D) and not wobbles else model


def _of_swings(
    history: FreeHistory, column: Column, model: LossyDrums, tilt: np.ndarray, noise: float, advance: Any
) -> dict[str, Any]:
    """Losses from the extremes of a body that rocks in a plane."""
    time, alpha = history.time, one_body(column).slenderness
    peaks = swings(time, tilt, noise)
    if len(peaks.tilts) < FEWEST + 1:
        sides = len(sides_of(tilt, noise))
        if sides > FEWEST + 1:
            why = "its samples are too far apart to tell how far it swings: give a shorter step"
        else:
            why = "the history must go on for more swings, from its release on"
        raise InputError(
            f"{history.name} has {len(peaks.tilts)} swings beyond its noise ({noise:.2g} rad) that are resolved, of "
            f"{sides}; {FEWEST + 1} are needed: {why}."
        )
    if bool((np.diff(peaks.tilts) > 4.0 * (peaks.errors[1:] + peaks.errors[:-1]) + 0.02 * peaks.tilts[:-1]).any()):
        grows = int(np.argmax(np.diff(peaks.tilts)))
        raise InputError(
            f"{history.name} swings farther at {peaks.times[grows + 1]:.4g} s than before; a free motion dies away: cut it, "
            "or take off its offset."
        )
    logs, covariance = kept(peaks, alpha)
    limits = (_damping_limits(column),)
    start = Start(min(1.02 * float(peaks.tilts[0]), 0.99 * alpha))
    duration = 3.0 * float(peaks.times[-1] - peaks.times[0]) + 2.0 / column.frequency_parameter
    interval = float(np.diff(peaks.times).min()) / 40.0

    def computed(law: str | None, at: np.ndarray) -> np.ndarray:
        losses = [losses_at(point, limits, law) for point in at]
        motions = released(column, model, losses, [start] * len(at), duration, interval)
        advance(len(at))
        return np.stack([kept_at(peaks.tilts[:-1], motion.time, motion.lean[:, 0], alpha) for motion in motions])

    after = searched(computed, logs, covariance, _laws(column, model), 1, IN_PLANE, LEAST_OF_IMPACTS)
    side = math.pi if tilt[int(np.argmin(np.abs(time - peaks.times[0])))] < 0.0 else 0.0
    begin = Wobble(float(peaks.times[0]), float(peaks.tilts[0]), side, 0.0, 0.0)
    return {
        "beginning": begin, "edges": peaks.times, "amplitudes": peaks.tilts, "after": after, "limits": limits,
        "impacts": (logs, covariance),
    }  # fmt: skip


def _of_wobble(
    history: FreeHistory, column: Column, model: LossyDrums, lean: np.ndarray, noise: float, advance: Any
) -> dict[str, Any]:
    """Losses from how fast the wobble of a round column dies."""
    time, size = history.time, np.hypot(*lean.T)
    begin = beginning(time, lean, noise)
    least = max(OVER_NOISE * noise, LEAST * begin.tilt)
    lasts = float(time[np.flatnonzero(size > least)[-1]])
    edges = _windows(begin, time, size, lasts, column)
    if len(edges) < FEWEST + 2:
        raise InputError(
            f"{history.name} wobbles for {lasts - begin.time:.3g} s beyond its noise ({noise:.2g} rad), {len(edges) - 1} "
            f"swings; {FEWEST + 1} are needed: give a longer history, from its release on."
        )
    shortest = float(np.diff(edges).min())
    if history.dt > shortest / FEWEST_STEPS:
        raise InputError(
            f"{history.name} has a step of {history.dt:.3g} s; allowed is up to {shortest / FEWEST_STEPS:.2g} s for swings "
            "of this column: give a history with a shorter step."
        )
    logs = envelope(begin.time, time, size, edges, 0.5 * least)
    limits = (_damping_limits(column), ROLLING)
    duration, interval = float(edges[-1]) + 0.2 * float(edges[1]), shortest / 60.0

    def computed(law: str | None, at: np.ndarray) -> np.ndarray:
        losses, starts = [losses_at(point, limits, law) for point in at], [start_of(begin, point[2:]) for point in at]
        decrements = []
        for motion in released(column, model, losses, starts, duration, interval):
            decrements.append(np.diff(envelope(0.0, motion.time, np.hypot(*motion.lean.T), edges, FLOOR * least)))
        advance(len(at))
        return np.stack(decrements)

    measured, covariance = np.diff(logs), of_increments((noise * np.exp(-logs)) ** 2)
    after = searched(computed, measured, covariance, _laws(column, model), 4, IN_SPACE, LEAST_OF_WOBBLES)
    middles = begin.time + 0.5 * (edges[1:] + edges[:-1])
    return {"beginning": begin, "edges": middles, "amplitudes": np.exp(logs), "after": after, "limits": limits}


def _windows(begin: Wobble, time: np.ndarray, size: np.ndarray, lasts: float, column: Column) -> np.ndarray:
    """Ends of :data:`MOST` windows at most, each as long as swings of what it leans in the one before [s]."""
    longer = 1.0
    while True:
        edges, tilt = [0.0], begin.tilt
        while True:
            end = edges[-1] + longer * _half_swing(tilt, column)
            if begin.time + end > lasts:
                break
            inside = size[(time >= begin.time + edges[-1]) & (time < begin.time + end)]
            tilt = min(tilt, float(inside.max(initial=0.0)))
            edges.append(end)
        if len(edges) <= MOST + 1:
            return np.array(edges)
        longer *= 1.2


def _half_swing(tilt: float, column: Column) -> float:
    """Time between extremes of a slender block, 2 arcosh(1/(1 − θ/α))/p (Housner 1963), and a quarter more [s]."""
    share = min(tilt / column.slenderness, 0.95)
    return 1.25 * 2.0 * math.acosh(1.0 / (1.0 - share)) / column.frequency_parameter


def _laws(column: Column, model: LossyDrums) -> tuple[str | None, ...]:
    whole = not column.on_rings
    return (LAWS if whole else ("bed",)) if column.section == "circular" and "y" in model.axes else (None,)


def _damping_limits(column: Column) -> tuple[float, float]:
    joint = column.joints[0]
    contact = math.sqrt(column.mass / (joint.normal_stiffness * float(column.joint_areas[0])))
    return DAMPING[0] * contact, min(DAMPING[1] * contact, 1.0)


def _restitution(logs: np.ndarray, covariance: np.ndarray, confidence: float) -> Loss:
    """Restitution of an impact by extremes alone, as if all had one."""
    known = np.linalg.solve(covariance + LEAST_OF_IMPACTS**2 * np.eye(len(logs)), np.ones(len(logs)))
    places = float(known @ logs / known.sum()) + np.linspace(-AROUND, AROUND, PLACES)
    computed = np.tile(places[:, None], len(logs))
    known = likelihoods(computed, logs, covariance, LEAST_OF_IMPACTS)[0]
    weights = np.exp(known - known.max())
    weights /= weights.sum()
    outside = 0.5 * (1.0 - confidence)
    low, high = np.interp([outside, 1.0 - outside], np.cumsum(weights) - 0.5 * weights, places)
    return Loss(math.exp(float(weights @ places)), math.exp(low), math.exp(high), "")
