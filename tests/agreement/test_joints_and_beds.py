"""Joints and beds of the same faces: blocks may be drawn, numbered and supported in any way, what they do is the same."""

import math
import warnings

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly import Assembly, Block
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.plane.loose import Loose
from stylobate.simulate import simulate

JOINT = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
TALL = ((-0.5, 0.0), (0.5, 0.0), (0.5, 2.4), (-0.5, 2.4))
#: The same outline with corners in the middle of its sides.
SPLIT = ((-0.5, 0.0), (-0.1, 0.0), (0.1, 0.0), (0.5, 0.0), (0.5, 1.0), (0.5, 2.4), (-0.5, 2.4))
#: Its lower edges worn away under 22°.
WORN = ((-0.4, 0.0), (0.4, 0.0), (0.5, 0.04), (0.5, 2.4), (-0.5, 2.4), (-0.5, 0.04))


def still(duration):
    return st.Motion(duration, np.zeros(2))


def turned(corners, degrees):
    angle = math.radians(degrees)
    c, s = math.cos(angle), math.sin(angle)
    points = np.asarray(corners) @ np.array([[c, s], [-s, c]])
    return tuple((float(x), float(z)) for x, z in points)


def slope(degrees):
    return Block(turned(((-20.0, -1.0), (20.0, -1.0), (20.0, 0.0), (-20.0, 0.0)), degrees), 0.0, "slope", fixed=True)


def test_a_side_with_corners_in_it_is_one_side():
    push = st.harmonic(1.0, 0.6 * st.g, 2.0)
    whole, split = (
        simulate(Assembly((Block(corners, 2000.0, "block"),), JOINT), push, DistinctElement2D())
        for corners in (TALL, SPLIT)
    )
    assert len(split.assembly.blocks[0].vertices) == 4
    assert np.abs(whole.rotation).max() > 0.01
    np.testing.assert_allclose(split.rotation, whole.rotation, atol=1e-12)


def test_a_worn_edge_does_not_sink_in():
    """The joint of the face hands over before the worn edge comes down on the ground."""
    push = st.harmonic(0.7, 0.4 * st.g, 3.0)
    response = simulate(Assembly((Block(WORN, 2000.0, "block"),), JOINT), push, DistinctElement2D())
    assert str(response.outcome) != "failed"
    assert np.abs(response.rotation).max() > math.radians(22.0)
    lowest = min(response.outline(i, 1)[:, 1].min() for i in range(len(response.time)))
    assert (
        lowest > -0.1 * 0.04
    )  # a tenth of the worn edge; a joint that knew its own face alone would let it sink in whole


@pytest.mark.parametrize(("sides", "degrees"), [(8, 30.0), (12, 20.0), (16, 15.0)])
def test_a_polygon_rolls_on_its_faces(sides, degrees):
    """Its centroid stays between the inner and the outer circle over the slope, and no corner enters it."""
    angles = -0.5 * math.pi - math.pi / sides + np.arange(sides) * 2.0 * math.pi / sides
    polygon = 0.5 * np.stack((np.cos(angles), np.sin(angles)), axis=1)
    polygon[:, 1] -= polygon[:, 1].min()
    blocks = (slope(degrees), Block(turned(polygon, degrees), 2000.0, "polygon"))
    with pytest.warns(st.OutOfRangeWarning, match="not in equilibrium"):
        response = simulate(Assembly(blocks, JOINT, ground=None), still(1.0), DistinctElement2D())
    assert str(response.outcome) != "failed"
    assert abs(response.rotation[-1, 1]) > 4.0 * math.pi / sides  # over two of its faces at least
    level = np.array([turned(response.outline(i, 1), -degrees) for i in range(len(response.time))])
    assert level[:, :, 1].min() > -3e-3
    height = level[:, :, 1].mean(axis=1)
    assert height.min() > 0.5 * math.cos(math.pi / sides) - 3e-3


@pytest.mark.parametrize("gap", [0.0, 1e-4])
def test_the_law_between_two_blocks_holds_for_joint_and_bed(gap):
    """A slippery pair by name on a rough slope, drawn touching or a tenth of a millimetre above it: Newton's slide."""
    slippery = st.Joint(5e10, 2.5e10, friction_coefficient=0.02)
    box = np.array(((-0.5, gap), (0.5, gap), (0.5, 0.6 + gap), (-0.5, 0.6 + gap)))
    blocks = (slope(10.0), Block(turned(box, 10.0), 2000.0, "box"))
    duration = 1.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.OutOfRangeWarning)  # it slides from the start, or touches nothing yet
        assembly = Assembly(blocks, JOINT, ground=None, overrides=(("slope", "box", slippery),))
        response = simulate(assembly, still(duration), DistinctElement2D(stiffness_damping=1e-5))
    angle = math.radians(10.0)
    expected = 0.5 * st.g * (math.sin(angle) - 0.02 * math.cos(angle)) * duration**2
    way = math.hypot(response.x[-1, 1] - response.x[0, 1], response.z[-1, 1] - response.z[0, 1])
    assert way == pytest.approx(expected, rel=2e-3)


@pytest.mark.filterwarnings("ignore:block .* touches nothing")
def test_what_may_touch_soon_does_not_depend_on_the_numbers():
    beam = Block(((-2.0, 0.0), (2.0, 0.0), (2.0, 0.4), (-2.0, 0.4)), 2000.0, "beam")
    stone = Block(((1.5, 0.7), (2.5, 0.7), (2.5, 1.7), (1.5, 1.7)), 2000.0, "stone")
    for blocks in ((beam, stone), (stone, beam)):
        engine = Loose(Assembly(blocks, JOINT, ground=None), DistinctElement2D(), still(0.2), 0.2)
        engine.start(1e-4)
        engine.records.body["w"][[block.name for block in blocks].index("beam")] = 3.0  # up to the stone in 0.05 s
        assert engine.may_come_loose(0.08)
        assert not engine.may_come_loose(0.005)


@pytest.mark.filterwarnings("ignore:block .* touches nothing", "ignore:.*not in equilibrium")
def test_a_slab_too_soft_for_what_falls_on_it_is_said():
    soft = st.Joint(1e8, 5e7, friction_coefficient=0.7)
    slab = Block(((-1.5, 1.98), (1.5, 1.98), (1.5, 2.0), (-1.5, 2.0)), 2500.0, "slab", fixed=False)
    corner_down = tuple((x, z + 6.0) for x, z in turned(((-0.75, 0.0), (0.75, 0.0), (0.75, 1.5), (-0.75, 1.5)), 45.0))
    heavy = Block(corner_down, 2500.0, "heavy")
    with pytest.warns(st.OutOfRangeWarning, match="'slab' is 20 mm thick"):
        response = simulate(Assembly((slab, heavy), soft), still(1.5), DistinctElement2D(restitution=0.3))
    assert response.provenance["deepest_penetration_m"] > 0.004
