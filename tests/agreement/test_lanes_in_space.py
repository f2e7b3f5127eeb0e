"""Assemblies in space in lanes: what stays intact comes to the same as alone, and what does not is run alone."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.models.base import Case
from stylobate.models.space import lanes
from stylobate.simulate import simulate_iter

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
    """Measures, and how many of the cases were run alone."""
    alone, one_by_one = [], lanes.measures_of_assemblies
    monkeypatch.setattr(lanes, "FEWEST", 1)

    def counted(run, some, *others):
        alone.extend(some)
        return one_by_one(run, some, *others)

    monkeypatch.setattr(lanes, "measures_of_assemblies", counted)
    found = dict(simulate_iter(cases, model or st.DistinctElement3D(), threads=1, **options))
    return [found[i] for i in range(len(cases))], len(alone)


@pytest.mark.parametrize(
    ("structure", "beta"), [(portal(), 0.0), (row(), 0.0), (row(), 1e-4)], ids=["portal", "row", "damped"]
)
def test_what_stays_intact(structure, beta, monkeypatch):
    """Joints that open and slip by tenths of a millimetre; some lanes begin where others have ended."""
    model = st.DistinctElement3D(stiffness_damping=beta)
    motions = [shaking(size, duration=duration) for size, duration in ((0.05, 0.3), (0.3, 0.4), (0.3, 0.25))]
    found, alone = batch([Case(structure, motion) for motion in motions], monkeypatch, model)
    assert alone == 0
    for one, motion in zip(found, motions, strict=True):
        other = st.simulate(structure, motion, model).measures
        for name in PEAKS:
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-9, abs=1e-9)
        assert one.blocks.peak_displacement == pytest.approx(other.blocks.peak_displacement, abs=1e-9)
        assert one.energy_imbalance == pytest.approx(other.energy_imbalance, abs=1e-6)
        for name in ("outcome", "decided", "steps", "time_step", "reason", "collapse"):
            assert getattr(one, name) == getattr(other, name)
        print(other)


def test_what_comes_loose_is_run_alone(monkeypatch):
    """One of three falls: its measures are those of a single run, to the last bit."""
    structure = portal()
    motions = [shaking(size, 0.0, 0.5) for size in (0.1, 3.0, 0.2)]
    found, alone = batch([Case(structure, motion) for motion in motions], monkeypatch, tail=1.5)
    assert alone == 1
    assert [one.collapsed for one in found] == [False, True, False]
    assert found[1] == st.simulate(structure, motions[1], st.DistinctElement3D(), tail=1.5).measures


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
    """Nor on its place, to the last bit, whatever kinds of structures are in a batch; what begins as drawn is run alone."""
    motions = [shaking(size, duration=duration) for size, duration in ((0.3, 0.2), (0.1, 0.15), (0.2, 0.1))]
    cases = [Case(portal(width), motion) for width in (0.8, 0.75) for motion in motions]
    drawn = st.SpatialAssembly(portal().stones, JOINT, name="as drawn", settle=False)
    together, alone = batch([*cases, Case(drawn, motions[2])], monkeypatch)
    assert alone == 1
    again = batch(cases[::-1], monkeypatch)[0][::-1]
    assert together[:-1] == again
    assert batch(cases[4:5], monkeypatch)[0] == together[4:5]


def test_a_joint_that_opens_far_over_is_told_alone(monkeypatch):
    """A block that leans by some 25° while the ground falls away below it; what lifts upright stays in lanes."""
    time = np.arange(0.0, 0.4, 0.005)
    drop = np.where((time > 0.28) & (time < 0.36), -3.0 * st.g, 0.0)
    stone = st.Stone.box((0.8, 0.8, 1.0), (0.0, 0.0, 0.0), 2700.0, name="block")
    block = st.SpatialAssembly((stone,), st.Joint(5e9, 2.5e9, 60.0), name="block")
    motions = [st.Motion(0.005, np.where(time < 0.25, push * st.g, 0.0), vertical=drop) for push in (1.6, 0.0)]
    found, alone = batch([Case(block, motion) for motion in motions], monkeypatch)
    assert alone == 1
    assert found[0] == st.simulate(block, motions[0], st.DistinctElement3D()).measures
    assert math.radians(20.0) < found[0].peak_rotation < math.radians(35.0)
