"""``stylobate modes``: keys that scripts rest on, files, what is told, what is refused."""

import json

import pytest

import stylobate as st
from stylobate.cli.main import call

COLUMN = """
name = "three drums"
section = "circular"
density = 2620.0
[tapered]
height = 5.95
bottom_width = 1.11
top_width = 0.9
drums = 3
[joint]
normal_stiffness = 1.0e10
shear_stiffness = 5.0e9
friction_angle = 35.0
"""


@pytest.fixture
def column(tmp_path):
    file = tmp_path / "column.toml"
    file.write_text(COLUMN)
    return str(file)


def test_modes_as_json(column, capsys):
    """The keys of the interface; 15.50 Hz is that of the rim law, twice k_n in bending."""
    assert call(["modes", column, "--json", "--number", "2"]) == 0
    answer = json.loads(capsys.readouterr().out)
    rows = [(mode["kind"], mode["number"]) for mode in answer["modes"]]
    assert rows == [(kind, number) for kind in ("bending", "torsion", "axial") for number in (1, 2)]
    assert answer["joint_bending_stiffness"] == pytest.approx(2e10)
    assert answer["joint_shear_stiffness"] == pytest.approx(5e9)
    modes = st.modes(st.read_column(column), st.DistinctElement3D())
    assert answer["modes"][0]["frequency_hz"] == modes.bending[0]
    assert answer["modes"][0]["bent_joint"] == "joint 1"
    assert 0.0 < answer["modes"][0]["holds_to_m"] < 1e-3
    assert len(answer["drops"]) == 3
    assert "inferred" not in answer


def test_other_models_have_other_joints(column, capsys):
    """2 : √2 : 1 of the three laws, nearly: k_b/J_A is 4, 2 and 1 times k_n."""
    first = {}
    for name, more in (("points", ["--model", "dem2d"]), ("rim", []), ("bed", ["--set", "law=bed"])):
        assert call(["modes", column, "--json", *more]) == 0
        answer = json.loads(capsys.readouterr().out)
        first[name] = answer["modes"][0]["frequency_hz"], answer["joint_bending_stiffness"]
    assert [first[name][1] for name in first] == pytest.approx([4e10, 2e10, 1e10])
    assert first["points"][0] / first["bed"][0] == pytest.approx(2.0, rel=0.05)
    assert first["rim"][0] / first["bed"][0] == pytest.approx(2.0**0.5, rel=0.03)


def test_measured_frequencies_become_a_column_and_a_scatter(column, tmp_path, capsys):
    """The files are read back: a column on the median joints, whose first frequency is what was measured."""
    out = tmp_path / "out"
    measured = "8.0Hz±2%,38Hz±4%,torsion 29Hz±4%"
    assert call(["modes", column, "--json", "--measured", measured, "--ground", "rigid", "--out", str(out)]) == 0
    inference = json.loads(capsys.readouterr().out)["inferred"]
    assert inference["confidence"] == 0.95
    assert [frequency["standard_deviation_hz"] for frequency in inference["measured"]] == pytest.approx(
        [0.16, 1.52, 1.16]
    )
    bending = inference["joint_bending_stiffness"]
    assert bending["low"] < bending["median"] < bending["high"]
    inferred = st.read_column(out / "column.toml")
    assert inferred.joints[0].normal_stiffness == pytest.approx(0.5 * bending["median"], rel=1e-9)
    assert st.modes(inferred, st.DistinctElement3D()).bending[0] == pytest.approx(8.0, rel=0.03)
    assert (out / "scatter.toml").read_text().count("joint_stiffness") == 2
    names = {file.name for file in out.glob("[!.]*")}
    assert names == {
        "modes.json", "drops.csv", "modes.png", "modes.svg", "column.toml", "scatter.toml", "asked-modes.json"
    }  # fmt: skip


def test_what_stays_open_is_null_and_said(column, capsys):
    assert call(["modes", column, "--json", "--measured", "8.0Hz±2%", "--ground", "rigid"]) == 0
    inference = json.loads(capsys.readouterr().out)["inferred"]
    assert inference["joint_bending_stiffness"]["high"] is None
    assert inference["joint_bending_stiffness"]["median"] is None
    assert inference["joint_bending_stiffness"]["low"] > 1e9
    assert call(["modes", column, "--measured", "8.0Hz±2%", "--ground", "rigid"]) == 0
    assert "no upper bound: rigid joints would give these frequencies too" in capsys.readouterr().out.replace("\n", " ")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--measured", "8.0Hz±2%"], "needs the ground on which it was measured; give --ground rigid"),
        (["--ground", "rigid"], "is for what was measured; give --measured too"),
        (["--measured", "8.0Hz", "--ground", "rigid"], "has no spread"),
        (["--model", "housner"], "allowed are dem2d and dem3d"),
        (["--number", "0"], "allowed is a whole number from 1"),
        (["--left", "2"], "left is 2; allowed is (0, 1)"),
    ],
)
def test_bad_input_is_one_sentence(column, capsys, words, sentence):
    assert call(["modes", column, *words]) == 2
    message = " ".join(capsys.readouterr().err.split())
    assert sentence in message


def test_an_assembly_in_space(tmp_path, capsys):
    """Two columns and a beam: the names of what is bent, and a picture."""
    file = tmp_path / "portal.toml"
    file.write_text(
        """
        name = "portal"
        [joint]
        normal_stiffness = 5.0e9
        shear_stiffness = 2.5e9
        friction_angle = 35.0
        [[column]]
        file = "column.toml"
        at = [[0.0, 0.0], [2.6, 0.0]]
        [[beam]]
        between = ["column 1", "column 2"]
        section = [0.8, 0.6]
        """
    )
    (tmp_path / "column.toml").write_text(COLUMN)
    assert call(["modes", str(file), "--json", "--number", "3", "--out", str(tmp_path / "out")]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert [mode["kind"] for mode in answer["modes"][:3]] == ["bending"] * 3
    assert " – " in answer["modes"][0]["bent_joint"]
    assert answer["joint_bending_stiffness"] is None
    assert (tmp_path / "out" / "modes.png").stat().st_size > 5000
    assert call(["modes", str(file), "--measured", "2Hz±2%", "--ground", "rigid"]) == 2
    assert "--measured is of columns" in capsys.readouterr().err
