"""Runs on a Dask cluster: this process hands out chunks of cases and takes results as they come.

A worker asks for the next chunk before its lanes run empty, and gets about ten seconds' worth, less towards the end: so
that all workers end together. What has finished is sent at once: a lost worker costs nothing but computing.

The scheduler computes a lost worker's chunks again by itself. A chunk that was on too many workers when they died is cut
into parts, down to the one case. A single case is handed out once more alone, when nothing else is under way: only what
then kills its workers again is to blame, and is a run that failed.
"""

from __future__ import annotations

import logging
import math
import queue
import threading
import time
import uuid
from collections import OrderedDict, deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Protocol

from ..errors import InputError, StylobateError
from ..models.base import Case, Model, RunOptions
from ..models.shared.lanes import not_computed
from ..motion import Motion
from ..response import Measures
from ..simulate import run_checked, thread_count
from .digests import samples_of
from .local_workers import LocalWorkers
from .worker import Chunk, law, pack, run_chunk, samples, unpack

if TYPE_CHECKING:
    from distributed import Client

#: A client and a future of ``distributed``, whose methods are typed for coroutines as well.
AnyClient = Future = Any

#: Workers on this machine, as an address.
LOCAL = "local"

#: Time that a scheduler has to answer [s].
PATIENCE = 6.0


@contextmanager
def on_cluster(
    address: str, workers: int | None = None, say: Callable[[str], object] | None = None
) -> Iterator[Client]:
    """Inside the block every campaign is computed by the workers of a Dask cluster, to the same bits as by threads.

    Parameters
    ----------
    address : str
        Of the scheduler, such as ``tcp://10.0.0.1:8786``; ``local`` starts workers on this machine, and ends them with the
        block.
    workers : int, optional
        Of a local cluster, each of one thread; as many as cores by default.
    say : callable, optional
        Told in a sentence what a person should know, e.g. that the cluster has no workers yet.

    Raises
    ------
    InputError
        Dask is not installed, or no scheduler answers within ten seconds.
    StylobateError
        The workers of this machine do not start, or the scheduler is lost on the way.
    """
    try:
        import distributed
    except ImportError:
        raise InputError(
            "runs on a cluster take Dask, which is not installed; install stylobate[cluster], or leave `dask` out."
        ) from None
    for name in list(logging.root.manager.loggerDict):  # what goes wrong is said here, in one sentence
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    local = LocalWorkers(thread_count(workers)) if address == LOCAL else None
    try:
        client = _connect(distributed.Client, address if local is None else local.address)
        try:
            with computed_by(_Cluster(client, say)):
                yield client
        finally:
            with suppress(Exception):
                client.close(timeout=0.2)
    finally:
        if local is not None:
            local.end()


def _connect(client: type[Client], address: str) -> Client:
    """A client of the scheduler at an address, or the sentence that there is none; within :data:`PATIENCE`."""
    from distributed.comm.addressing import get_address_host_port

    answers: queue.Queue = queue.Queue()

    class Known(client):
        """A client that waits for nobody at its end, unless it has come to a scheduler."""

        def __del__(self) -> None:
            if self.status == "running":
                super().__del__()

    def ask() -> None:
        try:
            answers.put(Known(address, timeout=0.9 * PATIENCE, set_as_default=False, name="stylobate"))
        except BaseException as error:
            answers.put(error)

    try:
        get_address_host_port(address)
        threading.Thread(target=ask, daemon=True).start()  # what takes a connection and says nothing is not waited for
        answer = answers.get(timeout=PATIENCE)
        if isinstance(answer, BaseException):
            raise answer
        return answer
    except Exception as error:  # of whichever library finds the address wrong
        why = " ".join(str(error).split()) or f"nothing within {PATIENCE:g} s"
        raise InputError(
            f"no Dask scheduler answers at {address!r} ({why[:200]}); give its address, such as tcp://10.0.0.1:8786, or "
            "local for workers on this machine."
        ) from None


class _Cluster:
    """The executor that stands for a cluster."""

    def __init__(self, client: Client, say: Callable[[str], object] | None) -> None:
        self.client, self.say = client, say

    def __call__(
        self, cases: Sequence[Case], model: Model, options: RunOptions, threads: int | None
    ) -> Generator[tuple[int, Measures], None, None]:
        work = HandOut(self.client, cases, model, options, self.say)
        try:
            yield from work.results()
        finally:
            work.end()


#: (index of the case, measures) as runs finish, in any order.
Finished = Generator[tuple[int, Measures], None, None]


class Executor(Protocol):
    """Executors of runs; the same cases give the same measures, to the bit, with any that computes by processors.

    A graphics card contracts and orders other sums: ``Measures.computed_by`` tells its runs.
    """

    def __call__(self, cases: Sequence[Case], model: Model, options: RunOptions, threads: int | None) -> Finished:
        """Run all cases, which were checked; closing what is returned stops it."""
        ...


_INSTEAD: ContextVar[Executor | None] = ContextVar("_INSTEAD", default=None)


def executor() -> Executor:
    """What computes runs now: :func:`stylobate.simulate.run_checked`, or what has taken its place."""
    return _INSTEAD.get() or run_checked


@contextmanager
def computed_by(executor: Executor) -> Iterator[None]:
    """Inside the block an executor computes, instead of threads."""
    token = _INSTEAD.set(executor)
    try:
        yield
    finally:
        _INSTEAD.reset(token)


#: A chunk takes about so long, and at least so long [s], and is at most so many times as large as what has been timed.
LENGTH, SHORTEST, GROWTH = 10.0, 0.25, 8

#: Cases of a chunk: before anything has been timed, fewest then, fewest, and most.
FIRST, FEWEST_UNTIMED, FEWEST, MOST = 128, 16, 4, 20_000

#: Share of what is left for each thread that one chunk takes; parts that a chunk is cut into.
SHARE, PARTS = 0.5, 8

#: Motions that the cluster keeps.
MOTIONS = 512

#: Time between two looks at the cluster [s].
LOOK = 1.0


class HandOut:
    """Cases on their way through a cluster.

    Parameters
    ----------
    client : distributed.Client
    cases : sequence of Case
        Asked for one by one, as they are sent.
    model : Model
    options : RunOptions
    say : callable, optional
        Told once if there are no workers.
    """

    def __init__(
        self,
        client: AnyClient,
        cases: Sequence[Case],
        model: Model,
        options: RunOptions,
        say: Callable[[str], object] | None = None,
    ) -> None:
        self.client, self.cases, self.model, self.options, self.say = client, cases, model, options, say
        self._inbox: queue.Queue = queue.Queue()
        self._topic = f"stylobate-{uuid.uuid4().hex}"
        self._motions: OrderedDict[tuple, tuple[Motion, Future]] = OrderedDict()
        self._running: dict[str, tuple[Future, set[int]]] = {}  # with the cases that have not come in yet
        self._sizes: dict[str, int] = {}
        self._again: deque[list[int]] = deque()
        self._suspects: deque[int] = deque()
        self._alone = ""  # the chunk of one that was sent when nothing else was under way
        self._full: set[str] = set()  # chunks whose workers have not asked for the next one
        self._asking: deque[str] = deque()  # workers that have, and have not got it
        self._next, self._made = 0, 0
        self._each = math.nan  # time of a case [s]
        self._largest = FIRST // GROWTH  # chunk that has been timed
        self._threads, self._looked = 0, -math.inf
        client.subscribe_topic(self._topic, lambda event: self._inbox.put(event[1]))

    def results(self) -> Iterator[tuple[int, Measures]]:
        """(index, measures) as they come in."""
        while self._send() or self._running:
            try:
                came = self._inbox.get(timeout=LOOK)
            except queue.Empty:
                self._check()
                continue
            name, content = came
            if isinstance(content, bytes):
                yield from self._new(name, content)
            elif isinstance(content, str):
                self._more(name, content)
            elif isinstance(content, float):
                self._time(content, self._sizes.get(name, 1))
            elif name in self._running:
                yield from self._ended(name, content)

    def end(self) -> None:
        """Take back what is under way; nothing is waited for."""
        for future, _ in self._running.values():
            future.release()
        self._running.clear()
        self._motions.clear()
        if self.client.status == "running":
            self.client.unsubscribe_topic(self._topic)

    # -- out -----------------------------------------------------------------------------------------------------

    def _send(self) -> bool:
        """Send as much as the cluster can use; whether anything is left to be sent."""
        self._count_threads()
        while len(self._full) < self._threads and (numbers := self._take()):
            self._submit(numbers)
        if not self._running and self._threads and self._suspects:
            self._alone = self._submit([self._suspects.popleft()])
        return bool(self._again or self._suspects or self._next < len(self.cases))

    def _take(self) -> list[int]:
        if self._again:
            return self._again.popleft()
        remaining = len(self.cases) - self._next
        if not remaining:
            return []
        share = math.ceil(SHARE * remaining / self._threads)
        if math.isnan(self._each):  # few cases are spread over all threads
            count = min(max(share, FEWEST_UNTIMED), FIRST, math.ceil(remaining / self._threads))
        else:
            shortest = max(FEWEST, math.ceil(SHORTEST / self._each))
            count = min(max(share, shortest), max(int(LENGTH / self._each), shortest), GROWTH * self._largest, MOST)
        count = min(count, remaining)
        self._next += count
        return list(range(self._next - count, self._next))

    def _submit(self, numbers: list[int]) -> str:
        stones: dict[int, tuple[int, Any]] = {}
        motions: dict[tuple, tuple[int, Future, Motion]] = {}  # the motions, so that nothing else gets their addresses
        stone, motion, factors, names = [], [], [], []
        for number in numbers:
            column, shaking = self.cases[number]
            stone.append(stones.setdefault(id(column), (len(stones), column))[0])
            key = samples_of(shaking)
            if key not in motions:
                motions[key] = len(motions), self._sent(key, shaking), shaking
            motion.append(motions[key][0])
            factors.append(shaking.factor)
            names.append(shaking.name)
        self._made += 1
        name = f"{self._topic}-{self._made}"
        listed = [structure for _, structure in stones.values()]
        chunk = Chunk(name, law(), self.model, self.options, numbers, listed, stone, motion, factors, names)
        needed = [samples for _, samples, _ in motions.values()]
        where = {"workers": [self._asking.popleft()], "allow_other_workers": True} if self._asking else {}
        future = self.client.submit(run_chunk, pack(chunk), needed, self._topic, key=name, pure=False, **where)
        self._running[name], self._sizes[name] = (future, set(numbers)), len(numbers)
        self._full.add(name)
        future.add_done_callback(lambda completed: self._inbox.put((name, completed)))
        return name

    def _sent(self, key: tuple, motion: Motion) -> Future:
        """The samples of a motion on the cluster: sent once, passed from worker to worker."""
        if key not in self._motions:
            given = (motion.dt, motion.samples, motion.y_samples, motion.z_samples)
            future = self.client.submit(samples, *given, key=f"{self._topic}-motion-{uuid.uuid4().hex}", pure=False)
            self._motions[key] = motion, future  # the motion, so that nothing else gets the numbers of its arrays
            if len(self._motions) > MOTIONS:
                self._motions.popitem(last=False)
        self._motions.move_to_end(key)
        return self._motions[key][1]

    def _count_threads(self) -> None:
        if (now := time.monotonic()) - self._looked < LOOK:
            return
        self._looked = now
        self._check()
        try:
            self._threads = sum(self.client.nthreads().values())
        except Exception:  # whatever the way to the scheduler makes of its end
            raise StylobateError(GONE) from None
        if not self._threads and self.say and not self._made:
            self.say("the cluster has no workers yet; waiting for some.")
            self.say = None

    # -- in ------------------------------------------------------------------------------------------------------

    def _more(self, name: str, worker: str) -> None:
        """A worker has room for the next chunk."""
        if name in self._full:  # computed again, it asks again
            self._full.remove(name)
            self._asking.append(worker)

    def _new(self, name: str, packed: bytes) -> Iterator[tuple[int, Measures]]:
        """Values that are new: a chunk that is computed again sends everything again."""
        outstanding = self._running[name][1] if name in self._running else set()
        for number, measures in unpack(packed):
            if number in outstanding:
                outstanding.remove(number)
                yield number, measures

    def _ended(self, name: str, future: Future) -> Iterator[tuple[int, Measures]]:
        if future.status == "finished":
            numbers = self._pop(name)
            self._again.extend([numbers] if numbers else [])
            return
        numbers = self._pop(name)
        error = future.exception() if future.status == "error" else None
        if error is None:  # taken back by the scheduler, which lost it
            self._check()
        elif type(error).__name__ != "KilledWorker":
            raise _bare_error(error) from None
        elif len(numbers) == 1:
            if name == self._alone:
                yield numbers[0], not_computed(InputError("the workers that computed it died, each time"))
            else:
                self._suspects.append(numbers[0])
            return
        size = math.ceil(len(numbers) / PARTS) if error else MOST
        self._again.extend(numbers[k : k + size] for k in range(0, len(numbers), max(1, size)))

    def _pop(self, name: str) -> list[int]:
        """A chunk has ended: what of it is missing."""
        for key, (_, future) in list(self._motions.items()):
            if future.status == "error":  # its workers died; it is sent again with the chunk
                del self._motions[key]
        self._full.discard(name)
        self._sizes.pop(name, None)
        return sorted(self._running.pop(name)[1])

    def _time(self, took: float, count: int) -> None:
        """A chunk of so many cases took so long [s]."""
        self._each, self._largest = max(took / count, 1e-9), max(self._largest, count)

    def _check(self) -> None:
        if self.client.status != "running":
            raise StylobateError(GONE)


#: Sentence when there is no scheduler any more.
GONE = "the Dask scheduler is gone; with `out=DIR` what has finished is kept, and the same command goes on from there."


def _bare_error(error: BaseException) -> BaseException:
    """Error of a worker, in a sentence where it is not about the work itself."""
    if isinstance(error, ImportError):
        return InputError(f"a worker cannot load what it needs ({error}); install the same version of stylobate there.")
    return error
