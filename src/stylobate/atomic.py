"""Files appear whole or not at all: written under a temporary name beside their place, then renamed."""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import re
import secrets
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path

from .errors import InputError, StylobateError, check_kind

# Files of this package in a folder: the list of those that it may replace or remove.
#
# A folder of results holds a list, ``.stylobate-files``: a line per file, its SHA-256 and its name. A file that is not on
# the list, or has changed since, belongs to somebody else: it is never replaced and never removed.

#: Name of the list in the folder.
LIST = ".stylobate-files"

_ACTIVE: ContextVar[tuple[OwnFiles, ...]] = ContextVar("_ACTIVE", default=())


class OwnFiles:
    """The list of one folder.

    Parameters
    ----------
    folder : path
        The list covers the folders in it as well; links to elsewhere are not followed.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(os.path.abspath(folder))
        self.kind = ""
        self._known: dict[str, set[str]] = {}
        self._read()

    def __iter__(self) -> Iterator[Path]:
        return (self.folder / name for name in self._known)

    def lists(self, path: Path) -> bool:
        """Whether a file of this name was written here, whatever it holds now."""
        return self._name(path) in self._known

    def holds(self, path: Path) -> bool:
        """Whether the file is there as it was written."""
        if path.is_symlink() or not path.is_file() or self._link(path) is not None:
            return False
        return self._is_own(path) or (self._read() and self._is_own(path))

    def check(self, path: Path) -> None:
        """Refuse to write over what is not our own.

        Raises
        ------
        InputError
            Something is there that this package did not write, or has been changed since, or a link leads elsewhere.
        """
        link = self._link(path)
        if link is not None:
            raise InputError(f"{link} is a link to another folder, in which nothing is written; choose another `out`.")
        if os.path.lexists(path) and not self.holds(path):
            changed = "was changed after stylobate wrote it" if self.lists(path) else "was not written by stylobate"
            raise InputError(f"{path} is there already and {changed}; choose another folder, or move it away.")

    def claim(self, kind: str) -> None:
        """Say what the folder is for."""
        self.kind = kind
        self._append(f"kind  {kind}")

    def add(self, path: Path, content: Path) -> None:
        """List a file before it appears under its name; ``content`` is where it lies until then."""
        checksum = digest(content)
        if checksum not in self._known.setdefault(self._name(path), set()):
            self._append(f"{checksum}  {self._name(path)}")
            self._known[self._name(path)].add(checksum)

    def remove(self, path: Path) -> None:
        """Remove a file if it is there as it was written; leave it otherwise."""
        if self.holds(path):
            path.unlink(missing_ok=True)

    def covers(self, path: Path) -> bool:
        """Whether the path lies in this folder."""
        return Path(os.path.abspath(path)).is_relative_to(self.folder)

    def _name(self, path: Path) -> str:
        return Path(os.path.abspath(path)).relative_to(self.folder).as_posix()

    def _link(self, path: Path) -> Path | None:
        """The folder on the way to the path that is a link, if there is one."""
        way = Path(os.path.abspath(path)).relative_to(self.folder).parents
        return next((self.folder / parent for parent in list(way)[:-1] if (self.folder / parent).is_symlink()), None)

    def _is_own(self, path: Path) -> bool:
        return self.lists(path) and digest(path) in self._known[self._name(path)]

    def _read(self) -> bool:
        """Read the list, to which another process at work in the folder may have added; whether there was anything new."""
        before = sum(map(len, self._known.values()))
        for line in self._lines():
            first, _, name = line.partition("  ")
            if first == "kind":
                self.kind = name
            elif len(first) == 64:
                self._known.setdefault(name, set()).add(first)
        return sum(map(len, self._known.values())) > before

    def _lines(self) -> list[str]:
        place = self.folder / LIST
        if place.is_symlink() or not place.is_file():
            return []
        return place.read_bytes().decode("utf-8", "surrogateescape").split("\n")

    def _append(self, line: str) -> None:
        place = self.folder / LIST
        if place.is_symlink() or (place.exists() and not place.is_file()):
            raise InputError(f"{place} is not a list of stylobate's files; choose another folder.")
        # A line of its own also after one that was cut short.
        text = f"\n{line}\n".encode("utf-8", "surrogateescape")
        handle = os.open(place, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        try:
            os.write(handle, text)
        finally:
            os.close(handle)


@contextmanager
def own_files(folder: str | Path, writes: Iterable[str] = ()) -> Iterator[OwnFiles]:
    """Guard a folder: what is written in it inside the block is listed, and replaces only what is on the list.

    Parameters
    ----------
    folder : path
    writes : iterable of str
        Names that will be written: one that is somebody else's is refused at once.

    Raises
    ------
    InputError
        A file that would be written is there already and is not our own.
    """
    active = _ACTIVE.get()
    inner = active[-1] if active else None
    guard = inner if inner is not None and inner.folder == Path(os.path.abspath(folder)) else OwnFiles(folder)
    for name in writes:
        guard.check(guard.folder / name)
    token = _ACTIVE.set((*active, guard))
    try:
        yield guard
    finally:
        _ACTIVE.reset(token)


def guard_of(path: Path) -> OwnFiles | None:
    """The innermost guarded folder that the path lies in."""
    return next((guard for guard in reversed(_ACTIVE.get()) if guard.covers(path)), None)


def digest(path: Path) -> str:
    """SHA-256 of a file's content."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


#: Errors of a system where a disk, or somebody's share of it, is full.
_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)

#: Temporary files of this process, which an end without clean-up removes.
PARTIAL: set[Path] = set()


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a temporary path that takes the place of ``path`` when the block ends well, and vanishes otherwise.

    Temporary files that killed processes of this machine left for the same ``path`` are removed.

    Parameters
    ----------
    path : str or Path
        The file to be; one that is there already is replaced. In an output folder of a command (:func:`output_folder`)
        only a file that this package wrote there is.

    Raises
    ------
    InputError
        The folder of ``path`` is missing or cannot be written to, or ``path`` is somebody else's.
    StylobateError
        The disk is full.
    """
    target = Path(check_kind("path", path, (str, os.PathLike)))
    if not target.parent.is_dir():
        raise InputError(f"{target} cannot be written: folder {target.parent} does not exist; create it first.")
    if target.is_dir():
        raise InputError(f"{target} cannot be written: it is a folder; name a file in it.")
    guard = guard_of(target)
    if guard is not None:
        guard.check(target)
    _remove_left(target)
    partial = target.with_name(_partial_name(target, str(os.getpid()), secrets.token_hex(4)))
    PARTIAL.add(partial)
    try:
        try:
            os.close(os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
        except OSError as error:
            raise InputError(f"{target} cannot be written: {error.strerror}; choose another folder.") from None
        try:
            yield partial
            if guard is not None:
                guard.add(target, partial)
            os.replace(partial, target)
        except OSError as error:
            if error.errno not in _NO_ROOM:
                raise
            raise StylobateError(
                f"{target} cannot be written: {error.strerror}; nothing is left of it: make room, or choose another folder."
            ) from None
    finally:
        partial.unlink(missing_ok=True)
        PARTIAL.discard(partial)


@contextmanager
def output_folder(path: str | Path, writes: Iterable[str] = ()) -> Iterator[Path]:
    """Make sure that a folder is there and can be written to, before anything is computed for it.

    What is written there replaces only what this package wrote (:mod:`stylobate.atomic`). A folder that was made here
    is removed again if the block fails and left nothing in it.

    Parameters
    ----------
    path : str or Path
    writes : iterable of str
        Names of the files to be.

    Raises
    ------
    InputError
        The folder cannot be made or written to, or one of the files to be is there and is somebody else's.
    """
    folder = Path(path)
    made = [ancestor for ancestor in (folder, *folder.parents) if not ancestor.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        why = error.strerror or str(error)
        raise InputError(f"output folder {folder} cannot be written to: {why}; choose another one.") from None
    try:
        with own_files(folder, writes):
            yield folder
    except BaseException:
        with suppress(OSError):  # not empty: something finished is kept
            for directory in made:
                directory.rmdir()
        raise


def set_aside(path: Path, endings: Iterable[str] = ("",)) -> Path:
    """Give a file a name under which nothing is yet, and return it.

    Parameters
    ----------
    path : path
    endings : iterable of str
        Files that belong to it, as endings of its name; all that are there go along.
    """
    number = 1
    while any(os.path.lexists(f"{path}.damaged-{number}{ending}") for ending in endings):
        number += 1
    new = path.with_name(f"{path.name}.damaged-{number}")
    for ending in endings:
        if os.path.lexists(f"{path}{ending}"):
            os.rename(f"{path}{ending}", f"{new}{ending}")
    return new


def _partial_name(target: Path, process: str, token: str) -> str:
    """Temporary name beside a file: whose process on which machine writes it, and that it is ours."""
    return f".{target.stem[:40]}.{process}-{token}@{platform.node()[:30]}.stylobate{target.suffix[:20]}"


def _remove_left(target: Path) -> None:
    start, middle, end = map(re.escape, _partial_name(target, "\0", "\0").split("\0"))
    pattern = re.compile(rf"{start}(\d{{1,9}}){middle}[0-9a-f]{{8}}{end}")
    with suppress(OSError):
        for path in target.parent.iterdir():
            match = pattern.fullmatch(path.name)
            if match and not path.is_symlink() and not _is_running(int(match[1])):
                path.unlink(missing_ok=True)


def _is_running(process: int) -> bool:
    if os.name == "nt":  # there a signal of number 0 is no question but a Ctrl-C
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


def refuse_existing(path: Path) -> None:
    """Refuse to write where something is.

    Raises
    ------
    InputError
    """
    if path.exists() or path.is_symlink():
        raise InputError(f"{path} is there already; choose another name.", "to")
