"""The same bad input from the command line, from a file, from Python and from the page: each in the words of its reader."""

import copy
import re

import pytest
import tomli_w

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.tables import made_of

OPTION, MARK, KEY = re.compile(r"(?<![\w-])--[a-z]"), re.compile("`"), re.compile(r"\b[a-z]+_[a-z]+\b")

#: What is wrong: places in a column file with the wrong value; the field that the page marks, and words of every message.
COLUMNS = [
    (("drum", 1, "bottom_width"), -1.0, "drum.2.bottom_width", ["is -1 m", "[0.0001, 1000] m", "use SI units"]),
    (("drum", 0, "density"), -1.0, "drum.1.density", ["is -1 kg/m³", "kg/m³; use SI units"]),
    (("joint", "normal_stiffness"), 0.0, "joint.normal_stiffness", ["is 0 N/m³", "[1, 1e+15] N/m³", "such as 5e10"]),
    (("joint", "friction_coefficient"), -0.1, "joint.friction_coefficient", ["is -0.1", "[0, 1e+06]"]),
    (("gravity",), 1e4, "gravity", ["is 10000 m/s²", "[0.01, 100] m/s²"]),
    (("section",), "oval", "section", ["is 'oval'", "circular, rectangular"]),
    (("as_found",), {"base_tilt": 80.0}, "base_tilt", ["is 80 degrees", "[-45, 45] degrees"]),
    (("as_found",), {"drum": [{"index": 2, "tilt": 80.0}]}, "found.2.tilt", ["is 80 degrees", "[-30, 30] degrees"]),
]


@pytest.mark.parametrize(("path", "value", "field", "words"), COLUMNS, ids=lambda parameter: str(parameter)[:30])
def test_a_column(client, table, path, value, field, words, tmp_path, capsys):
    wrong = copy.deepcopy(table)
    inner = wrong
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    with pytest.raises(st.InputError) as caught:
        made_of(st.Column, wrong)
    file = tmp_path / "mine.toml"
    file.write_text(tomli_w.dumps(wrong))
    assert call(["columns", str(file)]) == 2
    line, page = capsys.readouterr().err, client.post("/api/column", json=wrong).json()
    name = field.rpartition(".")[2]
    for text in (str(caught.value), line, page["error"]):
        assert all(word in text for word in words), text
        assert OPTION.search(text) is None, text
        assert MARK.search(text) is None, text
    assert f"{file}: " in line
    assert name in line
    assert name in str(caught.value)
    assert name.replace("_", " ") in page["error"]
    assert KEY.search(page["error"]) is None
    assert caught.value.field == page["field"] == field


#: What is typed for a motion, as parameters of a request; the field, words of every message, and the option.
MOTIONS = [
    ({"harmonic": "-1Hz,0.3g,4s"}, "frequency", ["frequency is -1 Hz", "[0.001, 1000] Hz"], None),
    ({"harmonic": "1Hz,abc,4s"}, "amplitude", ["'abc'", "write it as '1.0Hz,0.3g,10s'"], "harmonic"),
    ({"harmonic": "1Hz,0.3g,-4s"}, "duration", ["duration is -4 s", "(0, 10000] s"], None),
    ({"harmonic": "1Hz,0.3g", "across": "1Hz,0.1g,x"}, "across.phase", ["'x'", "1.0Hz,0.15g,90deg"], "across"),
    ({"harmonic": "1Hz,0.3g", "azimuth": "400deg"}, "azimuth", ["azimuth is 400 degrees", "[-360, 360]"], None),
    ({"harmonic": "1Hz,0.3g", "azimuth": "x"}, "azimuth", ["'x'", "write it as '30deg'"], "azimuth"),
    ({"harmonic": "1Hz,0.3g", "pga": "0.3"}, "pga", ["'0.3' has no unit", "such as 0.3g"], "pga"),
    ({"harmonic": "1Hz,0.3g", "pga": "-1g"}, "pga", ["is -9.81 m/s²", "[0, 10000] m/s²"], "pga"),
    ({"harmonic": "1Hz,0.3g", "unit": "g"}, "unit", ["describes a record", "leave it out"], "unit"),
    ({"harmonic": "1Hz,?g"}, "amplitude", ["leaves the amplitude open", "such as 0.3g"], "harmonic"),
    ({"pulse": "rickr,1Hz,0.3g"}, "pulse", ["'rickr'", "did you mean ricker?"], None),
    ({"synthetic": "greece,6.5Mw"}, "synthetic", ["holds no distance", "such as 20km"], "synthetic"),
]


#: On the page accelerations are in g, as its fields are.
IN_FIELDS = {"is -9.81 m/s²": "is -1 g", "[0, 10000] m/s²": "[0, 1019.37] g"}


@pytest.mark.parametrize(("typed", "field", "words", "option"), MOTIONS, ids=lambda parameter: str(parameter)[:40])
def test_a_motion(client, typed, field, words, option, capsys):
    with pytest.raises(st.InputError) as caught:
        st.MotionRequest.typed(**typed).motion()
    column = ["paper-monolithic", "--model=housner", "--replicates=0"]
    assert call(["run", *column, *(f"--{name}={value}" for name, value in typed.items())]) == 2
    line = capsys.readouterr().err
    kind = next(name for name in ("harmonic", "pulse", "synthetic") if name in typed)
    more = {name: value for name, value in typed.items() if name != kind}
    page = client.post("/api/motion", json={"motion": {"kind": kind, "text": typed[kind], **more}}).json()
    for text in (str(caught.value), line):
        assert all(word in text for word in words), text
    assert all(IN_FIELDS.get(word, word) in page["error"] for word in words), page["error"]
    if option:
        assert f"`{option}`" in str(caught.value)
        assert f"--{option}" in line
        assert "“" in page["error"]
    assert OPTION.search(str(caught.value)) is None
    assert MARK.search(line) is None
    assert OPTION.search(page["error"]) is MARK.search(page["error"]) is KEY.search(page["error"]) is None
    assert caught.value.field == page["field"] == field


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"frequencies": "4:1:5"}, "frequencies", ["'4:1:5'", "the first value must be below the last one"]),
        ({"amplitudes": "0.1:0.4:3"}, "amplitudes", ["'0.1' has no unit", "such as 0.1g"]),
        ({"frequencies": "0.5:2:0"}, "frequencies.number", ["with 0 values", "1 to 100000"]),
        ({"amplitudes": "-1g:1g:2"}, "amplitudes", ["is -9.81 m/s²", "(0, 10000] m/s²"]),
    ],
    ids=lambda parameter: str(parameter)[:40],
)
def test_a_grid(client, run_request, change, field, words, tmp_path, capsys):
    grid = {"frequencies": "0.5:2:4", "amplitudes": "0.1g:0.4g:3"} | change
    assert call(["domain", "paper-monolithic", *(f"--{name}={value}" for name, value in grid.items())]) == 2
    line = capsys.readouterr().err
    file = tmp_path / "grid.toml"
    file.write_text(tomli_w.dumps({"column": "paper-monolithic", "model": "housner", **grid}))
    assert call(["domain", str(file)]) == 2
    from_file = capsys.readouterr().err
    with pytest.raises(st.InputError) as caught:
        st.campaign.grid.read_grid(file)
    page = client.post("/api/jobs", json=run_request | {"kind": "domain", "motion": None} | grid).json()
    for text in (line, from_file, page.get("error", from_file)):  # the page leaves ranges to its jobs
        assert all(word in text for word in words), text
    assert OPTION.search(from_file) is None
    assert caught.value.field == field
    assert page["field"] == (field if "error" in page else None)
