"""The ledger of a folder: written in time, held by one process, and damaged in every way."""

import hashlib
import sqlite3
import subprocess
import sys
import time
from contextlib import closing

import numpy as np
import pytest

import stylobate as st
from stylobate.campaign import ledger as module
from stylobate.campaign.ledger import Ledger, finished_runs_in, read_line, rows_in, write_line
from stylobate.errors import StylobateError

ROW = {"outcome": "rocked", "peak_top_displacement_m": 0.12345678901234567, "collapse_time_s": None}


def filled(path, runs=100):
    with closing(Ledger(path)) as book:
        for number in range(runs):
            book.record(number, ROW | {"n": number, "note": "x" * 400})


def rows(path):
    with closing(Ledger(path)):
        return dict(rows_in(path, lambda number: True))


def test_a_run_is_on_disk_within_a_second_though_no_other_follows(tmp_path):
    path = tmp_path / "runs.sqlite"
    with closing(Ledger(path)) as book:
        book.record(7, ROW)
        deadline = time.monotonic() + 60.0
        started = time.monotonic()
        while finished_runs_in(path) == 0 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert finished_runs_in(path) == 1
        assert module.COMMIT_INTERVAL <= 0.5, time.monotonic() - started


def test_a_large_batch_is_written_before_its_time(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "COMMIT_INTERVAL", 1e6)
    monkeypatch.setattr(module, "BATCH", 10)
    path = tmp_path / "runs.sqlite"
    with closing(Ledger(path)) as book:
        for number in range(10):
            book.record(number, ROW)
        deadline = time.monotonic() + 60.0
        while finished_runs_in(path) < 10 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert finished_runs_in(path) == 10


def test_the_file_is_open_to_readers_while_runs_come_in(tmp_path):
    path = tmp_path / "runs.sqlite"
    with closing(Ledger(path)) as book:
        for number in range(50):
            book.record(number, ROW)
            with closing(sqlite3.connect(path, timeout=5.0)) as reader:
                reader.execute("SELECT count(*) FROM runs").fetchone()
                assert reader.execute("PRAGMA journal_mode").fetchone() == ("wal",)


def test_rows_come_back_to_the_bit(tmp_path):
    path = tmp_path / "runs.sqlite"
    filled(path, 3)
    assert rows(path) == {n: ROW | {"n": n, "note": "x" * 400} for n in range(3)}
    assert sorted(file.name for file in tmp_path.iterdir()) == ["runs.sqlite"]


def test_a_second_process_is_refused_in_one_sentence(tmp_path):
    path = tmp_path / "runs.sqlite"
    script = (
        "from stylobate.campaign.ledger import Ledger\n"
        f"try:\n    Ledger({str(path)!r})\n"
        "except Exception as error:\n    print(type(error).__name__, error)\n"
    )
    with closing(Ledger(path)):
        with pytest.raises(st.InputError, match="another process is at work on it; wait for its end"):
            Ledger(path)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        assert done.stdout.startswith("InputError ")
        assert done.stdout.count("\n") == 1
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == ""


@pytest.mark.parametrize("name", ["runs.sqlite", "progress.sqlite", "progress-half-step.sqlite"])
def test_a_ledger_of_an_earlier_version_is_refused_in_one_sentence_and_stays_as_it_was(tmp_path, monkeypatch, name):
    """What it says of itself is that of one command; its runs have their places there as numbers."""
    old = '{"column": "a digest", "frequencies": [1.0]}'
    monkeypatch.setattr(module, "KEY", old)
    monkeypatch.setattr(module, "SEAL", hashlib.sha256(old.encode()).hexdigest())
    filled(tmp_path / name)
    monkeypatch.undo()
    before = (tmp_path / name).read_bytes()
    with pytest.raises(
        st.InputError, match=f"{name} keeps unfinished runs of an earlier version.*choose another folder"
    ):
        Ledger(tmp_path / "runs.sqlite")
    assert {path.name for path in tmp_path.iterdir()} == {name}
    assert (tmp_path / name).read_bytes() == before


def test_what_else_is_called_like_one_of_an_earlier_version_is_left_alone(tmp_path):
    (tmp_path / "progress.sqlite").write_bytes(b"mine")
    filled(tmp_path / "runs.sqlite", 1)
    assert rows(tmp_path / "runs.sqlite") == {0: ROW | {"n": 0, "note": "x" * 400}}
    assert (tmp_path / "progress.sqlite").read_bytes() == b"mine"


@pytest.mark.parametrize("key", [None, 1234])
def test_the_database_of_another_program_is_refused_and_left_as_it_was(tmp_path, key):
    path = tmp_path / "runs.sqlite"
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("CREATE TABLE runs (uuid TEXT)")  # as others call theirs
        file.execute(f"PRAGMA application_id = {key or 0}")
        file.execute("PRAGMA journal_mode = WAL")
    before = path.read_bytes()
    with pytest.raises(st.InputError, match=r"is a database of another program.*choose another folder"):
        Ledger(path)
    assert [file.name for file in tmp_path.iterdir()] == ["runs.sqlite"]
    assert path.read_bytes() == before


@pytest.mark.parametrize("there", [True, False])
def test_a_link_is_refused_and_left_as_it_was(tmp_path, there):
    (tmp_path / "out").mkdir()
    if there:
        filled(tmp_path / "mine.sqlite", 3)
    (tmp_path / "out" / "runs.sqlite").symlink_to(tmp_path / "mine.sqlite")
    with pytest.raises(st.InputError, match=r"runs\.sqlite is a link.*choose another folder"):
        Ledger(tmp_path / "out" / "runs.sqlite")
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["runs.sqlite"]
    assert (tmp_path / "mine.sqlite").exists() == there


def refused(path, why):
    """A damaged ledger is refused in one sentence, and left as it was."""
    before = path.read_bytes()
    with pytest.raises(st.InputError, match=why) as error:
        Ledger(path)
    assert "it stays as it is: move it away" in str(error.value)
    assert path.read_bytes() == before


def test_a_ledger_whose_mark_was_damaged_is_refused(tmp_path):
    path = tmp_path / "runs.sqlite"
    filled(path, 5)
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("PRAGMA application_id = 7")
    refused(path, "not written by this version")


def test_only_runs_that_are_wanted_are_counted(tmp_path):
    path = tmp_path / "runs.sqlite"
    assert finished_runs_in(path, np.array([1])) == 0
    filled(path, 5)
    assert finished_runs_in(path) == 5
    assert finished_runs_in(path, np.array([3, 99, 3, 4])) == 3  # a case that is there twice counts twice


def test_a_full_disk_is_one_sentence_and_what_was_written_stays(tmp_path):
    path = tmp_path / "runs.sqlite"
    filled(path, 20)
    book = Ledger(path)
    pages = book._file.execute("PRAGMA page_count").fetchone()[0]
    book._file.execute(f"PRAGMA max_page_count = {pages}")  # SQLite's own answer to a disk without room
    for number in range(20, 500):
        book.record(number, ROW | {"note": "x" * 400})
    book.flush()
    with pytest.raises(StylobateError, match="database or disk is full") as error:
        book.record(500, ROW)
    with pytest.raises(StylobateError, match="20 finished runs are kept"):
        book.close()
    assert not isinstance(error.value, st.InputError)
    assert "delete" not in str(error.value)
    assert str(error.value).count("\n") == 0
    assert list(rows(path)) == list(range(20))


def test_a_line_proves_its_number_and_its_row():
    line = write_line(12, ROW)
    assert read_line(12, line) == ROW
    assert read_line(13, line) is None
    assert read_line(13, line.replace(" 12 ", " 13 ")) is None
    assert read_line(12, line.replace("rocked", "collapsed")) is None
    assert read_line(12, None) is read_line(12, b"") is read_line(12, "") is None


@pytest.mark.parametrize(
    "change", ["line = replace(line, 'rocked', 'collapsed')", "line = CAST(line AS BLOB)", "number = 77"]
)
def test_a_row_that_was_changed_is_left_out(tmp_path, change):
    path = tmp_path / "runs.sqlite"
    filled(path, 5)
    with closing(sqlite3.connect(path)) as file, file:
        file.execute(f"UPDATE runs SET {change} WHERE number = 3")
    assert list(rows(path)) == [0, 1, 2, 4]


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.99])
def test_a_ledger_that_was_cut_is_refused(tmp_path, share):
    path = tmp_path / "runs.sqlite"
    filled(path, 400)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    refused(path, "is damaged, or no such file")
