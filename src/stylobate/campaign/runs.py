"""Runs that are wanted: those that the ledger of a folder holds, whoever made them, and the others as they finish."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack, closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..atomic import digest as digest_of_file
from ..errors import InputError
from ..models import devices
from ..models.base import Case, Cases, Model, RunOptions
from ..models.engine import engine_for
from ..models.shared.ground import share_of
from ..response.measures import CPU, GPU
from ..response.rows import Rows
from ..simulate import check_cases, run_on_card
from .campaign import Campaign, Progress
from .cluster import computed_by, executor, on_cluster
from .digests import Digests, Hasher
from .ledger import Ledger, finished_runs_in, rows_in

#: Cases that run together: their numbers, their model, and how they are run.
Group = tuple[np.ndarray, Model, RunOptions]

#: (number of the run, its row).
Finished = Generator[tuple[int, dict[str, Any]], None, None]

_log = logging.getLogger("stylobate")

#: Time between two looks at a ledger that another process is at work on [s].
LOOK = 0.25


@dataclass(frozen=True, eq=False)
class Request:
    """Cases that are wanted.

    Parameters
    ----------
    cases : sequence of Case
        Asked for one by one, so that it can make them as they are needed.
    digests : Digests
        What decides each of them.
    groups : sequence of Group
        Together all cases.
    """

    cases: Sequence[Case]
    digests: Digests
    groups: Sequence[Group]
    _sound: bool = field(init=False, default=False)

    @classmethod
    def of(cls, cases: Sequence[Case], hasher: Hasher, quiet: float | None = 0.0) -> Request:
        """Cases of the model and the end of a hasher, of one share of quiet; None for the one that each has alone."""
        shares = np.array([share_of(case.motion) if quiet is None else quiet for case in cases])
        groups = [
            (np.flatnonzero(shares == share), hasher.model, replace(hasher.options, quiet=share))
            for share in np.unique(shares).tolist()
        ]
        return cls(cases, Digests(hasher.of_cases(cases, shares.tolist())), groups)

    def __len__(self) -> int:
        return len(self.cases)

    def check(self) -> None:
        """Refuse (InputError) or warn of any of the cases, finished or not, the first time that this is asked."""
        if not self._sound:
            for numbers, model, options in self.groups:
                check_cases(_some(self.cases, numbers), model, options)
            object.__setattr__(self, "_sound", True)


class Stopped(KeyboardInterrupt):
    """Runs were interrupted; the message says what is kept of them.

    Parameters
    ----------
    done, total : int
        Finished runs, and all.
    ledger : path, optional
        Where the finished ones are kept.
    rows : Rows, optional
        The finished ones.
    part : str
        What is kept of the run that was under way, in words.
    """

    def __init__(
        self, done: int, total: int, ledger: str | Path | None = None, rows: Rows | None = None, part: str = ""
    ) -> None:
        message = (
            f"interrupted after {done} of {total} runs; nothing is kept: with `out=DIR` it would go on from there."
        )
        if ledger is not None:
            kept = f"{done} of {total} runs are kept in {Path(ledger).parent}{part and f', and {part}'}"
            message = f"interrupted; {kept}: the same command goes on from there."
        super().__init__(message)
        self.rows, self.done, self.total = Rows(total) if rows is None else rows, done, total


class Runs:
    """Runs, and the ledger that keeps them.

    Parameters
    ----------
    campaign : Campaign
        Where they are computed and kept, and who is told.
    waiting : callable, optional
        Called again and again while another process holds the ledger, instead of refusing it.

    Attributes
    ----------
    made, kept : int
        Runs that were made here, and those of the requests that are finished, these among them.
    """

    def __init__(self, campaign: Campaign | None = None, waiting: Callable[[], object] | None = None) -> None:
        self.campaign = campaign = campaign or Campaign()
        self.path = None if campaign.ledger is None else Path(campaign.ledger)
        self.made = self.kept = 0
        self._book: Ledger | None = None
        self._waiting = waiting
        self._cluster, self._elsewhere = ExitStack(), False

    def open(self, *requests: Request) -> None:
        """Refuse or warn of requests, and only then take hold of the cluster and of the ledger."""
        for request in requests:
            request.check()
        if self.campaign.dask is not None and not self._elsewhere:
            self._cluster.enter_context(on_cluster(self.campaign.dask, self.campaign.threads, _log.info))
            self._elsewhere = True
        if self.campaign.device == GPU and not self._elsewhere:
            devices.gpu()
            self._cluster.enter_context(computed_by(run_on_card))
            self._elsewhere = True
        if self._book is None and self.path is not None:
            self._book = Ledger(self.path, self._waiting)

    def close(self) -> None:
        """Write what is open, and let go of the ledger and of the cluster."""
        with self._cluster:
            if self._book:
                self._book.close()

    def run(self, request: Request) -> Finished:
        """(number, row) of every case, with the keys of ``Measures.row()``: first those that the ledger holds.

        Cases with the same digest are run once.
        """
        self.open(request)
        digests = request.digests
        todo = np.ones(len(digests), dtype=bool)
        for number, row in self._known(digests):
            if not self.campaign.mix_devices:
                self._refuse_other_device(request, number, row.get("computed_by", CPU))
            todo[number] = False
            self.kept += 1
            yield number, row
        todo[digests.doubles] = False
        for numbers, model, options in request.groups:
            remaining = numbers[todo[numbers]]
            if len(remaining):
                with closing(
                    executor()(_some(request.cases, remaining), model, options, self.campaign.threads)
                ) as finished:
                    for index, measures in finished:
                        yield from self._keep(digests, int(remaining[index]), measures.row())

    def rows(self, request: Request, progress: Progress | None = None) -> Rows:
        """Rows of all cases; ``progress`` is called instead of that of the campaign.

        Raises
        ------
        Stopped
            Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
        """
        rows, progress = Rows(len(request)), progress or self.campaign.progress
        if progress:
            progress(0, len(request))
        try:
            with closing(self.run(request)) as finished:
                for done, (number, row) in enumerate(finished, 1):
                    rows[number] = row
                    if progress:
                        progress(done, len(request))
        except KeyboardInterrupt:
            done = rows.finished if self.path is None else self.kept
            raise Stopped(done, len(request), self.path, rows) from None
        return rows

    def products(self, request: Request, make: Callable[[int], dict[str, Any]], threads: int = 1) -> Finished:
        """(number, row) of runs that come to more than their measures, made one by one: first those that the ledger holds.

        Parameters
        ----------
        request : Request
            With digests of what decides each of them, see :meth:`~stylobate.campaign.digests.Hasher.of_product`.
        make : callable
            Makes the row of a number, of plain values; its ``files`` are names of files beside the ledger that belong to
            it: a row whose files are not as they were written is made again.
        threads : int
            At work at the same time, after the first run, which compiles what all of them share.
        """
        self.open(request)
        digests = request.digests
        todo = set(range(len(digests)))
        for number, row in self._known(digests):
            if all(self._sum_of(name) == written for name, written in row.get("files", {}).items()):
                todo.remove(number)
                self.kept += 1
                yield number, row
        todo.difference_update(digests.doubles.tolist())
        for number, row in _in_threads(make, sorted(todo), threads):
            files = {"files": {name: self._sum_of(name) for name in row["files"]}} if "files" in row else {}
            yield from self._keep(digests, number, row | files)

    def _refuse_other_device(self, request: Request, number: int, by: str) -> None:
        """Refuse a finished run that another kind of device has computed than computes now.

        Processors may have computed for a card: what it has no kernel for.

        Raises
        ------
        InputError
            It is such a run.
        """
        if by.partition(" ")[0] == self.campaign.device:
            return
        if self.campaign.device == GPU:
            model = next(model for numbers, model, _ in request.groups if number in numbers)
            if not engine_for(model, request.cases[number].column).on_card(devices.gpu()):
                return
        raise InputError(
            f"{self.path} keeps finished runs of this request that were computed by {by}, and `device` is "
            f"{self.campaign.device}: their last digits differ, and near the border so may verdicts. Choose another folder, "
            f"or give `mix_devices` to go on from them.",
            "device",
        )

    def _known(self, digests: Digests) -> Iterator[tuple[int, dict[str, Any]]]:
        if self.path is not None:
            yield from finished_rows(self.path, digests)

    def _keep(self, digests: Digests, number: int, row: dict[str, Any]) -> Finished:
        key = int(digests.keys[number])
        alike = digests.numbers(key)
        if self._book:
            self._book.record(key, {"case": digests[number], **row})
        self.made += len(alike)
        self.kept += len(alike)
        for case_number in alike:
            yield case_number, row

    def _sum_of(self, name: str) -> str | None:
        if self.path is None:
            return None
        place = self.path.parent / name
        return digest_of_file(place) if place.is_file() else None


def finished_rows(ledger: Path, digests: Digests) -> Iterator[tuple[int, dict[str, Any]]]:
    """(number, row) of the cases that a ledger holds; those of other requests and other laws in it are passed over."""
    for key, row in rows_in(ledger, digests.numbers):
        digest = row.pop("case", None)
        for number in digests.numbers(key):
            if digest == digests[number]:
                yield number, row


def _some(cases: Sequence[Case], numbers: np.ndarray) -> Cases:
    return Cases(len(numbers), lambda index: cases[int(numbers[index])])


def run_all(request: Request, campaign: Campaign | None = None) -> Rows:
    """Run what the ledger does not hold yet.

    Parameters
    ----------
    request : Request
    campaign : Campaign
        Where it is computed and kept, and who is told; what it says of columns and motions is in the request.

    Returns
    -------
    Rows
        One per case in their order, with the keys of ``Measures.row()``.

    Raises
    ------
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    with closing(Runs(campaign)) as runs:
        return runs.rows(request)


def its_turn(
    ledger: Path, digests: Digests, progress: Progress | None, waiting: Callable[[], None] | None
) -> Callable[[], None]:
    """Notice while another process is at work on the ledger: told once, and followed."""
    looks: list[bool] = []

    def look() -> None:
        if waiting and not looks:
            waiting()
        looks.append(True)
        started = time.perf_counter()
        if progress:
            progress(finished_runs_in(ledger, digests.keys), len(digests))
        time.sleep(max(LOOK, 4.0 * (time.perf_counter() - started)))  # counting a long ledger takes time of its own

    return look


def _in_threads(make: Callable[[int], dict[str, Any]], todo: list[int], threads: int) -> Finished:
    """Results as they are finished; the first one alone, which compiles what all of them share."""
    if threads == 1:
        yield from ((number, make(number)) for number in todo)
        return
    for number in todo[:1]:
        yield number, make(number)
    pool = ThreadPoolExecutor(threads)
    try:
        jobs = {pool.submit(make, number): number for number in todo[1:]}
        for job in as_completed(jobs):
            yield jobs[job], job.result()
    finally:
        pool.shutdown(cancel_futures=True)
