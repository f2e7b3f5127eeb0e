"""Housner's block: runs find the edges of pulses; uplift; Housner's restitution."""

import math

import numpy as np
import pytest
from oracles.adaptive_block import run_adaptive
from validation import overturning

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.base import Case, RunOptions
from stylobate.models.rocking.lanes import RockingLanes
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion
from stylobate.simulate import simulate, simulate_many

pytestmark = pytest.mark.processor


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
    pulse = overturning.pulse(kind, size, column.frequency_parameter)
    fell = []
    for factor in (0.999, 1.001):
        motion = pulse.scaled(closed(size) * factor * column.slenderness * g)
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


@pytest.mark.parametrize("steps", [1, 7, 100])
def test_a_motion_counts_up_to_its_last_sample(steps):
    # Constant push A for a time T, linearised: θ = (A − α)(cosh pT − 1), and then up to α − √((α − θ)² − (θ̇/p)²).
    width = 5.0 * math.tan(0.16)
    column = Column.of_drums([Drum(5.0, width, width, 1600.0)], Joint(5e10, 2.5e10, friction_coefficient=5.0))
    p, alpha = column.frequency_parameter, column.slenderness
    push, length = 2.0 * alpha, 0.04 * steps**0.5 / p
    motion = Motion(length / steps, np.ones(steps + 1), factor=push * g)
    turned = (push - alpha) * (math.cosh(p * length) - 1.0)
    speed = (push - alpha) * math.sinh(p * length)
    top = alpha - math.sqrt((alpha - turned) ** 2 - speed**2)
    model = HousnerBlock(linear=True)
    block = RockingLanes(model, RunOptions(), False)
    block.load(0, Case(column, motion))
    while not block.is_over(0):
        block.advance()
    assert block.row("V")[0] == pytest.approx(p * speed, rel=1e-6)
    for tail, expected in ((0.0, turned), (1.0 / p, top)):
        single = simulate(column, motion, model, tail=tail)
        batch = simulate_many(column, [motion], model, tail=tail).iloc[0]
        assert batch.peak_rotation_rad == single.peak_rotation  # the largest at the end of a step
        assert single.peak_rotation == pytest.approx(expected, rel=2e-4 if tail else 2e-5)
        assert run_adaptive(model, column, motion, RunOptions(tail=tail))[1].peak_rotation == pytest.approx(
            expected, rel=1e-6
        )
