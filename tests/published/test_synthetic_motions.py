"""Simulated motions: the target spectrum in the mean, constants of the literature, seeds, union with a pulse."""

import dataclasses
import itertools
import math

import numpy as np
import pytest

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import (
    REGIONS,
    displacement,
    fourier_target,
    integrate,
    mavroeidis_papageorgiou,
    parse_synthetic,
    pulse_match,
    stochastic_motion,
    with_directivity_pulse,
)
from stylobate.motion.synthesis import corner_frequency, seismic_moment, spreading


@pytest.mark.parametrize(("magnitude", "distance"), [(5.0, 10e3), (6.5, 20e3), (7.5, 80e3)])
@pytest.mark.parametrize("region", sorted(REGIONS))
def test_a_hundred_seeds_have_the_target_spectrum_in_the_mean(region, magnitude, distance):
    """Root mean square over seeds, in bands of a third of an octave, within 10 % of the target."""
    motions = [stochastic_motion(magnitude, distance, region, seed=seed) for seed in range(100)]
    size, dt = motions[0].steps, motions[0].dt
    f = np.fft.rfftfreq(size, dt)
    power = np.mean([np.abs(np.fft.rfft(m.acceleration) * dt) ** 2 for m in motions], axis=0)
    target = fourier_target(f, magnitude, distance, REGIONS[region])
    edges = 0.2 * 2.0 ** (np.arange(24) / 3.0)
    for low, high in itertools.pairwise(edges):
        band = (f >= low) & (f < high)
        if band.sum() >= 3:
            assert math.sqrt(power[band].mean() / np.mean(target[band] ** 2)) == pytest.approx(1.0, abs=0.1), low


def test_constants_in_the_units_of_the_literature():
    """M₀ = 10^(1.5 M + 16.05) dyn cm, and f_c = 4.906·10⁶ β (Δσ/M₀)^(1/3) with km/s, bar and dyn cm."""
    region = REGIONS["western-north-america"]
    assert seismic_moment(7.0) == pytest.approx(10.0 ** (1.5 * 7.0 + 16.05) * 1e-7, rel=1e-12)
    expected = 4.906e6 * 3.5 * (100.0 / 10.0 ** (1.5 * 7.0 + 16.05)) ** (1.0 / 3.0)
    assert corner_frequency(7.0, region) == pytest.approx(expected, rel=1e-3)


def test_geometric_spreading_is_continuous_and_has_its_powers():
    region = REGIONS["eastern-north-america"]
    assert spreading(1e3, region) == 1.0
    assert spreading(10e3, region) == pytest.approx(0.1)
    assert spreading(70e3, region) == pytest.approx(1.0 / 70.0)
    assert spreading(100e3, region) == pytest.approx(1.0 / 70.0)
    assert spreading(260e3, region) == pytest.approx(1.0 / 70.0 / math.sqrt(2.0))


def test_spectrum_rises_with_the_square_of_frequency_and_its_level_is_the_moment_s():
    region = dataclasses.replace(REGIONS["greece"], quality=1e9, quality_power=0.0)  # without loss on the way
    f = np.array([1e-4, 2e-4])
    low = fourier_target(f, 6.0, 10e3, region)
    assert low[1] / low[0] == pytest.approx(4.0, rel=1e-4)
    far_field = 0.55 * math.sqrt(0.5) * 2.0 * seismic_moment(6.0) / (4.0 * math.pi * 2700.0 * 3400.0**3 * 10e3)
    assert low[0] / (2.0 * math.pi * f[0]) ** 2 == pytest.approx(far_field, rel=1e-4)


def test_a_seed_is_a_motion():
    motion, same, other = (stochastic_motion(6.0, 15e3, seed=seed) for seed in (7, 7, 8))
    assert motion.digest == same.digest != other.digest
    assert stochastic_motion(6.0, 15e3, seed=7, horizontal=2).samples == pytest.approx(motion.samples)
    assert 0.05 < stochastic_motion(6.5, 10e3).pga / g < 0.6  # of the size that such earthquakes have on rock


def test_simulated_motions_end_at_rest():
    motion = stochastic_motion(6.5, 20e3, seed=3)
    v, d = integrate(motion.acceleration, motion.dt), displacement(motion.acceleration, motion.dt)
    assert abs(v[-1]) < 0.02 * np.abs(v).max()
    assert abs(d[-1]) < 0.1 * np.abs(d).max()


def test_union_with_a_pulse():
    motion = stochastic_motion(6.8, 8e3, seed=1, horizontal=2)
    pulse = mavroeidis_papageorgiou(0.4, 0.25 * g, oscillation=2.0)
    both = with_directivity_pulse(motion, pulse)
    assert pulse_match(both).period == pytest.approx(2.5, rel=0.25)
    v = integrate(both.acceleration, both.dt)
    assert np.abs(v).max() == pytest.approx(np.abs(integrate(pulse.acceleration, pulse.dt)).max(), rel=0.3)
    assert both.steps == len(both.lateral)
    assert "put in" in both.processing[-1]
    late = with_directivity_pulse(motion, pulse, motion.duration)
    assert late.duration > motion.duration
    with pytest.raises(InputError, match="far outside"):
        with_directivity_pulse(motion, pulse, 1e5)


def test_as_typed():
    motion = parse_synthetic("greece, 6.5Mw, 20 km, seed=3")
    assert motion.digest == stochastic_motion(6.5, 20e3, "greece", seed=3).digest
    for text, message in [
        ("atlantis,6.5Mw,20km", "region is 'atlantis'"),
        ("greece,6.5Mw", "no distance"),
        ("greece,20km", "no magnitude"),
        ("greece,6.5,20km", "'6.5' is not understood"),
        ("greece,9.5Mw,20km", "magnitude is 9.5"),
        ("greece,6.5Mw,6Mw,20km", "two values of mw"),
        ("", "region|no magnitude"),
    ]:
        with pytest.raises(InputError, match=message):
            parse_synthetic(text)
