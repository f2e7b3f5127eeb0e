"""What a graphics card makes of many histories: the figures of ``docs/how_to/scale.md``, part after part, the most
important first.

Usage: ``make bench-gpu ARGS="--out figures --seconds 900"`` on a machine with a card and nothing else computing on it. Every
figure is written as soon as it is measured, into a file of its part, so that a stop loses nothing; names of parts make these
alone.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib.metadata
import json
import multiprocessing
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np

import stylobate as st
from stylobate.atomic import replacing
from stylobate.column import Column, preset
from stylobate.column.files import write_column
from stylobate.kernels.run_codes import CHUNK, RUNNING
from stylobate.kernels.sources import source_digest
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for
from stylobate.motion.motion import write_csv
from stylobate.simulate import thread_count
from stylobate_gpu import card as records
from stylobate_gpu import card_check, driver, kinds
from stylobate_gpu import lanes as lanes
from stylobate_gpu.device import kernel_for

ROOT = Path(__file__).parents[1]

#: Parts, the most important first, and the longest that each may take [s].
PARTS = {
    "machine": 30.0, "kinds": 150.0, "plane": 80.0, "space": 80.0, "kernels": 60.0, "cores": 60.0, "tests": 150.0,
    "processes": 60.0, "million": 900.0,
}  # fmt: skip

#: Runs end to end, in the plane and in space; runs by the processor's threads alone, for each thread.
RUNS = {"plane": (65_536, 131_072), "space": (24_576,)}
BY_CORES = {"plane": 256, "space": 48}

#: Processes that share a card.
PROCESSES = 6

#: Measures one part, and writes what it has found so far.
Keep = Callable[[dict[str, Any]], None]


def twelve_drums(where: str) -> tuple[Column, Any]:
    """The paper's column of twelve drums, round in space, and the model that steps it."""
    column = preset("paper-12-drums")
    if where == "plane":
        return column, st.DistinctElement2D()
    return column.replace(
        drums=tuple(dataclasses.replace(drum, section="circular") for drum in column.drums)
    ), st.DistinctElement3D()


def shakings(number: int, seconds: float = 10.0) -> list[st.Motion]:
    """Harmonic motions, from columns that stay shut to columns that fall, in random order."""
    units = [st.harmonic(f, 1.0, seconds) for f in np.linspace(0.33, 4.0, 64)]
    order = np.random.default_rng(1).permutation(number).tolist()
    return [units[k % 64].scaled((0.05 + 0.55 * k / number) * st.g) for k in order]


def measure_machine() -> dict[str, Any]:
    """What the figures were measured on, and by what."""
    command = ["nvidia-smi", "--query-gpu=name,driver_version,memory.total,clocks.max.sm", "--format=csv,noheader"]
    output = (
        subprocess.run(command, capture_output=True, text=True, check=False).stdout if shutil.which(command[0]) else ""
    )
    names = ("numpy", "numba", "llvmlite", "scipy", "pandas", "cuda-bindings")
    versions = {}
    for name in names:
        with suppress(importlib.metadata.PackageNotFoundError):
            versions[name] = importlib.metadata.version(name)
    first = next(iter(kinds.kinds()))
    generator = re.search(r"NVVM [^\n]*|release [^,\n]*", kinds.text_of(first))
    return {
        "date": time.strftime("%Y-%m-%d"), "card": driver.the_card().name, "driver": output.strip(), "cpu": _processor(),
        "threads": thread_count(None), "python": platform.python_version(), "sources": source_digest(),
        "kernels": generator.group() if generator else "", **versions,
    }  # fmt: skip


def _processor() -> str:
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()


def measure_kinds(keep: Keep) -> None:
    """Every kernel beside the processor in the short runs by which it is checked, all at the same time."""
    with _processes(len(kinds.kinds())) as pool:
        waiting = [pool.submit(_check, name) for name in kinds.kinds()]
        for future in as_completed(waiting):
            keep(future.result())


def _check(name: str) -> dict[str, Any]:
    """What came of a kernel, and the time of compiling it for this machine and of its runs [s]."""
    started = time.perf_counter()
    try:
        card_check.check(
            driver.the_card(), name, st.DistinctElement2D if name.startswith("plane") else st.DistinctElement3D
        )
        verdict = "as the processor"
    except st.StylobateError as error:
        verdict = str(error)
    return {name: {"computes": verdict, "s": time.perf_counter() - started}}


def measure_end_to_end(where: str, turns: list[int], keep: Keep) -> None:
    """Runs a second through ``simulate_many``, from motions to a table, and where the time goes."""
    column, model = twelve_drums(where)
    st.simulate_many(column, shakings(256), model, device="gpu")
    for runs in turns:
        motions = shakings(runs)
        with _watched() as spent:
            started, own, whole = time.perf_counter(), time.thread_time(), time.process_time()
            table = st.simulate_many(column, motions, model, device="gpu")
            wall = time.perf_counter() - started
        keep(
            {
                f"{runs} runs": {
                    "runs_per_s": runs / wall,
                    "wall_s": wall,
                    "collecting_thread_s": time.thread_time() - own,
                    "processor_s": time.process_time() - whole,
                    **spent,
                    "outcomes": table["outcome"].value_counts().to_dict(),
                    "by": sorted(set(table["computed_by"])),
                }
            }
        )


@contextmanager
def _watched() -> Iterator[dict[str, float]]:
    """Times of beginning and ending runs and of launches, by the clock and of the processor, of all threads together [s]."""
    spent: dict[str, float] = {}
    kept = []

    def watch(owner: type, name: str, key: str) -> None:
        own = getattr(owner, name)
        kept.append((owner, name, own))

        def watched(*arguments: Any) -> Any:
            clock, processor = time.perf_counter(), time.thread_time()
            try:
                return own(*arguments)
            finally:
                for unit, now, before in (
                    ("s", time.perf_counter(), clock),
                    ("processor_s", time.thread_time(), processor),
                ):
                    spent[f"{key}_{unit}"] = spent.get(f"{key}_{unit}", 0.0) + now - before

        setattr(owner, name, watched)

    watch(lanes.CardLanes, "_begin", "begin")
    watch(lanes.CardLanes, "_end", "end")
    watch(records.CardRecords, "advance", "advance")
    watch(type(driver.the_card()), "launch", "launch")
    try:
        yield spent
    finally:
        for owner, name, own in kept:
            setattr(owner, name, own)


def measure_kernels(keep: Keep) -> None:
    """Runs a second of the kernels alone: steps of lanes in launches as long as nine tenths of the lanes run, over the mean
    steps of a run."""
    for where in RUNS:
        column, model = twelve_drums(where)
        engine, options = engine_for(model, column), RunOptions()
        name, device = kernel_for(model, engine.kind), driver.the_card()
        many = lanes.CardLanes(device, name, partial(engine.block, options), 10**9, Lock())
        for lane, motion in enumerate(shakings(many.lanes)):
            many.load(lane, Case(column, motion))
        many._begin()
        many.card.advance(0)
        feed, watch = many.card.here["feed"], many.card.here["watch"]
        first, spent, launches, rates = int(feed["step"].sum()), 0.0, 0, {}
        while (running := int(np.count_nonzero(watch["status"] == RUNNING))) > 0:
            started = time.perf_counter()
            many.card.advance(lanes.CHUNKS_PER_LAUNCH)
            spent, launches = spent + time.perf_counter() - started, launches + 1
            if not rates and np.count_nonzero(watch["status"] == RUNNING) < 0.9 * many.lanes:
                rates = {"steps_of_lanes_per_s": (int(feed["step"].sum()) - first) / spent, "launches": launches}
        mean = (int(feed["step"].sum()) - first) / many.lanes
        keep(
            {
                where: {
                    "lanes": many.lanes,
                    "lanes_to_their_end_runs_per_s": many.lanes / spent,
                    "steps_of_a_run": mean,
                    "runs_per_s": rates["steps_of_lanes_per_s"] / mean,
                    "launch_s": spent / launches,
                    "steps_of_a_launch": CHUNK * lanes.CHUNKS_PER_LAUNCH,
                    **rates,
                    "running": running,
                }
            }
        )


def measure_cores(each: dict[str, int], keep: Keep) -> None:
    """Runs a second of the processor of this machine, by all threads and by one."""
    count = thread_count(None)
    for where in RUNS:
        column, model = twelve_drums(where)
        for threads in (count, 1):
            motions = shakings(each[where] * threads)
            st.simulate_many(column, motions[:1], model, threads=1)
            started = time.perf_counter()
            st.simulate_many(column, motions, model, threads=threads)
            keep({f"{where}, {threads} threads": {"runs": len(motions), "runs_per_s": len(motions) / _since(started)}})


def measure_tests(keep: Keep) -> None:
    """The tests that need a card."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-n",
        "0",
        "-m",
        "gpu",
        "-v",
        "-rs",
        "packages/stylobate-gpu/tests/agreement/test_on_card.py",
    ]
    with subprocess.Popen(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as running:
        lines: list[str] = []
        for line in running.stdout or ():
            lines.append(line.rstrip())
            keep({"said": lines[-60:]})
    keep({"exit_code": running.returncode})


def measure_processes(count: int, runs: int, keep: Keep) -> None:
    """Runs a second of several processes that share the card, end to end, in the plane."""
    start = time.time() + 15.0
    with _processes(count) as pool:
        turns = list(pool.map(_share, [runs] * count, [start] * count))
    wall = max(end for _, end in turns) - min(begin for begin, _ in turns)
    keep({"processes": count, "runs": runs * count, "runs_per_s": runs * count / wall,
          "began_late_s": [begin - start for begin, _ in turns], "ended_s": [end - start for _, end in turns]})  # fmt: skip


def _share(runs: int, start: float) -> tuple[float, float]:
    column, model = twelve_drums("plane")
    motions = shakings(runs)
    st.simulate_many(column, motions[:64], model, device="gpu")
    time.sleep(max(0.0, start - time.time()))
    began = time.time()
    st.simulate_many(column, motions, model, device="gpu")
    return began, time.time()


def measure_million(histories: int, seconds: float, folder: Path, keep: Keep) -> None:
    """A study of three round drums in the plane on the card, killed and gone on with; stopped when its time is over."""
    until = time.monotonic() + seconds
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "pulses").mkdir(parents=True)
    joint = st.Joint(normal_stiffness=5e9, shear_stiffness=2.5e9, friction_angle=35.0)
    size = {"height": 5.0, "bottom_width": 0.9, "top_width": 0.8, "drums": 3, "density": 2400.0, "section": "circular"}
    write_column(Column.tapered(**size, joint=joint), folder / "column.toml")
    for k in range(20):
        write_csv(st.ricker(0.4 + 0.1 * k, 6.0, 10.0), folder / "pulses" / f"{k:02d}.csv")
    (folder / "study.toml").write_text(
        'columns = ["column.toml"]\nmodels = ["dem2d"]\n[motions]\nfiles = ["pulses/*.csv"]\n[scale]\nim = "pgv"\n'
        f'levels = "0.1m/s:2.5m/s:50"\n[scatter]\nrealisations = {max(1, histories // 1000)}\n'
    )
    run = [
        sys.executable,
        "-m",
        "stylobate",
        "study",
        "run",
        "study.toml",
        "--out",
        "study",
        "--device",
        "gpu",
        "--json",
    ]
    keep({"histories": max(1, histories // 1000) * 1000})
    began = time.monotonic()
    for name, last in (("killed", False), ("gone on with", True)):
        started, before, first = time.monotonic(), _kept(folder), None
        with (folder / f"{name}.json").open("w") as out, (folder / f"{name}.txt").open("w") as log:
            running = subprocess.Popen(run, cwd=folder, stdout=out, stderr=log)
            while running.poll() is None:
                time.sleep(1.0)
                done, now = _kept(folder), time.monotonic()
                if first is None and done > before:
                    first = now, done
                over = now > until - 20.0 if last else done >= histories // 4 or now > began + 0.4 * seconds
                if over:
                    running.send_signal(signal.SIGINT if last else signal.SIGKILL)
                    with suppress(subprocess.TimeoutExpired):
                        running.wait(15.0)
                    running.kill()
                    running.wait()
        done = _kept(folder)
        if first is None:
            first = time.monotonic(), done
        keep(
            {
                name: {
                    "wall_s": _monotonic_since(started),
                    "before_its_first_run_s": first[0] - started,
                    "finished": done,
                    "runs_per_s": (done - first[1]) / max(1e-9, _monotonic_since(first[0])),
                    "exit_code": running.returncode,
                    "said": (folder / f"{name}.txt").read_text()[-500:],
                    "summary": (folder / f"{name}.json").read_text()[-2000:],
                }
            }
        )
    shutil.rmtree(folder, ignore_errors=True)


def _kept(folder: Path) -> int:
    """Finished runs that the ledger of a study keeps."""
    import sqlite3

    path = folder / "study" / "runs.sqlite"
    if not path.is_file():
        return 0
    with suppress(sqlite3.Error):
        database = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
        try:
            return int(database.execute("SELECT count(*) FROM runs").fetchone()[0])
        finally:
            database.close()
    return 0


def _since(started: float) -> float:
    return time.perf_counter() - started


def _monotonic_since(started: float) -> float:
    return time.monotonic() - started


@contextmanager
def _processes(count: int) -> Iterator[ProcessPoolExecutor]:
    with ProcessPoolExecutor(count, multiprocessing.get_context("spawn")) as pool:
        yield pool


def measure(part: str, seconds: float, histories: int, small: bool, keep: Keep, folder: Path) -> None:
    """Measure a part; ``small`` tries it with few runs."""
    share = 256 if small else 1
    if part == "machine":
        keep(measure_machine())
    elif part == "kinds":
        measure_kinds(keep)
    elif part in RUNS:
        measure_end_to_end(part, [runs // share for runs in RUNS[part]], keep)
    elif part == "kernels":
        measure_kernels(keep)
    elif part == "cores":
        measure_cores({where: max(2, runs // share) for where, runs in BY_CORES.items()}, keep)
    elif part == "tests":
        measure_tests(keep)
    elif part == "processes":
        measure_processes(2 if small else PROCESSES, RUNS["plane"][0] // 4 // share, keep)
    else:
        measure_million(histories // share, seconds, folder / "study", keep)


def main() -> None:
    """Measure parts one after the other, each in a process of its own that is ended when its time is over."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("parts", nargs="*", metavar="PART", help=f"{', '.join(PARTS)}; all of them if left out")
    words.add_argument("--out", type=Path, default=Path("figures-gpu"), help="folder for the figures (figures-gpu)")
    words.add_argument("--seconds", type=float, default=900.0, help="time for all of it (900)")
    words.add_argument("--histories", type=int, default=1_000_000, help="runs of the study (1000000)")
    words.add_argument("--small", action="store_true", help="few runs, to try it")
    words.add_argument("--alone", action="store_true", help=argparse.SUPPRESS)  # the process of one part
    options = words.parse_args()
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        words.error(f"there is no part {unknown[0]!r}; parts are {', '.join(PARTS)}")
    options.out.mkdir(parents=True, exist_ok=True)
    if options.alone:
        (part,) = options.parts
        figures: dict[str, Any] = {}

        def keep(more: dict[str, Any]) -> None:
            figures.update(more)
            with replacing(options.out / f"{part}.json") as partial_file:
                partial_file.write_text(json.dumps(figures, indent=1))

        try:
            measure(part, options.seconds, options.histories, options.small, keep, options.out)
        except st.StylobateError as error:
            sys.exit(str(error))
        return
    until = time.monotonic() + options.seconds
    for part in ["machine", *(options.parts or [part for part in PARTS if part != "machine"])]:
        remaining = min(until - time.monotonic(), PARTS[part])
        if remaining < 5.0:
            print(f"{part}: no time is left", flush=True)
            continue
        started = time.monotonic()
        command = [sys.executable, __file__, part, "--alone", "--out", str(options.out)]
        command += ["--seconds", str(remaining), "--histories", str(options.histories)]
        with (options.out / f"{part}.txt").open("w") as log:
            running = subprocess.Popen(
                command + ["--small"] * options.small, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
            )
            try:
                code = str(running.wait(remaining))
            except subprocess.TimeoutExpired:
                code = "its time was over"
                with suppress(ProcessLookupError):
                    os.killpg(running.pid, signal.SIGKILL)
                running.wait()
        print(f"{part}: {code}, {_monotonic_since(started):.0f} s", flush=True)
        written = options.out / f"{part}.json"
        print(written.read_text() if written.is_file() else "", flush=True)
        if code != "0":
            print((options.out / f"{part}.txt").read_text()[-2000:], flush=True)
            if part == "machine":
                sys.exit(2)


if __name__ == "__main__":
    main()
