"""The engine of studies: runs what the ledger does not hold yet, and keeps each run as it finishes."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..models.base import Cases, Model
from ..response import Measures
from ..response.rows import Rows
from .cases import Study
from .executor import compute
from .ledger import Ledger, finished_runs_in
from .plan import KEY, RUNS_FILE, Plan
from .runner import Progress, Stopped

#: Time between two looks at a ledger that another process is at work on [s].
LOOK = 0.25


@dataclass(frozen=True, eq=False)
class StudyRows:
    """What a study came to.

    Parameters
    ----------
    plan : Plan
    rows : Rows
        One per case, with the keys of ``Measures.row()``.
    computed : int
        Runs that were made now; the others were in the ledger.
    wall_time : float
        [s], of this call.
    """

    plan: Plan
    rows: Rows
    computed: int
    wall_time: float


def run_cases(
    study: Study,
    folder: Path | None = None,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
    waiting: Callable[[], None] | None = None,
) -> StudyRows:
    """Run all cases that the ledger of a folder does not hold yet.

    One process at a time computes in a folder: it uses this machine's cores, and an SQLite ledger with several writers must
    not leave it. Another one waits, reads along, and goes on with what is missing when the first has ended or was killed.

    Parameters
    ----------
    study : Study
    folder : path, optional
        Keeps the plan and the finished runs, of this study and of those before it; without it nothing is kept.
    threads : int, optional
        All cores by default.
    progress : callable, optional
        Called with (finished, all).
    waiting : callable, optional
        Called once if another process is at work in the folder.

    Raises
    ------
    Stopped
        Interrupted (Ctrl-C); a KeyboardInterrupt that says what is kept.
    """
    started = time.perf_counter()
    plan = study.plan()
    book, done, first = None, 0, 0
    try:
        rows = Rows(len(plan))
        if folder is not None:
            turn = _its_turn(folder / RUNS_FILE, len(plan), progress, waiting)
            book = Ledger(folder / RUNS_FILE, KEY, len(plan), turn)
            plan.save(folder)
            rows = plan.known(folder / RUNS_FILE)
        done = first = rows.finished
        if progress:
            progress(done, len(plan))
        with closing(_runs(study, plan, rows, threads)) as finished:
            for number, measures in finished:
                row, key = measures.row(), int(plan.keys[number])
                if book:
                    book.record(key, {"case": plan.digest(number), **row})
                for same in plan.numbers(key):
                    rows[same] = row
                    done += 1
                if progress:
                    progress(done, len(plan))
    except KeyboardInterrupt:
        if book:
            book.close()
        raise Stopped(done, len(plan), None if folder is None else folder / RUNS_FILE) from None
    finally:
        if book:
            book.close()
    return StudyRows(plan, rows, done - first, time.perf_counter() - started)


def _its_turn(
    ledger: Path, total: int, progress: Progress | None, waiting: Callable[[], None] | None
) -> Callable[[], None]:
    """What is done while another process is at work on the ledger: it is told once, and followed."""
    told: list[bool] = []

    def look() -> None:
        if waiting and not told:
            waiting()
        told.append(True)
        if progress:
            progress(min(finished_runs_in(ledger), total), total)
        time.sleep(LOOK)

    return look


def _runs(study: Study, plan: Plan, rows: Rows, threads: int | None) -> Generator[tuple[int, Measures], None, None]:
    """(number of the case, measures) of what is not there yet; cases of one model and one share of quiet together."""
    todo = ~rows.made
    for key in np.unique(plan.keys[todo]) if len(np.unique(plan.keys)) < len(plan) else ():
        todo[plan.numbers(int(key))[1:]] = False  # the same case twice is run once
    each = len(plan) // len(study.models)
    motion = np.arange(len(plan)) // (study.shape[3] * study.shape[4]) % study.shape[2]
    for place, model in enumerate(study.models):
        for quiet in sorted(set(study.quiet.tolist())):
            those = np.flatnonzero(todo & (study.quiet[motion] == quiet))
            those = those[those // each == place]
            if len(those):
                yield from _some(study, those, model, quiet, threads)


def _some(
    study: Study, numbers: np.ndarray, model: Model, quiet: float, threads: int | None
) -> Generator[tuple[int, Measures], None, None]:
    cases = Cases(len(numbers), lambda index: study.case(int(numbers[index])))
    with closing(compute(cases, model, tail=study.tail, quiet=quiet, threads=threads)) as finished:
        for index, measures in finished:
            yield int(numbers[index]), measures
