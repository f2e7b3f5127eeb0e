"""The commands pushover and limit: JSON, files, exit codes."""

import json

import pytest

from stylobate.cli.main import call


def test_pushover_writes_curve_and_figure(tmp_path, capsys):
    assert call(["pushover", "paper-12-drums", "--json", "--out", str(tmp_path)]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["collapse_multiplier_g"] == pytest.approx(0.2046, rel=5e-3)
    assert answer["ultimate_displacement_m"] == pytest.approx(1.012, abs=2e-3)
    assert answer["governing_joint"] == 1
    assert len(answer["mechanism"]) == 12
    assert len(answer["curve"]["multiplier_g"]) == answer["steps"]
    names = {"pushover.csv", "pushover.json", "pushover.png", "pushover.svg", "asked-pushover.json"}
    assert {file.name for file in tmp_path.glob("[!.]*")} == names


def test_limit_writes_the_mechanism(tmp_path, capsys):
    assert call(["limit", "paper-monolithic", "--json", "--out", str(tmp_path)]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["collapse_multiplier_g"] == pytest.approx(0.2046, rel=5e-4)
    assert answer["upper_bound_g"] == pytest.approx(answer["lower_bound_g"], abs=1e-6)
    assert answer["active_joints"][0]["mode"] == "rocking right"
    assert (tmp_path / "limit.png").stat().st_size > 5000


def test_without_json_people_get_sentences(capsys):
    assert call(["limit", "paper-monolithic"]) == 0
    assert "0.2046 g" in capsys.readouterr().out


def test_joints_too_soft_for_the_weight_are_bad_input(tmp_path, capsys):
    file = tmp_path / "soft.toml"
    file.write_text(
        """
        name = "soft"
        density = 1600.0
        [tapered]
        height = 5.0
        bottom_width = 0.96
        top_width = 0.66
        drums = 1
        [joint]
        normal_stiffness = 2.0e6
        shear_stiffness = 1.0e6
        friction_angle = 35.0
        """
    )
    out = tmp_path / "out"
    assert call(["pushover", str(file), "--out", str(out)]) == 2
    shown = capsys.readouterr()
    assert "joint 1: its normal_stiffness is 2e+06 N/m³; needed is more than 2.02" in shown.err
    assert not out.exists()


def test_another_drum_than_the_top_is_led(tmp_path, capsys):
    led = ["pushover", "paper-12-drums", "--at", "6", "--to", "0.2", "--json"]
    assert call([*led, "--out", str(tmp_path)]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["led_drum"] == 6
    assert answer["curve"]["displacement_m"][-1] == pytest.approx(0.2)
    assert (tmp_path / "pushover.csv").read_text().startswith("step,drum_6_displacement_m,")
    assert call(["pushover", "paper-12-drums", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["collapse_multiplier_g"] == pytest.approx(
        answer["collapse_multiplier_g"]
    )
    for odd, words in (
        (["--at", "13"], "from 1 to 12"),
        (["--at", "6", "--check", "ec8,ag=0.25g,soil=B,type=1"], "--at"),
    ):
        assert call(["pushover", "paper-12-drums", *odd]) == 2
        assert words in capsys.readouterr().err


def test_a_path_that_ends_too_early_is_called_that(tmp_path, capsys):
    early = ["pushover", "paper-12-drums", "--to", "0.0001"]
    assert call([*early, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["peaked"] is False
    assert answer["collapse_multiplier_g"] is None
    assert answer["governing_joint"] is None
    assert answer["largest_multiplier_g"] == pytest.approx(max(answer["curve"]["multiplier_g"]))
    assert call([*early, "--out", str(tmp_path)]) == 0
    shown = capsys.readouterr().out
    assert "before it gives way" in shown
    assert "gives way at" not in shown


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["pushover", "paper-12-drums", "--to", "-0.1"], "control displacement"),
        (["pushover", "paper-12-drums", "--pattern", "1,2,3"], "3 values for 12 drums"),
        (["pushover", "paper-12-drums", "--compressive-strength", "1000"], "crushes under"),
        (["pushover", "paper-12-drums", "--control", "force"], "allowed are displacement"),
        (["limit", "paper-12-drums", "--tilt", "50"], "lower the tilt"),
        (["limit", "paper-12-drums", "--tilt", "steep"], "--tilt"),
        (["limit", "no-such-column"], "no-such-column"),
        (["limit", "paper-monolithic", "--directions", "0:90:100000"], "100000 directions; allowed are 1 to 360"),
    ],
)
def test_bad_input_is_one_sentence_and_exit_2(arguments, words, capsys):
    assert call(arguments) == 2
    shown = capsys.readouterr()
    assert words in shown.err
    assert shown.out == ""
