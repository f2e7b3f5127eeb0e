"""Files of records: samples that come with the package, and texts, opened, decoded and split into lines."""

from __future__ import annotations

import codecs
import gzip
import tomllib
from dataclasses import dataclass
from functools import cache, cached_property
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from ...errors import InputError, suggest
from ...text_tables import printable, read_bytes
from ..motion import MAX_SAMPLES

if TYPE_CHECKING:
    from collections.abc import Mapping


#: Beginning of the path of a sample.
PREFIX = "sample:"


@dataclass(frozen=True)
class Sample:
    """A record file that comes with the package.

    Parameters
    ----------
    name : str
        As in ``sample:NAME``.
    about : str
        Event, station and peak in words.
    file : str
        Name of the file as its network published it.
    format : str
        Its format.
    terms : str
        On what terms it may be used.
    sha256 : str
        Digest of the file.
    unit : str, optional
        Unit, where the file states none.
    event, station, network : str, optional
        Where the file names none.
    """

    name: str
    about: str
    file: str
    format: str
    terms: str
    sha256: str
    unit: str | None = None
    event: str | None = None
    station: str | None = None
    network: str | None = None

    @property
    def data(self) -> bytes:
        """The file, byte for byte."""
        return gzip.decompress((_folder() / f"{self.name}.gz").read_bytes())

    @property
    def facts(self) -> dict[str, str]:
        """Facts of the record beside its file."""
        known = {"event": self.event, "station": self.station, "network": self.network, "terms": self.terms}
        return {key: value for key, value in known.items() if value is not None}


@cache
def samples() -> Mapping[str, Sample]:
    """All samples by name, in the order in which they are listed."""
    table = tomllib.loads((_folder() / "samples.toml").read_text(encoding="utf-8"))
    return MappingProxyType({name: Sample(name, **facts) for name, facts in table.items()})


def sample_at(path: str | Path) -> Sample | None:
    """The sample that a path names, or None where it is the path of a file.

    Raises
    ------
    InputError
        There is no sample of this name.
    """
    text = str(path)
    if not text.startswith(PREFIX):
        return None
    name = text.removeprefix(PREFIX)
    if name not in samples():
        meant = suggest(text, (PREFIX + sample for sample in samples()))
        raise InputError(f"there is no sample motion {name!r}; {meant}they are {', '.join(samples())}.")
    return samples()[name]


def _folder():
    return resources.files("stylobate.motion") / "samples"


# -- The text of a record file ----------------------------------------------------------------------------------------


#: Larger files are refused before they are read [bytes]; three components of an hour at 200 Hz take some 30 MB.
MAX_BYTES = 100_000_000

#: No record has longer lines [characters]; the patterns that look for headers stay quick.
MAX_LINE = 2_000

_PACKED = {
    b"\x1f\x8b": "gzip",
    b"PK\x03\x04": "zip",
    b"BZh": "bzip2",
    b"\xfd7zXZ\x00": "xz",
    b"7z\xbc\xaf\x27\x1c": "7z",
    b"Rar!": "rar",
    b"\x28\xb5\x2f\xfd": "zstandard",
    b"\x1f\x9d": "compress",
}


@dataclass(frozen=True, eq=False)
class Source:
    """A file as found.

    Parameters
    ----------
    path : Path
    data : bytes
    sample : Sample, optional
        What is known of it where it comes with the package.
    """

    path: Path
    data: bytes
    sample: Sample | None = None

    @classmethod
    def open(cls, path: str | Path) -> Source:
        """Read a file, or take the sample that ``sample:NAME`` names.

        Raises
        ------
        InputError
            Not a file that can be read, too large, empty, or compressed; no sample of this name.
        """
        sample = sample_at(path)
        if sample is not None:
            return cls(Path(sample.name), sample.data, sample)
        place = Path(path)
        data = read_bytes(place, MAX_BYTES, "cut the record")
        if not data.strip(b"\x00 \t\r\n\x1a"):
            raise InputError(f"{printable(place.name)} is empty; give a file that holds a record.")
        for magic, name in _PACKED.items():
            if data.startswith(magic):
                raise InputError(f"{printable(place.name)} is compressed ({name}); unpack it and give the file inside.")
        return cls(place, data)

    @property
    def name(self) -> str:
        """File name without its folder, as it can be shown."""
        return printable(self.path.name)

    @cached_property
    def is_text(self) -> bool:
        """Whether the file is text: no zero bytes and hardly any control characters, or a byte-order mark."""
        if self.data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return True
        start = self.data[:65536]
        controls = sum(start.count(bytes([c])) for c in range(32) if c not in (9, 10, 12, 13, 26))
        return b"\x00" not in self.data and controls <= len(start) // 500

    @property
    def ends_with_newline(self) -> bool:
        """Whether the last line of the text is ended, as a whole file's mostly is."""
        return self._decoded.rstrip(" \t\x1a").endswith(("\n", "\r"))

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text, without their ends; any mixture of LF, CR-LF, CR-CR-LF and CR.

        Raises
        ------
        InputError
            The file is not text.
        """
        if not self.is_text:
            raise InputError(
                f"{self.name} is binary, and in no binary format that is read here (miniSEED is); convert it to text."
            )
        if self.data.count(b"\n") > MAX_SAMPLES:
            raise InputError(f"{self.name} has more than {MAX_SAMPLES} lines; cut the record.")
        text = self._decoded.replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n")
        lines = text.replace("\x1a", "").split("\n")
        while lines and not lines[-1].strip():
            lines.pop()
        for number, line in enumerate(lines, 1):
            if len(line) > MAX_LINE:
                raise InputError(
                    f"{self.name}, line {number}: {len(line)} characters in one line; allowed is up to {MAX_LINE}: "
                    "break the numbers into lines."
                )
        return lines

    @cached_property
    def head(self) -> str:
        """First 8000 characters in lower case, for recognising a format; empty when the file is not text."""
        return "\n".join(line[:400] for line in self.lines[:60])[:8000].lower() if self.is_text else ""

    @cached_property
    def _decoded(self) -> str:
        for mark, name in (
            (codecs.BOM_UTF8, "utf-8-sig"),
            (codecs.BOM_UTF16_LE, "utf-16"),
            (codecs.BOM_UTF16_BE, "utf-16"),
        ):
            if self.data.startswith(mark):
                return self.data.decode(name, errors="replace")
        try:
            return self.data.decode("utf-8")
        except UnicodeDecodeError:
            return self.data.decode("cp1252", errors="replace")  # names of places in an older code page
