"""The process of jobs: it takes them as lines of JSON, and says in such lines what becomes of them."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from .folder import private_file

#: Time that a process has to stop by itself when it is told to [s].
PATIENCE = 3.0

#: Priority of a process that is to stop: another one has taken over, and somebody waits for that.
LAST = 19


class Process:
    """A process that does jobs, heard by a thread of its own.

    Parameters
    ----------
    command : sequence of str
        Its command line.
    log : Path
        Takes what it says beside its lines.
    heard : callable
        Called when it has become ready.
    """

    def __init__(self, command: Sequence[str], log: Path, heard: Callable[[], None]) -> None:
        with open(log, "ab", opener=private_file) as file:
            self._process = subprocess.Popen(
                list(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=file, text=True, encoding="utf-8",
                bufsize=1, start_new_session=True,
            )  # fmt: skip
        self.ready = False
        self._told = False
        self._heard = heard
        self._said: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._listen, name="process", daemon=True)
        self._thread.start()

    @property
    def over(self) -> bool:
        """Whether it has ended, or has been told to: it takes no more jobs."""
        return self._told or self._process.poll() is not None

    def give(self, job: dict[str, Any]) -> None:
        """Hand it a job; where it has ended meanwhile, :meth:`says` ends at once."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(json.dumps(job) + "\n")

    def says(self) -> Iterator[dict[str, Any]]:
        """Words of the process, until it ends or is told to."""
        while (what := self._said.get()) is not None:
            yield what

    def end(self) -> int:
        """Its code, when it has ended."""
        return self._process.wait()

    def tell(self) -> None:
        """Tell it to stop, and let it stand back meanwhile; nothing more is heard of it."""
        self._told = True
        self._process.terminate()
        with suppress(OSError, AttributeError):  # it has ended, or this system has no such thing
            os.setpriority(os.PRIO_PGRP, self._process.pid, LAST)
        self._said.put(None)

    def stop(self) -> None:
        """Tell it to stop, and wait until it has."""
        self.tell()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def put_away(self) -> None:
        """Stop it, and close what leads to it."""
        self.stop()
        self._thread.join()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        with suppress(ValueError):  # its lines are closed
            for line in self._process.stdout:
                self._take(line)
        self._said.put(None)

    def _take(self, line: str) -> None:
        try:
            what = json.loads(line)
        except ValueError:
            return
        if not isinstance(what, dict):
            return
        if what.get("ready"):
            self.ready = True
            self._heard()
        else:
            self._said.put(what)
