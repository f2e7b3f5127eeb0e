"""Commands that are stopped keep what is finished, and no command writes over what is not its own."""

import json
import math

import pandas
import pytest

from stylobate.atomic import LIST
from stylobate.campaign.ledger import Holding
from stylobate.cli.main import call
from stylobate.models.drums.stepped import LaneEngine
from stylobate.models.rocking.model import Rocking
from stylobate.results.command_request import CommandRequest

HOUSNER = ["--model", "housner"]
COLUMN = """name = "my"
section = "rectangular"

[[drum]]
height = 5.0
bottom_width = 0.9
top_width = 0.9
density = 2000.0
depth = 1.0

[joint]
normal_stiffness = 5e10
shear_stiffness = 2.5e10
friction_coefficient = 0.7
"""


@pytest.fixture
def records(tmp_path):
    folder = tmp_path / "records"
    folder.mkdir()
    for k in range(3):
        lines = [f"{0.01 * i:.2f},{(2 + 2 * k) * math.sin(0.06 * i):.6f}" for i in range(200)]
        (folder / f"record-{k}.csv").write_text("\n".join(["time_s,ax_m_s2", *lines, ""]))
    return folder


@pytest.fixture
def counted(monkeypatch):
    """Stops the batch after so many runs; counts those that are made."""
    state = {"runs": 0, "stop": None}
    real = Rocking.run_many

    def run_many(self, cases, options, threads):
        for result in real(self, cases, options, 1):
            if state["runs"] == state["stop"]:
                raise KeyboardInterrupt
            state["runs"] += 1
            yield result

    monkeypatch.setattr(Rocking, "run_many", run_many)
    return state


def commands(records):
    grid = ["--from", "0.1g", "--to", "0.5g", "--step", "0.1g"]
    domain = ["--frequencies", "1:2:2", "--amplitudes", "0.1g:0.4g:3", "--duration", "2s"]
    return {
        "critical": (["critical", "paper-monolithic", *HOUSNER, *grid, "--harmonic", "1Hz,?g,2s"], 5),
        "records": (["critical", "paper-monolithic", *HOUSNER, *grid, "--motion", str(records)], 17),  # two as they are
        "suite": (["suite", "paper-monolithic", str(records), *HOUSNER], 3),
        "domain": (["domain", "paper-monolithic", *HOUSNER, *domain], 6),
        "ida": (["ida", "paper-monolithic", str(records), *HOUSNER, "--runs", "5", "--largest-factor", "5"], 15),
    }


@pytest.mark.parametrize("name", ["critical", "records", "suite", "domain", "ida"])
def test_what_is_finished_is_kept_and_the_same_command_goes_on(name, records, counted, tmp_path, capsys):
    command, runs = commands(records)[name]
    whole, out = tmp_path / "whole", tmp_path / "out"
    assert call([*command, "--out", str(whole)]) == 0
    assert counted["runs"] == runs
    capsys.readouterr()
    counted.update(runs=0, stop=2)
    assert call([*command, "--out", str(out)]) == 130
    assert f"interrupted; 2 of {runs} runs are kept in {out}" in capsys.readouterr().err
    counted.update(runs=0, stop=None)
    assert call([*command, "--out", str(out)]) == 0
    assert counted["runs"] == runs - 2
    for path in whole.glob("*.csv"):
        assert (out / path.name).read_bytes() == path.read_bytes()
    assert [path.name for path in out.glob("*.sqlite*")] == ["runs.sqlite"]
    counted.update(runs=0, stop=2)
    assert call(command) == 130
    assert f"interrupted after 2 of {runs} runs; nothing is kept: with --out DIR" in capsys.readouterr().err


def test_a_folder_of_records_goes_on_with_the_next(records, tmp_path, capsys, monkeypatch):
    out, made = tmp_path / "out", []
    real = Rocking.run

    def run(self, motion, options):
        if len(made) == 2:
            raise KeyboardInterrupt
        made.append(motion.name)
        return real(self, motion, options)

    monkeypatch.setattr(Rocking, "run", run)
    monkeypatch.setattr(
        "stylobate.cli.run.write", lambda response, _, folder, everything: [response.save(folder / "response.nc")]
    )
    command = ["run", "paper-monolithic", *HOUSNER, "--motion", str(records), "--out", str(out)]
    assert call(command) == 130
    assert f"interrupted; 2 of 3 runs are kept in {out}" in capsys.readouterr().err
    made[:] = []
    assert call(command) == 0
    assert len(made) == 1
    assert capsys.readouterr().out.count("record-") >= 3
    assert {path.name for path in out.glob("[!.]*")} == {*(f"record-{k}.csv" for k in range(3)), "runs.sqlite"}


SPREAD = ["--replicates", "18", "--scatter", "friction=10%"]


@pytest.mark.parametrize("several", [False, True])
def test_a_run_goes_on_with_its_twins(several, tmp_path, capsys, monkeypatch):
    """Its fifteen twins ride along with it; the three others are made after it, two of them before the interrupt."""
    from stylobate.verdicts import population as module

    state, real, real_many = {"runs": 0, "twins": 0, "stop": None}, module.simulate, LaneEngine.run_many

    def simulate(*arguments, **options):
        state["runs"] += 1
        return real(*arguments, **options)

    def run_many(self, cases, options, threads):
        for result in real_many(self, cases, options, 1):
            if state["twins"] == state["stop"]:
                raise KeyboardInterrupt
            state["twins"] += 1
            yield result

    monkeypatch.setattr(module, "simulate", simulate)
    monkeypatch.setattr(LaneEngine, "run_many", run_many)
    command = ["run", "paper-monolithic", "--harmonic", "1Hz,0.3g,1s", *SPREAD, "--no-pictures"]
    command += ["--azimuths", "0,180"] if several else []
    whole, out = tmp_path / "whole", tmp_path / "out"
    assert call([*command, "--out", str(whole)]) == 0
    state.update(runs=0, twins=0, stop=2)
    capsys.readouterr()
    assert call([*command, "--out", str(out)]) == 130
    message = capsys.readouterr().err
    if several:
        assert f"0 of 2 runs are kept in {out}, and of the one under way itself and 2 of 3 like it: the same" in message
    else:
        assert f"interrupted; 2 of 3 runs are kept in {out}: the same command goes on" in message
    state.update(runs=0, twins=0, stop=None)
    assert call([*command, "--out", str(out)]) == 0
    assert (state["runs"], state["twins"]) == ((1, 4) if several else (0, 1))
    for file in whole.rglob("replicates.csv"):
        assert (out / file.relative_to(whole)).read_bytes() == file.read_bytes()
    for file in whole.rglob("run.json"):
        first, again = (json.loads(path.read_text()) for path in (file, out / file.relative_to(whole)))
        assert [key for key in first if first[key] != again[key]] == ["wall_s", "files"]


def test_a_folder_in_use_is_refused_before_anything_is_computed(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("stylobate.verdicts.population.simulate", lambda *_, **__: pytest.fail("computed first"))
    holding = Holding(tmp_path / "runs.sqlite")
    try:
        assert call(["run", "paper-monolithic", "--harmonic", "1Hz,0.3g,1s", *SPREAD, "--out", str(tmp_path)]) == 2
        assert "runs.sqlite is not free: another process is at work on it" in capsys.readouterr().err
    finally:
        holding.release()


def test_a_comparison_goes_on_with_the_next_model(tmp_path, capsys, monkeypatch):
    from stylobate.verdicts import compare as module

    command = [
        "compare",
        "paper-monolithic",
        "--models",
        "housner,housner:restitution=0.9",
        "--harmonic",
        "1Hz,0.3g,2s",
    ]
    assert call([*command, "--out", str(tmp_path / "whole")]) == 0
    real, made = module.simulate, []

    def simulate(*arguments, **options):
        if made:
            raise KeyboardInterrupt
        made.append(real(*arguments, **options))
        return made[-1]

    monkeypatch.setattr(module, "simulate", simulate)
    assert call([*command, "--out", str(tmp_path / "out")]) == 130
    assert "interrupted; 1 of 2 runs are kept" in capsys.readouterr().err
    made.clear()
    assert call([*command, "--out", str(tmp_path / "out")]) == 0
    assert len(made) == 1
    tables = [
        pandas.read_csv(tmp_path / folder / "comparison.csv").drop(columns="wall_s") for folder in ("whole", "out")
    ]
    assert tables[0].equals(tables[1])
    assert [path.name for path in (tmp_path / "out").glob("*.sqlite*")] == ["runs.sqlite"]


def test_columns_do_not_rewrite_the_file_they_read(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.toml").write_text(COLUMN)
    assert call(["columns", "my.toml", "--out", "."]) == 2
    assert "my.toml is there already and was not written by stylobate" in capsys.readouterr().err
    assert (tmp_path / "my.toml").read_text() == COLUMN
    assert [path.name for path in tmp_path.iterdir()] == ["my.toml"]
    assert call(["columns", "my.toml", "my.toml", "--out", "new"]) == 2
    assert "give each a name of its own" in capsys.readouterr().err


def test_no_command_writes_over_what_is_not_its_own(records, tmp_path, capsys):
    harmonic = ["--harmonic", "1Hz,0.3g,1s"]
    grid = ["--from", "0.1g", "--to", "0.2g", "--step", "0.1g"]
    cells = ["--frequencies", "1:2:2", "--amplitudes", "0.1g:0.4g:2", "--duration", "1s"]
    response = tmp_path / "made"
    assert call(["run", "paper-monolithic", *HOUSNER, *harmonic, "--out", str(response)]) == 0
    attempts = {
        "response.nc": ["run", "paper-monolithic", *HOUSNER, *harmonic],
        "energy.svg": ["run", "paper-monolithic", *HOUSNER, *harmonic],
        "critical.csv": ["critical", "paper-monolithic", *HOUSNER, *grid, "--harmonic", "1Hz,?g,1s"],
        "runs.csv": ["critical", "paper-monolithic", *HOUSNER, *grid, "--motion", str(records)],
        "domain.nc": ["domain", "paper-monolithic", *HOUSNER, *cells],
        "probability.csv": ["domain", "paper-monolithic", *HOUSNER, *cells, "--replicates", "2"],
        "pushover.csv": ["pushover", "paper-monolithic"],
        "limit.json": ["limit", "paper-monolithic"],
        "comparison.csv": ["compare", "paper-monolithic", "--models", "housner,dem2d", *harmonic],
        "domain-housner.nc": ["compare", "paper-monolithic", "--models", "housner,dem2d", *cells],
        "suite.json": ["suite", "paper-monolithic", str(records), *HOUSNER],
        "motion.csv": ["motion", str(records / "record-0.csv")],
        "spectrum.csv": ["spectrum", str(records / "record-0.csv")],
        "response.gif": ["animate", str(response)],
        "citation.bib": ["cite"],
        "paper-12-drums.toml": ["columns"],
    }
    capsys.readouterr()
    for name, command in attempts.items():
        out = tmp_path / f"out-{name}"
        out.mkdir()
        (out / name).write_text("mine")
        assert call([*command, "--out", str(out)]) == 2, name
        assert f"{name} is there already and was not written by stylobate" in capsys.readouterr().err
        assert [(path.name, path.read_text()) for path in out.iterdir()] == [(name, "mine")]


def test_what_a_command_wrote_it_may_write_again_until_somebody_changes_it(tmp_path, capsys):
    command = ["limit", "paper-monolithic", "--out", str(tmp_path)]
    assert call(command) == call(command) == 0
    listed = [line.split("  ")[1] for line in (tmp_path / LIST).read_text().splitlines() if line]
    assert set(listed) == {"limit.json", "limit.png", "limit.svg", "asked-limit.json"}
    with (tmp_path / "limit.json").open("a") as file:
        file.write("a note of mine\n")
    capsys.readouterr()
    assert call(command) == 2
    assert "was changed after stylobate wrote it" in capsys.readouterr().err
    assert (tmp_path / "limit.json").read_text().endswith("a note of mine\n")


def test_the_result_of_another_question_is_replaced_with_a_word(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.toml").write_text(COLUMN)
    line = ["run", "my.toml", *HOUSNER, "--out", "out", "--harmonic"]
    messages = []
    for words in (
        [*line, "1Hz,0.3g,1s"],
        [*line, "1Hz,0.3g,1s", "--threads", "1", "--json"],  # the same question
        [*line, "1Hz,0.2g,1s", "--no-pictures"],
        [*line, "1Hz,0.2g,1s", "--no-pictures"],
        ["limit", "my.toml", "--out", "out"],
        ["limit", "my.toml", "--out", "out"],
    ):
        if len(messages) == 5:
            (tmp_path / "my.toml").write_text(COLUMN.replace("0.9", "0.8"))
        assert call(words) == 0
        messages.append(capsys.readouterr().err)
    replaced = "out held the result of another question"
    assert [replaced in message for message in messages] == [False, False, True, False, False, True]
    assert "1Hz,0.3g,1s" in messages[2]
    assert "out holds the result of run too" in messages[4]
    # folders are no matter of a signed report
    assert not CommandRequest.read(tmp_path / "out" / "asked-limit.json").warnings
    assert not (tmp_path / "out" / "energy.png").exists()  # of the first question: the third has no pictures
    assert (tmp_path / "out" / "limit.png").exists()
