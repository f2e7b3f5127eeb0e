"""A column of round drums is the same in lanes of columns and as an assembly in space, as long as the law is the same."""

import math

import numpy as np
import pytest

import stylobate as st

STEP = 2.5e-5


@pytest.mark.parametrize("azimuth", [0.0, 0.6])
def test_a_column_of_drums_in_both_engines(azimuth):
    """Half a sine that opens all joints, and the swing after it: places to 1e-9 m, of some millimetres."""
    joint = st.Joint(5e10, 2.5e10, math.degrees(math.atan(0.7)))
    column = st.Column.of_drums([st.Drum(1.0, 0.8, 0.8, 2700.0, section="circular")] * 3, joint, name="column")
    drums = [st.Stone.drum(0.8, 0.8, 1.0, (0.0, 0.0, float(i)), 2700.0, name=f"drum {i}") for i in range(3)]
    assembly = st.SpatialAssembly(tuple(drums), joint, name="column")
    push = 0.4 * 9.81 * np.sin(2.5 * np.pi * np.arange(0.0, 0.40001, 0.0025))
    motion = st.Motion(0.0025, push * math.cos(azimuth), lateral=push * math.sin(azimuth))
    model = st.DistinctElement3D(time_step=STEP)
    ways = []
    for one in (column, assembly):
        response = st.simulate(one, motion, model)
        position = np.array(response.poses.position)[:, -3:]
        assert response.measures.time_step == STEP
        ways.append(position - position[0])
    assert np.abs(ways[0]).max() > 6e-3
    assert ways[1] == pytest.approx(ways[0], abs=1e-9)
