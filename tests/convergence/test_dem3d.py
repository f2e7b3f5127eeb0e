"""Distinct elements in space: order of convergence in the time step, of closed joints that sway in two directions."""

import math
from itertools import pairwise

import numpy as np
import pytest
from validation.space import round_column

from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.motion import Motion

pytestmark = pytest.mark.processor


def top_after(step: float) -> np.ndarray:
    """Where the top of three drums stands after 0.4 s of a push that goes round, too weak to open a joint [m]."""
    column, time = round_column(3, stiffness=5e8), np.arange(401) * 1e-3
    push = 0.02 * 9.81 * np.sin(0.5 * math.pi * np.minimum(time / 0.2, 1.0)) ** 4
    model = DistinctElement3D(time_step=step)
    block = engine_for(model, column).block(RunOptions())
    motion = Motion(1e-3, push * np.cos(20.0 * time), push * np.sin(20.0 * time))
    block.load(0, Case(column, motion))
    while not block.is_over(0):
        block.advance()
    assert block.time(0) == pytest.approx(0.4, abs=1e-12)
    return block.bodies.top(block.records, np.array([0]))[0]


def test_second_order_in_the_time_step():
    """Halving the step quarters the change of the answer."""
    positions = [top_after(step) for step in (5e-4, 2.5e-4, 1.25e-4, 6.25e-5)]
    changes = [float(np.linalg.norm(after - before)) for before, after in pairwise(positions)]
    assert changes[0] > 1e-8
    assert np.log2(np.array(changes[:-1]) / changes[1:]) == pytest.approx(2.0, abs=0.1), changes
