"""Stiffness damping by what an impact is to leave: from free rocking of single bodies, each in its own plane.

A block that rocks from one edge to the other lands on Kelvin–Voigt contacts of k_n A and β k_n A. Its weight does next to
nothing while that lasts, so that what it keeps hangs on β √(k_n A/m), its shape, its friction and k_s/k_n alone, not on how
fast it lands: one curve for a body, which ends at the plastic impact of rigid bodies (Housner) as β grows.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...column import Column
from ...column.joint import Losses
from ...column.materials import IMPACT
from ...column.one_body import one_body, rocking_bodies
from ...column.structure import Structure
from ...errors import InputError
from ...kernels.dem3d.records import BETA
from ...kernels.run_codes import LANES
from ...motion import Motion
from ..base import Case, RunOptions
from ..engine import engine_for
from ..start import Start


class Free(NamedTuple):
    """A free motion.

    Parameters
    ----------
    time : array
        [s], shape (states,).
    lean : array
        Lean of the lowest body towards x and y [rad], shape (states, 2).
    """

    time: np.ndarray
    lean: np.ndarray


def released(
    column: Column, model: Any, losses: Sequence[Losses], starts: Sequence[Start], duration: float, interval: float
) -> list[Free]:
    """Free motions from starts, with losses in place of the model's.

    Parameters
    ----------
    column : Column
    model : LossyDrums
    losses : sequence of Losses
    starts : sequence of Start
        As many.
    duration, interval : float
        Of each motion, and between its states at most [s].
    """
    engines = [engine_for(replace(model, losses=loss_set), column) for loss_set in losses]
    kinds: dict[Any, list[int]] = {}
    for number, engine in enumerate(engines):
        kinds.setdefault(engine.kind, []).append(number)
    free_motions: dict[int, Free] = {}
    for numbers in kinds.values():
        # lanes of about one step end together
        ordered = sorted(numbers, key=lambda number: engines[number].step)
        for first in range(0, len(ordered), LANES):
            batch = ordered[first : first + LANES]
            block = engines[batch[0]].block(RunOptions(start=starts[batch[0]], until_end=True))
            for lane, number in enumerate(batch):
                block.pack, block.options = engines[number].pack, replace(block.options, start=starts[number])
                block.load(lane, Case(column, Motion(duration, np.zeros(2))))
            stride = max(1, int(interval / (block.chunk * block.dt.max())))
            states = [(block.dt * block.feed["step"][0], block.leans()) for _ in followed(block, stride, len(batch))]
            times, leans = (np.stack(series) for series in zip(*states, strict=True))
            for lane, number in enumerate(batch):
                moves = np.concatenate(([True], np.diff(times[:, lane]) > 0.0))
                free_motions[number] = Free(times[moves, lane], leans[moves, :, lane].copy())
    return [free_motions[number] for number in range(len(losses))]


def followed(block: Any, stride: int, lanes: int) -> Iterator[None]:
    """Let a block go on by so many chunks of steps at a time, as long as any of its first lanes runs; the start first."""
    yield
    while not all(block.is_over(lane) for lane in range(lanes)):
        block.advance(stride)
        yield


#: Damping that is tried, one value per lane besides none [s].
TRIED = np.concatenate(([0.0], np.geomspace(1e-6, 3e-3, 15)))

#: Released at this share of the critical angle.
RELEASE = 0.5

#: An impact of stone leaves what it should to this share of the velocity: measured ones scatter by six times as much, and
#: β beyond that costs steps, as the curve ends there in an asymptote.
CLOSE = 0.008

#: Least damping of joints that are damped [s]: where springs alone lose more than is asked for, that does nothing.
LEAST = 1e-12

#: How an engine lets a body rock: (the body as one drum, model, tilt at the release [rad]) to its leans towards +x as time
#: goes on, one for each damping of ``TRIED`` [rad].
Rocking = Callable[[Column, Any, float], Iterator[np.ndarray]]


def rocking_column(body: Column, model: Any, tilt: float) -> Iterator[np.ndarray]:
    """Leans of a column of one drum in the lanes of a model of columns."""
    alone = {"planar": True} if "y" in model.axes else {"start": "static"}
    twin = dataclasses.replace(model, **undamped(), **alone)
    return in_lanes(engine_for(twin, body).block(RunOptions(start=Start(tilt), until_end=True)), body)


def undamped() -> dict[str, Any]:
    """Parameters of a model whose lanes may have any damping that is tried."""
    return {"stiffness_damping": float(TRIED[-1]), "mass_damping": 0.0, "time_step": None}


def in_lanes(block: Any, what: Structure) -> Iterator[np.ndarray]:
    """Leans of what rocks in the lanes of a block, released by its options."""
    for lane, beta in enumerate(TRIED):
        block.load(lane, Case(what, longest(what)))
        block.lane["damp"][0, BETA, lane] = beta
    for _ in followed(block, 1, len(TRIED)):
        yield block.lean()[: len(TRIED)]


def longest(what: Structure) -> Motion:
    """No motion, for as long as it may take to rock there and back."""
    return Motion(10.0 / what.frequency_parameter, np.zeros(2))


@lru_cache(maxsize=1024)
def restitutions(column: Column, model: Any, rocking: Rocking = rocking_column) -> np.ndarray:
    """Velocity restitution of the first impact at each damping of ``TRIED``; the model has no restitution of its own."""
    body = one_body(column)
    tilt = RELEASE * body.slenderness
    lowest, over = np.zeros(len(TRIED)), np.zeros(len(TRIED), dtype=bool)
    for lean in rocking(body, model, tilt):
        over |= (lean > 0.0) & (lowest < 0.0)
        lowest = np.where(over, lowest, np.minimum(lowest, lean))
        if over.all():
            break
    energies = [_energy(-rebound, body.slenderness) / _energy(tilt, body.slenderness) for rebound in lowest.tolist()]
    return np.sqrt(energies)


def _energy(tilt: float, slenderness: float) -> float:
    """Rise of the centroid over the distance of the corner from it [-]."""
    return math.cos(slenderness - tilt) - math.cos(slenderness)


def damping_for(column: Column, model: Any, restitution: float) -> float:
    """Stiffness damping β at which the first impact of the column as one body has a velocity restitution [s].

    Raises
    ------
    InputError
        No damping that is tried gives it.
    """
    curve = np.minimum.accumulate(restitutions(column, model))
    if not curve[-1] <= restitution <= curve[0]:
        raise InputError(
            f"restitution is {restitution:g}; the joints of {column.name!r} give {curve[-1]:.3f} to {curve[0]:.3f} "
            f"(damped by {TRIED[-1]:g} s and undamped): choose one of these, or give stiffness_damping."
        )
    return float(np.interp(-restitution, -curve, TRIED))


def damping_of_stone(structure: Structure, model: Any, rocking: Rocking) -> float:
    """β at which impacts leave what those of stone do, ``IMPACT`` times Housner's restitution [s].

    It is the least at which every body that rocks on the ground with all that it carries comes within ``CLOSE``. Where
    joints lose as much without any damping there is next to none; where they give back more at the largest tried, that one.
    """
    chosen = [LEAST]
    for body in rocking_bodies(structure):
        curve = np.minimum.accumulate(restitutions(body, model, rocking))
        wanted = (1.0 + CLOSE) * IMPACT.value * one_body(body).restitution
        chosen.append(float(np.interp(-wanted, -curve, TRIED)))
    return max(chosen)
