"""The application: what the page asks of this machine, and the answers."""

from __future__ import annotations

import asyncio
import json
import shutil
import tempfile
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import tomli_w
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route

from ..column import Column
from ..column.files import write_column
from ..column.toml import checked
from ..errors import InputError, StylobateError
from ..motion.readers.component import UnstatedError
from ..motion.readers.samples import samples
from ..version import __version__
from . import columns, motions
from .asked import COLUMN, FRAGILITY, RECORDS, RESULT, STUDY, JobAsked, MotionAsked, commands, report_of, study
from .cells import new_cells
from .fields import column_field, domain_field, motion_field
from .guard import Guard, TooLarge
from .job import Job
from .records import FILE, Records
from .workshop import Workshop

STATIC = Path(__file__).with_name("static")
PLAYER = Path(__file__).parents[1] / "plots"

#: Files of the page by the end of their address: nothing else of the disk has one.
KINDS = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
PAGES = {f"/static/{one.name}": one for one in STATIC.iterdir() if one.suffix in KINDS} | {
    f"/static/{name}": PLAYER / name for name in ("player.js", "player_space.js")
}

#: Files of jobs that a browser shows, by the end of their names; it saves the others.
PICTURES = {"png": "image/png", "svg": "image/svg+xml", "html": "text/html"}

#: Time between two looks at jobs that are followed, and longest silence on that line [s]; most that listen.
LOOK, SILENCE, LISTENERS = 0.15, 10.0, 24

#: Files that were uploaded as columns [bytes], and most cells of a domain.
COLUMN_FILE = 1_000_000

Handler = Callable[[Request], Awaitable[Response]]


class Site:
    """Handlers of one page.

    Parameters
    ----------
    folder : Path
        Records and jobs are kept in it.
    worker : sequence of str
        As for :class:`stylobate.app.workshop.Workshop`.
    """

    def __init__(self, folder: Path, worker: Sequence[str]) -> None:
        self.records = Records(folder / RECORDS)
        self.workshop = Workshop(folder / "jobs", worker)
        self.listeners = 0
        self.closing = asyncio.Event()
        self._reading = asyncio.Semaphore(2)  # a record of the largest size takes some hundred MB while it is read

    # -- pages ---------------------------------------------------------------------------------------------------

    async def index(self, request: Request) -> Response:
        """The page."""
        return FileResponse(STATIC / "index.html", media_type="text/html")

    async def static(self, request: Request) -> Response:
        """One of its files."""
        found = PAGES.get(request.url.path)
        if found is None:
            return _missing("file")
        return FileResponse(found, media_type=KINDS[found.suffix], headers={"cache-control": "no-cache"})

    async def about(self, request: Request) -> Response:
        """What there is to choose from."""
        listed = [{"name": one.name, "about": one.about} for one in samples().values()]
        return JSONResponse({"version": __version__, "presets": columns.presets(), "samples": listed})

    # -- columns and motions -------------------------------------------------------------------------------------

    async def column(self, request: Request) -> Response:
        """Properties and outlines of a column."""
        table = await _object(request)
        try:
            columns.refuse_large(table)
            return JSONResponse(await run_in_threadpool(columns.describe, table))
        except InputError as error:
            return _found_wrong(error, column_field(str(error), table))

    async def column_toml(self, request: Request) -> Response:
        """The column file of a column."""
        table = await _object(request)
        columns.refuse_large(table)
        with tempfile.TemporaryDirectory() as folder:
            path = write_column(columns.column_of(table), Path(folder) / COLUMN)
            return PlainTextResponse(path.read_text(encoding="utf-8"))

    async def column_file(self, request: Request) -> Response:
        """What an uploaded column file holds."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "your-column.toml"
            path.write_bytes(await request.body())
            return JSONResponse({"table": await run_in_threadpool(columns.tables_in, path)})

    async def motion(self, request: Request) -> Response:
        """The plot and the measures of a motion."""
        body = await _object(request)
        asked = checked(body.get("motion") or {}, MotionAsked, "the motion")
        files = self.records.paths(asked.text) if asked.kind == "record" else []
        column = None
        if body.get("column"):
            try:
                column = columns.column_of(body["column"])
            except InputError:  # the column's own field says so
                column = None
        try:
            async with self._reading:
                return JSONResponse(await run_in_threadpool(motions.describe, asked, files, column))
        except InputError as error:
            sentence = str(error)
            unstated = "dt" if "step" in sentence else "unit"
            return _found_wrong(
                error, unstated if isinstance(error, UnstatedError) else motion_field(sentence, asked.kind, asked.text)
            )

    async def record(self, request: Request) -> Response:
        """Keep an uploaded record; its name comes along in a header."""
        name = unquote(request.headers.get("x-name", "record"))
        kept = await self.records.receive(name, request.stream())
        return JSONResponse({"id": kept.id, "name": kept.name, "size": kept.size})

    async def record_list(self, request: Request) -> Response:
        """Records that are here."""
        kept = self.records.kept.values()
        return JSONResponse({"records": [{"id": one.id, "name": one.name, "size": one.size} for one in kept]})

    async def record_remove(self, request: Request) -> Response:
        """Forget one."""
        self.records.remove(request.path_params["id"])
        return JSONResponse({})

    # -- jobs ----------------------------------------------------------------------------------------------------

    async def job_list(self, request: Request) -> Response:
        """All jobs."""
        return JSONResponse({"jobs": [self._shown(job) for job in self.workshop.jobs.values()]})

    async def job_new(self, request: Request) -> Response:
        """Put a job into the queue."""
        body = await _object(request)
        asked = checked(body, JobAsked, "the job")
        columns.refuse_large(asked.column)
        try:
            column = columns.column_of(asked.column)
        except InputError as error:
            return _refused(error, column_field(str(error), asked.column))
        try:
            tables = study(asked) if asked.kind == "domain" else None
        except InputError as error:
            return _refused(error, domain_field(str(error)))
        wanted = [one for one in asked.records if not one.startswith("sample:")]
        if asked.motion is not None and asked.motion.kind == "record":
            wanted.append(asked.motion.text)
        names = {one: [Path(path).name for path in self.records.paths(one)] for one in wanted}
        lines = commands(asked, names)

        def prepare(folder: Path) -> None:
            write_column(column, folder / COLUMN)
            self.records.copy(wanted, folder / RECORDS)
            if tables is not None:
                (folder / STUDY).write_text(tomli_w.dumps(tables), encoding="utf-8")

        title = _title(asked, column, self.records)
        job = await run_in_threadpool(self.workshop.submit, asked.kind, title, lines, body, prepare)
        return JSONResponse(self._shown(job), 201)

    async def job_one(self, request: Request) -> Response:
        """One job."""
        job = self._job(request)
        return _missing("job") if job is None else JSONResponse(self._shown(job, True))

    async def job_act(self, request: Request) -> Response:
        """Cancel a job, or do it again."""
        job = self._job(request)
        if job is None:
            return _missing("job")
        if request.path_params["act"] == "report":
            return JSONResponse(self._shown(await run_in_threadpool(self._report, job)), 201)
        act = {"cancel": self.workshop.cancel, "again": self.workshop.again}.get(request.path_params["act"])
        if act is None:
            return _missing("action")
        await run_in_threadpool(act, job)
        return JSONResponse(self._shown(job))

    def _report(self, job: Job) -> Job:
        """A job that makes the report of another one, of copies of its results."""
        if job.open:
            raise InputError("the job is not over; its report comes after it.")
        lines = report_of(job.folder)

        def prepare(folder: Path) -> None:
            for name in (RESULT, FRAGILITY):
                if (job.folder / name).is_dir():
                    shutil.copytree(job.folder / name, folder / name, ignore=shutil.ignore_patterns("*.sqlite*"))

        return self.workshop.submit("report", f"report: {job.title}", lines, {}, prepare)

    async def job_remove(self, request: Request) -> Response:
        """Cancel and forget a job."""
        job = self._job(request)
        if job is None:
            return _missing("job")
        await run_in_threadpool(self.workshop.remove, job)
        return JSONResponse({})

    async def film(self, request: Request) -> Response:
        """The film of a run."""
        job = self._job(request)
        path = None if job is None else job.folder / "film.json"
        return (
            _missing("film")
            if path is None or not path.is_file()
            else FileResponse(path, media_type="application/json")
        )

    async def cells(self, request: Request) -> Response:
        """All finished cells of a domain."""
        job = self._job(request)
        if job is None:
            return _missing("job")
        return JSONResponse({"cells": await run_in_threadpool(new_cells, job.folder, set())})

    async def file(self, request: Request) -> Response:
        """A file of a job, to be taken away: one of those that its list names."""
        job, name = self._job(request), request.path_params["name"]
        if job is None or name not in job.files():
            return _missing("file")
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

    async def events(self, request: Request) -> Response:
        """A line on which jobs say what becomes of them, and a domain its cells (server-sent events)."""
        if self.listeners >= LISTENERS:
            return JSONResponse({"error": f"{LISTENERS} pages are open already; close one."}, 503)
        followed = self.workshop.jobs.get(request.query_params.get("job", ""))
        return StreamingResponse(self._events(followed), media_type="text/event-stream")

    async def _events(self, followed: Job | None) -> AsyncIterator[str]:
        self.listeners += 1
        seen, known, silent, there, ready = 0, set[int](), 0.0, set[str](), None
        try:
            while not self.closing.is_set():
                said = []
                if ready != self.workshop.ready:
                    ready = self.workshop.ready
                    said.append(_event("ready", ready))
                if seen != self.workshop.version:
                    before, seen = seen, self.workshop.version
                    jobs = list(self.workshop.jobs.values())
                    changed = [job for job in jobs if job.version > before or job.state == "waiting"]
                    said += [_event("job", self._shown(job)) for job in changed]
                    ids = {job.id for job in jobs}
                    said += [_event("gone", one) for one in there - ids]
                    there = ids
                if followed is not None and followed.kind == "domain":
                    cells = await run_in_threadpool(new_cells, followed.folder, known)
                    if cells:
                        said.append(_event("cells", {"job": followed.id, "cells": cells}))
                    if not followed.open:
                        followed = None
                silent = 0.0 if said else silent + LOOK
                if silent >= SILENCE:
                    said, silent = [": still here\n\n"], 0.0
                if said:
                    yield "".join(said)
                await asyncio.sleep(LOOK)
        finally:
            self.listeners -= 1

    def _job(self, request: Request) -> Job | None:
        return self.workshop.jobs.get(request.path_params["id"])

    def _shown(self, job: Job, whole: bool = False) -> dict[str, Any]:
        return job.to_dict(whole) | {"place": self.workshop.place(job)}


def create_app(folder: Path, worker: Sequence[str], hosts: tuple[str, ...] = ()) -> Any:
    """The application (ASGI).

    Parameters
    ----------
    folder : Path
        Records and jobs are kept in it.
    worker : sequence of str
        The command line of the process that does the jobs.
    hosts : tuple of str
        Names under which this machine may be called, besides those of the loopback.
    """
    site: list[Site] = []

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        site.append(Site(folder, worker))
        site[0].workshop.open()
        try:
            yield
        finally:
            site[0].closing.set()
            await run_in_threadpool(site.pop().workshop.close)

    def at(path: str, handler: Callable[[Site, Request], Awaitable[Response]], method: str = "GET") -> Route:
        async def answer(request: Request) -> Response:
            return await handler(site[0], request)

        return Route(path, answer, methods=[method])

    routes = [
        at("/", Site.index),
        at("/static/{name}", Site.static),
        at("/api/about", Site.about),
        at("/api/column", Site.column, "POST"),
        at("/api/column/toml", Site.column_toml, "POST"),
        at("/api/column/file", Site.column_file, "POST"),
        at("/api/motion", Site.motion, "POST"),
        at("/api/records", Site.record_list),
        at("/api/records", Site.record, "POST"),
        at("/api/records/{id}", Site.record_remove, "DELETE"),
        at("/api/jobs", Site.job_list),
        at("/api/jobs", Site.job_new, "POST"),
        at("/api/jobs/{id}", Site.job_one),
        at("/api/jobs/{id}", Site.job_remove, "DELETE"),
        at("/api/jobs/{id}/film", Site.film),
        at("/api/jobs/{id}/cells", Site.cells),
        at("/api/jobs/{id}/files/{name:path}", Site.file),
        at("/api/jobs/{id}/{act}", Site.job_act, "POST"),
        at("/api/events", Site.events),
    ]
    handlers = {
        TooLarge: _on_too_large,
        InputError: _on_input,
        StylobateError: _on_failure,
        OSError: _on_failure,
        404: _on_missing,
    }
    app = Starlette(routes=routes, lifespan=lifespan, exception_handlers=handlers)
    return Guard(app, hosts, {"/api/records": FILE})


async def _object(request: Request) -> dict[str, Any]:
    """The JSON object that a request holds."""
    try:
        found = json.loads(await request.body())
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise InputError("the request holds no JSON object; reload the page.")
    return found


def _title(asked: JobAsked, column: Column, records: Records) -> str:
    """A job in a line."""
    if asked.kind == "run" and asked.motion is not None:
        what, kept = asked.motion.text, records.kept.get(asked.motion.text)
        what = kept.name if kept is not None else what
        what += f" at {asked.motion.azimuth}" if asked.motion.azimuth else ""
        what += f" scaled to {asked.motion.pga}" if asked.motion.pga else ""
    elif asked.kind == "domain":
        what = f"domain {asked.frequencies} Hz × {asked.amplitudes}"
    else:
        what = f"{len(asked.records)} records by {asked.im or 'pgv'}"
    return f"{column.name} · {what} · {asked.model}"


def _event(kind: str, what: Any) -> str:
    return f"event: {kind}\ndata: {json.dumps(what)}\n\n"


def _found_wrong(error: InputError, field: str | None) -> Response:
    """The answer to a question that was put well, about something that cannot be."""
    return JSONResponse({"error": str(error), "field": field})


def _refused(error: InputError, field: str | None) -> Response:
    return JSONResponse({"error": str(error), "field": field}, 422)


def _missing(what: str) -> Response:
    return JSONResponse({"error": f"there is no such {what}; reload the page."}, 404)


async def _on_input(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error), "field": None}, 422)


async def _on_too_large(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error)}, 413, {"connection": "close"})


async def _on_failure(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": f"{error}"[:300]}, 500)


async def _on_missing(request: Request, error: Exception) -> Response:
    return _missing("page")
