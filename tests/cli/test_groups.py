"""Options that commands share mean the same in all of them."""

import json

import numpy as np
import pytest

from stylobate.cli.main import call, commands, run_request, words_of
from stylobate.cli.options import Execution, Following, Motions, Population

COLUMN = """
name = "three"
section = "rectangular"
depth = 0.5
density = 2600.0
[tapered]
height = 2.4
bottom_width = 0.5
top_width = 0.45
drums = 3
[joint]
normal_stiffness = 5.0e9
shear_stiffness = 2.5e9
friction_angle = 35.0
"""


@pytest.fixture
def folder(tmp_path):
    """A column, and a record of one shock behind two quiet seconds."""
    (tmp_path / "column.toml").write_text(COLUMN)
    time = np.arange(0.0, 3.0, 0.01)
    shock = 0.3 * np.exp(-(((time - 2.5) / 0.2) ** 2)) * np.sin(2.0 * np.pi * 2.0 * time) * (time > 1.9)
    lines = [f"{t:.2f},{a:.6f}" for t, a in zip(time, shock, strict=True)]
    (tmp_path / "record.csv").write_text("\n".join(["time_s,ax_g", *lines]) + "\n")
    return tmp_path


def answer(capsys, *words):
    assert call([*map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_compare_leaves_the_quiet_of_a_record_out_as_run_does(capsys, folder):
    column, record = folder / "column.toml", ("--motion", folder / "record.csv")
    run = answer(capsys, "run", column, *record, "--replicates", "0")
    (compared,) = answer(capsys, "compare", column, "--models", "dem2d", *record)["runs"]
    assert compared["stepped_s"] is not None
    assert {key: compared[key] for key in run.keys() & compared.keys() - {"wall_s"}} == {
        key: run[key] for key in run.keys() & compared.keys() - {"wall_s"}
    }
    (whole,) = answer(capsys, "compare", column, "--models", "dem2d", *record, "--whole")["runs"]
    assert whole.get("stepped_s") is None
    assert whole["steps"] > compared["steps"]


def test_losses_go_with_the_model_wherever_one_is_computed():
    """A command that computes with a model has ``--losses``; not ``cite``, nor ``calibrate``, which finds
    losses, nor ``modes``, in which nothing is lost."""
    names = {
        name: {flag for parameter in command.params for flag in parameter.opts}
        for name, command in commands().commands.items()
    }
    computing = {name for name, flags in names.items() if flags & {"--model", "--models"}} - {
        "calibrate",
        "cite",
        "modes",
    }
    assert {"run", "domain", "compare", "suite", "critical", "ida", "states", "sequence"} <= computing
    assert [name for name in sorted(computing) if "--losses" not in names[name]] == []


def test_losses_are_for_the_models_that_know_them(capsys, folder):
    words = "compare", folder / "column.toml", "--motion", folder / "record.csv", "--losses", "stone"
    runs = answer(capsys, *words, "--models", "rigid-block,dem2d,dem2d:losses=none")["runs"]
    assert [run["losses"] for run in runs] == [None, "stone", "none"]
    assert call([*map(str, words), "--models", "rigid-beam,rigid-block"]) == 2
    assert "none of the models rigid-beam, rigid-block knows them" in capsys.readouterr().err


def test_states_step_all_of_a_record_where_asked(capsys, folder):
    (folder / "again.toml").write_text(COLUMN)
    states = "--as-built", folder / "column.toml", "--with", folder / "again.toml"
    for options, stepped in (((), True), (("--whole",), False)):
        out = folder / f"out{len(options)}"
        answer(capsys, "states", folder / "record.csv", *states, *options, "--out", out)
        assert ("stepped_s" in (out / "states.csv").read_text().splitlines()[0]) == stepped


def test_an_ida_takes_both_signs_of_a_record_and_counts_it_once(capsys, folder):
    words = folder / "record.csv", "--model", "rigid-block", "--im", "pga", "--runs", "4", "--signs", "both"
    result = answer(capsys, "ida", folder / "column.toml", *words)
    assert [capacity["motion"] for capacity in result["capacities"]] == ["record.csv", "record.csv reversed"]
    assert result["records"] == 1


def test_options_of_a_group_are_said_alike_wherever_they_are():
    """The help of an option is that of its group, unless the command says more of it."""
    own = {
        ("critical", "harmonic"),
        ("critical", "across"),
        ("critical", "pulse"),
        ("domain", "tail"),
        ("domain", "duration"),
    }
    own |= {
        ("calibrate", "unit"),
        ("calibrate", "dt"),
        ("convert", "columns"),
        ("spectrum", "tail"),
        ("sequence", "motion"),
        ("compare", "settings"),
        ("reproduce", "out"),
        ("draw", "out"),
        ("draw", "scale"),
        ("report", "out"),
        ("serve", "out"),
    }
    groups = {
        name: field.default
        for kind in (Motions, Following, Population, Execution)
        for name, field in kind.__dataclass_fields__.items()
    }
    shared = 0
    for command, made in commands().commands.items():
        for option in getattr(made, "params", ()):
            known = groups.get(option.name)
            if (
                known is None
                or (command, option.name) in own
                or getattr(option, "help", None) is None
                or option.name == "seed"
            ):
                continue
            assert option.help == known.help, (command, option.name)
            shared += 1
    assert shared > 100


def test_a_request_does_what_its_command_line_does(capsys, folder):
    column, record = str(folder / "column.toml"), str(folder / "record.csv")
    request = {"command": "run", "column": column, "model": "dem2d", "set": ["points=2"], "motion": [record]}
    request |= {"replicates": "0", "whole": True, "pictures": False, "scale": None, "json": True}
    words = ["run", column, "--model=dem2d", "--set=points=2", f"--motion={record}", "--replicates=0", "--whole"]
    assert words_of(request) == [*words, "--no-pictures", "--json"]
    answers = []
    for do in (lambda: run_request(request), lambda: call(words_of(request))):
        assert do() == 0
        answers.append(json.loads(capsys.readouterr().out) | {"wall_s": 0.0})
    assert answers[0] == answers[1]
    for wrong, why in (
        ({"modell": "x"}, "run takes no 'modell'"),
        ({"column": None}, "--column is missing; give it"),
        ({"command": "ida", "sources": [record], "runs": "x"}, "--runs is 'x'; allowed is a whole number."),
    ):
        plain = {"command": "run", "column": column, "motion": [record]}
        if "command" in wrong:
            plain.pop("motion")
        assert run_request(plain | wrong) == 2
        assert why in capsys.readouterr().err
