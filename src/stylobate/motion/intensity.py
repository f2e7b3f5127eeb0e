"""Measures of a motion: how strong, how long, how fast for a given column."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..constants import g
from ..errors import OutOfRangeWarning, check_range, warn
from ..messages import say
from .drift import as_asked, cure_of, cured, drift_of
from .motion import Motion, absolute_integral, arias, displacement, peak_velocity, square_integral, time_above
from .pulses import pulse_match
from .spectra import housner_intensity, pseudo_acceleration, rotated_pga

#: Of a peak velocity, in warnings that results keep and that what rests on them says again.
DRIFTS = "is that of a baseline which drifts"


def peak_ground_velocity(motion: Motion, component: str = "x") -> float:
    """Largest absolute velocity from rest, also between samples [m/s]."""
    return peak_velocity(motion.components[component], motion.dt)


def peak_ground_displacement(motion: Motion, component: str = "x") -> float:
    """Largest absolute displacement from rest [m]; where :func:`displacement_drift` is not zero, it is the drift's."""
    return float(np.abs(displacement(motion.components[component], motion.dt)).max())


def displacement_drift(motion: Motion, component: str = "x") -> float:
    """Displacement at the end, where it makes most of the peak and more than 0.1 m; else 0 [m].

    An offset of the baseline grows with the square of time under double integration; a ground that shook comes back, or
    stops within metres of a fault.
    """
    return drift_of(motion.components[component], motion.dt)


def warn_of_drift(motion: Motion) -> None:
    """Warn of peak displacements of a record that double integration has made; computed motions have no baseline."""
    for axis in motion.components if "file" in motion.metadata else ():
        if drift := displacement_drift(motion, axis):
            peak, cure = peak_ground_displacement(motion, axis), cure_of(motion)
            remedy = "take no displacement from it, as no conditioning that is known here mends it"
            if cure is not None:
                remedy = f"correct it before a displacement is taken from it ({as_asked(cure)})"
            warn(
                f"{motion.name}: the peak displacement of component {axis}, {peak:.3g} m, is what double integration "
                f"leaves: {drift:.3g} m stand at the end, drift of the baseline unless the ground moved for good; "
                f"{remedy}.",
                OutOfRangeWarning,
            )


def warn_of_velocity(motion: Motion, axes: str = "x") -> None:
    """Warn of a peak velocity that holds drift, where it is what says how strong a record is; with what it is without."""
    for axis in axes if "file" in motion.metadata else ():
        if axis not in motion.components or not (drift := displacement_drift(motion, axis)):
            continue
        own, cure = peak_ground_velocity(motion, axis), cure_of(motion)
        remedy = say(
            "take its strength from another measure, such as sa:1s, as no conditioning that is known here mends it"
        )
        if cure is not None:
            left = peak_ground_velocity(cured(motion, cure), axis)
            remedy = say(
                "correct it first ({as_asked}), which leaves {left:.3g} m/s", as_asked=as_asked(cure), left=left
            )
        warn(
            say(
                "{motion.name}: the peak velocity of component {axis}, {own:.3g} m/s, {DRIFTS}: integrated twice, "
                "{drift:.3g} m stand at the end; {remedy}.",
                motion=motion,
                axis=axis,
                own=own,
                DRIFTS=DRIFTS,
                drift=abs(drift),
                remedy=remedy,
            ),
            OutOfRangeWarning,
        )


def arias_intensity(motion: Motion, component: str = "x") -> float:
    """Arias intensity π/(2g) ∫a² dt, exact for the linear interpolation [m/s].

    References
    ----------
    Arias (1970).
    """
    return arias(motion.components[component], motion.dt)


def cumulative_absolute_velocity(motion: Motion, component: str = "x") -> float:
    """CAV, ∫|a| dt, exact for the linear interpolation [m/s].

    References
    ----------
    EPRI (1988), without a threshold.
    """
    return absolute_integral(motion.components[component], motion.dt)


def significant_duration(motion: Motion, low: float = 0.05, high: float = 0.95, component: str = "x") -> float:
    """Time in which the Arias intensity grows from ``low`` to ``high`` of its end value [s].

    References
    ----------
    Trifunac and Brady (1975).
    """
    growth = square_integral(motion.components[component], motion.dt)
    if growth[-1] == 0.0:
        return 0.0
    start, end = np.interp([low, high], growth / growth[-1], motion.time)
    return float(end - start)


def rocking_measures(motion: Motion, tangent: float, frequency_parameter: float, component: str = "x") -> dict:
    """Measures of a motion for a block of given slenderness and size.

    Parameters
    ----------
    motion : Motion
    tangent : float
        tan α of the column [-].
    frequency_parameter : float
        p of the column [rad/s].
    component : str

    Returns
    -------
    dict
        ``pga_over_g_tan_alpha``: below 1 a rigid column stays closed; ``omega_g_over_p``: frequency of the strongest
        pulse to that of the column; ``uniform_duration_s``: time during which |a| exceeds g tan α;
        ``pgv_p_over_g_tan_alpha``: dimensionless velocity.
    """
    alpha = check_range("tan α", tangent, 0.0, 10.0, open_low=True)
    p = check_range("p", frequency_parameter, 0.0, 100.0, unit="rad/s", open_low=True)
    values = motion.components[component]
    peak = float(np.abs(values).max())
    period = pulse_match(motion, component=component).period if peak > 0.0 else math.nan
    return {
        "pga_over_g_tan_alpha": peak / (g * alpha),
        "omega_g_over_p": 2.0 * math.pi / period / p if period > 0.0 else None,
        "uniform_duration_s": time_above(values, motion.dt, g * alpha),
        "pgv_p_over_g_tan_alpha": peak_velocity(values, motion.dt) * p / (g * alpha),
    }


def motion_summary(motion: Motion, *, spectrum: bool = True) -> dict[str, Any]:
    """Contents of a motion, as plain values for JSON.

    Parameters
    ----------
    motion : Motion
    spectrum : bool
        Spectral measures too; they need the compiled kernels.

    Returns
    -------
    dict
        Units are in the keys; measures of components by axis.
    """
    facts = motion.metadata
    azimuths = facts.get("azimuths") or {}
    axes = motion.components
    dt = motion.dt
    found: dict[str, Any] = {"name": motion.name}
    for key in (
        "format",
        "stage",
        "unit",
        "station",
        "station_name",
        "network",
        "event",
        "start_time",
        "terms",
        "file",
    ):
        if key in facts:
            found[key] = None if facts[key] is None else str(facts[key])
    found |= {
        "components": list(axes),
        "azimuths_deg": {axis: azimuths.get(axis) for axis in axes if axis != "z"},
        "labels": {axis: str(label) for axis, label in (facts.get("labels") or {}).items()},
        "dt_s": dt,
        "steps": motion.steps,
        "duration_s": motion.duration,
        "pga_g": {axis: float(np.abs(a).max()) / g for axis, a in axes.items()},
        "pgv_m_s": {axis: peak_velocity(a, dt) for axis, a in axes.items()},
        "pgd_m": {axis: float(np.abs(displacement(a, dt)).max()) for axis, a in axes.items()},
        "pgd_drift_m": {axis: displacement_drift(motion, axis) for axis in axes},
        "final_velocity_m_s": {axis: float(dt * (a.sum() - 0.5 * (a[0] + a[-1]))) for axis, a in axes.items()},
        "arias_m_s": {axis: arias(a, dt) for axis, a in axes.items()},
        "cav_m_s": {axis: absolute_integral(a, dt) for axis, a in axes.items()},
        "duration_5_75_s": {axis: significant_duration(motion, 0.05, 0.75, axis) for axis in axes},
        "duration_5_95_s": {axis: significant_duration(motion, 0.05, 0.95, axis) for axis in axes},
    }
    if motion.lateral is not None:
        rotated = rotated_pga(motion)
        found |= {"pga_rotd50_g": rotated[50.0] / g, "pga_rotd100_g": rotated[100.0] / g}
    shaken = motion.pga > 0.0
    if shaken:
        pulse = pulse_match(motion)
        found |= {
            "pgv_over_pga_s": peak_velocity(axes["x"], dt) / motion.pga,
            "pulse_period_s": pulse.period,
            "pulse_amplitude_g": pulse.amplitude / g,
            "pulse_energy_share": pulse.energy_share,
        }
    if spectrum and shaken:
        periods = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0]
        psa = pseudo_acceleration(motion, periods) / g
        found["psa_5_percent_g"] = {f"{period:g} s": float(value) for period, value in zip(periods, psa)}
        found["housner_intensity_m"] = housner_intensity(motion)
    return found | {"processing": list(motion.processing)}
