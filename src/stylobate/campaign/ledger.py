"""The ledger of a folder: its finished runs on disk, by numbers from the digests of their cases, for good.

An SQLite file in WAL mode. A thread of its own writes what has come in at least every half second, in transactions that
are open for no longer than the writing. One process at a time holds a ledger. Every row carries a checksum over its
number and itself.
"""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
import threading
import weakref
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import numpy as np

from ..atomic import replacing
from ..errors import InputError, StylobateError

#: File in an output folder that keeps finished runs, of whichever commands have made them.
RUNS_FILE = "runs.sqlite"

#: Files in which versions before this one kept the unfinished runs of a command, by their place in that command.
FORMER_FILES = "progress*.sqlite"

#: Note in a ledger on how its runs are told apart, and the seal that it gives to their checksums.
KEY = '{"keyed by": "digest of the case"}'
SEAL = hashlib.sha256(KEY.encode()).hexdigest()

#: Runs are on disk at most so long after they have finished [s]; what a killed campaign loses.
COMMIT_INTERVAL = 0.5

#: Runs that are written at once, however little time has passed.
BATCH = 5_000

#: Runs that may wait to be written; whoever has more waits as well.
MOST_WAITING = 20_000

#: Marks of a ledger among other SQLite files, and of its layout among others ("Styl", 2).
APPLICATION, LAYOUT = 0x5374796C, 2

#: Words of SQLite where it is not the file that is at fault.
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

#: Words of SQLite for a damaged file; its own words need not be text then.
_DAMAGE = sqlite3.Error, ValueError

#: A ledger and what SQLite keeps beside it.
ENDINGS = ("", "-wal", "-shm")

#: Ledgers in use, for an end without clean-up.
OPEN: weakref.WeakSet[Ledger] = weakref.WeakSet()


class Ledger:
    """Finished runs of a folder.

    Parameters
    ----------
    path : str or Path
        Made if it is not there.
    waiting : callable, optional
        Called again and again while another process holds the ledger, instead of refusing it.

    Raises
    ------
    InputError
        The folder holds the ledger of an earlier version, the file is damaged, a link or the database of another program,
        or another process holds it.
    StylobateError
        Nothing can be written there.
    """

    def __init__(self, path: str | Path, waiting: Callable[[], object] | None = None) -> None:
        self.path = Path(path)
        if self.path.is_dir() or not self.path.parent.is_dir():
            raise InputError(
                f"{self.path} cannot keep the progress: it is a folder, or has none; choose another folder."
            )
        refuse_foreign(self.path)
        refuse_former(*self.path.parent.glob(FORMER_FILES))
        self._holding = Holding(self.path, waiting)
        try:
            self._file = self._open()
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

    def record(self, number: int, row: Mapping[str, Any]) -> None:
        """Keep a finished run: it is on disk within :data:`COMMIT_INTERVAL`.

        Raises
        ------
        StylobateError
            An earlier one could not be written, e.g. because the disk is full.
        """
        self._check()
        with self._wake:
            self._pending.append((number, write_line(number, row)))
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
        """Write what is open and let go of the file; other runs can be added later.

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

    def _open(self) -> sqlite3.Connection:
        if not any(os.path.lexists(f"{self.path}{ending}") for ending in ENDINGS):
            try:
                with replacing(self.path) as partial:
                    create(partial)
            except (sqlite3.Error, OSError) as error:
                raise _cannot(self.path, str(error)) from None
        return connect(self.path)


def connect(path: Path) -> sqlite3.Connection:
    """Open a ledger and see that it is whole.

    Raises
    ------
    InputError
        It is damaged, no ledger, or that of an earlier version.
    StylobateError
        The system does not let it be used.
    """
    if not path.is_file() or path.stat().st_size == 0:
        raise _damaged(path, "it is empty" if path.exists() else "its main file is missing")
    file = _text_file(path, timeout=10.0, isolation_level=None, check_same_thread=False)
    try:
        _check(file, path)
        file.execute("PRAGMA journal_mode = WAL")
    except sqlite3.Error as error:
        file.close()
        if getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF in _SOUND_FILE:
            raise _cannot(path, str(error)) from None
        raise _damaged(path, str(error)) from None
    except UnicodeDecodeError as error:  # words of SQLite that are no text
        file.close()
        raise _damaged(path, str(error)) from None
    except BaseException:
        file.close()
        raise
    return file


def _check(file: sqlite3.Connection, path: Path) -> None:
    """Refuse a ledger that is not whole, or of an earlier version."""
    marks = [file.execute(f"PRAGMA {name}").fetchone()[0] for name in ("application_id", "user_version")]
    if marks != [APPLICATION, LAYOUT]:
        raise _damaged(path, "it was not written by this version of stylobate")
    if (check := file.execute("PRAGMA quick_check(1)").fetchone()[0]) != "ok":
        raise _damaged(path, " ".join(check.split()))
    keys = file.execute("SELECT key, sum FROM campaign").fetchall()
    if len(keys) != 1 or hashlib.sha256(str(keys[0][0]).encode()).hexdigest() != keys[0][1]:
        raise _damaged(path, "its first table is not whole")
    if keys[0][0] != KEY:
        raise _former(path)


def create(path: Path) -> None:
    """Write a new ledger; it is whole when this returns."""
    with closing(sqlite3.connect(path, isolation_level=None)) as file:
        file.execute(f"PRAGMA application_id = {APPLICATION}")
        file.execute(f"PRAGMA user_version = {LAYOUT}")
        file.execute("BEGIN")
        file.execute("CREATE TABLE campaign (key TEXT, sum TEXT)")
        file.execute("CREATE TABLE runs (number INTEGER PRIMARY KEY, line TEXT)")
        file.execute("INSERT INTO campaign VALUES (?, ?)", (KEY, SEAL))
        file.execute("COMMIT")


def write_line(number: int, row: Mapping[str, Any]) -> str:
    """A run as one line: checksum, number, row."""
    rest = f"{number} {json.dumps(row)}"
    return f"{_checksum(rest)} {rest}"


def read_line(number: int, line: Any) -> dict | None:
    """The row in the line of a run; None if the line is not whole, or that of another run."""
    checksum, _, rest = line.partition(" ") if isinstance(line, str) else ("", "", "")
    if checksum != _checksum(rest) or not rest.startswith(f"{number} "):
        return None
    return json.loads(rest.partition(" ")[2])


def _checksum(rest: str) -> str:
    return hashlib.sha256(f"{SEAL} {rest}".encode("utf-8", "surrogatepass")).hexdigest()[:16]


def _text_file(path: Path, mode: str = "", **options: Any) -> sqlite3.Connection:
    """A database whose texts may be damaged: checksums judge them, not the decoder."""
    place: Any = f"{path.absolute().as_uri()}?{mode}" if mode else path
    file = sqlite3.connect(place, uri=bool(mode), **options)
    file.text_factory = lambda data: data.decode("utf-8", "replace")
    return file


def _damaged(path: Path, why: str) -> InputError:
    return InputError(
        f"{path} keeps finished runs and is damaged, or no such file ({why}); it stays as it is: move it away, and the same "
        "command computes its runs anew, or choose another folder."
    )


def _cannot(path: Path, why: str) -> StylobateError:
    return StylobateError(f"the progress cannot be kept in {path} ({why}); make room there, or choose another folder.")


def refuse_foreign(path: Path) -> None:
    """Refuse what only has the name of a ledger: it is never set aside.

    Raises
    ------
    InputError
        The file is a link, or a whole database without the tables of a ledger.
    """
    what = "a link" if any(os.path.islink(f"{path}{ending}") for ending in ENDINGS) else ""
    with suppress(*_DAMAGE), closing(_untouched(path)) as file:
        tables = {name for (name,) in file.execute("SELECT name FROM sqlite_schema")}
        ours = {"campaign", "runs"} <= tables or file.execute("PRAGMA application_id").fetchone()[0] == APPLICATION
        if tables and not ours and file.execute("PRAGMA quick_check(1)").fetchone()[0] == "ok":
            what = what or "a database of another program"
    if what:
        raise InputError(f"{path} is {what}, and finished runs would be kept there; move it, or choose another folder.")


def refuse_former(*paths: Path) -> None:
    """Refuse ledgers of versions before this one.

    Raises
    ------
    InputError
        One of the files is such a ledger.
    """
    for path in paths:
        with suppress(OSError), path.open("rb") as file:
            if file.read(72)[68:] == APPLICATION.to_bytes(4) and _key_of(path) != KEY:
                raise _former(path)


def _former(path: Path) -> InputError:
    return InputError(
        f"{path} keeps unfinished runs of an earlier version, which this one cannot tell apart; finish them with that "
        "version, or choose another folder."
    )


def _key_of(path: Path) -> str | None:
    with suppress(*_DAMAGE), closing(_untouched(path)) as file:
        return next((key for (key,) in file.execute("SELECT key FROM campaign")), None)
    return None


def _untouched(path: Path) -> sqlite3.Connection:
    return _text_file(path, "mode=ro&immutable=1")  # leaves nothing beside it


def rows_in(path: str | Path, wanted: Callable[[int], object]) -> Iterator[tuple[int, dict]]:
    """(number, row) of the runs in a ledger whose numbers are wanted; another process may be at work on it.

    Rows without a valid checksum are left out; a file that is missing, or no ledger, holds none.
    """
    with closing(_opened(path)) as file, suppress(*_DAMAGE):
        for number, line in file.execute("SELECT number, line FROM runs ORDER BY number"):
            row = read_line(number, line) if wanted(number) else None
            if row is not None:
                yield number, row


def finished_runs_in(path: str | Path, wanted: np.ndarray | None = None) -> int:
    """Number of runs in a ledger, or of those wanted that it holds; 0 where there is none."""
    with closing(_opened(path)) as file, suppress(*_DAMAGE):
        numbers = np.fromiter((number for (number,) in file.execute("SELECT number FROM runs")), np.int64)
        return len(numbers) if wanted is None else int(np.isin(wanted, numbers).sum())
    return 0


def _opened(path: str | Path) -> sqlite3.Connection:
    """A ledger to be read; one without anything in it in place of a file that is missing, or no ledger."""
    place = Path(path).absolute()
    for access in ("mode=ro", "mode=ro&immutable=1"):  # the second where the folder cannot be written to either
        if place.is_file():
            file = _text_file(place, access)
            with suppress(*_DAMAGE):
                file.execute("SELECT number FROM runs LIMIT 1").fetchone()
                return file
            file.close()
    return sqlite3.connect(":memory:")


class Holding:
    """The hold of this process on a file, which the system lets go of however the process ends.

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
