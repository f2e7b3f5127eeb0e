"""The records that come with the package: ``sample:NAME`` wherever the path of a record is asked for."""

from __future__ import annotations

import gzip
import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from ...errors import InputError, suggest

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
