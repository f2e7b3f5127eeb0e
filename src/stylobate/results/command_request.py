"""Request of a command, and the runs of others that results rest on."""

from __future__ import annotations

import json
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..atomic import LIST, OwnFiles, digest
from ..column.assembly_files import FROM_DICT
from ..column.structure import Structure
from ..constants import g
from ..errors import InputError
from ..messages import MESSAGES, joined, restored, say
from ..models.base import Model
from ..models.registry import MODELS, model_class
from ..motion import Motion
from ..motion.orientation import record_of
from ..probability.evidence import STOOD
from ..response.words import ROUND_IN_THE_PLANE, UNDAMPED_WOBBLE, cautions_in_space, undamped
from ..text_tables import printable, read_bytes
from ..verdicts.directions import direction_of
from ..version import __version__

if TYPE_CHECKING:
    import pandas


#: Largest JSON file of a result [bytes].
MOST = 500_000_000


def read_json(path: Path) -> dict[str, Any]:
    """The object in a JSON file.

    Raises
    ------
    InputError
        There is none, or it holds something else.
    """
    content = read_bytes(path, MOST)
    try:
        document = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{printable(path)} is no JSON that can be read ({error}); run again.") from None
    if not isinstance(document, dict):
        raise InputError(f"{printable(path)} holds no object as stylobate writes it; run again.")
    messages = document.pop(MESSAGES, {})
    try:
        return restored(document, messages)
    except (AttributeError, KeyError, TypeError, ValueError):
        raise InputError(f"{printable(path)} holds messages as nobody writes them; run again.") from None


#: Number of the form of these files; a larger one is of a later version.
FORM = 1


def request_file_name(command: str) -> str:
    """Name of the file of a command, such as ``asked-critical.json``: one folder may hold results of several."""
    return f"asked-{command}.json"


def others_in(folder: Path, command: str) -> list[str]:
    """Other commands that left a result in a folder."""
    names = sorted(path.name for path in folder.glob(request_file_name("*")) if path.name != request_file_name(command))
    start, end = request_file_name("*").split("*")
    return [name.removeprefix(start).removesuffix(end) for name in names]


@dataclass(frozen=True)
class CommandRequest:
    """Request of a command.

    Parameters
    ----------
    command : tuple of str
        Its words as typed, without the name of the program; empty where it was not called on a command line.
    structures : tuple of dict
        Each under its kind, ``column`` or ``assembly``, as plain values, with its ``digest``.
    models : tuple of dict
        ``name`` and ``parameters``.
    motions : tuple of dict
        ``name``, ``digest``, ``record``, ``components``, ``azimuths``, ``factor``, ``peaks_g``, ``processing``, ``left_out``
        and what their files say of themselves (``metadata``); ``scales``, by which runs multiplied them: the least factor,
        the largest one and how many there are.
    sources : tuple of dict
        Tables of runs that it was computed from, see :class:`~stylobate.results.command_request.Source`.
    options : dict
        What else was asked, by the name of the option.
    warnings : tuple of str
        Said while it was computed.
    version, python, machine, day : str
        Of the package and of the machine; the day as YYYY-MM-DD.
    """

    command: tuple[str, ...] = ()
    structures: tuple[dict[str, Any], ...] = ()
    models: tuple[dict[str, Any], ...] = ()
    motions: tuple[dict[str, Any], ...] = ()
    sources: tuple[dict[str, Any], ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    version: str = __version__
    python: str = platform.python_version()
    machine: str = platform.machine()
    day: str = ""

    @classmethod
    def of(
        cls,
        command: Sequence[str] = (),
        *,
        structures: Sequence[Structure | dict[str, Any]] = (),
        models: Sequence[Model | dict[str, Any]] = (),
        motions: Sequence[Motion | dict[str, Any]] = (),
        sources: Sequence[dict[str, Any]] = (),
        runs: pandas.DataFrame | None = None,
        warnings: Sequence[str] = (),
        **options: Any,
    ) -> CommandRequest:
        """Present request, with the objects that it is asked for, or what another command has kept of them.

        Motions are given as the models take them; ``runs`` is the table that tells by how much each was multiplied.
        """
        return cls(
            tuple(command),
            tuple(
                structure
                if isinstance(structure, dict)
                else {structure.kind: structure.to_dict(), "digest": structure.digest}
                for structure in structures
            ),
            tuple(
                model if isinstance(model, dict) else {"name": model.name, "parameters": model.parameters()}
                for model in models
            ),
            tuple(
                motion if isinstance(motion, dict) else _motion(motion) | scales_of(runs, motion.name)
                for motion in motions
            ),
            tuple(sources),
            options,
            tuple(warnings),
            day=date.today().isoformat(),
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"form": FORM} | asdict(self)

    @classmethod
    def read(cls, path: Path) -> CommandRequest:
        """Read the file of a command.

        Raises
        ------
        InputError
            It is damaged, or of a later version.
        """
        document = read_json(path)
        form = document.pop("form", None)
        if isinstance(form, int) and form > FORM:
            raise InputError(
                f"{printable(path)} is of form {form}; this version of stylobate reads up to {FORM}: update it, or run "
                "again."
            )
        try:
            fields: dict[str, Any] = {
                key: tuple(value) if isinstance(value, list) else value
                for key, value in document.items()
                if key in cls.__dataclass_fields__
            }
            if form != FORM:
                raise ValueError("it has no form")
            for key, need in (("structures", ()), ("models", ("name",)), ("motions", ("name",)), ("sources", ())):
                if not all(isinstance(entry, dict) and entry.keys() >= {*need} for entry in fields.get(key, ())):
                    raise ValueError(f"{key!r} is no list of its entries")
            return cls(**fields)
        except (TypeError, ValueError) as error:
            raise InputError(f"{printable(path)} is not what stylobate wrote ({error}); run again.") from None

    def holds(self, other: CommandRequest) -> bool:
        """Whether all that stood and shook in another request is in this one as well."""
        mine = {entry.get("digest") for entry in (*self.structures, *self.motions)}
        return {entry.get("digest") for entry in (*other.structures, *other.motions)} <= mine

    @property
    def stood(self) -> list[Structure]:
        """Structure, made again."""
        return [
            make(structure[kind])
            for structure in self.structures
            for kind, make in FROM_DICT.items()
            if kind in structure
        ]


def _motion(motion: Motion) -> dict[str, Any]:
    metadata = {key: str(value) for key, value in motion.metadata.items() if key not in ("references", "left_out")}
    return {
        "name": motion.name,
        "digest": motion.digest,
        "duration_s": motion.duration,
        "dt_s": motion.dt,
        "record": record_of(motion),
        **direction_of(motion),
        "components": list(motion.components),
        "azimuths": dict(motion.metadata.get("azimuths") or {}),
        "factor": motion.factor,
        "peaks_g": {axis: peak / g for axis, peak in motion.peaks.items()},
        "processing": list(motion.processing),
        "left_out": list(motion.metadata.get("left_out", ())),
        "references": list(motion.metadata.get("references", ())),
        "metadata": metadata,
    }


def scales_of(runs: pandas.DataFrame | None, motion: str) -> dict[str, Any]:
    """Smallest and largest factor by which runs multiplied a motion, and how many of them differ; empty if not told."""
    key = next(
        (heading for heading in ("motion", "record") if runs is not None and heading in runs and "factor" in runs), None
    )
    if runs is None or key is None:
        return {}
    mine: Any = runs.loc[runs[key].astype(str) == motion, "factor"]
    return {"scales": [float(mine.min()), float(mine.max()), int(mine.nunique())]} if len(mine) else {}


#: Commands by the stem of the table of runs that they write.
COMMANDS = {"runs": "ida", "states": "states", "study": "study", "suite": "suite"}


@dataclass(frozen=True, eq=False)
class Source:
    """A table of runs, as far as a result rests on it.

    Parameters
    ----------
    path : Path
        As given: a folder, or a file.
    table : Path
    runs : pandas.DataFrame
        The rows that are used.
    """

    path: Path
    table: Path
    runs: pandas.DataFrame

    @cached_property
    def kept(self) -> CommandRequest | str:
        """Request of the command that wrote the table, or why that is not known."""
        command = COMMANDS.get(self.table.stem)
        file = self.table.parent / request_file_name(command or "")
        if command is None or not file.is_file() or not OwnFiles(self.table.parent).lists(self.table):
            return say("{table.table.name} lies beside no results of stylobate.", table=self)
        try:
            return CommandRequest.read(file)
        except InputError as error:
            return str(error)

    @property
    def request(self) -> CommandRequest | None:
        """Request of the command that wrote the table; None where that is not known."""
        return self.kept if isinstance(self.kept, CommandRequest) else None

    def names(self, column: str) -> list[str]:
        """Different values of a column of the table; none where it has no such column."""
        return list(dict.fromkeys(map(str, self.runs[column]))) if column in self.runs else []

    @property
    def stood(self) -> list[str]:
        """Structures of these runs, as the table calls them: columns, or states of one."""
        return next((names for heading in STOOD if (names := self.names(heading))), [])

    @property
    def structures(self) -> list[dict[str, Any]]:
        """Structures of these runs, as kept by the command."""
        request, names = self.request, self.stood
        kept = request.structures if request is not None else ()
        labels = request.options.get("states") if request is not None else None
        if labels and len(labels) == len(kept):
            return [structure | {"state": label} for label, structure in zip(labels, kept) if label in names]
        return [structure for structure in kept if not names or any(_named(structure, name) for name in names)]

    @property
    def models(self) -> list[dict[str, Any]]:
        """Models of these runs, as kept by the command."""
        request, names = self.request, self.names("model")
        return [
            model for model in (request.models if request is not None else ()) if not names or model["name"] in names
        ]

    @property
    def doubt(self) -> str:
        """Caveat before all that rests on these runs: stones in space struck, round columns in a plane, undamped wobble."""
        drums = [drum for structure in self.structures for drum in (structure.get("column") or {}).get("drums", ())]
        models = [model for model in self.models if model["name"] in MODELS]
        in_plane, in_space = [], []
        for model in models:
            known = model.get("parameters") or {}
            (in_plane if model_class(model["name"]).is_plane(known) else in_space).append(known)
        pairs = [(kind, part) for structure in self.structures for kind, part in structure.items() if kind in FROM_DICT]
        if stones := [FROM_DICT[kind](part) for kind, part in pairs if "stones" in part]:
            return joined(
                " ", dict.fromkeys(text for known in in_space or [{}] for text in cautions_in_space(stones, known))
            )
        if in_plane and any(drum.get("section") == "circular" for drum in drums):
            return ROUND_IN_THE_PLANE
        return UNDAMPED_WOBBLE if drums and any(map(undamped, in_space)) else ""

    @property
    def motions(self) -> list[dict[str, Any]]:
        """Motions of these runs, as kept by the command, each with the factors by which it was multiplied."""
        request = self.request
        scaled = None if self.table.stem == "suite" else self.runs  # a suite runs its motions as they are
        return (
            []
            if request is None
            else [{**scales_of(scaled, str(motion["name"])), **motion} for motion in request.motions]
        )

    @property
    def facts(self) -> dict[str, Any]:
        """Facts that are kept beside the result that rests on it."""
        request, records = self.request, self.names("record")
        listed = (self.table.parent / LIST).is_file() and OwnFiles(self.table.parent).lists(self.table)
        return {
            "path": str(self.path),
            "table": self.table.name,
            "sha256": digest(self.table),
            "unchanged": OwnFiles(self.table.parent).holds(self.table) if listed else None,
            "runs": len(self.runs),
            "records": records,
            "columns": self.stood,
            "models": self.names("model"),
            "not_told": self.kept if isinstance(self.kept, str) else None,
            "command": None if request is None else list(request.command),
            "version": None if request is None else request.version,
            "day": None if request is None else request.day,
        }


def kept_of(sources: Sequence[Source]) -> dict[str, Any]:
    """Part of these runs that results resting on them keep, as :meth:`CommandRequest.of` takes it; each structure once."""
    by_digest: dict[str, dict[str, Any]] = {"structures": {}, "models": {}, "motions": {}}
    warnings: dict[str, None] = {}
    for source in sources:
        for kind, entries in by_digest.items():
            for value in getattr(source, kind):
                entries.setdefault(str(value.get("digest") or sorted(value.items(), key=str)), value)
        warnings |= dict.fromkeys(source.request.warnings if source.request is not None else ())
    kept = {kind: list(entries.values()) for kind, entries in by_digest.items()}
    return kept | {"sources": [source.facts for source in sources], "earlier": list(warnings)}


def _named(structure: dict[str, Any], name: str) -> bool:
    return any(isinstance(part, dict) and part.get("name") == name for part in structure.values())
