"""``stylobate experiments`` on a folder of the documented form, whose tests were made here: our own model and noise."""

import csv
import json

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.files import load_column

TOML = """name = "podium"
source = "made by the model itself"
fixed = 2026-11-01
structure = "column.toml"
model = "dem2d"
tail = "1s"
{extra}
[motions]
unit = "m/s2"
[scatter]
realisations = 3
friction = 0.1
width = 0.02
[[scores]]
measure = "{measure}"
score = "median"
tolerance = 1.5
[[scores]]
measure = "collapsed"
score = "share"
tolerance = 0.4
[[scores]]
measure = "peak_top_displacement_m"
score = "distribution"
tolerance = 0.6
"""
COLUMN = """name = "post"
density = 2000.0
[tapered]
height = 1.0
bottom_width = 0.2
top_width = 0.2
drums = 2
[joint]
normal_stiffness = 1e9
shear_stiffness = 5e8
friction_angle = 35
"""
NUMBER = 16


def folder(place, *, size=1.0, extra="", measure="peak_top_displacement_m", change=lambda rows: None):
    """Pulses of growing size; peaks of one half measured as numbers, of the other half as histories."""
    place.mkdir()
    (place / "experiment.toml").write_text(TOML.format(extra=extra, measure=measure))
    (place / "column.toml").write_text(COLUMN)
    rng, rows = np.random.default_rng(1), []
    column = load_column(place / "column.toml")
    t = np.arange(120) * 0.01
    for k in range(NUMBER):
        samples = 9.81 * (0.2 + 0.012 * k) * np.where(t < 0.4, np.sin(2.0 * np.pi * t / 0.4), 0.0)
        np.savetxt(place / f"m{k}.csv", np.column_stack((t, samples)), delimiter=",", header="time_s,ax")
        response = st.simulate(column, st.Motion(0.01, samples), st.DistinctElement2D(), tail=1.0)
        peak = response.measures.peak_top_displacement * size * np.exp(0.05 * rng.standard_normal())
        row = {"test": f"t{k}", "motion": f"m{k}.csv", "collapsed": int(response.collapsed)}
        row |= {"peak_top_displacement_m": "", "history": ""}
        if k % 2:
            row["peak_top_displacement_m"] = f"{peak:.6g}"
        else:
            row["history"] = f"h{k}.csv"
            (place / row["history"]).write_text(f"time_s,top_displacement_m\n0,0.001\n0.5,{0.001 - peak}\n1,0\n")
        rows.append(row)
    change(rows)
    with open(place / "tests.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return place


def run(capsys, *arguments):
    code = call(["experiments", *map(str, arguments)])
    return code, capsys.readouterr()


def scored(captured):
    return {row["score"]: row for row in json.loads(captured.out)["tested"]["podium"]["scores"]}


def test_what_was_made_by_the_model_is_within_and_what_is_far_is_outside(tmp_path, capsys):
    out = tmp_path / "out"
    code, captured = run(capsys, folder(tmp_path / "like"), "--out", out, "--threads", "1", "--json")
    assert code == 0, captured.err
    podium = json.loads(captured.out)["tested"]["podium"]
    assert podium["tests"] == NUMBER
    assert podium["runs"] == 3 * NUMBER
    assert podium["fixed"]["on"] == "2026-11-01"
    assert podium["fixed"]["realisations"] == 3
    assert podium["changed_since"] is None
    near = scored(captured)
    assert near["median"]["low"] <= 1.0 <= near["median"]["high"]
    assert near["share"]["low"] <= 0.0 <= near["share"]["high"]
    assert "outside" not in {score["verdict"] for score in near.values()}
    for name in ("podium_tests.csv", "podium_scores.csv", "podium_tests.png"):
        assert (out / name).is_file()
    code, captured = run(capsys, folder(tmp_path / "far", size=0.2), "--threads", "1", "--json")
    assert scored(captured)["median"]["verdict"] == "outside"


def test_a_change_of_what_was_fixed_is_told_for_good(tmp_path, capsys):
    out, first, other = tmp_path / "out", folder(tmp_path / "one"), folder(tmp_path / "other", extra="whole = true")
    run(capsys, first, "--out", out, "--threads", "1")
    code, captured = run(capsys, other, "--out", out, "--threads", "1")
    assert code == 0
    assert "fixed has been changed since" in captured.out
    assert "fixed has been changed since" in run(capsys, other, "--out", out, "--threads", "1")[1].out


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"extra": "fixed_on = 1"}, "unknown key 'fixed_on'"),
        ({"measure": "peak_top_displacment_m"}, "peak_top_displacement_m"),
        ({"measure": "collapsed"}, "is no score"),
        ({"extra": 'models = ["dem3d"]'}, "one model"),
        ({"change": lambda rows: [row.update(height=1) for row in rows]}, "has the column 'height'"),
        ({"change": lambda rows: [row.update(collapsed=2) for row in rows]}, "allowed are 0 and 1"),
        ({"change": lambda rows: [row.update(motion="none.csv") for row in rows]}, "there is no file"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(tmp_path, capsys, given, sentence):
    code, captured = run(capsys, folder(tmp_path / "odd", **given))
    assert code == 2
    assert sentence in captured.err
    assert "Traceback" not in captured.err


def test_a_test_that_cannot_be_used_is_named_and_the_rest_goes_on(tmp_path, capsys):
    def change(rows):
        rows[3]["peak_top_displacement_m"] = "high"
        rows[4]["test"] = rows[5]["test"]

    code, captured = run(capsys, folder(tmp_path / "some", change=change), "--threads", "1", "--json")
    answer = json.loads(captured.out)
    assert code == 0
    assert answer["tested"]["podium"]["tests"] == NUMBER - 2
    assert [refusal for refusal in answer["refused"] if "which is no finite number" in refusal]
    assert [refusal for refusal in answer["refused"] if "another row has this name" in refusal]
