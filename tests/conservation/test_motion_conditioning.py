"""Conditioning: what each step must keep, what it must take away, and that it says so."""

import math

import numpy as np
import pytest

from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import (
    Motion,
    along,
    bandpass,
    baseline_piecewise,
    baseline_polynomial,
    demean,
    detrend,
    displacement,
    integrate,
    peak_ground_velocity,
    principal,
    resample,
    response_spectrum,
    rotated,
    scale_to_pgv,
    scale_to_sa,
    strongest,
    taper,
    trim,
    turned,
)


@pytest.fixture(scope="module")
def record():
    rng = np.random.default_rng(4)
    envelope = np.exp(-(((np.arange(6000) * 0.01 - 20.0) / 8.0) ** 2))
    parts = [np.convolve(rng.normal(size=6000), np.hanning(15), "same") * envelope for _ in range(3)]
    return Motion(0.01, *parts, factor=1.7, metadata={"azimuths": {"x": 30.0, "y": 300.0, "z": None}})


def test_every_step_is_pure_and_writes_itself_down(record):
    before = record.digest
    steps = [
        lambda m: demean(m),
        lambda m: demean(m, 2.0),
        lambda m: detrend(m),
        lambda m: baseline_polynomial(m),
        lambda m: baseline_piecewise(m),
        lambda m: taper(m, 1.0),
        lambda m: bandpass(m, 0.1, 25.0),
        lambda m: resample(m, 0.02),
        lambda m: trim(m),
        lambda m: rotated(m, 75.0),
        lambda m: along(m, 75.0),
        lambda m: turned(m, 20.0),
        lambda m: principal(m),
        lambda m: strongest(m),
        lambda m: scale_to_pgv(m, 0.4),
        lambda m: scale_to_sa(m, 1.0, 3.0),
    ]
    motion = record
    for step in steps:
        once = step(record)
        assert len(once.processing) >= 1
        assert once.digest != before
        assert once.name == record.name
        motion = step(motion) if step is not steps[9] and step is not steps[10] else motion
    assert record.digest == before
    assert record.processing == ()
    assert len(motion.processing) == len(steps) - 2


def test_an_offset_and_a_trend_are_taken_off(record):
    shifted = record.replace(acceleration=record.samples + 0.5)
    assert demean(shifted).acceleration.mean() == pytest.approx(0.0, abs=1e-12)
    sloped = record.replace(acceleration=record.samples + np.linspace(-1.0, 2.0, record.steps))
    assert detrend(sloped).acceleration == pytest.approx(detrend(record).acceleration, abs=1e-9)


def test_parseval_for_the_filter(record):
    """Energy of the filtered motion = energy of the spectrum times the squared gain."""
    low, high, n = 0.2, 20.0, 4
    out = bandpass(record, low, high, n)
    size = 1 << 18
    f = np.fft.rfftfreq(size, record.dt)
    with np.errstate(divide="ignore"):
        gain = 1.0 / (1.0 + (low / f) ** (2 * n)) / (1.0 + (f / high) ** (2 * n))
    spectrum = np.fft.rfft(record.acceleration, size) * gain
    energy = 2.0 * np.sum(np.abs(spectrum) ** 2) / size  # the ends f = 0 and Nyquist carry nothing
    assert np.sum(out.acceleration**2) == pytest.approx(energy, rel=1e-6)


def test_the_filter_has_no_phase_and_leaves_the_band(record):
    f0 = 2.0
    t = np.arange(8000) * 0.01
    wave = np.sin(2 * np.pi * f0 * t) * np.exp(-(((t - 40.0) / 8.0) ** 2))
    out = bandpass(Motion(0.01, wave), 0.1, 30.0, keep_padding=False)
    assert out.acceleration == pytest.approx(wave, abs=1e-4)


def test_a_filtered_record_returns_to_rest(record):
    for motion in (
        bandpass(record, 0.1, 25.0),
        bandpass(record.replace(acceleration=record.samples + 0.05), 0.1, None),
    ):
        v, d = integrate(motion.acceleration, motion.dt), displacement(motion.acceleration, motion.dt)
        assert abs(v[-1]) < 1e-5 * np.abs(v).max()
        assert abs(d[-1]) < 1e-3 * np.abs(d).max()


def test_polynomial_baseline_takes_off_every_drift_of_its_order(record):
    """Whatever polynomial of order 4 the instrument added to the acceleration, the result is the same."""
    s = np.linspace(0.0, 1.0, record.steps)
    drift = 0.02 - 0.3 * s + 0.5 * s**3 - 0.4 * s**4
    fixed = baseline_polynomial(record, 6)
    again = baseline_polynomial(record.replace(acceleration=record.samples + drift), 6)
    # The drift is a polynomial, but linear between samples here: its double integral differs by some (Δs)².
    assert again.acceleration == pytest.approx(fixed.acceleration, abs=1e-6)
    d, before = displacement(fixed.acceleration, 0.01), displacement(record.acceleration, 0.01)
    assert np.sum(d**2) < np.sum(before**2)


def test_piecewise_baseline_keeps_a_permanent_displacement():
    """A known motion with a permanent offset, disturbed by two known offsets, is found again."""
    dt, n = 0.01, 6001
    t = np.arange(n) * dt
    s = np.clip((t - 18.0) / 4.0, 0.0, 1.0)
    # displacement 0.3 m by a smooth step; its acceleration is the second derivative of s³(10 − 15 s + 6 s²)
    step = 0.3 * (60.0 * s - 180.0 * s**2 + 120.0 * s**3) / 16.0
    shaking = np.sin(2 * np.pi * 2.0 * t) * np.exp(-(((t - 20.0) / 3.0) ** 2))
    true = step + shaking - np.interp(t, [0.0, 60.0], [0.0, 0.0])
    disturbed = true + np.where((t >= 15.0) & (t < 25.0), 0.01, 0.0) + np.where(t >= 25.0, 0.003, 0.0)
    fixed = baseline_piecewise(Motion(dt, disturbed), 15.0, 25.0)
    d = displacement(fixed.acceleration, dt)
    assert d[-1] == pytest.approx(0.3, abs=0.01)
    assert abs(integrate(fixed.acceleration, dt)[-1]) < 1e-4
    with pytest.raises(InputError, match="no quiet end"):
        baseline_piecewise(Motion(dt, disturbed), 15.0, 60.0)


def test_resampling_keeps_the_band_and_folds_nothing_back():
    t = np.arange(20_000) * 0.001
    bell = np.exp(-(((t - 10.0) / 2.0) ** 2))
    slow, fast = np.sin(2 * np.pi * 5.0 * t) * bell, np.sin(2 * np.pi * 130.0 * t) * bell
    out = resample(Motion(0.001, slow + fast), 0.01)
    assert out.dt == pytest.approx(0.01, rel=1e-12)
    assert out.acceleration == pytest.approx(slow[::10], abs=1e-6)
    finer = resample(Motion(0.01, slow[::10]), 0.001)
    assert finer.acceleration[: 10 * 1990] == pytest.approx(slow[: 10 * 1990], abs=1e-6)
    odd = resample(Motion(0.001, slow), 0.0015)
    assert odd.acceleration[:10_000] == pytest.approx(np.interp(odd.time, t, slow)[:10_000], abs=1e-3)
    with pytest.raises(InputError, match="whole numbers"):
        resample(Motion(0.001, slow), 0.001 * math.pi)


def test_taper_and_trim(record):
    out = taper(record, 2.0)
    assert out.acceleration[0] == 0.0
    assert out.acceleration[-1] == 0.0
    assert out.acceleration[300:-300] == pytest.approx(record.acceleration[300:-300])
    kept = trim(record, before=1.0, after=1.0)
    assert 10.0 < kept.duration < 30.0
    energy = sum(np.sum(a**2) for a in kept.components.values()) / sum(np.sum(a**2) for a in record.components.values())
    assert 0.9 < energy < 1.0


@pytest.mark.parametrize("azimuth", [0.0, 30.0, 117.0, 300.0])
def test_turning_keeps_the_horizontal_vector(record, azimuth):
    out = rotated(record, azimuth)
    assert np.hypot(out.acceleration, out.lateral) == pytest.approx(np.hypot(record.acceleration, record.lateral))
    assert out.metadata["azimuths"] == {"x": azimuth, "y": (azimuth - 90.0) % 360.0, "z": None}
    assert rotated(out, 30.0).acceleration == pytest.approx(record.acceleration, abs=1e-12)
    assert rotated(out, 300.0).acceleration == pytest.approx(record.lateral, abs=1e-12)


def test_turning_north_and_east_to_a_compass_direction():
    north, east = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 2.0])
    motion = Motion(0.1, north, east, metadata={"azimuths": {"x": 0.0, "y": 90.0}})
    assert along(motion, 90.0).acceleration == pytest.approx(east)
    assert along(motion, 180.0).acceleration == pytest.approx(-north)
    assert along(motion, 45.0).acceleration == pytest.approx((north + east) / math.sqrt(2.0))
    assert along(motion, 45.0).lateral is None
    assert turned(motion, 90.0).metadata["azimuths"] == {"x": 90.0, "y": 180.0}
    oblique = Motion(0.1, north, (north + east) / math.sqrt(2.0), metadata={"azimuths": {"x": 0.0, "y": 45.0}})
    assert along(oblique, 90.0).acceleration == pytest.approx(east)


def test_principal_axes_are_uncorrelated_and_the_strongest_direction_has_the_largest_peak(record):
    out = principal(record)
    a, b = out.acceleration, out.lateral
    cross = np.sum(a[:-1] * b[:-1] + a[1:] * b[1:] + 0.5 * (a[:-1] * b[1:] + a[1:] * b[:-1]))
    assert abs(cross) < 1e-9 * np.sum(a * a)
    assert np.sum(a * a) >= np.sum(b * b)
    assert strongest(record).pga == pytest.approx(np.hypot(record.acceleration, record.lateral).max())


def test_a_motion_without_azimuths_is_turned_as_a_whole_as_if_its_x_pointed_north(record):
    bare = record.replace(metadata={"azimuths": {"x": None, "y": None}})
    north = record.replace(metadata={"azimuths": {"x": 0.0, "y": 270.0}})
    for azimuth in (0.0, 30.0, 90.0, -45.0):
        out, stated = rotated(bare, azimuth), rotated(north, azimuth)
        assert out.acceleration == pytest.approx(stated.acceleration, abs=1e-12)
        assert out.lateral == pytest.approx(stated.lateral, abs=1e-12)
        assert out.metadata["azimuths"]["x"] == stated.metadata["azimuths"]["x"] == azimuth % 360.0
        assert "from x towards y (no azimuths are stated" in out.processing[-1]
    # what shook along x shakes along the azimuth, from x towards y
    along_x = Motion(0.1, [0.0, 2.0], [0.0, 0.0])
    assert rotated(along_x, 30.0).components["x"][1] == pytest.approx(2.0 * math.cos(math.pi / 6.0))
    assert rotated(along_x, 30.0).components["y"][1] == pytest.approx(2.0 * math.sin(math.pi / 6.0))


def test_turning_needs_two_components_that_are_not_parallel():
    motion = Motion(0.1, [0.0, 1.0])
    parallel = Motion(0.1, [0.0, 1.0], [0.0, 1.0], metadata={"azimuths": {"x": 10.0, "y": 190.0}})
    with pytest.raises(InputError, match="one horizontal component"):
        turned(motion, 10.0)
    with pytest.raises(InputError, match="one horizontal component"):
        rotated(motion, 10.0)
    with pytest.raises(InputError, match="nearly parallel"):
        rotated(parallel, 10.0)


def test_scaling_meets_its_target(record):
    assert peak_ground_velocity(scale_to_pgv(record, 0.3)) == pytest.approx(0.3, rel=1e-2)
    # As close as states lie on a period: the peak between them is missed by up to 0.05 %.
    assert response_spectrum(scale_to_sa(record, 0.7, 4.0), [0.7]).psa[0] == pytest.approx(4.0, rel=6e-4)
    with pytest.raises(InputError, match="zero along x"):
        scale_to_pgv(Motion(0.1, [0.0, 0.0]), 0.3)


@pytest.mark.parametrize(
    ("step", "message"),
    [
        (lambda m: bandpass(m, 10.0, 5.0), "high corner"),
        (lambda m: bandpass(m, 0.1, 1e4), "nothing above"),
        (lambda m: bandpass(m, None, None), "low or a high"),
        (lambda m: taper(m, 1e4), "length of the taper"),
        (lambda m: trim(m, 0.9, 0.1), "high share"),
        (lambda m: baseline_polynomial(m, 1), "order"),
        (lambda m: demean(m, 1e9), "pre_event"),
    ],
)
def test_impossible_steps_are_refused(record, step, message):
    with pytest.raises(InputError, match=message):
        step(record)


def test_a_trim_that_begins_in_the_middle_of_motion_leads_its_ends_to_zero(record):
    kept = trim(record, 0.3, 0.6)
    assert kept.acceleration[0] == 0.0
    assert kept.acceleration[-1] == 0.0
    assert "s at start and end" in kept.processing[-1]
    bare = trim(record, 0.3, 0.6, ends=0.0)
    assert abs(bare.acceleration[0]) > 0.0
    away = round(0.25 / record.dt)
    assert kept.acceleration[away:-away] == pytest.approx(bare.acceleration[away:-away])
    quiet = Motion(0.01, np.concatenate([np.zeros(500), np.sin(np.arange(1000) * 0.1), np.zeros(500)]))
    assert "taper" not in trim(quiet, 0.0, 1.0, before=1.0).processing[-1]  # quiet ends are left alone


def test_a_record_scaled_by_more_than_ten_is_warned_about(record):
    real = record.replace(metadata={"file": "a.asc"})
    with pytest.warns(OutOfRangeWarning, match=r"a\.asc is scaled by"):
        scale_to_pgv(real, 20.0 * real.pgv)
    scale_to_pgv(record, 20.0 * record.pgv)  # not a record
