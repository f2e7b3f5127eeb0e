"""``stylobate records`` as its user runs it: what is written, told, and refused."""

from __future__ import annotations

import json

import numpy as np
import pytest

from stylobate.cli.main import call
from stylobate.motion import Motion
from stylobate.motion.motion import write_csv
from stylobate.motion.specs import parse_synthetic

TARGET = "ec8,ag=0.2g,soil=B"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("records")
    for k, (m, r) in enumerate([(6.0, 10), (6.5, 20), (6.8, 15), (7.0, 30)]):
        write_csv(parse_synthetic(f"greece,{m}Mw,{r}km,seed={k}"), place / f"{k}.csv")
    return place


def test_what_is_written_reads_back_as_scaled(folder, tmp_path, capsys):
    """The scaled files, asked for again, have the mean that was told."""
    out = tmp_path / "out"
    arguments = ["records", str(folder), "--target", TARGET, "--count", "3", "--factors", "0.1:10"]
    assert call([*arguments, "--out", str(out)]) == 0
    summary = json.loads((out / "records.json").read_text())
    assert summary["meets"]
    capsys.readouterr()
    again = ["records", str(out / "scaled"), "--target", TARGET, "--count", "3", "--factors", "0.1:10", "--json"]
    assert call(again) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["mean_g"] == pytest.approx(summary["mean_g"], rel=1e-6)
    assert call([*arguments, "--condition", "pgv=0.3m/s"]) == 2
    assert "--condition pgv=0.3m/s scales every record before it is chosen" in capsys.readouterr().err
    # a second choice into the same folder would leave files of the first among its own
    assert call([*arguments[:5], "2", *arguments[6:], "--out", str(out)]) == 2
    assert "choose another folder" in capsys.readouterr().err
    assert call([*arguments, "--out", str(out)]) == 0
    page = tmp_path / "r.html"
    assert call(["report", str(out), "--out", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert summary["sentence"][:40] in text
    assert text.count("<td") > 3 * len(summary["records"])
    assert "stylobate records" in text


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (["--periods", "3s:0.2s"], "the first value must be below the second"),
        (["--periods", "0.2s:7s"], "allowed is [0, 4] s"),
        (["--where", "pgv=0.1:0.8"], "level '0.1' of pgv has no unit; write it with one, such as 0.1m/s"),
        (["--where", "pgv"], "write it as pgv=0.1m/s:0.8m/s"),
        (["--count", "40"], "4 records can be used, and 40 are asked for"),
        (["--per-event", "0"], "per_event"),
        (["--factors", "2:3"], "smallest factor is 2"),
    ],
)
def test_what_is_refused(folder, changed, words, capsys):
    factors = [] if "--factors" in changed else ["--factors", "0.1:10"]
    code = call(["records", str(folder), "--target", TARGET, *factors, *changed])
    error = capsys.readouterr().err
    assert code == 2, error
    assert words.split(" records")[0] in error
    assert "Traceback" not in error


def test_a_record_that_drifts_is_named_where_it_is_scaled_to_a_velocity(tmp_path, capsys):
    """In ida and in states, once each, and not where another measure is scaled."""
    time = 0.02 * np.arange(1001)
    shaking = 3.0 * np.sin(6.0 * np.pi * time) * np.exp(-(((time - 8.0) / 2.0) ** 2))
    for name, drift in (("drifts", 0.02), ("rests", 0.0)):
        write_csv(Motion(0.02, shaking + drift), tmp_path / f"{name}.csv")
    block = ["paper-monolithic", "--model", "housner"]
    for measure, levels in (("pgv", "0.1m/s:0.2m/s:2"), ("pga", "0.1g:0.2g:2")):
        size = ["--im", measure, "--levels", levels]
        for arguments in (
            ["ida", block[0], str(tmp_path), *block[1:], *size],
            ["states", str(tmp_path), "--as-built", block[0], "--as-found", block[0], *block[1:], *size],
        ):
            assert call(arguments) == 0
            warnings = [line for line in capsys.readouterr().err.splitlines() if "peak velocity of component x" in line]
            assert [line.partition("warning: ")[2].partition(":")[0] for line in warnings] == ["drifts.csv"] * (
                measure == "pgv"
            )
            assert all("--condition" in line for line in warnings)


def test_a_fragility_says_again_that_its_velocities_drift(tmp_path, capsys):
    """Of runs that ida kept; over another measure it says nothing."""
    time = 0.02 * np.arange(1001)
    shaking = 3.0 * np.sin(np.pi * time) * np.exp(-(((time - 8.0) / 2.0) ** 2))
    records, out = tmp_path / "records", tmp_path / "ida"
    records.mkdir()
    for k in range(3):
        write_csv(Motion(0.02, shaking * (1.0 + 0.2 * k) + 0.02 * (k == 0)), records / f"{k}.csv")
    hunt = ["ida", "paper-monolithic", str(records), "--model", "housner", "--runs", "8", "--largest-factor", "1000"]
    assert call([*hunt, "--out", str(out)]) == 0
    capsys.readouterr()
    for measure, names in (("pgv", ["0.csv"]), ("pga", [])):
        assert call(["fragility", str(out), "--im", measure, "--records-are-one"]) == 0
        warnings = [line for line in capsys.readouterr().err.splitlines() if "peak velocity of component x" in line]
        assert [line.partition("warning: ")[2].partition(":")[0] for line in warnings] == names


def test_a_manifest_beside_records_may_be_named(folder, tmp_path, capsys):
    """As it is read where it lies in their folder; one that tells of none of them is refused."""
    manifest = tmp_path / "manifest.csv"
    manifest.write_text("file,event\n0.csv,Somewhere Mw6.0\n1.csv,no size\n")
    arguments = [
        "records",
        str(folder),
        "--target",
        TARGET,
        "--count",
        "4",
        "--factors",
        "0.01:100",
        "--about",
        str(manifest),
    ]
    assert call([*arguments, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["records"]
    assert {row["record"]: row["magnitude"] for row in rows} == {
        "0.csv": 6.0,
        "1.csv": None,
        "2.csv": None,
        "3.csv": None,
    }
    manifest.write_text("file,event\nother.csv,Mw6.0\n")
    assert call(arguments) == 2
    assert "tells the magnitude of none of these records" in capsys.readouterr().err
    manifest.write_text("record,magnitude\n0.csv,6.1\n")  # a table of records, whatever it is called
    assert call([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["records"][0]["magnitude"] == 6.1


def test_files_that_are_not_there_are_named_as_typed(tmp_path, capsys):
    assert call(["records", str(tmp_path / "nope"), "--target", TARGET]) == 2
    assert f"stylobate: {tmp_path / 'nope'} holds no record that can be used; the first" in capsys.readouterr().err
