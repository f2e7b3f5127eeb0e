"""Speed of the distinct elements on this machine, beside the same step in native code, in one run."""

from __future__ import annotations

import dataclasses
import os
import platform
import shutil
import subprocess
import tempfile
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.cluster import LOCAL, executor, on_cluster
from stylobate.column import Column, preset
from stylobate.constants import g
from stylobate.errors import StylobateError
from stylobate.kernels.run_codes import CHUNK
from stylobate.models import devices
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.drums.stepped import SteppedDrums
from stylobate.models.engine import engine_for
from stylobate.motion import Motion, harmonic
from stylobate.response.measures import CPU, GPU
from stylobate.simulate import run_options, simulate, simulate_many, thread_count

from .assemblies import assemblies

#: Vectors as wide as the machine has, multiply-add contraction as in the kernels, no reordering of sums.
FLAGS = (
    "-O3",
    "-march=native",
    "-ffp-contract=fast",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-mprefer-vector-width=512",
)

STEPS = 16_000
ROUNDS = 7

#: Chunks of steps after which ours and the native one are compared: before rounding has grown.
EARLY = 30


def native_reference(source: str, folder: str | Path) -> Path | None:
    """Compile a source beside this file into a folder; None where there is no C++ compiler."""
    compiler = shutil.which(os.environ.get("CXX", "c++")) or shutil.which("g++") or shutil.which("clang++")
    path = Path(__file__).parent / source
    if compiler is None:
        return None
    target = Path(folder) / path.stem
    flags = [
        flag for flag in FLAGS if not (flag.startswith("-mprefer") and platform.machine() not in ("x86_64", "AMD64"))
    ]
    done = subprocess.run([compiler, *flags, str(path), "-o", str(target)], capture_output=True, text=True, check=False)
    if done.returncode:
        raise StylobateError(f"the native reference {source} does not compile: {done.stderr.strip().splitlines()[:1]}.")
    return target


def bench(
    threads: int | None = None,
    *,
    full: bool = False,
    device: str = CPU,
    say: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Time the kernel, one run, threads against each other, and (``full``) the domain of 768 cells of ten seconds, and Dask
    workers against threads.

    Parameters
    ----------
    threads : int, optional
        All cores by default.
    full : bool
        Also the domain of the 12-drum column, 24 × 32 cells, and what as many Dask workers on this machine do in the time of
        the threads.
    device : {"cpu", "gpu"}
        ``gpu``: also runs per second of the graphics card of this machine, end to end, beside those of the threads.
    say : callable
        Takes a line of progress.

    Returns
    -------
    dict
        Keys of ``stylobate bench --json``. Times per contact point and step are processor time, the smallest of several
        rounds in which ours and the native one take turns.
    """
    count = thread_count(threads)
    column, model = preset("paper-12-drums"), DistinctElement2D()
    if device == GPU:
        devices.gpu()  # refused before anything is measured
    out: dict[str, Any] = {"threads": count, "cpu": cpu_name()}
    say("kernel and native reference")
    out |= _kernel(model, column, Motion(1.0, np.array([2.0, 2.0])), "native_dem2d.cpp", model.points)
    say("kernel and native reference in space")
    out |= _in_space(count, full)
    say("an assembly in space")
    out |= assemblies(say)
    say("one run")
    shaking = harmonic(1.0, 0.3 * g, 10.0)
    simulate(column, shaking.scaled(0.0), model)
    wall = min(_timed(lambda: simulate(column, shaking, model)) for _ in range(3))
    out |= {"single_run_s": wall, "real_time_factor": shaking.duration / wall}
    say(f"1 thread against {count}")
    unit = harmonic(1.0, 1.0, 10.0)
    motions = [unit.scaled(a * g) for a in np.linspace(0.05, 0.3, 128)]
    single, many = (
        min(_timed(lambda n=n: simulate_many(column, motions, model, threads=n)) for _ in range(3)) for n in (1, count)
    )
    out["threads_speedup"] = single / many
    if full:
        for name in ("paper-monolithic", "paper-12-drums"):
            say(f"domain of 768 cells, {name}")
            units = [harmonic(f, 1.0, 10.0) for f in np.linspace(0.33, 4.0, 24)]
            cells = [unit.scaled(a * g) for unit in units for a in np.linspace(0.05, 0.6, 32)]
            out[f"domain_768_{name.removeprefix('paper-').replace('-', '_')}_s"] = _timed(
                lambda name=name, cells=cells: simulate_many(preset(name), cells, model, threads=count)
            )
        say(f"{count} threads against {count} Dask workers")
        out["dask_throughput"] = _on_workers(column, model, count)
    if device == GPU:
        say(f"the graphics card against {count} threads")
        out |= _on_card(count)
    return out


def _on_card(count: int) -> dict[str, Any]:
    """Runs per second of twelve drums for ten seconds, by the card and by threads, from motions to a table."""
    column = preset("paper-12-drums")
    speeds: dict[str, Any] = {"gpu": devices.gpu().name}
    of_plane, of_space = (column, DistinctElement2D()), (_round(column), DistinctElement3D())
    for name, (stone, model), runs in (("plane", of_plane, 20_000), ("space", of_space, 8_000)):
        units = [harmonic(f, 1.0, 10.0) for f in np.linspace(0.33, 4.0, 64)]
        cells = [units[k % 64].scaled((0.05 + 0.55 * k / runs) * g) for k in np.random.default_rng(1).permutation(runs)]
        simulate_many(stone, cells[:256], model, device=GPU)
        speeds[f"gpu_{name}_runs_per_s"] = runs / _timed(partial(simulate_many, stone, cells, model, device=GPU))
        sample = cells[: 16 * count]
        speeds[f"cpu_{name}_runs_per_s"] = len(sample) / _timed(
            partial(simulate_many, stone, sample, model, threads=count)
        )
    return speeds


def _on_workers(column: Column, model: SteppedDrums, count: int) -> float | None:
    """Throughput of Dask workers on this machine over that of as many threads [-], of runs of about a tenth of a second.

    Both have loaded their kernels before; None without Dask.
    """
    if find_spec("distributed") is None:
        return None
    units = [harmonic(float(f), g, 70.0) for f in np.linspace(0.6, 3.0, 6)]
    shaking = [unit.scaled(float(a)) for unit in units for a in np.repeat(np.linspace(0.05, 0.45, 16), 4)]
    cases = [Case(column, motion) for motion in shaking]

    def finish(batch: list[Case]) -> None:
        deque(executor()(batch, model, run_options(), count), maxlen=0)

    threads, workers = [], []
    for _ in range(2):
        threads.append(_timed(lambda: finish(cases)))
        with on_cluster(LOCAL, count):
            finish(cases[: 4 * count])
            workers.append(_timed(lambda: finish(cases)))
    return min(threads) / min(workers)


def _kernel(model: SteppedDrums, column: Column, motion: Motion, source: str, points: int) -> dict[str, Any]:
    """Nanoseconds per contact point and step, ours and native, for one full block; how far apart the two are early on."""
    dt = engine_for(model, column).step
    shaking = motion.replace(dt=dt * STEPS)
    ours, native = [], []

    def timed(chunks: int) -> tuple[float, float]:
        block = engine_for(model, column).block(RunOptions(until_end=True))
        for lane in range(block.lanes):
            block.load(lane, Case(column, shaking))
        bodies = block.records.body
        started = time.thread_time()
        block.advance(chunks)
        steps = chunks * block.chunk * column.n * points * block.lanes
        return (time.thread_time() - started) / steps * 1e9, float(bodies["x"][-1, 0])

    with tempfile.TemporaryDirectory() as folder:
        program = native_reference(source, folder)

        def beside(chunks: int) -> tuple[float, float]:
            arguments = [str(program), str(chunks * CHUNK), repr(dt)]
            text = subprocess.run(arguments, capture_output=True, text=True, check=True).stdout.split()
            return float(text[0]), float(text[1])

        early = timed(EARLY)[1]  # compiles as well
        apart = None if program is None else abs(early - beside(EARLY)[1])
        for _ in range(ROUNDS):
            ours.append(timed(STEPS // CHUNK - 1)[0])
            if program is not None:
                native.append(beside(STEPS // CHUNK - 1)[0])
    best = min(native) if native else None
    return {
        "ns_per_contact_step": min(ours),
        "native_ns_per_contact_step": best,
        "ratio_to_native": None if best is None else min(ours) / best,
        "native_difference_m": apart,
    }


def _in_space(threads: int, full: bool) -> dict[str, Any]:
    """The same of round drums in space, per joint and step; and what runs of 10 s cost in a batch on one core [s]."""
    model = DistinctElement3D()
    monolith, twelve = (_round(preset(name)) for name in ("paper-monolithic", "paper-12-drums"))
    push = Motion(1.0, np.array([2.0, 2.0]), np.array([1.0, 1.0]))
    measurements = _kernel(model, twelve, push, "native_dem3d.cpp", 1)
    out = {f"space_{key.replace('contact', 'joint')}": value for key, value in measurements.items()}
    unit = harmonic(1.0, 1.0, 10.0)
    for name, column in (("monolith", monolith), ("12_drums", twelve)):
        motions = [unit.scaled(a * g) for a in np.linspace(0.05, 0.3, 32 if column.n > 1 else 320)]
        simulate_many(column, motions[:1], model, threads=1)
        started = time.process_time()
        simulate_many(column, motions, model, threads=1)
        out[f"space_run_of_{name}_s"] = (time.process_time() - started) / len(motions)
    if full:
        cells = [harmonic(f, a * g, 10.0) for f in np.linspace(0.33, 4.0, 24) for a in np.linspace(0.05, 0.6, 32)]
        out["space_domain_768_12_drums_s"] = _timed(lambda: simulate_many(twelve, cells, model, threads=threads))
    return out


def _round(column: Column) -> Column:
    return column.replace(drums=tuple(dataclasses.replace(drum, section="circular") for drum in column.drums))


def cpu_name() -> str:
    """Name of the processor."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def _timed(action: Callable[[], object]) -> float:
    started = time.perf_counter()
    action()
    return time.perf_counter() - started
