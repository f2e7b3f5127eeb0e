"""The folder of a page: what lies in it is its owner's alone, and one page at a time is served from it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from stylobate.atomic import output_folder
from stylobate.campaign.ledger import Holding
from stylobate.errors import InputError
from stylobate.reading import shown

#: Rights of a folder, and of a file, that nobody else on this machine may look into.
FOLDER, FILE = 0o700, 0o600

#: Folders of the page in it.
RECORDS, JOBS = "records", "jobs"

#: Lock while a page is served; an empty file of that name and ``-lock`` lies in the folder meanwhile.
HELD = "page"


@contextmanager
def held(folder: Path) -> Iterator[Path]:
    """Hold a folder for one page; it is made if it is not there, and then it is its owner's alone.

    Raises
    ------
    InputError
        It cannot be written to, another page is served from it, or a part of it is somebody else's.
    """
    new = not folder.exists()
    with output_folder(folder):
        pass
    if new:
        folder.chmod(FOLDER)
    try:
        holding = Holding(folder / HELD)
    except InputError:
        raise InputError(
            f"{shown(folder)} is not free: a page is served from it already; use or end that one, or choose another `out`."
        ) from None
    try:
        for name in (RECORDS, JOBS):
            private(folder / name)
        yield folder
    finally:
        holding.release()


def private(folder: Path) -> Path:
    """A folder of the page's own, made if it is not there; nobody else may read it, whoever made it.

    Raises
    ------
    InputError
        It is a link, or somebody else's.
    """
    if folder.is_symlink():
        raise InputError(
            f"{shown(folder)} is a link, behind which nothing is kept; remove it, or choose another `out`."
        )
    folder.mkdir(mode=FOLDER, parents=True, exist_ok=True)
    if hasattr(os, "geteuid") and folder.stat().st_uid != os.geteuid():
        raise InputError(f"{shown(folder)} belongs to another user; choose another `out`.")
    folder.chmod(FOLDER)
    return folder


def private_file(path: str, flags: int) -> int:
    """Opens a file that nobody else may read; an ``opener`` for :func:`open`."""
    return os.open(path, flags, FILE)
