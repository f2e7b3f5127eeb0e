"""What the page is told of columns and motions: properties, outlines, measures, and errors at their fields."""

import copy
import re

import numpy as np
import pytest

import stylobate as st
from stylobate_exchange.convert import Reading, convert


def test_a_column_has_the_properties_of_the_library(client, table):
    answer = client.post("/api/column", json=table).json()
    column = st.Column.of_drums(
        [st.Drum(drum["height"], drum["bottom_width"], drum["top_width"], 1600.0) for drum in table["drum"]],
        st.Joint(5e10, 2.5e10, friction_coefficient=0.7),
    )
    assert answer["facts"]["mass"] == pytest.approx(column.mass)
    assert answer["facts"]["uplift_g"] == pytest.approx(column.uplift_acceleration / st.g)
    corners = np.array(answer["outlines"]["xz"][2])
    assert corners[:, 1].max() == pytest.approx(column.height, abs=1e-4)
    assert np.ptp(corners[:, 0]) == pytest.approx(table["drum"][2]["bottom_width"], abs=2e-4)


def test_offsets_move_the_outlines(client, table):
    straight = client.post("/api/column", json=table).json()["outlines"]["xz"]
    moved = table | {"as_found": {"drum": [{"index": 2, "offset": 0.05}]}}
    outlines = client.post("/api/column", json=moved).json()["outlines"]["xz"]
    assert np.array(outlines[0]) == pytest.approx(np.array(straight[0]), abs=1e-4)
    for i in (1, 2):
        assert np.array(outlines[i])[:, 0] == pytest.approx(np.array(straight[i])[:, 0] + 0.05, abs=2e-4)
    aside = table | {"as_found": {"drum": [{"index": 2, "offset": 0.05, "offset_azimuth": 90}]}}
    in_space = client.post("/api/column", json=aside).json()
    assert in_space["in_space"]
    seen = np.array(in_space["outlines"]["yz"][1])
    assert seen[:, 0].mean() == pytest.approx(0.05, abs=1e-3)


def put(table, path, value):
    changed_table = copy.deepcopy(table)
    group, *rest = path.split(".")
    if group == "drum":
        changed_table["drum"][int(rest[0]) - 1][rest[1]] = value
    elif group == "found":
        changed_table["as_found"] = {"drum": [{"index": 1, "offset": 0.001}, {"index": int(rest[0]), rest[1]: value}]}
    elif group == "override":
        changed_table["joint_override"] = [{"index": int(rest[0]), rest[1]: value}]
    elif group == "joint":
        changed_table["joint"] = {"normal_stiffness": 5e10, "shear_stiffness": 2.5e10} | {rest[0]: value}
    elif group.startswith("base"):
        changed_table["as_found"] = {group: value}
    else:
        changed_table[group] = value
    return changed_table


FIELDS = (
    [("drum.2", name) for name in ("height", "bottom_width", "top_width", "density", "depth")]
    + [
        ("found.3", name)
        for name in (
            "offset",
            "tilt",
            "chip_left",
            "chip_right",
            "chip_front",
            "chip_azimuth",
            "offset_azimuth",
            "turn",
        )
    ]
    + [("joint", name) for name in ("normal_stiffness", "shear_stiffness", "friction_coefficient", "cohesion")]
    + [("override.2", name) for name in ("normal_stiffness", "friction_coefficient", "cohesion")]
    + [(None, "gravity"), (None, "base_tilt"), (None, "base_azimuth")]
)


@pytest.mark.parametrize(("where", "name"), FIELDS)
@pytest.mark.parametrize("value", [-1e9, "abc"])
def test_every_error_finds_its_field(client, table, where, name, value):
    """Whatever is out of range or no number at all, in the library's words, is marked where it was typed."""
    path = name if where is None else f"{where}.{name}"
    answer = client.post("/api/column", json=put(table, path, value))
    assert answer.json()["field"] == path, answer.json()["error"]


DOWEL = {"kind": "dowel", "joint": 2, "diameter": 0.03, "embedment": 0.1, "material": "titanium"}


@pytest.mark.parametrize(
    ("field", "value"),
    [("diameter", -1), ("diameter", "abc"), ("diameter", None), ("embedment", None), ("material", "gold"), ("joint", 9),
     ("joint", "x"), ("at", [1]), ("at", [0.0, 9.0]), ("hole", 0.01), ("failure", "bends"), ("kind", "rope")],
)  # fmt: skip
def test_an_error_of_a_link_finds_its_field(client, table, field, value):
    assert "error" not in client.post("/api/column", json=table | {"link": [DOWEL]}).json()
    wrong = {key: entry for key, entry in (DOWEL | {field: value}).items() if entry is not None}
    answer = client.post("/api/column", json=table | {"link": [DOWEL, wrong]}).json()
    assert answer["field"] == f"link.2.{field}", answer["error"]


def test_links_are_where_they_are_drawn(client, table):
    """A dowel through its joint as far as it reaches into both drums; a tie from drum to drum; both seen from two sides."""
    tie = {"kind": "tie", "at": [0.6, 0.2], "from_drum": 0, "to_drum": 3, "diameter": 0.02, "material": "titanium"}
    answer = client.post("/api/column", json=table | {"link": [DOWEL, tie]}).json()
    joint, (_, middle) = table["drum"][0]["height"], _span(answer["outlines"]["xz"][2])
    assert np.array(answer["links"]["xz"]) == pytest.approx(
        np.array([[[0.0, joint - 0.1], [0.0, joint + 0.1]], [[0.6, 0.0], [0.6, middle]]]), abs=1e-3
    )
    aside = {"as_found": {"drum": [{"index": 2, "offset": 0.05, "offset_azimuth": 90}]}}
    answer = client.post("/api/column", json=table | aside | {"link": [DOWEL, tie]}).json()["links"]
    assert answer["yz"][1][0] == pytest.approx([0.2, 0.0], abs=1e-3)
    assert answer["yz"][1][1][0] == pytest.approx(0.25, abs=1e-3)  # it goes with the drum that is offset


def _span(corners):
    """Lowest, and middle height of an outline."""
    heights = [z for _, z in corners]
    return min(heights), 0.5 * (min(heights) + max(heights))


def test_a_missing_value_finds_its_field(client, table):
    del table["drum"][1]["height"]
    answer = client.post("/api/column", json=table).json()
    assert answer == {
        "error": "drum 2: key 'height' is missing; add it.",
        "field": "drum.2.height",
    }


def test_a_joint_without_contact_is_found_at_the_offset_above_it(client, table):
    answer = client.post("/api/column", json=put(table, "found.2.offset", 0.96)).json()
    assert "has no contact left" in answer["error"]
    assert answer["field"] == "found.2.offset"


def test_errors_about_no_field_have_none(client, table):
    assert client.post("/api/column", json=table | {"drum": []}).json()["field"] is None
    motion = {"kind": "sample", "text": "nowhere"}
    assert client.post("/api/motion", json={"motion": motion}).json()["field"] is None


def test_a_survey_opens_as_convert_opens_it(client, tmp_path):
    """Names of our own and others', an older code page, and the line of a spreadsheet; what is left open is asked for."""
    text = "sep=;\ntamburo;altezza (cm);inf (cm);sup (cm);verità\n1;81,2;100;98,2;sì\n2;80;98,2;96;no\n".encode(
        "latin-1"
    )
    columns = "drum, height [cm], bottom_width [cm], top_width [cm], note"
    answer = client.post("/api/column/file", content=text, headers={"x-name": "survey.csv"})
    assert answer.status_code == 422
    assert answer.json()["field"] == "columns"
    assert 'Columns” "drum, height [cm], bottom_width [cm], top_width [cm], -"' in answer.json()["error"]
    stated = {"x-name": "survey.csv", "x-columns": columns}
    assert client.post("/api/column/file", content=text, headers=stated).json()["field"] == "material"
    opened = client.post("/api/column/file", content=text, headers=stated | {"x-material": "marble"}).json()["table"]
    (tmp_path / "survey.csv").write_bytes(text)
    column, *_ = convert(str(tmp_path / "survey.csv"), tmp_path / "survey.toml", Reading("marble", columns=columns))
    assert client.post("/api/column", json=opened).json()["facts"]["digest"] == column.digest


def test_a_column_file_goes_out_and_comes_back(client, table):
    table["as_found"] = {"base_tilt": 0.2, "drum": [{"index": 2, "offset": 0.01}]}
    text = client.post("/api/column/toml", json=table).text
    assert "[[drum]]" in text
    back = client.post("/api/column/file", content=text.encode()).json()["table"]
    same = [client.post("/api/column", json=column).json()["facts"]["digest"] for column in (table, back)]
    assert same[0] == same[1]
    answer = client.post("/api/column/file", content=b"height = ")
    assert answer.status_code == 422
    assert "is not valid TOML" in answer.json()["error"]


def test_a_sine_is_shown_with_its_measures(client, table):
    request_body = {"motion": {"kind": "harmonic", "text": "1Hz,0.3g,4s", "azimuth": "90deg"}, "column": table}
    answer = client.post("/api/motion", json=request_body).json()
    assert answer["summary"]["pga_g"]["y"] == pytest.approx(0.3, abs=1e-4)
    time, values = answer["lines"]["y"]
    assert len(time) == len(values) <= 2401
    assert max(values) == pytest.approx(0.3, abs=1e-4)
    facts = client.post("/api/column", json=table).json()["facts"]
    tangent = np.tan(facts["slenderness"])  # the sine is all along y: it is that which the column feels
    assert answer["relative"]["pga_over_g_tan_alpha"] == pytest.approx(0.3 / tangent, rel=1e-3)


@pytest.mark.parametrize(
    ("motion", "field"),
    [
        ({"kind": "harmonic", "text": "-1Hz,0.3g,4s"}, "frequency"),
        ({"kind": "harmonic", "text": "1Hz,abc,4s"}, "amplitude"),
        ({"kind": "harmonic", "text": "1Hz,0.3g,-4s"}, "duration"),
        ({"kind": "harmonic", "text": "1Hz,0.3g,4s", "azimuth": "400deg"}, "azimuth"),
        ({"kind": "harmonic", "text": "1Hz,0.3g,4s", "azimuth": "xdeg"}, "azimuth"),
        ({"kind": "sample", "text": "el-centro-1940", "azimuth": "30deg"}, "azimuth"),
    ],
)
def test_errors_of_motions_find_their_field(client, motion, field):
    answer = client.post("/api/motion", json={"motion": motion})
    assert answer.json()["field"] == field, answer.json()


def test_a_record_is_uploaded_and_its_unit_asked_for(client, table):
    lines = "\n".join(f"{0.01 * k:.2f} {0.2 * np.sin(0.3 * k):.6f}" for k in range(400)) + "\n"
    kept = client.post("/api/records", content=lines.encode(), headers={"x-name": "my%20record.txt"}).json()
    assert kept["name"] == "my record.txt"
    motion = {"kind": "record", "text": kept["id"]}
    refused = client.post("/api/motion", json={"motion": motion})
    assert refused.json()["field"] == "unit"
    answer = client.post("/api/motion", json={"motion": motion | {"unit": "m/s2"}}).json()
    assert answer["summary"]["format"] == "columns of text"
    assert re.fullmatch(r"my-record-[0-9a-f]{8}\.txt", answer["summary"]["file"])
    assert client.delete(f"/api/records/{kept['id']}").status_code == 200
    assert "upload it again" in client.post("/api/motion", json={"motion": motion}).json()["error"]


ASSEMBLY = """name = "portal"
[joint]
normal_stiffness = 5e9
shear_stiffness = 2.5e9
friction_angle = 35
[[block]]
vertices = [[0,0],[1,0],[1,3],[0,3]]
density = 2500
"""


def test_an_assembly_is_told_apart_from_a_column(client):
    assert client.post("/api/column/file", content=ASSEMBLY.encode()).json() == {"assembly": ASSEMBLY, "model": "dem2d"}
    answer = client.post("/api/assembly", json={"assembly": ASSEMBLY}).json()
    assert answer["facts"] | {"digest": ""} == {
        "name": "portal", "blocks": 1, "fixed": 0, "joints": 1, "links": 0, "mass": 7500.0, "height": 3.0, "digest": ""
    }  # fmt: skip
    (view,) = answer["views"]  # the outline of the block, and its face
    assert (
        sorted(view["polygons"][0]) == sorted(view["polygons"][1]) == [[0.0, 0.0], [0.0, 3.0], [1.0, 0.0], [1.0, 3.0]]
    )
    assert (view["outlines"][0], view["ground"]) == (True, 0.0)
    run_request = {"kind": "run", "assembly": ASSEMBLY, "motion": {"kind": "harmonic", "text": "1Hz,0.1g,1s"}}
    job = client.post("/api/jobs", json=run_request).json()
    assert job["commands"][0].startswith("stylobate run assembly.toml --model=dem2d ")
    steps = {"first": "0.1g", "last": "0.2g", "step": "0.1g"}
    job = client.post("/api/jobs", json=run_request | {"kind": "critical"} | steps).json()
    assert job["commands"][0].startswith("stylobate critical assembly.toml ")
    wrong = client.post("/api/jobs", json=run_request | {"kind": "domain"})
    assert (wrong.status_code, "takes a column" in wrong.json()["error"]) == (422, True)


@pytest.mark.parametrize("file", ["../../../etc/passwd", "/etc/passwd", "column.toml", "\\u0000"])
def test_an_assembly_opens_no_file_of_this_machine(client, file):
    text = f'[[column]]\nfile = "{file}"\nnumber = 2\nspacing = 3.0\n'
    for answer in (
        client.post("/api/column/file", content=text.encode()),
        client.post("/api/assembly", json={"assembly": text}),
    ):
        assert "has only presets at hand" in answer.json()["error"]
        assert "tmp" not in answer.json()["error"]


def test_what_is_wrong_in_a_file_is_said_without_where_it_lies(client):
    for text in ("name = ", "[[block]]\nvertices = [[0,0],[1,0],[1,1]]\n", "section = 'round'\n"):
        error = client.post("/api/column/file", content=text.encode()).json()["error"]
        assert error.startswith("your-")


def test_an_uploaded_file_is_told_by_its_name(client):
    for name, called in (("broken%20one.toml", "broken one.toml"), ("..%2F..%2Fetc%2Fpasswd", "_.._etc_passwd")):
        error = client.post("/api/column/file", content=b"name = ", headers={"x-name": name}).json()["error"]
        assert error.startswith(f"{called} is not valid TOML")


def test_an_assembly_with_a_mistake_opens_to_be_mended(client):
    text = ASSEMBLY.replace("[1,3]", "[1,-3]")
    opened = client.post("/api/column/file", content=text.encode()).json()
    assert (opened["assembly"], "block 1" in opened["error"]) == (text, True)
    answer = client.post("/api/assembly", json={"assembly": text}).json()
    assert answer["field"].startswith("assembly.")


def test_keys_of_a_file_stay_as_they_are_written(client, run_request):
    """Who writes what the remedy says has it right."""
    wrong = ASSEMBLY.replace("friction_angle", "friction_angel")
    for answer in (
        client.post("/api/assembly", json={"assembly": wrong}),
        client.post("/api/column/file", content=wrong.encode()),
        client.post("/api/column/file", content=b"section = 'circular'\n[joint]\nfriction_angel = 3\n"),
    ):
        assert "did you mean friction_angle?" in answer.json()["error"]
    ruin = client.post(
        "/api/jobs", json=run_request | {"kind": "infer", "ruin": "columns = []\n[prior]\npg_v = 1\n"}
    ).json()
    assert (ruin["field"].partition(".")[0], "'pg_v'" in ruin["error"]) == ("ruin", True)


IN_SPACE = """\
density = 2500
[joint]
normal_stiffness = 5e9
shear_stiffness = 2.5e9
friction_angle = 35
[[block]]
name = "base"
box = [2.0, 1.0, 0.5]
at = [0.0, 0.0, 0.0]
fixed = true
[[block]]
name = "stone"
box = [0.5, 0.4, 1.5]
at = [0.0, 0.0, 0.5]
"""


def test_an_assembly_in_space_is_seen_from_two_sides_from_above_and_askew(client):
    opened = client.post("/api/column/file", content=IN_SPACE.encode()).json()
    assert opened["model"] == "dem3d"
    answer = client.post("/api/assembly", json=opened).json()
    facts = answer["facts"]
    assert (facts["blocks"], facts["fixed"], facts["joints"], facts["mass"]) == (2, 1, 1, pytest.approx(750.0))
    sides = [np.ptp(np.concatenate(view["polygons"]), axis=0).tolist() for view in answer["views"]]
    assert sides[:3] == [[2.0, 2.0], [1.0, 2.0], [2.0, 1.0]]
    assert [view["ground"] for view in answer["views"]] == [0.0, 0.0, None, None]
    run_request = {"kind": "run", "assembly": IN_SPACE, "model": "dem3d", "replicates": "3"}
    job = client.post("/api/jobs", json=run_request | {"motion": {"kind": "harmonic", "text": "1Hz,0.1g,1s"}}).json()
    assert job["commands"][0].startswith("stylobate run assembly.toml --model=dem3d ")


@pytest.mark.parametrize(
    "mesh", ['mesh = "/etc/passwd"', 'mesh = "../../secret.obj"', 'parts = [{ mesh = "secret.obj" }]', "mesh = 3"]
)
def test_an_assembly_in_space_opens_no_mesh_of_this_machine(client, mesh):
    text = f'{IN_SPACE}[[block]]\nname = "other"\n{mesh}\n'
    for answer in (
        client.post("/api/column/file", content=text.encode()),
        client.post("/api/assembly", json={"assembly": text}),
    ):
        error = answer.json()["error"]
        assert "is a mesh, and the page has no other file at hand; give its vertices." in error
        assert "secret" not in error


#: Two blocks, and a line that is none.
TEXT = """name = "two"
[joint]
normal_stiffness = 5e9
shear_stiffness = 2.5e9
friction_angle = 35
[[block]]
name = "left"
vertices = [
    [0, 0], [1, 0], [1, 3], [0, 3],
]
density = 2500
[[block]]
density = 2500
vertices = [[4, 0], [5, 0], [5, 3], [4, 3]]
"""


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("friction_angle = 35", "friction_angle =", 5),  # no TOML
        ("friction_angle", "frction_angle", 5),
        ("[[block]]\ndensity = 2500\nv", "[[block]]\ndensity = 2500\nmas = 1\nv", 14),  # of the second table
        ("density = 2500\n[[", "density = 'heavy'\n[[", 11),  # behind lines of numbers in brackets
        ("density = 2500\n[[", "density = -1\n[[", 7),  # named by the sentence alone
        ("[4, 3]]", "[4.9, 1]]", 12),  # by its number
        ("[[block]]\ndensity", '[[block]]\nname = "left"\ndensity', 7),
        ("[[block]]", "[[blok]]", None),
    ],
)
def test_an_error_in_the_text_of_an_assembly_is_of_its_line(client, old, new, line):
    assert "error" not in client.post("/api/assembly", json={"assembly": TEXT}).json()
    wrong = "[[blok]]" if old == "[[block]]" else TEXT.replace(old, new, 1)
    answer = client.post("/api/assembly", json={"assembly": wrong}).json()
    assert answer["field"] == ("assembly" if line is None else f"assembly.{line}"), answer["error"]


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [("height", 850.0, "drums have 0.005 to 30 m: check"), ("bottom_width", 0.001, "stones have 0.005 to 10 m: check")],
)
def test_a_size_that_no_drum_has_is_marked_and_not_the_slope_on_which_it_falls(client, table, key, value, says):
    """A column of such a drum stands on no slope; what was typed last is what is wrong."""
    wrong = copy.deepcopy(table) | {"as_found": {"base_tilt": 0.5}}
    wrong["drum"][1][key] = value
    answer = client.post("/api/column", json=wrong).json()
    assert answer["field"] == f"drum.2.{key}", answer
    assert "is not in equilibrium" in answer["error"]
    assert says in answer["error"]
    sound = copy.deepcopy(table) | {"as_found": {"base_tilt": 44.0}}
    assert client.post("/api/column", json=sound).json()["field"] == "base_tilt"
