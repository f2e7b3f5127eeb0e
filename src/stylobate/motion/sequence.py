"""Earthquakes one after another as one motion: records, the rest after each of them, and where each begins and ends."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ..errors import InputError, check_all, check_range, check_whole
from .motion import MAX_SAMPLES, Motion

#: Quiet ground after each earthquake where nothing else is said [s].
REST = 30.0

#: Longest rest [s], and most earthquakes.
LONGEST_REST, MOST = 3600.0, 1000

#: Most parts into which a step of a record is divided, so that the steps of all are one.
FINEST = 50

#: Key of the metadata of a motion that is a sequence.
KEY = "sequence"


@dataclass(frozen=True)
class Span:
    """An earthquake of a sequence, with the rest after it.

    Parameters
    ----------
    motion : str
        What shakes.
    begins, quiet, ends : float
        When its shaking begins, when it is over, and when the rest after it is [s].
    """

    motion: str
    begins: float
    quiet: float
    ends: float


def in_sequence(motions: Motion | Sequence[Motion], rest: float = REST, repeat: int = 1) -> Motion:
    """One motion of several, one after the other, each followed by quiet ground.

    Between the last sample of one and the first zero of the rest, and between the last zero and the first sample of the
    next, the acceleration is linear, as between any samples. Steps that differ are divided into their largest common one,
    which the processing says; the acceleration stays the same, being linear between samples.

    Parameters
    ----------
    motions : sequence of Motion
        In this order. Scale them before: ``[main, main.scaled(0.6)]``.
    rest : float
        Quiet ground after each of them, the last one too [s]; rounded up to whole steps.
    repeat : int
        How often all of them come, one after the other.

    Returns
    -------
    Motion
        ``metadata["sequence"]`` holds the :class:`Span` of each earthquake.

    Raises
    ------
    InputError
        No motion, components that differ, steps without a common one, a rest that is negative, more samples than memory.
    """
    once = check_all("motions", motions, Motion)
    rest = check_range("`rest`", rest, 0.0, LONGEST_REST, unit="s")
    repeat = check_whole("`repeat`", repeat, 1, MOST)
    if not once:
        raise InputError("no motion is given; give at least one.", "motions")
    if len(once) * repeat > MOST:
        raise InputError(
            f"{len(once) * repeat} earthquakes are asked for; allowed is up to {MOST}: give fewer.", "repeat"
        )
    axes = [tuple(motion.components) for motion in once]
    if len(set(axes)) > 1:
        other = next(k for k, components in enumerate(axes) if components != axes[0])
        raise InputError(
            f"{once[0].name!r} has the components {', '.join(axes[0])} and {once[other].name!r} {', '.join(axes[other])}; "
            "give each earthquake of a sequence the same ones: name one `component` of each, and leave the vertical out.",
            "motions",
        )
    dt = _common_step(once)
    zeros = math.ceil(rest / dt * (1.0 - 1e-12))
    parts = [round(motion.dt / dt) for motion in once]
    total = repeat * sum((motion.steps - 1) * part + 1 + zeros for motion, part in zip(once, parts, strict=True))
    if total > MAX_SAMPLES:
        raise InputError(
            f"the sequence takes {total} samples; allowed is up to {MAX_SAMPLES}: give fewer earthquakes, or less rest.",
            "rest",
        )
    samples: dict[str, list[np.ndarray]] = {axis: [] for axis in axes[0]}
    spans: list[Span] = []
    place, notes = 0, []
    for _ in range(repeat):
        for motion, part in zip(once, parts, strict=True):
            for axis, values in motion.components.items():
                samples[axis] += [_divided(values, part), np.zeros(zeros)]
            count = (motion.steps - 1) * part + 1
            begins, quiet = place * dt, (place + count - 1) * dt
            place += count + zeros
            spans.append(Span(motion.name, begins, quiet, (place - 1) * dt))
    for motion, part in zip(once, parts, strict=True):
        notes += [f"{motion.name}: {step}" for step in motion.processing]
        if part > 1:
            notes.append(
                f"{motion.name}: step of {motion.dt:g} s divided into {part} of {dt:.6g} s, linear between samples"
            )
    known: dict[str, Any] = {KEY: tuple(spans)}
    if left_out := [f"{motion.name}: {text}" for motion in once for text in motion.metadata.get("left_out", ())]:
        known["left_out"] = tuple(dict.fromkeys(left_out))
    if all("format" in motion.metadata for motion in once):
        known["format"] = "sequence"
    azimuths = [motion.metadata.get("azimuths") for motion in once]
    if azimuths[0] and all(directions == azimuths[0] for directions in azimuths):
        known["azimuths"] = azimuths[0]
    if references := [key for motion in once for key in motion.metadata.get("references", ())]:
        known["references"] = tuple(dict.fromkeys(references))
    x, y, z = (np.concatenate(samples[axis]) if axis in samples else None for axis in "xyz")
    return Motion(dt, x, y, z, name=_name(once, repeat), metadata=known, processing=tuple(dict.fromkeys(notes)))


def spans_of(motion: Motion) -> tuple[Span, ...]:
    """The earthquakes of a sequence; of any other motion none."""
    return tuple(motion.metadata.get(KEY, ()))


def number_at(spans: Sequence[Span], time: float | None) -> int | None:
    """Number of the earthquake, from 1, during or after which something happened [s]; None where it did not."""
    if time is None or math.isnan(time) or not spans:
        return None
    return max(1, sum(span.begins <= time for span in spans))


def _name(motions: Sequence[Motion], repeat: int) -> str:
    names = [motion.name for motion in motions]
    each = ", then ".join(names) if len(names) <= 3 else f"{names[0]} and {len(names) - 1} more"
    if repeat == 1:
        return each
    return f"{repeat} times {each}" if len(names) == 1 else f"{repeat} times ({each})"


def _common_step(motions: Sequence[Motion]) -> float:
    """Largest step of which the steps of all motions are whole multiples [s]."""
    steps = [motion.dt for motion in motions]
    if len(set(steps)) == 1:
        return steps[0]
    fractions = [Fraction(step).limit_denominator(1_000_000) for step in steps]
    exact = all(abs(float(fraction) - step) <= 1e-9 * step for fraction, step in zip(fractions, steps, strict=True))
    whole = math.lcm(*(fraction.denominator for fraction in fractions))
    common = Fraction(math.gcd(*(int(fraction * whole) for fraction in fractions)), whole)
    if not exact or max(fractions) > FINEST * common:
        shortest, longest = min(steps), max(steps)
        raise InputError(
            f"the steps of the motions, {shortest:.6g} s and {longest:.6g} s, have no common one of at least a "
            f"{FINEST}th of them; resample one of them (the step resample of `condition`).",
            "motions",
        )
    return float(common)


def _divided(values: np.ndarray, parts: int) -> np.ndarray:
    """Samples with so many equal steps in place of each, on the line between them."""
    if parts == 1:
        return values
    share = np.arange(parts) / parts
    return np.append((values[:-1, None] + np.diff(values)[:, None] * share).ravel(), values[-1])
