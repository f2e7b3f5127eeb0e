"""Options that several commands share, and what they mean together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InputError

if TYPE_CHECKING:
    from ..column import Column
    from ..column.assembly import Assembly
    from ..models.base import Model
    from ..motion import Motion, Suite

ColumnName = Annotated[str, typer.Argument(metavar="COLUMN", help="Name of a preset, or a column file (TOML).")]
StructureName = Annotated[
    str,
    typer.Argument(
        metavar="COLUMN", help="Name of a preset, or a file (TOML) of a column or of an assembly of blocks."
    ),
]
ModelName = Annotated[
    str,
    typer.Option(
        "--model", metavar="MODEL", help="How it is computed: dem2d, dem3d, rigid-block, rigid-beam, housner."
    ),
]
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
Synthetic = Annotated[
    str | None, typer.Option("--synthetic", metavar="SPEC", help="Simulated motion, such as greece,6.5Mw,20km,seed=3.")
]
MotionFile = Annotated[
    list[Path] | None,
    typer.Option(
        "--motion",
        metavar="FILE",
        help="Record of a ground motion, once per file of its components; or sample:NAME (stylobate motion --samples).",
    ),
]
MotionFiles = Annotated[
    list[Path] | None,
    typer.Option(
        "--motion",
        metavar="FILE|DIR",
        help="Record, once per file of its components; a folder of records; or sample:NAME (stylobate motion --samples).",
    ),
]
ComponentName = Annotated[
    str | None,
    typer.Option("--component", metavar="C", help="The one component to use: number in the file, label or azimuth."),
]
Azimuth = Annotated[
    str | None,
    typer.Option("--azimuth", metavar="DEGREES", help="Turn the record so that x points there, clockwise from north."),
]
Condition = Annotated[
    list[str] | None,
    typer.Option("--condition", metavar="STEP", help="Conditioning, in the order given, such as bandpass=0.1Hz,25Hz."),
]
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
    column: Column | Assembly,
    *,
    harmonic: str | None,
    pulse: str | None,
    file: Sequence[Path] | None,
    synthetic: str | None = None,
    unit: str | None = None,
    dt: str | None = None,
    component: str | None = None,
    azimuth: str | None = None,
    condition: list[str] | None = None,
    scale: str | None = None,
    pga: str | None = None,
    vertical: str = "on",
) -> Motion:
    """The one motion that the options describe.

    A pulse without a stated length is followed by 20/p, p the frequency parameter of the column or of the largest part
    of an assembly: free rocking from close to overturning has come to a verdict by then.
    """
    from ..motion.specs import parse_harmonic, parse_pulse

    check_one_motion(harmonic, pulse, file, unit, dt, synthetic, component)
    if harmonic is not None:
        motion = parse_harmonic(harmonic)
    elif pulse is not None:
        length = parse_pulse(pulse).metadata["pulse_length"]
        motion = parse_pulse(pulse, length + 20.0 / column.frequency_parameter)
    else:
        motion = the_record(file, unit, dt, component, synthetic)
    return plane(scaled(shaped(motion, azimuth, condition), scale, pga), vertical)


def the_record(
    files: Sequence[Path] | None,
    unit: str | None = None,
    dt: str | None = None,
    component: str | None = None,
    synthetic: str | None = None,
) -> Motion:
    """The motion in the files of one record, or the simulated one."""
    from ..motion.readers import read_motion
    from ..motion.specs import parse_synthetic, parse_time

    if synthetic is not None:
        return parse_synthetic(synthetic)
    paths = list(files or ())
    folder = next((path for path in paths if path.is_dir()), None)
    if folder is not None:
        raise InputError(f"{folder} is a folder; give the file or the files of one record here.")
    return read_motion(paths, unit, None if dt is None else parse_time(dt), component=component)


def the_suite(
    sources: Sequence[Path], unit: str | None = None, dt: str | None = None, component: str | None = None
) -> Suite:
    """All records of folders and files."""
    from ..motion.readers import read_suite
    from ..motion.specs import parse_time

    files: list[Path] = []
    for source in sources:
        files += (
            sorted(p for p in source.iterdir() if p.is_file() and p.name[0] != ".") if source.is_dir() else [source]
        )
    if not files:
        raise InputError(f"{' and '.join(map(str, sources))} holds no file; give a folder of records, or files.")
    return read_suite(files, unit, None if dt is None else parse_time(dt), component=component)


def of_each(suite: Suite, change: Callable[[Motion], Motion]) -> Suite:
    """A suite with every motion changed; one that cannot be is refused with the reason."""
    from ..motion.readers import Suite

    motions, refused = [], dict(suite.refused)
    for motion in suite.motions:
        try:
            motions.append(change(motion))
        except InputError as error:
            refused[motion.name] = str(error)
    if not motions:
        raise InputError(f"no record of the suite can be used; the first reason: {next(iter(refused.values()))}")
    return Suite(tuple(motions), refused)


def is_suite(files: Sequence[Path] | None) -> bool:
    """Whether ``--motion`` names a folder of records."""
    folders = [path for path in files or () if path.is_dir()]
    if folders and len(files or ()) > 1:
        raise InputError(
            f"--motion is {folders[0]}, a folder, and other paths; give one folder, or files of one record."
        )
    return bool(folders)


def shaped(motion: Motion, azimuth: str | None = None, condition: list[str] | None = None) -> Motion:
    """The motion turned and conditioned as asked, every step written into its history."""
    if azimuth is not None:
        from ..motion.orientation import rotated

        motion = rotated(motion, number("--azimuth", azimuth))
    if condition:
        from ..motion.condition_specs import conditioned

        for step in condition:
            motion = conditioned(motion, step)
    return motion


def scaled(motion: Motion, scale: str | None = None, pga: str | None = None) -> Motion:
    """The motion with its amplitude as asked, which its name then says."""
    from ..motion.specs import parse_acceleration

    if scale is not None and pga is not None:
        raise InputError("--scale and --pga are both given; give one of the two.")
    if scale is not None:
        factor = number("--scale", scale)
        said = (*motion.processing, f"multiplied by {factor:g}")
        motion = motion.scaled(factor).replace(name=f"{motion.name} × {factor:g}", processing=said)
    if pga is not None:
        peak = parse_acceleration(pga)
        before = motion
        motion = motion.scaled_to_pga(peak)
        times = motion.factor / before.factor if before.factor else 0.0
        said = (*motion.processing, f"multiplied by {times:.4g}: scaled to a peak of {pga} along x")
        motion = motion.replace(name=f"{before.name}, scaled to {pga}", processing=said)
    if scale is not None or pga is not None:
        from ..motion.conditioning import warn_of_scaling

        warn_of_scaling(motion)
    return motion


def plane(motion: Motion, vertical: str = "on") -> Motion:
    """What the plane models take: x, and the vertical if it is on; the rest is left out and written down."""
    from ..motion.orientation import plane_input

    if vertical not in ("on", "off"):
        raise InputError(f"--vertical is {vertical!r}; allowed is on or off.")
    return plane_input(motion, vertical=vertical == "on")


def input_facts(motion: Motion) -> dict[str, Any]:
    """What was shaken with, under the names of the JSON object."""
    azimuths = motion.metadata.get("azimuths") or {}
    unused = [f"component {label!r} of the file" for label in motion.metadata.get("components_left_out", ())]
    return {
        "motion": motion.name,
        "azimuth_deg": azimuths.get("x"),
        "factor": motion.factor,
        "vertical": motion.z_samples is not None,
        "left_out": [*unused, *motion.metadata.get("left_out", ())],
        "processing": list(motion.processing),
    }


def input_lines(motion: Motion) -> dict[str, str]:
    """The same for people, where there is something to say."""
    facts = input_facts(motion)
    found = {"motion": motion.describe()}
    if facts["azimuth_deg"] is not None:
        found["direction"] = f"x to azimuth {facts['azimuth_deg']:g}°"
    if facts["left_out"]:
        found["left out"] = "; ".join(facts["left_out"])
    done = [text for text in facts["processing"] if not text.startswith("left out: ")]
    if done:
        found["processing"] = "; ".join(done)
    return found


def number(option: str, text: str) -> float:
    """A number as typed after an option."""
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{option} is {text!r}; allowed is a number, such as 1.5.") from None


def check_one_motion(
    harmonic: str | None,
    pulse: str | None,
    file: Sequence[Path] | None,
    unit: str | None = None,
    dt: str | None = None,
    synthetic: str | None = None,
    component: str | None = None,
) -> None:
    """Exactly one motion is given, and options of records only with a record."""
    motions = (("--harmonic", harmonic), ("--pulse", pulse), ("--synthetic", synthetic), ("--motion", file))
    given = [one for one, value in motions if value]
    if len(given) != 1:
        what = "no motion is given" if not given else f"{' and '.join(given)} are both given"
        raise InputError(f"{what}; give one of --harmonic, --pulse, --synthetic and --motion.")
    for option, value in (("--unit", unit), ("--dt", dt), ("--component", component)):
        if value is not None and not file:
            raise InputError(f"{option} describes a record, but none is given; leave it out or give --motion FILE.")
