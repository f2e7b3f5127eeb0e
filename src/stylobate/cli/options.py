"""Options that several commands share, and what they mean together."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InputError

if TYPE_CHECKING:
    from ..column import Column
    from ..column.scatter import Scatter
    from ..column.structure import Structure
    from ..models.base import Model
    from ..motion import Motion
    from ..motion.request import MotionRequest
    from ..motion.scatter import MotionScatter

#: Options that make the request for motions.
REQUEST = (
    *("harmonic", "across", "pulse", "synthetic", "motion", "unit", "dt", "component", "azimuth", "azimuths", "signs"),
    *("condition", "scale", "pga", "vertical"),
)


def _models(incomplete: str) -> list[str]:
    """Names of models that begin so, for the completion of a shell."""
    from ..models.registry import MODELS

    return [name for name in MODELS if name.startswith(incomplete)]


def _columns(incomplete: str) -> list[str]:
    """Presets and column files that begin so, for the completion of a shell."""
    from ..column.presets import PRESETS

    folder, _, start = incomplete.rpartition("/")
    there = Path(folder or ("/" if incomplete.startswith("/") else "."))
    files = sorted(one for one in there.glob("*") if one.is_dir() or one.suffix == ".toml") if there.is_dir() else []
    found = [f"{folder}/{one.name}" if "/" in incomplete else one.name for one in files if one.name.startswith(start)]
    return [*(name for name in PRESETS if name.startswith(incomplete)), *found]


ColumnName = Annotated[
    str,
    typer.Argument(metavar="COLUMN", help="Name of a preset, or a column file (TOML).", autocompletion=_columns),
]
Project = Annotated[
    str | None,
    typer.Option(
        "--project",
        metavar="AZIMUTH",
        help="What is found out of the plane, projected onto the vertical plane of this azimuth, such as 30deg.",
    ),
]
StructureName = Annotated[
    str,
    typer.Argument(
        metavar="COLUMN",
        help="Name of a preset, or a file (TOML) of a column or of an assembly of blocks.",
        autocompletion=_columns,
    ),
]
ModelName = Annotated[
    str,
    typer.Option(
        "--model",
        metavar="MODEL",
        help="How it is computed: dem2d, dem3d, rigid-block, rigid-beam, housner.",
        autocompletion=_models,
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
    typer.Option("--component", metavar="C", help="The one component to use: its number, label or azimuth."),
]
Across = Annotated[
    str | None,
    typer.Option("--across", metavar="F,A,PHASE", help="Sine along y beside --harmonic, such as 1.0Hz,0.15g,90deg."),
]
Azimuth = Annotated[
    str | None,
    typer.Option("--azimuth", metavar="ANGLE", help="Turn the whole motion, so that x points there, such as 30deg."),
]
Azimuths = Annotated[
    str | None,
    typer.Option("--azimuths", metavar="A:A:N", help="Every motion turned to each of these, such as 0:330:12."),
]
Signs = Annotated[str, typer.Option("--signs", metavar="+|both", help="Every motion as it is, or reversed as well.")]
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
Whole = Annotated[
    bool, typer.Option("--whole", help="Step all of a record, its quiet before, between and after shocks too.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on standard output, and nothing else there.")]
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Folder for files and figures; without it none are written.")
]
Replicates = Annotated[
    str | None,
    typer.Option("--replicates", metavar="N", help="How sure that is: so many columns like this one, by --scatter."),
]
Seed = Annotated[
    str | None, typer.Option("--seed", metavar="N", help="Of these columns; the same seed, the same ones.")
]
ScatterSizes = Annotated[
    str | None,
    typer.Option(
        "--scatter",
        metavar="NAME=SIZE,…",
        help="How they differ; friction=10%,joint_stiffness=20%,density=2%,width=0.5%,height=0.5%,offset=0.3%.",
    ),
]
Threads = Annotated[str | None, typer.Option("--threads", metavar="N", help="Threads to use; all cores by default.")]

Dask = Annotated[
    str | None,
    typer.Option(
        "--dask", metavar="ADDRESS|local", help="Compute on a Dask cluster: its scheduler, or local for workers here."
    ),
]


def the_column(name: str, project: str | None = None) -> Column:
    """The preset or the column of a file of that name, in a vertical plane where one is asked for."""
    from ..column.files import load_column

    return _in_plane(load_column(name), project)


def the_structure(name: str, project: str | None = None) -> Structure:
    """As :func:`the_column`, or the assembly of a file."""
    from ..column.assembly_files import load_structure

    return _in_plane(load_structure(name), project)


def _in_plane(structure: Any, project: str | None) -> Any:
    from ..column.projection import projected
    from ..motion.specs import parse_angle

    if project is None:
        return structure
    if structure.stack is None:
        what = f"{structure.name!r} is {structure.described}, which lies in a plane"
        raise InputError(f"--project is for columns, and {what}.")
    try:
        azimuth = parse_angle(project)
    except InputError:
        raise InputError(f"--project is {project!r}; write it with its unit, such as 30deg.") from None
    return projected(structure.stack, azimuth)


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


def the_engine(context: typer.Context, dask: str | None, threads: int) -> None:
    """From here to the end of the command runs are computed by threads, or by the workers of a Dask cluster."""
    if dask is not None:
        from ..campaign.cluster import on_cluster
        from . import console

        context.with_resource(on_cluster(dask, threads, console.note))


def the_tail(text: str) -> float:
    """Time after the motion [s]."""
    from ..motion.specs import parse_time

    return parse_time(text, "tail")


def the_request(context: typer.Context, **changes: Any) -> MotionRequest:
    """The request for motions that the options of a command make, checked before anything is read.

    Parameters
    ----------
    context : typer.Context
        Of the command, with its options under the names that the request has.
    **changes
        Instead of what the context holds.
    """
    from ..motion.request import MotionRequest

    asked = {key: value for key, value in context.params.items() if key in REQUEST}
    return MotionRequest.typed(**asked | changes)


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


def whole(option: str, text: str, example: int) -> int:
    """A whole number as typed after an option."""
    if not text.isdecimal():
        raise InputError(f"{option} is {text!r}; allowed is a whole number, such as {example}.")
    return int(text)


def share(text: str, example: str) -> float:
    """A share as typed: ``1%`` or ``0.01``."""
    number, percent = text.strip().removesuffix("%"), text.strip().endswith("%")
    try:
        return float(number) / (100.0 if percent else 1.0)
    except ValueError:
        raise InputError(f"{text!r} is no size; write it as {example}.") from None


def the_population(
    replicates: str | None, scatter: str | None, seed: str | None, **others: str | None
) -> dict[str, Any] | None:
    """Arguments ``replicates``, ``scatter`` and ``seed`` that the options describe; None if no replicates are asked for.

    ``others`` are more options, by name, that are for replicates only.
    """
    if replicates is None:
        for option, value in {"--scatter": scatter, "--seed": seed, **others}.items():
            if value is not None:
                raise InputError(
                    f"{option} is for columns like this one; give --replicates as well, e.g. --replicates 30."
                )
        return None
    return {
        "replicates": whole("--replicates", replicates, 30),
        "scatter": None if scatter is None else the_scatter(scatter),
        "seed": 0 if seed is None else whole("--seed", seed, 1),
    }


def the_twins(
    stone: Structure, model: Model, asked: dict[str, Any] | None, to_the_ground: bool = False
) -> dict[str, Any] | None:
    """The columns that are computed beside this one: as asked for, or as many as cost nothing; None without any."""
    from ..campaign.twins import the_twins as drawn

    if asked is not None:
        if asked["replicates"] == 0:
            return None
        drawn(stone, model, **asked)
        return asked
    if not model.carried(stone) or to_the_ground:
        return None
    free = {"replicates": model.carries, "scatter": None, "seed": 0}
    try:
        drawn(stone, model, **free)
    except InputError:  # so close to falling as it was found that no twin of it stands
        return None
    return free


def the_scatter(text: str) -> Scatter:
    """Sizes of the scatter as typed, by name; what is not named does not scatter."""
    from ..column.scatter import LARGEST, Scatter

    return Scatter(**_sizes("--scatter", text, LARGEST, "--scatter friction=10%,joint_stiffness=20%"))


def motion_scatter(text: str) -> MotionScatter:
    """Sizes of the scatter of a motion as typed, likewise."""
    from ..motion.scatter import LARGEST_OF_MOTION, MotionScatter

    example = "--motion-scatter amplitude=1%,phase=0.1"
    return MotionScatter(**_sizes("--motion-scatter", text, LARGEST_OF_MOTION, example))


def _sizes(option: str, text: str, names: Iterable[str], example: str) -> dict[str, float]:
    sizes = dict.fromkeys(names, 0.0)
    for part in text.split(","):
        name, _, size = part.partition("=")
        if name.strip() not in sizes:
            raise InputError(f"{option} names {name.strip()!r}; names are {', '.join(sizes)}, e.g. {example}.")
        sizes[name.strip()] = share(size, example)
    return sizes
