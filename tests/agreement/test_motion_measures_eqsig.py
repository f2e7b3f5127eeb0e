"""Arias intensity, CAV, durations and spectra against the eqsig library, on samples so dense that its rule is right."""

import warnings

import numpy as np
import pytest

from stylobate.motion import (
    Motion,
    arias_intensity,
    cumulative_absolute_velocity,
    response_spectrum,
    significant_duration,
)

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    eqsig = pytest.importorskip("eqsig", reason="the eqsig library is not installed")


@pytest.fixture(scope="module")
def pair():
    """The same piecewise linear motion at 0.01 s for us, and 20 times denser for the trapezoidal rule."""
    rng = np.random.default_rng(11)
    envelope = np.exp(-(((np.arange(3000) * 0.01 - 8.0) / 5.0) ** 2))
    motion = Motion(0.01, np.convolve(rng.normal(size=3000), [0.25, 0.5, 0.25], "same") * envelope)
    dense = np.interp(np.arange(2999 * 20 + 1) * 0.0005, motion.time, motion.acceleration)
    return motion, eqsig.AccSignal(dense, 0.0005)


def test_arias(pair):
    motion, other = pair
    assert arias_intensity(motion) == pytest.approx(eqsig.im.calc_arias_intensity(other)[-1], rel=2e-3)


def test_cav(pair):
    motion, other = pair
    assert cumulative_absolute_velocity(motion) == pytest.approx(eqsig.im.calc_cav(other)[-1], rel=2e-3)


@pytest.mark.parametrize("end", [0.75, 0.95])
def test_durations(pair, end):
    motion, other = pair
    theirs = eqsig.im.calc_sig_dur_vals(other.values, other.dt, start=0.05, end=end)
    assert significant_duration(motion, 0.05, end) == pytest.approx(theirs, abs=0.01)


def test_spectrum(pair):
    motion, other = pair
    periods = np.array([0.1, 0.3, 1.0, 3.0])
    ours = response_spectrum(motion, periods, 0.05)
    sd, _, _ = eqsig.sdof.pseudo_response_spectra(other.values, other.dt, periods, 0.05)
    assert ours.sd == pytest.approx(sd, rel=2e-3)
