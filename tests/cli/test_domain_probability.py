"""``stylobate domain --replicates`` and ``--half-step``: keys, files, and what is refused."""

import json

import pytest

from stylobate.cli.main import call

GRID = ["domain", "paper-monolithic", "--model", "housner", "--frequencies", "0.5:2:3", "--amplitudes", "0.1g:0.5g:4",
        "--duration", "5s"]  # fmt: skip
KEYS = {
    "cells", "replicates", "imperfection", "seed", "confidence", "all_stand", "some_collapse", "all_collapse",
    "no_verdict", "band_width_median_g", "band_width_largest_g", "band_open_frequencies", "amplitude_step_g", "runs",
    "collapsed", "stands", "undecided", "failed", "not_run", "wall_s", "model", "version", "files",
}  # fmt: skip


def test_replicates_give_counts_table_file_and_figure(capsys, tmp_path):
    options = ["--replicates", "5", "--imperfection", "geometry=5%,phase=0.1", "--seed", "7"]
    assert call([*GRID, *options, "--out", str(tmp_path), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result) >= KEYS
    assert (result["cells"], result["replicates"], result["runs"], result["seed"]) == (12, 5, 60, 7)
    assert result["imperfection"] == {
        "geometry": 0.05, "friction": 0.0, "stiffness": 0.0, "amplitude": 0.0, "phase": 0.1, "across": 0.0,
    }  # fmt: skip
    assert result["collapsed"] + result["stands"] + result["undecided"] + result["failed"] == 60
    names = {path.name for path in tmp_path.glob("[!.]*")}
    results = {f"probability.{end}" for end in ("nc", "csv", "png", "svg", "json")} | {"asked-domain.json"}
    assert names == results | {"runs.sqlite"}
    assert sorted(result["files"]) == sorted(str(tmp_path / name) for name in results)


def test_a_person_is_told_how_wide_the_doubt_is(capsys):
    assert call([*GRID, "--replicates", "4", "--imperfection", "3%"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("Of 12 cells, all variations stand in ")
    assert "geometry ±0.03, friction ±0.03, stiffness ±0.03" in text


def test_half_step_counts_the_verdicts_that_differ(capsys):
    options = ["--set", "time_step=0.004", "--half-step"]
    assert call([*GRID, *options, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["half_step"]
    assert found["comparable"] >= found["differing"] >= 0
    assert call([*GRID, *options]) == 0
    assert "With half of the time step" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--replicates", "many"], "--replicates is 'many'"),
        (["--replicates", "0"], "replicates is 0"),
        (["--replicates", "3", "--imperfection", "width=1%"], "width"),
        (["--replicates", "3", "--imperfection", "much"], "no size of imperfections"),
        (["--replicates", "3", "--imperfection", "friction=200%"], "friction of the imperfections"),
        (["--replicates", "3", "--half-step"], "--half-step is for a domain without --replicates"),
        (["--imperfection", "1%"], "--imperfection is for variations"),
        (["--seed", "1"], "--seed is for variations"),
        (["--half-step"], "chooses its steps by itself"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(capsys, tmp_path, options, words):
    assert call([*GRID, *options, "--out", str(tmp_path / "never"), "--json"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1
    assert words in err
