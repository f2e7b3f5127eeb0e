"""Executors of runs: the threads of this process, or whatever has taken their place (a Dask cluster)."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Protocol

from ..models.base import Case, Model, RunOptions
from ..response import Measures
from ..simulate import run_checked

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
