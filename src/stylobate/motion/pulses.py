"""Harmonic motions and single pulses in closed form, and the pulse that is nearest to a record."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..constants import g
from ..errors import InputError, check_range
from .motion import MAX_SAMPLES, Motion

#: Samples per cycle; linear interpolation between them is wrong by (2π/n)²/8 = 5e-6 of the amplitude at most.
SAMPLES_PER_CYCLE = 1000


def harmonic(
    frequency: float,
    amplitude: float,
    duration: float = 10.0,
    *,
    across: tuple[float, float, float] | None = None,
) -> Motion:
    """Harmonic acceleration a sin(2πft) from rest, along x or along x and y.

    Parameters
    ----------
    frequency : float
        f [Hz].
    amplitude : float
        a [m/s²], e.g. ``0.3 * st.g``.
    duration : float
        Length [s].
    across : (float, float, float), optional
        Frequency f₂ [Hz], amplitude a₂ [m/s²] and phase φ [rad] of a second sine a₂ sin(2πf₂t + φ) along y. With the same
        frequency and a phase of π/2 the ground goes round an ellipse.

    Returns
    -------
    Motion
        Unit sine scaled by ``amplitude``: harmonics of one frequency and duration can share their samples.
    """
    f = check_range("frequency", frequency, 1e-3, 1e3, unit="Hz")
    a = check_range("amplitude", amplitude, -1e4, 1e4, unit="m/s²")
    total = check_range("duration", duration, 0.0, 1e4, unit="s", open_low=True)
    name = f"harmonic {f:g} Hz, {a / g:g} g"
    if across is None:
        time = _times(f, total)
        return Motion(total / (len(time) - 1), np.sin(2.0 * np.pi * f * time), factor=a, name=name)
    f2 = check_range("frequency across", across[0], 1e-3, 1e3, unit="Hz", field="across.frequency")
    a2 = check_range("amplitude across", across[1], -1e4, 1e4, unit="m/s²", field="across.amplitude")
    phase = check_range("phase across", across[2], -1e3, 1e3, unit="rad", field="across.phase")
    time = _times(max(f, f2), total)
    factor = a if a != 0.0 else 1.0
    return Motion(
        total / (len(time) - 1),
        (a / factor) * np.sin(2.0 * np.pi * f * time),
        (a2 / factor) * np.sin(2.0 * np.pi * f2 * time + phase),
        factor=factor,
        name=f"{name} along x, {f2:g} Hz, {a2 / g:g} g, {np.degrees(phase):g}° along y",
    )


def _times(frequency: float, duration: float) -> np.ndarray:
    """Sample times [s] that resolve a sine of this frequency."""
    steps = max(2, round(duration * frequency * SAMPLES_PER_CYCLE))
    if steps >= MAX_SAMPLES:
        raise InputError(
            f"a harmonic of {frequency:g} Hz over {duration:g} s takes {steps} samples; allowed is up to {MAX_SAMPLES}: "
            "give a shorter duration.",
            "duration",
        )
    return np.linspace(0.0, duration, steps + 1)


# -- Pulses of one to three half-cycles, the simplest picture of a near-fault motion ----------------------------------


#: Zeros that follow a pulse whose ``duration`` is not stated [s]: several times the period scale 2π/p of a tall column.
DEFAULT_QUIET_TIME = 10.0

#: Half length of a Ricker pulse in periods: the acceleration there is below 1e-7 of the peak.
RICKER_HALF_LENGTH = 1.5

#: Sources of the shape of a kind of pulse, as keys of the bibliography.
SOURCES = {
    "ricker": ("ricker1943", "vassiliou2011"),
    "antisymmetric ricker": ("ricker1943", "vassiliou2011"),
    "gabor": ("gabor1946", "mavroeidis2003"),
    "mavroeidis-papageorgiou": ("mavroeidis2003",),
}


def rectangular_pulse(frequency: float, amplitude: float, duration: float | None = None) -> Motion:
    """Constant acceleration for half a period.

    Parameters
    ----------
    frequency : float
        f [Hz]; the pulse lasts 1/(2f).
    amplitude : float
        Acceleration of the pulse [m/s²].
    duration : float, optional
        Length of the whole motion, the pulse and the quiet after it [s]; rounded up to a whole step of 1/(1000f).
        By default the pulse and ten seconds.

    Returns
    -------
    Motion
        Unit samples scaled by ``amplitude``.

    Raises
    ------
    InputError
        A frequency that is not positive, a duration shorter than the pulse.
    """
    return _pulse("rectangular", frequency, amplitude, duration, 0.5, lambda phase: np.ones_like(phase))


def half_sine_pulse(frequency: float, amplitude: float, duration: float | None = None) -> Motion:
    """Half a cycle of a sine: a sin(2πft) for 0 ≤ t ≤ 1/(2f). Parameters as for :func:`rectangular_pulse`."""
    return _pulse("half-sine", frequency, amplitude, duration, 0.5, lambda phase: np.sin(2.0 * np.pi * phase))


def sine_pulse(frequency: float, amplitude: float, duration: float | None = None) -> Motion:
    """One cycle of a sine: a sin(2πft) for 0 ≤ t ≤ 1/f. Parameters as for :func:`rectangular_pulse`."""
    return _pulse("sine", frequency, amplitude, duration, 1.0, lambda phase: np.sin(2.0 * np.pi * phase))


def cosine_pulse(frequency: float, amplitude: float, duration: float | None = None) -> Motion:
    """One cycle of a cosine: a cos(2πft) for 0 ≤ t ≤ 1/f. Parameters as for :func:`rectangular_pulse`.

    Notes
    -----
    It jumps from zero to ``amplitude`` at its start and back at its end; the velocity returns to zero.
    """
    return _pulse("cosine", frequency, amplitude, duration, 1.0, lambda phase: np.cos(2.0 * np.pi * phase))


def ricker(frequency: float, amplitude: float, duration: float | None = None, *, antisymmetric: bool = False) -> Motion:
    """Ricker wavelet, symmetric or antisymmetric.

    Parameters
    ----------
    frequency : float
        Frequency of the peak of the wavelet's Fourier amplitude [Hz].
    amplitude : float
        Largest absolute acceleration [m/s²]; of the symmetric wavelet, its middle peak.
    duration : float, optional
        Length of the whole motion [s]; the wavelet takes the first 3/f. By default the wavelet and ten seconds.
    antisymmetric : bool
        The third derivative of a Gaussian instead of the second.

    Notes
    -----
    With τ the time from the middle, the symmetric wavelet is a (1 − 2π²f²τ²) exp(−π²f²τ²), the antisymmetric one
    (a/β) (s² − 3) s exp(−s²/2) with s = 2πfτ/√3 and β such that the peak is a.

    References
    ----------
    Ricker (1943); Vassiliou and Makris (2011).
    """

    def symmetric(phase: np.ndarray) -> np.ndarray:
        x = (np.pi * (phase - RICKER_HALF_LENGTH)) ** 2  # Vassiliou and Makris (2011), symmetric
        return (1.0 - 2.0 * x) * np.exp(-x)

    def skew(phase: np.ndarray) -> np.ndarray:
        s = 2.0 * np.pi / math.sqrt(3.0) * (phase - RICKER_HALF_LENGTH)  # Vassiliou and Makris (2011), antisymmetric
        # The extrema of (s² − 3) s exp(−s²/2) are the roots of s⁴ − 6s² + 3 = 0; the inner one is the larger.
        inner = math.sqrt(3.0 - math.sqrt(6.0))
        beta = (3.0 - inner**2) * inner * math.exp(-(inner**2) / 2.0)
        return (s * s - 3.0) * s * np.exp(-s * s / 2.0) / beta

    if antisymmetric:
        return _pulse("antisymmetric ricker", frequency, amplitude, duration, 2.0 * RICKER_HALF_LENGTH, skew)
    return _pulse("ricker", frequency, amplitude, duration, 2.0 * RICKER_HALF_LENGTH, symmetric)


def gabor(
    frequency: float,
    amplitude: float,
    duration: float | None = None,
    *,
    oscillation: float = 2.0,
    phase: float = 90.0,
) -> Motion:
    """Gabor pulse: a cosine under a Gaussian bell as velocity, differentiated analytically.

    Parameters
    ----------
    frequency : float
        f [Hz].
    amplitude : float
        Largest absolute acceleration [m/s²].
    duration : float, optional
        Length of the whole motion [s]. By default the pulse and ten seconds.
    oscillation : float
        γ: width of the bell, roughly the number of half-cycles [-].
    phase : float
        ν: phase of the cosine in the middle of the bell [degrees]; 0 gives a one-sided velocity pulse in the middle,
        90 a two-sided one.

    Notes
    -----
    v(τ) = V exp(−2π²f²τ²/γ²) cos(2πfτ + ν), τ the time from the middle.

    References
    ----------
    Gabor (1946); Mavroeidis and Papageorgiou (2003).
    """
    gamma = check_range("oscillation", oscillation, 0.5, 20.0)
    nu = math.radians(check_range("phase", phase, -360.0, 360.0, unit="degrees"))
    half = gamma * math.sqrt(math.log(1e9) / 2.0) / math.pi  # the bell is down to 1e-9

    def shape(time: np.ndarray) -> np.ndarray:
        x = 2.0 * np.pi * (time - half)
        bell = np.exp(-0.5 * (x / gamma) ** 2)
        return -bell * (np.sin(x + nu) + x / gamma**2 * np.cos(x + nu))  # dv/dt over 2πfV

    return _pulse("gabor", frequency, amplitude, duration, 2.0 * half, _to_unit_peak(shape, 2.0 * half))


def mavroeidis_papageorgiou(
    frequency: float,
    amplitude: float,
    duration: float | None = None,
    *,
    oscillation: float = 2.0,
    phase: float = 90.0,
) -> Motion:
    """Near-fault velocity pulse of Mavroeidis and Papageorgiou, differentiated analytically.

    Parameters
    ----------
    frequency : float
        f_p, prevailing frequency [Hz].
    amplitude : float
        Largest absolute acceleration [m/s²].
    duration : float, optional
        Length of the whole motion [s]. By default the pulse, γ/f_p long, and ten seconds.
    oscillation : float
        γ: number of half-cycles, more than 1 [-].
    phase : float
        ν [degrees]: 0 gives a velocity pulse symmetric about its middle, 90 an antisymmetric one.

    Notes
    -----
    v(τ) = (A/2) [1 + cos(2πf_p τ/γ)] cos(2πf_p τ + ν) for |τ| ≤ γ/(2f_p), zero elsewhere. Velocity and acceleration
    vanish at both ends.

    References
    ----------
    Mavroeidis and Papageorgiou (2003).
    """
    gamma = check_range("oscillation", oscillation, 1.0, 20.0, open_low=True)
    nu = math.radians(check_range("phase", phase, -360.0, 360.0, unit="degrees"))

    def shape(time: np.ndarray) -> np.ndarray:
        x = 2.0 * np.pi * (time - gamma / 2.0)
        # dv/dt over πfA/γ
        return -(np.sin(x / gamma) * np.cos(x + nu) + gamma * np.sin(x + nu) * (1.0 + np.cos(x / gamma)))

    return _pulse("mavroeidis-papageorgiou", frequency, amplitude, duration, gamma, _to_unit_peak(shape, gamma))


def _to_unit_peak(shape: Callable[[np.ndarray], np.ndarray], cycles: float) -> Callable[[np.ndarray], np.ndarray]:
    peak = float(np.abs(shape(np.linspace(0.0, cycles, 20_001))).max())
    return lambda phase: shape(phase) / peak


def _pulse(
    kind: str,
    frequency: float,
    amplitude: float,
    duration: float | None,
    cycles: float,
    shape: Callable[[np.ndarray], np.ndarray],
) -> Motion:
    """Sample ``shape``, a function of t f on [0, cycles], and let zeros follow."""
    f = check_range("frequency", frequency, 1e-3, 1e3, unit="Hz")
    a = check_range("amplitude", amplitude, -1e4, 1e4, unit="m/s²")
    length = cycles / f
    total = length + DEFAULT_QUIET_TIME if duration is None else check_range("duration", duration, 0.0, 1e4, unit="s")
    if total < length * (1.0 - 1e-9):
        raise InputError(
            f"duration is {total:g} s; a {kind} pulse of {f:g} Hz takes {length:g} s, so give at least that, "
            "or leave the duration out.",
            "duration",
        )
    # A whole number of steps in the pulse, so that its end is a sample.
    pulse_steps = math.ceil(cycles * SAMPLES_PER_CYCLE - 1e-9)
    dt = length / pulse_steps
    steps = max(pulse_steps, math.ceil(total / dt - 1e-6))
    if steps >= MAX_SAMPLES:
        raise InputError(
            f"a pulse of {f:g} Hz followed over {total:g} s takes {steps} samples; allowed is up to {MAX_SAMPLES}: "
            "give a shorter duration.",
            "duration",
        )
    samples = np.zeros(steps + 1)
    samples[: pulse_steps + 1] = shape(np.arange(pulse_steps + 1) / pulse_steps * cycles)
    if steps > pulse_steps:
        samples[pulse_steps] *= 0.5  # the middle of the jump, where there is one
    facts = {"pulse_length": length, "references": SOURCES.get(kind, ())}
    return Motion(dt, samples, factor=a, name=f"{kind} pulse {f:g} Hz, {a / g:g} g", metadata=facts)


# -- The strongest pulse inside a motion, found by wavelets -----------------------------------------------------------


#: Order of the derivative of a Gaussian, its peak on the ω axis for unit scale, and its energy Γ(n + 1/2).
_WAVELETS = {"symmetric": (2, math.sqrt(2.0), math.gamma(2.5)), "antisymmetric": (3, math.sqrt(3.0), math.gamma(3.5))}


@dataclass(frozen=True)
class PulseMatch:
    """The Ricker wavelet that carries the largest part of a motion's energy.

    Parameters
    ----------
    period : float
        1 / frequency of the peak of its spectrum [s].
    amplitude : float
        Its largest absolute acceleration [m/s²].
    time : float
        Of its middle [s].
    kind : str
        ``symmetric`` or ``antisymmetric``.
    energy_share : float
        Part of ∫a² dt that it carries [-]; a pulse-like motion has more than about a third.
    """

    period: float
    amplitude: float
    time: float
    kind: str
    energy_share: float


def pulse_match(
    motion: Motion, *, component: str = "x", shortest: float = 0.1, longest: float = 10.0, per_octave: int = 8
) -> PulseMatch:
    """Match the motion with symmetric and antisymmetric Ricker wavelets of all periods and places.

    Parameters
    ----------
    motion : Motion
    component : str
        ``x``, ``y`` or ``z``.
    shortest, longest : float
        Periods to look at [s].
    per_octave : int
        Number of them per doubling.

    Raises
    ------
    InputError
        A component that is missing or zero.

    References
    ----------
    Vassiliou and Makris (2011): the wavelet transform of the acceleration, weighted for equal energy.
    """
    if component not in motion.components:
        raise InputError(f"motion {motion.name!r} has no component {component!r}.")
    a = motion.components[component]
    energy = float(a @ a) * motion.dt
    if energy == 0.0:
        raise InputError(f"component {component} of {motion.name!r} is zero; it holds no pulse.")
    longest = max(2.0 * shortest, min(longest, motion.duration))
    padding = math.ceil(3.0 * longest / motion.dt)
    size = 1 << (len(a) + padding - 1).bit_length()
    spectrum = np.fft.rfft(a, size) * motion.dt
    periods = np.geomspace(shortest, longest, max(2, round(per_octave * math.log2(longest / shortest)) + 1))
    match = _Match(spectrum, size, motion.dt)
    best = max((match.at(kind, period) for kind in _WAVELETS for period in periods), key=lambda fit: fit[0])
    finer = best[2] * 2.0 ** (np.linspace(-1.0, 1.0, 17) / per_octave)
    share, height, period, time, kind = max(match.at(best[4], float(candidate)) for candidate in finer)
    if time > motion.duration + 0.5 * padding * motion.dt:  # periodic transform: it lies before the beginning
        time -= size * motion.dt
    return PulseMatch(period, abs(height), time, kind, share / energy)


class _Match:
    """The wavelet transform of one spectrum."""

    def __init__(self, spectrum: np.ndarray, size: int, dt: float) -> None:
        self.spectrum, self.size, self.dt = spectrum, size, dt
        self.omega = 2.0 * np.pi * np.fft.rfftfreq(size, dt)

    def at(self, kind: str, period: float) -> tuple[float, float, float, float, str]:
        """Energy [m²/s³], height [m/s²], period [s], time [s] and kind of the best wavelet of a period."""
        order, peak, norm = _WAVELETS[kind]
        scale = peak * period / (2.0 * np.pi)
        total = self.size * self.dt
        points = self.size  # 16 or more in a period: the wavelet's spectrum ends long before
        while points > 64 and period * (points // 2) >= 16.0 * total:
            points //= 2
        count = points // 2 + 1
        x = self.omega[:count] * scale
        wavelet = math.sqrt(2.0 * np.pi) * scale * x**order * np.exp(-0.5 * x * x)
        turn = 1.0 if order == 2 else 1.0j  # the sign of the match does not matter
        inner = np.fft.irfft(self.spectrum[:count] * wavelet * turn, points) * (points / total)
        best = int(np.argmax(np.abs(inner)))
        value = float(inner[best])
        height = value / (scale * norm) * _extreme(order)
        return value * value / (scale * norm), height, float(period), best * total / points, kind


def _extreme(order: int) -> float:
    """Largest absolute value of the Gaussian's derivative with unit scale."""
    if order == 2:
        return 1.0
    inner = math.sqrt(3.0 - math.sqrt(6.0))
    return (3.0 - inner**2) * inner * math.exp(-(inner**2) / 2.0)


# Scatter of a harmonic motion: what of the shaking nobody knows to the last digit.

#: Largest half width of each part.
LARGEST_OF_MOTION = {"amplitude": 0.5, "phase": 0.5, "across": 1.0}

#: Starts of a motion, and sizes of its component across, that are told apart, so that all draws share these samples.
PHASES, ASIDES = 9, 8


@dataclass(frozen=True)
class MotionScatter:
    """Half widths of the intervals from which harmonic motions are drawn, all even and independent; nothing by default.

    Parameters
    ----------
    amplitude : float
        Of the amplitude, relative [-].
    phase : float
        Of the instant in its cycle at which the motion starts [cycles].
    across : float
        Of a second component along y, a quarter of a cycle late, relative to the amplitude along x [-]. No shaking is
        plane; models in the plane leave this component out.

    Raises
    ------
    InputError
        A value outside its range.
    """

    amplitude: float = 0.0
    phase: float = 0.0
    across: float = 0.0

    def __post_init__(self) -> None:
        for name, high in LARGEST_OF_MOTION.items():
            check_range(
                f"{name} of the motion's scatter", getattr(self, name), 0.0, high, remedy="0.01 is one per cent"
            )

    @property
    def given(self) -> dict[str, float]:
        """Scattered parts, by name."""
        return {name: value for name, value in dataclasses.asdict(self).items() if value}

    def describe(self) -> str:
        """The sizes in words."""
        units = {"phase": lambda value: f"{value:.3g} cycles"}
        words = (
            f"{name} ±{units.get(name, lambda size: f'{100.0 * size:.3g} %')(value)}"
            for name, value in self.given.items()
        )
        return ", ".join(words) or "nothing"


class ScatteredSines:
    """Harmonic motions that are drawn around one of each frequency and amplitude: draw k is alike for all of them.

    Draw k of a seed is the same for any ``number`` above k.

    Parameters
    ----------
    frequencies : array
        [Hz]
    duration : float
        [s]
    size : MotionScatter
    number, seed : int
        The same seed gives the same motions.
    """

    def __init__(self, frequencies: np.ndarray, duration: float, size: MotionScatter, number: int, seed: int) -> None:
        starts = size.phase * np.linspace(-1.0, 1.0, PHASES) if size.phase else np.zeros(1)
        aside = size.across * np.linspace(-1.0, 1.0, ASIDES) if size.across else np.zeros(1)
        # Each part has a stream of its own, so that draw k does not depend on how many there are, nor on the other parts.
        factors, first, across = (np.random.default_rng([seed, part]) for part in (1, 3, 2))
        self._factors = 1.0 + size.amplitude * factors.uniform(-1.0, 1.0, number)
        self._start = first.integers(0, len(starts), number)
        self._aside = across.integers(0, len(aside), number)
        self._units = [
            [[_sine(float(f), duration, float(start), float(share)) for share in aside] for start in starts]
            for f in frequencies
        ]

    def motion(self, i: int, amplitude: float, k: int) -> Motion:
        """Draw k of the motion of frequency number i and of an amplitude [m/s²]; samples are shared."""
        return self._units[i][self._start[k]][self._aside[k]].scaled(float(amplitude * self._factors[k]))


def _sine(frequency: float, duration: float, start: float, aside: float) -> Motion:
    """A unit sine that starts so many cycles late, with a component across of that share, a quarter of a cycle later."""
    unit = harmonic(frequency, 1.0, duration)
    if not start and not aside:
        return unit
    angle = 2.0 * np.pi * (np.arange(unit.steps) * unit.dt * frequency + start)
    lateral = -aside * np.cos(angle) if aside else None
    return unit.replace(acceleration=np.sin(angle), lateral=lateral)
