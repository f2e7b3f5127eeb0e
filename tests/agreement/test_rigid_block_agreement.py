"""Rigid blocks: the acceleration that opens them, and verdicts against the distinct elements."""

import numpy as np
import pytest

from stylobate.column import preset
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.models.rigid_block import RigidBlock
from stylobate.motion import Motion, harmonic
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


@pytest.mark.slow
def test_populations_of_rigid_blocks_and_distinct_elements():
    # 12 drums, 1 Hz: verdicts over amplitudes, not one trajectory.
    column = preset("paper-12-drums")
    motions = [harmonic(1.0, a * G, 6.0) for a in np.linspace(0.25, 0.45, 32)]
    tables = [simulate_many(column, motions, model) for model in (RigidBlock(), DistinctElement2D())]
    counts = [int(table.collapsed.sum()) for table in tables]
    assert abs(counts[0] - counts[1]) <= 6
    assert all((table.outcome != "failed").all() for table in tables)
