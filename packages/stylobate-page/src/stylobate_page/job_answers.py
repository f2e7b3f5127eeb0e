"""Jobs of the page, and the answers: new ones, their news, films, cells and files."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
import time
import zipfile
from collections.abc import AsyncIterator, Iterator
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

import tomli_w
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, Response, StreamingResponse

from stylobate.column.catalogue import PRESETS, preset
from stylobate.column.files import write_column
from stylobate.column.structure import Structure
from stylobate.column.toml import checked
from stylobate.errors import InputError

from . import columns
from .answers import Answer, Missing, as_json, json_object, missing
from .curves import curves, new_cells
from .forms import FORMS
from .job_request import (
    ASSEMBLY,
    COLUMN,
    FRAGILITY,
    HAZARDS,
    RESULT,
    RUIN,
    RUNS,
    STUDY,
    TABLE,
    JobRequest,
    hazard_files,
    report_of,
    requests,
    study,
)
from .records import RECORDS, Records
from .texts import assembly_of, ruin_of
from .workshop import FILM, Job, Workshop

#: Files of jobs that a browser shows, by the end of their names; it saves the others.
PICTURES = {"png": "image/png", "svg": "image/svg+xml", "html": "text/html"}

#: Time between two looks at the cells of a domain, least time between two pieces of news, longest silence on that line [s];
#: most that listen.
LOOK, PACE, SILENCE, LISTENERS = 0.15, 0.02, 10.0, 24

#: Recipe of a job, as a file of its own.
LINES = "commands.txt"

#: A file with all others of a job: kept in memory up to this size, and sent in such pieces [bytes].
IN_MEMORY, PIECE = 20_000_000, 200_000


class JobAnswers:
    """Handlers for jobs.

    Parameters
    ----------
    records : Records
        That jobs copy.
    workshop : Workshop
        Where they are done.
    """

    def __init__(self, records: Records, workshop: Workshop) -> None:
        self.records, self.workshop = records, workshop
        self.listeners: set[asyncio.Event] = set()
        self.closing = False
        self._packing = asyncio.Semaphore(2)

    def open(self) -> None:
        """Hear of what happens in the workshop, in the loop that calls this."""
        loop = asyncio.get_running_loop()

        def notify() -> None:
            with suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(self._ring)

        self.workshop.notify = notify

    def close(self) -> None:
        """End the lines on which news are told."""
        self.closing = True
        self._ring()

    def _ring(self) -> None:
        for listener in self.listeners:
            listener.set()

    async def listed(self, request: Request) -> Response:
        """All jobs."""
        return Answer({"jobs": [self._shown(job) for job in self.workshop.jobs.values()]})

    async def new(self, request: Request) -> Response:
        """Put a job into the queue."""
        body = await json_object(request)
        job_request = checked(body, JobRequest, "the job")
        takes = FORMS[job_request.kind].takes if job_request.kind in FORMS else ("column",)
        stone = _structure(job_request) if "column" in takes else None
        source = self._source(job_request) if "source" in takes else None
        tables = study(job_request) if job_request.kind == "domain" else None
        if "ruin" in takes and stone is not None:
            await run_in_threadpool(ruin_of, job_request.ruin, stone, job_request.assembly)
        wanted = [record for record in job_request.records if not record.startswith("sample:")]
        if job_request.motion is not None and job_request.motion.kind == "record":
            wanted.append(job_request.motion.text)
        names = {record: self.records.names(record) for record in wanted}
        needed = requests(job_request, names)

        def prepare(folder: Path) -> None:
            _write(job_request, stone, folder)
            self.records.copy(wanted, folder / RECORDS)
            if source is not None:
                _copy_result(source.folder / RESULT, folder / RUNS)
            if tables is not None:
                (folder / STUDY).write_text(tomli_w.dumps(tables), encoding="utf-8")

        stands = _called(stone) if stone is not None else source.title if source is not None else "table of runs"
        title = _title(job_request, stands, self.records)
        job = await run_in_threadpool(self.workshop.submit, job_request.kind, title, needed, body, prepare)
        return Answer(self._shown(job), 201)

    def _source(self, job_request: JobRequest) -> Job | None:
        """The job on whose runs another one rests; None where it brings a table of its own."""
        if job_request.table is not None:
            return None
        job = self.workshop.jobs.get(job_request.source or "")
        if job is None or not (job.folder / RESULT / "runs.csv").is_file():
            raise InputError("no fragility is chosen; compute one, or open a table of runs.", "source")
        return job

    async def one(self, request: Request) -> Response:
        """One job."""
        return Answer(self._shown(self._job(request), True))

    async def act(self, request: Request) -> Response:
        """Cancel a job, or do it again."""
        job = self._job(request)
        if request.path_params["act"] == "report":
            return Answer(self._shown(await run_in_threadpool(self._report, job)), 201)
        act = {"cancel": self.workshop.cancel, "again": self.workshop.again}.get(request.path_params["act"])
        if act is None:
            return missing("action")
        await run_in_threadpool(act, job)
        return Answer(self._shown(job))

    def _report(self, job: Job) -> Job:
        """A job that makes the report of another one, of copies of its results."""
        if job.open:
            raise InputError("the job is not over; its report comes after it.")
        needed = report_of(job.folder)

        def prepare(folder: Path) -> None:
            for name in (RESULT, FRAGILITY, RUNS):
                if (job.folder / name).is_dir():
                    _copy_result(job.folder / name, folder / name)

        return self.workshop.submit("report", f"report: {job.title}", needed, {}, prepare)

    async def remove(self, request: Request) -> Response:
        """Cancel and forget a job."""
        job = self._job(request)
        await run_in_threadpool(self.workshop.remove, job)
        return Answer({})

    async def film(self, request: Request) -> Response:
        """The film of a run."""
        path = self._job(request, "film").folder / FILM
        return FileResponse(path, media_type="application/json") if path.is_file() else missing("film")

    async def cells(self, request: Request) -> Response:
        """All finished cells of a domain."""
        job = self._job(request)
        return Answer({"cells": await run_in_threadpool(new_cells, job.folder, set())})

    async def curves(self, request: Request) -> Response:
        """Pictures of an analysis."""
        job = self._job(request)
        return Answer(await run_in_threadpool(curves, job.folder))

    async def file(self, request: Request) -> Response:
        """A file of a job, to be taken away: one of those that its list names."""
        job, name = self._job(request, "file"), request.path_params["name"]
        if name not in job.files():
            return missing("file")
        ending = name.rpartition(".")[2]
        headers = {"content-security-policy": "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:"}
        kind, disposition = (
            (PICTURES[ending], "inline") if ending in PICTURES else ("application/octet-stream", "attachment")
        )
        return FileResponse(
            job.folder / name,
            filename=name.rpartition("/")[2],
            media_type=kind,
            headers=headers,
            content_disposition_type=disposition,
        )

    async def lines(self, request: Request) -> Response:
        """Command line that repeats a job without the page."""
        job = self._job(request)
        headers = {"content-disposition": f'attachment; filename="{LINES}"'}
        return Response(job.lines(), media_type="text/plain; charset=utf-8", headers=headers)

    async def archive(self, request: Request) -> Response:
        """All files of a job in one, with its command lines: what another machine needs to do it again."""
        job = self._job(request)
        async with self._packing:
            packed = await run_in_threadpool(_packed, job)
        headers = {"content-disposition": f'attachment; filename="stylobate-{job.kind}-{job.id}.zip"'}
        return StreamingResponse(_pieces(packed), media_type="application/zip", headers=headers)

    async def events(self, request: Request) -> Response:
        """A line on which jobs say what becomes of them, and a domain its cells (server-sent events)."""
        if len(self.listeners) >= LISTENERS:
            return Answer({"error": f"{LISTENERS} pages are open already; close one."}, 503)
        followed = self.workshop.jobs.get(request.query_params.get("job", ""))
        return StreamingResponse(self._events(followed), media_type="text/event-stream")

    async def _events(self, followed: Job | None) -> AsyncIterator[str]:
        rung = asyncio.Event()
        self.listeners.add(rung)
        seen, known, there, ready, last = 0, set[int](), set[str](), None, time.monotonic()
        try:
            while not self.closing:
                rung.clear()
                messages = []
                if ready != self.workshop.ready:
                    ready = self.workshop.ready
                    messages.append(_event("ready", ready))
                if seen != self.workshop.version:
                    before, seen = seen, self.workshop.version
                    jobs = list(self.workshop.jobs.values())
                    changed = [job for job in jobs if job.version > before or job.state == "waiting"]
                    messages += [_event("job", self._shown(job)) for job in changed]
                    ids = {job.id for job in jobs}
                    messages += [_event("gone", job_id) for job_id in there - ids]
                    there = ids
                if followed is not None and followed.kind == "domain":
                    over = not followed.open
                    cells = await run_in_threadpool(new_cells, followed.folder, known)
                    if cells:
                        messages.append(_event("cells", {"job": followed.id, "cells": cells}))
                    if over:
                        followed = None
                if not messages and time.monotonic() - last >= SILENCE:
                    messages = [": still here\n\n"]
                if messages:
                    last = time.monotonic()
                    yield "".join(messages)
                with suppress(TimeoutError):
                    await asyncio.wait_for(rung.wait(), SILENCE if followed is None else LOOK)
                await asyncio.sleep(PACE)
        finally:
            self.listeners.discard(rung)

    def _job(self, request: Request, what: str = "job") -> Job:
        """The job that a request is about; ``what`` of it, for the answer where there is none."""
        job = self.workshop.jobs.get(request.path_params["id"])
        if job is None:
            raise Missing(what)
        return job

    def _shown(self, job: Job, whole: bool = False) -> dict[str, Any]:
        return job.to_dict(whole) | {"place": self.workshop.place(job)}


def _called(stone: Structure) -> str:
    """The name of what stands; a preset that was changed is told from what it was."""
    return (
        f"{stone.name}, changed" if stone.name in PRESETS and preset(stone.name).digest != stone.digest else stone.name
    )


def _copy_result(source: Path, target: Path) -> None:
    """Copy what a command wrote, without what it keeps half-way."""
    shutil.copytree(source, target, ignore=shutil.ignore_patterns("*.sqlite*"))


def _write(job_request: JobRequest, stone: Structure | None, folder: Path) -> None:
    """Write what the page sent with a job into its folder."""
    if stone is not None and job_request.assembly is None:
        write_column(stone.stack, folder / COLUMN)
    texts = {ASSEMBLY: job_request.assembly, RUIN: job_request.ruin, TABLE: job_request.table}
    texts |= {f"{HAZARDS}/{name}": text for name, text in hazard_files(job_request).items()}
    for name, text in texts.items():
        if text is not None:
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")


def _structure(job_request: JobRequest) -> Structure:
    """Structure: a column, or an assembly, which has no domain."""
    if job_request.assembly is not None:
        if job_request.kind == "domain":
            raise InputError(f"a {job_request.kind} takes a column here; go back to one.")
        return assembly_of(job_request.assembly)
    if job_request.column is None:
        raise InputError("there is neither a column nor an assembly; choose a column.")
    columns.refuse_large(job_request.column)
    return columns.column_of(job_request.column)


def _title(job_request: JobRequest, name: str, records: Records) -> str:
    """A job in a line."""
    form, shaken = FORMS.get(job_request.kind), ""
    if job_request.motion is not None:
        kept = records.kept.get(job_request.motion.text)
        shaken = kept.name if kept is not None else job_request.motion.text
        shaken += (
            f" at {job_request.motion.azimuth}"
            if job_request.motion.azimuth and job_request.kind != "directions"
            else ""
        )
        shaken += f" scaled to {job_request.motion.pga}" if job_request.motion.pga else ""
    model = job_request.options.get("model") or job_request.model
    if form is not None:
        shaken = f"{len(job_request.records)} records" if "motions" in form.takes and job_request.records else shaken
        model = model if "model" in form.takes else ""
        return " · ".join(part for part in (name, form.title.lower(), shaken, model) if part)
    if job_request.kind == "domain":
        what = f"domain {job_request.frequencies} Hz × {job_request.amplitudes}"
    elif job_request.kind == "ida":
        what = f"{len(job_request.records)} records by {job_request.im or 'pgv'}"
    else:
        what = (
            shaken
            if job_request.kind == "run"
            else f"what brings it down of {shaken}, {job_request.first} to {job_request.last}"
        )
    return f"{name} · {what} · {model}"


def _event(kind: str, what: Any) -> str:
    return f"event: {kind}\ndata: {as_json(what)}\n\n"


def _packed(job: Job) -> IO[bytes]:
    """The files of a job in a ZIP file; their names are those of its list, below a folder of the job's own."""
    file = tempfile.SpooledTemporaryFile(IN_MEMORY)  # noqa: SIM115 (it is closed when it has been sent)
    try:
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as packed:
            packed.writestr(f"{job.id}/{LINES}", job.lines())
            for name in job.files():
                with suppress(FileNotFoundError):  # a job that is computed replaces its files
                    packed.write(job.folder / name, f"{job.id}/{name}")
    except BaseException:
        file.close()
        raise
    file.seek(0)
    return file


def _pieces(file: IO[bytes]) -> Iterator[bytes]:
    with file:
        while piece := file.read(PIECE):
            yield piece
