"""What pretension stores in links and in the joints that it presses, and what of it counts against a verdict."""

from __future__ import annotations

import numpy as np
import pytest

import stylobate as st
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for

G = 9.80665
PULL, AXIAL = 5e4, 1e9
JOINT = st.Joint(normal_stiffness=1e7, shear_stiffness=5e6, friction_coefficient=0.7)
MODELS = [st.DistinctElement2D(), st.DistinctElement3D()]


def loaded(model, links=(), drums=1, joint=JOINT):
    """A block of lanes with a column of 0.5 m by 2 m in its first, at rest."""
    half = st.Drum(2.0 / drums, 0.5, 0.5, 2500.0, depth=0.5)
    column = st.Column.of_drums([half] * drums, joint).replace(links=links, gravity=G)
    motion = st.Motion(0.01, np.zeros(201), metadata={"format": "made for this test"})
    block = engine_for(model, column).block(RunOptions(quiet=0.1))
    block.load(0, Case(column, motion))
    return block


def links_of(block):
    """Records of the links of a block, in the plane or in space."""
    return block.records.link


def core(**more):
    return st.Core(axial_stiffness=AXIAL, pretension=PULL, **more)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
@pytest.mark.parametrize("drums", [1, 2])
def test_what_pretension_stores(model, drums):
    """T²/2k of the link and, in each joint of stiffness K = k_n A, T²/2K above the weight: linear, so exact to rounding.

    A pull of four times the weight at 10⁷ N/m³ stores a thousand times more in the joint than in the link.
    """
    block = loaded(model, [core()], drums)
    joint = PULL**2 / (2.0 * 1e7 * 0.25)
    assert block.link_energy(0) == pytest.approx(PULL**2 / (2.0 * AXIAL) + drums * joint, rel=1e-6)
    assert loaded(model, [st.Core(axial_stiffness=AXIAL)], drums).link_energy(0) == 0.0


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_what_a_joint_holds_of_pretension_may_overturn_a_column(model):
    """500 J in the joint, against a barrier of m g (R − H) = 377 J: as it stands it is not sure to stand for good.

    With half the pull a quarter of the energy is left, and it is.
    """
    for pull, sure in ((PULL, False), (0.5 * PULL, True)):
        block = loaded(model, [st.Core(axial_stiffness=AXIAL, pretension=pull)])
        block.steps[0] = 0
        assert block.collect(0).decided is sure


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_column_that_moves_with_what_pretension_gave_away_is_not_at_rest(model):
    """The core lost, the joint still pressed and the drum moving with what the link had: below the energy of the start.

    With its core whole and nothing moving the column is at rest.
    """
    block = loaded(model, [core()])
    assert block.at_rest(0)
    links_of(block)["on"][0, 0] = links_of(block)["ft"][0, 0] = 0.0
    assert not block.at_rest(0)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_dowel_out_of_its_hole_is_not_bent(model):
    """Lifted by more than its embedment it slides beyond its ultimate slip, out and whole; in its hole it breaks."""
    dowel = st.Dowel(joint=1, shear_stiffness=1e6, embedment=0.05, ultimate_slip=0.02)
    for lift, out in ((0.06, 1.0), (0.0, 0.0)):
        block = loaded(model, [dowel])
        body = block.records.body
        body["z"][1, 0] += lift
        body["x"][1, 0] += 0.03
        forces = block.records.kernel.forces if model.axes == "xyz" else block.records.kernel.gather
        forces(block.records.state)
        links = links_of(block)
        assert (links["out"][0, 0], links["on"][0, 0]) == (out, out)
        assert links["fx"][0, 0] == 0.0


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_dowels_within_their_slack_count_with_what_they_can_hold(model):
    """They are not computed while they are far from touching, and hold against a fall all the same."""
    dowel = st.Dowel(joint=1, shear_stiffness=1e6, shear_capacity=1e4, embedment=0.05, clearance=0.1)
    block = loaded(model, [dowel], joint=st.Joint(1e11, 5e10, friction_coefficient=0.7))
    block.advance(1)
    assert block.records.bond["near"][0] == 0
    hold = block.records.hold["moment"][0]
    assert hold.max() == pytest.approx(1e4 * 0.05)


def test_wood_is_as_strong_in_tension_as_its_standard_says():
    """EN 338:2016, D30: 18 MPa along the grain in tension, 30 MPa in bending."""
    column = st.Column.of_drums([st.Drum(2.0, 0.5, 0.5, 2500.0)], JOINT)
    tie = st.Tie(at=(0.3, 0.0), diameter=0.1, material="wood")
    bar = st.Bar(joint=1, diameter=0.01, embedment=0.5, material="wood")
    strong = [link.axial_capacity for link in column.replace(links=[tie, bar]).placed_links]
    assert strong == pytest.approx([18e6 * np.pi * 0.1**2 / 4.0, 18e6 * np.pi * 0.01**2 / 4.0])


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_column_that_only_its_pretension_holds_up_is_computed(model):
    """The weight of the upper drum passes 50 mm beyond its joint; the core presses it back. All of its joints counts."""
    drum = st.Drum(1.0, 0.5, 0.5, 2500.0, depth=0.5)
    stressed_core = st.Core(at=(0.15, 0.0), to=(-0.15, 0.0), axial_stiffness=1e7, pretension=6e4)
    as_found = st.AsFound((st.FoundDrum(2, offset=0.3),))
    joint = st.Joint(1e10, 5e9, friction_coefficient=0.7)
    column = st.Column.of_drums([drum, drum], joint).replace(links=(stressed_core,), as_found=as_found)
    response = st.simulate(column, st.Motion(0.01, np.zeros(11)), model)
    assert response.outcome is st.Outcome.AT_REST
    assert not response.decided
    assert "which no tail decides" in response.sentence


@pytest.mark.parametrize("at", [(0.3, 0.0), (-0.3, 0.0), (0.0, 0.3)])
@pytest.mark.parametrize("share", [1.0, 3.0])
def test_a_strap_beside_the_axis_lowers_what_opens_a_joint(at, share):
    """a W h/2 = W b/2 + P (b/2 − e) g about the edge away from the strap, b = 0.5 m, h = 2 m, e = 0.3 m."""
    drum = st.Drum(2.0, 0.5, 0.5, 2500.0, depth=0.5)
    pull = share * drum.mass * G
    column = st.Column.of_drums([drum], JOINT).replace(
        links=(st.Tie(at=at, axial_stiffness=1e7, pretension=pull),), gravity=G
    )
    assert column.uplift_acceleration == pytest.approx(G * (0.25 + share * (0.25 - 0.3)), rel=1e-9)
