"""One run of an assembly: closed under its weight, shaken, and followed to the end of the motion or until rest."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ...column.assembly import Assembly
from ...errors import InputError, OutOfRangeWarning
from ...motion import Motion
from ...response import Response
from ...response.assembly_measures import first_touch, response_of_blocks
from ..base import RunOptions, ground_histories, refuse_endless, refuse_long_histories
from ..dem2d.model import DistinctElement2D
from ..drums.block import LARGEST_IMBALANCE
from .engine import LONGEST_WAIT, RESTITUTION_TO_REST, Engine, stable_step


def run_assembly(assembly: Assembly, motion: Motion, model: DistinctElement2D, options: RunOptions) -> Response:
    """One run of an assembly to the end of the motion and its tail, or until rest.

    Parameters
    ----------
    assembly : Assembly
    motion : Motion
    model : DistinctElement2D
        Contact points, damping, step, restitution. The contacts are closed by the weight they carry; an assembly that
        is not in equilibrium begins as drawn, which is said, or is refused with ``start="settle"``.
    options : RunOptions

    Raises
    ------
    InputError
        The step asked for is unstable, the assembly cannot settle, or the stone is given a modulus.

    Warns
    -----
    OutOfRangeWarning
        The assembly is not in equilibrium as drawn.
    """
    if model.block_modulus is not None:
        raise InputError(
            f"block_modulus is {model.block_modulus:g} Pa; the blocks of an assembly are rigid: leave it out."
        )
    restitution = model.restitution
    if restitution is None:
        restitution = RESTITUTION_TO_REST if options.until_rest else 1.0
    engine = Engine(assembly, model, motion, motion.duration + options.tail, restitution)
    stable = stable_step(engine)
    step = model.step_factor * stable if model.time_step is None else model.time_step
    if step >= stable:
        raise InputError(
            f"time_step is {step:g} s; the largest stable step for {assembly.name!r} is {stable:.4g} s: "
            f"give at most {0.9 * stable:.3g} s, or leave it out."
        )
    length = engine.duration + (LONGEST_WAIT if options.until_rest else 0.0)
    step = min(step, motion.duration / engine.kernel.CHUNK)
    refuse_endless(f"{assembly.name!r} under {motion.name!r}", length, step, engine.cost)
    refuse_long_histories(length / options.output_interval, len(assembly.blocks))
    engine.start(step)
    balanced = engine.settle()
    if not balanced and model.start == "settle":
        raise InputError(
            f"{assembly.name!r} is not in equilibrium as drawn; support its blocks, or leave start=settle out to let "
            "it move."
        )
    if not balanced:
        said = f"{assembly.name!r} is not in equilibrium as drawn; it moves from the start."
        warnings.warn(said, OutOfRangeWarning, stacklevel=3)
    start = engine.energies()
    states, still = follow(engine, options)
    stack = {key: np.array([state[key] for state in states]) for key in states[0]}
    names = ("input", "kinetic", "gravitational", "elastic", "friction", "viscous")
    change = stack["energy"] - np.where([0, 0, 1, 1, 1, 1], start, 0.0)
    missing = float(abs(change[-1, 0] - change[-1, 1:].sum()))
    largest = max(float(np.abs(change[:, 0]).max()), float(-change[:, 2].min()), float(start[3]), 1e-300)
    acceleration, displacement = ground_histories(motion, stack["time"])
    step, poses = int(engine.now["touched"][0]), (stack["x"], stack["z"], stack["rotation"])
    touched = first_touch(assembly, stack["time"], *poses, step * engine.dt) if step >= 0 else None
    return response_of_blocks(
        assembly,
        stack["time"],
        *poses,
        {name: change[:, k] for k, name in enumerate(names)},
        acceleration,
        displacement,
        at_rest=still,
        in_equilibrium=balanced,
        failed=engine.failed or missing > LARGEST_IMBALANCE * largest,
        energy_imbalance=missing / largest,
        time_step=engine.dt,
        steps=int(engine.now["step"][0]),
        model=model.name,
        touched=touched,
        provenance={
            "restitution": restitution,
            "joints": len(assembly.joints),
            "deepest_penetration_m": engine.deepest(),
        },
    )


def follow(engine: Engine, options: RunOptions) -> tuple[list[dict[str, Any]], bool]:
    """Go on to the end of the motion and its tail, or until rest; the states on the way, and whether all lies still."""
    every = max(1, min(engine.chunks, round(options.output_interval / (engine.kernel.CHUNK * engine.dt))))
    states, still = [engine.state()], False
    while not engine.failed:
        left = engine.chunks - int(engine.now["step"][0]) // engine.kernel.CHUNK
        still = engine.at_rest()
        if left <= 0:
            engine.now["dull"] = engine.now["eta"] if options.until_rest else 0.0
        if left <= 0 and (not options.until_rest or still or engine.time > engine.duration + LONGEST_WAIT):
            break
        engine.advance(min(every, left) if left > 0 else every)
        states.append(engine.state())
    return states, still
