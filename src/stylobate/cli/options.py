"""Options that several commands share, and what they mean together."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperCommand, TyperOption

from ..errors import InputError

if TYPE_CHECKING:
    from ..campaign.campaign import Campaign
    from ..column import Column
    from ..column.structure import Structure
    from ..models.base import Model
    from ..motion import Motion
    from ..motion.request import MotionRequest
    from .files import Files


# Options: groups that several commands share, handed to a command as one value; help on one screen, the rare by name.


@dataclass(frozen=True)
class Option:
    """An option of a command, as the default of a parameter or of a field of a group; without a flag, an argument."""

    metavar: str | None
    help: str
    default: Any
    flag: str | None
    complete: Callable[[str], list[str]] | None = None
    read: Callable[[str, str], Any] | None = None

    def parameter(self, name: str, kind: Any) -> inspect.Parameter:
        """The option of that name as typer takes it."""
        default = inspect.Parameter.empty if self.default is ... else self.default
        if self.read is not None:
            kind = str | None if default is None else str
        words: Any = {"metavar": self.metavar, "help": self.help, "autocompletion": self.complete}
        flag = f"--{name.replace('_', '-')}" if self.flag is None else self.flag
        annotation = Annotated[kind, typer.Option(flag, **words) if flag else typer.Argument(**words)]
        return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)

    def value(self, name: str, typed: Any) -> Any:
        """What is meant by what was typed for the option of that name, which errors are about."""
        key = (self.flag or name).strip("-").replace("-", "_")
        return typed if self.read is None or typed is None else self.read(typed, key)


def option(metavar: str | None, help: str, default: Any = None, flag: str | None = None, **more: Any) -> Any:
    """An option called as its parameter, unless it has a ``flag`` of its own; ``...`` for one that must be given.

    ``read`` makes a value of what is typed, as is the default, and of the name for messages; ``complete`` gives what a shell
    completes it to.
    """
    return Option(metavar, help, default, flag, **more)


def argument(metavar: str, help: str, default: Any = ..., complete: Any = None) -> Any:
    """What stands without a flag."""
    return Option(metavar, help, default, "", complete)


@dataclass(frozen=True)
class Group:
    """Options as fields of a value."""


class Without:
    """Fields of a group that are no options of a command: ``Annotated[Motions, Without("scale", "pga")]``."""

    def __init__(self, *names: str) -> None:
        self.names = names


def takes(command: Callable[..., None], within: Callable[[], AbstractContextManager[None]]) -> Callable[..., None]:
    """The command with its options, and those of its groups in their places; it is called with the groups as values.

    Parameters
    ----------
    command : callable
    within : callable
        Makes what the command is called in.
    """
    signature = inspect.signature(command, eval_str=True)
    options: list[inspect.Parameter] = []
    own: dict[str, Option] = {}
    groups: dict[str, tuple[type[Group], dict[str, Option], dict[str, Option]]] = {}
    for parameter in signature.parameters.values():
        plain = get_origin(parameter.annotation) is not Annotated
        kind, *notes = (parameter.annotation,) if plain else get_args(parameter.annotation)
        if isinstance(parameter.default, Option):
            own[parameter.name] = parameter.default
            options.append(parameter.default.parameter(parameter.name, kind))
        elif not (isinstance(kind, type) and issubclass(kind, Group)):
            options.append(parameter.replace(kind=parameter.KEYWORD_ONLY))
        else:
            every: dict[str, Any] = {field.name: field.default for field in fields(kind)}
            left_out = {name: every.pop(name) for note in notes if isinstance(note, Without) for name in note.names}
            types = get_type_hints(kind)
            options += [option.parameter(name, types[name]) for name, option in every.items()]
            groups[parameter.name] = kind, every, left_out

    @wraps(command)
    def taking(**given: Any) -> None:
        with within():
            values = {}
            for name, (kind, every, left_out) in groups.items():
                stated = {key: option.value(key, given.pop(key)) for key, option in every.items()}
                values[name] = kind(
                    **stated, **{key: option.value(key, option.default) for key, option in left_out.items()}
                )
            command(**given | {key: option.value(key, given[key]) for key, option in own.items()}, **values)

    taking.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    taking.__annotations__ = {option.name: option.annotation for option in options}
    return taking


#: Options that few runs need, of commands that have many.
RARE = frozenset({
    "across", "synthetic", "unit", "dt", "columns", "component", "azimuth", "azimuths", "signs", "condition",
    "vertical", "whole", "until_end", "output_interval", "settings", "losses", "project", "scatter", "motion_scatter",
    "seed", "pictures", "half_step", "threads", "dask", "device", "mix_devices",
})  # fmt: skip

#: Options that fit on a screen with their help.
FEW = 22

#: Columns of a line of help.
WIDTH = 100


class Command(TyperCommand):
    """A command whose help is one screen."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Options as typed, each once unless it may be repeated; ``--help-all`` is a help that leaves nothing out."""
        ctx.meta[_ALL] = "--help-all" in args
        args = ["--help"] if ctx.meta[_ALL] else args
        _, _, given = self.make_parser(ctx).parse_args(list(args))
        for option in given:
            if isinstance(option, TyperOption) and not (option.multiple or option.is_flag) and given.count(option) > 1:
                ctx.fail(f"{option.opts[0]} is given {given.count(option)} times; give it once.")
        return super().parse_args(ctx, args)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options: all where they were asked for, else the rare ones by their names."""
        options = [param for param in self.params if isinstance(param, TyperOption)]
        few = ctx.meta.get(_ALL) or len(options) <= FEW
        rare = [] if few else [option for option in options if option.name in RARE]
        for rare_option in rare:
            rare_option.hidden = True
        super().format_options(ctx, formatter)
        for rare_option in rare:
            rare_option.hidden = False
        if rare:
            with formatter.section("More options, which --help-all explains"):
                names = " ".join(option.opts[0] for option in rare)
                for line in wrap(names, formatter.width - formatter.current_indent, break_on_hyphens=False):
                    formatter.write_text(line)


_ALL = "stylobate.help_all"


def time(text: str, name: str) -> float:
    """A time as typed, with its unit [s]."""
    from ..motion.specs import parse_time

    return parse_time(text, name)


def acceleration(text: str, name: str) -> float:
    """An acceleration as typed, with its unit [m/s²]."""
    from ..motion.specs import parse_acceleration

    return parse_acceleration(text, name)


def pressure(text: str, name: str) -> float:
    """A pressure or strength as typed, with its unit [Pa]."""
    from ..motion.specs import parse_pressure

    return parse_pressure(text, name)


def number(text: str, name: str, example: str = "such as 0.5") -> float:
    """A number as typed."""
    from ..motion.specs import parse_number

    return parse_number(f"`{name}`", text, example)


def whole_number(text: str, name: str) -> int:
    """A whole number as typed."""
    if not text.isdecimal():
        raise InputError(f"`{name}` is {text!r}; allowed is a whole number from 0 on, such as 30.", name)
    return int(text)


def scatter(text: str, name: str) -> Any:
    """Sizes as typed, each a share such as ``1%`` or ``0.01``, of the scatter of columns or of a motion."""
    from ..column.scatter import LARGEST, Scatter
    from ..motion.pulses import LARGEST_OF_MOTION, MotionScatter

    kind, names, example = Scatter, LARGEST, f"`{name}=friction=10%,joint_stiffness=20%`"
    if name == "motion_scatter":
        kind, names, example = MotionScatter, LARGEST_OF_MOTION, f"`{name}=amplitude=1%,phase=0.1`"
    sizes = dict.fromkeys(names, 0.0)
    for part in text.split(","):
        key, _, size = map(str.strip, part.partition("="))
        if key not in sizes:
            raise InputError(f"`{name}` names {key!r}; names are {', '.join(sizes)}, e.g. {example}.", name)
        try:
            sizes[key] = float(size.removesuffix("%")) / (100.0 if size.endswith("%") else 1.0)
        except ValueError:
            raise InputError(f"{size!r} is no size; write it as {example}.", name) from None
    return kind(**sizes)


def _models(incomplete: str) -> list[str]:
    """Names of models that begin so, for the completion of a shell."""
    from ..models.registry import MODELS

    return [name for name in MODELS if name.startswith(incomplete)]


def _columns(incomplete: str) -> list[str]:
    """Presets and column files that begin so, for the completion of a shell."""
    from ..column.catalogue import ASSEMBLIES, PRESETS

    folder, _, start = incomplete.rpartition("/")
    there = Path(folder or ("/" if incomplete.startswith("/") else "."))
    files = (
        sorted(path for path in there.glob("*") if path.is_dir() or path.suffix == ".toml") if there.is_dir() else []
    )
    completions = [
        f"{folder}/{file.name}" if "/" in incomplete else file.name for file in files if file.name.startswith(start)
    ]
    return [*(name for name in (*PRESETS, *ASSEMBLIES) if name.startswith(incomplete)), *completions]


#: What stands: a column; a column or an assembly.
COLUMN = argument("COLUMN", "Name of a preset, or a column file (TOML).", complete=_columns)
STRUCTURE = argument(
    "COLUMN", "Name of a preset, or a file (TOML) of a column or of an assembly of blocks.", complete=_columns
)


def model(default: str | None = "dem2d") -> Any:
    """The option that names a model."""
    return option(
        "MODEL", "How it is computed: dem2d, dem3d, rigid-block, rigid-beam, housner.", default, complete=_models
    )


@dataclass(frozen=True)
class Motions(Group):
    """What is shaken with."""

    harmonic: str | None = option("F,A,T", "Sine from rest, such as 1.0Hz,0.3g,10s.")
    across: str | None = option("F,A,PHASE", "Sine along y beside --harmonic, such as 1.0Hz,0.15g,90deg.")
    pulse: str | None = option(
        "KIND,F,A[,T]", "Pulse, such as ricker,1.0Hz,0.3g; the time is the length of the whole run."
    )
    synthetic: str | None = option("SPEC", "Simulated motion, such as greece,6.5Mw,20km,seed=3.")
    motion: list[Path] | None = option(
        "FILE|DIR",
        "Record, once per file of its components; a folder of records; or sample:NAME (stylobate motion --samples).",
    )
    unit: str | None = option(None, "Unit of the record where the file names none, such as g.")
    dt: str | None = option("TIME", "Step of a record without times, such as 0.01s.")
    columns: str | None = option("NAMES", 'Columns of a text file: "t [s], x [g], -, z [g]", - to leave one out.')
    component: str | None = option("C", "The one component to use: its number, label or azimuth.")
    azimuth: str | None = option("ANGLE", "Turn the whole motion, so that x points there, such as 30deg.")
    azimuths: str | None = option("A:A:N", "Every motion turned to each of these, such as 0:330:12.")
    signs: str = option("+|both", "Every motion as it is, or reversed as well.", "+")
    condition: list[str] | None = option("STEP", "Conditioning, in the order given, such as bandpass=0.1Hz,25Hz.")
    scale: str | None = option("X", "Multiply the motion, such as 1.5.")
    pga: str | None = option("A", "Scale the motion to this horizontal peak, such as 0.4g.")
    vertical: str = option("on|off", "Whether the vertical component acts.", "on")

    def request(self, **changes: Any) -> MotionRequest:
        """The request for motions, checked before anything is read; ``changes`` instead of what is typed."""
        from ..motion.request import MotionRequest

        return MotionRequest.typed(**vars(self) | changes)


@dataclass(frozen=True)
class Modelling(Group):
    """How what stands is computed."""

    settings: list[str] | None = option("NAME=VALUE", "Option of the model; may be repeated.", flag="--set")
    losses: str | None = option(
        "none|stone|FILE",
        "What joints lose: as other options say, as measured stone, or as a file of calibrate says (dem2d, dem3d).",
    )
    project: str | None = option(
        "AZIMUTH", "What is found out of the plane, projected onto the vertical plane of this azimuth, such as 30deg."
    )

    def column(self, name: str) -> Column:
        """The preset or the column of a file of that name, in a vertical plane where one is asked for."""
        from ..column.files import load_column

        return self._in_plane(load_column(name))

    def structure(self, name: str) -> Structure:
        """The same, or the assembly of a file."""
        from ..column.assembly_files import load_structure

        return self._in_plane(load_structure(name))

    def _in_plane(self, structure: Any) -> Any:
        from ..column.projection import projected
        from ..motion.specs import parse_angle

        if self.project is None:
            return structure
        if structure.stack is None:
            lies = ", which lies in a plane" if structure.space_joints is None else ""
            raise InputError(
                f"`project` is for columns, and {structure.name!r} is {structure.described}{lies}.", "project"
            )
        try:
            azimuth = parse_angle(self.project)
        except InputError:
            raise InputError(
                f"`project` is {self.project!r}; write it with its unit, such as 30deg.", "project"
            ) from None
        return projected(structure.stack, azimuth)

    def model(self, name: str) -> Model:
        """The model of that name with its options and losses."""
        return self.models([(name, self.settings)])[0]

    def models(self, named: Sequence[tuple[str, list[str] | None]]) -> list[Model]:
        """Models by name with options of their own, and with losses for those that know them; see :func:`make_models`."""
        from ..models.registry import make_models

        values = [(name, _settings(settings or [])) for name, settings in named]
        if self.losses is not None and all("losses" in own for _, own in values):
            raise InputError("losses are given twice, by `losses` and by `set`; give them once.", "losses")
        return make_models(values, self.losses)


#: Options of motions that are not for files which are named as arguments.
FILES_NAMED = "harmonic", "across", "pulse", "synthetic", "motion"

#: Options that make several motions of one.
SEVERAL = "azimuths", "signs"


@dataclass(frozen=True)
class Following(Group):
    """How long each run goes on."""

    tail: float = option("TIME", "Go on for this long after the motion, such as 5s.", "0s", read=time)
    whole: bool = option(None, "Step all of a record, its quiet before, between and after shocks too.", False)

    @property
    def fields(self) -> dict[str, Any]:
        """Fields of the campaign."""
        return {"tail": self.tail, "whole": self.whole}


@dataclass(frozen=True)
class Population(Group):
    """Columns like the one that stands."""

    replicates: int | None = option(
        "N", "How sure that is: so many columns like this one, by --scatter.", read=whole_number
    )
    scatter: Any = option(
        "NAME=SIZE,…",
        "How they differ; friction=10%,joint_stiffness=20%,density=2%,width=0.5%,height=0.5%,offset=0.3%; in space also "
        "stiffness_damping=80%,rolling_resistance=80%,law=50%,unknown_stiffness=100%.",
        read=scatter,
    )
    seed: int | None = option("N", "Of these columns; the same seed, the same ones.", read=whole_number)

    @property
    def fields(self) -> dict[str, Any]:
        """Fields of the campaign; none where no replicates are asked for."""
        if self.replicates is None:
            for name in ("scatter", "seed"):
                for_replicates(name, getattr(self, name))
            return {}
        return {"replicates": self.replicates, "scatter": self.scatter, "seed": self.seed or 0}


@dataclass(frozen=True)
class Execution(Group):
    """Where runs are computed, where results go, and whether they are told to people or as JSON."""

    threads: str | None = option("N", "Threads to use; all cores by default.")
    dask: str | None = option("ADDRESS|local", "Compute on a Dask cluster: its scheduler, or local for workers here.")
    device: str = option("cpu|gpu", "Let the graphics card of this machine compute what it has kernels for.", "cpu")
    mix_devices: bool = option(None, "Go on from finished runs that another kind of device has computed.", False)
    out: Path | None = option("DIR", "Folder for files and figures; without it none are written.")
    as_json: bool = option(
        None, "Print one JSON object on standard output, and nothing else there.", False, flag="--json"
    )

    def __post_init__(self) -> None:
        self.campaign()

    def campaign(self, *groups: Following | Population, **fields: Any) -> Campaign:
        """How runs are made, checked: what these groups and further fields say, computed here."""
        from ..campaign.campaign import Campaign

        if self.threads is not None and not self.threads.isdecimal():
            raise InputError(
                f"`threads` is {self.threads!r}; allowed is a whole number from 1; leave it out to use all cores.",
                "threads",
            )
        for group in groups:
            fields |= group.fields
        threads = None if self.threads is None else int(self.threads)
        return Campaign(threads=threads, dask=self.dask, device=self.device, mix_devices=self.mix_devices, **fields)

    def refuse_for_one(self, why: str) -> None:
        """Refuse what computes many runs beside threads where there is one; ``why`` in words that follow the option."""
        for name, wanted in (("dask", self.dask is not None), ("device", self.device != "cpu")):
            if wanted:
                raise InputError(f"`{name}` {why}", name)

    @property
    def count(self) -> int:
        """Number of threads."""
        from ..simulate import thread_count

        return thread_count(self.campaign().threads)

    def files(self, command: str, *writes: str) -> AbstractContextManager[Files]:
        """Files of a command, by its name and theirs: see :func:`stylobate.cli.files.files`."""
        from .files import files

        return files(self.out, command, *writes)

    def place(self, file: Path) -> Path:
        """The file in the folder of ``--out``, which is made; where no folder is named, the file as it is."""
        if self.out is None:
            return file
        if self.out.exists() and not self.out.is_dir():
            raise InputError(f"`out` is {str(self.out)!r}, which is a file; name a folder.", "out")
        self.out.mkdir(parents=True, exist_ok=True)
        return self.out / file

    def emits(self, result: Mapping[str, Any]) -> bool:
        """Print the result as one JSON object where that is asked for, else leave it to be told to people."""
        from . import console

        if self.as_json:
            console.emit(result)
        return self.as_json


#: Options that say what computes many runs besides threads.
CAMPAIGNS = "dask", "device", "mix_devices"

#: Of commands whose runs are no campaign.
Plain = Annotated[Execution, Without(*CAMPAIGNS)]


def _settings(given: list[str]) -> dict[str, str]:
    """Options of a model as typed after ``--set``."""
    values: dict[str, str] = {}
    for text in given:
        key, sign, value = text.partition("=")
        if not sign or not key.strip():
            raise InputError(f"`set` is {text!r}; write it as name=value, e.g. `set=points=3`.", "set")
        if key.strip() in values:
            raise InputError(f"`set` {key.strip()} is given twice; give it once.", "set")
        values[key.strip()] = value.strip()
    return values


def input_facts(motion: Motion) -> dict[str, Any]:
    """Motion, under the names of the JSON object."""
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
    lines = {"motion": motion.describe()}
    if facts["azimuth_deg"] is not None:
        lines["direction"] = f"x to azimuth {facts['azimuth_deg']:g}°"
    if facts["left_out"]:
        lines["left out"] = "; ".join(facts["left_out"])
    done = [text for text in facts["processing"] if not text.startswith("left out: ")]
    if done:
        lines["processing"] = "; ".join(done)
    return lines


def with_twins(stone: Structure, model: Model, campaign: Campaign, given: bool) -> Campaign:
    """What is asked for, with as many columns like this one as cost nothing where no number is ``given``."""
    from ..campaign.twins import the_twins
    from ..column.scatter import usual_scatter
    from ..models.engine import engine_for

    number = campaign.replicates if given else engine_for(model, stone).twins
    # unasked they ride along, and what rides along is of one law
    scatter = campaign.scatter if given or not number else campaign.scatter or usual_scatter(stone.stack or stone)
    made = dataclasses.replace(campaign, replicates=number, scatter=scatter)
    try:
        if number:
            the_twins(stone, model, made)
    except InputError:
        if given:
            raise
        return campaign  # so close to falling as it was found that no twin of it stands
    return made


def for_replicates(name: str, value: Any) -> None:
    """Refuse an option that is for columns like one, where none are asked for."""
    if value is not None:
        raise InputError(
            f"`{name}` is for columns like this one; give `replicates` as well, e.g. `replicates=30`.", name
        )
