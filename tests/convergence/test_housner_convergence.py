"""Housner's block: order of the batch's step, and verdicts as the step is halved."""

import math

import numpy as np
import pytest

from stylobate.column import preset
from stylobate.constants import g
from stylobate.models.housner import HousnerBlock
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate_many

COLUMN = preset("paper-monolithic")


def test_order_four_between_impacts():
    # Free rocking from 0.8 α for a time before the first impact: p T/4 = 2.3.
    p = COLUMN.frequency_parameter
    motion = Motion(0.2 / p, np.zeros(9))
    start = 0.8 * COLUMN.slenderness

    def last(step: float) -> float:
        model = HousnerBlock(initial_rotation=start, time_step=step)
        return simulate_many(COLUMN, [motion], model).residual_top_displacement_m[0]

    steps = 0.2 / p / np.array([1, 2, 4, 64])
    values = np.array([last(step) for step in steps])
    errors = np.abs(values[:3] - values[3])
    assert np.log2(errors[:2] / errors[1:]) == pytest.approx(4.0, abs=0.25)


def test_order_four_through_impacts():
    # Impacts are located to the order of the step: e = 0.9, three of them.
    p = COLUMN.frequency_parameter
    motion = Motion(0.1 / p, np.zeros(62))
    start = 0.5 * COLUMN.slenderness

    def last(step: float) -> float:
        model = HousnerBlock(initial_rotation=start, time_step=step, restitution=0.9)
        return simulate_many(COLUMN, [motion], model).residual_top_displacement_m[0]

    values = np.array([last(0.1 / p / k) for k in (1, 2, 4, 64)])
    errors = np.abs(values[:3] - values[3])
    assert math.log2(errors[0] / errors[2]) / 2.0 == pytest.approx(4.0, abs=0.6)


def test_verdicts_settle_as_the_step_is_halved():
    motions = [
        harmonic(float(f), float(a) * g, 10.0)
        for f in np.linspace(0.4, 2.0, 24) for a in np.linspace(0.2, 0.6, 24)
    ]  # fmt: skip
    p = COLUMN.frequency_parameter
    fell = [
        simulate_many(COLUMN, motions, HousnerBlock(time_step=share / p)).collapsed.to_numpy()
        for share in (0.01, 0.005, 0.0025)
    ]
    assert 0.1 < fell[2].mean() < 0.9
    # Without located impacts 10–20 % flip.
    assert (fell[0] != fell[1]).mean() < 0.01
    assert (fell[1] != fell[2]).mean() < 0.01
