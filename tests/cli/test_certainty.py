"""How sure a verdict is and where it comes from, on the command line: promised keys, pictures, and what is refused."""

import json

import numpy as np
import pytest

from stylobate.cli.main import call

COLUMN = """name = "three"
section = "circular"
density = 2600.0
[tapered]
height = 2.4
bottom_width = 0.5
top_width = 0.4
drums = 3
[joint]
normal_stiffness = 2.0e9
shear_stiffness = 1.0e9
friction_coefficient = 0.7
"""
KEYS = {"collapse_probability", "collapse_interval_low", "collapse_interval_high", "replicates"}


@pytest.fixture
def column(tmp_path):
    path = tmp_path / "three.toml"
    path.write_text(COLUMN)
    return path


@pytest.fixture
def record(tmp_path):
    """A sine of 0.4 g along x, and half of it along y, a quarter of a cycle later."""
    time = np.arange(0.0, 2.0, 0.01)
    wave = 0.4 * np.sin(2 * np.pi * time)
    lines = [f"{t:.2f},{x:.6f},{y:.6f}" for t, x, y in zip(time, wave, 0.5 * np.roll(wave, 25))]
    path = tmp_path / "wave.csv"
    path.write_text("\n".join(["time_s,ax_g,ay_g", *lines]))
    return path


@pytest.fixture
def answer(capsys):
    def run(*arguments):
        assert call([str(argument) for argument in (*arguments, "--json")]) == 0, capsys.readouterr().err
        return json.loads(capsys.readouterr().out)

    return run


@pytest.fixture
def refusal(capsys):
    def run(*arguments):
        assert call([str(argument) for argument in arguments]) == 2
        return capsys.readouterr().err

    return run


def test_a_single_run_says_how_sure_it_is_unless_told_not_to(answer, column, record):
    result = answer("run", column, "--motion", record)
    assert KEYS <= set(result)
    assert result["replicates"] == 15
    assert result["certainty"]["scatter"]["friction"] == 0.1
    assert result["certainty"]["seed"] == 0
    assert result["collapse_interval_low"] <= result["collapse_probability"] <= result["collapse_interval_high"]
    bare = answer("run", column, "--motion", record, "--replicates", "0")
    assert not KEYS & set(bare)
    assert {key: result[key] for key in bare if key != "wall_s"} == {key: bare[key] for key in bare if key != "wall_s"}


def test_replicates_asked_for_leave_a_table_and_the_strip_of_the_median_run(answer, column, record, tmp_path):
    result = answer(
        *("run", column, "--motion", record, "--replicates", "17", "--seed", "2"),
        *("--scatter", "friction=20%,width=1%", "--out", tmp_path / "out"),
    )
    assert result["replicates"] == 17
    assert result["certainty"]["scatter"]["joint_stiffness"] == 0.0
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"replicates.csv", "median.png", "median.svg"} <= names
    assert len((tmp_path / "out" / "replicates.csv").read_text().splitlines()) == 18


def test_a_sweep_of_directions_names_the_worst_and_draws_a_compass(answer, column, record, tmp_path):
    sweep = ("--motion", record, "--azimuths", "0:90:2", "--signs", "both")
    result = answer(
        "critical", column, *sweep, "--from", "0.3g", "--to", "0.9g", "--step", "0.3g", "--out", tmp_path / "c"
    )
    assert {(row["azimuth_deg"], row["reversed"]) for row in result["records"]} == {
        (0.0, False), (0.0, True), (90.0, False), (90.0, True)
    }  # fmt: skip
    factors = [row["critical_factor"] for row in result["records"] if row["critical_factor"] is not None]
    assert result["critical_factor"] == min(factors) == result["worst"]["critical_factor"]
    assert (tmp_path / "c" / "directions.png").is_file()
    suite = answer("suite", column, record, "--azimuths", "0:90:2", "--replicates", "3", "--out", tmp_path / "s")
    assert all(set(row) >= KEYS for row in suite["runs"])
    assert suite["worst"]["azimuth_deg"] in (0.0, 90.0)
    assert (tmp_path / "s" / "directions.png").is_file()
    runs = answer("run", column, "--motion", record, "--signs", "both", "--replicates", "0")
    assert [run["reversed"] for run in runs["runs"]] == [False, True]
    assert runs["worst"] in runs["runs"]


def test_critical_answers_with_the_probability_over_the_factor(answer, column, record, tmp_path):
    grid = ("--from", "0.2g", "--to", "1.0g", "--step", "0.2g")
    result = answer("critical", column, "--motion", record, *grid, "--replicates", "4", "--out", tmp_path / "c")
    assert result["runs"] == 5  # those of the column itself; its twins are counted apart
    assert len(result["collapse_probability"]) == len(result["factors"]) == len(result["collapse_interval_high"]) == 5
    assert result["factors"] == pytest.approx([0.5, 1.0, 1.5, 2.0, 2.5], rel=1e-3)  # the record peaks at 0.4 g
    assert result["critical_factor"] == pytest.approx(result["critical_g"] / 0.4, rel=1e-3)
    counts = result["certainty"]
    assert sum(counts[outcome] for outcome in ("collapsed", "stands", "undecided", "failed")) == 20
    assert (tmp_path / "c" / "probability.png").is_file()
    formula = answer("critical", column, "--harmonic", "1Hz,?g,1s", *grid)
    assert formula["critical_factor"] is None
    assert formula["replicates"] == 15  # as many as run takes along, unasked, at a dozen of the amplitudes at most
    fine = answer("critical", column, "--harmonic", "1Hz,?g,0.2s", "--from", "0.01g", "--to", "0.2g", "--step", "0.01g")
    assert (fine["runs"], len(fine["amplitudes_g"])) == (20, 12)
    bare = answer("critical", column, "--motion", record, *grid, "--replicates", "0")
    assert not KEYS & set(bare)
    assert [bare[key] for key in ("critical_g", "alternation")] == [
        result[key] for key in ("critical_g", "alternation")
    ]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--replicates", "many"), "allowed is a whole number from 0 on, such as 30"),
        (("--replicates", "1000000"), "allowed is a whole number from 0 to 100000"),
        (("--seed", "3"), "give --replicates as well"),
        (("--replicates", "5", "--scatter", "colour=5%"), "names are friction"),
        (("--replicates", "5", "--scatter", "friction=90%"), "0.05 is five per cent"),
        (("--replicates", "5", "--scatter", "friction=0"), "nothing scatters"),
    ],
)
def test_what_makes_no_replicates_is_refused_in_a_sentence(refusal, column, record, options, words):
    for command in (("run", column, "--motion", record), ("suite", column, record)):
        text = refusal(*command, *options)
        assert words in text
        assert text.count("\n") == 1
