"""Commands that keep what is finished, killed at random times: what they go on with is what one without a kill ends with.

A try kills one command once to three times, then lets it end. At most a second of finished runs may be lost at each kill,
the tables must be those of the command that nobody killed, and other people's files in the folder as they were. How long
signals took to end the command is told as a distribution. No run that was kept is made again.
"""

from __future__ import annotations

import json
import math
import os
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path

from stylobate.campaign.ledger import RUNS_FILE

from .target import Fault, Target, Tried

#: The command line, and a note of each run that it has finished, before it is kept.
SCRIPT = """
import os, sys, time
from stylobate.cli import signals
signals.listen()
import stylobate.campaign.ledger as ledger
notes, record = os.open(sys.argv.pop(1), os.O_WRONLY | os.O_APPEND | os.O_CREAT), ledger.Ledger.record
def noted(self, number, row):
    os.write(notes, f"{time.time()} {number} {os.path.abspath(self.path)}\\n".encode())
    record(self, number, row)
ledger.Ledger.record = noted
if "reproduce" in sys.argv:
    import tiny_study
    tiny_study.play()
from stylobate.cli.start import main
os.utime(notes)
main()
"""

GRID = ["--frequencies", "0.5:2:2", "--amplitudes", "0.1g:0.5g:12", "--duration", "6s"]
LEVELS = ["--from", "0.1g", "--to", "0.6g", "--step", "0.02g"]
DEM = ["--model", "dem2d"]
COMMANDS = {
    "domain": ["domain", "paper-12-drums", *DEM, *GRID],
    "domain, half step": ["domain", "paper-monolithic", *DEM, *GRID, "--half-step"],
    "probability": ["domain", "paper-monolithic", *DEM, *GRID, "--replicates", "3"],
    "critical": ["critical", "paper-12-drums", *DEM, *LEVELS, "--harmonic", "1Hz,?g,6s"],
    "critical, records": ["critical", "paper-monolithic", *DEM, *LEVELS, "--motion", "RECORDS"],
    "suite": ["suite", "paper-12-drums", "RECORDS", "--also", "paper-monolithic", *DEM],
    "ida": ["ida", "paper-monolithic", "RECORDS", *DEM, "--im", "pga", "--runs", "6"],
    "run, records": ["run", "paper-monolithic", *DEM, "--motion", "RECORDS"],
    "reproduce": ["reproduce", "--quick"],
    "compare": ["compare", "paper-monolithic", "--models", "dem2d,rigid-block", *GRID],
}

#: Somebody else's, in the folder of the results.
FOREIGN = (".env-local.sh", ".domain-ab_3.nc", ".pre-commit-config.yaml", "notes.txt", "progress.txt")

#: Longest answer to a signal [s]: a second, and what a machine that does other things as well may add.
ANSWER = 4.0

_whole: dict[str, tuple[float, dict[str, str]]] = {}


def attempt(rng: random.Random, folder: Path) -> Tried:
    """Kill one command, let it end, and compare."""
    name = rng.choice(list(COMMANDS))
    if name not in _whole:
        with tempfile.TemporaryDirectory() as other:
            started = time.monotonic()
            end(start(COMMANDS[name], Path(other)))
            _whole[name] = time.monotonic() - started, tables(Path(other) / "out")
    length, whole = _whole[name]
    out = folder / "out"
    out.mkdir()
    others = () if name == "reproduce" else FOREIGN  # it takes a folder of its own only
    for foreign in others:
        (out / foreign).write_text(f"of somebody else: {foreign}")
    signals, took = [], []
    for _ in range(rng.randrange(1, 4)):
        process = start(COMMANDS[name], folder)
        time.sleep(rng.uniform(0.2, 1.1) * length)
        number = rng.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
        signals.append(number.name)
        sent = time.time()
        took += kill(process, number, name)
        lost(folder / "notes", sent)
    end(start(COMMANDS[name], folder))
    for foreign in others:
        if (out / foreign).read_text() != f"of somebody else: {foreign}":
            raise Fault(f"{name}: {foreign} is not as it was")
    if tables(out) != whole:
        raise Fault(f"{name}: after {signals} another table")
    made = [line.split(" ", 2)[1] for line in (folder / "notes").read_text().splitlines()]
    if len(set(made)) < len(made):
        raise Fault(f"{name}: {len(made) - len(set(made))} runs that were kept were made again after {signals}")
    leftovers = [path.name for path in out.rglob("*.sqlite*") if path.name != RUNS_FILE]
    leftovers += [path.name for path in out.rglob(".*") if path.name not in (*FOREIGN, ".stylobate-files")]
    if leftovers:
        raise Fault(f"{name}: {leftovers} were left over after {signals}")
    return Tried(f"{len(signals)} kills", numbers={"answers to a signal [s]": took})


def kill(process: subprocess.Popen, number: signal.Signals, name: str) -> list[float]:
    """Send a signal to a command, whose answer must be quick and one sentence; how long it took [s], of an interrupt."""
    sent_at = time.monotonic()
    process.send_signal(number)
    _, output = process.communicate(timeout=60)
    took = time.monotonic() - sent_at
    if number != signal.SIGKILL and took > ANSWER:
        raise Fault(f"{name}: {number.name} was answered after {took:.1f} s")
    if process.returncode not in (0, 130, -number) or "Traceback" in output:
        raise Fault(f"{name}: {number.name} ended with {process.returncode}: {output}")
    sentences = [
        line for line in output.splitlines() if not line.endswith(" ...")
    ]  # which piece of a study is computed
    if process.returncode == 130 and len(sentences) != 1:
        raise Fault(f"{name}: not one sentence: {output}")
    return [took] if process.returncode == 130 else []


def start(line: list[str], folder: Path) -> subprocess.Popen:
    """A command as a process; its results go to ``out``."""
    records = folder / "records"
    if not records.is_dir():
        records.mkdir()
        for k in range(4):
            times = [0.01 * i for i in range(500)]
            lines = [f"{t:.2f},{(2.0 + k) * math.sin(2 * math.pi * (1 + 0.3 * k) * t):.6f}" for t in times]
            (records / f"record-{k}.csv").write_text("\n".join(["time_s,ax_m_s2", *lines, ""]))
    arguments = [str(records) if argument == "RECORDS" else argument for argument in line]
    search_path = os.pathsep.join(filter(None, [str(Path(__file__).parents[1]), os.getenv("PYTHONPATH")]))
    command = [sys.executable, "-c", SCRIPT, str(folder / "notes"), *arguments, "--out", str(folder / "out"), "--json"]
    return subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, preexec_fn=_hear_everything,
        env=os.environ | {"PYTHONPATH": search_path},
    )  # fmt: skip


def _hear_everything() -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def end(process: subprocess.Popen) -> None:
    """Wait for a command that nobody kills."""
    _, output = process.communicate(timeout=600)
    if process.returncode != 0:
        raise Fault(f"ended with {process.returncode}: {output}")


def lost(notes: Path, killed: float) -> int:
    """Runs that were finished and are not in their ledger; those of the last second may be. They are noted no more."""
    missing, kept_lines = 0, []
    ledgers: dict[str, set[int]] = {}
    for line in notes.read_text().splitlines(keepends=True) if notes.exists() else ():
        when, number, ledger = line.rstrip("\n").split(" ", 2)
        if not Path(ledger).exists():
            raise Fault(f"{ledger} is gone")
        if ledger not in ledgers:
            with closing(sqlite3.connect(ledger)) as file:
                ledgers[ledger] = {number for (number,) in file.execute("SELECT number FROM runs")}
        if int(number) in ledgers[ledger]:
            kept_lines.append(line)
        elif killed - float(when) > 1.0:
            raise Fault(f"a run that was finished {killed - float(when):.1f} s before the kill is lost")
        else:
            missing += 1
    notes.write_text("".join(kept_lines))
    return missing


def tables(out: Path) -> dict[str, str]:
    """What the results say, without what the clock says."""
    texts = {str(path.relative_to(out)): path.read_text() for path in sorted(out.rglob("*.csv")) if path.is_file()}
    for path in sorted(out.rglob("run.json")):
        run = {key: value for key, value in json.loads(path.read_text()).items() if key not in ("wall_s", "files")}
        texts[str(path.relative_to(out))] = json.dumps(run)
    if not texts:
        raise Fault(f"no table in {sorted(os.listdir(out))}")
    return texts


TARGET = Target("kills", 50, 2, attempt, limit=1800.0)  # a hang is seen by the time that a signal or an end is given
