"""What the page asks for, checked, and the requests to commands that do it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from stylobate.column.toml import Table
from stylobate.errors import InputError
from stylobate.motion.specs import amplitude_range, frequency_range, parse_time

from .forms import FORMS, Form
from .records import RECORDS

#: Files of a job: its column or assembly, the study of a domain, and where its commands write; its records lie in a folder
#: that is called as that of the page.
COLUMN, ASSEMBLY, STUDY, RUIN, RESULT, FRAGILITY, REPORT = (
    *("column.toml", "assembly.toml", "study.toml", "ruin.toml", "result", "fragility", "report.html"),
)

#: The runs that a job rests on, the folder of another one or a table that was opened; and the folder of its hazard curves.
RUNS, TABLE, HAZARDS = "runs", "opened-table.csv", "hazards"

#: Most cells of a domain.
CELLS = 20_000


class MotionChoice(Table):
    """A motion as the page holds it, in the words of the command line.

    ``kind`` is ``harmonic``, ``pulse``, ``synthetic``, ``sample`` or ``record``; ``text`` what follows that option, the
    name of the sample, or the id of the record.
    """

    kind: Literal["harmonic", "pulse", "synthetic", "sample", "record"]
    text: str
    across: str | None = None
    unit: str | None = None
    dt: str | None = None
    columns: str | None = None
    component: str | None = None
    azimuth: str | None = None
    pga: str | None = None
    scale: str | None = None
    vertical: Literal["on", "off"] = "on"

    def words(self, files: Sequence[str] = ()) -> dict[str, Any]:
        """Words of :meth:`stylobate.motion.MotionRequest.typed`.

        Parameters
        ----------
        files : sequence of str
            Paths of the record.
        """
        options = ("across", "unit", "dt", "columns", "component", "azimuth", "pga", "scale")
        parameters: dict[str, Any] = {name: value for name in options if (value := getattr(self, name))}
        if self.vertical == "off":
            parameters["vertical"] = "off"
        if self.kind in ("sample", "record"):
            return parameters | {"motion": [f"sample:{self.text}"] if self.kind == "sample" else list(files)}
        return parameters | {self.kind: self.text}


class JobRequest(Table):
    """Computation that is asked for: all but kind, column and model as on the command line.

    ``column`` is what a column file holds, ``assembly`` the text of an assembly file, ``ruin`` that of a ruin file; of
    ``critical`` the amplitudes go from ``first`` to ``last`` by ``step``. An analysis of :data:`~stylobate_page.forms.FORMS`
    has ``options``, what its fields hold, and may rest on a ``source``, the id of another job, or on the text of a ``table``
    of runs, and on texts of ``hazards`` by the names of their files. ``page`` is what the page's fields hold, for it to fill
    them again.
    """

    kind: Literal[
        "run", "critical", "domain", "ida", "directions", "compare", "sequence", "risk", "survival", "infer", "modes"
    ]
    options: dict[str, str] = Field(default_factory=dict)
    source: str | None = None
    table: str | None = None
    hazards: dict[str, str] = Field(default_factory=dict)
    column: dict[str, Any] | None = None
    assembly: str | None = None
    ruin: str | None = None
    model: str = "dem2d"
    settings: dict[str, str] = Field(default_factory=dict)
    motion: MotionChoice | None = None
    replicates: str | None = None
    tail: str | None = None
    frequencies: str | None = None
    amplitudes: str | None = None
    duration: str | None = None
    first: str | None = None
    last: str | None = None
    step: str | None = None
    page: dict[str, Any] = Field(default_factory=dict)
    records: list[str] = Field(default_factory=list)
    unit: str | None = None
    columns: str | None = None
    im: str | None = None
    runs: str | None = None
    state: str | None = None


def requests(job_request: JobRequest, records: Mapping[str, Sequence[str]]) -> list[dict[str, Any]]:
    """Requests to commands, as :func:`stylobate.cli.main.run_request` takes them; paths from the folder of the job.

    Parameters
    ----------
    job_request : JobRequest
    records : mapping
        Paths of the files of each record, by its id.

    Raises
    ------
    InputError
        Something is missing.
    """
    if job_request.kind in FORMS:
        return [_of_form(job_request, FORMS[job_request.kind], records)]
    if job_request.kind == "domain":
        return [{"command": "domain", "what": STUDY, "out": RESULT}]
    made = {"command": job_request.kind, "column": _stands(job_request)}
    end = _without_empty(tail=job_request.tail) | {"out": RESULT}
    if job_request.kind in ("run", "critical"):
        more = (
            {"pictures": False}
            if job_request.kind == "run"
            else {"from": job_request.first, "to": job_request.last, "step": job_request.step}
        )
        made |= _model(job_request.model, job_request.settings) | _motion(_the_motion(job_request), records)
        return [made | _without_empty(replicates=job_request.replicates, **more) | end]
    from stylobate.probability.fragility import FEWEST

    if not job_request.records:
        raise InputError("no record is chosen; a fragility takes several: upload them, or choose samples.")
    made |= {"sources": _each(job_request.records, records)} | _model(job_request.model, job_request.settings)
    made |= (
        _without_empty(unit=job_request.unit, columns=job_request.columns, im=job_request.im, runs=job_request.runs)
        | end
    )
    curve = {"command": "fragility", "sources": [RESULT], **_without_empty(state=job_request.state), "out": FRAGILITY}
    return [made] if len(job_request.records) < FEWEST else [made, curve]


def _of_form(job_request: JobRequest, form: Form, records: Mapping[str, Sequence[str]]) -> dict[str, Any]:
    """The request of an analysis: what it takes of the page, and what its fields hold."""
    takes, boxes = form.takes, {box.option: box for box in form.boxes}
    unknown = next((name for name in job_request.options if name not in boxes), None)
    if unknown is not None:
        raise InputError(f"{form.title!r} has no field {unknown!r}; reload the page.")
    given = {name: job_request.options.get(name, box.start).strip() for name, box in boxes.items()}
    empty = next((box for name, box in boxes.items() if box.start and not given[name]), None)
    if empty is not None:
        raise InputError(f"“{empty.label}” is empty; give it, such as {empty.start}.", empty.option)
    made: dict[str, Any] = {"command": form.command}
    if "ruin" in takes:
        made["ruin"] = RUIN
    elif "column" in takes:
        made["column"] = _stands(job_request)
    if "source" in takes:
        made["source"] = RUNS if job_request.table is None else TABLE
    if "model" in takes:
        model = given.pop("model", job_request.model)
        made |= _model(model, job_request.settings if model == job_request.model else {})
    if "motions" in takes and job_request.records:
        made["motion"] = _each(job_request.records, records)
    elif {"motion", "motions", "round"} & {*takes}:
        given = {
            name: text for name, text in given.items() if name not in ("unit", "columns")
        }  # the page's motion has its own
        motion = _the_motion(job_request)
        made |= _motion(motion.model_copy(update={"azimuth": None}) if "round" in takes else motion, records)
    if {"hazard", "hazards"} & {*takes}:
        number = len(job_request.hazards)
        if not number or (number > 1 and "hazard" in takes):
            wanted = "one" if "hazard" in takes else "at least one"
            raise InputError(
                f"{number} hazard curves are open; {form.title.lower()} takes {wanted}: open its file.", "hazard"
            )
        files = [f"{HAZARDS}/{name}" for name in hazard_files(job_request)]
        made["hazard"] = files if "hazards" in takes else files[0]
    made |= _without_empty(**{name: text and text + boxes[name].unit for name, text in given.items()}) | form.fixed
    return made | _without_empty(tail=job_request.tail if "tail" in takes else None) | {"out": RESULT}


def hazard_files(job_request: JobRequest) -> dict[str, str]:
    """Texts of the hazard curves by the names of their files in the folder of the job: those that they had, made safe.

    Raises
    ------
    InputError
        Two are called the same.
    """
    files: dict[str, str] = {}
    for name, text in job_request.hazards.items():
        safe = safe_name(name, "hazard")
        if safe in files:
            raise InputError(f"two hazard curves are called {safe!r}; rename one of the files.", "hazard")
        files[safe] = text
    return files


def safe_name(name: str, otherwise: str) -> str:
    """The name of a file of somebody, made one that a folder here can hold."""
    return re.sub(r"[^\w.() -]+", "_", name).strip(". ")[-60:] or otherwise


def _the_motion(job_request: JobRequest) -> MotionChoice:
    if job_request.motion is None:
        raise InputError("there is no motion; choose one.")
    return job_request.motion


def _stands(job_request: JobRequest) -> str:
    return COLUMN if job_request.assembly is None else ASSEMBLY


def _model(model: str, settings: Mapping[str, str]) -> dict[str, Any]:
    return _without_empty(model=model, set=[f"{name}={value}" for name, value in settings.items() if value])


def _each(chosen: Sequence[str], records: Mapping[str, Sequence[str]]) -> list[str]:
    """The file of each record that is chosen."""
    if any(len(records.get(record, ())) > 1 for record in chosen):
        raise InputError("a record of several files cannot be one of many here; upload one file for each record.")
    return [path for record in chosen for path in _files(record, records)]


def study(job_request: JobRequest) -> dict[str, Any]:
    """The study file of a domain, as TOML gives it.

    Raises
    ------
    InputError
        A time cannot be read.
    """
    tables = {
        "column": COLUMN,
        "model": job_request.model,
        "frequencies": job_request.frequencies,
        "amplitudes": job_request.amplitudes,
    }
    tables |= {name: parse_time(text, name) for name in ("duration", "tail") if (text := getattr(job_request, name))}
    settings = {name: value for name, value in job_request.settings.items() if value}
    missing = next((name for name, value in tables.items() if value is None), None)
    if missing is not None:
        raise InputError(f"a domain has no {missing}; give them, such as 0.33:4:24 and 0.05g:0.6g:32.", missing)
    cells = len(frequency_range(str(job_request.frequencies))) * len(amplitude_range(str(job_request.amplitudes)))
    if cells > CELLS:
        raise InputError(
            f"the domain has {cells} cells; the page takes up to {CELLS}: give fewer frequencies.", "frequencies.number"
        )
    return tables | ({"set": settings} if settings else {})


def report_of(folder: Path) -> list[dict[str, Any]]:
    """The request for a report on what lies in the folder of a job.

    Raises
    ------
    InputError
        Nothing has been computed there.
    """
    folders = [name for name in (RESULT, FRAGILITY) if (folder / name).is_dir()]
    if not folders:
        raise InputError("there is no result to report on; run the job first.")
    return [{"command": "report", "folders": folders, "out": REPORT}]


def _without_empty(**values: Any) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value or value is False}


def _motion(motion: MotionChoice, records: Mapping[str, Sequence[str]]) -> dict[str, Any]:
    return motion.words(_files(motion.text, records) if motion.kind == "record" else ())


def _files(record: str, records: Mapping[str, Sequence[str]]) -> list[str]:
    if record.startswith("sample:"):
        return [record]
    if record not in records:
        raise InputError("the record is no longer here; upload it again.")
    return [f"{RECORDS}/{name}" for name in records[record]]
