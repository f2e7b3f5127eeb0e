"""Verdicts of the sliding rigid beam against those of the distinct elements, where a drum slides off."""

import numpy as np
import pytest

from stylobate.column import Column, Joint
from stylobate.constants import g
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.models.rigid_beam import RigidBeam
from stylobate.motion import Motion
from stylobate.outcome import Outcome
from stylobate.simulate import simulate

ROUGH, SMOOTH = (Joint(5e9, 2.5e9, friction_coefficient=mu) for mu in (0.7, 0.05))
COLUMN = Column.tapered(
    height=4.0, bottom_width=1.0, top_width=1.0, drums=4, density=2000.0, joint=ROUGH, overrides={4: SMOOTH}
)


@pytest.mark.parametrize(("push", "expected"), [(0.08, Outcome.DISPLACED), (0.12, Outcome.COLLAPSED)])
@pytest.mark.parametrize("solver", ["fixed", "adaptive"])
def test_a_drum_that_slides_over_the_edge_comes_down(push, expected, solver):
    # The base goes off under the top drum: 0.25 m of slip at 0.08 g, 0.85 m of the 1 m wide joint at 0.12 g.
    motion = Motion(0.005, np.full(201, push * g))
    beam = simulate(COLUMN, motion, RigidBeam(sliding=True, solver=solver), tail=2.0)
    drums = simulate(COLUMN, motion, DistinctElement2D(), tail=2.0)
    assert beam.outcome is drums.outcome is expected
    assert beam.decided
    assert drums.decided
    if expected is Outcome.COLLAPSED:
        assert "drum 4" in beam.measures.reason


def test_a_drum_without_contact_is_lost_while_the_motion_goes_on():
    motion = Motion(0.005, np.full(601, 0.12 * g))
    found = simulate(COLUMN, motion, RigidBeam(sliding=True))
    assert found.outcome is Outcome.COLLAPSED
    assert found.decided
    assert found.collapse_time < motion.duration
