"""Command lines: each ends with exit code 0 or 2, in one sentence where it is refused, in one JSON object where asked."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

from . import odd
from .columns import file as column_file
from .command import command
from .target import Target

#: Values of options: usual ones, then odd ones.
TEXTS = (
    "", " ", "-", "--", "0", "-1", "1", "nan", "inf", "-inf", "1e308", "1e-308", "0.02", "5s", "5 s", "20ms", "1e-12s",
    "1e99s", "0.3g", "?g", "3m/s2", "300gal", "1.0Hz", "1Hz,0.3g,1s", "1Hz,0.3g", "1Hz", "0.3g,1Hz,0.5s", "1Hz,?g,0.5s",
    "1Hz,0.3g,1e-12s", "1e9Hz,0.3g,1s", "0Hz,0.3g,1s", "1Hz,1e9g,1s", "ricker,1Hz,0.2g,1s", "ricker", "gabor,1Hz,0.2g",
    "greece,6.5Mw,20km", "greece,99Mw,-1km", "x", "y", "1:2:2", "0.1g:0.2g:2", "2:1:5", "1:2:999999999", "1,2,,3", "a:b:c",
    "points=3", "points=99999999999", "time_step=1e-12", "restitution=2", "=", "x=y", "step_factor=nan", "2MPa", "2e99GPa",
    "$", "\x00", "\x1b[31m", "\udcff", "列柱", "x" * 5000, "%s", "{0}", "'", '"', "\n", "../..", "/dev/zero", "/dev/null",
    ".", "nowhere.toml", "housner", "dem2d", "rigid-beam", "rigid-block", "dem9d", "housner,rigid-beam", "on", "off", "true",
)  # fmt: skip

OPTIONS = (
    "--model", "--harmonic", "--pulse", "--synthetic", "--motion", "--unit", "--dt", "--component", "--azimuth",
    "--condition", "--scale", "--pga", "--vertical", "--tail", "--output-interval", "--set", "--threads", "--from", "--to",
    "--step", "--frequencies", "--amplitudes", "--duration", "--compressive-strength", "--pattern", "--tilt", "--models",
    "--against", "--wrong", "-x", "--help",
)  # fmt: skip

#: Command lines that are right, of which some are changed.
USUAL: tuple[tuple[str, ...], ...] = (
    ("run", "COLUMN", "--model", "MODEL", "--harmonic", "1Hz,0.3g,0.2s"),
    ("run", "COLUMN", "--pulse", "ricker,4Hz,0.3g,0.4s", "--tail", "0.1s"),
    ("run", "COLUMN", "--motion", "RECORD", "--scale", "1.5", "--model", "MODEL"),
    (
        "critical",
        "COLUMN",
        "--model",
        "MODEL",
        "--harmonic",
        "2Hz,?g,0.2s",
        "--from",
        "0.1g",
        "--to",
        "0.3g",
        "--step",
        "0.1g",
    ),
    (
        "domain",
        "COLUMN",
        "--model",
        "MODEL",
        "--frequencies",
        "1:2:2",
        "--amplitudes",
        "0.1g:0.2g:2",
        "--duration",
        "0.2s",
    ),
    ("limit", "COLUMN", "--compressive-strength", "2MPa"),
    ("pushover", "COLUMN"),
    ("sequence", "COLUMN", "--model", "MODEL", "--harmonic", "2Hz,0.3g,0.2s", "--rest", "0.2s", "--factors", "1,0.5"),
    ("columns", "COLUMN"),
    ("compare", "COLUMN", "--models", "housner,rigid-beam", "--harmonic", "1Hz,0.3g,0.2s"),
    ("motion", "RECORD"),
    ("spectrum", "RECORD"),
    ("animate", "FILE"),
    ("cite", "FILE"),
)

RECORD = "time_s,ax_g\n" + "".join(f"{0.02 * i:.2f},{0.3 * (-1) ** (i // 5)}\n" for i in range(40))


def attempt(rng: random.Random, folder: Path) -> str:
    """One command line."""
    line = [word(rng, folder, part) for part in rng.choice(USUAL)]
    for _ in range(rng.choice((0, 0, 1, 1, 2))):
        change: Callable[[random.Random, list[str]], None] = rng.choice(
            (_value, _value, _option, _drop, _double, _swap)
        )
        change(rng, line)
    if rng.random() < 0.5:
        line.append("--json")
    if "--threads" not in line:
        line += ["--threads", "1"]
    if rng.random() < 0.1:
        line += ["--out", str(folder / "out")]
    return "done" if command([part.replace("\x00", "") for part in line]).code == 0 else "refused"


def word(rng: random.Random, folder: Path, part: str) -> str:
    """A part of a usual command line, its placeholder filled."""
    if part == "COLUMN":
        if rng.random() < 0.7:
            return rng.choice(("paper-monolithic", "paper-12-drums"))
        return str(odd.write(rng, folder, column_file(rng)))
    if part == "MODEL":
        return rng.choice(("housner", "rigid-beam", "rigid-block", "dem2d"))
    if part == "RECORD":
        path = folder / rng.choice(("record.csv", "r$cord.csv", "r\udcffcord.csv"))
        path.write_bytes(odd.damaged(rng, RECORD.encode()) if rng.random() < 0.2 else RECORD.encode())
        return str(path)
    if part == "FILE":
        path = folder / "file.nc"
        path.write_bytes(rng.choice((b"", b"CDF\x01", b"\x89HDF\r\n\x1a\n" + bytes(200), b"text")))
        return str(path)
    return part


def _value(rng: random.Random, line: list[str]) -> None:
    line[rng.randrange(len(line))] = rng.choice(TEXTS)


def _option(rng: random.Random, line: list[str]) -> None:
    at = rng.randrange(1, len(line) + 1)
    line[at:at] = [rng.choice(OPTIONS), rng.choice(TEXTS)]


def _drop(rng: random.Random, line: list[str]) -> None:
    if len(line) > 1:
        del line[rng.randrange(1, len(line))]


def _double(rng: random.Random, line: list[str]) -> None:
    line += line[rng.randrange(len(line)) :]


def _swap(rng: random.Random, line: list[str]) -> None:
    i, j = rng.randrange(len(line)), rng.randrange(len(line))
    line[i], line[j] = line[j], line[i]


TARGET = Target("options", 1_000, 25, attempt, limit=60.0)
