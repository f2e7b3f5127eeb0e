"""Rigid blocks against closed forms of dynamics, Housner's block, and the distinct elements."""

import math

import numpy as np
import pytest

from stylobate.column import Column, Joint, preset
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.models.housner import HousnerBlock
from stylobate.models.rigid_block import RigidBlock
from stylobate.motion import Motion, harmonic
from stylobate.motion.pulses import half_sine_pulse, sine_pulse
from stylobate.simulate import simulate, simulate_many

G = 9.81


def ramp(value: float, duration: float, hold: float) -> Motion:
    time = np.linspace(0.0, duration + hold, 400)
    return Motion(time[1], np.minimum(time / duration, 1.0) * value)


@pytest.mark.parametrize("name", ["paper-monolithic", "paper-12-drums"])
def test_uplift_threshold(name):
    # A slow ramp: the column opens when a passes g d/(2 z_C); the elastic joints swing by a few per mille.
    column = preset(name)
    limit = column.uplift_acceleration
    below = simulate(column, ramp(0.985 * limit, 2.0, 0.2), RigidBlock())
    above = simulate(column, ramp(1.015 * limit, 2.0, 0.2), RigidBlock())
    assert below.outcome.label == "at_rest"
    assert above.peak_joint_opening > 1e-4


def test_slip_threshold_and_newmark_slip():
    # A stocky block under a rectangular pulse A > μ g, of length t: slip = (A − μ g) A t² / (2 μ g) (Newmark 1965).
    mu, a, t = 0.2, 0.4 * G, 0.2
    joint = Joint(1e9, 1e9, friction_coefficient=mu)
    block = Column.tapered(height=0.5, bottom_width=2.0, top_width=2.0, drums=1, density=2000.0, joint=joint)
    dt = 1e-4
    samples = np.zeros(round(1.5 / dt) + 1)
    samples[: round(t / dt)] = a
    slid = simulate(block, Motion(dt, samples), RigidBlock())
    expected = (a - mu * G) * a * t**2 / (2.0 * mu * G)
    assert slid.residual_joint_slip == pytest.approx(expected, rel=2e-2)
    stuck = simulate(block, Motion(dt, samples).scaled(0.95 * mu * G / a), RigidBlock())
    # The joint's shear spring swings to twice its static force under a sudden load: slips, but little.
    assert stuck.residual_joint_slip < 1e-2 * expected


def second_impact(response) -> float:
    """Time of the second change of sign of the first drum's rotation [s]."""
    turn = response.histories.drum_rotation[:, 0]
    big = np.abs(turn) > 2e-4
    sign, time = np.sign(turn[big]), response.histories.time[big]
    changes = time[1:][sign[1:] != sign[:-1]]
    return float(changes[1]) if len(changes) > 1 else math.inf


def test_histories_follow_housner_until_the_first_impact_and_the_distinct_elements_until_the_second():
    column = preset("paper-monolithic").with_joint(friction_coefficient=2.0)
    motion = sine_pulse(0.8, 0.3 * G, 4.0)
    found = {
        model.name: simulate(column, motion, model, output_interval=0.005)
        for model in (RigidBlock(), DistinctElement2D(), HousnerBlock())
    }
    time = np.linspace(0.0, 4.0, 801)
    turns = {name: np.interp(time, r.histories.time, r.histories.drum_rotation[:, 0]) for name, r in found.items()}
    first = time[1:][np.diff(np.sign(turns["housner"])) != 0]
    first = first[first > 0.3][0]
    size = np.abs(turns["housner"][time < first]).max()
    until = time < first
    for other in ("housner", "dem2d"):
        assert np.abs(turns["rigid-block"] - turns[other])[until].max() < 0.02 * size
    second = time < min(second_impact(found["rigid-block"]), second_impact(found["dem2d"]))
    assert second.sum() > until.sum()
    assert np.abs(turns["rigid-block"] - turns["dem2d"])[second].max() < 0.25 * np.abs(turns["dem2d"][second]).max()


def test_overturning_pulse_of_the_monolith_is_housners():
    # Half-sine at ω/p = 4 without impact before overturning: Housner's block and the rigid block agree on the boundary.
    column = preset("paper-monolithic").with_joint(friction_coefficient=2.0)
    frequency = 4.0 * column.frequency_parameter / (2.0 * math.pi)
    grid = np.linspace(0.45, 0.75, 31) * G
    motions = [half_sine_pulse(frequency, a, 6.0) for a in grid]
    first = {}
    for model in (RigidBlock(), HousnerBlock()):
        table = simulate_many(column, motions, model, tail=6.0)
        first[model.name] = grid[table.collapsed.to_numpy()][0]
    assert first["rigid-block"] == pytest.approx(first["housner"], rel=0.03)


@pytest.mark.slow
def test_populations_of_rigid_blocks_and_distinct_elements():
    # 12 drums, 1 Hz: medians and verdicts over amplitudes, not one trajectory.
    column = preset("paper-12-drums")
    motions = [harmonic(1.0, a * G, 6.0) for a in np.linspace(0.25, 0.45, 32)]
    tables = [simulate_many(column, motions, model) for model in (RigidBlock(), DistinctElement2D())]
    medians = [float(table.peak_top_displacement_m.median()) for table in tables]
    assert medians[0] == pytest.approx(medians[1], rel=0.15)
    counts = [int(table.collapsed.sum()) for table in tables]
    assert abs(counts[0] - counts[1]) <= 6
    assert all((table.outcome != "failed").all() for table in tables)
