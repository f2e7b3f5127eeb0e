"""Pulses in two horizontal directions: the ground's velocity goes round an ellipse under a bell that rises and falls."""

from __future__ import annotations

import numpy as np

from stylobate.errors import check_range
from stylobate.motion.motion import Motion

#: Samples in a period; the acceleration is linear between them.
IN_A_PERIOD = 100


def elliptical_pulse(
    period: float,
    velocity: float,
    *,
    azimuth: float = 0.0,
    ellipticity: float = 0.0,
    cycles: float = 2.0,
    phase: float = 90.0,
) -> Motion:
    """The near-fault pulse of Mavroeidis and Papageorgiou along one axis, a quarter of a cycle late across it.

    Parameters
    ----------
    period : float
        T, of the carrier [s].
    velocity : float
        Largest length of the ground's velocity vector [m/s].
    azimuth : float
        α: direction of the strong axis, from x towards y [degrees].
    ellipticity : float
        e: peak velocity across the strong axis over that along it [-]; 0 for straight shaking.
    cycles : float
        γ: length of the pulse in periods, above 1 [-].
    phase : float
        ν: of the carrier in the middle of the pulse [degrees].

    Returns
    -------
    Motion
        Samples of a pulse of 1 m/s, scaled by ``velocity``.

    Raises
    ------
    InputError
        A number outside its range.

    Notes
    -----
    With τ the time from the middle, along and across the strong axis,

        v = (A/2) [1 + cos(2πτ/(γT))] (cos(2πτ/T + ν), e sin(2πτ/T + ν))

    for |τ| ≤ γT/2 and zero elsewhere. To turn by 180° is to add 180° to the phase: where every phase is as likely, the
    strong axis has no sense, and azimuths that differ by 180° are the same.

    References
    ----------
    Mavroeidis and Papageorgiou (2003).
    """
    length = check_range("period", period, 1e-3, 1e3, unit="s")
    peak = check_range("velocity", velocity, 0.0, 1e3, unit="m/s")
    alpha = np.radians(check_range("azimuth", azimuth, -360.0, 360.0, unit="degrees"))
    aside = check_range("ellipticity", ellipticity, 0.0, 1.0)
    gamma = check_range("cycles", cycles, 1.0, 20.0, open_low=True)
    nu = np.radians(check_range("phase", phase, -360.0, 360.0, unit="degrees"))
    steps = int(np.ceil(gamma * IN_A_PERIOD))
    time = np.linspace(-0.5 * gamma, 0.5 * gamma, steps + 1)  # in periods
    bell, slope = 1.0 + np.cos(2.0 * np.pi * time / gamma), -np.sin(2.0 * np.pi * time / gamma) / gamma
    angle = 2.0 * np.pi * time + nu
    carrier, rate = np.stack((np.cos(angle), aside * np.sin(angle))), np.stack((-np.sin(angle), aside * np.cos(angle)))
    unit = float(np.hypot(*(bell * carrier)).max())  # of the velocity, times 2/A
    flat = 2.0 * np.pi / length * (slope * carrier + bell * rate) / unit  # dv/dt of a pulse of 1 m/s
    x = np.cos(alpha) * flat[0] - np.sin(alpha) * flat[1]
    y = np.sin(alpha) * flat[0] + np.cos(alpha) * flat[1]
    facts = {"pulse_length": gamma * length, "references": ("mavroeidis2003",)}
    name = f"pulse {length:.3g} s, {peak:.3g} m/s, towards {azimuth:.3g}°"
    return Motion(gamma * length / steps, x, y, factor=peak, name=name, metadata=facts)
