"""Damaged records of every format: refused, warned of, or read as the whole file; what no check can see is counted."""

from __future__ import annotations

import functools
import io
import random
import re
import warnings
from pathlib import Path

import numpy as np

from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import Motion, read_motion, write_csv

from .record_files import FORMATS, WAVES, knet
from .target import Fault, Target, sentence

#: Real records, where they lie beside the project.
RECORDS = Path(__file__).resolve().parents[2].parent / "shared" / "records"

#: Formats that state no number of samples: where their file is cut between two lines, nothing says so.
OPEN_ENDED = ("columns", "mseed")

#: A word of a line: a number, or what stands between blanks.
_WORD = re.compile(rb"[^\s,;:=/]+")


@functools.cache
def originals() -> dict[str, tuple[bytes, dict]]:
    """Content and options of reading, by name: the small files of every format, one of our own, and real ones."""
    files = {name: (text.encode("latin-1"), {}) for name, (text, *_) in FORMATS.items()}
    files["knet"] = (knet().encode(), {})
    lines = "".join(f"{i * 0.01:.2f} {value:.4f}\n" for i, value in enumerate(WAVES[0]))
    files["columns"] = (lines.encode(), {"unit": "g"})
    files["columns header"] = (b"time_s,ax_g\n" + lines.replace(" ", ",").encode(), {})
    files["our csv"] = (_own(), {})
    if (small := _mseed()) is not None:
        files["mseed"] = (small, {})
    for path in sorted(RECORDS.glob("*.*")) if RECORDS.is_dir() else []:
        if path.suffix in (".csv", ".xml", ".mseed") or path.stat().st_size > 450_000:
            continue
        options = {"unit": "g"} if path.name.startswith("twocol") else {}
        files[f"real {path.name.partition('_')[0]} {path.name}"] = (path.read_bytes(), options)
    return files


def _own() -> bytes:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = write_csv(Motion(0.01, WAVES[0], WAVES[1], WAVES[2]), Path(folder) / "own.csv")
        return path.read_bytes()


def _mseed() -> bytes | None:
    """Some records of miniSEED, or None without ObsPy."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            import obspy
    except ImportError:
        return None
    counts = np.round(1e5 * np.sin(np.arange(900) * 0.05) + 3e4 * np.sin(np.arange(900) * 0.9)).astype(np.int32)
    trace = obspy.Trace(counts, {"network": "XX", "station": "ABC", "channel": "HNE", "sampling_rate": 100.0})
    data = io.BytesIO()
    obspy.Stream([trace]).write(data, format="MSEED", encoding="STEIM2", reclen=512)
    return data.getvalue()


STATION = """<?xml version="1.0" encoding="UTF-8"?>
<FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1" schemaVersion="1.1"><Source>x</Source>
<Created>2020-01-01T00:00:00Z</Created><Network code="XX"><Station code="ABC"><Latitude>0</Latitude>
<Longitude>0</Longitude><Elevation>0</Elevation><Site><Name>x</Name></Site><Channel code="HNE" locationCode="">
<Latitude>0</Latitude><Longitude>0</Longitude><Elevation>0</Elevation><Depth>0</Depth><Azimuth>90</Azimuth>
<Dip>0</Dip><SampleRate>100</SampleRate><Response><InstrumentSensitivity><Value>100000</Value>
<Frequency>1</Frequency><InputUnits><Name>M/S**2</Name></InputUnits><OutputUnits><Name>COUNTS</Name></OutputUnits>
</InstrumentSensitivity></Response></Channel></Station></Network></FDSNStationXML>
"""


def _read(data: bytes, folder: Path, options: dict, mseed: bool) -> tuple[Motion, set[str]]:
    path = folder / ("record.mseed" if mseed else "record.txt")
    path.write_bytes(data)
    if mseed:
        (folder / "station.xml").write_text(STATION)
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        motion = read_motion(path, **options)
    for warning in seen:
        if not issubclass(warning.category, (OutOfRangeWarning, DeprecationWarning)):
            raise Fault(f"a warning that is none of ours: {warning.message}")
    return motion, {
        str(warning.message).partition(": ")[2] for warning in seen if warning.category is OutOfRangeWarning
    }


def _sums(motion: Motion) -> tuple:
    """What a verdict hangs on: step, components, samples."""
    parts = tuple((axis, values.tobytes()) for axis, values in motion.components.items())
    return motion.dt, parts


@functools.cache
def _whole(name: str) -> tuple[tuple, dict, set[str]]:
    import tempfile

    data, options = originals()[name]
    with tempfile.TemporaryDirectory() as folder:
        motion, seen = _read(data, Path(folder), options, name == "mseed")
    return _sums(motion), dict(motion.metadata), seen


def _cut(rng: random.Random, data: bytes) -> bytes:
    """The beginning of a file, to any byte or to the end of a line."""
    at = rng.randrange(1, len(data))
    if rng.random() < 0.5:
        at = data.find(b"\n", at) + 1 or at
    return data[:at]


def _flip(rng: random.Random, data: bytes) -> bytes:
    at = rng.randrange(len(data))
    return data[:at] + bytes([data[at] ^ (1 << rng.randrange(8))]) + data[at + 1 :]


def _lines(rng: random.Random, data: bytes) -> bytes:
    """A line removed, doubled or swapped with another."""
    lines = data.splitlines(keepends=True)
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.choice(("remove", "double", "swap"))
    if kind == "remove":
        lines.pop(i)
    elif kind == "double":
        lines.insert(i, lines[i])
    else:
        lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


def _header(rng: random.Random, data: bytes) -> bytes:
    """A digit changed in the first lines of the file."""
    digits = [i for i, byte in enumerate(data[: min(len(data), 3000)]) if 48 <= byte <= 57]
    if not digits:
        return data
    at = rng.choice(digits)
    return data[:at] + str(rng.randrange(10)).encode() + data[at + 1 :]


def _word(rng: random.Random, data: bytes) -> bytes:
    """A word replaced by what may confuse a reader."""
    words = list(_WORD.finditer(data[: min(len(data), 20_000)]))
    match = rng.choice(words)
    odd = rng.choice(
        (b"nan", b"1e999", b"1d3", b"-1", b"0", b"99999999999", b"", b"*****", b"1_0", b"\xff\xfe", b"\x00")
    )
    return data[: match.start()] + odd + data[match.end() :]


DAMAGES = {"cut": _cut, "flip": _flip, "lines": _lines, "header": _header, "word": _word}


def _changed_words(old: bytes, new: bytes) -> list[tuple[bytes, bytes]] | None:
    """Words that differ, or None where their numbers or the lines do."""
    before, after = old.splitlines(), new.splitlines()
    if len(before) != len(after):
        return None
    pairs = []
    for line, other in zip(before, after):
        if line == other:
            continue
        a, b = _WORD.findall(line), _WORD.findall(other)
        if len(a) != len(b):
            return None
        pairs += [(x, y) for x, y in zip(a, b) if x != y]
    return pairs


def _permuted(old: bytes, new: bytes) -> bool:
    return sorted(old.splitlines()) == sorted(new.splitlines())


def attempt(rng: random.Random, folder: Path) -> str:
    """One damaged file."""
    name = rng.choice(sorted(originals()))
    data, options = originals()[name]
    kind = rng.choice(sorted(DAMAGES))
    damaged = DAMAGES[kind](rng, data)
    label = name.partition(" ")[0] if name.startswith("real") else name
    label = f"{label} {name.split()[1]}" if label == "real" else label
    whole, facts, seen = _whole(name)
    try:
        motion, warned = _read(damaged, folder, options, name == "mseed")
    except InputError as error:
        sentence(error)
        return f"{label}: refused"
    if _sums(motion) == whole and motion.metadata.get("azimuths") == facts.get("azimuths"):
        return f"{label}: the same"
    if warned - seen:
        return f"{label}: warned"
    return f"{label}: unseen, {_unseen(name, kind, data, damaged)}"


def _unseen(name: str, kind: str, data: bytes, damaged: bytes) -> str:
    """Why no check could see a change; a fault where one could."""
    if name == "our csv":
        raise Fault(f"our own file, which carries a digest, was read changed ({kind})")
    if name.startswith(OPEN_ENDED) or name.endswith("dat"):
        if kind == "cut" and data.startswith(damaged):
            return "cut between lines or records of a format without count"
    elif kind == "cut" and name == "usc":
        return "cut between channels, whose number the header does not state"
    elif kind == "cut":
        rest = data[len(damaged) :]
        raise Fault(f"{name} cut to {len(damaged)} of {len(data)} bytes was read: {damaged[-80:]!r} | {rest[:40]!r}")
    if name == "mseed":
        return "a header of miniSEED, which has no check"
    if _permuted(data, damaged):
        return "order of lines"
    words = _changed_words(data, damaged)
    if words and len(words) == 1:
        return "one word" if not re.search(rb"\d", words[0][0]) else "one number"
    return "several words" if words else "numbers joined or split"


TARGET = Target("records", 20_000, 300, attempt)
