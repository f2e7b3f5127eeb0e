"""Conditioning between a record and an input motion: the steps, their notation, and which of them takes a drift off.

A step is a pure function that writes itself into the processing history. Nothing is applied unless it is called. All
components are treated alike, and ``factor`` is left alone, except where a function scales.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ..constants import g
from ..errors import InputError, OutOfRangeWarning, check_range, suggest, warn
from ..messages import joined, percent, percents, say
from .motion import MAX_SAMPLES, STRONGEST, Motion, arias_growth, displacement, integrate, square_integral
from .specs import parse_acceleration, parse_frequency, parse_time

#: An end with less than this share of the peak is quiet.
QUIET_SHARE = 0.01

#: Scaling a record by more than this draws a warning [-].
LARGEST_SCALING = 10.0


def demean(motion: Motion, pre_event: float | None = None) -> Motion:
    """Take off the mean of each component, of the whole record or of its first ``pre_event`` seconds.

    Parameters
    ----------
    motion : Motion
    pre_event : float, optional
        Length of the quiet beginning whose mean is the zero level [s].
    """
    count = motion.steps
    if pre_event is not None:
        check_range("pre_event", pre_event, motion.dt, motion.duration, unit="s")
        count = round(pre_event / motion.dt) + 1
    part = say("the record") if pre_event is None else say("the first {pre_event:g} s", pre_event=pre_event)
    return _changed(motion, lambda a: a - a[:count].mean(), say("mean of {part} taken off", part=part))


def detrend(motion: Motion) -> Motion:
    """Take off the straight line that fits each component best."""

    def straight(a: np.ndarray) -> np.ndarray:
        t = np.linspace(-1.0, 1.0, len(a))
        return a - a.mean() - t * ((t @ a) / (t @ t))

    return _changed(motion, straight, say("linear trend taken off"))


def baseline_polynomial(motion: Motion, order: int = 6) -> Motion:
    """Baseline correction by a polynomial of the displacement, which then ends near zero.

    Parameters
    ----------
    motion : Motion
    order : int
        Highest power of time in the polynomial; its constant and linear terms are zero, so that displacement and
        velocity start at rest.

    Notes
    -----
    The polynomial is fitted to the displacement and its second derivative is taken off the acceleration. A permanent
    displacement of the ground is lost: use :func:`baseline_piecewise` to keep one.

    References
    ----------
    Ancheta et al. (2014), NGA-West2 database, section on the baseline correction.
    """
    n = int(check_range("order of the baseline", order, 2, 12))

    def corrected(a: np.ndarray) -> np.ndarray:
        s = np.linspace(0.0, 1.0, len(a))
        total = (len(a) - 1) * motion.dt
        powers = np.stack([s**k for k in range(2, n + 1)], axis=1)
        weights = np.linalg.lstsq(powers, displacement(a, motion.dt), rcond=None)[0]
        curve = sum(w * k * (k - 1) * s ** (k - 2) for w, k in zip(weights, range(2, n + 1)))
        return a - curve / total**2

    return _changed(
        motion, corrected, say("baseline: polynomial of order {n} fitted to the displacement taken off", n=n)
    )


def baseline_piecewise(motion: Motion, start: float | None = None, end: float | None = None) -> Motion:
    """Baseline correction by two constant offsets, which keeps a permanent displacement.

    Parameters
    ----------
    motion : Motion
    start, end : float, optional
        Strong shaking, during which the instrument's baseline moved [s]; by default 5 % and 95 % of the Arias
        intensity of all components together.

    Notes
    -----
    A straight line is fitted to the velocity after ``end``. Its slope is the offset after ``end``; the offset between
    ``start`` and ``end`` is the constant one that leads to the line's value there. The velocity after ``end`` is then
    zero on average, and the displacement settles at its permanent value.

    References
    ----------
    Iwan, Moser and Peng (1985); Boore (2001).
    """
    growth = arias_growth(motion)
    t1 = float(np.interp(0.05, growth, motion.time)) if start is None else start
    t2 = float(np.interp(0.95, growth, motion.time)) if end is None else end
    check_range("start of strong shaking", t1, 0.0, motion.duration, unit="s")
    check_range("end of strong shaking", t2, t1, motion.duration, unit="s", open_low=True)
    # On samples, so that the areas are exact; the corners of the offset are its middle values.
    i, j = round(t1 / motion.dt), round(t2 / motion.dt)
    if j - i < 2 or motion.steps - j < 10:
        raise InputError(
            f"strong shaking from {t1:g} s to {t2:g} s leaves no quiet end in {motion.duration:g} s; "
            "state start and end, or use baseline_polynomial."
        )

    def corrected(a: np.ndarray) -> np.ndarray:
        v = integrate(a, motion.dt)
        after = (np.arange(len(a)) - j) * motion.dt
        slope, at_end = np.polyfit(after[j:], v[j:], 1)
        offset = np.zeros(len(a))
        between = at_end / ((j - i) * motion.dt)
        offset[i:j], offset[j:] = between, slope
        offset[i], offset[j] = 0.5 * between, 0.5 * (between + slope)
        return a - offset

    text = say(
        "baseline: constant offsets from {first:g} to {last:g} s and after it taken off",
        first=i * motion.dt,
        last=j * motion.dt,
    )
    return _changed(motion, corrected, text)


def taper(motion: Motion, length: float, *, start: bool = True, end: bool = True) -> Motion:
    """Lead the ends to zero with half a cosine.

    Parameters
    ----------
    motion : Motion
    length : float
        Of each taper [s], up to half of the record.
    start, end : bool
        Which ends.
    """
    check_range("length of the taper", length, motion.dt, 0.5 * motion.duration, unit="s")
    count = round(length / motion.dt)
    ramp = 0.5 * (1.0 - np.cos(np.pi * np.arange(count) / count))

    def tapered(a: np.ndarray) -> np.ndarray:
        out = a.copy()
        if start:
            out[:count] *= ramp
        if end:
            out[-count:] *= ramp[::-1]
        return out

    names = [say("start") if start else "", say("end") if end else ""]
    ends = joined(say(" and "), names) or say("no end")
    return _changed(motion, tapered, say("cosine taper of {dt:g} s at {ends}", dt=count * motion.dt, ends=ends))


def bandpass(
    motion: Motion, low: float | None, high: float | None, order: int = 4, *, keep_padding: bool = True
) -> Motion:
    """Acausal Butterworth filter: forward and backward, without phase shift.

    Parameters
    ----------
    motion : Motion
    low, high : float or None
        Corner frequencies [Hz]; None leaves that side open.
    order : int
        Of one pass.
    keep_padding : bool
        Keep the zeros that are put before and after the record, where the filter rings. Without them the velocity and
        the displacement do not return to rest.

    Notes
    -----
    Computed as a gain on the spectrum, 1/(1 + (f_low/f)^2n) · 1/(1 + (f/f_high)^2n): the squared gain of one pass.
    Zeros of 1.5 n / f_low seconds are put at each end.

    References
    ----------
    Boore (2005); Boore and Bommer (2005).
    """
    nyquist = 0.5 / motion.dt
    n = int(check_range("order of the filter", order, 1, 10))
    if low is None and high is None:
        raise InputError("a filter needs a low or a high corner frequency; give one, e.g. low=0.1.")
    if low is not None:
        check_range("low corner frequency", low, 1e-4, nyquist, unit="Hz", open_high=True)
    if high is not None:
        remedy = "the record holds nothing above it"
        check_range("high corner frequency", high, low or 0.0, nyquist, unit="Hz", open_low=True, remedy=remedy)
    pad = math.ceil(1.5 * n / (low or high or 1.0) / motion.dt)
    total = motion.steps + 2 * pad
    if total > MAX_SAMPLES:
        raise InputError(f"a low corner of {low:g} Hz needs {total} samples; allowed is up to {MAX_SAMPLES}: raise it.")
    size = _fast_length(total)
    f = np.fft.rfftfreq(size, motion.dt)
    gain = np.ones_like(f)
    if low is not None:
        with np.errstate(divide="ignore"):
            gain /= 1.0 + (low / f) ** (2 * n)  # Boore (2005), the square of one pass
    if high is not None:
        gain /= 1.0 + (f / high) ** (2 * n)

    def filtered(a: np.ndarray) -> np.ndarray:
        padded = np.zeros(size)
        padded[pad : pad + len(a)] = a
        out = np.fft.irfft(np.fft.rfft(padded) * gain, size)[:total]
        return out if keep_padding else out[pad : pad + len(a)]

    band = say("{low:g} Hz up") if high is None else say("{low:g} to {high:g} Hz")
    band = band.of(low=low or 0.0, high=high)
    zeros = (
        say("zeros of {time:g} s at each end kept")
        if keep_padding
        else say("zeros of {time:g} s at each end cut off again")
    )
    padding = zeros.of(time=pad * motion.dt)
    return _changed(
        motion,
        filtered,
        say("acausal Butterworth filter of order {n}, {band}; {padding}", n=n, band=band, padding=padding),
    )


def resample(motion: Motion, dt: float) -> Motion:
    """Another step, by way of the spectrum: nothing is folded back from above the new Nyquist frequency.

    Parameters
    ----------
    motion : Motion
    dt : float
        New step [s]; old and new step must be in the ratio of whole numbers up to 1000.

    Notes
    -----
    A coarser step loses what lies above 0.8 of its Nyquist frequency (a cosine flank, gone at 1.0). A finer step adds
    nothing. Zeros follow the record on the way, so that its end does not wrap around to its beginning.
    """
    new = check_range("dt", dt, 1e-6, 10.0, unit="s")
    ratio = Fraction(new / motion.dt).limit_denominator(1000)
    if abs(float(ratio) - new / motion.dt) > 1e-9 * float(ratio) or ratio == 0:
        raise InputError(
            f"new step {new:g} s and old step {motion.dt:g} s are not in the ratio of small whole numbers; choose a "
            f"step such as {motion.dt * 2:g} or {motion.dt / 2:g} s."
        )
    p, q = ratio.numerator, ratio.denominator
    if motion.steps * q / p > MAX_SAMPLES:
        raise InputError(f"dt of {new:g} s gives {motion.steps * q // p} samples; allowed is up to {MAX_SAMPLES}.")
    blocks = _fast_length(math.ceil((motion.steps + min(motion.steps, 1000)) / p) + 1)
    old_size, new_size = blocks * p, blocks * q
    count = math.floor((motion.steps - 1) * q / p + 1e-9) + 1

    def at_new_step(a: np.ndarray) -> np.ndarray:
        spectrum = np.fft.rfft(a, old_size)
        if new_size < old_size:
            share = np.arange(new_size // 2 + 1) / (new_size / 2)
            flank = np.clip((share - 0.8) / 0.2, 0.0, 1.0)
            spectrum = spectrum[: new_size // 2 + 1] * (0.5 * (1.0 + np.cos(np.pi * flank)))
        return np.fft.irfft(spectrum, new_size)[:count] * (new_size / old_size)

    text = say("resampled from {motion.dt:g} to {new:g} s by way of the spectrum", motion=motion, new=new)
    return _changed(motion, at_new_step, text, dt=motion.dt * p / q)


def trim(
    motion: Motion,
    low: float = 0.05,
    high: float = 0.95,
    *,
    before: float = 0.0,
    after: float = 0.0,
    ends: float | None = None,
) -> Motion:
    """Keep the significant duration: from ``low`` to ``high`` of the Arias intensity of all components together.

    Parameters
    ----------
    motion : Motion
    low, high : float
        Shares of the intensity [-].
    before, after : float
        More to keep before and after it [s].
    ends : float, optional
        Length of the half cosine that leads an end to zero where the cut lies in the middle of motion [s], within what
        is kept; 0 leaves the ends as they are. By default a quarter of a second, at most a twentieth of what is kept.

    Notes
    -----
    A column at rest cannot enter the middle of a motion: a first sample that is not near zero acts as a jerk. An end
    counts as quiet where no component there exceeds a hundredth of its peak.
    """
    check_range("low share", low, 0.0, 1.0, open_high=True)
    check_range("high share", high, low, 1.0, open_low=True)
    growth = arias_growth(motion)
    t1 = float(np.interp(low, growth, motion.time)) - check_range("before", before, 0.0, 1e4, unit="s")
    t2 = float(np.interp(high, growth, motion.time)) + check_range("after", after, 0.0, 1e4, unit="s")
    i = max(0, math.floor(t1 / motion.dt))
    j = min(motion.steps - 1, math.ceil(t2 / motion.dt))
    text = say(
        "trimmed to {first:g} … {last:g} s ({share} of the Arias intensity)",
        first=i * motion.dt,
        last=j * motion.dt,
        share=percents(low, high),
    )
    kept = _changed(motion, lambda a: a[i : j + 1], text)
    length = min(0.25, 0.05 * kept.duration) if ends is None else check_range("ends", ends, 0.0, 0.5 * kept.duration)
    loud = [
        max(abs(a[at]) / max(float(np.abs(a).max()), 1e-300) for a in kept.components.values()) > QUIET_SHARE
        for at in (0, -1)
    ]
    start, end = loud[0] and i > 0, loud[1] and j < motion.steps - 1
    if length < kept.dt or not (start or end):
        return kept
    led = taper(kept, length, start=start, end=end)
    return led.replace(processing=(*motion.processing, joined("; ", (text, led.processing[-1]))))


def scale_to_pgv(motion: Motion, pgv: float) -> Motion:
    """Scale all components so that the peak velocity along x is ``pgv`` [m/s]."""
    value = check_range("pgv", pgv, 0.0, 100.0, unit="m/s")
    return _scaled_to(motion, value, motion.pgv, say("PGV of {value:g} m/s", value=value))


def scale_to_sa(motion: Motion, period: float, sa: float, damping: float = 0.05) -> Motion:
    """Scale all components so that the pseudo-acceleration of a period along x is ``sa``.

    Parameters
    ----------
    motion : Motion
    period : float
        [s]
    sa : float
        [m/s²]
    damping : float
        Share of the critical damping [-].
    """
    value = check_range("sa", sa, 0.0, 1e4, unit="m/s²")
    share = percent(damping)
    text = say("Sa({period:g} s, {share}) of {size:g} g", period=period, share=share, size=value / g)
    return _scaled_to(motion, value, sa_of(motion, period, damping), text)


def sa_of(motion: Motion, period: float, damping: float = 0.05) -> float:
    """Pseudo-acceleration of a period [s] along x [m/s²]."""
    from .spectra import pseudo_acceleration

    return float(pseudo_acceleration(motion, [period], damping)[0])


def _scaled_to(motion: Motion, wanted: float, current: float, text: str) -> Motion:
    if current == 0.0:
        raise InputError(f"motion {motion.name!r} is zero along x and cannot be scaled to a {text}.")
    factor = wanted / current
    step = say("scaled by {factor:.6g} to a {what}", factor=factor, what=text)
    scaled = motion.replace(factor=motion.factor * factor, processing=(*motion.processing, step))
    warn_of_scaling(scaled)
    return scaled


def warn_of_scaling(motion: Motion) -> None:
    """Say that a record was scaled by more than ten times, which is mostly a slip of units.

    Warns
    -----
    OutOfRangeWarning
    """
    if motion.metadata.get("file") and abs(motion.factor) > LARGEST_SCALING:
        warn(
            say(
                "{motion.metadata[file]} is scaled by {motion.factor:.4g}, more than {LARGEST_SCALING:g} times what "
                "was recorded; check the units, or choose a stronger record.",
                motion=motion,
                LARGEST_SCALING=LARGEST_SCALING,
            ),
            OutOfRangeWarning,
        )


def warn_of_peak(motion: Motion) -> None:
    """Say that a motion is stronger than any record, which is mostly a slip of units.

    Warns
    -----
    OutOfRangeWarning
    """
    peak, axis = motion.horizontal_peak
    if peak > STRONGEST * g:
        warn(
            say(
                "{motion.name} peaks at {number:.3g} g along {axis}, and no record has reached {STRONGEST:g} g; "
                "check the unit, g or m/s².",
                motion=motion,
                number=peak / g,
                axis=axis,
                STRONGEST=STRONGEST,
            ),
            OutOfRangeWarning,
        )


def _changed(
    motion: Motion, change: Callable[[np.ndarray], np.ndarray], text: str, *, dt: float | None = None
) -> Motion:
    """A copy with every component changed and the step written down; for changes that are linear in the samples."""
    parts = {
        "acceleration": motion.samples,
        "lateral": motion.y_samples,
        "vertical": motion.z_samples,
    }
    new = {key: None if values is None else change(values) for key, values in parts.items()}
    return motion.replace(dt=motion.dt if dt is None else dt, processing=(*motion.processing, text), **new)


def _fast_length(count: int) -> int:
    """The next length for which the transform is fast."""
    from scipy.fft import next_fast_len

    return next_fast_len(count, real=True)  # pyright: ignore[reportReturnType]: scipy has no types


# Notation of a step of conditioning: ``detrend``, ``bandpass=0.1Hz,25Hz``, ``taper=2s``.

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
    "demean": Step("demean or demean=2s", (0, 1), lambda m, *v: demean(m, *map(parse_time, v))),
    "detrend": Step("detrend", (0,), detrend),
    "taper": Step("taper=2s", (1,), lambda m, v: taper(m, parse_time(v))),
    "bandpass": Step(
        "bandpass=0.1Hz,25Hz", (2,), lambda m, low, high: bandpass(m, parse_frequency(low), parse_frequency(high))
    ),
    "highpass": Step("highpass=0.1Hz", (1,), lambda m, v: bandpass(m, parse_frequency(v), None)),
    "lowpass": Step("lowpass=25Hz", (1,), lambda m, v: bandpass(m, None, parse_frequency(v))),
    "baseline": Step("baseline=6", (0, 1), lambda m, *v: baseline_polynomial(m, *map(_whole_number, v))),
    "baseline-piecewise": Step(
        "baseline-piecewise or baseline-piecewise=5s,20s",
        (0, 2),
        lambda m, *v: baseline_piecewise(m, *map(parse_time, v)),
    ),
    "resample": Step("resample=0.005s", (1,), lambda m, v: resample(m, parse_time(v))),
    "trim": Step("trim or trim=0.05,0.95", (0, 2), lambda m, *v: trim(m, *map(_number, v))),
    "pgv": Step("pgv=0.3m/s", (1,), lambda m, v: scale_to_pgv(m, _velocity(v)), lambda m, _: m.pgv),
    "sa": Step(
        "sa=1.0s,0.3g",
        (2,),
        lambda m, t, a: scale_to_sa(m, parse_time(t), parse_acceleration(a)),
        lambda m, t, _: sa_of(m, parse_time(t)),
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
        return [step.apply(motion, *values) for motion in motions]
    sizes = [step.size(motion, *values) for motion in motions]
    strongest = motions[sizes.index(max(sizes))]
    scaled = step.apply(strongest, *values)
    times = scaled.factor / strongest.factor
    note = say("{step}, that of the strongest of these directions", step=scaled.processing[-1])
    return [motion.replace(factor=motion.factor * times, processing=(*motion.processing, note)) for motion in motions]


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


# Which conditioning takes the drift off a record: tried, not guessed, so that none is named that does not help.

#: A displacement that has not come back by the end of a record is drift from this share of its peak on [-], where it
#: also exceeds what a column would be surveyed to [m].
DRIFT_SHARE, SMALLEST_DRIFT = 0.5, 0.1

#: The ground is not at rest at the end beyond this share of its peak velocity [-]; that counts above so much [m/s].
RESIDUAL_SHARE, SMALLEST_RESIDUAL = 0.05, 0.01

#: Filters that are tried, the one that takes least first, each with the longest period that it must be able to see [s].
FILTERS = {"highpass=0.05Hz": 20.0, "highpass=0.1Hz": 10.0}

#: Steps that are tried with their longest periods [s], several in a row joined by :data:`THEN`.
THEN = " + "
CURES = {
    "baseline": 0.0,
    "detrend": 0.0,
    "demean": 0.0,
    **FILTERS,
    **{f"demean{THEN}{k}": t for k, t in FILTERS.items()},
}

#: Shares of the peak acceleration and of the peak velocity that must stay [-].
KEPT, KEPT_VELOCITY = 0.95, 0.9

#: Most of the displacement at the end that shaking makes between 5 and 95 % of its Arias intensity where it is drift [-].
WITHIN_SHAKING = 0.5


def drift_of(values: np.ndarray, dt: float) -> float:
    """Displacement at the end, where it makes most of the peak and more than 0.1 m; else 0 [m].

    Parameters
    ----------
    values : array
        Accelerations [m/s²].
    dt : float
        [s]
    """
    path = displacement(values, dt)
    last = float(path[-1])
    return last if abs(last) > max(DRIFT_SHARE * float(np.abs(path).max()), SMALLEST_DRIFT) else 0.0


def cure_of(motion: Motion) -> str | None:
    """The conditioning after which no component of a motion that drifts does so any more, nor moves at its end.

    A step, or ``demean + highpass=0.1Hz`` where no single step does as well; None where nothing that is tried does. Of
    several the one that leaves the smallest displacement, as drift within the record is what makes it large.
    """
    dt = motion.dt
    drifting = [values for values in motion.components.values() if drift_of(values, dt)]
    outside = any(_outside_shaking(values, dt) for values in drifting)  # of one component: the recorder drifts
    each = [cures_of(values, dt, outside=outside) for values in drifting]
    displacements = {
        cure: max(cures[cure] for cures in each) for cure in CURES if each and all(cure in cures for cures in each)
    }
    return best_of(displacements)


def best_of(displacements: Mapping[str, float]) -> str | None:
    """Of conditionings with the displacements that they leave, the one that leaves least; two steps must halve it."""
    return min(displacements, key=lambda cure: displacements[cure] * len(cure.split(THEN)), default=None)


def cures_of(values: np.ndarray, dt: float, fastest: float = np.inf, *, outside: bool = False) -> dict[str, float]:
    """What of :data:`CURES` ends the drift of a component and the motion at its end, with the largest displacement left [m].

    None that takes the shaking with it: more than a tenth of the record's own peak velocity, that of a record which still
    moves at its end without a straight line in its acceleration. Where most of the displacement comes before and after the
    shaking, the peak velocity is that of the drift, and what the gentlest filter leaves counts as the record's own. No
    filter whose period is longer than the record.

    Parameters
    ----------
    values, dt
        As of :func:`drift_of`.
    fastest : float
        Velocity that it must not exceed either [m/s].
    outside : bool
        It is known from another component that the displacement comes before and after the shaking.
    """
    peak, displacements, tops = float(np.abs(values).max()), {}, {}
    for step in (cure for cure, period in CURES.items() if period <= dt * (len(values) - 1)):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                mended = cured(Motion(dt, values), step).components["x"]
        except InputError:  # too short for it
            continue
        tops[step], rests = _end_velocity(mended, dt)
        same = KEPT <= float(np.abs(mended).max()) / peak <= 1.0 / KEPT if peak else False
        if same and rests and tops[step] <= fastest and not drift_of(mended, dt):
            displacements[step] = float(np.abs(displacement(mended, dt)).max())
    own, rests = _end_velocity(values, dt)
    if outside or _outside_shaking(values, dt):
        own = next((tops[cure] for cure in FILTERS if cure in tops), own)
    elif not rests:
        own = min((tops[cure] for cure in ("detrend", "demean") if cure in tops), default=own)
    return {step: size for step, size in displacements.items() if tops[step] >= KEPT_VELOCITY * own}


def cured(motion: Motion, cure: str) -> Motion:
    """A motion after the conditioning that :func:`cure_of` names."""

    for step in cure.split(THEN):
        motion = conditioned(motion, step)
    return motion


def cure_request(cure: str) -> str:
    """How to ask for the conditioning that :func:`cure_of` names."""
    return ", then ".join(f"`condition={step!r}`" for step in cure.split(THEN))


def _outside_shaking(values: np.ndarray, dt: float) -> bool:
    """Whether most of the displacement at the end comes before and after the shaking, as drift does and no fault's slip."""
    growth, path = square_integral(values, dt), displacement(values, dt)
    first, last = np.searchsorted(growth, [0.05 * growth[-1], 0.95 * growth[-1]])
    return bool(abs(path[last] - path[first]) < WITHIN_SHAKING * abs(path[-1]))


def _end_velocity(values: np.ndarray, dt: float) -> tuple[float, bool]:
    """Peak velocity of a component [m/s], and whether it is at rest at its end."""
    velocity = np.abs(integrate(values, dt))
    top = float(velocity.max())
    return top, bool(velocity[-1] <= max(RESIDUAL_SHARE * top, SMALLEST_RESIDUAL))
