"""Kinds of results of a folder, as types: each with what its report and its readers need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..analysis.domain import Domain
from ..analysis.probability import CollapseProbability
from ..analysis.studies import StudyResult
from ..column import Column
from ..column.structure import Structure
from ..motion import Motion
from ..response import Response
from .asked import Asked

if TYPE_CHECKING:
    import pandas


class Kind(Enum):
    """The kinds, by the command that makes them; ``states`` are those that ``compare`` sets side by side."""

    RUN = "run"
    RUNS = "runs"
    CRITICAL = "critical"
    DOMAIN = "domain"
    PROBABILITY = "probability"
    PUSHOVER = "pushover"
    LIMIT = "limit"
    COMPARE = "compare"
    STATES = "states"
    SUITE = "suite"
    IDA = "ida"
    FRAGILITY = "fragility"
    RISK = "risk"
    SURVIVAL = "survival"
    INFER = "infer"
    UNTIL_FALL = "sequence"
    STUDY = "study"
    RECORDS = "records"
    CALIBRATE = "calibrate"


@dataclass(frozen=True)
class FileFact:
    """A file of a result.

    Parameters
    ----------
    name : str
        In the folder.
    digest : str
        SHA-256 of what it holds now.
    unchanged : bool or None
        Whether that is what stylobate wrote; None where the folder has no list that tells.
    """

    name: str
    digest: str
    unchanged: bool | None


@dataclass(frozen=True, eq=False)
class Result:
    """A result: what it is, where it lies, and what was asked.

    Parameters
    ----------
    kind : Kind
    folder : Path
    asked : Asked or None
        None in folders of versions that did not keep it.
    files : tuple of FileFact
        Those that belong to it.
    summary : dict
        The JSON object of its command.
    """

    kind: Kind
    folder: Path
    asked: Asked | None
    files: tuple[FileFact, ...]
    summary: dict[str, Any]

    @property
    def structures(self) -> Sequence[Structure]:
        """Subject, as far as the folder tells."""
        return [] if self.asked is None else self.asked.stood

    @property
    def name(self) -> str:
        """Of what stood; the folder's where that is not known."""
        return ", ".join(dict.fromkeys(structure.name for structure in self.structures)) or self.folder.name

    @property
    def pictures(self) -> dict[str, Path]:
        """Pictures (PNG) as stylobate wrote them, by their names; one that was changed since is left out."""
        named = [file for file in self.files if file.name.endswith(".png") and file.unchanged is not False]
        return {Path(one.name).stem: self.folder / one.name for one in named}


@dataclass(frozen=True, eq=False)
class RunResult(Result):
    """One run of a column or an assembly.

    Parameters
    ----------
    response : Response
    motion : Motion or None
        What acted, all of it; None in folders of versions that did not keep it.
    replicates : pandas.DataFrame or None
        Columns like this one, a row each.
    """

    response: Response
    motion: Motion | None = None
    replicates: pandas.DataFrame | None = None

    @property
    def structures(self) -> Sequence[Structure]:
        """Structure."""
        return [self.response.structure]


@dataclass(frozen=True, eq=False)
class SeveralRuns(Result):
    """Runs of one column under several motions, each in a folder of its own; in the order of their names."""

    runs: tuple[RunResult, ...] = ()

    @property
    def structures(self) -> Sequence[Structure]:
        """Structure."""
        return [self.runs[0].response.structure]


@dataclass(frozen=True, eq=False)
class Grid(Result):
    """A domain over frequency and amplitude, or probabilities over it."""

    data: Domain | CollapseProbability

    @property
    def structures(self) -> Sequence[Column]:
        """Structure."""
        return [self.data.column]


@dataclass(frozen=True, eq=False)
class Comparison(Result):
    """Several models side by side, under one motion or over one domain."""

    table: pandas.DataFrame
    responses: dict[str, Response] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Numbers(Result):
    """A result that is its JSON object, tables and pictures.

    Parameters
    ----------
    tables : dict of str to pandas.DataFrame
        By the names of their files without ending.
    """

    tables: dict[str, pandas.DataFrame] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class StudyFolder(Result):
    """A study as far as it is.

    Parameters
    ----------
    study : StudyResult
    histories : dict of str to Response
        ``median`` and ``worst``, where they are there.
    """

    study: StudyResult
    histories: dict[str, Response] = field(default_factory=dict)
