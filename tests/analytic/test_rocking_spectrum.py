"""Rocking spectra against the closed forms of Housner's block."""

import math

import numpy as np
import pytest
from validation.overturning import half_sine

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion, half_sine_pulse
from stylobate.simulate import simulate
from stylobate.verdicts.rocking_spectrum import rocking_block, rocking_spectrum


def test_blocks_have_the_size_and_slenderness_they_are_named_for():
    for p, alpha in ((0.8, 0.05), (1.7, 0.16), (6.0, 0.4)):
        block = rocking_block(p, alpha)
        assert block.frequency_parameter == pytest.approx(p, rel=1e-9)
        assert block.slenderness == pytest.approx(alpha, rel=1e-9)
        assert block.restitution == pytest.approx(1.0 - 1.5 * math.sin(alpha) ** 2, rel=1e-9)


def test_blocks_stay_closed_below_their_uplift_acceleration():
    alphas = np.array([0.1, 0.2, 0.3])
    motion = half_sine_pulse(1.0, g * math.tan(0.2) * 1.001, 5.0)
    spectrum = rocking_spectrum(motion, [1.0, 3.0], alphas, threads=1)
    assert (spectrum.peak_rotation[:, 2] == 0.0).all()
    assert (spectrum.peak_rotation[:, :2] > 0.0).all()
    assert spectrum.decided.all()


@pytest.mark.parametrize("ratio", [1.0, 2.0, 4.0])
def test_the_half_sine_threshold_of_slender_blocks(ratio):
    """The closed form is linear; slender enough here to 1 %."""
    threshold = half_sine(ratio)
    p = 2.0
    motion = half_sine_pulse(ratio * p / (2.0 * math.pi), g * 0.03 * threshold, 12.0)
    spectrum = rocking_spectrum(motion, [p], [0.03 * 0.985, 0.03 * 1.015], restitution=0.9, threads=1)
    assert spectrum.collapsed[0].tolist() == [True, False]


def test_a_cell_is_the_single_run():
    rng = np.random.default_rng(8)
    motion = Motion(0.01, np.convolve(rng.normal(size=1500), np.hanning(40), "same") * 0.8)
    spectrum = rocking_spectrum(motion, [1.5], [0.2], threads=1)
    single = simulate(rocking_block(1.5, 0.2), motion, HousnerBlock())
    assert spectrum.peak_rotation[0, 0] == pytest.approx(single.peak_rotation, rel=0.02)


def test_impossible_grids_are_refused():
    with pytest.raises(InputError, match="slendernesses"):
        rocking_spectrum(Motion(0.1, [0.0, 1.0]), [1.0], [2.0])
