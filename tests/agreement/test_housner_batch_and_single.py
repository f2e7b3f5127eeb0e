"""Housner's block: single runs and batches against an adaptive solver, order of cases, number of threads, refused input."""

import gc
import math
import warnings
import weakref

import numpy as np
import pytest
from oracles.adaptive_block import run_adaptive

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.kernels.rocking.step import A_ADDRESS, LANES, trigonometry
from stylobate.models.base import Case, RunOptions
from stylobate.models.rocking import lanes as rocking_lanes
from stylobate.models.rocking.lanes import RockingLanes
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion, harmonic
from stylobate.outcome import Outcome
from stylobate.simulate import run_cases, simulate, simulate_many

COLUMN = preset("paper-monolithic")
JOINT = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=0.7)


def record() -> Motion:
    """Noise of two components, sampled as coarsely as records are."""
    random = np.random.default_rng(5)
    time = np.arange(1201) * 0.01
    shape = np.sin(np.pi * time / 12.0) ** 2
    x, z = (shape * np.convolve(random.standard_normal(1201), np.hanning(60), "same") for _ in range(2))
    return Motion(0.01, x / np.abs(x).max(), vertical=0.3 * z / np.abs(z).max(), factor=0.3 * g)


@pytest.mark.parametrize(
    ("motion", "tail"),
    [(harmonic(1.0, 0.24 * g, 4.0), 3.0), (harmonic(1.0, 0.40 * g, 10.0), 0.0), (harmonic(0.5, 0.3 * g, 6.0), 1.0),
     (record(), 2.0)],
)  # fmt: skip
@pytest.mark.parametrize("model", [HousnerBlock(), HousnerBlock(linear=True, restitution=0.8)])
def test_runs_agree_with_an_adaptive_solver(motion, tail, model):
    single = simulate(COLUMN, motion, model, tail=tail)
    batch = simulate_many(COLUMN, [motion], model, tail=tail).iloc[0]
    assert batch.outcome == str(single.outcome)
    assert batch.peak_rotation_rad == single.peak_rotation > 0.0
    histories, measures = run_adaptive(model, COLUMN, motion, RunOptions(tail=tail))
    assert (single.outcome, single.decided) == (measures.outcome, measures.decided)
    if single.collapsed:
        assert single.collapse_time == pytest.approx(measures.collapse_time, abs=0.01)
    else:
        assert single.peak_rotation == pytest.approx(measures.peak_rotation, rel=1e-4)
        tilt = np.interp(single.time, histories.time, histories.drum_rotation[:, 0])
        assert np.abs(single.drum_rotation[:, 0] - tilt).max() < 5e-3 * single.peak_rotation


def mixed_cases() -> list[Case]:
    stocky = Column.of_drums([Drum(2.0, 0.7, 0.6, 2000.0)], JOINT)
    shared = record()
    cases = []
    for k in range(3 * LANES // 2):
        motion = shared.scaled(0.5 + k / 50) if k % 3 else harmonic(0.5 + 0.02 * k, 0.3 * g, 2.0 + 0.05 * k)
        cases.append(Case(stocky if k % 4 == 0 else COLUMN, motion))
    return cases


def test_same_bits_for_any_order_and_number_of_threads():
    cases = mixed_cases()
    model = HousnerBlock()
    reference = dict(run_cases(cases, model, threads=1))
    assert len({str(m.outcome) for m in reference.values()}) >= 2
    threaded = dict(run_cases(cases, model, threads=2))
    order = np.random.default_rng(1).permutation(len(cases))
    shuffled = {order[i]: m for i, m in run_cases([cases[i] for i in order], model, threads=1)}
    for index, measures in reference.items():
        expected = repr(measures)
        assert repr(threaded[index]) == expected
        assert repr(shuffled[index]) == expected


def test_motions_that_share_samples_keep_their_own_vertical_component():
    both = record()
    other = both.replace(vertical=-2.0 * both.z_samples)
    motions = [both, both.without_vertical(), other, both.replace(dt=1.5 * both.dt)]
    alone = [simulate_many(COLUMN, [motion], HousnerBlock()).peak_rotation_rad[0] for motion in motions]
    assert len(set(alone)) == len(motions)
    for order in ([0, 1, 2, 3], [3, 2, 1, 0]):
        together = simulate_many(COLUMN, [motions[i] for i in order], HousnerBlock(), threads=1)
        assert together.peak_rotation_rad.tolist() == [alone[i] for i in order]


@pytest.mark.parametrize("seed", [83, 1, 2])
def test_runs_under_coarse_noise(seed):
    # The block hops, and goes through upright more than once within a step of the solver.
    random = np.random.default_rng(seed)
    block = Column.of_drums([Drum(3.0, 0.6, 0.6, 2000.0)], JOINT)
    x = random.normal(size=150)
    motion = Motion(0.0075, 0.8 * g * x / np.abs(x).max())
    model = HousnerBlock(restitution=0.5)
    response, (_, measures) = simulate(block, motion, model), run_adaptive(model, block, motion)
    assert str(response.outcome) == str(measures.outcome) == "rocked"
    assert measures.energy_imbalance < 1e-6
    assert response.peak_rotation == pytest.approx(measures.peak_rotation, rel=2e-2)


def test_the_tail_changes_nothing_before_it():
    # A record that ends in full swing, so that its last sample matters.
    motion = record().replace(acceleration=record().samples[:702], vertical=record().z_samples[:702], factor=0.4 * g)
    assert abs(motion.acceleration[-1]) > 0.05 * g
    short, long = (simulate(COLUMN, motion, HousnerBlock(), tail=tail, output_interval=0.01) for tail in (0.0, 2.0))
    assert short.peak_rotation > 0.0
    assert np.array_equal(short.drum_rotation, long.drum_rotation[: len(short.time)])


def test_followed_until_it_lies():
    motion = harmonic(1.0, 0.45 * g, 10.0)
    short, long = (simulate(COLUMN, motion, HousnerBlock(), until_end=flag) for flag in (False, True))
    assert short.outcome == long.outcome == Outcome.COLLAPSED
    assert short.collapse_time == pytest.approx(long.collapse_time)
    assert short.time[-1] == pytest.approx(short.collapse_time)
    assert np.abs(long.drum_rotation[-1, 0]) == pytest.approx(math.pi / 2, abs=0.1)


def test_polynomials_over_their_range():
    w = np.linspace(-2.0, 2.0, 2001)
    coefficients = trigonometry(False)
    assert np.polynomial.polynomial.polyval(w * w, coefficients[:8]) * w == pytest.approx(np.sin(w), abs=2e-13)
    assert np.polynomial.polynomial.polyval(w * w, coefficients[8:]) == pytest.approx(np.cos(w), abs=2e-13)


def test_refused_input():
    motion = harmonic(1.0, 0.3 * g, 1.0)
    with pytest.raises(InputError, match=r"12 drums.*rigid-beam"):
        simulate(preset("paper-12-drums"), motion, HousnerBlock())
    for bad in (-0.1, 1.1, math.nan):
        with pytest.raises(InputError, match=r"restitution.*\[0, 1\]"):
            HousnerBlock(restitution=bad)
    with pytest.raises(InputError, match="initial_rotation"):
        simulate(COLUMN, motion, HousnerBlock(initial_rotation=0.5))
    with pytest.raises(InputError, match="time_step"):
        simulate(COLUMN, motion, HousnerBlock(time_step=0.5))
    with pytest.raises(InputError, match="restitutoin"):
        HousnerBlock.from_settings({"restitutoin": "0.9"})
    assert HousnerBlock.from_settings({"restitution": "0.9", "linear": "yes"}) == HousnerBlock(0.9, True)


def test_declared_limits_warn():
    motion = harmonic(1.0, 0.3 * g, 0.1)
    stocky = Column.of_drums([Drum(1.0, 0.8, 0.8, 1600.0)], JOINT)
    with pytest.warns(OutOfRangeWarning, match="slides before it rocks"):
        simulate(stocky, motion, HousnerBlock())
    lifted = motion.replace(vertical=-8.0 * motion.samples)
    with pytest.warns(OutOfRangeWarning, match="leave the ground"):
        simulate(COLUMN, lifted, HousnerBlock())


def test_the_largest_motion_of_a_batch_is_checked_in_any_order():
    motion = harmonic(1.0, 0.1 * g, 0.1)
    lifted = motion.replace(vertical=-10.0 * motion.samples)
    # Upwards only; turned round, it falls below −1 g.
    bump = motion.replace(vertical=np.full(motion.steps, 0.5 * g))
    for factors in ((0.1, 1.0, 3.0), (3.0, 1.0, 0.1)):
        with pytest.warns(OutOfRangeWarning, match="leave the ground"):
            simulate_many(COLUMN, [lifted.scaled(factor) for factor in factors], HousnerBlock())
    for factors in ((-3.0, 4.0), (4.0, -3.0)):
        with pytest.warns(OutOfRangeWarning, match="leave the ground"):
            simulate_many(COLUMN, [bump.scaled(factor) for factor in factors], HousnerBlock())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate_many(COLUMN, [bump.scaled(factor) for factor in (4.0, 1.0)], HousnerBlock())


def test_a_lane_that_has_ended_keeps_the_samples_that_the_kernel_still_reads(monkeypatch):
    # The loop over lanes reads the input of those, too, that nothing is left to run for.
    monkeypatch.setattr(rocking_lanes, "MOST_TABLES", 1)
    block = RockingLanes(HousnerBlock(), RunOptions(), False)
    block.load(0, Case(COLUMN, harmonic(2.0, 0.01 * g, 1.0)))
    samples = weakref.ref(block.cases[0][2][0])
    while not block.is_over(0):
        block.advance()
    block.collect(0)
    block.load(1, Case(COLUMN, harmonic(3.0, 0.01 * g, 1.0)))  # the tables are full: the first is no longer kept there
    gc.collect()
    assert block.whole[A_ADDRESS, 0] == 0 or samples() is not None
