"""Batches ask for their cases one by one, keep none of them, and go on where one cannot be computed."""

import threading
import tracemalloc
import warnings
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as st
from stylobate.errors import OutOfRangeWarning
from stylobate.models.base import Case
from stylobate.models.engine import engine_for
from stylobate.models.plane.columns import ColumnLanes
from stylobate.models.shared.lanes import LONGEST_CALL, MOST_ALONE, WINDOW, run_alike, run_lanes
from stylobate.simulate import run_cases

JOINT = st.Joint(5e9, 2.5e9, friction_angle=35.0)


def column(drums=2, joint=JOINT):
    return st.Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=joint, name=f"{drums} drums"
    )


class Block:
    """A block of lanes whose runs end at once."""

    lanes = 16

    def __init__(self, kind=None):
        self.kind, self.loaded = kind, {}

    def load(self, lane, case):
        if isinstance(case, str):
            raise st.InputError("this one is odd.")
        self.loaded[lane] = case

    def advance(self):
        pass

    def is_over(self, lane):
        return True

    def collect(self, lane):
        return self.kind, self.loaded.pop(lane)


def test_cases_are_asked_for_as_lanes_become_free():
    requests, most = 0, 0

    def cases():
        nonlocal requests
        for number in range(20_000):
            requests += 1
            yield number

    done = 0
    for index, (_, case) in run_lanes(Block, cases(), 1):
        assert index == case
        done += 1
        most = max(most, requests - done)
    assert done == requests == 20_000
    assert most <= WINDOW + 2 * Block.lanes + 1
    # nothing but what waits to be handed over is ahead of the caller
    before = threading.active_count()
    stream = run_lanes(Block, (number for number in iter(int, 1)), 1)  # without end
    assert next(stream)[0] >= 0
    stream.close()
    assert threading.active_count() <= before


@pytest.mark.parametrize("threads", [1, 3])
def test_what_lanes_hand_over_goes_on_alone(threads):
    """Two of three runs are handed over: each is a result once, what cannot be computed too, and few wait at a time."""
    waiting, counted = set(), []

    class Handing(Block):
        def collect(self, lane):
            number = self.loaded.pop(lane)
            if number % 3 == 0:
                return number
            waiting.add(number)
            counted.append(len(waiting))
            return lambda: alone(number)

    def alone(number):
        waiting.remove(number)
        if number == 7:
            raise st.InputError("this one is odd.")
        return number

    results = dict(run_lanes(Handing, range(1000), threads))
    assert results.pop(7).reason == "this one is odd"
    assert results == {number: number for number in range(1000) if number != 7}
    # each thread may add those of its lanes before it looks
    assert max(counted) <= MOST_ALONE + threads * Block.lanes
    assert not waiting


def test_memory_is_flat_however_many_cases_there_are():
    def peak(count):
        tracemalloc.start()
        for _ in run_alike(lambda case: "one", Block, (np.full(1000, number) for number in range(count)), 1):
            pass
        memory = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return memory

    few, many = peak(WINDOW), peak(4 * WINDOW)
    assert many < 2.0 * few


def test_kinds_share_blocks_and_every_case_is_run_once():
    cases = [number % 3 for number in range(2 * WINDOW + 100)]
    results = dict(run_alike(lambda case: case, Block, iter(cases), 2))
    assert results == {index: (case, case) for index, case in enumerate(cases)}


def test_a_case_that_cannot_be_loaded_is_failed_and_the_others_go_on():
    cases = ["odd" if number % 50 == 7 else number for number in range(500)]
    results = dict(run_lanes(Block, cases, 2))
    assert len(results) == 500
    for index, case in enumerate(cases):
        if case == "odd":
            assert results[index].outcome.label == "failed"
            assert results[index].reason == "this one is odd"
        else:
            assert results[index] == (None, case)


class Kept(Sequence):
    """Cases that are made when asked for; says how many live at the same time."""

    def __init__(self, count):
        self.count = count
        self.alive = self.most = 0
        self.motion = st.harmonic(2.0, 0.5, 0.05)

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        if not 0 <= index < self.count:
            raise IndexError(index)
        return Case(BLOCK, self.motion.scaled(1.0 + index / self.count))


BLOCK = column(1)


@pytest.mark.parametrize(
    "model", [st.HousnerBlock(), st.RigidBeam(), st.DistinctElement2D()], ids=lambda model: model.name
)
def test_models_take_sequences_that_make_their_cases(model):
    cases = Kept(40)
    lazily = dict(run_cases(cases, model, threads=2))
    listed = dict(run_cases(list(cases), model, threads=1))
    assert {k: measures.row() for k, measures in lazily.items()} == {
        k: measures.row() for k, measures in listed.items()
    }
    assert sorted(lazily) == list(range(40))


def test_of_runs_that_end_together_each_has_its_own_measures_or_its_own_error(monkeypatch):
    """Eight runs of one length in one block: together to the bits of each alone; an error belongs to one of them."""
    stone, time = column(), np.arange(0.0, 0.5, 0.01)
    motions = [st.Motion(0.01, size * np.sin(9.0 * time)) for size in np.linspace(0.1, 4.0, 8)]
    cases, model = [Case(stone, motion) for motion in motions], st.DistinctElement2D()
    alone = [dict(run_cases([case], model, threads=1))[0] for case in cases]
    assert dict(run_cases(cases, model, threads=1)) == dict(enumerate(alone))
    stay = ColumnLanes.stay

    def odd(block, lanes, *given):
        if any(block.case(lane).motion is motions[3] for lane in lanes):
            raise st.InputError("this one is odd.")
        return stay(block, lanes, *given)

    monkeypatch.setattr(ColumnLanes, "stay", odd)
    results = dict(run_cases(cases, model, threads=1))
    assert results.pop(3).reason == "this one is odd"
    assert results == {number: measures for number, measures in enumerate(alone) if number != 3}


def test_a_beam_on_joints_that_do_not_hold_it_is_failed_and_aborts_no_batch():
    soft = st.Joint(1e6, 5e5, friction_angle=35.0)
    motion = st.harmonic(1.0, 1.0, 1.0)
    columns = [column(4), column(4, soft), column(1, soft), column(4)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        table = st.simulate_many(columns, [motion] * 4, st.RigidBeam())
        single = st.simulate(columns[1], motion, st.RigidBeam())
    assert list(table.outcome) == ["rocked", "failed", "failed", "rocked"]
    assert "too soft to hold the column upright" in table.reason[1]
    assert single.outcome.label == "failed"
    assert single.measures.reason == table.reason[1]


def test_absurd_numbers_of_steps_are_refused_with_the_estimate():
    endless = [
        (column(200, st.Joint(1e15, 5e14, 35.0)), st.harmonic(1.0, 1.0, 10.0), st.DistinctElement2D()),
        (column(1), st.harmonic(1.0, 1.0, 1e-12), st.DistinctElement2D()),
        (column(1), st.harmonic(1.0, 1.0, 1e-12), st.RigidBlock()),
        (column(1), st.harmonic(1.0, 1.0, 1e-12), st.RigidBeam()),
        (column(1), st.harmonic(1.0, 1.0, 1e-12), st.HousnerBlock()),
        (column(12), st.harmonic(1.0, 1.0, 10.0), st.DistinctElement2D(time_step=1e-12)),
    ]
    for stone, motion, model in endless:
        with pytest.raises(st.InputError, match=r"would take .* steps of .* s, about .*; allowed is up to 60 minutes"):
            st.simulate(stone, motion, model, tail=5.0)
        with pytest.raises(st.InputError, match="would take"):
            st.simulate_many(stone, [motion], model, tail=5.0)
    with pytest.raises(st.InputError, match="longer output interval"):
        st.simulate(column(1), st.harmonic(1.0, 1.0, 10.0), st.HousnerBlock(), output_interval=1e-12)
    for drums in (1, 12):  # what is usual is far below
        stone, motion = column(drums, st.Joint(1e12, 1e12, 35.0)), st.harmonic(1.0, 1.0, 120.0)
        step, cost = engine_for(st.DistinctElement2D(), stone).expected_step(motion)
        assert motion.duration / step * cost < 200.0


@pytest.mark.parametrize(
    "model", [st.DistinctElement2D(points=32), st.RigidBeam(), st.RigidBlock()], ids=lambda m: m.name
)
def test_compiled_calls_are_short_however_long_the_run(model):
    from stylobate.models.rigid_beam.lanes import BeamLanes, loop_for
    from stylobate.simulate import RunOptions

    stone, motion = column(60, st.Joint(1e12, 1e12, 35.0)), st.harmonic(1.0, 1.0, 100.0)
    case = Case(stone, motion)
    if isinstance(model, st.RigidBeam):
        block = BeamLanes(model.pack, loop_for(model.pack(stone), motion), RunOptions())
        chunk = block.loop.steps
    else:
        block = engine_for(model, stone).block(RunOptions())
        chunk = block.chunk
    calls = []
    block.load(0, case)

    class Kernel:
        def __getattr__(self, name):
            return getattr(real, name)

        def advance(self, *arguments):
            calls.append(
                next(
                    argument for argument in reversed(arguments[:7]) if isinstance(argument, int) and argument != chunk
                )
            )

    if isinstance(model, st.RigidBeam):
        from stylobate.models.rigid_beam import lanes

        real, lanes.kernel = lanes.kernel, Kernel()
        try:
            block.advance()
            block.advance(10_000)
        finally:
            lanes.kernel = real
    else:
        block.records.kernel = SimpleNamespace(advance=lambda _, chunks: calls.append(chunks))
        block.advance()
        block.advance(10_000)
    _, cost = engine_for(model, stone).expected_step(motion)
    assert sum(calls[1:]) == 10_000
    assert max(calls) == 1 or max(calls) * chunk * cost <= LONGEST_CALL


@pytest.mark.parametrize("drums", [1, 3])
def test_a_beam_that_would_slide_says_so(drums):
    slippery = column(drums, st.Joint(5e9, 2.5e9, friction_angle=5.0))
    motion = st.harmonic(1.0, 0.1, 0.1)
    with pytest.warns(OutOfRangeWarning, match="slides before it rocks, and rigid-beam as it is set has no sliding"):
        st.simulate(slippery, motion, st.RigidBeam())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        st.simulate(slippery, motion, st.RigidBeam(sliding=True))
        st.simulate(column(drums), motion, st.RigidBeam())
