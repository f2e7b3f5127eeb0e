"""A chunk of like cases on its way to a worker, and the worker's part: it computes them and sends results as they finish."""

from __future__ import annotations

import pickle
import threading
import time
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..kernels.sources import source_digest
from ..models.base import Case, Cases, Model, RunOptions
from ..motion import Motion
from ..response import Measures
from ..version import __version__
from .stream import Part, Stream

#: A worker sends what it has finished so often, and sees so often whether its lanes run empty [s].
SEND_INTERVAL, LOOK = 0.5, 0.05


def law() -> tuple[str, str]:
    """Identity of a campaign's computations wherever they are made: version, and source of the kernels."""
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


def run_chunk(packed: bytes, motions: Sequence[Samples], topic: str) -> None:
    """Compute a chunk on a worker.

    All that it comes to is sent, and nothing is returned: a result that waits on a worker would be lost with it.
    """
    from distributed import get_worker, secede

    worker, chunk = get_worker(), unpack(packed)

    def more() -> None:
        secede()  # the worker begins what it has been sent besides
        worker.log_event(topic, (chunk.name, worker.address))

    with _FIRST:
        streams = _STREAMS.setdefault(id(worker), [Stream() for _ in range(worker.state.nthreads)])
    stream = min(streams, key=lambda one: one.left)
    results_of(chunk, motions, lambda some: worker.log_event(topic, some), worker.address, stream, more)


#: Streams of the workers in this process, one for each thread.
_STREAMS: dict[int, list[Stream]] = {}
_FIRST = threading.Lock()


def results_of(
    chunk: Chunk,
    motions: Sequence[Samples],
    send: Callable[[tuple[str, Any]], object],
    where: str,
    stream: Stream | None = None,
    more: Callable[[], object] = lambda: None,
) -> None:
    """Compute a chunk; what has finished is sent every half a second.

    Parameters
    ----------
    chunk : Chunk
    motions : sequence
        Their samples.
    send : callable
        Takes the name of the chunk with what has finished, as bytes; in the end, with how long its cases took [s].
    where : str
        What the worker is called.
    stream : Stream, optional
        Lanes that the chunk shares with those before and behind it.
    more : callable
        Called once, when the lanes will soon have room for the next chunk.
    """
    if chunk.law != law():
        raise InputError(
            f"the worker at {where} computes with stylobate {__version__} and other kernels than this one "
            f"({chunk.law[0]}); install the same version there."
        )

    whole = [Motion(*motion) for motion in motions]

    def case(index: int) -> Case:
        shaking = whole[chunk.motion[index]].replace(factor=chunk.factors[index], name=chunk.names[index])
        return Case(chunk.stones[chunk.stone[index]], shaking)

    stream = stream or Stream()
    kind = pickle.dumps((chunk.model, chunk.options, sorted({type(stone).__name__ for stone in chunk.stones})))
    part = Part(Cases(len(chunk.numbers), case), chunk.model, chunk.options, kind)
    started = sent = time.perf_counter()
    before, asked = stream.finished, False
    stream.add(part)
    ready: list[tuple[int, Measures]] = []
    while part.left:
        ready += [(chunk.numbers[index], measures) for index, measures in part.take(LOOK)]
        if not asked and stream.wants_more:
            asked = True
            more()
        if ready and time.perf_counter() - sent > SEND_INTERVAL:
            send((chunk.name, pack(ready)))
            ready, sent = [], time.perf_counter()
    each = (time.perf_counter() - started) / (stream.finished - before)  # in the meantime others have finished as well
    send((chunk.name, pack(ready)))
    send((chunk.name, each * len(chunk.numbers)))


def pack(value: Any) -> bytes:
    """A value as bytes that a scheduler passes on as they are."""
    return zlib.compress(pickle.dumps(value), 1)


def unpack(packed: bytes) -> Any:
    """The value of :func:`pack`, of our own processes only."""
    return pickle.loads(zlib.decompress(packed))
