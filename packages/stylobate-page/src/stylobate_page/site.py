"""The application: pages, columns, motions and records; its jobs are answered beside it (``job_answers.py``)."""

from __future__ import annotations

import asyncio
import tempfile
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import asdict
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Route

from stylobate.column.assembly_files import is_assembly
from stylobate.column.files import write_column
from stylobate.column.toml import checked
from stylobate.errors import InputError
from stylobate.motion.readers.source import samples
from stylobate.response.measures import MEASURES
from stylobate.version import __version__
from stylobate_exchange.convert import SURVEYS

from . import columns, motions, texts
from .answers import HANDLERS, Answer, found_wrong, json_object, missing
from .forms import FORMS, LABELS, in_page_words
from .guard import Guard, Keys
from .job_answers import LINES, JobAnswers
from .job_request import COLUMN, MotionChoice, safe_name
from .records import FILE, JOBS, RECORDS, Record, Records
from .workshop import Workshop

STATIC = Path(__file__).with_name("static")
PLAYER = Path(str(files("stylobate.plots")))

#: Files of the page by the end of their address: nothing else of the disk has one.
KINDS = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
PAGES = {f"/static/{path.name}": path for path in STATIC.iterdir() if path.suffix in KINDS} | {
    f"/static/{name}": PLAYER / name for name in ("player.js", "player_space.js")
}

#: Analyses as the scripts of the page take them.
FORMS_SHOWN = {name: asdict(form) for name, form in FORMS.items()}


class Site:
    """Handlers of one page.

    Parameters
    ----------
    folder : Path
        Records and jobs are kept in it.
    worker : sequence of str
        As for :class:`stylobate_page.workshop.Workshop`.
    """

    def __init__(self, folder: Path, worker: Sequence[str]) -> None:
        folder = folder.absolute()  # the process of jobs is in the folder of the last one
        self.records = Records(folder / RECORDS)
        self.workshop = Workshop(folder / JOBS, worker)
        self.jobs = JobAnswers(self.records, self.workshop)
        self._reading = asyncio.Semaphore(2)  # a record of the largest size takes some hundred MB while it is read

    # -- pages ---------------------------------------------------------------------------------------------------

    async def index(self, request: Request) -> Response:
        """The page."""
        return FileResponse(STATIC / "index.html", media_type="text/html")

    async def static(self, request: Request) -> Response:
        """One of its files."""
        path = PAGES.get(request.url.path)
        if path is None:
            return missing("file")
        return FileResponse(path, media_type=KINDS[path.suffix], headers={"cache-control": "no-cache"})

    async def about(self, request: Request) -> Response:
        """Choices."""
        listed = [{"name": sample.name, "about": sample.about} for sample in samples().values()]
        return Answer(
            {
                "version": __version__,
                "presets": columns.presets(),
                "samples": listed,
                "labels": LABELS,
                "forms": FORMS_SHOWN,
                "measures": [
                    {"key": measure.key, "label": measure.label, "unit": measure.unit}
                    for measure in MEASURES
                    if measure.label
                ],
            }
        )

    # -- columns and motions -------------------------------------------------------------------------------------

    async def column(self, request: Request) -> Response:
        """Properties and outlines of a column."""
        table = await json_object(request)
        try:
            columns.refuse_large(table)
            return Answer(await run_in_threadpool(columns.describe, table))
        except InputError as error:
            return found_wrong(error)

    async def column_toml(self, request: Request) -> Response:
        """The column file of a column."""
        table = await json_object(request)
        columns.refuse_large(table)
        with tempfile.TemporaryDirectory() as folder:
            path = write_column(columns.column_of(table), Path(folder) / COLUMN)
            return PlainTextResponse(path.read_text(encoding="utf-8"))

    async def column_file(self, request: Request) -> Response:
        """Contents of an uploaded file: a column, a survey, or an assembly, which is mended where it is edited."""
        stated = (unquote(request.headers.get(key, "")) or None for key in ("x-material", "x-columns"))
        name = safe_name(unquote(request.headers.get("x-name", "")), "your-column.toml")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.write_bytes(await request.body())
            try:
                if path.suffix.lower() not in SURVEYS and is_assembly(path):
                    return await _opened(path.read_text(encoding="utf-8"))
                return Answer({"table": await run_in_threadpool(columns.tables_in, path, *stated)})
            except InputError as error:
                error.without(f"{folder}/")
                if error.field not in ("material", "columns"):  # of a survey, which are asked for
                    error.field = "file"  # and none of the column that stands on the page
                raise

    async def assembly(self, request: Request) -> Response:
        """Summary of an assembly."""
        text = (await json_object(request)).get("assembly")
        try:
            return Answer(await run_in_threadpool(texts.describe, str(text)))
        except InputError as error:
            return found_wrong(error)

    async def motion(self, request: Request) -> Response:
        """The plot and the measures of a motion."""
        body = await json_object(request)
        motion_choice = checked(body.get("motion") or {}, MotionChoice, "the motion")
        files = self.records.paths(motion_choice.text) if motion_choice.kind == "record" else []
        column = None
        if body.get("column"):
            try:
                column = columns.column_of(body["column"])
            except InputError:  # the column's own field says so
                column = None
        try:
            async with self._reading:
                return Answer(await run_in_threadpool(motions.describe, motion_choice, files, column))
        except InputError as error:
            return found_wrong(error)

    async def record(self, request: Request) -> Response:
        """Keep an uploaded record; its name comes along in a header."""
        name = unquote(request.headers.get("x-name", "record"))
        joined, beside = (request.query_params.get(key, "") for key in ("with", "beside"))
        kept = await self.records.receive(name, request.stream(), joined, beside)
        return Answer(_of_record(kept))

    async def record_list(self, request: Request) -> Response:
        """Records that are here."""
        kept = self.records.kept.values()
        return Answer({"records": [_of_record(record) for record in kept]})

    async def record_remove(self, request: Request) -> Response:
        """Forget one."""
        self.records.remove(request.path_params["id"])
        return Answer({})


async def _opened(text: str) -> Response:
    """An assembly file with its model, and what is wrong in it."""
    answer: dict[str, Any] = {"assembly": text, "model": "dem2d"}
    try:
        answer["model"] = texts.model_of(await run_in_threadpool(texts.assembly_of, text))
    except InputError as error:
        if len(text) > texts.LARGEST:
            raise
        answer["error"] = in_page_words(error, of_text=True)
    return Answer(answer)


def _of_record(record: Record) -> dict[str, Any]:
    return {"id": record.id, "name": record.name, "size": record.size, "files": len(record.files)}


def create_app(folder: Path, worker: Sequence[str], hosts: tuple[str, ...] = (), keys: Keys | None = None) -> Any:
    """The application (ASGI).

    Parameters
    ----------
    folder : Path
        Records and jobs are kept in it.
    worker : sequence of str
        The command line of the process that does the jobs.
    hosts : tuple of str
        Names under which this machine may be called, besides those of the loopback.
    keys : Keys, optional
        What lets a request in; without them whoever reaches this machine may use the page.
    """
    site: list[Site] = []

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        site.append(Site(folder, worker))
        site[0].jobs.open()
        site[0].workshop.open()
        try:
            yield
        finally:
            site[0].jobs.close()
            await run_in_threadpool(site.pop().workshop.close)

    def at(path: str, handler: Callable[[Site, Request], Awaitable[Response]], method: str = "GET") -> Route:
        async def answer(request: Request) -> Response:
            return await handler(site[0], request)

        return Route(path, answer, methods=[method])

    def job(path: str, handler: Callable[[JobAnswers, Request], Awaitable[Response]], method: str = "GET") -> Route:
        return at(f"/api/jobs{path}", lambda site, request: handler(site.jobs, request), method)

    routes = [
        at("/", Site.index),
        at("/static/{name}", Site.static),
        at("/api/about", Site.about),
        at("/api/column", Site.column, "POST"),
        at("/api/column/toml", Site.column_toml, "POST"),
        at("/api/column/file", Site.column_file, "POST"),
        at("/api/assembly", Site.assembly, "POST"),
        at("/api/motion", Site.motion, "POST"),
        at("/api/records", Site.record_list),
        at("/api/records", Site.record, "POST"),
        at("/api/records/{id}", Site.record_remove, "DELETE"),
        job("", JobAnswers.listed),
        job("", JobAnswers.new, "POST"),
        job("/{id}", JobAnswers.one),
        job("/{id}", JobAnswers.remove, "DELETE"),
        job("/{id}/film", JobAnswers.film),
        job("/{id}/cells", JobAnswers.cells),
        job("/{id}/curves", JobAnswers.curves),
        job("/{id}/zip", JobAnswers.archive),
        job(f"/{{id}}/{LINES}", JobAnswers.lines),
        job("/{id}/files/{name:path}", JobAnswers.file),
        job("/{id}/{act}", JobAnswers.act, "POST"),
        at("/api/events", lambda site, request: site.jobs.events(request)),
    ]
    app = Starlette(routes=routes, lifespan=lifespan, exception_handlers=HANDLERS)
    return Guard(app, hosts, {"/api/records": FILE}, keys)
