"""Links in files of assemblies in space: what is read, where it is, and what cannot be, said in one sentence."""

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.links import block_link

SCENE = """
density = 2000.0
[joint]
normal_stiffness = 1e9
shear_stiffness = 5e8
friction_coefficient = 0.7
[[block]]
name = "a"
box = [1.0, 1.0, 0.5]
at = [0.0, 0.0, 0.0]
[[block]]
name = "b"
box = [1.0, 1.0, 0.5]
at = [0.0, 1.0, 0.0]
[[block]]
name = "c"
drum = { bottom_diameter = 0.8, top_diameter = 0.8, height = 0.5 }
at = [0.0, 2.5, 0.0]
[[block]]
name = "top"
box = [1.0, 1.0, 0.4]
at = [0.0, 0.0, 0.5]
[[block]]
name = "wall"
box = [0.2, 1.0, 1.0]
at = [-2.0, 0.0, 0.0]
fixed = true
"""

CLAMP = 'kind = "clamp"\nbetween = ["a", "b"]\nat = [0.6, 0.35, 0.48]\nto = [0.6, 0.65, 0.48]\naxial_stiffness = 1e7\n'
CLAMP = CLAMP.replace("0.6,", "0.3,") + "shear_stiffness = 1e7"
DOWEL = 'kind = "dowel"\nbetween = ["a", "top"]\nshear_stiffness = 1e7'
TIE = 'kind = "tie"\nbetween = ["ground", "top"]\nat = [-0.6, 0.0, 0.0]\nto = [-0.6, 0.0, 0.8]\naxial_stiffness = 1e6'
PAD = 'kind = "pad"\nbetween = ["ground", "c"]\nmaterial = "lead"\nthickness = 0.002'

SHAFT = """
section = "circular"
density = 2400.0
[tapered]
height = 3.0
bottom_width = 0.8
top_width = 0.8
drums = 3
[joint]
normal_stiffness = 5e9
shear_stiffness = 2.5e9
friction_angle = 30.0
[[link]]
kind = "dowel"
joints = "all"
at = [0.1, 0.0]
diameter = 0.04
embedment = 0.08
material = "titanium"
[[link]]
kind = "tie"
at = [0.5, 0.0]
to_height = 2.5
axial_stiffness = 3e6
[[link]]
kind = "pad"
joint = 1
material = "lead"
thickness = 0.002
[[as_found.drum]]
index = 2
offset = 0.02
offset_azimuth = 30.0
turn = 10.0
"""


def written(tmp_path, *tables: str):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE + "".join(f"[[link]]\n{table}\n" for table in tables))
    return path


def test_links_are_read_with_their_places(tmp_path) -> None:
    scene = st.read_assembly(written(tmp_path, CLAMP, DOWEL, TIE, PAD))
    clamp, dowel, tie, pad = scene.placed_links
    assert clamp.middle == pytest.approx((0.3, 0.5, 0.48))
    assert clamp.frame[2] == pytest.approx((0.0, 1.0, 0.0))
    assert np.array(clamp.frame) @ np.array(clamp.frame).T == pytest.approx(np.eye(3))
    assert dowel.name == "dowel between a and top"
    assert dowel.low == pytest.approx((0.0, 0.0, 0.5))
    assert tie.length == pytest.approx(0.8)
    lead = 5.0e9 / (1.0 + 5.0e9 * 0.002 / 16.1e9)
    assert scene.law_between(0, 3).normal_stiffness == pytest.approx(1.0 / (1e-9 + 0.002 / 16.1e9))
    assert scene.law_between(0, 1).normal_stiffness == 1e9
    assert pad.bed_stiffness == pytest.approx(lead / (1.0 - lead / 5.0e9))
    again = type(scene).from_dict(scene.to_dict())
    assert again.digest == scene.digest
    assert again.placed_links == scene.placed_links


def test_links_of_columns_come_with_them_as_found_and_turned(tmp_path) -> None:
    """At [0.1, 0] of a column turned by 30°, whose second drum is 20 mm aside towards 30° and turned by 10°."""
    (tmp_path / "shaft.toml").write_text(SHAFT)
    (tmp_path / "scene.toml").write_text(
        '[[column]]\nfile = "shaft.toml"\nat = [[0.0, 0.0], [3.0, 1.0]]\nturn = 30.0\n'
    )
    scene = st.read_assembly(tmp_path / "scene.toml")
    assert len(scene.placed_links) == 10
    first, second, third, tie, pad = scene.placed_links[5:]
    assert [first.name, tie.name] == ["column 2, dowel in joint 1", "column 2, tie from the base to drum 3"]

    def at(radius, angle, x, y):
        return x + radius * np.cos(np.radians(angle)), y + radius * np.sin(np.radians(angle))

    base, aside = (3.0, 1.0), at(0.02, 60.0, 3.0, 1.0)
    assert first.low == pytest.approx((*at(0.1, 30.0, *base), 0.0))
    assert second.low == pytest.approx((*at(0.1, 40.0, *aside), 1.0))
    assert third.low == pytest.approx((*at(0.1, 40.0, *aside), 2.0))
    assert tie.low == pytest.approx((*at(0.5, 30.0, *base), 0.0))
    assert tie.high == pytest.approx((*at(0.5, 40.0, *aside), 2.5))
    assert second.arms[1] == pytest.approx((0.1, 0.0, -0.5))
    assert scene.space_joints[0].law.normal_stiffness == pytest.approx(5e9 / (1.0 + 5e9 * 0.002 / 16.1e9))
    assert pad.bed_stiffness < np.inf


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (CLAMP.replace('"b"', '"bb"'), "names block 'bb', which does not exist; did you mean b?"),
        (CLAMP.replace('"b"', '"a"'), "between 'a' and itself"),
        (CLAMP.replace('"a", "b"', '"ground", "wall"'), "between two bodies that both move with the ground"),
        (CLAMP.replace("0.35, 0.48", "0.35, 0.68"), "0.18 m outside block 'a'; its end must be in it"),
        (
            CLAMP.replace("[0.3, 0.35, 0.48]", "[0.3, 0.48]"),
            "at of a clamp is [0.3, 0.48] among bodies in space; give three",
        ),
        (CLAMP.replace("0.35,", "0.65,"), "a clamp has no length"),
        (CLAMP.replace('"b"', '"c"').replace("0.65,", "2.5,"), "mm inside block 'b' at [0.3, "),
        (CLAMP.replace("to = [0.3, 0.65, 0.48]\n", ""), "a clamp has two ends"),
        (CLAMP + "\nembedment = 0.6", "legs of a clamp are 0.6 m long, and block 'a' is 0.5 m thick"),
        (DOWEL.replace('"top"', '"c"'), "'a' and 'c' have no joint for a dowel; name two blocks whose faces touch"),
        (DOWEL + "\nat = [0.0, 0.0, 0.7]", "is 0.2 m from the joint of 'a' and 'top'"),
        (DOWEL + "\nat = [0.0, 0.7, 0.5]", "is outside the section, by 0.2 m"),
        (DOWEL + "\nat = [0.0, 0.48, 0.5]\ndiameter = 0.02", "leaves 10 mm of stone to the rim"),
        (DOWEL + "\ndiameter = 0.02\nembedment = 0.45", "embedded by 0.45 m, and block 'top' is 0.4 m high there"),
        (TIE.replace("-0.6, 0.0, 0.8", "0.6, 0.0, 0.8"), "a tie passes through stone"),
        (TIE.replace("-0.6, 0.0, 0.8", "-2.6, 0.0, 0.8"), "must be within 1 m of it"),
        (
            TIE + "\naxial_capacity = 10.0\npretension = 20.0",
            "pretension of a tie is 20 N, more than its axial capacity",
        ),
        (PAD.replace("lead", "rubber"), "has no shape_factor"),
        (PAD + "\nat = [0.0, 2.5, 0.0]", "a pad covers its joint"),
    ],
)
def test_what_cannot_be_is_said_in_one_sentence(tmp_path, capsys, table, words) -> None:
    assert call(["columns", str(written(tmp_path, table))]) == 2
    message = " ".join(capsys.readouterr().err.split())
    assert words in message
    assert "Traceback" not in message
    assert "number 1" in message or "link 1 of" in message


def test_a_dowel_between_bodies_that_touch_twice_needs_its_place() -> None:
    """An L of two parts touches a box below and beside it."""
    law = st.Joint(1e9, 5e8, friction_coefficient=0.7)
    foot = st.Stone.box((1.0, 1.0, 0.5), (0.0, 0.0, 0.0), 2000.0, name="foot")
    parts = (
        *st.Stone.box((2.0, 1.0, 0.5), (0.5, 0.0, 0.5), 2000.0).placed,
        *st.Stone.box((1.0, 1.0, 0.5), (1.0, 0.0, 0.0), 2000.0).placed,
    )
    angle = st.Stone(parts, (0.6666666666666666, 0.0, 0.5833333333333334), 2000.0, "angle")

    def scene(**where):
        dowel = block_link("dowel", ("foot", "angle"), shear_stiffness=1e6, **where)
        return st.SpatialAssembly((foot, angle), law, links=(dowel,))

    with pytest.raises(
        st.InputError, match="'foot' and 'angle' touch with 2 pairs of faces; give the place of a dowel"
    ):
        scene()
    (beside,) = scene(at=(0.5, 0.0, 0.25)).placed_links
    assert np.abs(beside.frame[2]) == pytest.approx((1.0, 0.0, 0.0))
    (above,) = scene(at=(0.0, 0.1, 0.5)).placed_links
    assert np.abs(above.frame[2]) == pytest.approx((0.0, 0.0, 1.0))
