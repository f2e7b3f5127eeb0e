"""How assemblies in space begin and end: what settles, what begins as drawn, and when all is at rest."""

import numpy as np
import pytest

import stylobate as st

JOINT = st.Joint(5e9, 2.5e9, 35.0)
STILL = st.Motion(0.01, np.zeros(21))


def box(name, sides, at, **others):
    return st.Stone.box(sides, at, 2700.0, name=name, **others)


def test_a_stone_that_falls_from_a_high_support_is_followed_to_the_ground():
    """A small stone pushed off a fixed wall 6 m high takes longer than 1.1 s to come down, and then to lie still."""
    wall = box("wall", (1.0, 1.0, 6.0), (0.0, 0.0, 0.0), fixed=True)
    finial = box("finial", (0.3, 0.3, 0.3), (0.2, 0.0, 6.0), velocity=(3.0, 0.0, 0.0))
    scene = st.SpatialAssembly((wall, finial), JOINT, name="finial", settle=False)
    response = st.simulate(scene, STILL, st.DistinctElement3D(), until_rest=True)
    assert response.collapsed
    assert response.at_rest
    assert response.body_position[-1, 2, 2] < 0.25
    assert np.abs(response.body_velocity[-1]).max() < 0.05


def test_what_moves_at_the_start_does_not_settle():
    with pytest.raises(st.InputError, match=r"block 'box' of 'scene' moves at the start, .* give settle = false"):
        st.SpatialAssembly(
            (box("box", (1.0, 1.0, 2.0), (0.0, 0.0, 0.0), velocity=(0.1, 0.0, 0.0)),), JOINT, name="scene"
        )


def test_a_beam_that_tips_onto_a_stop_has_not_settled_as_drawn():
    """Its centroid hardly moves; its end goes down by a tenth of a metre."""
    stones = (
        box("pier", (0.2, 0.4, 2.0), (0.0, 0.0, 0.0), fixed=True),
        box("stop", (0.2, 0.4, 1.9), (1.9, 0.0, 0.0), fixed=True),
        box("beam", (4.0, 0.4, 0.4), (0.101, 0.0, 2.0)),
    )
    with pytest.warns(st.OutOfRangeWarning, match="not in equilibrium as drawn"):
        response = st.simulate(st.SpatialAssembly(stones, JOINT, name="beam"), STILL, st.DistinctElement3D(), tail=2.0)
    assert response.measures.blocks.in_equilibrium is False
    assert response.measures.peak_rotation > 0.04


def test_soft_joints_settle():
    """With a step of 3.7 ms too: a cube of 2 m on 1e8 N/m³."""
    cube = st.SpatialAssembly((box("cube", (2.0, 2.0, 2.0), (0.0, 0.0, 0.0)),), st.Joint(1e8, 5e7, 35.0), name="cube")
    response = st.simulate(cube, STILL, st.DistinctElement3D())
    assert response.measures.blocks.in_equilibrium
    assert response.outcome is st.Outcome.AT_REST


def test_what_sinks_by_more_than_a_hundredth_of_a_stone_says_so():
    """A pillar of 2700 kg/m³ sinks by ρ g h / k_n: 8.8 mm of 2 m on 6e6 N/m³."""
    pillar = box("pillar", (0.5, 0.5, 2.0), (0.0, 0.0, 0.0))
    soft = st.SpatialAssembly((pillar,), st.Joint(6e6, 3e6, 35.0), name="pillar")
    with pytest.warns(
        st.OutOfRangeWarning, match="'pillar' sinks and sways by 8.8 mm under its own weight before it rests"
    ):
        response = st.simulate(soft, STILL, st.DistinctElement3D())
    assert response.measures.blocks.in_equilibrium
    assert response.outcome is st.Outcome.AT_REST
