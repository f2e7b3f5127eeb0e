"""Assemblies in space in lanes: what stays intact comes to the same as alone, and what does not goes on alone."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.kernels.run_codes import FAILED
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for
from stylobate.models.space import lanes
from stylobate.simulate import run_checked

TAN_PHI = math.degrees(math.atan(0.7))
JOINT = st.Joint(5e9, 2.5e9, TAN_PHI)
PEAKS = ["peak_rotation", "peak_joint_opening", "residual_joint_slip"]


def portal(across=0.8):
    """Square columns under a beam: rectangles on the ground and on one another."""
    stones = [
        st.Stone.box((0.8, across, 4.0), (-1.2, 0.0, 0.0), 2700.0, name="left"),
        st.Stone.box((0.8, across, 4.0), (1.2, 0.0, 0.0), 2700.0, name="right"),
        st.Stone.box((2.8, 0.7, 0.6), (0.0, 0.0, 4.0), 2700.0, name="beam"),
    ]
    return st.SpatialAssembly(tuple(stones), JOINT, name="portal")


def row():
    """Round columns, the middle one with a square abacus, under beams that meet on it: all kinds of faces on one another."""
    stones = []
    for k, x in enumerate((-1.5, 0.0, 1.5)):
        stones += [
            st.Stone.drum(0.8, 0.76, 1.2, (x, 0.0, 0.0), 2700.0, name=f"foot {k}"),
            st.Stone.drum(0.76, 0.72, 1.2, (x, 0.0, 1.2), 2700.0, name=f"head {k}"),
            st.Stone.box((0.8, 0.8, 0.3), (x, 0.0, 2.4), 2700.0, name=f"abacus {k}")
            if k == 1
            else st.Stone.drum(0.72, 0.72, 0.3, (x, 0.0, 2.4), 2700.0, name=f"cap {k}"),
        ]
    stones += [st.Stone.box((1.5, 0.5, 0.5), (x, 0.0, 2.7), 2700.0, name=f"beam {x}") for x in (-0.75, 0.75)]
    return st.SpatialAssembly(tuple(stones), JOINT, name="row")


def shaking(size, azimuth=0.3, duration=0.4):
    time = np.arange(0.0, duration + 1e-9, 0.005)
    push = size * st.g * np.sin(2.0 * np.pi * 2.0 * time)
    return st.Motion(0.005, push * math.cos(azimuth), lateral=push * math.sin(azimuth), vertical=0.2 * push)


def batch(cases, monkeypatch, model=None, **options):
    """Measures, and how many of the cases went on alone."""
    alone, collect = [], lanes.IntactLanes.collect

    def counted(self, lane):
        result = collect(self, lane)
        alone.extend([result] * callable(result))
        return result

    with monkeypatch.context() as patched:
        patched.setattr(lanes.IntactLanes, "collect", counted)
        results = dict(run_checked(cases, model or st.DistinctElement3D(), RunOptions(**options), 1))
    return [results[i] for i in range(len(cases))], len(alone)


def handed_over(case, share, model):
    """Measures of a case that rides alone in its block, and is given up there after a share of its run."""
    block = lanes.IntactLanes(model, RunOptions())
    block.load(3, case)
    for _ in range(int(share * block.chunks[3] / block.every[3])):
        block.kernel.advance(block.state, int(block.every[3]))
        block._record(np.array([3]))
    assert block.watch["status"][0, 3] != FAILED
    block.status[3] = FAILED
    return block.collect(3)()


@pytest.mark.parametrize(
    ("structure", "beta"), [(portal(), 0.0), (row(), 0.0), (row(), 1e-4)], ids=["portal", "row", "damped"]
)
def test_what_stays_intact(structure, beta, monkeypatch):
    """Joints that open and slip by tenths of a millimetre; some lanes begin where others have ended."""
    model = st.DistinctElement3D(stiffness_damping=beta)
    motions = [shaking(size, duration=duration) for size, duration in ((0.05, 0.3), (0.3, 0.4), (0.3, 0.25))]
    results, alone = batch([Case(structure, motion) for motion in motions], monkeypatch, model)
    assert alone == 0
    for measures, motion in zip(results, motions, strict=True):
        alike(measures, st.simulate(structure, motion, model).measures)


def test_losses_by_name_are_those_of_each_structure(monkeypatch):
    """Two portals of other columns in one block of lanes: each has the damping that it has alone."""
    model, cases = st.DistinctElement3D(losses="stone"), [Case(portal(wide), shaking(0.2)) for wide in (0.8, 0.7)]
    results, alone = batch(cases, monkeypatch, model)
    assert alone == 0
    damping = [engine_for(model, case.column).acting.stiffness_damping for case in cases]
    assert damping[0] > 1.1 * damping[1] > 1e-5
    for measures, case in zip(results, cases, strict=True):
        alike(measures, st.simulate(*case, model).measures)


def alike(measures, other):
    """Whether two runs agree as long as no impacts have made rounding grow."""
    for name in PEAKS:
        assert getattr(measures, name) == pytest.approx(getattr(other, name), rel=1e-9, abs=1e-9)
    assert measures.blocks.peak_displacement == pytest.approx(other.blocks.peak_displacement, abs=1e-9)
    assert measures.energy_imbalance == pytest.approx(other.energy_imbalance, abs=1e-6)
    for name in ("outcome", "decided", "steps", "time_step", "reason", "collapse"):
        assert getattr(measures, name) == getattr(other, name)


def test_what_is_handed_over_at_once_is_the_run_alone():
    """To the last bit: all that the engine knows of a run at its start has been in the lane and has come back."""
    case, model = Case(portal(), shaking(0.3)), st.DistinctElement3D(stiffness_damping=1e-4)
    assert handed_over(case, 0.0, model) == st.simulate(*case, model).measures


@pytest.mark.parametrize(("structure", "beta"), [(portal(), 0.0), (row(), 1e-4)], ids=["portal", "damped row"])
def test_what_is_handed_over_while_it_rocks(structure, beta):
    """Springs of friction, sliding, dashpots and the ledger go with it: in the first swing, and on its way back."""
    case, model = Case(structure, shaking(0.3)), st.DistinctElement3D(stiffness_damping=beta)
    alone = st.simulate(*case, model).measures
    for share in (0.4, 0.8):
        alike(handed_over(case, share, model), alone)


def test_what_comes_loose_goes_on_alone(monkeypatch):
    """One of three is thrown over by a pulse: the same bodies fall, at the same time but for a thousandth of a second."""
    structure = portal()
    motions = [shaking(size, 0.0, 0.5) for size in (0.1, 3.0, 0.2)]
    results, alone = batch([Case(structure, motion) for motion in motions], monkeypatch, tail=1.5)
    assert alone == 1
    assert [measures.collapsed for measures in results] == [False, True, False]
    other = st.simulate(structure, motions[1], st.DistinctElement3D(), tail=1.5).measures
    assert (results[1].outcome, results[1].decided, results[1].steps) == (other.outcome, other.decided, other.steps)
    assert dict(results[1].blocks.fell_at) == pytest.approx(dict(other.blocks.fell_at), abs=1e-3)
    assert results[1].peak_rotation == pytest.approx(other.peak_rotation, rel=1e-9)


def test_what_is_undecided_at_the_end_goes_on_alone(monkeypatch):
    """A portal that still rocks when its motion ends, until it lies still; one that lies still by then ends in its lane."""
    motions = [shaking(0.3, 0.0), shaking(0.0, 0.0, 0.7)]
    cases = [Case(portal(), motion) for motion in motions]
    model = st.DistinctElement3D(stiffness_damping=1e-3)
    results, alone = batch(cases, monkeypatch, model, until_decided=True)
    assert alone == 1
    for measures, motion in zip(results, motions, strict=True):
        other = st.simulate(portal(), motion, model, until_decided=True).measures
        print(measures, other)
        alike(measures, other)
        assert measures.decided
    assert results[0].steps * results[0].time_step > motions[0].duration + 0.5


def test_bodies_that_may_strike_one_another_are_run_alone(monkeypatch):
    """Of two blocks, 4 mm apart; 40 cm apart they stay in lanes."""
    motions = [shaking(0.3, 0.0, 0.3)] * 2

    def blocks(gap):
        stones = [
            st.Stone.box((0.4, 0.4, 1.6), (0.0, 0.0, 0.0), 2700.0, name="slender"),
            st.Stone.box((1.0, 1.0, 1.6), (0.7 + gap, 0.0, 0.0), 2700.0, name="stout"),
        ]
        return st.SpatialAssembly(tuple(stones), JOINT, name="two blocks")

    assert batch([Case(blocks(0.004), motion) for motion in motions], monkeypatch)[1] == 2
    assert batch([Case(blocks(0.4), motion) for motion in motions], monkeypatch)[1] == 0


def test_a_lane_does_not_hang_on_its_neighbours(monkeypatch):
    """Nor on its place, to the last bit, whatever kinds of structures are in a batch, and whether it comes loose.

    What begins as drawn is run alone.
    """
    motions = [shaking(size, duration=duration) for size, duration in ((4.0, 0.3), (0.1, 0.15), (0.2, 0.1))]
    cases = [Case(portal(width), motion) for width in (0.8, 0.75) for motion in motions]
    drawn = st.SpatialAssembly(portal().stones, JOINT, name="as drawn", settle=False)
    together, alone = batch([*cases, Case(drawn, motions[2])], monkeypatch)
    assert alone == 3
    again = batch(cases[::-1], monkeypatch)[0][::-1]
    assert together[:-1] == again
    assert batch(cases[3:4], monkeypatch)[0] == together[3:4]
    threads = dict(run_checked(cases, st.DistinctElement3D(), RunOptions(), 3))
    assert [threads[i] for i in range(len(cases))] == together[:-1]


def test_a_joint_that_opens_far_over_is_told_alone(monkeypatch):
    """A block that leans by some 25° while the ground falls away below it; what lifts upright stays in lanes."""
    time = np.arange(0.0, 0.4, 0.005)
    drop = np.where((time > 0.28) & (time < 0.36), -3.0 * st.g, 0.0)
    stone = st.Stone.box((0.8, 0.8, 1.0), (0.0, 0.0, 0.0), 2700.0, name="block")
    block = st.SpatialAssembly((stone,), st.Joint(5e9, 2.5e9, 60.0), name="block")
    motions = [st.Motion(0.005, np.where(time < 0.25, push * st.g, 0.0), vertical=drop) for push in (1.6, 0.0)]
    results, alone = batch([Case(block, motion) for motion in motions], monkeypatch)
    assert alone == 1
    alike(results[0], st.simulate(block, motions[0], st.DistinctElement3D()).measures)
    assert math.radians(20.0) < results[0].peak_rotation < math.radians(35.0)
