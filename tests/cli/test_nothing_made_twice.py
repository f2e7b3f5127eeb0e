"""One ledger a folder: a run that any command has made there is not made again by another, nor by the same one."""

import hashlib
import json
import math
import sqlite3
from contextlib import closing

import pytest

import stylobate as st
from stylobate.campaign.ledger import APPLICATION, LAYOUT, RUNS_FILE, finished_runs_in
from stylobate.cli.main import call
from stylobate.models.rocking.model import HousnerBlock, Rocking
from stylobate.verdicts.compare import compare_models

MODEL = ["--model", "housner"]
GRID = ["--frequencies", "1:2:2", "--amplitudes", "0.25g:1g:4", "--duration", "2s"]
STUDY = """
column = "paper-monolithic"
model = "housner"
"""
HARMONICS = f'{STUDY}frequencies = "1:2:2"\namplitudes = "0.25g:1g:4"\nduration = 2.0\n'
RECORDS = f'{STUDY}[motions]\nfiles = ["records/*.csv"]\n'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "records").mkdir()
    for k in range(3):
        lines = [f"{0.01 * i:.2f},{(2 + 2 * k) * math.sin(0.06 * i):.6f}" for i in range(200)]
        (tmp_path / "records" / f"record-{k}.csv").write_text("\n".join(["time_s,ax_m_s2", *lines, ""]))
    (tmp_path / "harmonics.toml").write_text(HARMONICS)
    (tmp_path / "records.toml").write_text(RECORDS)
    return tmp_path


@pytest.fixture
def made(monkeypatch):
    """Counts the runs that are made, in batches and one by one."""
    runs = []
    many, single = Rocking.run_many, Rocking.run

    def run_many(self, cases, options, threads):
        for result in many(self, cases, options, 1):
            runs.append(result[0])
            yield result

    def run(self, *arguments):
        runs.append(0)
        return single(self, *arguments)

    monkeypatch.setattr(Rocking, "run_many", run_many)
    monkeypatch.setattr(Rocking, "run", run)
    return runs


def commands():
    column = ["paper-monolithic", *MODEL]
    critical = ["--from", "0.25g", "--to", "1g", "--step", "0.25g", "--harmonic", "1Hz,?g,2s"]
    states = ["states", "--as-built", "paper-monolithic", "--with", "paper-monolithic", *MODEL]
    return {
        "domain": (["domain", *column, *GRID], 8),
        "domain of a file": (["domain", "harmonics.toml"], 8),
        "study of harmonics": (["study", "run", "harmonics.toml"], 8),
        "compare": (["compare", "paper-monolithic", "--models", "housner,housner:restitution=0.9", *GRID], 16),
        "critical": (["critical", *column, *critical], 4),
        "suite": (["suite", "paper-monolithic", "records", *MODEL], 3),
        "study of records": (["study", "run", "records.toml"], 3),
        "states": ([*states, "--motion", "records"], 3),
        "run": (["run", *column, "--motion", "records", "--no-pictures"], 3),
        "twins of a run": (["run", *column, "--harmonic", "1Hz,0.5g,2s", "--replicates", "6", "--no-pictures"], 7),
        "ida": (["ida", "paper-monolithic", "records", *MODEL, "--im", "pga", "--levels", "0.2g:0.4g:2"], 6),
    }


@pytest.mark.parametrize(
    ("first", "second", "again"),
    [
        ("domain", "domain", 0),
        ("domain", "domain of a file", 0),
        ("domain", "study of harmonics", 0),
        ("domain", "compare", 8),  # those of the other restitution
        ("critical", "domain", 4),  # those at the other frequency
        ("domain", "critical", 0),
        ("suite", "study of records", 0),
        ("suite", "states", 0),  # a column decides the same under another name
        ("states", "suite", 0),
        ("ida", "ida", 0),
        ("run", "run", 0),
        ("twins of a run", "twins of a run", 0),  # the run itself with its histories, too
    ],
)
def test_what_one_command_has_made_the_next_one_reads(first, second, again, folder, made, capsys):
    def answer(name, out):
        made.clear()
        assert call([*commands()[name][0], "--out", out, "--json"]) == 0, capsys.readouterr().err
        return json.loads(capsys.readouterr().out), len(made)

    alone, runs = answer(second, "alone")
    histories = len(list(folder.glob("alone/histories/*.nc")))
    assert runs == commands()[second][1] + histories
    assert answer(first, "shared")[1] >= commands()[first][1]
    result, runs = answer(second, "shared")
    assert runs == again + (0 if first == second else histories)
    for table in (path for path in folder.glob("alone/*.csv") if path.is_file()):
        assert (folder / "shared" / table.name).read_text() == table.read_text(), table.name
    drop = {"wall_s", "files", "computed"}
    if first != "run":
        assert {key for key in alone if alone[key] != result[key]} <= drop | {"domains"}
    assert finished_runs_in(folder / "shared" / RUNS_FILE) > 0


def test_a_run_whose_files_were_lost_is_made_again(folder, made, capsys):
    command = ["run", "paper-monolithic", *MODEL, "--motion", "records", "--no-pictures", "--out", "out"]
    assert call(command) == 0
    made.clear()
    (folder / "out" / "record-1.csv" / "response.nc").unlink()
    assert call(command) == 0
    assert len(made) == 1
    assert (folder / "out" / "record-1.csv" / "response.nc").is_file()
    made.clear()
    assert call([*command, "--tail", "1s"]) == 0  # writes over all files
    assert len(made) == 3
    made.clear()
    capsys.readouterr()
    assert call([*command, "--json"]) == 0  # the files are no longer those of this command
    assert len(made) == 3


@pytest.mark.parametrize(
    "command", ["domain", "critical", "suite", "ida", "run", "states", "study of records", "compare"]
)
def test_a_folder_with_unfinished_runs_of_an_earlier_version_is_refused(command, folder, made, capsys):
    (folder / "out").mkdir()
    place, key = folder / "out" / "progress.sqlite", json.dumps({"column": "a digest", "frequencies": [1.0, 2.0]})
    with closing(sqlite3.connect(place)) as file, file:
        file.execute(f"PRAGMA application_id = {APPLICATION}")
        file.execute(f"PRAGMA user_version = {LAYOUT}")
        file.execute("CREATE TABLE campaign (key TEXT, sum TEXT)")
        file.execute("CREATE TABLE runs (number INTEGER PRIMARY KEY, line TEXT)")
        file.execute("INSERT INTO campaign VALUES (?, ?)", (key, hashlib.sha256(key.encode()).hexdigest()))
    before = place.read_bytes()
    assert call([*commands()[command][0], "--out", "out"]) == 2
    text = capsys.readouterr().err
    sentences = [line for line in text.splitlines() if "warning" not in line]
    assert len(sentences) == 1, text
    assert "progress.sqlite keeps unfinished runs of an earlier version" in sentences[0]
    assert "choose another folder" in sentences[0]
    assert made == []
    assert [path.name for path in (folder / "out").iterdir()] == ["progress.sqlite"]
    assert place.read_bytes() == before


REFUSED = [
    ([*commands()[name][0]], "drums")
    for name in (
        "domain",
        "study of harmonics",
        "compare",
        "critical",
        "suite",
        "study of records",
        "states",
        "run",
        "ida",
    )
] + [
    (["domain", "paper-monolithic", *MODEL, *GRID, "--replicates", "3"], "drums"),
    (["compare", "paper-monolithic", "--models", "housner,dem2d", "--harmonic", "1Hz,0.3g,2s"], "drums"),
    (["critical", "paper-monolithic", *MODEL, "--from", "0.1g", "--to", "1g", "--motion", "records"], "drums"),
    (["domain", "paper-monolithic", *MODEL, *GRID, "--half-step"], "time_step"),
    (["run", "paper-monolithic", *MODEL, "--motion", "records", "--until-rest"], "--until-rest"),
    (["run", "paper-monolithic", *MODEL, "--motion", "records", "--output-interval", "0s"], "--output-interval"),
]


@pytest.mark.parametrize(("command", "why"), REFUSED)
def test_what_is_refused_leaves_no_folder(command, why, folder, made, capsys):
    if why == "drums":  # which this model does not compute
        command = [argument.replace("paper-monolithic", "paper-12-drums") for argument in command]
        for path in folder.glob("*.toml"):
            path.write_text(path.read_text().replace("paper-monolithic", "paper-12-drums"))
    assert call([*command, "--out", "out"]) == 2
    assert why in capsys.readouterr().err
    assert made == []
    assert not (folder / "out").exists()


def test_what_is_to_be_said_is_said_of_runs_that_the_ledger_holds_and_of_doubles(tmp_path):
    along = st.harmonic(1.0, 2.0, 1.0)
    first, second = (along.replace(name=name, ay=0.3 * along.samples) for name in ("first", "second"))
    for motions in ([first], [first, second, along.scaled(1.5)]):
        with pytest.warns(st.errors.LeftOutWarning) as warnings:
            st.suite_table(st.preset("paper-monolithic"), motions, HousnerBlock(), ledger=tmp_path / RUNS_FILE)
        for motion in motions[:2]:
            assert any(motion.name in str(warning.message) for warning in warnings)


def test_the_same_model_twice_is_compared_and_run_once(folder, made):
    column, motion, models = st.preset("paper-monolithic"), st.harmonic(1.0, 2.0, 1.0), [HousnerBlock()] * 2
    comparison = compare_models(column, motion, models)
    assert comparison.table["peak_top_displacement_m"].nunique() == len(made) == 1
    files = [folder / "a.nc", folder / "b.nc"]
    for runs in (2, 2):
        again = compare_models(column, motion, models, labels=["a", "b"], ledger=folder / RUNS_FILE, files=files)
        assert again.table["peak_top_displacement_m"].nunique() == 1
        assert len(made) == runs
        assert all(path.is_file() for path in files)
