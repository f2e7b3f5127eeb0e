"""Records that were uploaded: kept under generated names, as many and as large as allowed."""

from __future__ import annotations

import re
import secrets
import shutil
import threading
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError
from ..reading import shown

#: Largest file, and all together [bytes]; most records. Three components of an hour at 200 Hz take some 30 MB.
FILE, ALL, MOST = 32_000_000, 600_000_000, 1000


@dataclass(frozen=True)
class Record:
    """A record that was uploaded.

    Parameters
    ----------
    id : str
    name : str
        As it was called where it came from; shown, and nothing else.
    file : str
        Its name here.
    size : int
        [bytes]
    """

    id: str
    name: str
    file: str
    size: int


class Records:
    """The records of a page in one folder.

    Parameters
    ----------
    folder : Path
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.kept: dict[str, Record] = {}
        self._lock = threading.Lock()
        self._coming = 0

    async def receive(self, name: str, chunks: AsyncIterator[bytes]) -> Record:
        """Keep a file as it comes in; nothing is left of one that is too large or breaks off.

        Raises
        ------
        InputError
            There are too many, or too much.
        """
        token = secrets.token_hex(4)
        target = self.folder / generated_name(name, token)
        size = 0
        with self._lock:
            room = ALL - self._coming - sum(one.size for one in self.kept.values())
            if len(self.kept) >= MOST or room <= 0:
                raise InputError(f"{len(self.kept)} records are kept, and there is no room for more; remove some.")
            self._coming += FILE
        try:
            with target.open("xb") as file:
                async for chunk in chunks:
                    size += len(chunk)
                    if size > min(FILE, room):
                        raise InputError(f"the record is larger than {min(FILE, room) / 1e6:.3g} MB; cut it.")
                    file.write(chunk)
            record = Record(token, shown(name)[:200] or "record", target.name, size)
            self.kept[token] = record
        except BaseException:
            target.unlink(missing_ok=True)
            raise
        finally:
            self._coming -= FILE
        return record

    def remove(self, record: str) -> None:
        """Forget a record; jobs have copies of their own."""
        found = self.kept.pop(record, None)
        if found is not None:
            (self.folder / found.file).unlink(missing_ok=True)

    def paths(self, record: str) -> list[str]:
        """Where the files of a record lie.

        Raises
        ------
        InputError
            There is no such record.
        """
        if record not in self.kept:
            raise InputError("the record is no longer here; upload it again.")
        return [str(self.folder / self.kept[record].file)]

    def copy(self, records: Sequence[str], folder: Path) -> dict[str, list[str]]:
        """Copy the files of records into a folder; returns their names there by record."""
        copied: dict[str, list[str]] = {}
        for record in records:
            for path in self.paths(record):
                folder.mkdir(exist_ok=True)
                shutil.copyfile(path, folder / Path(path).name)
                copied.setdefault(record, []).append(Path(path).name)
        return copied


def generated_name(name: str, token: str) -> str:
    """A name of letters, digits, - and _ alone: what is left of another one, and a token that makes it unique."""
    stem, dot, ending = name.replace("\\", "/").rpartition("/")[2].rpartition(".")
    if not dot:
        stem, ending = ending, ""
    plain = re.sub(r"[^A-Za-z0-9]+", "-", stem).strip("-")[:40] or "record"
    end = f".{ending.lower()}" if re.fullmatch(r"[A-Za-z0-9]{1,6}", ending) else ""
    return f"{plain}-{token}{end}"
