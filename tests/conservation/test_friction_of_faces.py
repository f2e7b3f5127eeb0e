"""Friction of faces at random loaded poses: a potential while nothing opens or slips, and never a source of energy.

Every engine's own function of forces is led round displacements that are prescribed (``oracles/joint_probe.py``). Shear that
acted at the middle of pressure, which moves as a face rocks, gave 5e-2, 2e-3 and, of what a rocking joint holds, lost 0.8.
"""

import numpy as np
import pytest
from oracles import joint_probe as probe

import stylobate as st

#: Poses of each law, of one lane at a time or of sixteen.
POSES = 4

#: Shear at a finite angle turns with the joint: its share of a stiffness is T / K R, 2e-5 here at most.
ASKEW = 1e-3

#: Work round a loop of φ = 1e-6 rad over the energy T² / 2 K that shear stores. A force that turns with the joint does the
#: work T φ · φ R of it: 2 φ² K R / T, 1e-5 at most for the stiffest joints and least shears here. It was 1e-3 to 1e-2.
ROUND = 1e-5

#: On the bed a drum is a prism of twelve facets that turn to where it is touched: what touches changes with the tilt, and a
#: twentieth of the askew stiffness of friction at the middle of pressure is left.
FACETED, FACETED_ASKEW, FACETED_ROUND = ("space bed, drum on box",), 5e-3, 1e-3

#: What closes again comes to rest within two cycles; a corner that slips on its way adds 8e-5.
CREEPS = 1e-3


@pytest.fixture(scope="module", params=list(probe.LAWS))
def rig(request):
    return probe.LAWS[request.param]()


def test_loops_of_a_closed_face_do_no_work(rig, request):
    faceted = request.node.callspec.params["rig"] in FACETED
    results = [probe.measured(rig, 47 + k) for k in range(1 if rig.lanes > 1 else POSES)]
    stuck = np.concatenate([result.stuck for result in results])
    assert stuck.sum() >= POSES
    assert np.concatenate([result.askew for result in results])[stuck].max() < (FACETED_ASKEW if faceted else ASKEW)
    assert np.abs(np.concatenate([result.turns for result in results], axis=1))[:, stuck].max() < (
        FACETED_ROUND if faceted else ROUND
    )


def test_friction_never_gives_energy_back(rig):
    assert max(probe.given_back(rig, 47 + k).max() for k in range(1 if rig.lanes > 1 else POSES)) < 1e-9


def test_a_face_that_opens_and_closes_again_keeps_its_shear(rig):
    losses = [probe.lost_by_rocking(rig, 47 + k) for k in range(1 if rig.lanes > 1 else POSES)]
    assert np.concatenate(losses).max() < CREEPS


@pytest.mark.parametrize("degrees", [20.0, 44.0, 46.0])
def test_a_joint_that_hands_over_to_the_bed_feeds_nothing(degrees):
    """A box on its edge: between 0.7 and all of the tilt at which the bed acts alone, the share of the joint falls."""
    for seed in (0, 1):
        assert probe.tipped(probe.LAWS["space joint, box on ground"](), degrees, seed).max() < ROUND


def test_heat_of_friction_never_falls_in_a_shaken_column():
    """A layer of friction that has opened holds nothing: what was rounded of its torsion counted 14 J, on no spring."""
    drum = st.Drum(0.6, 0.6, 0.6, 2500.0, section="circular")
    column = st.Column.of_drums([drum, drum], st.Joint(5e9, 2.5e9, friction_coefficient=0.7))
    rng, time = np.random.default_rng(0), np.arange(0.0, 2.5, 0.01)
    along, across = (
        sum(rng.normal() * np.sin(2.0 * np.pi * f * time + rng.uniform(0.0, 6.0)) for f in (0.7, 1.3, 2.1, 3.7))
        for _ in range(2)
    )
    push = 0.175 * st.g * np.minimum(time, 1.0)
    response = st.simulate(column, st.Motion(0.01, push * along, lateral=push * across), st.DistinctElement3D())
    assert np.diff(response.energy["friction"]).min() > -1e-9
