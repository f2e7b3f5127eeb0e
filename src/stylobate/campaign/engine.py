"""The engine of studies: runs what the ledger does not hold yet, and keeps each run as it finishes."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from ..models.base import Cases
from ..response.rows import Rows
from .cases import Study
from .kept import Kept
from .ledger import finished_runs_in
from .plan import RUNS_FILE, Plan
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
    ledger = None if folder is None else folder / RUNS_FILE
    rows = Rows(len(plan))
    turn = None if ledger is None else _its_turn(ledger, len(plan), progress, waiting)
    try:
        with closing(Kept(ledger, len(plan), turn)) as kept:
            if folder is not None:
                plan.save(folder)
            cases = Cases(len(plan), study.case)
            runs = kept.run(cases, plan.digests, study.groups(), tail=study.tail, threads=threads)
            with closing(runs) as finished:
                for done, (number, row) in enumerate(finished, 1):
                    rows[number] = row
                    if progress:
                        progress(done, len(plan))
    except KeyboardInterrupt:
        raise Stopped(rows.finished, len(plan), ledger) from None
    return StudyRows(plan, rows, kept.computed, time.perf_counter() - started)


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
