"""Harmonic base motion from rest."""

from __future__ import annotations

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
