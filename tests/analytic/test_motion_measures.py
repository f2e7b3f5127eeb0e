"""Spectra and measures of motions against closed forms, exact to rounding where the form is exact."""

import json
import math
import re
import warnings

import numpy as np
import pytest

from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import (
    Motion,
    arias_intensity,
    cumulative_absolute_velocity,
    displacement,
    half_sine_pulse,
    harmonic,
    housner_intensity,
    motion_summary,
    peak_ground_displacement,
    peak_ground_velocity,
    pulse_match,
    rectangular_pulse,
    response_spectrum,
    ricker,
    rocking_measures,
    rotated_pga,
    rotated_spectrum,
    significant_duration,
)
from stylobate.motion.conditioning import CURES, KEPT_VELOCITY, THEN, conditioned, cure_of, cured, cures_of, drift_of
from stylobate.motion.intensity import displacement_drift, warn_of_drift, warn_of_velocity
from stylobate.motion.motion import integrate
from stylobate.motion.readers.registry import sample_motion

PERIODS = np.array([0.03, 0.1, 0.33, 0.7, 1.0, 1.9, 4.0])


def test_undamped_spectrum_of_a_rectangular_pulse():
    length, a = 0.5, 2.0
    spectrum = response_spectrum(rectangular_pulse(1.0, a, length), PERIODS, 0.0)
    w = 2.0 * np.pi / PERIODS
    exact = np.where(length >= PERIODS / 2.0, 2.0, 2.0 * np.abs(np.sin(w * length / 2.0))) * a / w**2
    assert spectrum.sd == pytest.approx(exact, rel=6e-4)
    assert spectrum.psa == pytest.approx(exact * w**2, rel=6e-4)
    assert spectrum.sa == pytest.approx(spectrum.psa, rel=1e-12)  # no damping: the same


def test_undamped_spectrum_of_a_half_sine():
    f, a = 1.0, 3.0
    motion = half_sine_pulse(f, a, 0.5)
    w, big = 2.0 * np.pi / PERIODS, 2.0 * np.pi * f
    t = np.linspace(0.0, 0.5, 200_001)
    for j in range(len(PERIODS)):
        if abs(w[j] - big) < 1e-9:
            u = a / (2 * big**2) * (big * t * np.cos(big * t) - np.sin(big * t))
            v_end = a / (2 * big**2) * (-(big**2) * 0.5 * math.sin(big * 0.5))
        else:
            u = -a / (w[j] ** 2 - big**2) * (np.sin(big * t) - big / w[j] * np.sin(w[j] * t))
            v_end = -a / (w[j] ** 2 - big**2) * big * (math.cos(big * 0.5) - math.cos(w[j] * 0.5))
        exact = max(np.abs(u).max(), math.hypot(u[-1], v_end / w[j]))
        assert response_spectrum(motion, [PERIODS[j]], 0.0).sd[0] == pytest.approx(exact, rel=6e-4), PERIODS[j]


@pytest.mark.parametrize("damping", [0.0, 0.02, 0.2, 0.7])
def test_overshoot_of_a_suddenly_applied_acceleration(damping):
    motion = Motion(0.01, np.full(2000, 1.5))
    spectrum = response_spectrum(motion, [0.5, 1.0], damping)
    overshoot = 1.0 + math.exp(-damping * math.pi / math.sqrt(1.0 - damping**2))
    assert spectrum.psa == pytest.approx([1.5 * overshoot] * 2, rel=6e-4)


def test_resonance():
    motion = harmonic(1.0, 1.0, 60.0)
    spectrum = response_spectrum(motion, [1.0], 0.05)
    assert spectrum.psa[0] == pytest.approx(1.0 / (2.0 * 0.05), rel=1e-3)


def test_spectrum_against_the_matrix_exponential():
    """Another exact way through a step, on noise, with peaks sought between the samples."""
    from scipy.linalg import expm

    rng = np.random.default_rng(5)
    motion = Motion(0.02, rng.normal(size=300))
    for period, z in ((0.05, 0.05), (0.6, 0.05), (3.0, 0.3)):
        w, sub = 2.0 * np.pi / period, 40
        h = motion.dt / sub
        system = np.array([[0, 1, 0, 0], [-w * w, -2 * z * w, 1, 0], [0, 0, 0, 1], [0, 0, 0, 0]], dtype=float)
        step = expm(system * h)
        state, peak, peak_v, peak_a = np.zeros(4), 0.0, 0.0, 0.0
        a = np.concatenate([motion.acceleration, [0.0]])
        tail = math.ceil(1.2 * period / motion.dt)
        for i in range(motion.steps - 1 + tail):
            inside = i < motion.steps - 1
            state[2] = -a[i] if inside else 0.0
            state[3] = -(a[i + 1] - a[i]) / motion.dt if inside else 0.0
            for _ in range(sub):
                state = step @ state
                peak, peak_v = max(peak, abs(state[0])), max(peak_v, abs(state[1]))
                peak_a = max(peak_a, abs(w * w * state[0] + 2 * z * w * state[1]))
        spectrum = response_spectrum(motion, [period], z)
        assert spectrum.sd[0] == pytest.approx(peak, rel=1e-3)
        assert spectrum.sv[0] == pytest.approx(peak_v, rel=5e-3)
        assert spectrum.sa[0] == pytest.approx(peak_a, rel=5e-3)


def test_limits_of_the_spectrum():
    """A stiff oscillator follows the ground, a soft one stays where it was; the pulse ends at rest."""
    motion = ricker(1.0, 3.0, 10.0)
    assert response_spectrum(motion, [0.01], 0.05).psa[0] == pytest.approx(motion.pga, rel=1e-3)
    assert response_spectrum(motion, [500.0], 0.0).sd[0] == pytest.approx(peak_ground_displacement(motion), rel=1e-3)


def test_arias_and_cav_of_a_triangle_are_exact_between_samples():
    motion = Motion(1.0, [0.0, 3.0, -3.0, 0.0])
    assert arias_intensity(motion) == pytest.approx(math.pi / (2.0 * g) * 9.0, rel=1e-15)
    assert cumulative_absolute_velocity(motion) == pytest.approx(1.5 + 1.5 + 1.5, rel=1e-15)
    assert peak_ground_velocity(motion) == pytest.approx(1.5 + 0.75, rel=1e-15)


def test_displacement_of_a_constant_and_a_ramp_are_exact():
    assert peak_ground_displacement(Motion(0.5, [2.0] * 5)) == pytest.approx(0.5 * 2.0 * 4.0, rel=1e-15)
    assert peak_ground_displacement(Motion(1.0, [0.0, 1.0, 2.0])) == pytest.approx(8.0 / 6.0, rel=1e-15)


def test_measures_of_a_long_harmonic():
    f, a, total = 2.0, 3.0, 20.0
    motion = harmonic(f, a, total)
    assert arias_intensity(motion) == pytest.approx(math.pi / (2.0 * g) * a**2 * total / 2.0, rel=1e-5)
    assert cumulative_absolute_velocity(motion) == pytest.approx(2.0 * a / math.pi * total, rel=1e-5)
    assert peak_ground_velocity(motion) == pytest.approx(a / (math.pi * f), rel=1e-5)
    assert significant_duration(motion, 0.05, 0.95) == pytest.approx(0.9 * total, abs=0.25 / f)
    assert significant_duration(motion, 0.05, 0.75) == pytest.approx(0.7 * total, abs=0.25 / f)


def test_rocking_measures():
    alpha, p = 0.2, 1.7
    motion = harmonic(1.0, 2.0 * g * alpha, 10.0)
    measures = rocking_measures(motion, alpha, p)
    assert measures["pga_over_g_tan_alpha"] == pytest.approx(2.0, rel=1e-5)
    assert measures["uniform_duration_s"] == pytest.approx(
        10.0 * 2.0 / 3.0, rel=1e-5
    )  # |sin| > 1/2 two thirds of the time
    pulse = rocking_measures(ricker(0.8, 5.0, 20.0), alpha, p)
    assert pulse["omega_g_over_p"] == pytest.approx(2.0 * math.pi * 0.8 / p, rel=5e-3)


@pytest.mark.parametrize("antisymmetric", [False, True])
@pytest.mark.parametrize("frequency", [0.3, 0.8, 2.5])
def test_a_ricker_pulse_is_found_in_noise(antisymmetric, frequency):
    pulse = ricker(frequency, 4.0, 20.0, antisymmetric=antisymmetric)
    noise = np.random.default_rng(1).normal(size=pulse.steps) * 0.5
    match = pulse_match(Motion(pulse.dt, pulse.acceleration + noise))
    assert match.period == pytest.approx(1.0 / frequency, rel=0.02)
    assert match.amplitude == pytest.approx(4.0, rel=0.03)
    assert match.time == pytest.approx(1.5 / frequency, abs=0.07 / frequency)
    assert match.kind == ("antisymmetric" if antisymmetric else "symmetric")


def test_directions():
    """A motion along 30° from x: every direction sees its projection."""
    rng = np.random.default_rng(3)
    a = rng.normal(size=2000)
    motion = Motion(0.01, a * math.cos(math.pi / 6), a * math.sin(math.pi / 6))
    peak = np.abs(a).max()
    peaks = rotated_pga(motion)
    assert peaks[100.0] == pytest.approx(peak, rel=1e-12)
    assert peaks[50.0] == pytest.approx(peak * math.cos(math.pi / 4), rel=0.02)
    spectrum = rotated_spectrum(motion, periods=[0.5, 1.0])
    along = response_spectrum(Motion(0.01, a), [0.5, 1.0]).psa
    assert spectrum[100.0] == pytest.approx(along, rel=6e-4)  # as close as states lie on a period


def test_housner_intensity_of_an_impulse():
    """A velocity V all at once gives V cos ωt: the undamped pseudo-velocity is V at every period."""
    pulse = rectangular_pulse(1000.0, 1000.0, 3.0)
    short = Motion(0.0005, np.concatenate([[1000.0, 0.0], np.zeros(100)]))
    assert housner_intensity(short, 0.0) == pytest.approx(2.4 * 0.25, rel=1e-3)
    assert pulse.pgv == pytest.approx(0.5, rel=1e-9)


@pytest.mark.parametrize("periods", [[0.0], [-1.0], [math.nan], [], [1e9]])
def test_impossible_periods_are_refused(periods):
    with pytest.raises(InputError, match="periods"):
        response_spectrum(Motion(0.01, [0.0, 1.0]), periods)


def test_one_component_has_no_directions():
    with pytest.raises(InputError, match="one horizontal component"):
        rotated_spectrum(Motion(0.01, [0.0, 1.0]))
    with pytest.raises(InputError, match="no component 'z'"):
        response_spectrum(Motion(0.01, [0.0, 1.0]), component="z")


def test_a_displacement_that_double_integration_leaves_is_told_with_its_size():
    offset = Motion(0.01, np.full(1001, 0.02), np.sin(2.0 * np.pi * np.arange(1001) * 0.01), metadata={"file": "a.csv"})
    assert displacement_drift(offset) == pytest.approx(0.5 * 0.02 * 10.0**2)
    # A sine from rest leaves 1/ω² ω T = T/ω; an antisymmetric pulse comes back.
    assert displacement_drift(offset, "y") == pytest.approx(10.0 / (2.0 * np.pi), rel=1e-3)
    with pytest.warns(OutOfRangeWarning) as seen:
        warn_of_drift(offset)
    assert [str(warning.message)[:44] for warning in seen] == [
        f"{offset.name}: the peak displacement of component {axis}"[:44] for axis in "xy"
    ]
    assert "1 m stand at the end" in str(seen[0].message)
    back = Motion(0.01, ricker(1.0, 3.0).samples * 3.0)
    assert displacement_drift(back) == 0.0
    assert motion_summary(back, spectrum=False)["pgd_drift_m"] == {"x": 0.0}
    assert motion_summary(offset, spectrum=False)["pgd_drift_m"]["x"] == pytest.approx(1.0)


def mended(motion, step):
    """Whether a step of conditioning ends the drift of a motion, its velocity at the end included."""
    after = conditioned(motion, step)
    speed = np.abs(integrate(after.samples, after.dt))
    return displacement_drift(after) == 0.0 and speed[-1] < 0.05 * speed.max()


@pytest.mark.parametrize("drift", [lambda t: 1e-3 * t, lambda t: 0.003 * np.ones_like(t), lambda t: 0.02 * (t > 8.0)])
def test_only_a_conditioning_that_ends_the_drift_is_named(drift):
    time = 0.01 * np.arange(2001)
    shaking = 3.0 * np.sin(2.0 * np.pi * 1.5 * time) * np.exp(-(((time - 8.0) / 3.0) ** 2))
    record = Motion(0.01, shaking + drift(time), name="r", metadata={"file": "r.csv"})
    assert displacement_drift(record) != 0.0
    with pytest.warns(OutOfRangeWarning, match="stand at the end") as seen:
        warn_of_drift(record)
    named = re.search(r"\(`condition='(\S+)'`\)", str(seen[0].message))
    assert named is not None
    assert mended(record, named[1])


def test_no_conditioning_is_named_where_none_helps():
    with pytest.warns(OutOfRangeWarning, match="take no displacement from it") as seen:  # nothing but an offset
        warn_of_drift(Motion(0.01, np.full(1001, 0.02), name="r", metadata={"file": "r.csv"}))
    assert "`condition" not in str(seen[0].message)


def test_no_conditioning_is_named_that_takes_the_shaking_or_is_longer_than_the_record():
    """A ground that moves for good by half a sine of velocity: all that ends the displacement takes more than a tenth."""
    time = 0.01 * np.arange(3001)
    fling = np.where(np.abs(time - 12.5) < 2.5, np.cos(np.pi * (time - 12.5) / 5.0), 0.0) * 0.5
    shaking = 0.8 * np.sin(6.0 * np.pi * time) * np.exp(-(((time - 12.0) / 3.0) ** 2))
    values = np.gradient(fling, 0.01) + shaking
    own = float(np.abs(integrate(values, 0.01)).max())
    taken = {cure: np.abs(integrate(cured(Motion(0.01, values), cure).samples, 0.01)).max() for cure in CURES}
    assert min(own / taken[cure] for cure in CURES if cure != "demean") > 1.0 / KEPT_VELOCITY
    assert drift_of(values, 0.01) != 0.0
    assert cures_of(values, 0.01) == {}
    short = (shaking + 0.003 * time)[800:1700]  # nine seconds, which a filter of ten does not see
    assert drift_of(short, 0.01) != 0.0
    assert "highpass" not in str(cures_of(short, 0.01))


def drifting(offset):
    """A minute with some seconds of shaking, on a baseline with an offset [m/s²] that wanders slowly."""
    time = 0.01 * np.arange(6001)
    shaking = 3.0 * np.sin(6.0 * np.pi * time) * np.exp(-(((time - 20.0) / 3.0) ** 2))
    baseline = offset * (1.0 + 0.2 * np.sin(2.0 * np.pi * time / 45.0))
    return Motion(0.01, shaking + baseline, name="r", metadata={"file": "r.csv"})


def test_a_combination_is_named_where_it_does_better_than_any_single_step():
    """The jump of a large offset rings through a filter alone; a mean alone leaves the wandering."""
    record = drifting(0.12)
    named = str(cure_of(record))
    assert named == f"demean{THEN}highpass=0.1Hz"
    drifts = {cure: np.abs(displacement(cured(record, cure).samples, 0.01)).max() for cure in CURES}
    assert drifts[named] < 0.5 * min(size for cure, size in drifts.items() if THEN not in cure)
    assert displacement_drift(cured(record, named)) == 0.0
    with pytest.warns(OutOfRangeWarning, match=r"\(`condition='demean'`, then `condition='highpass=0.1Hz'`\)"):
        warn_of_drift(record)


def test_one_conditioning_is_named_for_all_components_that_drift():
    """What mends one of them alone is no remedy: the mean, of y whose offset is constant and not of x where it jumps."""
    shaking = drifting(0.0).samples
    both = Motion(0.01, shaking + 0.02 * (np.arange(6001) > 2500), shaking + 0.003, metadata={"file": "r.csv"})
    each = [cures_of(values, 0.01) for values in both.components.values()]
    assert "demean" in each[1]
    assert "demean" not in each[0]
    named = str(cure_of(both))
    assert all(drift_of(values, 0.01) == 0.0 for values in cured(both, named).components.values())


def test_the_velocity_of_a_record_that_drifts_is_told_with_what_it_is_without():
    """Conditioned as the warning says, it is that of the shaking: 3 m/s² at 3 Hz make 3/(6π) m/s."""
    record = drifting(0.02)
    with pytest.warns(OutOfRangeWarning, match="r: the peak velocity of component x, .* m stand at the end") as seen:
        warn_of_velocity(record)
    match = re.search(r"leaves (\S+) m/s", str(seen[0].message))
    assert match is not None
    assert float(match[1]) == pytest.approx(3.0 / (6.0 * np.pi), rel=0.05)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_velocity(cured(record, str(cure_of(record))))
        warn_of_velocity(drifting(0.0))


def test_el_centro_is_not_told_a_baseline_that_leaves_it_moving():
    record = sample_motion("el-centro-1940")
    assert not mended(record, "baseline")
    with pytest.warns(OutOfRangeWarning, match=r"\(`condition='highpass=0.1Hz'`\)"):
        warn_of_drift(record)
    assert mended(record, "highpass=0.1Hz")


@pytest.mark.parametrize("size", [0.0, 2.0])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_summary_is_plain_values(size, count):
    waves = [size * np.sin(np.linspace(0.0, 20.0 + i, 800)) for i in range(count)]
    summary = motion_summary(Motion(0.01, *waves))
    text = json.dumps(summary, allow_nan=False)
    assert json.loads(text)["pga_g"]["x"] == pytest.approx(np.abs(waves[0]).max() / g)
    assert list(summary["pgv_m_s"]) == list("xyz")[:count]
    assert ("pga_rotd100_g" in summary) == (count > 1)
    assert ("psa_5_percent_g" in summary) == (size > 0.0)
