"""Motions from no record: the stochastic point source, and its union with a directivity pulse."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import InputError, check_choice, check_range
from .motion import MAX_SAMPLES, Motion, integrate

#: Average radiation of shear waves, share of one horizontal component, and the free surface's doubling.
RADIATION, PARTITION, FREE_SURFACE = 0.55, math.sqrt(0.5), 2.0


@dataclass(frozen=True)
class Region:
    """Effect of the crust on the waves between source and site; hard rock, no amplification by softer ground.

    Parameters
    ----------
    name : str
        As on the command line.
    stress_drop : float
        Stress parameter of the source [Pa].
    shear_velocity, density : float
        At the source [m/s], [kg/m³].
    quality, quality_power : float
        Q(f) = quality · f^quality_power, f in Hz.
    kappa : float
        Loss near the surface, exp(−πκf) [s].
    spreading : tuple of (float, float)
        From each distance [m] on, the power of distance.
    path_duration : float
        Growth of the duration with distance [s/m].
    reference : str
        Where the values come from.
    sources : tuple of str
        The same as keys of the bibliography.
    """

    name: str
    stress_drop: float
    shear_velocity: float
    density: float
    quality: float
    quality_power: float
    kappa: float
    spreading: tuple[tuple[float, float], ...]
    path_duration: float
    reference: str
    sources: tuple[str, ...] = ()


_BAR = 1e5
_PER_KM = 1e-3
REGIONS = {
    region.name: region
    for region in (
        Region(
            name="greece",
            stress_drop=56.0 * _BAR,
            shear_velocity=3400.0,
            density=2700.0,
            quality=88.0,
            quality_power=0.9,
            kappa=0.035,
            spreading=((1e3, -1.0),),
            path_duration=0.05 * _PER_KM,
            reference="Margaris and Boore (1998), stress parameter and kappa; Hatzidimitriou (1993), Q",
            sources=("margaris1998", "hatzidimitriou1993"),
        ),
        Region(
            name="western-north-america",
            stress_drop=100.0 * _BAR,
            shear_velocity=3500.0,
            density=2800.0,
            quality=180.0,
            quality_power=0.45,
            kappa=0.04,
            spreading=((1e3, -1.0), (40e3, -0.5)),
            path_duration=0.05 * _PER_KM,
            reference="Campbell (2003)",
            sources=("campbell2003",),
        ),
        Region(
            name="eastern-north-america",
            stress_drop=150.0 * _BAR,
            shear_velocity=3600.0,
            density=2800.0,
            quality=680.0,
            quality_power=0.36,
            kappa=0.006,
            spreading=((1e3, -1.0), (70e3, 0.0), (130e3, -0.5)),
            path_duration=0.05 * _PER_KM,
            reference="Campbell (2003)",
            sources=("campbell2003",),
        ),
    )
}


def seismic_moment(magnitude: float) -> float:
    """Moment of a moment magnitude [N m] (Hanks and Kanamori 1979)."""
    return 10.0 ** (1.5 * magnitude + 9.05)


def corner_frequency(magnitude: float, region: Region) -> float:
    """Corner frequency of the ω² source [Hz] (Brune 1970)."""
    return 0.4906 * region.shear_velocity * (region.stress_drop / seismic_moment(magnitude)) ** (1.0 / 3.0)


def spreading(distance: float, region: Region) -> float:
    """Geometric spreading relative to a distance of 1 km [-]."""
    factor = 1.0
    for (start, power), end in zip(region.spreading, [*(d for d, _ in region.spreading[1:]), math.inf]):
        if distance > start or start == region.spreading[0][0]:
            factor *= (min(distance, end) / start) ** power
    return factor


def fourier_target(frequency: np.ndarray, magnitude: float, distance: float, region: Region) -> np.ndarray:
    """Fourier amplitude of the acceleration that the point-source model predicts.

    Parameters
    ----------
    frequency : array
        [Hz], shape (F,)
    magnitude : float
        Moment magnitude.
    distance : float
        From the source [m].
    region : Region

    Returns
    -------
    array
        |∫ a exp(−2πift) dt| [m/s], shape (F,).

    References
    ----------
    Boore (2003).
    """
    f = np.asarray(frequency, dtype=float)
    beta = region.shear_velocity
    scale = RADIATION * PARTITION * FREE_SURFACE / (4.0 * np.pi * region.density * beta**3 * 1e3)
    source = (2.0 * np.pi * f) ** 2 / (1.0 + (f / corner_frequency(magnitude, region)) ** 2)
    quality = region.quality * np.maximum(f, 1e-9) ** region.quality_power
    path = spreading(distance, region) * np.exp(-np.pi * f * distance / (quality * beta))
    return scale * seismic_moment(magnitude) * source * path * np.exp(-np.pi * region.kappa * f)


def stochastic_motion(
    magnitude: float,
    distance: float,
    region: Region | str = "greece",
    *,
    seed: int = 0,
    dt: float = 0.005,
    horizontal: int = 1,
) -> Motion:
    """A motion of the stochastic point-source model.

    Parameters
    ----------
    magnitude : float
        Moment magnitude, 3 to 8.
    distance : float
        From the source [m], 1 km to 500 km.
    region : Region or str
        A key of :data:`REGIONS`, or values of your own.
    seed : int
        The same seed gives the same motion.
    dt : float
        Step [s].
    horizontal : int
        1, or 2 for independent x and y. The model has no vertical component.

    Raises
    ------
    InputError
        Values outside the ranges above, an unknown region.

    Notes
    -----
    Noise in a window of Saragoni and Hart, its spectrum normalised to unit mean square and multiplied by
    :func:`fourier_target`. Duration: 1/f_c + 0.05 s per km. The model knows no directivity, no surface waves and
    no fault
    larger than the distance: near a large fault use :func:`with_directivity_pulse`, or records.

    References
    ----------
    Boore (2003); window: Saragoni and Hart (1974).
    """
    if not isinstance(region, Region):
        check_choice("region", region, REGIONS)
        region = REGIONS[region]
    check_range("magnitude", magnitude, 3.0, 8.0)
    check_range("distance", distance, 1e3, 500e3, unit="m")
    check_range("dt", dt, 1e-4, 0.05, unit="s")
    check_range("number of horizontal components", horizontal, 1, 2)
    check_range("seed", seed, 0, 2**63)
    duration = 1.0 / corner_frequency(magnitude, region) + region.path_duration * distance
    quiet = min(10.0, 2.0 / corner_frequency(magnitude, region) + 1.0)
    window = _window(duration, dt)
    lead = math.ceil(quiet / dt)
    size = len(window) + 2 * lead
    if size > MAX_SAMPLES:
        raise InputError(f"a motion of {duration:g} s at {dt:g} s takes {size} samples; give a longer step.")
    target = fourier_target(np.fft.rfftfreq(size, dt), magnitude, distance, region)
    random = np.random.default_rng(seed)
    parts = []
    for _ in range(int(horizontal)):
        noise = np.zeros(size)
        noise[lead : lead + len(window)] = random.standard_normal(len(window)) * window
        spectrum = np.fft.rfft(noise)
        spectrum /= math.sqrt(float(np.mean(np.abs(spectrum) ** 2)))
        parts.append(np.fft.irfft(spectrum * target, size) / dt)
    return Motion(
        dt,
        *parts,
        name=f"stochastic M{magnitude:g} at {distance / 1e3:g} km, {region.name}, seed {seed}",
        metadata={
            "format": "stochastic point source",
            "stage": "simulated",
            "region": region.name,
            "reference": region.reference,
            "references": ("boore2003", "brune1970", "saragoni1974", *region.sources),
            "magnitude": magnitude,
            "distance_m": distance,
            "seed": seed,
        },
    )


def with_directivity_pulse(motion: Motion, pulse: Motion, time: float | None = None) -> Motion:
    """Put a directivity pulse into the x component of a simulated motion.

    Parameters
    ----------
    motion : Motion
        Of high frequencies, e.g. from :func:`stochastic_motion`.
    pulse : Motion
        E.g. :func:`mavroeidis_papageorgiou`.
    time : float, optional
        Of the pulse's largest velocity [s]; by default that of the largest velocity of ``motion``.

    Notes
    -----
    The Fourier amplitude of the pulse is taken off that of the motion, where there is as much, at the motion's phase;
    then the pulse is added. So the union does not hold the pulse's band twice.

    References
    ----------
    Mavroeidis and Papageorgiou (2003).
    """
    dt = motion.dt
    a = motion.acceleration
    fine = pulse.acceleration
    length = pulse.metadata.get("pulse_length", pulse.duration)
    given = np.interp(np.arange(0.0, length + dt, dt), pulse.time, fine, right=0.0)
    middle = int(np.argmax(np.abs(integrate(given, dt))))
    at = int(np.argmax(np.abs(integrate(a, dt)))) if time is None else round(time / dt)
    start = at - middle
    if start < 0 or start + len(given) > len(a):
        before, after = max(0, -start), max(0, start + len(given) - len(a))
        if before + after > 10 * len(a):
            raise InputError(
                f"a pulse at {at * dt:g} s lies far outside a motion of {motion.duration:g} s; choose a time."
            )
        a = np.pad(a, (before, after))
        start += before
    else:
        before, after = 0, 0
    placed = np.zeros(len(a))
    placed[start : start + len(given)] = given
    spectrum, taken = np.fft.rfft(a), np.abs(np.fft.rfft(placed))
    size = np.abs(spectrum)
    share = np.divide(np.maximum(size - taken, 0.0), size, out=np.zeros_like(size), where=size > 0.0)
    out = np.fft.irfft(spectrum * share, len(a)) + placed

    def padded(values: np.ndarray | None) -> np.ndarray | None:
        return None if values is None else np.pad(values, (before, after))

    text = f"{pulse.name} put in with its largest velocity at {(start + middle) * dt:g} s"
    sources = (*motion.metadata.get("references", ()), *pulse.metadata.get("references", ()), "mavroeidis2003")
    return motion.replace(
        acceleration=out,
        lateral=padded(motion.lateral),
        vertical=padded(motion.vertical),
        factor=1.0,
        name=f"{motion.name} with {pulse.name}",
        metadata={**motion.metadata, "references": tuple(dict.fromkeys(sources))},
        processing=(*motion.processing, text),
    )


def _window(duration: float, dt: float) -> np.ndarray:
    """Window of Saragoni and Hart with the constants of Boore (2003): peak at 0.2, 5 % at the end of twice "
    "``duration``."""
    epsilon, eta = 0.2, 0.05
    b = -epsilon * math.log(eta) / (1.0 + epsilon * (math.log(epsilon) - 1.0))
    c = b / epsilon
    t = np.arange(0.0, 1.5 * 2.0 * duration, dt) / (2.0 * duration)
    return (math.e / epsilon) ** b * t**b * np.exp(-c * t)
