"""Files appear whole or not at all: written under a temporary name beside their place, then renamed."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import InputError


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a temporary path that takes the place of ``path`` when the block ends well, and vanishes otherwise.

    Parameters
    ----------
    path : str or Path
        The file to be; one that is there already is replaced.

    Raises
    ------
    InputError
        The folder of ``path`` is missing or cannot be written to.
    """
    target = Path(path)
    if not target.parent.is_dir():
        raise InputError(f"{target} cannot be written: folder {target.parent} does not exist; create it first.")
    if target.is_dir():
        raise InputError(f"{target} cannot be written: it is a folder; name a file in it.")
    try:
        handle, name = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
    except OSError as error:
        raise InputError(f"{target} cannot be written: {error.strerror}; choose another folder.") from None
    os.close(handle)
    partial = Path(name)
    try:
        yield partial
        partial.chmod(0o666 & ~_umask())  # mkstemp made it private
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)


@contextmanager
def output_folder(path: str | Path) -> Iterator[Path]:
    """Make sure that a folder is there and can be written to, before anything is computed for it.

    A folder that was made here is removed again if the block fails and left nothing in it.

    Raises
    ------
    InputError
        The folder cannot be made or written to.
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
        yield folder
    except BaseException:
        with suppress(OSError):  # not empty: something finished is kept
            for one in made:
                one.rmdir()
        raise


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
