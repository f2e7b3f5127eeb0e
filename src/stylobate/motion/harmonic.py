"""Harmonic base motion from rest."""

from __future__ import annotations

import numpy as np

from ..constants import g
from ..errors import InputError, check_range
from .motion import MAX_SAMPLES, Motion

#: Samples per cycle; linear interpolation between them is wrong by (2π/n)²/8 = 5e-6 of the amplitude at most.
SAMPLES_PER_CYCLE = 1000


def harmonic(frequency: float, amplitude: float, duration: float = 10.0) -> Motion:
    """Harmonic acceleration a sin(2πft) from rest.

    Parameters
    ----------
    frequency : float
        f [Hz].
    amplitude : float
        a [m/s²], e.g. ``0.3 * st.g``.
    duration : float
        Length [s].

    Returns
    -------
    Motion
        Unit sine scaled by ``amplitude``: harmonics of one frequency and duration can share their samples.
    """
    f = check_range("frequency", frequency, 1e-3, 1e3, unit="Hz")
    a = check_range("amplitude", amplitude, -1e4, 1e4, unit="m/s²")
    total = check_range("duration", duration, 0.0, 1e4, unit="s", open_low=True)
    steps = max(2, round(total * f * SAMPLES_PER_CYCLE))
    if steps >= MAX_SAMPLES:
        raise InputError(
            f"a harmonic of {f:g} Hz over {total:g} s takes {steps} samples; allowed is up to {MAX_SAMPLES}: "
            "give a shorter duration."
        )
    time = np.linspace(0.0, total, steps + 1)
    return Motion(total / steps, np.sin(2.0 * np.pi * f * time), factor=a, name=f"harmonic {f:g} Hz, {a / g:g} g")
