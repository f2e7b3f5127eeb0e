"""Pushover against closed forms: peak, softening branch, mechanism; both controls; equilibrium of the exact tangent."""

import math
import re

import numpy as np
import pytest
from oracles.quadrilaterals import stack_of_quadrilaterals
from validation.statics import COLUMNS, MULTIPLIERS, tapered

from stylobate.column import Column, Drum, Joint, preset
from stylobate.errors import InputError
from stylobate.models.rigid_block.block_stack import BlockStack
from stylobate.statics.limit import crushing_forces, gravity_forces, horizontal_forces, limit_analysis
from stylobate.statics.pushover import STATES, EquilibriumPath, pushover

JOINT = Joint(5e10, 2.5e10, friction_angle=35.0)


@pytest.mark.parametrize(
    ("column", "multiplier"), list(zip(COLUMNS.values(), MULTIPLIERS, strict=True)), ids=list(COLUMNS)
)
def test_peak_and_zero_of_the_softening_branch_under_arc_length_control(column, multiplier):
    path = pushover(column, control="arc-length")
    assert path.complete, path.stop
    # The joints' elasticity takes 2e-4 off the rigid multiplier at most (the stiffness is 5e10 N/m³).
    assert path.collapse_multiplier == pytest.approx(multiplier, rel=2.5e-4)
    assert path.governing_joint == 1
    # λ(θ) = tan(α − θ): zero where the centroid stands above the corner. The elastic joints above add 1e-4.
    assert -path.rotation_at_zero(1) == pytest.approx(column.slenderness, rel=2e-4)
    behind = slice(path.peak + 5, None)
    expected = np.tan(column.slenderness + path.rotation[behind, 0])
    assert np.allclose(path.multiplier[behind], expected, atol=2e-4)
    # The top's displacement at that rotation: the top turns about the corner.
    turn, half = column.slenderness, column.base_width / 2
    top = half * (1 - math.cos(turn)) + column.height * math.sin(turn)
    assert path.ultimate_displacement == pytest.approx(top, rel=2e-3)


@pytest.mark.parametrize("name", ["paper-monolithic", "paper-12-drums"])
def test_without_geometric_nonlinearity_the_peak_is_a_plateau(name):
    path = pushover(preset(name), geometric=False, to=0.2)
    expected = limit_analysis(preset(name)).multiplier
    assert path.complete
    assert path.displacement[-1] == pytest.approx(0.2, rel=1e-9)
    # Newton stops at about 1e-8 of the weight per block, which is where the joints' stiffness rounds.
    assert path.collapse_multiplier == pytest.approx(expected, abs=5e-7)
    assert path.multiplier[-1] == pytest.approx(expected, abs=5e-7)
    assert math.isnan(path.ultimate_displacement)
    # It begins where the column leaves the elastic branch, long before the end of the path.
    slope = path.multiplier[2] / path.displacement[2]
    assert path.peak_displacement == pytest.approx(expected / slope, rel=1e-2)


def test_the_elastic_branch_has_the_stiffness_of_the_joint():
    # One block on its joint: u_top = λ W (z_C H / k_n J + 1 / k_s A), with a dead load that stays put.
    column = preset("paper-monolithic")
    path = pushover(column, geometric=False, to=0.01)
    weight, second, area = column.joint_weights[0], column.joint_second_moments[0], column.joint_areas[0]
    soft = weight * (column.centroid_height * column.height / (5e10 * second) + 1.0 / (2.5e10 * area))
    elastic = (path.states[:, 0] == STATES.index("elastic")) & (path.multiplier > 0.0)
    assert elastic.sum() > 5
    assert np.allclose(path.displacement[elastic], soft * path.multiplier[elastic], rtol=1e-7)


@pytest.mark.parametrize("drums", [1, 12])
def test_low_friction_slides_on_a_plateau(drums):
    column = tapered(drums).with_joint(friction_angle=8.0)
    path = pushover(column, geometric=False, to=0.02)
    mu = math.tan(math.radians(8.0))
    assert path.collapse_multiplier == pytest.approx(mu, abs=5e-7)
    assert (path.states[-1] == STATES.index("sliding")).any()
    assert path.slip[-1].sum() == pytest.approx(0.02, rel=2e-2)


def test_joint_forces_are_those_of_equilibrium():
    column = preset("paper-12-drums")
    path = pushover(column, geometric=False, to=0.01)
    assert np.allclose(path.compression, column.joint_weights, rtol=1e-7)
    # The part above pushes the joint with λ times its weight; the joint holds it back.
    assert np.allclose(
        path.shear, -path.multiplier[:, None] * column.joint_weights, atol=1e-6 * column.joint_weights[0]
    )


@pytest.mark.parametrize("geometric", [True, False])
def test_the_weak_joint_governs(geometric):
    drums = [Drum(1.0, 1.2, 1.0, 2000.0), Drum(0.7, 0.5, 0.5, 2200.0), Drum(2.0, 0.8, 0.7, 1800.0)]
    column = Column.of_drums(drums, JOINT)
    path = pushover(column, geometric=geometric, to=0.1)
    expected = limit_analysis(column)
    assert path.collapse_multiplier == pytest.approx(expected.multiplier, rel=1e-3)
    assert path.governing_joint == expected.governing_joint == 2
    # The mechanism is that of the limit analysis: to first order with large rotations, else the same.
    assert np.allclose(path.mechanism, expected.mechanism, atol=0.06 if geometric else 1e-3)


@pytest.mark.parametrize(("geometric", "tolerance"), [(True, 3e-4), (False, 5e-6)])
def test_compressive_strength_lowers_the_peak(geometric, tolerance):
    column = preset("paper-12-drums")
    path = pushover(column, geometric=geometric, compressive_strength=3.0e5)
    expected = limit_analysis(column, compressive_strength=3.0e5).multiplier
    assert path.collapse_multiplier == pytest.approx(expected, rel=tolerance)


def test_softer_joints_lower_the_peak():
    # Second order: the peak lies on the softening branch at the rotation at which the joint gives way.
    peaks = []
    for stiffness in (5e10, 5e8, 5e7):
        joint = Joint(stiffness, stiffness / 2, friction_angle=35.0)
        column = Column.tapered(
            height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=joint
        )  # fmt: skip
        peaks.append(pushover(column, to=0.5).collapse_multiplier)
        # M = N d/2 is reached at θ = N d / (2 k_n J); λ there is tan(α − θ) up to second order.
        turn = column.joint_weights[0] * 0.48 / (stiffness * column.joint_second_moments[0])
        assert peaks[-1] == pytest.approx(math.tan(column.slenderness - turn), rel=3e-4)
    assert peaks[0] > peaks[1] > peaks[2]


@pytest.mark.parametrize("stiffness", [1e8, 2e7])
def test_on_soft_joints_the_path_goes_on_until_the_column_gives_way(stiffness):
    # A tenth of the base width is far within the elastic branch here; the multiplier is that of rigid blocks.
    joint = Joint(stiffness, stiffness / 2, friction_angle=35.0)
    column = Column.tapered(
        height=10.0, bottom_width=1.0, top_width=0.8, drums=10, density=2500.0, joint=joint
    )  # fmt: skip
    path = pushover(column, geometric=False)
    assert path.peaked
    assert path.complete
    assert path.collapse_multiplier == pytest.approx(limit_analysis(column).multiplier, abs=5e-7)


@pytest.mark.parametrize("control", ["displacement", "arc-length"])
@pytest.mark.parametrize("geometric", [True, False])
def test_a_path_that_ends_on_the_elastic_branch_has_no_collapse_multiplier(geometric, control):
    column = preset("paper-monolithic")
    path = pushover(column, geometric=geometric, control=control, to=1e-5)
    assert path.complete
    assert not path.peaked
    assert math.isnan(path.collapse_multiplier)
    assert math.isnan(path.peak_displacement)
    assert math.isnan(path.ultimate_displacement)
    # One block on its base: λ rises in proportion to the top's displacement, z_C H/(k_n J) + 1/(k_s A) per W.
    lever = column.centroid_height * column.height / (5e10 * column.joint_second_moments[0])
    soft = column.joint_weights[0] * (lever + 1.0 / (2.5e10 * column.joint_areas[0]))
    assert path.largest_multiplier == pytest.approx(path.displacement[-1] / soft, rel=1e-3 if geometric else 1e-7)
    assert path.largest_multiplier < 0.5 * limit_analysis(column).multiplier


def soft(drums: int, stiffness: float) -> Column:
    joint = Joint(stiffness, stiffness / 2, friction_angle=35.0)
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=joint
    )  # fmt: skip


def stiffness_asked_for(column: Column, **how) -> float:
    with pytest.raises(InputError, match="buckles under its own weight, first of all on joint 1:") as refusal:
        pushover(column, **how)
    return float(re.search(r"needed is more than (\S+) N/m³", str(refusal.value))[1])


@pytest.mark.parametrize("control", ["displacement", "arc-length"])
@pytest.mark.parametrize("share", [0.05, 0.5, 0.99])
def test_a_block_on_a_joint_too_soft_for_its_weight_is_refused(share, control):
    # Stable for k_n J > W z_C: the joint's moment against that of the weight, for a small rotation.
    column = soft(1, 1e9)
    needed = column.joint_weights[0] * column.centroid_height / column.joint_second_moments[0]
    # The search for it ends within 1e-4; the message has four digits.
    assert stiffness_asked_for(soft(1, share * needed), control=control) == pytest.approx(needed, rel=3e-4)
    just = pushover(soft(1, 1.01 * needed), control=control)
    assert just.complete
    # Where the joint has its largest moment the block leans by nearly α: little is left for the forces.
    assert 0.0 < just.collapse_multiplier < 0.01 * column.slenderness


def test_drums_on_soft_joints_are_refused_up_to_the_stiffness_that_is_named():
    needed = stiffness_asked_for(soft(12, 1e6))
    assert stiffness_asked_for(soft(12, 0.99 * needed)) == pytest.approx(needed, rel=3e-4)
    assert pushover(soft(12, 1.01 * needed)).peaked
    # In the undisplaced state nothing buckles.
    assert pushover(soft(12, 1e6), geometric=False).collapse_multiplier == pytest.approx(0.20463, rel=1e-4)


def test_a_path_against_the_forces_ends_as_well():
    # From an unstable equilibrium the top moves to −x; pushover itself refuses to start there.
    stack = BlockStack.of_column(soft(1, 1.9e6))
    path = EquilibriumPath(stack, gravity_forces(stack), horizontal_forces(stack), crushing_forces(stack, None), True)
    result = path.follow("displacement", 0.1)
    assert result.displacement[-1] == pytest.approx(-0.1, rel=1e-9)


def test_a_column_without_friction_is_lost_not_followed_for_ever():
    column = preset("paper-12-drums").with_joint(friction_angle=0.0)
    path = pushover(column, to=0.02)
    assert not path.complete
    assert path.largest_multiplier == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("strength", [None, 3e4])
def test_the_tangent_is_the_derivative_of_the_forces(strength):
    outlines = [
        [[-0.5, 0.0], [0.6, 0.1], [0.5, 1.2], [-0.3, 1.0]],
        [[-0.3, 1.0], [0.5, 1.2], [0.4, 2.0], [-0.3, 2.1]],
    ]
    stack = stack_of_quadrilaterals(outlines, Joint(1e5, 1e5, friction_angle=50.0), density=2000.0)
    limits = crushing_forces(stack, strength)
    path = EquilibriumPath(stack, gravity_forces(stack), horizontal_forces(stack), limits, True)
    seen = set()
    for seed in range(12):
        place = np.random.default_rng(seed).normal(size=(2, 3)) * 0.2 - [[0.0, 0.3, 0.0], [0.0, 0.6, 0.0]]
        path.memory[:] = [0.0, 0.0, 1.0, 0.0]
        path.residual(place, 0.0)
        path.memory[:, :3] = path.after[:, :3] * [0.5, 1.0, 1.0]
        path.residual(place, 0.0)
        exact = path.stiffness.copy()
        seen |= set(path.report[:, 3].astype(int))
        step = 1e-7
        for j in range(6):
            move = step * np.eye(6)[j].reshape(2, 3)
            change = (path.residual(place + move, 0.0) - path.residual(place - move, 0.0)) / (2 * step)
            assert np.allclose(exact[:, j], -change, atol=1e-7 * np.abs(exact).max())
    assert len(seen) >= 3


def test_a_lost_path_says_where_and_keeps_its_curve(monkeypatch):
    monkeypatch.setattr("stylobate.statics.pushover.MAX_ITERATIONS", 1)
    monkeypatch.setattr("stylobate.statics.pushover.MAX_CUTS", 1)
    path = pushover(preset("paper-12-drums"))
    assert not path.complete
    assert path.stop.startswith(f"step {len(path.multiplier)}: ")
    assert len(path.to_frame()) == len(path.multiplier) >= 1


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"to": -0.1}, "control displacement is -0.1"),
        ({"pattern": [1.0] * 11}, "11 values for 12 drums"),
        ({"compressive_strength": 1e4}, "crushes under the column's own weight"),
        ({"control": "force"}, "allowed are displacement, arc-length"),
    ],
)
def test_bad_input_is_one_sentence(change, words):
    with pytest.raises(InputError, match=words):
        pushover(preset("paper-12-drums"), **change)
