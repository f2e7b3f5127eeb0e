"""Assemblies made of columns from files and beams on them, and the commands that take assemblies."""

import json
import shutil
from pathlib import Path

import pytest

import stylobate as st
from stylobate.cli.main import call

GALLERY = Path(__file__).parents[2] / "gallery" / "assemblies"


@pytest.fixture
def folder(tmp_path):
    for name in ("two_columns.toml", "column5.toml"):
        shutil.copy(GALLERY / name, tmp_path / name)
    return tmp_path


def test_two_columns_and_an_architrave(folder):
    column, assembly = st.read_column(folder / "column5.toml"), st.read_assembly(folder / "two_columns.toml")
    assert [block.name for block in assembly.blocks][-2:] == ["column 2, drum 5", "architrave"]
    # five joints in each column, and the architrave on both
    assert len(assembly.joints) == 12
    drums = assembly.blocks[:5]
    assert sum(block.properties[0] for block in drums) == pytest.approx(column.mass)
    assert [block.properties[2] for block in assembly.blocks[5:10]] == pytest.approx([2.6] * 5)
    beam = assembly.blocks[-1]
    assert beam.corners.min(axis=0) == pytest.approx((1.3 - 1.7, 4.0))
    assert beam.properties[0] == pytest.approx(column.drums[0].density * 3.4 * 0.5 * 0.6)
    assert assembly.joint == column.joints[-1]


COLONNADE = """
[[column]]
file = "column5.toml"
number = 4
spacing = 2.3
[[beam]]
on = [1, 2]
overhang = [0.4, 0]
height = 0.5
[[beam]]
on = [2, 3]
length = 2.3
height = 0.5
[[beam]]
between = ["column 3", "column 4"]
overhang = [0.0, 0.4]
height = 0.5
"""


def test_architraves_that_meet_on_an_axis_share_the_top_of_the_column(folder):
    """Ends by overhang, by length and by names; each rests on its half, and they touch without an overlap."""
    path = folder / "colonnade.toml"
    path.write_text(COLONNADE)
    assembly = st.read_assembly(path)
    beams = assembly.blocks[-3:]
    ends = [(architrave.corners[:, 0].min(), architrave.corners[:, 0].max()) for architrave in beams]
    assert ends == [pytest.approx(span) for span in ((-0.4, 2.3), (2.3, 4.6), (4.6, 7.3))]
    names = [body.name for body in assembly.bodies]
    touching = {frozenset((names[joint.lower], names[joint.upper])) for joint in assembly.joints}
    for beam, left, right in ((1, 1, 2), (2, 2, 3), (3, 3, 4)):
        for column in (left, right):
            assert {f"architrave {beam}", f"column {column}, drum 5"} in touching
    assert {"architrave 1", "architrave 2"} in touching
    path.write_text(COLONNADE.replace("overhang = [0.4, 0]", "overhang = 0.4"))
    with pytest.raises(st.InputError, match="block 'architrave 2' and block 'architrave 1' overlap by 400 mm"):
        st.read_assembly(path)


def test_critical_suite_and_study_take_it(tmp_path, capsys):
    # two slender blocks on soft joints, and a beam: 1.05 g for half a second throws them over, 0.05 g does not open a joint
    (tmp_path / "pillar.toml").write_text(
        "density = 2000.0\n[tapered]\nheight = 2.0\nbottom_width = 0.4\ntop_width = 0.4\ndrums = 1\n"
        "[joint]\nnormal_stiffness = 2e8\nshear_stiffness = 1e8\nfriction_coefficient = 0.7\n"
    )
    frame = tmp_path / "frame.toml"
    frame.write_text(
        '[[column]]\nfile = "pillar.toml"\nat = [0.0, 1.5]\n[[beam]]\nlength = 2.0\nheight = 0.3\ndepth = 0.5\n'
    )
    motion = ["--pulse", "rectangular,1.0Hz,?g,2s", "--from", "0.05g", "--to", "1.05g", "--step", "1g"]
    assert call(["critical", str(frame), *motion, "--json", "--out", str(tmp_path / "critical")]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert (answer["runs"], answer["critical_g"]) == (2, pytest.approx(1.05))
    time = [0.01 * i for i in range(60)]
    record = "".join(f"{t:.2f},{0.05 if 0.1 < t < 0.5 else 0.0}\n" for t in time)
    (tmp_path / "weak.csv").write_text("time_s,ax_g\n" + record)
    assert call(["suite", str(frame), str(tmp_path / "weak.csv"), "--out", str(tmp_path / "suite"), "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["runs"]
    assert row["collapsed"] is False
    assert row["peak_displacement_m"] < 1e-2
    assert "base_width_m" not in row
    assert (tmp_path / "suite" / "suite.png").is_file()
    study = tmp_path / "study.toml"
    study.write_text('column = "frame.toml"\nmodel = "dem2d"\n[motions]\nfiles = ["weak.csv"]\n')
    assert call(["study", "run", str(study), "--out", str(tmp_path / "out"), "--json"]) == 0
    counts = json.loads(capsys.readouterr().out)
    assert (counts["cases"], counts["finished"], counts["collapsed"]) == (1, 1, 0)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("number = 2", ""), "needs at = [...], or number and spacing"),
        (("spacing = 2.6", ""), "have no spacing"),
        (("length = 3.4", "length = 1.0"), "reaches from 0.8 to 1.8 m, and 'column 1' stands at 0 m"),
        (("length = 3.4", "centre = 1.0"), "has a centre and no length"),
        (("length = 3.4", "length = 3.4\noverhang = 0.1"), "has a length and an overhang"),
        (("length = 3.4", "overhang = [0.1]"), "has 1 values; give one, or that on the left and right"),
        (("length = 3.4", "overhang = -0.1"), "overhang of beam 'architrave' is -0.1 m; allowed is [0, 100] m"),
        (("length = 3.4", "overhang = 'x'"), "'overhang' in [[beam]] number 1 is 'x'; it must be a number or a list"),
        (("depth = 0.6", "between = ['column 1', 'colum 2']"), "'colum 2'; did you mean column 2?"),
        (("depth = 0.6", "between = ['column 1']"), "lies between 1 columns; name two different ones"),
        (("depth = 0.6", "between = ['column 1', 'column 2']\non = [1, 2]"), "has on and between"),
        (("length = 3.4", "on = [1]"), "lies on one axis and has no length"),
        (("depth = 0.6", "depth = 0.6\non = [1, 3]"), "lies on column 3; the file has columns 1 to 2"),
        (("column5.toml", "column6.toml"), "column6.toml"),
        (("spacing = 2.6", "spacing = 0.5"), "overlap"),
    ],
)
def test_what_cannot_stand_is_said_in_one_sentence(folder, capsys, change, words):
    path = folder / "two_columns.toml"
    path.write_text(path.read_text(encoding="utf-8").replace(*change), encoding="utf-8")
    assert call(["run", str(path), "--pulse", "ricker,1Hz,0.1g"]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["critical", "{file}", "--model", "dem3d"], "is an assembly; dem2d"),
        (["critical", "{file}", "--replicates", "5"], "only columns and assemblies in space have twins"),
        (["limit", "{file}"], "is no prism of its outline"),
        (["pushover", "{file}"], "describes an assembly of blocks"),
        (
            ["suite", "{file}", "sample:el-centro-1940", "--replicates", "5"],
            "only columns and assemblies in space have twins",
        ),
        (["suite", "{file}", "sample:el-centro-1940", "--also", "paper-monolithic"], "holds columns and assemblies"),
        (["suite", "{file}", "sample:el-centro-1940", "--against", "omega_g_over_p"], "--against is 'omega_g_over_p'"),
    ],
)
def test_commands_that_do_not_take_it_say_so(folder, capsys, arguments, words):
    how = ["--pulse", "ricker,1Hz,?g", "--from", "0.1g", "--to", "0.2g"] if arguments[0] == "critical" else []
    assert call([argument.format(file=folder / "two_columns.toml") for argument in arguments] + how) == 2
    assert words in capsys.readouterr().err
