"""Origin of a result: the table of runs of another command, with that command's request, or of anybody."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..analysis.evidence import STOOD
from ..errors import InputError
from ..messages import say
from ..models.registry import MODELS, model_class
from ..own_files import LIST, OwnFiles, digest
from ..response.words import ROUND_IN_THE_PLANE, UNDAMPED_WOBBLE, cautions_in_space, undamped
from .asked import FROM_DICT, Asked, asked_file, scales_of

if TYPE_CHECKING:
    import pandas

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
    def kept(self) -> Asked | str:
        """Request of the command that wrote the table, or why that is not known."""
        command = COMMANDS.get(self.table.stem)
        file = self.table.parent / asked_file(command or "")
        if command is None or not file.is_file() or not OwnFiles(self.table.parent).lists(self.table):
            return say("{table.table.name} lies beside no results of stylobate.", table=self)
        try:
            return Asked.read(file)
        except InputError as error:
            return str(error)

    @property
    def asked(self) -> Asked | None:
        """Request of the command that wrote the table; None where that is not known."""
        return self.kept if isinstance(self.kept, Asked) else None

    def names(self, column: str) -> list[str]:
        """Different values of a column of the table; none where it has no such column."""
        return list(dict.fromkeys(map(str, self.runs[column]))) if column in self.runs else []

    @property
    def stood(self) -> list[str]:
        """Structures of these runs, as the table calls them: columns, or states of one."""
        return next((found for one in STOOD if (found := self.names(one))), [])

    @property
    def structures(self) -> list[dict[str, Any]]:
        """Structures of these runs, as kept by the command."""
        asked, names = self.asked, self.stood
        kept = asked.structures if asked is not None else ()
        labels = asked.options.get("states") if asked is not None else None
        if labels and len(labels) == len(kept):
            return [one | {"state": label} for label, one in zip(labels, kept) if label in names]
        return [one for one in kept if not names or any(_named(one, name) for name in names)]

    @property
    def models(self) -> list[dict[str, Any]]:
        """Models of these runs, as kept by the command."""
        asked, names = self.asked, self.names("model")
        return [model for model in (asked.models if asked is not None else ()) if not names or model["name"] in names]

    @property
    def doubt(self) -> str:
        """Caveat before all that rests on these runs: stones in space struck, round columns in a plane, undamped wobble."""
        drums = [drum for one in self.structures for drum in (one.get("column") or {}).get("drums", ())]
        models = [one for one in self.models if one["name"] in MODELS]
        in_plane, in_space = [], []
        for model in models:
            known = model.get("parameters") or {}
            (in_plane if model_class(model["name"]).is_plane(known) else in_space).append(known)
        pairs = [(kind, one) for structure in self.structures for kind, one in structure.items() if kind in FROM_DICT]
        if stones := [FROM_DICT[kind](one) for kind, one in pairs if "stones" in one]:
            return " ".join(
                dict.fromkeys(text for known in in_space or [{}] for text in cautions_in_space(stones, known))
            )
        if in_plane and any(drum.get("section") == "circular" for drum in drums):
            return f"{ROUND_IN_THE_PLANE}."
        return UNDAMPED_WOBBLE if drums and any(map(undamped, in_space)) else ""

    @property
    def motions(self) -> list[dict[str, Any]]:
        """Motions of these runs, as kept by the command, each with the factors by which it was multiplied."""
        asked = self.asked
        scaled = None if self.table.stem == "suite" else self.runs  # a suite runs its motions as they are
        return (
            [] if asked is None else [{**scales_of(scaled, str(motion["name"])), **motion} for motion in asked.motions]
        )

    @property
    def facts(self) -> dict[str, Any]:
        """Facts that are kept beside the result that rests on it."""
        asked, records = self.asked, self.names("record")
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
            "command": None if asked is None else list(asked.command),
            "version": None if asked is None else asked.version,
            "day": None if asked is None else asked.day,
        }


def kept_of(sources: Sequence[Source]) -> dict[str, Any]:
    """Part of these runs that results resting on them keep, as arguments of :meth:`Asked.of`; each structure once."""
    found: dict[str, dict[str, Any]] = {"structures": {}, "models": {}, "motions": {}}
    warnings: dict[str, None] = {}
    for source in sources:
        for kind, some in found.items():
            for value in getattr(source, kind):
                some.setdefault(str(value.get("digest") or sorted(value.items(), key=str)), value)
        warnings |= dict.fromkeys(source.asked.warnings if source.asked is not None else ())
    kept = {kind: list(some.values()) for kind, some in found.items()}
    return kept | {"sources": [source.facts for source in sources], "earlier": list(warnings)}


def _named(structure: dict[str, Any], name: str) -> bool:
    return any(isinstance(one, dict) and one.get("name") == name for one in structure.values())
