"""A campaign: many cases through one model, with progress, interruption and resumption."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..models.base import Case, Model
from ..response import Measures
from ..response.rows import Rows
from ..version import __version__
from .executor import compute
from .ledger import Ledger, what_is_kept
from .others import Others

#: Called with (finished runs, all runs) whenever a run finishes.
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class CampaignResult:
    """Rows of a campaign.

    Parameters
    ----------
    rows : Rows
        One per case in their order, with the keys of ``Measures.row()``; None where the case was not run.
    interrupted : bool
        Whether the campaign was stopped (Ctrl-C) before its end.
    wall_time : float
        [s], of this call only.
    """

    rows: Rows
    interrupted: bool
    wall_time: float


def run_campaign(
    cases: Sequence[Case],
    model: Model,
    *,
    tail: float = 0.0,
    quiet: float = 0.0,
    threads: int | None = None,
    progress: Progress | None = None,
    ledger: str | Path | None = None,
    key: Mapping[str, Any] | None = None,
) -> CampaignResult:
    """Run all cases; an interrupt keeps what is finished.

    Parameters
    ----------
    cases : sequence of Case
    model : Model
    tail : float
        Time to go on after each motion has ended [s].
    quiet : float
        As for :func:`stylobate.simulate.simulate_iter`; part of the campaign's key.
    threads : int, optional
        All cores by default.
    progress : callable, optional
        Called with (finished, all).
    ledger : path, optional
        File that keeps finished runs; runs that it holds already are not computed again. It is left on disk: the
        caller removes it once the results are safe.
    key : mapping, optional
        What decides the results besides the version and the model's parameters, e.g. the column's digest.
    """
    started = time.perf_counter()
    rows = Rows(len(cases))
    done, interrupted = 0, False
    if progress:
        progress(0, len(cases))
    try:
        runs = finished_runs(cases, model, tail=tail, quiet=quiet, threads=threads, ledger=ledger, key=key)
        with closing(runs) as finished:
            for number, row in finished:
                rows[number] = row
                done += 1
                if progress:
                    progress(done, len(cases))
    except KeyboardInterrupt:
        interrupted = True
    return CampaignResult(rows, interrupted, time.perf_counter() - started)


def finished_runs(
    cases: Sequence[Case],
    model: Model,
    *,
    tail: float = 0.0,
    quiet: float = 0.0,
    threads: int | None = None,
    ledger: str | Path | None = None,
    key: Mapping[str, Any] | None = None,
    keep: Callable[[Measures], dict] = Measures.row,
) -> Generator[tuple[int, dict], None, None]:
    """Yield (number of the case, what is kept of it): first the runs that the ledger holds, then the others.

    Parameters
    ----------
    cases : sequence of Case
        Asked for one by one, so that it can make them as they are needed.
    model, tail, quiet, threads, ledger, key
        As in :func:`run_campaign`.
    keep : callable
        What of a run goes into the ledger and to the caller.
    """
    decisive = {**(key or {}), "quiet": quiet}
    book = Ledger(ledger, full_key(model, tail, decisive), len(cases)) if ledger is not None else None
    try:
        others = Others(cases)
        for number, row in book.rows() if book else ():
            if others.leave_out(number):
                yield number, row
        with closing(compute(others, model, tail=tail, quiet=quiet, threads=threads)) as finished:
            for index, measures in finished:
                number, row = others.number(index), keep(measures)
                if book:
                    book.record(number, row)
                yield number, row
    finally:
        if book:
            book.close()


class Stopped(KeyboardInterrupt):
    """A campaign was interrupted; the message says what is kept of it.

    Parameters
    ----------
    done, total : int
        Finished runs, and all.
    *ledgers : path
        Where the finished ones are kept.
    """

    def __init__(self, done: int, total: int, *ledgers: str | Path | None) -> None:
        super().__init__(what_is_kept(done, total, *ledgers))


def full_key(model: Model, tail: float, key: Mapping[str, Any]) -> dict[str, Any]:
    """Everything that decides the results of a campaign: its own key, the model, the version and the laws."""
    from ..kernels.jit import source_digest  # a resumed campaign never mixes two laws

    return {
        **key,
        "version": __version__,
        "kernels": source_digest(),
        "model": model.name,
        "parameters": model.parameters(),
        "tail": tail,
    }
