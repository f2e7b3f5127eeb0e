"""Runs that wait, for rest or for their verdict, are those that do not, and then go on."""

import json

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call

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


def test_a_column_that_rocks_at_the_end_goes_on_until_its_verdict_is_certain():
    """In a critical amplitude and alone; to the end of the motion it is the run that does not go on, bit by bit."""
    column, model = st.preset("paper-12-drums"), st.DistinctElement2D()
    grid = 0.3 * st.g, 0.42 * st.g, 0.12 * st.g
    weak = st.harmonic(0.7, grid[0], 4.0 / 0.7)
    motions = [weak, weak.scaled((grid[0] + grid[2]) / grid[0])]
    alone = [st.simulate(column, motion, model) for motion in motions]
    assert [response.decided for response in alone] == [True, False]
    waits = [st.simulate(column, motion, model, until_decided=True) for motion in motions]
    assert all(response.decided for response in waits)
    assert waits[0].measures.steps == alone[0].measures.steps
    same = len(alone[1].time) - 1  # the last row of a run may come early
    assert np.array_equal(waits[1].drum_x[:same], alone[1].drum_x[:same])
    assert alone[1].time[-1] < waits[1].time[-1] < alone[1].time[-1] + 10.0
    result = st.critical_amplitude(column, motions[0], model, *grid, nominal=0.3 * st.g)
    assert result.counts["undecided"] == 0
    assert result.table["steps"].tolist() == [response.measures.steps for response in waits]


@pytest.mark.parametrize("replicates", ["0", "2"])
def test_the_command_goes_on_with_a_run_and_columns_like_it(replicates, capsys):
    command = ["run", "paper-12-drums", "--harmonic", "0.7Hz,0.4g,5.714s", "--json"]
    assert call([*command, "--replicates", replicates]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["decided"]
    assert summary.get("certainty", {}).get("undecided", 0) == 0


def test_what_cannot_move_on_does_not_wait():
    """A column that lies still while its pretension leaves the verdict open ends with its motion, as no wait decides it."""
    tied = st.preset("paper-monolithic").replace(
        links=(st.Core(axial_stiffness=5e7, axial_capacity=2e5, pretension=1e5),)
    )
    response = st.simulate(tied, st.harmonic(1.0, 0.02 * st.g, 1.0), st.DistinctElement2D(), until_decided=True)
    assert response.time[-1] < 1.1
