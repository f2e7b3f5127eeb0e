"""The elastic bed's moment–rotation curve against distinct elements pressed by a constant weight and turned."""

import numpy as np
import pytest
from scipy.optimize import brentq

from stylobate.column import Column, Joint
from stylobate.kernels import moment_law
from stylobate.models.base import Case, RunOptions
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.models.drum_block import DrumBlock
from stylobate.models.rigid_beam import RigidBeam
from stylobate.models.rigid_beam_state import packed
from stylobate.motion import Motion

STILL = Motion(0.1, np.zeros(2))


def column_of(section: str) -> Column:
    joint = Joint(normal_stiffness=1e8, shear_stiffness=5e7)
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=joint, section=section
    )


def dem_moment(column: Column, points: int, phi: float) -> float:
    """Resisting moment about the middle of the base of a drum turned by φ, lowered until it is pressed by its weight."""
    block = DrumBlock(DistinctElement2D(points=points), 1, RunOptions())
    block.load(0, Case(column, STILL))
    height, weight = column.centroid_height, float(column.joint_weights[0])
    drum = block.drum

    def forces(sunk: float) -> np.ndarray:
        drum["th"][1, 0], drum["c"][1, 0], drum["s"][1, 0] = phi, np.cos(phi), np.sin(phi)
        drum["x"][1, 0], drum["z"][1, 0] = -height * np.sin(phi), height * np.cos(phi) - sunk
        joint, lane = block.joint.copy(), block.lane.copy()
        joint["fs"][:] = 0.0
        joint["ks"][:] = 0.0
        block.kernel.forces(drum, joint, lane)
        return np.array([joint[name][0, 0] for name in ("fx", "fz", "mu_")])

    width = column.base_width
    sunk = brentq(lambda s: forces(s)[1] - weight, -width * phi, width * phi + 1e-3, xtol=1e-16)
    fx, fz, moment = forces(sunk)  # on the drum, about its centroid, counter-clockwise
    return -(moment + drum["x"][1, 0] * fz - drum["z"][1, 0] * fx)


@pytest.mark.parametrize("section", ["rectangular", "circular"])
def test_many_contact_points_follow_the_bed(section):
    column = column_of(section)
    beam = packed(RigidBeam(), column)
    ratios = np.array([0.3, 0.9, 1.5, 3.0, 8.0, 25.0])
    for ratio in ratios:
        phi = ratio * beam.opening[0]
        exact = np.empty(1)
        moment_law.moments(np.array([phi]), 1.0, beam.joints, beam.bed, exact)
        assert dem_moment(column, 32, phi) == pytest.approx(exact[0], rel=0.01)


def test_two_points_are_three_times_as_stiff_while_closed():
    column = column_of("rectangular")
    beam = packed(RigidBeam(), column)
    phi = 0.05 * beam.opening[0]
    assert dem_moment(column, 2, phi) / phi == pytest.approx(3.0 * beam.joints[0, 0], rel=1e-3)
    assert dem_moment(column, 3, phi) / phi == pytest.approx(beam.joints[0, 0], rel=1e-3)
