"""``stylobate sequence``: a table and an object for each earthquake, files, studies, and bad input in one sentence."""

import json

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.campaign.study_files import read_plan
from stylobate.cli.main import call
from stylobate.motion import spans_of, write_csv
from stylobate.results.reading import read_folder

COLUMN = """name = "two drums"
density = 2000.0
[tapered]
height = 3.0
bottom_width = 0.8
top_width = 0.6
drums = 2
[joint]
normal_stiffness = 5.0e8
shear_stiffness = 2.5e8
friction_angle = 20.0
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "column.toml").write_text(COLUMN)
    shake = 4.0 * np.sin(np.linspace(0.0, 2.0 * np.pi, 61))
    for name, size in (("first", 1.0), ("second", 0.5)):
        write_csv(st.Motion(0.01, size * shake), tmp_path / f"{name}.csv")
    write_csv(st.Motion(0.01, shake, az=0.1 * shake), tmp_path / "vertical.csv")
    return tmp_path


def run(capsys, *arguments):
    code = call([str(argument) for argument in arguments])
    return code, *capsys.readouterr()


def test_an_object_a_table_and_files(folder, capsys):
    motions = ["--motion", folder / "first.csv", "--motion", folder / "second.csv", "--rest", "1s"]
    out = folder / "out"
    arguments = ["sequence", folder / "column.toml", *motions, "--replicates", "7", "--json", "--out", out]
    code, printed, _ = run(capsys, *arguments)
    assert code == 0
    answer = json.loads(printed)
    assert (answer["earthquakes"], answer["fell_in"], answer["rest_s"]) == (2, None, 1.0)
    first, second = answer["events"]
    assert second["outcome"] == answer["outcome"] == "displaced"
    assert (first["motion"], second["earthquake"]) == ("first.csv", 2)
    added = [event["alone"]["added"]["residual_slip_x_m"][0] for event in answer["events"]]
    assert sum(added) == pytest.approx(answer["residual_slip_x_m"][0], abs=1e-3)
    assert answer["falls"]["runs"] == 7
    table = pandas.read_csv(out / "events.csv")
    assert table["outcome"].tolist() == [first["outcome"], "displaced"]
    assert (out / "sequence.png").stat().st_size > 5000
    assert (out / "ends.svg").is_file()
    (result,) = read_folder(out)  # the folder of a run, for reports and films
    assert result.kind.value == "run"
    assert result.summary["events"][0]["ends_s"] == pytest.approx(1.6)
    code, _, _ = run(capsys, "report", out, "--out", folder / "page.html")
    assert code == 0
    assert "Earthquake by earthquake" in (folder / "page.html").read_text()


def test_words_for_people(folder, capsys):
    code, printed, _ = run(capsys, "sequence", folder / "column.toml", "--motion", folder / "first.csv", "--factors",
                           "1,0.5", "--rest", "0.2s", "--replicates", "0")  # fmt: skip
    assert code == 0
    assert "After 2 earthquakes: The column stands" in printed
    assert "first.csv × 0.5" in printed
    assert "give a longer --rest" in printed
    code, printed, _ = run(capsys, "sequence", folder / "column.toml", "--motion", folder / "first.csv", "--motion",
                           folder / "second.csv", "--until-fall", "2", "--rest", "0.2s")  # fmt: skip
    assert code == 0
    assert printed.count("more than 2") == 3
    assert "Over the kinds, median of 2: more than 2 (no interval of fewer than 6)." in printed


def test_counts_are_kept_and_have_a_page(folder, capsys):
    arguments = [
        "sequence",
        folder / "column.toml",
        "--motion",
        folder / "first.csv",
        "--until-fall",
        "2",
        "--rest",
        "4s",
    ]
    out = folder / "out"
    answers = [json.loads(run(capsys, *arguments, "--replicates", "6", "--json", "--out", out)[1]) for _ in range(2)]
    assert answers[0]["until_fall"] == answers[1]["until_fall"]
    assert answers[0]["motions"][0]["not_fallen"] == 6
    assert answers[0]["motions"][0]["median_high"] is None
    assert pandas.read_csv(out / "until_fall.csv")["most"].tolist() == [2]
    code, _, error = run(capsys, "report", out, "--out", folder / "page.html")
    assert code == 0, error
    page = (folder / "page.html").read_text().replace("\u00a0", " ").replace("&nbsp;", " ")
    assert "Earthquakes until it falls, first.csv again and again: median of 6: more than 2" in page
    assert "with 4 s of quiet ground" in page


def test_a_study_of_sequences(folder):
    (folder / "study.toml").write_text("""column = "column.toml"
model = "dem2d"
[motions]
signs = "both"
[[motions.sequences]]
name = "pair"
files = ["first.csv", "second.csv"]
factors = [1.0, 2.0]
rest = "3s"
[scale]
levels = ["1", "9"]
""")
    study, refused = read_plan(folder / "study.toml")
    assert not refused
    as_it_is, reversed_ = study.motions
    np.testing.assert_array_equal(as_it_is.samples, -reversed_.samples)
    assert (as_it_is.record, reversed_.record) == ("pair", "pair")
    assert len(spans_of(as_it_is)) == 2
    table = st.run_study(study).table
    assert table["verdict"].tolist() == ["stands", "collapsed"] * 2
    assert table["fell_in_earthquake"].isna().tolist() == [True, False] * 2
    assert set(table["fell_in_earthquake"].dropna()) <= {1.0, 2.0}


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ([], "no motion is given"),
        (["--motion", "first.csv", "--rest", "-1s"], "--rest is -1"),
        (["--motion", "first.csv", "--rest", "1"], "--rest: '1' has no unit"),
        (["--motion", "first.csv", "--rest", "9000s"], "--rest is 9000"),
        (["--motion", "first.csv", "--repeat", "0"], "--repeat is 0"),
        (["--motion", "first.csv", "--repeat", "x"], "--repeat is 'x'"),
        (["--motion", "first.csv", "--motion", "vertical.csv"], "has the components x and"),
        (["--motion", "first.csv", "--motion", "second.csv", "--factors", "1,2,3"], "3 factors are given for 2"),
        (["--motion", "first.csv", "--factors", "1,much"], "--factors is 'much'"),
        (["--motion", "first.csv", "--until-fall", "0"], "allowed is"),
        (["--motion", "first.csv", "--until-fall", "3", "--repeat", "3"], "--repeat and --until-fall"),
        (["--motion", "first.csv", "--component", "all"], "--component all"),
        (["--motion", "first.csv", "--dask", "local"], "--dask computes many runs"),
        (["--motion", "first.csv", "--repeat", "900", "--rest", "3600s"], "samples; allowed is up to"),
        (["--motion", "column.toml"], "column.toml"),
    ],
)
def test_bad_input_is_one_sentence_and_nothing_is_written(folder, capsys, monkeypatch, arguments, sentence):
    monkeypatch.chdir(folder)
    code, printed, error = run(capsys, "sequence", "column.toml", *arguments, "--out", "out")
    assert (code, printed) == (2, "")
    assert sentence in error
    assert error.count("\n") == 1
    assert not (folder / "out").exists()
