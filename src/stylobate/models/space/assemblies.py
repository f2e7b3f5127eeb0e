"""One run of an assembly in space: closed under its weight, shaken, and followed to the end of the motion or until rest."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...column.structure import Structure
from ...constants import LONGEST_WAIT
from ...errors import OutOfRangeWarning
from ...kernels.run_codes import CHUNK
from ...motion import Motion
from ...response import LinkHistories, Response
from ...response.space_measures import fallen, recorded_in_space
from ..base import RESTITUTION, RunOptions, refuse_endless, refuse_long_histories
from ..drums.links import acting, link_histories, link_measures, link_snapshot
from ..shared import ledger
from ..shared.ground import BEFORE, ground_histories, value_at
from ..shared.stable_step import chosen_step
from .loose import Loose
from .packing import joints_of, laws_of, solids_of

#: A run has failed when its ledger misses more than this share of the energy at stake, at the end or before anything fell.
LARGEST_IMBALANCE = 0.05

#: Nor has a run a verdict in which a contact was deeper than this share of the least width of any body.
DEEPEST = 0.25

#: About what a step costs on one core for each joint and body [s].
COST = 2e-6


@dataclass(frozen=True)
class SpatialNumbers:
    """What a run is computed with.

    Parameters
    ----------
    name : str
        Of the model, for the response.
    stiffness_damping : float
        [s]
    step_factor, time_step : float, float or None
        Share of the largest stable step, or the step itself [s].
    restitution : float or None
        Of what no joint holds; :data:`RESTITUTION` by default.
    """

    name: str
    stiffness_damping: float
    step_factor: float
    time_step: float | None
    restitution: float | None


def engine_of(structure: Structure, numbers: SpatialNumbers, restitution: float) -> Loose:
    """The lane of an assembly in space."""
    solids, first = solids_of(structure)
    joints = joints_of(structure, solids, first)
    gravity = (0.0, 0.0, structure.gravity)
    return Loose(solids, laws_of(structure), gravity, restitution, numbers.stiffness_damping, joints, acting(structure))


def step_for(engine: Loose, structure: Structure, numbers: SpatialNumbers) -> float:
    """Time step of a run [s].

    Raises
    ------
    InputError
        The step asked for is unstable.
    """
    return chosen_step(engine.stable_step(), numbers.step_factor, numbers.time_step, repr(structure.name))


def run_in_space(structure: Structure, motion: Motion, numbers: SpatialNumbers, options: RunOptions) -> Response:
    """One run of an assembly in space to the end of the motion and its tail, or until rest.

    It goes on however much has fallen: what stands may fall later. The contacts are closed by the weight they carry; an
    assembly that is not in equilibrium begins as drawn, with a warning.

    Raises
    ------
    InputError
        The step asked for is unstable.

    Warns
    -----
    OutOfRangeWarning
        The assembly is not in equilibrium as drawn.
    """
    motion, engine = motion.multiplied, unsettled(structure, numbers)
    chunks_of(structure, motion, engine, options)
    made = settled(structure, engine)
    if made.balanced is False:
        said = f"{structure.name!r} is not in equilibrium as drawn, as far as settling shows; it moves from the start."
        warnings.warn(said, OutOfRangeWarning, stacklevel=4)
    return go_on(structure, motion, numbers, options, made, [])


def go_on(
    structure: Structure,
    motion: Motion,
    numbers: SpatialNumbers,
    options: RunOptions,
    made: Begun,
    states: list[dict[str, Any]],
) -> Response:
    """Go on with a run from where its engine is to where it ends.

    Parameters
    ----------
    structure, motion, numbers, options
        As of :func:`run_in_space`.
    made : Begun
        How it began, with the engine as it is now.
    states : list of dict
        What was recorded so far, the last one now; empty at the start. Of what the first one holds a history is kept.
    """
    engine = made.engine
    engine.shake(motion)
    states, still = _follow(structure, engine, motion, states or [_state(engine, motion)], options)
    stack: dict[str, Any] = {key: np.array([state[key] for state in states]) for key in states[0] if key != "links"}
    failure = ""
    if engine.failed:
        failure = f"the bodies could not be followed beyond {engine.time:.4g} s; try a smaller step_factor"
    return response_of(
        structure, motion, numbers, made, stack, still=still, failure=failure, held=link_histories(states)
    )


class Begun(NamedTuple):
    """An assembly in space about to be shaken.

    Parameters
    ----------
    engine : Loose
        With its step, settled.
    start : array
        Ledger of its state [J].
    balanced : bool or None
        Whether it is in equilibrium as drawn; None if it was not asked to settle.
    """

    engine: Loose
    start: np.ndarray
    balanced: bool | None


def unsettled(structure: Structure, numbers: SpatialNumbers) -> Loose:
    """The lane of an assembly in space as drawn, with its step.

    Raises
    ------
    InputError
        The step asked for is unstable.
    """
    restitution = RESTITUTION if numbers.restitution is None else numbers.restitution
    engine = engine_of(structure, numbers, restitution)
    engine.start(step_for(engine, structure, numbers))
    return engine


def settled(structure: Structure, engine: Loose) -> Begun:
    """An assembly in space with its contacts closed by the weight that they carry, unless it begins as drawn."""
    balanced = engine.settle() if getattr(structure, "settle", True) else None
    return Begun(engine, engine.energies(), balanced)


def chunks_of(structure: Structure, motion: Motion, engine: Loose, options: RunOptions) -> tuple[int, int]:
    """Chunks of steps of a run, and after how many of them a state is kept; endless runs are refused.

    Raises
    ------
    InputError
    """
    duration = motion.duration + options.tail
    length = duration + (LONGEST_WAIT if options.until_rest else 0.0)
    refuse_endless(f"{structure.name!r} under {motion.name!r}", length, engine.dt, COST * len(engine.body))
    refuse_long_histories(length / options.output_interval, len(engine.body))
    chunks = math.ceil(duration / (CHUNK * engine.dt) * (1.0 - 1e-12))
    return chunks, max(1, min(chunks, round(options.output_interval / (CHUNK * engine.dt))))


def response_of(
    structure: Structure,
    motion: Motion,
    numbers: SpatialNumbers,
    made: Begun,
    stack: dict[str, Any],
    *,
    still: bool,
    failure: str = "",
    held: LinkHistories | None = None,
) -> Response:
    """The response of a run from its states, by their names; ``failure`` is why they end before the run does, ``held`` are
    the histories of its links."""
    engine, start = made.engine, made.start
    change = stack["energy"] - np.where([0, 0, 1, 1, 1, 1], start, 0.0)
    imbalance = max(_imbalance(change, start), _imbalance_before_falls(structure, stack, change, start))
    deepest = float(engine.now["deepest"][0])
    if not failure and deepest > DEEPEST * engine.least_width:
        failure = (
            f"bodies sank into one another, {deepest:.3g} m at a contact; try a smaller step_factor, or stiffer joints"
        )
    failure = failure or ledger.out_of_balance(imbalance, LARGEST_IMBALANCE)
    acceleration, displacement = ground_histories(motion, stack["time"])
    if made.balanced:
        failure = failure or ledger.set_off_by_itself(stack["time"], acceleration, change[:, 1], float(start[3]))
    recorded = recorded_in_space(
        structure,
        stack["time"],
        stack["position"],
        stack["axes"],
        {name: change[:, k] for k, name in enumerate(ledger.TERMS)},
        acceleration,
        displacement,
        at_rest=still,
        in_equilibrium=made.balanced,
        failure=failure,
        energy_imbalance=imbalance,
        time_step=engine.dt,
        steps=round(float(stack["time"][-1]) / engine.dt),
        velocity=stack.get("velocity"),
        spin=stack.get("spin"),
        struck_at=engine.struck_at,
        model=numbers.name,
        links=link_measures(engine.links, engine.ties.link, 0, engine.dt),
        held=held,
        provenance={
            "restitution": engine.restitution,
            "joints": len(engine.joint),
            "deepest_penetration_m": deepest,
        },
    )
    return Response.of(recorded)


def _imbalance(change: np.ndarray, start: np.ndarray) -> float:
    """Energy imbalance at the last of some states, whose ledgers have changed so since the start."""
    return ledger.imbalance(
        ledger.unaccounted(change[-1] - np.where([0, 1, 0, 0, 0, 0], change[0], 0.0)),
        work=float(np.abs(change[:, 0]).max()), start=float(start[1] + start[3]), barrier=0.0,
        released=ledger.released(change[-1]),
    )  # fmt: skip


def _imbalance_before_falls(
    structure: Structure, stack: dict[str, Any], change: np.ndarray, start: np.ndarray
) -> float:
    """Most that the ledger misses before anything fell, over the input by then or what the way there has set free.

    It may have decided over the fall, which sets free far more.
    """
    down = fallen(structure, stack["position"][0], stack["axes"][0], stack["position"], stack["axes"]).any(axis=1)
    if not down.any():
        return 0.0
    upright = change[: np.argmax(down)] - np.where([0, 1, 0, 0, 0, 0], change[0], 0.0)
    return ledger.imbalance(
        max(map(ledger.unaccounted, upright)), work=float(np.abs(upright[:, 0]).max()),
        start=float(start[1] + start[3]), barrier=0.0, released=max(map(ledger.released, upright)),
    )  # fmt: skip


def _follow(
    structure: Structure, engine: Loose, motion: Motion, states: list[dict[str, Any]], options: RunOptions
) -> tuple[list[dict[str, Any]], bool]:
    """Go on to where the run ends; the states until there, and whether all lies still after the motion."""
    chunks, every = chunks_of(structure, motion, engine, options)
    duration = motion.duration + options.tail
    still, over = False, False
    while not engine.failed:
        left = chunks - engine.steps // CHUNK
        still, over = engine.at_rest(), left <= 0
        if over:
            waits = options.until_rest or (options.until_decided and not _fallen(structure, states).any())
            if not waits or still or engine.time > duration + LONGEST_WAIT:
                break
            engine.now["dull"] = engine.now["eta"]
            engine.quieten()
        engine.advance(every if over else min(every, left))
        states.append(_state(engine, motion))
        if options.progress:
            options.progress(min(engine.time, duration), duration)
    return states, still and over


def _fallen(structure: Structure, states: Sequence[dict[str, Any]]) -> np.ndarray:
    """Which bodies have fallen in the last of some states."""
    first, last = states[0], states[-1]
    return fallen(structure, first["position"], first["axes"], last["position"], last["axes"])


def _state(engine: Loose, motion: Motion) -> dict[str, Any]:
    """Part of the present state in a history."""
    return {
        "time": engine.time,
        "position": engine.places,
        "axes": engine.axes_of_all,
        "velocity": engine.vectors("v"),
        "spin": engine.vectors("w"),
        "energy": engine.energies(ground_at(motion, engine.time)),
    } | ({"links": link_snapshot(engine.ties.link, 0)} if engine.links else {})


def ground_at(motion: Motion, time: float) -> np.ndarray:
    """Acceleration of the base at a time [m/s²], shape (3,)."""
    place, base = time / motion.dt, np.zeros(3)
    if place <= motion.steps - 1:
        for c, samples in enumerate((motion.samples, motion.y_samples, motion.z_samples)):
            if samples is not None:
                base[c] = value_at(samples, place, BEFORE) * motion.factor
    return base
