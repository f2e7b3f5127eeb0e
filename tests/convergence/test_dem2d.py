"""Plane distinct elements: smaller steps change few verdicts, and more contact points converge."""

from itertools import pairwise

import numpy as np
import pytest

from stylobate.column import Column, Joint, preset
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.distinct_element_2d import DistinctElement2D, contact_points
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate, simulate_many

FREQUENCIES = np.linspace(0.4, 1.6, 9)
AMPLITUDES = np.linspace(0.05, 0.6, 16) * g


def collapsed_cells(column, model):
    units = [harmonic(frequency, 1.0, 10.0) for frequency in FREQUENCIES]
    motions = [unit.scaled(amplitude) for unit in units for amplitude in AMPLITUDES]
    return simulate_many(column, motions, model)["collapsed"].to_numpy()


def test_halving_the_step_changes_few_verdicts_of_a_domain():
    column = preset("paper-monolithic")
    cells = [collapsed_cells(column, DistinctElement2D(step_factor=factor)) for factor in (0.4, 0.2, 0.1)]
    counts = [int(one.sum()) for one in cells]
    changed = [int((a != b).sum()) for a, b in pairwise(cells)]
    assert min(counts) > 30
    assert max(changed) <= 0.06 * len(cells[0])
    # cells near the boundary flip either way like coins: the net change stays within two standard deviations
    assert abs(counts[2] - counts[1]) <= 2.0 * np.sqrt(changed[1])


def test_smooth_motion_converges_with_the_square_of_the_step():
    """Before any joint opens or slides the column is a linear oscillator: central differences are of second order."""
    column = preset("paper-monolithic").with_joint(normal_stiffness=1e9, shear_stiffness=5e8, friction_coefficient=50.0)
    motion = harmonic(5.0, 0.02 * g, 0.4)

    def top(factor):
        return simulate(column, motion, DistinctElement2D(step_factor=factor)).top_displacement[-1]

    exact = top(0.005)
    errors = np.array([abs(top(factor) - exact) for factor in (0.4, 0.2, 0.1, 0.05)])
    orders = np.log2(errors[:-1] / errors[1:])
    assert abs(exact) > 1e-6
    assert orders[-1] == pytest.approx(2.0, abs=0.2), (orders, errors, exact)


def static_moment(column, points, turn):
    """Moment of the base joint about its middle for a rotation of the column under constant weight [N m]."""
    from stylobate.models.base import Case, RunOptions
    from stylobate.models.drum_block import DrumBlock

    block = DrumBlock(DistinctElement2D(points=points), 1, RunOptions())
    block.load(0, Case(column, Motion(1.0, np.zeros(2))))
    weight, zc = column.joint_weights[0], column.centroid_height
    low, high = -1e-3, 1.0
    for _ in range(200):  # lift that leaves the weight on the joint
        lift = 0.5 * (low + high)
        block.drum["c"][1, 0], block.drum["s"][1, 0] = np.cos(turn), np.sin(turn)
        block.drum["x"][1, 0], block.drum["z"][1, 0] = -zc * np.sin(turn), zc * np.cos(turn) + lift
        block.joint["fs"][..., 0] = 0.0
        block.kernel.forces(block.drum, block.joint, block.lane)
        low, high = (lift, high) if block.joint["fz"][0, 0] > weight else (low, lift)
    return -block.joint["ml"][0, 0]


def test_more_contact_points_approach_the_elastic_bed():
    """No-tension elastic bed under constant N: closed M = k_n J φ, open M = (N d/2)(1 − (2/3)√(2N/(k_n w d² φ)))."""
    joint = Joint(1e8, 5e7, friction_coefficient=0.7)
    column = Column.tapered(height=3.0, bottom_width=1.0, top_width=1.0, drums=1, density=2000.0, joint=joint)
    weight, stiffness = column.joint_weights[0], 1e8
    closed = 2.0 * weight / stiffness  # decompression for w = d = 1
    for turn, exact in (
        (0.5 * closed, stiffness / 12.0 * 0.5 * closed),
        (4.0 * closed, 0.5 * weight * (1.0 - 2.0 / 3.0 * np.sqrt(0.25))),
        (20.0 * closed, 0.5 * weight * (1.0 - 2.0 / 3.0 * np.sqrt(0.05))),
    ):
        errors = {points: abs(abs(static_moment(column, points, turn)) / exact - 1.0) for points in (3, 8, 32)}
        assert errors[32] < 0.01, (turn, errors)
        assert errors[32] <= errors[3] + 1e-6, (turn, errors)
    two = abs(static_moment(column, 2, 0.3 * closed))
    assert two == pytest.approx(3.0 * stiffness / 12.0 * 0.3 * closed, rel=1e-3)


@pytest.mark.parametrize("points", [2, 3, 4, 5, 9, 20])
def test_contact_points_integrate_the_section(points):
    for section, second in (("rectangular", 1.0 / 3.0), ("circular", 1.0 / 4.0)):
        xi, share = contact_points(section, points)
        assert share.min() > 0.0
        assert share.sum() == pytest.approx(1.0, rel=1e-12)
        assert list(xi[[0, -1]]) == [-1.0, 1.0]
        if points > 2:
            assert share @ xi**2 == pytest.approx(second, rel=1e-12)


def test_largest_stable_step_is_sharp():
    """Just below the limit a closed column stays at rest under a tiny push; just above, it would not."""
    column = preset("paper-12-drums").with_joint(friction_coefficient=1e3)
    model = DistinctElement2D(step_factor=0.999)
    push = Motion(0.001, np.array([0.0, 1e-6, 0.0] + [0.0] * 198))
    response = simulate(column, push, model)
    assert np.abs(response.top_displacement).max() < 1e-8
    stable = model.step_for(column) / 0.999
    with pytest.raises(InputError, match="largest stable"):
        DistinctElement2D(time_step=1.01 * stable).step_for(column)
    # the limit is taken away by hand: beyond it the same push grows without bound
    from stylobate.models.base import Case, RunOptions
    from stylobate.models.drum_block import DrumBlock

    block = DrumBlock(model, column.n, RunOptions())
    block.load(0, Case(column, push))
    block.lane["dt"][0, 0] = block.dt[0] = 1.02 * stable
    block.drum["vx"][-1, 0] = 1e-9
    for _ in range(50):
        block.kernel.forces(block.drum, block.joint, block.lane)
        block.kernel.move(block.drum, block.joint, block.lane, block.ground, 0)
    early = np.abs(block.drum["vx"][:, 0]).max()
    for _ in range(600):
        block.kernel.forces(block.drum, block.joint, block.lane)
        block.kernel.move(block.drum, block.joint, block.lane, block.ground, 0)
    assert np.abs(block.drum["vx"][:, 0]).max() > 100.0 * early
