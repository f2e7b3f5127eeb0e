"""A job of the page: what was asked, its command lines, and what has become of it; kept in a folder of its own."""

from __future__ import annotations

import dataclasses
import json
import shlex
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from stylobate.atomic import LIST, replacing

from .forms import in_page_words

#: States of a job: it waits, is computed, has ended well, was refused as bad input, failed, or was stopped.
WAITING, RUNNING, DONE, REFUSED, FAILED, CANCELLED = "waiting", "running", "done", "refused", "failed", "cancelled"

#: The file that keeps a job; those from which the page draws its film, and its points as they come.
JOB, FILM, GROWING = "job.json", "film.json", "growing.json"


@dataclass
class Job:
    """Facts of a job.

    Parameters
    ----------
    id : str
    folder : Path
    kind : str
        ``run``, ``critical``, ``domain``, ``ida``, ``report``, or one of :data:`~stylobate_page.forms.FORMS`.
    title : str
        What it computes, in a line.
    commands : list of list of str
        Command lines that do it, without the program's name: for people.
    asked : dict
        What the page asked for, so that it can be asked again.
    requests : list of dict
        What commands are asked for it, one after the other, as :func:`stylobate.cli.main.ask` takes it; none in jobs of
        earlier versions.
    """

    id: str
    folder: Path
    kind: str
    title: str
    commands: list[list[str]]
    asked: dict[str, Any]
    requests: list[dict[str, Any]] = dataclasses.field(default_factory=list)
    state: str = WAITING
    created: float = dataclasses.field(default_factory=time.time)
    started: float | None = None
    ended: float | None = None
    done: float = 0.0
    total: float = 0.0
    what: str = ""
    sentence: str = ""
    field: str | None = None
    warnings: list[str] = dataclasses.field(default_factory=list)
    results: list[dict[str, Any]] = dataclasses.field(default_factory=list)
    version: int = 0
    filmed: bool = False
    grown: int = 0
    _files: list[str] | None = dataclasses.field(default=None, init=False, repr=False, compare=False)

    @property
    def open(self) -> bool:
        """Whether it waits or is computed."""
        return self.state in (WAITING, RUNNING)

    def files(self) -> list[str]:
        """Files that can be taken away: what stood, what was asked and what has come of it; not what is kept half-way."""
        if self._files is not None:
            return self._files
        found = [path for path in self.folder.rglob("*") if path.is_file() and not path.is_symlink()]
        names = [one.relative_to(self.folder).as_posix() for one in found if one.name[0] != "." and one.name != LIST]
        self._files = sorted(name for name in names if name not in (JOB, FILM, GROWING) and ".sqlite" not in name)
        return self._files

    def changed(self) -> None:
        """Look at its files anew when they are asked for next."""
        self._files = None

    def to_dict(self, whole: bool = True) -> dict[str, Any]:
        """For the page; less what was asked and what came of it, unless all of it is wanted."""
        left_out = ("folder", "_files", "requests", *(() if whole else ("asked", "results")))
        plain = {field.name: getattr(self, field.name) for field in fields(self) if field.name not in left_out}
        plain |= {"results": in_page_words(plain["results"])} if whole else {}
        plain["commands"] = [as_typed(command) for command in self.commands]
        plain["files"] = [] if self.open else self.files()
        plain["film"] = (self.filmed or not self.open) and (self.folder / FILM).is_file()
        return plain

    def lines(self) -> bytes:
        """Its command lines as a text file."""
        return "".join(f"{as_typed(command)}\n" for command in self.commands).encode("utf-8", "backslashreplace")

    def save(self) -> None:
        """Keep it in its folder."""
        plain = asdict(self) | {"folder": None}
        plain.pop("_files")
        with replacing(self.folder / JOB) as partial:
            partial.write_text(json.dumps(plain), encoding="utf-8")

    @classmethod
    def load(cls, folder: Path) -> Job | None:
        """The job that a folder keeps; None where it keeps none."""
        try:
            job = cls(**json.loads((folder / JOB).read_text(encoding="utf-8")) | {"folder": folder})
            job.created = float(job.created)
        except (OSError, ValueError, TypeError):
            return None
        if job.open:
            job.state, job.sentence = (
                CANCELLED,
                "The page was ended meanwhile; what is finished is kept: go on with it.",
            )
        return job


def as_typed(command: Sequence[str]) -> str:
    """A command line as a person types it."""
    return shlex.join(("stylobate", *command))
