"""Housner's block: single runs find the edges of the pulses that the batch finds; uplift; Housner's restitution."""

import math

import numpy as np
import pytest
from validation import overturning

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.housner import HousnerBlock
from stylobate.motion import Motion
from stylobate.simulate import simulate


@pytest.mark.parametrize(
    ("kind", "size", "closed"),
    [
        ("constant", 0.5, overturning.constant),
        ("half sine", 2.0, overturning.half_sine),
        ("one sine", 2.0, overturning.one_sine),
        ("one cosine", 1.0, overturning.one_cosine),
    ],
)
def test_single_runs_find_the_edge_of_a_pulse(kind, size, closed):
    width = 5.0 * math.tan(0.16)
    joint = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=5.0)
    column = Column.of_drums([Drum(5.0, width, width, 1600.0)], joint)
    one = overturning.pulse(kind, size, column.frequency_parameter)
    fell = []
    for factor in (0.999, 1.001):
        motion = one.scaled(closed(size) * factor * column.slenderness * g)
        response = simulate(column, motion, HousnerBlock(linear=True, restitution=0.0), tail=4.0)
        # without impact the block falls on the side it rose to first: −x, counter-clockwise positive
        fell.append(bool(response.collapsed and response.drum_rotation[-1, 0] > column.slenderness))
    assert fell == [False, True]


def test_loss_at_an_impact_with_housners_restitution():
    column = preset("paper-monolithic")
    model = HousnerBlock(initial_rotation=0.5 * column.slenderness)
    response = simulate(column, Motion(0.12, np.zeros(11)), model, output_interval=0.01)
    fallen = model.block(column).inertia * model.block(column).potential(0.5 * column.slenderness)
    # upright, to the recording's grid
    assert -response.energy["gravitational"].min() == pytest.approx(fallen, rel=2e-2)
    assert response.energy["impact"][-1] == pytest.approx((1 - column.restitution**2) * fallen, rel=1e-7)


def test_uplift_threshold():
    # |a_g| cos α > (g + a_v) sin α
    column = preset("paper-monolithic")
    limit = g * math.tan(column.slenderness)
    for factor, moved in ((0.9999, False), (1.0001, True)):
        motion = Motion(1.5e-3, np.sin(np.linspace(0, 6, 2001)), factor=limit * factor)
        assert (simulate(column, motion, HousnerBlock()).peak_rotation > 0.0) == moved
    lighter = Motion(1.5e-3, np.sin(np.linspace(0, 6, 2001)), vertical=np.full(2001, -0.2 * g / limit), factor=limit)
    for factor, moved in ((0.9999, False), (1.0001, True)):
        scaled = lighter.replace(acceleration=0.8 * factor * lighter.samples)
        assert (simulate(column, scaled, HousnerBlock()).peak_rotation > 0.0) == moved
