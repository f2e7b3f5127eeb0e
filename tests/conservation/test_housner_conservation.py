"""Housner's block: energy ledger, mirror symmetry, similarity."""

import math

import numpy as np
import pytest

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import Motion, harmonic
from stylobate.outcome import Outcome
from stylobate.simulate import simulate, simulate_many

COLUMN = preset("paper-monolithic")


def shaken(amplitude: float, vertical: float = 0.0) -> Motion:
    time = np.arange(6001) * 1e-3
    up = vertical * np.sin(2 * np.pi * 3.1 * time) if vertical else None
    return Motion(1e-3, amplitude * np.sin(2 * np.pi * time), vertical=up)


pytestmark = pytest.mark.processor


@pytest.mark.parametrize("linear", [False, True])
@pytest.mark.parametrize("vertical", [0.0, 0.3 * g])
def test_ledger_closes(linear, vertical):
    response = simulate(COLUMN, shaken(0.28 * g, vertical), HousnerBlock(linear=linear))
    scale = response.energy["input"].max()
    assert scale > 0.0
    assert response.peak_rotation > 0.1 * COLUMN.slenderness
    assert np.abs(response.imbalance).max() < 1e-7 * scale
    batch = simulate_many(COLUMN, [shaken(0.28 * g, vertical)], HousnerBlock(linear=linear))
    assert batch.energy_imbalance[0] < 1e-6


def test_mirror_symmetry():
    motion = shaken(0.25 * g)
    left, right = (simulate(COLUMN, motion.scaled(sign), HousnerBlock()) for sign in (1.0, -1.0))
    assert np.array_equal(left.drum_rotation, -right.drum_rotation)
    assert np.array_equal(left.top_displacement, -right.top_displacement)
    assert np.array_equal(left.drum_z, right.drum_z)
    table = simulate_many(COLUMN, [motion, motion.scaled(-1.0)], HousnerBlock())
    assert table.peak_rotation_rad[0] == table.peak_rotation_rad[1]


def test_similarity():
    # Lengths × λ, times × √λ, the same accelerations: the same rotations (p scales with 1/√λ). With λ = 4 every number
    # differs by a power of two, which no rounding sees: equal to the last bit on every processor, impacts and all.
    size = 4.0
    joint = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=0.7)
    small = Column.of_drums([Drum(2.0, 0.5, 0.4, 1600.0)], joint)
    large = Column.of_drums([Drum(2.0 * size, 0.5 * size, 0.4 * size, 1600.0)], joint)
    motion = harmonic(1.6, 0.35 * g, 5.0)
    stretched = motion.replace(dt=motion.dt * math.sqrt(size))
    original = simulate(small, motion, HousnerBlock(), output_interval=0.01)
    enlarged = simulate(large, stretched, HousnerBlock(), output_interval=0.02)
    assert np.count_nonzero(np.diff(np.sign(original.drum_rotation[:, 0]))) > 5  # impacts
    assert np.array_equal(enlarged.time, 2.0 * original.time)
    assert np.array_equal(enlarged.drum_rotation, original.drum_rotation)
    assert enlarged.peak_rotation == original.peak_rotation
    assert enlarged.peak_top_displacement == size * original.peak_top_displacement


def test_a_small_rotation_moves_points_as_a_rigid_body_does():
    response = simulate(COLUMN, shaken(0.3 * g), HousnerBlock())
    rotation = response.drum_rotation[:, 0]
    distance = response.top_displacement - response.base_displacement
    assert np.allclose(distance, -COLUMN.height * np.sin(rotation), atol=1e-12)
    assert np.allclose(response.joint_opening[:, 0], COLUMN.base_width * np.sin(np.abs(rotation)), atol=1e-12)


def test_what_the_ledger_cannot_account_for_counts_against_a_verdict():
    block = HousnerBlock().block(COLUMN)
    facts = {"side": 1.0, "peaks": (0.1, 0.0), "end": 2.0, "failure": "", "step": 1e-3, "steps": 2000, "start": 0.0}

    def measures(energy: float, unaccounted: float, time: float = -1.0, work: float = 2.0, sign: float = 1.0):
        v = sign * math.sqrt(2.0 * energy * block.barrier)
        energies = {"work": work * block.barrier, "unaccounted": unaccounted * block.barrier}
        return block.measures(x=0.0, v=v, collapse_time=time, **energies, **facts)

    assert measures(0.9, 0.05).decided
    assert not measures(0.9, 0.12).decided
    assert measures(1.1, 0.05).collapsed
    assert not measures(1.1, 0.12).decided
    assert not measures(1.1, 0.05, sign=-1.0).decided
    assert measures(0.9, 0.05, work=0.0).energy_imbalance == pytest.approx(0.05)
    assert measures(0.9, 0.6).outcome is Outcome.FAILED
    # a collapse that was found, without the energy for it
    assert measures(1.5, 0.2, time=1.0, work=1.4).collapsed
    assert measures(1.5, 0.2, time=1.0, work=0.9).outcome is Outcome.FAILED
