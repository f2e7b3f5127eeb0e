"""A column of round drums is the same in lanes of columns and as an assembly in space, as long as the law is the same."""

import math

import numpy as np
import pytest

import stylobate as st

STEP = 2.5e-5
COLUMN = """
name = "stele"
section = "circular"
density = 2500.0
[[drum]]
height = 1.0
bottom_width = 0.5
top_width = 0.5
[[drum]]
height = 0.9
bottom_width = 0.5
top_width = 0.45
[joint]
normal_stiffness = 2.0e9
shear_stiffness = 1.0e9
friction_coefficient = 0.7
[[link]]
kind = "dowel"
joint = 2
diameter = 0.02
embedment = 0.1
material = "titanium"
"""
SCENE = """
name = "scene"
[[column]]
file = "stele.toml"
at = [[0.0, 0.0]]
"""


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
    for structure in (column, assembly):
        response = st.simulate(structure, motion, model)
        position = np.array(response.poses.position)[:, -3:]
        assert response.measures.time_step == STEP
        ways.append(position - position[0])
    assert np.abs(ways[0]).max() > 6e-3
    assert ways[1] == pytest.approx(ways[0], abs=1e-9)


def test_a_column_is_followed_to_the_ground_as_in_a_scene(tmp_path):
    """With its dowel, brought down by one swing: the same bits as a file with one [[column]]."""
    (tmp_path / "stele.toml").write_text(COLUMN)
    (tmp_path / "scene.toml").write_text(SCENE)
    motion, model = st.harmonic(0.8, 0.6 * st.g, 1.25), st.DistinctElement3D()
    alone = st.simulate(st.Column.from_toml(tmp_path / "stele.toml"), motion, model, until_rest=True)
    scene = st.simulate(st.read_assembly(tmp_path / "scene.toml"), motion, model, until_rest=True)
    assert alone.measures.collapsed
    assert alone.summary()["at_rest"]
    assert alone.structure.name == "stele"
    assert [body.name for body in alone.structure.bodies] == ["ground", "drum 1", "drum 2"]
    assert np.array_equal(alone.body_position, scene.body_position)
    assert np.array_equal(alone.body_orientation, scene.body_orientation)


@pytest.mark.parametrize(("setting", "name"), [({"law": "bed"}, "law"), ({"planar": True}, "planar")])
def test_what_a_followed_column_in_space_does_not_know_is_refused(setting, name):
    column, motion = st.preset("paper-monolithic"), st.harmonic(1.0, 1.0, 1.0)
    with pytest.raises(st.InputError, match=f"^{name} is .*, which assemblies in space such as .* do not know"):
        st.simulate(column, motion, st.DistinctElement3D(**setting), until_rest=True)
