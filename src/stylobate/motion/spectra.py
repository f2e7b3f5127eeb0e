"""Response spectra of a motion, and orientation-independent ones of its two horizontal components."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError, check_range
from .motion import Motion

#: States that fall on a period at least: a peak between them is missed by (π/100)²/2 = 0.05 % at most.
STATES_PER_PERIOD = 100.0

#: Parts of a step at least, for velocities and accelerations; displacements are smooth within a step.
PARTS_OF_STEP = 8

#: Periods at which a spectrum is evaluated by default [s].
PERIODS = np.geomspace(0.02, 10.0, 120)


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Peaks of linear oscillators.

    Parameters
    ----------
    period : array
        [s], shape (P,)
    damping : float
        Share of the critical damping [-].
    sd, sv : array
        Largest relative displacement [m] and velocity [m/s], shape (P,).
    sa : array
        Largest absolute acceleration [m/s²], shape (P,).
    """

    period: np.ndarray
    damping: float
    sd: np.ndarray
    sv: np.ndarray
    sa: np.ndarray

    @property
    def psv(self) -> np.ndarray:
        """Pseudo-velocity ω Sd [m/s], shape (P,)."""
        return 2.0 * np.pi / self.period * self.sd

    @property
    def psa(self) -> np.ndarray:
        """Pseudo-acceleration ω² Sd [m/s²], shape (P,)."""
        return (2.0 * np.pi / self.period) ** 2 * self.sd


def response_spectrum(
    motion: Motion, periods: Sequence[float] | np.ndarray | None = None, damping: float = 0.05, *, component: str = "x"
) -> ResponseSpectrum:
    """Response spectrum of one component.

    Parameters
    ----------
    motion : Motion
    periods : sequence of float, optional
        [s]; by default 120 from 0.02 s to 10 s.
    damping : float
        Share of the critical damping [-].
    component : str
        ``x``, ``y`` or ``z``.

    Raises
    ------
    InputError
        A component that the motion lacks, a period that is not positive, damping outside [0, 1).

    Notes
    -----
    The motion is linear between samples, and each oscillator's state is advanced by the closed solution of such a step,
    finely enough that no peak between states is missed by more than 0.05 %. Free vibration after the end counts.

    References
    ----------
    Nigam and Jennings (1969).
    """
    from ..kernels.spectrum import peaks

    components = motion.components
    if component not in components:
        raise InputError(f"motion {motion.name!r} has no component {component!r}; it has {', '.join(components)}.")
    t, z = _checked(periods, damping)
    out = np.empty((len(t), 3))
    peaks(components[component], motion.dt, t, z, STATES_PER_PERIOD, PARTS_OF_STEP, out)
    return ResponseSpectrum(t, z, out[:, 0], out[:, 1], out[:, 2])


def pseudo_acceleration(
    motion: Motion, periods: Sequence[float] | np.ndarray, damping: float = 0.05, *, component: str = "x"
) -> np.ndarray:
    """Pseudo-acceleration ω² Sd alone [m/s²], shape (P,); quicker than the whole :func:`response_spectrum`."""
    from ..kernels.spectrum import peaks

    t, z = _checked(periods, damping)
    out = np.empty((len(t), 3))
    peaks(motion.components[component], motion.dt, t, z, STATES_PER_PERIOD, 1, out)
    return (2.0 * np.pi / t) ** 2 * out[:, 0]


def rotated_spectrum(
    motion: Motion,
    percentiles: Sequence[float] = (50.0, 100.0),
    periods: Sequence[float] | np.ndarray | None = None,
    damping: float = 0.05,
) -> dict[float, np.ndarray]:
    """Pseudo-acceleration over all horizontal directions: RotD50, RotD100 …

    Parameters
    ----------
    motion : Motion
        With two horizontal components.
    percentiles : sequence of float
        Over 180 directions, one degree apart.
    periods, damping
        As for :func:`response_spectrum`.

    Returns
    -------
    dict of float to array
        Pseudo-acceleration [m/s²] by percentile, each of shape (P,).

    References
    ----------
    Boore (2010).
    """
    from ..kernels.spectrum import rotated_peaks

    t, z = _checked(periods, damping)
    x, y = _horizontal(motion)
    theta = np.radians(np.arange(180.0))
    out = np.zeros((len(t), len(theta)))
    rotated_peaks(x, y, motion.dt, t, z, STATES_PER_PERIOD, np.cos(theta), np.sin(theta), out)
    out *= ((2.0 * np.pi / t) ** 2)[:, None]
    return {float(p): np.percentile(out, p, axis=1) for p in percentiles}


def rotated_pga(motion: Motion, percentiles: Sequence[float] = (50.0, 100.0)) -> dict[float, float]:
    """Peak acceleration over all horizontal directions [m/s²], by percentile; as :func:`rotated_spectrum`."""
    x, y = _horizontal(motion)
    theta = np.radians(np.arange(180.0))
    peaks = [np.abs(x * np.cos(a) + y * np.sin(a)).max() for a in theta]
    return {float(p): float(np.percentile(peaks, p)) for p in percentiles}


def housner_intensity(motion: Motion, damping: float = 0.05, *, component: str = "x") -> float:
    """Spectrum intensity: the integral of the pseudo-velocity from 0.1 s to 2.5 s [m].

    References
    ----------
    Housner (1952), with the damping usual today.
    """
    t = np.linspace(0.1, 2.5, 49)
    psv = pseudo_acceleration(motion, t, damping, component=component) * t / (2.0 * np.pi)
    return float(np.sum(0.5 * (psv[1:] + psv[:-1]) * np.diff(t)))


def _checked(periods: Sequence[float] | np.ndarray | None, damping: float) -> tuple[np.ndarray, float]:
    t = np.array(PERIODS if periods is None else periods, dtype=float)
    if t.ndim != 1 or not t.size or not np.isfinite(t).all() or t.min() < 1e-3 or t.max() > 1e3:
        raise InputError(
            f"periods of a spectrum are {t.tolist()[:5]} …; allowed is a row of numbers from 0.001 to 1000 s."
        )
    z = check_range("damping", damping, 0.0, 1.0, open_high=True)
    return t, z


def _horizontal(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    if motion.lateral is None:
        raise InputError(f"motion {motion.name!r} has one horizontal component; directions need two of them.")
    return motion.acceleration, motion.lateral
