"""Verdicts on assemblies in space that are turned about the vertical as a whole, with the motion, and renumbered."""

import math

import numpy as np
import pytest

import stylobate as st

TAN_PHI = math.degrees(math.atan(0.7))

#: Boxes as sides and the middle of the lower face [m]: a portal, a row of dominoes, and two stones on a wide one.
SCENES = {
    "portal": [((0.8, 0.8, 4.0), (-1.2, 0.0, 0.0)), ((0.8, 0.8, 4.0), (1.2, 0.0, 0.0)), ((3.2, 0.8, 0.6), (0, 0, 4.0))],
    "dominoes": [((0.5, 0.9, 2.5), (1.1 * k, 0.0, 0.0)) for k in range(3)],
    "heap": [((1.2, 0.9, 0.5), (0, 0, 0)), ((0.5, 0.6, 0.8), (-0.3, 0, 0.5)), ((0.5, 0.5, 1.2), (0.3, 0.1, 0.5))],
}


def verdict(name, share, period, angle=0.0, order=None):
    """Outcome under a sine, and which stones fell, of a scene in an order, turned by an angle [rad]."""
    scene = SCENES[name]
    c, s = math.cos(angle), math.sin(angle)
    stones = []
    for i in order or range(len(scene)):
        sides, (x, y, z) = scene[i]
        at = (c * x - s * y, s * x + c * y, z)
        spin = (math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle))
        stones.append(st.Stone.box(sides, at, 2700.0, name=f"stone {i}", orientation=spin))
    assembly = st.SpatialAssembly(tuple(stones), st.Joint(5e9, 2.5e9, TAN_PHI), name=name)
    t = np.arange(0.0, period + 1.0, 0.005)
    a = share * 9.81 * np.sin(2.0 * np.pi * t / period) * (t < period)
    motion = st.Motion(0.005, c * a, lateral=s * a)
    response = st.simulate(assembly, motion, st.DistinctElement3D())
    return response.measures.outcome, {who for who, _ in response.measures.blocks.fell_at}


@pytest.mark.parametrize(
    ("name", "share", "period"),
    [("portal", 0.6, 1.2), ("portal", 0.3, 0.6), ("dominoes", 0.5, 1.0), ("heap", 0.8, 0.8)],
)
def test_turning_and_renumbering_change_no_verdict(name, share, period):
    rng = np.random.default_rng(len(name))
    plain = verdict(name, share, period)
    order = [int(k) for k in rng.permutation(len(SCENES[name]))]
    assert verdict(name, share, period, rng.uniform(0.0, 2.0 * math.pi), order) == plain
