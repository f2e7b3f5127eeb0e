"""The page that a signed report begins with: project, answers, assumptions, limits, sources, and where one signs."""

from __future__ import annotations

import datetime
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import field_validator

from stylobate.column.toml import Table, read_table
from stylobate.errors import InputError
from stylobate.messages import joined, say
from stylobate.probability.design import OPEN
from stylobate.results import Result, RunResult, SeveralRuns
from stylobate.text_tables import printable
from stylobate.version import __version__

from .design import SHOWN, design_of, governing_rows
from .language import language_of
from .page import Exact, Facts, Item, Points, Rows, Section
from .record import files_of, known_model, titled


class Project(Table):
    """Facts that a report is signed with, as a project file (TOML) holds them; texts, and none of them empty."""

    client: str
    site: str
    engineer: str
    role: str | None = None
    place: str | None = None
    date: str | None = None
    reference: str | None = None
    assumptions: list[str] | None = None
    language: str = "en"

    @field_validator("date", mode="before")
    @classmethod
    def _as_text(cls, value: Any) -> Any:
        """A date of TOML as it is written; a text stays."""
        plain = isinstance(value, datetime.date) and not isinstance(value, datetime.datetime)
        return value.isoformat() if plain else value


def read_project(path: str | Path) -> Project:
    """Read a project file.

    Raises
    ------
    InputError
        The file cannot be read, is not TOML, has an unknown key, lacks one, or has an empty value.
    """
    project = read_table(path, Project)
    for key, value in project:
        if any(not text.strip() for text in ([value] if isinstance(value, str) else value or [])):
            raise InputError(f"{printable(path)}: {key} is empty; write it, or leave an optional key out.")
    if project.language.endswith(".po"):
        project = project.model_copy(update={"language": str(Path(path).parent / project.language)})
    language_of(project.language)
    return project


def front_sections(
    project: Project, results: Sequence[Result], cases: Sequence[dict[str, Any]], notes: Sequence[Item]
) -> list[Section]:
    """Sections of the first page.

    Parameters
    ----------
    project : Project
    results : sequence of Result
    cases : sequence of dict
        The case of each result, whose ``verdict`` is its answer: it is repeated as it stands there.
    notes : sequence of Item
        What must be known before any of the answers is relied on.
    """
    apart = ("role", "place", "language")
    known = [(say(key), Exact(value)) for key, value in project if isinstance(value, str) and key not in apart]
    answers = [[str(k), Exact(case["title"]), Exact(case["verdict"])] for k, case in enumerate(cases, start=1)]
    assumptions = list(map(Exact, project.assumptions or ())) or [say("None are told in the project file.")]
    return [
        Section(say("Project"), [Facts(known)]),
        Section(say("Answers"), [*notes, Rows([say("case"), say("result"), say("answer")], answers)]),
        *_design_values(results),
        Section(
            say("Assumptions of this report"),
            [Points(assumptions), say("What the models assume stands with each case.")],
        ),
        Section(say("Limits: what is not covered"), _limits(results)),
        Section(say("Sources of the results"), _sources(results)),
    ]


def _design_values(results: Sequence[Result]) -> list[Section]:
    """Of every state the design value that governs, where there are some."""
    designed = [
        (str(k), design) for k, result in enumerate(results, start=1) if (design := design_of(result)) is not None
    ]
    body = [[k, *row] for k, design in designed for row in governing_rows(design)]
    caption = say(
        "Of every state the link that is used most, at the level that is told: what 84 % of the motions do not "
        "exceed, and its 95 % interval. A ductile link at its capacity bears no more; its slip then tells how "
        "far it is used."
    )
    other = say("What else bears how much, and at which other levels, stands with each case.")
    caption = joined(" ", [caption, OPEN, other])
    return (
        [Section(say("Design values that govern"), [Rows([say("case"), *SHOWN], body, caption, numbers=True)])]
        if body
        else []
    )


def _limits(results: Sequence[Result]) -> list[Item]:
    """Limits of the models of all results, each model once."""
    names = dict.fromkeys(name for result in results for name in _models(result))
    kinds = {name: kind for name in names if (kind := known_model(name)) is not None}
    items: list[Item] = [say("The results are no check against a code. Where models end:")] if kinds else []
    for name, kind in kinds.items():
        items += [titled(name) + ":", Points(list(map(say, kind.limits)))]
    return items or [say("The results are no check against a code; their limits stand with each case.")]


def _models(result: Result) -> list[str]:
    if isinstance(result, RunResult):
        return [result.response.model]
    if isinstance(result, SeveralRuns):
        return [run.response.model for run in result.runs]
    return [str(model["name"]) for model in result.request.models] if result.request is not None else []


def _sources(results: Sequence[Result]) -> list[Item]:
    """Programs, and the digest by which the signature holds for the files that are listed at the end."""
    listed = joined("", (say("{file.digest}  {file.name}\n", file=file) for _, file in files_of(results)))
    computed = dict.fromkeys(result.request.version for result in results if result.request is not None)
    pairs = [
        (say("computed by stylobate"), joined(", ", computed) or say("not known")),
        (say("written by stylobate"), __version__),
    ]
    pairs.append((say("SHA-256 of the list of files"), Exact(hashlib.sha256(listed.encode()).hexdigest())))
    return [Facts(pairs), say("The files with their digests, and what is cited, stand at the end of the appendix.")]
