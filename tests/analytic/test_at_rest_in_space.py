"""Stones in space that bear their load lie still: on slopes, under pushes that last, and below their uplift."""

import numpy as np
import pytest

import stylobate as st
from stylobate.errors import OutOfRangeWarning
from stylobate.models.shared import ledger

JOINT = st.Joint(5e9, 2.5e9, friction_coefficient=0.7)


def block_on_slope(degrees):
    """A block of b/h = 0.5 on a wedge: it overturns at 26.57°, and would slide at 35°."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    corners = np.array([(x, y, z) for x in (-0.25, 0.25) for y in (-0.25, 0.25) for z in (0.0, 1.0)])
    wedge = np.array([(x, y, z) for x in (-0.6, 0.6) for y in (-0.5, 0.5) for z in (-1.0, 0.0)])
    stones = [
        st.Stone.hull(wedge @ turn.T + (0.0, 0.0, 2.0), 2500.0, name="wedge", fixed=True),
        st.Stone.hull(corners @ turn.T + (0.0, 0.0, 2.0), 2500.0, name="block"),
    ]
    return st.SpatialAssembly(tuple(stones), JOINT, name="slope")


@pytest.mark.parametrize("degrees", [19.3, 24.2])
def test_a_block_on_a_slope_that_it_bears_lies_still(degrees):
    """Nothing shakes it: it moves by less than a thousandth of a millimetre in eight seconds (157 mm and a fall once)."""
    response = st.simulate(block_on_slope(degrees), st.Motion(0.1, np.zeros(81)), st.DistinctElement3D())
    assert response.outcome.label == "at_rest"
    assert response.measures.blocks.in_equilibrium
    assert response.measures.blocks.residual_displacement < 1e-6


def test_a_block_on_a_slope_that_it_does_not_bear_says_so_and_falls():
    with pytest.warns(OutOfRangeWarning, match="not in equilibrium"):
        response = st.simulate(block_on_slope(27.5), st.Motion(0.1, np.zeros(81)), st.DistinctElement3D())
    assert response.collapsed


def test_a_push_that_lasts_below_what_a_block_bears_leaves_it_where_it_is():
    """0.45 g of 0.5 g for eight seconds, with a seed across: it leans by the elasticity of its joint, and does not creep."""
    time = np.arange(0.0, 9.0, 0.01)
    push = 0.45 * st.g * np.minimum(time / 1.5, 1.0)
    seed = 1e-6 * st.g * np.sin(2.0 * np.pi * 3.0 * time) * (time < 1.0)
    box = st.Stone.box((0.5, 0.5, 1.0), (0.0, 0.0, 0.0), 2500.0, name="box")
    scene = st.SpatialAssembly((box,), JOINT, name="box")
    response = st.simulate(scene, st.Motion(0.01, push, seed), st.DistinctElement3D())
    late = response.time > 3.0
    place = response.body_position[late, -1]
    assert np.abs(place - place[0]).max() < 2e-5


def lasting(push, azimuth):
    """A push of so many g towards an azimuth [rad], slowly raised in two seconds, and held for five."""
    time = np.arange(0.0, 7.0, 0.01)
    raised = np.minimum(time / 2.0, 1.0)
    raised = -push * st.g * raised * raised * (3.0 - 2.0 * raised)
    return st.Motion(0.01, raised * np.cos(azimuth), lateral=raised * np.sin(azimuth))


def creep(response):
    """Way from the fourth second to the seventh, means over both, while the push lasts [m]."""
    time, place = response.time, response.body_position
    first, last = (place[(time > low) & (time < low + 0.9)].mean(axis=0) for low in (3.0, 6.0))
    return np.abs(last - first).max()


@pytest.mark.parametrize("losses", ["none", "stone"])
@pytest.mark.parametrize(("share", "degrees"), [(0.88, 200.0), (0.95, 225.0)])
def test_a_push_askew_that_lasts_moves_no_box_whose_edge_has_opened(share, degrees, losses):
    """A box that slides at 0.7 g and tips beyond: its corner opens far below. Node by node it stands at 0.97 of it."""
    box = st.Stone.box((0.745, 0.622, 0.966), (0.0, 0.0, 0.0), 2500.0, name="box")
    scene = st.SpatialAssembly((box,), JOINT, name="box")
    push = lasting(share * 0.69, np.radians(degrees))
    response = st.simulate(scene, push, st.DistinctElement3D(losses=losses))
    assert creep(response) < 1e-6


@pytest.mark.parametrize("law", ["rim", "bed"])
@pytest.mark.parametrize("drums", [1, 4])
def test_a_push_that_lasts_moves_no_round_column_that_bears_it(law, drums):
    """0.88 of what overturns it as a rigid body, 6 % below what it bears on joints of this stiffness (bed)."""
    part = st.Drum(1.2 / drums, 0.6, 0.6, 2500.0, section="circular")
    column = st.Column.of_drums([part] * drums, st.Joint(5e10, 2.5e10, friction_coefficient=0.7))
    response = st.simulate(column, lasting(0.44, 0.5), st.DistinctElement3D(law=law), until_end=True)
    assert creep(response) < 1e-6


def test_nothing_has_rocked_that_is_pressed_all_along():
    """A block of b/h = 1/4 at 0.05 g: its edge rises by a third of what its weight has pressed it."""
    box = st.Stone.box((0.5, 0.5, 2.0), (0.0, 0.0, 0.0), 2500.0, name="box")
    scene = st.SpatialAssembly((box,), JOINT, name="box")
    response = st.simulate(scene, st.harmonic(1.0, 0.05 * st.g, 1.0), st.DistinctElement3D())
    assert response.measures.peak_joint_opening == 0.0
    assert response.outcome.label == "at_rest"


def test_what_begins_to_move_by_itself_has_no_verdict():
    time = np.arange(0.0, 4.0, 0.1)
    still, shaken = np.zeros((40, 3)), np.zeros((40, 3))
    shaken[20:, 0] = np.sin(time[20:])
    way = np.where(time < 2.0, 1e-3, 5.0)  # at rest, and then five times what its joints store
    assert ledger.set_off_by_itself(time, still, way, 1.0)
    assert not ledger.set_off_by_itself(time, shaken, way, 1.0)
    pushed = np.zeros((40, 3))
    pushed[1:, 0] = 3.0  # all of it from the first instant on
    assert not ledger.set_off_by_itself(time, pushed, np.where(time < 0.05, 0.0, 5.0), 1.0)
    pushed[1:, 0] = 3.0
    assert ledger.set_off_by_itself(time, pushed, way, 1.0)  # at rest under the push, and then not
