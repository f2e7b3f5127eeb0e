"""Files of other people: kind and size are looked at before anything is read, and names are made fit to be shown."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from .errors import InputError

#: Most that a text of settings (a column, a study, an assembly) may hold [bytes].
SETTINGS = 2_000_000


def read_bytes(path: str | Path, most: int, remedy: str = "give another file") -> bytes:
    """Content of a file of at most ``most`` bytes.

    Parameters
    ----------
    path : str or Path
    most : int
        [bytes]
    remedy : str
        One clause that says what to do with a file that is larger.

    Raises
    ------
    InputError
        There is no such file, it cannot be read, is larger, or is no file: a folder, a pipe or a device, which might
        never end.
    """
    check_file(path, most, remedy)
    try:
        with Path(path).open("rb") as file:
            told = min(os.fstat(file.fileno()).st_size, most)
            data = file.read(told + 1)  # a buffer of this size: not of the most that is allowed
            if len(data) > told:  # it grows, or its size is not told beforehand; no more even so
                data += file.read(most + 1 - len(data))
    except OSError as error:
        raise _unreadable(path, error) from None
    if len(data) > most:
        raise InputError(f"{shown(path)} holds more than {most} bytes, which is the most here: {remedy}.")
    return data


def check_file(path: str | Path, most: int, remedy: str = "give another file") -> None:
    """Refuse what is no file or too large a one, without opening it; see :func:`read_bytes`."""
    try:
        found = Path(path).stat()
    except (OSError, ValueError) as error:
        raise _unreadable(path, error) from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError(f"{shown(path)} is a folder; name the file in it.")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(f"{shown(path)} is not a file but a pipe or a device; give a file.")
    if found.st_size > most:
        raise InputError(f"{shown(path)} holds {found.st_size} bytes; allowed is up to {most}: {remedy}.")


def shown(path: str | Path) -> str:
    """A path as it can be printed and stored: bytes that are no UTF-8, and control characters, as ``\\x…``."""
    text = os.fsencode(str(path)).decode("utf-8", "backslashreplace")
    return "".join(one if one.isprintable() else one.encode("unicode_escape").decode() for one in text)


def _unreadable(path: str | Path, error: OSError | ValueError) -> InputError:
    if isinstance(error, FileNotFoundError):
        slashed = str(path).replace("\\", "/")
        remedy = f"; write {slashed}" if slashed != str(path) and Path(slashed).exists() else ""
        return InputError(f"there is no file {shown(path)}{remedy}.")
    reason = getattr(error, "strerror", None) or str(error)
    return InputError(f"{shown(path)} cannot be read: {reason}; check the path.")
