"""Files appear whole or not at all: written under a temporary name beside their place, then renamed."""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import secrets
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import InputError, StylobateError, check_kind
from .own_files import guard_of, own_files

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
    partial = target.with_name(_partial_name(target, os.getpid(), secrets.token_hex(4)))
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

    What is written there replaces only what this package wrote (:mod:`stylobate.own_files`). A folder that was made here
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
    made = [one for one in (folder, *folder.parents) if not one.exists()]
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
            for one in made:
                one.rmdir()
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


def _partial_name(target: Path, process: int, token: str) -> str:
    # The seal tells our own from any other hidden file: it stands for this machine, the process and the whole name.
    seal = hashlib.sha256(os.fsencode(f"stylobate {platform.node()} {process} {token} {target.name}")).hexdigest()[:12]
    return f".{target.stem[:40]}.{process}-{token}-{seal}{target.suffix[:20]}"


def _remove_left(target: Path) -> None:
    start, end = f".{target.stem[:40]}.", target.suffix[:20]
    with suppress(OSError):
        for name in os.listdir(target.parent):
            process, _, rest = name[len(start) : len(name) - len(end)].partition("-")
            if name.startswith(start) and name.endswith(end) and process.isdecimal() and len(rest) == 21:
                own = name == _partial_name(target, int(process), rest[:8])
                left = target.with_name(name)
                if own and not _is_running(int(process)) and not left.is_symlink():
                    left.unlink(missing_ok=True)


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
