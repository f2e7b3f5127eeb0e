"""Records that were uploaded, kept under generated names over restarts; and the folder of the page, its owner's alone."""

from __future__ import annotations

import json
import os
import re
import secrets
import shutil
import threading
from collections.abc import AsyncIterator, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from stylobate.atomic import output_folder, replacing
from stylobate.campaign.ledger import Holding
from stylobate.errors import InputError
from stylobate.text_tables import printable

#: Largest file, and all together [bytes]; most records. Three components of an hour at 200 Hz take some 30 MB.
FILE, ALL, MOST = 32_000_000, 600_000_000, 1000

#: Most files of one record: its components, and what describes its station; most that come in at once.
PARTS, COMING = 12, 16

#: The end of the name of a file that is kept here, with its token; and the name of the note about a record.
_KEPT, _NOTE = re.compile(r"-([0-9a-f]{8})(?:\.[a-z0-9]{1,6})?"), re.compile(r"\.([0-9a-f]{8})\.json")

#: Beginning of the name of a file that is still coming in.
_COMING = ".coming-"


@dataclass(frozen=True)
class Record:
    """A record that was uploaded.

    Parameters
    ----------
    id : str
    name : str
        As it was called where it came from; shown, and nothing else. No two records are called the same.
    place : str
        The folder in which its files lie, with those that came together with it: what describes a station is looked for
        there, and what others have uploaded is no part of it.
    files : tuple of str
        Names of its files there: several where its components, or what describes its station, lie in files of their own.
    size : int
        [bytes]
    """

    id: str
    name: str
    place: str
    files: tuple[str, ...]
    size: int

    @property
    def names(self) -> list[str]:
        """Its files, from the folder of all records."""
        return [f"{self.place}/{file}" for file in self.files]

    @property
    def describes(self) -> bool:
        """Whether it describes stations (StationXML): readers look for it beside a record."""
        return self.files[0].endswith(".xml")


@dataclass
class _Upload:
    """A file that is coming in."""

    path: Path
    token: str = field(default_factory=lambda: secrets.token_hex(4))
    size: int = 0


class Records:
    """The records of a page in one folder.

    Parameters
    ----------
    folder : Path
        What lies in it already is kept as well.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = private(folder)
        self.kept: dict[str, Record] = {}
        self._lock = threading.Lock()
        self._coming: list[_Upload] = []
        for record in sorted(self._found(), key=lambda item: self._path(item.names[0]).stat().st_mtime):
            self.kept[record.id] = replace(record, name=self._unlike(record.name))

    async def receive(self, name: str, chunks: AsyncIterator[bytes], joined: str = "", beside: str = "") -> Record:
        """Keep a file as it comes in; nothing is left of one that is too large or breaks off.

        Parameters
        ----------
        name : str
            Of the file, where it comes from.
        chunks : iterator of bytes
        joined : str
            The record that it is a part of; a record of its own where there is none.
        beside : str
            The record that it came together with: what describes a station in one of them holds for the others.

        Raises
        ------
        InputError
            There are too many, or too much.
        """
        for record_id in filter(None, (joined, beside)):
            if len(self._record(record_id).files) >= PARTS and joined:
                raise InputError(f"the record has {PARTS} files, and more are not taken; leave some out.")
        upload = _Upload(self.folder)
        upload.path = self.folder / f"{_COMING}{upload.token}"
        with self._lock:
            if len(self._coming) >= COMING:
                raise InputError(f"{len(self._coming)} files are coming in at this moment; send this one after them.")
            if len(self.kept) + len(self._coming) >= MOST:
                raise InputError(f"{len(self.kept)} records are kept, which is the most allowed; remove some.")
            self._coming.append(upload)
        try:
            with open(upload.path, "xb", opener=private_file) as file:
                async for chunk in chunks:
                    upload.size += len(chunk)
                    self._check_size(upload)
                    file.write(chunk)
            return self._keep(upload, name, joined, beside)
        finally:
            self._coming.remove(upload)
            upload.path.unlink(missing_ok=True)

    def remove(self, record: str) -> None:
        """Forget a record; jobs have copies of their own."""
        entry = self.kept.pop(record, None)
        if entry is None:
            return
        for file in (f".{entry.id}.json", *entry.files):
            (self.folder / entry.place / file).unlink(missing_ok=True)
        with suppress(OSError):  # others lie beside it
            (self.folder / entry.place).rmdir()

    def paths(self, record: str) -> list[str]:
        """Place of the files of a record.

        Raises
        ------
        InputError
            There is no such record.
        """
        return [str(self._path(name)) for name in self._record(record).names]

    def names(self, record: str) -> list[str]:
        """The files of a record as :meth:`copy` calls them, from the folder that it copies into; see :meth:`paths`."""
        return self._record(record).names

    def copy(self, records: Sequence[str], folder: Path) -> None:
        """Copy the files of records into a folder, with the descriptions of stations that came together with them."""
        wanted = [self._record(record) for record in records]
        places = {record.place for record in wanted}
        beside = [record for record in self.kept.values() if record.place in places and record.describes]
        for name in dict.fromkeys(name for record in (*wanted, *beside) for name in record.names):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self._path(name), folder / name)

    def _record(self, record: str) -> Record:
        if record not in self.kept:
            raise InputError("the record is no longer here; upload it again.")
        return self.kept[record]

    def _path(self, name: str) -> Path:
        return self.folder.joinpath(*PurePosixPath(name).parts)

    def _check_size(self, upload: _Upload) -> None:
        """Refuse what is too large, alone or with all others, those that are coming in as well."""
        if upload.size > FILE:
            raise InputError(f"the file is larger than {FILE / 1e6:g} MB, which is the most allowed; cut it.")
        kept = sum(record.size for record in self.kept.values())
        if kept + sum(incoming.size for incoming in self._coming) > ALL:
            raise InputError(
                f"there is no room for the file: {len(self.kept)} records are kept, with {kept / 1e6:.3g} of "
                f"{ALL / 1e6:g} MB; remove some."
            )

    def _keep(self, upload: _Upload, name: str, joined: str, beside: str) -> Record:
        """A file that has come in becomes a record, or a part of one, which may have changed or gone meanwhile."""
        called, token = printable(name)[:200] or "record", upload.token
        file = generated_name(name, token)
        whole = self.kept.get(joined)
        if whole is not None:
            both = self._unlike(f"{whole.name}, {called}"[:400], whole.id)
            record = Record(whole.id, both, whole.place, (*whole.files, file), whole.size + upload.size)
        else:
            neighbour = self.kept.get(beside)
            place = token if neighbour is None else neighbour.place
            record = Record(token, self._unlike(called), place, (file,), upload.size)
        (self.folder / record.place).mkdir(mode=PRIVATE_FOLDER, exist_ok=True)
        upload.path.rename(self.folder / record.place / file)
        self._note(record)
        self.kept[record.id] = record
        return record

    def _unlike(self, name: str, but: str = "") -> str:
        """A name that no other record has: with a number where it must."""
        taken = {record.name for record in self.kept.values() if record.id != but}
        stem, dot, ending = name.rpartition(".")
        number, candidate = 1, name
        while candidate in taken:
            number += 1
            candidate = f"{stem} ({number}){dot}{ending}" if stem else f"{name} ({number})"
        return candidate

    # -- over restarts -------------------------------------------------------------------------------------------

    def _note(self, record: Record) -> None:
        """Write down what is known of a record beside its files."""
        with replacing(self.folder / record.place / f".{record.id}.json") as partial:
            partial.write_text(json.dumps({"name": record.name, "files": record.files}), encoding="utf-8")

    def _found(self) -> Iterator[Record]:
        """Records that lie here: as their notes say, and files without a note each as a record of its own."""
        for leftover in self.folder.glob(f"{_COMING}*"):  # a page that was killed had not received it to its end
            leftover.unlink()
        for file in _plain(self.folder):  # as earlier versions kept them
            token = _token(file.name) or secrets.token_hex(4)
            (self.folder / token).mkdir(mode=PRIVATE_FOLDER, exist_ok=True)
            file.rename(self.folder / token / file.name)
        for place in sorted(path for path in self.folder.iterdir() if path.is_dir() and not path.is_symlink()):
            files = {path.name: path.stat().st_size for path in _plain(place)}
            for token, name, parts in _notes(place):
                if all(part in files for part in parts):
                    yield Record(token, name, place.name, parts, sum(files.pop(part) for part in parts))
            for file, size in files.items():
                token = _token(file) or secrets.token_hex(4)
                yield Record(token, file.replace(f"-{token}", ""), place.name, (file,), size)


def _plain(folder: Path) -> list[Path]:
    """Files in a folder, without hidden ones and links."""
    paths = (path for path in folder.iterdir() if path.name[0] != "." and path.is_file() and not path.is_symlink())
    return sorted(paths)


def _token(file: str) -> str | None:
    """The token in the name of a file."""
    match = _KEPT.search(file)
    return match[1] if match is not None and match.end() == len(file) else None


def _notes(place: Path) -> Iterable[tuple[str, str, tuple[str, ...]]]:
    """Notes about records in a folder: id, name and files; one that cannot be read is passed over."""
    for path in sorted(place.glob(".*.json")):
        token = _NOTE.fullmatch(path.name)
        with suppress(OSError, ValueError, TypeError, KeyError):
            note = json.loads(path.read_text(encoding="utf-8"))
            parts = tuple(map(str, note["files"]))
            if token is not None and parts and len(set(parts)) == len(parts):
                yield token[1], printable(note["name"]), parts


def generated_name(name: str, token: str) -> str:
    """A name of letters, digits, - and _ alone: what is left of another one, and a token that makes it unique."""
    stem, dot, ending = name.replace("\\", "/").rpartition("/")[2].rpartition(".")
    if not dot:
        stem, ending = ending, ""
    plain = re.sub(r"[^A-Za-z0-9]+", "-", stem).strip("-")[:40] or "record"
    end = f".{ending.lower()}" if re.fullmatch(r"[A-Za-z0-9]{1,6}", ending) else ""
    return f"{plain}-{token}{end}"


#: Rights of a folder, and of a file, that nobody else on this machine may look into.
PRIVATE_FOLDER, PRIVATE_FILE = 0o700, 0o600

#: Folders of the page in it.
RECORDS, JOBS = "records", "jobs"

#: Lock while a page is served; an empty file of that name and ``-lock`` lies in the folder meanwhile.
LOCK = "page"


@contextmanager
def locked_folder(folder: Path) -> Iterator[Path]:
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
        folder.chmod(PRIVATE_FOLDER)
    try:
        holding = Holding(folder / LOCK)
    except InputError:
        raise InputError(
            f"{printable(folder)} is not free: a page is served from it already; use or end that one, or "
            "choose another `out`."
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
            f"{printable(folder)} is a link, behind which nothing is kept; remove it, or choose another `out`."
        )
    folder.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
    if hasattr(os, "geteuid") and folder.stat().st_uid != os.geteuid():
        raise InputError(f"{printable(folder)} belongs to another user; choose another `out`.")
    folder.chmod(PRIVATE_FOLDER)
    return folder


def private_file(path: str, flags: int) -> int:
    """Opens a file that nobody else may read; an ``opener`` for :func:`open`."""
    return os.open(path, flags, PRIVATE_FILE)
