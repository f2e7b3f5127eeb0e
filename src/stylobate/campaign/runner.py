"""A campaign: many cases through one model, with progress, interruption and resumption."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import __version__
from ..models.base import Case, Model
from ..simulate import simulate_iter
from .ledger import Ledger

#: Called with (finished runs, all runs) whenever a run finishes.
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class CampaignResult:
    """Rows of a campaign.

    Parameters
    ----------
    rows : list of dict or None
        One per case in their order, with the keys of ``Measures.row()``; None where the case was not run.
    interrupted : bool
        Whether the campaign was stopped (Ctrl-C) before its end.
    wall_time : float
        [s], of this call only.
    """

    rows: list[dict | None]
    interrupted: bool
    wall_time: float


def run_campaign(
    cases: Sequence[Case],
    model: Model,
    *,
    tail: float = 0.0,
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
    book = Ledger(ledger, _full_key(model, tail, key or {})) if ledger is not None else None
    rows: list[dict | None] = [None] * len(cases)
    done = 0
    for number, row in (book.rows() if book else {}).items():
        rows[number] = row
        done += 1
    todo = [number for number, row in enumerate(rows) if row is None]
    interrupted = False
    try:
        if progress:
            progress(done, len(cases))
        with closing(simulate_iter([cases[i] for i in todo], model, tail=tail, threads=threads)) as finished:
            for index, measures in finished:
                row = measures.row()
                rows[todo[index]] = row
                done += 1
                if book:
                    book.record(todo[index], row)
                if progress:
                    progress(done, len(cases))
    except KeyboardInterrupt:
        interrupted = True
    finally:
        if book:
            book.close()
    return CampaignResult(rows, interrupted, time.perf_counter() - started)


def _full_key(model: Model, tail: float, key: Mapping[str, Any]) -> dict[str, Any]:
    from ..kernels.jit import source_digest  # a resumed campaign never mixes two laws

    return {
        **key,
        "version": __version__,
        "kernels": source_digest(),
        "model": model.name,
        "parameters": model.parameters(),
        "tail": tail,
    }
