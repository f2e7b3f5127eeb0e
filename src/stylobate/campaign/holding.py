"""One process at a time: the hold on a ledger, which the system lets go of however the process ends."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from ..errors import InputError, StylobateError


class Holding:
    """The hold of this process on a file.

    SQLite's lock on an empty file beside it: there on every system, and gone with the process.

    Parameters
    ----------
    path : path
        What is held; the empty file is called the same with ``-lock`` behind.
    waiting : callable, optional
        Called again and again while another process holds it, until that one lets go or ends; it takes the time between two
        looks.

    Raises
    ------
    InputError
        Another process holds it, and nobody wants to wait.
    StylobateError
        The system does not let it be held, e.g. because the disk is full.
    """

    def __init__(self, path: Path, waiting: Callable[[], object] | None = None) -> None:
        self.path, self.place = path, Path(f"{path}-lock")
        while True:
            before = self._inode() or self._made()
            self._file = sqlite3.connect(self.place, timeout=0.0, isolation_level=None, check_same_thread=False)
            try:
                self._file.execute("BEGIN EXCLUSIVE")
            except sqlite3.Error as error:
                self._file.close()
                if "locked" not in str(error):
                    raise StylobateError(
                        f"the progress cannot be kept in {path} ({error}); make room there, or choose another folder."
                    ) from None
                if waiting is None:
                    raise InputError(
                        f"{path} is not free: another process is at work on it; wait for its end, or choose another folder."
                    ) from None
                waiting()
                continue
            if before is not None and before == self._inode():
                return
            self._file.close()  # the other process removed it in between: this lock would be on a deleted file

    def release(self) -> None:
        """Let go."""
        with suppress(OSError):
            if self.place.stat().st_size == 0:
                self.place.unlink()
        self._file.close()

    def _made(self) -> int | None:
        # Opened only where it is new: a process that closes a file loses all its locks on it.
        with suppress(FileExistsError):
            os.close(os.open(self.place, os.O_RDONLY | os.O_CREAT | os.O_EXCL, 0o666))
        return self._inode()

    def _inode(self) -> int | None:
        try:
            return self.place.stat().st_ino
        except OSError:
            return None


def refuse_held(path: Path) -> None:
    """Refuse (InputError) a file that another process holds, before anything is computed for it."""
    if Path(f"{path}-lock").exists():
        Holding(path).release()
