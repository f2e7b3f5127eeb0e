"""The strongest pulse inside a motion, found by wavelets: its period, amplitude, place and kind."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from .motion import Motion

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

    Returns
    -------
    PulseMatch

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
    best = max((match.at(kind, period) for kind in _WAVELETS for period in periods), key=lambda found: found[0])
    finer = best[2] * 2.0 ** (np.linspace(-1.0, 1.0, 17) / per_octave)
    share, height, period, time, kind = max(match.at(best[4], float(one)) for one in finer)
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
