"""Fields of a joint that may be left out: the digest is as without them, and what rebuilds a joint keeps them."""

from __future__ import annotations

import dataclasses
import json

import pytest

import stylobate as st
from stylobate.column.assembly_files import load_structure
from stylobate.column.files import column_from_dict, write_column
from stylobate.column.materials import material
from stylobate.column.scatter import LARGEST, Scatter, twins_of
from stylobate.column.tables import JointTable

COLUMN = st.Column.tapered(
    height=5.0, bottom_width=0.96, top_width=0.66, drums=12, density=1600.0, section="circular",
    joint=st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0),
)  # fmt: skip
#: SHA-256 of this column before joints had any of them but a friction.
DIGEST = "cf5328c3705b61ff5499fe2b97e3c4294dcb7b439120614cd95b9de4590d2992"

#: Of every field whose default is None a value; a new field needs one here.
VALUES = {"friction_angle": 20.0, "friction_coefficient": 0.5, "ring_width": 0.1}
OPTIONAL = [field.name for field in dataclasses.fields(st.Joint) if field.default is None]


@pytest.mark.parametrize(
    "text",
    [
        "[joint]\n{law}[tapered]\nheight = 2.0\nbottom_width = 0.5\ntop_width = 0.4\ndrums = 2\n",
        "[joint]\n{law}[[block]]\nvertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]\n",
        "[joint]\n{law}[[block]]\nname = 'a'\nbox = [1.0, 1.0, 1.0]\nat = [0.0, 0.0, 0.0]\n",
        "[joint]\n{law}friction_angle = 20.0\n[[block]]\nname = 'a'\nbox = [1.0, 1.0, 1.0]\nat = [0.0, 0.0, 0.0]\n"
        "[[joint_override]]\nbetween = ['ground', 'a']\n{law}",
    ],
    ids=["column", "plane", "space", "override"],
)
def test_a_friction_that_nobody_gives_is_none(tmp_path, text) -> None:
    """It was 35 degrees, also between two stones of a structure whose others had 20."""
    with pytest.raises(st.InputError, match="neither friction_angle"):
        st.Joint(5e10, 2.5e10)
    law = "normal_stiffness = 5.0e9\nshear_stiffness = 2.5e9\n"
    (tmp_path / "a.toml").write_text("density = 2500.0\n" + text.format(law=law))
    with pytest.raises(st.InputError, match=r"neither friction_angle .*; give one of the two, such as"):
        load_structure(tmp_path / "a.toml")
    if "override" not in text:
        (tmp_path / "a.toml").write_text("density = 2500.0\n" + text.format(law=law + "friction_coefficient = 0.6\n"))
        assert load_structure(tmp_path / "a.toml").n == text.count("drums = 2") + 1


def test_files_say_all_of_a_joint() -> None:
    assert {*JointTable.model_fields} - {"material"} == {field.name for field in dataclasses.fields(st.Joint)}


@pytest.mark.parametrize("name", OPTIONAL)
def test_what_rebuilds_a_joint_keeps_what_may_be_left_out(name, tmp_path) -> None:
    assert COLUMN.digest == DIGEST
    value = VALUES[name]
    column = COLUMN.with_joint(**{name: value})
    assert column.digest != DIGEST
    assert {getattr(joint, name) for joint in column.joints} == {value}
    for again in (
        st.read_column(write_column(column, tmp_path / "column.toml")),
        column_from_dict(json.loads(json.dumps(column.to_dict()))),
        column.with_joint(cohesion=10.0).with_joint(cohesion=0.0),
    ):
        assert again == column
        assert again.digest == column.digest
    for twin in twins_of(column, Scatter(**dict.fromkeys(LARGEST, 0.0)), 2, seed=1):
        assert [getattr(joint, name) for joint in twin.joints] == pytest.approx([value] * 12, rel=1e-15)
    path = tmp_path / "column.toml"
    override = 'index = 2\nmaterial = "marble, worn"\n'
    path.write_text(f"{path.read_text()}\n[[joint_override]]\n{override}")
    joint = st.read_column(path).joints[1]
    if name.startswith("friction"):
        assert joint.friction_coefficient == material("marble, worn").joint().tan_phi
    else:
        assert getattr(joint, name) == value


def test_both_forms_of_a_friction_are_one_friction() -> None:
    joint = COLUMN.joints[0]
    assert joint.changed(cohesion=10.0).friction_angle == 35.0
    assert st.Joint(5e10, 2.5e10, 35.0, joint.tan_phi) == joint
    steep = st.Joint(5e10, 2.5e10, friction_angle=89.9999999)
    assert steep.changed(cohesion=10.0).changed(cohesion=0.0) == steep
    with pytest.raises(st.InputError, match=r"friction_angle = 35.0 and friction_coefficient = 0.7 are both given"):
        st.Joint(5e10, 2.5e10, 35.0, 0.7)


def test_a_specimen_refuses_what_its_contact_does_not_have() -> None:
    corners = [(x, y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.3, 0.3)]
    joint = st.Joint(5e10, 2.5e10, friction_angle=35.0)
    body = st.Specimen(60.0, (1.0, 1.0, 0.4), corners, joint=joint)
    assert st.Specimen.from_dict(body.to_dict()).joint.tan_phi == joint.tan_phi
    with pytest.raises(st.InputError, match=r"has a cohesion of 10 Pa, and a specimen touches at points"):
        st.Specimen(60.0, (1.0, 1.0, 0.4), corners, joint=joint.changed(cohesion=10.0))
