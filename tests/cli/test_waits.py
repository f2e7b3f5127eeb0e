"""What a person who waits is told on standard error: that it compiles, how long it will take, how far it is."""

import logging
from types import SimpleNamespace

import numpy as np
import pytest
from numba.core import event

import stylobate as st
from stylobate import DistinctElement2D, DistinctElement3D
from stylobate.cli import console
from stylobate.cli.main import call
from stylobate.kernels import jit
from stylobate.models.base import Case, duration
from stylobate.models.drums.stepped import LaneEngine
from stylobate.models.engine import engine_for
from stylobate.simulate import run_cases

COLUMN = st.preset("paper-12-drums")


@pytest.fixture
def logged(capsys):
    """What is told to the log, as the command line says it."""
    log = logging.getLogger("stylobate")
    before, level = list(log.handlers), log.level
    console.log_to_stderr()
    yield lambda: capsys.readouterr().err
    log.handlers[:] = before
    log.setLevel(level)


class Bell:
    """A timer that rings when the test says so."""

    rung: "Bell"

    def __init__(self, wait, ring):
        self.wait, self.ring, self.running = wait, ring, False
        Bell.rung = self

    def start(self):
        self.running = True

    def cancel(self):
        self.running = False


def test_compiling_is_told_where_it_takes_long(logged, monkeypatch):
    clock = [100.0]
    monkeypatch.setattr(jit, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    monkeypatch.setattr(jit, "threading", SimpleNamespace(Timer=Bell))
    with event.install_listener("numba:compile", jit._Wait()):
        with event.trigger_event("numba:compile"), event.trigger_event("numba:compile"):  # kernels compile others
            assert Bell.rung.wait == 2.0
            clock[0] += 1.5
        assert not Bell.rung.running
        clock[0] += 1000.0  # in which nothing is compiled
        with event.trigger_event("numba:compile"):
            assert Bell.rung.wait == 0.5
            clock[0] += 0.5
            assert logged() == ""
            Bell.rung.ring()
            assert logged().startswith("stylobate: compiling, which these settings need once on this machine: ")
            assert Bell.rung.wait == 30.0
            clock[0] += 30.0
            last = Bell.rung
            last.ring()
            assert logged() == "stylobate: still compiling, for 32 s so far ...\n"
        last.ring()  # one that came too late
    assert logged() == ""


def test_nothing_is_told_where_nobody_listens(capsys, monkeypatch):
    monkeypatch.setattr(console, "FIRST_LINE", 0.0)
    monkeypatch.setitem(run_cases.__globals__, "LONG_WAIT", 0.0)
    assert call(["run", "paper-monolithic", "--harmonic", "1Hz,0.1g,0.2s", "--replicates", "0", "--json"]) == 0
    assert capsys.readouterr().err == ""


def test_progress_in_lines(logged, monkeypatch):
    clock = [100.0]
    monkeypatch.setattr(console, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    lines = console.Lines("runs")
    for at, done in ((1.0, 0), (3.0, 1), (5.0, 2), (7.0, 3), (9.0, 4), (11.0, 5), (15.0, 7), (17.0, 8), (40.0, 30)):
        clock[0] = 100.0 + at
        lines(done, 30)
    # the first after ten seconds, the next after half as many again; two seconds a run after the first; none at the end
    assert logged().splitlines() == [
        "stylobate: 5 of 30 runs, about 50 s to go ...",
        "stylobate: 8 of 30 runs, about 44 s to go ...",
    ]


def left_at(monkeypatch, finished, total):
    """The time to go that is told where so many are done at these times."""
    clock = [0.0]
    monkeypatch.setattr(console, "time", SimpleNamespace(monotonic=lambda: clock[0]))
    pace, forecasts = console.Pace(), []
    for clock[0], done in finished:
        forecasts.append(pace.remaining(done, total))
    return forecasts


def test_the_time_to_go_is_that_of_runs_and_not_of_compiling(monkeypatch):
    # forty seconds in which code is compiled, then a run a second
    steady = left_at(monkeypatch, [(0.0, 0), *((40.0 + k, 1 + k) for k in range(11))], 1001)
    assert steady[:6] == [None] * 6
    assert steady[-1] == duration(990.0)
    # twelve hundred runs that an earlier call has left, within a second, then the same
    kept = left_at(
        monkeypatch, [*((0.001 * k, k) for k in range(1201)), *((40.0 + k, 1201 + k) for k in range(11))], 2201
    )
    assert kept[:-6] == [None] * (len(kept) - 6)
    assert kept[-1] == duration(990.0)
    # two hundred thousand that take eight seconds to be read, then a run a second without any longer pause
    read = [(4e-5 * k, k) for k in range(200_001)]
    many = left_at(monkeypatch, [*read, *((8.0 + k, 200_000 + k) for k in range(1, 12))], 201_000)
    assert set(many[: len(read) + 4]) == {None}
    assert many[-1] == duration(989.0)


def test_runs_that_end_many_at_a_time_tell_nothing_until_some_such_times_have_passed(monkeypatch):
    # sixteen lanes end within some milliseconds every minute: of 1600 runs all take 100 minutes
    burst = [(40.0 + 60.0 * (1 + n) + 0.001 * k, 1 + k + 16 * n) for n in range(5) for k in range(16)]
    forecasts = left_at(monkeypatch, [(0.0, 0), *burst], 1600)
    first = next(k for k, forecast in enumerate(forecasts) if forecast is not None)
    assert first == 1 + 3 * 16  # with the fourth minute
    assert forecasts[first] == duration(180.0 * (1600 - 49) / 48)


def test_progress_is_in_lines_where_there_is_no_terminal(logged, monkeypatch):
    monkeypatch.setattr(console, "FIRST_LINE", 0.0)
    assert call(["run", "paper-monolithic", "--harmonic", "1Hz,0.1g,1s", "--replicates", "0"]) == 0
    assert " of 1 seconds of motion" in logged()


def test_a_long_computation_is_told_before_it_begins(logged, monkeypatch):
    motion = st.Motion(0.01, np.sin(np.arange(3001) / 10.0), metadata={"format": "made for this test"})
    model = st.DistinctElement2D()
    step, cost = engine_for(model, COLUMN).expected_step(motion)
    monkeypatch.setitem(run_cases.__globals__, "LONG_WAIT", 1.0)
    # so many to a lane, and the longest besides, as some lane begins it last
    for runs, threads, blocks in ((1, 1, 1), (320, 2, 10 + 31 / 32), (320, 1, 20 + 15 / 16)):
        results = run_cases([Case(COLUMN, motion)] * runs, model, threads=threads)
        monkeypatch.setattr(LaneEngine, "run_many", lambda *_: iter(()))
        assert list(results) == []
        what = "this run takes" if runs == 1 else "320 runs take"
        expected = duration(blocks * cost * motion.duration / step)
        assert logged() == f"stylobate: {what} about {expected} where nothing else runs on this machine ...\n"


def test_what_falls_takes_longer_than_told(logged, monkeypatch):
    monkeypatch.setitem(run_cases.__globals__, "LONG_WAIT", 0.0)
    block = st.Block([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], density=2500.0, name="cube")
    cube = st.Assembly([block], st.Joint(1e8, 5e7, friction_angle=35.0), name="cube")
    st.simulate(cube, st.harmonic(1.0, 0.1, 0.1), DistinctElement2D())
    assert " where nothing else runs on this machine, and longer once something falls ...\n" in logged()


def test_the_wait_for_several_directions_is_that_for_all_of_them(logged, tmp_path, monkeypatch):
    """Twelve directions, each with twenty columns like it of which fifteen ride along: the five others are a batch."""
    waits = []
    monkeypatch.setitem(
        run_cases.__globals__, "log_expected_time", lambda runs, wait, column: waits.append((runs, wait))
    )
    monkeypatch.setattr("stylobate.cli.run.conclude", lambda *_: pytest.fail("told before anything is computed"))
    command = ["run", "paper-monolithic", "--harmonic", "1Hz,0.3g,1s", "--azimuths", "0:330:12", "--threads", "1"]
    command += ["--replicates", "20", "--scatter", "friction=10%"]
    with pytest.raises(pytest.fail.Exception):
        call(command)
    ((what, wait),) = waits
    step, cost = engine_for(DistinctElement2D(), st.preset("paper-monolithic")).expected_step(
        st.harmonic(1.0, 0.3, 1.0)
    )
    assert what == "12 runs, each with 20 like it, take"
    assert wait == pytest.approx(12 * cost / step * (1.0 + 5 / 16 + 15 / 16), rel=0.3)  # the last steps, and the quiet


def test_damping_costs_what_its_steps_do():
    """A damped step in space costs half as much again as an undamped one; named losses are told by what acts."""
    column, motion = st.preset("paper-12-drums"), st.harmonic(1.0, 0.3, 1.0)
    free, stone = (
        engine_for(DistinctElement3D(losses=name), column).expected_step(motion) for name in ("none", "stone")
    )
    assert stone[0] < free[0]
    assert stone[1] == pytest.approx(1.5 * free[1], rel=0.05)


def test_links_cost_what_their_steps_do():
    """Five drums on five dowels take 1.5 times as long in the plane as without, and 1.7 times in space."""
    column, motion = (
        st.Column.of_drums([st.Drum(1.0, 1.0, 1.0, 2600.0)] * 5, COLUMN.joints[0]),
        st.harmonic(1.0, 0.3, 1.0),
    )
    linked = column.replace(
        links=tuple(st.Dowel(joint=k, shear_stiffness=1e8, shear_capacity=1e5) for k in range(1, 6))
    )
    for model in (DistinctElement2D(), DistinctElement3D()):
        bare, more = (engine_for(model, structure).expected_step(motion)[1] for structure in (column, linked))
        assert more == pytest.approx(1.6 * bare, rel=0.07)


def test_quiet_is_left_out_and_said(capsys, tmp_path):
    samples = np.concatenate([np.zeros(500), 0.1 * np.sin(2.0 * np.pi * np.arange(101) / 100.0), np.zeros(1500)])
    record = tmp_path / "record.csv"
    record.write_text("time_s,ax_g\n" + "".join(f"{0.01 * i:.2f},{sample:.6f}\n" for i, sample in enumerate(samples)))
    run = ["run", "paper-monolithic", "--motion", str(record), "--replicates", "0"]
    assert call(run) == 0
    assert " of 21 s, without what is quiet (--whole steps all)\n" in capsys.readouterr().out
    assert call([*run, "--whole"]) == 0
    assert "quiet" not in capsys.readouterr().out
