"""Request of a command, kept beside its results: the command line, what stood, models, motions and warnings."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..analysis.directions import direction_of
from ..column.assembly_files import FROM_DICT
from ..column.structure import Structure
from ..constants import g
from ..errors import InputError
from ..models.base import Model
from ..motion import Motion
from ..motion.orientation import record_of
from ..reading import shown
from ..version import __version__
from .json_files import read_json

if TYPE_CHECKING:
    import pandas

#: Number of the form of these files; a larger one is of a later version.
FORM = 1


def asked_file(command: str) -> str:
    """Name of the file of a command, such as ``asked-critical.json``: one folder may hold results of several."""
    return f"asked-{command}.json"


def others_in(folder: Path, command: str) -> list[str]:
    """Other commands that left a result in a folder."""
    names = sorted(path.name for path in folder.glob(asked_file("*")) if path.name != asked_file(command))
    start, end = asked_file("*").split("*")
    return [name.removeprefix(start).removesuffix(end) for name in names]


@dataclass(frozen=True)
class Asked:
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
        Tables of runs that it was computed from, see :class:`~stylobate.results.sources.Source`.
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
    ) -> Asked:
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
    def read(cls, path: Path) -> Asked:
        """Read the file of a command.

        Raises
        ------
        InputError
            It is damaged, or of a later version.
        """
        found = read_json(path)
        form = found.pop("form", None)
        if isinstance(form, int) and form > FORM:
            raise InputError(
                f"{shown(path)} is of form {form}; this version of stylobate reads up to {FORM}: update it, or run again."
            )
        try:
            fields: dict[str, Any] = {
                key: tuple(value) if isinstance(value, list) else value
                for key, value in found.items()
                if key in cls.__dataclass_fields__
            }
            if form != FORM:
                raise ValueError("it has no form")
            for key, need in (("structures", ()), ("models", ("name",)), ("motions", ("name",)), ("sources", ())):
                if not all(isinstance(one, dict) and one.keys() >= {*need} for one in fields.get(key, ())):
                    raise ValueError(f"{key!r} is no list of its entries")
            return cls(**fields)
        except (TypeError, ValueError) as error:
            raise InputError(f"{shown(path)} is not what stylobate wrote ({error}); run again.") from None

    def holds(self, other: Asked) -> bool:
        """Whether all that stood and shook in another request is in this one as well."""
        mine = {one.get("digest") for one in (*self.structures, *self.motions)}
        return {one.get("digest") for one in (*other.structures, *other.motions)} <= mine

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
    said = {key: str(value) for key, value in motion.metadata.items() if key not in ("references", "left_out")}
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
        "metadata": said,
    }


def scales_of(runs: pandas.DataFrame | None, motion: str) -> dict[str, Any]:
    """Smallest and largest factor by which runs multiplied a motion, and how many of them differ; empty if not told."""
    key = next((one for one in ("motion", "record") if runs is not None and one in runs and "factor" in runs), None)
    if runs is None or key is None:
        return {}
    mine: Any = runs.loc[runs[key].astype(str) == motion, "factor"]
    return {"scales": [float(mine.min()), float(mine.max()), int(mine.nunique())]} if len(mine) else {}
