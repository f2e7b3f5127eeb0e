"""Formats that ObsPy lacks, as its plug-ins: ``obspy.read`` recognises and reads their files, in m/s².

ObsPy asks for two functions of a format, by the entry points ``obspy.plugin.waveform.<NAME>`` of ``pyproject.toml``:
``isFormat`` and ``readFormat``. Each takes the name of a file or an open one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from stylobate.errors import InputError
from stylobate.motion.readers.registry import Format, components_of
from stylobate.motion.readers.source import Source

from .formats import FORMATS

if TYPE_CHECKING:
    import obspy

#: Names that ObsPy knows the formats by, and ours; ObsPy reads miniSEED and K-NET itself.
NAMES = {
    "CSMIP": "CSMIP V1, V2",
    "COSMOS": "COSMOS V0, V1, V2",
    "SMC": "USGS SMC V1, V2",
    "GEONET": "GeoNet V1A, V2A",
    "USC": "USC V1",
    "AT2": "PEER AT2",
    "ESM": "ESM / ITACA ASCII",
    "AFAD": "AFAD text",
    "TSMIP": "TSMIP text",
    "UNAM": "UNAM ASA",
    "RENADIC": "RENADIC V1",
    "BHRC": "BHRC V1",
}

#: Letters of SEED codes of components by their direction; those of others are numbers [degrees].
LETTERS: dict[float | None, str] = {0.0: "N", 90.0: "E"}


def is_format(file: str | Path | IO[bytes], file_format: Format) -> bool:
    """Whether a file is of a format."""
    try:
        return file_format.recognises(_opened(file))
    except (InputError, OSError):
        return False


def read_format(file: str | Path | IO[bytes], file_format: Format, **_: Any) -> obspy.Stream:
    """The components of a file: a trace each, its facts and its processing in ``stats.strongmotion``.

    Raises
    ------
    InputError
        The file is of another format, or cannot be read with certainty.
    """
    from obspy import Stream, Trace, UTCDateTime

    source = _opened(file)
    if not file_format.recognises(source):
        raise InputError(f"{source.name} is not of format {file_format.name}.")
    traces = []
    for number, part in enumerate(components_of([source])[0], 1):
        if not math.isfinite(part.dt):
            raise InputError(
                f"{source.name} has samples at unequal times, which no trace holds; use strongmotion.read."
            )
        facts = {key: value for key, value in part.facts.items() if value is not None}
        trace = Trace(part.values)
        trace.stats.delta = part.dt
        trace.stats.station, trace.stats.network = (str(facts.get(key, "")) for key in ("station", "network"))
        trace.stats.channel = "HN" + ("Z" if part.vertical else LETTERS.get(part.azimuth, str(number)))
        if (start := _utc(str(facts.get("start_time", "")))) is not None:
            trace.stats.starttime = UTCDateTime(start)
        trace.stats.strongmotion = facts | {
            "label": part.label,
            "azimuth": part.azimuth,
            "unit": "m/s2",
            "processing": [*part.history, *part.processing],
        }
        traces.append(trace)
    return Stream(traces)


def _utc(text: str) -> datetime | None:
    """The time that a file states (ISO 8601), where it says that it is universal time."""
    try:
        moment = datetime.fromisoformat(text.replace(" UTC", "+00:00"))
    except ValueError:
        return None
    return None if moment.tzinfo is None else moment.astimezone(UTC)


def _opened(file: str | Path | IO[bytes]) -> Source:
    if isinstance(file, (str, Path)):
        return Source.open(file)
    return Source(Path(getattr(file, "name", "record")), file.read())


def _pair(name: str) -> tuple[Callable[..., bool], Callable[..., Any]]:
    """The two functions of a format by the name that ObsPy knows it by."""
    file_format = next(each for each in FORMATS if each.name == NAMES[name])
    return partial(is_format, file_format=file_format), partial(read_format, file_format=file_format)


is_csmip, read_csmip = _pair("CSMIP")
is_cosmos, read_cosmos = _pair("COSMOS")
is_smc, read_smc = _pair("SMC")
is_geonet, read_geonet = _pair("GEONET")
is_usc, read_usc = _pair("USC")
is_at2, read_at2 = _pair("AT2")
is_esm, read_esm = _pair("ESM")
is_afad, read_afad = _pair("AFAD")
is_tsmip, read_tsmip = _pair("TSMIP")
is_unam, read_unam = _pair("UNAM")
is_renadic, read_renadic = _pair("RENADIC")
is_bhrc, read_bhrc = _pair("BHRC")
