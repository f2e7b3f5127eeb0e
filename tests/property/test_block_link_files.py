"""Links in assembly files: what is read, and what cannot be, said in one sentence."""

import pytest

import stylobate as st
from stylobate.cli.main import call

PAIR = """
density = 2000.0
[joint]
normal_stiffness = 1e9
shear_stiffness = 5e8
friction_coefficient = 0.7
[[block]]
name = "a"
vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]]
[[block]]
name = "b"
vertices = [[1.0, 0.0], [2.0, 0.0], [2.0, 0.5], [1.0, 0.5]]
[[block]]
name = "c"
vertices = [[2.0, 0.0], [3.0, 0.0], [3.0, 0.5], [2.0, 0.5]]
[[block]]
name = "top"
vertices = [[0.0, 0.5], [1.0, 0.5], [1.0, 0.9], [0.0, 0.9]]
"""

CLAMP = 'kind = "clamp"\nbetween = ["a", "b"]\nat = [0.85, 0.48]\nto = [1.15, 0.48]\naxial_stiffness = 1e7\n'
CLAMP += "shear_stiffness = 1e7"
DOWEL = 'kind = "dowel"\nbetween = ["a", "top"]\nshear_stiffness = 1e7'
TIE = 'kind = "tie"\nbetween = ["ground", "top"]\nat = [-0.1, 0.0]\nto = [-0.1, 0.8]\naxial_stiffness = 1e6'


def written(tmp_path, *tables: str):
    path = tmp_path / "pair.toml"
    path.write_text(PAIR + "".join(f"[[link]]\n{table}\n" for table in tables))
    return path


def test_links_are_read_with_their_places(tmp_path) -> None:
    made = 'kind = "clamp"\nbetween = ["a", "b"]\nat = [0.85, 0.48]\nto = [1.15, 0.48]\nsection = [0.03, 0.012]\n'
    made += 'embedment = 0.06\nmaterial = "iron in lead"'
    links = st.read_assembly(written(tmp_path, CLAMP, DOWEL, TIE, made)).placed_links
    assert [link.name for link in links] == [
        "clamp between a and b, 1", "dowel between a and top", "tie between ground and top", "clamp between a and b, 2",
    ]  # fmt: skip
    clamp, dowel, tie, iron = links
    assert clamp.place == pytest.approx((1.0, 0.48))
    assert clamp.along == pytest.approx((0.0, -1.0))
    assert dowel.low == pytest.approx((0.5, 0.0, 0.5))
    assert tie.length == pytest.approx(0.8)
    assert iron.axial_capacity < 200e6 * 0.03 * 0.012 * 1.0001
    assert iron.ultimate_elongation < 0.05


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (CLAMP.replace('"b"', '"bb"'), "names block 'bb', which does not exist; did you mean b?"),
        (CLAMP.replace('"b"', '"a"'), "between 'a' and itself"),
        (CLAMP.replace("[0.85, 0.48]", "[0.85, 0.68]"), "0.18 m outside block 'a'; its end must be in it"),
        (CLAMP.replace("[0.85, 0.48]", "[1.15, 0.48]"), "a clamp has no length"),
        (
            CLAMP.replace('"b"', '"c"').replace("1.15", "2.15"),
            "mm inside block 'b' at [1.0255, 0.48] m; a clamp lies in two",
        ),
        (CLAMP.replace("to = [1.15, 0.48]\n", ""), "a clamp has two ends"),
        (CLAMP + "\naxial_capacity = 0.0", "axial_capacity of a clamp is 0 N, which holds nothing"),
        (CLAMP + "\nembedment = 0.6", "legs of a clamp are 0.6 m long, and block 'a' is 0.5 m thick"),
        (CLAMP + "\nbond = 1e6", "a clamp has no 'bond'"),
        (CLAMP.replace("axial_stiffness = 1e7\n", ""), "a clamp has neither material nor axial_stiffness"),
        (CLAMP + '\nsection = [0.0, 0.01]', "section of a clamp is [0.0, 0.01] m"),
        (CLAMP.replace("clamp", "clmp"), "kind of a link is 'clmp'; did you mean clamp?"),
        (DOWEL.replace('"top"', '"c"'), "'a' and 'c' have no joint for a dowel"),
        (DOWEL + "\nat = [0.5, 0.7]", "is 0.2 m from the joint of 'a' and 'top'"),
        (DOWEL + "\nat = [1.2, 0.5]", "is outside the section, by 0.2 m"),
        (DOWEL + "\nat = [0.98, 0.5]\ndiameter = 0.02", "leaves 10 mm of stone to the rim"),
        (DOWEL + "\ndiameter = 0.02\nembedment = 0.45", "embedded by 0.45 m, and block 'top' is 0.4 m high there"),
        (DOWEL + "\nto = [0.5, 0.5]", "a dowel has one place, at"),
        (DOWEL + "\njoint = 1", "'joint'"),
        (TIE.replace("-0.1, 0.8", "0.5, 0.8"), "a tie passes through stone"),
        (TIE + "\naxial_capacity = 10.0\npretension = 20.0", "pretension of a tie is 20 N, more than its axial capacity"),
        (TIE.replace('"top"', '"ground"'), "between 'ground' and itself"),
        (TIE.replace("-0.1, 0.8", "-2.1, 0.8"), "must be within 1 m of it"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_said_in_one_sentence(tmp_path, capsys, table, words) -> None:
    assert call(["run", str(written(tmp_path, table)), "--pulse", "ricker,1Hz,0.1g"]) == 2
    message = capsys.readouterr().err
    assert words in " ".join(message.split())
    assert "Traceback" not in message


def test_a_column_has_no_clamp(tmp_path) -> None:
    path = tmp_path / "column.toml"
    text = "density = 2000.0\n[tapered]\nheight = 2.0\nbottom_width = 0.5\ntop_width = 0.5\ndrums = 2\n"
    path.write_text(
        text
        + "[joint]\nnormal_stiffness = 1e9\nshear_stiffness = 5e8\nfriction_angle = 35.0\n"
        + '[[link]]\nkind = "clamp"\njoint = 1\n'
    )
    with pytest.raises(st.InputError, match="kind of a link is 'clamp'"):
        st.read_column(path)
