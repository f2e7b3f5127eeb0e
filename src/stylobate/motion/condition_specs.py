"""Notation of a step of conditioning: ``detrend``, ``bandpass=0.1Hz,25Hz``, ``taper=2s``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..errors import InputError, suggest
from . import conditioning as c
from .motion import Motion
from .specs import parse_acceleration, parse_frequency, parse_time

#: Units of velocity that may be typed, in m/s.
VELOCITY_UNITS = {"mm/s": 0.001, "cm/s": 0.01, "m/s": 1.0}


@dataclass(frozen=True)
class Step:
    """A step by the name that it has on the command line.

    Parameters
    ----------
    example : str
        How to write it.
    counts : tuple of int
        Allowed numbers of values behind the equals sign.
    apply : callable
        Given the motion and the values as typed.
    size : callable, optional
        Of a step that multiplies a motion until it is as large as asked for: how large it is, of the same arguments.
    """

    example: str
    counts: tuple[int, ...]
    apply: Callable[..., Motion]
    size: Callable[..., float] | None = None


#: Every step, in the order in which they are usually taken.
STEPS: dict[str, Step] = {
    "demean": Step("demean or demean=2s", (0, 1), lambda m, *v: c.demean(m, *map(parse_time, v))),
    "detrend": Step("detrend", (0,), c.detrend),
    "taper": Step("taper=2s", (1,), lambda m, v: c.taper(m, parse_time(v))),
    "bandpass": Step(
        "bandpass=0.1Hz,25Hz", (2,), lambda m, low, high: c.bandpass(m, parse_frequency(low), parse_frequency(high))
    ),
    "highpass": Step("highpass=0.1Hz", (1,), lambda m, v: c.bandpass(m, parse_frequency(v), None)),
    "lowpass": Step("lowpass=25Hz", (1,), lambda m, v: c.bandpass(m, None, parse_frequency(v))),
    "baseline": Step("baseline=6", (0, 1), lambda m, *v: c.baseline_polynomial(m, *map(_whole_number, v))),
    "baseline-piecewise": Step(
        "baseline-piecewise or baseline-piecewise=5s,20s",
        (0, 2),
        lambda m, *v: c.baseline_piecewise(m, *map(parse_time, v)),
    ),
    "resample": Step("resample=0.005s", (1,), lambda m, v: c.resample(m, parse_time(v))),
    "trim": Step("trim or trim=0.05,0.95", (0, 2), lambda m, *v: c.trim(m, *map(_number, v))),
    "pgv": Step("pgv=0.3m/s", (1,), lambda m, v: c.scale_to_pgv(m, _velocity(v)), lambda m, _: m.pgv),
    "sa": Step(
        "sa=1.0s,0.3g",
        (2,),
        lambda m, t, a: c.scale_to_sa(m, parse_time(t), parse_acceleration(a)),
        lambda m, t, _: c.sa_of(m, parse_time(t)),
    ),
}


def conditioned(motion: Motion, text: str) -> Motion:
    """Apply one step of conditioning as typed; it writes itself into the processing history.

    Parameters
    ----------
    motion : Motion
    text : str
        A key of :data:`STEPS`, with its values and their units behind an equals sign.

    Raises
    ------
    InputError
        The text cannot be understood, or the step cannot be done to this motion.
    """
    step, values = _step(text)
    return step.apply(motion, *values)


def conditioned_alike(motions: Sequence[Motion], text: str) -> list[Motion]:
    """Apply one step to directions of one record; where it scales, all have the factor of the strongest."""
    step, values = _step(text)
    if step.size is None or len(motions) < 2:
        return [step.apply(one, *values) for one in motions]
    sizes = [step.size(one, *values) for one in motions]
    strongest = motions[sizes.index(max(sizes))]
    scaled = step.apply(strongest, *values)
    times = scaled.factor / strongest.factor
    said = f"{scaled.processing[-1]}, that of the strongest of these directions"
    return [one.replace(factor=one.factor * times, processing=(*one.processing, said)) for one in motions]


def scales(text: str) -> bool:
    """Whether a step as typed multiplies a motion until it is as large as asked for."""
    return _step(text)[0].size is not None


def _step(text: str) -> tuple[Step, list[str]]:
    """A step as typed, and its values."""
    name, sign, rest = text.partition("=")
    key = name.strip().lower()
    if key not in STEPS:
        raise InputError(f"`condition` {text!r} is no step; {suggest(key, STEPS)}steps are {', '.join(STEPS)}.")
    step = STEPS[key]
    values = [value.strip() for value in rest.split(",")] if sign else []
    if len(values) not in step.counts or not all(values):
        raise InputError(f"`condition` {text!r} is not understood; write it as {step.example}.")
    return step, values


def _velocity(text: str) -> float:
    for unit, size in VELOCITY_UNITS.items():
        if text.endswith(unit):
            return _number(text.removesuffix(unit)) * size
    raise InputError(f"{text!r} is not a value of velocity; write it with its unit, as in '0.3m/s'.")


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{text!r} is not a number.") from None


def _whole_number(text: str) -> int:
    if not text.isdecimal():
        raise InputError(f"{text!r} is not a whole number.")
    return int(text)
