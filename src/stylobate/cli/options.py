"""Options that several commands share, and what they mean together."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError

if TYPE_CHECKING:
    from ..column import Column
    from ..models.base import Model
    from ..motion import Motion

ColumnName = Annotated[str, typer.Argument(metavar="COLUMN", help="Name of a preset, or a column file (TOML).")]
ModelName = Annotated[str, typer.Option("--model", metavar="MODEL", help="How it is computed: dem2d, housner …")]
Settings = Annotated[
    list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Option of the model; may be repeated.")
]
Harmonic = Annotated[
    str | None, typer.Option("--harmonic", metavar="F,A,T", help="Sine from rest, such as 1.0Hz,0.3g,10s.")
]
Pulse = Annotated[
    str | None,
    typer.Option(
        "--pulse",
        metavar="KIND,F,A[,T]",
        help="Pulse, such as ricker,1.0Hz,0.3g; the time is the length of the whole run.",
    ),
]
MotionFile = Annotated[Path | None, typer.Option("--motion", metavar="FILE", help="Record of a ground motion.")]
Unit = Annotated[str | None, typer.Option("--unit", help="Unit of the record where the file names none, such as g.")]
Step = Annotated[
    str | None, typer.Option("--dt", metavar="TIME", help="Step of a record without times, such as 0.01s.")
]
Scale = Annotated[str | None, typer.Option("--scale", metavar="X", help="Multiply the motion, such as 1.5.")]
Pga = Annotated[
    str | None, typer.Option("--pga", metavar="A", help="Scale the motion to this horizontal peak, such as 0.4g.")
]
Vertical = Annotated[str, typer.Option("--vertical", metavar="on|off", help="Whether the vertical component acts.")]
Tail = Annotated[str, typer.Option("--tail", metavar="TIME", help="Go on for this long after the motion, such as 5s.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on standard output, and nothing else there.")]
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Folder for files and figures; without it none are written.")
]
Threads = Annotated[str | None, typer.Option("--threads", metavar="N", help="Threads to use; all cores by default.")]


def the_model(name: str, settings: list[str] | None) -> Model:
    """The model of that name with its options."""
    from ..models.registry import make_model

    values: dict[str, str] = {}
    for text in settings or []:
        key, sign, value = text.partition("=")
        if not sign or not key.strip():
            raise InputError(f"--set is {text!r}; write it as name=value, e.g. --set points=3.")
        if key.strip() in values:
            raise InputError(f"--set {key.strip()} is given twice; give it once.")
        values[key.strip()] = value.strip()
    return make_model(name, values)


def the_threads(text: str | None) -> int:
    """Number of threads, checked before anything is read or computed."""
    from ..simulate import thread_count

    if text is not None and not text.isdecimal():
        raise InputError(f"--threads is {text!r}; allowed is a whole number from 1; leave it out to use all cores.")
    return thread_count(None if text is None else int(text))


def the_tail(text: str) -> float:
    """Time after the motion [s]."""
    from ..motion.specs import parse_time

    return parse_time(text)


def the_motion(
    column: Column,
    *,
    harmonic: str | None,
    pulse: str | None,
    file: Path | None,
    unit: str | None = None,
    dt: str | None = None,
    scale: str | None = None,
    pga: str | None = None,
    vertical: str = "on",
) -> Motion:
    """The one motion that the options describe.

    A pulse without a stated length is followed by 20/p, p the frequency parameter of the column: free rocking from
    close to overturning has come to a verdict by then.
    """
    from ..motion.specs import parse_acceleration, parse_harmonic, parse_pulse

    check_one_motion(harmonic, pulse, file, unit, dt)
    if harmonic is not None:
        motion = parse_harmonic(harmonic)
    elif pulse is not None:
        length = parse_pulse(pulse).metadata["pulse_length"]
        motion = parse_pulse(pulse, length + 20.0 / column.frequency_parameter)
    else:
        motion = the_record(file, unit, dt)
    if scale is not None and pga is not None:
        raise InputError("--scale and --pga are both given; give one of the two.")
    if scale is not None:
        factor = _number("--scale", scale)
        motion = motion.scaled(factor).replace(name=f"{motion.name} × {factor:g}")
    if pga is not None:
        motion = motion.scaled_to_pga(parse_acceleration(pga)).replace(name=f"{motion.name}, scaled to {pga}")
    return with_vertical(motion, vertical)


def the_record(file: Path | None, unit: str | None, dt: str | None) -> Motion:
    """The motion in a file."""
    from ..motion.readers import read_motion
    from ..motion.specs import parse_time

    assert file is not None
    return read_motion(file, unit=unit, dt=None if dt is None else parse_time(dt))


def with_vertical(motion: Motion, vertical: str) -> Motion:
    """The motion with or without its vertical component."""
    if vertical not in ("on", "off"):
        raise InputError(f"--vertical is {vertical!r}; allowed is on or off.")
    return motion.without_vertical() if vertical == "off" else motion


def _number(option: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{option} is {text!r}; allowed is a number, such as 1.5.") from None


def check_one_motion(
    harmonic: str | None, pulse: str | None, file: Path | None, unit: str | None = None, dt: str | None = None
) -> None:
    """Exactly one motion is given, and options of records only with a record."""
    given = [one for one, value in (("--harmonic", harmonic), ("--pulse", pulse), ("--motion", file)) if value]
    if len(given) != 1:
        what = "no motion is given" if not given else f"{' and '.join(given)} are both given"
        raise InputError(f"{what}; give one of --harmonic, --pulse and --motion.")
    for option, value in (("--unit", unit), ("--dt", dt)):
        if value is not None and file is None:
            raise InputError(f"{option} describes a record, but none is given; leave it out or give --motion FILE.")
