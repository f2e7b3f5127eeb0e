"""Ruins of assemblies: which bodies have fallen, which stand, and how far they have moved."""

import numpy as np
import pytest

import stylobate as st
from stylobate.campaign.campaign import Campaign
from stylobate_ruins.answers import Answers
from stylobate_ruins.simulations import FELL, STANDS, FinalState, Simulations, simulations_of

#: A slender pillar, and a stout block far beside it.
PAIR = st.SpatialAssembly(
    [
        st.Stone.box((0.3, 0.3, 1.8), (0.0, 0.0, 0.0), 2600.0, name="pillar"),
        st.Stone.box((1.2, 1.2, 0.6), (20.0, 0.0, 0.0), 2600.0, name="base"),
    ],
    st.Joint(normal_stiffness=2e9, shear_stiffness=2e9, friction_coefficient=0.5),
    name="pair",
)

PRIOR = st.Prior(pgv=(0.05, 1.0), period=(0.3, 0.6), stiffness_damping=(3e-4,))


def seen(**fields) -> st.Ruin:
    return st.Ruin([PAIR], [st.Observed("pair", **fields)], PRIOR)


def made(count: int = 2000) -> Simulations:
    """A table: the pillar falls above 0.4 m/s, and the base slides along x by 0.1 s times what is above 0.2 m/s."""
    parameters = PRIOR.draws(count, 1).parameters
    pgv = parameters["pgv_m_s"]
    fallen = np.stack((pgv > 0.4, np.zeros(count, bool)), axis=1)
    moved = np.zeros((count, 2, 2))
    moved[:, 1, 0] = 0.1 * np.maximum(pgv - 0.2, 0.0)
    verdict = np.where(fallen.any(axis=1), FELL, STANDS).astype(np.int8)
    state = FinalState(
        "pair", verdict, np.where(fallen[:, 0], 90.0, np.nan), moved, np.zeros((count, 2)), fallen, moved
    )
    return Simulations(PRIOR, parameters, (state,))


@pytest.mark.slow
def test_bodies_of_runs_are_told_one_by_one():
    prior = st.Prior(pgv=(1.4, 1.5), period=(1.0, 1.1), stiffness_damping=(3e-4,))
    (state,) = simulations_of([PAIR], prior, st.DistinctElement3D(), 1, 1, campaign=Campaign(tail=2.0)).final_states
    assert state.fallen.tolist() == [[True, False]]  # a pillar six times as high as wide; a block slides: 0.5 < 1.2/0.6
    assert state.verdict.tolist() == [FELL]
    assert state.moved.shape == state.slip.shape == (1, 2, 2)
    assert np.hypot(*state.moved[0, 1]) > 0.01
    # the block turns little: its centroid moves as its joint slips
    assert np.allclose(state.moved[:, 1], state.slip[:, 1], atol=5e-3)


def test_facts_of_bodies_match_draws():
    table = made()
    fallen = seen(fell=["pillar"], moved=[["base", 0.03, 0.0, 0.01]])
    assert [fact.kind for fact in fallen.facts] == ["state", "body", "body", "moved"]
    facts = fallen.facts
    answers = Answers(table, facts, 1)
    down = table.final_states[0].fallen[:, 0]
    assert np.array_equal(answers.matching(facts), np.flatnonzero(down))
    moved = facts[-1]
    off = answers.values[moved] - table.final_states[0].moved[:, 1]
    assert off.std() == pytest.approx(0.01, rel=0.2)  # measured as badly as the ruin was; many standard errors
    assert [fact.kind for fact in answers.alone(moved)] == ["state", "body", "moved"]
    assert moved not in answers.without(facts[2])
    standing = seen(stand=["base"])
    assert [fact.kind for fact in standing.facts] == ["body"]  # of the pillar nothing is seen
    assert len(Answers(table, standing.facts, 1).matching(standing.facts)) == table.sound.sum()


def test_slips_of_bodies_that_stand_tell_the_shaking():
    # Of the base alone nothing follows; 30 ± 1 mm come of 0.5 m/s, ± 2 %.
    table = made()
    spreads = [
        Answers(table, ruin.facts, 1).spread_of_pgv(ruin.facts)
        for ruin in (seen(stand=["base"]), seen(moved=[["base", 0.03, 0.0, 0.001]]))
    ]
    assert spreads[0] == pytest.approx(1.0, abs=1e-9)
    assert spreads[1] < 0.1


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"fell": ["column"]}, "'column' is no body of 'pair' that can move; .*known are pillar, base"),
        ({"fell": ["base"], "stand": ["base"]}, "one of the two is wrong"),
        ({"fell": ["base"], "moved": [["base", 0.1, 0.0, 0.01]]}, "one of the two is wrong"),
        ({"fell": ["base", "base"]}, "name each body once"),
        ({"state": "stands", "fell": ["base"]}, "where all stand, leave the names out"),
        ({"state": "fell before", "stand": ["base"]}, "leave the state out"),
        ({"moved": [["base", 0.1, 0.01]]}, "body, x, y and sd"),
        ({"moved": [["base", 0.1, 0.0, 0.0]]}, "allowed is \\(0"),
    ],
)
def test_bodies_that_contradict_are_refused(fields, message):
    with pytest.raises(st.InputError, match=message):
        seen(**fields)


def test_a_column_falls_as_a_whole():
    column = st.preset("paper-monolithic")
    with pytest.raises(st.InputError, match="which is a column and falls as a whole"):
        st.Ruin([column], [st.Observed(column.name, fell=["drum 1"])], PRIOR)
