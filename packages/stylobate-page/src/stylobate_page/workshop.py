"""Workshop of jobs: one process, which hears of them in lines of JSON and answers so; the others wait in a visible queue."""

from __future__ import annotations

import dataclasses
import json
import os
import queue
import secrets
import shlex
import shutil
import signal
import subprocess
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from itertools import count
from pathlib import Path
from typing import Any

from stylobate.atomic import LIST, replacing
from stylobate.cli.main import words_of
from stylobate.errors import InputError

from .forms import in_page_words
from .records import private, private_file

# A job of the page: what was asked, its command lines, and what has become of it; kept in a folder of its own.

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
        What commands are asked for it, one after the other, as :func:`stylobate.cli.main.run_request` takes it; none in jobs
        of earlier versions.
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
        paths = [path for path in self.folder.rglob("*") if path.is_file() and not path.is_symlink()]
        names = [
            path.relative_to(self.folder).as_posix() for path in paths if path.name[0] != "." and path.name != LIST
        ]
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


#: Most jobs that wait, and that are kept.
WAIT, KEEP = 50, 300

#: Words of the process beside its jobs, beside their folder.
LOG = "worker.log"

#: Kinds of jobs that can be stopped and go on later where they were.
LONG = ("domain", "ida", "critical", "directions", "compare", "infer")

#: Time between two looks at an idle process, and at one that is ending [s].
LOOK, PAUSE = 0.5, 0.02

#: Codes of the command line for bad input and for an interrupt.
BAD_INPUT, INTERRUPTED = 2, 130


class Workshop:
    """Jobs and the process that does them.

    Parameters
    ----------
    folder : Path
        Each job has a folder in it.
    worker : sequence of str
        The command line of the process; it takes jobs on standard input.
    notify : callable
        Called, from any thread, when something has changed.
    """

    def __init__(self, folder: Path, worker: Sequence[str], notify: Callable[[], None] = lambda: None) -> None:
        self.folder, self.worker, self.notify = private(folder), list(worker), notify
        self._log = self.folder.parent / LOG
        self._log.unlink(missing_ok=True)
        loaded = [Job.load(path) for path in self.folder.iterdir() if path.is_dir()]
        self.jobs = {job.id: job for job in sorted((job for job in loaded if job), key=lambda job: job.created)}
        self.version = 0
        self._queue: deque[str] = deque()
        self._lock, self._wake = threading.RLock(), threading.Condition()
        self._process: Process | None = None
        self._spare: Process | None = None
        self._leaving: list[threading.Thread] = []
        self._current: str | None = None
        self._retried: str | None = None
        self._closing = False
        self._thread = threading.Thread(target=self._work, name="jobs", daemon=True)

    def open(self) -> None:
        """Start the process."""
        self._thread.start()

    def close(self) -> None:
        """End the process; what is finished is kept."""
        with self._wake:
            self._closing = True
            self._wake.notify()
        self._stop_process()
        if self._thread.is_alive():
            self._thread.join()

    @property
    def ready(self) -> bool:
        """Whether the process has its compiled code at hand."""
        process = self._process
        return process is not None and process.ready and not process.over

    # -- asked by the page ---------------------------------------------------------------------------------------

    def submit(
        self,
        kind: str,
        title: str,
        requests: list[dict[str, Any]],
        asked: dict[str, Any],
        prepare: Callable[[Path], object] = lambda folder: None,
    ) -> Job:
        """Put a job into the queue.

        Parameters
        ----------
        kind, title, requests, asked
            As for :class:`stylobate_page.workshop.Job`.
        prepare : callable
            Writes what the requests need into the job's folder.

        Raises
        ------
        InputError
            Too many jobs wait.
        """
        with self._lock:
            if len(self._queue) >= WAIT:
                raise InputError(f"{len(self._queue)} jobs are waiting; cancel some, or wait until they are done.")
            job = Job(
                secrets.token_hex(6),
                self.folder,
                kind,
                self._unlike(title),
                list(map(words_of, requests)),
                asked,
                requests,
            )
            job.folder = self.folder / job.id
            job.folder.mkdir()
            try:
                prepare(job.folder)
            except BaseException:
                shutil.rmtree(job.folder, ignore_errors=True)
                raise
            self.jobs[job.id] = job
            self._forget_old()
        self._enqueue(job)
        self._make_room()
        return job

    def _unlike(self, title: str) -> str:
        """The title, with a number where jobs at hand have it already."""
        taken = {job.title for job in self.jobs.values()}
        return next(candidate for k in count(1) if (candidate := title if k == 1 else f"{title} ({k})") not in taken)

    def again(self, job: Job) -> None:
        """Do a job once more, in its folder: one that was stopped goes on where it was."""
        if not job.requests:
            raise InputError("the job is of an earlier version and cannot go on; ask for it anew.")
        with self._lock:
            if job.open:
                return
            job.state, job.sentence, job.ended, job.started, job.warnings, job.results = WAITING, "", None, None, [], []
            job.field = None
            job.done = job.total = 0.0
        self._enqueue(job)

    def cancel(self, job: Job) -> None:
        """Take a job out of the queue, or stop it."""
        with self._lock:
            if job.state == WAITING:
                with suppress(ValueError):
                    self._queue.remove(job.id)
                self._end(job, CANCELLED, "Cancelled before it began.")
            elif job.state == RUNNING:
                job.state = CANCELLED
                self._changed(job)
                self._stop_process()

    def remove(self, job: Job) -> None:
        """Cancel a job and delete its folder."""
        self.cancel(job)
        with self._lock:
            self.jobs.pop(job.id, None)
            self.version += 1
        self.notify()
        for process in self._leaving:  # it may have been paused a moment ago
            process.join(PATIENCE)
        shutil.rmtree(job.folder, ignore_errors=True)

    def place(self, job: Job) -> int:
        """Number of jobs that are done before this one."""
        with self._lock:
            waiting = list(self._queue)
            return waiting.index(job.id) + (self._current is not None) if job.id in waiting else 0

    # -- the process ---------------------------------------------------------------------------------------------

    def _enqueue(self, job: Job) -> None:
        self._changed(job)
        job.save()  # before it can be begun: what is written of its end must be the last word
        with self._wake:
            self._queue.insert(self._turn(job), job.id)
            self._wake.notify()

    def _turn(self, job: Job) -> int:
        """Place of a job in the queue: after all others, but before the long ones where it is none of them."""
        return len(self._queue) if job.kind in LONG else self._before_long()

    def _before_long(self) -> int:
        kinds = [self.jobs[job_id].kind if job_id in self.jobs else "" for job_id in self._queue]
        return next((k for k, kind in enumerate(kinds) if kind in LONG), len(kinds))

    def _make_room(self) -> None:
        """Let the long job that is computed pause, where a short one waits: its ledger keeps what is finished."""
        with self._lock:
            current = self.jobs.get(self._current or "")
            first = self.jobs.get(self._queue[0]) if self._queue else None
            if current is None or first is None or current.state != RUNNING:
                return
            if current.kind not in LONG or first.kind in LONG:
                return
            self._put_back(current, self._before_long())
            process = self._process
            if process is not None:
                process.tell()  # with the lock: it must not be given another job

    def _put_back(self, job: Job, place: int) -> None:
        job.state = WAITING
        self._queue.insert(place, job.id)
        self._changed(job)

    def _work(self) -> None:
        while not self._closing:
            process = self._started()
            with self._wake:
                self._wake.wait_for(lambda: self._closing or self._queue, LOOK)
            if self._closing or process.over or not self._queue:
                if process.ready:
                    self._stand_by(process)
                continue
            with self._lock:
                job = self._taken(process)
            if job is None:
                time.sleep(PAUSE)
                continue
            try:
                self._follow(job, process)
            finally:
                self._current = None
        both = [worker for worker in (self._process, self._spare) if worker is not None]
        for worker in both:
            worker.tell()
        for worker in both:
            worker.put_away()
        for worker in self._leaving:
            worker.join()

    def _taken(self, process: Process) -> Job | None:
        """The first of the queue, which is computed from now on; None where there is none that could be."""
        if not self._queue or process.over:  # it was stopped while this waited for the lock
            return None
        job = self.jobs.get(self._queue[0])
        if job is not None and job.kind in LONG and any(process.is_alive() for process in self._leaving):
            return None  # it may be the one that has just paused, whose ledger is held until its process has ended
        self._queue.popleft()
        if job is None or job.state != WAITING:
            return None
        self._current, job.state, job.started = job.id, RUNNING, time.time()
        job.results, job.warnings, job.filmed = [], [], False
        self._changed(job)
        return job

    def _started(self) -> Process:
        """The process that does jobs; where it has ended, the one that waits to take over, or a new one."""
        if self._process is None or self._process.over:
            if self._process is not None:
                # Let a process end by itself, and go on meanwhile.
                leaving = threading.Thread(target=self._process.put_away, name="leaving", daemon=True)
                leaving.start()
                self._leaving = [process for process in self._leaving if process.is_alive()] + [leaving]
            spare, self._spare = self._spare, None
            if spare is not None and spare.over:
                spare.put_away()
                spare = None
            self._process = spare or self._new()
            self._news()
        return self._process

    def _stand_by(self, process: Process) -> None:
        """Have a second process at hand, for a short job that comes while a long one is computed: libraries take seconds."""
        if self._spare is None and not self._closing and not process.over:
            self._spare = self._new()

    def _new(self) -> Process:
        return Process(self.worker, self._log, self._news)

    def _follow(self, job: Job, process: Process) -> None:
        """Hand a job to the process and hear what becomes of it."""
        process.give({"id": job.id, "folder": str(job.folder)})
        if job.kind in LONG:
            self._stand_by(process)
        begun = False
        for what in process.says():
            if what.get("id") == job.id:
                begun = True
                if self._hear(job, what):
                    return
        if job.state == WAITING:  # it makes room for another one
            return
        code = process.end()
        with self._lock:
            if (
                job.state == RUNNING and not begun and self._retried != job.id
            ):  # the process had ended before it took the job
                self._retried = job.id
                self._put_back(job, 0)
                return
        if job.state == CANCELLED:
            self._end(job, CANCELLED, "Cancelled; what is finished is kept, and it can go on from there.")
        else:
            why = signal.Signals(-code).name if code < 0 else f"code {code}"
            self._end(
                job,
                FAILED,
                f"The process that computes ended before the job was done ({why}); what is finished is kept: go on with it.",
            )

    def _hear(self, job: Job, what: dict[str, Any]) -> bool:
        """Note what the process says; True when the job is over."""
        if "progress" in what:
            job.done, job.total = what["progress"]
            job.what = what["what"]
            self._changed(job)
            return False
        if "done" in what:
            self._end(job, DONE, "")
            return True
        if "code" not in what:  # it has begun, or there is more of it to see
            job.filmed, job.grown = job.filmed or "film" in what, job.grown + ("grown" in what)
            self._changed(job)
            return False
        complaints = [str(complaint) for complaint in what["complained"]]
        job.warnings += [
            complaint.removeprefix("warning: ") for complaint in complaints if complaint.startswith("warning: ")
        ]
        with suppress(ValueError):
            job.results.append(json.loads(what["said"]))
        if what["code"] == 0:
            self._changed(job)
            return False
        if job.state == WAITING:
            return True
        if what["code"] == INTERRUPTED or job.state == CANCELLED:
            self._end(job, CANCELLED, "Cancelled; what is finished is kept, and it can go on from there.")
            return True
        sentence = next(
            (complaint for complaint in reversed(complaints) if not complaint.startswith("warning: ")), "It failed."
        )
        job.field = what.get("field")
        self._end(job, REFUSED if what["code"] == BAD_INPUT else FAILED, sentence)
        return True

    def _end(self, job: Job, state: str, sentence: str) -> None:
        job.state, job.sentence, job.ended = state, sentence, time.time()
        self._changed(job)
        if job.id in self.jobs:
            with suppress(InputError, OSError):
                job.save()

    def _changed(self, job: Job) -> None:
        with self._lock:
            self.version += 1
            job.version = self.version
            job.changed()
        self.notify()

    def _news(self) -> None:
        with self._lock:
            self.version += 1
        self.notify()

    def _forget_old(self) -> None:
        ended = [job for job in self.jobs.values() if not job.open]
        for job in ended[: max(0, len(self.jobs) - KEEP)]:
            self.jobs.pop(job.id)
            shutil.rmtree(job.folder, ignore_errors=True)

    def _stop_process(self) -> None:
        process = self._process
        if process is not None:
            process.stop()


#: Time that a process has to stop by itself when it is told to [s].
PATIENCE = 3.0

#: Priority of a process that is to stop: another one has taken over, and somebody waits for that.
LAST = 19


class Process:
    """A process that does jobs, heard by a thread of its own.

    Parameters
    ----------
    command : sequence of str
        Its command line.
    log : Path
        Takes what it says beside its lines.
    heard : callable
        Called when it has become ready.
    """

    def __init__(self, command: Sequence[str], log: Path, heard: Callable[[], None]) -> None:
        with open(log, "ab", opener=private_file) as file:
            self._process = subprocess.Popen(
                list(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=file, text=True, encoding="utf-8",
                bufsize=1, start_new_session=True,
            )  # fmt: skip
        self.ready = False
        self._stopped = False
        self._heard = heard
        self._answers: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._listen, name="process", daemon=True)
        self._thread.start()

    @property
    def over(self) -> bool:
        """Whether it has ended, or has been told to: it takes no more jobs."""
        return self._stopped or self._process.poll() is not None

    def give(self, job: dict[str, Any]) -> None:
        """Hand it a job; where it has ended meanwhile, :meth:`says` ends at once."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(json.dumps(job) + "\n")

    def says(self) -> Iterator[dict[str, Any]]:
        """Words of the process, until it ends or is told to."""
        while (what := self._answers.get()) is not None:
            yield what

    def end(self) -> int:
        """Its code, when it has ended."""
        return self._process.wait()

    def tell(self) -> None:
        """Tell it to stop, and let it stand back meanwhile; nothing more is heard of it."""
        self._stopped = True
        self._process.terminate()
        with suppress(OSError, AttributeError):  # it has ended, or this system has no such thing
            os.setpriority(os.PRIO_PGRP, self._process.pid, LAST)
        self._answers.put(None)

    def stop(self) -> None:
        """Tell it to stop, and wait until it has."""
        self.tell()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def put_away(self) -> None:
        """Stop it, and close what leads to it."""
        self.stop()
        self._thread.join()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        with suppress(ValueError):  # its lines are closed
            for line in self._process.stdout:
                self._take(line)
        self._answers.put(None)

    def _take(self, line: str) -> None:
        try:
            what = json.loads(line)
        except ValueError:
            return
        if not isinstance(what, dict):
            return
        if what.get("ready"):
            self.ready = True
            self._heard()
        else:
            self._answers.put(what)
