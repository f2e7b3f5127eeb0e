"""A chunk of like cases on its way to a worker, and the worker's part: it computes them and sends results as they finish."""

from __future__ import annotations

import pickle
import time
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..kernels.jit import source_digest
from ..models.base import Case, Cases, Model, RunOptions
from ..motion import Motion
from ..response import Measures
from ..version import __version__

#: A worker sends what it has finished so often [s].
SEND_INTERVAL = 0.5


def law() -> tuple[str, str]:
    """What must be the same wherever cases of one campaign are computed: version, and source of the kernels."""
    return __version__, source_digest()


@dataclass(frozen=True)
class Chunk:
    """Cases without the samples of their motions, which are sent once per worker.

    Parameters
    ----------
    name : str
        Tells it from other chunks.
    law : tuple
        Of the client.
    model : Model
    options : RunOptions
    numbers : list of int
        Of the cases.
    stones : list
        Columns, or specimens, each once.
    stone, motion : list of int
        Which one each case has: of ``stones``, and of the motions that are sent apart.
    factors : list of float
    names : list of str
        Of the motions as scaled; they are in the words of a run that fails.
    """

    name: str
    law: tuple[str, str]
    model: Model
    options: RunOptions
    numbers: list[int]
    stones: list[Any]
    stone: list[int]
    motion: list[int]
    factors: list[float]
    names: list[str]


#: Step [s] and samples along x, y and z of a motion.
Samples = tuple[float, np.ndarray, "np.ndarray | None", "np.ndarray | None"]


def samples(*given: Any) -> Samples:
    """The samples of a motion as a task, whose result a worker that needs it takes from another one."""
    return given


def run_chunk(packed: bytes, motions: Sequence[Samples], topic: str) -> tuple[float, bytes]:
    """Compute a chunk on a worker: how long that took [s], and the results that have not been sent yet."""
    from distributed import get_worker

    worker = get_worker()
    return results_of(unpack(packed), motions, lambda some: worker.log_event(topic, some), worker.address)


def results_of(
    chunk: Chunk, motions: Sequence[Samples], send: Callable[[tuple[str, bytes]], None], where: str
) -> tuple[float, bytes]:
    """Compute a chunk; what has finished is sent every half a second, with the name of the chunk."""
    if chunk.law != law():
        raise InputError(
            f"the worker at {where} computes with stylobate {__version__} and other kernels than this one "
            f"({chunk.law[0]}); install the same version there."
        )

    whole = [Motion(*one) for one in motions]

    def case(index: int) -> Case:
        shaking = whole[chunk.motion[index]].replace(factor=chunk.factors[index], name=chunk.names[index])
        return Case(chunk.stones[chunk.stone[index]], shaking)

    started = sent = time.perf_counter()
    ready: list[tuple[int, Measures]] = []
    for index, measures in chunk.model.run_many(Cases(len(chunk.numbers), case), chunk.options, 1):
        ready.append((chunk.numbers[index], measures))
        if time.perf_counter() - sent > SEND_INTERVAL:
            send((chunk.name, pack(ready)))
            ready, sent = [], time.perf_counter()
    return time.perf_counter() - started, pack(ready)


def pack(value: Any) -> bytes:
    """A value as bytes that a scheduler passes on as they are."""
    return zlib.compress(pickle.dumps(value), 1)


def unpack(packed: bytes) -> Any:
    """The value of :func:`pack`, of our own processes only."""
    return pickle.loads(zlib.decompress(packed))
