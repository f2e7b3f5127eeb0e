"""The rigid beam's verdict: what is left of a contact, the lowest barrier, the near side of it, against closed forms."""

import numpy as np
import pytest
from oracles.adaptive_beam import run_as

from stylobate.column import Column, Drum, Joint, preset
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.kernels.rigid_beam import moment_law
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_beam.state import room
from stylobate.motion import Motion, harmonic
from stylobate.outcome import Outcome
from stylobate.simulate import simulate, simulate_many

STIFF = Joint(normal_stiffness=1e14, shear_stiffness=5e13, friction_coefficient=10.0)
SOFT = Joint(normal_stiffness=2e8, shear_stiffness=1e8, friction_coefficient=0.7)
ZERO = Motion(0.01, np.zeros(11))


def prism(drums: int, joint: Joint = STIFF, width: float = 1.0, **settings) -> Column:
    return Column.tapered(
        height=4.0, bottom_width=width, top_width=width, drums=drums, density=2000.0, joint=joint, **settings
    )


def test_room_on_the_contacts_of_slid_drums():
    # Four equal prisms, 1 m wide. The third has slid by 0.3 m and the fourth by 0.4 m on it; the base takes nothing away.
    margins = room(prism(4), np.array([5.0, 0.0, 0.3, 0.4]))
    above_three = 0.4 / 2.0  # centroid of drums 3 and 4 over drum 3
    above_two = (2.0 * 0.3 + 0.4) / 3.0
    above_one = (2.0 * 0.3 + 0.4) / 4.0
    assert margins == pytest.approx([0.5 - above_one, 0.5 - above_two, 0.2 - above_three, 0.1])
    assert room(prism(4), -np.array([5.0, 0.0, 0.3, 0.4])) == pytest.approx(margins)
    # A narrow drum on a wide one slides 0.2 m before the contact gets shorter.
    stepped = Column.of_drums([Drum(1.0, 1.0, 1.0, 2000.0), Drum(1.0, 0.6, 0.6, 2000.0)], STIFF)
    for slip, free in ((0.2, 0.3), (0.25, 0.25), (0.5, 0.0), (0.6, -0.1)):
        assert room(stepped, np.array([0.0, slip]))[1] == pytest.approx(free)


def test_lowest_barrier_of_rigid_drums():
    # One body of weight N, half width b, centroid at H: ½ N b²/H with small rotations. Joint 4 carries one drum.
    weight, half, height = 2000.0 * g, 0.5, 0.5
    passes = RigidBeam(moment_law="bilinear", sliding=True).pack(prism(4))
    whole, top = 0.5 * 4.0 * weight * half**2 / 2.0, 0.5 * weight * half**2 / height
    assert passes.lowest(np.zeros(4)) == pytest.approx(min(whole, top), rel=1e-4)
    slip = np.array([3.0, 0.0, 0.0, 0.2])
    # the top drum has 0.3 m left, and the whole column's centroid stands 0.05 m out
    near = min(whole * (0.45 / 0.5) ** 2, top * (0.3 / 0.5) ** 2)
    assert passes.lowest(slip) == pytest.approx(near, rel=1e-4)
    assert passes.lowest(np.array([0.0, 0.0, 0.0, 0.6])) == -np.inf
    # A loose joint slides down its tilted face before the balance point: N (b μ − H μ²/2) for every part that holds it.
    loose = RigidBeam(moment_law="bilinear", sliding=True).pack(
        prism(4, overrides={4: Joint(1e14, 5e13, friction_coefficient=0.1)}),
    )
    expected = weight * min(k * (half * 0.1 - 0.5 * (0.5 * k) * 0.1**2) for k in (1.0, 2.0, 3.0, 4.0))
    assert loose.lowest(np.zeros(4)) == pytest.approx(expected, rel=1e-2)
    alone = RigidBeam(moment_law="bilinear", sliding=True).pack(prism(1, Joint(1e14, 5e13, friction_coefficient=0.1)))
    assert alone.lowest(np.array([2.0])) == pytest.approx(whole, rel=1e-4)


@pytest.mark.parametrize("law", ["winkler", "bilinear"])
@pytest.mark.parametrize("stiffness", [1e9, 1e8])
def test_no_way_over_two_joints_is_lower_than_the_barrier(law, stiffness):
    # While one joint of two is turned over its summit the other gives way: the lowest pass of the potential of both.
    column = Column.tapered(
        height=5.0,
        bottom_width=0.96,
        top_width=0.66,
        drums=2,
        density=1600.0,
        joint=Joint(stiffness, 0.5 * stiffness, 35.0),
    )
    passes = RigidBeam(moment_law=law).pack(column)
    weight = passes.gravity[0]
    lowest = []
    for joint in (0, 1):
        turned = np.linspace(0.3, 1.0, 400)[:, None] * passes.angles[-1, joint]
        gives = np.linspace(0.0, 40.0, 2001)[None, :] * passes.opening[1 - joint]
        phi = np.stack(np.broadcast_arrays(*((turned, gives) if joint == 0 else (gives, turned))), axis=-1)
        energy = moment_law.stored(phi, passes.joints[:, None, None, :], passes.bed).sum(axis=-1)
        energy -= 0.5 * np.cumsum(phi, axis=-1) ** 2 @ weight
        lowest.append(energy.min(axis=1).max())
    assert passes.lowest_unslid <= min(lowest) <= passes.lowest_rigid
    assert passes.lowest_unslid > 0.97 * min(lowest)
    assert min(lowest) < (1.0 - 1e-4) * passes.lowest_rigid


@pytest.mark.parametrize("second_order", ["geometric", "law"])
@pytest.mark.parametrize("solver", ["fixed", "adaptive"])
def test_a_soft_block_let_go_beyond_its_summit_falls(second_order, solver):
    # The bed without tension gives way: its balance point lies before b/H, and from there on the block falls by itself.
    column = Column.tapered(height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=SOFT)
    passes = RigidBeam(second_order=second_order).pack(column)
    summit = float(passes.angles[passes.heights[:, 0].argmax(), 0])
    assert summit < 0.98 * passes.angles[-1, 0]
    for share, falls in ((0.98, False), (1.01, True)):
        model = RigidBeam(second_order=second_order, initial_rotation=share * summit)
        response = run_as(solver, column, ZERO, model)
        assert (response.outcome is Outcome.COLLAPSED) == falls
        assert response.decided
        assert (run_as(solver, column, ZERO, model, tail=4.0).outcome is Outcome.COLLAPSED) == falls


def test_a_column_that_slid_on_its_base_stands():
    column = Column.tapered(
        height=2.0, bottom_width=1.0, top_width=1.0, drums=1, density=2000.0,
        joint=Joint(5e9, 2.5e9, friction_coefficient=0.05),
    )  # fmt: skip
    push = Motion(0.005, np.full(201, 0.14 * g))
    response = simulate(column, push, RigidBeam(sliding=True, stiffness_damping=1e-4), tail=2.0)
    assert response.residual_joint_slip > column.base_width
    assert response.outcome is Outcome.DISPLACED
    assert response.decided


def test_laws_in_rotations_of_single_drums_decide_only_what_stays_closed():
    # Their moments have no potential, so no barrier can be named: a joint that has opened may open again.
    column, model = preset("paper-12-drums"), RigidBeam.paper(stiffness_damping=1e-5)
    motions = [harmonic(f, a * g, 3.0 / f) for f in (1.0, 2.0) for a in (0.1, 0.15, 0.25, 0.3, 0.35)]
    table = simulate_many(column, motions, model, threads=1)
    stands = ~table.collapsed
    assert (table.decided & stands & (table.outcome == "at_rest")).sum() >= 4
    assert not (table.decided & stands & (table.outcome == "rocked")).any()
    assert (stands & (table.outcome == "rocked")).any()
    # One drum turns as its joint does, and has a potential.
    response = simulate(preset("paper-monolithic"), harmonic(1.0, 0.2 * g, 3.0), RigidBeam.paper())
    assert response.outcome is Outcome.ROCKED
    assert response.decided


def test_a_closed_column_that_flutters_is_refused():
    # Many stocky drums whose laws are in single rotations have complex modes: the smallest vibration grows.
    quiet = harmonic(1.0, 1e-4 * g, 1.0)
    response = simulate(preset("paper-12-drums"), quiet, RigidBeam(rotation="absolute"))
    assert response.outcome is Outcome.AT_REST
    assert response.decided
    stocky = prism(12, width=2.0)
    with pytest.raises(InputError, match="rotation=relative"):
        simulate(stocky, quiet, RigidBeam(rotation="absolute"))
    assert simulate(stocky, quiet, RigidBeam()).outcome is Outcome.AT_REST


@pytest.mark.processor
def test_flutter_is_told_by_values_not_by_the_type_of_an_array(monkeypatch):
    # numpy 2.5 returns complex arrays from eig always, earlier versions real ones where all values are real.
    real_eig = np.linalg.eig

    def complex_eig(matrix):
        values, vectors = real_eig(matrix)
        return values.astype(complex), vectors.astype(complex)

    model, quiet = RigidBeam(rotation="absolute"), harmonic(1.0, 1e-4 * g, 1.0)
    monkeypatch.setattr(np.linalg, "eig", complex_eig)
    response = simulate(preset("paper-12-drums"), quiet, model)
    assert (response.outcome, response.decided) == (Outcome.AT_REST, True)
    with pytest.raises(InputError, match="rotation=relative"):
        simulate(prism(12, width=2.0), quiet, model)
