"""Pulses against their definitions: impulse, peak, period, rest at the end, and what linear interpolation loses."""

import math

import numpy as np
import pytest

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import (
    cosine_pulse,
    gabor,
    half_sine_pulse,
    harmonic,
    integrate,
    mavroeidis_papageorgiou,
    rectangular_pulse,
    ricker,
    sine_pulse,
)

PULSES = [rectangular_pulse, half_sine_pulse, sine_pulse, cosine_pulse, ricker, gabor, mavroeidis_papageorgiou]


def velocity(motion):
    return integrate(motion.acceleration, motion.dt)


@pytest.mark.parametrize("frequency", [0.37, 1.0, 7.3])
@pytest.mark.parametrize("quiet", [0.0, 2.0])
def test_final_velocity_is_the_impulse_of_the_pulse(frequency, quiet):
    a = 2.5
    for pulse, cycles, impulse in (
        (rectangular_pulse, 0.5, a / (2.0 * frequency)),
        (half_sine_pulse, 0.5, a / (math.pi * frequency)),
        (sine_pulse, 1.0, 0.0),
        (cosine_pulse, 1.0, 0.0),
        (ricker, 3.0, 0.0),
    ):
        final = velocity(pulse(frequency, a, cycles / frequency + quiet))[-1]
        # 1e-6: the trapezoidal rule on a half-sine of 500 steps is off by (π/500)²/12 = 3e-6 of it
        assert final == pytest.approx(impulse, rel=4e-6, abs=1e-8 * a / frequency), pulse.__name__


@pytest.mark.parametrize("pulse", PULSES)
def test_peak_is_the_amplitude_and_samples_are_shared(pulse):
    motion = pulse(1.3, -0.4 * g)
    # 1000 samples per cycle miss a peak by up to (π/1000)²/2 = 5e-6; higher harmonics by a few times that.
    assert motion.pga == pytest.approx(0.4 * g, rel=3e-5)
    assert motion.scaled(2.0).samples is motion.samples


@pytest.mark.parametrize("antisymmetric", [False, True])
def test_ricker_peaks_at_its_frequency(antisymmetric):
    motion = ricker(2.0, 1.0, 40.0, antisymmetric=antisymmetric)
    spectrum = np.abs(np.fft.rfft(motion.acceleration))
    frequencies = np.fft.rfftfreq(motion.steps, motion.dt)
    assert frequencies[spectrum.argmax()] == pytest.approx(2.0, abs=1.01 / 40.0)


def test_symmetric_ricker_is_the_second_derivative_of_a_gaussian():
    f, motion = 1.5, ricker(1.5, 1.0)
    tau = motion.time - 1.5 / f
    v = velocity(motion)  # τ exp(−π²f²τ²) by integrating the definition once
    assert np.abs(v - tau * np.exp(-((math.pi * f * tau) ** 2))).max() < 2e-6


@pytest.mark.parametrize("phase", [0.0, 37.0, 90.0, 200.0])
@pytest.mark.parametrize("oscillation", [1.3, 2.0, 3.5])
def test_mavroeidis_papageorgiou_is_the_derivative_of_its_velocity_pulse(phase, oscillation):
    f = 0.8
    motion = mavroeidis_papageorgiou(f, 3.0, oscillation=oscillation, phase=phase)
    tau = motion.time - oscillation / (2.0 * f)
    inside = np.abs(tau) <= oscillation / (2.0 * f)
    shape = np.where(
        inside,
        0.5 * (1.0 + np.cos(2.0 * np.pi * f * tau / oscillation)) * np.cos(2.0 * np.pi * f * tau + math.radians(phase)),
        0.0,
    )
    v = velocity(motion)
    scale = v @ shape / (shape @ shape)
    assert np.abs(v - scale * shape).max() < 1e-5 * abs(scale)
    # What the trapezoidal rule loses where the slope of the acceleration jumps at the ends: h²/12 of the jumps.
    pulse = motion.acceleration[inside]
    jumps = abs(pulse[1] - pulse[0]) + abs(pulse[-2] - pulse[-1])
    assert abs(v[-1]) < 1.1 * motion.dt / 12.0 * jumps + 1e-12
    assert abs(motion.acceleration[0]) < 1e-12


@pytest.mark.parametrize("phase", [0.0, 45.0, 90.0])
def test_gabor_is_the_derivative_of_its_velocity_pulse(phase):
    f, gamma = 1.1, 2.5
    motion = gabor(f, 3.0, oscillation=gamma, phase=phase)
    middle = gamma * math.sqrt(math.log(1e9) / 2.0) / math.pi / f
    tau = motion.time - middle
    shape = np.exp(-2.0 * (math.pi * f * tau / gamma) ** 2) * np.cos(2.0 * np.pi * f * tau + math.radians(phase))
    v = velocity(motion)
    scale = v @ shape / (shape @ shape)
    assert np.abs(v - scale * shape).max() < 1e-5 * abs(scale)
    assert abs(v[-1]) < 1e-8 * abs(scale)


def test_linear_interpolation_is_close_to_the_sine():
    motion = harmonic(2.0, 1.0, 3.0)
    fine = np.linspace(0.0, 3.0, 40_001)
    assert np.abs(np.interp(fine, motion.time, motion.acceleration) - np.sin(4.0 * np.pi * fine)).max() < 6e-6


@pytest.mark.parametrize(
    ("pulse", "arguments", "message"),
    [
        (half_sine_pulse, (0.0, 1.0), "frequency"),
        (half_sine_pulse, (1.0, math.nan), "amplitude"),
        (sine_pulse, (1.0, 1.0, 0.5), "takes 1 s"),
        (ricker, (1000.0, 1.0, 9000.0), "shorter duration"),
        (harmonic, (1000.0, 1.0, 9000.0), "shorter duration"),
    ],
)
def test_impossible_pulses_are_refused(pulse, arguments, message):
    with pytest.raises(InputError, match=message):
        pulse(*arguments)
