"""``stylobate domain --replicates`` and ``--half-step``: keys, files, and what is refused."""

import json

import pytest

from stylobate.cli.main import call

GRID = ["domain", "paper-monolithic", "--model", "housner", "--frequencies", "0.5:2:3", "--amplitudes", "0.1g:0.5g:4",
        "--duration", "5s"]  # fmt: skip
KEYS = {
    "cells", "replicates", "scatter", "motion_scatter", "left_out", "seed", "confidence", "all_stand",
    "some_collapse", "all_collapse", "no_verdict", "band_width_median_g", "band_width_largest_g",
    "band_open_frequencies", "amplitude_step_g", "runs", "collapsed", "stands", "undecided", "failed", "not_run",
    "wall_s", "model", "version", "files",
}  # fmt: skip


def test_replicates_give_counts_table_file_and_figure(capsys, tmp_path):
    options = ["--replicates", "5", "--scatter", "width=5%", "--motion-scatter", "phase=0.1", "--seed", "7"]
    assert call([*GRID, *options, "--out", str(tmp_path), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result) >= KEYS
    assert (result["cells"], result["replicates"], result["runs"], result["seed"]) == (12, 5, 60, 7)
    assert result["scatter"] == {
        "friction": 0.0, "joint_stiffness": 0.0, "density": 0.0, "width": 0.05, "height": 0.0, "offset": 0.0,
        "stiffness_damping": 0.0, "rolling_resistance": 0.0, "law": 0.0, "unknown_stiffness": 0.0,
    }  # fmt: skip
    assert result["motion_scatter"] == {"amplitude": 0.0, "phase": 0.1, "across": 0.0}
    assert result["collapsed"] + result["stands"] + result["undecided"] + result["failed"] == 60
    names = {path.name for path in tmp_path.glob("[!.]*")}
    results = {f"probability.{end}" for end in ("nc", "csv", "png", "svg", "json")} | {"asked-domain.json"}
    assert names == results | {"runs.sqlite"}
    assert sorted(result["files"]) == sorted(str(tmp_path / name) for name in results)


def test_a_person_is_told_how_wide_the_doubt_is(capsys):
    assert call([*GRID, "--replicates", "4", "--motion-scatter", "phase=0.1,amplitude=3%,across=1%"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("Of 12 cells, all columns stand in ")
    assert "4 that vary by width 0.5 %, height 0.5 %" in text
    assert "seed 0, without friction, joint stiffness, density, offset, across, which the model does not take" in text
    assert "vary by amplitude ±3 %, phase ±0.1 cycles\n" in text


def test_half_step_counts_the_verdicts_that_differ(capsys):
    options = ["--set", "time_step=0.004", "--half-step"]
    assert call([*GRID, *options, "--json"]) == 0
    half_step = json.loads(capsys.readouterr().out)["half_step"]
    assert half_step["comparable"] >= half_step["differing"] >= 0
    assert call([*GRID, *options]) == 0
    assert "With half of the time step" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--replicates", "many"], "--replicates is 'many'"),
        (["--replicates", "0"], "replicates is 0"),
        (["--replicates", "3", "--scatter", "geometry=1%"], "--scatter names 'geometry'"),
        (["--replicates", "3", "--motion-scatter", "phase=much"], "'much' is no size"),
        (["--replicates", "3", "--motion-scatter", "across=200%"], "across of the motion's scatter is 2"),
        (["--replicates", "3", "--scatter", "offset=1%"], "nothing scatters, as housner does not take offset"),
        (["--replicates", "3", "--scatter", "width=0", "--motion-scatter", "across=1%"], "nothing scatters"),
        (["--replicates", "3", "--half-step"], "--half-step is for a domain without --replicates"),
        (["--motion-scatter", "phase=0.1"], "--motion-scatter is for columns like this one"),
        (["--seed", "1"], "--seed is for columns like this one"),
        (["--half-step"], "chooses its steps by itself"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(capsys, tmp_path, options, words):
    assert call([*GRID, *options, "--out", str(tmp_path / "never"), "--json"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1
    assert words in err
