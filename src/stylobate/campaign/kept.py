"""Runs by the digests of their cases: what a ledger holds is not run again, whichever study it was made for."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from ..models.base import Case, Cases, Model
from .digests import Digests
from .executor import compute
from .ledger import Ledger, rows_in

#: One ledger takes the runs of any study: what tells them apart is the digest of each case.
KEY = {"keyed by": "digest of the case"}

#: Cases that run together: their numbers, their model, and the share below which their motions are quiet.
Group = tuple[np.ndarray, Model, float]


class Kept:
    """Runs, and the ledger that keeps them.

    Parameters
    ----------
    path : path, optional
        Of the ledger; without it nothing is kept.
    total : int
        Number of runs.
    waiting : callable, optional
        Called again and again while another process holds the ledger, instead of refusing it.

    Attributes
    ----------
    computed : int
        Runs that were made here.
    """

    def __init__(self, path: Path | None, total: int = 0, waiting: Callable[[], object] | None = None) -> None:
        self.path, self.computed = path, 0
        self._book = None if path is None else Ledger(path, KEY, total, waiting)

    def close(self) -> None:
        """Write what is open and let go of the ledger."""
        if self._book:
            self._book.close()

    def run(
        self, cases: Sequence[Case], digests: Digests, groups: Iterable[Group], *, tail: float, threads: int | None
    ) -> Generator[tuple[int, dict], None, None]:
        """(number, row) of every case: first those that the ledger holds, then the others as they finish.

        Cases with the same digest are run once.
        """
        todo = np.ones(len(digests), dtype=bool)
        if self.path is not None:
            for number, row in known(self.path, digests):
                todo[number] = False
                yield number, row
        todo[digests.doubles] = False
        for numbers, model, quiet in groups:
            left = numbers[todo[numbers]]
            if not len(left):
                continue
            some = Cases(len(left), lambda index, left=left: cases[int(left[index])])
            with closing(compute(some, model, tail=tail, quiet=quiet, threads=threads)) as finished:
                for index, measures in finished:
                    row, key = measures.row(), int(digests.keys[left[index]])
                    if self._book:
                        self._book.record(key, {"case": digests[left[index]], **row})
                    for number in digests.numbers(key):
                        self.computed += 1
                        yield number, row


def known(ledger: Path, digests: Digests) -> Iterator[tuple[int, dict[str, Any]]]:
    """(number, row) of the cases that a ledger holds; those of other studies and other laws in it are passed over."""
    for key, row in rows_in(ledger, KEY):
        digest = row.pop("case", None)
        for number in digests.numbers(key):
            if digest == digests[number]:
                yield number, row
