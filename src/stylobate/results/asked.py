"""What a command was asked, kept beside its results: the command line, what stood, models, motions and warnings."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date
from pathlib import Path
from typing import Any

from ..column.kinds import FROM_DICT
from ..column.structure import Structure
from ..errors import InputError
from ..models.base import Model
from ..motion import Motion
from ..reading import shown
from ..version import __version__
from .json_files import read_json

#: Number of the form of these files; a larger one is of a later version.
FORM = 1


def asked_file(command: str) -> str:
    """Name of the file of a command, such as ``asked-critical.json``: one folder may hold results of several."""
    return f"asked-{command}.json"


@dataclass(frozen=True)
class Asked:
    """What a command was asked.

    Parameters
    ----------
    command : tuple of str
        Its words as typed, without the name of the program; empty where it was not called on a command line.
    structures : tuple of dict
        Each under its kind, ``column`` or ``assembly``, as plain values, with its ``digest``.
    models : tuple of dict
        ``name`` and ``parameters``.
    motions : tuple of dict
        ``name``, ``digest``, ``processing``, ``left_out`` and what their files say of themselves (``metadata``).
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
        structures: Sequence[Structure] = (),
        models: Sequence[Model] = (),
        motions: Sequence[Motion] = (),
        warnings: Sequence[str] = (),
        **options: Any,
    ) -> Asked:
        """What is asked now, with the objects that it is asked for; motions as the models take them."""
        return cls(
            tuple(command),
            tuple({one.kind: one.to_dict(), "digest": one.digest} for one in structures),
            tuple({"name": one.name, "parameters": one.parameters()} for one in models),
            tuple(_motion(one) for one in motions),
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
            return cls(**fields)
        except (TypeError, ValueError) as error:
            raise InputError(f"{shown(path)} is not what stylobate wrote ({error}); run again.") from None

    @property
    def stood(self) -> list[Structure]:
        """What stood, made again."""
        return [make(one[kind]) for one in self.structures for kind, make in FROM_DICT.items() if kind in one]


def _motion(one: Motion) -> dict[str, Any]:
    said = {key: str(value) for key, value in one.metadata.items() if key not in ("references", "left_out")}
    return {
        "name": one.name,
        "digest": one.digest,
        "duration_s": one.duration,
        "dt_s": one.dt,
        "components": list(one.components),
        "processing": list(one.processing),
        "left_out": list(one.metadata.get("left_out", ())),
        "references": list(one.metadata.get("references", ())),
        "metadata": said,
    }
