"""Files of this package in a folder: the list of those that it may replace or remove.

A folder of results holds a list, ``.stylobate-files``: a line per file, its SHA-256 and its name. A file that is not on
the list, or has changed since, belongs to somebody else: it is never replaced and never removed.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from .errors import InputError

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
        found = digest(content)
        if found not in self._known.setdefault(self._name(path), set()):
            self._append(f"{found}  {self._name(path)}")
            self._known[self._name(path)].add(found)

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
        return next((self.folder / one for one in list(way)[:-1] if (self.folder / one).is_symlink()), None)

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
    found = inner if inner is not None and inner.folder == Path(os.path.abspath(folder)) else OwnFiles(folder)
    for name in writes:
        found.check(found.folder / name)
    token = _ACTIVE.set((*active, found))
    try:
        yield found
    finally:
        _ACTIVE.reset(token)


def guard_of(path: Path) -> OwnFiles | None:
    """The innermost guarded folder that the path lies in."""
    return next((one for one in reversed(_ACTIVE.get()) if one.covers(path)), None)


def digest(path: Path) -> str:
    """SHA-256 of a file's content."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
