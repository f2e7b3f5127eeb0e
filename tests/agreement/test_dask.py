"""Runs on a Dask cluster: the same rows to the bit as by threads, whatever happens to the workers."""

import dataclasses
import gc
import json
import logging
import os
import signal
import socket
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from poison import Poisoning, Poisonous

import stylobate as st
from stylobate.campaign import cluster as module
from stylobate.campaign.cluster import HandOut, executor, on_cluster
from stylobate.campaign.digests import Hasher
from stylobate.campaign.local_workers import started
from stylobate.campaign.runs import Request, run_all
from stylobate.campaign.worker import Chunk, Stream, law, pack, results_of, unpack
from stylobate.cli.main import call
from stylobate.models.base import Case, Cases, RunOptions
from stylobate.motion.request import MotionRequest
from stylobate.simulate import run_cases

COLUMN = st.preset("paper-monolithic")
POISON = dataclasses.replace(COLUMN, name="poison")
MOTION = st.harmonic(1.0, 1.0, 1.0)


@pytest.fixture(scope="module")
def cluster():
    """One worker; it is killed again and again."""
    pytest.importorskip("distributed")
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(Path(__file__).parents[1]), before]))
    try:
        with on_cluster("local", 1) as client:
            yield client
    finally:
        os.environ.pop("PYTHONPATH") if before is None else os.environ.update(PYTHONPATH=before)


def test_rows_are_those_of_threads_to_the_bit(cluster, tmp_path):
    records = MotionRequest(files=("sample:el-centro-1940",)).expand().motions
    motions = [
        st.harmonic(0.8, 1.0, 2.0),
        *(record.replace(ax=record.samples[:300], ay=None, az=None) for record in records),
    ]
    columns = [st.preset("paper-monolithic"), st.preset("paper-12-drums")]
    cases = Cases(60, lambda n: Case(columns[n % 3 == 0], motions[n % len(motions)].scaled(0.3 + 0.05 * n)))
    on_workers = run_all(
        Request.of(cases, Hasher(st.DistinctElement2D(), RunOptions()), 0.1),
        st.Campaign(ledger=tmp_path / "runs.sqlite"),
    )
    by_threads = {number: measures.row() for number, measures in run_cases(cases, st.DistinctElement2D(), quiet=0.1)}
    assert list(map(repr, on_workers)) == [repr(by_threads[number]) for number in range(60)]


def test_a_killed_worker_is_replaced_and_its_chunks_are_computed_again(cluster):
    kill = threading.Timer(0.5, lambda: os.kill(pid, signal.SIGKILL))
    [pid] = cluster.run(os.getpid).values()
    cases = Cases(60, lambda n: Case(COLUMN, MOTION.scaled(1.0 + n)))
    kill.start()
    rows = run_all(Request.of(cases, Hasher(Poisonous(0.05))))
    assert [row["peak_top_displacement_m"] for row in rows] == [1.0 + n for n in range(60)]
    assert list(cluster.run(os.getpid).values()) != [pid]


def test_the_libraries_of_the_cluster_say_nothing_of_their_own(cluster):
    names = ("distributed", "distributed.client", "distributed.worker", "tornado.application")
    assert not any(logging.getLogger(name).isEnabledFor(logging.CRITICAL) for name in names)


def test_a_case_that_kills_its_workers_is_a_run_that_failed(cluster):
    for _ in range(2):  # so often that the one who starts the worker again gives up and is replaced
        results = dict(executor()([Case(COLUMN, MOTION), Case(POISON, MOTION)], Poisonous(), RunOptions(), None))
        assert results[0].row()["outcome"] == "rocked"
        assert results[1].row()["outcome"] == "failed"
        assert results[1].reason == "the workers that computed it died, each time"


STUDY = """
column = "paper-monolithic"
model = "housner"
[motions]
files = ["sample:el-centro-1940"]
[scale]
im = "pga"
levels = ["0.3g", "0.5g", "0.9g"]
"""


def test_the_recipe_for_slurm_and_a_study_on_its_cluster(cluster, tmp_path, monkeypatch, capsys):
    page = (Path(__file__).parents[2] / "docs" / "how_to" / "cluster.md").read_text(encoding="utf-8")
    script = page.split("```python\n")[1].split("```")[0]
    settings = {}

    class Scheduler:  # in place of dask_jobqueue.SLURMCluster, which takes a queue of jobs
        scheduler_address = cluster.scheduler.address

        def __init__(self, **job):
            settings.update(job)

        def scale(self, jobs):
            settings["jobs"] = jobs

    monkeypatch.setitem(sys.modules, "dask_jobqueue", SimpleNamespace(SLURMCluster=Scheduler))
    monkeypatch.setattr("builtins.input", lambda: "")
    exec(script, {})
    address = capsys.readouterr().out.split()[-1]
    assert address == cluster.scheduler.address
    assert settings["jobs"] > 0
    (tmp_path / "study.toml").write_text(STUDY)
    for out, options in (("threads", []), ("dask", ["--dask", address])):
        arguments = ["study", "run", tmp_path / "study.toml", "--out", tmp_path / out, "--json", *options]
        assert call(list(map(str, arguments))) == 0, capsys.readouterr().err
        assert json.loads(capsys.readouterr().out)["computed"] == 3
    tables = [(tmp_path / out / "study.parquet").read_bytes() for out in ("threads", "dask")]
    assert tables[0] == tables[1]


def test_workers_of_which_one_dies_while_it_starts_are_started_again():
    tries = []

    def make():
        tries.append(1)
        if len(tries) < 3:
            raise RuntimeError("Nanny failed to start.")
        return "cluster"

    assert started(make) == "cluster"
    with pytest.raises(ZeroDivisionError):
        started(lambda: 1 / 0)


# -- without a cluster: the bookkeeping ------------------------------------------------------------------------------


class Killed(Exception):
    """As of Dask, by its name."""


Killed.__name__ = "KilledWorker"


class Client:
    """Computes a chunk when it is asked what has become of it; the odd chunk dies with its worker, or is lost."""

    def __init__(self, poison=(), lost=(), twice=False, threads=2):
        self.poison, self.lost, self.twice, self.threads = set(poison), set(lost), twice, threads
        self.status, self.chunks = "running", []

    def nthreads(self):
        return {"one": self.threads}

    def subscribe_topic(self, topic, handler):
        self.send = lambda message: handler((0.0, message))

    def unsubscribe_topic(self, topic):
        self.send = None

    def submit(self, task, *given, key, pure, **where):
        future = SimpleNamespace(status="finished", release=lambda: None)
        if task is not results_of.__globals__["run_chunk"]:
            future.result = lambda: task(*given)
            return future
        chunk = unpack(given[0])
        self.chunks.append(chunk.numbers)

        def done(tell):
            if not self.poison.isdisjoint(chunk.numbers):
                future.status, future.exception = "error", lambda: Killed()
            elif not self.lost.isdisjoint(chunk.numbers):
                self.lost -= set(chunk.numbers)
                future.status = "cancelled"
            else:
                for _ in range(1 + self.twice):
                    results_of(chunk, [future.result() for future in given[1]], self.send, "here")
            tell(future)

        future.add_done_callback = done
        return future


def handed_out(client, count=40):
    cases = Cases(count, lambda n: Case(COLUMN, MOTION.scaled(1.0 + n)))
    return list(HandOut(client, cases, Poisonous(), RunOptions()).results())


def test_a_chunk_that_kills_its_workers_is_cut_down_to_the_case():
    client = Client(poison=[7, 31])
    results = dict(handed_out(client))
    assert len(results) == 40
    assert {n for n, measures in results.items() if measures.outcome.label == "failed"} == {7, 31}
    assert [results[n].peak_top_displacement for n in range(6)] == [1.0 + n for n in range(6)]
    assert sorted(client.chunks[-2:]) == [[7], [31]]  # once more, each alone


def test_what_was_suspected_only_because_it_was_beside_is_computed_in_the_end():
    client = Client(poison=[7])
    cases = Cases(8, lambda n: Case(COLUMN, MOTION.scaled(1.0 + n)))
    work = HandOut(client, cases, Poisonous(), RunOptions())
    results = {}
    for number, measures in work.results():
        results[number] = measures
        if len(results) == 7:  # what killed the workers was something else
            client.poison.clear()
    assert results[7].outcome.label == "rocked"


def test_lost_chunks_are_sent_again_and_results_that_come_twice_count_once():
    results = handed_out(Client(lost=[3, 20], twice=True))
    assert sorted(number for number, _ in results) == list(range(40))


def test_chunks_are_about_as_long_as_they_should_be():
    client = Client()
    handed_out(client, 5_000)
    sizes = [len(chunk) for chunk in client.chunks]
    assert sizes[0] == 128
    assert max(sizes) <= 20_000
    assert all(after <= 8 * max(sizes[: k + 1]) for k, after in enumerate(sizes[1:]))
    few = Client(threads=30)
    handed_out(few, 40)
    assert len(few.chunks) >= 20  # as many workers as there are have something to do


class Seeing(Poisoning):
    """Its peaks are the first samples."""

    def run_many(self, cases, options, threads):
        for index, measures in super().run_many(cases, options, threads):
            yield index, dataclasses.replace(measures, peak_top_displacement=float(cases[index].motion.samples[0]))


class Seen(Poisonous):
    """The model of these."""

    engines = (Seeing,)


def test_motions_that_are_made_one_by_one_are_not_taken_for_one_another(monkeypatch):
    """Numbers of arrays that are gone are given again: the arrays of a chunk are kept until it is sent."""

    monkeypatch.setattr("stylobate.campaign.cluster.MOTIONS", 8)
    cases = Cases(100, lambda n: Case(COLUMN, st.Motion(0.01, np.full(200, float(n)))))
    results = dict(HandOut(Client(), cases, Seen(), RunOptions()).results())
    assert [results[n].peak_top_displacement for n in range(100)] == list(range(100))


class ImpatientClient(Client):
    """Its workers ask for more before they have finished."""

    def __init__(self):
        super().__init__()
        self.where, self.waiting = [], []

    def submit(self, task, *given, key, pure, **where):
        future = super().submit(task, *given, key=key, pure=pure)
        if hasattr(future, "add_done_callback"):
            self.where.append(where)
            later = future.add_done_callback
            future.add_done_callback = lambda tell: self.waiting.append(lambda: later(tell))
            self.send((key, f"tcp://worker-{len(self.where)}"))
            if len(self.where) > 2:
                self.waiting.pop(0)()
        return future


def test_the_worker_that_asks_gets_the_next_chunk_and_the_last_ones_are_small(monkeypatch):
    client = ImpatientClient()
    cases = Cases(300, lambda n: Case(COLUMN, MOTION.scaled(1.0 + n)))
    work, numbers = HandOut(client, cases, Poisonous(), RunOptions()), []
    work._count_threads()
    work._each, work._largest = 0.1, 300  # as if it had been timed
    monkeypatch.setattr(work, "_time", lambda *_: None)
    runs = work.results()
    while work._next < len(cases):
        numbers.append(next(runs)[0])
    for finish in client.waiting:
        finish()
    numbers += [number for number, _ in runs]
    assert sorted(numbers) == list(range(300))
    assert client.where[:2] == [{}, {}]
    assert client.where[2] == {"workers": ["tcp://worker-1"], "allow_other_workers": True}
    sizes = [len(chunk) for chunk in client.chunks]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[0] == 75  # half of a worker's share of what is left
    assert sizes[-1] <= 4


class Twenty(Poisoning):
    """Twenty runs at a time, of which the oldest ends next."""

    def run_many(self, cases, options, threads):
        coming, running = enumerate(cases), []
        while True:
            while len(running) < 20 and (pair := next(coming, None)) is not None:
                running.append(pair)
            if not running:
                return
            BESIDE.append(len(running))
            time.sleep(self.model.pause)
            index, case = running.pop(0)
            if case.motion.factor < 0.0:
                raise ArithmeticError("a fault")
            for _, measures in Poisoning(Poisonous(), COLUMN).run_many([case], options, 1):
                yield index, measures


@dataclasses.dataclass(frozen=True)
class Lanes(Poisonous):
    """The model of these."""

    name = "lanes"
    engines = (Twenty,)


BESIDE: list[int] = []


def test_the_next_chunk_begins_before_the_lanes_of_the_last_one_are_empty():
    stream, peaks, threads = Stream(), {}, []
    BESIDE.clear()

    def chunk(name, first):
        numbers = list(range(first, first + 40))
        factors = [float(number) for number in numbers]
        return Chunk(name, law(), Lanes(0.01), RunOptions(), numbers, [COLUMN], [0] * 40, [0] * 40, factors, ["m"] * 40)

    def compute_one(name, first, more):
        motion = (MOTION.dt, MOTION.samples, None, None)
        results_of(chunk(name, first), [motion], lambda message: take(message[1]), "here", stream, more)

    def take(content):
        if isinstance(content, bytes):
            peaks.update((number, measures.peak_top_displacement) for number, measures in unpack(content))
        else:
            assert content > 0.3  # 40 cases of 0.01 s

    def next_one():
        threads.append(threading.Thread(target=compute_one, args=("b", 40, lambda: None)))
        threads[0].start()

    compute_one("a", 0, next_one)
    threads[0].join()
    assert peaks == {number: float(number) for number in range(80)}
    assert set(BESIDE[:60]) == {20}  # no lane was empty until both chunks were in them
    assert stream.remaining == 0


def test_what_has_finished_is_sent_although_nothing_else_finishes():
    sent = []
    numbers, motion = [0, 1], (MOTION.dt, MOTION.samples, None, None)
    chunk = Chunk("a", law(), Poisonous(0.45), RunOptions(), numbers, [COLUMN], [0, 0], [0, 0], [1.0, 2.0], ["m", "m"])
    results_of(chunk, [motion], lambda message: sent.append(message[1]), "here")
    assert [number for number, _ in unpack(sent[0])] == [0]
    assert [number for number, _ in unpack(sent[1])] == [1]


def test_a_fault_in_a_run_is_told_and_the_lanes_go_on():
    stream, motion = Stream(), (MOTION.dt, MOTION.samples, None, None)

    def result(factor):
        chunk = Chunk("a", law(), Lanes(), RunOptions(), [0], [COLUMN], [0], [0], [factor], ["m"])
        sent = []
        results_of(chunk, [motion], lambda message: sent.append(message[1]), "here", stream)
        return unpack(sent[0])

    with pytest.raises(ArithmeticError, match="a fault"):
        result(-1.0)
    assert stream.remaining == 0
    [(number, measures)] = result(2.0)
    assert (number, measures.peak_top_displacement) == (0, 2.0)


def test_a_worker_with_another_law_is_refused_in_a_sentence():
    chunk = Chunk("a", ("0.0", "other"), Poisonous(), RunOptions(), [0], [COLUMN], [0], [0], [1.0], ["m"])
    with pytest.raises(st.InputError, match="the worker at tcp://there computes with stylobate"):
        results_of(unpack(pack(chunk)), [(0.1, np.zeros(3), None, None)], print, "tcp://there")
    assert law()[0] == st.__version__


def test_a_scheduler_that_is_gone_is_one_sentence():
    client = Client(threads=0)
    client.status = "closed"
    with pytest.raises(st.errors.StylobateError, match="the Dask scheduler is gone"):
        handed_out(client)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nowhere", ""])
def test_an_unreachable_scheduler_is_one_sentence(address, monkeypatch, capsys):
    pytest.importorskip("distributed")
    assert module.PATIENCE < 8.0
    monkeypatch.setattr(module, "PATIENCE", 0.5)
    grid = ["--frequencies", "1:2:2", "--amplitudes", "0.1g:0.3g:3"]
    started = time.monotonic()
    assert call(["domain", "paper-monolithic", *grid, "--dask", address]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert f"no Dask scheduler answers at {address!r}" in message
    assert time.monotonic() - started < 8.0


def test_what_answers_and_is_no_scheduler_is_one_sentence(monkeypatch, capsys):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(module, "PATIENCE", 1.0)
    closed = []
    monkeypatch.setattr(distributed.Client, "close", lambda self, *_, **__: closed.append(self))
    with socket.create_server(("127.0.0.1", 0)) as server:
        page = b"HTTP/1.1 400 Bad Request\r\n\r\n" + 200 * b"no scheduler "

        def answer():
            with suppress(OSError):
                while True:
                    with server.accept()[0] as asking:
                        asking.sendall(page)

        threading.Thread(target=answer, daemon=True).start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(st.InputError, match="no Dask scheduler answers at"), on_cluster(address):
            pass
        gc.collect()  # what would be closed now would be waited for, and would tell of it
    assert closed == []


def test_without_dask_the_remedy_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(st.InputError, match=r"install stylobate\[cluster\]"), on_cluster("local"):
        pass
