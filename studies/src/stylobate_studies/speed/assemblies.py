"""Speed of assemblies in space on this machine: in lanes, beside the engine that finds contacts, in one run."""

from __future__ import annotations

import time
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
from stylobate.motion import harmonic
from stylobate.simulate import simulate, simulate_many

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


def assemblies() -> dict[str, Any]:
    """Nanoseconds per joint and step of a colonnade of 15 bodies that stays intact, motion of its bodies included, in lanes
    and alone; how far apart both are; and what runs of 10 s cost on one core in a batch, and alone [s]."""
    structure, model = colonnade(), DistinctElement3D()
    motions = [harmonic(1.0, a * g, 10.0) for a in np.linspace(0.02, 0.08, 16)]
    block = IntactLanes(model.spatial_numbers, RunOptions())
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
    return {
        "assembly_ns_per_joint_step": min(in_lanes[1:]),
        "assembly_alone_ns_per_joint_step": min(alone[1:]),
        "assembly_difference_m": float(difference),
        "assembly_run_of_colonnade_s": batch,
        "assembly_run_of_colonnade_alone_s": time.process_time() - started,
    }
