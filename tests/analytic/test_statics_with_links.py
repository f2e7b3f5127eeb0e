"""Limit analysis and pushover with dowels, bars, ties and cores: multipliers by hand."""

import json
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.analysis.limit import limit_analysis
from stylobate.analysis.pushover import pushover
from stylobate.cli.main import call
from stylobate.column.files import write_column

ROUGH = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
SMOOTH = st.Joint(5e10, 2.5e10, friction_coefficient=0.1)
BLOCK = st.Column.of_drums([st.Drum(4.0, 1.0, 1.0, 2500.0)], ROUGH, name="block")
WEIGHT = BLOCK.mass * BLOCK.gravity


def with_links(column, *links):
    return column.replace(links=links)


@pytest.mark.parametrize("slack", [0.0, 0.002])
def test_a_dowelled_block_slides_at_friction_and_capacity_after_its_slack(slack):
    dowel = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=5e3, clearance=slack)
    column = with_links(st.Column.of_drums(BLOCK.drums, SMOOTH), dowel)
    expected = 0.1 + 5e3 / WEIGHT
    found = limit_analysis(column)
    assert (found.lower, found.upper) == pytest.approx((expected, expected), rel=1e-9)
    assert [(one.force, one.yields) for one in found.links] == [(pytest.approx(5e3), True)]
    path = pushover(column, to=0.01)
    assert path.collapse_multiplier == pytest.approx(expected, rel=1e-6)
    # before the slack is used up friction holds alone
    within = (path.slip[:, 0] > 0.0) & (path.displacement < 0.9 * slack)
    assert np.allclose(path.multiplier[within], 0.1, rtol=1e-6)
    assert within.any() == (slack > 0.0)


@pytest.mark.parametrize(("at", "arm"), [((-0.55, 0.0), 1.05), ((0.55, 0.0), None)])
def test_a_tied_block_overturns_by_hand(at, arm):
    tie = st.Tie(at=at, axial_stiffness=1e8, axial_capacity=3e4, to_height=4.0)
    column = with_links(BLOCK, tie)
    # W b + T (b + x) about the right corner; a tie on the side towards which it turns goes slack
    expected = (WEIGHT * 0.5 + (3e4 * arm if arm else 0.0)) / (WEIGHT * 2.0)
    found = limit_analysis(column)
    assert found.multiplier == pytest.approx(expected, rel=1e-9)
    assert found.links[0].yields is bool(arm)
    path = pushover(column)
    assert path.collapse_multiplier == pytest.approx(expected, rel=2e-3)
    assert path.link_force[path.peak, 0] == pytest.approx(3e4 if arm else 0.0, abs=1.0)
    # pushed to the other side the two change places
    other = limit_analysis(column, direction=180.0)
    mirrored = limit_analysis(with_links(BLOCK, st.Tie(at=(-at[0], 0.0), axial_stiffness=1e8, axial_capacity=3e4)))
    assert other.multiplier == pytest.approx(mirrored.multiplier, rel=1e-9)


def test_an_elastic_tie_by_hand():
    # turned by θ about its right corner (rigid joint): λ W z = W (b c − z s) + T (2 b c …): first order in T = k 2 b θ
    tie = st.Tie(at=(-0.5, 0.0), axial_stiffness=1e6, to_height=4.0)
    path = pushover(with_links(BLOCK, tie), to=0.2)
    turn = -path.rotation[-1, 0]
    c, s = math.cos(turn), math.sin(turn)
    # corner at the origin: tie from (−1, 0) to R(−θ)(−1, 4) = (−c + 4 s, s + 4 c)
    end = np.array([-c + 4.0 * s, s + 4.0 * c])
    line = end - (-1.0, 0.0)
    length = float(np.hypot(*line))
    pull = 1e6 * (length - 4.0)
    # moment of the tie about the corner, against the push λ W at the centroid R(−θ)(−0.5, 2)
    moment = pull * abs(float(line[0] * end[1] - line[1] * end[0])) / length
    expected = (WEIGHT * (0.5 * c - 2.0 * s) + moment) / (WEIGHT * (0.5 * s + 2.0 * c))
    assert path.multiplier[-1] == pytest.approx(expected, rel=2e-3)
    assert path.link_force[-1, 0] == pytest.approx(pull, rel=2e-3)


def test_a_core_and_a_bar_hold_at_their_capacity_in_the_joint_that_gives_way():
    column = st.preset("paper-12-drums")
    weight = column.joint_weights[0]
    core = with_links(column, st.Core(axial_stiffness=1e8, axial_capacity=5e4, pretension=2e4))
    half, z = 0.5 * column.base_width, column.centroid_height
    expected = (weight * half + 5e4 * half) / (weight * z)
    found = limit_analysis(core)
    assert found.multiplier == pytest.approx(expected, rel=1e-9)  # pretension makes no difference to a plastic core
    # a bar in the base alone moves the hinge up to the next joint that is weaker
    barred = with_links(column, st.Bar(joint=1, shear_stiffness=1e9, axial_stiffness=1e9, axial_capacity=1e6))
    assert limit_analysis(barred).governing_joint == 2
    assert limit_analysis(barred).multiplier == pytest.approx(column.joint_uplift_accelerations[1] / column.gravity)


def test_a_layer_lowers_the_friction_and_a_spring_without_capacity_is_no_strength():
    layer = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5)
    assert limit_analysis(with_links(BLOCK, layer)).multiplier == pytest.approx(0.08, rel=1e-9)
    held = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5, shear_capacity=4e3)
    assert limit_analysis(with_links(BLOCK, held)).multiplier == pytest.approx(0.08 + 4e3 / WEIGHT, rel=1e-9)


def test_a_brittle_dowel_is_gone_after_its_capacity():
    dowel = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=5e3, failure="brittle")
    path = pushover(with_links(st.Column.of_drums(BLOCK.drums, SMOOTH), dowel), to=0.01)
    assert path.largest_multiplier == pytest.approx(0.1 + 5e3 / WEIGHT, rel=1e-2)


def test_what_bears_any_push_is_refused_in_one_sentence(tmp_path, capsys):
    endless = with_links(BLOCK.with_joint(cohesion=1e6), st.Core(axial_stiffness=1e8))
    with pytest.raises(st.InputError, match="bears any push, because core from the base to drum 1 has no capacity"):
        limit_analysis(endless)
    tied = with_links(BLOCK, st.Tie(at=(-0.55, 0.0), axial_stiffness=1e8, axial_capacity=3e4))
    file = write_column(tied, tmp_path / "tied.toml")
    assert call(["limit", str(file), "--directions", "0:345:24"]) == 2
    assert "limit analysis in space knows no links" in capsys.readouterr().err
    assert call(["limit", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["links"][0]["yields"] is True
