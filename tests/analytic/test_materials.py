"""Stone and joints by name: the published numbers, what files make of them, and how columns of them scatter."""

import json
import math

import pytest

import stylobate as st
from stylobate.bibliography import bibliography
from stylobate.cli.main import call
from stylobate.column.files import column_from_dict, read_column, write_column
from stylobate.column.materials import MATERIALS, material
from stylobate.column.scatter import Scatter, usual_scatter

TAPERED = """material = "{material}"
[tapered]
height = 5.0
bottom_width = 0.96
top_width = 0.66
drums = 3
"""


def column_of(tmp_path, name="limestone", more=""):
    path = tmp_path / "column.toml"
    path.write_text(TAPERED.format(material=name) + more, encoding="utf-8")
    return read_column(path)


def test_every_number_lies_in_its_range_and_has_a_source():
    for substance in MATERIALS.values():
        for quantity in substance.quantities.values():
            assert quantity.low <= quantity.value <= quantity.high
            assert quantity.source in bibliography()
            assert quantity.note


def test_friction_is_the_middle_of_the_published_angles(tmp_path):
    # Barton and Choubey (1977), Table 1: limestone, dry, 31 to 37 degrees; residual angle (φ_b − 20) + 20 r/R
    assert material("limestone").friction_coefficient.value == pytest.approx(math.tan(math.radians(34.0)))
    worn = material("limestone, worn").friction_coefficient
    assert math.degrees(math.atan(worn.low)) == pytest.approx(31.0 - 20.0 + 20.0 * 0.7)
    assert math.degrees(math.atan(worn.high)) == pytest.approx(37.0 - 20.0 + 20.0 * 0.9)
    column = column_of(tmp_path)
    assert column.material == "limestone, dry"
    assert [joint.friction_angle for joint in column.joints] == pytest.approx([34.0] * 3)
    # EN 1991-1-1, Table A.2: 20 to 29 kN/m³, 24.5 / 9.80665 to the nearest 10 kg/m³
    assert {drum.density for drum in column.drums} == {2500.0}


def test_explicit_values_come_first(tmp_path):
    common = "[joint]\nnormal_stiffness = 1e9\nshear_stiffness = 5e8\nfriction_angle = 20.0\n"
    override = '[[joint_override]]\nindex = 1\nmaterial = "marble, worn"\ncohesion = 10.0\n'
    column = column_of(tmp_path, "marble, lead sheet", common + override)
    assert [round(joint.friction_angle, 6) for joint in column.joints[1:]] == [20.0, 20.0]
    assert column.joints[1].normal_stiffness == 1e9
    assert column.joints[0].tan_phi == pytest.approx(material("marble, worn").friction_coefficient.value)
    assert column.joints[0].normal_stiffness == 5e10
    assert column.joints[0].cohesion == 10.0
    assert column.drums[0].density == 2700.0


def test_its_spread_is_the_scatter_of_columns_like_it(tmp_path):
    column = column_of(tmp_path, "granite, dry")
    usual = usual_scatter(column)
    # (tan 35° − tan 31°) / (4 tan 33°); (2809 − 2516) / (4 · 2667)
    wide = math.tan(math.radians(35.0)) - math.tan(math.radians(31.0))
    assert usual.friction == pytest.approx(wide / (4.0 * math.tan(math.radians(33.0))))
    assert usual.density == pytest.approx((2809.0 - 2516.0) / (4.0 * 2667.0))
    assert usual.joint_stiffness == Scatter().joint_stiffness
    # what is given by hand is no longer the material's
    assert usual_scatter(column.with_joint(friction_angle=30.0)).friction == Scatter().friction
    assert usual_scatter(column.replace(material=None)) == Scatter()


def test_a_column_with_a_material_is_written_and_read_back(tmp_path):
    column = column_of(tmp_path, "tuff, mortared", "[joint]\nnormal_stiffness=1e9\nshear_stiffness=5e8\n")
    assert read_column(write_column(column, tmp_path / "again.toml")) == column
    assert column_from_dict(column.to_dict()) == column
    assert column.digest != column.replace(material=None).digest
    assert "material" not in column.replace(material=None).to_dict()


@pytest.mark.parametrize(
    ("name", "more", "message"),
    [
        ("Pentelic marble", "", "there is no material 'Pentelic marble'; the nearest are 'marble, dry' ("),
        ("Pentelic marbel worn", "", "the nearest are 'marble, worn' ("),
        ("Carrara", "", "there is no material 'Carrara'; stones are marble, limestone"),
        ("marbel, worn", "", "there is no material 'marbel, worn'; the nearest are 'marble, worn'"),
        ("brick", "", "there is no material 'brick'; "),
        ("tuff", "", "no friction of 'tuff, dry' is published"),
        ("marble, mortared", "", "no normal_stiffness of 'marble, mortared' is published"),
    ],
)
def test_what_is_unknown_is_said_in_one_sentence(tmp_path, name, more, message):
    with pytest.raises(st.InputError, match=r"column.toml: ") as refused:
        column_of(tmp_path, name, more)
    assert message in str(refused.value)


def test_the_command_says_value_range_and_source(capsys):
    assert call(["materials", "limestone", "--json"]) == 0
    limestone = json.loads(capsys.readouterr().out)["materials"][0]
    density = limestone["density"]
    # 20 and 29 kN/m³ over 9.81 m/s²
    assert (density["value"], density["low"], density["high"]) == (2500.0, 2039, 2956)
    assert (density["source"], density["cited"]) == ("en1991", "EN 1991-1-1:2002")
    assert limestone["not_published"] == []
    assert call(["materials", "tuf"]) == 2
    assert "'tuff, dry'" in capsys.readouterr().err
