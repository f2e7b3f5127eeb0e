"""Bad input: exit code 2, one clear sentence on standard error, nothing on standard output, nothing half-written."""

import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.models.rocking.model import Rocking
from stylobate.motion import write_csv

GOOD = {"--model": "housner", "--harmonic": "1Hz,0.3g,1s"}
COLUMN = """\
density = 1600.0
[tapered]
height = 5.0
bottom_width = 0.96
top_width = 0.66
drums = 2
[joint]
normal_stiffness = 5.0e10
shear_stiffness = 2.5e10
friction_angle = 35.0
"""
STUDY = """\
column = "paper-monolithic"
model = "housner"
frequencies = "1:2:2"
amplitudes = "0.1g:0.2g:2"
duration = 1.0
"""


@pytest.fixture
def refused(capsys, tmp_path):
    """Runs a command line that must be refused; returns its sentence."""

    def run(*arguments):
        folder = tmp_path / "never"
        seen = {path.name for path in tmp_path.iterdir()}
        code = call([*(str(argument) for argument in arguments), "--json"])
        out, err = capsys.readouterr()
        assert code == 2, err
        assert out == ""
        lines = err.splitlines()
        assert len(lines) == 1, err
        assert lines[0].startswith("stylobate: ")
        assert lines[0].endswith((".", "?"))
        assert not folder.exists()
        assert {path.name for path in tmp_path.iterdir()} == seen
        return lines[0]

    return run


def with_options(command, column, tmp_path, **changes):
    options = {**GOOD, "--out": str(tmp_path / "never"), **{f"--{key}": value for key, value in changes.items()}}
    return [
        command,
        str(column),
        *(part for key, value in options.items() if value is not None for part in (key, value)),
    ]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"model": "dem2"}, ["no model 'dem2'", "did you mean dem2d?", "housner"]),
        ({"model": "dem4d"}, ["no model 'dem4d'"]),
        ({"set": "restitutoin=0.9"}, ["'restitutoin'", "did you mean restitution?"]),
        ({"set": "restitution"}, ["'restitution'", "name=value"]),
        ({"set": "restitution=2"}, ["restitution is 2", "[0, 1]"]),
        ({"set": "linear=maybe"}, ["linear is 'maybe'", "true or false"]),
        ({"model": "dem2d", "set": "points=1"}, ["points is 1", "from 2"]),
        ({"model": "dem2d", "set": "points=2.5"}, ["points is '2.5'", "whole number"]),
        ({"model": "dem2d", "set": "time_step=0.1"}, ["0.1 s"]),
        ({"harmonic": None}, ["no motion", "--harmonic, --pulse, --synthetic and --motion"]),
        ({"pulse": "ricker,1Hz,0.3g"}, ["--harmonic and --pulse are both given"]),
        ({"harmonic": "1Hz,0.3,10s"}, ["'0.3' has no unit", "1.0Hz,0.3g,10s"]),
        ({"harmonic": "1Hz,?g,10s"}, ["leaves the amplitude open"]),
        ({"harmonic": "-1Hz,0.3g,10s"}, ["frequency is -1 Hz"]),
        ({"harmonic": None, "pulse": "rickr,1Hz,0.3g"}, ["'rickr'", "did you mean ricker?"]),
        ({"harmonic": None, "motion": "nowhere.csv"}, ["nowhere.csv"]),
        ({"unit": "g"}, ["--unit", "record"]),
        ({"dt": "0.01s"}, ["--dt", "record"]),
        ({"scale": "2", "pga": "0.3g"}, ["--scale and --pga"]),
        ({"scale": "nan"}, ["--scale is nan"]),
        ({"scale": "twice"}, ["--scale", "twice"]),
        ({"pga": "0.3"}, ["'0.3'", "unit"]),
        ({"vertical": "maybe"}, ["--vertical is 'maybe'", "on, off"]),
        ({"tail": "5"}, ["'5'", "unit"]),
        ({"tail": "-1s"}, ["--tail is -1 s"]),
        ({"output-interval": "0s"}, ["--output-interval is 0 s"]),
        ({"threads": "0"}, ["--threads is 0"]),
        ({"threads": "many"}, ["--threads", "many"]),
    ],
)
def test_run(changes, words, refused, tmp_path):
    message = refused(*with_options("run", "paper-monolithic", tmp_path, **changes))
    for word in words:
        assert word in message, message


def test_options_given_twice(refused, tmp_path):
    """The last one would win, and the other earthquake be lost without a word."""
    twice = [
        *with_options("sequence", "paper-monolithic", tmp_path, harmonic=None),
        *2 * ("--pulse", "ricker,1Hz,0.3g"),
    ]
    assert "--pulse is given 2 times; give it once" in refused(*twice)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("bottom_width", "botom_width"), ["'botom_width'", "did you mean bottom_width?"]),
        (("height = 5.0", "height = -5.0"), ["height", "-5 m"]),
        (("= 2\n", "= 0\n"), ["drums is 0", "1 to 200"]),
        (("= 2\n", "= 1000000\n"), ["drums is 1000000"]),
        (("5.0e10", "0.0"), ["normal_stiffness", "0 N/m³"]),
        (("35.0", "90.0"), ["friction_angle", "[0, 90) degrees"]),
        (("[joint]", "[jiont]"), ["'jiont'", "did you mean joint?"]),
        (("density = 1600.0", "density = "), ["not valid TOML"]),
    ],
)
def test_column_files(change, words, refused, tmp_path):
    path = tmp_path / "column.toml"
    path.write_text(COLUMN.replace(*change))
    message = refused(*with_options("run", path, tmp_path))
    for word in [str(path), *words]:
        assert word in message, message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time_s,ax\n0,0\n0.01,1\n0.02,0\n", ["unit"]),
        ("time_s,ax_g\n0,0\n0.01,nan\n0.02,0\n", ["record.csv"]),
        ("time_s,ax_g\n0,0\n0.01,1\n0.05,0\n", ["0.0"]),
        ("", ["record.csv"]),
    ],
    ids=["no unit", "NaN", "unequal steps", "empty"],
)
def test_records(text, words, refused, tmp_path):
    path = tmp_path / "record.csv"
    path.write_text(text)
    message = refused(*with_options("run", "paper-monolithic", tmp_path, harmonic=None, motion=str(path)))
    for word in words:
        assert word in message, message


def test_a_column_that_is_nowhere(refused, tmp_path):
    assert "did you mean paper-monolithic?" in refused(*with_options("run", "paper-monolith", tmp_path))
    assert "there is no file" in refused(*with_options("run", tmp_path / "none.toml", tmp_path))


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "paper-monolithic", "--model", "housner", "--harmonic", "1Hz,0.3g,1s"],
        [
            "critical",
            "paper-monolithic",
            "--model",
            "housner",
            "--harmonic",
            "1Hz,?g,1s",
            "--from",
            "0.1g",
            "--to",
            "0.2g",
        ],
        ["domain", "paper-monolithic", "--model", "housner", "--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2"],
        ["compare", "paper-monolithic", "--models", "housner", "--harmonic", "1Hz,0.3g,1s"],
        ["columns"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_computed(
    arguments, refused, tmp_path, monkeypatch
):
    computed = []
    for verb in ("run", "run_many"):
        monkeypatch.setattr(Rocking, verb, lambda *_, **__: computed.append(1))
    (tmp_path / "file").write_text("in the way")
    message = refused(*arguments, "--out", tmp_path / "file" / "folder")
    assert "cannot be written" in message
    assert not computed


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"harmonic": "1Hz,0.3g,1s"}, ["states its amplitude", "?g"]),
        ({"from": "0.5g", "to": "0.2g"}, ["largest amplitude", "must not be below"]),
        ({"from": "0g"}, ["smallest amplitude is 0"]),
        ({"step": "0g"}, ["step is 0"]),
        ({"step": "0.0000001g"}, ["larger step"]),
        ({"from": None}, ["--from"]),
    ],
)
def test_critical(changes, words, refused, tmp_path):
    options = {"harmonic": "1Hz,?g,1s", "from": "0.1g", "to": "0.2g", "step": "0.05g"} | changes
    message = refused(*with_options("critical", "paper-monolithic", tmp_path, **options))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frequencies": None}, ["--frequencies is missing", "0.33:4:24"]),
        ({"amplitudes": "0.1:0.2:2"}, ["'0.1'", "unit"]),
        ({"amplitudes": "0.1g:0.2g"}, ["first:last:number"]),
        ({"amplitudes": "0.3g:0.2g:4"}, ["first value must be below the last"]),
        ({"frequencies": "1:2:0"}, ["0 values"]),
        ({"frequencies": "1:2:two"}, ["'two'"]),
        ({"frequencies": "2,1"}, ["must rise"]),
        ({"duration": "0s"}, ["duration is 0"]),
    ],
)
def test_domain(changes, words, refused, tmp_path):
    options = {"harmonic": None, "frequencies": "1:2:2", "amplitudes": "0.1g:0.2g:2"} | changes
    message = refused(*with_options("domain", "paper-monolithic", tmp_path, **options))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("frequencies", "frequncies"), ["'frequncies'", "did you mean frequencies?"]),
        (('"housner"', '"houser"'), ["no model 'houser'", "did you mean housner?"]),
        (('"paper-monolithic"', '"paper-monolith"'), ["did you mean paper-monolithic?"]),
        (("1.0", '"1 s"'), ["'duration'", "a number"]),
        (('"0.1g:0.2g:2"', "[0.1, 0.2]"), ["0.1, without a unit", "'0.3g'"]),
        (('"1:2:2"', "3"), ["frequencies is 3", "a list"]),
        (('"1:2:2"', "[true]"), ["True", "a number"]),
        (("1.0", "1.0\n[set]\nrestitutoin = 1"), ["'restitutoin'", "did you mean restitution?"]),
    ],
)
def test_study_files(change, words, refused, tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY.replace(*change))
    message = refused("domain", path, "--out", tmp_path / "never")
    for word in [str(path), *words]:
        assert word in message, message


def test_a_study_file_and_options_at_once(refused, tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    assert "--model is given as well" in refused("domain", path, "--model", "dem2d", "--out", tmp_path / "never")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["rnu", "paper-monolithic"], ["rnu"]),
        (["run"], ["COLUMN"]),
        (["run", "paper-monolithic", "--modle", "housner"], ["--modle"]),
        (["columns", "nowhere"], ["nowhere"]),
        (["motion", "nowhere.csv"], ["nowhere.csv"]),
        (["compare", "paper-monolithic", "--models", "housner,housner", "--harmonic", "1Hz,1g,1s"], ["given twice"]),
        (
            ["states", "--as-built", "paper-monolithic", "--with", "paper-12-drums"],
            ["no record is given; name a folder"],
        ),
        (
            ["fragility", "runs.csv", "--im", "pgv", "--state", "top:0.35"],
            ["has no unit; write top:0.35d", "or top:0.35m"],
        ),
        (["compare", "paper-monolithic", "--models", "housner,dem", "--harmonic", "1Hz,1g,1s"], ["dem2d"]),
        (["compare", "paper-monolithic", "--models", "housner", "--frequencies", "1:2:2"], ["both --frequencies and"]),
        (
            ["compare", "paper-monolithic", "--models", "housner", "--harmonic", "1Hz,1g", "--set", "e=1"],
            ["model.name=value"],
        ),
    ],
)
def test_what_is_typed_wrong(arguments, words, refused):
    message = refused(*arguments)
    for word in words:
        assert word in message, message


def write_found(folder, as_found):
    path = folder / "found.toml"
    path.write_text(COLUMN + "[as_found]\n" + as_found)
    return path


@pytest.mark.parametrize(
    ("as_found", "words"),
    [
        ("base_tilt = 12.0\n", ["not in equilibrium", "joint 1", "N m are missing"]),
        ("[[as_found.drum]]\nindex = 3\noffset = 0.1\n", ["given drum 3 as found", "drums 1 to 2"]),
        ("[[as_found.drum]]\nindex = 2\nchip_left = 0.9\n", ["joint 2", "no contact left"]),
        ("[[as_found.drum]]\nindex = 2\ntlit = 0.9\n", ["tlit", "tilt"]),
        ("base_tilt = 50.0\n", ["base_tilt is 50", "-45"]),
    ],
)
def test_columns_that_cannot_be_as_found(as_found, words, refused, tmp_path):
    sentence = refused("run", write_found(tmp_path, as_found), "--model", "dem2d", "--harmonic", "1Hz,0.1g,1s")
    assert all(word in sentence for word in words), sentence


@pytest.mark.parametrize("model", ["housner", "rigid-beam", "rigid-block"])
def test_what_knows_columns_as_built_only(model, refused, tmp_path):
    column = write_found(tmp_path, "base_tilt = 1.0\n")
    sentence = refused("run", column, "--model", model, "--harmonic", "1Hz,0.1g,1s")
    assert "as found" in sentence
    assert "dem2d" in sentence


@pytest.mark.parametrize("model", ["housner", "rigid-beam", "rigid-block"])
def test_until_rest_is_for_the_model_that_follows_a_collapse(model, refused, tmp_path):
    sentence = refused(*with_options("run", "paper-monolithic", tmp_path, model=model), "--until-rest")
    assert model in sentence
    assert "use dem2d" in sentence


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--state", "roof_m:0.3"), "needs 'roof_m', which the runs do not have"),
        (("--state", "peak_tilt_rad:0.1"), "needs 'peak_tilt_rad'"),  # of a model in space
        (("--state", "reason:1"), "'reason' of the runs is none"),
        (("--as-found", "drums.toml"), "computes one block"),
    ],
)
def test_states_are_refused_before_anything_is_written(tmp_path, monkeypatch, refused, arguments, why):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drums.toml").write_text(COLUMN)
    for name, width in (("thin", 0.5), ("wide", 0.6)):
        column = st.Column.of_drums([st.Drum(2.0, width, width, 2500.0)], st.Joint(5e10, 2.5e10, 35.0), name=name)
        write_column(column, tmp_path / f"{name}.toml")
    write_csv(st.harmonic(2.0, 0.3 * st.g, 3.0), tmp_path / "sine.csv")
    states = ("states", "--as-built", "thin.toml", "--with", "wide.toml", "--model", "housner", "--motion", "sine.csv")
    assert why in refused(*states, *arguments, "--out", tmp_path / "never")


@pytest.mark.parametrize(
    "motion",
    [("--harmonic", "1Hz,0.1g,1s"), ("--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2", "--duration", "1s")],
)
def test_models_are_refused_before_the_first_of_them_is_run(tmp_path, monkeypatch, refused, motion):
    for name in ("simulate", "run_grid"):
        monkeypatch.setattr(f"stylobate.verdicts.compare.{name}", None)
    drums = ("compare", "paper-12-drums", "--models", "dem2d,housner", *motion)
    assert "computes one block" in refused(*drums, "--out", tmp_path / "never")


def test_workbooks_and_decimal_commas_are_told(tmp_path, monkeypatch, refused):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.xlsx").write_bytes(b"PK\x03\x04\xff\xfe")
    assert "is the table of a spreadsheet; of a survey `stylobate convert` makes a column" in refused(
        "columns", "a.xlsx"
    )
    (tmp_path / "a.toml").write_text('name = "a"\n[[drum]]\nheight = 0,845 # as measured\n')
    assert "numbers have a decimal point: write 0.845." in refused("columns", "a.toml")
    run = ("run", "paper-monolithic", "--model", "housner", "--harmonic", "1Hz,0.1g,1s")
    assert "'0,3g' has a decimal comma; write it as 0.3g." in refused(*run, "--pga", "0,3g")
    assert "write it as 0.3g if % of g is meant" in refused(*run, "--pga", "30")
    assert "of g it is 0.3g" in refused(*run, "--pga", "30%")
    ida = ("ida", "paper-monolithic", "records", "--model", "housner", "--im", "pga")
    assert "--runs is 'abc'; allowed is a whole number; see" in refused(*ida, "--runs", "abc")
    assert "--runs is '1.5'; allowed is a whole number; see" in refused(*ida, "--runs=1.5")


def test_a_survey_where_a_column_file_is_wanted_is_told_as_one(tmp_path, monkeypatch, refused):
    """Whatever its headings and its letters are."""
    monkeypatch.chdir(tmp_path)
    for text in ("# name: x\nheight_m;bottom_width_m;top_width_m\n0,7;1,2;1,1\n", "Höhe;Ø unten [°N]\n0,7;1,2\n"):
        (tmp_path / "survey.csv").write_bytes(text.encode("latin-1"))
        for command in (("draw", "survey.csv", "--out", "never"), ("run", "survey.csv", "--harmonic", "1Hz,0.1g,1s")):
            assert "is the table of a spreadsheet; of a survey `stylobate convert` makes a column" in refused(*command)


def test_the_option_that_was_typed_is_named(refused):
    assert "--directions are '345:0:24'" in refused("limit", "paper-monolithic", "--directions", "345:0:24")
