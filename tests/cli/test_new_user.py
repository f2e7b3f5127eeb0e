"""What a new user stumbled over: answers in the units that were typed, defaults, and sentences that do not contradict."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import stylobate as st
from stylobate.cli import critical as command
from stylobate.cli.main import call
from stylobate.column.files import load_column
from stylobate.motion.intensity import motion_summary
from stylobate.verdicts.critical import CriticalAmplitude

FOUND = """\
density = 1600.0
[tapered]
height = 5.0
bottom_width = 0.96
top_width = 0.66
drums = 3
[joint]
normal_stiffness = 5.0e10
shear_stiffness = 2.5e10
friction_angle = 35.0
[as_found]
base_tilt = 0.5
[[as_found.drum]]
index = 2
offset = 0.03
chip_left = 0.05
"""


@pytest.fixture
def output_of(capsys):
    def run(*arguments, code=0):
        assert call([str(argument) for argument in arguments]) == code
        captured = capsys.readouterr()
        return captured.out if code == 0 else captured.err

    return run


def test_a_step_without_unit_is_told_how_it_is_written(output_of, tmp_path):
    record = tmp_path / "record.txt"
    record.write_text("0.0\n0.1\n-0.1\n0.0\n")
    text = output_of("motion", record, "--unit", "g", "--dt", "0.02", code=2)
    assert "'0.02' has no unit; write it with one, such as 0.02s." in text
    assert "such as 5s" in output_of("run", "paper-monolithic", "--harmonic", "1Hz,0.1g,1s", "--tail", "5", code=2)


def test_amplitudes_are_answered_in_g(output_of):
    text = output_of(
        "critical",
        "paper-monolithic",
        "--model",
        "housner",
        "--harmonic",
        "1Hz,?g,1s",
        "--from",
        "1.0g",
        "--to",
        "0.2g",
        code=2,
    )
    assert "the largest amplitude is 0.2 g; allowed is [1, 1000] g; it must not be below the smallest." in text
    assert "m/s²" not in text


def test_a_model_need_not_be_named(output_of):
    for arguments in (
        ("run", "paper-monolithic", "--harmonic", "1Hz,0.1g,0.2s"),
        ("critical", "paper-monolithic", "--harmonic", "1Hz,?g,0.2s", "--from", "0.1g", "--to", "0.1g"),
    ):
        assert json.loads(output_of(*arguments, "--json"))["model"] == "dem2d"
    arguments = ("--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2", "--duration", "0.1s")
    assert json.loads(output_of("domain", "paper-monolithic", *arguments, "--json"))["model"] == "dem2d"


@pytest.mark.parametrize(("text", "value"), [("2MPa", 2e6), ("2e6", 2e6), ("2 N/mm2", 2e6), ("0.002GPa", 2e6)])
def test_strengths_have_units(output_of, text, value):
    multipliers = [
        json.loads(output_of("limit", "paper-12-drums", "--compressive-strength", strength, "--json"))[
            "collapse_multiplier_g"
        ]
        for strength in (text, f"{value}")
    ]
    assert multipliers[0] == multipliers[1]
    assert multipliers[0] < json.loads(output_of("limit", "paper-12-drums", "--json"))["collapse_multiplier_g"]


def test_a_strength_that_is_not_understood_is_told_how_it_is_written(output_of):
    assert "'2MPa'" in output_of("limit", "paper-12-drums", "--compressive-strength", "2 tons", code=2)


def test_columns_say_what_is_as_found(output_of, tmp_path):
    path = tmp_path / "found.toml"
    path.write_text(FOUND)
    text = output_of("columns", path)
    assert "slopes by 0.5°" in text
    assert "offset 0.03 m, chipped on the left by 0.05 m" in text
    as_found = json.loads(output_of("columns", path, "--json"))["columns"][0]["as_found"]
    assert as_found["base_tilt"] == 0.5
    assert as_found["drums"][0]["drum"] == 2
    assert json.loads(output_of("columns", "paper-monolithic", "--json"))["columns"][0]["as_found"] is None


def test_the_peak_velocity_is_one_number():
    coarse = st.Motion(0.1, np.array([0.0, 1.0, -0.6, 0.3, 0.0]))
    assert coarse.pgv == motion_summary(coarse)["pgv_m_s"]["x"]
    # between the samples, where the acceleration passes zero: 0.05 + 1/1.6 of a step under a triangle
    assert coarse.pgv == pytest.approx(0.05 + 0.5 * 0.1 / 1.6, rel=1e-12)


@pytest.mark.parametrize(
    ("collapsed", "sentence"),
    [
        (
            [0, 0, 1, 1],
            "collapses at 0.3 g (the next below that was looked at is 0.2 g), and at all larger ones up to 0.4 g.",
        ),
        (
            [0, 1, 0, 1],
            "at 0.2 g (the next below that was looked at is 0.1 g), but stands again at 0.3 g: no single amplitude",
        ),
        (
            [0, 1, 0, 0],
            "collapses at 0.2 g (the next below that was looked at is 0.1 g), but stands again at 0.3 to 0.4 g",
        ),
        (
            [1, 1, 0, 1],
            "The column collapses already at 0.1 g, the lowest amplitude looked at, but stands again at 0.3 g",
        ),
        ([0, 0, 0, 0], "No amplitude looked at, 0.1 to 0.4 g, collapses the column; larger ones were not looked at."),
    ],
)
def test_sentences_on_collapse_do_not_contradict_themselves(capsys, collapsed, sentence):
    column, motion = load_column("paper-monolithic"), st.harmonic(1.0, 1.0, 0.1)
    run = st.simulate(column, motion, st.HousnerBlock()).measures.row()
    rows = [
        run | {"collapsed": bool(flag), "outcome": "collapsed" if flag else "rocked", "decided": True}
        for flag in collapsed
    ]
    result = CriticalAmplitude(column, motion, "housner", st.g * np.array([0.1, 0.2, 0.3, 0.4]), rows, 1.0)
    command.describe(result, result.summary(), motion, [])
    output = capsys.readouterr().out
    assert sentence in output
    assert "one alone says little: with 15 replicates" in output


def test_folders_and_records_whose_names_are_no_text(tmp_path):
    record = os.fsencode(tmp_path) + b"/r\xffcord$.csv"
    with open(record, "w") as file:
        file.write("time_s,ax_g\n" + "".join(f"{0.02 * i:.2f},{0.3 * (-1) ** (i // 5)}\n" for i in range(20)))
    command = [sys.executable, "-m", "stylobate.cli.main", "run", "paper-monolithic", "--model", "housner"]
    command += ["--motion", os.fsdecode(record), "--out", os.fsdecode(os.fsencode(tmp_path) + b"/o\xe4t")]
    people = subprocess.run(command, capture_output=True)
    assert people.returncode == 0, people.stderr
    assert rb"o\udce4t" in people.stdout
    script = subprocess.run([*command, "--json"], capture_output=True)
    assert script.returncode == 0, script.stderr
    assert all(os.path.isfile(file) for file in json.loads(script.stdout)["files"])


@pytest.mark.parametrize(
    "arguments", [("columns", "x" * 5000), ("run", "x" * 300 + ".toml", "--harmonic", "1Hz,0.1g,1s")]
)
def test_names_that_no_disk_takes_are_bad_input(output_of, arguments):
    text = output_of(*arguments, code=2)
    assert text.startswith("stylobate: ")
    assert len(text.splitlines()) == 1
    assert len(text) < 500
