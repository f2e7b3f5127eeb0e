"""Many runs through blocks of lanes: threads take cases from one queue, decided lanes are refilled at once.

A lane kernel advances all lanes of its block together; a lane whose run is over is frozen by the kernel, collected
here and loaded with the next case. A run's result does not depend on its lane, its neighbours or the number of threads.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol

import numpy as np

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

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run has ended; the lane is free afterwards."""
        ...


#: Samples of a motion that a fixed step of the rocking models may pass over.
MOST_SAMPLES = 4

#: Arrays of lanes start at a multiple of this [bytes], so that no vector straddles two lines of the cache.
CACHE_LINE = 64


def aligned_zeros(shape: int, dtype: np.dtype) -> np.ndarray:
    """One-dimensional zeros that start on a line of the cache."""
    size = shape * dtype.itemsize
    raw = np.zeros(size + CACHE_LINE, dtype=np.uint8)
    start = -raw.ctypes.data % CACHE_LINE
    return raw[start : start + size].view(dtype)


def run_lanes(
    make_block: Callable[[], LaneBlock], cases: Sequence[Case], threads: int
) -> Iterator[tuple[int, Measures]]:
    """Run all cases; yields (index, measures) as they finish. Closing the iterator stops the threads."""
    if not cases:
        return
    todo = iter(range(len(cases)))
    take = threading.Lock()
    results: queue.SimpleQueue = queue.SimpleQueue()
    stop = threading.Event()

    def next_case() -> int | None:
        with take:
            return next(todo, None)

    def work() -> None:
        try:
            block = make_block()
            running: dict[int, int] = {}
            while not stop.is_set():
                for lane in range(block.lanes):
                    if lane in running:
                        continue
                    index = next_case()
                    if index is None:
                        break
                    block.load(lane, cases[index])
                    running[lane] = index
                if not running:
                    break
                block.advance()
                for lane in [lane for lane in running if block.is_over(lane)]:
                    results.put((running.pop(lane), block.collect(lane)))
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
                yield item
    finally:
        stop.set()
        for worker in workers:
            worker.join()
