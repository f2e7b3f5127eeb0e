"""Normal force, shear and moment of joints, from the motion: what statics and Housner's block say."""

import numpy as np
import pytest

import stylobate as st
from stylobate.column import AsFound
from stylobate.constants import g


def block():
    return st.Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.96, drums=1, density=1600.0, joint=st.Joint(5e10, 2.5e10, 35.0)
    )


def test_a_rocking_block_stands_on_its_corner():
    """Between impacts of Housner's block the resultant passes through the pivot, B/2 from the middle of the face.

    The mean over 2 h of r × F differs from the product of means by O(h²): with h = 5 ms and rates of 1/s by less than 1e-4.
    """
    column = block()
    response = st.simulate(column, st.harmonic(1.0, 0.35 * g, 3.0), st.HousnerBlock(), output_interval=0.005)
    forces, turn = response.joint_forces(), response.rotation[1:-1, 0]
    apart = np.abs(turn) > 0.02  # rad: away from impacts
    assert apart.sum() > 300
    side = -0.5 * np.sign(turn) * column.base_width
    through = side * (np.cos(turn) * forces.normal[:, 0] - np.sin(turn) * forces.shear[:, 0])
    np.testing.assert_allclose(forces.moment[apart, 0], through[apart], rtol=2e-4)


@pytest.mark.parametrize("model", [st.RigidBeam(), st.RigidBlock(), st.DistinctElement2D()])
def test_closed_joints_carry_weight_and_inertia(model):
    """0.02 g at 0.2 Hz, a thirtieth of the lowest frequency: V = Σ m a, M = -Σ m a z, within 1 % of the largest."""
    column = st.preset("paper-12-drums")
    response = st.simulate(column, st.harmonic(0.2, 0.02 * g, 5.0), model, output_interval=0.02, until_end=True)
    forces = response.joint_forces()
    a = np.interp(forces.time, response.time, response.ground_acceleration)
    above = np.triu(np.ones((12, 12)))
    shear = a[:, None] * (above @ column.masses)
    arms = column.centroid_heights - column.joint_heights[:, None]
    moment = -a[:, None] * (above * arms @ column.masses)
    inside = forces.time > 0.5  # s: the start of the sine makes it swing
    for got, static in ((forces.shear, shear), (forces.moment, moment)):
        assert np.abs(got - static)[inside].max() < 0.01 * np.abs(static).max()
    np.testing.assert_allclose(forces.normal, np.broadcast_to(column.joint_weights, forces.normal.shape), rtol=2e-3)


def test_a_leaning_column_stands_on_the_side_it_leans_to():
    """Base out of level by 2 degrees: the weight passes z sin 2° beside the middle, here to the left."""
    column = block().replace(as_found=AsFound(base_tilt=2.0))
    forces = st.simulate(column, st.Motion(0.01, np.zeros(101)), st.DistinctElement2D(), until_end=True).joint_forces()
    np.testing.assert_allclose(forces.normal[:, 0], column.mass * column.gravity, rtol=1e-6)
    lean = column.centroid_height * np.sin(np.deg2rad(2.0))
    np.testing.assert_allclose(forces.eccentricity[:, 0], -lean, rtol=1e-3)  # and the joint gives way a little


def test_forces_of_what_is_no_column_in_the_plane_are_refused():
    response = st.simulate(st.preset("paper-monolithic"), st.harmonic(1.0, 0.1 * g, 0.5), st.DistinctElement3D())
    with pytest.raises(st.InputError, match="forces of joints are known for columns in the plane"):
        response.joint_forces()
