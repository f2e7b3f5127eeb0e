"""Rigid block dynamics: ledger, convergence of its imbalance, mirror symmetry, lanes."""

import numpy as np
import pytest

from stylobate.column import preset
from stylobate.models.base import RunOptions
from stylobate.models.engine import engine_for
from stylobate.models.rigid_block.model import RigidBlock, stable_step
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate, simulate_many

pytestmark = pytest.mark.processor

G = 9.81


def amplitudes(low: float, high: float, count: int) -> list[Motion]:
    return [harmonic(1.0, a * G, 3.0) for a in np.linspace(low, high, count)]


def test_the_ledger_of_the_monolith_closes_and_better_with_a_smaller_step():
    medians = []
    for factor in (0.4, 0.2, 0.1):
        table = simulate_many(preset("paper-monolithic"), amplitudes(0.25, 0.32, 16), RigidBlock(step_factor=factor))
        medians.append(float(table.energy_imbalance.median()))
        if factor <= 0.2:
            assert table.energy_imbalance.max() < 1e-2
    # The loss at closing contacts is of second order in the step; the median over runs shows it.
    assert medians[2] < 0.4 * medians[1] < 0.4 * medians[0]


def test_the_ledger_holds_every_term():
    response = simulate(preset("paper-12-drums"), harmonic(1.0, 0.3 * G, 3.0), RigidBlock())
    energy = response.histories.energy
    assert energy["input"][-1] > 1e3
    assert energy["friction"][-1] > 0.1 * energy["input"][-1]
    assert (np.diff(energy["friction"]) > -1e-3 * energy["input"].max()).all()
    assert np.abs(response.histories.imbalance).max() < 1e-2 * np.abs(energy["input"]).max()


def test_damping_is_accounted_for_and_takes_energy():
    column = preset("paper-12-drums")
    model = RigidBlock(stiffness_damping=1e-5, mass_damping=0.05)
    response = simulate(column, harmonic(1.0, 0.3 * G, 3.0), model)
    energy = response.histories.energy
    assert energy["viscous"][-1] > 0.01 * energy["input"][-1]
    assert response.energy_imbalance < 1e-2


def test_a_column_at_rest_stays_at_rest():
    response = simulate(preset("paper-12-drums"), Motion(1.0, np.zeros(2)), RigidBlock())
    assert response.outcome.label == "at_rest"
    assert np.abs(response.histories.drum_x).max() < 1e-12
    assert np.abs(response.histories.drum_z).max() < 1e-12


def test_mirrored_motion_gives_the_mirrored_response():
    column, motion = preset("paper-12-drums"), harmonic(1.0, 0.3 * G, 2.0)
    there = simulate(column, motion, RigidBlock()).histories
    back = simulate(column, motion.scaled(-1.0), RigidBlock()).histories
    assert np.array_equal(there.drum_x, -back.drum_x)
    assert np.array_equal(there.drum_rotation, -back.drum_rotation)
    assert np.array_equal(there.drum_z, back.drum_z)


def test_a_run_does_not_depend_on_its_lane_neighbours_or_threads():
    columns = [preset("paper-12-drums"), preset("paper-monolithic")] * 12
    motions = [harmonic(1.0, a * G, 1.0) for a in np.linspace(0.1, 0.6, 24)]
    serial = simulate_many(columns, motions, RigidBlock(), threads=1)
    parallel = simulate_many(columns, motions, RigidBlock(), threads=2)
    facts = [name for name in serial.columns if name not in ("wall_s",)]
    assert serial[facts].equals(parallel[facts])
    for k in (0, 7, 22):
        alone = simulate(columns[k], motions[k], RigidBlock()).measures.row()
        assert all(serial.iloc[k][name] == value for name, value in alone.items() if isinstance(value, float))


def test_an_unstable_step_is_refused_and_a_stable_one_is_stable():
    from stylobate.errors import InputError

    column = preset("paper-12-drums")
    stable = stable_step(column)
    with pytest.raises(InputError, match="largest stable step"):
        engine_for(RigidBlock(time_step=1.1 * stable), column).check(harmonic(1.0, 1.0))
    # Below uplift the column is linear: close to the stability limit its energy stays bounded.
    response = simulate(column, harmonic(2.0, 0.05 * G, 1.0), RigidBlock(step_factor=0.95))
    assert response.peak_top_displacement < 1e-3
    assert RunOptions().tail == 0.0


@pytest.mark.parametrize("strength", [2e6, 2e5])
def test_the_ledger_closes_with_a_strength_as_well(strength):
    # 2 MPa is reached in impacts only, 0.2 MPa is three times the stress under the weight.
    motions = [harmonic(0.5, a * G, 4.0) for a in np.linspace(0.12, 0.45, 16)]
    table = simulate_many(preset("paper-12-drums"), motions, RigidBlock(compressive_strength=strength))
    assert (table.outcome != "failed").all()
    assert table.energy_imbalance.max() < 5e-3
    assert 0 < table.collapsed.sum() < 16
