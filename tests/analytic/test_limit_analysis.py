"""Limit analysis: mechanisms, weak joints, load patterns, quadrilaterals, refused input."""

import math

import numpy as np
import pytest
from oracles.quadrilaterals import stack_of_quadrilaterals
from validation.statics import inclined

from stylobate.column import Column, Drum, Joint, preset
from stylobate.column.as_found import AsFound
from stylobate.column.found_geometry import gravity_vector
from stylobate.errors import InputError
from stylobate.models.rigid_block.block_stack import BlockStack
from stylobate.statics.limit import gravity_forces, limit_analysis
from stylobate.statics.pushover import pushover

JOINT = Joint(5e10, 2.5e10, friction_angle=35.0)


def overturning(column: Column) -> tuple[float, int]:
    """Smallest half width over height of the centroid above the joint, over all joints."""
    values = column.joint_uplift_accelerations / column.gravity
    return float(values.min()), int(values.argmin()) + 1


@pytest.mark.parametrize("flow", ["associated", "non-associated"])
@pytest.mark.parametrize("name", ["paper-monolithic", "paper-12-drums"])
def test_the_mechanism_of_overturning_is_a_rigid_rotation_about_the_corner(name, flow):
    column = preset(name)
    limit = limit_analysis(column, flow=flow)
    joint = overturning(column)[1]
    assert [(item.joint, item.mode) for item in limit.active] == [(joint, "rocking right")]
    # A rigid rotation about the right corner: ẋ = z θ̇, ż = −(x − d/2) θ̇.
    turn = -limit.mechanism[:, 2]
    assert np.allclose(limit.mechanism[:, 0], turn * column.centroid_heights)
    assert np.allclose(limit.mechanism[:, 1], turn * column.base_width / 2)


@pytest.mark.parametrize("name", ["paper-monolithic", "paper-12-drums"])
def test_low_friction_changes_the_mechanism_to_sliding_at_tan_phi(name):
    column = preset(name).with_joint(friction_angle=8.0)
    mu = math.tan(math.radians(8.0))
    for flow, dilatancy in (("non-associated", 0.0), ("associated", mu)):
        limit = limit_analysis(column, flow=flow)
        assert limit.lower == pytest.approx(mu, rel=1e-9)
        assert limit.upper == pytest.approx(mu, rel=1e-9)
        assert {item.mode for item in limit.active} == {"sliding right"}
        # Every joint reaches its friction at once, and the flow rule decides how the mechanism lifts.
        assert limit.at_limit == tuple(range(1, column.n + 1))
        moving = limit.mechanism[-1]
        assert moving[1] == pytest.approx(dilatancy * moving[0], abs=1e-9)


def test_one_slippery_joint_governs():
    column = Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=6, density=1600.0, joint=JOINT,
        overrides={4: Joint(5e10, 2.5e10, friction_angle=6.0)},
    )  # fmt: skip
    limit = limit_analysis(column)
    assert limit.multiplier == pytest.approx(math.tan(math.radians(6.0)), rel=1e-9)
    assert limit.at_limit == (4,)
    assert np.allclose(limit.mechanism[:3], 0.0, atol=1e-12)
    assert np.allclose(limit.mechanism[3:, 0], 1.0)


def test_unequal_drums_rock_about_the_narrow_neck():
    drums = [Drum(1.0, 1.2, 1.0, 2000.0), Drum(0.7, 0.5, 0.6, 2200.0), Drum(2.0, 0.8, 0.7, 1800.0)]
    column = Column.of_drums(drums, JOINT)
    expected, joint = overturning(column)
    limit = limit_analysis(column)
    assert joint == 2
    assert limit.multiplier == pytest.approx(expected, rel=1e-9)
    assert limit.governing_joint == joint


def test_a_load_pattern_moves_the_resultant():
    column = preset("paper-12-drums")
    share = column.masses * column.centroid_heights
    limit = limit_analysis(column, pattern=share)
    force = share / share.sum() * column.joint_weights[0]
    limits = [
        column.joint_weights[i]
        * column.joint_widths[i]
        / 2
        / float(force[i:] @ (column.centroid_heights[i:] - column.joint_heights[i]))
        for i in range(column.n)
    ]
    assert limit.multiplier == pytest.approx(min(limits), rel=1e-9)
    assert limit.governing_joint == int(np.argmin(limits)) + 1


def test_quadrilaterals_equal_the_column_and_may_lean():
    column = preset("paper-12-drums")
    outlines = BlockStack.of_column(column).outlines
    stack = stack_of_quadrilaterals(outlines, column.joints[0], density=1600.0)
    assert np.allclose(stack.inertia, column.inertias, rtol=1e-12)
    assert np.allclose(stack.centroid[:, 1], column.centroid_heights, rtol=1e-12)
    assert limit_analysis(stack).multiplier == pytest.approx(limit_analysis(column).multiplier, rel=1e-12)
    # A parallelogram: its centroid stands off the middle by half the lean.
    lean = np.array([[[-0.5, 0.0], [0.5, 0.0], [0.7, 4.0], [-0.3, 4.0]]])
    limit = limit_analysis(stack_of_quadrilaterals(lean, JOINT, density=2000.0))
    assert limit.multiplier == pytest.approx((0.5 - 0.1) / 2.0, rel=1e-9)


def test_the_forces_push_to_the_right_and_the_mirrored_stack_is_the_other_direction():
    lean = np.array([[[-0.5, 0.0], [0.5, 0.0], [0.7, 4.0], [-0.3, 4.0]]])
    mirrored = lean[:, [1, 0, 3, 2]] * [-1.0, 1.0]
    for outlines, to_the_edge in ((lean, 0.4), (mirrored, 0.6)):
        stack = stack_of_quadrilaterals(outlines, JOINT, density=2000.0)
        assert limit_analysis(stack).multiplier == pytest.approx(to_the_edge / 2.0, rel=1e-9)
        assert pushover(stack).collapse_multiplier == pytest.approx(to_the_edge / 2.0, rel=1e-3)


@pytest.mark.parametrize("degrees", [3.0, -3.0])
def test_the_tilt_is_downhill_to_the_right_and_the_slope_as_found_is_not(degrees):
    column, turn = preset("paper-monolithic"), math.radians(degrees)
    # With the forces along the base: cos τ tan α − sin τ, less downhill, more uphill.
    expected = math.cos(turn) * math.tan(column.slenderness) - math.sin(turn)
    assert limit_analysis(column, base_tilt=degrees).multiplier == pytest.approx(expected, rel=1e-9)
    assert pushover(column, base_tilt=degrees).collapse_multiplier == pytest.approx(expected, rel=1e-3)
    tilted_column = column.replace(as_found=AsFound(base_tilt=degrees))
    weight = gravity_forces(BlockStack.of_column(column), -degrees).sum(axis=0)
    assert np.allclose(weight[:2], column.mass * gravity_vector(tilted_column), rtol=1e-12)


def test_an_inclined_joint_is_the_one_at_its_limit():
    assert limit_analysis(inclined()).at_limit == (2,)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"compressive_strength": 3.0e4}, "crushes under the column's own weight"),
        ({"pattern": [1.0, 1.0]}, "2 values for 12 drums"),
        ({"pattern": [-1.0] * 12}, "positive sum"),
        ({"base_tilt": 40.0}, "lower the tilt"),
        ({"flow": "plastic"}, "allowed are"),
    ],
)
def test_bad_input_is_one_sentence(change, words):
    with pytest.raises(InputError, match=words):
        limit_analysis(preset("paper-12-drums"), **change)


def test_no_friction_on_a_tilted_base():
    with pytest.raises(InputError, match="slides under the column's own weight"):
        limit_analysis(preset("paper-12-drums").with_joint(friction_angle=0.0), base_tilt=1.0)
