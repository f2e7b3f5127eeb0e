"""Progress of work in many pieces."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def stages() -> Iterator[Callable[[str, int, int], None]]:
    """For work in many pieces, named "kind: piece": a bar with the remaining time of the piece on standard error, or a line
    per kind if that is no terminal.
    """
    if sys.stderr.isatty():
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (
            TimeRemainingColumn(),
            BarColumn(bar_width=20),
            MofNCompleteColumn(),
            TextColumn("{task.description}"),
        )
        with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("")

            def advance(what: str, done: int, total: int) -> None:
                if bar.tasks[0].description != what:
                    bar.reset(task, description=what)  # its speed is another one
                bar.update(task, completed=done, total=total or None)

            yield advance
        return
    seen: list[str] = []

    def line(what: str, _: int, __: int) -> None:
        kind = what.split(":")[0]
        if [kind] != seen:
            seen[:] = [kind]
            print(f"{kind} ...", file=sys.stderr, flush=True)

    yield line
