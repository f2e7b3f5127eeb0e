"""Column files: what is written is read back equal, and every mistake is one sentence."""

import re
import tomllib
import warnings
from pathlib import Path

import pytest
from hypothesis import given, settings, strategies

import stylobate as st
from stylobate.column.assembly_files import read_assembly
from stylobate.column.catalogue import PRESETS, preset
from stylobate.column.files import column_from_dict, load_column, read_column, write_column
from stylobate.column.plausible import length_doubts, unit_doubts
from stylobate.column.scatter import Scatter, twins_of
from stylobate.column.toml import parse_toml, toml_text
from stylobate.errors import InputError

LENGTHS = strategies.floats(1e-3, 1e3)


@strategies.composite
def joints(draw):
    friction = draw(strategies.sampled_from(["friction_angle", "friction_coefficient"]))
    value = draw(strategies.floats(0.0, 89.9)) if friction == "friction_angle" else draw(strategies.floats(0.0, 100.0))
    stiffness = strategies.floats(1.0, 1e15)
    return st.Joint(draw(stiffness), draw(stiffness), cohesion=draw(strategies.floats(0.0, 1e9)), **{friction: value})


@strategies.composite
def as_found(draw, n):
    small = strategies.floats(-1e-4, 1e-4)
    drums = [
        st.FoundDrum(i, draw(small), draw(strategies.floats(-0.1, 0.1)), abs(draw(small)), abs(draw(small)))
        for i in draw(strategies.sets(strategies.integers(1, n)))
    ]
    return st.AsFound(tuple(drums), draw(strategies.floats(-0.1, 0.1)))


@strategies.composite
def columns(draw):
    section = draw(strategies.sampled_from(["circular", "rectangular"]))
    n = draw(strategies.integers(1, 6))
    drums = [
        st.Drum(
            draw(LENGTHS),
            draw(LENGTHS),
            draw(LENGTHS),
            draw(strategies.floats(1.0, 1e5)),
            section,
            draw(LENGTHS) if section == "rectangular" else 1.0,
        )
        for _ in range(n)
    ]
    signs = strategies.characters(exclude_categories=["Cs", "Cc", "Zl", "Zp"])
    name = draw(strategies.text(signs, min_size=1, max_size=20).filter(str.strip))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.OutOfRangeWarning)
        column = st.Column(
            tuple(drums), tuple(draw(joints()) for _ in range(n)), name, draw(strategies.floats(0.1, 100.0))
        )
        try:
            return column.replace(as_found=draw(strategies.none() | as_found(n)) or st.AsFound())
        except st.InputError:  # it would not stand
            return column


@pytest.mark.filterwarnings("ignore::stylobate.OutOfRangeWarning")  # sizes are anything
@settings(deadline=None)
@given(column=columns())
def test_a_written_column_is_read_back_equal(column, tmp_path_factory):
    path = write_column(column, tmp_path_factory.getbasetemp() / "round.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.OutOfRangeWarning)
        assert read_column(path) == column
        assert column_from_dict(column.to_dict()) == column


@pytest.mark.parametrize("name", PRESETS)
def test_presets_survive_a_file(name, tmp_path):
    path = write_column(preset(name), tmp_path / "column.toml")
    assert load_column(path) == load_column(name) == st.Column.from_toml(path)
    assert [file.name for file in tmp_path.iterdir()] == ["column.toml"]


TAPERED = """\
name = "paper, 12 drums"
section = "rectangular"
depth = 1.0
density = 1600.0

[tapered]
height = 5.0
bottom_width = 0.96
top_width = 0.66
drums = 12

[joint]
normal_stiffness = 5.0e10
shear_stiffness = 2.5e10
friction_angle = 35.0
"""
DRUMS = """\
density = 2620.0
[[drum]]
height = 0.82
bottom_width = 1.11
top_width = 1.08
[[drum]]
height = 1
bottom_width = 1.08
top_width = 1.0
density = 2000.0
[joint]
normal_stiffness = 5e10
shear_stiffness = 2.5e10
friction_coefficient = 0.70
[[joint_override]]
index = 2
friction_angle = 25.0
"""


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            ("density = 1600.0", "density = 2.3"),
            r"density of drum 1 is 2.3 kg/m³, and stone has 500 to 5000 kg/m³: check it",
        ),
        (
            ("height = 5.0", "height = 14.0"),
            r"height of the column over its width is 17.\d+, and columns of stone have 0 to 15",
        ),
        (("height = 5.0", "height = 680.0"), r"height of drum 1 is 56.67 m, and drums have 0.005 to 30 m: check"),
        (
            ("bottom_width = 0.96", "bottom_width = 86.0"),
            r"width of the lower face of drum 1 is 86 m, and stones have 0.005 to 10 m",
        ),
        # σ = 1600 × 9.81 × 5 Pa × 0.81/0.96 on 5e7 N/m³
        (
            ("normal_stiffness = 5.0e10", "normal_stiffness = 5.0e7"),
            r"of 5e\+07 N/m³ the closure of joint 1 by weight is 1.3\d* mm, .* 0 to 0.5 mm: check",
        ),
        (
            ("normal_stiffness = 5.0e10", "normal_stiffness = 50.0"),
            r"normal_stiffness is 50 N/m³, and nobody has measured but 1e\+07 to 1e\+13",
        ),
        (("friction_angle = 35.0", "friction_angle = 0.65"), "friction_angle is 0.65 degrees"),
    ],
)
def test_what_no_column_of_stone_is_like_is_warned_of(change, says, tmp_path):
    path = tmp_path / "column.toml"
    path.write_text(TAPERED.replace(*change))
    with pytest.warns(st.OutOfRangeWarning, match=says):
        read_column(path)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (
            "[[as_found.drum]]\nindex = 2\noffset = 0.38",
            r"offset of drum 2 over its width is 0.38, and drums are found with 0 to 0.3: check",
        ),
        ("[[as_found.drum]]\nindex = 2\noffset = 0.2", None),
    ],
)
def test_a_drum_found_near_the_edge_is_warned_of(table, says, tmp_path):
    drum = "[[drum]]\nheight = 0.74\nbottom_width = 1.0\ntop_width = 1.0\n"
    joint = "[joint]\nnormal_stiffness = 5e10\nshear_stiffness = 2.5e10\nfriction_angle = 35.0\n"
    path = tmp_path / "column.toml"
    path.write_text(f"density = 2600.0\n{drum * 6}{joint}{table}\n")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        read_column(path)
    assert (says is None and not caught) or any(re.search(says, str(w.message)) for w in caught)


def drums_of(height, width, number):
    """Equal round drums."""
    joint = st.Joint(5e10, 2.5e10, 35.0)
    return st.Column.tapered(
        height=height,
        bottom_width=width,
        top_width=width,
        drums=number,
        density=2500.0,
        joint=joint,
        section="circular",
    )


@pytest.mark.parametrize(
    ("size", "says"),
    [
        ((9.0, 0.5, 1), "the height of the column over its width is 18, and columns of stone have 0 to 15"),
        ((14.0, 1.0, 6), r"the height of drums over their width is 2.333, and those of .* have 0 to 2.2"),
        ((9.0, 1.0, 1), ""),
        ((9.0, 1.0, 4), ""),  # tall drums, as Roman columns have them
        ((19.6, 1.6, 6), ""),  # Persepolis, among the most slender of many drums
        ((5.5, 0.5, 10), ""),
    ],
)
def test_a_radius_given_for_a_diameter_makes_a_column_too_slender(size, says):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        doubts = unit_doubts(drums_of(*size))
    assert [str(warning.message) for warning in caught] == [f"'column': {doubt}" for doubt in doubts]
    assert len(doubts) == bool(says)
    assert re.search(says, " ".join(doubts))


def test_a_column_made_in_python_is_doubted_as_one_of_a_file_and_not_again():
    drums = [st.Drum(900.0, 800.0, 800.0, 2500.0, section="circular")] * 3
    joint = st.Joint(5e10, 2.5e10, 35.0)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        column = st.Column.of_drums(drums, joint)
    first, *others = (str(warning.message) for warning in caught)
    assert first == "'column': the height of drum 1 is 900 m, and drums have 0.005 to 30 m: check it and its unit."
    assert re.search("width of the lower face of drum 1 is 800 m", others[0])
    sound = drums_of(5.5, 0.5, 10)
    with pytest.warns(st.OutOfRangeWarning, match=r"density of drum 1 is 2.5 kg/m³"):
        sound.replace(drums=(st.Drum(1.0, 0.5, 0.5, 2.5, section="circular"), *sound.drums[1:]))
    with pytest.warns(st.OutOfRangeWarning, match=r"friction_angle is 0.7 degrees, and a coefficient is friction_coef"):
        sound.with_joint(friction_angle=0.7)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert column_from_dict(column.to_dict()) == column
        assert len(twins_of(column, Scatter(), 2, 1)) == 2
        assert st.Joint(5e10, 5e10, friction_angle=0.0).tan_phi == 0.0
        column.replace(name="again")


def test_no_column_that_is_known_is_doubted():
    gallery = Path(__file__).parents[2] / "gallery" / "assemblies"
    for column in (*map(preset, PRESETS), read_column(gallery / "column5.toml")):
        assert unit_doubts(column) == []


AS_FOUND = """
[as_found]
base_tilt = 0.5

[[as_found.drum]]
index = 3
offset = 0.012
tilt = -0.4

[[as_found.drum]]
index = 5
chip_left = 0.05
"""


def test_what_is_found_is_part_of_the_column(tmp_path):
    path = tmp_path / "found.toml"
    path.write_text(TAPERED + AS_FOUND)
    column = read_column(path)
    damage = st.AsFound((st.FoundDrum(3, offset=0.012, tilt=-0.4), st.FoundDrum(5, chip_left=0.05)), 0.5)
    path.write_text(TAPERED)
    as_built = read_column(path)
    assert column == as_built.replace(as_found=damage)
    assert column.digest != as_built.digest
    assert "as_found" not in as_built.to_dict()


def test_both_ways_of_stating_drums(tmp_path):
    path = tmp_path / "column.toml"
    path.write_text(TAPERED)
    tapered = read_column(path)
    assert tapered == st.Column.tapered(
        height=5.0,
        bottom_width=0.96,
        top_width=0.66,
        drums=12,
        density=1600.0,
        joint=st.Joint(5e10, 2.5e10, friction_angle=35.0),
        name="paper, 12 drums",
    )
    path.write_text(DRUMS)
    column = read_column(path)
    assert column.name == "column"
    assert [drum.density for drum in column.drums] == [2620.0, 2000.0]
    assert column.joints[0].friction_coefficient == 0.70
    assert column.joints[1] == st.Joint(5e10, 2.5e10, friction_angle=25.0)


@given(data=strategies.data())
def test_a_misspelt_key_is_named_with_the_right_one(data, tmp_path_factory):
    lines = TAPERED.splitlines()
    at = data.draw(strategies.sampled_from([i for i, line in enumerate(lines) if "=" in line]))
    key, _, value = lines[at].partition(" = ")
    cut = data.draw(strategies.integers(0, len(key) - 1))
    wrong = key[:cut] + key[cut + 1 :]
    lines[at] = f"{wrong} = {value}"
    path = tmp_path_factory.getbasetemp() / "misspelt.toml"
    path.write_text("\n".join(lines))
    with pytest.raises(st.InputError) as error:
        read_column(path)
    assert f"unknown key '{wrong}'" in str(error.value)
    assert f"did you mean {key}?" in str(error.value)
    assert "misspelt.toml" in str(error.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (TAPERED.replace("height = 5.0\n", ""), ["'height'", "missing", "[tapered]"]),
        (TAPERED.replace("height = 5.0", "height = -5.0"), ["height", "-5 m", "[0.0001, 1000] m"]),
        (TAPERED.replace("height = 5.0", 'height = "5 m"'), ["'height' in [tapered]", "'5 m'", "a number"]),
        (TAPERED.replace("height = 5.0", "height = inf"), ["height", "inf"]),
        (TAPERED.replace("drums = 12", "drums = 12.0"), ["'drums' in [tapered]", "whole number"]),
        (TAPERED.replace("drums = 12", "drums = true"), ["'drums' in [tapered]", "whole number"]),
        (TAPERED.replace("drums = 12", "drums = 0"), ["drums is 0", "1 to 200"]),
        (TAPERED.replace("drums = 12", "drums = 1000000"), ["drums is 1000000", "1 to 200"]),
        (TAPERED.replace("density = 1600.0\n", ""), ["'density'", "missing"]),
        (TAPERED.replace('"rectangular"', '"round"'), ["'round'", "circular, rectangular"]),
        (TAPERED.replace('"rectangular"', '"circular"'), ["depth", "circular", "leave it out"]),
        (TAPERED.split("[joint]")[0], ["no [joint] table", "normal_stiffness"]),
        (TAPERED.replace("5.0e10", "0.0"), ["normal_stiffness", "0 N/m³"]),
        (TAPERED.replace("= 35.0", "= 90.0"), ["friction_angle", "[0, 90) degrees"]),
        (TAPERED + "friction_coefficient = 0.7\n", ["both given", "one of the two"]),
        (TAPERED + "[[drum]]\nheight = 1.0\nbottom_width = 1.0\ntop_width = 1.0\n", ["both [tapered] and [[drum]]"]),
        (TAPERED + "[[joint_override]]\nindex = 13\n", ["index is 13", "to 12"]),
        (TAPERED + "[[joint_override]]\nindex = 0\n", ["index is 0", "from 1 to 12; 1 is at the base"]),
        (TAPERED + "[[joint_override]]\nindex = 3\nfriction_angle = 95.0\n", ["index 3", "95 degrees"]),
        (TAPERED + 2 * "[[joint_override]]\nindex = 3\n", ["index 3", "twice"]),
        (DRUMS.replace("top_width = 1.0\n", ""), ["'top_width'", "missing", "[[drum]] number 2"]),
        (DRUMS.replace("density = 2620.0\n", ""), ["[[drum]] number 1", "no density"]),
        (DRUMS.replace("0.82", "-0.82"), ["[[drum]] number 1", "-0.82 m"]),
        (
            "[joint]\nnormal_stiffness = 1e10\nshear_stiffness = 1e10\nfriction_angle = 35.0\n",
            ["neither [tapered] nor [[drum]]"],
        ),
        ("height = [1,", ["not valid TOML"]),
        ("", ["no [joint] table"]),
    ],
)
def test_every_mistake_is_one_sentence(text, words, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(st.InputError) as error:
        read_column(path)
    message = str(error.value)
    assert message.startswith(str(path))
    assert "\n" not in message
    for word in words:
        assert word in message


def test_a_column_that_is_neither_preset_nor_file(tmp_path):
    with pytest.raises(st.InputError, match=r"did you mean paper-12-drums\?"):
        load_column("paper-12-drum")
    with pytest.raises(st.InputError, match="there is no file"):
        load_column(tmp_path / "none.toml")
    with pytest.raises(st.InputError, match="is a folder"):
        load_column(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(st.InputError, match="not a text file in UTF-8"):
        load_column(tmp_path / "binary.toml")
    with pytest.raises(st.InputError, match="does not exist"):
        write_column(preset("paper-monolithic"), tmp_path / "none" / "column.toml")


@pytest.mark.parametrize(
    ("line", "warning"),
    [
        ("friction_coefficient = 3.5", "friction_coefficient is 3.5, and nobody has measured but 0 to 2"),
        ("normal_stiffness = 5e6", "normal_stiffness is 5e\\+06 N/m³, and nobody has measured but 1e\\+07"),
        ("shear_stiffness = 5e13", "shear_stiffness is 5e\\+13 N/m³, and nobody has measured"),
    ],
)
def test_joints_that_nobody_has_measured_are_warned_about(line, warning, tmp_path):
    joint = {"normal_stiffness": "5e10", "shear_stiffness": "2.5e10", "friction_coefficient": "0.7"}
    key, _, value = line.partition(" = ")
    rows = "\n".join(f"{name} = {number}" for name, number in (joint | {key: value}).items())
    path = tmp_path / "column.toml"
    path.write_text(
        "density = 2000.0\n[tapered]\nheight = 2.0\nbottom_width = 0.6\ntop_width = 0.6\ndrums = 1\n[joint]\n" + rows
    )
    with pytest.warns(st.OutOfRangeWarning, match=warning):
        read_column(path)


def test_links_that_nobody_makes_are_warned_about(tmp_path):
    """A capacity in kN, a stiffness in kN/mm."""
    path = tmp_path / "column.toml"
    path.write_text(
        "density = 2000.0\n[tapered]\nheight = 2.0\nbottom_width = 0.6\ntop_width = 0.6\ndrums = 2\n[joint]\n"
        "normal_stiffness = 5e10\nshear_stiffness = 2.5e10\nfriction_coefficient = 0.7\n[[link]]\nkind = 'dowel'\n"
        "joint = 2\ndiameter = 0.03\nembedment = 0.1\nshear_stiffness = 50.0\nshear_capacity = 40.0\n"
    )
    with pytest.warns(st.OutOfRangeWarning) as warnings:
        read_column(path)
    texts = " ".join(str(warning.message) for warning in warnings)
    assert "shear_capacity is 40 N, and links bear 50 to 1e+08 N" in texts
    assert "shear_stiffness is 50 N/m, and links have 10000 to 1e+12 N/m" in texts


def test_a_taper_in_depth_goes_through_a_file(tmp_path):
    """In both ways of stating drums; a column that has none keeps its digest."""
    (tmp_path / "a.toml").write_text(
        "depth = 1.11\ndensity = 2620.0\n[tapered]\nheight = 5.95\nbottom_width = 1.11\ntop_width = 0.9\ndrums = 8\n"
        "top_depth = 0.9\n[joint]\nnormal_stiffness = 1e10\nshear_stiffness = 1e10\nfriction_angle = 35.0\n"
    )
    column = st.Column.from_toml(tmp_path / "a.toml")
    assert column.drums[0].depth == 1.11
    assert column.drums[-1].top_depth == pytest.approx(0.9, rel=1e-15)
    assert column.drums[3].top_depth == column.drums[4].depth
    again = read_column(write_column(column, tmp_path / "b.toml"))
    assert again == column
    assert again.digest == column.digest
    assert column_from_dict(column.to_dict()) == column
    assert "top_depth" not in st.preset("paper-12-drums").to_dict()["drums"][0]


def test_one_drum_too_high_is_told_apart_from_a_column_too_high(tmp_path):
    drums = "".join(f"[[drum]]\nheight = {h}\nbottom_width = 1.0\ntop_width = 1.0\n" for h in (0.86, 86.0, 0.86))
    law = "[joint]\nnormal_stiffness = 5e10\nshear_stiffness = 2.5e10\nfriction_angle = 35.0\n"
    path = tmp_path / "column.toml"
    path.write_text(f"density = 2500.0\n{drums}{law}")
    with pytest.warns(st.OutOfRangeWarning) as seen:
        read_column(path)
    assert [str(warning.message) for warning in seen] == [
        "'column': the height of drum 2 is 86 m, and drums have 0.005 to 30 m: check it and its unit."
    ]


def test_a_key_of_a_table_in_a_table_is_told_by_the_whole_path(tmp_path):
    path = tmp_path / "column.toml"
    path.write_text(TAPERED + "\n[[as_found.drum]]\nindex = 2\nofset = 0.01\n")
    with pytest.raises(
        InputError, match=r"unknown key 'ofset' in \[\[as_found\.drum\]\] number 1; did you mean offset"
    ):
        read_column(path)


def test_each_kind_of_length_is_doubted_once():
    assert length_doubts([74.2, 73.1], [(120.4, 117.2), (117.2, 114.1)]) == [
        "the height of drum 1 is 74.2 m, and drums have 0.005 to 30 m: check it and its unit.",
        "the width of the lower face of drum 1 is 120.4 m, and stones have 0.005 to 10 m: check it and its unit.",
    ]
    assert length_doubts([25.0, 25.0, 25.0], [(1.2, 1.1)] * 3)[0].startswith("the height of the column is 75 m")
    assert length_doubts([0.742], [(1.2, 1.1)], [90.0])[0].startswith("the depth of drum 1 is 90 m")
    assert length_doubts([0.742], [(1.2, 1.1)], [0.9]) == []


@pytest.mark.parametrize(
    ("line", "warning"),
    [
        ("height = 86.0", r"size of block 'a' is 86 m, and stones have 0.05 to 60 m: check"),
        ("depth = 80.0", r"size of block 'a' is 80 m, and stones have"),
        ("density = 2.5", r"density of block 'a' is 2.5 kg/m³, and stone has 500 to 5000 kg/m³"),
        ("normal_stiffness = 5e7", r"closure of the joint under block 'a' by weight is 1.962 mm, and dry joints"),
    ],
)
def test_blocks_of_an_assembly_are_doubted_as_drums_are(line, warning, tmp_path):
    values = {"height": "4.0", "density": "2500.0", "normal_stiffness": "5e10", "depth": "0.8"}
    name, _, value = line.partition(" = ")
    values[name] = value
    h = values["height"]
    path = tmp_path / "block.toml"
    path.write_text(
        f"density = {values['density']}\ndepth = {values['depth']}\n"
        f"[joint]\nnormal_stiffness = {values['normal_stiffness']}\nshear_stiffness = 2e10\nfriction_angle = 35.0\n"
        f"[[block]]\nname = 'a'\nvertices = [[0.0, 0.0], [0.8, 0.0], [0.8, {h}], [0.0, {h}]]\n"
    )
    with pytest.warns(st.OutOfRangeWarning, match=warning) as seen:
        read_assembly(path)
    assert len(seen) == 1


SCALARS = (
    strategies.integers(-5, 5)
    | strategies.floats(-1e9, 1e9)
    | strategies.booleans()
    | strategies.text("ab \n\"'#é", max_size=5)
)
KEYS = strategies.text("abc_", min_size=1, max_size=3)
VALUES = strategies.recursive(
    SCALARS,
    lambda children: strategies.lists(children, max_size=3) | strategies.dictionaries(KEYS, children, max_size=3),
)


@given(
    strategies.dictionaries(KEYS, VALUES, max_size=5), strategies.lists(strategies.text("ab #", max_size=4), max_size=2)
)
def test_a_file_under_headings_holds_the_same_tables(tables, comments):
    assert tomllib.loads(toml_text(tables, comments)) == tables


MISTAKES = {
    "height = .8": 0.8,
    "height = 1.": 1.0,
    "height = 5.e9": 5e9,
    "height = 0,85": 0.85,
    "height = 08": 8,
    "height = .8 m": 0.8,
    "height = 35° # of the joint": 35,
    "height = 5e9 N/m³": 5e9,
    "height = \N{MINUS SIGN}0.8": -0.8,
    "height = 0.8\N{NO-BREAK SPACE}": 0.8,
    "height = 0.8;": 0.8,
    "height: 0.8": 0.8,
    "height = True": True,
    "height = no": False,
    "height = 1.0 e10": 1.0e10,
    "height = [.5, 1.]": [0.5, 1.0],
    "height = [0.5 m, .3 m],": [0.5, 0.3],
    "height = “Ναός”": "Ναός",
    "height = «Ναός»": "Ναός",
    "height = ‘test’": "test",
    "height = temple of Zeus # as known": "temple of Zeus",
    'height = "sub\\ok.toml"': "sub/ok.toml",
}


@pytest.mark.parametrize("line", MISTAKES)
def test_the_advice_on_a_slip_of_the_hand_works(tmp_path, line):
    """What stands behind "write" is put in the place of the value, and the file is read as it was meant."""
    (tmp_path / "a.toml").write_text(f'name = "a"\n{line}\n', encoding="utf-8")
    with pytest.raises(InputError, match=r": write .*\.$") as refused:
        parse_toml(tmp_path / "a.toml")
    advice = str(refused.value).partition(": write ")[2].removesuffix(".").removeprefix("height = ")
    (tmp_path / "a.toml").write_text(f'name = "a"\nheight = {advice}\n', encoding="utf-8")
    assert parse_toml(tmp_path / "a.toml") == {"name": "a", "height": MISTAKES[line]}


def test_no_value_is_advised_that_would_be_a_guess(tmp_path):
    """80 cm are not 80 m; a table that stands there twice may be two of a list, or one too many."""
    for text, advice in {
        "height = 80 cm": "give the number alone, in SI units",
        "height = 3/4": "column 11); a line is a key, =, and a number",
        "height = None": "column 10); a line is a key, =, and a number",
        "height = 1.0\nheight = 2.0": "leave one out",
        "[drum]\nheight = 1.0\n[drum]\nheight = 2.0": "write [[drum]] each time if there may be several, as of drums",
    }.items():
        (tmp_path / "a.toml").write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=re.escape(advice)) as refused:
            parse_toml(tmp_path / "a.toml")
        assert not re.search(r"write [\d\"]", str(refused.value))
    (tmp_path / "a.toml").write_text("[drum]\nheight = 1.0\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"it must be a list: write \[\[drum\]\], with two brackets"):
        load_column(tmp_path / "a.toml")
    (tmp_path / "sub").mkdir()
    write_column(preset("paper-monolithic"), tmp_path / "sub" / "ok.toml")
    (tmp_path / "b.toml").write_text("[[column]]\nfile = 'sub\\ok.toml'\nat = [0.0]\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"; write .*sub/ok\.toml"):
        read_assembly(tmp_path / "b.toml")
