"""Runs of assemblies that wait, for rest or for their verdict, are those that do not, and then go on."""

import numpy as np
import pytest

import stylobate as st

JOINT = st.Joint(5e8, 2.5e8, friction_coefficient=0.7)


def plane(boxes):
    """Boxes as left end, lower end, width and height [m]."""
    blocks = [
        st.Block([(x, z), (x + w, z), (x + w, z + h), (x, z + h)], 2500.0, f"stone {k}", depth=0.8)
        for k, (x, z, w, h) in enumerate(boxes)
    ]
    return st.Assembly(blocks, JOINT, name="plane")


def space(boxes):
    stones = [
        st.Stone.box((w, 0.8, h), (x + 0.5 * w, 0.0, z), 2500.0, name=f"stone {k}")
        for k, (x, z, w, h) in enumerate(boxes)
    ]
    return st.SpatialAssembly(stones, JOINT, name="space")


PORTAL = [(0.0, 0.0, 0.6, 3.0), (2.4, 0.0, 0.6, 3.0), (-0.1, 3.0, 3.2, 0.5)]
DOMINOES = [(0.9 * k, 0.0, 0.4, 2.0) for k in range(2)]
KINDS = {"plane": (plane, st.DistinctElement2D()), "space": (space, st.DistinctElement3D(stiffness_damping=1e-3))}


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_until_rest_is_the_run_without_and_then_its_rest(kind):
    """Of stones that strike one another while the motion lasts: what they give back does not hang on the wait."""
    make, model = KINDS[kind]
    motion = st.harmonic(0.8, 0.5 * st.g, 1.8)
    plain, waits = (st.simulate(make(DOMINOES), motion, model, tail=0.2, until_rest=rest) for rest in (False, True))
    assert any(when < 1.8 for _, when in plain.measures.blocks.fell_at)
    same = len(plain.time)
    assert np.array_equal(waits.body_position[:same], plain.body_position)
    assert waits.measures.blocks.at_rest
    assert waits.time[-1] > plain.time[-1]


@pytest.mark.parametrize("kind", KINDS)
def test_many_runs_go_on_until_their_verdicts_are_certain(kind):
    """A portal that rocks when its motion ends: alone it is undecided, in a study it stands."""
    make, model = KINDS[kind]
    portal, motion = make(PORTAL), st.harmonic(1.5, 0.3 * st.g, 1.0)
    alone = st.simulate(portal, motion, model)
    assert not alone.decided
    table = st.run_study(st.Study([portal], [motion], [model], (0.5, 1.0))).table
    assert (table["verdict"] == "stands").all()
    assert table["at_rest"].all()
    again = st.simulate(portal, motion, model, until_decided=True)
    assert again.decided
    assert again.time[-1] > alone.time[-1]
    assert table["peak_rotation_rad"][1] == pytest.approx(again.peak_rotation, rel=1e-9)  # lanes add in another order
    assert table["steps"][1] == again.measures.steps
