"""Plane distinct elements: a batch has the bits of single runs, whatever the lanes, the neighbours and the threads."""

import numpy as np
import pytest

from stylobate.column import AsFound, Column, FoundDrum, Joint, preset
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate, simulate_many

pytestmark = pytest.mark.processor

MEASURES = [
    "outcome",
    "decided",
    "collapse_time_s",
    "peak_top_displacement_m",
    "residual_top_displacement_m",
    "peak_rotation_rad",
    "peak_joint_opening_m",
    "residual_joint_slip_m",
    "energy_imbalance",
    "time_step_s",
    "steps",
    "reason",
]


def mixed_cases():
    """Columns of three drums that differ in shape, section and joints, under motions that differ in kind and length."""
    rng = np.random.default_rng(7)
    record = Motion(0.01, rng.normal(0.0, 3.0, 151), vertical=rng.normal(0.0, 1.0, 151))
    columns, motions = [], []
    for k in range(20):
        joint = Joint(1e9 * (1 + k % 3), 5e8, friction_angle=10.0 + 2.0 * k)
        columns.append(
            Column.tapered(
                height=2.0 + 0.1 * k,
                bottom_width=0.5,
                top_width=0.4,
                drums=3,
                density=2000.0 + 50.0 * k,
                joint=joint,
                section="circular" if k % 2 else "rectangular",
            )
        )
        if k % 4 == 3:
            columns[-1] = columns[-1].replace(as_found=AsFound((FoundDrum(2, 0.01, -0.5, 0.02),), 0.1 * k))
        motions.append(record.scaled(0.5 + 0.1 * k) if k % 3 == 0 else harmonic(1.0 + 0.2 * k, 0.4 * g, 1.0 + 0.1 * k))
    return columns, motions


@pytest.mark.parametrize(
    "model",
    [DistinctElement2D(), DistinctElement2D(points=3), DistinctElement2D(stiffness_damping=1e-4, mass_damping=0.2)],
    ids=["two points", "three points", "damped"],
)
def test_batch_has_the_bits_of_single_runs(model):
    columns, motions = mixed_cases()
    table = simulate_many(columns, motions, model, threads=2)
    for k in range(0, len(columns), 3):
        single = simulate(columns[k], motions[k], model).measures.row()
        for name in MEASURES:
            batch = table[name][k]
            assert single[name] == batch or (single[name] is None and (batch is None or np.isnan(batch))), (k, name)


def test_threads_and_order_do_not_change_a_bit():
    columns, motions = mixed_cases()
    single = simulate_many(columns, motions, DistinctElement2D(), threads=1)
    two = simulate_many(columns, motions, DistinctElement2D(), threads=2)
    back = simulate_many(columns[::-1], motions[::-1], DistinctElement2D(), threads=2)[::-1].reset_index(drop=True)
    assert single[MEASURES].equals(two[MEASURES])
    assert single[MEASURES].equals(back[MEASURES])


def test_columns_of_different_drum_counts_share_a_batch():
    motion = harmonic(1.0, 0.3 * g, 2.0)
    columns = [preset("paper-12-drums"), preset("paper-monolithic")]
    table = simulate_many(columns, [motion, motion], DistinctElement2D())
    for column, steps in zip(columns, table["steps"], strict=True):
        assert simulate(column, motion, DistinctElement2D()).measures.steps == steps


def test_recording_rate_does_not_change_the_run():
    column, motion = preset("paper-monolithic"), harmonic(1.0, 0.3 * g, 5.0)
    fine = simulate(column, motion, DistinctElement2D(), output_interval=0.004)
    coarse = simulate(column, motion, DistinctElement2D(), output_interval=0.5)
    assert fine.measures == coarse.measures
    assert len(fine.time) > 50 * len(coarse.time) / 2
    assert fine.time[-1] == coarse.time[-1] == pytest.approx(5.0)
