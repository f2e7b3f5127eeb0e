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

#: Most files of one record: its components, and what describes its station.
PARTS = 12


@dataclass(frozen=True)
class Record:
    """A record that was uploaded.

    Parameters
    ----------
    id : str
    name : str
        As it was called where it came from; shown, and nothing else.
    files : tuple of str
        Names of its files here: several where its components, or what describes its station, lie in files of their own.
    size : int
        [bytes]
    """

    id: str
    name: str
    files: tuple[str, ...]
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

    async def receive(self, name: str, chunks: AsyncIterator[bytes], joined: str = "") -> Record:
        """Keep a file as it comes in; nothing is left of one that is too large or breaks off.

        Parameters
        ----------
        name : str
            Of the file, where it comes from.
        chunks : iterator of bytes
        joined : str
            The record that it is a part of; a record of its own where there is none.

        Raises
        ------
        InputError
            There are too many, or too much.
        """
        whole = self.kept.get(joined)
        if joined and whole is None:
            raise InputError("the record is no longer here; upload it again.")
        if whole is not None and len(whole.files) >= PARTS:
            raise InputError(f"the record has {PARTS} files, and more are not taken; leave some out.")
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
            called = shown(name)[:200] or "record"
            whole = self.kept.get(joined)  # it may have changed meanwhile
            if whole is None:
                record = Record(token, called, (target.name,), size)
            else:
                record = Record(
                    whole.id, f"{whole.name}, {called}"[:400], (*whole.files, target.name), whole.size + size
                )
            self.kept[record.id] = record
        except BaseException:
            target.unlink(missing_ok=True)
            raise
        finally:
            self._coming -= FILE
        return record

    def remove(self, record: str) -> None:
        """Forget a record; jobs have copies of their own."""
        found = self.kept.pop(record, None)
        for file in found.files if found is not None else ():
            (self.folder / file).unlink(missing_ok=True)

    def paths(self, record: str) -> list[str]:
        """Where the files of a record lie.

        Raises
        ------
        InputError
            There is no such record.
        """
        if record not in self.kept:
            raise InputError("the record is no longer here; upload it again.")
        return [str(self.folder / file) for file in self.kept[record].files]

    def copy(self, records: Sequence[str], folder: Path) -> dict[str, list[str]]:
        """Copy the files of records into a folder; returns their names there by record.

        Descriptions of stations (StationXML) go with them: readers look for them beside the record.
        """
        copied: dict[str, list[str]] = {}
        described = [one for one in self.kept.values() if one.id not in records and one.files[0].endswith(".xml")]
        for one in described if records else ():
            folder.mkdir(exist_ok=True)
            for file in one.files:
                shutil.copyfile(self.folder / file, folder / file)
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
