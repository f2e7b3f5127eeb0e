"""Speed of assemblies in space on this machine: in lanes, alone and as they fall, beside other engines, in one run."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from stylobate.column.joint import Joint
from stylobate.column.spatial.assembly import SpatialAssembly
from stylobate.column.spatial.stone import Stone
from stylobate.constants import g
from stylobate.kernels.run_codes import CHUNK
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.space.lanes import IntactLanes
from stylobate.motion import Motion, harmonic, sine_pulse
from stylobate.simulate import simulate, simulate_many

from .others import MISSING, others

#: Chunks of steps in each of several rounds, in which lanes and the other engine take turns.
CHUNKS, ROUNDS = 40, 7


def colonnade() -> SpatialAssembly:
    """Four columns of three round drums, and three architraves from axis to axis."""
    stones = [
        Stone.drum(1.0 - 0.05 * i, 0.95 - 0.05 * i, 1.5, (2.6 * k, 0.0, 1.5 * i), 2700.0, name=f"drum {k + 1}.{i + 1}")
        for k in range(4)
        for i in range(3)
    ]
    stones += [
        Stone.box((2.6, 0.7, 0.6), (2.6 * k + 1.3, 0.0, 4.5), 2700.0, name=f"architrave {k + 1}") for k in range(3)
    ]
    return SpatialAssembly(tuple(stones), Joint(5e9, 2.5e9, 35.0), name="colonnade")


def assemblies(say: Callable[[str], None]) -> dict[str, Any]:
    """Nanoseconds per joint and step of a colonnade of 15 bodies that stays intact, motion of its bodies included, in lanes
    and alone; how far apart both are; and what runs of 10 s cost on one core in a batch, and alone [s].

    Then its collapse: the dearest second of it, and all of its 5 s; and both runs by other engines."""
    structure, model = colonnade(), DistinctElement3D()
    motions = [harmonic(1.0, a * g, 10.0) for a in np.linspace(0.02, 0.08, 16)]
    block = IntactLanes(model, RunOptions())
    for lane in range(block.lanes):
        block.load(lane, Case(structure, motions[0]))
    engine = block.begun(structure)[0].engine
    engine.shake(motions[0])
    joints, in_lanes, alone = len(engine.joint), [], []
    for chunks in (1, *(CHUNKS,) * ROUNDS):  # the first compiles
        started = time.thread_time()
        block.kernel.advance(block.state, chunks)
        between = time.thread_time()
        engine.advance(chunks)
        in_lanes.append((between - started) / (chunks * CHUNK * joints * block.lanes) * 1e9)
        alone.append((time.thread_time() - between) / (chunks * CHUNK * joints) * 1e9)
    difference = np.abs(np.array([block.body[c][:, 0] - engine.body[c][:, 0] for c in "xyz"])).max()
    simulate_many(structure, motions[:4], model, threads=1)
    started = time.process_time()
    simulate_many(structure, motions, model, threads=1)
    batch = (time.process_time() - started) / len(motions)
    started = time.process_time()
    simulate(structure, motions[0], model)
    intact = time.process_time() - started
    say("the collapse of an assembly")
    thrown, seen = over(), []
    fell = simulate(structure, thrown, model, progress=lambda now, _: seen.append((now, time.process_time())))
    assert fell.measures.collapsed
    now, spent = np.array(seen).T
    dearest = np.max(np.interp(now + 1.0, now, spent) - spent)
    rivals = {}
    for name, shaken in (("run_of_colonnade", motions[0]), ("collapse", thrown)):
        timings = others(structure, shaken)
        rivals |= {f"assembly_{name}_{engine}_s": seconds for engine, seconds in timings.items()}
    if None in rivals.values():
        say(MISSING)
    return {
        "assembly_ns_per_joint_step": min(in_lanes[1:]),
        "assembly_alone_ns_per_joint_step": min(alone[1:]),
        "assembly_difference_m": float(difference),
        "assembly_run_of_colonnade_s": batch,
        "assembly_run_of_colonnade_alone_s": intact,
        "assembly_second_of_collapse_s": float(dearest),
        "assembly_collapse_s": float(spent[-1] - spent[0]),
    } | rivals


def over() -> Motion:
    """A pulse from askew that throws the colonnade over, and rest to 5 s."""
    pulse, rest = sine_pulse(0.8, g, 1.25), np.zeros(375)
    samples = np.concatenate((pulse.acceleration[:: round(0.01 / pulse.dt)], rest))
    return Motion(0.01, 0.5 * samples, lateral=0.87 * samples)
