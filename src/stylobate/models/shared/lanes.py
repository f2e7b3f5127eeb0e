"""Many runs through blocks of lanes: threads take cases from one queue, decided lanes are refilled at once.

A lane kernel advances all lanes of its block together; a lane whose run is over is frozen by the kernel, collected
here and loaded with the next case. A run's result does not depend on its lane, its neighbours or the number of threads.
"""

from __future__ import annotations

import itertools
import operator
import queue
import threading
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from functools import cache, partial
from typing import Any, Protocol, TypeVar

import numpy as np

from ...errors import InputError
from ...kernels.shared.records import STATE
from ...outcome import Outcome
from ...response import Measures
from ..base import Case


class LaneBlock(Protocol):
    """A block of lanes that one thread advances."""

    lanes: int

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane that is free."""
        ...

    def advance(self) -> None:
        """Advance all lanes by a good many steps, releasing the interpreter's lock; lanes that are over stand still."""
        ...

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended."""
        ...

    def collect(self, lane: int) -> Measures | GoesOn:
        """Measures of a lane whose run has ended, or what makes them alone; the lane is free afterwards."""
        ...


#: Goes on alone with a run that a lane has handed over, to its end, on any thread; it holds all that it needs.
GoesOn = Callable[[], Measures]


class WatchedBlock(LaneBlock, Protocol):
    """A block that tells of all lanes at a time whether their runs go on, and hands none of them over."""

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended; the lane is free afterwards."""
        ...

    def running(self) -> np.ndarray:
        """Which lanes' runs go on, shape (lanes,)."""
        ...


#: Samples of a motion that a fixed step of the rocking models may pass over.
MOST_SAMPLES = 4

#: Longest call of a compiled loop [s], by the estimate: Ctrl-C and a batch that is closed have to wait for its end.
LONGEST_CALL = 0.05


def longest_piece(cost: float, chunk: int) -> int:
    """Most chunks of steps that a call takes, from about what a step costs [s]."""
    return max(1, int(LONGEST_CALL / (cost * chunk)))


#: Arrays of lanes start at a multiple of this [bytes], so that no vector straddles two lines of the cache.
CACHE_LINE = 64


def aligned_zeros(shape: int, dtype: np.dtype) -> np.ndarray:
    """One-dimensional zeros that start on a line of the cache."""
    size = shape * dtype.itemsize
    raw = np.zeros(size + CACHE_LINE, dtype=np.uint8)
    start = -raw.ctypes.data % CACHE_LINE
    return raw[start : start + size].view(dtype)


def copied(records: np.ndarray) -> np.ndarray:
    """A copy as one piece of memory; numpy copies records field by field."""
    return records.view(np.uint8).copy().view(records.dtype) if len(records) else records


#: Records of an engine whose memory a look at the forces changes; those of bodies and loads are computed anew in every step.
CHANGED = ("joint", "link", "lane")


def with_copies(state: tuple[Any, ...], *others: str) -> tuple[Any, ...]:
    """A state of an engine with copies of all records that a look at the forces changes, and of some others."""
    records = list(state)
    for place in _places(*others):
        records[place] = copied(records[place])
    return tuple(records)


@cache
def _places(*others: str) -> tuple[int, ...]:
    """Places in a state of the records of which there are copies."""
    return tuple(STATE.index(name) for name in (*CHANGED, *others))


def in_rows(records: np.ndarray, lanes: int) -> np.ndarray:
    """All fields of records over lanes as rows, shape (fields, lanes); bits, whatever their type."""
    return records.view(np.int64).reshape(-1, lanes) if len(records) else np.zeros((0, lanes), np.int64)


#: Cases that are looked at together, to put those next to each other that share blocks, and results that may wait.
WINDOW = 4096

#: Runs that lanes have handed over which may wait while lanes go on: they hold their states.
MOST_ALONE = 4

Key = TypeVar("Key", bound=Hashable)


def run_alike(
    key: Callable[[Case], Key],
    make_block: Callable[[Key], LaneBlock],
    cases: Iterable[Case],
    threads: int | Callable[[Key], int],
) -> Iterator[tuple[int, Measures]]:
    """Run cases of several kinds, those of one kind together; yields as :func:`run_lanes` does.

    Parameters
    ----------
    key : callable
        Kind of a case: cases of one kind can share a block.
    make_block : callable
        A block for cases of a kind.
    cases : iterable of Case
        Asked for one by one, :data:`WINDOW` ahead of the runs at most.
    threads : int or callable
        For all kinds, or for one.
    """
    lost: list[tuple[int, Measures]] = []

    def kinds() -> Iterator[tuple[Key, int, Case]]:
        numbered, last = enumerate(cases), None
        while window := list(itertools.islice(numbered, WINDOW)):
            by_kind: dict[Key, list[tuple[int, Case]]] = {}
            for index, case in window:
                try:
                    by_kind.setdefault(key(case), []).append((index, case))
                except NOT_COMPUTED as error:
                    lost.append((index, not_computed(error)))
            # the kind of the window before first: its blocks go on
            for kind in sorted(by_kind, key=lambda kind: kind != last):
                last = kind
                for index, case in by_kind[kind]:
                    yield kind, index, case

    for kind, group in itertools.groupby(kinds(), key=operator.itemgetter(0)):
        count = threads(kind) if callable(threads) else threads
        yield from run_lanes(lambda kind=kind: make_block(kind), (entry[1:] for entry in group), count, numbered=True)
    yield from lost


def run_lanes(
    make_block: Callable[[], LaneBlock], cases: Iterable[Any], threads: int, *, numbered: bool = False
) -> Iterator[tuple[int, Measures]]:
    """Run all cases; yields (index, measures) as they finish. Closing the iterator stops the threads.

    What lanes hand over goes on alone: on a thread that has no lanes left, or, once some wait, before its lanes go on.

    Parameters
    ----------
    make_block : callable
    cases : iterable of Case
        Asked for one by one, as lanes become free. With ``numbered``: of (index, Case).
    threads : int
    numbered : bool
    """
    todo: Iterator[tuple[int, Case]] = iter(cases if numbered else enumerate(cases))
    take = threading.Lock()
    results: queue.SimpleQueue = queue.SimpleQueue()
    alone: queue.SimpleQueue[tuple[int, GoesOn]] = queue.SimpleQueue()
    riding: set[int] = set()  # cases in lanes, of all threads
    stop = threading.Event()

    def next_case() -> tuple[int, Case] | None:
        with take:
            return next(todo, None)

    def load(block: LaneBlock, lane: int) -> int | None:
        """Fill a lane; a case that cannot be loaded is a result, and the next one is taken."""
        while (numbered_case := next_case()) is not None:
            try:
                block.load(lane, numbered_case[1])
                return numbered_case[0]
            except NOT_COMPUTED as error:
                results.put([(numbered_case[0], not_computed(error))])
        return None

    def end(index: int, collect: Callable[[], Measures | GoesOn]) -> list[tuple[int, Measures]]:
        """The measures of a run; none where it waits for whoever goes on with it."""
        try:
            outcome = collect()
        except NOT_COMPUTED as error:
            outcome = not_computed(error)
        if callable(outcome):
            alone.put((index, outcome))
            return []
        return [(index, outcome)]

    def work() -> None:
        try:
            block = make_block()
            running: dict[int, int] = {}
            while not stop.is_set():
                while results.qsize() > WINDOW // block.lanes and not stop.wait(0.01):  # a slow caller is waited for
                    pass
                for lane in range(block.lanes):
                    if lane not in running:
                        index = load(block, lane)
                        if index is None:
                            break
                        running[lane] = index
                        riding.add(index)
                if alone.qsize() >= MOST_ALONE or not running:
                    others = bool(riding)  # asked before the queue: what they hand over is in it by then
                    try:  # without a timeout, by which a SimpleQueue of several takers may wait for ever in CPython 3.11
                        results.put(end(*alone.get_nowait()))
                    except queue.Empty:
                        if not running and not others:
                            break
                        if not running:
                            stop.wait(0.01)
                    continue
                block.advance()
                ended: list[tuple[int, Measures]] = []
                for lane in [lane for lane in running if block.is_over(lane)]:
                    index = running.pop(lane)
                    ended += end(index, partial(block.collect, lane))
                    riding.discard(index)
                if ended:  # together: whoever takes them is woken once
                    results.put(ended)
            results.put(None)
        except BaseException as error:  # handed to the caller's thread, which raises it
            results.put(error)

    workers = [threading.Thread(target=work, daemon=True) for _ in range(max(1, threads))]
    for worker in workers:
        worker.start()
    alive = len(workers)
    try:
        while alive:
            item = results.get()
            if item is None:
                alive -= 1
            elif isinstance(item, BaseException):
                raise item
            else:
                yield from item
    finally:
        stop.set()
        for worker in workers:
            worker.join()


class Riders:
    """Cases in the lanes that a single run leaves free; the run itself is in lane 0.

    Parameters
    ----------
    block : WatchedBlock
    cases : sequence of Case
        Not more than there are lanes besides the first.
    """

    def __init__(self, block: WatchedBlock, cases: Sequence[Case]) -> None:
        self.block, self.number = block, len(cases)
        self._riding = np.zeros(block.lanes, dtype=bool)  # lanes with a case that has not been collected
        self._riding[1 : 1 + len(cases)] = True
        self.decided: dict[int, Measures] = {}
        for lane, case in enumerate(cases, 1):
            try:
                block.load(lane, case)
            except NOT_COMPUTED as error:
                self._keep(lane, not_computed(error))

    def collect(self) -> None:
        """Take the measures of those that have ended."""
        for lane in np.flatnonzero(self._riding & ~self.block.running()).tolist():
            if self.block.is_over(lane):
                try:
                    self._keep(lane, self.block.collect(lane))
                except NOT_COMPUTED as error:
                    self._keep(lane, not_computed(error))

    def measures(self) -> tuple[Measures, ...]:
        """Bring all of them to their ends; what each comes down to."""
        while len(self.decided) < self.number:
            self.block.advance()
            self.collect()
        return tuple(self.decided[lane] for lane in sorted(self.decided))

    def _keep(self, lane: int, measures: Measures) -> None:
        self.decided[lane] = measures
        self._riding[lane] = False


#: Ends of one run of a batch and not of the batch.
NOT_COMPUTED = (InputError, ArithmeticError, np.linalg.LinAlgError)


def not_computed(error: Exception) -> Measures:
    """Measures of a case that could not be computed, with the reason."""
    what = str(error) if isinstance(error, InputError) else f"could not be computed: {type(error).__name__}: {error}"
    return Measures(Outcome.FAILED, False, reason=what.rstrip("."))
