"""Columns followed to the ground: the verdict is that of the lanes, and what has fallen is a collapse."""

import numpy as np
import pytest

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.motion import Motion, harmonic
from stylobate.outcome import Outcome
from stylobate.simulate import simulate

MONOLITH, TWELVE = preset("paper-monolithic"), preset("paper-12-drums")


@pytest.mark.slow
@pytest.mark.parametrize(("length", "amplitude"), [(0.55, 0.6), (0.5, 0.7), (0.8, 0.4), (0.6, 0.5), (0.3, 0.4)])
def test_a_column_that_falls_after_its_motion_has_collapsed(length, amplitude):
    push = Motion(0.01, np.full(round(length / 0.01) + 1, amplitude * g))
    followed = simulate(MONOLITH, push, DistinctElement2D(), until_rest=True)
    waited = simulate(MONOLITH, push, DistinctElement2D(), tail=8.0)
    assert followed.collapsed == waited.collapsed == (length > 0.3)
    assert followed.measures.reason == waited.measures.reason
    assert bool(followed.mechanism.fallen) == waited.collapsed


@pytest.mark.parametrize("column", [MONOLITH, TWELVE], ids=["1", "12"])
def test_what_has_fallen_is_a_collapse_and_what_stands_is_none(column):
    seen = set()
    for frequency, amplitude in ((0.5, 0.2), (0.66, 0.5), (0.8, 0.35), (1.0, 0.5), (0.5, 0.5)):
        motion = harmonic(frequency, amplitude * g, 3.0)
        response = simulate(column, motion, DistinctElement2D(), until_rest=True, output_interval=0.02)
        assert response.outcome is not Outcome.FAILED
        assert bool(response.mechanism.fallen) == response.collapsed
        seen.add(response.collapsed)
    assert seen == {False, True}


@pytest.mark.parametrize("modulus", [2e10, 5e9, 1e9])
def test_the_stone_in_the_joints_is_in_the_bed_too(modulus):
    """Softer joints make longer steps: the bed must be as soft, or it blows up."""
    model = DistinctElement2D(block_modulus=modulus)
    response = simulate(MONOLITH, harmonic(0.5, 0.3 * g, 5.0), model, until_rest=True)
    assert response.collapsed
    assert response.mechanism.at_rest
    assert response.energy_imbalance < 1e-2
    assert response.drum_z.max() < 0.2  # thrown up no higher than a corner lifts it


def test_sliding_off_is_not_called_overturning():
    rough, slippery = (Joint(5e10, 2.5e10, friction_coefficient=mu) for mu in (3.0, 0.05))
    drums = [Drum(0.5, 1.0, 1.0, 2000.0), Drum(2.0, 1.0, 1.0, 2000.0)]
    column = Column.of_drums(drums, rough, overrides={2: slippery})
    push = Motion(0.01, np.concatenate((np.full(31, 1.35 * g), np.zeros(200))))
    response = simulate(column, push, DistinctElement2D(), until_end=True)
    assert "left the support at joint 2" in response.measures.reason
    assert response.mechanism.slid_off
    assert "slid off its support" in response.mechanism.describe()
