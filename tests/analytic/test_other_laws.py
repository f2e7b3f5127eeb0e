"""A run in space under the other laws of its joints: which they are, and that they are what the model makes of them."""

import pytest

import stylobate as st
from stylobate.verdicts import verdict as v
from stylobate.verdicts.population import FACTOR, OtherLaws

JOINT = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
SIZE = {"height": 2.0, "bottom_width": 0.5, "top_width": 0.5, "density": 2700.0, "drums": 1}
ROUND = st.Column.tapered(**SIZE, joint=JOINT, section="circular", name="round")
MOTION = st.harmonic(frequency=1.2, amplitude=0.4 * st.g, duration=2.0)
SPACE = st.DistinctElement3D()


@pytest.fixture(scope="module")
def companions():
    return st.other_laws(st.simulate(ROUND, MOTION, SPACE), MOTION, SPACE, st.Campaign(threads=1))


def test_verdicts_are_those_of_the_models_with_these_laws(companions):
    """Each companion is the column under a model that says the same: its rows are those of single runs."""
    stone = {"stiffness_damping": 3e-4, "rolling_resistance": 0.003}
    same = {
        "on rims, damped as stone": st.DistinctElement3D(**stone),
        "on beds, undamped": st.DistinctElement3D(law="bed"),
        "on beds, damped as stone": st.DistinctElement3D(law="bed", **stone),
    }
    assert set(companions.verdicts) == {*same, "stiffer joints", "softer joints"}
    for words, model in same.items():
        alone = st.simulate(ROUND, MOTION, model, until_decided=True).measures.row()
        assert companions.verdicts[words] == v.verdict(alone)
    soft = st.Joint(JOINT.normal_stiffness / FACTOR, JOINT.shear_stiffness / FACTOR, friction_coefficient=0.7)
    alone = st.simulate(ROUND.replace(joints=soft), MOTION, SPACE, until_decided=True).measures.row()
    assert companions.verdicts["softer joints"] == v.verdict(alone)


def test_a_factor_is_one_standard_deviation_of_a_variation_of_100_percent():
    assert pytest.approx(2.299, abs=1e-3) == FACTOR  # exp √ln 2


def test_no_law_is_at_stake_where_nothing_moves_and_in_the_plane():
    weak = st.harmonic(frequency=1.2, amplitude=0.05 * st.g, duration=1.0)
    assert st.other_laws(st.simulate(ROUND, weak, SPACE), weak, SPACE, st.Campaign()) is None
    plane = st.DistinctElement2D()
    response = st.simulate(st.Column.tapered(**SIZE, joint=JOINT, name="prism"), MOTION, plane)
    assert st.other_laws(response, MOTION, plane, st.Campaign()) is None


def test_what_changes_the_verdict_is_named():
    fell = OtherLaws(v.COLLAPSED, {"softer joints": v.STANDS, "on beds, undamped": v.COLLAPSED})
    assert "under 1 of 2 other laws it stands (softer joints)" in fell.sentence
    stood = OtherLaws(v.STANDS, {"softer joints": v.STANDS, "on beds, undamped": v.UNDECIDED})
    assert (stood.changes, stood.sentence) == (False, "")
    open_ = OtherLaws(v.UNDECIDED, {"softer joints": v.STANDS, "stiffer joints": v.COLLAPSED})
    assert "it falls (stiffer joints)" in open_.sentence
