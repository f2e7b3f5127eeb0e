"""A worker of a cluster: chunks of like cases flow through its lanes, the next one begins while the last cases of one run.

At the end of a batch its lanes run empty one by one, and a block with a single run in it costs as much as a full one. A
worker that finished its chunks one at a time would pay for that with every chunk.
"""

from __future__ import annotations

import pickle
import queue
import threading
import time
import zlib
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import InputError
from ..kernels.run_codes import LANES
from ..kernels.sources import source_digest
from ..models.base import Case, Cases, Model, RunOptions
from ..models.engine import engine_for
from ..motion import Motion
from ..response import Measures
from ..version import __version__

#: Cases that wait for a lane, at least, and how long they last [s]: until the next chunk is here.
FEWEST_WAITING, WAITING = 8, 1.5


@dataclass
class Part:
    """The cases of one chunk, and what has finished of them.

    Parameters
    ----------
    cases : Cases
    model : Model
    options : RunOptions
    kind : bytes
        Parts of the same kind have the same model, options and type of structure, and can share lanes.
    """

    cases: Cases
    model: Model
    options: RunOptions
    kind: bytes
    given: int = 0  # cases that are in lanes, or were
    remaining: int = field(init=False)  # cases whose results have not been taken
    _results: queue.Queue = field(init=False, default_factory=queue.Queue)

    def __post_init__(self) -> None:
        self.remaining = len(self.cases)

    def put(self, result: tuple[int, Measures] | BaseException) -> None:
        """A case has finished, or the run of all of them has failed."""
        self._results.put(result)

    def take(self, timeout: float) -> list[tuple[int, Measures]]:
        """(index, measures) of what has finished; the first is waited for no longer than so [s]."""
        results: list[tuple[int, Measures]] = []
        while self.remaining:
            try:
                result = self._results.get(timeout=0.0 if results else timeout)
            except queue.Empty:
                break
            if isinstance(result, BaseException):
                raise result
            results.append(result)
            self.remaining -= 1
        return results


class Stream:
    """A thread that runs the cases of the parts that are handed to it, in their order."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: deque[Part] = deque()  # parts with cases that have not been given to lanes
        self._at_work = False
        self.remaining, self.finished = 0, 0  # cases that have not finished, and that have
        self.each = 0.0  # time of a case, of those that finished in the last run [s]

    def add(self, part: Part) -> None:
        """Run the cases of a part, behind those that wait already."""
        with self._lock:
            self._waiting.append(part)
            self.remaining += part.remaining
            if not self._at_work:
                self._at_work = True
                threading.Thread(target=self._work, name="stream", daemon=True).start()

    @property
    def wants_more(self) -> bool:
        """Whether the lanes would soon run empty."""
        waiting = WAITING / self.each if self.each else 0.0
        return self.remaining <= LANES + max(FEWEST_WAITING, waiting)

    def _work(self) -> None:
        while True:
            with self._lock:
                if not self._waiting:
                    self._at_work = False
                    return
                first = self._waiting[0]
            self._run(first)

    def _run(self, first: Part) -> None:
        """Run a part, and those of its kind that come before its lanes are empty."""
        feed = _Feed(self, first)
        started, finished = time.perf_counter(), 0
        try:
            engine = engine_for(first.model, first.cases[0].column)
            for index, measures in engine.run_many(feed, first.options, 1):
                part, number = feed.given.pop(index)
                finished += 1
                self._ended(1)
                self.each = (time.perf_counter() - started) / finished
                part.put((number, measures))
        except BaseException as error:  # raised again where it is waited for
            with self._lock:
                parts = {id(part): part for part, _ in [*feed.given.values(), (first, 0)]}
                self._waiting = deque(waiting_part for waiting_part in self._waiting if id(waiting_part) not in parts)
            self._ended(
                len(feed.given) + sum(len(failed_part.cases) - failed_part.given for failed_part in parts.values())
            )
            for part in parts.values():
                part.put(error)

    def next_of(self, kind: bytes) -> tuple[Part, int] | None:
        """The next case that can share lanes with those of a kind; None while there is none."""
        with self._lock:
            if not self._waiting or self._waiting[0].kind != kind:
                return None
            part = self._waiting[0]
            part.given += 1
            if part.given == len(part.cases):
                self._waiting.popleft()
            return part, part.given - 1

    def _ended(self, count: int) -> None:
        with self._lock:
            self.remaining -= count
            self.finished += count


class _Feed(Sequence[Case]):
    """Cases for lanes: an iterator that ends where there is none for now, and goes on if it is asked again."""

    def __init__(self, stream: Stream, first: Part) -> None:
        self.stream, self.first = stream, first
        self.given: dict[int, tuple[Part, int]] = {}  # by the number of the case in the run
        self._count = 0

    def __len__(self) -> int:
        return len(self.first.cases)

    def __getitem__(self, index: Any) -> Any:
        return self.first.cases[index]

    def __iter__(self) -> Iterator[Case]:
        return self

    def __next__(self) -> Case:
        next_case = self.stream.next_of(self.first.kind)
        if next_case is None:
            raise StopIteration
        part, number = next_case
        self.given[self._count] = next_case
        self._count += 1
        return part.cases[number]


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
    stream = min(streams, key=lambda candidate: candidate.remaining)
    results_of(chunk, motions, lambda message: worker.log_event(topic, message), worker.address, stream, more)


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
    before, request_sent = stream.finished, False
    stream.add(part)
    ready: list[tuple[int, Measures]] = []
    while part.remaining:
        ready += [(chunk.numbers[index], measures) for index, measures in part.take(LOOK)]
        if not request_sent and stream.wants_more:
            request_sent = True
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
