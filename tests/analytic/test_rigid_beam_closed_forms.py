"""The rigid beam against closed forms: stored energies, matrices by hand, rocking of one stiff block, Newmark's slide."""

import math

import numpy as np
import pytest
from oracles.adaptive_beam import run_as
from scipy.integrate import quad
from validation import overturning

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.kernels.rigid_beam import moment_law
from stylobate.models.base import Case
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_beam.state import BeamMatrices, tridiagonal
from stylobate.motion import Motion
from stylobate.simulate import run_cases, simulate
from stylobate_studies.paper.nodal_beam import nodal_matrices

pytestmark = pytest.mark.processor

JOINT = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=0.7)


def bed_moment(phi: float, k: float, m1: float, s1: float, bed) -> float:
    out = np.empty(1)
    moment_law.moments(np.array([phi]), 1.0, np.array([[k], [m1], [s1], [0.0], [0.0]]), bed, out)
    return out[0]


@pytest.mark.parametrize("ratio", [0.3, 0.99, 1.5, 4.0, 30.0, 400.0])
@pytest.mark.parametrize("section", ["rectangular", "circular"])
def test_energy_stored_in_an_elastic_bed_is_the_work_of_its_moment(section, ratio):
    half, load = 0.6, 2.0e-2  # bed of 1 N/m³
    if section == "rectangular":
        area, second, bed = 2.0 * half * 1.3, 1.3 * (2 * half) ** 3 / 12.0, True
    else:
        area, second, bed = math.pi * half**2, math.pi * half**4 / 4.0, moment_law.circle()
    opening = load / (area * half)
    energy = quad(lambda x: bed_moment(x, second, load * half, opening, bed), 0, ratio * opening, points=[opening])[0]
    stored = moment_law.stored(
        np.array([-ratio * opening]), np.array([[second], [load * half], [opening], [0], [0]]), bed
    )
    assert stored[0] == pytest.approx(energy, rel=1e-6)


def test_laws_of_lines_in_law_and_geometric_form():
    column = preset("paper-monolithic").as_prism()
    ultimate = column.joint_weights[0] * 0.405
    alpha = math.atan2(0.405, 2.5)
    stiff = 5e10 * 0.81**3 / 12
    model = RigidBeam(moment_law="trilinear", xi=0.8, second_order="law")
    phi = np.array([1e-7, 0.1 * alpha, 0.3 * alpha, -0.6 * alpha, 1.2 * alpha])
    out = np.empty((5, 1))
    for row, value in zip(out, phi, strict=True):
        moment_law.moments(np.array([value]), 1.0, model.joints(column), None, row)
    # What gravity takes in the equations of motion is what the law of the geometric form has more.
    geometric = RigidBeam(moment_law="trilinear", xi=0.8)
    for value, law in zip(phi[1:], out[1:, 0], strict=True):
        row = np.empty(1)
        moment_law.moments(np.array([value]), 1.0, geometric.joints(column), None, row)
        if abs(value) < alpha:
            assert row[0] - ultimate * value / alpha == pytest.approx(law, rel=1e-12)
    energy = quad(lambda x: np.interp(x, [0, 0.8 * ultimate / stiff, 0.2 * alpha, 2 * alpha],
                                      [0, 0.8 * ultimate, 0.8 * ultimate, -ultimate]), 0, 1.2 * alpha,
                  points=[0.8 * ultimate / stiff, 0.2 * alpha], limit=200)[0]  # fmt: skip
    assert moment_law.stored(np.array([1.2 * alpha]), model.joints(column), None)[0] == pytest.approx(energy, rel=1e-6)


def test_papers_matrices_of_two_equal_prisms():
    # Baraldi et al., Eq. 2 with signs and dots put right, by hand: m = 1 t, h = 2 m.
    drum = Drum(2.0, 2.0 * math.sqrt(2.0), 2.0 * math.sqrt(2.0), 1e3 / (4.0 * math.sqrt(2.0)))
    assert drum.mass == pytest.approx(1e3)
    inertia = 1e3 * (4.0 + 8.0) / 12.0
    assert drum.inertia == pytest.approx(inertia)
    geometry, shear, turning, shear_base, turning_base = nodal_matrices(
        Column.of_fields(drums=(drum,) * 2, joints=(JOINT,) * 2, name="prisms")
    )
    assert geometry == pytest.approx(np.array([[1.0, 2.0], [0.0, 1.0]]))
    assert shear == pytest.approx(1e3 * np.array([[1.0, 0.5], [0.5, 0.5]]))
    assert shear_base == pytest.approx([500.0, 0.0])
    assert turning == pytest.approx(np.array([[0.0, 0.5], [-0.5, 0.5]]) * inertia)
    assert turning_base == pytest.approx([-0.5 * inertia, 0.0])


def test_tridiagonal_mass_matrix():
    column = preset("paper-12-drums")
    pivot, upper, nodes = tridiagonal(column)
    triangle = np.eye(12) + np.diag(upper[1:], 1)
    full = triangle @ np.diag(1.0 / pivot) @ triangle.T
    turn = (np.eye(12) - np.eye(12, k=-1)) / column.heights[:, None]  # θ from u
    assert full == pytest.approx(turn.T @ BeamMatrices(column).mass @ turn, rel=1e-11, abs=1e-9)
    assert nodes == pytest.approx(turn.T @ BeamMatrices(column).load, rel=1e-12)


def stiff_block(second_order: str) -> tuple[Column, RigidBeam, float, float]:
    """A slender prism on a very stiff joint, and the beam's own p and critical tangent."""
    joint = Joint(normal_stiffness=1e13, shear_stiffness=1e13, friction_coefficient=0.7)
    column = Column.of_drums([Drum(5.0, 0.5, 0.5, 1600.0)], joint)
    model = RigidBeam(moment_law="bilinear", second_order=second_order)
    inertia = column.mass * (25.0 / 4.0) + column.inertias[0]
    arm = 0.25 if second_order == "geometric" else 2.5 * math.atan(0.1)
    return column, model, math.sqrt(column.mass * g * 0.25 / (arm / 2.5) / inertia), arm / 2.5


@pytest.mark.parametrize("second_order", ["geometric", "law"])
def test_stiff_beam_of_one_drum_rocks_as_the_linearised_block(second_order):
    column, model, p, alpha = stiff_block(second_order)
    start = 0.6 * alpha
    quarter = math.acosh(1.0 / 0.4) / p
    model = RigidBeam(moment_law="bilinear", second_order=second_order, initial_rotation=start)
    motion = Motion(0.01, np.zeros(1 + round(1.5 * quarter / 0.01)))
    response = run_as("adaptive", column, motion, model, output_interval=1e-3)
    rotation, time = response.drum_rotation[:, 0], response.time
    before = time < 0.98 * quarter
    exact = alpha - (alpha - start) * np.cosh(p * time)
    assert rotation[before] == pytest.approx(exact[before], abs=1e-4 * alpha)
    k = np.flatnonzero(rotation < 0.0)[0]
    assert time[k] == pytest.approx(quarter, abs=2e-3)


@pytest.mark.parametrize("pt", [0.5, 1.0, 2.0])
def test_constant_pulse_overturns_the_beam_with_housners_law(pt):
    # Housner 1963 with the beam's own p and M_u/(m g z).
    column, model, p, alpha = stiff_block("geometric")
    model = RigidBeam(moment_law="housner")
    ratio = overturning.constant(pt)
    motions = []
    for factor in (0.995, 0.998, 1.002, 1.005):
        motions.append(Motion(pt / p / 1000, np.ones(1001), factor=ratio * factor * alpha * g))
    cases = [Case(column, motion) for motion in motions]
    results = dict(run_cases(cases, model, tail=3.0, threads=1))
    assert [results[i].collapsed for i in range(4)] == [False, False, True, True]


@pytest.mark.parametrize("second_order", ["geometric", "law"])
@pytest.mark.parametrize("slope", [0.2, 0.5, 1.0])
def test_housners_law_lifts_off_at_the_true_acceleration(second_order, slope):
    # m a h > m g b, whatever α stands for: a = g tan α; then I θ̈ = m (a h − g b) in the first instant.
    column = Column.of_drums(
        [Drum(4.0, 4.0 * slope, 4.0 * slope, 2000.0)], Joint(5e11, 2.5e11, friction_coefficient=10)
    )
    model = RigidBeam(moment_law="housner", second_order=second_order)
    limit = slope * g
    for factor, lifts in ((0.9995, False), (1.0005, True)):
        motion = Motion(0.01, np.full(101, factor * limit))
        single = simulate(column, motion, model)
        batch = dict(run_cases([Case(column, motion)], model, threads=1))[0]
        assert (single.peak_rotation > 0.0) == (batch.peak_rotation > 0.0) == lifts
    motion, time = Motion(0.001, np.full(21, 1.5 * limit)), 0.02
    expected = 0.5 * (0.5 * column.mass * limit * 2.0) / float(BeamMatrices(column).mass[0, 0]) * time**2
    for measures in (simulate(column, motion, model), dict(run_cases([Case(column, motion)], model, threads=1))[0]):
        assert measures.peak_rotation == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("solver", ["fixed", "adaptive"])
def test_newmark_slide(solver):
    # Base pulse A for t₁, A > μ g: slip = ½ (A − μ g) t₁² A/(μ g), against the base's motion.
    friction, pulse, length = 0.2, 0.5 * g, 0.3
    joint = Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_coefficient=friction)
    column = Column.of_drums([Drum(1.0, 3.0, 3.0, 2000.0)], joint)
    motion = Motion(length / 300, np.ones(301), factor=pulse)
    response = run_as(solver, column, motion, RigidBeam(sliding=True), tail=0.55)
    slip = 0.5 * (pulse - friction * g) * length**2 * pulse / (friction * g)
    assert response.joint_slip[-1, 0] == pytest.approx(-slip, rel=2e-3)
    assert str(response.outcome) == "displaced"
    assert response.energy["friction"][-1] == pytest.approx(friction * column.mass * g * slip, rel=2e-3)


def test_no_sliding_is_the_limit_of_high_friction_and_shear_stiffness():
    loose = Joint(normal_stiffness=2e9, shear_stiffness=1e9, friction_coefficient=0.7)
    column = Column.tapered(height=5.0, bottom_width=0.96, top_width=0.66, drums=3, density=1600.0, joint=loose)
    time = np.linspace(0.0, 0.8, 401)
    motion = Motion(time[1], np.sin(2 * np.pi * time), factor=0.35 * g)
    expected = simulate(column, motion, RigidBeam()).peak_top_displacement
    differences = []
    for stiffness in (1e10, 1e12):
        rough = column.with_joint(friction_coefficient=1e5, shear_stiffness=stiffness)
        displacement = simulate(rough, motion, RigidBeam(sliding=True)).peak_top_displacement
        differences.append(abs(displacement / expected - 1.0))
    assert expected > 0.02
    assert differences[1] < 2e-4
    assert differences[1] < differences[0]
