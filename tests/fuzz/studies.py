"""A study of two thousand runs, killed at random times with its Dask workers: in the end its table is that of no kill.

A try kills twice, the program or one of its workers (the program goes on with others), then lets the study end. At most a
second of finished runs may be lost at each kill, nothing that is in the ledger is run again, the table must be the same to
the bit, and no worker left over.
"""

from __future__ import annotations

import math
import os
import random
import signal
import sqlite3
import subprocess
import tempfile
import time
from contextlib import closing, suppress
from pathlib import Path

from stylobate.campaign.ledger import RUNS_FILE, finished_runs_in
from stylobate.probability.studies import StudyResult

from .kills import end, kill, lost, start
from .target import Fault, Target, Tried

CASES = 2000
STUDY = """
column = "column.toml"
model = "dem2d"
[motions]
files = ["wave.csv"]
[scale]
im = "pga"
levels = "0.05g:1.5g:100"
[scatter]
realisations = 20
friction = 0.1
width = 0.01
"""
COLUMN = """name = "one"
section = "circular"
density = 2600.0
[tapered]
height = 2.4
bottom_width = 0.5
top_width = 0.4
drums = 1
[joint]
normal_stiffness = 2.0e8
shear_stiffness = 1.0e8
friction_coefficient = 0.7
"""

#: Time in which workers end that have lost their program [s].
LAST = 20.0

_whole: list = []


def attempt(rng: random.Random, folder: Path) -> Tried:
    """Kill a study twice, let it end, and compare."""
    if not _whole:
        with tempfile.TemporaryDirectory() as other:
            end(start(line(Path(other), []), Path(other)))
            _whole.append(StudyResult.in_folder(Path(other) / "out").table)
    [whole] = _whole
    options = rng.choice([[], ["--dask", "local"]])
    what, took, gone, at = [], [], [], []
    process = None
    for _ in range(2):
        if process is None:
            began = time.time()
            process = start(line(folder, options), folder)
            while process.poll() is None and not listens(folder / "notes", began):
                time.sleep(0.01)
        wait(process, folder, rng)
        at.append(finished_runs_in(folder / "out" / RUNS_FILE))
        workers = of_cluster(process.pid) if options else []
        if workers and process.poll() is None and rng.random() < 0.5:  # the program goes on with another one
            with suppress(ProcessLookupError):
                os.kill(rng.choice(workers), signal.SIGKILL)
            what.append("worker")
            continue
        number = rng.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
        what.append(number.name)
        sent = time.time()
        took += kill(process, number, "study")
        gone.append(float(lost(folder / "notes", sent)))
        ended(workers)
        process = None
    end(process or start(line(folder, options), folder))
    out = folder / "out"
    runs = made(folder)
    if len(runs) != CASES or set(runs) != kept(folder):
        raise Fault(f"{len(runs)} runs were made, {len(kept(folder))} are in the ledger, after {what}")
    if not StudyResult.in_folder(out).table.equals(whole):
        raise Fault(f"another table after {what}")
    if leftovers := [path.name for path in out.glob(".*") if path.name != ".stylobate-files"]:
        raise Fault(f"{leftovers} were left over after {what}")
    numbers: dict[str, list[float]] = {"answers to a signal [s]": took, "lost runs": gone}
    numbers["runs at a kill on the way"] = [float(count) for count in at if 0 < count < CASES]
    for kind in what:
        numbers.setdefault(f"kills by {kind}" if kind != "worker" else "kills of a worker", []).append(1.0)
    return Tried(f"2 kills {'of a cluster' if options else 'of threads'}", numbers=numbers)


def listens(notes: Path, since: float) -> bool:
    """Whether the program listens to signals: a Python that has just begun does not."""
    return notes.exists() and notes.stat().st_mtime > since


def wait(process: subprocess.Popen, folder: Path, rng: random.Random) -> None:
    """Wait for a random moment: in the first seconds of a program, at some number of runs, or while it writes the table."""
    share, before = rng.uniform(-0.15, 1.15), len(kept(folder))
    if share < 0.0:
        time.sleep(rng.uniform(0.0, 3.0))
        return
    while process.poll() is None and finished_runs_in(folder / "out" / RUNS_FILE) < before + share * (CASES - before):
        if share > 1.0 and finished_runs_in(folder / "out" / RUNS_FILE) == CASES:
            time.sleep(rng.uniform(0.0, 1.0))
            return
        time.sleep(0.01)


def made(folder: Path) -> list[int]:
    """Numbers of the runs that were made, as often as they were made and not lost."""
    notes = folder / "notes"
    return [int(line.split(" ", 2)[1]) for line in notes.read_text().splitlines()] if notes.exists() else []


def kept(folder: Path) -> set[int]:
    """Numbers of the runs that the ledger holds."""
    place = folder / "out" / RUNS_FILE
    if not place.exists():
        return set()
    with closing(sqlite3.connect(place)) as file:
        return {number for (number,) in file.execute("SELECT number FROM runs")}


def line(folder: Path, options: list[str]) -> list[str]:
    """The command, and the files that it reads."""
    if not (folder / "study.toml").exists():
        steps = [f"{0.01 * i:.2f},{0.4 * math.sin(0.02 * math.pi * i):.6f}" for i in range(1001)]
        files = {"study.toml": STUDY, "column.toml": COLUMN, "wave.csv": "\n".join(["time_s,ax_g", *steps])}
        for name, text in files.items():
            (folder / name).write_text(text)
    return ["study", "run", str(folder / "study.toml"), "--threads", "2" if options else "1", *options]


def of_cluster(program: int) -> list[int]:
    """Processes of the workers that a program has started."""
    table = subprocess.run(["ps", "-eo", "pid=,ppid=,args="], capture_output=True, text=True, check=True).stdout
    rows = [line.split(None, 2) for line in table.splitlines()]
    clusters = {pid for pid, parent, args in rows if int(parent) == program and "local_workers" in args}
    return [int(pid) for pid, parent, args in rows if parent in clusters and "spawn_main" in args]


def ended(workers: list[int]) -> None:
    """See that processes end."""
    deadline = time.monotonic() + LAST
    while survivors := [pid for pid in workers if Path(f"/proc/{pid}").exists()]:
        if time.monotonic() > deadline:
            raise Fault(f"workers {survivors} live on without their program")
        time.sleep(0.05)


TARGET = Target("studies", 50, 1, attempt, limit=600.0)
