"""The ledger of a campaign: finished runs on disk, so that a campaign that was stopped goes on where it was.

An SQLite file in WAL mode. A thread of its own writes what has come in at least every half second, in transactions that
are open for no longer than the writing. One process at a time holds a ledger. Every row carries a checksum over its
campaign, its number and itself.
"""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
import threading
import warnings
import weakref
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from ..atomic import replacing, set_aside
from ..errors import DamagedFileWarning, InputError, StylobateError
from . import salvage
from .holding import Holding

#: File in an output folder that keeps finished runs until the results are written.
PROGRESS_FILE = "progress.sqlite"

#: Runs are on disk at most so long after they have finished [s]; what a killed campaign loses.
COMMIT_INTERVAL = 0.5

#: Runs that are written at once, however little time has passed.
BATCH = 5_000

#: Runs that may wait to be written; whoever has more waits as well.
MOST_WAITING = 20_000

#: What tells a ledger from other SQLite files, and its layout from others ("Styl", 2).
APPLICATION, LAYOUT = 0x5374796C, 2

#: What SQLite says where it is not the file that is at fault.
_SOUND_FILE = (
    sqlite3.SQLITE_BUSY,
    sqlite3.SQLITE_LOCKED,
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_PERM,
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_CANTOPEN,
    sqlite3.SQLITE_NOMEM,
)

#: A ledger and what SQLite keeps beside it.
ENDINGS = ("", "-wal", "-shm")

#: Ledgers in use, for an end without clean-up.
OPEN: weakref.WeakSet[Ledger] = weakref.WeakSet()


class Ledger:
    """Finished runs of one campaign.

    Parameters
    ----------
    path : str or Path
        Made if it is not there. A file that is damaged, or no ledger, is set aside under a new name with a warning;
        rows of this campaign that are whole in it are taken over.
    key : mapping
        Everything that decides the results. A ledger with another key belongs to another campaign and is refused.
    total : int
        Number of runs of the campaign.
    waiting : callable, optional
        Called again and again while another process holds the ledger, instead of refusing it.

    Raises
    ------
    InputError
        The file is the ledger of another campaign, another process holds it, or nothing can be written there.
    """

    def __init__(
        self, path: str | Path, key: Mapping[str, Any], total: int = 0, waiting: Callable[[], object] | None = None
    ) -> None:
        self.path, self.total = Path(path), total
        text = json.dumps(key, sort_keys=True, default=str)
        self.campaign = hashlib.sha256(text.encode()).hexdigest()
        if self.path.is_dir() or not self.path.parent.is_dir():
            raise InputError(
                f"{self.path} cannot keep the progress: it is a folder, or has none; choose another --out."
            )
        self._holding = Holding(self.path, waiting)
        try:
            self._file, found = self._open(text)
            if found != text:
                self._file.close()
                raise InputError(
                    f"{self.path} keeps the unfinished runs of another campaign (or of another version); finish that one "
                    "with its own command, or choose another folder."
                )
        except BaseException:
            self._holding.release()
            raise
        self.finished = self._file.execute("SELECT count(*) FROM runs").fetchone()[0]
        self._lock, self._wake = threading.Lock(), threading.Condition()
        self._pending: list[tuple[int, str]] = []
        self._failure: Exception | None = None
        self._closing = False
        self._writer = threading.Thread(target=self._write_in_time, name="ledger", daemon=True)
        self._writer.start()
        OPEN.add(self)

    def rows(self) -> Iterator[tuple[int, dict]]:
        """(number, row) of the finished runs, those without a valid checksum left out."""
        with closing(sqlite3.connect(self.path)) as file:  # a second connection: the writer is not disturbed
            file.text_factory = salvage.text
            for (line,) in file.execute("SELECT line FROM runs ORDER BY number"):
                if (found := salvage.read_line(line, self.campaign)) is not None:
                    yield found

    def record(self, number: int, row: Mapping[str, Any]) -> None:
        """Keep a finished run: it is on disk within :data:`COMMIT_INTERVAL`.

        Raises
        ------
        StylobateError
            An earlier one could not be written, e.g. because the disk is full.
        """
        self._check()
        with self._wake:
            self._pending.append((number, salvage.write_line(number, row, self.campaign)))
            waiting = len(self._pending)
            self._wake.notify()
        if waiting > MOST_WAITING:  # a slow disk is waited for
            self.flush()

    def flush(self) -> None:
        """Write what has come in, now."""
        with self._lock:
            with self._wake:
                rows, self._pending = self._pending, []
            if not rows or self._failure is not None:
                return
            try:
                with self._file:  # one transaction
                    self._file.execute("BEGIN IMMEDIATE")
                    self._file.executemany("INSERT OR REPLACE INTO runs VALUES (?, ?)", rows)
                self.finished += len(rows)
            except sqlite3.Error as error:
                self._failure = error

    def close(self) -> None:
        """Write what is open and let go of the file; the campaign can go on from here later.

        Raises
        ------
        StylobateError
            Something could not be written.
        """
        if self._closing:
            return
        with self._wake:
            self._closing = True
            self._wake.notify()
        self._writer.join()
        self.flush()
        OPEN.discard(self)
        self._file.close()
        self._holding.release()
        self._check()

    def _write_in_time(self) -> None:
        while not self._closing:
            with self._wake:
                self._wake.wait_for(lambda: self._closing or self._pending)
                self._wake.wait_for(lambda: self._closing or len(self._pending) >= BATCH, COMMIT_INTERVAL)
            self.flush()

    def _check(self) -> None:
        if self._failure is not None:
            raise StylobateError(
                f"the progress cannot be written to {self.path} ({self._failure}); {self.finished} finished runs are kept "
                "there: make room, and the same command goes on from them."
            )

    def _open(self, text: str) -> tuple[sqlite3.Connection, str]:
        taken: list[tuple[int, str]] = []
        if any(os.path.lexists(f"{self.path}{ending}") for ending in ENDINGS):
            try:
                return connect(self.path)
            except Damaged as damage:
                try:
                    aside = set_aside(self.path, ENDINGS)
                except OSError as error:
                    raise _cannot(self.path, error.strerror or str(error)) from None
                taken = salvage.whole_lines(aside, self.campaign)
                kept = (
                    f"{len(taken)} of its finished runs are whole and are used" if taken else "no run in it is of use"
                )
                said = f"{self.path} is damaged or no ledger ({damage}); it is kept as {aside.name}, and {kept}."
                warnings.warn(said, DamagedFileWarning, stacklevel=2)
        try:
            with replacing(self.path) as partial:
                create(partial, text, taken)
            return connect(self.path)
        except (sqlite3.Error, Damaged, OSError) as error:
            raise _cannot(self.path, str(error)) from None


class Damaged(Exception):
    """A file is no whole ledger; the message says why."""


def connect(path: Path) -> tuple[sqlite3.Connection, str]:
    """Open a ledger and see that it is whole; returns it with the key of its campaign as a text.

    Raises
    ------
    Damaged
        It is not whole, or no ledger.
    StylobateError
        The system does not let it be used.
    """
    if not path.exists():
        raise Damaged("its main file is missing")
    if path.stat().st_size == 0:
        raise Damaged("it is empty")
    file = sqlite3.connect(path, timeout=10.0, isolation_level=None, check_same_thread=False)
    file.text_factory = salvage.text
    try:
        marks = [file.execute(f"PRAGMA {name}").fetchone()[0] for name in ("application_id", "user_version")]
        if marks != [APPLICATION, LAYOUT]:
            raise Damaged("it was not written by this version of stylobate")
        if (said := file.execute("PRAGMA quick_check(1)").fetchone()[0]) != "ok":
            raise Damaged(" ".join(said.split()))
        file.execute("PRAGMA journal_mode = WAL")
        found = file.execute("SELECT key, sum FROM campaign").fetchall()
        file.execute("SELECT number, line FROM runs LIMIT 1").fetchall()
        if len(found) != 1 or hashlib.sha256(str(found[0][0]).encode()).hexdigest() != found[0][1]:
            raise Damaged("the name of its campaign is not whole")
        return file, found[0][0]
    except sqlite3.Error as error:
        file.close()
        if getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF in _SOUND_FILE:
            raise _cannot(path, str(error)) from None
        raise Damaged(str(error)) from None
    except ValueError as error:  # SQLite returned bytes that are not text
        file.close()
        raise Damaged(str(error)) from None
    except BaseException:
        file.close()
        raise


def create(path: Path, key: str, lines: list[tuple[int, str]]) -> None:
    """Write a new ledger; it is whole when this returns."""
    file = sqlite3.connect(path, isolation_level=None)
    try:
        file.execute(f"PRAGMA application_id = {APPLICATION}")
        file.execute(f"PRAGMA user_version = {LAYOUT}")
        file.execute("BEGIN")
        file.execute("CREATE TABLE campaign (key TEXT, sum TEXT)")
        file.execute("CREATE TABLE runs (number INTEGER PRIMARY KEY, line TEXT)")
        file.execute("INSERT INTO campaign VALUES (?, ?)", (key, hashlib.sha256(key.encode()).hexdigest()))
        file.executemany("INSERT OR REPLACE INTO runs VALUES (?, ?)", lines)
        file.execute("COMMIT")
    finally:
        file.close()


def _cannot(path: Path, why: str) -> StylobateError:
    return StylobateError(f"the progress cannot be kept in {path} ({why}); make room there, or choose another --out.")


def rows_in(path: str | Path, key: Mapping[str, Any]) -> Iterator[tuple[int, dict]]:
    """(number, row) of the finished runs of a campaign in a ledger that another process may be at work on.

    Rows without a valid checksum are left out; a file that is missing, or no ledger, holds none.
    """
    campaign = hashlib.sha256(json.dumps(key, sort_keys=True, default=str).encode()).hexdigest()
    if not Path(path).is_file():
        return
    place = Path(path).absolute().as_uri()
    for access in ("mode=ro", "mode=ro&immutable=1"):  # the second where the folder cannot be written to either
        with suppress(sqlite3.Error), closing(sqlite3.connect(f"{place}?{access}", uri=True)) as file:
            file.text_factory = salvage.text
            for (line,) in file.execute("SELECT line FROM runs ORDER BY number"):
                if (found := salvage.read_line(line, campaign)) is not None:
                    yield found
            return


def finished_runs_in(path: str | Path) -> int:
    """Number of runs that a ledger holds; 0 where there is none."""
    try:
        file = sqlite3.connect(f"{Path(path).absolute().as_uri()}?mode=ro", uri=True)
    except sqlite3.Error:
        return 0
    try:
        return file.execute("SELECT count(*) FROM runs").fetchone()[0]
    except sqlite3.Error:
        return 0
    finally:
        file.close()


def what_is_kept(done: int, total: int, *ledgers: str | Path | None) -> str:
    """The sentence after an interrupt; what the ledgers hold counts, not what was reported last."""
    kept = [Path(one) for one in ledgers if one is not None]
    if not kept:
        return f"interrupted after {done} of {total} runs; nothing is kept: with --out DIR it would go on from there."
    done = sum(finished_runs_in(one) for one in kept)
    return f"interrupted; {done} of {total} runs are kept in {kept[0].parent}: the same command goes on from there."


def discard(path: str | Path) -> None:
    """Delete a ledger: the campaign is over and its results are elsewhere.

    What is no ledger of this package, or is held by another process, stays.
    """
    place = Path(path)
    if not place.is_file() or place.is_symlink():
        return
    try:
        holding = Holding(place)
    except StylobateError:
        return
    try:
        connect(place)[0].close()
    except (Damaged, StylobateError):
        return
    else:
        for ending in reversed(ENDINGS):
            Path(f"{place}{ending}").unlink(missing_ok=True)
    finally:
        holding.release()
