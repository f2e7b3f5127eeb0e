"""The process of the page's jobs: it hears of them on standard input, one after the other, and does what they request.

A job is a line of JSON: ``id`` and ``folder``, whose file holds the requests. What becomes of it goes to standard output,
in lines of JSON as well: ``progress``, the end of each command with its JSON object and its complaints, and ``done``.
"""

from __future__ import annotations

import io
import json
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.cli import signals
from stylobate.errors import StylobateError

from .forms import in_page_words
from .job_request import ASSEMBLY, COLUMN, RUIN, STUDY
from .workshop import FILM, GROWING, JOB

if TYPE_CHECKING:
    from stylobate.probability.evidence import Ida
    from stylobate.response import Response

#: Least time between two lines about progress, and between two looks at an analysis that grows [s].
PACE, LOOK = 0.1, 0.7

#: Share of the memory of this machine that a job may take [-].
MEMORY = 0.6


def main() -> None:
    """Work until standard input ends."""
    signals.listen()
    limit_memory(MEMORY)
    telling = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what libraries print is no line of ours

    def tell(**what: Any) -> None:
        telling.write(json.dumps(what) + "\n")
        telling.flush()

    from stylobate.cli import console

    jobs: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
    threading.Thread(target=listen, args=(jobs,), name="jobs", daemon=True).start()
    with suppress(KeyboardInterrupt):
        warm(tell)
        while not signals.STOP_SIGNALLED.is_set():
            job = jobs.get()
            console.LISTENER = listener(job["id"], tell)
            requests = json.loads((Path(job["folder"]) / JOB).read_text(encoding="utf-8"))["requests"]
            work(job, requests, tell)
            console.LISTENER = None
    signals.mark_ended()
    signals.end_now(signals.INTERRUPTED)


def limit_memory(share: float) -> None:
    """Let this process have no more than a share of the memory; where a system has no such limits, all of it."""
    try:
        import resource

        whole = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        _, hard = resource.getrlimit(resource.RLIMIT_DATA)
        most = int(share * whole)
        resource.setrlimit(resource.RLIMIT_DATA, (most if hard < 0 else min(most, hard), hard))
    except (ImportError, AttributeError, OSError, ValueError):
        return


def listen(jobs: queue.SimpleQueue[dict[str, Any]]) -> None:
    """Take jobs from standard input; where it ends, nobody waits for this process any more."""
    for line in sys.stdin:
        jobs.put(json.loads(line))
    os.kill(os.getpid(), signal.SIGTERM)


def listener(job: str, tell: Callable[..., None]) -> Callable[[str, float, float], None]:
    """Hears of the progress of a job and passes it on, not too often."""
    last = [0.0]

    def hear(what: str, done: float, total: float) -> None:
        now = time.monotonic()
        if now - last[0] >= PACE or done >= total:
            last[0] = now
            tell(id=job, progress=[done, total], what=what)

    return hear


def warm(tell: Callable[..., None]) -> None:
    """Load compiled code and libraries before the first job comes."""
    import h5netcdf  # noqa: F401

    from stylobate import DistinctElement2D, certainty, harmonic, preset
    from stylobate.cli.main import run_request

    from .curves import film

    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        run_request({"command": "run", "column": "paper-12-drums", "harmonic": "1Hz,0.05g,0.1s", "json": True})
        made = certainty(preset("paper-12-drums"), harmonic(1.0, 0.5, 0.1), DistinctElement2D())
        film(made.response)
        made.response.to_xarray()
        made.population.table.to_csv()
    tell(ready=True)


def work(job: dict[str, Any], requests: Sequence[dict[str, Any]], tell: Callable[..., None]) -> None:
    """Do the requests of a job; the film of a run is told of as soon as there is one."""
    from stylobate.cli import console
    from stylobate.cli.main import run_request

    tell(id=job["id"], begun=True)
    os.chdir(job["folder"])
    state = next((entry["state"] for entry in requests if "state" in entry), "collapse")
    for number, request in enumerate(requests):
        output, complained = io.StringIO(), io.StringIO()
        console.VIEWER, console.WORDING = viewer(job["id"], request, state, tell), worded
        with redirect_stdout(output), redirect_stderr(complained):
            code = run_request(request | {"json": True})
        console.VIEWER, console.WORDING = None, console.in_options
        lines = [line.removeprefix("stylobate: ") for line in complained.getvalue().splitlines()]
        tell(id=job["id"], number=number, code=code, said=output.getvalue(), complained=lines, field=console.FIELD)
        if code:
            return
    tell(id=job["id"], done=True)


def worded(message: object) -> str:
    """What a command says, in words of the page, which knows nothing of the files of the job."""
    sentence = str(in_page_words(message))
    for file in (COLUMN, ASSEMBLY, STUDY, RUIN):
        sentence = sentence.removeprefix(f"{file}: ")
    return sentence


def viewer(job: str, request: dict[str, Any], state: str, tell: Callable[..., None]) -> Callable[[Any], None] | None:
    """What sees what a command has come to: a film is made of one run, and of an analysis its points so far."""
    if request["command"] == "ida":
        return growing(job, state, tell)
    single_run = request["command"] == "sequence" or (request["command"] == "run" and "azimuths" not in request)
    return partial(make_film, job, tell) if single_run else None


def growing(job: str, state: str, tell: Callable[..., None]) -> Callable[[Callable[[], Ida]], None]:
    """Keeps the points of an analysis in the folder of its job as they come, not too often."""
    last = [-LOOK]

    def see(so_far: Callable[[], Ida]) -> None:
        from .curves import write_points

        if time.monotonic() - last[0] >= LOOK:
            write_points(so_far(), state, Path(GROWING))
            last[0] = time.monotonic()
            tell(id=job, grown=True)

    return see


def make_film(job: str, tell: Callable[..., None], response: Response) -> None:
    """Make the film of a run, in the folder of its job."""
    from .curves import write_film

    try:
        write_film(response, Path(FILM))
    except StylobateError as error:
        print(f"stylobate: warning: there is no film: {error}", file=sys.stderr)
        return
    tell(id=job, film=True)


if __name__ == "__main__":
    main()
