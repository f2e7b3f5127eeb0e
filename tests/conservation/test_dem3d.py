"""Distinct elements in space: ledger, symmetry under turns and mirrors, similarity, a column that is left alone."""

import math

import numpy as np
import pytest
from validation.space import round_column

from stylobate.column import Column, Drum, Joint
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.drums.impact import TRIED, restitutions
from stylobate.models.engine import engine_for
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate, simulate_many

pytestmark = pytest.mark.processor

MONOLITH, TWELVE = round_column(), round_column(12)
AMPLITUDES = np.linspace(0.28, 0.32, 16) * g  # one block of lanes


def two_ways(duration: float, angle: float = 0.0, mirrored: bool = False) -> Motion:
    """0.3 g at 1 Hz along x and 0.2 g at 1.3 Hz along y, turned about z or seen in a mirror."""
    time = np.arange(round(duration * 500) + 1) * 2e-3
    x, y = 0.3 * g * np.sin(2.0 * np.pi * time), 0.2 * g * np.sin(2.6 * np.pi * time)
    y = -y if mirrored else y
    c, s = math.cos(angle), math.sin(angle)
    return Motion(2e-3, c * x - s * y, s * x + c * y)


def unequal() -> Column:
    """Three drums that differ in everything, one joint with cohesion."""
    shapes = [(1.4, 1.0, 0.9, 2000.0), (0.5, 0.9, 0.8, 2600.0), (1.9, 0.75, 0.7, 1800.0)]
    drums = [Drum(*shape, "circular") for shape in shapes]
    other = Joint(2e10, 3e10, friction_coefficient=0.5, cohesion=1e4)
    return Column.of_drums(drums, Joint(5e10, 2.5e10, friction_coefficient=0.7), overrides={2: other})


def places(column, motion, **options):
    """Centroids of all drums every 32 steps, shape (T, 3, n), and the times."""
    model = DistinctElement3D(**options)
    block = engine_for(model, column).block(RunOptions(until_end=True))
    block.load(0, Case(column, motion))
    centroids = []
    while not block.is_over(0):
        block.advance(1)
        centroids.append(np.array([block.records.body[c][1:, 0] for c in "xyz"]))
    return np.array(centroids), np.arange(1, len(centroids) + 1) * block.chunk * block.dt[0]


# -- energy ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("column", "options", "limit"),
    [(MONOLITH, {}, 1e-2), (MONOLITH, {"stiffness_damping": 1e-4, "mass_damping": 0.2}, 1e-2), (unequal(), {}, 1e-2)],
    ids=["monolith", "damped", "unequal, cohesion"],
)
def test_ledger_closes_to_second_order(column, options, limit):
    """Imbalance over 16 amplitudes along one direction, at the default step and at half of it."""
    unit = harmonic(1.0, 1.0 if column is MONOLITH else 1.7, 6.0)
    medians = []
    for step in (0.4, 0.2):
        table = simulate_many(
            column, [unit.scaled(a) for a in AMPLITUDES], DistinctElement3D(step_factor=step, **options)
        )
        assert (table["peak_joint_opening_m"] > 1e-3).all()
        medians.append(np.median(table["energy_imbalance"]))
    assert medians[0] < limit
    assert 1.7 < medians[0] / medians[1] < 9.0


def test_every_term_of_the_ledger_is_there():
    options = {"stiffness_damping": 1e-4, "mass_damping": 0.1}
    response = simulate(MONOLITH, two_ways(4.0), DistinctElement3D(**options))
    energy = response.histories.energy
    largest = np.abs(energy["input"]).max()
    for loss in ("friction", "viscous"):
        assert energy[loss][-1] > 0.01 * largest
        assert (np.diff(energy[loss]) > -1e-3 * largest).all()
    assert energy["kinetic"].min() >= 0.0
    assert np.abs(response.histories.imbalance).max() < 0.01 * largest


@pytest.mark.parametrize("law", ["rim", "bed"])
def test_a_column_that_is_left_alone_stands_still(law):
    response = simulate(TWELVE, Motion(0.1, np.zeros(6)), DistinctElement3D(law=law))
    assert response.provenance["residual_acceleration_at_start_m_s2"] < 1e-4
    assert np.abs(response.top_displacement).max() < 1e-9
    assert response.peak_twist < 1e-10
    assert str(response.outcome) == "at_rest"
    assert response.decided


# -- symmetry ----------------------------------------------------------------------------------------------------


def test_turned_input_turns_the_response():
    """By 37°: no direction is preferred; of 0.2 m is left what rounding grows to by impacts and changing layers."""
    angle = math.radians(37.0)
    straight, _ = places(MONOLITH, two_ways(5.0))
    turned, _ = places(MONOLITH, two_ways(5.0, angle))
    c, s = math.cos(angle), math.sin(angle)
    x, y = c * straight[:, 0] - s * straight[:, 1], s * straight[:, 0] + c * straight[:, 1]
    assert np.ptp(straight[:, 0]) > 0.2
    assert np.ptp(straight[:, 1]) > 0.1
    assert max(np.abs(x - turned[:, 0]).max(), np.abs(y - turned[:, 1]).max()) < 5e-5


@pytest.mark.parametrize(("column", "duration"), [(MONOLITH, 5.0), (TWELVE, 1.0)], ids=["monolith", "12 drums"])
def test_mirrored_input_gives_the_mirrored_motion_to_the_bit(column, duration):
    centroids, _ = places(column, two_ways(duration))
    mirrored, _ = places(column, two_ways(duration, mirrored=True))
    np.testing.assert_array_equal(centroids[:, [0, 2]], mirrored[:, [0, 2]])
    np.testing.assert_array_equal(centroids[:, 1], -mirrored[:, 1])


def test_planar_twin_stays_in_its_plane():
    response = simulate(unequal(), two_ways(3.0).scaled(1.8), DistinctElement3D(planar=True))
    assert response.peak_top_x > 0.01
    assert response.peak_top_y == 0.0
    assert response.peak_twist == 0.0
    assert np.abs(response.body_position[..., 1]).max() == 0.0


def test_four_times_the_size_is_the_same_motion():
    """Lengths × 4, times × 2, stiffness per area kept: the same numbers but for powers of two."""
    step = engine_for(DistinctElement3D(), MONOLITH).step
    large = Column.tapered(
        height=20.0,
        bottom_width=3.84,
        top_width=2.64,
        drums=1,
        density=1600.0,
        joint=MONOLITH.joints[0],
        section="circular",
    )
    motion = two_ways(4.0)
    small, _ = places(MONOLITH, motion, time_step=step, stiffness_damping=2.0**-15)
    four, _ = places(large, motion.replace(dt=2.0 * motion.dt), time_step=2.0 * step, stiffness_damping=2.0**-14)
    np.testing.assert_allclose(four, 4.0 * small, rtol=0, atol=1e-9)


def test_a_target_restitution_chooses_the_damping_and_says_its_cost():
    """Housner's e = 0.9351 for the frustum; undamped the rim law gives back more."""
    target = MONOLITH.restitution
    model = DistinctElement3D(restitution=target)
    beta = model.damping(MONOLITH)
    assert 3e-4 < beta < 3e-3
    coefficients = restitutions(MONOLITH, DistinctElement3D())
    assert coefficients[0] == pytest.approx(0.98, abs=0.01)
    assert np.interp(beta, TRIED, coefficients) == pytest.approx(target, abs=1e-3)
    response = simulate(MONOLITH, harmonic(1.0, 0.1 * g, 0.2), model)
    assert response.provenance["stiffness_damping_s"] == beta
    assert response.provenance["steps_over_undamped"] > 2.0
    with pytest.raises(InputError, match=r"restitution is 0\.5; the joints of 'column' give"):
        DistinctElement3D(restitution=0.5).damping(MONOLITH)
    with pytest.raises(InputError, match="both given"):
        simulate(MONOLITH, two_ways(1.0), DistinctElement3D(restitution=0.9, stiffness_damping=1e-4))
